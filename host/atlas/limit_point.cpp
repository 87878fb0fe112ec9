#include "limit_point.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "../replay/driver.hpp"

namespace lode::host {
namespace {

constexpr double farthest = 20;  // strain scales
constexpr int increments = 4000;
constexpr int loading_increments = 50;
constexpr std::size_t plotted_every = 10;

Scenario driven(const Scenario& scenario, Control control, double value, int count) {
    Scenario scene = scenario;
    scene.analysis.entry = Entry::umat;
    const bool cohesive = is_cohesive(scenario.analysis.kind);
    scene.analysis.unnamed = cohesive ? Control::strain : Control::stress;
    Step step;
    step.components[0] = Prescribed{control, value};
    step.increments = FixedIncrements{count};
    scene.steps = {step};
    return scene;
}

struct Peak {
    double strain = 0, stress = 0, before = 0, after = 0;
    bool inside = false;
};

Peak peak_of(const Scenario& scenario, const Library& library, double strain,
             std::vector<std::pair<double, double>>* curve) {
    Scenario scene = driven(scenario, Control::strain, strain, increments);
    resolve(scene, library);
    Peak peak;
    double last = 0, end_stress = 0;
    bool next = false;
    drive(scene, library, [&](const Record& r) {
        const double e = r.point.strain[0], s = r.point.stress[0];
        if (curve != nullptr) curve->emplace_back(e, s);
        if (next) peak.after = e;
        next = s > peak.stress;
        if (next) {
            peak = {e, s, last, e, false};
        }
        last = e;
        end_stress = s;
    });
    peak.inside = end_stress < (1 - 1e-3) * peak.stress;
    return peak;
}

}  // namespace

bool reaches(const Scenario& scenario, const Library& library, double stress, std::string* message) {
    Scenario scene = driven(scenario, Control::stress, stress, loading_increments);
    resolve(scene, library);
    const Outcome outcome = drive(scene, library, [](const Record&) {});
    if (message != nullptr && outcome.status != Status::success) *message = outcome.message;
    return outcome.status == Status::success;
}

std::optional<LimitPoint> limit_point(const Scenario& scenario, const Library& library, double strain_scale) {
    LimitPoint limit;
    const Peak coarse = peak_of(scenario, library, farthest * strain_scale, &limit.curve);
    if (!coarse.inside || !(coarse.stress > 0)) return std::nullopt;
    // Once more with increments that are small where the peak is.
    const Peak fine = peak_of(scenario, library, 1.5 * coarse.strain, nullptr);
    limit.strain = fine.stress > coarse.stress ? fine.strain : coarse.strain;
    limit.stress = std::max(fine.stress, coarse.stress);
    double good = 0.5 * limit.stress, bad = 1.5 * limit.stress;
    if (!reaches(scenario, library, good) || reaches(scenario, library, bad)) return limit;
    while (bad - good > 1e-6 * limit.stress) {
        const double middle = 0.5 * (good + bad);
        (reaches(scenario, library, middle, &limit.message) ? good : bad) = middle;
    }
    limit.reached = good;
    return limit;
}

Sheet limit_point_sheet(const LimitPoint& limit, const std::string& stem, const std::string& title) {
    Sheet sheet{stem, "", Table({"strain", "stress"}), "", ""};
    std::string data = "$curve << EOD\n";
    for (std::size_t i = 0; i < limit.curve.size(); ++i) {
        const auto& [e, s] = limit.curve[i];
        sheet.table.add({e, s});
        if (i % plotted_every == 0) data += fmt::format("{:.6g} {:.6g}\n", e, s);
    }
    sheet.text = fmt::format("{}\n  peak {:.8g} at strain {:.6g}; stress control reaches {:.8g} and then ends: {}\n",
                             title, limit.stress, limit.strain, limit.reached, limit.message);
    sheet.setup = figure_setup(title, "strain (separation) driven", "stress (traction)") + data +
                  "EOD\nset key top right Left reverse\n";
    sheet.plot = fmt::format(
        "plot $curve using 1:2 with lines lw 1.6 lc rgb '#1f5fa8' title 'strain control', {} with lines dt 2 lw 1.4 lc "
        "rgb "
        "'#c8501e' title 'largest stress that stress control reaches'",
        limit.reached);
    return sheet;
}

}  // namespace lode::host
