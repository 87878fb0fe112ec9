#include "order.hpp"

#include <algorithm>
#include <cmath>

namespace lode::host {
namespace {

constexpr std::size_t most_points = 4;
constexpr double clear = 20;  // times the floor: the order is then off by less than 0.1

}  // namespace

std::optional<double> fitted_order(std::vector<ErrorAt> errors, double floor) {
    std::sort(errors.begin(), errors.end(),
              [](const ErrorAt& a, const ErrorAt& b) { return a.increments > b.increments; });
    std::vector<ErrorAt> used;
    for (const ErrorAt& e : errors)
        if (e.error > clear * floor && used.size() < most_points) used.push_back(e);
    if (used.size() < 3) return std::nullopt;
    double x_mean = 0, y_mean = 0;
    for (const ErrorAt& e : used) {
        x_mean += std::log(e.increments);
        y_mean += std::log(e.error);
    }
    x_mean /= static_cast<double>(used.size());
    y_mean /= static_cast<double>(used.size());
    double xx = 0, xy = 0;
    for (const ErrorAt& e : used) {
        const double x = std::log(e.increments) - x_mean;
        xx += x * x;
        xy += x * (std::log(e.error) - y_mean);
    }
    return xx > 0 ? std::optional<double>(-xy / xx) : std::nullopt;
}

}  // namespace lode::host
