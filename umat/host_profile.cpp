#include "host_profile.hpp"

#include <Eigen/Eigenvalues>
#include <cstdlib>
#include <string_view>

namespace lode {
namespace {

HostChoice choice_from_environment() {
    const char* host = std::getenv("LODE_HOST");
    if (host == nullptr) return HostChoice::by_pnewdt;
    if (std::string_view(host) == "calculix") return HostChoice::calculix;
    return std::string_view(host) == "abaqus" ? HostChoice::abaqus : HostChoice::by_pnewdt;
}

}  // namespace

HostChoice host_choice() {
    static const HostChoice choice = choice_from_environment();
    return choice;
}

const double* unrotated(const double* deformation_gradient, double* stretch) {
    const Eigen::Map<const Eigen::Matrix3d> f(deformation_gradient);
    if (f(0, 1) == f(1, 0) && f(0, 2) == f(2, 0) && f(1, 2) == f(2, 1)) return deformation_gradient;
    if (!(f.determinant() > 0.0)) return deformation_gradient;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> c(f.transpose() * f);
    Eigen::Map<Eigen::Matrix3d> u(stretch);
    u = c.operatorSqrt();
    return stretch;
}

}  // namespace lode
