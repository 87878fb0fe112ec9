// For tests of laws of the deformation gradient.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>

#include "umat_point.hpp"

namespace lode::test {

inline Matrix3d diagonal_gradient(double a, double b, double c) { return Eigen::Vector3d(a, b, c).asDiagonal(); }
inline Matrix3d simple_shear(double g) {
    Matrix3d f = Matrix3d::Identity();
    f(0, 1) = g;
    return f;
}

// Volume of a particle in a shock tube, t = 0..1: rest, a shock a tenth of the time wide, rest, a rarefaction fan that
// ends at another volume. Its rate is continuous.
inline double shock_tube(double t, double shocked, double rarefied) {
    const auto step = [](double x) {
        const double y = std::clamp(x, 0.0, 1.0);
        return y * y * (3.0 - 2.0 * y);
    };
    return 1.0 + (shocked - 1.0) * step((t - 0.1) / 0.1) + (rarefied - shocked) * step((t - 0.3) / 0.6);
}

// Component by component, relative to the largest of those expected.
inline constexpr double fourteen_digits = 2e-13;
inline void expect_close(const Numbers& expected, const Numbers& actual, double relative = fourteen_digits) {
    ASSERT_LE(expected.size(), actual.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_NEAR(actual[i], expected[i], relative * largest(expected)) << "component " << i + 1;
}
inline void expect_hydrostatic(double normal, const Numbers& stress, double relative) {
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(stress[i], normal, relative * std::abs(normal)) << i + 1;
    for (std::size_t i = 3; i < stress.size(); ++i) EXPECT_EQ(stress[i], 0.0) << i + 1;
}

// The message with which constants are refused, or "" where they are accepted.
inline std::string refusal(const std::string& name, const Numbers& props, AnalysisKind kind = AnalysisKind::solid) {
    char error[512] = "";
    const int needed = lode_required_state(name.c_str(), props.data(), static_cast<int>(props.size()),
                                           normal_components(kind), shear_components(kind), error, sizeof error);
    return needed >= 0 ? "" : error;
}
inline void expect_refused(const std::string& name, const Numbers& props, const std::vector<std::string>& words,
                           AnalysisKind kind = AnalysisKind::solid) {
    const std::string message = refusal(name, props, kind);
    EXPECT_NE(message, "") << "was accepted";
    for (const std::string& word : words)
        EXPECT_NE(message.find(word), std::string::npos) << "no '" << word << "' in: " << message;
}

}  // namespace lode::test
