#include "summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lode::host {

Summary::Summary(const Scenario& scenario) : scenario_(scenario), layout_(scenario.analysis.kind) {
    strain_.resize(static_cast<std::size_t>(layout_.size()));
    stress_ = strain_;
}

void Summary::widen(Extremes& extremes, double value, double time, bool first) {
    if (first || value < extremes.least) {
        extremes.least = value;
        extremes.least_time = time;
    }
    if (first || value > extremes.most) {
        extremes.most = value;
        extremes.most_time = time;
    }
    extremes.last = value;
}

void Summary::observe(const Record& record) {
    const PointState& point = record.point;
    for (int i = 0; i < layout_.size(); ++i) {
        const auto k = static_cast<std::size_t>(i);
        widen(strain_[k], point.strain[i], point.total_time, first_);
        widen(stress_[k], point.stress[i], point.total_time, first_);
    }
    if (first_) initial_energy_ = point.energies.sum();
    largest_energy_ = std::max({largest_energy_, std::abs(point.work), std::abs(point.energies.elastic)});
    last_ = point;
    first_ = false;
}

std::string Summary::text(const Outcome& outcome, const Library& library) const {
    std::string out;
    const auto line = [&out](fmt::string_view format, auto&&... arguments) {
        out += fmt::vformat(format, fmt::make_format_args(arguments...));
        out += '\n';
    };
    const Statistics& statistics = outcome.statistics;
    const bool umat = scenario_.analysis.entry == Entry::umat;

    if (!scenario_.title.empty()) line("{}", scenario_.title);
    line("material    {} ({} constants, {} state variables), {}, {}{}", scenario_.material.name,
         scenario_.material.constants.size(), scenario_.material.initial_state.size(), name_of(scenario_.analysis.kind),
         umat ? "UMAT" : "VUMAT", scenario_.analysis.large_rotation.value_or(false) ? ", large rotation" : "");
    line("library     {}{}{}", library.path(), library.version().empty() ? "" : ", version " + library.version(),
         library.instruction_set().empty() ? "" : ", " + library.instruction_set());
    line("increments  {} in {} steps, {} cut-backs, end time {:g}", statistics.increments, scenario_.steps.size(),
         statistics.cut_backs, last_.total_time);
    line("Newton      {} corrections, {:.2f} an increment, {} at most", statistics.iterations,
         statistics.increments > 0 ? static_cast<double>(statistics.iterations) / statistics.increments : 0.0,
         statistics.most_iterations);
    const CallCount& calls = statistics.calls;
    const double points = umat ? 1 : scenario_.analysis.block;
    const double each = calls.calls > 1 ? calls.nanoseconds / static_cast<double>(calls.calls - 1) / points : 0.0;
    line("calls       {} of {}{}, {:.1f} ns {} (the first {:.0f} ns)", calls.calls, umat ? "UMAT" : "VUMAT",
         umat ? "" : fmt::format(" on {} points", scenario_.analysis.block), each, umat ? "each" : "a point",
         calls.first_nanoseconds / points);

    line("");
    line("{:<14}{:>14}{:>14}{:>12}{:>14}{:>12}", "", "end", "minimum", "at time", "maximum", "at time");
    const auto rows = [&](std::string_view prefix, const std::vector<Extremes>& values) {
        for (std::size_t i = 0; i < values.size(); ++i)
            line("{:<14}{:>14.6g}{:>14.6g}{:>12.5g}{:>14.6g}{:>12.5g}",
                 std::string(prefix) + std::string(layout_.name(static_cast<int>(i))), values[i].last, values[i].least,
                 values[i].least_time, values[i].most, values[i].most_time);
    };
    rows(layout_.strain_prefix(), strain_);
    rows(layout_.stress_prefix(), stress_);

    if (!last_.state.empty()) {
        line("");
        line("state at the end");
        const lode_model* const model = library.model_of(scenario_.material.name);
        for (std::size_t i = 0; i < last_.state.size(); ++i) {
            const bool described = model != nullptr && i < static_cast<std::size_t>(model->state_count);
            line("{:>4} {:<10}{:>14.6g}  {}", i + 1, described ? model->state[i].name : "", last_.state[i],
                 described ? model->state[i].meaning : "");
        }
    }

    line("");
    const double volume = last_.F.determinant();
    const Energies& energies = last_.energies;
    line("energies    SSE {:.6g}, SPD {:.6g}, SCD {:.6g}; stress work {:.6g}", energies.elastic, energies.plastic,
         energies.creep, last_.work);
    const double gap = energies.sum() * volume - initial_energy_ - last_.work;
    if (energies.sum() == 0 && largest_energy_ > 0 && last_.work != 0)
        line("balance     this material reports no energies");
    else
        line("balance     SSE + SPD + SCD - work = {:.3g} ({:.3g} of the largest energy)", gap,
             largest_energy_ > 0 ? gap / largest_energy_ : 0.0);

    for (const auto& remark : outcome.remarks) line("remark      {}", remark);
    if (!outcome.message.empty()) line("STOPPED     {}", outcome.message);
    return out;
}

}  // namespace lode::host
