// Files and text of a chart.
#ifndef LODE_HOST_CHART_OUTPUT_HPP
#define LODE_HOST_CHART_OUTPUT_HPP

#include <string>

#include "chart.hpp"

namespace lode::host {

// One row a run. Throws Failure (usage) if the file cannot be written.
void write_csv(const Chart& chart, const std::string& path);
// The work-precision diagram; stem.gp, stem.png and stem.svg appear. Returns what went wrong, or nothing.
std::string draw(const Chart& chart, const std::string& stem);
// Reference, fitted orders and the Pareto front.
std::string text(const Chart& chart);

}  // namespace lode::host

#endif
