#include "run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "child.hpp"
#include "vumat_call.hpp"

namespace lode::host {
namespace {

const char* name_of(ChildEnd::How how) {
    switch (how) {
        case ChildEnd::How::crashed:
            return "crash";
        case ChildEnd::How::timed_out:
            return "endless-loop";
        default:
            return "ends-process";
    }
}

CheckResult result_of(const Check& check, const Subject& subject) {
    CheckResult result;
    result.check = check.name;
    result.interface = check.entry == Entry::umat ? "umat" : "vumat";
    result.kind = lode::host::name_of(subject.kind);
    return result;
}

CheckResult run_check(const Check& check, const Subject& subject, double seconds) {
    const CheckResult blank = result_of(check, subject);
    const ChildEnd end = in_child(
        [&] {
            CheckResult result = blank;
            check.run(subject, result);
            return packed(result);
        },
        seconds);
    if (end.how == ChildEnd::How::answered) return unpacked(end.answer);
    CheckResult result = blank;
    result.figures = "the check came to no end";
    result.fail(name_of(end.how), description(end, seconds));
    return result;
}

// The first look through one of the entry points, which fills the subject in. What went wrong goes into `result`.
bool look(Subject& subject, bool implicit, double seconds, CheckResult& result) {
    const ChildEnd end = in_child(
        [&] {
            const FirstLook found = implicit ? first_look(subject) : vumat_first_look(subject);
            std::string text =
                fmt::format("{} {} {} {} {} {} ", found.scale, found.stiffness, found.reads_gradient ? 1 : 0,
                            found.rate_dependent ? 1 : 0, found.elastic, found.inelastic);
            return text + "|" + found.refusal;
        },
        seconds);
    if (end.how != ChildEnd::How::answered) {
        result.figures = "an ordinary path";
        result.fail(name_of(end.how), description(end, seconds));
        return false;
    }
    double scale = 0, stiffness = 0;
    int reads_gradient = 0, rate_dependent = 0, elastic = 0, inelastic = 0;
    std::sscanf(end.answer.c_str(), "%lf %lf %d %d %d %d", &scale, &stiffness, &reads_gradient, &rate_dependent,
                &elastic, &inelastic);
    const std::string refusal = end.answer.substr(end.answer.find('|') + 1);
    if (!refusal.empty()) {
        result.figures = "the first call";
        result.fail("ends-analysis", refusal);
        return false;
    }
    subject.scale = scale;
    subject.stiffness = stiffness;
    subject.reads_gradient = reads_gradient != 0;
    subject.rate_dependent = rate_dependent != 0;
    result.figures =
        fmt::format("strain scale {:.3g}, stiffness {:.4g}{}{}{}", scale, stiffness,
                    implicit ? fmt::format("; {} elastic and {} inelastic increments", elastic, inelastic) : "",
                    subject.reads_gradient ? "; reads DFGRD1" : "", subject.rate_dependent ? "; depends on DTIME" : "");
    return true;
}

}  // namespace

SubjectReport run_checks(const Subject& given, const RunSettings& settings,
                         const std::function<void(const CheckResult&)>& progress) {
    Subject subject = given;
    SubjectReport report;
    report.material = subject.name;
    report.kind = name_of(subject.kind);
    report.library = subject.library->path();
    const auto add = [&](CheckResult result) {
        if (progress) progress(result);
        report.results.push_back(std::move(result));
    };
    const bool recorded_vumat = subject.recorded != nullptr && !subject.recorded->is_umat();
    const bool implicit = subject.library->umat() != nullptr && !recorded_vumat;
    CheckResult first;
    first.check = "ordinary-path";
    first.interface = implicit ? "umat" : "vumat";
    first.kind = report.kind;
    const bool usable = look(subject, implicit, settings.seconds, first);
    add(std::move(first));
    if (!usable) return report;
    for (const Check& check : all_checks()) {
        if (!settings.only.empty() &&
            std::find(settings.only.begin(), settings.only.end(), check.name) == settings.only.end())
            continue;
        if (settings.entry && *settings.entry != check.entry) continue;
        const bool exists = check.entry == Entry::umat ? implicit : subject.library->vumat() != nullptr;
        if (!exists) continue;
        if (subject.recorded != nullptr && (!check.at_state || (check.entry == Entry::vumat) != recorded_vumat))
            continue;
        // Explicit hosts tell plane stress by the number of components, or by the label that the library knows.
        if (check.entry == Entry::vumat && subject.kind == Kind::plane_stress && subject.model == nullptr) continue;
        add(run_check(check, subject, settings.seconds));
    }
    return report;
}

int count(const std::vector<SubjectReport>& reports, Verdict verdict) {
    int number = 0;
    for (const SubjectReport& report : reports)
        for (const CheckResult& result : report.results) number += result.verdict() == verdict ? 1 : 0;
    return number;
}

}  // namespace lode::host
