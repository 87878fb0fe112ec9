#include "command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <list>
#include <optional>

#include "../cards.hpp"
#include "../guard.hpp"
#include "../replay/deck.hpp"
#include "../replay/driver.hpp"
#include "../study/libraries.hpp"
#include "../study/material_point.hpp"
#include "../study/meter.hpp"
#include "../study/paths.hpp"
#include "../study/variants.hpp"
#include "../text.hpp"
#include "constants.hpp"
#include "element_size.hpp"
#include "ellipticity.hpp"
#include "error_map.hpp"
#include "failure_rate.hpp"
#include "limit_point.hpp"
#include "rotation.hpp"
#include "time_step.hpp"

namespace lode::host {
namespace {

// A material in a kind, and what maps need to know of it.
struct Subject {
    const lode_model& model;
    const lode_sample& sample;
    Kind kind;
    const Library& library;
    const Scenario* deck = nullptr;  // the scene that the material comes from

    Scenario scenario() const {
        Scenario scene = as_in_deck(sample_scenario(model, sample, kind));
        if (scene.analysis.large_rotation && (model.traits & LODE_FINITE_STRAIN) == 0)
            scene.analysis.large_rotation = false;
        return scene;
    }
    // With the material and the surroundings of the deck.
    Scenario as_in_deck(Scenario scene) const {
        if (deck == nullptr) return scene;
        scene.material = deck->material;
        scene.analysis.element_length = deck->analysis.element_length;
        scene.analysis.temperature = deck->analysis.temperature;
        if (!deck->analysis.fields.empty()) scene.analysis.fields = deck->analysis.fields;
        return scene;
    }
    std::string name() const { return deck != nullptr ? deck->stem : material_name(model, sample); }
    std::string stem(const std::string& map) const { return fmt::format("{}_{}_{}", name(), name_of(kind), map); }
    std::string title(const std::string& what) const { return fmt::format("{}, {}: {}", name(), name_of(kind), what); }
    bool cohesive() const { return is_cohesive(kind); }
    bool has(unsigned trait) const { return (model.traits & trait) != 0; }
};

using Sheets = std::vector<Sheet>;

// One for each algorithm that the constants can select, where there is an elastic limit.
Sheets error_maps(const Subject& s, bool quiet) {
    Sheets sheets;
    const Scenario scene = s.scenario();
    const auto axes = usual_axes(scene, s.library, s.sample.strain_scale);
    if (!axes) return sheets;
    std::optional<Scenario> exact;
    for (int i = 0; i < s.model.algorithm_count; ++i)
        if (std::isinf(s.model.algorithms[i].order)) {
            Scenario candidate = with_algorithm(scene, s.model, s.model.algorithms[i]);
            try {
                if (MaterialPoint(candidate, s.library).advance(axes->start)) exact = candidate;
            } catch (const Refused&) {
            }
        }
    if (exact && s.model.algorithm_count == 1) exact.reset();  // it would be compared with itself
    for (int i = 0; i < s.model.algorithm_count; ++i) {
        const lode_algorithm& algorithm = s.model.algorithms[i];
        const Scenario own = with_algorithm(scene, s.model, algorithm);
        try {
            Meter meter("atlas: " + s.stem("error"), static_cast<int>(axes->x.size() * axes->y.size()), quiet);
            // Elastic after the limit as well: nothing to see.
            const bool is_exact = std::isinf(algorithm.order);
            const ErrorMap map = error_map(own, s.library, *axes, is_exact ? std::nullopt : exact, &meter);
            const std::string number = s.model.algorithm_count > 1 ? fmt::format("_{}", i + 1) : "";
            sheets.push_back(error_sheet(map, s.stem("error" + number), s.title(algorithm.name)));
            if (map.most.iterations > 0)
                sheets.push_back(solution_sheet(map, &lode_observation::iterations,
                                                "iterations (evaluations of the residual)",
                                                s.stem("iterations" + number), s.title(algorithm.name)));
            if (map.most.safeguards > 0)
                sheets.push_back(solution_sheet(map, &lode_observation::safeguards, "steps of a safeguard",
                                                s.stem("safeguards" + number), s.title(algorithm.name)));
        } catch (const Refused&) {
            // the algorithm does not go with these constants
        }
    }
    return sheets;
}

Sheets time_step_maps(const Subject& s, bool) {
    if (s.library.vumat() == nullptr) return {};
    const Scenario scene = s.scenario();
    const auto limits = time_step_limits(scene, s.library, s.sample.strain_scale);
    std::vector<TimeStepLimit> along;
    if (s.has(LODE_ELASTIC) && !s.cohesive()) along = time_step_along(scene, s.library, s.sample.strain_scale, 8);
    return {time_step_sheet(limits, along, s.stem("time_step"), s.title("explicit time step of one element"))};
}

Sheets element_size_maps(const Subject& s, bool) {
    if (!s.has(LODE_USES_CELENT) || s.cohesive()) return {};
    const Scenario scene = s.scenario();
    const auto largest = largest_element(scene, s.library);
    if (!largest) return {};
    std::vector<double> fractions;
    constexpr int halvings = 7;
    for (int i = 1; i <= halvings; ++i) fractions.push_back(std::ldexp(1.0, -i));
    const auto runs = dissipation_over_size(scene, s.library, s.sample.strain_scale, largest->length, fractions);
    return {element_size_sheet(largest, runs, s.stem("element_size"), s.title("softening over the element size"))};
}

Sheets ellipticity_maps(const Subject& s, bool) {
    if (s.cohesive() || s.kind == Kind::uniaxial || s.library.umat() == nullptr) return {};
    std::vector<std::pair<std::string, Ellipticity>> paths;
    for (Scenario& path : built_in_paths(s.model, s.sample, s.kind))
        paths.emplace_back(path_name(path), ellipticity_along(with_increments(s.as_in_deck(path), 50), s.library));
    return {ellipticity_sheet(paths, s.stem("ellipticity"), s.title("acoustic tensor along the built-in paths"))};
}

Sheets rotation_maps(const Subject& s, bool) {
    if (s.kind != Kind::solid && s.kind != Kind::plane_strain) return {};
    const double strain = s.has(LODE_FINITE_STRAIN) ? s.sample.strain_scale : std::max(s.sample.strain_scale, 0.1);
    const auto errors = rotation_errors(s.scenario(), s.library, strain);
    return {rotation_sheet(errors, s.stem("rotation"), s.title("large rotation"))};
}

Sheets limit_point_maps(const Subject& s, bool) {
    if (s.library.umat() == nullptr) return {};
    const auto limit = limit_point(s.scenario(), s.library, s.sample.strain_scale);
    if (!limit) return {};
    return {limit_point_sheet(*limit, s.stem("limit_point"), s.title("stress control up to a limit point"))};
}

// With algorithms that are never at a loss, or never need a safeguard, there is nothing to see.
Sheets failure_maps(const Subject& s, bool quiet) {
    if (s.library.umat() == nullptr) return {};
    const Scenario scene = s.scenario();
    std::vector<Algorithm> algorithms;
    for (int i = 0; i < s.model.algorithm_count; ++i)
        algorithms.push_back({s.model.algorithms[i].name, with_algorithm(scene, s.model, s.model.algorithms[i])});
    std::vector<double> sizes;
    for (int i = -4; i <= 3; ++i) sizes.push_back(s.sample.strain_scale * std::pow(10.0, 0.5 * i));
    constexpr int states = 300;
    Meter meter("atlas: " + s.stem("failures"), states, quiet);
    const auto rates = failure_rates(scene, algorithms, s.library, s.sample.strain_scale, sizes, states, &meter);
    const auto never = [](const AlgorithmRates& a) {
        return std::all_of(a.rates.begin(), a.rates.end(), [](const FailureRate& r) { return r.cut == 0; });
    };
    Sheets sheets;
    if (!std::all_of(rates.begin(), rates.end(), never))
        sheets.push_back(failure_sheet(rates, s.stem("failures"), s.title("random increments that are refused")));
    if (std::any_of(rates.begin(), rates.end(), [](const AlgorithmRates& a) { return a.is_ever_safeguarded(); }))
        sheets.push_back(safeguard_sheet(rates, s.stem("fallbacks"), s.title("random increments with safeguards")));
    return sheets;
}

Sheets constants_maps(const Subject& s, bool quiet) {
    Meter meter("atlas: " + s.stem("constants"), s.sample.constant_count, quiet);
    const auto ranges = constant_ranges(s.scenario(), s.model, s.library, s.sample.strain_scale, &meter);
    const auto unlimited = [](const ConstantRange& r) { return !r.lower.limited && !r.upper.limited; };
    if (std::all_of(ranges.begin(), ranges.end(), unlimited)) return {};
    return {constants_sheet(ranges, s.stem("constants"), s.title("how far each constant may be varied"))};
}

struct MapKind {
    const char* name;
    Sheets (*make)(const Subject&, bool quiet);
};
constexpr std::array<MapKind, 8> map_kinds{{{"error", error_maps},
                                            {"failures", failure_maps},
                                            {"time_step", time_step_maps},
                                            {"element_size", element_size_maps},
                                            {"ellipticity", ellipticity_maps},
                                            {"rotation", rotation_maps},
                                            {"limit_point", limit_point_maps},
                                            {"constants", constants_maps}}};

struct Target {
    const lode_model* model;
    const lode_sample* sample;
    const Scenario* deck;  // null for the library's own samples
};

// The material of a deck as a sample; its strain scale is the largest strain of the deck's path.
class DeckMaterial {
  public:
    DeckMaterial(Scenario scene, const Library& library) : scene_(std::move(scene)) {
        model_ = library.model_of(scene_.material.name);
        if (model_ == nullptr)
            throw Failure(Status::usage,
                          fmt::format("{}: the library has no model of that name", scene_.material.name));
        Scenario path = scene_;
        resolve(path, library);
        double strain = 0;
        drive(path, library, [&](const Record& r) { strain = std::max(strain, r.point.strain.cwiseAbs().maxCoeff()); });
        const std::vector<double>& constants = scene_.material.constants;
        sample_ = {scene_.stem.c_str(),
                   scene_.title.c_str(),
                   constants.data(),
                   static_cast<int>(constants.size()),
                   strain > 0 ? strain : model_->samples[0].strain_scale,
                   model_->kinds};
    }
    DeckMaterial(const DeckMaterial&) = delete;
    DeckMaterial& operator=(const DeckMaterial&) = delete;

    const lode_model& model() const { return *model_; }
    const lode_sample& sample() const { return sample_; }
    const Scenario& scene() const { return scene_; }

  private:
    Scenario scene_;
    const lode_model* model_ = nullptr;
    lode_sample sample_{};
};

}  // namespace

std::vector<std::string> atlas_maps() {
    std::vector<std::string> names;
    for (const MapKind& map : map_kinds) names.emplace_back(map.name);
    return names;
}

Status atlas(const AtlasOptions& options) {
    std::string request = options.library;
    std::vector<Scenario> decks = decks_among(options.targets, request);
    const Library library(request);
    std::vector<std::pair<const lode_model*, const lode_sample*>> samples;
    if (options.all) samples = all_samples(library);
    for (const auto& target : options.targets)
        if (!is_deck(target))
            for (const auto& sample : samples_named(library, target)) samples.push_back(sample);
    if (options.first) std::erase_if(samples, [](const auto& s) { return s.second != &s.first->samples[0]; });
    std::vector<Target> targets;
    for (const auto& [model, sample] : samples) targets.push_back({model, sample, nullptr});
    std::list<DeckMaterial> materials;
    for (Scenario& deck : decks) {
        const DeckMaterial& material = materials.emplace_back(std::move(deck), library);
        targets.push_back({&material.model(), &material.sample(), &material.scene()});
    }
    if (targets.empty()) throw Failure(Status::usage, "nothing to map: name decks or materials, or say --all");

    const std::string directory = output_directory(options.output_directory);
    Meter meter("atlas", static_cast<int>(targets.size() * map_kinds.size()), options.quiet);
    int sheets = 0;
    for (const auto& [model, sample, deck] : targets) {
        const std::vector<Kind> served = kinds_of(model->kinds & sample->kinds);
        const Kind usual = deck != nullptr ? deck->analysis.kind : served.front();
        std::vector<Kind> kinds;
        for (const Kind kind : served)
            if (options.kinds.empty()
                    ? kind == usual
                    : std::find(options.kinds.begin(), options.kinds.end(), name_of(kind)) != options.kinds.end())
                kinds.push_back(kind);
        for (const Kind kind : kinds)
            for (const MapKind& map : map_kinds) {
                const bool wanted = options.maps.empty() ||
                                    std::find(options.maps.begin(), options.maps.end(), map.name) != options.maps.end();
                const Subject subject{*model, *sample, kind, library, deck};
                meter.advance(subject.stem(map.name));
                if (!wanted) continue;
                const Muted muted;  // maps go where materials refuse
                try {
                    for (const Sheet& sheet : map.make(subject, options.quiet)) {
                        const std::string failure = write_sheet(sheet, directory);
                        if (!failure.empty()) fmt::print(stderr, "lode: {}\n", failure);
                        if (!options.quiet) fmt::print("{}", sheet.text);
                        ++sheets;
                    }
                } catch (const Refused& refusal) {
                    fmt::print(stderr, "lode: {}: {}\n", subject.stem(map.name), refusal.what());
                }
            }
    }
    if (!options.quiet) fmt::print("{} maps in {}\n", sheets, directory);
    return Status::success;
}

}  // namespace lode::host
