// VUMAT: what is written, what a point depends on, and whether it is the same material as UMAT.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>
#include <set>
#include <thread>

#include "../replay/kinematics.hpp"
#include "../text.hpp"
#include "checks.hpp"
#include "child.hpp"
#include "vumat_call.hpp"

namespace lode::host {
namespace {

using record::VumatInput;
using record::VumatOutput;

constexpr double fill_a = 7.25e77, fill_b = -1.5e-3;
constexpr const char* no_points = "no increment of the path could be done";

std::string at_point(std::size_t i) { return fmt::format("state {} of the paths", i + 1); }

std::string listed(const std::set<std::string>& names) {
    return joined(std::vector<std::string>(names.begin(), names.end()));
}

// Largest difference of the stresses, of the stress scale; infinite if one is no number.
double stress_difference(const Subject& subject, const VumatAnswer& a, const VumatAnswer& b) {
    double difference = 0, size = subject.stress_scale();
    const Numbers &x = a.output(VumatOutput::stress_new), &y = b.output(VumatOutput::stress_new);
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double d = std::abs(x[i] - y[i]);
        difference = std::max(difference, std::isnan(d) ? HUGE_VAL : d);
        size = std::max(size, std::abs(y[i]));
    }
    return difference / size;
}

}  // namespace

void check_vumat_writes(const Subject& subject, CheckResult& result) {
    VumatBench bench(subject);
    const std::vector<VumatCall> points = bench.situations();
    if (points.empty()) return result.skip(no_points);
    std::set<std::string> outside, inputs;
    int calls = 0;
    const auto examine = [&](const VumatCall& call) {
        const VumatAnswer answer = bench.call(call);
        ++calls;
        for (const Damage& d : answer.damage) (d.outside ? outside : inputs).insert(d.array);
        // Of strainInc only the thickness strain of plane stress may be answered.
        const Numbers &before = call.input(VumatInput::strain_inc), &after = answer.output(VumatOutput::strain_inc);
        const auto n = static_cast<std::size_t>(call.points());
        for (std::size_t i = 0; answer.returned && i < before.size(); ++i)
            if (before[i] != after[i] && !(call.header.ndir == 3 && call.header.nshr == 1 && i / n == 2))
                inputs.insert("strainInc");
    };
    for (std::size_t i = 0; i < points.size(); ++i) {
        doing("a block of one point, " + at_point(i));
        examine(points[i]);
    }
    doing("a block of all points");
    examine(joined(points));
    result.figures = fmt::format("{} blocks between guard zones", calls);
    if (!outside.empty()) result.fail("writes-out-of-bounds", "around " + listed(outside));
    if (!inputs.empty()) result.fail("writes-input", listed(inputs));
}

void check_vumat_outputs(const Subject& subject, CheckResult& result) {
    VumatBench bench(subject);
    const std::vector<VumatCall> points = bench.situations();
    if (points.empty()) return result.skip(no_points);
    const VumatCall block = joined(points);
    doing("outputs with two fillings");
    const VumatAnswer a = bench.call(block, {.outputs = fill_a}), b = bench.call(block, {.outputs = fill_b});
    if (!a.returned || !b.returned) return result.skip("the library ends the analysis at a block of all states");
    std::set<std::string> unset, reads;
    bool energies_unset = false;
    for (const VumatOutput o : {VumatOutput::stress_new, VumatOutput::state_new, VumatOutput::ener_intern_new,
                                VumatOutput::ener_inelas_new}) {
        const Numbers &x = a.output(o), &y = b.output(o);
        const std::size_t n = static_cast<std::size_t>(block.points());
        for (std::size_t i = 0; i < x.size(); ++i) {
            if (x[i] == y[i] || (std::isnan(x[i]) && std::isnan(y[i]))) continue;
            if (x[i] != fill_a || y[i] != fill_b) reads.insert(name_of(o));
            else if (o == VumatOutput::ener_intern_new || o == VumatOutput::ener_inelas_new) energies_unset = true;
            else unset.insert(fmt::format("{}(*,{})", name_of(o), i / n + 1));
        }
    }
    result.figures = fmt::format("{} points, other numbers in the outputs", block.points());
    if (!unset.empty()) result.fail("output-unset", listed(unset));
    if (!reads.empty()) result.fail("reads-output", listed(reads));
    if (energies_unset) result.warn("energy-not-set", "enerInternNew or enerInelasNew is not written");
    doing("two fillings around the arrays");
    const VumatAnswer c = bench.call(block, {.zones = fill_a}), d = bench.call(block, {.zones = fill_b});
    const std::string difference = first_difference(c, d);
    if (!difference.empty()) result.fail("reads-out-of-bounds", difference + " depends on what lies around the arrays");
}

void check_vumat_block(const Subject& subject, CheckResult& result) {
    VumatBench bench(subject);
    const std::vector<VumatCall> points = bench.situations();
    if (points.empty()) return result.skip(no_points);
    std::vector<VumatAnswer> alone;
    for (std::size_t i = 0; i < points.size(); ++i) {
        doing("a block of one point, " + at_point(i));
        alone.push_back(bench.call(points[i]));
    }
    std::vector<int> order(points.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
    const VumatCall all = joined(points);
    double worst = 0;
    int bits = 0;
    std::string at, fate;
    const auto examine = [&](const std::vector<int>& which, const std::string& what) {
        doing("a block of " + what);
        const VumatAnswer answer = bench.call(selected(all, which));
        for (std::size_t k = 0; k < which.size(); ++k) {
            const VumatAnswer& one = alone[static_cast<std::size_t>(which[k])];
            if (one.returned != answer.returned) {
                if (fate.empty()) fate = "the analysis ends in a block of " + what;
                return;
            }
            const VumatAnswer here = point_of(answer, static_cast<int>(k));
            if (first_difference(one, here).empty()) continue;
            ++bits;
            double difference = stress_difference(subject, here, one);
            const Numbers &x = here.output(VumatOutput::state_new), &y = one.output(VumatOutput::state_new);
            for (std::size_t i = 0; i < x.size(); ++i) {
                const double d = std::abs(x[i] - y[i]) / std::max(std::abs(y[i]), subject.scale);
                difference =
                    std::max(difference, std::isnan(d) && !(std::isnan(x[i]) && std::isnan(y[i])) ? HUGE_VAL : d);
            }
            if (difference <= worst) continue;
            worst = difference;
            at = fmt::format("point {} in a block of {}", k + 1, what);
        }
    };
    examine(order, fmt::format("{} points", order.size()));
    for (const std::size_t size : {std::size_t{2}, std::size_t{7}, std::size_t{8}, std::size_t{16}})
        if (size <= order.size())
            examine({order.begin(), order.begin() + static_cast<std::ptrdiff_t>(size)}, fmt::format("{} points", size));
    std::reverse(order.begin(), order.end());
    examine(order, fmt::format("{} points, backwards", order.size()));
    result.figures = fmt::format(
        "{} points alone and in blocks: {}", points.size(),
        bits == 0 ? std::string("the same bits") : fmt::format("different by {:.1e} of the scale at most", worst));
    constexpr double rounding = 1e-11;
    if (!fate.empty()) result.fail("depends-on-block", fate);
    else if (worst > rounding) result.fail("depends-on-block", fmt::format("by {:.1e} of the scale, {}", worst, at));
}

void check_vumat_components(const Subject& subject, CheckResult& result) {
    if (subject.library->umat() == nullptr) return result.skip("the library has no umat_ to compare with");
    VumatBench bench(subject);
    const std::vector<VumatCall> points = bench.situations();
    if (points.empty()) return result.skip(no_points);
    Bench implicit(subject);
    const int nshr = bench.layout().nshr();
    double worst = 0, swapped_worst = 0, halved_worst = 0;
    std::string at;
    int compared = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const UmatCall call = bench.as_umat(points[i]);
        doing("the same increment through umat_, " + at_point(i));
        const UmatAnswer umat = implicit.call(call);
        const VumatAnswer vumat = bench.call(points[i]);
        if (!umat.done(call) || !vumat.returned) continue;
        ++compared;
        const double size = std::max({subject.stress_scale(), umat.stress.cwiseAbs().maxCoeff(),
                                      subject.stiffness * call.dstran.cwiseAbs().maxCoeff()});
        const Components seen = bench.stress(vumat.output(VumatOutput::stress_new));
        const double difference = (seen - umat.stress).cwiseAbs().maxCoeff() / size;
        if (!(difference <= worst)) {
            worst = std::isnan(difference) ? HUGE_VAL : difference;
            at = at_point(i);
        }
        if (nshr == 3) {
            Components swapped = seen;
            std::swap(swapped[4], swapped[5]);
            swapped_worst = std::max(swapped_worst, (swapped - umat.stress).cwiseAbs().maxCoeff() / size);
        }
        if (nshr > 0 && !bench.layout().cohesive()) {
            UmatCall halved = call;
            halved.dstran.tail(nshr) *= 0.5;
            const UmatAnswer other = implicit.call(halved);
            halved_worst = std::max(halved_worst,
                                    other.done(halved) ? (seen - other.stress).cwiseAbs().maxCoeff() / size : HUGE_VAL);
        }
    }
    if (compared == 0) return result.skip("no increment could be done by both");
    result.figures = fmt::format("{} increments through both: stresses differ by {:.1e} of the scale", compared, worst);
    constexpr double same = 1e-6;
    if (worst <= same) return;
    if (nshr == 3 && swapped_worst <= same)
        result.fail("vumat-component-order", result.figures + "; equal once 23 and 31 change places");
    else if (nshr > 0 && !bench.layout().cohesive() && halved_worst <= same)
        result.fail("vumat-shear-factor", result.figures + "; equal once UMAT gets half the shear strains");
    else if (subject.model != nullptr) result.fail("vumat-differs-from-umat", result.figures + ", " + at);
    else result.warn("vumat-differs-from-umat", result.figures + ", " + at);
}

void check_vumat_frame(const Subject& subject, CheckResult& result) {
    VumatBench bench(subject);
    if (bench.layout().cohesive() || bench.layout().kind() == Kind::uniaxial)
        return result.skip("the frame of this kind turns with the element");
    const std::vector<VumatCall> points = bench.situations();
    if (points.empty()) return result.skip(no_points);
    Random random(9);
    double worst = 0;
    std::string at;
    constexpr std::array<std::pair<int, int>, 9> places{
        {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}, {1, 0}, {2, 1}, {0, 2}}};
    for (std::size_t i = 0; i < points.size(); ++i) {
        VumatCall call = points[i];
        const auto normals = static_cast<std::size_t>(call.header.ndir),
                   shears = static_cast<std::size_t>(call.header.nshr);
        const Matrix3 q = random.rotation(bench.layout().kind(), 1.0);
        // The axes turn with the material: F = R U with the same U means the same stress in those axes.
        for (const VumatInput gradient : {VumatInput::defgrad_old, VumatInput::defgrad_new}) {
            Numbers& values = call.input(gradient);
            const auto place_of = [&](std::size_t k) {
                return k < normals ? k : k < normals + shears ? 3 + k - normals : 6 + k - normals - shears;
            };
            Matrix3 F = Matrix3::Identity();
            for (std::size_t k = 0; k < values.size(); ++k)
                F(places[place_of(k)].first, places[place_of(k)].second) = values[k];
            const Matrix3 turned = q * F;
            for (std::size_t k = 0; k < values.size(); ++k)
                values[k] = turned(places[place_of(k)].first, places[place_of(k)].second);
        }
        doing("a rotation in defgradOld and defgradNew, " + at_point(i));
        const VumatAnswer plain = bench.call(points[i]), seen = bench.call(call);
        if (!plain.returned) continue;
        const double difference = seen.returned ? stress_difference(subject, seen, plain) : HUGE_VAL;
        if (difference <= worst) continue;
        worst = difference;
        at = at_point(i);
    }
    result.figures =
        fmt::format("stresses change by {:.1e} of the scale when defgrad turns and stretch does not", worst);
    constexpr double rounding = 1e-8;
    if (worst > rounding) result.fail("vumat-not-corotational", fmt::format("by {:.1e} of the scale, {}", worst, at));
}

void check_vumat_probe(const Subject& subject, CheckResult& result) {
    VumatBench bench(subject);
    const std::vector<VumatCall> points = bench.situations();
    if (points.empty()) return result.skip(no_points);
    VumatCall call = subject.recorded != nullptr ? points.front() : bench.start();
    Components made_up = Components::Zero(bench.layout().size());
    for (int i = 0; i < bench.layout().size(); ++i) made_up[i] = 1e-6 * (i + 1);
    if (subject.recorded == nullptr) call = bench.with_strain(call, made_up, call.header.dt);
    call.header.step_time = call.header.total_time = 0;
    doing("the probe call with stepTime = totalTime = 0");
    const VumatAnswer answer = bench.call(call);
    result.figures = "a call with stepTime = totalTime = 0 and made-up strains";
    if (!answer.returned) return result.fail("probe-fails", "the library ends the analysis: " + answer.message);
    if (!answer.finite()) return result.fail("probe-fails", "stressNew or stateNew is not a number");
    if (answer.output(VumatOutput::state_new) != call.input(VumatInput::state_old))
        result.warn("probe-changes-history", "stateNew differs from stateOld");
}

void check_vumat_energy(const Subject& subject, CheckResult& result) {
    if (subject.has_trait(LODE_EQUATION_OF_STATE | LODE_OPEN_ENERGY | LODE_ENERGY_ESTIMATE) || subject.total_law())
        return result.skip("declared: the energies do not balance the work of the stresses");
    if (subject.kind == Kind::plane_stress && subject.reads_gradient)
        return result.skip("the density of plane stress follows from a thickness that the material finds");
    VumatBench bench(subject);
    const int n = bench.layout().size();
    Random random(21);
    Components a = random.direction(n), b = random.direction(n);
    if (bench.layout().cohesive()) a[0] = std::abs(a[0]), b[0] = std::abs(b[0]);
    const auto fraction = [&](int increments) -> double {
        VumatCall call = bench.start();
        VumatAnswer answer;
        double work = 0, magnitude = 0;
        double first = 0;
        for (int leg = 0; leg < 2; ++leg)
            for (int i = 0; i < increments; ++i) {
                const Components strain = (leg == 0 ? a : b) * (subject.scale / increments);
                const double dt = 1.0 / increments;
                call = leg == 0 && i == 0 ? bench.with_strain(call, strain, dt) : bench.next(call, answer, strain, dt);
                doing(fmt::format("a path of {} increments (VUMAT)", 2 * increments));
                answer = bench.call(call);
                if (!answer.returned || !answer.finite()) return NAN;
                // The energy of the state from which the host starts is not zero everywhere: initial pressures.
                if (leg == 0 && i == 0) {
                    first = answer.output(VumatOutput::ener_intern_new)[0];
                    continue;
                }
                const double power = 0.5 *
                                     (bench.stress(call.input(VumatInput::stress_old)) +
                                      bench.stress(answer.output(VumatOutput::stress_new)))
                                         .dot(strain) /
                                     call.input(VumatInput::density)[0];
                work += power;
                magnitude += std::abs(power);
            }
        const double energy = answer.output(VumatOutput::ener_intern_new)[0] - first;
        return energy == 0 && magnitude > 0 ? HUGE_VAL : std::abs(energy - work) / magnitude;
    };
    double coarse = fraction(64), fine = coarse;
    if (std::isnan(coarse)) return result.skip("the path could not be followed to its end");
    if (std::isinf(coarse)) {
        result.figures = "enerInternNew does not change";
        return result.warn("energy-not-set", "enerInternNew stays what enerInternOld was");
    }
    bool closes = coarse < 1e-8;
    for (int increments = 256; increments <= 4096 && !closes; increments *= 4) {
        fine = fraction(increments);
        closes = fine <= coarse / 2.2 + 1e-12 || fine < 1e-8;
        coarse = fine;
    }
    result.figures = fmt::format("enerInternNew balances the work but for {:.1e} of it", fine);
    if (!closes) result.fail("energy-balance", result.figures + ", whatever the increment");
}

void check_vumat_zero_increment(const Subject& subject, CheckResult& result) {
    VumatBench bench(subject);
    const std::vector<VumatCall> points = bench.situations();
    if (points.empty()) return result.skip(no_points);
    double worst = 0;
    std::string at, not_finite;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const VumatAnswer there = bench.call(points[i]);
        if (!there.returned || subject.recorded != nullptr) continue;
        const VumatCall call =
            bench.next(points[i], there, Components::Zero(bench.layout().size()), points[i].header.dt);
        doing("a zero increment after " + at_point(i));
        const VumatAnswer answer = bench.call(call);
        if (!answer.returned || !answer.finite()) {
            if (not_finite.empty()) not_finite = "after " + at_point(i);
            continue;
        }
        const double change = stress_difference(subject, answer, there);
        if (change <= worst) continue;
        worst = change;
        at = at_point(i);
    }
    const bool relaxes = subject.rate_dependent || subject.has_trait(LODE_VISCOUS);
    result.figures = relaxes ? "the stress may relax, its change is not judged"
                             : fmt::format("the stress changes by {:.1e} of its scale at most", worst);
    if (!not_finite.empty()) result.fail("zero-increment-not-finite", not_finite);
    if (worst > 1e-6 && !relaxes)
        result.fail("zero-increment-changes-stress", fmt::format("by {:.1e} after {}", worst, at));
}

void check_vumat_determinism(const Subject& subject, CheckResult& result) {
    VumatBench bench(subject);
    const std::vector<VumatCall> points = bench.situations();
    if (points.empty()) return result.skip(no_points);
    std::vector<VumatAnswer> forward;
    std::string difference;
    for (std::size_t i = 0; i < points.size(); ++i) {
        doing("the same call twice, " + at_point(i));
        forward.push_back(bench.call(points[i]));
        const std::string name = first_difference(forward.back(), bench.call(points[i]));
        if (difference.empty() && !name.empty())
            difference = name + " differs in the second of two equal calls, " + at_point(i);
    }
    for (std::size_t i = points.size(); i-- > 0;) {
        doing("the calls in another order, " + at_point(i));
        const std::string name = first_difference(forward[i], bench.call(points[i]));
        if (difference.empty() && !name.empty()) difference = name + " depends on the calls before, " + at_point(i);
    }
    result.figures = fmt::format("{} calls repeated, also in another order", 2 * points.size());
    if (!difference.empty()) result.fail("hidden-state", difference);
}

void check_vumat_threads(const Subject& subject, CheckResult& result) {
    std::vector<VumatCall> points;
    std::vector<VumatAnswer> alone;
    {
        VumatBench bench(subject);
        points = bench.situations();
        for (const VumatCall& p : points) alone.push_back(bench.call(p));
    }
    if (points.size() < 2) return result.skip("no two increments of the path could be done");
    std::atomic<bool> stop{false};
    std::atomic<long> calls{0};
    std::mutex mutex;
    std::string difference;
    doing("two threads at the same time (VUMAT)");
    const auto work = [&](std::size_t thread) {
        VumatBench bench(subject);
        long own = 0;
        for (std::size_t k = thread * points.size() / 2; !stop.load(std::memory_order_relaxed); ++k, ++own) {
            const std::size_t i = k % points.size();
            const std::string name = first_difference(alone[i], bench.call(points[i]));
            if (name.empty()) continue;
            const std::lock_guard lock(mutex);
            if (difference.empty()) difference = name + " differs, " + at_point(i);
            stop = true;
        }
        calls += own;
    };
    std::thread one(work, std::size_t{0}), two(work, std::size_t{1});
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(250);
    while (!stop && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    stop = true;
    one.join();
    two.join();
    result.figures = fmt::format("{} calls in two threads", calls.load());
    if (!difference.empty()) result.fail("thread-race", difference);
}

void check_vumat_nan(const Subject& subject, CheckResult& result) {
    VumatBench bench(subject);
    const std::vector<VumatCall> points = bench.situations();
    if (points.size() < 3) return result.skip("no three increments of the path could be done");
    const VumatCall whole = joined(points);
    const VumatAnswer clean = bench.call(whole);
    if (!clean.returned) return result.skip("the library ends the analysis at a block of all states");
    const std::size_t n = points.size();
    int ended = 0;
    std::string swallowed, spread;
    for (const std::size_t bad : {std::size_t{0}, n / 2, n - 1}) {
        VumatCall call = whole;
        call.input(VumatInput::strain_inc)[bad] = std::numeric_limits<double>::quiet_NaN();
        if (!bench.layout().cohesive()) {
            call.input(VumatInput::stretch_new)[bad] = std::numeric_limits<double>::quiet_NaN();
            call.input(VumatInput::defgrad_new)[bad] = std::numeric_limits<double>::quiet_NaN();
        }
        doing(fmt::format("strainInc({},1) = NaN in a block of {}", bad + 1, n));
        const VumatAnswer answer = bench.call(call);
        if (!answer.returned) {
            ++ended;
            continue;
        }
        for (std::size_t i = 0; i < n; ++i) {
            const VumatAnswer here = point_of(answer, static_cast<int>(i));
            if (i == bad) {
                if (here.finite() && swallowed.empty())
                    swallowed = fmt::format("strainInc({},1) = NaN gives a finite stress", bad + 1);
            } else if (!first_difference(here, point_of(clean, static_cast<int>(i))).empty() && spread.empty()) {
                spread = fmt::format("strainInc({},1) = NaN changes point {}", bad + 1, i + 1);
            }
        }
    }
    result.figures = fmt::format("NaN in one point of a block: {} of 3 calls end the analysis", ended);
    if (!swallowed.empty()) result.fail("nan-swallowed", swallowed);
    if (!spread.empty()) result.fail("nan-spreads", spread);
}

void check_vumat_absurd(const Subject& subject, CheckResult& result) {
    VumatBench bench(subject);
    const std::vector<VumatCall> points = bench.situations();
    if (points.empty() || subject.recorded != nullptr) return result.skip(no_points);
    int calls = 0, ended = 0;
    std::string bad;
    std::vector<double> sizes{10 * subject.scale, 100 * subject.scale, 1e4 * subject.scale};
    for (const double strain : {0.5, 3.0}) sizes.push_back(strain * (subject.cohesive() ? subject.element_length : 1));
    for (std::size_t k = 0; k < points.size(); k += std::max<std::size_t>(1, points.size() / 6)) {
        const VumatAnswer there = bench.call(points[k]);
        if (!there.returned) continue;
        const Components strain = bench.strain(points[k]);
        const Components direction = strain / std::max(strain.cwiseAbs().maxCoeff(), 1e-300);
        for (const double size : sizes)
            for (const double sign : {1.0, -1.0}) {
                if (size > 10 && !subject.cohesive()) continue;
                const VumatCall call = bench.next(points[k], there, direction * (sign * size), 1);
                const std::string place =
                    fmt::format("a strain increment of {:.2g} after {}", sign * size, at_point(k));
                doing(place + " (VUMAT)");
                const VumatAnswer answer = bench.call(call);
                ++calls;
                if (!answer.returned) ++ended;
                else if (!answer.finite() && bad.empty()) bad = place;
            }
    }
    result.figures = fmt::format("{} calls with strains up to 3, {} end the analysis", calls, ended);
    if (!bad.empty()) result.fail("absurd-increment-not-finite", "stressNew or stateNew is not a number at " + bad);
}

}  // namespace lode::host
