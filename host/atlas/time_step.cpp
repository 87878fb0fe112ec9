#include "time_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lode::host {
namespace {

constexpr double relative_amplitude = 1e-6;  // of the strain scale
constexpr double growth = 1000;              // an amplitude that has grown so much has no bound
constexpr int oscillations = 2000;
constexpr double resolution = 1e-5, first_bracket = 1e-4;
constexpr int rate_corrections = 2;
constexpr double rate_dependence = 1e-5;

// Strain of a unit acceleration: two masses density * length / 2, a unit area, apart by u: u'' = -4 stress / (density
// length) with the strain u / length, or the separation u.
double inertia(const Layout& layout, double density, double length) {
    return density * length * (layout.cohesive() ? 1 : length);
}

double limit_by_bisection(MaterialPoint& point, int component, double density, double length, double amplitude,
                          double guess) {
    const auto stable = [&](double step) {
        return oscillator_is_stable(point, component, density, length, amplitude, step, oscillations);
    };
    // Most limits are where the stiffness says: the bracket grows from there.
    double good = guess, bad = guess, width = first_bracket;
    const auto wider = [&] { return width = std::min(4 * width, 0.5); };
    if (stable(guess)) {
        for (bad *= 1 + width; stable(bad); bad *= 1 + wider()) {
            good = bad;
            if (bad > 1e6 * guess) return HUGE_VAL;
        }
    } else {
        for (good *= 1 - width; !stable(good); good *= 1 - wider()) {
            bad = good;
            if (good < 1e-6 * guess) return 0;
        }
    }
    while (bad - good > resolution * good) {
        const double middle = 0.5 * (good + bad);
        (stable(middle) ? good : bad) = middle;
    }
    return good;
}

// Slopes of the stress over the strain of a component, for a small strain either way.
struct Slopes {
    double stiffer = 0, softer = 0;
};
Slopes slopes(const Scenario& scenario, const Library& library, int component, double strain_scale, double dtime) {
    MaterialPoint point(scenario, library);
    const double width = relative_amplitude * strain_scale;
    const auto stress = [&](double strain) {
        return point.respond(unit_strain(point.layout(), component, strain), dtime).stress[component];
    };
    const double still = stress(0), up = (stress(width) - still) / width, down = (still - stress(-width)) / width;
    return {std::max(up, down), std::min(up, down)};
}

}  // namespace

bool oscillator_is_stable(MaterialPoint& point, int component, double density, double length, double amplitude,
                          double time_step, int steps) {
    const PointState start = point.state();
    const Layout& layout = point.layout();
    const double still = point.respond(Components::Zero(layout.size()), time_step).stress[component];
    if (!point.advance(unit_strain(layout, component, amplitude), time_step)) return false;
    const double mass = inertia(layout, density, length);
    double strain = amplitude, rate = 0;
    bool bounded = true;
    for (int i = 0; i < steps && bounded; ++i) {
        const double stress = point.state().stress[component] - still;
        rate -= time_step * 4 * stress / mass;
        const double change = time_step * rate;
        strain += change;
        bounded =
            std::abs(strain) < growth * amplitude && point.advance(unit_strain(layout, component, change), time_step);
    }
    point.set_state(start);
    return bounded;
}

std::vector<TimeStepLimit> time_step_limits(const Scenario& scenario, const Library& library, double strain_scale) {
    std::vector<TimeStepLimit> limits;
    Scenario scene = scenario;
    scene.analysis.entry = Entry::vumat;
    const double density = scene.material.density, length = scene.analysis.element_length;
    MaterialPoint point(scene, library);
    const Layout& layout = point.layout();
    for (int i = 0; i < layout.size(); ++i) {
        TimeStepLimit limit;
        limit.component = layout.name(i);

        Slopes slope = slopes(scene, library, i, strain_scale, 1);
        if (!(slope.stiffer > 0)) continue;
        const double mass = inertia(layout, density, length);
        // With viscosity the stiffness depends on the step.
        for (int k = 0; k < rate_corrections; ++k)
            slope = slopes(scene, library, i, strain_scale, std::sqrt(mass / slope.stiffer));
        limit.estimate = std::sqrt(mass / slope.stiffer);
        const double slower = slopes(scene, library, i, strain_scale, 0.5 * limit.estimate).stiffer;
        limit.rate_dependent = std::abs(slower / slope.stiffer - 1) > rate_dependence;
        limit.softer = slope.softer > 0 ? std::sqrt(mass / slope.softer) : HUGE_VAL;
        limit.found = limit_by_bisection(point, i, density, length, relative_amplitude * strain_scale, limit.estimate);
        limits.push_back(limit);
    }
    return limits;
}

std::vector<TimeStepLimit> time_step_along(const Scenario& scenario, const Library& library, double strain_scale,
                                           int points) {
    std::vector<TimeStepLimit> limits;
    Scenario scene = scenario;
    scene.analysis.entry = Entry::vumat;
    const double stiffness = slopes(scene, library, 0, strain_scale, 1).stiffer;
    for (int i = -points; i <= points && stiffness > 0; ++i) {
        MaterialPoint point(scene, library);
        TimeStepLimit limit;
        limit.component = point.layout().name(0);
        limit.prestrain = strain_scale * i / points;
        limit.estimate =
            std::sqrt(inertia(point.layout(), scene.material.density, scene.analysis.element_length) / stiffness);
        if (i != 0 && !point.advance_in(20, unit_strain(point.layout(), 0, limit.prestrain))) continue;
        limit.found = limit_by_bisection(point, 0, scene.material.density, scene.analysis.element_length,
                                         relative_amplitude * strain_scale, limit.estimate);
        limits.push_back(limit);
    }
    return limits;
}

Sheet time_step_sheet(const std::vector<TimeStepLimit>& limits, const std::vector<TimeStepLimit>& along,
                      const std::string& stem, const std::string& title) {
    Sheet sheet{stem, title + "\n", Table({"component", "prestrain", "found", "estimate", "found_over_estimate"}), "",
                ""};
    std::vector<std::vector<std::string>> rows{{"component", "largest stable step", "length / wave speed", "ratio"}};
    std::string bars = "$bars << EOD\n", line = "$line << EOD\n";
    for (const TimeStepLimit& l : limits) {
        sheet.table.add({l.component, l.prestrain, l.found, l.estimate, l.found / l.estimate});
        rows.push_back({l.component, fmt::format("{:.6g}", l.found), fmt::format("{:.6g}", l.estimate),
                        fmt::format("{:.5f}", l.found / l.estimate)});
        bars += fmt::format("\"{}\" {}\n", l.component, l.found / l.estimate);
    }
    double worst = HUGE_VAL;
    for (const TimeStepLimit& l : along) {
        sheet.table.add({l.component, l.prestrain, l.found, l.estimate, l.found / l.estimate});
        line += fmt::format("{} {}\n", l.prestrain, l.found / l.estimate);
        worst = std::min(worst, l.found / l.estimate);
    }
    sheet.text += aligned(rows, "  ");
    if (!along.empty())
        sheet.text += fmt::format("  strained by {:.3g} to {:.3g}: down to {:.3f} of the step of the virgin state\n",
                                  along.front().prestrain, along.back().prestrain, worst);
    const bool path = !along.empty();
    sheet.setup = figure_setup(title, path ? "strain 11" : "component", "largest stable step / (length / wave speed)") +
                  bars + "EOD\n" + line + "EOD\nset yrange [0:*]\nset key off\n";
    sheet.plot =
        path ? "plot $line using 1:2 with linespoints lw 1.6 pt 7 lc rgb '#1f5fa8', 1 with lines dt 2 lc rgb '#808080'"
             : "plot $bars using 0:2:xtic(1) with points pt 7 ps 1.6 lc rgb '#1f5fa8', 1 with lines dt 2 lc rgb "
               "'#808080'";
    return sheet;
}

}  // namespace lode::host
