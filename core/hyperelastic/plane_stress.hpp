// Plane stress of hyperelastic laws: the thickness stretch F33* = exp(y) that makes the stress 33 vanish, and the
// condensation of tangents (page 50, section 1.6).
#pragma once

#include "lode/hyperelastic/residual_strain.hpp"
#include "lode/numerics/root.hpp"

namespace lode {

// A solution y of tau33(y) = 0, with F33* - 1 to full relative accuracy.
template <class Real>
struct ThicknessStretch {
    Real y, d;  // ln F33*, F33* - 1
    Mask<Real> converged;
};

namespace thickness_detail {

// Newton's step, and the sign of the residual, which is all that a bracket needs: the tolerance is then one of y.
template <class Real, class F>
LODE_INLINE Residual<Real> step_of(const F& residual, const Real& y) {
    const Residual<Real> r = residual(y);
    const Real slope = abs(r.slope);
    return {r.value / slope, select(r.slope > Real(0.0), Real(1.0), Real(-1.0))};
}

// Where Newton's steps from the start do not shrink: steps away until the residual, taken as increasing, changes sign,
// then a safeguarded search. All arguments by value: nothing of the caller has to live in memory.
template <class Real, class F>
[[gnu::noinline]] Root<Real> search(const F residual, const Real start, const Real tolerance, const Mask<Real> active) {
    constexpr double farthest = 40.0;
    const auto step = [&residual](const Real& y) { return step_of(residual, y); };
    const Mask<Real> falls = residual(start).value > Real(0.0);
    Real lower = start, upper = start;
    Mask<Real> open = active;
    for (double stride = 0.25; any(open); stride *= 2.0) {
        lower = select(open && falls, lower - stride, lower);
        upper = select(open && !falls, upper + stride, upper);
        const Real value = residual(select(falls, lower, upper)).value;
        const Mask<Real> crossed = (falls && value <= Real(0.0)) || (!falls && value >= Real(0.0));
        open = open && !crossed;
        const Mask<Real> in_reach = max(abs(lower), abs(upper)) < Real(farthest);
        if (!any(open && in_reach)) break;
    }
    Root<Real> root = solve_bracketed(step, lower, upper, 0.5 * (lower + upper), tolerance, active && !open);
    root.converged = root.converged && active && !open;
    return root;
}

}  // namespace thickness_detail

// Solves residual(y).value = 0, a function object that holds what it needs by value; `residual` is tau33 and its
// derivative by y. Newton from `start`; the search above takes the lanes in which the steps do not shrink. `scale` is
// the size of the in-plane strain: the last step is below 1e-8 of it, what is left after it is of its square.
template <class Real, class F>
LODE_INLINE ThicknessStretch<Real> solve_thickness(const F& residual, const Real& start, const Real& scale,
                                                   const SolveCounter<Real>& solves) {
    constexpr int newton_limit = 9;
    const Real tolerance = 1e-8 * min(scale, Real(1.0));
    Real y = start, last(1.0);
    Mask<Real> done(false), regular = is_finite(start) && is_finite(scale);
    int iteration = 1;
    for (; iteration <= newton_limit; ++iteration) {
        const Residual<Real> r = residual(y);
        const Real step = r.value / r.slope;
        // A root that Newton approaches, from a side where the residual increases.
        regular = regular && (done || (abs(step) <= last && r.slope > Real(0.0)));
        const Mask<Real> go_on = regular && !done;
        // Derivatives lag one step behind the value: a differentiated number takes one more.
        if (is_differentiated<Real> && all(done)) {
            y = y - step;
            break;
        }
        y = select(go_on, y - step, y);
        done = done || (go_on && abs(step) <= tolerance);
        last = select(go_on, max(0.7 * abs(step), tolerance), last);
        if (!is_differentiated<Real> && all(done || !regular)) break;
    }
    solves.count(iteration);
    if (!all(done)) [[unlikely]] {
        const Mask<Real> active = !done && is_finite(start) && is_finite(scale);
        const Root<Real> root = thickness_detail::search<Real, F>(residual, start, Real(1e-7 * tolerance), active);
        solves.count(root.iterations, root.iterations);  // none of them is Newton's from the start
        y = select(active, root.x, y);
        done = done || root.converged;
    }
    return {y, expm1(y), done};
}

// The start of the search: what STATEV says the thickness was, without residual strain e.
template <class Real>
LODE_INLINE Real thickness_of_state(const Real& f33m1, const Real& e) {
    const Mask<Real> possible = f33m1 > Real(-1.0) && f33m1 < Real(1e30);
    return select(possible, log1p(select(possible, f33m1, Real(0.0))) - e, Real(0.0));
}

// Drops component 33 in plane stress.
template <AnalysisKind kind, class Real>
LODE_INLINE Stress<kind, Real> without_thickness(const Stress<with_thickness(kind), Real>& s) {
    if constexpr (kind == AnalysisKind::plane_stress) {
        Stress<kind, Real> r;
        r[0] = s[0];
        r[1] = s[1];
        r[2] = s[3];
        return r;
    } else {
        return s;
    }
}

// Writes DDSDDE and DDSDDT. `fill(c)` sets the tangent of the kind with thickness; `thermal(c)` returns
// d sigma/d temperature at fixed F and is called if there is any. Plane stress: C_ab - C_a3 C_3b/C_33, and the
// thickness follows the temperature so that the stress 33 stays zero (section 1.8).
template <AnalysisKind kind, class Fill, class Thermal>
LODE_INLINE void set_tangent_of_kind(Tangent<kind>& tangent, const Stress<kind, double>& stress, bool is_thermal,
                                     const Fill& fill, const Thermal& thermal) {
    if constexpr (kind != AnalysisKind::plane_stress) {
        fill(tangent);
        if (!is_thermal) return;
        const Stress<kind, double> s = thermal(tangent);
        for (int i = 0; i < components(kind); ++i) tangent.thermal_stress[i] = s[i];
    } else {
        constexpr int in_plane[] = {0, 1, 3};
        double entries[16];
        Tangent<AnalysisKind::plane_strain> c{entries};
        fill(c);
        const double flexibility = 1.0 / c(2, 2);
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 3; ++i)
                tangent(i, j) = c(in_plane[i], in_plane[j]) - c(in_plane[i], 2) * (c(2, in_plane[j]) * flexibility);
        if (!is_thermal) return;
        const Stress<AnalysisKind::plane_strain, double> s = thermal(c);
        for (int i = 0; i < 3; ++i)
            tangent.thermal_stress[i] = s[in_plane[i]] - (c(in_plane[i], 2) - stress[i]) * (s[2] * flexibility);
    }
}

// d sigma/d temperature of an isotropic law, -alpha (C : 1 - 3 sigma).
template <AnalysisKind kind>
LODE_INLINE Stress<kind, double> isotropic_thermal_stress(double alpha, const Tangent<kind>& c,
                                                          const Stress<kind, double>& stress) {
    Stress<kind, double> s;
    for (int i = 0; i < components(kind); ++i) s[i] = -alpha * (c(i, 0) + c(i, 1) + c(i, 2) - 3.0 * stress[i]);
    return s;
}

}  // namespace lode
