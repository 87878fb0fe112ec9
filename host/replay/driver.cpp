#include "driver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kinematics.hpp"
#include "material.hpp"
#include "path.hpp"
#include "solver.hpp"

namespace lode::host {
namespace {

constexpr double default_cut = 0.25;
constexpr double growth = 1.5;
constexpr int easy_iterations = 5;      // an increment with no more corrections is easy
constexpr int easy_increments = 2;      // so many in a row and the increment grows
constexpr double fixed_minimum = 1e-6;  // of a fixed increment, before the run is given up
constexpr double same_time = 1e-9;      // of the step's time

// Times that increments end at: the corners of the path and, with fixed increments, the grid.
std::vector<double> end_points(const Step& step, const std::vector<double>& corners) {
    std::vector<double> times = corners;
    if (const auto* fixed = std::get_if<FixedIncrements>(&step.increments)) {
        for (int i = 1; i < fixed->count; ++i) {
            const double time = step.time * i / fixed->count;
            const bool taken = std::any_of(corners.begin(), corners.end(),
                                           [&](double t) { return std::abs(t - time) <= same_time * step.time; });
            if (!taken) times.push_back(time);
        }
        std::sort(times.begin(), times.end());
    }
    return times;
}

class Run {
  public:
    Run(const Scenario& scenario, Material& material, const Observer& observer)
        : scenario_(scenario),
          layout_(scenario.analysis.kind),
          material_(material),
          observer_(observer),
          solver_(scenario, material),
          point_(initial_point()),
          load_(initial_load(scenario, point_)) {}

    Outcome run() {
        Outcome outcome;
        try {
            probe();
            static const std::string initial = "initial";
            observer_({.step_name = initial, .point = point_});
            for (std::size_t i = 0; i < scenario_.steps.size() && outcome.message.empty(); ++i)
                outcome.message = run_step(scenario_.steps[i], static_cast<int>(i) + 1);
            if (!outcome.message.empty()) outcome.status = Status::not_converged;
        } catch (const Refused& refusal) {
            outcome.status = Status::refused;
            outcome.message = refusal.what();
        }
        outcome.remarks = material_.remarks();
        statistics_.calls = material_.calls();
        outcome.statistics = statistics_;
        return outcome;
    }

  private:
    PointState initial_point() const {
        PointState point;
        point.strain = Components::Zero(layout_.size());
        point.stress = scenario_.material.initial_stress.value_or(Components::Zero(layout_.size()));
        point.state = scenario_.material.initial_state;
        point.temperature = scenario_.analysis.temperature;
        point.fields = scenario_.analysis.fields;
        return point;
    }

    // The body undeformed and as new; time goes on.
    void start_anew() {
        const double time = point_.total_time;
        point_ = initial_point();
        point_.total_time = time;
        load_ = initial_load(scenario_, point_);
    }

    void probe() {
        const Step& first = scenario_.steps.front();
        const auto* fixed = std::get_if<FixedIncrements>(&first.increments);
        const double dtime =
            fixed != nullptr ? first.time / fixed->count : std::get<AutomaticIncrements>(first.increments).initial;
        const Moment moment{1, 0, dtime};
        material_.probe(point_, solver_.increment_for(point_, {}, load_, moment, Components::Zero(layout_.size())));
    }

    // Returns why the step could not be finished, or nothing.
    std::string run_step(const Step& step, int number) {
        if (step.manufactured) start_anew();
        point_.step_time = 0;
        const Path path(step, layout_, point_, load_);
        const LogarithmicFrame frame = logarithmic_frame(layout_, point_);
        const std::vector<double> ends = end_points(step, path.corners());
        const auto* automatic = std::get_if<AutomaticIncrements>(&step.increments);
        const double minimum = automatic != nullptr
                                   ? automatic->minimum
                                   : fixed_minimum * step.time / std::get<FixedIncrements>(step.increments).count;
        const double maximum = automatic != nullptr ? automatic->maximum : step.time;

        double wanted = automatic != nullptr ? automatic->initial : step.time;
        double last_dtime = 0;  // 0: nothing to extrapolate from
        Components last_dstrain;
        int easy = 0, increment = 0;
        const double total_begin = point_.total_time;

        for (std::size_t next = 0; next < ends.size();) {
            const double remaining = ends[next] - point_.step_time;
            double dtime = std::min({wanted, maximum, remaining});
            if (remaining - dtime <= same_time * step.time) dtime = remaining;
            else if (remaining < 2 * dtime) dtime = 0.5 * remaining;  // two equal ones, no sliver at the end
            const bool reaches_end = dtime == remaining;
            const double end_time = reaches_end ? ends[next] : point_.step_time + dtime;

            const Load load = path.at(end_time);
            const Moment moment{number, increment + 1, dtime};
            Solution solution;
            if (last_dtime > 0) {
                const Components guess = last_dstrain * (dtime / last_dtime);
                solution = solver_.solve(point_, frame, load, moment, &guess);
            }
            if (!solution.converged) solution = solver_.solve(point_, frame, load, moment, nullptr);

            if (!solution.converged) {
                ++statistics_.cut_backs;
                easy = 0;
                last_dtime = 0;
                const double factor = solution.cut_factor < 1 ? solution.cut_factor : default_cut;
                wanted = dtime * factor;
                if (wanted < minimum)
                    return fmt::format(
                        "step {} \"{}\", increment {}, time {:.6g}: {}; the next increment {:.3g} would be below the "
                        "smallest allowed, {:.3g}",
                        number, step.name, increment + 1, point_.step_time, solution.failure, wanted, minimum);
                continue;
            }

            accept(solution, load, end_time, total_begin + end_time);
            ++increment;
            last_dtime = dtime;
            last_dstrain = solution.increment.total_dstrain;
            if (reaches_end && is_corner(path, ends[next])) last_dtime = 0;
            if (reaches_end) ++next;
            observer_({number, increment, step.name, dtime, solution.iterations, point_, &solution.response,
                       &solution.residuals});

            easy = solution.iterations <= easy_iterations ? easy + 1 : 0;
            if (solution.response.pnewdt > 1)
                wanted = std::min(maximum, std::max(wanted, dtime * solution.response.pnewdt));
            else if (easy >= easy_increments) wanted = std::min(maximum, std::max(wanted, dtime * growth));
        }
        load_ = path.at(step.time);
        return {};
    }

    static bool is_corner(const Path& path, double time) {
        return std::find(path.corners().begin(), path.corners().end(), time) != path.corners().end();
    }

    void accept(const Solution& solution, const Load& load, double step_time, double total_time) {
        const Increment& increment = solution.increment;
        const Response& response = solution.response;
        Components old_stress = point_.stress;
        if (!increment.rotation.isIdentity(0))
            old_stress = layout_.stress_components(increment.rotation * layout_.stress_tensor(old_stress) *
                                                   increment.rotation.transpose());
        point_.work += 0.5 * (increment.F0.determinant() * old_stress + increment.F1.determinant() * response.stress)
                                 .dot(increment.dstrain);
        if (increment.rotation.isIdentity(0)) {
            point_.strain += increment.total_dstrain;
        } else {
            point_.strain = layout_.strain_components(increment.rotation * layout_.strain_tensor(point_.strain) *
                                                      increment.rotation.transpose()) +
                            increment.total_dstrain;
        }
        // Prescribed strains are met exactly however many increments led to them.
        if (!load.gradient)
            for (int i = 0; i < layout_.size(); ++i)
                if (load.control[static_cast<std::size_t>(i)] == Control::strain) point_.strain[i] = load.value[i];
        point_.stress = response.stress;
        point_.state = response.state;
        point_.energies = response.energies;
        point_.F = increment.F1;
        point_.temperature = load.temperature;
        point_.fields = load.fields;
        point_.thickness_strain += response.thickness_increment;
        point_.step_time = step_time;
        point_.total_time = total_time;

        ++statistics_.increments;
        statistics_.iterations += solution.iterations;
        statistics_.most_iterations = std::max(statistics_.most_iterations, solution.iterations);
    }

    const Scenario& scenario_;
    Layout layout_;
    Material& material_;
    const Observer& observer_;
    Solver solver_;
    PointState point_;
    Load load_;
    Statistics statistics_;
};

}  // namespace

void resolve(Scenario& scenario, const Library& library) {
    MaterialSpec& material = scenario.material;
    AnalysisSpec& analysis = scenario.analysis;
    const Layout layout(analysis.kind);
    const lode_model* model = library.model_of(material.name);

    material.reads_gradient = model != nullptr && (model->traits & LODE_FINITE_STRAIN) != 0;
    const bool gradient_steps =
        std::any_of(scenario.steps.begin(), scenario.steps.end(), [](const Step& s) { return s.moves_by_gradient(); });
    if (!analysis.large_rotation) analysis.large_rotation = gradient_steps || material.reads_gradient;
    if (material.reads_gradient && !*analysis.large_rotation)
        throw BadDeck(analysis.large_rotation_location + ": " + material.name +
                      " takes its stress from the deformation gradient, which a geometrically linear analysis does not "
                      "have: analysis.large_rotation = false is not possible with it");

    if (!material.state_variables)
        material.state_variables =
            library.required_state(material.name, material.constants, layout.ndi(), layout.nshr()).value_or(0);
    const auto count = static_cast<std::size_t>(*material.state_variables);
    material.initial_state.resize(std::max(count, material.initial_state.size()), 0.0);
    material.state_variables = static_cast<int>(material.initial_state.size());
    for (const auto& [name, value] : material.initial_named_state) {
        std::optional<std::size_t> index;
        for (int i = 0; model != nullptr && i < model->state_count; ++i)
            if (name.text == model->state[i].name) index = static_cast<std::size_t>(i);
        if (!index || *index >= material.initial_state.size())
            throw BadDeck(
                fmt::format("{}: \"{}\" is no state variable of {}; `lode models {}` lists them, and indices "
                            "from 1 are always understood",
                            name.location, name.text, material.name, material.name.substr(0, material.name.find('-'))));
        material.initial_state[*index] = value;
    }
    find_solutions(scenario);
}

void find_solutions(Scenario& scenario) {
    const MaterialSpec& material = scenario.material;
    for (Step& step : scenario.steps) {
        if (!step.manufactured) continue;
        if (material.initial_stress || !material.expansion.empty() ||
            std::any_of(material.initial_state.begin(), material.initial_state.end(), [](double x) { return x != 0; }))
            throw BadDeck(step.manufactured->location +
                          ": closed forms are those of a new material without expansion of the host: no "
                          "initial_stress, initial_state, expansion in [material]");
        step.solution = manufactured_solution(material.name, material.constants, *step.manufactured,
                                              scenario.analysis.kind, scenario.analysis.entry);
    }
}

Outcome drive(const Scenario& scenario, const Library& library, const Observer& observer) {
    const auto material = make_material(scenario, library);
    return drive(scenario, *material, observer);
}

Outcome drive(const Scenario& scenario, Material& material, const Observer& observer) {
    return Run(scenario, material, observer).run();
}

}  // namespace lode::host
