// The update of ISO_PLASTIC with one hardening law: one step of backward Euler (page 20, section 3) with its tangent.
// The multiplier is written as the increment of equivalent plastic strain, dalpha = sqrt(2/3) |dep|, whose sum alpha is
// the hardening variable: q <= K, dep = (3/2) dalpha s/q.
#pragma once

#include "lode/plasticity/iso_plastic_plane_stress.hpp"

namespace lode::iso_plastic {

template <class Law>
class Kernel : public PlaneStressReturn<Law> {
  public:
    Kernel(const Constants& constants, const Law& hardening) : PlaneStressReturn<Law>(constants, hardening) {}

    using Rules = IncrementRules<Law>;
    using Rules::begin, Rules::balance_of, Rules::finish, Rules::c, Rules::law;

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        Step<kind, Real, Law> step;
        if (!begin(increment, point, step)) return;
        const Real trace_start = trace(point.stress);
        if (!correct(increment, point, step, tangent)) return;
        const Balance<Real> balance = balance_of(step);
        finish(increment, point, step, step.dalpha, balance, trace_start, tangent);
    }

    // Stress at the end of the step, from step.strain, step.alpha and point.stress; the elastic energy, and in plane
    // stress the thickness strain. False where the point is refused.
    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE bool correct(const Increment<kind, Real>& increment, Point<kind, Real>& point,
                             Step<kind, Real, Law>& step, T& tangent) const {
        step.start = law.start(step.at, step.alpha);
        // Entry by entry: a copy of the whole would wait for the stores before it.
        step.end.value = step.start.value, step.end.slope = step.start.slope, step.end.curvature = step.start.curvature;
        step.dalpha = Real(0.0);
        if constexpr (kind == AnalysisKind::plane_stress)
            return this->return_in_plane_stress(increment, point, step, tangent);
        else if constexpr (kind == AnalysisKind::uniaxial) return return_in_tension(increment, point, step, tangent);
        else return return_radially(increment, point, step, tangent);
    }

  private:
    using Rules::has_rate, Rules::heat_per_strain, Rules::heat_slopes, Rules::set_elastic, Rules::set_heat_temperature,
        Rules::set_molten, Rules::shear, Rules::shear_by_temperature, Rules::yielding;

    // Three normal components: the trial deviator shrinks, s = (1 - 3G dalpha/q_trial) s_trial; the pressure is
    // elastic.
    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE bool return_radially(const Increment<kind, Real>& increment, Point<kind, Real>& point,
                                     Step<kind, Real, Law>& step, T& tangent) const {
        constexpr int n = components(kind);
        const auto G = shear(step.at);
        const double K = c.elastic.bulk;
        const Real mean = (1.0 / 3.0) * trace(point.stress) + K * trace(step.strain);
        Stress<kind, Real> s_start = deviator(point.stress), strain = deviator(step.strain);
        const Stress<kind, Real> s_trial = s_start + Real(2.0 * G) * strain;
        const Real q_trial = sqrt(1.5 * double_contraction(s_trial, s_trial));

        Real theta = Real(1.0), inverse_q = Real(0.0), flow = Real(0.0);
        step.yields = yielding(step, q_trial);
        if (!has_rate(point, step)) return false;
        if (any(step.yields)) {
            inverse_q = 1.0 / select(step.yields, max(q_trial, Real(1e-300)), Real(1.0));
            this->template solve<radial>(step, q_trial, point.solves);
            if constexpr (Law::melts)
                if (any(step.at.melted)) [[unlikely]]
                    set_molten(step, q_trial / (3.0 * G), double_contraction(s_start, s_start) / (4.0 * G));
            flow = step.dalpha * inverse_q;
            theta = 1.0 - (3.0 * G) * flow;
            if constexpr (Law::melts) theta = select(step.at.melted, Real(0.0), theta);
        }
        if (step.keeps_plastic_strain)
            for (int i = 0; i < n; ++i) step.plastic_strain[i] = (i < 3 ? 1.5 : 3.0) * flow * s_trial[i];
        for (int i = 0; i < n; ++i) point.stress[i] = i < 3 ? theta * s_trial[i] + mean : theta * s_trial[i];
        point.elastic_energy = deviatoric_energy(step.at, theta * q_trial, mean);

        if constexpr (wants_tangent<T>) {
            if (step.yields) {
                // D = K 1x1 + 2G theta I_dev - 2G theta_bar n x n, n = s_trial/|s_trial| = sqrt(3/2) s_trial/q_trial
                const double share = law.template plastic_share<radial>(step.at, step.end.slope);
                const double theta_bar = share - (1.0 - theta);
                const double along_flow = theta_bar * (3.0 * G * (inverse_q * inverse_q));
                set_isotropic_less_dyad(tangent, K - (2.0 / 3.0) * G * theta, 2.0 * G * theta, along_flow, s_trial);
                const HeatSlopes slopes = heat_slopes(step);
                const double heat = heat_per_strain(increment, slopes) * share * inverse_q;
                for (int i = 0; i < n; ++i) tangent.heat_rate_strain[i] = heat * s_trial[i];
                if constexpr (Law::feels_temperature) {
                    const double G_T = shear_by_temperature(step.at);
                    const double q_T = 3.0 * G_T * inverse_q * double_contraction(s_trial, strain);
                    const double dalpha_T =
                        (q_T - 3.0 * G_T * step.dalpha - slopes.flow_temperature) * share / (3.0 * G);
                    const double along = 3.0 * inverse_q * (G * flow * q_T - G_T * step.dalpha - G * dalpha_T);
                    for (int i = 0; i < n; ++i)
                        tangent.thermal_stress[i] = 2.0 * G_T * theta * strain[i] + along * s_trial[i];
                    set_heat_temperature(increment, slopes, dalpha_T, tangent);
                }
            } else {
                this->template set_elastic<kind>(step.at, tangent);
                if constexpr (Law::changes_shear)
                    for (int i = 0; i < n; ++i)
                        tangent.thermal_stress[i] = 2.0 * shear_by_temperature(step.at) * strain[i];
            }
            if constexpr (Law::feels_temperature)
                for (int i = 0; i < 3; ++i) tangent.thermal_stress[i] -= 3.0 * K * c.thermal_expansion;
        }
        return true;
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE bool return_in_tension(const Increment<kind, Real>& increment, Point<kind, Real>& point,
                                       Step<kind, Real, Law>& step, T& tangent) const {
        const auto E = young(step.at);
        const Real start = point.stress[0], trial = start + E * step.strain[0];
        const Real sign = select(trial < Real(0.0), Real(-1.0), Real(1.0)), q_trial = abs(trial);
        step.yields = yielding(step, q_trial);
        if (!has_rate(point, step)) return false;
        if (any(step.yields)) {
            this->template solve<axial>(step, q_trial, point.solves);
            if constexpr (Law::melts)
                if (any(step.at.melted)) [[unlikely]]
                    set_molten(step, q_trial / E, start * start / (2.0 * E));
        }
        const Real plastic = sign * step.dalpha;
        point.stress[0] = trial - E * plastic;
        if constexpr (Law::melts) point.stress[0] = select(step.at.melted, Real(0.0), point.stress[0]);
        if (step.keeps_plastic_strain) step.plastic_strain = {{plastic, -0.5 * plastic, -0.5 * plastic}};
        if constexpr (Law::changes_shear) point.elastic_energy = point.stress[0] * point.stress[0] / (2.0 * E);
        else point.elastic_energy = c.elastic.energy(point.stress);

        if constexpr (wants_tangent<T>) {
            double E_T = 0.0;
            if constexpr (Law::changes_shear) {
                const double K = c.elastic.bulk;
                E_T = 27.0 * K * K * shear_by_temperature(step.at) / square(3.0 * K + shear(step.at));
            }
            const double elastic_T = E_T * step.strain[0] - E * c.thermal_expansion;
            if (step.yields) {
                const double H = step.end.slope;
                const double share = law.template plastic_share<axial>(step.at, H);
                tangent(0, 0) = H * share;
                const HeatSlopes slopes = heat_slopes(step);
                tangent.heat_rate_strain[0] = heat_per_strain(increment, slopes) * sign * share;
                if constexpr (Law::feels_temperature) {
                    const double dalpha_T =
                        (sign * elastic_T - E_T * step.dalpha - slopes.flow_temperature) * share / E;
                    tangent.thermal_stress[0] = elastic_T - sign * (E_T * step.dalpha + E * dalpha_T);
                    set_heat_temperature(increment, slopes, dalpha_T, tangent);
                }
            } else {
                tangent(0, 0) = E;
                if constexpr (Law::feels_temperature) tangent.thermal_stress[0] = elastic_T;
            }
        }
        return true;
    }

    template <class At>
    LODE_INLINE auto young(const At& at) const {
        if constexpr (Law::changes_shear) {
            const auto G = shear(at);
            return 9.0 * c.elastic.bulk * G / (3.0 * c.elastic.bulk + G);
        } else {
            return c.elastic.young;
        }
    }

    // s:s/(4G) + p^2/(2K)
    template <class At, class Real>
    LODE_INLINE Real deviatoric_energy(const At& at, const Real& q, const Real& mean) const {
        if constexpr (Law::changes_shear) return q * q / (6.0 * shear(at)) + mean * mean * (0.5 / c.elastic.bulk);
        else
            return c.elastic.half_compliance * ((2.0 / 3.0) * (1.0 + c.elastic.poisson) * (q * q) +
                                                3.0 * (1.0 - 2.0 * c.elastic.poisson) * (mean * mean));
    }
};

}  // namespace lode::iso_plastic
