// SSE + SPD + SCD against the work of the stresses.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "checks.hpp"
#include "child.hpp"

namespace lode::host {
namespace {

struct Balance {
    bool done = false;
    double error = 0, work = 0;                   // work: sum of magnitudes
    double stored = 0, dissipated = 0, drop = 0;  // drop: largest decrease of SPD + SCD
    double fraction() const { return work > 0 ? error / work : 0; }
};

// Loading, turning and partial unloading, smooth, in so many increments.
Balance balance(Bench& bench, int increments, double amplitude, std::uint64_t seed) {
    Random random(seed);
    const int n = bench.layout().size();
    Components a = random.direction(n), b = random.direction(n);
    if (bench.layout().cohesive()) {
        a[0] = std::abs(a[0]);
        b[0] = std::abs(b[0]);
    }
    const auto strain = [&](int i) -> Components {
        const double t = static_cast<double>(i) / increments;
        return amplitude * (a * std::sin(2.5 * t) + b * (1 - std::cos(2.0 * t)));
    };
    CheckedState state = bench.start();
    Balance result;
    const UmatCall zero = bench.call_for(state, {Components::Zero(n), Matrix3::Identity(), 0});
    const double volume = bench.jacobian(state.statev, state.F);
    double first = volume * state.sse;
    if (bench.subject().model != nullptr) first = volume * bench.call(zero).sse;
    double work = 0;
    doing(fmt::format("a path of {} increments", increments));
    for (int i = 1; i <= increments; ++i) {
        const CheckedState before = state;
        const PathStep step{strain(i) - strain(i - 1), Matrix3::Identity(), 1.0 / increments};
        if (!bench.advance(state, step)) return result;
        const double j_old = bench.jacobian(before.statev, before.F), j = bench.jacobian(state.statev, state.F);
        const double power = 0.5 * (j_old * before.stress + j * state.stress).dot(step.strain);
        const double dissipation = j * (state.spd - before.spd + state.scd - before.scd);
        work += power;
        result.work += std::abs(power);
        result.dissipated += dissipation;
        result.drop = std::max(result.drop, -dissipation);
    }
    result.stored = bench.jacobian(state.statev, state.F) * state.sse - first;
    result.error = std::abs(result.stored + result.dissipated - work);
    result.done = std::isfinite(result.error);
    return result;
}

// Events (yield, reversal, opening) fall anywhere in an increment: the worst of several numbers of increments.
Balance worst_balance(Bench& bench, int increments, std::uint64_t seed) {
    Balance most;
    most.done = true;
    for (const double part : {0.82, 1.0, 1.15}) {
        const Balance one = balance(bench, static_cast<int>(part * increments), bench.subject().scale, seed);
        if (!one.done) return {};
        if (one.error >= most.error) most = one;
    }
    return most;
}

}  // namespace

void check_energy(const Subject& subject, CheckResult& result) {
    if (subject.has_trait(LODE_EQUATION_OF_STATE)) return result.skip("SSE is internal energy, which heat changes too");
    if (subject.has_trait(LODE_OPEN_ENERGY))
        return result.skip("declared: the work of phase changes is in none of the energies");
    Bench bench(subject);
    const bool estimate = subject.total_law() || subject.has_trait(LODE_ENERGY_ESTIMATE);
    double last_error = 0, order = 0, drop = 0;
    int paths = 0, open = 0, silent = 0;
    std::string at;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        Balance coarse = worst_balance(bench, 64, seed);
        if (!coarse.done || !(coarse.work > 0)) continue;
        ++paths;
        Curve curve{"Energy balance",
                    "increments",
                    "|SSE + SPD + SCD - work| / work",
                    fmt::format("path {}", seed),
                    {64},
                    {std::max(coarse.fraction(), 1e-17)}};
        if (coarse.stored == 0 && coarse.dissipated == 0) {
            ++silent;
            continue;
        }
        bool closes = false;
        double measured = 0;
        // Terms of first and second order may cancel in large increments: then smaller ones tell.
        for (int increments = 256; increments <= 4096 && !closes; increments *= 4) {
            const Balance fine = worst_balance(bench, increments, seed);
            if (!fine.done) break;
            curve.x.push_back(increments);
            curve.y.push_back(std::max(fine.fraction(), 1e-17));
            const double rounding = 1e-13 * increments * fine.work;
            measured = std::log(std::max(coarse.error, 1e-300) / std::max(fine.error, 1e-300)) / std::log(4.0);
            // First order at least; the factor 4 with some tolerance for events.
            closes = fine.error <= coarse.error / 2.2 + rounding || fine.fraction() < 1e-8;
            if (estimate) closes = fine.fraction() <= 10 * subject.scale;
            coarse = fine;
        }
        drop = std::max(drop, coarse.drop / coarse.work);
        result.curves.push_back(std::move(curve));
        order = paths == 1 ? measured : std::min(order, measured);
        last_error = std::max(last_error, coarse.fraction());
        if (!closes) {
            ++open;
            at = fmt::format(
                "path {}: SSE + SPD + SCD differ from the work by {:.2g} of it, whatever the increment "
                "(SSE {:.4g}, SPD + SCD {:.4g})",
                seed, coarse.fraction(), coarse.stored, coarse.dissipated);
        }
    }
    if (paths == 0) return result.skip("the paths could not be followed to their end");
    result.figures = fmt::format("imbalance {:.1e} of the work with the finest increments", last_error);
    if (estimate) result.figures += "; declared as an estimate";
    else if (last_error > 1e-12) result.figures += fmt::format(", order {:.1f}", order);
    if (silent == paths) {
        result.figures = "SSE, SPD and SCD come back as they went in";
        result.warn("energy-not-set", fmt::format("on {} paths with work", paths));
    } else if (open > 0) {
        result.fail("energy-balance", at);
    }
    if (drop > 1e-9) result.warn("dissipation-decreases", fmt::format("SPD + SCD fall by {:.1e} of the work", drop));
}

void check_closed_path(const Subject& subject, CheckResult& result) {
    if (!subject.elastic && !subject.has_trait(LODE_ELASTIC))
        return result.skip("the material is not declared elastic (--elastic)");
    Bench bench(subject);
    const int n = bench.layout().size();
    constexpr int increments = 16;
    double stress = 0, dissipation = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        Random random(seed);
        const Components direction = random.direction(n), aside = random.direction(n);
        CheckedState state = bench.start();
        const CheckedState first = state;
        bool done = true;
        // Out, aside, and straight back.
        for (const Components& leg : {Components(direction), Components(aside), Components(-direction - aside)})
            for (int i = 0; i < increments && done; ++i) {
                doing("a closed path");
                done = bench.advance(state, {leg * (subject.scale / increments), Matrix3::Identity(), 1});
            }
        if (!done) continue;
        // A motion that turns principal axes does not close in F with the exponentials of its parts.
        if (subject.reads_gradient) {
            const Matrix3 residue = state.F * first.F.inverse();
            UmatCall home = bench.call_for(state, {Components::Zero(n), Matrix3::Identity(), 1});
            home.dfgrd1 = residue.inverse() * state.F;
            const UmatAnswer answer = bench.call(home);
            if (!answer.done(home)) continue;
            state = bench.after(home, answer);
        }
        const double size = subject.reads_gradient ? 1 : subject.scale;
        stress = std::max(stress, (state.stress - first.stress).cwiseAbs().maxCoeff() / (subject.stiffness * size));
        dissipation = std::max(dissipation, std::abs(state.spd + state.scd - first.spd - first.scd) /
                                                (subject.stress_scale() * subject.scale));
    }
    result.figures = fmt::format("stress left at the end {:.1e} of its scale, dissipation {:.1e}", stress, dissipation);
    if (stress > 1e-10 || dissipation > 1e-10) result.fail("path-dependent", result.figures);
}

}  // namespace lode::host
