// The return of ISO_PLASTIC in plane stress (page 20, section 3): sigma33 = 0, one scalar equation.
#pragma once

#include "lode/plasticity/iso_plastic_increment.hpp"

namespace lode::iso_plastic {

// A = E/(3(1 - nu)), rho = 2G/A.
template <class Number>
struct PlaneStressElasticity {
    Number shear, inverse_A, rho;
    Number sum_stiffness;       // E/(1 - nu)
    Number lateral_compliance;  // nu/E
    Number half_compliance, poisson;

    explicit PlaneStressElasticity(const IsotropicModuli& e)
        : shear(e.shear),
          inverse_A(3.0 * (1.0 - e.poisson) / e.young),
          rho(2.0 * e.shear * inverse_A),
          sum_stiffness(e.young / (1.0 - e.poisson)),
          lateral_compliance(e.poisson / e.young),
          half_compliance(e.half_compliance),
          poisson(e.poisson) {}
    PlaneStressElasticity(double K, const Number& G) : shear(G) {
        const Number E = 9.0 * K * G / (3.0 * K + G);
        poisson = (3.0 * K - 2.0 * G) / (2.0 * (3.0 * K + G));
        inverse_A = 3.0 * (1.0 - poisson) / E;
        rho = 2.0 * G * inverse_A;
        sum_stiffness = E / (1.0 - poisson);
        lateral_compliance = poisson / E;
        half_compliance = 0.5 / E;
    }
};

template <class Law>
class PlaneStressReturn : public IncrementRules<Law> {
  public:
    PlaneStressReturn(const Constants& constants, const Law& hardening)
        : IncrementRules<Law>(constants, hardening), plane(constants.elastic) {}

  protected:
    using Rules = IncrementRules<Law>;
    using Rules::c, Rules::law, Rules::shear, Rules::has_rate, Rules::heat_per_strain, Rules::heat_slopes,
        Rules::set_elastic, Rules::set_heat_temperature, Rules::set_molten, Rules::set_return,
        Rules::shear_by_temperature, Rules::yielding;

    // sigma33 = 0. The multiplier mu (dep = mu s) is replaced by t = 1/(1 + A mu), which stays in [0, 1]; laws that
    // feel the rate take ln(1 - t), in which the logarithm of dalpha is nearly straight.
    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE bool return_in_plane_stress(const Increment<kind, Real>& increment, Point<kind, Real>& point,
                                            Step<kind, Real, Law>& step, T& tangent) const {
        const auto e = plane_stress(step.at);
        const Stress<kind, Real> start = point.stress;
        const Real de_sum = step.strain[0] + step.strain[1], de_difference = step.strain[1] - step.strain[0];
        const Real S = start[0] + start[1] + e.sum_stiffness * de_sum;
        const Real D = start[1] - start[0] + 2.0 * e.shear * de_difference;
        const Real tau = start[2] + e.shear * step.strain[2];
        const Real sum = 0.25 * (S * S), shear_part = 0.75 * (D * D) + 3.0 * (tau * tau);
        const Real q_trial = sqrt(sum + shear_part);

        Real t = Real(1.0), b = Real(1.0);
        for (int i = 0; i < 4; ++i) step.plastic_strain[i] = Real(0.0);
        point.stress[0] = 0.5 * (S - D), point.stress[1] = 0.5 * (S + D), point.stress[2] = tau;
        step.yields = yielding(step, q_trial);
        if (!has_rate(point, step)) return false;
        if (any(step.yields)) {
            t = solve_in_plane_stress(step, e, sum, shear_part, q_trial, point.solves);
            if constexpr (Law::melts)
                if (any(step.at.melted)) [[unlikely]] {
                    set_molten(step, q_trial / (3.0 * e.shear), stored_energy(e, start));
                    t = select(step.at.melted, Real(0.0), t);
                }
            b = t + e.rho * (1.0 - t);
            // mu = (1 - t)/(A t), 1 + 2G mu = b/t: the stress over t stays finite when the yield stress falls to zero.
            const Real inverse_b = 1.0 / b, D_over_t = D * inverse_b, tau_over_t = tau * inverse_b;
            point.stress[0] = select(step.yields, 0.5 * t * (S - D_over_t), point.stress[0]);
            point.stress[1] = select(step.yields, 0.5 * t * (S + D_over_t), point.stress[1]);
            point.stress[2] = select(step.yields, t * tau_over_t, point.stress[2]);
            const Real mu_t = e.inverse_A * (1.0 - t);
            step.plastic_strain[0] = (1.0 / 6.0) * mu_t * (S - 3.0 * D_over_t);
            step.plastic_strain[1] = (1.0 / 6.0) * mu_t * (S + 3.0 * D_over_t);
            step.plastic_strain[2] = Real(0.0) - (step.plastic_strain[0] + step.plastic_strain[1]);
            step.plastic_strain[3] = 2.0 * mu_t * tau_over_t;
        }
        point.elastic_energy = stored_energy(e, point.stress);
        point.thickness_strain_increment =
            e.lateral_compliance * (trace(start) - trace(point.stress)) + step.plastic_strain[2];

        if constexpr (wants_tangent<T>) {
            const auto strain_change = Vector<double, 3>{{de_sum, de_difference, step.strain[2]}};
            if (step.yields) set_plane_stress_tangent(increment, point.stress, step, e, t, b, strain_change, tangent);
            else {
                this->template set_elastic<kind>(step.at, tangent);
                if constexpr (Law::feels_temperature)
                    set_from_modes(temperature_modes(step.at, e, strain_change, {{0.0, 0.0, 0.0}}, 0.0),
                                   tangent.thermal_stress);
            }
        }
        return true;
    }

  private:
    PlaneStressElasticity<double> plane;

    template <class At>
    LODE_INLINE auto plane_stress(const At& at) const {
        if constexpr (Law::changes_shear) {
            const auto G = shear(at);
            return PlaneStressElasticity<std::decay_t<decltype(G)>>(c.elastic.bulk, G);
        } else {
            return plane;
        }
    }

    template <AnalysisKind kind, class Real, class E>
    LODE_INLINE Real solve_in_plane_stress(Step<kind, Real, Law>& step, const E& e, const Real& sum,
                                           const Real& shear_part, const Real& q_trial,
                                           const SolveCounter<Real>& solves) const {
        Mask<Real> solid = step.yields;
        if constexpr (Law::melts) solid = solid && !step.at.melted;
        const auto rho = e.rho;
        const auto A_factor = (2.0 / 3.0) * e.inverse_A;
        // As a function of 1 - t. Everything by value: a reference would keep the point in memory.
        const auto residual = [sum, shear_part, rho, A_factor, alpha = step.alpha, at = step.at,
                               hardening = law](const Real& gone) {
            // Q = sqrt(S^2/4 + shear/b^2) with its two derivatives at the price of one root and one division.
            const Real x = 1.0 - gone, b_x = x + rho * gone;
            const Real Q_b = sqrt(sum * (b_x * b_x) + shear_part);
            const Real inverse = 1.0 / (b_x * Q_b), inverse_b = inverse * Q_b;
            const Real Q = Q_b * inverse_b, w = (rho - 1.0) * shear_part * inverse_b * inverse;
            const Real Q_slope = w, Q_bend = 3.0 * (rho - 1.0) * w * inverse_b - w * w * (b_x * b_x) * inverse;
            const Real dalpha = A_factor * gone * Q;
            const Real dalpha_slope = A_factor * (gone * Q_slope - Q);
            const Real dalpha_bend = A_factor * (gone * Q_bend - 2.0 * Q_slope);
            const FlowStress<Real> k = hardening.flow(at, alpha, dalpha);
            // Derivatives by t.
            return ReturnTrial<Real>{
                x * Q - k.value, Q + x * Q_slope - k.slope * dalpha_slope,
                2.0 * Q_slope + x * Q_bend - k.slope * dalpha_bend - k.curvature * (dalpha_slope * dalpha_slope),
                dalpha, k};
        };
        const Real tolerance = return_tolerance * q_trial;
        const Real start = select(solid, step.start.value / q_trial, Real(1.0));
        if constexpr (Law::feels_rate) {
            // t = 1 - exp(y)
            const auto in_logarithm = [residual](const Real& y) {
                const Real gone = quick_exp(y);
                auto r = residual(gone);
                r.curvature = gone * (gone * r.curvature - r.slope);
                r.slope = Real(0.0) - gone * r.slope;
                return r;
            };
            const Real first = quick_log(max(1.0 - start, Real(1e-12)));
            // Where the stress at the smallest multiplier is below K the point hardly flows.
            const Real lowest(-690.0);
            const Mask<Real> flows = solid && in_logarithm(lowest).value > Real(0.0);
            const auto root =
                solve_bracketed<Slope::decreasing>(in_logarithm, lowest, Real(0.0), first, tolerance, flows);
            solves.count(root);
            set_return(step, {root.last.dalpha, root.last.flow}, flows);
            step.yields = step.yields && (flows || !solid);
            return select(flows, 1.0 - quick_exp(root.x), Real(1.0));
        } else {
            const auto of_t = [residual](const Real& x) { return residual(1.0 - x); };
            const auto root = solve_bracketed<Slope::increasing>(of_t, Real(0.0), Real(1.0), start, tolerance, solid);
            solves.count(root);
            set_return(step, {root.last.dalpha, root.last.flow}, solid);
            return select(solid, root.x, Real(1.0));
        }
    }

    // In the modes 11 + 22, 22 - 11, 12 of plane stress: the stress by temperature, times 1 + 2G mu or 1 + A mu, at
    // constant multiplier: -C a + C_T (de - mu P sigma).
    template <class At, class E>
    LODE_INLINE Vector<double, 3> temperature_modes(const At& at, const E& e, const Vector<double, 3>& de,
                                                    const Vector<double, 3>& P_sigma, double mu) const {
        Vector<double, 3> v{{-2.0 * c.thermal_expansion * e.sum_stiffness, 0.0, 0.0}};
        if constexpr (Law::changes_shear) {
            const double G_T = shear_by_temperature(at), K = c.elastic.bulk;
            const double sum_by_shear = 54.0 * K * K / square(3.0 * K + 4.0 * e.shear);
            v[0] += sum_by_shear * G_T * (de[0] - mu * P_sigma[0]);
            v[1] += 2.0 * G_T * (de[1] - mu * P_sigma[1]);
            v[2] += G_T * (de[2] - mu * P_sigma[2]);
        }
        return v;
    }

    LODE_INLINE static void set_from_modes(const Vector<double, 3>& v, double* stress) {
        stress[0] = 0.5 * (v[0] - v[1]);
        stress[1] = 0.5 * (v[0] + v[1]);
        stress[2] = v[2];
    }

    template <AnalysisKind kind, class E>
    LODE_INLINE void set_plane_stress_tangent(const Increment<kind, double>& increment, const Stress<kind, double>& s,
                                              const Step<kind, double, Law>& step, const E& e, double t, double b,
                                              const Vector<double, 3>& de, Tangent<kind>& tangent) const {
        // D = Xi - radial N x N/(radial P sigma : N + (2/3) q^2 H), Xi = (C^-1 + mu P)^-1, N = Xi P sigma
        const double H = step.end.slope;
        const double mu = e.inverse_A * (1.0 - t) / max(t, 1e-300);
        const double xi_sum = t * e.sum_stiffness, xi_difference = 2.0 * e.shear * t / b;
        const double xi_coupling = 0.5 * (xi_sum - xi_difference), xi_normal = xi_coupling + xi_difference;
        const Stress<kind, double> P_sigma{
            {(1.0 / 3.0) * (2.0 * s[0] - s[1]), (1.0 / 3.0) * (2.0 * s[1] - s[0]), 2.0 * s[2]}};
        const Stress<kind, double> N{{xi_normal * P_sigma[0] + xi_coupling * P_sigma[1],
                                      xi_coupling * P_sigma[0] + xi_normal * P_sigma[1],
                                      0.5 * xi_difference * P_sigma[2]}};
        const auto along = [](const auto& a, const auto& v) { return a[0] * v[0] + a[1] * v[1] + a[2] * v[2]; };
        const double P_sigma_N = along(P_sigma, N);
        const double q_squared = s[0] * s[0] + s[1] * s[1] - s[0] * s[1] + 3.0 * s[2] * s[2];
        const double radial_part = 1.5 * (1.0 - (2.0 / 3.0) * mu * H);
        const double denominator = radial_part * P_sigma_N + (2.0 / 3.0) * q_squared * H;
        const double inverse = denominator > 0.0 ? 1.0 / denominator : 0.0;
        const double factor = radial_part * inverse;
        set_isotropic_less_dyad(tangent, xi_coupling, xi_difference, factor, N);
        // dalpha = (2/3) mu q: d(dalpha) = (2/3)(q dmu + mu dq), dmu = q factor N, dq = (3/(2q)) P sigma D, and
        // P sigma D = (1 - factor P sigma : N) N
        const double q = sqrt(q_squared), inverse_q = q > 0.0 ? 1.0 / q : 0.0;
        const HeatSlopes slopes = heat_slopes(step);
        const double heat = heat_per_strain(increment, slopes) *
                            ((2.0 / 3.0) * q * factor + mu * inverse_q * (1.0 - factor * P_sigma_N));
        for (int j = 0; j < 3; ++j) tangent.heat_rate_strain[j] = heat * N[j];
        if constexpr (Law::feels_temperature) {
            Vector<double, 3> modes =
                temperature_modes(step.at, e, de, {{P_sigma[0] + P_sigma[1], P_sigma[1] - P_sigma[0], P_sigma[2]}}, mu);
            modes[0] *= t;
            modes[1] *= t / b;
            modes[2] *= t / b;
            double change[3];
            set_from_modes(modes, change);
            const double mu_T = (radial_part * along(P_sigma, change) - q * slopes.flow_temperature) * inverse;
            for (int i = 0; i < 3; ++i) tangent.thermal_stress[i] = change[i] - mu_T * N[i];
            const double q_T = 1.5 * inverse_q * along(P_sigma, tangent.thermal_stress);
            set_heat_temperature(increment, slopes, (2.0 / 3.0) * (q * mu_T + mu * q_T), tangent);
        }
    }

    // sigma:C^-1:sigma/2 in plane stress
    template <class E, AnalysisKind kind, class Real>
    LODE_INLINE static Real stored_energy(const E& e, const Stress<kind, Real>& s) {
        const Real sum = trace(s);
        return e.half_compliance * ((1.0 + e.poisson) * double_contraction(s, s) - e.poisson * (sum * sum));
    }
};

}  // namespace lode::iso_plastic
