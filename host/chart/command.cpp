#include "command.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <optional>

#include "../cards.hpp"
#include "../replay/deck.hpp"
#include "../study/paths.hpp"
#include "../study/table.hpp"
#include "../text.hpp"
#include "chart.hpp"
#include "output.hpp"

namespace lode::host {
namespace {

Kind kind_named(const std::string& name) {
    std::vector<std::string_view> names;
    for (const KindName& entry : kind_names) {
        if (entry.name == name) return entry.kind;
        names.push_back(entry.name);
    }
    throw Failure(Status::usage, fmt::format("there is no kind \"{}\"{}; there are {}", name, did_you_mean(name, names),
                                             joined(names)));
}

std::vector<Kind> kinds_named(const std::vector<std::string>& names) {
    std::vector<Kind> kinds;
    for (const auto& name : names) kinds.push_back(kind_named(name));
    return kinds;
}

void add_sample(std::vector<Scenario>& scenes, const lode_model& model, const lode_sample& sample,
                const ChartOptions& options) {
    if (options.first && &sample != &model.samples[0]) return;
    const std::vector<Kind> served = kinds_of(model.kinds & sample.kinds);
    std::vector<Kind> kinds = kinds_named(options.kinds);
    if (kinds.empty() && !served.empty()) kinds = {served.front()};
    for (const Kind kind : kinds) {
        if (std::find(served.begin(), served.end(), kind) == served.end()) continue;
        if (!options.path.empty()) scenes.push_back(built_in_path(model, sample, kind, options.path));
        else
            for (Scenario& scene : built_in_paths(model, sample, kind)) scenes.push_back(std::move(scene));
    }
}

}  // namespace

Status chart(const ChartOptions& options) {
    std::string request = options.library;
    std::vector<Scenario> scenes = decks_among(options.targets, request);
    const Libraries libraries(request, options.single_library);
    const std::size_t decks = scenes.size();
    for (const auto& target : options.targets)
        if (!is_deck(target))
            for (const auto& [model, sample] : samples_named(libraries.main(), target))
                add_sample(scenes, *model, *sample, options);
    if (options.all)
        for (const auto& [model, sample] : all_samples(libraries.main())) add_sample(scenes, *model, *sample, options);
    if (scenes.empty()) throw Failure(Status::usage, "nothing to chart: name decks or materials, or say --all");

    ChartSettings settings;
    settings.cost = !options.no_cost;
    if (!options.increments.empty()) settings.increments = options.increments;
    if (!options.kinds.empty()) settings.kinds = kinds_named(options.kinds);
    const auto settings_of = [&](std::size_t i) {
        ChartSettings own = settings;
        // A built-in path is charted in the kind that it was made for.
        if (i >= decks) own.kinds = {scenes[i].analysis.kind};
        return own;
    };
    int runs = 0;
    for (std::size_t i = 0; i < scenes.size(); ++i) runs += chart_runs(scenes[i], libraries, settings_of(i));

    const std::filesystem::path directory = output_directory(options.output_directory);
    Meter meter("chart", runs, options.quiet);
    Status status = Status::success;
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        const std::string stem = (directory / (scenes[i].stem + "_chart")).lexically_normal().string();
        try {
            const Chart result = make_chart(scenes[i], libraries, settings_of(i), &meter);
            write_csv(result, stem + ".csv");
            const std::string failure = settings.cost ? draw(result, stem) : std::string();
            if (!failure.empty()) fmt::print(stderr, "lode: {}\n", failure);
            if (!options.quiet) fmt::print("{}\n", text(result));
        } catch (const Refused& refusal) {
            fmt::print(stderr, "lode: {}: {}\n", scenes[i].stem, refusal.what());
            status = Status::refused;
        }
    }
    if (!options.quiet) fmt::print("files: *_chart.csv, .png, .svg, .gp in {}\n", directory.string());
    return status;
}

}  // namespace lode::host
