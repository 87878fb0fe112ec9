// DRUCKER_PRAGER: pressure-dependent, non-associated plasticity with apex (page 20, section 4; Nairn, eqs. 2.82-2.96).
// Phi = q - eta p - xi c(alpha) with q = sqrt(J2), dep = lambda (s/(2q) + eta_bar/3 1), dalpha = xi lambda. Backward
// Euler, in one step or in NSUB substeps.
#pragma once

#include <variant>

#include "lode/elastic/isotropic_moduli.hpp"
#include "lode/elastic/known_field.hpp"
#include "lode/material/thermal_block.hpp"
#include "lode/plasticity/drucker_prager_description.hpp"
#include "lode/plasticity/drucker_prager_plane_stress.hpp"
#include "lode/plasticity/plastic_strain.hpp"
#include "lode/plasticity/softening_scale.hpp"
#include "lode/plasticity/substep_chain.hpp"
#include "lode/tensor/invariants.hpp"

namespace lode {

namespace drucker_prager {

// What the constants mean, whatever the hardening law.
struct Constants {
    IsotropicModuli elastic;
    Cone cone;
    double initial_cohesion;
    double thermal_expansion, moisture_expansion;
    ThermalBlock thermal;
    int substeps;
    double reference_length;
};

// The model with one hardening law, so that each law gets code of its own.
template <class Law>
class Kernel {
  public:
    Kernel(const Constants& constants, const Law& hardening)
        : c(constants),
          law(hardening),
          cone_return(law, c.cone, c.elastic.shear, c.elastic.bulk, c.initial_cohesion),
          plane_return(law, c.cone, c.elastic, c.initial_cohesion) {}

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        Course<kind, Real> course;
        course.strain = mechanical_strain(increment, point.state);
        if (c.thermal_expansion != 0.0 || c.moisture_expansion != 0.0)
            if (!is_known(course.strain[0], point, "temperature or field 1 on entry is not finite")) return;
        course.alpha = point.state[EQPS];
        course.keeps_plastic_strain = keeps_plastic_strain(point);
        if constexpr (Law::softens) {
            const double unloading =
                kind == AnalysisKind::plane_stress ? plane_return.unloading() : cone_return.unloading();
            if (!softening_scale(increment, point, c.reference_length, unloading, law.steepest_slope(), course.scale))
                return;
        }
        const bool thermoelastic = c.thermal.is_thermoelastic();
        if (thermoelastic)
            if (!c.thermal.is_absolute(point, c.thermal.temperature(increment, point.state))) return;
        course.cohesion = ReturnToYield<Law>::at(law, course.alpha, course.scale);

        if (c.substeps > 1) [[unlikely]] {
            // Copies, so that the point itself stays in registers on the other way.
            const Course<kind, Real> done = in_substeps(point.stress, course, tangent, point.solves);
            course = done;
            point.stress = done.stress;
        } else {
            integrate(point.stress, course, tangent, point.solves);
        }

        point.elastic_energy = course.energy;
        point.plastic_dissipation = course.work;
        const Real heat = c.thermal.plastic_heat(course.heat, course.work);
        Real volume_change = trace(increment.strain_increment), volume_heat = Real(0.0);
        if constexpr (kind == AnalysisKind::plane_stress) {
            point.thickness_strain_increment =
                course.thickness + (increment.strain_increment[0] - course.strain[0]);  // with the free strain
            volume_change = volume_change + point.thickness_strain_increment;
        }
        if (thermoelastic)
            volume_heat = c.thermal.thermoelastic_heat(c.thermal.temperature(increment, point.state),
                                                       (-3.0 * c.elastic.bulk * c.thermal_expansion) * volume_change);
        if constexpr (wants_tangent<T>)
            set_thermal_tangent(increment, point.state, course, heat + volume_heat, volume_change, tangent);

        c.thermal.store(increment, point.state, course.work, heat, volume_heat);
        if (course.keeps_plastic_strain) store_plastic_strain(increment, point, course.plastic_strain);
        const Real plastic_volume = point.state[EPV] + course.volume;
        point.state.set(EQPS, course.alpha);
        point.state.set(COHC, course.cohesion.value);
        point.state.set(REGION, course.region);
        point.state.set(EPV, plastic_volume);
    }

    const IsotropicModuli& elastic() const { return c.elastic; }

  private:
    Constants c;
    Law law;
    ConeReturn<Law> cone_return;
    PlaneReturn<Law> plane_return;

    // What an increment is and what it does.
    template <AnalysisKind kind, class Real>
    struct Course {
        Strain<kind, Real> strain;  // mechanical part of DSTRAN
        bool keeps_plastic_strain = false;
        Real alpha, scale = Real(1.0);  // h/LREF of a softening law
        FlowStress<Real> cohesion;
        Real work = Real(0.0), heat = Real(0.0);  // sigma:dep, and the heat of the source rule
        Real volume = Real(0.0), region = Real(0.0);
        Real energy = Real(0.0);     // sigma:S:sigma/2 at the end
        Real thickness = Real(0.0);  // mechanical strain increment 33, plane stress
        Strain<plastic_strain_layout(kind), Real> plastic_strain{};
        Stress<kind, Real> stress;  // at the end, of substeps
        // Of a tangent: how work and heat by the constants' rule and the thickness answer to DSTRAN.
        Vector<double, components(kind)> heat_by_strain{}, thickness_by_strain{};
    };

    // One backward Euler step of three normal components, page steps 1 to 4.
    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void integrate(Stress<kind, Real>& stress, Course<kind, Real>& course, T& tangent,
                               const SolveCounter<Real>& solves) const {
        constexpr int n = components(kind);
        const double G = c.elastic.shear, K = c.elastic.bulk;
        const Real p_trial = pressure(stress) - K * trace(course.strain);
        const Stress<kind, Real> s_trial = deviator(stress) + Real(2.0 * G) * deviator(course.strain);
        const Real q_trial = sqrt(0.5 * double_contraction(s_trial, s_trial));
        const ConeStep<Real> end = cone_return(q_trial, p_trial, course.alpha, course.scale, course.cohesion, solves);

        const Real theta = 1.0 - end.loss;
        for (int i = 0; i < n; ++i) stress[i] = i < 3 ? theta * s_trial[i] - end.p : theta * s_trial[i];
        if (course.keeps_plastic_strain) {
            // The lost part of the deviator over 2G, and a third of the plastic volume strain.
            const Real shear = (0.5 / G) * end.loss, mean = (1.0 / 3.0) * end.volume;
            for (int i = 0; i < n; ++i)
                course.plastic_strain[i] =
                    course.plastic_strain[i] + (i < 3 ? shear * s_trial[i] + mean : 2.0 * (shear * s_trial[i]));
        }
        course.alpha = course.alpha + end.dalpha;
        // Entry by entry: a copy of the whole would wait for the stores before it.
        course.cohesion.value = end.cohesion.value, course.cohesion.slope = end.cohesion.slope;
        course.cohesion.curvature = end.cohesion.curvature;
        course.work = course.work + end.work();
        course.heat = course.heat + end.heat(c.initial_cohesion);
        course.volume = course.volume + end.volume;
        // q^2/(2G) + p^2/(2K)
        course.energy = c.elastic.half_compliance * (2.0 * (1.0 + c.elastic.poisson) * (end.q * end.q) +
                                                     3.0 * (1.0 - 2.0 * c.elastic.poisson) * (end.p * end.p));
        course.region = select(end.yields, select(end.at_apex, Real(2.0), Real(1.0)), Real(0.0));
        if constexpr (wants_tangent<T>) set_tangent(s_trial, end, course, tangent);
    }

    // D = 2G theta I_dev + s_trial/q_trial x (shape by strain) - 1 x (p by strain), where q_trial answers to the strain
    // by G s_trial/q_trial and p_trial by -K 1.
    template <AnalysisKind kind>
    LODE_INLINE void set_tangent(const Stress<kind, double>& s_trial, const ConeStep<double>& end,
                                 Course<kind, double>& course, Tangent<kind>& tangent) const {
        constexpr int n = components(kind);
        const double G = c.elastic.shear, K = c.elastic.bulk, theta = 1.0 - end.loss;
        if (!end.yields) {
            if (c.thermal_expansion != 0.0)
                for (int i = 0; i < 3; ++i) tangent.thermal_stress[i] = -3.0 * K * c.thermal_expansion;
            return c.elastic.set_stiffness<kind>(tangent);
        }
        const auto [by_q, by_p, by_alpha] = cone_return.linearise(end);
        const double to_q = c.thermal.plastic_heat(by_q.heat, by_q.work);
        const double to_p = c.thermal.plastic_heat(by_p.heat, by_p.work);
        Column<n> direction{}, normal{};
        for (int i = 0; i < n; ++i) direction[i] = end.inverse_q * s_trial[i];
        for (int i = 0; i < 3; ++i) normal[i] = 1.0;
        const double coupling = by_p.p - (2.0 / 3.0) * G * theta;
        for (int j = 0; j < n; ++j) {
            Column<n> unit{};
            unit[j] = j < 3 ? 2.0 * G * theta : G * theta;
            const double s = s_trial[j];
            const double along = j < 3 ? by_q.shape * s - by_p.shape : by_q.shape * s;
            const double on_normals = j < 3 ? coupling - by_q.p * s : -by_q.p * s;
            store_column<n>(tangent.stiffness, j, unit + along * direction + on_normals * normal);
            course.heat_by_strain[j] = j < 3 ? to_q * s - to_p : to_q * s;
        }
        if (c.thermal_expansion == 0.0) return;
        // -alpha D 1, of which a deviator leaves nothing else.
        const double shear = 3.0 * c.thermal_expansion * by_p.shape * end.inverse_q;
        const double mean = 3.0 * c.thermal_expansion * by_p.p;
        for (int i = 0; i < n; ++i) tangent.thermal_stress[i] = i < 3 ? shear * s_trial[i] - mean : shear * s_trial[i];
    }

    // The same after other substeps: s_trial:d(sigma_trial)/(2G) and tr d(sigma_trial)/(3K) stand for s_trial and 1.
    template <AnalysisKind kind>
    LODE_INLINE void set_tangent(const Stress<kind, double>& s_trial, const ConeStep<double>& end,
                                 const Course<kind, double>&, SubstepChain<kind>& chain) const {
        constexpr int n = components(kind);
        using Row = typename SubstepChain<kind>::Row;
        chain.add_strain();
        if (!end.yields) return;
        const ConeLinearisation by = cone_return.linearise(end);
        const Row trace = chain.stress[0] + chain.stress[1] + chain.stress[2];
        Row contraction = s_trial[0] * chain.stress[0];
        for (int i = 1; i < n; ++i) contraction += (i < 3 ? s_trial[i] : 2.0 * s_trial[i]) * chain.stress[i];
        const Row shear = (0.5 / c.elastic.shear) * contraction, volume = (1.0 / (3.0 * c.elastic.bulk)) * trace;
        const auto answer = [&](auto slope) LODE_INLINE_LAMBDA {
            return slope(by.by_q) * shear - slope(by.by_p) * volume + slope(by.by_alpha) * chain.alpha;
        };
        const double theta = 1.0 - end.loss;
        const Row along = end.inverse_q * answer([](const ConeSlopes& d) { return d.shape; });
        const Row mean = (theta / 3.0) * trace + answer([](const ConeSlopes& d) { return d.p; });
        chain.heat += answer([this](const ConeSlopes& d) { return c.thermal.plastic_heat(d.heat, d.work); });
        chain.alpha = answer([](const ConeSlopes& d) { return d.alpha; });
        for (int i = 0; i < n; ++i) {
            chain.stress[i] = theta * chain.stress[i] + s_trial[i] * along;
            if (i < 3) chain.stress[i] -= mean;
        }
    }

    // One backward Euler step of plane stress.
    template <class Real, class T>
    LODE_INLINE void integrate(Stress<AnalysisKind::plane_stress, Real>& stress,
                               Course<AnalysisKind::plane_stress, Real>& course, T& tangent,
                               const SolveCounter<Real>& solves) const {
        const Real start_sum = stress[0] + stress[1];
        stress += c.elastic.stress<AnalysisKind::plane_stress>(course.strain);
        const Real S = stress[0] + stress[1], D = stress[1] - stress[0], tau = stress[2];
        const Real T_trial = 0.25 * (D * D) + tau * tau;
        const PlaneStep<Real> end = plane_return(S, T_trial, course.alpha, course.scale, course.cohesion, solves);
        if constexpr (wants_tangent<T>) set_plane_tangent({S, D, tau, T_trial}, end, course, tangent);

        const Real inverse_b = 1.0 / end.b, share = end.t * inverse_b;
        const Real sum = end.t * end.S, difference = share * D;
        stress[0] = select(end.yields, 0.5 * (sum - difference), stress[0]);
        stress[1] = select(end.yields, 0.5 * (sum + difference), stress[1]);
        stress[2] = share * tau;
        const Real plastic_thickness = plane_return.thickness(end),
                   volume = c.cone.eta_bar * plane_return.multiplier(end);
        if (course.keeps_plastic_strain) {
            const Real flow = plane_return.flow(end), mean = (1.0 / 12.0) * (flow * end.S) + (1.0 / 3.0) * volume;
            const Real turned = flow * inverse_b, half_difference = 0.25 * (turned * D);
            auto& ep = course.plastic_strain;
            ep[0] = ep[0] + (mean - half_difference);
            ep[1] = ep[1] + (mean + half_difference);
            ep[2] = ep[2] + plastic_thickness;
            ep[3] = ep[3] + turned * tau;
        }
        course.alpha = course.alpha + end.dalpha;
        course.cohesion = end.cohesion;
        course.work = course.work + plane_return.work(end);
        course.heat = course.heat + plane_return.heat(end);
        course.volume = course.volume + volume;
        course.thickness = course.thickness + plastic_thickness +
                           (c.elastic.poisson / c.elastic.young) * (start_sum - (stress[0] + stress[1]));
        course.energy = c.elastic.energy(stress);
        course.region = select(end.yields, Real(1.0), Real(0.0));
    }

    struct PlaneTrial {
        double S, D, tau, T;
    };
    // One step is a chain of one.
    LODE_INLINE void set_plane_tangent(const PlaneTrial& trial, const PlaneStep<double>& end,
                                       Course<AnalysisKind::plane_stress, double>& course,
                                       Tangent<AnalysisKind::plane_stress>& tangent) const {
        SubstepChain<AnalysisKind::plane_stress> chain;
        begin(chain, 1.0);
        set_plane_tangent(trial, end, course, chain);
        finish(chain, course, tangent);
    }
    // The chain rule from strain to S, D, tau, T and back.
    LODE_INLINE void set_plane_tangent(const PlaneTrial& trial, const PlaneStep<double>& end,
                                       const Course<AnalysisKind::plane_stress, double>& course,
                                       SubstepChain<AnalysisKind::plane_stress>& chain) const {
        using Row = SubstepChain<AnalysisKind::plane_stress>::Row;
        chain.add_strain();
        if (!end.yields) return;
        const PlaneLinearisation by = plane_return.linearise(end, trial.S, trial.T, course.alpha, course.scale);
        const Row dS = chain.stress[0] + chain.stress[1], dD = chain.stress[1] - chain.stress[0];
        const Row dT = (0.5 * trial.D) * dD + (2.0 * trial.tau) * chain.stress[2];
        const auto answer = [&](auto slope) LODE_INLINE_LAMBDA {
            return slope(by.by_S) * dS + slope(by.by_T) * dT + slope(by.by_alpha) * chain.alpha;
        };
        const Row sum = answer([](const PlaneSlopes& d) { return d.sum; });
        const Row dshare = answer([](const PlaneSlopes& d) { return d.share; });
        chain.heat += answer([this](const PlaneSlopes& d) { return c.thermal.plastic_heat(d.heat, d.work); });
        chain.thickness += answer([](const PlaneSlopes& d) { return d.thickness; });
        chain.alpha = answer([](const PlaneSlopes& d) { return d.alpha; });
        const double share = end.t / end.b;
        const Row difference = share * dD + trial.D * dshare;
        chain.stress[0] = 0.5 * (sum - difference);
        chain.stress[1] = 0.5 * (sum + difference);
        chain.stress[2] = share * chain.stress[2] + trial.tau * dshare;
    }

    template <AnalysisKind kind>
    LODE_INLINE void begin(SubstepChain<kind>& chain, double share) const {
        constexpr int normals = normal_components(kind);
        const double coupling = share * c.elastic.coupling_stiffness<kind>();
        const double normal = share * c.elastic.normal_stiffness<kind>();
        for (int i = 0; i < components(kind); ++i)
            for (int j = 0; j < components(kind); ++j)
                if (i < normals && j < normals) chain.elastic[i][j] = i == j ? normal : coupling;
                else if (i == j) chain.elastic[i][i] = share * c.elastic.shear;
    }
    template <AnalysisKind kind>
    LODE_INLINE void finish(const SubstepChain<kind>& chain, Course<kind, double>& course,
                            Tangent<kind>& tangent) const {
        chain.store(tangent);
        set_thermal_stress(tangent);
        for (int j = 0; j < components(kind); ++j) course.heat_by_strain[j] = chain.heat[j];
        if constexpr (kind == AnalysisKind::plane_stress) {
            const double lateral = c.elastic.poisson / c.elastic.young;
            for (int j = 0; j < 3; ++j)
                course.thickness_by_strain[j] = chain.thickness[j] - lateral * (tangent(0, j) + tangent(1, j));
        }
    }

    // METHOD 2.
    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void take_substeps(Course<kind, Real>& course, T& tangent, const SolveCounter<Real>& solves) const {
        const Strain<kind, Real> whole = course.strain;
        course.strain = Real(1.0 / c.substeps) * course.strain;
        solves.count_substeps(c.substeps);
        for (int k = 0; k < c.substeps; ++k) integrate(course.stress, course, tangent, solves);
        course.strain = whole;
    }
    template <AnalysisKind kind, class Real, class T>
    [[gnu::noinline]] Course<kind, Real> in_substeps(Stress<kind, Real> stress, Course<kind, Real> course, T& tangent,
                                                     SolveCounter<Real> solves) const {
        course.stress = stress;
        if constexpr (wants_tangent<T>) {
            SubstepChain<kind> chain;
            begin(chain, 1.0 / c.substeps);
            take_substeps(course, chain, solves);
            finish(chain, course, tangent);
        } else {
            take_substeps(course, tangent, solves);
        }
        return course;
    }

    template <AnalysisKind kind, class Real>
    LODE_INLINE Strain<kind, Real> mechanical_strain(const Increment<kind, Real>& increment,
                                                     const State<Real>& state) const {
        Strain<kind, Real> strain = increment.strain_increment;
        if (c.thermal_expansion != 0.0)
            add_to_normals(strain, normal_components(kind),
                           -c.thermal_expansion * c.thermal.temperature_increment(increment, state));
        if (c.moisture_expansion != 0.0)
            add_to_normals(strain, normal_components(kind), -c.moisture_expansion * increment.field_increment(1));
        return strain;
    }

    // DDSDDT: temperature acts as a strain.
    template <AnalysisKind kind>
    LODE_INLINE void set_thermal_stress(Tangent<kind>& tangent) const {
        for (int j = 0; j < normal_components(kind); ++j)
            for (int i = 0; i < components(kind); ++i) tangent.thermal_stress[i] -= c.thermal_expansion * tangent(i, j);
    }

    // Page 25, section 4. Temperature acts through the thermal strain alone; `heat` is dPhi + H_is.
    template <AnalysisKind kind>
    LODE_INLINE void set_thermal_tangent(const Increment<kind, double>& increment, const State<double>& state,
                                         const Course<kind, double>& course, double heat, double volume_change,
                                         Tangent<kind>& tangent) const {
        const double rate = increment.time_increment.inverse, alpha = c.thermal_expansion;
        const bool feeds_host = !c.thermal.heats_itself();
        c.thermal.set_heat_rate(tangent, increment, heat);
        if (feeds_host)
            for (int j = 0; j < components(kind); ++j) tangent.heat_rate_strain[j] = rate * course.heat_by_strain[j];
        if (alpha == 0.0) return;
        for (int j = 0; j < normal_components(kind); ++j)
            tangent.heat_rate_temperature -= alpha * tangent.heat_rate_strain[j];
        if (!(feeds_host && c.thermal.is_thermoelastic())) return;
        // H_is = -3K alpha T d eps_v, in plane stress with the thickness strain that the return finds.
        const double per_volume = -3.0 * c.elastic.bulk * alpha * rate;
        const double T = c.thermal.absolute(c.thermal.temperature(increment, state));
        double volume_by_temperature = kind == AnalysisKind::plane_stress ? alpha : 0.0;
        for (int j = 0; j < components(kind); ++j) {
            const double volume_by_strain = (j < normal_components(kind) ? 1.0 : 0.0) + course.thickness_by_strain[j];
            tangent.heat_rate_strain[j] += per_volume * T * volume_by_strain;
            if (j < normal_components(kind)) volume_by_temperature -= alpha * course.thickness_by_strain[j];
        }
        tangent.heat_rate_temperature += per_volume * (volume_change + T * volume_by_temperature);
    }
};

}  // namespace drucker_prager

struct DruckerPrager {
    static constexpr const lode_model& description = drucker_prager::description;

    template <class... Laws>
    using AnyKernel = std::variant<drucker_prager::Kernel<Laws>...>;
    using Kernel = AnyKernel<LinearHardening, SaturationHardening, NonlinearHardening, PowerHardening, LinearSoftening,
                             Floored<FallingCurve>>;

    explicit DruckerPrager(const Properties& p)
        : kernel(make_kernel(p)), state_count(std::max(4, thermal_block(p).required_state())) {}

    int required_state(AnalysisKind) const { return state_count; }

    template <AnalysisKind kind>
    void initial_stiffness(const Stress<kind, double>&, const State<double>&, Tangent<kind>& tangent) const {
        specialise([&](const auto& k) { k.elastic().template set_stiffness<kind>(tangent); });
    }

    // Calls f with the kernel of the hardening law at hand.
    template <std::size_t law = 0, class F>
    LODE_INLINE void specialise(const F& f) const {
        if constexpr (law + 1 == std::variant_size_v<Kernel>) {
            f(*std::get_if<law>(&kernel));
        } else {
            if (const auto* k = std::get_if<law>(&kernel)) return f(*k);
            specialise<law + 1>(f);
        }
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        specialise([&](const auto& k) LODE_INLINE_LAMBDA { k.update(increment, point, tangent); });
    }

  private:
    static HardeningLaw hardening_law(const Properties& p) {
        using namespace drucker_prager;
        return HardeningLaw(p, p[COH], HLAW, H1);
    }
    static ThermalBlock thermal_block(const Properties& p) {
        return ThermalBlock(p, drucker_prager::TABS, hardening_law(p).is_softening());
    }

    static Kernel make_kernel(const Properties& p) {
        using namespace drucker_prager;
        const HardeningLaw hardening = hardening_law(p);
        if (p.code(METHOD) == 1) p.refuse(METHOD, "0 or 2: the exact integration of METHOD 1 is ISO_PLASTIC's");
        if (hardening.is_softening() && p[LREF] <= 0.0) p.refuse(LREF, "> 0: softening law needs LREF > 0");
        const Constants c{.elastic = IsotropicModuli::from_young_poisson(p[E], p[NU]),
                          .cone = Cone::from_properties(p, FIT, XI),
                          .initial_cohesion = p[COH],
                          .thermal_expansion = p[ALPHA],
                          .moisture_expansion = p[BETA],
                          .thermal = thermal_block(p),
                          .substeps = p.code(METHOD) == 2 ? p.code(NSUB) : 1,
                          .reference_length = p[LREF]};
        return hardening.visit<DruckerPrager::Kernel>([&](const auto& law) -> DruckerPrager::Kernel {
            if constexpr (requires { any_falling(law); }) return drucker_prager::Kernel(c, any_falling(law));
            else return drucker_prager::Kernel(c, law);
        });
    }

    Kernel kernel;
    int state_count;
};

}  // namespace lode
