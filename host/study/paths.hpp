// Paths that show what the models of a family do, scaled to a sample of constants.
#ifndef LODE_HOST_STUDY_PATHS_HPP
#define LODE_HOST_STUDY_PATHS_HPP

#include <string_view>
#include <vector>

#include "../library.hpp"
#include "../replay/scenario.hpp"

namespace lode::host {

// The name of the path that claimed orders refer to: it turns sharply while the material is beyond its elastic range.
inline constexpr std::string_view corner_path = "corner";

// All built-in paths of a sample in a kind, as scenarios whose stem is KEYWORD-LABEL_kind_path and whose title says
// what they are. Every component is prescribed. Steps have one time unit.
std::vector<Scenario> built_in_paths(const lode_model& model, const lode_sample& sample, Kind kind);
// The same, one of them; throws Failure (usage) naming the legal ones.
Scenario built_in_path(const lode_model& model, const lode_sample& sample, Kind kind, std::string_view name);
// "corner" from the stem of such a scenario.
std::string path_name(const Scenario& scenario);

// The scenario of a sample without steps.
Scenario sample_scenario(const lode_model& model, const lode_sample& sample, Kind kind);

}  // namespace lode::host

#endif
