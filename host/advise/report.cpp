#include "report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "../cards.hpp"
#include "../status.hpp"

namespace lode::host {
namespace {

std::string increments_text(const Option& option) {
    return option.increments > 0 ? fmt::format("{} a step", option.increments) : "as in the deck";
}

// What follows a colon explains.
std::string short_name(const std::string& algorithm) { return algorithm.substr(0, algorithm.find(':')); }

std::string strain_text(const Option& option) {
    return option.strain == StrainMeasure::small ? "small strain" : "strain as in the deck";
}

std::string cost_text(const Option& option) {
    if (!option.cost) return "-";
    return fmt::format("{:.0f} ({:.0f}..{:.0f})", option.cost->median, option.cost->low, option.cost->high);
}

std::string summary(const Option& option) {
    return fmt::format("{}{}{}, {}, {}, {}, increments {}", option.material, option.algorithm.empty() ? "" : ", ",
                       short_name(option.algorithm), name_of(option.kind), option.interface_name(), strain_text(option),
                       increments_text(option));
}

std::vector<std::string> row(const Option& option) {
    return {option.sufficient ? "yes" : "no",
            option.origin,
            option.material,
            option.algorithm.empty() ? "-" : short_name(option.algorithm),
            std::string(name_of(option.kind)),
            option.interface_name(),
            increments_text(option),
            std::isfinite(option.error) ? fmt::format("{:.2e}", option.error) : "failed",
            cost_text(option)};
}

std::string saving(const char* what, const Option& best, const std::optional<Option>& other) {
    if (!other || !other->cost || !best.cost || !(best.cost->median > 0)) return {};
    return fmt::format("  against {}: {:.0f} ns, error {:.2e}; {:.1f} times the cost\n", what, other->cost->median,
                       other->error, other->cost->median / best.cost->median);
}

std::string list(const std::vector<double>& values) {
    std::string text;
    for (const double value : values) text += fmt::format("{}{}", text.empty() ? "" : ", ", value);
    return text;
}

}  // namespace

std::string text(const Advice& advice) {
    std::string result = fmt::format("tolerance   {:g} of the largest stress{}\n", advice.tolerance,
                                     advice.reference.compare_strain ? " and of the largest strain" : "");
    result += fmt::format("reference   {}{}; its own error is about {:.1e}\n",
                          advice.reference_algorithm.empty() ? "" : advice.reference_algorithm + ", ",
                          advice.reference.how, advice.reference.estimate);
    result += advice.tangent_needed ? "tangent     needed: some strains follow from stresses, so UMAT only\n"
                                    : "tangent     not needed: all strains are prescribed, so a VUMAT may do\n";
    if (advice.best) {
        result += fmt::format("advice      {}\n  error {:.2e}, {} ns for each point\n", summary(*advice.best),
                              advice.best->error, cost_text(*advice.best));
        result += saving("the deck as it is", *advice.best, advice.as_written);
        result += saving("the safest setting", *advice.best, advice.safest);
        result += fmt::format("  {}\n", advice.best->origin);
    } else {
        result += fmt::format("advice      none: nothing that was run meets the tolerance; {}\n", advice.verdict);
    }
    std::vector<std::vector<std::string>> rows{
        {"enough", "tried", "material", "algorithm", "kind", "interface", "increments", "error", "cost (ns)"}};
    for (const Option& option : advice.options) rows.push_back(row(option));
    return result + "what was run\n" + aligned(rows, "  ");
}

Table evidence(const Advice& advice) {
    Table table({"sufficient", "origin", "material", "algorithm", "kind", "interface", "strain", "increments", "error",
                 "cost_ns", "cost_low_ns", "cost_high_ns", "failure"});
    const auto add = [&table](const Option& o) {
        const double none = std::nan("");
        table.add({o.sufficient ? "yes" : "no", o.origin, o.material, o.algorithm, name_of(o.kind), o.interface_name(),
                   o.strain == StrainMeasure::small ? "small" : "as the deck", o.increments, o.error,
                   o.cost ? o.cost->median : none, o.cost ? o.cost->low : none, o.cost ? o.cost->high : none,
                   o.failure});
    };
    for (const Option& option : advice.options) add(option);
    if (advice.as_written) add(*advice.as_written);
    if (advice.safest) add(*advice.safest);
    return table;
}

std::string cards(const Option& option, const Library& library) {
    const Scenario& scene = option.scenario;
    const auto& constants = scene.material.constants;
    const lode_model* model = library.model_of(scene.material.name);
    const auto [ndi, nshr] = layout_of(scene.analysis.kind);
    int states = scene.material.state_variables.value_or(0);
    if (const auto count = library.required_state(scene.material.name, constants, ndi, nshr))
        states = std::max(states, *count);
    std::string result = "* Abaqus\n" + material_cards(scene.material.name, constants, states,
                                                       model != nullptr && (model->traits & LODE_UNSYMMETRIC) != 0);
    result += fmt::format(
        "# lode replay\n[material]\nname = \"{}\"\nconstants = [{}]\n[analysis]\nkind = \"{}\"\ninterface = \"{}\"\n",
        scene.material.name, list(constants), name_of(scene.analysis.kind),
        option.entry == Entry::umat ? "umat" : "vumat");
    if (option.precision == Precision::single) result += "precision = \"single\"\n";
    if (scene.analysis.large_rotation)
        result += fmt::format("large_rotation = {}\n", *scene.analysis.large_rotation ? "true" : "false");
    if (option.increments > 0) result += fmt::format("# in every [[step]]\nincrements = {}\n", option.increments);
    return result;
}

}  // namespace lode::host
