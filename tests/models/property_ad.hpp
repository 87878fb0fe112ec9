// The exact derivative of a model's own kernel: the update is run on numbers that carry their derivatives.
#pragma once

#include <string_view>

#include "umat_point.hpp"

namespace lode::test {

// What the kernel gives for an increment, and how that answers to the increment.
struct Differentiated {
    Numbers stress, state;
    Eigen::MatrixXd stress_by_strain;  // DSTRAN, and F <- (I + D) F, perturbed together
    Eigen::VectorXd stress_by_temperature;
    Eigen::MatrixXd state_by_strain;
    Eigen::VectorXd state_by_temperature;
    bool done = false;
};
using DifferentiateFunction = Differentiated (*)(const UmatPoint& point, const Load& load);

// The differentiated kernel of a model in a kind; null where it does not serve it.
DifferentiateFunction differentiated_kernel(std::string_view keyword, AnalysisKind kind);
// That of POROUS_<KEYWORD>: the kernels of its pores around the differentiated kernel of the solid.
DifferentiateFunction differentiated_porous_kernel(AnalysisKind kind);

struct DifferentiatedModel {
    const char* keyword;
    DifferentiateFunction kernels[kind_count];
};
// Called by the generated translation units.
bool register_differentiated(const DifferentiatedModel& model);

}  // namespace lode::test
