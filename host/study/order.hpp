// The order at which errors fall with the number of increments.
#ifndef LODE_HOST_STUDY_ORDER_HPP
#define LODE_HOST_STUDY_ORDER_HPP

#include <optional>
#include <vector>

namespace lode::host {

struct ErrorAt {
    int increments = 0;
    double error = 0;
};

// Slope of log(error) over log(increments), least squares over the finest errors that stand clear of `floor` (rounding
// and the error of the reference). None if fewer than three do.
std::optional<double> fitted_order(std::vector<ErrorAt> errors, double floor);

}  // namespace lode::host

#endif
