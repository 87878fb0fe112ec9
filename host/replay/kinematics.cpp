#include "kinematics.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <cmath>

namespace lode::host {
namespace {

template <class Function>
Matrix3 spectral(const Matrix3& symmetric, Function&& function) {
    const Eigen::SelfAdjointEigenSolver<Matrix3> solver(symmetric);
    const Eigen::Vector3d values = solver.eigenvalues().unaryExpr(function);
    return solver.eigenvectors() * values.asDiagonal() * solver.eigenvectors().transpose();
}

Matrix3 symmetric_part(const Matrix3& a) { return 0.5 * (a + a.transpose()); }

}  // namespace

Polar polar(const Matrix3& F) {
    if (F == F.transpose() && F.isIdentity(0)) return {F, F, F};
    const Eigen::JacobiSVD<Matrix3> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Matrix3 stretch = svd.singularValues().asDiagonal();
    const Matrix3& u = svd.matrixU();
    const Matrix3& v = svd.matrixV();
    return {u * v.transpose(), v * stretch * v.transpose(), u * stretch * u.transpose()};
}

// A diagonal argument, the common case, gives an exactly diagonal result.
Matrix3 exponential(const Matrix3& symmetric) {
    if (symmetric.isDiagonal(0)) return symmetric.diagonal().array().exp().matrix().asDiagonal();
    return spectral(symmetric, [](double x) { return std::exp(x); });
}

Matrix3 exponential_derivative(const Matrix3& symmetric, const Matrix3& direction) {
    const Eigen::SelfAdjointEigenSolver<Matrix3> solver(symmetric);
    const Matrix3& n = solver.eigenvectors();
    const Eigen::Vector3d& e = solver.eigenvalues();
    Matrix3 derivative = n.transpose() * direction * n;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            // (exp a - exp b)/(a - b), also for equal ones
            const double half = 0.5 * (e[i] - e[j]);
            derivative(i, j) *= std::exp(0.5 * (e[i] + e[j])) * (half == 0 ? 1 : std::sinh(half) / half);
        }
    return n * derivative * n.transpose();
}

Matrix3 logarithm(const Matrix3& symmetric_positive) {
    if (symmetric_positive.isDiagonal(0)) return symmetric_positive.diagonal().array().log().matrix().asDiagonal();
    return spectral(symmetric_positive, [](double x) { return std::log(x); });
}

Matrix3 rotation_about(const Eigen::Vector3d& axis, double angle) {
    return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

MotionIncrement motion_increment(const Matrix3& F0, const Matrix3& F1) {
    const Matrix3 gradient = (F1 - F0) * (0.5 * (F0 + F1)).inverse();
    const Matrix3 spin = 0.5 * (gradient - gradient.transpose());
    const Matrix3 one = Matrix3::Identity();
    if (spin.norm() <= 1e-14 * (1 + gradient.norm()))
        return {logarithm(symmetric_part(F1 * F0.inverse())), Matrix3::Zero(), one};
    return {symmetric_part(gradient), spin, (one - 0.5 * spin).inverse() * (one + 0.5 * spin)};
}

}  // namespace lode::host
