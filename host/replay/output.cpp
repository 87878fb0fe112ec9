#include "output.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

namespace lode::host {
namespace {

std::string with_unit(const std::string& label, const std::string& unit) {
    return unit.empty() ? label : fmt::format("{} ({})", label, unit);
}

// Inside gnuplot's single quotes.
std::string quoted(const std::string& text) {
    std::string result = "'";
    for (const char c : text) result += c == '\'' ? std::string("''") : std::string(1, c);
    return result + "'";
}

// Inside gnuplot's double quotes, where a doubled backslash escapes a character of enhanced text.
std::string double_quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) result += c == '"' ? std::string("\\\"") : std::string(1, c);
    return result + "\"";
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

// Runs gnuplot where the script is, silently; its exit status, 127 if there is no gnuplot.
int run_gnuplot(const std::filesystem::path& script) {
    const std::string directory = script.parent_path().empty() ? "." : script.parent_path().string();
    const std::string name = script.filename().string();
    const pid_t child = fork();
    if (child < 0) return 1;
    if (child == 0) {
        const int sink = open("/dev/null", O_WRONLY);
        dup2(sink, STDOUT_FILENO);
        dup2(sink, STDERR_FILENO);
        if (chdir(directory.c_str()) != 0) _exit(1);
        execlp("gnuplot", "gnuplot", name.c_str(), static_cast<char*>(nullptr));
        _exit(127);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}

// The component that the first step drives.
std::pair<std::string, std::string> default_axes(const Scenario& scenario) {
    const Layout layout(scenario.analysis.kind);
    int component = 0;
    for (const Step& step : scenario.steps) {
        if (step.moves_by_gradient()) break;
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
    const std::filesystem::path script_path = figure.stem + ".gp";
    // The script names its files without directories, so that it can be run again wherever they are.
    const std::string name = std::filesystem::path(figure.stem).filename().string();
    const std::string data = std::filesystem::path(csv).filename().string();
    constexpr std::array<const char*, 6> colours{"#1f5fa8", "#c8501e", "#2e8540", "#7b3fa0", "#a67c00", "#444444"};

    std::string curves;
    for (std::size_t i = 0; i < figure.y.size(); ++i) {
        curves += fmt::format("{} using {}:{} with lines lw 1.6 lc rgb '{}' {}", i == 0 ? "plot data" : ", data",
                              figure.x_index + 1, figure.y_index[i] + 1, colours[i % colours.size()],
                              figure.y.size() > 1 ? "title " + double_quoted(figure.y[i].label) : "notitle");
    }
    const std::string script = fmt::format(
        R"(# gnuplot script, written by `lode replay`. Run it in the directory of its data.
data = {data}
set datafile separator ','
set datafile columnheaders
set encoding utf8
set minussign
{key}
set title {title} font ',14' offset 0,-0.2 noenhanced
set xlabel {x}
set ylabel {y}
set border 3 lw 0.8 lc rgb '#404040'
set tics nomirror out scale 0.6 textcolor rgb '#202020'
set grid lt 1 dt solid lw 0.5 lc rgb '#e0e0e0'
set xzeroaxis lt 1 dt solid lw 0.7 lc rgb '#a0a0a0'
set yzeroaxis lt 1 dt solid lw 0.7 lc rgb '#a0a0a0'
set offsets graph 0.03, graph 0.03, graph 0.06, graph 0.06
set autoscale noextend
set terminal pngcairo size 1200,800 font 'Noto Sans,13' fontscale 1.2 enhanced
set output {png}
{curves}
set terminal svg size 760,500 font 'Noto Sans,DejaVu Sans,sans-serif,13' enhanced background 'white' dynamic
set output {svg}
replot
set output
)",
        fmt::arg("data", quoted(data)),
        fmt::arg("key", figure.y.size() > 1
                            ? "set key below center horizontal Left reverse samplen 2 spacing 1.3 height 0.5"
                            : "unset key"),
        fmt::arg("title", quoted(figure.title)), fmt::arg("x", double_quoted(figure.x_label)),
        fmt::arg("y", double_quoted(figure.y_label)), fmt::arg("png", quoted(name + ".png")),
        fmt::arg("svg", quoted(name + ".svg")), fmt::arg("curves", curves));

    std::FILE* const file = std::fopen(script_path.c_str(), "w");
    if (file == nullptr) return "cannot write " + script_path.string();
    std::fwrite(script.data(), 1, script.size(), file);
    std::fclose(file);
    const int status = run_gnuplot(script_path);
    if (status == 127) return "gnuplot is not installed: " + script_path.string() + " is there, its pictures are not";
    if (status != 0) return fmt::format("gnuplot refused {} (status {})", script_path.string(), status);
    return {};
}

}  // namespace lode::host
