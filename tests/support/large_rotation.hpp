// Increments as hosts make them from a deformation gradient (page 10, section 6): what a hypoelastic law is given.
#pragma once

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "umat_point.hpp"

namespace lode::test {

// H: Hughes and Winget. DSTRAN and DROT from the symmetric and skew parts of 2 (dF - I)(dF + I)^-1.
inline Load hughes_winget_increment(const Matrix3d& f_old, const Matrix3d& f_new, AnalysisKind kind) {
    const Matrix3d one = Matrix3d::Identity(), df = f_new * f_old.inverse();
    const Matrix3d g = 2.0 * (df - one) * (df + one).inverse();
    const Matrix3d w = 0.25 * (g - g.transpose());  // W/2
    return {.dstran = to_components(0.5 * (g + g.transpose()), kind, 2.0),
            .dfgrd1 = f_new,
            .drot = (one - w).inverse() * (one + w)};
}

// P: polar decomposition dF = dV dR; DSTRAN = ln dV, in the axes of the end.
inline Load polar_increment(const Matrix3d& f_old, const Matrix3d& f_new, AnalysisKind kind) {
    const Matrix3d df = f_new * f_old.inverse();
    const Eigen::SelfAdjointEigenSolver<Matrix3d> b(df * df.transpose());
    const Matrix3d& n = b.eigenvectors();
    const Matrix3d log_v = 0.5 * (n * b.eigenvalues().array().log().matrix().asDiagonal() * n.transpose());
    return {.dstran = to_components(log_v, kind, 2.0), .dfgrd1 = f_new, .drot = b.operatorInverseSqrt() * df};
}

// R of F = R U.
inline Matrix3d polar_rotation(const Matrix3d& f) {
    return Eigen::SelfAdjointEigenSolver<Matrix3d>(f * f.transpose()).operatorInverseSqrt() * f;
}

// G: strainInc of an explicit host, in the frame that turns with R: the symmetric part of dU U^-1 in the middle.
inline Numbers stretch_increment(const Matrix3d& f_old, const Matrix3d& f_new, AnalysisKind kind) {
    const Matrix3d u_old = polar_rotation(f_old).transpose() * f_old, u_new = polar_rotation(f_new).transpose() * f_new;
    const Matrix3d g = (u_new - u_old) * (0.5 * (u_old + u_new)).inverse();
    return to_components(0.5 * (g + g.transpose()), kind, 2.0);
}

// Follows F = path(t), t = 0..1, in equal increments made by `increment`.
template <class Path, class MakeIncrement>
void follow(UmatPoint& point, int increments, const Path& path, const MakeIncrement& increment) {
    for (int i = 0; i < increments; ++i) {
        const double from = static_cast<double>(i) / increments, to = static_cast<double>(i + 1) / increments;
        point.advance(increment(path(from), path(to), point.kind()));
    }
}

// Agreement with numbers printed with twelve significant digits.
inline void expect_digits(const Numbers& actual, const Numbers& page, double digits = 5e-12) {
    ASSERT_EQ(actual.size(), page.size());
    for (std::size_t i = 0; i < page.size(); ++i)
        EXPECT_NEAR(actual[i], page[i], digits * std::max(largest(page), 1e-300)) << "component " << i + 1;
}

}  // namespace lode::test
