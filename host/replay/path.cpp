#include "path.hpp"

#include "kinematics.hpp"

namespace lode::host {

Load initial_load(const Scenario& scenario, const PointState& point) {
    Load load;
    load.control.fill(scenario.analysis.unnamed);
    // Plane strain is what its name says whatever else is left to itself.
    if (scenario.analysis.kind == Kind::plane_strain) load.control[2] = Control::strain;
    load.value = point.stress;
    for (int i = 0; i < load.value.size(); ++i)
        if (load.control[static_cast<std::size_t>(i)] == Control::strain) load.value[i] = point.strain[i];
    load.temperature = point.temperature;
    load.fields = point.fields;
    return load;
}

Path::Path(const Step& step, const Layout& layout, const PointState& start, const Load& previous)
    : step_(step), layout_(layout), begin_(previous), gradient_begin_(start.F), gradient_end_(start.F) {
    for (int i = 0; i < layout.size(); ++i) {
        const auto k = static_cast<std::size_t>(i);
        if (const auto& prescribed = step.components[k]) begin_.control[k] = prescribed->control;
        const bool strain = begin_.control[k] == Control::strain;
        // A stress that is held stays at its target, not at what the tolerance made of it.
        if (strain) begin_.value[i] = start.strain[i];
        else if (previous.control[k] != Control::stress) begin_.value[i] = start.stress[i];
    }
    begin_.gradient.reset();
    begin_.temperature = start.temperature;
    begin_.fields = start.fields;

    end_ = begin_;
    for (int i = 0; i < layout.size(); ++i)
        if (const auto& prescribed = step.components[static_cast<std::size_t>(i)])
            end_.value[i] = step.relative ? begin_.value[i] + prescribed->value : prescribed->value;
    if (step.temperature) end_.temperature = step.relative ? begin_.temperature + *step.temperature : *step.temperature;
    if (step.fields)
        for (std::size_t i = 0; i < step.fields->size(); ++i)
            end_.fields[i] = step.relative ? begin_.fields[i] + (*step.fields)[i] : (*step.fields)[i];
    if (step.deformation_gradient) gradient_end_ = *step.deformation_gradient;

    if (step.manufactured && step.manufactured->motion == Motion::held_shear)
        corners_.push_back(step.manufactured->jump_time());
    for (const AmplitudePoint& point : step.amplitude)
        if (point.time > 0 && point.time < 1) corners_.push_back(point.time * step.time);
    corners_.push_back(step.time);
}

double Path::progress(double time) const {
    const double fraction = time >= step_.time ? 1 : time / step_.time;
    if (step_.amplitude.empty()) return fraction;
    const auto& table = step_.amplitude;
    for (std::size_t i = 1; i < table.size(); ++i) {
        if (fraction > table[i].time) continue;
        if (fraction == table[i].time) return table[i].value;
        const double share = (fraction - table[i - 1].time) / (table[i].time - table[i - 1].time);
        return table[i - 1].value + share * (table[i].value - table[i - 1].value);
    }
    return table.back().value;
}

// Where the closed form is, or its small strain; heat or moisture follow ln(lr), not a straight ramp.
Load Path::manufactured_at(double time) const {
    const ManufacturedSolution& solution = *step_.solution;
    Load load = begin_;
    load.control.fill(Control::strain);
    if (step_.moves_by_gradient()) load.gradient = solution.gradient(time);
    else load.value = layout_.strain_components(solution.small_strain(time));
    const double change = solution.residual_change(time);
    if (solution.motion().cause == ResidualCause::temperature) load.temperature += change;
    else load.fields.front() += change;
    return load;
}

Load Path::at(double time) const {
    if (step_.solution) return manufactured_at(time);
    const double s = progress(time);
    const auto between = [s](double begin, double end) { return s == 1 ? end : begin + s * (end - begin); };
    Load load = begin_;
    for (int i = 0; i < load.value.size(); ++i) load.value[i] = between(begin_.value[i], end_.value[i]);
    load.temperature = between(begin_.temperature, end_.temperature);
    for (std::size_t i = 0; i < load.fields.size(); ++i) load.fields[i] = between(begin_.fields[i], end_.fields[i]);
    if (step_.moves_by_gradient()) {
        Matrix3 gradient = gradient_begin_ + s * (gradient_end_ - gradient_begin_);
        if (s == 1) gradient = gradient_end_;
        if (step_.rotation) gradient = rotation_about(step_.rotation->axis, s * step_.rotation->angle) * gradient;
        load.gradient = gradient;
        load.control.fill(Control::strain);
    }
    return load;
}

}  // namespace lode::host
