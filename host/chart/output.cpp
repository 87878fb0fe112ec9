#include "output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "../plot/gnuplot.hpp"
#include "../status.hpp"
#include "../study/table.hpp"

namespace lode::host {
namespace {

constexpr double plotted_floor = 1e-17;  // zero has no place on a logarithmic axis

bool several_kinds(const Chart& chart) {
    std::set<Kind> kinds;
    for (const Series& s : chart.series) kinds.insert(s.kind);
    return kinds.size() > 1;
}

std::string label(const Series& series, bool with_kind) {
    std::string text = series.algorithm.empty() ? "as it is" : series.algorithm;
    // What follows a colon explains; it is too long for a key.
    text = text.substr(0, text.find(':'));
    text += ", " + series.interface_name();
    if (with_kind) text += fmt::format(", {}", name_of(series.kind));
    if (series.own_law) text += " (own law)";
    return text;
}

std::string data_block(std::size_t index, const Series& series) {
    std::string block = fmt::format("$s{} << EOD\n", index);
    for (const ChartPoint& p : series.points)
        if (p.usable())
            block += fmt::format("{} {} {} {} {}\n", p.cost.median, std::max(p.error, plotted_floor), p.cost.low,
                                 p.cost.high, p.increments);
    return block + "EOD\n";
}

struct FrontPoint {
    double cost, error;
    int increments;
};
std::vector<FrontPoint> front(const Chart& chart) {
    std::vector<FrontPoint> points;
    for (const Series& s : chart.series)
        for (const ChartPoint& p : s.points)
            if (p.best) points.push_back({p.cost.median, std::max(p.error, plotted_floor), p.increments});
    std::sort(points.begin(), points.end(), [](const FrontPoint& a, const FrontPoint& b) { return a.cost < b.cost; });
    return points;
}

}  // namespace

void write_csv(const Chart& chart, const std::string& path) {
    Table table({"kind", "interface", "algorithm", "claimed_order", "own_law", "increments", "error",
                 "dissipation_error", "reference_error", "cost_ns", "cost_low_ns", "cost_high_ns", "ns_per_call",
                 "calls", "cut_backs", "pareto", "fitted_order", "status"});
    for (const Series& s : chart.series)
        for (const ChartPoint& p : s.points)
            table.add({name_of(s.kind), s.interface_name(), s.algorithm, s.claimed_order, s.own_law ? 1 : 0,
                       p.increments, p.usable() ? p.error : std::nan(""), p.usable() ? p.dissipation : std::nan(""),
                       s.floor, p.cost.median, p.cost.low, p.cost.high, p.cost.per_call, p.cost.calls,
                       p.trace.outcome.statistics.cut_backs, p.best ? 1 : 0, s.order.value_or(std::nan("")),
                       p.usable() ? "ok" : p.trace.outcome.message});
    table.write(path);
}

std::string draw(const Chart& chart, const std::string& stem) {
    std::string script = "# gnuplot script, written by `lode chart`. The data are in it.\n" + figure_style() +
                         fmt::format(R"(set logscale xy
set format x '10^{{%L}}'
set format y '10^{{%L}}'
set title {} font ',14' offset 0,-0.2 noenhanced
set xlabel 'cost of the whole path (ns for each point)'
set ylabel 'error relative to the largest stress'
set key outside right top vertical Left reverse samplen 2 spacing 1.2 width -2 font ',10' noenhanced
set pointsize 0.9
)",
                                     single_quoted(chart.title));
    // Colours tell algorithms apart, or kinds where there is one algorithm only.
    std::map<std::string, std::size_t> colours;
    const bool one_algorithm = std::all_of(chart.series.begin(), chart.series.end(), [&](const Series& s) {
        return s.algorithm == chart.series.front().algorithm;
    });
    std::map<Kind, int> dashes;
    const bool with_kind = several_kinds(chart);
    std::string plot = "plot";
    const auto add = [&plot](const std::string& curve) { plot += (plot == "plot" ? " " : ", ") + curve; };

    script += "$front << EOD\n";
    double last = 0;
    for (const FrontPoint& p : front(chart)) {
        if (last > 0) script += fmt::format("{} {}\n", p.cost, last);
        script += fmt::format("{} {}\n", p.cost, p.error);
        last = p.error;
    }
    script += "EOD\n$best << EOD\n";
    for (const FrontPoint& p : front(chart)) script += fmt::format("{} {} {}\n", p.cost, p.error, p.increments);
    script += "EOD\n";
    add("$front using 1:2 with lines lw 7 lc rgb '#e3d9b0' title 'Pareto front'");
    if (chart.reference.estimate > plotted_floor)
        add(fmt::format("{} with lines dt 3 lw 1 lc rgb '#808080' title 'error of the reference'",
                        chart.reference.estimate));
    for (std::size_t i = 0; i < chart.series.size(); ++i) {
        const Series& s = chart.series[i];
        if (std::none_of(s.points.begin(), s.points.end(), [](const ChartPoint& p) { return p.usable(); })) continue;
        script += data_block(i, s);
        const std::size_t colour =
            colours.try_emplace(one_algorithm ? std::string(name_of(s.kind)) : s.algorithm, colours.size())
                .first->second;
        const int dash = dashes.try_emplace(s.kind, static_cast<int>(dashes.size()) + 1).first->second;
        const int mark = s.entry == Entry::umat ? 7 : s.precision == Precision::single ? 4 : 9;
        add(fmt::format("$s{} using 1:2 with linespoints lw 1.4 dt {} pt {} lc rgb '{}' title {}", i, dash, mark,
                        curve_colour(colour), single_quoted(label(s, with_kind))));
        add(fmt::format("$s{} using 1:2:3:4 with xerrorbars pt 0 lw 0.8 lc rgb '{}' notitle", i, curve_colour(colour)));
    }
    add("$best using 1:2:3 with labels font ',8' textcolor rgb '#606060' offset 0,-0.8 title 'number: increments a "
        "step'");
    return draw_script(stem, script + terminals(stem, plot, Width::wide));
}

std::string text(const Chart& chart) {
    std::string result = fmt::format("{}\n  reference   {}{}; its own error is about {:.1e}\n", chart.title,
                                     chart.reference_algorithm.empty() ? "" : chart.reference_algorithm + ", ",
                                     chart.reference.how, chart.reference.estimate);
    std::vector<std::vector<std::string>> rows{{"algorithm", "kind", "interface", "convergence", "ns a call"}};
    for (const Series& s : chart.series) {
        double per_call = 0;
        for (const ChartPoint& p : s.points)
            if (p.usable()) per_call = p.cost.per_call;
        rows.push_back({s.algorithm.substr(0, s.algorithm.find(':')) + (s.own_law ? " (own law)" : ""),
                        std::string(name_of(s.kind)), s.interface_name(), order_text(s),
                        per_call > 0 ? fmt::format("{:.1f}", per_call) : "-"});
    }
    result += aligned(rows, "  ");
    std::vector<std::vector<std::string>> best{{"Pareto front", "increments", "error", "cost (ns)", "quartiles"}};
    std::vector<std::pair<double, std::vector<std::string>>> points;
    for (const Series& s : chart.series)
        for (const ChartPoint& p : s.points)
            if (p.best && p.cost.median > 0)
                points.emplace_back(
                    p.cost.median,
                    std::vector<std::string>{label(s, true), fmt::format("{}", p.increments),
                                             fmt::format("{:.2e}", p.error), fmt::format("{:.0f}", p.cost.median),
                                             fmt::format("{:.0f}..{:.0f}", p.cost.low, p.cost.high)});
    std::sort(points.begin(), points.end());
    for (auto& [cost, row] : points) best.push_back(std::move(row));
    if (!points.empty()) result += aligned(best, "  ");
    return result;
}

}  // namespace lode::host
