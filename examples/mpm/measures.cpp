#include "measures.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numbers>

#include "theory.hpp"

namespace mpm {

namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr int samples = 1050;  // of the history

// STATEV of ELASTIC_DECOHESIVE, from 1.
enum { W = 2, normal_x = 5, normal_y, jump_x = 8, jump_y, phase = 12 };

// u_0 of points with a share of the full strength.
double opening_at_failure(double share) { return 2.0 * bar::G_f / (share * bar::tau_nf); }

void add_energies(const Solver& solver, Sample& sample) {
    const double V = solver.scene().point_volume, M = solver.particle_mass(), nu = bar::nu;
    double strain = 0.0, fracture = 0.0, kinetic = 0.0, internal = 0.0;
    for (const MaterialBlock& block : solver.blocks())
        for (int i = 0; i < block.count(); ++i) {
            const double x = block.stress(i, 0), y = block.stress(i, 1), z = block.stress(i, 2),
                         xy = block.stress(i, 3);
            strain += x * x + y * y + z * z - 2.0 * nu * (x * y + y * z + z * x) + 2.0 * (1.0 + nu) * xy * xy;
            fracture += block.state(i, W);
            internal += block.internal_energy(i);
        }
    for (const Particle& p : solver.particles()) kinetic += dot(p.velocity, p.velocity);
    sample.strain = strain * V / (2.0 * bar::E);
    sample.fracture = fracture * V;
    sample.kinetic = 0.5 * M * kinetic;
    sample.internal = M * internal;
}

PointState point_state(const Solver& solver, const MaterialBlock& block, int i) {
    const Scene& scene = solver.scene();
    const std::size_t k = static_cast<std::size_t>(block.first_point() + i);
    const PlacedPoint& placed = scene.points[k];
    const Particle& p = solver.particles()[k];
    const Vec n = scene.settings.n(), t = scene.settings.t();
    const auto traction = [&](Vec m) { return Vec{p.s_xx * m.x + p.s_xy * m.y, p.s_xy * m.x + p.s_yy * m.y}; };
    PointState s{placed.local,
                 p.position,
                 placed.group,
                 0.0,
                 dot(n, traction(n)) / bar::tau_nf,
                 dot(t, traction(t)) / bar::tau_nf,
                 dot(t, traction(n)) / bar::tau_nf,
                 0.0,
                 false,
                 false,
                 0.0};
    if (placed.group == elastic || block.state(i, phase) == 0.0) return s;
    const Vec normal{block.state(i, normal_x), block.state(i, normal_y)},
        jump{block.state(i, jump_x), block.state(i, jump_y)};
    s.cracked = true;
    s.failed = block.state(i, phase) >= 2.0;
    const double u_n = dot(jump, normal);
    s.opening = u_n / opening_at_failure(1.0);
    s.normal = std::remainder(std::atan2(normal.y, normal.x) / degree - scene.settings.angle, 180.0);
    const double open = std::min(u_n / opening_at_failure(placed.group == weak ? bar::weakness : 1.0), 1.0);
    s.fracture_by_hand = 2.0 * bar::G_f * open * (1.0 - 0.5 * open);
    return s;
}

Snapshot take(const Solver& solver, double elongation) {
    Snapshot snapshot{elongation, {}, {}};
    for (const MaterialBlock& block : solver.blocks())
        for (int i = 0; i < block.count(); ++i) snapshot.points.push_back(point_state(solver, block, i));
    // Nodes with hardly any mass are thrown about.
    const double h = solver.scene().grid.h, least_mass = 0.1 * bar::rho * bar::D * h * h;
    for (int i = 0; i < solver.scene().grid.nodes(); ++i)
        if (const Node& node = solver.nodes()[static_cast<std::size_t>(i)]; node.mass > least_mass)
            snapshot.nodes.push_back({solver.scene().grid.node(i), node.velocity_star});
    return snapshot;
}

}  // namespace

Band band_of(const Snapshot& snapshot) {
    Band band;
    double sum = 0.0, x = 0.0, y = 0.0, xx = 0.0, yy = 0.0, xy = 0.0, angle = 0.0, angle2 = 0.0;
    for (const PointState& p : snapshot.points) {
        if (!p.cracked) continue;
        ++band.cracked;
        if (p.failed) {
            band.failed_from = band.failed == 0 ? p.local.x : std::min(band.failed_from, p.local.x);
            band.failed_to = band.failed == 0 ? p.local.x : std::max(band.failed_to, p.local.x);
            ++band.failed;
        }
        const double w = p.opening;
        band.largest = std::max(band.largest, w);
        sum += w;
        x += w * p.local.x;
        y += w * p.local.y;
        xx += w * p.local.x * p.local.x;
        yy += w * p.local.y * p.local.y;
        xy += w * p.local.x * p.local.y;
        angle += w * p.normal;
        angle2 += w * p.normal * p.normal;
    }
    if (sum <= 0.0) return band;
    const double mean_y = y / sum;
    band.mean = x / sum;
    const double var_x = std::max(0.0, xx / sum - band.mean * band.mean), var_y = yy / sum - mean_y * mean_y,
                 cov = xy / sum - band.mean * mean_y;
    band.width = std::sqrt(12.0 * var_x);
    band.tilt = 0.5 * std::atan2(2.0 * cov, var_y - var_x) / degree;
    band.normal_mean = angle / sum;
    band.normal_deviation = std::sqrt(std::max(0.0, angle2 / sum - band.normal_mean * band.normal_mean));
    return band;
}

Field field_of(const Snapshot& snapshot) {
    Field field;
    double sum = 0.0, sum2 = 0.0;
    int count = 0;
    for (const PointState& p : snapshot.points) {
        if (std::abs(p.local.x) >= 0.25 * bar::L) continue;
        field.least = count == 0 ? p.s_nn : std::min(field.least, p.s_nn);
        field.most = count == 0 ? p.s_nn : std::max(field.most, p.s_nn);
        field.largest_nt = std::max(field.largest_nt, std::abs(p.s_nt));
        field.largest_tt = std::max(field.largest_tt, std::abs(p.s_tt));
        sum += p.s_nn;
        sum2 += p.s_nn * p.s_nn;
        ++count;
    }
    field.mean = sum / count;
    field.deviation = std::sqrt(std::max(0.0, sum2 / count - field.mean * field.mean));
    return field;
}

double Result::load_at(double elongation) const {
    const auto after = std::lower_bound(history.begin(), history.end(), elongation,
                                        [](const Sample& s, double d) { return s.loads.elongation < d; });
    if (after == history.end()) return history.back().loads.mean;
    if (after == history.begin()) return after->loads.mean;
    const Loads &a = (after - 1)->loads, &b = after->loads;
    return a.mean + (b.mean - a.mean) * (elongation - a.elongation) / (b.elongation - a.elongation);
}

double Result::stiffness_excess() const {
    double sum = 0.0;
    int count = 0;
    for (const Sample& s : history)
        if (s.loads.elongation >= 1e-5 && s.loads.elongation <= 2e-5) {
            sum += s.loads.mean / (elastic_stiffness * s.loads.elongation) - 1.0;
            ++count;
        }
    return count > 0 ? sum / count : 0.0;
}

double Result::imbalance() const {
    const Sample& s = end();
    return std::abs(s.work - (s.internal + s.kinetic - history.front().kinetic)) / s.work;
}

Result simulate(const Settings& settings, const std::vector<double>& snapshots_at,
                const std::function<void(double)>& progress) {
    const auto start = std::chrono::steady_clock::now();
    const Scene scene(settings);
    Solver solver(scene);
    Result result;
    result.settings = settings;
    result.points = static_cast<int>(scene.points.size());
    result.probe_error = solver.probe_error();

    const int steps = settings.steps(), every = std::max(1, steps / samples);
    std::size_t next_snapshot = 0;
    double work = 0.0;
    Loads now{}, before{};
    bool wants_snapshot = false;
    solver.at_step = [&](int step, const Loads& loads) {
        before = now;
        now = loads;
        work += 0.5 * (before.mean + now.mean) * (now.elongation - before.elongation);
        if (now.mean > result.peak) result.peak = now.mean, result.peak_at = now.elongation;
        const auto [least, most] = std::minmax_element(now.stations.begin(), now.stations.end());
        result.station_scatter = std::max(result.station_scatter, *most - *least);
        wants_snapshot = step == steps || (next_snapshot < snapshots_at.size() &&
                                           now.elongation >= snapshots_at[next_snapshot] * (1.0 - 1e-9));
        return wants_snapshot || step % every == 0;
    };
    solver.sampled = [&] {
        Sample sample{now, work, 0.0, 0.0, 0.0, 0.0};
        add_energies(solver, sample);
        result.history.push_back(sample);
        if (wants_snapshot) {
            result.snapshots.push_back(take(solver, now.elongation));
            ++next_snapshot;
        }
        if (progress) progress(now.elongation / settings.end);
    };
    solver.run();

    for (const PointState& p : result.snapshots.back().points)
        result.work_by_opening += scene.point_volume / (settings.L_c_over_h * settings.h) * p.fracture_by_hand;
    for (const MaterialBlock& block : solver.blocks())
        for (int i = 0; i < block.count(); ++i)
            result.host_dissipation += solver.particle_mass() * block.inelastic_energy(i);
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

void write_history(const Result& result, const std::string& path) {
    std::ofstream file(path);
    file.precision(9);
    file << "elongation,P_left,P_middle,P_right,P,P_end,work,fracture,strain,kinetic,internal,theory,discrete\n";
    const Settings& s = result.settings;
    for (const Sample& sample : result.history) {
        const Loads& l = sample.loads;
        for (const double x :
             {l.elongation, l.stations[0], l.stations[1], l.stations[2], l.mean, l.end, sample.work, sample.fracture,
              sample.strain, sample.kinetic, sample.internal, crack_load(l.elongation, 2.0 * bar::G_f)})
            file << x << ',';
        file << discrete_load(l.elongation, s.h, s.L_c_over_h * s.h) << '\n';
    }
}

void write_points(const Snapshot& snapshot, const std::string& path) {
    std::ofstream file(path);
    file.precision(7);
    file << "along,across,x,y,group,opening,s_nn,s_tt,s_nt,normal\n";
    for (const PointState& p : snapshot.points)
        file << p.local.x << ',' << p.local.y << ',' << p.position.x << ',' << p.position.y << ',' << p.group << ','
             << p.opening << ',' << p.s_nn << ',' << p.s_tt << ',' << p.s_nt << ',' << p.normal << '\n';
}

}  // namespace mpm
