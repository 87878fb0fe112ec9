// Increments that real analyses contain sooner or later: none at all, tiny, cut into pieces, far too large, not a
// number.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "../study/order.hpp"
#include "checks.hpp"
#include "child.hpp"

namespace lode::host {
namespace {

bool same_bits(const Numbers& a, const Numbers& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}
bool same_bits(const Components& a, const Components& b) {
    return a.size() == b.size() &&
           std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(double)) == 0;
}

std::string pnewdt_text(double pnewdt) { return fmt::format("PNEWDT = {:.4g}", pnewdt); }

}  // namespace

void check_zero_increment(const Subject& subject, CheckResult& result) {
    Bench bench(subject);
    const int n = bench.layout().size();
    double worst = 0;
    std::string at, not_finite, no_tangent, no_time, cut;
    int states = 0;
    const auto examine = [&](const CheckedState& state, const std::string& place) {
        const UmatCall call = bench.call_for(state, {Components::Zero(n), Matrix3::Identity(), 1});
        doing("a zero increment after " + place);
        const UmatAnswer answer = bench.call(call);
        ++states;
        if (!answer.returned) {
            if (not_finite.empty()) not_finite = "the library ends the analysis after " + place + ": " + answer.message;
            return;
        }
        if (answer.cut(call)) {
            if (cut.empty()) cut = pnewdt_text(answer.pnewdt) + " after " + place;
            return;
        }
        if (!answer.finite() && not_finite.empty()) not_finite = "STRESS or STATEV is not a number after " + place;
        if (!answer.tangent.allFinite() && no_tangent.empty()) no_tangent = "DDSDDE is not finite after " + place;
        UmatCall still = call;
        still.dtime = 0;
        doing("a zero increment with DTIME = 0 after " + place);
        const UmatAnswer timeless = bench.call(still);
        if (no_time.empty() && timeless.returned && answer.finite() &&
            (!timeless.finite() || !timeless.tangent.allFinite()))
            no_time = "STRESS, STATEV or DDSDDE is not finite with DTIME = 0 after " + place;
        if (subject.rate_dependent || subject.has_trait(LODE_VISCOUS) || !answer.finite()) return;
        const double change =
            largest(answer.stress - state.stress) / std::max(subject.stress_scale(), largest(state.stress));
        if (change <= worst) return;
        worst = change;
        at = place;
    };
    const CheckedState start = bench.start();
    // The stress at the start may be one that the material has to find first.
    if (subject.model == nullptr || !subject.has_trait(LODE_HISTORY_STRESS)) examine(start, "the start");
    for (const Situation& s : bench.situations()) {
        const CheckedState state = bench.after(s.call, s.answer);
        examine(state, where(s));
    }
    result.figures = subject.rate_dependent
                         ? fmt::format("{} states; the stress may relax, its change is not judged", states)
                         : fmt::format("{} states: the stress changes by {:.1e} of its scale at most", states, worst);
    if (!not_finite.empty()) result.fail("zero-increment-not-finite", not_finite);
    if (!no_tangent.empty()) result.fail("zero-increment-tangent", no_tangent);
    if (!no_time.empty()) result.warn("zero-time", no_time);
    if (!cut.empty()) result.fail("zero-increment-cut", cut);
    constexpr double allowed = 1e-6;
    if (worst > allowed) result.fail("zero-increment-changes-stress", fmt::format("by {:.1e} after {}", worst, at));
}

void check_tiny_increments(const Subject& subject, CheckResult& result) {
    Bench bench(subject);
    double worst = 0;
    std::string at, not_done;
    int increments = 0;
    for (const Situation& s : bench.situations()) {
        const CheckedState state = bench.after(s.call, s.answer);
        const UmatCall zero =
            bench.call_for(state, {Components::Zero(bench.layout().size()), Matrix3::Identity(), s.call.dtime});
        const UmatAnswer base = bench.call(zero);
        if (!base.done(zero)) continue;
        const Components direction = s.call.dstran / std::max(largest(s.call.dstran), 1e-300);
        for (const double size : {1e-6, 1e-9, 1e-12, 1e-15}) {
            const double length = size * subject.scale;
            const UmatCall call = bench.call_for(state, {direction * length, Matrix3::Identity(), s.call.dtime});
            const std::string place = fmt::format("a strain increment of {:.1e} after {}", length, where(s));
            doing(place);
            const UmatAnswer answer = bench.call(call);
            ++increments;
            if (!answer.done(call)) {
                if (not_done.empty())
                    not_done = place + (answer.returned && answer.finite() ? ": " + pnewdt_text(answer.pnewdt)
                                                                           : ": no finite answer");
                continue;
            }
            // Rounding of stress and of F, which is of order 1.
            const double rounding = 1e-11 * std::max(subject.stress_scale(), largest(state.stress)) +
                                    (subject.reads_gradient ? 1e-14 * subject.stiffness : 0);
            // Contact may be far stiffer than the start. A jump is steeper than any stiffness.
            const double stiffness =
                std::max({subject.stiffness, base.tangent.cwiseAbs().maxCoeff(), answer.tangent.cwiseAbs().maxCoeff()});
            const double steep = (largest(answer.stress - base.stress) - rounding) / (stiffness * length);
            if (steep <= worst) continue;
            worst = steep;
            at = place;
        }
    }
    result.figures = fmt::format("{} increments down to 1e-15 of the scale; slope at most {:.2g} times the stiffness",
                                 increments, std::max(worst, 0.0));
    if (increments == 0) return result.skip("no increment of the path could be done");
    if (!not_done.empty()) result.fail("tiny-increment-fails", not_done);
    constexpr double jump = 1e3;
    if (worst > jump) result.fail("stress-jumps", fmt::format("{:.2g} times the stiffness at {}", worst, at));
}

void check_splitting(const Subject& subject, CheckResult& result) {
    Bench bench(subject);
    const int n = bench.layout().size();
    Random random(11);
    Components a = random.direction(n), b = random.direction(n);
    if (bench.layout().cohesive()) {
        a[0] = std::abs(a[0]);
        b[0] = std::abs(b[0]);
    }
    // From one loading straight into another: the direction changes at the corner and inside the second leg.
    const CheckedState start = bench.start();
    const auto stress_in = [&](int increments) -> std::optional<Components> {
        doing(fmt::format("the same path in {} increments", 2 * increments));
        CheckedState state = start;
        for (const Components& leg : {Components(a), Components(b)})
            for (int i = 0; i < increments; ++i)
                if (!bench.advance(state, {leg * (subject.scale / increments), Matrix3::Identity(), 1.0 / increments}))
                    return std::nullopt;
        return state.stress;
    };
    const std::optional<Components> exact = stress_in(2048);
    if (!exact) return result.skip("the path could not be followed in 4096 increments");
    const double size = std::max(subject.stress_scale(), largest(*exact));
    std::vector<ErrorAt> errors;
    Curve curve{"Splitting the increment", "increments", "error of STRESS / stress scale", "corner path", {}, {}};
    double coarsest = 0, finest = 0;
    for (int increments = 1; increments <= 256; increments *= 2) {
        const std::optional<Components> stress = stress_in(increments);
        if (!stress) continue;
        finest = largest(*stress - *exact) / size;
        if (errors.empty()) coarsest = finest;
        errors.push_back({increments, finest});
        curve.x.push_back(2 * increments);
        curve.y.push_back(std::max(finest, 1e-17));
    }
    if (errors.size() < 3) return result.skip("the path cannot be followed in large increments");
    result.curves.push_back(std::move(curve));
    const std::optional<double> order = fitted_order(errors, 1e-13);
    result.figures =
        fmt::format("error {:.1e} in {} increments, {:.1e} in 512", coarsest, 2 * errors.front().increments, finest);
    if (order) result.figures += fmt::format("; order {:.1f}", *order);
    else if (coarsest < 1e-9) result.figures += "; independent of the splitting";
    // Half of first order is what a path with events may show over a few refinements.
    constexpr double least_order = 0.5, small = 1e-3;
    if (finest > small && order && *order < least_order) result.fail("splitting-does-not-converge", result.figures);
    else if (finest > 0.1) result.warn("splitting-does-not-converge", result.figures);
}

void check_cut_back(const Subject& subject, CheckResult& result) {
    Bench bench(subject);
    int asked = 0, tried = 0;
    std::string changed, invalid, above;
    double smallest = HUGE_VAL;
    for (const Situation& s : bench.situations()) {
        CheckedState state = bench.after(s.call, s.answer);
        if (subject.recorded != nullptr) state = bench.start();
        for (double factor = 1; factor <= 1e4; factor *= 10) {
            const UmatCall call = bench.call_for(
                state, {s.call.dstran * (factor * subject.scale / std::max(largest(s.call.dstran), 1e-300)),
                        Matrix3::Identity(), s.call.dtime});
            if (largest(call.dstran) > 3 && !bench.layout().cohesive()) break;
            const std::string place =
                fmt::format("a strain increment of {:.2g} after {}", largest(call.dstran), where(s));
            doing(place);
            const UmatAnswer answer = bench.call(call);
            ++tried;
            if (!answer.returned) continue;
            if (!(answer.pnewdt > 0) && answer.pnewdt != call.pnewdt && invalid.empty())
                invalid = pnewdt_text(answer.pnewdt) + " at " + place;
            if (answer.pnewdt > 1 && above.empty()) above = pnewdt_text(answer.pnewdt) + " at " + place;
            if (!answer.cut(call)) continue;
            ++asked;
            smallest = std::min(smallest, answer.pnewdt);
            if (!changed.empty()) continue;
            if (!same_bits(answer.stress, call.stress)) changed = "STRESS at " + place;
            else if (!same_bits(answer.statev, call.statev)) changed = "STATEV at " + place;
        }
    }
    result.figures = asked == 0 ? fmt::format("{} increments, none asks for a smaller one", tried)
                                : fmt::format("{} of {} increments ask for a smaller one, PNEWDT down to {:.3g}", asked,
                                              tried, smallest);
    if (!invalid.empty()) result.fail("pnewdt-invalid", invalid);
    if (!above.empty()) result.warn("pnewdt-above-one", above);
    if (!changed.empty()) result.warn("state-changed-on-cut", changed + " with PNEWDT < 1");
}

void check_nan(const Subject& subject, CheckResult& result) {
    Bench bench(subject);
    const std::vector<Situation> situations = bench.situations();
    if (situations.empty()) return result.skip("no increment of the path could be done");
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    int ended = 0, asked = 0, passed_on = 0, calls = 0;
    std::string swallowed;
    // First, last and some between.
    for (std::size_t k = 0; k < situations.size(); k += std::max<std::size_t>(1, situations.size() / 6)) {
        const Situation& s = situations[k];
        for (int component = 0; component < bench.layout().size(); ++component) {
            UmatCall call = s.call;
            call.dstran[component] = nan;
            if (!bench.layout().cohesive()) {
                const auto [i, j] = bench.layout().position(component);
                call.dfgrd1(i, j) = nan;
            }
            const std::string place = fmt::format("DSTRAN({}) = NaN at {}", component + 1, where(s));
            doing(place);
            const UmatAnswer answer = bench.call(call);
            ++calls;
            if (!answer.returned) ++ended;
            else if (answer.cut(call)) ++asked;
            else if (!answer.finite()) ++passed_on;
            else if (swallowed.empty()) swallowed = place;
        }
    }
    result.figures = fmt::format("{} calls: {} end the analysis, {} ask for a smaller increment, {} return NaN", calls,
                                 ended, asked, passed_on);
    if (!swallowed.empty()) result.fail("nan-swallowed", swallowed + " gives a finite stress");
}

void check_absurd_increments(const Subject& subject, CheckResult& result) {
    Bench bench(subject);
    const std::vector<Situation> situations = bench.situations();
    if (situations.empty()) return result.skip("no increment of the path could be done");
    int calls = 0, done = 0, cut = 0, ended = 0;
    std::string bad, bad_tangent;
    constexpr double most = 30;
    std::vector<double> sizes{10 * subject.scale, 100 * subject.scale, 1e4 * subject.scale};
    for (const double strain : {0.5, 3.0, most})
        sizes.push_back(strain * (subject.cohesive() ? subject.element_length : 1));
    for (std::size_t k = 0; k < situations.size(); k += std::max<std::size_t>(1, situations.size() / 6)) {
        const Situation& s = situations[k];
        const Components direction = s.call.dstran / std::max(largest(s.call.dstran), 1e-300);
        for (const double size : sizes)
            for (const double sign : {1.0, -1.0}) {
                if (size > most && !subject.cohesive()) continue;
                const CheckedState state = bench.after(s.call, s.answer);
                const UmatCall call = bench.call_for(state, {direction * (sign * size), Matrix3::Identity(), 1});
                // What exp() of such a strain cannot hold is no deformation.
                if (!call.dfgrd1.allFinite() || !(call.dfgrd1.determinant() > 1e-12)) continue;
                const std::string place = fmt::format("a strain increment of {:.2g} after {}", sign * size, where(s));
                doing(place);
                const UmatAnswer answer = bench.call(call);
                ++calls;
                if (!answer.returned) ++ended;
                else if (answer.cut(call)) ++cut;
                else if (!answer.finite()) {
                    if (bad.empty()) bad = place;
                } else {
                    ++done;
                    if (!answer.tangent.allFinite() && bad_tangent.empty()) bad_tangent = place;
                }
            }
    }
    result.figures = fmt::format(
        "{} calls with strains up to 30: {} done, {} ask for a smaller increment, {} end the "
        "analysis",
        calls, done, cut, ended);
    if (!bad.empty()) result.fail("absurd-increment-not-finite", "STRESS or STATEV is not a number at " + bad);
    if (!bad_tangent.empty()) result.fail("absurd-increment-not-finite", "DDSDDE is not finite at " + bad_tangent);
    if (ended > 0) result.warn("absurd-increment-ends-analysis", fmt::format("{} of {} calls", ended, calls));
}

}  // namespace lode::host
