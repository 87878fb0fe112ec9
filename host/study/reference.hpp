// The solution that errors are measured against, and how far it can be trusted.
#ifndef LODE_HOST_STUDY_REFERENCE_HPP
#define LODE_HOST_STUDY_REFERENCE_HPP

#include <optional>
#include <string>

#include "trace.hpp"

namespace lode::host {

struct Reference {
    Trace trace;          // at the times of the coarsest of its runs
    double estimate = 0;  // of the error that the reference itself has, relative like the errors
    int increments =
        0;            // of the coarsest of its runs, in a step: what has a divisor of this number compares everywhere
    std::string how;  // in words
    bool compare_strain = false;
    bool smooth = true;  // false: the solution is too rough to extrapolate, and errors show no order
    bool valid() const { return trace.complete() && !trace.points.empty(); }

    Difference error_of(const Trace& other) const { return difference(other, trace, compare_strain); }
};

// Runs of N, 2N and 4N increments a step. If N and 2N agree to rounding the algorithm is exact on this path; else the
// runs are extrapolated with the order of the algorithm. The estimate is the difference of two extrapolations, or that
// of the finest run to them where the path is too rough to extrapolate. `order` as in lode_algorithm; N is a multiple
// of `multiple_of`, the increments that errors will be asked for.
Reference make_reference(const Scenario& scenario, const Library& library, double order, int multiple_of);

}  // namespace lode::host

#endif
