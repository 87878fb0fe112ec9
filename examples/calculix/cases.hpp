// The comparisons: each runs structures in CalculiX and holds them against a reference.
#pragma once

#include <string>
#include <vector>

#include "ccx.hpp"

namespace ccx {

struct Check {
    std::string what, reference;
    double deviation, tolerance;
    std::string newton;  // iterations with the library and, in brackets, with CalculiX's own material
    bool passed() const { return deviation <= tolerance; }  // NaN fails
};

using Report = std::vector<Check>;

struct Case {
    const char *name, *title;
    void (*run)(const Host&, Report&);
};

extern const std::vector<Case> cases;

}  // namespace ccx
