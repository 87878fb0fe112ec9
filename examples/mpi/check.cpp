// Runs mpi_bar on one and two ranks and prints how far it is from its references.
//   mpi_check --program MPI_BAR [--output DIRECTORY] [case ...]
//   mpi_check --list
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#define TOML_HEADER_ONLY 1
#include <toml++/toml.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

namespace {

namespace fs = std::filesystem;
constexpr int skipped = 77;  // what the tests take for "not on this machine"

// The steel and the bar that most cases have, mm and MPa (the program's defaults).
constexpr double young = 210000, yield_stress = 250, hardening = 2000;
constexpr double width = 20, length = 50, thickness = 10, radius = 5;
constexpr double newton_tolerance = 1e-10;
// Residuals of this size move forces and plastic strains by as much, times what the tangent has lost of its stiffness.
constexpr double solver_tolerance = 10 * newton_tolerance;

struct Check {
    std::string what, reference;
    double deviation, tolerance;
    std::string note;
    bool passed() const { return deviation <= tolerance; }  // false for NaN
};
struct Report : std::vector<Check> {
    std::string remark;  // printed above the checks
};

struct Row {
    double time, size, elongation, force, watched;
};
struct Run {
    int status = -1;  // exit status; -1 if a signal ended it
    std::string log;
    toml::table summary;
    std::vector<Row> curve;
    std::vector<std::vector<double>> residuals;  // of each increment

    int count(const char* key) const { return summary[key].value_or(-1); }
    double of_seconds(const char* key) const { return summary["seconds"][key].value_or(0.0); }
    double last_force() const { return curve.empty() ? NAN : curve.back().force; }
};

std::vector<std::vector<double>> read_csv(const fs::path& file) {
    std::ifstream in(file);
    std::vector<std::vector<double>> rows;
    std::string line;
    std::getline(in, line);  // heading
    while (std::getline(in, line)) {
        std::replace(line.begin(), line.end(), ',', ' ');
        std::istringstream words(line);
        rows.emplace_back();
        for (double value; words >> value;) rows.back().push_back(value);
    }
    return rows;
}

std::string text(const char* format, auto... values) {
    char line[400];
    std::snprintf(line, sizeof line, format, values...);
    return line;
}

class Host {
  public:
    Host(fs::path program, fs::path output) : program_(std::move(program)), output_(std::move(output)) {}

    // `card` is the TOML text of the run. Lines of the program appear on standard error while it runs. After `limit`
    // seconds it is ended, with status 124.
    Run run(const std::string& name, int ranks, const std::string& card, int limit = 3600) const {
        const fs::path directory = output_ / (name + "_" + std::to_string(ranks));
        fs::remove_all(directory);
        fs::create_directories(directory);
        std::ofstream(directory / "card.toml") << card;
        // Ranks share processors with whatever else runs here, and a bound or busily waiting one would wait long.
        const std::string root = geteuid() == 0 ? "--allow-run-as-root " : "";
        const std::string command = "OMP_NUM_THREADS=1 timeout " + std::to_string(limit) + " mpirun " + root +
                                    "--oversubscribe --bind-to none --mca mpi_yield_when_idle 1 -n " +
                                    std::to_string(ranks) + " '" + program_.string() + "' '" +
                                    (directory / "card.toml").string() + "' -o '" + directory.string() +
                                    "' 2>&1 </dev/null";
        std::fprintf(stderr, "-- %s, ranks: %d\n", name.c_str(), ranks);
        Run run;
        std::FILE* const lines = popen(command.c_str(), "r");
        if (lines == nullptr) throw std::runtime_error("cannot run " + command);
        std::ofstream log(directory / "log.txt");
        for (char line[1000]; std::fgets(line, sizeof line, lines) != nullptr;) {
            std::fputs(line, stderr);
            log << line;
            run.log += line;
        }
        const int status = pclose(lines);
        run.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
        if (fs::exists(directory / "summary.toml"))
            run.summary = toml::parse_file((directory / "summary.toml").string());
        for (const auto& r : read_csv(directory / "curve.csv")) run.curve.push_back({r[1], r[2], r[3], r[4], r[5]});
        for (const auto& r : read_csv(directory / "newton.csv")) {
            if (r[1] == 0) run.residuals.emplace_back();
            run.residuals.back().push_back(r[2]);
        }
        return run;
    }
    void draw(const std::string& run) const {
        const std::string command = "cd '" + (output_ / run).string() + "' && gnuplot mid_plane.gp >gnuplot.log 2>&1";
        if (std::system(command.c_str()) != 0) std::fprintf(stderr, "no picture: gnuplot is missing or failed\n");
    }

  private:
    fs::path program_, output_;
};

double relative(double value, double reference) { return std::abs(value / reference - 1); }
double verdict(bool holds) { return holds ? 0 : 1; }

void must_finish(Report& report, const std::string& what, const Run& run) {
    if (run.status != 0) report.push_back({what + ": ends at its goal", "exit status 0", 1.0 * run.status, 0, ""});
}

// Force and largest state of every increment of two runs.
void compare(Report& report, const std::string& what, const Run& run, const std::string& reference, const Run& other) {
    double force = verdict(!run.curve.empty() && run.curve.size() == other.curve.size()), watched = force;
    double largest_force = 0, largest_watched = 0;
    for (const Row& row : other.curve) {
        largest_force = std::max(largest_force, std::abs(row.force));
        largest_watched = std::max(largest_watched, std::abs(row.watched));
    }
    for (std::size_t i = 0; force < 1 && i < run.curve.size(); ++i) {
        force = std::max(force, std::abs(run.curve[i].force - other.curve[i].force) / largest_force);
        watched = std::max(watched,
                           std::abs(run.curve[i].watched - other.curve[i].watched) / std::max(largest_watched, 1e-300));
    }
    report.push_back({what + ": force, every increment", reference, force, solver_tolerance,
                      text("%zu increments", run.curve.size())});
    report.push_back({what + ": largest plastic strain", reference, watched, solver_tolerance, ""});
}

// Order of convergence from the last three residuals that are above rounding, in the middle of all increments.
void add_order(Report& report, const std::string& what, const Run& run) {
    std::vector<double> orders;
    std::string shown;
    for (std::vector<double> r : run.residuals) {
        while (!r.empty() && r.back() < 1e-13) r.pop_back();
        if (r.size() < 3) continue;
        const std::size_t n = r.size();
        orders.push_back(std::log(r[n - 1] / r[n - 2]) / std::log(r[n - 2] / r[n - 3]));
        shown = text("%.0e, %.0e, %.0e", r[n - 3], r[n - 2], r[n - 1]);
    }
    std::sort(orders.begin(), orders.end());
    const double order = orders.empty() ? 0 : orders[orders.size() / 2];
    report.push_back({what + text(": Newton's order, median %.1f", order), "2, quadratic", std::max(0.0, 2 - order),
                      0.2, "last: " + shown});
}

std::string material(const char* name, const std::string& constants, const std::string& more = "") {
    return text("[material]\nname = \"%s\"\nconstants = [%s]\n%s\n", name, constants.c_str(), more.c_str());
}
const std::string steel = material("ISO_PLASTIC-STEEL", "210000, 0.3, 250, 1, 2000");
const std::string no_notch = "[bar]\nnotch_radius = 0\ndivisions = 2\nlayers = 2\nrefine = 1\n";
const std::string small_mesh = "[bar]\nrefine = 1\n";

void uniform_bar(const Host& host, Report& report) {
    const std::string card = steel + no_notch;
    const Run run = host.run("uniform_bar", 2, card), alone = host.run("uniform_bar", 1, card);
    double force = verdict(!run.curve.empty()), plastic = force;
    for (const Row& row : run.curve) {
        const double strain = row.elongation / length;
        const double p = std::max(0.0, (strain - yield_stress / young) / (1 + hardening / young));
        force = std::max(force, relative(row.force, width * thickness * young * (strain - p)));
        plastic = std::max(plastic, std::abs(row.watched - p) / strain);
    }
    report.push_back(
        {"force, every increment, 2 ranks", "area times stress, uniaxial J2", force, solver_tolerance, ""});
    report.push_back({"plastic strain, 2 ranks", "uniaxial J2", plastic, solver_tolerance, ""});
    compare(report, "2 ranks", run, "1 rank", alone);

    // Not associated: the matrix is not symmetric. Drucker-Prager with eta, eta_bar and linear hardening of the
    // cohesion, f = sqrt(J2) - eta sigma_m - xi c; in tension sigma (1/sqrt3 + eta/3) = xi (c0 + H xi lambda).
    const double eta = 0.5, dilation = 0.2, cohesion = 10, slope = 500, E = 20000;
    const Run soil = host.run("uniform_soil", 2,
                              material("DRUCKER_PRAGER-SOIL", "20000, 0.25, 0, 0.5, 0.2, 10, 1, 1, 500") + no_notch);
    double deviation = verdict(!soil.curve.empty());
    for (const Row& row : soil.curve) {
        const double a = 1 / std::numbers::sqrt3 + eta / 3, b = 1 / std::numbers::sqrt3 + dilation / 3;
        const double strain = row.elongation / length;
        const double lambda = std::max(0.0, (strain * a - cohesion / E) / (slope / E + a * b));
        deviation = std::max(deviation, relative(row.force, width * thickness * E * (strain - lambda * b)));
    }
    report.push_back({"DRUCKER_PRAGER: force, every increment, 2 ranks", "uniaxial closed form", deviation,
                      solver_tolerance, soil.summary["linear_solver"].value_or("")});
}

void elastic(const Host& host, Report& report) {
    const std::string rest = small_mesh + "[loading]\nelongation = 0.02\nfirst = 0.2\nlargest = 0.2\n";
    const Run run = host.run("elastic", 2, steel + rest);
    const Run linear = host.run("linear", 2, material("ISO_ELASTIC-STEEL", "210000, 0.3") + rest);
    double force = verdict(!run.curve.empty() && run.curve.size() == linear.curve.size()), straight = force;
    for (std::size_t i = 0; force < 1 && i < run.curve.size(); ++i) {
        force = std::max(force, relative(run.curve[i].force, linear.curve[i].force));
        straight = std::max(straight, relative(run.curve[i].force / run.curve[i].elongation,
                                               linear.curve[0].force / linear.curve[0].elongation));
    }
    report.push_back({"below yield: force, every increment", "ISO_ELASTIC, same mesh", force, solver_tolerance, ""});
    report.push_back(
        {"below yield: stiffness, every increment", "that of the first increment", straight, solver_tolerance, ""});
}

void notched_bar(const Host& host, Report& report) {
    const Run alone = host.run("notched_bar", 1, steel), run = host.run("notched_bar", 2, steel);
    host.draw("notched_bar_1");
    must_finish(report, "1 rank", alone);
    must_finish(report, "2 ranks", run);
    compare(report, "2 ranks", run, "1 rank", alone);
    add_order(report, "1 rank", alone);
    add_order(report, "2 ranks", run);
    report.remark = text("  %d elements, %d unknowns, %d points, %d Newton and %d linear iterations; seconds:\n",
                         alone.count("elements"), alone.count("unknowns"), alone.count("points"),
                         alone.count("newton_iterations"), alone.count("linear_iterations"));
    report.remark +=
        text("  %5s %9s %9s %9s %9s %14s\n", "ranks", "assembly", "umat", "solve", "total", "processor time");
    for (const Run* r : {&alone, &run})
        report.remark +=
            text("  %5d %9.2f %9.2f %9.2f %9.2f %14.2f\n", r->count("ranks"), r->of_seconds("assembly"),
                 r->of_seconds("umat"), r->of_seconds("solve"), r->of_seconds("total"), r->of_seconds("processor"));
}

void limit_load(const Host& host, Report& report) {
    // Between notches of radius R, a ligament 2a wide, plane strain: logarithmic spirals (Hill), valid for
    // ln(1 + a/R) <= pi/2. In terms of the yield stress of von Mises and the net section.
    const double a = width / 2 - radius, net_section = 2 * a * thickness * yield_stress;
    const double spirals = 2 / std::numbers::sqrt3 * (1 + radius / a) * std::log(1 + a / radius);
    const std::string perfect = material("ISO_PLASTIC-PERFECT", "210000, 0.3, 250, 0");
    std::vector<double> load;
    for (const int divisions : {8, 16, 32}) {
        const Run run = host.run("plane_strain_" + std::to_string(divisions), 2,
                                 perfect + text("[bar]\nplane_strain = true\ndivisions = %d\nlayers = 1\nrefine = 0\n"
                                                "[loading]\nelongation = 0.3\n",
                                                divisions));
        must_finish(report, text("plane strain, %d divisions", divisions), run);
        load.push_back(run.last_force() / net_section);
    }
    const std::string reference = text("slip lines, %.4f", spirals);
    // Divisions of 45 degrees of the notch; the mesh's error is of first order in their size or better.
    report.push_back({text("plane strain, 32 divisions: %.4f", load[2]), reference, relative(load[2], spirals), 0.005,
                      text("8, 16: %.4f, %.4f", load[0], load[1])});
    const double gain = (load[0] - load[1]) / (load[1] - load[2]);
    const double limit = load[2] - (load[1] - load[2]) / (gain - 1);
    report.push_back({text("plane strain, extrapolated: %.4f", limit), reference, relative(limit, spirals), 0.002,
                      text("order %.1f", std::log2(gain))});
    const Run free = host.run("free_faces", 2, perfect + small_mesh + "[loading]\nelongation = 0.3\n");
    must_finish(report, "free faces", free);
    const double factor = free.last_force() / net_section;
    report.push_back({text("free faces: %.4f of the net section", factor), text("bounds 1 and %.4f", spirals),
                      verdict(factor > 1 && factor < spirals), 0, ""});
}

std::string list_of_sizes(const Run& run) {
    std::string list;
    for (const Row& row : run.curve) list += text("%s%.17g", list.empty() ? "" : ", ", row.size);
    return list;
}

void cut_back(const Host& host, Report& report) {
    const std::string bar = steel + small_mesh + "[loading]\nelongation = 0.4\n";
    const std::string card = bar + "first = 1\nlargest = 1\n";
    const Run run = host.run("cut_back", 1, card), two = host.run("cut_back", 2, card);
    must_finish(report, "all of it at once", run);
    report.push_back({"all of it at once: increments cut", "at least one", verdict(run.count("refused_by_newton") > 0),
                      0, text("%d cuts", run.count("refused_by_newton"))});
    double smallest = 1, later = 0;
    for (const Row& row : run.curve) {
        if (row.size < smallest) smallest = row.size, later = 0;
        later = std::max(later, row.size);
    }
    report.push_back({"increments grow again", "the last cut undone", verdict(later > 4 * smallest), 0,
                      text("%.3f to %.3f", smallest, later)});
    const Run given = host.run("same_increments", 1, bar + "increments = [" + list_of_sizes(run) + "]\n");
    compare(report, "after the cuts", run, "same increments, no cuts", given);
    compare(report, "2 ranks", two, "1 rank", run);
}

void smaller_increments(const Host& host, Report& report) {
    // Clay under pressure, pressed far in one increment; the textbook Newton of the model fails near the notch.
    const std::string bar = material("CAM_CLAY-CLAY", "100, 0.02, 0.1, 1.2, 3000, 0, 100, 0, 0, 0, 0, 1, 0, 2",
                                     "initial_stress = [-100, -100, -100, 0, 0, 0]\nwatch = \"esp\"") +
                            small_mesh + "[loading]\nelongation = -5\n";
    const std::string card = bar + "first = 1\n";
    const Run run = host.run("smaller_increments", 2, card), alone = host.run("smaller_increments", 1, card);
    must_finish(report, "clay", run);
    report.push_back({"PNEWDT cuts the increment on all ranks", "at least one",
                      verdict(run.count("refused_by_material") > 0), 0,
                      text("%d cuts, asked by %d of 2", run.count("refused_by_material"), run.count("ranks_asking"))});
    const Run given = host.run("same_increments_clay", 2, bar + "increments = [" + list_of_sizes(run) + "]\n");
    compare(report, "after the cuts", run, "same increments, no cuts", given);
    compare(report, "2 ranks", run, "1 rank", alone);
}

void own_material(const Host& host, Report& report) {
    const std::string card = material("DRUCKER_PRAGER-SOIL", "20000, 0.25, 0, 0.5, 0.2, 10, 1, 1, 500") + small_mesh;
    const Run alone = host.run("own_material", 1, card), run = host.run("own_material", 2, card);
    must_finish(report, "DRUCKER_PRAGER", run);
    report.push_back({"DRUCKER_PRAGER, not associated", "takes GMRES",
                      verdict(run.summary["linear_solver"].value_or(std::string()) == "GMRES"), 0, ""});
    compare(report, "2 ranks", run, "1 rank", alone);
    add_order(report, "2 ranks", run);
}

void bad_constants(const Host& host, Report& report) {
    const auto contains = [](const Run& run, std::initializer_list<const char*> words) {
        return std::all_of(words.begin(), words.end(),
                           [&](const char* word) { return run.log.find(word) != std::string::npos; });
    };
    const int patience = 60, refused = 65;
    const Run bad = host.run("bad_constants", 2, material("ISO_PLASTIC-STEEL", "210000, 0.7, 250, 1, 2000"), patience);
    report.push_back({"NU = 0.7: all ranks end", "status 65, within a minute", verdict(bad.status == refused), 0,
                      text("status %d", bad.status)});
    report.push_back({"NU = 0.7: message", "names material, constant, value",
                      verdict(contains(bad, {"ISO_PLASTIC-STEEL", "NU", "0.7"})), 0, ""});
    // Passed on as it is: the library finds out at its first call and ends the program through XIT.
    const Run few = host.run(
        "few_state_variables", 2,
        material("ISO_PLASTIC-STEEL", "210000, 0.3, 250, 1, 2000", "state_variables = 2") + small_mesh, patience);
    report.push_back({"NSTATV = 2: all ranks end, through XIT", "status 65, within a minute",
                      verdict(few.status == refused), 0, text("status %d", few.status)});
    report.push_back({"NSTATV = 2: message", "names material and NSTATV",
                      verdict(contains(few, {"ISO_PLASTIC-STEEL", "NSTATV"})), 0, ""});
}

struct Case {
    const char *name, *title;
    void (*run)(const Host&, Report&);
};
constexpr Case cases[] = {
    {"uniform_bar", "bar without notch", uniform_bar},
    {"elastic", "notched bar below yield", elastic},
    {"notched_bar", "notched bar of steel, the default", notched_bar},
    {"limit_load", "notched bar without hardening: limit load", limit_load},
    {"cut_back", "no equilibrium: increments that are cut", cut_back},
    {"smaller_increments", "a material that asks for smaller increments", smaller_increments},
    {"own_material", "another material", own_material},
    {"bad_constants", "constants that are refused", bad_constants},
};

std::string formatted(double value) {
    return text(value == std::floor(value) && std::abs(value) < 1000 ? "%.0f" : "%.1e", value);
}

int run(int count, char** words) {
    fs::path program, output = "mpi";
    std::vector<std::string> chosen;
    bool list = false;
    CLI::App app("Runs mpi_bar and compares it with its references");
    app.add_option("--program", program, "mpi_bar")->check(CLI::ExistingFile);
    app.add_option("-o,--output", output, "directory of the results");
    app.add_flag("--list", list, "names the cases");
    app.add_option("case", chosen, "default: all");
    try {
        app.parse(count, words);
    } catch (const CLI::ParseError& error) {
        return app.exit(error);
    }
    for (const Case& c : cases)
        if (list) std::printf("%-20s %s\n", c.name, c.title);
    if (list) return 0;
    for (const std::string& name : chosen)
        if (std::none_of(std::begin(cases), std::end(cases), [&](const Case& c) { return name == c.name; }))
            throw std::runtime_error("no case " + name + "; --list names them");
    if (program.empty()) throw std::runtime_error("--program is needed");
    if (std::system("command -v mpirun >/dev/null") != 0) {
        std::printf("mpirun is not installed\n");
        return skipped;
    }
    fs::create_directories(output);
    const Host host(fs::canonical(program), fs::canonical(output));
    int passed = 0, failed = 0;
    std::string table = text("  %-50s %-32s %9s %9s\n", "", "reference", "deviation", "tolerance");
    for (const Case& c : cases) {
        if (!chosen.empty() && std::find(chosen.begin(), chosen.end(), c.name) == chosen.end()) continue;
        const auto start = std::chrono::steady_clock::now();
        Report report;
        c.run(host, report);
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        table += text("%s (%.0f s)\n", c.title, seconds) + report.remark;
        for (const Check& check : report) {
            table += text("  %-50s %-32s %9s %9s  %s  %s\n", check.what.c_str(), check.reference.c_str(),
                          formatted(check.deviation).c_str(), formatted(check.tolerance).c_str(),
                          check.passed() ? "pass" : "FAIL", check.note.c_str());
            ++(check.passed() ? passed : failed);
        }
    }
    table += text("%d passed, %d failed\n", passed, failed);
    // After the lines of the programs, which are on the other stream.
    std::printf("\n%s", table.c_str());
    std::ofstream(output / (chosen.size() == 1 ? chosen[0] + ".txt" : "table.txt")) << table;
    return failed == 0 ? 0 : 1;
}

}  // namespace

int main(int count, char** words) {
    try {
        return run(count, words);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "mpi_check: %s\n", error.what());
        return 1;
    }
}
