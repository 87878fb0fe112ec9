#include "element_size.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "../guard.hpp"
#include "../plot/gnuplot.hpp"
#include "../replay/driver.hpp"

namespace lode::host {
namespace {

constexpr double smallest = 1e-9, largest_tried = 1e9;
constexpr int pull_increments = 1000;
constexpr std::size_t plotted_every = 4;
constexpr double softened = 0.2;  // of the strength

Scenario pulled(const Scenario& scenario, double length, double strain, int count) {
    Scenario scene = scenario;
    scene.analysis.element_length = length;
    scene.analysis.large_rotation = false;
    scene.analysis.unnamed = Control::stress;
    Step step;
    step.components[0] = Prescribed{Control::strain, strain};
    step.increments = FixedIncrements{count};
    scene.steps = {step};
    return scene;
}

}  // namespace

bool accepts_element(const Scenario& scenario, const Library& library, double length, std::string* message) {
    try {
        // A strain that no material leaves its elastic range at: the size is checked before anything else.
        Scenario scene = pulled(scenario, length, 1e-12, 1);
        resolve(scene, library);
        const Outcome outcome = drive(scene, library, [](const Record&) {});
        if (message != nullptr && outcome.status != Status::success) *message = outcome.message;
        return outcome.status == Status::success;
    } catch (const Refused& refusal) {
        if (message != nullptr) *message = refusal.what();
        return false;
    }
}

std::optional<LargestElement> largest_element(const Scenario& scenario, const Library& library) {
    const Muted muted;
    if (!accepts_element(scenario, library, smallest) || accepts_element(scenario, library, largest_tried))
        return std::nullopt;
    LargestElement result;
    double good = smallest, bad = largest_tried;
    while (bad > good * (1 + 1e-12)) {
        const double middle = std::sqrt(good * bad);
        if (middle <= good || middle >= bad) break;
        (accepts_element(scenario, library, middle, &result.message) ? good : bad) = middle;
    }
    result.length = good;
    return result;
}

std::vector<Dissipation> dissipation_over_size(const Scenario& scenario, const Library& library, double strain_scale,
                                               double largest_length, const std::vector<double>& fractions) {
    // How far to pull.
    const double half = 0.5 * largest_length;
    double displacement = 0;
    for (double strain = strain_scale; strain < 1e4 * strain_scale && displacement == 0; strain *= 4) {
        Scenario scene = pulled(scenario, half, strain, pull_increments);
        resolve(scene, library);
        double strength = 0;
        drive(scene, library, [&](const Record& r) {
            strength = std::max(strength, r.point.stress[0]);
            if (displacement == 0 && strength > 0 && r.point.stress[0] < softened * strength)
                displacement = r.point.strain[0] * half;
        });
    }
    std::vector<Dissipation> runs;
    if (displacement == 0) return runs;
    for (const double fraction : fractions) {
        Dissipation run;
        run.length = fraction * largest_length;
        Scenario scene = pulled(scenario, run.length, displacement / run.length, pull_increments);
        resolve(scene, library);
        const Outcome outcome = drive(scene, library, [&](const Record& r) {
            run.curve.emplace_back(r.point.strain[0] * run.length, r.point.stress[0]);
            run.energy = (r.point.work - r.point.energies.elastic) * run.length;
        });
        run.complete = outcome.status == Status::success;
        runs.push_back(std::move(run));
    }
    return runs;
}

Sheet element_size_sheet(const std::optional<LargestElement>& largest, const std::vector<Dissipation>& runs,
                         const std::string& stem, const std::string& title) {
    Sheet sheet{stem, title + "\n", Table({"length", "dissipation_per_area", "complete"}), "", ""};
    if (largest)
        sheet.text += fmt::format("  largest element {:.9g}; above it: {}\n", largest->length, largest->message);
    double least = HUGE_VAL, most = 0;
    std::string data;
    sheet.plot = "plot";
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const Dissipation& run = runs[i];
        sheet.table.add({run.length, run.energy, run.complete ? 1 : 0});
        if (!run.complete) continue;
        least = std::min(least, run.energy);
        most = std::max(most, run.energy);
        data += fmt::format("$l{} << EOD\n", i);
        for (std::size_t k = 0; k < run.curve.size(); k += plotted_every)
            data += fmt::format("{:.5g} {:.5g}\n", run.curve[k].first, run.curve[k].second);
        data += "EOD\n";
        sheet.plot += fmt::format("{} $l{} using 1:2 with lines lw 1.6 lc rgb '{}' title '{:.4g}: dissipates {:.4g}'",
                                  sheet.plot == "plot" ? "" : ",", i, curve_colour(i), run.length, run.energy);
    }
    if (most > 0)
        sheet.text += fmt::format("  dissipation per area {:.6g} .. {:.6g} for elements of {:.4g} .. {:.4g}\n", least,
                                  most, runs.back().length, runs.front().length);
    if (sheet.plot == "plot") return sheet;
    sheet.setup = figure_setup(title, "displacement of the element", "stress 11") + data +
                  "set key outside right top Left reverse title 'element length'\n";
    return sheet;
}

}  // namespace lode::host
