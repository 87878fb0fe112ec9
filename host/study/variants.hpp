// The same scene under another setting: kind, algorithm, number of increments, strain measure.
#ifndef LODE_HOST_STUDY_VARIANTS_HPP
#define LODE_HOST_STUDY_VARIANTS_HPP

#include <optional>
#include <string>
#include <vector>

#include "../library.hpp"
#include "../replay/scenario.hpp"
#include "trace.hpp"

namespace lode::host {

// Scenarios here have not been resolved: what belongs to a kind is filled in when they run.

// So many equal increments in every step.
Scenario with_increments(Scenario scenario, int count);

// The PROPS entry that selects the algorithm is set; entries before it that are missing get their defaults.
Scenario with_algorithm(Scenario scenario, const lode_model& model, const lode_algorithm& algorithm);
// The algorithm that the constants select; null if the description has none that fits.
const lode_algorithm* algorithm_of(const lode_model& model, const std::vector<double>& constants);

// The scene in another kind, or none if the path does not allow it: what the kind leaves out has to be zero, and free
// of stress (plane stress, 1D) or of shear.
std::optional<Scenario> in_kind(const Scenario& scenario, Kind kind);
// All kinds that the path allows, the fullest first, that of the scenario included.
std::vector<Kind> possible_kinds(const Scenario& scenario);

// Whether any component is found from its stress.
bool stress_controlled(const Scenario& scenario);
// Whether a step prescribes the deformation gradient or a rotation.
bool gradient_controlled(const Scenario& scenario);

// The geometrically linear reading of a scene that prescribes deformation gradients without rotation: the strain is
// the symmetric part of F - 1. None if a step rotates, or if there is nothing to read linearly.
std::optional<Scenario> in_small_strain(const Scenario& scenario);

// The scene with all strains prescribed: those that `strains` found, at the times of `times`. What an explicit host
// does to its materials, whatever it controls. None if a time is missing in `strains`, or with deformation gradients,
// temperatures or fields.
std::optional<Scenario> strain_driven(const Scenario& scenario, const Trace& times, const Trace& strains);

}  // namespace lode::host

#endif
