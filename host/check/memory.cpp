// What the library writes and reads outside of what the interface gives it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include "../text.hpp"
#include "checks.hpp"
#include "child.hpp"

namespace lode::host {
namespace {

constexpr double fill_a = 7.25e77, fill_b = -1.5e-3;

std::string listed(const std::set<std::string>& names) {
    constexpr std::size_t shown = 6;
    std::vector<std::string> list(names.begin(), names.end());
    if (list.size() > shown) {
        list.resize(shown);
        list.push_back(fmt::format("... ({} in all)", names.size()));
    }
    return joined(list);
}

// Without that a second answer says nothing about what has been changed in between.
bool repeatable(Bench& bench, const std::vector<Situation>& situations) {
    return std::all_of(situations.begin(), situations.end(),
                       [&](const Situation& s) { return identical(bench.call(s.call), bench.call(s.call)); });
}
constexpr const char* not_repeatable = "equal calls have different answers: see determinism";

}  // namespace

void check_writes(const Subject& subject, CheckResult& result) {
    Bench bench(subject);
    std::set<std::string> outside, inputs;
    std::string first_outside, first_input;
    int calls = 0;
    const auto examine = [&](const UmatCall& call, const std::string& place) {
        doing("a call at " + place);
        const UmatAnswer answer = bench.call(call);
        ++calls;
        for (const Damage& d : answer.damage) {
            (d.outside ? outside : inputs).insert(d.array);
            std::string& first = d.outside ? first_outside : first_input;
            if (first.empty()) first = place;
        }
    };
    for (const Situation& s : bench.situations()) {
        examine(s.call, where(s));
        UmatCall large = s.call;
        large.dstran *= 50;
        examine(large, "a large increment at " + where(s));
    }
    result.figures = fmt::format("{} calls between guard zones", calls);
    if (!outside.empty())
        result.fail("writes-out-of-bounds", fmt::format("around {}, first at {}", listed(outside), first_outside));
    if (!inputs.empty()) result.fail("writes-input", fmt::format("{}, first at {}", listed(inputs), first_input));
}

void check_uninitialised(const Subject& subject, CheckResult& result) {
    Bench bench(subject);
    std::set<std::string> unset, reads, around;
    std::string first_unset, first_read, first_around;
    int calls = 0;
    const std::vector<Situation> situations = bench.situations();
    if (!repeatable(bench, situations)) return result.skip(not_repeatable);
    for (const Situation& s : situations) {
        doing("outputs with two fillings at " + where(s));
        const UmatAnswer a = bench.call(s.call, {.outputs = fill_a}), b = bench.call(s.call, {.outputs = fill_b});
        ++calls;
        const auto compare = [&](const std::string& name, double x, double y) {
            if (x == y || (std::isnan(x) && std::isnan(y))) return;
            const bool untouched = x == fill_a && y == fill_b;
            // Heat terms are for analyses with temperature: many materials never touch them, hosts clear them.
            if (untouched && !name.starts_with("DDSDDE")) return;
            (untouched ? unset : reads).insert(name);
            std::string& first = untouched ? first_unset : first_read;
            if (first.empty()) first = where(s);
        };
        const int n = bench.layout().size();
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i)
                compare(fmt::format("DDSDDE({},{})", i + 1, j + 1), a.tangent(i, j), b.tangent(i, j));
        for (int i = 0; i < n; ++i) {
            compare("STRESS", a.stress[i], b.stress[i]);
            compare("DDSDDT", a.ddsddt[i], b.ddsddt[i]);
            compare("DRPLDE", a.drplde[i], b.drplde[i]);
        }
        for (std::size_t i = 0; i < a.statev.size(); ++i) compare("STATEV", a.statev[i], b.statev[i]);
        compare("SSE", a.sse, b.sse);
        compare("SPD", a.spd, b.spd);
        compare("SCD", a.scd, b.scd);
        compare("RPL", a.rpl, b.rpl);
        compare("DRPLDT", a.drpldt, b.drpldt);
        compare("PNEWDT", a.pnewdt, b.pnewdt);
        // The same with what lies around the arrays.
        doing("two fillings around the arrays at " + where(s));
        const UmatAnswer c = bench.call(s.call, {.zones = fill_b});
        const UmatAnswer d = bench.call(s.call, {.zones = fill_a});
        if (identical(c, d)) continue;
        if (first_around.empty()) first_around = where(s);
        for (const char* array :
             {"PROPS", "STATEV", "STRESS", "STRAN",  "DSTRAN", "TIME",   "PREDEF", "DPRED", "COORDS",
              "DROT",  "DFGRD0", "DFGRD1", "DDSDDE", "DDSDDT", "DRPLDE", "CELENT", "TEMP",  "DTEMP",
              "DTIME", "SSE",    "SPD",    "SCD",    "RPL",    "DRPLDT", "PNEWDT"})
            if (!identical(d, bench.call(s.call, {.zones = fill_b, .array = array, .other_zones = fill_a})))
                around.insert(array);
    }
    result.figures = fmt::format("{} calls repeated with other numbers in and around the outputs", calls);
    // What is added to zero looks unset.
    const bool adds =
        std::any_of(reads.begin(), reads.end(), [](const std::string& name) { return name.starts_with("DDSDDE"); });
    if (!unset.empty() && !adds)
        result.fail("ddsdde-unset", fmt::format("{} {} never written, first at {}", listed(unset),
                                                unset.size() == 1 ? "is" : "are", first_unset));
    if (!reads.empty())
        result.fail("reads-output", fmt::format("{} {} on what DDSDDE, RPL, DDSDDT, DRPLDE or DRPLDT hold on entry, "
                                                "first at {}",
                                                listed(reads), reads.size() == 1 ? "depends" : "depend", first_read));
    // PREDEF and DPRED have as many entries as the analysis has fields, which no argument tells.
    const bool fields_only = !around.empty() && std::all_of(around.begin(), around.end(), [](const std::string& name) {
        return name == "PREDEF" || name == "DPRED";
    });
    if (fields_only) result.warn("reads-fields", fmt::format("{}, first at {}", listed(around), first_around));
    else if (!first_around.empty())
        result.fail("reads-out-of-bounds",
                    fmt::format("the answer depends on what lies around {}, first at {}",
                                around.empty() ? std::string("the arrays") : listed(around), first_around));
}

void check_short_arrays(const Subject& subject, CheckResult& result) {
    Bench bench(subject);
    const CheckedState start = bench.start();
    Random random(3);
    const PathStep step{random.direction(bench.layout().size()) * subject.scale, Matrix3::Identity(), 1};
    const UmatCall whole = bench.call_for(start, step);
    std::vector<std::string> said;
    const auto examine = [&](const char* what, const UmatCall& call) {
        doing(fmt::format("{} one too small", what));
        const UmatAnswer a = bench.call(call, {.zones = fill_a}), b = bench.call(call, {.zones = fill_b});
        const bool outside = std::any_of(a.damage.begin(), a.damage.end(), [](const Damage& d) { return d.outside; });
        if (!a.returned) said.push_back(std::string(what) + " refused");
        else if (outside) {
            said.push_back(std::string(what) + " not looked at");
            result.warn("nstatv-unchecked", fmt::format("with {} one too small the library writes beyond it", what));
        } else if (!identical(a, b)) {
            said.push_back(std::string(what) + " not looked at");
            result.warn("nprops-unchecked", fmt::format("with {} one too small the library reads beyond it", what));
        } else said.push_back(std::string(what) + " one less makes no harm");
    };
    if (!subject.constants.empty()) {
        UmatCall call = whole;
        call.props.pop_back();
        examine("NPROPS", call);
    }
    if (subject.state_variables > 0) {
        UmatCall call = whole;
        call.statev.pop_back();
        examine("NSTATV", call);
    }
    if (said.empty()) return result.skip("there is neither a constant nor a state variable");
    result.figures = joined(said);
}

}  // namespace lode::host
