// What large rotations do to a stress: rigid turns, simple shear, closed cycles of strain and rotation.
#ifndef LODE_HOST_ATLAS_ROTATION_HPP
#define LODE_HOST_ATLAS_ROTATION_HPP

#include <string>
#include <vector>

#include "../library.hpp"
#include "../replay/scenario.hpp"
#include "sheet.hpp"

namespace lode::host {

struct RotationError {
    std::string motion;     // "turn", "shear", "cycle"
    std::string interface;  // "UMAT", "VUMAT"
    int increments = 0;     // of the motion; of the cycle: a leg
    double error = 0;
};

// A material stretched by `strain`, then turned by 360 degrees about axis 3: change of the stress relative to the
// largest on the way.
double turn_error(const Scenario& scenario, const Library& library, double strain, int increments);
// Simple shear to `gamma`, the body at rest before.
Components sheared_stress(const Scenario& scenario, const Library& library, double gamma, int increments);
// Stretch by `a`, shear by `a`, unstretch, unshear: what stress is left.
Components cycled_stress(const Scenario& scenario, const Library& library, double a, int increments);

// All three, both interfaces, 4 to 1024 increments. Errors are relative to the largest stress on the way.
std::vector<RotationError> rotation_errors(const Scenario& scenario, const Library& library, double strain_scale);

Sheet rotation_sheet(const std::vector<RotationError>& errors, const std::string& stem, const std::string& title);

}  // namespace lode::host

#endif
