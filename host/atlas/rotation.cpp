#include "rotation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "../plot/gnuplot.hpp"
#include "../replay/driver.hpp"
#include "../study/material_point.hpp"
#include "../study/order.hpp"

namespace lode::host {
namespace {

constexpr int finest = 4096;

Step to_gradient(const Matrix3& F, int increments) {
    Step step;
    step.deformation_gradient = F;
    step.increments = FixedIncrements{increments};
    return step;
}

// The stress at the end of each step, none if the run fails, and the largest on the way in the norm of the tensor:
// what softens has none left at the end.
struct Stresses {
    std::vector<Components> ends;
    double largest = 0;
};
Stresses stresses(Scenario scenario, const Library& library) {
    scenario.analysis.large_rotation = true;
    resolve(scenario, library);
    const Layout layout(scenario.analysis.kind);
    Stresses result;
    std::vector<Components>& ends = result.ends;
    std::size_t step = 0;
    const Outcome outcome = drive(scenario, library, [&](const Record& r) {
        const auto number = static_cast<std::size_t>(r.step);
        if (number == 0) return;
        result.largest = std::max(result.largest, stress_norm(layout, r.point.stress));
        if (number > step) {
            ends.push_back(r.point.stress);
            step = number;
        } else {
            ends.back() = r.point.stress;
        }
    });
    if (outcome.status != Status::success) ends.clear();
    return result;
}

Matrix3 gradient(double stretch, double shear) {
    Matrix3 F = Matrix3::Identity();
    F(0, 0) += stretch;
    F(0, 1) += shear;
    return F;
}

Stresses cycle(Scenario scene, const Library& library, double a, int increments) {
    // Shear of the stretched body, stretch taken back, shear taken back: F = (1 + shear) (1 + stretch).
    const Matrix3 stretched = gradient(a, 0), sheared = gradient(0, a);
    scene.steps = {to_gradient(stretched, increments), to_gradient(sheared * stretched, increments),
                   to_gradient(sheared, increments), to_gradient(Matrix3::Identity(), increments)};
    return stresses(scene, library);
}

}  // namespace

double turn_error(const Scenario& scenario, const Library& library, double strain, int increments) {
    Scenario scene = scenario;
    scene.steps = {to_gradient(gradient(strain, 0), 10)};
    Step turn;
    turn.rotation = Rotation{Eigen::Vector3d::UnitZ(), 2 * std::numbers::pi};
    turn.increments = FixedIncrements{increments};
    scene.steps.push_back(turn);
    const auto [ends, largest] = stresses(scene, library);
    if (ends.size() < 2) return std::nan("");
    return stress_norm(Layout(scenario.analysis.kind), ends[1] - ends[0]) / largest;
}

Components sheared_stress(const Scenario& scenario, const Library& library, double gamma, int increments) {
    Scenario scene = scenario;
    scene.steps = {to_gradient(gradient(0, gamma), increments)};
    const auto ends = stresses(scene, library).ends;
    const Layout layout(scenario.analysis.kind);
    return ends.empty() ? Components::Constant(layout.size(), std::nan("")) : ends.back();
}

Components cycled_stress(const Scenario& scenario, const Library& library, double a, int increments) {
    const auto ends = cycle(scenario, library, a, increments).ends;
    return ends.size() < 4 ? Components::Constant(Layout(scenario.analysis.kind).size(), std::nan("")) : ends.back();
}

std::vector<RotationError> rotation_errors(const Scenario& scenario, const Library& library, double strain_scale) {
    std::vector<RotationError> errors;
    const Layout layout(scenario.analysis.kind);
    for (const Entry entry : {Entry::umat, Entry::vumat}) {
        if (entry == Entry::umat ? library.umat() == nullptr : library.vumat() == nullptr) continue;
        Scenario scene = scenario;
        scene.analysis.entry = entry;
        const std::string interface = entry == Entry::umat ? "UMAT" : "VUMAT";
        const Components target = sheared_stress(scene, library, 2 * strain_scale, finest);
        Scenario once = scene;
        once.steps = {to_gradient(gradient(0, 2 * strain_scale), 64)};
        const double shear = stresses(once, library).largest;
        for (int n = 4; n <= 1024; n *= 4) {
            errors.push_back({"turn", interface, n, turn_error(scene, library, 0.1 * strain_scale, n)});
            errors.push_back(
                {"shear", interface, n,
                 stress_norm(layout, sheared_stress(scene, library, 2 * strain_scale, n) - target) / shear});
            const auto [ends, largest] = cycle(scene, library, strain_scale, n);
            errors.push_back(
                {"cycle", interface, n, ends.size() < 4 ? std::nan("") : stress_norm(layout, ends.back()) / largest});
        }
    }
    return errors;
}

Sheet rotation_sheet(const std::vector<RotationError>& errors, const std::string& stem, const std::string& title) {
    Sheet sheet{stem, title + "\n", Table({"motion", "interface", "increments", "error"}), "", "plot"};
    std::map<std::string, std::vector<ErrorAt>> curves;
    for (const RotationError& e : errors) {
        sheet.table.add({e.motion, e.interface, e.increments, e.error});
        curves[e.motion + ", " + e.interface].push_back({e.increments, e.error});
    }
    const std::map<std::string, std::string> meanings{{"turn", "drift in one rigid turn"},
                                                      {"shear", "error in simple shear"},
                                                      {"cycle", "stress left by a closed cycle"}};
    std::string data;
    std::size_t index = 0;
    for (const auto& [name, points] : curves) {
        data += fmt::format("$c{} << EOD\n", index);
        for (const ErrorAt& p : points) data += fmt::format("{} {}\n", p.increments, std::max(p.error, 1e-17));
        data += "EOD\n";
        const std::string motion = name.substr(0, name.find(',')), interface = name.substr(name.find(',') + 2);
        const auto order = fitted_order(points, 1e-13);
        sheet.text += fmt::format("  {} ({}): {:.2e} in {} increments, {:.2e} in {}{}\n", meanings.at(motion),
                                  interface, points.front().error, points.front().increments, points.back().error,
                                  points.back().increments, order ? fmt::format(", order {:.2f}", *order) : "");
        sheet.plot += fmt::format("{} $c{} using 1:2 with linespoints lw 1.5 pt {} lc rgb '{}' title {}",
                                  sheet.plot == "plot" ? "" : ",", index, interface == "UMAT" ? 7 : 9,
                                  curve_colour(index / 2), single_quoted(meanings.at(motion) + ", " + interface));
        ++index;
    }
    sheet.setup = figure_setup(title, "increments", "relative error of the stress") + data +
                  "set logscale xy\nset format y '10^{%L}'\nset key outside right top Left reverse noenhanced\n";
    return sheet;
}

}  // namespace lode::host
