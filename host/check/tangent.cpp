// DDSDDE against central differences of the very same entry point.
#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "checks.hpp"
#include "child.hpp"

namespace lode::host {
namespace {

// Kinks ask for a small step and rounding for a large one: the best of these counts.
constexpr std::array<double, 7> steps{1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8};  // of the scale
constexpr double good = 1e-6, usable = 1e-3;                                      // error of the largest entry
constexpr double floor = 1e-2;  // of the stiffness: yield conditions are met to a tolerance, seen where DDSDDE vanishes
constexpr double recognised = 1e-4;  // a diagnosis explains the difference if it leaves less

double largest_entry(const Tangent& a) { return a.cwiseAbs().maxCoeff(); }

struct Differences {
    std::array<double, steps.size()> error;  // NaN where a perturbed increment could not be done
    Tangent best;                            // of the Kirchhoff stress over J
    Tangent cauchy;
    double best_error = HUGE_VAL;
};

// One column with the strain of the end moved by +-h: central differences of J sigma over J, and of sigma alone.
struct Column {
    Components kirchhoff, cauchy;
};
std::optional<Column> column(Bench& bench, const Situation& s, int component, double h) {
    Components kirchhoff[2], cauchy[2];
    for (const int side : {0, 1}) {
        Components strain = Components::Zero(bench.layout().size());
        strain[component] = side == 0 ? h : -h;
        UmatCall call = s.call;
        call.dstran += strain;
        if (!bench.layout().cohesive())
            call.dfgrd1 = (Matrix3::Identity() + bench.layout().strain_tensor(strain)) * s.call.dfgrd1;
        const UmatAnswer answer = bench.call(call);
        if (!answer.done(call)) return std::nullopt;
        double j = bench.jacobian(answer.statev, call.dfgrd1);
        if (bench.subject().total_law() && bench.layout().kind() != Kind::plane_stress) j = call.dfgrd1.determinant();
        cauchy[side] = answer.stress;
        kirchhoff[side] = j * answer.stress;
    }
    double j = bench.jacobian(s.answer.statev, s.call.dfgrd1);
    if (bench.subject().total_law() && bench.layout().kind() != Kind::plane_stress) j = s.call.dfgrd1.determinant();
    return Column{(kirchhoff[0] - kirchhoff[1]) / (2 * h * j), (cauchy[0] - cauchy[1]) / (2 * h)};
}

Differences differences(Bench& bench, const Situation& s) {
    const int n = bench.layout().size();
    Differences result;
    result.best = result.cauchy = Tangent::Zero(n, n);
    const double size = std::max(largest_entry(s.answer.tangent), floor * bench.subject().stiffness);
    for (std::size_t i = 0; i < steps.size(); ++i) {
        Tangent kirchhoff(n, n), cauchy(n, n);
        bool done = true;
        for (int k = 0; k < n && done; ++k) {
            const std::optional<Column> c = column(bench, s, k, steps[i] * bench.subject().scale);
            done = c.has_value();
            if (!done) break;
            kirchhoff.col(k) = c->kirchhoff;
            cauchy.col(k) = c->cauchy;
        }
        result.error[i] = NAN;
        if (!done) continue;
        double error = largest_entry(kirchhoff - s.answer.tangent) / size;
        if (!std::isfinite(error)) error = HUGE_VAL;
        result.error[i] = error;
        if (result.best.isZero(0) || error < result.best_error) {
            result.best_error = error;
            result.best = kirchhoff;
            result.cauchy = cauchy;
        }
    }
    return result;
}

// With the rows or the columns of shear scaled.
Tangent scaled_shear(const Tangent& tangent, int ndi, double factor, bool rows) {
    Tangent scaled = tangent;
    const Eigen::Index shears = tangent.rows() - ndi;
    if (rows) scaled.bottomRows(shears) *= factor;
    else scaled.rightCols(shears) *= factor;
    return scaled;
}

// What kind of mistake makes this DDSDDE of that derivative.
std::string diagnosis(Bench& bench, const Situation& s, const Differences& d, const Tangent& virgin) {
    const Tangent& given = s.answer.tangent;
    const double size = std::max(largest_entry(d.best), floor * bench.subject().stiffness);
    const auto is = [&](const Tangent& a, const Tangent& b) {
        const double error = largest_entry(a - b);
        return std::isfinite(error) && error <= recognised * size;
    };
    if (!given.allFinite()) return "tangent-not-finite";
    if (given.isZero(0) && largest_entry(d.best) > floor * bench.subject().stiffness) return "tangent-zero";
    if (is(given.transpose(), d.best)) return "tangent-transposed";
    if (is(given, d.cauchy)) return "tangent-cauchy";
    const int ndi = bench.layout().ndi();
    if (bench.layout().nshr() > 0 && !bench.layout().cohesive())
        for (const double factor : {2.0, 0.5})
            for (const bool rows : {true, false})
                if (is(scaled_shear(given, ndi, factor, rows), d.best)) return "tangent-shear-factor";
    if (largest_entry(given - virgin) <= recognised * largest_entry(virgin)) return "tangent-elastic";
    // Components 13 and 23 the other way round.
    if (bench.layout().size() == 6) {
        Eigen::PermutationMatrix<6> swap;
        swap.setIdentity();
        std::swap(swap.indices()[4], swap.indices()[5]);
        if (is(swap * given * swap.transpose(), d.best)) return "tangent-component-order";
    }
    return "tangent-wrong";
}

std::string worst_entry(const Tangent& given, const Tangent& derivative) {
    Eigen::Index i = 0, j = 0;
    (given - derivative).cwiseAbs().maxCoeff(&i, &j);
    return fmt::format("DDSDDE({},{}) is {:.6g}, the derivative {:.6g}", i + 1, j + 1, given(i, j), derivative(i, j));
}

}  // namespace

void check_tangent(const Subject& subject, CheckResult& result) {
    Bench bench(subject);
    const std::vector<Situation> situations = bench.situations();
    const CheckedState start = bench.start();
    const Tangent virgin =
        bench.call(bench.call_for(start, {Components::Zero(bench.layout().size()), Matrix3::Identity(), 1})).tangent;
    const Situation* worst[2] = {nullptr, nullptr};  // elastic, inelastic
    Differences at_worst[2];
    int count[2] = {0, 0}, wrong = 0;
    for (const Situation& s : situations) {
        doing("differences at " + where(s));
        const Differences d = differences(bench, s);
        if (std::all_of(d.error.begin(), d.error.end(), [](double e) { return std::isnan(e); })) continue;
        const int k = s.inelastic ? 1 : 0;
        ++count[k];
        if (d.best_error > good) ++wrong;
        if (worst[k] != nullptr && d.best_error <= at_worst[k].best_error) continue;
        worst[k] = &s;
        at_worst[k] = d;
    }
    if (count[0] + count[1] == 0) return result.skip("no increment of the path could be done");
    const auto error_text = [&](int k) {
        return count[k] == 0 ? std::string("none") : fmt::format("{:.1e} of {}", at_worst[k].best_error, count[k]);
    };
    result.figures = fmt::format("largest error, best step: elastic {}, inelastic {}", error_text(0), error_text(1));
    for (const int k : {0, 1}) {
        if (worst[k] == nullptr) continue;
        Curve curve{"Tangent against central differences",
                    "step / strain scale",
                    "error / largest entry of DDSDDE",
                    where(*worst[k]),
                    {},
                    {}};
        for (std::size_t i = 0; i < steps.size(); ++i)
            if (std::isfinite(at_worst[k].error[i])) {
                curve.x.push_back(steps[i]);
                curve.y.push_back(std::max(at_worst[k].error[i], 1e-17));
            }
        result.curves.push_back(std::move(curve));
    }
    // The elastic tangent shows itself in inelastic states only, so those come first.
    for (const int k : {1, 0}) {
        if (worst[k] == nullptr || at_worst[k].best_error <= good) continue;
        const std::string name = diagnosis(bench, *worst[k], at_worst[k], virgin);
        if (result.has(name)) continue;
        const std::string details = fmt::format("{}: {} (error {:.1e}; {} of {} states are off)", where(*worst[k]),
                                                worst_entry(worst[k]->answer.tangent, at_worst[k].best),
                                                at_worst[k].best_error, wrong, count[0] + count[1]);
        if (name == "tangent-wrong" && at_worst[k].best_error <= usable) result.warn("tangent-inexact", details);
        else if (name == "tangent-cauchy") result.warn(name, details);
        else result.fail(name, details);
    }
}

void check_symmetry(const Subject& subject, CheckResult& result) {
    Bench bench(subject);
    double worst = 0;
    std::string at;
    for (const Situation& s : bench.situations()) {
        const double size = largest_entry(s.answer.tangent);
        if (!(size > 0) || !std::isfinite(size)) continue;
        const double skew = largest_entry(s.answer.tangent - s.answer.tangent.transpose()) / size;
        if (skew <= worst) continue;
        worst = skew;
        at = where(s);
    }
    result.figures = fmt::format("largest difference of entries (i,j) and (j,i): {:.1e} of the largest entry", worst);
    constexpr double rounding = 1e-9;
    const bool claimed = subject.unsymmetric || subject.has_trait(LODE_UNSYMMETRIC) || subject.total_law();
    if (worst > rounding && claimed) result.figures += "; unsymmetric, as declared";
    else if (worst > rounding) result.warn("tangent-unsymmetric", fmt::format("{:.1e} at {}", worst, at));
}

}  // namespace lode::host
