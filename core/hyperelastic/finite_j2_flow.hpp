// The flow laws that finite-strain J2 plasticity serves, and how PROPS choose among them (page 55, section 1.1).
#pragma once

#include <variant>

#include "lode/hyperelastic/finite_j2.hpp"
#include "lode/plasticity/hardening_law_johnson_cook.hpp"

namespace lode::finite_j2 {

// HLAW = 3, at the temperature and rate of an increment.
struct JohnsonCookFlow {
    static constexpr bool yields = true, feels_temperature = true;
    JohnsonCook law;

    template <class Real>
    struct AtPoint {
        JohnsonCook law;
        JohnsonCook::At<Real> now;
        // Without time and strain nothing flows: hosts probe so, and the stress may be above the yield stress at rate
        // 0.
        Mask<Real> frozen;

        LODE_INLINE FlowStress<Real> start(const Real& alpha) const {
            FlowStress<Real> k = law.start(now, alpha);
            if (any(frozen)) [[unlikely]]
                k.value = select(frozen, Real(1e300), k.value);
            return k;
        }
        LODE_INLINE ReturnResult<Real> solve(const Real& q, const Real& stiffness, const Real& alpha,
                                             const FlowStress<Real>& k, const Mask<Real>& where,
                                             const SolveCounter<Real>& solves = {}) const {
            auto end = now;  // what the law notes there is not needed
            return law.solve_along(stiffness, Real(1.0 / stiffness), end, q, alpha, k, where, solves);
        }
        // dK/dtemperature at fixed dalpha.
        LODE_INLINE Real temperature_slope(const Real& alpha, const Real& dalpha, const Real& K) const {
            if (now.melted) return Real(0.0);
            const FlowStress<Real> end{K, Real(0.0), Real(0.0)};
            return law.slopes(now, alpha, dalpha, law.start(now, alpha), end).flow_temperature;
        }
    };
    template <AnalysisKind kind, class Real>
    LODE_INLINE AtPoint<Real> at(const Increment<kind, Real>& increment, const Real& temperature) const {
        Surroundings<Real> s;
        s.temperature = temperature;
        s.time = increment.time_increment;
        Mask<Real> frozen(false);
        if (s.time.value <= 0.0) {
            Real strain = abs(increment.strain_increment[0]);
            for (int i = 1; i < components(kind); ++i) strain = strain + abs(increment.strain_increment[i]);
            frozen = !(strain > Real(0.0));
        }
        return {law, law.at(s), frozen};
    }
};

// PROPS indices of HLAW, SY, H1 and TREF.
struct FlowIndices {
    int law, yield, first_constant, reference_temperature;
};

template <template <class> class Kernel>
using AnyKernel =
    std::variant<Kernel<NoFlow>, Kernel<StaticFlow<LinearHardening>>, Kernel<StaticFlow<NonlinearHardening>>,
                 Kernel<StaticFlow<PowerHardening>>, Kernel<JohnsonCookFlow>>;

// f(kernel). In this order GCC 12 keeps the points of all of them in registers; linear hardening first cost 160 memory
// accesses.
template <class Variant, class F>
LODE_INLINE void visit(const Variant& kernel, const F& f) {
    if (const auto* power = std::get_if<3>(&kernel)) return f(*power);
    if (const auto* johnson_cook = std::get_if<4>(&kernel)) return f(*johnson_cook);
    if (const auto* nonlinear = std::get_if<2>(&kernel)) return f(*nonlinear);
    if (const auto* linear = std::get_if<1>(&kernel)) return f(*linear);
    f(*std::get_if<0>(&kernel));
}

// make(flow) for the law that PROPS ask for. Throws BadProperty: softening, which these models do not serve, too.
template <class Result, class Make>
Result with_flow(const Properties& p, const FlowIndices& at, const Make& make) {
    const int law = p.code(at.law);
    const auto h = [&](int i) { return p[at.first_constant + i - 1]; };
    const auto need = [&](int i, bool holds, const char* allowed) {
        if (!holds) p.refuse(at.first_constant + i - 1, allowed);
    };
    if (law == -1) return make(NoFlow{});
    const double Y = p[at.yield];
    if (!(Y > 0.0)) p.refuse(at.yield, "> 0");
    switch (law) {
        case 0:
            return make(StaticFlow<LinearHardening>{{Y, 0.0}});
        case 1:
            need(1, h(1) >= 0.0, ">= 0: softening is not served");
            return make(StaticFlow<LinearHardening>{{Y, h(1)}});
        case 2:
            need(1, h(1) >= 0.0, ">= 0: softening is not served");
            need(2, h(2) >= 0.0, ">= 0: softening is not served");
            return make(StaticFlow<NonlinearHardening>{{Y, h(1), h(2)}});
        case 3:
            return make(JohnsonCookFlow{JohnsonCook(p, at.first_constant, Y, p[at.reference_temperature], 1.0, 1.0)});
        case 6:
            need(1, h(1) >= 0.0, ">= 0: softening is not served");
            need(2, h(2) > 0.0, "> 0");
            return make(StaticFlow<PowerHardening>{{Y, Y * h(1), h(2)}});
        default:
            p.refuse(at.law, "one of the laws -1, 0, 1, 2, 3, 6");
    }
}

}  // namespace lode::finite_j2
