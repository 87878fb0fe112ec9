#include "columns.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "../text.hpp"

namespace lode::host {
namespace {

double mises(const Matrix3& stress) {
    const Matrix3 deviator = stress - stress.trace() / 3 * Matrix3::Identity();
    return std::sqrt(1.5) * deviator.norm();
}

double principal(const Matrix3& tensor, int i) {
    return Eigen::SelfAdjointEigenSolver<Matrix3>(tensor, Eigen::EigenvaluesOnly).eigenvalues()[i];
}

// Characters that gnuplot's enhanced text takes for commands.
std::string plain(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '_' || c == '^' || c == '@' || c == '&' || c == '~' || c == '{' || c == '}') result += "\\\\";
        result += c;
    }
    return result;
}

std::string quotient(const std::string& a, const std::string& b) { return a.empty() || b.empty() ? "" : a + "/" + b; }

}  // namespace

void ColumnSet::add(std::string name, std::string quantity, std::string label, std::string unit,
                    std::function<double(const Record&)> value, bool is_default) {
    if (is_default) default_names_.push_back(name);
    columns_.push_back({std::move(name), std::move(quantity), std::move(label), std::move(unit), std::move(value)});
}

ColumnSet::ColumnSet(const Scenario& scenario, const Library& library) {
    const Layout layout(scenario.analysis.kind);
    const OutputSpec& output = scenario.output;
    const std::string &stress = output.stress_unit, &length = output.length_unit, &time = output.time_unit;
    const bool solid = !layout.cohesive();
    constexpr bool by_default = true;

    add(
        "time", "", "time", time, [](const Record& r) { return r.point.total_time; }, by_default);
    add(
        "step", "", "step", "", [](const Record& r) { return r.step; }, by_default);
    add(
        "increment", "", "increment", "", [](const Record& r) { return r.increment; }, by_default);
    add("step_time", "", "time in the step", time, [](const Record& r) { return r.point.step_time; });
    add("dtime", "", "time increment", time, [](const Record& r) { return r.dtime; });

    const std::string strain_quantity = solid ? "strain" : "separation",
                      stress_quantity = solid ? "stress" : "traction";
    for (int i = 0; i < layout.size(); ++i) {
        const std::string name(layout.name(i));
        const std::string symbol = solid ? (i < layout.ndi() ? "ε" : "γ") : "u";
        add(
            std::string(layout.strain_prefix()) + name, strain_quantity, fmt::format("{}_{{{}}}", symbol, name),
            solid ? "" : length, [i](const Record& r) { return r.point.strain[i]; }, by_default);
    }
    if (layout.kind() == Kind::plane_stress && scenario.analysis.entry == Entry::vumat)
        add(
            "strain33", "strain", "ε_{33}", "", [](const Record& r) { return r.point.thickness_strain; }, by_default);
    for (int i = 0; i < layout.size(); ++i) {
        const std::string name(layout.name(i));
        const std::string symbol = solid ? (i < layout.ndi() ? "σ" : "τ") : "t";
        add(
            std::string(layout.stress_prefix()) + name, stress_quantity, fmt::format("{}_{{{}}}", symbol, name), stress,
            [i](const Record& r) { return r.point.stress[i]; }, by_default);
    }

    const lode_model* const model = library.model_of(scenario.material.name);
    for (int i = 0; i < scenario.material.state_variables.value_or(0); ++i) {
        const auto value = [i](const Record& r) { return r.point.state[static_cast<std::size_t>(i)]; };
        const bool named = model != nullptr && i < model->state_count;
        const std::string label = named ? plain(model->state[i].name) : fmt::format("{}", i + 1);
        add(fmt::format("state{}", i + 1), "state", label, "", value, by_default);
        if (named) add(model->state[i].name, "state", label, "", value);
    }

    const auto energy = [&](const char* name, const char* label, std::function<double(const Record&)> value,
                            bool shown) { add(name, "energy density", label, stress, std::move(value), shown); };
    energy(
        "SSE", "elastic", [](const Record& r) { return r.point.energies.elastic; }, by_default);
    energy(
        "SPD", "plastic", [](const Record& r) { return r.point.energies.plastic; }, by_default);
    energy(
        "SCD", "creep", [](const Record& r) { return r.point.energies.creep; }, by_default);
    energy(
        "work", "stress work", [](const Record& r) { return r.point.work; }, false);
    add("heat", "", "heat generation", quotient(stress, time),
        [](const Record& r) { return r.response != nullptr ? r.response->heat : 0; });
    add("temperature", "", "temperature", "", [](const Record& r) { return r.point.temperature; });
    for (std::size_t i = 0; i < scenario.analysis.fields.size(); ++i)
        add(fmt::format("field{}", i + 1), "field", fmt::format("{}", i + 1), "",
            [i](const Record& r) { return r.point.fields[i]; });
    add("iterations", "", "Newton corrections", "", [](const Record& r) { return r.iterations; });
    add("pnewdt", "", "PNEWDT", "", [](const Record& r) { return r.response != nullptr ? r.response->pnewdt : 1; });

    if (solid) {
        const auto stress_tensor = [layout](const Record& r) { return layout.stress_tensor(r.point.stress); };
        add("mises", "stress", "Mises", stress, [=](const Record& r) { return mises(stress_tensor(r)); });
        add("pressure", "stress", "pressure", stress, [=](const Record& r) { return -stress_tensor(r).trace() / 3; });
        constexpr std::array<const char*, 3> order{"min", "mid", "max"};
        for (int i = 0; i < 3; ++i) {
            const char* const which = order[static_cast<std::size_t>(i)];
            add(fmt::format("stress_{}", which), "stress", fmt::format("σ_{{{}}}", which), stress,
                [=](const Record& r) { return principal(stress_tensor(r), i); });
        }
        add("strain_volume", "strain", "volumetric", "",
            [layout](const Record& r) { return r.point.strain.head(layout.ndi()).sum(); });
        add("J", "", "det F", "", [](const Record& r) { return r.point.F.determinant(); });
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                add(fmt::format("F{}{}", i + 1, j + 1), "deformation gradient", fmt::format("F_{{{}{}}}", i + 1, j + 1),
                    "", [i, j](const Record& r) { return r.point.F(i, j); });
    }
    add_closed_forms(scenario, layout);
    if (scenario.analysis.entry == Entry::umat)
        for (int i = 0; i < layout.size(); ++i)
            for (int j = 0; j < layout.size(); ++j)
                add(fmt::format("ddsdde{}{}", i + 1, j + 1), "tangent", fmt::format("DDSDDE({},{})", i + 1, j + 1),
                    solid ? stress : quotient(stress, length), [i, j](const Record& r) {
                        return r.response != nullptr ? r.response->tangent(i, j)
                                                     : std::numeric_limits<double>::quiet_NaN();
                    });
}

// What an element test has to prescribe; not a number in steps without a closed form.
void ColumnSet::add_closed_forms(const Scenario& scenario, const Layout& layout) {
    std::vector<std::shared_ptr<const ManufacturedSolution>> solutions;
    for (const Step& step : scenario.steps) solutions.push_back(step.solution);
    if (std::none_of(solutions.begin(), solutions.end(), [](const auto& s) { return s != nullptr; })) return;
    const auto exact = [solutions](auto&& quantity) {
        return [solutions, quantity](const Record& r) {
            const auto& solution = solutions[static_cast<std::size_t>(std::max(r.step, 1) - 1)];
            return solution ? quantity(*solution, r.point.step_time) : std::numeric_limits<double>::quiet_NaN();
        };
    };
    const std::string& stress = scenario.output.stress_unit;
    for (int i = 0; i < layout.size(); ++i) {
        const std::string name(layout.name(i));
        const char* const symbol = i < layout.ndi() ? "σ" : "τ";
        add("exact" + name, "stress", fmt::format("{}_{{{}}}, closed form", symbol, name), stress,
            exact([layout, i](const ManufacturedSolution& s, double t) {
                return layout.stress_components(s.stress(t))[i];
            }));
        columns_.back().is_reference = true;
    }
    for (int i = 0; i < 3; ++i) {
        add(fmt::format("body_force{}", i + 1), "body force per mass", fmt::format("b_{{{}}}", i + 1), "",
            exact([i](const ManufacturedSolution& s, double t) { return s.body_force(t)[i]; }));
        for (int face = 0; face < 3; ++face)
            add(fmt::format("traction_{}{}", "xyz"[face], i + 1), "traction",
                fmt::format("T_{{{}{}}}", "xyz"[face], i + 1), stress,
                exact([i, face](const ManufacturedSolution& s, double t) { return s.tractions(t)(i, face); }));
    }
}

Column ColumnSet::find(const Located& request) const {
    for (const Column& column : columns_)
        if (column.name == request.text) return column;
    // Names of state variables are upper case, as in the catalogue.
    for (const Column& column : columns_)
        if (upper(column.name) == upper(request.text)) return column;
    std::vector<std::string> names;
    for (const Column& column : columns_)
        if (!column.name.starts_with("ddsdde")) names.push_back(column.name);
    throw BadDeck(fmt::format("{}: there is no column \"{}\"{}; legal are {} and ddsdde11, ddsdde12, ...",
                              request.location, request.text, did_you_mean(request.text, names), joined(names)));
}

std::vector<Column> ColumnSet::defaults() const {
    std::vector<Column> result;
    for (const auto& name : default_names_) result.push_back(find({name, ""}));
    return result;
}

std::size_t ColumnSet::place(std::vector<Column>& columns, const Column& column) {
    const auto found =
        std::find_if(columns.begin(), columns.end(), [&](const Column& c) { return c.name == column.name; });
    const auto index = static_cast<std::size_t>(found - columns.begin());
    if (found == columns.end()) columns.push_back(column);
    return index;
}

}  // namespace lode::host
