#include "reference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "variants.hpp"

namespace lode::host {
namespace {

constexpr double rounding = 1e-11;  // runs that agree to this are the same
constexpr double tight_tolerance = 1e-12;
constexpr int most_increments = 60000;  // of the coarsest run, all steps together
constexpr int usual_increments = 512;

// a + factor (b - a) where both have the same time.
Trace combined(const Trace& coarse, const Trace& fine, double factor) {
    Trace result = coarse;
    auto other = fine.points.begin();
    for (TracePoint& p : result.points) {
        while (other != fine.points.end() && other->time < p.time * (1 - 1e-12)) ++other;
        if (other == fine.points.end()) break;
        for (std::size_t i = 0; i < 6; ++i) {
            p.stress[i] += factor * (other->stress[i] - p.stress[i]);
            p.strain[i] += factor * (other->strain[i] - p.strain[i]);
        }
        p.energies.plastic += factor * (other->energies.plastic - p.energies.plastic);
        p.energies.creep += factor * (other->energies.creep - p.energies.creep);
    }
    return result;
}

// Times of `grid` only.
Trace at_times_of(const Trace& fine, const Trace& grid) { return combined(grid, fine, 1); }

}  // namespace

Reference make_reference(const Scenario& scenario, const Library& library, double order, int multiple_of) {
    Scenario tight = scenario;
    tight.analysis.tolerance = std::min(scenario.analysis.tolerance, tight_tolerance);
    const int steps = static_cast<int>(scenario.steps.size());
    int n = multiple_of;
    while (n < usual_increments && 2 * n * steps <= most_increments) n *= 2;

    Reference reference;
    reference.increments = n;
    reference.compare_strain = stress_controlled(scenario) && !gradient_controlled(scenario);
    const auto run = [&](int increments) { return follow(with_increments(tight, increments), library); };
    const auto apart = [&](const Trace& a, const Trace& b) {
        return difference(a, b, reference.compare_strain).worst();
    };

    const Trace once = run(n), twice = run(2 * n);
    reference.trace = twice;
    if (!once.complete() || !twice.complete()) {
        reference.trace = once.complete() ? twice : once;
        return reference;
    }
    const double first = apart(once, twice);
    // Stresses that were asked for are met to the host's tolerance only.
    if (first <= (reference.compare_strain ? tight_tolerance * 10 : rounding)) {
        reference.trace = at_times_of(twice, once);
        reference.estimate = first;
        reference.how = "exact to rounding";
        if (difference(once, twice, false).dissipation <= rounding) return reference;
        // Stresses are exact, energies are not.
        const Trace finest = run(4 * n);
        if (!finest.complete()) return reference;
        const double p = std::isfinite(order) ? order : 1;
        reference.trace = combined(reference.trace, finest, 1 + 1 / (std::exp2(p) - 1));
        return reference;
    }
    const Trace finest = run(4 * n);
    if (!finest.complete()) {
        reference.trace = finest;
        return reference;
    }
    const double second = apart(twice, finest);
    const double observed = second > 0 ? std::log2(first / second) : order;
    const double p = std::isfinite(order) ? order : std::clamp(observed, 0.5, 8.0);
    const double factor = 1 / (std::exp2(p) - 1);
    const Trace coarse = combined(once, twice, 1 + factor);
    const Trace fine = combined(at_times_of(twice, once), finest, 1 + factor);
    const double between = apart(coarse, fine), left = factor * second;
    if (between < left) {
        reference.trace = fine;
        reference.estimate = between;
        reference.how = fmt::format("extrapolated from {} and {} increments a step with order {:.3g}", 2 * n, 4 * n, p);
    } else {
        reference.smooth = false;
        reference.trace = at_times_of(finest, once);
        reference.estimate = std::max(left, 0.0);
        reference.how = fmt::format("{} increments a step; too rough to extrapolate", 4 * n);
    }
    reference.trace.outcome = finest.outcome;
    return reference;
}

}  // namespace lode::host
