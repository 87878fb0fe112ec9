// One increment: the strains that give the prescribed stresses.
#ifndef LODE_HOST_REPLAY_SOLVER_HPP
#define LODE_HOST_REPLAY_SOLVER_HPP

#include <string>
#include <vector>

#include "material.hpp"
#include "path.hpp"

namespace lode::host {

// Under large rotation a step controlled by strain and stress has F = exp(E + offset) rotation with E the strain
// tensor: what came before the step stays in it.
struct LogarithmicFrame {
    Matrix3 offset = Matrix3::Zero(), rotation = Matrix3::Identity();
};
LogarithmicFrame logarithmic_frame(const Layout& layout, const PointState& point);

// When an increment happens.
struct Moment {
    int step = 1, number = 1;
    double dtime = 0;
};

struct Solution {
    bool converged = false;
    std::string failure;    // why not
    double cut_factor = 1;  // what PNEWDT asked for, 1 if it did not
    int iterations = 0;     // Newton corrections
    // Largest residual stress before every correction and at the end.
    std::vector<double> residuals;
    Increment increment;
    Response response;
};

class Solver {
  public:
    Solver(const Scenario& scenario, Material& material);

    // `load` at the end of the increment. `guess`: total strain increment to begin with; without one the tangent of a
    // zero increment predicts.
    Solution solve(const PointState& start, const LogarithmicFrame& frame, const Load& load, const Moment& moment,
                   const Components* guess) const;
    // Also used for the probe call of explicit hosts.
    Increment increment_for(const PointState& start, const LogarithmicFrame& frame, const Load& load,
                            const Moment& moment, const Components& total_dstrain) const;

  private:
    struct Problem;
    struct Trial;

    Trial evaluate(const Problem& problem, const Components& total_dstrain) const;
    Components predict(const Problem& problem, const Components& prescribed) const;
    Tangent strain_tangent(const Problem& problem, const Trial& trial, const Tangent& tangent) const;
    Tangent tangent_at(const Problem& problem, const Trial& trial) const;
    bool correct(const Problem& problem, const Eigen::MatrixXd& jacobian, Trial& trial) const;
    Eigen::MatrixXd free_block(const Problem& problem, const Tangent& tangent) const;
    double tolerance(const Problem& problem, const Trial& trial) const;
    Solution finish(Trial&& trial, std::vector<double>&& residuals) const;

    Layout layout_;
    Material& material_;
    bool large_rotation_;
    bool reads_gradient_;  // DDSDDE is the Jaumann rate of Kirchhoff stress over J
    std::vector<double> expansion_;
    double reference_temperature_;
    double tolerance_;
    int maximum_iterations_;
};

}  // namespace lode::host

#endif
