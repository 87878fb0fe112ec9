#include "error_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "../study/material_point.hpp"

namespace lode::host {
namespace {

constexpr int timed_calls = 100;
constexpr int coarse_increments = 256;  // doubled twice and extrapolated
constexpr double grid_step = 0.5, grid_end = 6;

// The stress after the increment in equal parts.
std::optional<Components> stress_after(MaterialPoint& point, const PointState& start, const Components& dstrain,
                                       int increments) {
    point.set_state(start);
    const bool done = point.advance_in(increments, dstrain);
    const Components stress = point.state().stress;
    point.set_state(start);
    return done ? std::optional(stress) : std::nullopt;
}

struct Target {
    Components stress;
    double estimate = 0;
};

// Errors of backward Euler and its like have an expansion in powers of the increment: Romberg's extrapolation.
std::optional<Target> target(MaterialPoint& point, const PointState& start, const Components& dstrain) {
    std::array<Components, 3> s;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto stress = stress_after(point, start, dstrain, coarse_increments << i);
        if (!stress) return std::nullopt;
        s[i] = *stress;
    }
    const Components once = 2 * s[1] - s[0], twice = 2 * s[2] - s[1];
    const Components best = (4 * twice - once) / 3;
    return Target{best, stress_norm(point.layout(), best - twice)};
}

Table table_of(const ErrorMap& map) {
    const bool observed = !map.cells.empty() && map.cells.front().observation.has_value();
    std::vector<std::string> columns{"x", "y", "error", "reference_error", "pnewdt", "ns"};
    if (observed) columns.insert(columns.end(), {"iterations", "safeguards", "substeps"});
    Table table(columns);
    for (const ErrorMapCell& c : map.cells) {
        std::vector<Cell> row{c.x, c.y, c.error, c.reference_error, c.pnewdt, c.nanoseconds};
        if (c.observation)
            row.insert(row.end(), {c.observation->iterations, c.observation->safeguards, c.observation->substeps});
        table.add(row);
    }
    return table;
}

// x, y and value as gnuplot wants a grid: a blank line between rows.
template <class Value>
std::string grid_of(const ErrorMap& map, const Value& value) {
    std::string rows = "$grid << EOD\n";
    double row = map.cells.empty() ? 0 : map.cells.front().y;
    for (const ErrorMapCell& c : map.cells) {
        if (c.y != row) rows += "\n";
        row = c.y;
        rows += fmt::format("{} {} {}\n", c.x, c.y, value(c));
    }
    return rows + "EOD\n";
}

constexpr const char* x_label = "increment along the stress (elastic limit strains)";
constexpr const char* y_label = "increment across it (elastic limit strains)";

}  // namespace

std::optional<ErrorMapAxes> usual_axes(const Scenario& scenario, const Library& library, double strain_scale) {
    const Layout layout(scenario.analysis.kind);
    Components along = Components::Zero(layout.size()), across = Components::Zero(layout.size());
    if (layout.cohesive()) {
        along[0] = 1;
        across[1] = 1;
    } else {
        if (layout.size() < 3) return std::nullopt;
        along[0] = 1;
        for (int i = 1; i < layout.ndi(); ++i) along[i] = -0.5;
        if (layout.ndi() == 2) along[1] = 0;
        across[layout.ndi()] = 1;
        along /= strain_norm(layout, along);
        across /= strain_norm(layout, across);
    }
    const auto limit = elastic_limit(scenario, library, along, 100 * strain_scale);
    if (!limit) return std::nullopt;
    ErrorMapAxes axes;
    axes.start = *limit * along;
    axes.along = axes.start;
    axes.across = *limit * across;
    const int steps = static_cast<int>(std::floor(grid_end / grid_step + 1e-9));
    for (int i = 0; i <= steps; ++i) axes.x.push_back(i * grid_step);
    axes.y = axes.x;
    return axes;
}

ErrorMap error_map(const Scenario& scenario, const Library& library, const ErrorMapAxes& axes,
                   const std::optional<Scenario>& exact, Meter* meter) {
    MaterialPoint point(scenario, library);
    MaterialPoint reference(exact.value_or(scenario), library);
    point.observe();
    const Components before = point.state().stress;
    ErrorMap map;
    if (!point.advance(axes.start) || !reference.advance(axes.start)) return map;
    const PointState start = point.state(), reference_start = reference.state();
    const double scale = axes.stress_scale > 0 ? axes.stress_scale : stress_norm(point.layout(), start.stress - before);
    double sum = 0;
    int done = 0;
    for (const double y : axes.y)
        for (const double x : axes.x) {
            if (meter != nullptr) meter->advance(fmt::format("x = {}, y = {}", x, y));
            ErrorMapCell cell;
            cell.x = x;
            cell.y = y;
            cell.error = std::numeric_limits<double>::quiet_NaN();
            const Components dstrain = x * axes.along + y * axes.across;
            point.set_state(start);
            const Response response = point.respond(dstrain);
            cell.pnewdt = response.pnewdt;
            cell.observation = response.observation;
            if (cell.observation)
                for (const auto what :
                     {&lode_observation::iterations, &lode_observation::safeguards, &lode_observation::substeps})
                    map.most.*what = std::max(map.most.*what, *cell.observation.*what);
            cell.nanoseconds = point.nanoseconds(dstrain, timed_calls);
            const bool answered = !response.cut_wanted() && response.finite();
            if (!answered) ++map.cut_backs;
            std::optional<Target> wanted;
            if (exact) {
                if (const auto stress = stress_after(reference, reference_start, dstrain, 1))
                    wanted = Target{*stress, 0};
            } else {
                wanted = target(reference, reference_start, dstrain);
            }
            if (answered && wanted) {
                const double norm = axes.relative_to_end ? stress_norm(point.layout(), wanted->stress) : scale;
                cell.error = stress_norm(point.layout(), response.stress - wanted->stress) / norm;
                cell.reference_error = wanted->estimate / norm;
                map.largest = std::max(map.largest, cell.error);
                sum += cell.error;
                ++done;
            }
            map.cells.push_back(cell);
        }
    if (done > 0) map.mean = sum / done;
    return map;
}

Sheet error_sheet(const ErrorMap& map, const std::string& stem, const std::string& title) {
    Sheet sheet{stem, "", table_of(map), "", ""};
    double worst_estimate = 0, slowest = 0, fastest = HUGE_VAL;
    for (const ErrorMapCell& c : map.cells) {
        worst_estimate = std::max(worst_estimate, c.reference_error);
        slowest = std::max(slowest, c.nanoseconds);
        fastest = std::min(fastest, c.nanoseconds);
    }
    sheet.text = fmt::format(
        "{}\n  error of one increment: largest {:.3g} %, mean {:.3g} % (reference good to {:.1e}); cut-backs asked for "
        "in "
        "{} of {} cells; {:.0f}..{:.0f} ns a call\n",
        title, 100 * map.largest, 100 * map.mean, worst_estimate, map.cut_backs, map.cells.size(), fastest, slowest);
    if (map.most.iterations > 0 || map.most.substeps > 0)
        sheet.text += fmt::format("  at most {} iterations, {} of them steps of a safeguard, {} substeps\n",
                                  map.most.iterations, map.most.safeguards, map.most.substeps);
    sheet.setup = figure_setup(title, x_label, y_label) +
                  grid_of(map, [](const ErrorMapCell& c) { return 100 * c.error; }) + R"(set table $contours
set contour base
unset surface
set cntrparam levels auto 12
splot $grid using 1:2:3 with lines
unset table
unset contour
set surface
set palette defined (0 '#f7fbff', 0.25 '#c6dbef', 0.5 '#6baed6', 0.75 '#2171b5', 1 '#08306b')
set cblabel 'error (% of the stress at the limit)'
set size ratio -1
set key off
set autoscale fix
)";
    sheet.plot =
        "plot $grid using 1:2:3 with image pixels, $contours using 1:2 with lines lw 1 lc rgb '#303030', "
        "$contours using 1:2:(sprintf('%.3g', $3)) every 14::6 with labels font ',8' textcolor rgb '#202020'";
    return sheet;
}

Sheet solution_sheet(const ErrorMap& map, int lode_observation::*what, const char* label, const std::string& stem,
                     const std::string& title) {
    Sheet sheet{stem, "", table_of(map), "", ""};
    sheet.setup =
        figure_setup(title, x_label, y_label) +
        grid_of(map, [what](const ErrorMapCell& c) { return c.observation.value_or(lode_observation{}).*what; }) +
        fmt::format(R"(set palette defined (0 '#ffffff', 0.25 '#fee8c8', 0.6 '#fdbb84', 1 '#e34a33')
set cbrange [0:{}]
set cblabel '{}'
set size ratio -1
set key off
set autoscale fix
)",
                    std::max(map.most.*what, 1), label);
    sheet.plot =
        "plot $grid using 1:2:3 with image pixels, "
        "$grid using 1:2:(sprintf('%d', $3)) with labels font ',8' textcolor rgb '#202020'";
    return sheet;
}

}  // namespace lode::host
