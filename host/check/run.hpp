// Runs the checks of a subject, each in a child process.
#ifndef LODE_HOST_CHECK_RUN_HPP
#define LODE_HOST_CHECK_RUN_HPP

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "checks.hpp"

namespace lode::host {

struct RunSettings {
    double seconds = 10;            // for each check
    std::vector<std::string> only;  // names of checks, empty: all
    std::optional<Entry> entry;     // umat_ or vumat_ alone
};

// All results for one material in one kind.
struct SubjectReport {
    std::string material, kind, library;
    std::vector<CheckResult> results;
};
SubjectReport run_checks(const Subject& subject, const RunSettings& settings,
                         const std::function<void(const CheckResult&)>& progress = {});

// Number of results with this verdict.
int count(const std::vector<SubjectReport>& reports, Verdict verdict);

}  // namespace lode::host

#endif
