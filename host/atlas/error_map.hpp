// Iso-error map: the error of a single increment over its size and direction, from a state at the elastic limit, and
// what its solution took.
#ifndef LODE_HOST_ATLAS_ERROR_MAP_HPP
#define LODE_HOST_ATLAS_ERROR_MAP_HPP

#include <optional>
#include <vector>

#include "../library.hpp"
#include "../replay/scenario.hpp"
#include "../study/meter.hpp"
#include "sheet.hpp"

namespace lode::host {

// The increment x * along + y * across is taken in one go from the state after `start`.
struct ErrorMapAxes {
    Components start, along, across;
    std::vector<double> x, y;
    double stress_scale = 0;       // errors are relative to it; 0: the norm of the stress that `start` has brought
    bool relative_to_end = false;  // errors are relative to the exact stress after the increment instead
};

struct ErrorMapCell {
    double x = 0, y = 0;
    double error = 0;            // of the stress, relative to the scale; NaN if the increment was not done
    double reference_error = 0;  // estimate
    double pnewdt = 1;           // below 1: a smaller increment was asked for
    double nanoseconds = 0;      // of the call
    std::optional<lode_observation> observation;  // if the library says it
};

struct ErrorMap {
    std::vector<ErrorMapCell> cells;  // rows of y, x running first
    double largest = 0, mean = 0;     // of the cells that were done
    int cut_backs = 0;
    lode_observation most{};  // of any cell
};

// From the virgin state to the elastic limit in the direction of a deviator (cohesive: of opening); then increments of
// 0, 0.5, ..., 6 times that strain along it and across it (shear 12; cohesive: sliding). None if there is no limit.
std::optional<ErrorMapAxes> usual_axes(const Scenario& scenario, const Library& library, double strain_scale);

// `exact`: the same material with an algorithm that needs no small increments; none: many increments, extrapolated.
ErrorMap error_map(const Scenario& scenario, const Library& library, const ErrorMapAxes& axes,
                   const std::optional<Scenario>& exact, Meter* meter);

Sheet error_sheet(const ErrorMap& map, const std::string& stem, const std::string& title);
// What the solution took, cell by cell: iterations, or steps of safeguards.
Sheet solution_sheet(const ErrorMap& map, int lode_observation::*what, const char* label, const std::string& stem,
                     const std::string& title);

}  // namespace lode::host

#endif
