// What is measured on the bar: loads, energies, the pattern of cracks, the field of stress.
#pragma once

#include <vector>

#include "solver.hpp"

namespace mpm {

struct Sample {
    Loads loads;
    double work;      // W_f, of the mean load
    double fracture;  // E_f, dissipated
    double strain;    // U, elastic
    double kinetic;
    double internal;  // stress power, as vumat_ adds it up
    // A point that fails in mixed mode drops its shear traction at once: that energy is neither stored nor dissipated.
    double dropped() const { return internal - fracture - strain; }
};

// A point at some elongation, in the axes of the bar.
struct PointState {
    Vec local, position;
    Group group;
    double opening;           // u_n/u_0, with u_0 of the full strength
    double s_nn, s_tt, s_nt;  // over tau_nf
    double normal;            // angle of the crack's normal to the bar's axis, degrees; 0 without a crack
    bool cracked, failed;
    double fracture_by_hand;  // mode I energy from the opening (5.2.40), per area
};
struct NodeState {
    Vec position, velocity;  // of the grid at this time
};
struct Snapshot {
    double elongation = 0.0;
    std::vector<PointState> points;
    std::vector<NodeState> nodes;
};

// The band of cracks: moments of x' and y' weighted with the opening.
struct Band {
    int cracked = 0, failed = 0;
    double largest = 0.0;                        // u_n/u_0
    double mean = 0.0, width = 0.0, tilt = 0.0;  // of x' in m; degrees
    double normal_mean = 0.0, normal_deviation = 0.0;
    double failed_from = 0.0, failed_to = 0.0;  // x' of failed points
};
Band band_of(const Snapshot& snapshot);

// Stresses of points with |x'| < L/4, over tau_nf.
struct Field {
    double mean = 0.0, deviation = 0.0, least = 0.0, most = 0.0;  // of s_nn
    double largest_nt = 0.0, largest_tt = 0.0;                    // magnitudes
};
Field field_of(const Snapshot& snapshot);

// All there is to say of one run.
struct Result {
    Settings settings;
    int points = 0;
    double probe_error = 0.0, seconds = 0.0;
    std::vector<Sample> history;
    std::vector<Snapshot> snapshots;  // at the elongations asked for, then at the end
    double peak = 0.0, peak_at = 0.0;
    double station_scatter = 0.0;   // largest difference of the three stations' loads
    double work_by_opening = 0.0;   // E_f from the openings (5.2.40)
    double host_dissipation = 0.0;  // E_f from enerInelas

    const Sample& end() const { return history.back(); }
    double load_at(double elongation) const;
    // Mean of P/(W D E* elongation/L) - 1 over the elastic elongations 1 ... 2e-5 m.
    double stiffness_excess() const;
    // |W_f - (E_f + U + dropped + kinetic - initial kinetic)|/W_f at the end.
    double imbalance() const;
};

// Runs the bar. `progress` is told the part done, now and then.
Result simulate(const Settings& settings, const std::vector<double>& snapshots_at,
                const std::function<void(double)>& progress = {});

void write_history(const Result& result, const std::string& path);
void write_points(const Snapshot& snapshot, const std::string& path);

}  // namespace mpm
