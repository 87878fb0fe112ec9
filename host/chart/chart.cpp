#include "chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "../guard.hpp"
#include "../status.hpp"
#include "../study/candidates.hpp"
#include "../study/order.hpp"
#include "../study/variants.hpp"

namespace lode::host {
namespace {

constexpr double rounding = 1e-13;        // errors below are not worth an order
constexpr double single_rounding = 2e-5;  // many increments in single precision
constexpr double many_roundings = 1e-9;
constexpr double clearly_better = 0.95;

std::vector<Kind> kinds_for(const Scenario& scenario, const ChartSettings& settings) {
    std::vector<Kind> kinds;
    for (const Kind kind : possible_kinds(scenario))
        if (!settings.kinds || std::find(settings.kinds->begin(), settings.kinds->end(), kind) != settings.kinds->end())
            kinds.push_back(kind);
    return kinds;
}

std::vector<Interface> charted_interfaces(const Libraries& libraries, const ChartSettings& settings) {
    std::vector<Interface> all = interfaces(libraries);
    if (!settings.vumat) std::erase_if(all, [](const Interface& interface) { return interface.entry == Entry::vumat; });
    return all;
}

ChartPoint run_point(const Scenario& scenario, const Interface& interface, const Libraries& libraries, int increments,
                     const Reference& reference, const ChartSettings& settings) {
    ChartPoint point;
    point.increments = increments;
    const auto run = scene_for(scenario, interface, libraries, increments, reference);
    if (!run) {
        point.trace.outcome.status = Status::not_converged;
        point.trace.outcome.message = "the strains of the reference are not known at all times";
        return point;
    }
    point.trace = follow(*run, *interface.library);
    if (!point.usable()) return point;
    const Difference error = reference.error_of(point.trace);
    point.error = error.worst();
    point.dissipation = error.dissipation;
    if (settings.cost) point.cost = measure(*run, *interface.library, settings.repetitions);
    return point;
}

void fit(Series& series) {
    std::vector<ErrorAt> errors;
    for (const ChartPoint& p : series.points)
        if (p.usable()) errors.push_back({p.increments, p.error});
    const double own_rounding = series.precision == Precision::single ? single_rounding : rounding;
    series.order = fitted_order(errors, std::max(series.floor, own_rounding));
    for (std::size_t i = 0, k = 0; i < series.points.size(); ++i)
        if (series.points[i].usable()) errors[k++].error = series.points[i].dissipation;
    series.dissipation_order = fitted_order(errors, std::max(series.floor, own_rounding));
}

void mark_front(Chart& chart) {
    std::vector<ChartPoint*> points;
    for (Series& s : chart.series)
        for (ChartPoint& p : s.points)
            if (p.usable() && !s.own_law) points.push_back(&p);
    std::stable_sort(points.begin(), points.end(),
                     [](const ChartPoint* a, const ChartPoint* b) { return a->cost.median < b->cost.median; });
    // Errors below what the reference can tell are equal.
    const double least = std::max(chart.reference.estimate, 1e-16);
    double best = HUGE_VAL;
    for (ChartPoint* p : points) {
        const double error = std::max(p->error, least);
        p->best = error < clearly_better * best;
        if (p->best) best = error;
    }
}

}  // namespace

double Series::largest_error() const {
    double largest = 0;
    for (const ChartPoint& p : points)
        if (p.usable()) largest = std::max(largest, p.error);
    return largest;
}

std::string Series::interface_name() const { return Interface{entry, precision, nullptr}.name(); }

int chart_runs(const Scenario& scenario, const Libraries& libraries, const ChartSettings& settings) {
    return static_cast<int>(algorithms_of(scenario, libraries.main()).size() * kinds_for(scenario, settings).size() *
                            charted_interfaces(libraries, settings).size() * settings.increments.size());
}

Chart make_chart(const Scenario& scenario, const Libraries& libraries, const ChartSettings& settings, Meter* meter) {
    const Muted muted;  // kinds and algorithms that the library refuses are among those tried
    Chart chart;
    chart.title = scenario.title.empty() ? scenario.material.name : scenario.title;
    chart.stem = scenario.stem;
    Scenario scene = scenario;
    scene.analysis.entry = libraries.main().umat() != nullptr ? Entry::umat : Entry::vumat;

    const std::vector<Candidate> candidates = candidates_for(scene, libraries.main(), settings.increments);
    const Candidate& reference = most_accurate(candidates);
    chart.reference = reference.reference;
    chart.reference_algorithm = reference.name();

    for (const Candidate& candidate : candidates)
        for (const Kind kind : kinds_for(scene, settings))
            for (const Interface& interface : charted_interfaces(libraries, settings)) {
                Series series;
                series.kind = kind;
                series.entry = interface.entry;
                series.precision = interface.precision;
                series.claimed_order = candidate.order();
                series.algorithm = candidate.name();
                series.own_law = candidate.own_law;
                const Reference& against = candidate.own_law ? candidate.reference : chart.reference;
                series.floor = against.estimate;
                if (against.compare_strain) series.floor = std::max(series.floor, scene.analysis.tolerance);
                const Scenario run = *in_kind(candidate.scenario, kind);
                for (const int increments : settings.increments) {
                    if (meter != nullptr)
                        meter->advance(fmt::format("{} {} {} {}", chart.stem, series.algorithm, series.interface_name(),
                                                   increments));
                    ChartPoint point = run_point(run, interface, libraries, increments, against, settings);
                    if (!point.usable()) series.failure = point.trace.outcome.message;
                    if (point.trace.outcome.status == Status::refused && series.points.empty()) break;
                    series.points.push_back(std::move(point));
                }
                if (series.points.empty()) continue;  // the material does not serve the kind or the interface
                fit(series);
                chart.series.push_back(std::move(series));
            }
    mark_front(chart);
    return chart;
}

double Series::largest_dissipation_error() const {
    double largest = 0;
    for (const ChartPoint& p : points)
        if (p.usable()) largest = std::max(largest, p.dissipation);
    return largest;
}

double Series::exact_enough() const {
    return std::max(precision == Precision::single ? single_rounding : many_roundings, 20 * floor);
}

std::string order_text(const Series& series) {
    const std::string claim =
        std::isfinite(series.claimed_order) ? fmt::format("claimed {:g}", series.claimed_order) : "claimed exact";
    if (std::none_of(series.points.begin(), series.points.end(), [](const ChartPoint& p) { return p.usable(); }))
        return "no run came to its end: " + series.failure;
    const double largest = series.largest_error();
    if (largest > series.exact_enough()) {
        if (series.order) return fmt::format("order {:.2f} ({})", *series.order, claim);
        return fmt::format("errors from {:.1e} down to the floor ({})", largest, claim);
    }
    std::string text = fmt::format("stress exact, at most {:.1e}", largest);
    if (series.largest_dissipation_error() > series.exact_enough() && series.dissipation_order)
        text += fmt::format(", dissipation of order {:.2f}", *series.dissipation_order);
    return text + fmt::format(" ({})", claim);
}

}  // namespace lode::host
