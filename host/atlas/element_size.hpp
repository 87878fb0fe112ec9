// Softening laws over the size of the element: the largest size that the material accepts, and the energy that an
// element dissipates until it is pulled apart by a given displacement.
#ifndef LODE_HOST_ATLAS_ELEMENT_SIZE_HPP
#define LODE_HOST_ATLAS_ELEMENT_SIZE_HPP

#include <optional>
#include <string>
#include <vector>

#include "../library.hpp"
#include "../replay/scenario.hpp"
#include "sheet.hpp"

namespace lode::host {

struct LargestElement {
    double length = 0;    // by bisection
    std::string message;  // what the library says just above
};
// None if every length is accepted (up to 1e9), or none.
std::optional<LargestElement> largest_element(const Scenario& scenario, const Library& library);
bool accepts_element(const Scenario& scenario, const Library& library, double length, std::string* message = nullptr);

struct Dissipation {
    double length = 0;
    double energy = 0;                             // per area: of the stress less what is still stored
    std::vector<std::pair<double, double>> curve;  // displacement, stress
    bool complete = false;
};
// Pulls an element of each length in direction 11, lateral directions free, by the displacement at which an element of
// half the largest length has softened to a fifth of its strength.
std::vector<Dissipation> dissipation_over_size(const Scenario& scenario, const Library& library, double strain_scale,
                                               double largest_length, const std::vector<double>& fractions);

Sheet element_size_sheet(const std::optional<LargestElement>& largest, const std::vector<Dissipation>& runs,
                         const std::string& stem, const std::string& title);

}  // namespace lode::host

#endif
