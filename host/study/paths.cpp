#include "paths.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "../cards.hpp"
#include "../status.hpp"
#include "../text.hpp"

namespace lode::host {
namespace {

constexpr double room_temperature = 300;  // absolute, for equations of state

// Corners in units of the sample's strain scale.
struct Definition {
    const char* name;
    const char* title;
    std::vector<std::array<double, 4>> corners;
};

// Strains 11, 22, 33, 12 (engineering); other shears are zero. In one dimension only the first counts.
const std::vector<Definition>& small_strain_paths() {
    static const std::vector<Definition> paths{
        {"uniaxial", "Extension with lateral contraction", {{1, -0.3, -0.3, 0}}},
        {"shear", "Simple shear", {{0, 0, 0, 2}}},
        {"corner", "Extension, then shear: a sharp corner", {{0.7, -0.35, -0.35, 0}, {0.7, -0.35, -0.35, 1.6}}},
        {"cyclic",
         "Extension and shear by turns, around a square",
         {{1, -0.4, -0.4, 0}, {0, 0, 0, 1.6}, {-1, 0.4, 0.4, 0}, {0, 0, 0, -1.6}, {1, -0.4, -0.4, 0}}},
        {"apex", "Shear, then extension in all directions", {{0.2, -0.1, -0.1, 0.6}, {1.2, 0.9, 0.9, 0.6}}},
        {"compression_tension", "Compression, then tension", {{-1, 0.3, 0.3, 0}, {1, -0.3, -0.3, 0}}},
    };
    return paths;
}

// F - 1: 11, 22, 33, 12, and a rotation by 90 degrees where the last corner of "turn" is.
const std::vector<Definition>& finite_strain_paths() {
    static const std::vector<Definition> paths{
        {"stretch", "Stretch with lateral contraction", {{1, -0.3, -0.3, 0}}},
        {"shear", "Simple shear", {{0, 0, 0, 2}}},
        {"corner", "Stretch, then shear: a sharp corner", {{0.7, -0.3, -0.3, 0}, {0.7, -0.3, -0.3, 1.6}}},
        {"cyclic",
         "Stretch and shear by turns, around a square",
         {{1, -0.4, -0.4, 0}, {0, 0, 0, 1.6}, {-0.6, 0.3, 0.3, 0}, {0, 0, 0, -1.6}, {1, -0.4, -0.4, 0}}},
        {"turn", "Stretch, then a quarter turn", {{1, -0.3, -0.3, 0.5}, {0, 0, 0, 0}}},
        {"compression_tension", "Compression, then tension", {{-0.6, 0.2, 0.2, 0}, {1, -0.3, -0.3, 0}}},
    };
    return paths;
}

// Separations n, s1, s2.
const std::vector<Definition>& cohesive_paths() {
    static const std::vector<Definition> paths{
        {"opening", "Opening", {{1, 0, 0, 0}}},
        {"sliding", "Sliding", {{0, 1, 0, 0}}},
        {"mixed", "Opening and sliding in one direction", {{0.5, 0.6, 0, 0}}},
        {"corner", "Opening, then sliding: a sharp corner", {{0.3, 0, 0, 0}, {0.3, 0.6, 0, 0}}},
        {"cyclic",
         "Opening and sliding with unloading",
         {{0.3, 0.2, 0, 0}, {0, 0, 0, 0}, {0.5, -0.3, 0, 0}, {0, 0, 0, 0}, {1, 0.5, 0, 0}}},
        {"compression_shear",
         "Closing, then sliding, then opening",
         {{-0.02, 0, 0, 0}, {-0.02, 0.6, 0, 0}, {0.8, 0.6, 0, 0}}},
    };
    return paths;
}

const std::vector<Definition>& paths_of(const lode_model& model, Kind kind) {
    if (is_cohesive(kind)) return cohesive_paths();
    return (model.traits & LODE_FINITE_STRAIN) != 0 ? finite_strain_paths() : small_strain_paths();
}

Step gradient_step(const std::array<double, 4>& corner, double scale, bool turn) {
    Step step;
    if (turn) {
        step.rotation = Rotation{Eigen::Vector3d::UnitZ(), std::numbers::pi / 2};
        return step;
    }
    Matrix3 F = Matrix3::Identity();
    for (int i = 0; i < 3; ++i) F(i, i) += scale * corner[static_cast<std::size_t>(i)];
    F(0, 1) = scale * corner[3];
    step.deformation_gradient = F;
    return step;
}

Step strain_step(const std::array<double, 4>& corner, double scale, const Layout& layout) {
    Step step;
    const Layout full(Kind::solid);
    for (int i = 0; i < layout.size(); ++i) {
        const auto place = static_cast<std::size_t>(layout.cohesive() ? i : *full.find(layout.name(i)));
        step.components[static_cast<std::size_t>(i)] =
            Prescribed{Control::strain, place < corner.size() ? scale * corner[place] : 0};
    }
    return step;
}

}  // namespace

Scenario sample_scenario(const lode_model& model, const lode_sample& sample, Kind kind) {
    Scenario scenario;
    scenario.material.name = material_name(model, sample);
    scenario.material.constants.assign(sample.constants, sample.constants + sample.constant_count);
    scenario.analysis.kind = kind;
    if ((model.traits & LODE_EQUATION_OF_STATE) != 0) scenario.analysis.temperature = room_temperature;
    scenario.analysis.fields = {0.0};  // materials that read a field variable find one
    // The deformation gradient is there for models that can use it.
    if (!is_cohesive(kind)) scenario.analysis.large_rotation = true;
    scenario.stem = fmt::format("{}_{}", scenario.material.name, name_of(kind));
    scenario.title = fmt::format("{}, {}", scenario.material.name, name_of(kind));
    return scenario;
}

std::vector<Scenario> built_in_paths(const lode_model& model, const lode_sample& sample, Kind kind) {
    std::vector<Scenario> scenarios;
    const Layout layout(kind);
    const bool gradient = (model.traits & LODE_FINITE_STRAIN) != 0 && !layout.cohesive();
    for (const Definition& path : paths_of(model, kind)) {
        const std::string_view name = path.name;
        if (kind == Kind::uniaxial && (name == "shear" || name == "corner" || name == "apex")) continue;
        Scenario scenario = sample_scenario(model, sample, kind);
        scenario.stem += "_" + std::string(name);
        scenario.title += fmt::format(": {}", path.title);
        for (std::size_t i = 0; i < path.corners.size(); ++i)
            scenario.steps.push_back(gradient
                                         ? gradient_step(path.corners[i], sample.strain_scale, name == "turn" && i > 0)
                                         : strain_step(path.corners[i], sample.strain_scale, layout));
        scenarios.push_back(std::move(scenario));
    }
    return scenarios;
}

std::string path_name(const Scenario& scenario) {
    const std::string prefix = fmt::format("{}_{}_", scenario.material.name, name_of(scenario.analysis.kind));
    return scenario.stem.starts_with(prefix) ? scenario.stem.substr(prefix.size()) : scenario.stem;
}

Scenario built_in_path(const lode_model& model, const lode_sample& sample, Kind kind, std::string_view name) {
    std::vector<std::string> names;
    for (Scenario& scenario : built_in_paths(model, sample, kind)) {
        if (path_name(scenario) == name) return scenario;
        names.push_back(path_name(scenario));
    }
    throw Failure(Status::usage, fmt::format("there is no path \"{}\" for {} in {}{}; there are {}", name,
                                             model.keyword, name_of(kind), did_you_mean(name, names), joined(names)));
}

}  // namespace lode::host
