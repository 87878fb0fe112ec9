#include "deck_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../status.hpp"
#include "../text.hpp"

namespace lode::host {
namespace {

constexpr std::size_t most_steps = 1'000'000;

// Names of the tables that prescribe, in the kind's own words.
std::string_view control_key(const Layout& layout, Control control) {
    if (layout.cohesive()) return control == Control::strain ? "separation" : "traction";
    return control == Control::strain ? "strain" : "stress";
}

void read_components(TableReader& reader, const Layout& layout, Control control, Step& step) {
    const std::string_view key = control_key(layout, control);
    const auto table = reader.table(key);
    if (!table) return;
    for (const auto& [name, value] : table->named_numbers()) {
        const auto component = layout.find(name);
        if (!component)
            table->refuse(name, fmt::format("{} has no such component; legal are {}", name_of(layout.kind()),
                                            joined(layout.names())));
        if (layout.kind() == Kind::plane_strain && *component == 2)
            table->refuse(name, "plane_strain holds strain 33 at zero; axisymmetric and 3d leave it free");
        auto& slot = step.components[static_cast<std::size_t>(*component)];
        if (slot)
            table->refuse(name, fmt::format("component {} is prescribed twice in this step", layout.name(*component)));
        slot = Prescribed{control, value};
    }
}

void read_gradient(TableReader& reader, const Layout& layout, Step& step) {
    if (const auto rows = reader.rows("deformation_gradient")) {
        const std::size_t n = rows->size();
        const bool planar_kind = layout.nshr() == 1;
        if (!(n == 3 || (n == 2 && planar_kind)) || rows->front().size() != n)
            reader.refuse("deformation_gradient", planar_kind
                                                      ? "expected two rows of two or three rows of three numbers"
                                                      : "expected three rows of three numbers");
        Matrix3 F = Matrix3::Identity();
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < n; ++j)
                F(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = (*rows)[i][j];
        if (!(F.determinant() > 0)) reader.refuse("deformation_gradient", "its determinant has to be positive");
        if (planar_kind && (F(0, 2) != 0 || F(1, 2) != 0 || F(2, 0) != 0 || F(2, 1) != 0))
            reader.refuse("deformation_gradient",
                          fmt::format("{} has no components 13, 23, 31, 32", name_of(layout.kind())));
        if (layout.kind() == Kind::plane_strain && F(2, 2) != 1)
            reader.refuse("deformation_gradient", "component 33 is 1 in plane_strain; axisymmetric leaves it free");
        step.deformation_gradient = F;
    }
    if (auto rotation = reader.table("rotation")) {
        const auto axis = rotation->numbers("axis");
        const auto angle = rotation->number("angle_degrees");
        if (!angle) rotation->refuse("", "angle_degrees is missing");
        Rotation turn;
        turn.angle = *angle * std::numbers::pi / 180;
        if (axis) {
            if (axis->size() != 3) rotation->refuse("axis", "expected three numbers");
            turn.axis = {(*axis)[0], (*axis)[1], (*axis)[2]};
            if (turn.axis.norm() == 0) rotation->refuse("axis", "the axis has no direction");
        }
        if (layout.nshr() == 1 && (turn.axis[0] != 0 || turn.axis[1] != 0))
            rotation->refuse("axis", fmt::format("{} can only turn about axis 3", name_of(layout.kind())));
        rotation->finish();
        step.rotation = turn;
    }
    if (!step.moves_by_gradient()) return;
    const char* const key = step.deformation_gradient ? "deformation_gradient" : "rotation";
    if (layout.cohesive() || layout.kind() == Kind::uniaxial)
        reader.refuse(key, fmt::format("{} has no deformation gradient", name_of(layout.kind())));
    if (std::any_of(step.components.begin(), step.components.end(), [](const auto& c) { return c.has_value(); }))
        reader.refuse(key, "a step is driven either by the deformation gradient or by strain and stress");
}

// What the motion needs, and nothing else.
void read_motion(TableReader& reader, ManufacturedMotion& motion) {
    const auto needed = [&](const char* key, bool wanted, const Limits& limits, double& value) {
        const auto given = reader.number(key, limits);
        if (wanted && !given) reader.refuse(key, fmt::format("{} needs {}", motion.name(), key));
        if (!wanted && given) reader.refuse(key, fmt::format("{} has no {}", motion.name(), key));
        if (given) value = *given;
    };
    needed("stretch", !motion.is_shear(), positive, motion.stretch);
    needed("shear", motion.is_shear(), any_number, motion.shear);
    needed("angular_frequency", motion.is_sinusoidal(), positive, motion.angular_frequency);
    if (motion.motion == Motion::sinusoidal_tension && !(std::abs(motion.stretch - 1) < 1))
        reader.refuse("stretch", "sinusoidal_tension has to stay below 2: F11 = 2 - stretch half a period later");
}

void read_manufactured(TableReader& step_reader, AnalysisSpec& analysis, Step& step) {
    auto table = step_reader.table("manufactured");
    if (!table) return;
    TableReader& reader = *table;
    ManufacturedMotion motion;
    motion.duration = step.time;
    motion.location = step_reader.location("manufactured");
    const auto name = reader.choice("motion", motion_names);
    if (!name) reader.refuse("motion", fmt::format("is missing; legal are {}", joined(motion_names)));
    motion.motion = static_cast<Motion>(*name);
    constexpr std::array<std::string_view, 2> drives{"gradient", "strain"}, causes{"temperature", "field"};
    if (const auto drive = reader.choice("drive", drives)) motion.drive = *drive == 0 ? Drive::gradient : Drive::strain;
    if (const auto cause = reader.choice("residual_by", causes))
        motion.cause = *cause == 0 ? ResidualCause::temperature : ResidualCause::field;
    read_motion(reader, motion);
    motion.residual_stretch = reader.number("residual_stretch", positive).value_or(1);
    if (auto law = reader.text("law")) {
        motion.law = upper(*law);
        motion.law_constants = reader.numbers("law_constants").value_or(std::vector<double>{});
        if (motion.law_constants.empty()) reader.refuse("law_constants", "are missing: the constants of the law");
    }
    reader.finish();
    for (const char* key : {"strain", "stress", "separation", "traction", "deformation_gradient", "rotation",
                            "temperature", "field", "amplitude", "relative"})
        if (step_reader.has(key)) step_reader.refuse(key, "a manufactured step has no other loading");
    if (motion.cause == ResidualCause::field && analysis.fields.empty()) analysis.fields.assign(1, 0.0);
    step.manufactured = std::move(motion);
}

void read_amplitude(TableReader& reader, Step& step) {
    const auto rows = reader.rows("amplitude");
    if (!rows) return;
    if (rows->size() < 2 || rows->front().size() != 2)
        reader.refuse("amplitude", "expected rows [fraction of the step's time, fraction of the way to the target]");
    for (const auto& row : *rows) {
        if (!step.amplitude.empty() && !(row[0] > step.amplitude.back().time))
            reader.refuse("amplitude", "the times have to ascend");
        step.amplitude.push_back({row[0], row[1]});
    }
    if (step.amplitude.front().time != 0 || step.amplitude.front().value != 0)
        reader.refuse("amplitude", "the first row has to be [0, 0]: a step begins where the one before it ended");
    if (step.amplitude.back().time != 1) reader.refuse("amplitude", "the last row has to be at time fraction 1");
}

void read_increments(TableReader& reader, Step& step) {
    const auto count = reader.integer("increments", 1);
    auto automatic = reader.table("automatic");
    if (count && automatic) reader.refuse("automatic", "give either increments (a number, fixed) or automatic");
    if (count) step.increments = FixedIncrements{*count};
    if (!automatic) return;
    AutomaticIncrements control;
    const Limits within{0, step.time, true, "a positive time not longer than the step"};
    control.initial = automatic->number("initial", within).value_or(step.time / 100);
    control.maximum = automatic->number("maximum", within).value_or(step.time / 10);
    control.minimum = automatic->number("minimum", within).value_or(std::min(control.initial, control.maximum) * 1e-6);
    automatic->finish();
    if (control.minimum > control.initial) automatic->refuse("minimum", "is larger than initial");
    if (control.initial > control.maximum) {
        if (automatic->has("initial") && automatic->has("maximum"))
            automatic->refuse("maximum", "is smaller than initial");
        if (automatic->has("maximum")) control.initial = control.maximum;
        else control.maximum = control.initial;
    }
    step.increments = control;
}

class StepReader {
  public:
    StepReader(const Layout& layout, AnalysisSpec& analysis) : layout_(layout), analysis_(analysis) {}

    void read(TableReader& reader, std::vector<Step>& steps) {
        const int repeat = reader.integer("repeat", 1, 1'000'000).value_or(1);
        std::vector<Step> group;
        if (reader.has("step")) {
            reader.text("name");
            for (TableReader& member : reader.tables("step")) read(member, group);
            if (group.empty()) reader.refuse("step", "the group has no steps");
            reader.finish();
        } else {
            group.push_back(read_one(reader));
        }
        if (steps.size() + group.size() * static_cast<std::size_t>(repeat) > most_steps)
            reader.refuse("repeat", fmt::format("that makes more than {} steps", most_steps));
        for (int i = 0; i < repeat; ++i) steps.insert(steps.end(), group.begin(), group.end());
    }

  private:
    Step read_one(TableReader& reader) {
        Step step;
        step.name = reader.text("name").value_or("");
        step.time = reader.number("time", positive).value_or(1);
        read_increments(reader, step);
        read_manufactured(reader, analysis_, step);
        for (const Control control : {Control::strain, Control::stress})
            read_components(reader, layout_, control, step);
        read_gradient(reader, layout_, step);
        read_amplitude(reader, step);
        step.relative = reader.flag("relative").value_or(false);
        if (step.relative && step.moves_by_gradient())
            reader.refuse("relative", "targets of the deformation gradient are always total");
        step.temperature = reader.number("temperature");
        step.fields = reader.numbers("field");
        if (step.fields) {
            if (analysis_.fields.empty()) analysis_.fields.assign(step.fields->size(), 0.0);
            if (step.fields->size() != analysis_.fields.size())
                reader.refuse("field", fmt::format("{} values here, but there are {} field variables",
                                                   step.fields->size(), analysis_.fields.size()));
        }
        if (step.moves_by_gradient() && analysis_.large_rotation == false)
            reader.refuse(step.deformation_gradient ? "deformation_gradient"
                          : step.rotation           ? "rotation"
                                                    : "manufactured",
                          "needs large_rotation = true in [analysis], or no such key");
        reader.finish();
        return step;
    }

    const Layout& layout_;
    AnalysisSpec& analysis_;
};

}  // namespace

std::vector<Step> read_steps(TableReader& deck, const Layout& layout, AnalysisSpec& analysis) {
    std::vector<Step> steps;
    StepReader reader(layout, analysis);
    for (TableReader& table : deck.tables("step")) reader.read(table, steps);
    if (steps.empty()) deck.refuse("", "there is no [[step]]: nothing to replay");
    return steps;
}

}  // namespace lode::host
