#include "output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "../plot/gnuplot.hpp"

namespace lode::host {
namespace {

std::string with_unit(const std::string& label, const std::string& unit) {
    return unit.empty() ? label : fmt::format("{} ({})", label, unit);
}

// One curve: what it is, by name and symbol. Several: what they have in common, else all their names.
std::string axis_label(const std::vector<Column>& columns) {
    const Column& first = columns.front();
    const bool alike = std::all_of(columns.begin(), columns.end(), [&](const Column& c) {
        return !c.quantity.empty() && c.quantity == first.quantity;
    });
    std::string text;
    if (alike && columns.size() > 1) text = first.quantity;
    else if (alike) text = first.quantity + " " + first.label;
    else
        for (const Column& column : columns) text.append(text.empty() ? "" : ", ").append(column.label);
    return with_unit(text, first.unit);
}

// The component that the first step drives.
std::pair<std::string, std::string> default_axes(const Scenario& scenario) {
    const Layout layout(scenario.analysis.kind);
    int component = 0;
    for (const Step& step : scenario.steps) {
        if (step.moves_by_gradient() || step.manufactured) {
            if (step.manufactured && step.manufactured->is_shear()) component = layout.ndi();
            break;
        }
        const auto driven = std::find_if(step.components.begin(), step.components.end(),
                                         [](const auto& c) { return c && c->value != 0; });
        if (driven == step.components.end()) continue;
        component = static_cast<int>(driven - step.components.begin());
        break;
    }
    const std::string name(layout.name(component));
    return {std::string(layout.strain_prefix()) + name, std::string(layout.stress_prefix()) + name};
}

}  // namespace

CsvWriter::CsvWriter(std::string path, std::vector<Column> columns)
    : path_(std::move(path)), columns_(std::move(columns)), file_(std::fopen(path_.c_str(), "w"), &std::fclose) {
    if (!file_) throw Failure(Status::usage, "cannot write " + path_);
    for (const Column& column : columns_) line_.append(line_.empty() ? "" : ",").append(column.name);
    line_ += '\n';
    std::fwrite(line_.data(), 1, line_.size(), file_.get());
}

void CsvWriter::write(const Record& record) {
    line_.clear();
    for (const Column& column : columns_) {
        if (!line_.empty()) line_ += ',';
        // Shortest text that reads back as the same number.
        fmt::format_to(std::back_inserter(line_), "{}", column.value(record));
    }
    line_ += '\n';
    std::fwrite(line_.data(), 1, line_.size(), file_.get());
}

void CsvWriter::close() {
    if (!file_) return;
    const bool failed = std::ferror(file_.get()) != 0;
    if (std::fclose(file_.release()) != 0 || failed) throw Failure(Status::usage, "cannot write " + path_);
}

std::vector<Figure> make_figures(const Scenario& scenario, const ColumnSet& set, const std::string& stem,
                                 std::vector<Column>& columns) {
    std::vector<Plot> plots = scenario.output.plots;
    if (plots.empty() && scenario.output.plot) {
        const auto [x, y] = default_axes(scenario);
        Plot plot;
        plot.x = {x, ""};
        plot.y = {{y, ""}};
        plots.push_back(plot);
    }
    std::vector<Figure> figures;
    for (const Plot& plot : plots) {
        Figure figure;
        const std::string suffix = !plot.name.empty() ? "-" + plot.name
                                   : plots.size() > 1 ? fmt::format("-{}", figures.size() + 1)
                                                      : "";
        figure.stem = stem + suffix;
        figure.x = set.find(plot.x);
        figure.x_index = ColumnSet::place(columns, figure.x);
        for (const Located& y : plot.y) {
            figure.y.push_back(set.find(y));
            figure.y_index.push_back(ColumnSet::place(columns, figure.y.back()));
        }
        figure.title = !plot.title.empty()       ? plot.title
                       : !scenario.title.empty() ? scenario.title
                                                 : scenario.material.name;
        figure.x_label = !plot.x_label.empty() ? plot.x_label : axis_label({figure.x});
        figure.y_label = !plot.y_label.empty() ? plot.y_label : axis_label(figure.y);
        figures.push_back(std::move(figure));
    }
    return figures;
}

std::string draw(const Figure& figure, const std::string& csv) {
    const std::string data = std::filesystem::path(csv).filename().string();
    std::string curves;
    for (std::size_t i = 0; i < figure.y.size(); ++i) {
        curves +=
            fmt::format("{} using {}:{} with {} lc rgb '{}' {}", i == 0 ? "plot data" : ", data", figure.x_index + 1,
                        figure.y_index[i] + 1, figure.y[i].is_reference ? "points pt 6 ps 0.8 lw 1.2" : "lines lw 1.6",
                        curve_colour(i), figure.y.size() > 1 ? "title " + double_quoted(figure.y[i].label) : "notitle");
    }
    return draw_script(
        figure.stem,
        fmt::format(
            R"(# gnuplot script, written by `lode replay`. Run it in the directory of its data.
data = {data}
set datafile separator ','
set datafile columnheaders
{style}{key}
set title {title} font ',14' offset 0,-0.2 noenhanced
set xlabel {x}
set ylabel {y}
set xzeroaxis lt 1 dt solid lw 0.7 lc rgb '#a0a0a0'
set yzeroaxis lt 1 dt solid lw 0.7 lc rgb '#a0a0a0'
set offsets graph 0.03, graph 0.03, graph 0.06, graph 0.06
set autoscale noextend
{draw})",
            fmt::arg("data", single_quoted(data)), fmt::arg("style", figure_style()),
            fmt::arg("key", figure.y.size() > 1 ? "set key below center horizontal Left reverse samplen 2 spacing 1.3 "
                                                  "height 0.5"
                                                : "unset key"),
            fmt::arg("title", single_quoted(figure.title)), fmt::arg("x", double_quoted(figure.x_label)),
            fmt::arg("y", double_quoted(figure.y_label)), fmt::arg("draw", terminals(figure.stem, curves))));
}

}  // namespace lode::host
