// Loads beyond a limit point: the peak of a strain-driven path, and the largest stress that a stress-driven one
// reaches.
#ifndef LODE_HOST_ATLAS_LIMIT_POINT_HPP
#define LODE_HOST_ATLAS_LIMIT_POINT_HPP

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../library.hpp"
#include "../replay/scenario.hpp"
#include "sheet.hpp"

namespace lode::host {

struct LimitPoint {
    double strain = 0, stress = 0;                 // of the strain-driven path
    double reached = 0;                            // largest stress that stress control reaches, by bisection
    std::string message;                           // how it ends just above
    std::vector<std::pair<double, double>> curve;  // of the strain-driven path
};

// Component 1 is driven, the others are free of stress (cohesive: held). None if the stress has no peak up to 20 times
// the strain scale.
std::optional<LimitPoint> limit_point(const Scenario& scenario, const Library& library, double strain_scale);
// Whether stress control gets to this stress; `message` says why not.
bool reaches(const Scenario& scenario, const Library& library, double stress, std::string* message = nullptr);

Sheet limit_point_sheet(const LimitPoint& limit, const std::string& stem, const std::string& title);

}  // namespace lode::host

#endif
