// The checks: one small function each, all with the same interface. Each runs in a child process of its own.
#ifndef LODE_HOST_CHECK_CHECKS_HPP
#define LODE_HOST_CHECK_CHECKS_HPP

#include <string_view>
#include <vector>

#include "finding.hpp"
#include "subject.hpp"

namespace lode::host {

using CheckFunction = void (*)(const Subject&, CheckResult&);

struct Check {
    std::string_view name;
    Entry entry;
    bool at_state;  // makes sense at a recorded call as well
    std::string_view what;
    CheckFunction run;
};
const std::vector<Check>& all_checks();

// tangent.cpp
void check_tangent(const Subject& subject, CheckResult& result);
void check_symmetry(const Subject& subject, CheckResult& result);
// frame.cpp
void check_objectivity(const Subject& subject, CheckResult& result);
// energy.cpp
void check_energy(const Subject& subject, CheckResult& result);
void check_closed_path(const Subject& subject, CheckResult& result);
// increments.cpp
void check_zero_increment(const Subject& subject, CheckResult& result);
void check_tiny_increments(const Subject& subject, CheckResult& result);
void check_splitting(const Subject& subject, CheckResult& result);
void check_cut_back(const Subject& subject, CheckResult& result);
void check_nan(const Subject& subject, CheckResult& result);
void check_absurd_increments(const Subject& subject, CheckResult& result);
// memory.cpp
void check_writes(const Subject& subject, CheckResult& result);
void check_uninitialised(const Subject& subject, CheckResult& result);
void check_short_arrays(const Subject& subject, CheckResult& result);
// repetition.cpp
void check_determinism(const Subject& subject, CheckResult& result);
void check_constants(const Subject& subject, CheckResult& result);
void check_threads(const Subject& subject, CheckResult& result);
// vumat_checks.cpp
void check_vumat_writes(const Subject& subject, CheckResult& result);
void check_vumat_outputs(const Subject& subject, CheckResult& result);
void check_vumat_block(const Subject& subject, CheckResult& result);
void check_vumat_components(const Subject& subject, CheckResult& result);
void check_vumat_frame(const Subject& subject, CheckResult& result);
void check_vumat_probe(const Subject& subject, CheckResult& result);
void check_vumat_energy(const Subject& subject, CheckResult& result);
void check_vumat_zero_increment(const Subject& subject, CheckResult& result);
void check_vumat_determinism(const Subject& subject, CheckResult& result);
void check_vumat_threads(const Subject& subject, CheckResult& result);
void check_vumat_nan(const Subject& subject, CheckResult& result);
void check_vumat_absurd(const Subject& subject, CheckResult& result);

}  // namespace lode::host

#endif
