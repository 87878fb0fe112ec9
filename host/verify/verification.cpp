#include "verification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "../replay/driver.hpp"
#include "../status.hpp"
#include "../study/table.hpp"

namespace lode::host {
namespace {

constexpr double floor_of_scale = 1e-3;  // of the largest stress of the path

// Gauss points and weights on [-1, 1], five: exact to the ninth power of the increment.
constexpr std::array<std::pair<double, double>, 5> gauss{{{0, 128.0 / 225},
                                                          {0.53846931010568309, 0.47862867049936647},
                                                          {-0.53846931010568309, 0.47862867049936647},
                                                          {0.90617984593866399, 0.23692688505618909},
                                                          {-0.90617984593866399, 0.23692688505618909}}};

double work_between(const ManufacturedSolution& solution, double begin, double end) {
    double work = 0;
    const double half = 0.5 * (end - begin), middle = 0.5 * (begin + end);
    for (const auto& [point, weight] : gauss) work += weight * solution.stress_power(middle + half * point);
    return half * work;
}

struct Sample {
    Components exact, found;
    double work, energy;  // per reference volume
};

struct Errors {
    std::vector<double> stress;
    std::optional<double> energy;
    std::string failure;
};

Errors run(Scenario scenario, const Library& library, const Layout& layout) {
    const ManufacturedSolution& solution = *scenario.steps.front().solution;
    std::vector<Sample> samples;
    double time = 0, work = 0;
    const Outcome outcome = drive(scenario, library, [&](const Record& record) {
        if (record.increment == 0) return;
        const PointState& point = record.point;
        if (solution.has_energy()) work += work_between(solution, time, point.step_time);
        time = point.step_time;
        samples.push_back({layout.stress_components(solution.stress(time)), point.stress, work,
                           point.energies.sum() * point.F.determinant()});
    });
    Errors errors;
    errors.stress.assign(static_cast<std::size_t>(layout.size()), 0.0);
    errors.failure = outcome.message;
    double stress_scale = 0, energy_scale = 0, energy_error = 0;
    for (const Sample& s : samples) {
        stress_scale = std::max(stress_scale, s.exact.cwiseAbs().maxCoeff());
        energy_scale = std::max(energy_scale, std::abs(s.work));
    }
    for (const Sample& s : samples) {
        const double scale = solution.order() > 0
                                 ? stress_scale
                                 : std::max(s.exact.cwiseAbs().maxCoeff(), floor_of_scale * stress_scale);
        for (int i = 0; i < layout.size(); ++i) {
            const double error = std::abs(s.found[i] - s.exact[i]);
            double& largest = errors.stress[static_cast<std::size_t>(i)];
            // No stress at all is exact; a NaN is not.
            if (error != 0) largest = std::isnan(error) || scale == 0 ? HUGE_VAL : std::max(largest, error / scale);
        }
        energy_error = std::max(energy_error, std::abs(s.energy - s.work));
    }
    if (solution.has_energy() && energy_scale > 0) errors.energy = energy_error / energy_scale;
    return errors;
}

VerifiedStep verify_step(const Scenario& scenario, int number, Entry entry, const Library& library) {
    Scenario alone = scenario;
    const Step& step = scenario.steps[static_cast<std::size_t>(number) - 1];
    alone.steps.assign(1, step);
    alone.analysis.entry = entry;
    find_solutions(alone);
    const ManufacturedSolution& solution = *alone.steps.front().solution;
    const Layout layout(scenario.analysis.kind);

    const Errors errors = run(alone, library, layout);
    VerifiedStep result{number, step.name, std::string(step.manufactured->name()), entry, {}, {}, errors.failure};
    for (const double error : errors.stress) result.stress.push_back({error, solution.order()});
    if (errors.energy) result.energy = {*errors.energy, solution.energy_order(entry)};
    if (result.passed() || !result.failure.empty()) return result;

    std::get<FixedIncrements>(alone.steps.front().increments).count *= 2;
    const Errors finer = run(alone, library, layout);
    result.failure = finer.failure;
    const auto measure = [](VerifiedStep::Quantity& quantity, double after) {
        if (quantity.error > exact_limit) quantity.order = std::log2(quantity.error / after);
    };
    for (std::size_t i = 0; i < result.stress.size(); ++i) measure(result.stress[i], finer.stress[i]);
    if (result.energy) measure(*result.energy, finer.energy.value_or(HUGE_VAL));
    return result;
}

std::string short_number(double x) { return x == 0 ? "0" : fmt::format("{:.1e}", x); }

// The worst of the quantities in words: "exact", "1.98 (2)".
std::string verdict(const std::vector<VerifiedStep::Quantity>& quantities) {
    const VerifiedStep::Quantity* worst = nullptr;
    for (const auto& q : quantities)
        if (q.error > exact_limit && (worst == nullptr || q.order.value_or(0) < worst->order.value_or(0))) worst = &q;
    if (worst == nullptr) return "exact";
    const std::string found = worst->order ? fmt::format("{:.2f}", *worst->order) : "?";
    return worst->stated_order == 0 ? fmt::format("{} (exact)", found)
                                    : fmt::format("{} ({})", found, worst->stated_order);
}

}  // namespace

bool VerifiedStep::passed() const {
    return failure.empty() && (!energy || energy->passed()) &&
           std::all_of(stress.begin(), stress.end(), [](const Quantity& q) { return q.passed(); });
}

bool Verification::passed() const {
    return std::all_of(steps.begin(), steps.end(), [](const VerifiedStep& s) { return s.passed(); });
}

std::string Verification::text() const {
    std::vector<std::vector<std::string>> rows(1);
    rows.front() = {"step", "motion", "through"};
    for (const auto& name : components) rows.front().push_back(name);
    for (const char* word : {"energy", "stress", "energy", ""}) rows.front().emplace_back(word);
    for (const VerifiedStep& s : steps) {
        std::vector<std::string> row{fmt::format("{}{}{}", s.step, s.name.empty() ? "" : " ", s.name), s.motion,
                                     s.entry == Entry::umat ? "umat_" : "vumat_"};
        for (const auto& quantity : s.stress) row.push_back(short_number(quantity.error));
        row.push_back(s.energy ? short_number(s.energy->error) : "-");
        row.push_back(verdict(s.stress));
        row.push_back(s.energy ? verdict({*s.energy}) : "-");
        row.emplace_back(s.passed() ? "ok" : "WRONG");
        rows.push_back(std::move(row));
    }
    std::string text = fmt::format(
        "closed forms: largest errors, relative to the largest stress of their time; exact: below {:.0e}; orders with "
        "the one stated in brackets\n",
        exact_limit);
    text += aligned(rows, "");
    for (const VerifiedStep& s : steps)
        if (!s.failure.empty()) text += fmt::format("step {} stopped: {}\n", s.step, s.failure);
    return text;
}

void check_verifiable(const Scenario& scenario, const std::string& deck) {
    if (std::none_of(scenario.steps.begin(), scenario.steps.end(), [](const Step& s) { return s.solution != nullptr; }))
        throw BadDeck(deck +
                      ": --verify compares steps with `manufactured = { motion = ... }` with their closed forms, and "
                      "there is none");
    if (scenario.analysis.precision == Precision::single)
        throw BadDeck(deck + ": --verify needs analysis.precision = \"double\": the limits are those of double");
    for (const Step& step : scenario.steps)
        if (step.solution && !std::holds_alternative<FixedIncrements>(step.increments))
            throw BadDeck(step.manufactured->location + ": --verify needs a number of increments, not `automatic`");
}

Verification verify(const Scenario& scenario, const Library& library, std::optional<Entry> only) {
    const Layout layout(scenario.analysis.kind);
    Verification result;
    for (const auto name : layout.names()) result.components.emplace_back(name);
    for (std::size_t i = 0; i < scenario.steps.size(); ++i) {
        if (!scenario.steps[i].solution) continue;
        for (const Entry entry : {Entry::umat, Entry::vumat}) {
            const bool there = entry == Entry::umat ? library.umat() != nullptr : library.vumat() != nullptr;
            if (there && (!only || *only == entry))
                result.steps.push_back(verify_step(scenario, static_cast<int>(i) + 1, entry, library));
        }
    }
    return result;
}

}  // namespace lode::host
