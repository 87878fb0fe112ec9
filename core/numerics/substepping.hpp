// Error-controlled substepping of an increment, generic in the state.
#pragma once

#include <algorithm>
#include <cmath>

#include "lode/numerics/scalar.hpp"

namespace lode {

template <class State>
struct DoubledSubsteps {
    State state;
    int substeps;       // of `state`
    double difference;  // between the last two refinements
    bool converged;     // difference <= tolerance
};

// Equal substeps, doubled until two refinements agree: state of 2N substeps with difference(2N, N) <= tolerance, and 2N
// at most `limit`. `integrate(N)` returns the state after N equal substeps from the start of the increment,
// `difference(fine, coarse)` a number. Page 70, `stol`.
template <class Integrate, class Difference>
inline auto double_substeps(const Integrate& integrate, const Difference& difference, double tolerance, int start = 1,
                            int limit = 1024) -> DoubledSubsteps<decltype(integrate(1))> {
    auto coarse = integrate(start);
    for (int n = start;;) {
        n *= 2;
        auto fine = integrate(n);
        const double change = difference(fine, coarse);
        if (change <= tolerance || 2 * n > limit) return {fine, n, change, change <= tolerance};
        coarse = fine;
    }
}

struct SubstepControl {
    double tolerance = 1e-6;   // on the error measure of one substep
    double first = 1.0;        // first substep, as a part of the increment
    double smallest = 1e-6;    // below this the increment is given up
    int max_substeps = 10000;  // evaluated, accepted or not
};

template <class State>
struct SubsteppedState {
    State state;
    int accepted, rejected;
    bool completed;  // false: stopped before the end, at the smallest substep or the largest number of them
};

// Modified Euler with an embedded error estimate over pseudo-time 0..1: k1 = rate(s), k2 = rate(s + h k1),
// s <- s + h (k1 + k2)/2, err = error(h (k2 - k1)/2, new state). A substep is accepted if err <= tolerance; the next is
// min(0.9 sqrt(tolerance/err), 2) times as long, after a rejection not longer, and never less than a tenth.
// `accept(state)` is called after every accepted substep, e.g. to pull the state back to a yield surface. State and
// rate need +, - and multiplication from the left by a number of the kind that `error` returns. Source: Sloan (1987);
// page 20, section 6.
template <class State, class Rate, class Error, class Accept>
inline SubsteppedState<State> modified_euler(const State& start, const Rate& rate, const Error& error,
                                             const Accept& accept, const SubstepControl& control = {}) {
    SubsteppedState<State> s{start, 0, 0, false};
    using Number = decltype(error(0.5 * (rate(start) - rate(start)), start));
    Number time(0.0), h(std::min(1.0, control.first)), growth(2.0);
    for (int substep = 0; substep < control.max_substeps; ++substep) {
        const bool last = h >= Number(1.0 - time);
        if (last) h = 1.0 - time;
        const auto k1 = rate(s.state);
        const State predictor = s.state + h * k1;
        const auto k2 = rate(predictor);
        const State next = s.state + (0.5 * h) * (k1 + k2);
        const Number err = error((0.5 * h) * (k2 - k1), next);
        const Number factor = err > Number(0.0) ? Number(0.9 * sqrt(control.tolerance / err)) : Number(2.0);
        if (err <= Number(control.tolerance)) {
            s.state = next;
            accept(s.state);
            ++s.accepted;
            if (last) {
                s.completed = true;
                return s;
            }
            time = time + h;
            h = h * min(factor, growth);
            growth = Number(2.0);
        } else {
            ++s.rejected;
            if (h <= Number(control.smallest)) return s;
            h = max(h * max(min(factor, Number(1.0)), Number(0.1)), Number(control.smallest));
            growth = Number(1.0);
        }
    }
    return s;
}
template <class State, class Rate, class Error>
inline SubsteppedState<State> modified_euler(const State& start, const Rate& rate, const Error& error,
                                             const SubstepControl& control = {}) {
    return modified_euler(
        start, rate, error, [](State&) {}, control);
}

}  // namespace lode
