// ISO_PLASTIC: von Mises plasticity with isotropic hardening (page 20, section 3; Nairn, eqs. 2.14-2.64, 2.125).
// One backward Euler step. The multiplier is written as the increment of equivalent plastic strain,
// dalpha = sqrt(2/3) |dep|, whose sum alpha is the hardening variable: q <= K(alpha), dep = (3/2) dalpha s/q.
#pragma once

#include <variant>

#include "lode/elastic/isotropic_moduli.hpp"
#include "lode/plasticity/hardening_law.hpp"
#include "lode/plasticity/iso_plastic_description.hpp"

namespace lode {

namespace iso_plastic {

// What the constants mean, whatever the hardening law.
struct Constants {
    IsotropicModuli elastic;
    double initial_yield;
    double thermal_expansion, moisture_expansion;
    double absolute_zero_offset, heat_capacity, heat_fraction;
    double reference_length;
};

// The model with one hardening law, so that each law gets code of its own.
template <class Law>
class Kernel {
  public:
    Kernel(const Constants& constants, const Law& hardening)
        : c(constants),
          law(hardening),
          radial_return(law, 3.0 * c.elastic.shear),
          axial_return(law, c.elastic.young),
          plane(c.elastic) {}

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        Step<kind, Real> step;
        step.strain = mechanical_strain(increment);
        step.alpha = point.state[EQPS];
        if constexpr (Law::softens)
            if (!regularise(increment, point, step)) return;
        const FlowStress<Real> k = flow_stress(step.alpha, step);
        step.start = k;
        step.end = k;

        if constexpr (kind == AnalysisKind::plane_stress) return_in_plane_stress(increment, point, step, tangent);
        else if constexpr (kind == AnalysisKind::uniaxial) return_in_tension(increment, point, step, tangent);
        else return_radially(increment, point, step, tangent);

        point.plastic_dissipation = plastic_work(step);
        if constexpr (wants_tangent<T>) set_thermal_tangent(point, increment, step, tangent);
        store_state(increment, point, step);
    }

    const IsotropicModuli& elastic() const { return c.elastic; }

  private:
    // Of the return in plane stress: A = E/(3(1 - nu)), rho = 2G/A.
    struct PlaneStress {
        double inverse_A, rho;
        double sum_stiffness;       // E/(1 - nu)
        double lateral_compliance;  // nu/E

        explicit PlaneStress(const IsotropicModuli& e)
            : inverse_A(3.0 * (1.0 - e.poisson) / e.young),
              rho(2.0 * e.shear * inverse_A),
              sum_stiffness(e.young / (1.0 - e.poisson)),
              lateral_compliance(e.poisson / e.young) {}
    };

    Constants c;
    Law law;
    ReturnToYield<Law> radial_return, axial_return;
    PlaneStress plane;

    template <class Real>
    using Result = typename ReturnToYield<Law>::template Result<Real>;
    template <class Real>
    struct Trial {
        Real value, slope, curvature;  // of the residual
        Result<Real> result;
    };

    template <AnalysisKind kind, class Real>
    struct Step {
        Strain<kind, Real> strain;    // mechanical part of DSTRAN
        Real alpha;                   // at the start
        FlowStress<Real> start, end;  // k and dk/dalpha
        Real scale = Real(1.0);       // h/LREF of a softening law
        Mask<Real> yields = Mask<Real>(false);
        Real dalpha = Real(0.0);

        // What the return says of the lanes that yield.
        LODE_INLINE void set_return(const Result<Real>& result) {
            dalpha = select(yields, result.dalpha, Real(0.0));
            end.value = select(yields, result.flow.value, end.value);
            end.slope = select(yields, result.flow.slope, end.slope);
        }
    };

    // Three normal components: the trial deviator shrinks, s = (1 - 3G dalpha/q_trial) s_trial; the pressure is
    // elastic.
    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void return_radially(const Increment<kind, Real>& increment, Point<kind, Real>& point,
                                     Step<kind, Real>& step, T& tangent) const {
        constexpr int n = components(kind);
        const double G = c.elastic.shear, K = c.elastic.bulk;
        const Real mean = (1.0 / 3.0) * trace(point.stress) + K * trace(step.strain);
        const Stress<kind, Real> s_trial = deviator(point.stress) + Real(2.0 * G) * deviator(step.strain);
        const Real q_trial = sqrt(1.5 * double_contraction(s_trial, s_trial));

        Real theta = Real(1.0), inverse_q = Real(0.0), flow = Real(0.0);
        step.yields = exceeds(q_trial, step.start.value);
        if (any(step.yields)) {
            inverse_q = 1.0 / select(step.yields, q_trial, Real(1.0));
            step.set_return(radial_return(q_trial, step.alpha, step.scale, step.start, step.yields));
            flow = step.dalpha * inverse_q;
            theta = 1.0 - (3.0 * G) * flow;
        }
        if (keeps_plastic_strain(point)) {
            Vector<Real, n> plastic_strain;
            for (int i = 0; i < n; ++i) plastic_strain[i] = (i < 3 ? 1.5 : 3.0) * flow * s_trial[i];
            store_plastic_strain(increment, point, plastic_strain);
        }
        for (int i = 0; i < n; ++i) point.stress[i] = i < 3 ? theta * s_trial[i] + mean : theta * s_trial[i];
        const Real q = theta * q_trial;
        // q^2/(6G) + mean^2/(2K)
        point.elastic_energy = c.elastic.half_compliance * ((2.0 / 3.0) * (1.0 + c.elastic.poisson) * (q * q) +
                                                            3.0 * (1.0 - 2.0 * c.elastic.poisson) * (mean * mean));

        if constexpr (wants_tangent<T>) {
            if (!step.yields) return c.elastic.set_stiffness<kind>(tangent);
            // D = K 1x1 + 2G theta I_dev - 2G theta_bar n x n, n = s_trial/|s_trial| = sqrt(3/2) s_trial/q_trial
            const double ratio_3G = radial_return.plastic_share(step.end.slope);
            const double theta_bar = ratio_3G - (1.0 - theta);
            const double along_flow = 3.0 * G * theta_bar * inverse_q * inverse_q;
            set_isotropic_less_dyad(tangent, K - (2.0 / 3.0) * G * theta, 2.0 * G * theta, along_flow, s_trial);
            const double heat = heat_per_strain(increment, step) * ratio_3G * inverse_q;
            for (int i = 0; i < n; ++i) tangent.heat_rate_strain[i] = heat * s_trial[i];
        }
    }

    // sigma33 = 0. The multiplier mu (dep = mu s) is replaced by t = 1/(1 + A mu), which stays in [0, 1].
    template <class Real, class T>
    LODE_INLINE void return_in_plane_stress(const Increment<AnalysisKind::plane_stress, Real>& increment,
                                            Point<AnalysisKind::plane_stress, Real>& point,
                                            Step<AnalysisKind::plane_stress, Real>& step, T& tangent) const {
        const double inverse_A = plane.inverse_A, rho = plane.rho, A_factor = (2.0 / 3.0) * inverse_A;
        const Real start_sum = trace(point.stress);
        auto trial = c.elastic.stress<AnalysisKind::plane_stress>(step.strain);
        trial += point.stress;
        const Real S = trial[0] + trial[1], D = trial[1] - trial[0], tau = trial[2];
        const Real sum = 0.25 * (S * S), shear = 0.75 * (D * D) + 3.0 * (tau * tau);
        const Real q_trial = sqrt(sum + shear);

        Real t = Real(1.0), b = Real(1.0);
        Vector<Real, 4> plastic_strain;
        for (int i = 0; i < 4; ++i) plastic_strain[i] = Real(0.0);
        for (int i = 0; i < 3; ++i) point.stress[i] = trial[i];
        step.yields = exceeds(q_trial, step.start.value);
        if (any(step.yields)) {
            // Everything by value: a reference would keep the point in memory.
            const auto residual = [sum, shear, rho, A_factor, alpha = step.alpha, scale = step.scale,
                                   hardening = law](const Real& x) {
                // Q = sqrt(S^2/4 + shear/b^2) with its two derivatives at the price of one root and one division.
                const Real b_x = x + rho * (1.0 - x);
                const Real Q_b = sqrt(sum * (b_x * b_x) + shear);
                const Real inverse = 1.0 / (b_x * Q_b), inverse_b = inverse * Q_b;
                const Real Q = Q_b * inverse_b, w = (rho - 1.0) * shear * inverse_b * inverse;
                const Real Q_slope = w, Q_bend = 3.0 * (rho - 1.0) * w * inverse_b - w * w * (b_x * b_x) * inverse;
                const Real dalpha = A_factor * (1.0 - x) * Q;
                const Real dalpha_slope = A_factor * ((1.0 - x) * Q_slope - Q);
                const Real dalpha_bend = A_factor * ((1.0 - x) * Q_bend - 2.0 * Q_slope);
                const FlowStress<Real> k = ReturnToYield<Law>::at(hardening, alpha + dalpha, scale);
                return Trial<Real>{
                    x * Q - k.value,
                    Q + x * Q_slope - k.slope * dalpha_slope,
                    2.0 * Q_slope + x * Q_bend - k.slope * dalpha_bend - k.curvature * (dalpha_slope * dalpha_slope),
                    {dalpha, k}};
            };
            const Real start = select(step.yields, step.start.value / q_trial, Real(1.0));
            const Real tolerance = return_tolerance * q_trial;
            const auto root =
                solve_bracketed<Slope::increasing>(residual, Real(0.0), Real(1.0), start, tolerance, step.yields);
            step.set_return(root.last.result);
            t = root.x;
            b = t + rho * (1.0 - t);
            // mu = (1 - t)/(A t), 1 + 2G mu = b/t: the stress over t stays finite when the yield stress falls to zero.
            const Real inverse_b = 1.0 / b, D_over_t = D * inverse_b, tau_over_t = tau * inverse_b;
            point.stress[0] = select(step.yields, 0.5 * t * (S - D_over_t), trial[0]);
            point.stress[1] = select(step.yields, 0.5 * t * (S + D_over_t), trial[1]);
            point.stress[2] = select(step.yields, t * tau_over_t, trial[2]);
            const Real mu_t = inverse_A * (1.0 - t);
            plastic_strain[0] = (1.0 / 6.0) * mu_t * (S - 3.0 * D_over_t);
            plastic_strain[1] = (1.0 / 6.0) * mu_t * (S + 3.0 * D_over_t);
            plastic_strain[2] = Real(0.0) - (plastic_strain[0] + plastic_strain[1]);
            plastic_strain[3] = 2.0 * mu_t * tau_over_t;
        }
        point.elastic_energy = c.elastic.energy(point.stress);
        point.thickness_strain_increment =
            plane.lateral_compliance * (start_sum - trace(point.stress)) + plastic_strain[2];

        if (keeps_plastic_strain(point)) store_plastic_strain(increment, point, plastic_strain);

        if constexpr (wants_tangent<T>) {
            if (!step.yields) return c.elastic.set_stiffness<AnalysisKind::plane_stress>(tangent);
            // D = Xi - radial N x N/(radial P sigma : N + (2/3) q^2 H), Xi = (C^-1 + mu P)^-1, N = Xi P sigma
            const double H = step.end.slope;
            const double mu = inverse_A * (1.0 - t) / max(t, 1e-300);
            const double xi_sum = t * plane.sum_stiffness, xi_difference = 2.0 * c.elastic.shear * t / b;
            const double xi_coupling = 0.5 * (xi_sum - xi_difference), xi_normal = xi_coupling + xi_difference;
            const auto& s = point.stress;
            const Stress<AnalysisKind::plane_stress, double> P_sigma{
                {(1.0 / 3.0) * (2.0 * s[0] - s[1]), (1.0 / 3.0) * (2.0 * s[1] - s[0]), 2.0 * s[2]}};
            const Stress<AnalysisKind::plane_stress, double> N{{xi_normal * P_sigma[0] + xi_coupling * P_sigma[1],
                                                                xi_coupling * P_sigma[0] + xi_normal * P_sigma[1],
                                                                0.5 * xi_difference * P_sigma[2]}};
            const double P_sigma_N = P_sigma[0] * N[0] + P_sigma[1] * N[1] + P_sigma[2] * N[2];
            const double q_squared = s[0] * s[0] + s[1] * s[1] - s[0] * s[1] + 3.0 * s[2] * s[2];
            const double radial = 1.5 * (1.0 - (2.0 / 3.0) * mu * H);
            const double denominator = radial * P_sigma_N + (2.0 / 3.0) * q_squared * H;
            const double factor = denominator > 0.0 ? radial / denominator : 0.0;
            set_isotropic_less_dyad(tangent, xi_coupling, xi_difference, factor, N);
            // dalpha = (2/3) mu q: d(dalpha) = (2/3)(q dmu + mu dq), dmu = q factor N, dq = (3/(2q)) P sigma D, and
            // P sigma D = (1 - factor P sigma : N) N
            const double q = sqrt(q_squared), inverse_q = q > 0.0 ? 1.0 / q : 0.0;
            const double heat = heat_per_strain(increment, step) *
                                ((2.0 / 3.0) * q * factor + mu * inverse_q * (1.0 - factor * P_sigma_N));
            for (int j = 0; j < 3; ++j) tangent.heat_rate_strain[j] = heat * N[j];
        }
    }

    template <class Real, class T>
    LODE_INLINE void return_in_tension(const Increment<AnalysisKind::uniaxial, Real>& increment,
                                       Point<AnalysisKind::uniaxial, Real>& point,
                                       Step<AnalysisKind::uniaxial, Real>& step, T& tangent) const {
        const double E = c.elastic.young;
        const Real trial = point.stress[0] + E * step.strain[0];
        const Real sign = select(trial < Real(0.0), Real(-1.0), Real(1.0));
        step.yields = exceeds(abs(trial), step.start.value);
        if (any(step.yields))
            step.set_return(axial_return(abs(trial), step.alpha, step.scale, step.start, step.yields));
        const Real plastic = sign * step.dalpha;
        point.stress[0] = trial - E * plastic;
        if (keeps_plastic_strain(point))
            store_plastic_strain(increment, point, Vector<Real, 3>{plastic, -0.5 * plastic, -0.5 * plastic});
        point.elastic_energy = c.elastic.energy(point.stress);

        if constexpr (wants_tangent<T>) {
            if (!step.yields) return c.elastic.set_stiffness<AnalysisKind::uniaxial>(tangent);
            const double H = step.end.slope;
            const double share = axial_return.plastic_share(H);
            tangent(0, 0) = H * share;
            tangent.heat_rate_strain[0] = heat_per_strain(increment, step) * sign * share;
        }
    }

    // q <= K with the relative tolerance of section 1.
    template <class Real>
    LODE_INLINE static Mask<Real> exceeds(const Real& q_trial, const Real& yield_stress) {
        return q_trial - yield_stress > yield_tolerance * max(q_trial, yield_stress);
    }

    // k and dk/dalpha at `alpha`.
    template <AnalysisKind kind, class Real>
    LODE_INLINE FlowStress<Real> flow_stress(const Real& alpha, const Step<kind, Real>& step) const {
        return ReturnToYield<Law>::at(law, alpha, step.scale);
    }

    template <AnalysisKind kind, class Real>
    LODE_INLINE Strain<kind, Real> mechanical_strain(const Increment<kind, Real>& increment) const {
        Strain<kind, Real> strain = increment.strain_increment;
        if (c.thermal_expansion != 0.0)
            add_to_normals(strain, normal_components(kind), -c.thermal_expansion * increment.temperature_increment());
        if (c.moisture_expansion != 0.0)
            add_to_normals(strain, normal_components(kind), -c.moisture_expansion * increment.field_increment(1));
        return strain;
    }

    // Softening dissipates the energy of an element of size LREF whatever the element size h, as long as the law is not
    // steeper than the elastic unloading of the point.
    template <AnalysisKind kind, class Real>
    LODE_INLINE bool regularise(const Increment<kind, Real>& increment, Point<kind, Real>& point,
                                Step<kind, Real>& step) const {
        const Real h = increment.element_length();
        const auto unknown = !(h > Real(0.0)) || !is_finite(h);
        if (any(unknown)) {
            point.refuse(unknown, "softening needs the element size CELENT, which", h, "> 0");
            return false;
        }
        constexpr bool is_plane = kind == AnalysisKind::plane_stress;
        const double unloading = is_plane                         ? c.elastic.young / (2.0 * (1.0 - c.elastic.poisson))
                                 : kind == AnalysisKind::uniaxial ? c.elastic.young
                                                                  : 3.0 * c.elastic.shear;
        const double h_max = unloading * c.reference_length / -law.steepest_slope();
        const auto too_large = h >= Real(h_max);
        if (any(too_large)) {
            point.refuse(too_large, "element size h exceeds h_max: h", h, "<", Real(h_max));
            return false;
        }
        step.scale = h * (1.0 / c.reference_length);
        return true;
    }

    // The flow stress of these laws does not depend on temperature, which acts through the thermal strain alone.
    template <AnalysisKind kind>
    LODE_INLINE void set_thermal_tangent(const Point<kind, double>& point, const Increment<kind, double>& increment,
                                         const Step<kind, double>& step, Tangent<kind>& tangent) const {
        if (step.yields)
            tangent.heat_rate = plastic_heat(step, point.plastic_dissipation) * increment.time_increment.inverse;
        if (c.thermal_expansion == 0.0) return;
        for (int j = 0; j < normal_components(kind); ++j) {
            for (int i = 0; i < components(kind); ++i) tangent.thermal_stress[i] -= c.thermal_expansion * tangent(i, j);
            tangent.heat_rate_temperature -= c.thermal_expansion * tangent.heat_rate_strain[j];
        }
    }

    // Plastic work of the increment: the exact integral of K dalpha.
    template <AnalysisKind kind, class Real>
    LODE_INLINE Real plastic_work(const Step<kind, Real>& step) const {
        const Real &k = step.start.value, &k_end = step.end.value;
        Real stored;
        if constexpr (Law::softens)
            stored = law.stored_energy(step.scale * step.alpha, step.scale * step.dalpha, k, k_end) / step.scale;
        else stored = law.stored_energy(step.alpha, step.dalpha, k, k_end);
        return c.initial_yield * step.dalpha + stored;
    }
    // Its part that becomes heat (page 25, section 3).
    template <AnalysisKind kind, class Real>
    LODE_INLINE Real plastic_heat(const Step<kind, Real>& step, const Real& work) const {
        if (c.heat_fraction == 0.0) return c.initial_yield * step.dalpha;
        return c.heat_fraction < 0.0 ? Real(0.0) : c.heat_fraction * work;
    }
    // d RPL/d(dalpha).
    template <AnalysisKind kind>
    LODE_INLINE double heat_per_strain(const Increment<kind, double>& increment, const Step<kind, double>& step) const {
        if (c.heat_fraction == 0.0) return c.initial_yield * increment.time_increment.inverse;
        if (c.heat_fraction < 0.0) return 0.0;
        return c.heat_fraction * step.end.value * increment.time_increment.inverse;
    }

    template <AnalysisKind kind, class Real>
    LODE_INLINE void store_state(const Increment<kind, Real>& increment, Point<kind, Real>& point,
                                 const Step<kind, Real>& step) const {
        auto& state = point.state;
        const Real alpha = step.alpha + step.dalpha;
        if (c.thermal_expansion != 0.0 || c.moisture_expansion != 0.0) add_free_strain(increment, point);
        if (state.has(ENTR)) store_heat(increment, point, step);
        state.set(EQPS, alpha);
        state.set(RATE, step.dalpha * increment.time_increment.inverse);
        state.set(FLOW, step.end.value);
        state.set(YT, Real(0.0));
    }

    template <AnalysisKind kind, class Real>
    LODE_INLINE void add_free_strain(const Increment<kind, Real>& increment, Point<kind, Real>& point) const {
        if constexpr (kind == AnalysisKind::plane_stress)
            point.thickness_strain_increment =
                point.thickness_strain_increment + increment.strain_increment[0] - mechanical_strain(increment)[0];
    }

    template <AnalysisKind kind, class Real>
    LODE_INLINE void store_heat(const Increment<kind, Real>& increment, Point<kind, Real>& point,
                                const Step<kind, Real>& step) const {
        auto& state = point.state;
        const Real heat = plastic_heat(step, point.plastic_dissipation);
        const Real received = c.heat_capacity * increment.temperature_increment() - heat;
        const Real temperature = increment.temperature_end() + c.absolute_zero_offset;
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
    LODE_INLINE static bool keeps_plastic_strain(const Point<kind, Real>& point) {
        return point.state.has(EP + 5);
    }
    // Adds an increment of plastic strain (engineering shears; in plane stress with the thickness component).
    template <int n, AnalysisKind kind, class Real>
    LODE_INLINE void store_plastic_strain(const Increment<kind, Real>& increment, Point<kind, Real>& point,
                                          const Vector<Real, n>& plastic_strain) const {
        constexpr auto layout = kind == AnalysisKind::solid ? AnalysisKind::solid : AnalysisKind::plane_strain;
        Vector<Real, n> total;
        for (int i = 0; i < n; ++i) total[i] = point.state[EP + i];
        if constexpr (kind != AnalysisKind::uniaxial) {
            if (increment.has_rotation()) {
                Strain<layout, Real> strain;
                for (int i = 0; i < n; ++i) strain[i] = total[i];
                strain = rotate(strain, increment.rotation());
                for (int i = 0; i < n; ++i) total[i] = strain[i];
            }
        }
        for (int i = 0; i < n; ++i) point.state.set(EP + i, total[i] + plastic_strain[i]);
    }
};

}  // namespace iso_plastic

struct IsoPlastic {
    static constexpr const lode_model& description = iso_plastic::description;

    explicit IsoPlastic(const Properties& p) : kernel(make_kernel(p)) {}

    int required_state(AnalysisKind) const { return 4; }

    template <AnalysisKind kind>
    void initial_stiffness(const Stress<kind, double>&, const State<double>&, Tangent<kind>& tangent) const {
        specialise([&](const auto& k) { k.elastic().template set_stiffness<kind>(tangent); });
    }

    // Calls f with the kernel of the hardening law at hand.
    template <class F>
    LODE_INLINE void specialise(const F& f) const {
        if (const auto* linear = std::get_if<0>(&kernel)) return f(*linear);
        if (const auto* saturation = std::get_if<1>(&kernel)) return f(*saturation);
        if (const auto* linear_softening = std::get_if<2>(&kernel)) return f(*linear_softening);
        f(*std::get_if<3>(&kernel));
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        specialise([&](const auto& k) __attribute__((always_inline)) { k.update(increment, point, tangent); });
    }

  private:
    template <class... Laws>
    using AnyKernel = std::variant<iso_plastic::Kernel<Laws>...>;
    using Kernel = AnyKernel<LinearHardening, SaturationHardening, LinearSoftening, SaturationSoftening>;

    static Kernel make_kernel(const Properties& p) {
        using namespace iso_plastic;
        const HardeningLaw hardening(p, p[SIGY], HLAW, H1);
        Constants c{.elastic = IsotropicModuli::from_young_poisson(p[E], p[NU]),
                    .initial_yield = p[SIGY],
                    .thermal_expansion = p[ALPHA],
                    .moisture_expansion = p[BETA],
                    .absolute_zero_offset = p[TABS],
                    .heat_capacity = p[RHOCV],
                    .heat_fraction = p[CHI],
                    .reference_length = p[LREF]};
        if (c.heat_fraction < 0.0 && c.heat_fraction != -1.0) p.refuse(CHI, "-1, 0 or in (0, 1]");
        if (hardening.is_softening() && c.reference_length <= 0.0) p.refuse(LREF, "> 0: a softening law needs it");
        if (hardening.is_softening() && c.heat_fraction == 0.0) c.heat_fraction = 1.0;  // no stored energy is released
        return hardening.visit<IsoPlastic::Kernel>(
            [&](const auto& law) -> IsoPlastic::Kernel { return iso_plastic::Kernel(c, law); });
    }

    Kernel kernel;
};

}  // namespace lode
