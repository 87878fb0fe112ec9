// Runs a model's kernel on dual numbers (included after the model's header).
#pragma once

#include "dual.hpp"
#include "lode/material/point.hpp"
#include "lode/material/properties.hpp"
#include "property_ad.hpp"

namespace lode::test {

// The derivatives of `update(increment, point)`, which is given numbers that carry them.
template <AnalysisKind kind, class Update>
Differentiated differentiate_update(const UmatPoint& at, const Load& load, const Update& update) {
    constexpr int n = components(kind);
    using Real = Dual<n + 1>;  // the strain components, then temperature
    const auto constants = [](const auto& values) { return std::vector<Real>(std::begin(values), std::end(values)); };
    const auto index = [](int i) { return static_cast<std::size_t>(i); };

    Increment<kind, Real> increment;
    Point<kind, Real> point;
    const Numbers dstran = load.dstran.empty() ? Numbers(n, 0.0) : load.dstran;
    const bool turn = !is_cohesive(kind) && kind != AnalysisKind::uniaxial;
    const Numbers stress = turn ? rotated_stress(at.stress(), kind, load.drot) : at.stress();
    for (int i = 0; i < n; ++i) {
        increment.strain_increment[i] = Real::variable(dstran[index(i)], i);
        point.stress[i] = Real(stress[index(i)]);
    }
    increment.time_increment = load.dtime;
    increment.time_end = at.total_time() + load.dtime;
    const Real temperature(at.temperature()), temperature_change = Real::variable(load.dtemp, n);
    increment.temperature_source[0] = &temperature;
    increment.temperature_source[1] = &temperature_change;
    Numbers dpred = load.dpred;
    dpred.resize(at.fields().size());
    const std::vector<Real> fields = constants(at.fields()), field_changes = constants(dpred);
    increment.field_source[0] = fields.data();
    increment.field_source[1] = field_changes.data();
    const Real celent(at.celent());
    increment.element_length_source = &celent;
    increment.rotation_source = load.drot.data();

    // (I + D) F
    const Matrix3d f = load.dfgrd1.value_or(at.deformation_gradient());
    Real deformation[9];
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) deformation[i + 3 * j] = Real(f(i, j));
    if constexpr (!is_cohesive(kind))
        for (int c = 0; c < n; ++c) {
            Numbers unit(n, 0.0);
            unit[index(c)] = 1.0;
            const Matrix3d df = strain_tensor(unit, kind) * f;
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) deformation[i + 3 * j].derivative[index(c)] = df(i, j);
        }
    increment.deformation_source = deformation;
    std::vector<Real> state = constants(at.state());
    point.state = State<Real>(state.data(), state.data(), 1, static_cast<int>(state.size()));

    update(increment, point);

    Differentiated result;
    result.done = point.failure == nullptr;
    result.stress_by_strain.resize(n, n);
    result.stress_by_temperature.resize(n);
    result.state_by_strain.resize(static_cast<Eigen::Index>(state.size()), n);
    result.state_by_temperature.resize(static_cast<Eigen::Index>(state.size()));
    for (int i = 0; i < n; ++i) {
        result.stress.push_back(point.stress[i].value);
        for (int j = 0; j < n; ++j) result.stress_by_strain(i, j) = point.stress[i](j);
        result.stress_by_temperature(i) = point.stress[i](n);
    }
    for (std::size_t i = 0; i < state.size(); ++i) {
        result.state.push_back(state[i].value);
        for (int j = 0; j < n; ++j) result.state_by_strain(static_cast<Eigen::Index>(i), j) = state[i](j);
        result.state_by_temperature(static_cast<Eigen::Index>(i)) = state[i](n);
    }
    return result;
}

template <class Model, AnalysisKind kind>
Differentiated differentiate(const UmatPoint& at, const Load& load) {
    const Model model(
        Properties(Model::description, at.name(), at.props().data(), static_cast<int>(at.props().size())));
    return differentiate_update<kind>(
        at, load, [&]<class Real>(const Increment<kind, Real>& increment, Point<kind, Real>& point) {
            NoTangent none;
            model.template update<kind, Real>(increment, point, none);
        });
}

template <class Model, int k>
constexpr DifferentiateFunction differentiate_if_served() {
    if constexpr (serves(Model::description, static_cast<AnalysisKind>(k)))
        return &differentiate<Model, static_cast<AnalysisKind>(k)>;
    else return nullptr;
}

template <class Model>
constexpr DifferentiatedModel differentiated_model() {
    return {Model::description.keyword,
            {differentiate_if_served<Model, 0>(), differentiate_if_served<Model, 1>(),
             differentiate_if_served<Model, 2>(), differentiate_if_served<Model, 3>(),
             differentiate_if_served<Model, 4>(), differentiate_if_served<Model, 5>()}};
}

}  // namespace lode::test
