// CAM_CLAY: modified Cam-clay with a coupled hyperelastic law (page 70; Banerjee's text after Borja et al. 1997).
// Pressures are positive in compression, tensors in tension. The stress follows from the elastic strain kept in STATEV.
#pragma once

#include <string>

#include "lode/soil/cam_clay_initial_state.hpp"
#include "lode/soil/cam_clay_substeps.hpp"

namespace lode {

struct CamClay {
    static constexpr const lode_model& description = cam_clay::description;

    explicit CamClay(const Properties& p)
        : elasticity(p[cam_clay::P_REF], p[cam_clay::KAPPA], p[cam_clay::MU0], p[cam_clay::ALPHA]),
          plasticity(elasticity, p[cam_clay::LAMBDA], p[cam_clay::M], p.code(cam_clay::METHOD)),
          substeps{plasticity, p.code(cam_clay::NSUB), p[cam_clay::STOL]},
          initial_state(p, elasticity),
          biot(p[cam_clay::BIOT]),
          thermal_expansion(p[cam_clay::ALPHA_T]) {
        const double kappa = p[cam_clay::KAPPA], mu0 = p[cam_clay::MU0], alpha = p[cam_clay::ALPHA];
        if (!(p[cam_clay::LAMBDA] > kappa)) p.refuse(cam_clay::LAMBDA, "> kappa = " + format_number(kappa));
        if (!(mu0 + alpha > 0.0)) p.refuse(cam_clay::MU0, "> 0 where alpha is 0 (mu0 + alpha > 0)");
    }
    std::string warnings() const { return initial_state.warnings(); }

    int required_state(AnalysisKind) const { return cam_clay::description.state_count; }

    template <AnalysisKind kind>
    void initial_stiffness(const Stress<kind, double>& stress, const State<double>& state, Tangent<kind>& c) const {
        double v = 0.0, pc = state[cam_clay::PC];
        Stress<kind, double> e = elastic_strain<kind, double>(state);
        if (state[cam_clay::INIT] != 0.0) {
            v = -trace(e);
            e = deviator(e);
        } else if (initial_state.find(stress, 0.0, v, e, pc).refused != nullptr) {
            v = elasticity.kappa * log(initial_state.p_ini / elasticity.p_ref);
            e = {};
        }
        CamClayStep<double> at{};
        at.s = shear_invariant(e);
        at.A = elasticity.volumetric_pressure(v);
        at.mu = elasticity.shear_modulus(at.A);
        at.p = elasticity.pressure(at.A, at.s);
        substeps.set_tangent(at, plasticity.linearised(at), e, c);
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        State<Real>& state = point.state;

        // The elastic strain at the start, in the frame of the end.
        CamClayPath<kind, Real> start;
        Stress<kind, Real> elastic = elastic_strain<kind, Real>(state);
        if constexpr (!is_batch<Real>)
            if (increment.turns()) elastic = rotate<kind, Real>(elastic, increment.rotation());
        start.v = -trace(elastic);
        start.e = deviator(elastic);
        start.pc = state[cam_clay::PC];
        const Mask<Real> fresh = state[cam_clay::INIT] == Real(0.0);
        if (any(fresh)) [[unlikely]] {
            Real pore_pressure = Real(0.0);
            if (biot != 0.0) pore_pressure = increment.field_start(1);
            if (!initial_state.find_lanes(fresh, pore_pressure, point, start.v, start.e, start.pc)) return;
        }
        const Real pc_relative = start.pc * (1.0 / elasticity.p_ref);
        const Mask<Real> sane = pc_relative > Real(1e-300) && pc_relative < Real(1e300);
        start.log_pc = select(sane, quick_log(pc_relative), Real(std::numeric_limits<double>::quiet_NaN()));

        Strain<kind, Real> strain = increment.strain_increment;
        if (thermal_expansion != 0.0)
            add_to_normals(strain, 3, (-thermal_expansion) * increment.temperature_increment());
        Real dv = -trace(strain);
        Stress<kind, Real> de = deviator(strain);
        Mask<Real> clipped = Mask<Real>(false);
        if (!guard(increment, start, dv, de, clipped, point)) return;

        if (substeps.is_single_step()) {
            CamClayPath<kind, Real>& path = start;
            substeps.advance(path, dv, de, point.solves);
            if (!accept(increment, path, clipped, point)) return;
            if constexpr (wants_tangent<T>) {
                substeps.set_tangent(path.last, plasticity.linearised(path.last), path.e, tangent);
                complete_tangent(path.last, tangent);
            }
        } else {
            CamClaySensitivity<kind, wants_tangent<T>> sensitivity;
            const CamClayPath<kind, Real> end = substeps.several_steps(start, dv, de, sensitivity, point.solves);
            if (!accept(increment, end, clipped, point)) return;
            if constexpr (wants_tangent<T>) {
                substeps.set_tangent(end.last, sensitivity, end.e, tangent);
                complete_tangent(end.last, tangent);
            }
        }
    }

    CamClayElasticity elasticity;
    CamClayReturn plasticity;
    CamClaySubsteps substeps;
    CamClayInitialState initial_state;
    double biot, thermal_expansion;

  private:
    static constexpr double largest_strain = 0.5;
    static constexpr double largest_extension = 600.0;  // in units of kappa, from where pc would be reached
    static constexpr double largest_exponent = 660.0;   // exp() of it and of its negative are normal numbers

    template <AnalysisKind kind, class Real>
    static Stress<kind, Real> elastic_strain(const State<Real>& state) {
        Stress<kind, Real> e;
        for (int i = 0; i < components(kind); ++i) e[i] = state[cam_clay::EE + i];
        return e;
    }

    // Stress, energies and state at the end; false where the stress is not finite.
    template <AnalysisKind kind, class Real>
    LODE_INLINE bool accept(const Increment<kind, Real>& increment, const CamClayPath<kind, Real>& end,
                            const Mask<Real>& clipped, Point<kind, Real>& point) const {
        const CamClayStep<Real>& last = end.last;
        if (any(end.failed)) [[unlikely]] {
            point.fail(end.failed, "CAM_CLAY: the textbook Newton iteration has found no solution (method 0 does)",
                       0.25);
            return false;
        }
        Real pore_stress = Real(0.0);
        if (biot != 0.0) pore_stress = biot * increment.field_end(1);
        const Mask<Real> bad = !is_finite(Real(last.p + last.q + end.pc + pore_stress));
        if (any(bad)) [[unlikely]] {
            point.fail(bad, "CAM_CLAY: the stress is not finite");
            return false;
        }
        assign(point.stress, (2.0 * last.mu) * end.e);
        add_to_normals(point.stress, 3, Real(-last.p - pore_stress));
        point.elastic_energy = elasticity.energy(last.A, last.s);
        point.plastic_dissipation = end.dissipation;
        if (elasticity.alpha > 0.0 && any(elasticity.convexity(last.A, last.s) <= Real(0.0))) [[unlikely]]
            point.warn("CAM_CLAY: the elastic law has lost convexity, q/p is too high for alpha and mu0 (zone + 10)");

        State<Real>& state = point.state;
        const Real epv = state[cam_clay::EPV] - end.compaction, esp = state[cam_clay::ESP] + end.plastic_shear;
        state.set(cam_clay::INIT, Real(1.0));
        state.set(cam_clay::PC, end.pc);
        for (int i = 0; i < 6; ++i) {
            Real component = Real(0.0);
            if (i < components(kind)) component = end.e[i];
            if (i < 3) component = component - end.v * (1.0 / 3.0);
            state.set(cam_clay::EE + i, component);
        }
        state.set(cam_clay::EPV, epv);
        state.set(cam_clay::ESP, esp);
        state.set(cam_clay::P, last.p);
        state.set(cam_clay::Q, last.q);
        state.set(cam_clay::ZONE, end.zone + select(clipped, Real(10.0), Real(0.0)));
        return true;
    }

    // DDSDDT = -alphaT C 1, and the floor that keeps the host's matrix regular where p has all but vanished.
    template <AnalysisKind kind>
    void complete_tangent(const CamClayStep<double>& last, Tangent<kind>& c) const {
        if (thermal_expansion != 0.0)
            for (int i = 0; i < components(kind); ++i)
                c.thermal_stress[i] = -thermal_expansion * (c(i, 0) + c(i, 1) + c(i, 2));
        if (last.A < 1e-10 * elasticity.p_ref) [[unlikely]]
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) c(i, j) += 1e-10 * elasticity.p_ref * elasticity.inverse_kappa;
    }

    // "Guards": UMAT asks for a smaller increment, VUMAT clips it. False where the increment cannot be done.
    template <AnalysisKind kind, class Real>
    LODE_INLINE bool guard(const Increment<kind, Real>& increment, const CamClayPath<kind, Real>& start, Real& dv,
                           Stress<kind, Real>& de, Mask<Real>& clipped, Point<kind, Real>& point) const {
        Real largest = abs(increment.strain_increment[0]);
        for (int i = 1; i < components(kind); ++i) largest = max(largest, abs(increment.strain_increment[i]));
        // w (v_max - v), linear in the increment
        const Real extension_start = start.log_pc - start.v * elasticity.inverse_kappa;
        const Real extension = extension_start - dv * elasticity.inverse_kappa;
        const Mask<Real> too_long = extension > Real(largest_extension);
        const Mask<Real> too_large = largest > Real(largest_strain) || too_long;
        if (any(too_large)) [[unlikely]] {
            if constexpr (is_batch<Real>) {
                const Real room = positive_part(largest_extension - extension_start);
                Real part = select(largest > Real(largest_strain), largest_strain / largest, Real(1.0));
                part = min(part, select(too_long, room / (extension - extension_start), Real(1.0)));
                dv = select(too_large, part * dv, dv);
                for (int i = 0; i < components(kind); ++i) de[i] = select(too_large, part * de[i], de[i]);
                clipped = too_large;
                point.warn("CAM_CLAY: strain increments above 0.5, or extensions beyond 600 kappa, were clipped");
            } else {
                point.fail(too_large, "CAM_CLAY: the strain increment is above 0.5, or an extension beyond 600 kappa");
                return false;
            }
        }
        const Real v_trial = start.v + dv;
        const Real v_max = (v_trial * plasticity.inverse_theta + start.log_pc) * plasticity.inverse_w;
        const Mask<Real> beyond = !(abs(min(v_trial, v_max)) <= Real(largest_exponent * elasticity.kappa));
        if (any(beyond)) [[unlikely]] {
            point.fail(beyond, "CAM_CLAY: the elastic strain in STATEV is not finite or leaves the range of doubles");
            return false;
        }
        return true;
    }
};

}  // namespace lode
