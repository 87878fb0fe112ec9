#include "command.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "../replay/deck.hpp"
#include "advise.hpp"
#include "report.hpp"

namespace lode::host {
namespace {

constexpr int usual_settings = 30;  // ways to run a scene, for the progress line

}  // namespace

Status advise(const AdviseOptions& options) {
    const Scenario scenario = read_deck(options.deck);
    const Libraries libraries(options.library.empty() ? scenario.material.library : options.library,
                              options.single_library);
    AdviseSettings settings;
    settings.tolerance = options.tolerance;
    Advice advice;
    {
        Meter meter("advise", usual_settings, options.quiet);
        advice = advise(scenario, libraries, settings, &meter);
    }
    if (!options.output_directory.empty()) {
        const std::filesystem::path directory = output_directory(options.output_directory);
        evidence(advice).write((directory / (scenario.stem + "_advice.csv")).string());
    }
    if (!options.quiet) fmt::print("{}", text(advice));
    if (advice.best) {
        fmt::print("{}", cards(*advice.best, libraries.main()));
        return Status::success;
    }
    if (options.quiet) fmt::print(stderr, "lode: nothing that was run meets the tolerance; {}\n", advice.verdict);
    return Status::not_converged;
}

}  // namespace lode::host
