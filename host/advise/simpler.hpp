// Simpler materials that might do in place of the scene's own.
#ifndef LODE_HOST_ADVISE_SIMPLER_HPP
#define LODE_HOST_ADVISE_SIMPLER_HPP

#include <string>
#include <vector>

#include "../library.hpp"
#include "../replay/scenario.hpp"

namespace lode::host {

struct SimplerScene {
    Scenario scenario;
    std::string origin;  // in words
    bool small_strain = false;
};

// The same material with the small-strain reading of the path; isotropic linear elasticity fitted to the material's
// initial tangent; the alternatives that the deck names.
std::vector<SimplerScene> simpler_scenes(const Scenario& scenario, const Library& library);

}  // namespace lode::host

#endif
