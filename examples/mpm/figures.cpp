#include "figures.hpp"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "theory.hpp"

namespace mpm {

namespace {

namespace fs = std::filesystem;

const char* const style = R"(set datafile separator ','
set encoding utf8
set border 3 lw 0.8 lc rgb '#404040'
set tics nomirror out scale 0.6 textcolor rgb '#202020'
set grid lt 1 dt solid lw 0.5 lc rgb '#e0e0e0'
)";
const char* const colours[] = {"#1f5fa8", "#c8501e", "#2e8540", "#7b3fa0"};

std::string number(double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", x);
    return text;
}
std::string quoted(const std::string& s) { return "'" + s + "'"; }

// A picture: a gnuplot script of several panels, run where its data are.
class Figure {
  public:
    Figure(fs::path directory, std::string name, int width, int height, const std::string& layout)
        : directory_(std::move(directory)), name_(std::move(name)) {
        script_ = std::string(style) + "set terminal svg size " + std::to_string(width) + "," + std::to_string(height) +
                  " font 'Noto Sans,DejaVu Sans,sans-serif,12' enhanced background 'white' dynamic\nset output " +
                  quoted(name_ + ".svg") + "\nset multiplot layout " + layout + "\n";
    }
    void add(const std::string& commands) { script_ += commands + "\n"; }
    bool draw() {
        script_ += "unset multiplot\nset output\n";
        std::ofstream(directory_ / (name_ + ".gp")) << script_;
        const std::string command = "cd '" + directory_.string() + "' && gnuplot " + name_ + ".gp 2>/dev/null";
        return std::system(command.c_str()) == 0;
    }

  private:
    fs::path directory_;
    std::string name_, script_;
};

std::string history_file(const Settings& s) { return s.file_name() + ".csv"; }
std::string points_file(const Settings& s, const Snapshot& at) {
    return s.file_name() + "_points_" + number(1e6 * at.elongation) + "um.csv";
}

// Columns of the two files.
constexpr int P_column = 5, work_column = 7, theory_column = 12;
enum PointColumn { opening = 6, s_nn, s_tt, s_nt };

std::string curve(const std::string& file, int column, double unit, const std::string& title, const char* look) {
    return quoted(file) + " skip 1 every 3 using ($1*1e6):($" + std::to_string(column) + "*" + number(unit) +
           ") with lines " + look + " title " + quoted(title);
}

std::string load_panel(const Settings& s, const std::string& title) {
    const std::string f = history_file(s);
    return "set title " + quoted(title) +
           "\nset xlabel 'elongation (µm)'\nset ylabel 'load (kN)'\nset key at 75,2.2\n" +
           "set xrange [0:105]\nset yrange [-0.5:10.5]\nplot " +
           curve(f, theory_column, 1e-3, "theory, one crack", "lw 2 dt 2 lc rgb '#808080'") + ", \\\n " +
           curve(f, P_column, 1e-3, "mean of three stations", "lw 1.6 lc rgb '#1f5fa8'");
}

std::string energy_panel(const Settings& s, const std::string& title) {
    const std::string f = history_file(s);
    const std::string whole = number(2.0 * bar::W * bar::D * bar::G_f);
    return "set title " + quoted(title) +
           "\nset xlabel 'elongation (µm)'\nset ylabel 'energy (J)'\nset key top left\n" +
           "set xrange [0:105]\nset yrange [0:1]\nplot " + whole +
           " lw 1.5 dt 2 lc rgb '#808080' title '2 W D G_f', \\\n " +
           curve(f, work_column, 1.0, "W_f work of the load", "lw 1.8 lc rgb '#1f5fa8'") + ", \\\n " +
           curve(f, work_column + 1, 1.0, "E_f dissipated", "lw 1.4 lc rgb '#c8501e'") + ", \\\n " +
           curve(f, work_column + 2, 1.0, "U elastic", "lw 1.4 lc rgb '#2e8540'");
}

// Points of the bar in its own axes, coloured by a column; those without an opening are left to the background.
std::string map_panel(const Settings& s, const Snapshot& at, PointColumn column, const std::string& title, double low,
                      double high) {
    const std::string size = number(0.1 * s.h / 0.0025 + 0.12), raw = "$" + std::to_string(column);
    const std::string along = column == opening ? "(" + raw + ">0.005?$1*100:NaN)" : "($1*100)";
    return "set title " + quoted(title) +
           "\nset xlabel 'along the bar (cm)'\nunset ylabel\nunset key\nset xrange [-10.2:10.2]\n" +
           "set yrange [-3.2:3.2]\nset size ratio -1\nset xtics 5\nset ytics 3\nset object 1 rect from -10,-3 to 10,3 "
           "fc rgb '#e8e8e8' fs solid noborder behind\nset cbrange [" +
           number(low) + ":" + number(high) + "]\nplot " + quoted(points_file(s, at)) + " skip 1 using " + along +
           ":($2*100):(" + raw + ") with points pt 5 ps " + size + " lc palette\nunset object 1";
}
const char* const opening_colours =
    "set palette defined (0 '#cfe0f2', 0.3 '#6fa3d8', 0.7 '#7b3fa0', 1 '#c8101e')\n"
    "set colorbox";
const char* const stress_colours =
    "set palette defined (-1 '#1f5fa8', -0.4 '#a9c8e8', 0 '#f2f2f2', 0.4 '#f2b895', 1 '#b0301e')\nset colorbox";

enum Moment : std::size_t { elastic_stage, softening_stage };  // of the study's snapshots

void stress_figure(Figure& figure, const Campaign& campaign, const Settings& left, const Settings& right,
                   const char* left_title, const char* right_title, Moment moment, double range) {
    const struct {
        PointColumn column;
        const char* name;
    } stresses[] = {{s_nn, "{/Symbol s}_{nn}"}, {s_tt, "{/Symbol s}_{tt}"}, {s_nt, "{/Symbol s}_{nt}"}};
    figure.add(stress_colours);
    for (const auto& [column, name] : stresses)
        for (const bool first : {true, false}) {
            const Settings& s = first ? left : right;
            figure.add(map_panel(s, campaign[s].snapshots[moment], column,
                                 std::string(name) + "/{/Symbol t}_{nf}, " + (first ? left_title : right_title), -range,
                                 range));
        }
}

void write_close_up(const Result& r, const fs::path& path) {
    std::ofstream file(path);
    const Vec middle = 0.5 * r.settings.v_L * r.settings.n();
    file << "x,y,vx,vy\n";
    for (const NodeState& node : r.snapshots.back().nodes) {
        const Vec v = node.velocity - middle;
        file << node.position.x << ',' << node.position.y << ',' << v.x << ',' << v.y << '\n';
    }
}

// Cells, points and the motion of the nodes relative to the middle of the bar.
std::string close_up_panel(const Settings& s, const Snapshot& at, const std::string& nodes, const std::string& title) {
    const std::string h = number(100.0 * s.h), scale = number(90.0 * s.h / s.v_L);
    return "set title " + quoted(title) + "\nset xlabel 'x (cm)'\nset ylabel 'y (cm)'\nunset key\nset size ratio -1\n" +
           "set xrange [-3:3]\nset yrange [-3:3]\nset xtics -3," + h + ",3 format ''\nset ytics -3," + h +
           ",3 format ''\nset cbrange [0:1]\nplot " + quoted(points_file(s, at)) +
           " skip 1 using ($3*100):($4*100):6 with points pt 7 ps 0.55 lc palette, \\\n " + quoted(nodes) +
           " skip 1 using ($1*100):($2*100):($3*" + scale + "):($4*" + scale +
           ") with vectors head filled size 0.08,20 lw 0.9 lc rgb '#202020'";
}

}  // namespace

bool draw_figures(const Campaign& campaign, const fs::path& directory) {
    bool drawn = true;
    std::set<std::string> written;
    const auto keep = [&](const Settings& s) {
        if (!written.insert(s.name()).second) return;
        const Result& r = campaign[s];
        write_history(r, directory / history_file(s));
        for (const Snapshot& at : r.snapshots) write_points(at, directory / points_file(s, at));
    };
    const double map_h = 5.0, fine = campaign.has(setting(2.5, 45.0)) ? 2.5 : 5.0;
    const std::string fine_text = ", h " + number(fine) + " mm", map_text = ", h " + number(map_h) + " mm";

    {  // figures 5.21, 5.22
        Figure figure(directory, "response", 960, 720, "2,2 columnsfirst");
        for (const double angle : {0.0, 45.0}) {
            const Settings s = setting(fine, angle);
            keep(s);
            figure.add(load_panel(s, number(angle) + "°" + fine_text));
            figure.add(energy_panel(s, number(angle) + "°" + fine_text));
        }
        drawn = figure.draw() && drawn;
    }
    {  // figures 5.23, 5.24
        Figure figure(directory, "cracks", 960, 460, "2,2");
        figure.add(opening_colours);
        for (const double angle : {0.0, 15.0, 30.0, 45.0}) {
            const Settings s = setting(map_h, angle);
            keep(s);
            figure.add(map_panel(s, campaign[s].snapshots.back(), opening,
                                 "u_n/u_0 at the end, " + number(angle) + "°" + map_text, 0.0, 1.0));
        }
        drawn = figure.draw() && drawn;
    }
    const Settings along = setting(map_h, 0.0), across = setting(map_h, 45.0),
                   uniform = setting(map_h, 45.0, Filling::uniform);
    keep(uniform);
    {  // figures 5.25 to 5.30
        Figure figure(directory, "stress_elastic", 960, 640, "3,2");
        stress_figure(figure, campaign, along, across, "0°, 15 µm", "45°, 15 µm", elastic_stage, 1.0);
        drawn = figure.draw() && drawn;
    }
    {  // figures 5.31 to 5.36
        Figure figure(directory, "stress_softening", 960, 640, "3,2");
        stress_figure(figure, campaign, along, across, "0°, 50 µm", "45°, 50 µm", softening_stage, 1.0);
        drawn = figure.draw() && drawn;
    }
    {  // figures 5.41 to 5.46
        Figure figure(directory, "filling", 960, 640, "3,2");
        stress_figure(figure, campaign, across, uniform, "rotated points, 15 µm", "uniform points, 15 µm",
                      elastic_stage, 1.0);
        drawn = figure.draw() && drawn;
    }
    {
        Figure figure(directory, "angle", 640, 460, "1,1");
        std::string plot =
            "set xlabel 'angle of the bar to the grid (degrees)'\nset ylabel 'W_f (J)'\nset key top left\n"
            "set xrange [-1:46]\nset yrange [0.4:0.9]\nplot " +
            number(2.0 * bar::W * bar::D * bar::G_f) + " lw 1.5 dt 2 lc rgb '#808080' title 'theory'";
        std::ofstream data(directory / "angle.csv");
        data << "h_mm,angle,W_f\n";
        std::size_t colour = 0;
        for (const double h : {20.0, 10.0, 5.0, 2.5}) {
            bool any = false;
            for (const double angle : {0.0, 5.0, 10.0, 15.0, 30.0, 45.0})
                if (const Settings s = setting(h, angle); campaign.has(s)) {
                    data << h << ',' << angle << ',' << campaign[s].end().work << '\n';
                    any = true;
                }
            if (any)
                plot += ", \\\n 'angle.csv' skip 1 using ($1==" + number(h) +
                        "?$2:NaN):3 with points pt 7 ps 0.8 lc rgb " + quoted(colours[colour]) + " title 'h " +
                        number(h) + " mm'";
            data << "\n\n";
            ++colour;
        }
        data.close();
        figure.add(plot);
        drawn = figure.draw() && drawn;
    }
    {  // figures 5.12, 5.15, 5.18
        Figure figure(directory, "weak", 1100, 640, "2,3");
        const char* const titles[] = {"weak line", "weak square", "one weak point"};
        for (const WeakPattern pattern : {WeakPattern::line, WeakPattern::square, WeakPattern::point}) {
            std::string plot =
                std::string("set title ") + quoted(titles[static_cast<int>(pattern)]) +
                "\nset xlabel 'elongation (µm)'\nset ylabel 'load (kN)'\nset key top right\nset autoscale "
                "xy\nset size noratio\nset xtics auto\nset ytics auto\nset xrange [0:105]\nset yrange [-0.5:10.5]\n";
            std::string separator = "plot ";
            std::size_t colour = 0;
            for (const double h : {20.0, 10.0, 5.0, 2.5}) {
                Settings s = setting(h, 0.0);
                s.pattern = pattern;
                const char* const hue = colours[colour++];
                if (!campaign.has(s)) continue;
                keep(s);
                if (separator == "plot ")
                    plot +=
                        separator + curve(history_file(s), theory_column, 1e-3, "theory", "lw 2 dt 2 lc rgb '#808080'");
                separator = ", \\\n ";
                plot += separator + curve(history_file(s), P_column, 1e-3, "h " + number(h) + " mm",
                                          (std::string("lw 1.2 lc rgb ") + quoted(hue)).c_str());
            }
            figure.add(plot);
        }
        figure.add(opening_colours);
        for (const WeakPattern pattern : {WeakPattern::line, WeakPattern::square, WeakPattern::point}) {
            Settings s = setting(fine, 0.0);
            s.pattern = pattern;
            figure.add(map_panel(s, campaign[s].snapshots.back(), opening, "u_n/u_0 at the end" + fine_text, 0.0, 1.0));
        }
        drawn = figure.draw() && drawn;
    }
    {  // figures 5.56 to 5.58
        Figure figure(directory, "close_up", 1040, 520, "1,2");
        figure.add(opening_colours);
        for (const double angle : {0.0, 45.0}) {
            const Settings s = setting(map_h, angle);
            const std::string nodes = s.file_name() + "_nodes.csv";
            write_close_up(campaign[s], directory / nodes);
            figure.add(close_up_panel(s, campaign[s].snapshots.back(), nodes,
                                      number(angle) + "°" + map_text + ": points u_n/u_0, arrows motion of nodes"));
        }
        drawn = figure.draw() && drawn;
    }
    return drawn;
}

bool draw_run(const Result& r, const fs::path& directory) {
    const Settings& s = r.settings;
    write_history(r, directory / history_file(s));
    for (const Snapshot& at : r.snapshots) write_points(at, directory / points_file(s, at));
    bool drawn = true;
    {
        Figure figure(directory, "response", 960, 380, "1,2");
        figure.add(load_panel(s, s.name()));
        figure.add(energy_panel(s, s.name()));
        drawn = figure.draw() && drawn;
    }
    Figure figure(directory, "bar", 960, 460, "2,2");
    figure.add(opening_colours);
    figure.add(map_panel(s, r.snapshots.back(), opening, "u_n/u_0 at the end", 0.0, 1.0));
    figure.add(stress_colours);
    const struct {
        PointColumn column;
        const char* name;
    } stresses[] = {{s_nn, "{/Symbol s}_{nn}"}, {s_tt, "{/Symbol s}_{tt}"}, {s_nt, "{/Symbol s}_{nt}"}};
    for (const auto& [column, name] : stresses)
        figure.add(map_panel(s, r.snapshots.back(), column, std::string(name) + "/{/Symbol t}_{nf}", -1.0, 1.0));
    return figure.draw() && drawn;
}

}  // namespace mpm
