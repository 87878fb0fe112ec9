#include "variants.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "lode/material/property_places.hpp"

namespace lode::host {
namespace {

// What happens to a component over all steps.
struct Usage {
    bool by_strain = false, by_stress = false;  // while some step runs
    bool nonzero = false;
};

Control initial_control(const Scenario& scenario, std::string_view name) {
    if (scenario.analysis.kind == Kind::plane_strain && name == "33") return Control::strain;
    return scenario.analysis.unnamed;
}

Usage usage_of(const Scenario& scenario, const Layout& layout, int component) {
    Usage usage;
    Control control = initial_control(scenario, layout.name(component));
    for (const Step& step : scenario.steps) {
        if (const auto& prescribed = step.components[static_cast<std::size_t>(component)]) {
            control = prescribed->control;
            usage.nonzero = usage.nonzero || prescribed->value != 0;
        }
        if (step.moves_by_gradient()) control = Control::strain;
        (control == Control::strain ? usage.by_strain : usage.by_stress) = true;
    }
    if (const auto& stress = scenario.material.initial_stress)
        usage.nonzero = usage.nonzero || (*stress)[component] != 0;
    return usage;
}

bool is_normal(std::string_view name) { return name.size() == 2 && name[0] == name[1]; }

// Whether `kind`, which has no such component, stands for what happens to it.
bool stands_for(const Usage& usage, std::string_view name, Kind kind) {
    if (usage.nonzero) return false;
    const bool free_of_stress = kind == Kind::plane_stress || kind == Kind::uniaxial;
    return !(is_normal(name) && free_of_stress && usage.by_strain);
}

// A component that only the larger kind has keeps its strain or its stress at zero.
std::optional<Control> held(Kind from, std::string_view name) {
    if (is_normal(name) && (from == Kind::plane_stress || from == Kind::uniaxial)) return Control::stress;
    return Control::strain;
}

bool in_plane(const Matrix3& F) { return F(0, 2) == 0 && F(1, 2) == 0 && F(2, 0) == 0 && F(2, 1) == 0; }

bool gradients_fit(const Scenario& scenario, Kind kind) {
    const bool manufactured = std::any_of(scenario.steps.begin(), scenario.steps.end(),
                                          [](const Step& step) { return step.manufactured.has_value(); });
    if (!gradient_controlled(scenario) && !manufactured) return true;
    if (kind == Kind::solid) return true;
    if (kind != Kind::plane_strain && kind != Kind::axisymmetric) return false;
    return std::all_of(scenario.steps.begin(), scenario.steps.end(), [](const Step& step) {
        if (step.deformation_gradient && !in_plane(*step.deformation_gradient)) return false;
        return !step.rotation || (step.rotation->axis[0] == 0 && step.rotation->axis[1] == 0);
    });
}

bool has_initial_state(const MaterialSpec& material) {
    return !material.initial_named_state.empty() ||
           std::any_of(material.initial_state.begin(), material.initial_state.end(), [](double x) { return x != 0; });
}

}  // namespace

Scenario with_increments(Scenario scenario, int count) {
    for (Step& step : scenario.steps) step.increments = FixedIncrements{count};
    return scenario;
}

Scenario with_algorithm(Scenario scenario, const lode_model& model, const lode_algorithm& algorithm) {
    if (algorithm.parameter == 0) return scenario;
    auto& constants = scenario.material.constants;
    const int count = static_cast<int>(constants.size());
    const int number = property_index(model, algorithm.parameter, constants.data(), count);
    if (number == 0) return scenario;
    const auto places = property_places(model, constants.data(), count);
    if (number > count && model.parameters[algorithm.parameter - 1].default_value == algorithm.value) return scenario;
    while (constants.size() < static_cast<std::size_t>(number))
        constants.push_back(places[constants.size()].parameter->default_value);
    constants[static_cast<std::size_t>(number - 1)] = algorithm.value;
    return scenario;
}

const lode_algorithm* algorithm_of(const lode_model& model, const std::vector<double>& constants) {
    for (int i = 0; i < model.algorithm_count; ++i) {
        const lode_algorithm& algorithm = model.algorithms[i];
        if (algorithm.parameter == 0) return &algorithm;
        const int count = static_cast<int>(constants.size());
        const int number = property_index(model, algorithm.parameter, constants.data(), count);
        const bool given = number > 0 && number <= count;
        const double value = given ? constants[static_cast<std::size_t>(number - 1)]
                                   : model.parameters[algorithm.parameter - 1].default_value;
        if (value == algorithm.value) return &algorithm;
    }
    return nullptr;
}

std::optional<Scenario> in_kind(const Scenario& scenario, Kind kind) {
    const Layout from(scenario.analysis.kind), to(kind);
    if (from.kind() == to.kind()) return scenario;
    if (from.cohesive() != to.cohesive() || !gradients_fit(scenario, kind)) return std::nullopt;
    if (has_initial_state(scenario.material)) return std::nullopt;  // its layout belongs to the kind
    for (int i = 0; i < from.size(); ++i)
        if (!to.find(from.name(i)) && !stands_for(usage_of(scenario, from, i), from.name(i), kind)) return std::nullopt;
    // The host's guess of the thickness stretch is no part of the scene.
    if (gradient_controlled(scenario) && from.kind() == Kind::plane_stress) return std::nullopt;

    Scenario result = scenario;
    result.analysis.kind = kind;
    for (std::size_t s = 0; s < result.steps.size(); ++s) {
        Step& step = result.steps[s];
        step.components = {};
        for (int i = 0; i < to.size(); ++i) {
            const auto k = static_cast<std::size_t>(i);
            const std::string_view name = to.name(i);
            const auto source = from.find(name);
            if (source) step.components[k] = scenario.steps[s].components[static_cast<std::size_t>(*source)];
            if (s > 0 || step.moves_by_gradient() || step.components[k]) continue;
            // What went without saying in the kind of the scene.
            if (!source) step.components[k] = Prescribed{*held(from.kind(), name), 0};
            else if (initial_control(scenario, name) != initial_control(result, name))
                step.components[k] = Prescribed{initial_control(scenario, name), 0};
        }
    }
    if (const auto& stress = scenario.material.initial_stress) {
        Components turned = Components::Zero(to.size());
        for (int i = 0; i < to.size(); ++i)
            if (const auto source = from.find(to.name(i))) turned[i] = (*stress)[*source];
        result.material.initial_stress = turned;
    }
    return result;
}

std::vector<Kind> possible_kinds(const Scenario& scenario) {
    std::vector<Kind> kinds;
    for (const Kind kind :
         {Kind::solid, Kind::axisymmetric, Kind::plane_stress, Kind::uniaxial, Kind::cohesive_3d, Kind::cohesive_2d}) {
        // Plane strain and axisymmetric are the same to a material.
        const bool own = kind == scenario.analysis.kind ||
                         (kind == Kind::axisymmetric && scenario.analysis.kind == Kind::plane_strain);
        if (own) kinds.push_back(scenario.analysis.kind);
        else if (in_kind(scenario, kind)) kinds.push_back(kind);
    }
    return kinds;
}

bool stress_controlled(const Scenario& scenario) {
    const Layout layout(scenario.analysis.kind);
    for (int i = 0; i < layout.size(); ++i)
        if (usage_of(scenario, layout, i).by_stress) return true;
    return false;
}

bool gradient_controlled(const Scenario& scenario) {
    return std::any_of(scenario.steps.begin(), scenario.steps.end(),
                       [](const Step& s) { return s.moves_by_gradient(); });
}

std::optional<Scenario> in_small_strain(const Scenario& scenario) {
    if (!gradient_controlled(scenario)) return std::nullopt;
    Scenario result = scenario;
    const Layout layout(scenario.analysis.kind);
    result.analysis.large_rotation = false;
    for (Step& step : result.steps) {
        if (step.rotation || step.manufactured) return std::nullopt;
        if (!step.deformation_gradient) continue;
        const Matrix3 H = *step.deformation_gradient - Matrix3::Identity();
        const Components strain = layout.strain_components(0.5 * (H + H.transpose()));
        for (int i = 0; i < layout.size(); ++i)
            step.components[static_cast<std::size_t>(i)] = Prescribed{Control::strain, strain[i]};
        step.deformation_gradient.reset();
    }
    return result;
}

std::optional<Scenario> strain_driven(const Scenario& scenario, const Trace& times, const Trace& strains) {
    if (gradient_controlled(scenario) || times.points.size() < 2) return std::nullopt;
    const Layout layout(scenario.analysis.kind), full(layout.cohesive() ? Kind::cohesive_3d : Kind::solid);
    Scenario result = scenario;
    result.steps.clear();
    const double tolerance = 1e-9 * times.points.back().time;
    auto point = strains.points.begin();
    double begin = 0, step_begin = 0;
    std::size_t step = 0;
    for (std::size_t i = 1; i < times.points.size(); ++i) {
        const double time = times.points[i].time;
        while (point != strains.points.end() && point->time < time - tolerance) ++point;
        if (point == strains.points.end() || point->time > time + tolerance) return std::nullopt;
        while (step + 1 < scenario.steps.size() && time > step_begin + scenario.steps[step].time + tolerance)
            step_begin += scenario.steps[step++].time;
        const Step& whole = scenario.steps[step];
        if (whole.temperature || whole.fields) return std::nullopt;
        Step part;
        part.name = whole.name;
        part.time = time - begin;
        part.increments = FixedIncrements{1};
        for (int k = 0; k < layout.size(); ++k)
            part.components[static_cast<std::size_t>(k)] =
                Prescribed{Control::strain, point->strain[static_cast<std::size_t>(*full.find(layout.name(k)))]};
        result.steps.push_back(std::move(part));
        begin = time;
    }
    return result;
}

}  // namespace lode::host
