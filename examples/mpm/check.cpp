#include "check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "campaign.hpp"
#include "theory.hpp"

namespace mpm {

namespace {

class Table {
  public:
    void within(const std::string& what, double value, double least, double most) {
        const bool inside = value >= least && value <= most;
        all_ = all_ && inside;
        std::printf("%-66s %12.6g   %11.6g ... %-11.6g %s\n", what.c_str(), value, least, most, inside ? "ok" : "NO");
    }
    void near(const std::string& what, double value, double expected, double tolerance) {
        within(what, value, expected - tolerance, expected + tolerance);
    }
    void title(const std::string& text) { std::printf("\n%s\n", text.c_str()); }
    bool all() const { return all_; }

  private:
    bool all_ = true;
};

constexpr double crack_energy = 2.0 * bar::W * bar::D * bar::G_f;  // both columns of a cell open: 2 G_f
constexpr double held_ends = 0.005;  // the ends cannot contract: the bar is stiffer by up to this

// The closed form of the discrete bar, h = 10 mm, against numbers computed independently of this program.
void check_theory(Table& table) {
    table.title("Closed form of the discrete bar, h = 10 mm");
    const double h = 0.010, reference[][2] = {{2.5e-5, 8614.9}, {4e-5, 6779.4}, {6e-5, 4332.1},
                                              {8e-5, 1884.8},   {9e-5, 661.1},  {10e-5, 47.4}};
    const Peak peak = discrete_peak(h, 0.5 * h);
    table.near("peak load, N", peak.load, 9229.41, 0.005);
    table.near("its elongation, um", 1e6 * peak.elongation, 19.978, 0.0005);
    for (const auto& [elongation, load] : reference) {
        char what[64];
        std::snprintf(what, sizeof what, "load at %g um, N", 1e6 * elongation);
        table.near(what, discrete_load(elongation, h, 0.5 * h), load, 0.05);
    }
}

double largest_deviation(const Result& r) {
    double worst = 0.0;
    for (const Sample& s : r.history)
        worst = std::max(worst, std::abs(s.loads.mean - discrete_load(s.loads.elongation, r.settings.h,
                                                                      r.settings.L_c_over_h * r.settings.h)));
    return worst;
}

void check_baseline(Table& table, const Result& r) {
    const Settings& s = r.settings;
    const double h = s.h, peak = discrete_peak(h, 0.5 * h).load;
    table.title("Bar along the grid, " + s.name());
    table.within("probe call against Hooke's law, relative", r.probe_error, 0.0, 1e-14);
    // Either half of the bar is released at half the end's speed: a wave of stress rho c v_L/2.
    const double wave = 0.5 * std::sqrt(bar::rho * bar::E_star) * s.v_L * bar::W * bar::D;
    table.within("largest distance of the load from the closed form, N", largest_deviation(r), 0.0,
                 held_ends * peak + wave);
    table.within("peak load, N", r.peak, 9225.0, 9300.0);
    table.near("load after failure, N", r.end().loads.mean, 0.0, 100.0);
    table.near("work W_f, J", r.end().work, crack_energy, 0.005 * crack_energy);
    table.near("dissipation E_f from STATEV, J", r.end().fracture, crack_energy, 0.005 * crack_energy);
    table.near("the same from the openings, J", r.work_by_opening, crack_energy, 0.005 * crack_energy);
    table.near("the same from enerInelas over STATEV", r.host_dissipation / r.end().fracture, 1.0, 1e-12);
    const Band band = band_of(r.snapshots.back());
    table.near("failed points: two columns of one row of cells", band.failed, 4.0 * bar::W / h, 0.0);
    table.near("the first of them, x'/h", band.failed_from / h, 0.25, 1e-12);
    table.near("the last of them, x'/h", band.failed_to / h, 0.75, 1e-12);
    table.within("largest difference of the three stations, over the peak", r.station_scatter / r.peak, 0.0, 0.02);
    table.within("energy balance, relative", r.imbalance(), 0.0, 0.01);
}

}  // namespace

bool check(int at_a_time) {
    Settings coarse, base, oblique, slanted, wide;
    coarse.h = 0.020;
    oblique.angle = 45.0;
    slanted.angle = 15.0;
    wide.L_c_over_h = 1.0;
    wide.end = 6e-5;
    std::vector<Settings> speeds(3);
    const double speed[] = {0.005, 0.02, 0.05}, speed_peak[] = {9253.0, 9324.0, 9486.0};
    for (std::size_t i = 0; i < 3; ++i) speeds[i].v_L = speed[i];

    Campaign campaign;
    for (const Settings& s : {coarse, base, oblique, slanted, wide}) campaign.add(s);
    for (const Settings& s : speeds) campaign.add(s);
    campaign.run(at_a_time);

    Table table;
    std::printf("%-66s %12s   %27s\n", "", "found", "allowed");
    check_theory(table);
    check_baseline(table, campaign[coarse]);
    check_baseline(table, campaign[base]);
    const double slope = 1.0045 * elastic_stiffness * 1e-5;
    table.near("load at 10 um, N", campaign[base].load_at(1e-5), slope, 0.002 * slope);

    table.title("Smearing length h: the crack spends G_f once");
    table.near("work W_f, J", campaign[wide].end().work, 0.5 * crack_energy, 0.0025 * crack_energy);

    table.title("Speeds of the end");
    for (std::size_t i = 0; i < 3; ++i) {
        const Result& r = campaign[speeds[i]];
        char what[64];
        std::snprintf(what, sizeof what, "%g m/s: peak load, N", speed[i]);
        table.near(what, r.peak, speed_peak[i], 0.001 * speed_peak[i]);
        std::snprintf(what, sizeof what, "%g m/s: work W_f, J", speed[i]);
        table.near(what, r.end().work, crack_energy, 0.001 * crack_energy);
    }

    table.title("Bar at 45 degrees to the grid, h = 10 mm: locking");
    const Result& locked = campaign[oblique];
    table.near("failed points", band_of(locked.snapshots.back()).failed, 0.0, 0.0);
    table.within("load after what should be failure, N", locked.end().loads.mean, 6500.0, 1e9);
    table.within("work W_f, J", locked.end().work, 0.72, 0.87);
    table.within("energy balance, relative", locked.imbalance(), 0.0, 0.01);

    table.title("Bar at 15 degrees");
    table.within("work W_f, J", campaign[slanted].end().work, 0.49, 0.60);
    table.within("energy balance, relative", campaign[slanted].imbalance(), 0.0, 0.01);

    table.title("Three threads, blocks shared out");
    Settings threaded = oblique;
    threaded.threads = 3;
    const Result shared = simulate(threaded, {});
    int different = shared.history.size() == locked.history.size() ? 0 : 1;
    for (std::size_t i = 0; different == 0 && i < shared.history.size(); ++i) {
        const Sample &a = shared.history[i], &b = locked.history[i];
        different += a.loads.mean != b.loads.mean || a.work != b.work || a.fracture != b.fracture ||
                     a.strain != b.strain || a.kinetic != b.kinetic;
    }
    table.near("results that differ in any bit from those of one thread", different, 0.0, 0.0);
    std::printf("\n%s\n", table.all() ? "All inside." : "NOT all inside.");
    return table.all();
}

}  // namespace mpm
