#include "study.hpp"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "campaign.hpp"
#include "figures.hpp"
#include "reference.hpp"
#include "theory.hpp"

namespace mpm {

namespace {

constexpr double crack_energy = 2.0 * bar::W * bar::D * bar::G_f;

// Tolerances. Along the grid the reference is met but for rounding and the sampling of the curves. At an angle points
// soften in an order that hangs on rounding (bifurcations): work within 10 %, the peak before most of that within 2 %.
constexpr double along_tolerance = 0.005, oblique_work = 0.10, oblique_peak = 0.02;

Settings pattern(double h_mm, WeakPattern p) {
    Settings s = setting(h_mm, 0.0);
    s.pattern = p;
    return s;
}
Settings free_normals(double angle) {
    Settings s = setting(10.0, angle);
    s.prescribed_normal = false;
    return s;
}
Settings work_case(const reference::WorkRow& row) {
    Settings s = setting(row.h, row.angle, row.filling);
    s.criterion = row.criterion;
    return s;
}
Settings all_elastic(double h_mm, double angle, Filling filling) {
    Settings s = setting(h_mm, angle, filling);
    s.cracks = false;
    s.end = 2e-5;
    return s;
}

template <class... Values>
std::string text(const char* format, Values... values) {
    char buffer[512];
    std::snprintf(buffer, sizeof buffer, format, values...);
    return buffer;
}

class Report {
  public:
    Report(const Campaign& campaign, const std::filesystem::path& path) : campaign_(campaign), file_(path) {}

    void baseline();
    void loads();
    void angles();
    void free_normal_table();
    void work_table();
    void pattern_table();
    void field_table();
    void elastic_table();
    void findings();
    bool all_inside() const { return outside_ == 0; }
    void close() {
        line(outside_ == 0 ? "\nEvery comparison is inside its tolerance."
                           : text("\n%d comparisons are OUTSIDE their tolerance (marked with !).", outside_));
    }
    void line(const std::string& s) {
        std::puts(s.c_str());
        file_ << s << '\n';
    }

  private:
    // "found (reference)", marked if they differ by more than the tolerance.
    std::string pair(const char* format, double found, double expected, double tolerance) {
        const bool inside = std::abs(found - expected) <= tolerance;
        outside_ += inside ? 0 : 1;
        return text(format, found) + " (" + text(format, expected) + ")" + (inside ? "" : " !");
    }
    std::string work_pair(const Settings& s, double found, double expected) {
        return pair("%.4f", found, expected, (s.angle == 0.0 ? along_tolerance : oblique_work) * expected);
    }
    // To be read, not to be judged.
    static std::string pair(const char* format, double found, double expected) {
        return text(format, found) + " (" + text(format, expected) + ")";
    }
    std::string verdict(bool inside) {
        outside_ += inside ? 0 : 1;
        return inside ? "yes" : "NO !";
    }

    const Campaign& campaign_;
    std::ofstream file_;
    int outside_ = 0;
};

void Report::baseline() {
    line(
        "\n## Bar along the grid against theory\n\nLoads in N; `crack` is one crack of 2 G_f, `discrete` the closed "
        "form of the cell whose two columns of points open.\n");
    line(
        "| elongation, um | crack | discrete, h 10 mm | h 20 mm | h 10 mm | h 5 mm | h 2.5 mm |\n"
        "|---|---|---|---|---|---|---|");
    for (const double d : reference::elongations) {
        const double elongation = 1e-5 * d;
        std::string row = text("| %g | %.0f | %.0f |", 10.0 * d, crack_load(elongation, 2.0 * bar::G_f),
                               discrete_load(elongation, 0.010, 0.005));
        for (const double h : {20.0, 10.0, 5.0, 2.5})
            row += campaign_.has(setting(h, 0.0)) ? text(" %.0f |", campaign_[setting(h, 0.0)].load_at(elongation))
                                                  : " - |";
        line(row);
    }
    std::string row = text("| W_f, J | %.5f | %.5f |", crack_energy, crack_energy);
    for (const double h : {20.0, 10.0, 5.0, 2.5})
        row += campaign_.has(setting(h, 0.0)) ? " " +
                                                    pair("%.5f", campaign_[setting(h, 0.0)].end().work, crack_energy,
                                                         along_tolerance * crack_energy) +
                                                    " |"
                                              : " - |";
    line(row);
}

void Report::loads() {
    line("\n## Loads at an angle\n\nP in N, found (reference), over the elongation in um.\n");
    std::string head = "| h, mm | angle |", rule = "|---|---|";
    for (const double d : reference::elongations) head += text(" %g |", 10.0 * d), rule += "---|";
    line(head + "\n" + rule);
    for (const reference::LoadRow& r : reference::loads()) {
        const Settings s = setting(r.h, r.angle);
        if (!campaign_.has(s)) continue;
        std::string row = text("| %g | %g |", r.h, r.angle);
        for (std::size_t i = 0; i < r.load.size(); ++i)
            row += " " + pair("%.0f", campaign_[s].load_at(1e-5 * reference::elongations[i]), r.load[i]) + " |";
        line(row);
    }
}

void Report::angles() {
    line(
        "\n## Angle of the grid against the pattern of cracks\n\nPrescribed normals; found (reference).\n\n"
        "| h, mm | angle | P_max, N | P at the end, N | W_f, J | E_f, J | failed points | largest u_n/u_0 | band "
        "width, "
        "mm | band tilt |\n|---|---|---|---|---|---|---|---|---|---|");
    for (const reference::AngleRow& r : reference::angles()) {
        const Settings s = setting(r.h, r.angle);
        if (!campaign_.has(s)) continue;
        const Result& found = campaign_[s];
        const Band band = band_of(found.snapshots.back());
        const double peak_tolerance = (r.angle == 0.0 ? along_tolerance : oblique_peak) * r.peak;
        line(text("| %g | %g | ", r.h, r.angle) + pair("%.0f", found.peak, r.peak, peak_tolerance) + " | " +
             pair("%.0f", found.end().loads.mean, r.end) + " | " + work_pair(s, found.end().work, r.work) + " | " +
             work_pair(s, found.end().fracture, r.fracture) + " | " + pair("%.0f", band.failed, r.failed) + " | " +
             pair("%.2f", band.largest, r.opening) + " | " + pair("%.1f", 1e3 * band.width, r.width) + " | " +
             pair("%.1f", band.tilt, r.tilt) + " |");
    }
}

void Report::free_normal_table() {
    line(
        "\n## Normals searched by the model, h 10 mm\n\n| angle | W_f, J | mean normal - angle | standard deviation |\n"
        "|---|---|---|---|");
    for (const reference::FreeRow& r : reference::free_normals()) {
        const Settings s = free_normals(r.angle);
        const Result& found = campaign_[s];
        const Band band = band_of(found.snapshots.back());
        line(text("| %g | ", r.angle) + work_pair(s, found.end().work, r.work) + " | " +
             pair("%.2f", band.normal_mean, r.mean, 2.0) + " | " + pair("%.2f", band.normal_deviation, r.deviation) +
             " |");
    }
}

void Report::work_table() {
    line(
        "\n## What does not cure it: Rankine's criterion, uniform points\n\n| h, mm | angle | points | criterion | "
        "W_f, J "
        "| failed points |\n|---|---|---|---|---|---|");
    for (const reference::WorkRow& r : reference::works()) {
        const Settings s = work_case(r);
        if (!campaign_.has(s)) continue;
        const Result& found = campaign_[s];
        line(text("| %g | %g | %s | %s | ", r.h, r.angle, r.filling == Filling::uniform ? "uniform" : "rotated",
                  r.criterion == 1 ? "Rankine" : "full") +
             work_pair(s, found.end().work, r.work) + text(" | %d |", band_of(found.snapshots.back()).failed));
    }
}

void Report::pattern_table() {
    line(
        "\n## Weak patterns, bar along the grid\n\n| weak | h, mm | P_max, N | W_f, J | middle of the band, mm |\n"
        "|---|---|---|---|---|");
    const char* const names[] = {"line", "square 20 mm", "one point"};
    for (const reference::PatternRow& r : reference::patterns()) {
        const Settings s = pattern(r.h, r.pattern);
        if (!campaign_.has(s)) continue;
        const Result& found = campaign_[s];
        // Where the crack runs, and so its work, is decided by rounding unless a line of weak points leads it.
        const double tolerance = r.pattern == WeakPattern::line ? along_tolerance : 0.03;
        line(text("| %s | %g | ", names[static_cast<int>(r.pattern)], r.h) +
             pair("%.0f", found.peak, r.peak, along_tolerance * r.peak) + " | " +
             pair("%.4f", found.end().work, r.work, tolerance * r.work) +
             text(" | %.1f |", 1e3 * band_of(found.snapshots.back()).mean));
    }
}

const Snapshot* snapshot_at(const Result& r, double elongation) {
    for (const Snapshot& s : r.snapshots)
        if (std::abs(s.elongation - elongation) < 0.01 * elongation) return &s;
    return nullptr;
}

void Report::field_table() {
    line(
        "\n## Stress in |x'| < L/4, over tau_nf\n\n| h, mm | angle | points | elongation, um | mean s_nn | its "
        "standard "
        "deviation | least | largest | largest abs s_nt | largest abs s_tt "
        "|\n|---|---|---|---|---|---|---|---|---|---|");
    for (const reference::FieldRow& r : reference::fields()) {
        const Settings s = setting(r.h, r.angle, r.filling);
        if (!campaign_.has(s)) continue;
        const Snapshot* const snapshot = snapshot_at(campaign_[s], 1e-5 * r.elongation);
        if (snapshot == nullptr) continue;
        const Field f = field_of(*snapshot);
        line(text("| %g | %g | %s | %g | ", r.h, r.angle, r.filling == Filling::uniform ? "uniform" : "rotated",
                  10.0 * r.elongation) +
             pair("%.3f", f.mean, r.mean, r.elongation < 2.0 ? 0.005 : 0.03) + " | " +
             pair("%.3f", f.deviation, r.deviation) + " | " + pair("%.2f", f.least, r.least) + " | " +
             pair("%.2f", f.most, r.most) + " | " + pair("%.3f", f.largest_nt, r.nt) + " | " +
             pair("%.3f", f.largest_tt, r.tt) + " |");
    }
}

void Report::elastic_table() {
    line(
        "\n## All points elastic: P/(W D E* elongation/L) - 1 in percent\n\n| angle | points | h 20 mm | h 10 mm | "
        "h 5 mm |\n|---|---|---|---|---|");
    for (const reference::ExcessRow& r : reference::excesses()) {
        std::string row = text("| %g | %s |", r.angle, r.filling == Filling::uniform ? "uniform" : "rotated");
        const double digits = r.angle == 0.0 ? 0.002 : r.filling == Filling::uniform ? 0.06 : 0.02;
        std::size_t i = 0;
        for (const double h : {20.0, 10.0, 5.0}) {
            const Settings s = all_elastic(h, r.angle, r.filling);
            const double expected = r.percent[i++];
            row += campaign_.has(s)
                       ? " " + pair("%.3f", 100.0 * campaign_[s].stiffness_excess(), expected, digits) + " |"
                       : " - |";
        }
        line(row);
    }
    line(
        "\nTable 5.2 of the dissertation has the slope of the error over 1/h in logarithms: -1.44, -0.95, -0.86, -0.90 "
        "at 0, 15, 30, 45 degrees. With ends that cannot contract the bar is stiffer than W D E*/L by 0.4 % on any "
        "grid, so the error does not go to zero; at an angle the effective length (which nodes the rigid points seize) "
        "scatters by a cell.");
    const Settings finest = all_elastic(2.5, 0.0, Filling::rotated);
    double excess[4] = {};
    std::size_t count = 0;
    for (const double h : {20.0, 10.0, 5.0, 2.5})
        if (const Settings s = all_elastic(h, 0.0, Filling::rotated); campaign_.has(s))
            excess[count++] = campaign_[s].stiffness_excess();
    const double first = std::log2((excess[0] - excess[1]) / (excess[1] - excess[2]));
    line(text("Against its own limit the bar along the grid converges with slope -%.2f (from h 20, 10, 5 mm)", first) +
         (campaign_.has(finest)
              ? text(" and -%.2f (10, 5, 2.5 mm).", std::log2((excess[1] - excess[2]) / (excess[2] - excess[3])))
              : "."));
}

// What the dissertation says of figures of which only the captions are left.
void Report::findings() {
    line("\n## What the dissertation found\n\n| finding | here | agrees |\n|---|---|---|");
    const auto finding = [&](const char* what, const std::string& here, bool agrees) {
        line(std::string("| ") + what + " | " + here + " | " + verdict(agrees) + " |");
    };
    const double h = campaign_.has(setting(2.5, 45.0)) ? 2.5 : 5.0;
    const Result &along = campaign_[setting(h, 0.0)], &across = campaign_[setting(h, 45.0)];
    const Result& coarser = campaign_[setting(2.0 * h, 45.0)];
    const std::string grid = text(" (h %g mm)", h);
    const double ratio = along.end().work / crack_energy;
    finding("baseline: W_f ends at the crack's energy (5.12, 5.15, 5.21)", text("%.4f of 2 W D G_f", ratio) + grid,
            std::abs(ratio - 1.0) < along_tolerance);
    finding("45 degrees: no point fails completely (5.24)",
            text("%d failed, u_n/u_0 at most %.2f", band_of(across.snapshots.back()).failed,
                 band_of(across.snapshots.back()).largest) +
                grid,
            band_of(across.snapshots.back()).failed == 0);
    const auto at = [](const Result& r, double elongation) -> const Sample& {
        for (const Sample& s : r.history)
            if (s.loads.elongation >= elongation) return s;
        return r.history.back();
    };
    const Sample &early = at(across, 4e-5), &late = across.end();
    finding("45 degrees: U stays constant after the peak (5.22)",
            text("%.4f J at 40 um, %.4f J at the end", early.strain, late.strain) + grid,
            std::abs(late.strain / early.strain - 1.0) < 0.1);
    finding("45 degrees: E_f keeps growing (5.22)", text("%.3f J, %.3f J", early.fracture, late.fracture) + grid,
            late.fracture > 2.0 * early.fracture);
    finding("45 degrees: refinement does not help",
            text("W_f %.4f J at h %g mm, %.4f J at half", coarser.end().work, 2.0 * h, across.end().work),
            across.end().work > coarser.end().work);
    const Snapshot* const soft = snapshot_at(across, 1e-4);
    const double nt = soft != nullptr ? field_of(*soft).largest_nt : 0.0;
    finding("45 degrees: s_nt reaches more than twice tau_nf beside the band (5.36)", text("%.2f tau_nf", nt) + grid,
            nt > 1.9);
    const Settings rotated = setting(5.0, 45.0), uniform = setting(5.0, 45.0, Filling::uniform);
    const Field scattered = field_of(*snapshot_at(campaign_[rotated], 1.5e-5)),
                even = field_of(*snapshot_at(campaign_[uniform], 1.5e-5));
    finding("points spread evenly in the cells: elastic stress is uniform (5.41-5.46)",
            text("standard deviation of s_nn %.3f, rotated points %.3f (h 5 mm)", even.deviation, scattered.deviation),
            even.deviation < 0.1 * scattered.deviation);
    finding("... but the bar locks all the same (5.5.3)",
            text("W_f %.3f J, %d failed points (h 5 mm)", campaign_[uniform].end().work,
                 band_of(campaign_[uniform].snapshots.back()).failed),
            campaign_[uniform].end().work > 1.5 * crack_energy);
    if (const Settings s = pattern(2.5, WeakPattern::point); campaign_.has(s)) {
        const double middle = band_of(campaign_[s].snapshots.back()).mean;
        finding("one weak point on a fine grid does not hold the crack (5.16-5.18)",
                text("band at x' = %.0f mm (h 2.5 mm)", 1e3 * middle), std::abs(middle) > 0.02);
    }
}

}  // namespace

bool study(const StudyOptions& options) {
    std::filesystem::create_directories(options.directory);
    Campaign campaign;
    campaign.snapshots_at = {1.5e-5, 5e-5, 1e-4};
    const auto add = [&](const Settings& s) {
        if (s.h >= 0.999 * options.finest) campaign.add(s);
    };
    for (const double h : {20.0, 10.0, 5.0, 2.5})
        for (const double angle : {0.0, 5.0, 10.0, 15.0, 30.0, 45.0}) add(setting(h, angle));
    for (const reference::FreeRow& r : reference::free_normals()) add(free_normals(r.angle));
    for (const reference::WorkRow& r : reference::works()) add(work_case(r));
    for (const reference::PatternRow& r : reference::patterns()) add(pattern(r.h, r.pattern));
    for (const reference::ExcessRow& r : reference::excesses())
        for (const double h : {20.0, 10.0, 5.0}) add(all_elastic(h, r.angle, r.filling));
    add(all_elastic(2.5, 0.0, Filling::rotated));
    campaign.run(options.at_a_time);

    Report report(campaign, options.directory / "tables.md");
    report.line("# Decohesive bar in tension, explicit material-point method");
    report.baseline();
    report.loads();
    report.angles();
    report.free_normal_table();
    report.work_table();
    report.pattern_table();
    report.field_table();
    report.elastic_table();
    report.findings();
    report.close();
    std::printf("%.0f s\n", campaign.seconds());
    if (!draw_figures(campaign, options.directory))
        std::puts("gnuplot is not installed or failed: the scripts *.gp are there, the pictures are not all");
    return report.all_inside();
}

}  // namespace mpm
