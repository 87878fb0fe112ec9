// Runs recorded calls again and compares.
#ifndef LODE_HOST_RERUN_RECORDED_RUN_HPP
#define LODE_HOST_RERUN_RECORDED_RUN_HPP

#include <string>
#include <vector>

#include "../library.hpp"
#include "recording.hpp"

namespace lode::host {

struct RunAgain {
    bool returned = false;                     // false: the library ended the analysis
    std::vector<std::vector<double>> outputs;  // as RecordedCall::outputs
    double nanoseconds = 0;                    // median of the repetitions
};

// The call with exactly the recorded inputs, `repetitions` times; outputs of the last one. Throws NotLoaded if the
// library lacks the entry point.
RunAgain run_again(const RecordedCall& call, const Library& library, int repetitions = 1);

// The largest difference of one output, relative to the largest entry of that output.
struct Difference {
    std::string argument;  // "STRESS(2)", empty if every bit agrees
    double recorded = 0, now = 0, relative = 0;
};
Difference compare(const RecordedCall& call, const RunAgain& again);

}  // namespace lode::host

#endif
