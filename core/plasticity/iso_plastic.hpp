// ISO_PLASTIC: von Mises plasticity with isotropic hardening (page 20, section 3; Nairn, eqs. 2.14-2.64, 2.125).
// One backward Euler step. The multiplier is written as the increment of equivalent plastic strain,
// dalpha = sqrt(2/3) |dep|, whose sum alpha is the hardening variable: q <= K(alpha), dep = (3/2) dalpha s/q.
#pragma once

#include "lode/elastic/isotropic_moduli.hpp"
#include "lode/plasticity/hardening_law.hpp"
#include "lode/plasticity/iso_plastic_description.hpp"

namespace lode {

struct IsoPlastic {
    static constexpr const lode_model& description = iso_plastic::description;

    explicit IsoPlastic(const Properties& p)
        : elastic(IsotropicModuli::from_young_poisson(p[iso_plastic::E], p[iso_plastic::NU])),
          hardening(p, p[iso_plastic::SIGY], iso_plastic::HLAW, iso_plastic::H1),
          thermal_expansion(p[iso_plastic::ALPHA]),
          moisture_expansion(p[iso_plastic::BETA]),
          absolute_zero_offset(p[iso_plastic::TABS]),
          heat_capacity(p[iso_plastic::RHOCV]),
          heat_fraction(p[iso_plastic::CHI]),
          reference_length(p[iso_plastic::LREF]) {
        if (heat_fraction < 0.0 && heat_fraction != -1.0) p.refuse(iso_plastic::CHI, "-1, 0 or in (0, 1]");
        if (hardening.is_softening() && reference_length <= 0.0)
            p.refuse(iso_plastic::LREF, "> 0: a softening law needs it");
        if (hardening.is_softening() && heat_fraction == 0.0) heat_fraction = 1.0;  // no stored energy is released
    }

    int required_state(AnalysisKind) const { return 4; }

    template <AnalysisKind kind>
    void initial_stiffness(const Stress<kind, double>&, const State<double>&, Tangent<kind>& c) const {
        elastic.set_stiffness<kind>(c);
    }

    // Calls f with the kernel of the hardening law at hand.
    template <class F>
    LODE_INLINE void specialise(const F& f) const {
        hardening.visit([&](const auto& law) __attribute__((always_inline)) { f(WithLaw{*this, law}); });
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        hardening.visit([&](const auto& law)
                            __attribute__((always_inline)) { update_with(law, increment, point, tangent); });
    }

    IsotropicModuli elastic;
    HardeningLaw hardening;
    double thermal_expansion, moisture_expansion;
    double absolute_zero_offset, heat_capacity, heat_fraction;
    double reference_length;

  private:
    template <class Law>
    struct WithLaw {
        const IsoPlastic& model;
        Law law;

        template <AnalysisKind kind, class Real, class T>
        LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
            model.update_with(law, increment, point, tangent);
        }
    };
    template <class Law>
    WithLaw(const IsoPlastic&, const Law&) -> WithLaw<Law>;

    // Plastic strain has engineering shears; plane stress keeps the thickness component too.
    template <AnalysisKind kind>
    static constexpr int plastic_components = kind == AnalysisKind::solid      ? 6
                                              : kind == AnalysisKind::uniaxial ? 3
                                                                               : 4;

    template <AnalysisKind kind, class Real>
    struct Step {
        Strain<kind, Real> strain;  // mechanical part of DSTRAN
        Real alpha, yield_stress;   // at the start
        Real scale = Real(1.0);     // h/LREF of a softening law
        Mask<Real> yields = Mask<Real>(false);
        Real dalpha = Real(0.0);
        Vector<Real, plastic_components<kind>> plastic_strain;  // its increment

        Step() {
            for (Real& x : plastic_strain.v) x = Real(0.0);
        }
        // h/LREF times x under a softening law.
        template <class Law>
        Real scaled(const Law&, const Real& x) const {
            return Law::softens ? scale * x : x;
        }
    };

    template <class Law, AnalysisKind kind, class Real, class T>
    LODE_INLINE void update_with(const Law& law, const Increment<kind, Real>& increment, Point<kind, Real>& point,
                                 T& tangent) const {
        Step<kind, Real> step;
        step.strain = mechanical_strain(increment);
        step.alpha = point.state[iso_plastic::EQPS];
        if constexpr (Law::softens)
            if (!regularise(law, increment, point, step)) return;
        step.yield_stress = law.flow_stress(step.scaled(law, step.alpha));

        if constexpr (kind == AnalysisKind::plane_stress) return_in_plane_stress(law, point, step, tangent);
        else if constexpr (kind == AnalysisKind::uniaxial) return_in_tension(law, point, step, tangent);
        else return_radially(law, point, step, tangent);

        if constexpr (wants_tangent<T>) set_thermal_tangent(law, increment, step, tangent);
        store_state(law, increment, point, step);
    }

    // Three normal components: the trial deviator shrinks, s = (1 - 3G dalpha/q_trial) s_trial; the pressure is
    // elastic.
    template <class Law, AnalysisKind kind, class Real, class T>
    LODE_INLINE void return_radially(const Law& law, Point<kind, Real>& point, Step<kind, Real>& step,
                                     T& tangent) const {
        constexpr int n = components(kind);
        const double G = elastic.shear, K = elastic.bulk;
        const Real mean = (1.0 / 3.0) * trace(point.stress) + K * trace(step.strain);
        const Stress<kind, Real> s_trial = deviator(point.stress) + Real(2.0 * G) * deviator(step.strain);
        const Real q_trial = sqrt(1.5 * double_contraction(s_trial, s_trial));

        Real theta = Real(1.0), inverse_q = Real(0.0);
        step.yields = exceeds(q_trial, step.yield_stress);
        if (any(step.yields)) {
            inverse_q = 1.0 / select(step.yields, q_trial, Real(1.0));
            step.dalpha =
                return_to_yield(law, q_trial, 3.0 * G, step.alpha, step.scale, step.yield_stress, step.yields);
            const Real ratio = step.dalpha * inverse_q;
            theta = 1.0 - (3.0 * G) * ratio;
            for (int i = 0; i < n; ++i) step.plastic_strain[i] = (i < 3 ? 1.5 : 3.0) * ratio * s_trial[i];
        }
        for (int i = 0; i < n; ++i) point.stress[i] = i < 3 ? theta * s_trial[i] + mean : theta * s_trial[i];
        const Real q = theta * q_trial;
        // q^2/(6G) + mean^2/(2K)
        point.elastic_energy = elastic.half_compliance * ((2.0 / 3.0) * (1.0 + elastic.poisson) * (q * q) +
                                                          3.0 * (1.0 - 2.0 * elastic.poisson) * (mean * mean));

        if constexpr (wants_tangent<T>) {
            if (!step.yields) return elastic.set_stiffness<kind>(tangent);
            // D = K 1x1 + 2G theta I_dev - 2G theta_bar n x n, n = s_trial/|s_trial| = sqrt(3/2) s_trial/q_trial
            const double ratio_3G = 3.0 * G / (3.0 * G + hardening_modulus(law, step));
            const double theta_bar = ratio_3G - (1.0 - theta);
            const double along_flow = 3.0 * G * theta_bar * inverse_q * inverse_q;
            const double coupling = K - (2.0 / 3.0) * G * theta;
            for (int j = 0; j < n; ++j) {
                const double column = along_flow * s_trial[j];
                for (int i = 0; i < n; ++i) tangent(i, j) = (i < 3 && j < 3 ? coupling : 0.0) - column * s_trial[i];
                tangent(j, j) += (j < 3 ? 2.0 : 1.0) * G * theta;
            }
            for (int i = 0; i < n; ++i) tangent.heat_rate_strain[i] = ratio_3G * inverse_q * s_trial[i];
        }
    }

    // sigma33 = 0. The multiplier mu (dep = mu s) is replaced by t = 1/(1 + A mu), which stays in [0, 1].
    template <class Law, class Real, class T>
    LODE_INLINE void return_in_plane_stress(const Law& law, Point<AnalysisKind::plane_stress, Real>& point,
                                            Step<AnalysisKind::plane_stress, Real>& step, T& tangent) const {
        const double G = elastic.shear, nu = elastic.poisson;
        const double A = elastic.young / (3.0 * (1.0 - nu)), rho = 2.0 * G / A;
        const Real start_sum = trace(point.stress);
        const auto trial = point.stress + elastic.stress<AnalysisKind::plane_stress>(step.strain);
        const Real S = trial[0] + trial[1], D = trial[1] - trial[0], tau = trial[2];
        const Real sum = 0.25 * (S * S), shear = 0.75 * (D * D) + 3.0 * (tau * tau);
        const Real q_trial = sqrt(sum + shear);

        Real t = Real(1.0), b = Real(1.0);
        point.stress = trial;
        step.yields = exceeds(q_trial, step.yield_stress);
        if (any(step.yields)) {
            const auto residual = [&](const Real& x) {
                const Real b_x = x + rho * (1.0 - x);
                const Real Q = sqrt(sum + shear / (b_x * b_x));
                const Real Q_slope = (rho - 1.0) * shear / (b_x * b_x * b_x * Q);
                const Real dalpha = (2.0 / 3.0 / A) * (1.0 - x) * Q;
                const Real dalpha_slope = (2.0 / 3.0 / A) * ((1.0 - x) * Q_slope - Q);
                const Real total = step.scaled(law, step.alpha + dalpha);
                return Residual<Real>{x * Q - law.flow_stress(total),
                                      Q + x * Q_slope - step.scaled(law, law.slope(total)) * dalpha_slope};
            };
            const Real start = select(step.yields, step.yield_stress / q_trial, Real(1.0));
            const Real tolerance = yield_tolerance * q_trial;
            t = solve_bracketed<Slope::increasing>(residual, Real(0.0), Real(1.0), start, tolerance, step.yields).x;
            b = t + rho * (1.0 - t);
            step.dalpha = (2.0 / 3.0 / A) * (1.0 - t) * sqrt(sum + shear / (b * b));
            // mu = (1 - t)/(A t), 1 + 2G mu = b/t: the stress over t stays finite when the yield stress falls to zero.
            const Real D_over_t = D / b, tau_over_t = tau / b;
            point.stress[0] = 0.5 * t * (S - D_over_t);
            point.stress[1] = 0.5 * t * (S + D_over_t);
            point.stress[2] = t * tau_over_t;
            const Real mu_t = (1.0 / A) * (1.0 - t);
            step.plastic_strain[0] = (1.0 / 6.0) * mu_t * (S - 3.0 * D_over_t);
            step.plastic_strain[1] = (1.0 / 6.0) * mu_t * (S + 3.0 * D_over_t);
            step.plastic_strain[2] = Real(0.0) - (step.plastic_strain[0] + step.plastic_strain[1]);
            step.plastic_strain[3] = 2.0 * mu_t * tau_over_t;
        }
        point.elastic_energy = elastic.energy(point.stress);
        point.thickness_strain_increment =
            (nu / elastic.young) * (start_sum - trace(point.stress)) + step.plastic_strain[2];

        if constexpr (wants_tangent<T>) {
            if (!step.yields) return elastic.set_stiffness<AnalysisKind::plane_stress>(tangent);
            // D = Xi - c N x N/(c P sigma : N + (2/3) q^2 H), Xi = (C^-1 + mu P)^-1, N = Xi P sigma
            const double H = hardening_modulus(law, step);
            const double mu = (1.0 - t) / (A * max(t, 1e-300));
            const double xi_sum = t * elastic.young / (1.0 - nu), xi_difference = 2.0 * G * t / b;
            const double xi_normal = 0.5 * (xi_sum + xi_difference), xi_coupling = 0.5 * (xi_sum - xi_difference);
            const auto& s = point.stress;
            const double P_sigma[3] = {(2.0 * s[0] - s[1]) / 3.0, (2.0 * s[1] - s[0]) / 3.0, 2.0 * s[2]};
            const double N[3] = {xi_normal * P_sigma[0] + xi_coupling * P_sigma[1],
                                 xi_coupling * P_sigma[0] + xi_normal * P_sigma[1], 0.5 * xi_difference * P_sigma[2]};
            const double P_sigma_N = P_sigma[0] * N[0] + P_sigma[1] * N[1] + P_sigma[2] * N[2];
            const double q_squared = s[0] * s[0] + s[1] * s[1] - s[0] * s[1] + 3.0 * s[2] * s[2];
            const double c = 1.5 * (1.0 - (2.0 / 3.0) * mu * H);
            const double denominator = c * P_sigma_N + (2.0 / 3.0) * q_squared * H;
            const double factor = denominator > 0.0 ? c / denominator : 0.0;
            elastic.set_stiffness<AnalysisKind::plane_stress>(tangent);
            tangent(0, 0) = tangent(1, 1) = xi_normal;
            tangent(0, 1) = tangent(1, 0) = xi_coupling;
            tangent(2, 2) = 0.5 * xi_difference;
            for (int j = 0; j < 3; ++j)
                for (int i = 0; i < 3; ++i) tangent(i, j) -= factor * N[i] * N[j];
            // dalpha = (2/3) mu q: d(dalpha) = (2/3)(q dmu + mu dq), dmu = q factor N, dq = (3/(2q)) P sigma D
            const double q = sqrt(q_squared), inverse_q = q > 0.0 ? 1.0 / q : 0.0;
            for (int j = 0; j < 3; ++j) {
                const double P_sigma_D =
                    P_sigma[0] * tangent(0, j) + P_sigma[1] * tangent(1, j) + P_sigma[2] * tangent(2, j);
                tangent.heat_rate_strain[j] = (2.0 / 3.0) * q * factor * N[j] + mu * inverse_q * P_sigma_D;
            }
        }
    }

    template <class Law, class Real, class T>
    LODE_INLINE void return_in_tension(const Law& law, Point<AnalysisKind::uniaxial, Real>& point,
                                       Step<AnalysisKind::uniaxial, Real>& step, T& tangent) const {
        const double E = elastic.young;
        const Real trial = point.stress[0] + E * step.strain[0];
        const Real sign = select(trial < Real(0.0), Real(-1.0), Real(1.0));
        step.yields = exceeds(abs(trial), step.yield_stress);
        if (any(step.yields)) {
            step.dalpha = return_to_yield(law, abs(trial), E, step.alpha, step.scale, step.yield_stress, step.yields);
            step.plastic_strain[0] = sign * step.dalpha;
            step.plastic_strain[1] = step.plastic_strain[2] = -0.5 * step.plastic_strain[0];
        }
        point.stress[0] = trial - E * step.plastic_strain[0];
        point.elastic_energy = elastic.energy(point.stress);

        if constexpr (wants_tangent<T>) {
            if (!step.yields) return elastic.set_stiffness<AnalysisKind::uniaxial>(tangent);
            const double H = hardening_modulus(law, step);
            tangent(0, 0) = E * H / (E + H);
            tangent.heat_rate_strain[0] = sign * E / (E + H);
        }
    }

    // q <= K with the relative tolerance of section 1.
    template <class Real>
    static Mask<Real> exceeds(const Real& q_trial, const Real& yield_stress) {
        return q_trial - yield_stress > yield_tolerance * max(q_trial, yield_stress);
    }

    // dK/dalpha at the end.
    template <class Law, AnalysisKind kind>
    static double hardening_modulus(const Law& law, const Step<kind, double>& step) {
        return step.scaled(law, law.slope(step.scaled(law, step.alpha + step.dalpha)));
    }

    template <AnalysisKind kind, class Real>
    Strain<kind, Real> mechanical_strain(const Increment<kind, Real>& increment) const {
        Strain<kind, Real> strain = increment.strain_increment;
        if (thermal_expansion != 0.0)
            add_to_normals(strain, normal_components(kind), -thermal_expansion * increment.temperature_increment());
        if (moisture_expansion != 0.0)
            add_to_normals(strain, normal_components(kind), -moisture_expansion * increment.field_increment(1));
        return strain;
    }

    // Softening dissipates the energy of an element of size LREF whatever the element size h, as long as the law is not
    // steeper than the elastic unloading of the point.
    template <class Law, AnalysisKind kind, class Real>
    bool regularise(const Law& law, const Increment<kind, Real>& increment, Point<kind, Real>& point,
                    Step<kind, Real>& step) const {
        const Real h = increment.element_length();
        const auto unknown = !(h > Real(0.0)) || !is_finite(h);
        if (any(unknown)) {
            point.refuse(unknown, "softening needs the element size CELENT, which", h, "> 0");
            return false;
        }
        constexpr bool is_plane = kind == AnalysisKind::plane_stress;
        const double unloading = is_plane                         ? elastic.young / (2.0 * (1.0 - elastic.poisson))
                                 : kind == AnalysisKind::uniaxial ? elastic.young
                                                                  : 3.0 * elastic.shear;
        const double h_max = unloading * reference_length / -law.steepest_slope();
        const auto too_large = h >= Real(h_max);
        if (any(too_large)) {
            point.refuse(too_large, "element size h exceeds h_max: h", h, "<", Real(h_max));
            return false;
        }
        step.scale = h * (1.0 / reference_length);
        return true;
    }

    // heat_rate_strain holds d(dalpha)/d(strain) on entry. The flow stress of these laws does not depend on
    // temperature, which acts through the thermal strain alone.
    template <class Law, AnalysisKind kind>
    LODE_INLINE void set_thermal_tangent(const Law& law, const Increment<kind, double>& increment,
                                         const Step<kind, double>& step, Tangent<kind>& tangent) const {
        if (step.yields) {
            const double rate = increment.time_increment > 0.0 ? 1.0 / increment.time_increment : 0.0;
            const double heat_slope = heat_per_plastic_strain(law, step) * rate;
            for (int i = 0; i < components(kind); ++i) tangent.heat_rate_strain[i] *= heat_slope;
            tangent.heat_rate = plastic_heat(step, plastic_work(law, step)) * rate;
        }
        if (thermal_expansion == 0.0) return;
        for (int j = 0; j < normal_components(kind); ++j) {
            for (int i = 0; i < components(kind); ++i) tangent.thermal_stress[i] -= thermal_expansion * tangent(i, j);
            tangent.heat_rate_temperature -= thermal_expansion * tangent.heat_rate_strain[j];
        }
    }

    // Plastic work of the increment: the exact integral of K dalpha.
    template <class Law, AnalysisKind kind, class Real>
    Real plastic_work(const Law& law, const Step<kind, Real>& step) const {
        if constexpr (std::is_same_v<Law, LinearHardening>) {
            return step.dalpha * (step.yield_stress + 0.5 * law.modulus * step.dalpha);
        } else {
            const Real start = step.scaled(law, step.alpha), end = step.scaled(law, step.alpha + step.dalpha);
            Real stored = law.stored_energy(end) - law.stored_energy(start);
            if constexpr (Law::softens) stored = stored / step.scale;
            return hardening.initial_yield() * step.dalpha + stored;
        }
    }
    // Its part that becomes heat (page 25, section 3), and the derivative of that part by dalpha.
    template <AnalysisKind kind, class Real>
    Real plastic_heat(const Step<kind, Real>& step, const Real& work) const {
        if (heat_fraction == 0.0) return hardening.initial_yield() * step.dalpha;
        return heat_fraction < 0.0 ? Real(0.0) : heat_fraction * work;
    }
    template <class Law, AnalysisKind kind>
    double heat_per_plastic_strain(const Law& law, const Step<kind, double>& step) const {
        if (heat_fraction == 0.0) return hardening.initial_yield();
        if (heat_fraction < 0.0) return 0.0;
        return heat_fraction * law.flow_stress(step.scaled(law, step.alpha + step.dalpha));
    }

    template <class Law, AnalysisKind kind, class Real>
    LODE_INLINE void store_state(const Law& law, const Increment<kind, Real>& increment, Point<kind, Real>& point,
                                 const Step<kind, Real>& step) const {
        auto& state = point.state;
        const double dt = increment.time_increment;
        const Real alpha = step.alpha + step.dalpha;
        if (thermal_expansion != 0.0 || moisture_expansion != 0.0) add_free_strain(increment, point);
        point.plastic_dissipation = plastic_work(law, step);
        if (state.has(iso_plastic::ENTR)) store_heat(increment, point, step);
        if (state.has(iso_plastic::EP + 5)) store_plastic_strain(increment, point, step);
        state.set(iso_plastic::EQPS, alpha);
        state.set(iso_plastic::RATE, dt > 0.0 ? step.dalpha * (1.0 / dt) : Real(0.0));
        state.set(iso_plastic::FLOW, law.flow_stress(step.scaled(law, alpha)));
        state.set(iso_plastic::YT, Real(0.0));
    }

    template <AnalysisKind kind, class Real>
    void add_free_strain(const Increment<kind, Real>& increment, Point<kind, Real>& point) const {
        if constexpr (kind == AnalysisKind::plane_stress)
            point.thickness_strain_increment =
                point.thickness_strain_increment + increment.strain_increment[0] - mechanical_strain(increment)[0];
    }

    template <AnalysisKind kind, class Real>
    void store_heat(const Increment<kind, Real>& increment, Point<kind, Real>& point,
                    const Step<kind, Real>& step) const {
        using namespace iso_plastic;
        auto& state = point.state;
        const Real heat = plastic_heat(step, point.plastic_dissipation);
        const Real received = heat_capacity * increment.temperature_increment() - heat;
        const Real temperature = increment.temperature_end() + absolute_zero_offset;
        const auto absolute = temperature > Real(0.0);
        const Real entropy = select(absolute, (received + heat) / select(absolute, temperature, Real(1.0)), Real(0.0));
        const Real stored = state[ASTOR] + (point.plastic_dissipation - heat), turned = state[PHI] + heat;
        const Real total_received = state[HEATQ] + received, total_entropy = state[ENTR] + entropy;
        state.set(TAD, Real(0.0));
        state.set(DTAD, Real(0.0));
        state.set(ASTOR, stored);
        state.set(PHI, turned);
        state.set(HEATQ, total_received);
        state.set(ENTR, total_entropy);
    }

    template <AnalysisKind kind, class Real>
    void store_plastic_strain(const Increment<kind, Real>& increment, Point<kind, Real>& point,
                              const Step<kind, Real>& step) const {
        constexpr int n = plastic_components<kind>;
        constexpr auto layout = kind == AnalysisKind::solid ? AnalysisKind::solid : AnalysisKind::plane_strain;
        Vector<Real, n> total;
        for (int i = 0; i < n; ++i) total[i] = point.state[iso_plastic::EP + i];
        if constexpr (kind != AnalysisKind::uniaxial) {
            if (increment.has_rotation()) {
                Strain<layout, Real> strain;
                for (int i = 0; i < n; ++i) strain[i] = total[i];
                strain = rotate(strain, increment.rotation());
                for (int i = 0; i < n; ++i) total[i] = strain[i];
            }
        }
        for (int i = 0; i < n; ++i) point.state.set(iso_plastic::EP + i, total[i] + step.plastic_strain[i]);
    }
};

}  // namespace lode
