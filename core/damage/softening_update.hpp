// One increment of a solid with a crack (page 30, sections 5 to 7), in a frame in which its stiffness is known.
#pragma once

#include "lode/damage/softening_explicit.hpp"
#include "lode/damage/softening_state.hpp"
#include "lode/damage/softening_tangent.hpp"

namespace lode {

// The crack as it enters the increment, and what comes of it.
template <AnalysisKind kind, class Real>
struct CrackUpdate {
    static constexpr int m = crack_directions(kind);

    CrackAxes<Real> axes;
    Vector<SofteningDirection<Real>, m> law;
    Stress<kind, Real> stiffness[m];  // C_a m_a: d(sigma)/d(EC_a) = -C_a m_a, q_a = m_a . eps
    CrackState<m, Real> old, now;
    Vector<Real, m> q;
    Mask<Real> failed, stepped;
    Stress<kind, Real> stress;
    Real stored, dissipated, friction_work;  // `stored`: in the crack

    // `stage`: STATE on entry; `damaging`: points whose damage may grow; `damage(q_old, q)` lets it grow, changes `now`
    // and returns those that fail; `stepping`: points that take an explicit step instead.
    template <bool isotropic, class Damage, class T>
    LODE_INLINE void run(const SofteningCrack<isotropic>& crack, const Stress<kind, Real>& stress_old,
                         const Stress<kind, Real>& trial, const Real& stage, const Mask<Real>& damaging,
                         const Mask<Real>& stepping, const Damage& damage,
                         [[maybe_unused]] CrackLinearisation<kind>* linear, T&) {
        const Real zero(0.0);
        // Effective strains on each side of the increment: q = T/C + EC.
        const Vector<Real, m> traction_old = axes.template tractions<kind>(stress_old);
        const Vector<Real, m> traction_trial = axes.template tractions<kind>(trial);
        Vector<Real, m> q_old;
        for (int j = 0; j < m; ++j) {
            const Real& compliance = law[j].compliance;
            q_old[j] = compliance * traction_old[j] + old.strain[j];
            q[j] = compliance * traction_trial[j] + old.strain[j];
        }

        now = old;
        const Mask<Real> failed_before = stage > Real(1.5);
        failed = failed_before;
        if (any(damaging)) failed = failed || damage(q_old, q);
        now.strain[0] = now.damage[0] * positive_part(q[0]);
        for (int j = 1; j < m; ++j) now.strain[j] = now.damage[j] * q[j];
        friction_work = zero;
        stepped = stepping;
        if constexpr (isotropic)
            if (any(stepping)) [[unlikely]] {
                const ExplicitStep<m, Real> step = crack.explicit_step(q_old, q, old, stepping, law);
                for (int j = 0; j < m; ++j) {
                    now.delta[j] = select(stepping, step.crack.delta[j], now.delta[j]);
                    now.damage[j] = select(stepping, step.crack.damage[j], now.damage[j]);
                    now.strain[j] = select(stepping, step.crack.strain[j], now.strain[j]);
                    now.dissipated[j] = select(stepping, step.crack.dissipated[j], now.dissipated[j]);
                    if constexpr (wants_tangent<T>)
                        for (int k = 0; k < m; ++k) linear->B[j][k] = step.B[j][k];
                }
                failed = failed || (stepping && step.fails);
            }
        if (any(failed)) {
            Vector<Real, m> strain;
            if constexpr (wants_tangent<T>) strain = crack.failed_strain(q, old.strain, law, friction_work, linear->B);
            else strain = crack.failed_strain(q, old.strain, law, friction_work);
            for (int j = 0; j < m; ++j) now.strain[j] = select(failed, strain[j], now.strain[j]);
            friction_work = select(failed_before, friction_work, zero);
        }

        // sigma = trial - C d(eps_c). A failed crack that slides stores nothing.
        stress = trial;
        stored = zero;
        dissipated = friction_work;
        for (int j = 0; j < m; ++j) {
            const Real change = now.strain[j] - old.strain[j];
            for (int i = 0; i < components(kind); ++i) stress[i] = stress[i] - change * stiffness[j][i];
            const Real work = 0.5 * law[j].modulus * (q[j] - now.strain[j]) * now.strain[j];
            stored = stored + (j == 0 ? work : select(failed, zero, work));
            dissipated = dissipated + (now.dissipated[j] - old.dissipated[j]);
        }
    }

    // The linearisation after `run`; `K` as in CrackPressure.
    LODE_INLINE void linearise(const DamageRates<m>& rates, double K, CrackLinearisation<kind>& linear) const {
        for (int j = 0; j < m; ++j) {
            linear.compliance[j] = law[j].compliance;
            linear.stiffness[j] = stiffness[j];
        }
        if (!failed && !stepped) linear.set_damaged(q, now.damage, rates, K);
    }
};

}  // namespace lode
