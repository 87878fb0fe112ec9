// How far each constant of a material may be varied by itself, and what stops it.
#ifndef LODE_HOST_ATLAS_CONSTANTS_HPP
#define LODE_HOST_ATLAS_CONSTANTS_HPP

#include <string>
#include <vector>

#include "../library.hpp"
#include "../replay/scenario.hpp"
#include "../study/meter.hpp"
#include "sheet.hpp"

namespace lode::host {

// One end of the interval of values that are accepted, found by bisection to 1e-9 of the value.
struct ConstantLimit {
    double value = 0;
    bool limited = false;  // else it was accepted as far as was looked
    std::string message;   // of the library, just outside
    bool works = false;    // just inside, the path to the strain scale can be followed
};
struct ConstantRange {
    std::string symbol;
    int property = 0;  // number in PROPS, from 1
    double value = 0;  // of the material
    ConstantLimit lower, upper;
};

// Of all constants that are neither zero nor codes, from a millionth to a million times their value. A constant is
// accepted if the library takes the material and an increment of zero.
std::vector<ConstantRange> constant_ranges(const Scenario& scenario, const lode_model& model, const Library& library,
                                           double strain_scale, Meter* meter);

Sheet constants_sheet(const std::vector<ConstantRange>& ranges, const std::string& stem, const std::string& title);

}  // namespace lode::host

#endif
