#include "simpler.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "../study/material_point.hpp"
#include "../study/variants.hpp"
#include "../text.hpp"

namespace lode::host {
namespace {

constexpr const char* elastic_keyword = "ISO_ELASTIC";

struct Moduli {
    double young, poisson;
};

// The isotropic part of a stiffness: the same resistance to a change of volume, the same sum of eigenvalues.
std::optional<Moduli> isotropic_part(const Tangent& d) {
    const double bulk = d.topLeftCorner(3, 3).sum() / 9;
    const double sum = d(0, 0) + d(1, 1) + d(2, 2) + 2 * (d(3, 3) + d(4, 4) + d(5, 5));
    const double shear = (sum - 3 * bulk) / 10;
    const Moduli moduli{9 * bulk * shear / (3 * bulk + shear), (3 * bulk - 2 * shear) / (2 * (3 * bulk + shear))};
    if (!(bulk > 0) || !(shear > 0) || !(moduli.poisson > -1) || !(moduli.poisson < 0.5)) return std::nullopt;
    return moduli;
}

const lode_model* elastic_model(const Library& library) {
    const lode_model* model = library.model_of(elastic_keyword);
    const bool understood = model != nullptr && model->parameter_count >= 2 && model->required_count == 2 &&
                            upper(model->parameters[0].symbol) == "E" && upper(model->parameters[1].symbol) == "NU";
    return understood ? model : nullptr;
}

MaterialSpec other_material(const MaterialSpec& own, const std::string& name, const std::vector<double>& constants) {
    MaterialSpec material;
    material.name = name;
    material.constants = constants;
    material.initial_stress = own.initial_stress;
    material.density = own.density;
    material.expansion = own.expansion;
    material.library = own.library;
    return material;
}

bool reads_gradient(const Scenario& scenario, const Library& library) {
    const lode_model* model = library.model_of(scenario.material.name);
    return model != nullptr && (model->traits & LODE_FINITE_STRAIN) != 0;
}

// Geometrically linear, if the deck is not anyway and the material can be.
std::optional<Scenario> linear(const Scenario& scenario, const Library& library) {
    if (is_cohesive(scenario.analysis.kind) || reads_gradient(scenario, library)) return std::nullopt;
    if (gradient_controlled(scenario)) return in_small_strain(scenario);
    if (!scenario.analysis.large_rotation.value_or(false)) return std::nullopt;
    Scenario result = scenario;
    result.analysis.large_rotation = false;
    return result;
}

std::optional<SimplerScene> fitted_elasticity(const Scenario& scenario, const Library& library) {
    const lode_model* elastic = elastic_model(library);
    if (elastic == nullptr || is_cohesive(scenario.analysis.kind) || library.umat() == nullptr) return std::nullopt;
    if (library.model_of(scenario.material.name) == elastic) return std::nullopt;
    Scenario solid = scenario;
    solid.analysis.kind = Kind::solid;
    solid.analysis.entry = Entry::umat;
    solid.material.initial_stress.reset();
    solid.material.state_variables.reset();
    try {
        const auto moduli = isotropic_part(MaterialPoint(solid, library).tangent());
        if (!moduli) return std::nullopt;
        SimplerScene simpler{scenario, "isotropic linear elasticity fitted to the initial tangent", false};
        simpler.scenario.material = other_material(scenario.material, fmt::format("{}-FITTED", elastic_keyword),
                                                   {moduli->young, moduli->poisson});
        if (const auto small = linear(simpler.scenario, library)) {
            simpler.scenario = *small;
            simpler.small_strain = true;
        }
        return simpler;
    } catch (const Refused&) {
        return std::nullopt;
    }
}

}  // namespace

std::vector<SimplerScene> simpler_scenes(const Scenario& scenario, const Library& library) {
    std::vector<SimplerScene> scenes;
    if (auto small = linear(scenario, library)) scenes.push_back({std::move(*small), "small strain", true});
    if (auto elastic = fitted_elasticity(scenario, library)) scenes.push_back(std::move(*elastic));
    for (const MaterialSpec& alternative : scenario.alternatives) {
        SimplerScene simpler{scenario, "named in the deck", false};
        simpler.scenario.material = other_material(scenario.material, alternative.name, alternative.constants);
        scenes.push_back(simpler);
        if (auto small = linear(simpler.scenario, library))
            scenes.push_back({std::move(*small), "named in the deck, small strain", true});
    }
    return scenes;
}

}  // namespace lode::host
