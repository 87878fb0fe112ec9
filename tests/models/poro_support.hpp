// What the tests of page 45 share.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include <Eigen/LU>

#include "umat_point.hpp"
#include "vumat_block.hpp"

namespace lode::test {

// The page prints 12 digits, exact numbers to 15; it asks for 1e-10.
inline constexpr double page = 1e-11;

inline void expect_close(double value, double expected, double relative = page, double scale = 0.0) {
    EXPECT_NEAR(value, expected, relative * std::max(std::abs(expected), scale));
}
// Every component to the printed digits of the largest.
inline void expect_stress(const Numbers& stress, const Numbers& expected, double relative = page) {
    ASSERT_EQ(stress.size(), expected.size());
    for (std::size_t i = 0; i < stress.size(); ++i)
        EXPECT_NEAR(stress[i], expected[i], relative * largest(expected)) << "component " << i + 1;
}
inline UmatPoint poro_point(const char* name, AnalysisKind kind, const Numbers& props) {
    return UmatPoint(name, kind, props);
}
// The same first increment through the explicit entry point.
inline VumatPoint explicit_answer(const UmatPoint& point, const Load& load) {
    VumatBlock block(point);
    VumatPoint p = block.fresh_point();
    p.strain_increment = load.dstran;
    p.temperature_new = load.dtemp;
    p.fields_new = load.dpred.empty() ? Numbers{0.0} : load.dpred;
    p.celent = point.celent();
    block.points.assign(3, p);
    EXPECT_EQ(block.run().stops, 0);
    return block.points[1];
}
inline std::string refusal(const char* name, const Numbers& props) {
    char error[512] = "";
    EXPECT_EQ(lode_required_state(name, props.data(), static_cast<int>(props.size()), 3, 3, error, sizeof error), -1)
        << "accepted";
    return error;
}
inline void expect_refused(const char* name, const Numbers& props, const std::vector<std::string>& words) {
    const std::string error = refusal(name, props);
    for (const std::string& word : words) EXPECT_NE(error.find(word), std::string::npos) << word << " in: " << error;
}

// STATEV of page 45.
enum { PE = 1, THETA, DP_UD, STORAGE, MOB1, MOB2, MOB3, DT_P, EZZ };

// Data set I (E = 10000, NU = 0.25, ALPHA = 0.8, KU = 9000) by any model: `digits` is the relative error allowed where
// the page's numbers are exact. PI1: drained oedometer, then pressure from the host.
inline void expect_drained_oedometer(UmatPoint point, double digits) {
    point.advance({.dstran = {0, 0, -1e-3, 0, 0, 0}});
    expect_stress(point.stress(), {-4, -4, -12, 0, 0, 0}, digits);
    expect_close(point.state(THETA), -8e-4, digits);
    expect_close(point.state(DP_UD), 2.91666666666667, digits);
    point.advance({.dpred = {3.0}});
    expect_stress(point.stress(), {-6.4, -6.4, -14.4, 0, 0, 0}, digits);
    expect_close(point.state(PE), 3.0, digits);
    expect_close(point.state(THETA), 2.28571428571429e-5, 1e-11);
}
// PI2: undrained oedometer.
inline void expect_undrained_oedometer(UmatPoint point, double digits) {
    const Load load{.dstran = {0, 0, -1e-3, 0, 0, 0}};
    const VumatPoint explicit_point = explicit_answer(point, load);
    const Answer a = point.advance(load);
    const Numbers expected = {-6.33333333333333, -6.33333333333333, -14.3333333333333, 0, 0, 0};
    expect_stress(point.stress(), expected, digits);
    expect_close(point.state(PE), 2.91666666666667, digits);
    EXPECT_EQ(point.state(THETA), 0.0);
    expect_close(a.tangent(0, 0), 14333.3333333333, digits);
    expect_close(a.tangent(0, 1), 6333.33333333333, digits);
    expect_close(a.tangent(3, 3), 4000.0, digits);
    expect_stress(explicit_point.stress, expected, digits);
    expect_close(explicit_point.state[PE - 1], 2.91666666666667, digits);
}
// PI3: consolidation, transport by the host.
inline void expect_consolidation(UmatPoint point, double digits) {
    point.advance({.dstran = {0, 0, -1e-3, 0, 0, 0}});
    point.advance({.dstran = {0, 0, -2e-4, 0, 0, 0}, .dpred = {-2.0}});
    expect_stress(point.stress(), {-6, -6, -15.6, 0, 0, 0}, digits);
    expect_close(point.state(PE), 1.5, 1e-13);
    expect_close(point.state(THETA), -5.48571428571429e-4, 1e-13);
}

// d of sets T and O.
inline const Numbers general_strain = {1e-3, -5e-4, 2e-4, 1e-3, 0.0, 5e-4};
inline const Numbers plane_strain = {1e-3, -5e-4, 1e-3};

}  // namespace lode::test
