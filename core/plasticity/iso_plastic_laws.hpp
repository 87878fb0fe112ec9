// The hardening laws of ISO_PLASTIC as its update wants them (surroundings.hpp): the curves of hardening_curves.hpp,
// which know neither rate nor temperature, and any law chosen at run time, for the methods of many steps.
#pragma once

#include <variant>

#include "lode/elastic/isotropic_moduli.hpp"
#include "lode/plasticity/hardening_law.hpp"
#include "lode/plasticity/hardening_law_dislocation.hpp"
#include "lode/plasticity/hardening_law_johnson_cook.hpp"
#include "lode/plasticity/hardening_law_steinberg.hpp"

namespace lode::iso_plastic {

template <class Curve>
class CurveLaw {
  public:
    static constexpr bool softens = Curve::softens, feels_rate = false, feels_temperature = false;
    static constexpr bool changes_shear = false, melts = false, remembers = false;

    template <class Real>
    struct At {
        Real scale;
    };

    CurveLaw(const Curve& curve, const IsotropicModuli& elastic)
        : curve_(curve), radial_(curve, 3.0 * elastic.shear), axial_(curve, elastic.young) {}

    template <class Real>
    LODE_INLINE At<Real> at(const Surroundings<Real>& s) const {
        return {s.scale};
    }
    template <class Real>
    LODE_INLINE FlowStress<Real> start(const At<Real>& at, const Real& alpha) const {
        return ReturnToYield<Curve>::at(curve_, alpha, at.scale);
    }
    template <class Real>
    LODE_INLINE FlowStress<Real> flow(const At<Real>& at, const Real& alpha, const Real& x) const {
        return ReturnToYield<Curve>::at(curve_, alpha + x, at.scale);
    }
    template <Line line, class Real>
    LODE_INLINE ReturnResult<Real> solve(const At<Real>& at, const Real& q_trial, const Real& alpha,
                                         const FlowStress<Real>& k, const Mask<Real>& yields,
                                         const SolveCounter<Real>& solves = {}) const {
        if constexpr (line == radial) return radial_(q_trial, alpha, at.scale, k, yields, solves);
        else return axial_(q_trial, alpha, at.scale, k, yields, solves);
    }
    // On a line chosen at run time.
    template <class Real>
    LODE_INLINE ReturnResult<Real> solve_on(Line line, const At<Real>& at, const Real& q_trial, const Real& alpha,
                                            const FlowStress<Real>& k, const Mask<Real>& yields,
                                            const SolveCounter<Real>& solves) const {
        return (line == radial ? radial_ : axial_)(q_trial, alpha, at.scale, k, yields, solves);
    }
    template <Line line>
    LODE_INLINE double plastic_share(const At<double>&, double H) const {
        if constexpr (line == radial) return radial_.plastic_share(H);
        else return axial_.plastic_share(H);
    }
    template <class Real>
    LODE_INLINE PlasticWork<Real> work(const At<Real>& at, const Real& alpha, const Real& dalpha,
                                       const FlowStress<Real>& k, const FlowStress<Real>& k_end) const {
        Real stored;
        if constexpr (softens) stored = curve_.stored_energy(at.scale * alpha, at.scale * dalpha, k, k_end) / at.scale;
        else stored = curve_.stored_energy(alpha, dalpha, k, k_end);
        return {Real(curve_.initial_yield()), stored};
    }
    double steepest_slope() const {
        if constexpr (softens) return curve_.steepest_slope();
        else return 0.0;
    }

  private:
    Curve curve_;
    ReturnToYield<Curve> radial_, axial_;
};

// A law whose functions stay out of the kernels: one copy serves all kinds. For the laws that are not the daily bread.
template <class Law>
class Apart {
  public:
    static constexpr bool softens = Law::softens, feels_rate = Law::feels_rate;
    static constexpr bool feels_temperature = Law::feels_temperature, changes_shear = Law::changes_shear;
    static constexpr bool melts = Law::melts, remembers = Law::remembers;
    template <class Real>
    using At = typename Law::template At<Real>;

    explicit Apart(const Law& law) : law_(law) {}
    const Law& law() const { return law_; }

    template <class Real>
    LODE_INLINE At<Real> at(const Surroundings<Real>& s) const {
        return law_.at(s);
    }
    // Everything by value: a reference would keep the point in memory.
    template <class Real>
    [[gnu::noinline]] FlowStress<Real> start(At<Real> at, Real alpha) const {
        return law_.start(at, alpha);
    }
    template <class Real>
    [[gnu::noinline]] FlowStress<Real> flow(At<Real> at, Real alpha, Real x) const {
        return law_.flow(at, alpha, x);
    }
    template <Line line, class Real>
    LODE_INLINE ReturnResult<Real> solve(const At<Real>& at, const Real& q_trial, const Real& alpha,
                                         const FlowStress<Real>& k, const Mask<Real>& yields,
                                         const SolveCounter<Real>& solves = {}) const {
        return solve_apart<Real>(line, at, q_trial, alpha, k, yields, solves);
    }
    template <Line line>
    LODE_INLINE double plastic_share(const At<double>& at, double H) const {
        return law_.template plastic_share<line>(at, H);
    }
    template <class Real>
    [[gnu::noinline]] PlasticWork<Real> work(At<Real> at, Real alpha, Real dalpha, FlowStress<Real> k,
                                             FlowStress<Real> k_end) const {
        return law_.work(at, alpha, dalpha, k, k_end);
    }
    [[gnu::noinline]] HeatSlopes slopes(At<double> at, double alpha, double dalpha, FlowStress<double> k,
                                        FlowStress<double> k_end) const requires Law::feels_temperature {
        return law_.slopes(at, alpha, dalpha, k, k_end);
    }
    double shear_temperature_factor(const At<double>& at) const requires Law::changes_shear {
        return law_.shear_temperature_factor(at);
    }
    template <class Real>
    Real thermal_part(const At<Real>& at, const Real& alpha, const Real& k) const requires Law::changes_shear {
        return law_.thermal_part(at, alpha, k);
    }
    const DislocationHardening* dislocations() const {
        if constexpr (std::is_same_v<Law, DislocationHardening>) return &law_;
        else return nullptr;
    }
    double steepest_slope() const requires Law::softens { return law_.steepest_slope(); }

  private:
    template <class Real>
    [[gnu::noinline]] ReturnResult<Real> solve_apart(Line line, At<Real> at, Real q_trial, Real alpha,
                                                     FlowStress<Real> k, Mask<Real> yields,
                                                     SolveCounter<Real> solves) const {
        return law_.solve_on(line, at, q_trial, alpha, k, yields, solves);
    }

    Law law_;
};

using SteinbergGuinan = Steinberg<false>;
using SteinbergLund = Steinberg<true>;

// F<Law>... over all laws.
template <template <class...> class F>
using OverLaws =
    F<CurveLaw<LinearHardening>, CurveLaw<SaturationHardening>, JohnsonCook, CurveLaw<LinearSoftening>,
      Apart<CurveLaw<NonlinearHardening>>, Apart<CurveLaw<PowerHardening>>, Apart<CurveLaw<Floored<FallingCurve>>>,
      Apart<SteinbergGuinan>, Apart<SteinbergLund>, Apart<DislocationHardening>>;
using LawVariant = OverLaws<std::variant>;

// The law of a curve, as it stands in LawVariant.
template <class Curve>
LawVariant law_of(const Curve& curve, const IsotropicModuli& elastic) {
    if constexpr (requires {
                      curve.floor_at;
                      curve.law;
                  }) {
        return Apart(CurveLaw<Floored<FallingCurve>>(any_falling(curve), elastic));
    } else if constexpr (std::is_constructible_v<LawVariant, CurveLaw<Curve>>) {
        return CurveLaw<Curve>(curve, elastic);
    } else {
        return Apart(CurveLaw<Curve>(curve, elastic));
    }
}

// Any law, chosen at run time. Its flags say what some law does.
class AnyLaw {
  public:
    static constexpr bool softens = true, feels_rate = true, feels_temperature = true, changes_shear = true;
    static constexpr bool melts = true, remembers = true;

    template <class Real>
    struct At {
        Surroundings<Real> surroundings;
        Real shear_ratio;
        Mask<Real> melted;
    };

    explicit AnyLaw(const LawVariant& law) : law_(law) {}

    template <class Real>
    At<Real> at(const Surroundings<Real>& s) const {
        At<Real> result{s, Real(1.0), Mask<Real>(false)};
        visit<void>([&](const auto& law) {
            using Law = std::decay_t<decltype(law)>;
            if constexpr (Law::changes_shear || Law::melts) {
                const auto at = law.at(s);
                result.melted = at.melted;
                if constexpr (Law::changes_shear) result.shear_ratio = at.shear_ratio;
            }
        });
        return result;
    }
    template <class Real>
    FlowStress<Real> start(const At<Real>& at, const Real& alpha) const {
        return visit<FlowStress<Real>>([&](const auto& law) { return law.start(law.at(at.surroundings), alpha); });
    }
    template <class Real>
    FlowStress<Real> flow(const At<Real>& at, const Real& alpha, const Real& x) const {
        return visit<FlowStress<Real>>([&](const auto& law) { return law.flow(law.at(at.surroundings), alpha, x); });
    }
    template <Line line, class Real>
    ReturnResult<Real> solve(const At<Real>& at, const Real& q_trial, const Real& alpha, const FlowStress<Real>& k,
                             const Mask<Real>& yields, const SolveCounter<Real>& solves = {}) const {
        return visit<ReturnResult<Real>>([&](const auto& law) {
            auto one = law.at(at.surroundings);
            return law.template solve<line>(one, q_trial, alpha, k, yields, solves);
        });
    }
    template <class Real>
    PlasticWork<Real> work(const At<Real>& at, const Real& alpha, const Real& dalpha, const FlowStress<Real>& k,
                           const FlowStress<Real>& k_end) const {
        return visit<PlasticWork<Real>>(
            [&](const auto& law) { return law.work(law.at(at.surroundings), alpha, dalpha, k, k_end); });
    }
    template <class Real>
    Real thermal_part(const At<Real>& at, const Real& alpha, const Real& k) const {
        const auto* lund = std::get_if<Apart<SteinbergLund>>(&law_);
        return lund != nullptr ? lund->thermal_part(lund->at(at.surroundings), alpha, k) : Real(0.0);
    }
    // The law with a memory, or null.
    const DislocationHardening* dislocations() const {
        const auto* law = std::get_if<Apart<DislocationHardening>>(&law_);
        return law != nullptr ? law->dislocations() : nullptr;
    }
    bool is_thermal() const { return std::holds_alternative<Apart<SteinbergLund>>(law_); }
    bool is_softening() const {
        return std::visit([](const auto& law) { return law.softens; }, law_);
    }
    bool depends_on_rate() const {
        return std::visit([](const auto& law) { return law.feels_rate; }, law_);
    }
    double steepest_slope() const {
        return std::visit(
            [](const auto& law) {
                if constexpr (std::decay_t<decltype(law)>::softens) return law.steepest_slope();
                else return 0.0;
            },
            law_);
    }

  private:
    template <class Result, class F>
    Result visit(const F& f) const {
        return std::visit([&](const auto& law) -> Result { return f(law); }, law_);
    }

    LawVariant law_;
};

}  // namespace lode::iso_plastic
