// `lode chart`: accuracy against cost, for a deck or for the built-in paths of a material.
#ifndef LODE_HOST_CHART_COMMAND_HPP
#define LODE_HOST_CHART_COMMAND_HPP

#include <string>
#include <vector>

#include "../status.hpp"

namespace lode::host {

struct ChartOptions {
    std::vector<std::string> targets;  // decks, KEYWORD or KEYWORD-LABEL
    bool all = false;                  // every material of the library
    bool first = false;                // only the first sample of each model
    std::string library, single_library, output_directory = ".";
    std::string path;                // one of the built-in paths; empty: all
    std::vector<std::string> kinds;  // empty: of a deck all that its path allows, of a material the fullest
    std::vector<int> increments;     // empty: 1, 2, 4, ..., 128
    bool no_cost = false, quiet = false;
};

Status chart(const ChartOptions& options);

}  // namespace lode::host

#endif
