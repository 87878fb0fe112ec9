// The increment with a rotation on top: everything turns with it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "checks.hpp"
#include "child.hpp"

namespace lode::host {
namespace {

// Of the stress scale. Rotating there and computing with other numbers costs a few roundings of the elastic predictor.
constexpr double tolerance = 1e-9;

// The same increment seen by an observer who turns by Q meanwhile.
UmatCall turned(const Bench& bench, const UmatCall& call, const Matrix3& q) {
    UmatCall result = call;
    result.stress = bench.turned_stress(call.stress, q);
    result.stran = bench.turned_strain(call.stran, q);
    result.dstran = bench.turned_strain(call.dstran, q);
    result.drot = q * call.drot;
    result.dfgrd1 = q * call.dfgrd1;
    return result;
}

struct Mismatch {
    double stress = 0, energy = 0;
};
Mismatch mismatch(Bench& bench, const UmatAnswer& answer, const UmatAnswer& seen, const Matrix3& q, double scale) {
    Mismatch m;
    m.stress = (seen.stress - bench.turned_stress(answer.stress, q)).cwiseAbs().maxCoeff() / scale;
    const double energy = scale * bench.subject().scale;
    m.energy =
        std::max({std::abs(seen.sse - answer.sse), std::abs(seen.spd - answer.spd), std::abs(seen.scd - answer.scd)}) /
        energy;
    if (std::isnan(m.stress)) m.stress = HUGE_VAL;
    if (std::isnan(m.energy)) m.energy = HUGE_VAL;
    return m;
}

// Whether the answer is right once the entries from `first` on are turned by hand.
bool mended_by_turning_state(Bench& bench, const UmatCall& call, const UmatAnswer& answer, const Matrix3& q,
                             double scale, std::size_t first, bool strain) {
    const auto n = static_cast<std::size_t>(bench.layout().size());
    UmatCall helped = call;
    const Components values = Eigen::Map<const Components>(call.statev.data() + first, static_cast<Eigen::Index>(n));
    if (values.isZero(0)) return false;
    // DROT is that of the whole increment.
    const Components t = strain ? bench.turned_strain(values, call.drot) : bench.turned_stress(values, call.drot);
    std::copy_n(t.data(), n, helped.statev.begin() + static_cast<std::ptrdiff_t>(first));
    const UmatAnswer again = bench.call(helped);
    // The answer without the rotation on top has the same mistake for its own DROT, which the caller made none.
    return again.returned && mismatch(bench, answer, again, q, scale).stress <= tolerance;
}

}  // namespace

void check_objectivity(const Subject& subject, CheckResult& result) {
    Bench bench(subject);
    if (!bench.can_turn()) return result.skip("the frame of this kind turns with the element");
    Random random(77);
    double worst_stress = 0, worst_energy = 0;
    int states = 0, wrong = 0, mended_by_old_stress = 0, with_history = 0, mended_by_state = 0;
    std::size_t turned_entry = 0;
    std::string at;
    for (const Situation& s : bench.situations()) {
        // Where damage begins some laws choose one of several equivalent directions, by the axes.
        if (subject.has_trait(LODE_FRAME_CHOICE) && s.call.spd == 0 && s.answer.spd > 0) continue;
        const Matrix3 q = random.rotation(bench.layout().kind(), 1.0);
        // The reference does not turn, so that only what DROT does is compared.
        UmatCall plain = s.call;
        plain.drot = Matrix3::Identity();
        plain.dfgrd1 = bench.moved(plain.dfgrd0, {plain.dstran, Matrix3::Identity(), plain.dtime});
        doing("an increment without rotation at " + where(s));
        const UmatAnswer answer = bench.call(plain);
        if (!answer.done(plain)) continue;
        const UmatCall call = turned(bench, plain, q);
        doing("an increment with a rotation on top at " + where(s));
        const UmatAnswer seen = bench.call(call);
        ++states;
        const double scale =
            std::max({subject.stress_scale(), answer.stress.cwiseAbs().maxCoeff(),
                      subject.stiffness * (bench.largest_strain(plain) + (subject.reads_gradient ? 1e-3 : 0))});
        Mismatch m{HUGE_VAL, 0};
        if (seen.returned) m = mismatch(bench, answer, seen, q, scale);
        worst_energy = std::max(worst_energy, m.energy);
        if (m.stress > worst_stress) {
            worst_stress = m.stress;
            at = where(s);
        }
        if (m.stress <= tolerance) continue;
        ++wrong;
        UmatCall unturned = call;
        unturned.stress = plain.stress;
        const UmatAnswer with_old = bench.call(unturned);
        if (with_old.returned && mismatch(bench, answer, with_old, q, scale).stress <= tolerance &&
            !plain.stress.isZero(0))
            ++mended_by_old_stress;
        const bool has_history = std::any_of(plain.statev.begin(), plain.statev.end(), [](double x) { return x != 0; });
        if (has_history) ++with_history;
        const auto n = static_cast<std::size_t>(bench.layout().size());
        for (std::size_t first = 0; first + n <= plain.statev.size(); ++first)
            if (mended_by_turning_state(bench, call, answer, q, scale, first, false) ||
                mended_by_turning_state(bench, call, answer, q, scale, first, true)) {
                ++mended_by_state;
                turned_entry = first + 1;
                break;
            }
    }
    result.figures = fmt::format("{} states with a rotation on top: stress off by {:.1e} of its scale, energies {:.1e}",
                                 states, worst_stress, worst_energy);
    if (states == 0) return result.skip("no increment of the path could be done without rotation");
    if (wrong > 0) {
        const std::string details =
            fmt::format("{} of {} states, most {:.1e} of the stress scale at {}", wrong, states, worst_stress, at);
        if (mended_by_old_stress == wrong)
            result.fail("stress-rotated-twice", details + "; right once STRESS comes in as it was before the rotation");
        else if (mended_by_state == wrong)
            result.fail("state-not-rotated",
                        details + fmt::format("; right once STATEV({}..{}) are turned by DROT", turned_entry,
                                              turned_entry + static_cast<std::size_t>(bench.layout().size()) - 1));
        else if (with_history == wrong)
            result.fail("state-not-rotated", details + "; only states in which STATEV is not zero are off");
        else result.fail("not-objective", details);
    } else if (worst_energy > 1e-6) {
        result.warn("energy-not-objective",
                    fmt::format("SSE, SPD or SCD change by {:.1e} of the energy scale", worst_energy));
    }
}

}  // namespace lode::host
