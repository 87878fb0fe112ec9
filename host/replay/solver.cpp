#include "solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinematics.hpp"

namespace lode::host {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double round_off = std::numeric_limits<double>::epsilon();
constexpr int maximum_halvings = 8;
constexpr double sufficient_decrease = 1e-4;

// E of F = exp(E) R at the end of an increment; the thickness of a sheet follows at constant volume.
Matrix3 frame_strain(const Layout& layout, const PointState& start, const LogarithmicFrame& frame,
                     const Components& total_dstrain) {
    Matrix3 strain = layout.strain_tensor(start.strain + total_dstrain) + frame.offset;
    if (layout.kind() == Kind::plane_stress) strain(2, 2) = -(strain(0, 0) + strain(1, 1));
    if (layout.kind() == Kind::uniaxial) strain(1, 1) = strain(2, 2) = -0.5 * strain(0, 0);
    return strain;
}

}  // namespace

struct Solver::Problem {
    const PointState& start;
    const LogarithmicFrame& frame;
    const Load& load;
    const Moment& moment;
    std::vector<int> free;  // stress-controlled components
};

struct Solver::Trial {
    Increment increment;
    Response response;
    Eigen::VectorXd residual;  // of the free components
    double norm = infinity;    // its largest entry; infinite if the material did not answer

    bool answered() const { return norm < infinity; }
};

LogarithmicFrame logarithmic_frame(const Layout& layout, const PointState& point) {
    LogarithmicFrame frame;
    if (layout.cohesive() || point.F.isIdentity(0)) return frame;
    const Polar decomposed = polar(point.F);
    // Round-off of the decomposition must not leak into runs without rotation.
    if (!decomposed.rotation.isIdentity(1e-12)) frame.rotation = decomposed.rotation;
    frame.offset = logarithm(decomposed.left_stretch) - layout.strain_tensor(point.strain);
    if (frame.offset.isZero(1e-13)) frame.offset.setZero();
    return frame;
}

Solver::Solver(const Scenario& scenario, Material& material)
    : layout_(scenario.analysis.kind),
      material_(material),
      large_rotation_(scenario.analysis.large_rotation.value_or(false) && !layout_.cohesive()),
      reads_gradient_(scenario.material.reads_gradient),
      expansion_(scenario.material.expansion),
      reference_temperature_(scenario.analysis.temperature),
      tolerance_(scenario.analysis.tolerance),
      maximum_iterations_(scenario.analysis.maximum_iterations) {}

Increment Solver::increment_for(const PointState& start, const LogarithmicFrame& frame, const Load& load,
                                const Moment& moment, const Components& total_dstrain) const {
    Increment increment;
    increment.step = moment.step;
    increment.number = moment.number;
    increment.step_time = start.step_time;
    increment.total_time = start.total_time;
    increment.dtime = moment.dtime;
    increment.temperature = start.temperature;
    increment.dtemperature = load.temperature - start.temperature;
    increment.fields = start.fields;
    increment.dfields.resize(start.fields.size());
    for (std::size_t i = 0; i < start.fields.size(); ++i) increment.dfields[i] = load.fields[i] - start.fields[i];

    increment.strain = start.strain;
    increment.total_dstrain = total_dstrain;
    if (large_rotation_) {
        increment.F0 = start.F;
        if (load.gradient) {
            increment.F1 = *load.gradient;
            if (layout_.kind() == Kind::plane_stress) {
                // As below, the host does not know the thickness and assumes constant volume.
                increment.F1(2, 2) = 1 / (increment.F1.topLeftCorner<2, 2>().determinant());
            }
            const MotionIncrement motion = motion_increment(increment.F0, increment.F1);
            increment.total_dstrain = layout_.strain_components(motion.strain);
            increment.rotation = motion.rotation;
            increment.spin = motion.spin;
            if (!motion.rotation.isIdentity(0))
                increment.strain = layout_.strain_components(motion.rotation * layout_.strain_tensor(start.strain) *
                                                             motion.rotation.transpose());
        } else {
            increment.F1 = exponential(frame_strain(layout_, start, frame, total_dstrain)) * frame.rotation;
        }
    }

    increment.dstrain = increment.total_dstrain;
    for (int i = 0; i < layout_.ndi() && !expansion_.empty() && !layout_.cohesive(); ++i) {
        const double coefficient = expansion_.size() == 1 ? expansion_[0] : expansion_[static_cast<std::size_t>(i)];
        increment.strain[i] -= coefficient * (start.temperature - reference_temperature_);
        increment.dstrain[i] -= coefficient * increment.dtemperature;
    }
    return increment;
}

Solver::Trial Solver::evaluate(const Problem& problem, const Components& total_dstrain) const {
    Trial trial;
    trial.increment = increment_for(problem.start, problem.frame, problem.load, problem.moment, total_dstrain);
    trial.response = material_.evaluate(problem.start, trial.increment);
    if (trial.response.cut_wanted() || !trial.response.finite()) return trial;
    trial.residual.resize(static_cast<Eigen::Index>(problem.free.size()));
    for (std::size_t i = 0; i < problem.free.size(); ++i) {
        const int component = problem.free[i];
        trial.residual[static_cast<Eigen::Index>(i)] = trial.response.stress[component] - problem.load.value[component];
    }
    trial.norm = problem.free.empty() ? 0 : trial.residual.cwiseAbs().maxCoeff();
    return trial;
}

// DDSDDE, or differences of calls where the interface has none.
Tangent Solver::tangent_at(const Problem& problem, const Trial& trial) const {
    if (material_.has_tangent()) return trial.response.tangent;
    Tangent tangent = Tangent::Zero(layout_.size(), layout_.size());
    const Components& dstrain = trial.increment.total_dstrain;
    // Half of the digits: of the increment if it is not small, else of a strain of 1e-6.
    const double width = std::sqrt(round_off) * std::max(dstrain.cwiseAbs().maxCoeff(), 1e-6);
    for (const int component : problem.free) {
        Components shifted = dstrain;
        shifted[component] += width;
        const Increment increment = increment_for(problem.start, problem.frame, problem.load, problem.moment, shifted);
        const Response response = material_.evaluate(problem.start, increment);
        tangent.col(component) = (response.stress - trial.response.stress) / (shifted[component] - dstrain[component]);
    }
    return tangent;
}

// d stress/d E of a material that reads F = exp(E) R, from DDSDDE = (1/J) d(J sigma) in the Jaumann sense:
// d sigma = DDSDDE D - sigma tr D + W sigma - sigma W, with D and W the parts of dF F^-1.
Tangent Solver::strain_tangent(const Problem& problem, const Trial& trial, const Tangent& tangent) const {
    const Matrix3 strain = frame_strain(layout_, problem.start, problem.frame, trial.increment.total_dstrain);
    const Matrix3 stress = layout_.stress_tensor(trial.response.stress);
    const Matrix3 inverse_stretch = exponential(-strain);
    Tangent result = tangent;
    for (const int component : problem.free) {
        const Components direction = Components::Unit(layout_.size(), component);
        const Matrix3 gradient = exponential_derivative(strain, layout_.strain_tensor(direction)) * inverse_stretch;
        const Matrix3 rate = 0.5 * (gradient + gradient.transpose()), spin = gradient - rate;
        result.col(component) = tangent * layout_.strain_components(rate) +
                                layout_.stress_components(spin * stress - stress * spin - rate.trace() * stress);
    }
    return result;
}

Eigen::MatrixXd Solver::free_block(const Problem& problem, const Tangent& tangent) const {
    const auto n = static_cast<Eigen::Index>(problem.free.size());
    Eigen::MatrixXd block(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = 0; j < n; ++j)
            block(i, j) = tangent(problem.free[static_cast<std::size_t>(i)], problem.free[static_cast<std::size_t>(j)]);
    return block;
}

// Strains of the free components that the tangent of a zero increment asks for.
Components Solver::predict(const Problem& problem, const Components& prescribed) const {
    Components guess = prescribed;
    if (!material_.has_tangent() || problem.free.empty()) return guess;
    const Trial still = evaluate(problem, Components::Zero(layout_.size()));
    if (!still.answered()) return guess;
    const Tangent& tangent = still.response.tangent;
    Eigen::VectorXd right = -still.residual;
    for (std::size_t i = 0; i < problem.free.size(); ++i)
        right[static_cast<Eigen::Index>(i)] -= tangent.row(problem.free[i]).dot(prescribed);
    const Eigen::FullPivLU<Eigen::MatrixXd> factors(free_block(problem, tangent));
    if (!factors.isInvertible()) return guess;
    const Eigen::VectorXd strain = factors.solve(right);
    if (!strain.allFinite()) return guess;
    for (std::size_t i = 0; i < problem.free.size(); ++i) guess[problem.free[i]] = strain[static_cast<Eigen::Index>(i)];
    return guess;
}

// The stress scale is the largest stress around; below the round-off of stiffness times strain nothing can be asked.
double Solver::tolerance(const Problem& problem, const Trial& trial) const {
    double scale = std::max(trial.response.stress.cwiseAbs().maxCoeff(), problem.start.stress.cwiseAbs().maxCoeff());
    for (const int component : problem.free) scale = std::max(scale, std::abs(problem.load.value[component]));
    const Tangent& tangent = trial.response.tangent;
    const double stiffness = tangent.size() > 0 && tangent.allFinite() ? tangent.cwiseAbs().maxCoeff() : scale;
    const double strain = large_rotation_ ? 1
                                          : std::max(trial.increment.total_dstrain.cwiseAbs().maxCoeff(),
                                                     trial.increment.strain.cwiseAbs().maxCoeff());
    return std::max(tolerance_ * scale, 8 * round_off * stiffness * strain);
}

// One Newton correction with halving of the step until the residual falls; false if it does not.
bool Solver::correct(const Problem& problem, const Eigen::MatrixXd& jacobian, Trial& trial) const {
    const Eigen::FullPivLU<Eigen::MatrixXd> factors(jacobian);
    if (!jacobian.allFinite() || !factors.isInvertible()) return false;
    const Eigen::VectorXd correction = factors.solve(-trial.residual);
    if (!correction.allFinite()) return false;

    double length = 1;
    for (int halving = 0; halving <= maximum_halvings; ++halving, length *= 0.5) {
        Components dstrain = trial.increment.total_dstrain;
        for (std::size_t i = 0; i < problem.free.size(); ++i)
            dstrain[problem.free[i]] += length * correction[static_cast<Eigen::Index>(i)];
        Trial next = evaluate(problem, dstrain);
        if (next.norm <= (1 - sufficient_decrease * length) * trial.norm || next.norm <= tolerance(problem, trial)) {
            trial = std::move(next);
            return true;
        }
    }
    return false;
}

Solution Solver::finish(Trial&& trial, std::vector<double>&& residuals) const {
    Solution solution;
    solution.converged = true;
    solution.iterations = static_cast<int>(residuals.size()) - 1;
    solution.residuals = std::move(residuals);
    solution.increment = std::move(trial.increment);
    solution.response = std::move(trial.response);
    return solution;
}

Solution Solver::solve(const PointState& start, const LogarithmicFrame& frame, const Load& load, const Moment& moment,
                       const Components* guess) const {
    Problem problem{start, frame, load, moment, {}};
    Components dstrain = Components::Zero(layout_.size());
    for (int i = 0; i < layout_.size() && !load.gradient; ++i) {
        if (load.control[static_cast<std::size_t>(i)] == Control::strain) dstrain[i] = load.value[i] - start.strain[i];
        else problem.free.push_back(i);
    }
    if (guess != nullptr)
        for (const int component : problem.free) dstrain[component] = (*guess)[component];
    else dstrain = predict(problem, dstrain);

    Solution failed;
    Trial trial = evaluate(problem, dstrain);
    if (!trial.answered()) {
        if (trial.response.cut_wanted()) {
            const double wanted = trial.response.pnewdt;
            failed.cut_factor = wanted > 0 && wanted < 1 ? wanted : 0.25;
            failed.failure = fmt::format("the material asked for a smaller increment (PNEWDT = {:g})", wanted);
        } else {
            failed.failure = "the material returned a stress that is not a number";
        }
        return failed;
    }

    Tangent elastic;  // of a zero increment: the fallback where the consistent tangent does not lead down
    std::vector<double> residuals;
    for (int iteration = 0;; ++iteration) {
        failed.iterations = iteration;
        residuals.push_back(trial.norm);
        if (trial.norm <= tolerance(problem, trial)) return finish(std::move(trial), std::move(residuals));
        if (iteration == maximum_iterations_) {
            failed.failure = fmt::format("no equilibrium in {} iterations; the largest residual stress is {:.3g}",
                                         iteration, trial.norm);
            return failed;
        }
        Tangent tangent = tangent_at(problem, trial);
        // Where the thickness follows, J hardly changes.
        if (large_rotation_ && reads_gradient_ && material_.has_tangent() && layout_.ndi() == 3)
            tangent = strain_tangent(problem, trial, tangent);
        if (correct(problem, free_block(problem, tangent), trial)) continue;

        if (elastic.size() == 0) {
            const Trial still = evaluate(problem, Components::Zero(layout_.size()));
            elastic = still.answered() ? tangent_at(problem, still) : tangent;
        }
        if (!correct(problem, free_block(problem, elastic), trial)) {
            failed.failure = fmt::format(
                "the residual stress does not fall below {:.3g} (wanted {:.3g}): a limit point, or a stress rougher "
                "than analysis.tolerance",
                trial.norm, tolerance(problem, trial));
            return failed;
        }
    }
}

}  // namespace lode::host
