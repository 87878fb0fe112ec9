// Safeguarded solution of one scalar equation: Newton inside a closed bracket with a change of sign.
//
// While Newton's iterates stay in the bracket and halve the residual nothing else happens (two comparisons an
// iteration). A lane for which that fails becomes guarded: it keeps a bracket whose ends have residuals of opposite
// sign, takes Newton's step only when that stays inside, halved the residual and is half the last step, and bisects
// otherwise. A residual that is not finite counts as a step that left the bracket. From iteration `bisection_only` on
// the bracket is bisected, over magnitudes where its ends differ in magnitude, so it shrinks to rounding level within
// 100 evaluations whatever the function and the bracket (any finite doubles). The iterates of a lane do not depend on
// the other lanes of its batch.
#pragma once

#include <optional>

#include "lode/numerics/scalar.hpp"
#include "lode/numerics/solve_counter.hpp"

namespace lode {

template <class Real>
struct Residual {
    Real value, slope;
};
// With the second derivative the iterates are Halley's, of third order, at the price of a few multiplications.
template <class Real>
struct CurvedResidual {
    Real value, slope, curvature;
};

template <class Real, class R = Residual<Real>>
struct Root {
    Real x;
    Mask<Real> converged;  // true in lanes that were not active
    int iterations;        // evaluations of the residual
    R last;                // what the residual returned at x
    int safeguards = 0;    // steps that were not Newton's; not counted in batches
};

// What the caller knows of the sign at the ends. `unknown` costs one more evaluation, and only if Newton is not enough.
enum class Slope { unknown, increasing, decreasing };

namespace root_detail {

inline constexpr double epsilon = std::numeric_limits<double>::epsilon();
inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr int unguarded = 6;        // Newton's iterations before the bracket must shrink as well
inline constexpr int wide_bisection = 12;  // from here on a bracket is bisected over magnitudes
inline constexpr int bisection_only = 30;

// Middle of the bracket: the arithmetic mean, or for a bracket that spans magnitudes zero first, then geometric means.
template <class Real>
inline Real middle(const Real& lower, const Real& upper, bool over_magnitudes) {
    const Real arithmetic = 0.5 * lower + 0.5 * upper;
    if (!over_magnitudes) return arithmetic;
    const Real smallest(1e-307);
    const Real a = abs(lower), b = abs(upper);
    const Real small = max(min(a, b), smallest), large = max(max(a, b), smallest);
    const Real size = sqrt(small) * sqrt(large);
    const Real geometric = select(upper > Real(0.0), size, -size);
    const Mask<Real> straddles = lower < Real(0.0) && upper > Real(0.0);
    return select(straddles, Real(0.0), select(large > 4.0 * small, geometric, arithmetic));
}

// The bracket of the guarded lanes. An end that has not been evaluated has an infinite size.
template <class Real>
struct Guard {
    using M = Mask<Real>;
    Real lower, upper;
    Real lower_size = Real(infinity), upper_size = Real(infinity);  // |residual|
    M active = M(false);                                            // guarded lanes
    M known, increasing;                                            // sign at the ends
    M probing = M(false);                                           // the current iterate is an end of the bracket
    Real saved_x = Real(0.0), saved_value = Real(0.0);
    Real last_step = Real(infinity);
    Real nudge = Real(2.0 * epsilon);

    Guard(const Real& l, const Real& u, Slope slope)
        : lower(l), upper(u), known(slope != Slope::unknown), increasing(slope == Slope::increasing) {}
};

// One iteration of the guarded lanes `here`: next iterate in `x`, residual to compare with in `previous`; returns the
// lanes whose bracket has shrunk to rounding level, with x its better end.
template <class Real>
inline Mask<Real> guarded_step(Guard<Real>& g, const Mask<Real>& here, int iteration, const Residual<Real>& r,
                               const Real& newton, Real& x, Real& previous) {
    using M = Mask<Real>;
    const Real zero(0.0);

    // An end was evaluated: its sign says which end is positive. Without a value there, the other end is asked.
    const M at_end = here && g.probing;
    const M probed = at_end && r.value == r.value;
    if (any(at_end)) {
        const M at_lower = x == g.lower;
        const M rises = (at_lower && r.value < zero) || (!at_lower && r.value > zero);
        g.increasing = (probed && rises) || (!probed && g.increasing);
        g.lower_size = select(probed && at_lower, abs(r.value), g.lower_size);
        g.upper_size = select(probed && !at_lower, abs(r.value), g.upper_size);
        g.known = g.known || probed;
        g.probing = g.probing && !probed;
        x = select(at_end && !probed, select(at_lower, g.upper, g.lower), x);
    }
    const Real at = select(probed, g.saved_x, x);
    const Real value = select(probed, g.saved_value, r.value);
    const Real size = abs(value);

    // No value here and none known elsewhere: the ends must tell which of them to replace.
    const M lost = here && !(value == value) && !(min(g.lower_size, g.upper_size) < Real(infinity));
    g.known = g.known && !lost;

    // The sign is needed and not known: look at the end through which Newton leaves.
    const M probe = here && !g.known && !g.probing;
    if (any(probe)) {
        g.saved_x = select(probe, x, g.saved_x);
        g.saved_value = select(probe, r.value, g.saved_value);
        g.probing = g.probing || probe;
        x = select(probe, select(newton > g.upper, g.upper, g.lower), x);
    }

    // Shrink the bracket. A residual without a value replaces the end that has none either.
    const M update = here && g.known;
    const M number = value == value;
    const M beyond = (g.increasing && value > zero) || (!g.increasing && value < zero);
    const M keep_lower = g.lower_size < Real(infinity);
    const M to_upper = (number && beyond) || (!number && keep_lower);
    const Real new_size = select(number, size, Real(infinity));
    g.upper = select(update && to_upper, at, g.upper);
    g.lower = select(update && !to_upper, at, g.lower);
    g.upper_size = select(update && to_upper, new_size, g.upper_size);
    g.lower_size = select(update && !to_upper, new_size, g.lower_size);

    const Real magnitude = max(abs(g.lower), abs(g.upper));
    const Real width = g.upper - g.lower;
    const M closed = update && width <= max(4.0 * epsilon * magnitude, Real(std::numeric_limits<double>::min()));

    // Newton's step, a step of at least rounding size across the root, or bisection.
    const Real step = abs(newton - at);
    const bool may_extrapolate = iteration < bisection_only;
    const M sound = number && !probed && M(may_extrapolate);
    const M accept =
        sound && newton > g.lower && newton < g.upper && size <= 0.5 * previous && step <= 0.5 * g.last_step;
    const M tiny = sound && step <= 2.0 * epsilon * abs(at) && is_finite(r.slope);
    const Real shift = g.nudge * abs(at);
    const Real pushed = at + select(to_upper, -shift, shift);
    const M push = tiny && pushed > g.lower && pushed < g.upper;
    g.nudge = select(update && push, 2.0 * g.nudge, g.nudge);
    Real next = select(accept, newton, middle(g.lower, g.upper, iteration >= wide_bisection));
    next = select(push, pushed, next);
    g.last_step = select(update, abs(next - at), g.last_step);
    previous = select(update, select(number, size, Real(infinity)), previous);

    next = select(closed, select(g.lower_size <= g.upper_size, g.lower, g.upper), next);
    x = select(update, next, x);
    return closed;
}

// x - f/f', or x - f f'/(f'^2 - f f''/2).
template <class Real, class R>
LODE_INLINE Real newton_iterate(const Real& x, const R& r) {
    if constexpr (requires { r.curvature; })
        return x - r.value * r.slope / (r.slope * r.slope - 0.5 * r.value * r.curvature);
    else return x - r.value / r.slope;
}

// Where the iterations stand.
template <class Real>
struct Progress {
    Real x, previous;         // iterate, |residual| before it
    Residual<Real> residual;  // at x
    Real newton;              // the next iterate, if it is `good`
    Mask<Real> done, good, found;
    int iteration;
    int safeguards = 0;  // steps so far that were not Newton's, of a lane by itself
};

// One iteration where Newton alone is not enough. Out of line, and everything else by value, so that the common path
// keeps its registers.
template <class Real>
[[gnu::noinline]] Progress<Real> advance(Guard<Real>& guard, Progress<Real> at) {
    using M = Mask<Real>;
    const M guarded = !at.done && (guard.active || !(at.good && M(at.iteration <= unguarded)));
    const M plain = !at.done && !guarded;
    guard.active = guard.active || guarded;
    Real next = at.x, last = at.previous;
    const M closed = guarded_step(guard, guarded, at.iteration, at.residual, at.newton, next, last);
    if constexpr (!is_batch<Real>) at.safeguards += guarded && !closed && next != at.newton ? 1 : 0;
    at.x = select(at.done, at.x, select(plain, at.newton, next));
    at.previous = select(plain, abs(at.residual.value), last);
    at.done = at.done || closed;
    at.found = at.found || (closed && min(guard.lower_size, guard.upper_size) < Real(infinity));
    return at;
}

// The residual is evaluated in one place: two copies of it could round differently, and the answer of a lane would
// depend on its neighbours.
template <Slope direction, class Real, class F>
LODE_INLINE auto solve(const F& residual, const Real& lower, const Real& upper, const Real& start,
                       const Real& tolerance, const Mask<Real>& active, int max_iterations) {
    using M = Mask<Real>;
    using R = decltype(residual(start));
    Real x = select(start > lower, start, lower);
    x = select(x < upper, x, upper);
    x = select(active, x, start);
    Real previous(infinity);
    M done = !active, found = done;
    std::optional<Guard<Real>> guard;
    int safeguards = 0;
    for (int iteration = 1;; ++iteration) {
        const R r = residual(x);
        const Real size = abs(r.value);
        const M small = !done && size <= tolerance;
        done = done || small;
        found = found || small;
        if (all(done) || iteration >= max_iterations) return Root<Real, R>{x, found, iteration, r, safeguards};
        const Real newton = newton_iterate(x, r);
        const M good = newton >= lower && newton <= upper && size <= 0.5 * previous;
        if (guard || iteration > unguarded || !all(done || good)) [[unlikely]] {
            if (!guard) guard.emplace(lower, upper, direction);
            const Progress<Real> next = advance<Real>(
                *guard, {x, previous, {r.value, r.slope}, newton, done, good, found, iteration, safeguards});
            x = next.x, previous = next.previous, done = next.done, found = next.found;
            safeguards = next.safeguards;
        } else {
            x = select(done, x, newton);
            previous = size;
        }
    }
}

}  // namespace root_detail

// Solves residual(x).value = 0 for x in [lower, upper] (both finite), where the residuals of the ends have opposite
// signs or one of them is zero. `residual(Real)` returns Residual<Real>, CurvedResidual<Real> or
// anything with these members; it is called at most once an
// iteration and never outside the bracket. Stops where |value| <= tolerance, or where a bracket with a change of sign
// has shrunk to rounding level. Lanes that are not `active` return `start`. An automatic-differentiation number is
// solved for its value; the derivatives follow from the implicit function theorem, dx = -d(residual at fixed x)/slope.
// Source: rtsafe (Press et al., Numerical Recipes, 9.4) and Brent (1973, ch. 4) for the safeguards.
template <Slope direction = Slope::unknown, class Real, class F>
LODE_INLINE auto solve_bracketed(const F& residual, const Real& lower, const Real& upper, const Real& start,
                                 const Real& tolerance, const Mask<Real>& active = Mask<Real>(true),
                                 int max_iterations = 100) {
    if constexpr (is_differentiated<Real>) {
        using R = decltype(residual(start));
        if (!active) return Root<Real, R>{start, true, 0, residual(start)};
        const auto plain = [&](double x) {
            const R r = residual(Real(x));
            return Residual<double>{value_of(r.value), value_of(r.slope)};
        };
        const Root<double> root = root_detail::solve<direction, double>(
            plain, value_of(lower), value_of(upper), value_of(start), value_of(tolerance), true, max_iterations);
        const R r = residual(Real(root.x));
        const Real x = Real(root.x) - (r.value - Real(value_of(r.value))) / Real(value_of(r.slope));
        return Root<Real, R>{x, root.converged, root.iterations, residual(x), root.safeguards};
    } else {
        return root_detail::solve<direction, Real>(residual, lower, upper, start, tolerance, active, max_iterations);
    }
}

}  // namespace lode
