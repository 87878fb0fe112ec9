// Ready-to-paste material cards of a sample: Abaqus, CalculiX, and a deck for `lode replay`.
#ifndef LODE_HOST_CARDS_HPP
#define LODE_HOST_CARDS_HPP

#include <string>
#include <vector>

#include "library.hpp"
#include "replay/analysis.hpp"

namespace lode::host {

// Kinds that a mask of lode.h has; axisymmetric goes with plane strain and is not listed.
std::vector<Kind> kinds_of(unsigned mask);
// NDI, NSHR
std::pair<int, int> layout_of(Kind kind);

std::string material_name(const lode_model& model, const lode_sample& sample);
// *MATERIAL, *USER MATERIAL and *DEPVAR of any constants.
std::string material_cards(const std::string& name, const std::vector<double>& constants, int state_variables,
                           bool unsymmetric);
std::string abaqus_cards(const lode_model& model, const lode_sample& sample, const Library& library);
// Empty if CalculiX, which sends solids only, cannot use the model.
std::string calculix_cards(const lode_model& model, const lode_sample& sample, const Library& library);
std::string replay_deck(const lode_model& model, const lode_sample& sample);

}  // namespace lode::host

#endif
