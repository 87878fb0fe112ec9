#include "material_point.hpp"

#include <cmath>

#include "../replay/driver.hpp"

namespace lode::host {
namespace {

constexpr double dissipating = 1e-13;  // of the elastic energy
constexpr int bisections = 200;
constexpr double no_limit = 1e-9;  // of the largest length tried

Scenario resolved(Scenario scenario, const Library& library) {
    resolve(scenario, library);
    return scenario;
}

double norm(const Layout& layout, const Components& values, double shear_weight) {
    double sum = 0;
    for (int i = 0; i < layout.size(); ++i)
        sum += (layout.cohesive() || i < layout.ndi() ? 1 : shear_weight) * values[i] * values[i];
    return std::sqrt(sum);
}

}  // namespace

MaterialPoint::MaterialPoint(const Scenario& scenario, const Library& library)
    : scenario_(resolved(scenario, library)),
      layout_(scenario.analysis.kind),
      material_(make_material(scenario_, library)),
      solver_(scenario_, *material_) {
    state_.strain = Components::Zero(layout_.size());
    state_.stress = scenario_.material.initial_stress.value_or(Components::Zero(layout_.size()));
    state_.state = scenario_.material.initial_state;
    state_.temperature = scenario_.analysis.temperature;
    state_.fields = scenario_.analysis.fields;
    material_->probe(state_, increment_for(Components::Zero(layout_.size()), 1));
}

Increment MaterialPoint::increment_for(const Components& dstrain, double dtime) const {
    Load load;
    load.control.fill(Control::strain);
    load.value = state_.strain + dstrain;
    load.temperature = state_.temperature;
    load.fields = state_.fields;
    return solver_.increment_for(state_, {}, load, Moment{1, number_, dtime}, dstrain);
}

Response MaterialPoint::respond(const Components& dstrain, double dtime) {
    return material_->evaluate(state_, increment_for(dstrain, dtime));
}

bool MaterialPoint::advance(const Components& dstrain, double dtime) {
    const Increment increment = increment_for(dstrain, dtime);
    Response response = material_->evaluate(state_, increment);
    if (response.cut_wanted() || !response.finite()) return false;
    const double before = state_.stress.dot(dstrain), after = response.stress.dot(dstrain);
    state_.work += 0.5 * (before + after);
    state_.strain += dstrain;
    state_.stress = response.stress;
    state_.state = std::move(response.state);
    state_.energies = response.energies;
    state_.F = increment.F1;
    state_.step_time += dtime;
    state_.total_time += dtime;
    ++number_;
    return true;
}

bool MaterialPoint::advance_in(int increments, const Components& dstrain, double dtime) {
    const Components part = dstrain / increments;
    for (int i = 0; i < increments; ++i)
        if (!advance(part, dtime / increments)) return false;
    return true;
}

Tangent MaterialPoint::tangent(double dtime) { return respond(Components::Zero(layout_.size()), dtime).tangent; }

double MaterialPoint::nanoseconds(const Components& dstrain, int calls) {
    const CallCount before = material_->calls();
    material_->repeat_calls(calls);
    respond(dstrain);
    material_->repeat_calls(1);
    const CallCount& after = material_->calls();
    return (after.nanoseconds - before.nanoseconds) / static_cast<double>(after.points - before.points);
}

Components unit_strain(const Layout& layout, int component, double value) {
    Components strain = Components::Zero(layout.size());
    strain[component] = value;
    return strain;
}

double stress_norm(const Layout& layout, const Components& stress) { return norm(layout, stress, 2); }
double strain_norm(const Layout& layout, const Components& strain) { return norm(layout, strain, 0.5); }

std::optional<double> elastic_limit(const Scenario& scenario, const Library& library, const Components& direction,
                                    double largest) {
    MaterialPoint point(scenario, library);
    const auto elastic = [&](double length) {
        const Response response = point.respond(length * direction);
        const Energies& e = response.energies;
        return !response.cut_wanted() && response.finite() && e.plastic + e.creep <= dissipating * std::abs(e.elastic);
    };
    double good = 0, bad = largest * 1e-3;
    while (elastic(bad)) {
        good = bad;
        bad *= 2;
        if (bad > largest) return std::nullopt;
    }
    for (int i = 0; i < bisections && bad - good > 1e-15 * bad; ++i) {
        const double middle = 0.5 * (good + bad);
        (elastic(middle) ? good : bad) = middle;
    }
    // Viscosity dissipates from the first.
    return good > no_limit * largest ? std::optional(good) : std::nullopt;
}

}  // namespace lode::host
