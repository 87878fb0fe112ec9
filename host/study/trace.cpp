#include "trace.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lode::host {
namespace {

constexpr double same_time = 1e-9;  // of the whole time
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

// Shears count twice in stresses, half in engineering strains; entries that are missing on a side do not count.
double norm_squared(const std::array<double, 6>& a, const std::array<double, 6>* b, double shear_weight) {
    double sum = 0;
    for (std::size_t i = 0; i < 6; ++i) {
        const double x = a[i] - (b != nullptr ? (*b)[i] : 0);
        if (!std::isnan(x)) sum += (i < 3 ? 1 : shear_weight) * x * x;
    }
    return sum;
}

double dissipated(const Energies& energies) { return energies.plastic + energies.creep; }

TracePoint trace_point(const Layout& layout, const PointState& state) {
    TracePoint point;
    point.time = state.total_time;
    point.strain.fill(nothing);
    const Layout full(layout.cohesive() ? Kind::cohesive_3d : Kind::solid);
    for (int i = 0; i < layout.size(); ++i) {
        const auto k = static_cast<std::size_t>(*full.find(layout.name(i)));
        point.stress[k] = state.stress[i];
        point.strain[k] = state.strain[i];
    }
    point.energies = state.energies;
    return point;
}

}  // namespace

Trace follow(Scenario scenario, const Library& library) {
    Trace trace;
    try {
        resolve(scenario, library);
        const Layout layout(scenario.analysis.kind);
        trace.outcome = drive(scenario, library,
                              [&](const Record& record) { trace.points.push_back(trace_point(layout, record.point)); });
    } catch (const Refused& refusal) {
        trace.outcome.status = Status::refused;
        trace.outcome.message = refusal.what();
    } catch (const BadDeck& mismatch) {
        trace.outcome.status = Status::bad_deck;
        trace.outcome.message = mismatch.what();
    }
    return trace;
}

double largest_stress(const Trace& trace) {
    double largest = 0;
    for (const TracePoint& p : trace.points) largest = std::max(largest, norm_squared(p.stress, nullptr, 2));
    return std::sqrt(largest);
}

Difference difference(const Trace& trace, const Trace& reference, bool compare_strain) {
    double stress_scale = 0, strain_scale = 0, energy_scale = 0, stress = 0, strain = 0, dissipation = 0;
    for (const TracePoint& p : reference.points) {
        stress_scale = std::max(stress_scale, norm_squared(p.stress, nullptr, 2));
        strain_scale = std::max(strain_scale, norm_squared(p.strain, nullptr, 0.5));
        energy_scale = std::max(energy_scale, std::abs(p.energies.sum()));
    }
    Difference result;
    if (trace.points.empty() || reference.points.empty()) return result;
    const double tolerance = same_time * std::max(reference.points.back().time, 1e-300);
    auto other = reference.points.begin();
    for (const TracePoint& p : trace.points) {
        while (other != reference.points.end() && other->time < p.time - tolerance) ++other;
        if (other == reference.points.end()) break;
        if (other->time > p.time + tolerance) continue;
        ++result.common;
        stress = std::max(stress, norm_squared(p.stress, &other->stress, 2));
        dissipation = std::max(dissipation, std::abs(dissipated(p.energies) - dissipated(other->energies)));
        if (compare_strain) strain = std::max(strain, norm_squared(p.strain, &other->strain, 0.5));
    }
    if (stress_scale > 0) result.stress = std::sqrt(stress / stress_scale);
    if (strain_scale > 0) result.strain = std::sqrt(strain / strain_scale);
    if (energy_scale > 0) result.dissipation = dissipation / energy_scale;
    return result;
}

}  // namespace lode::host
