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

// d of sets T and O.
inline const Numbers general_strain = {1e-3, -5e-4, 2e-4, 1e-3, 0.0, 5e-4};
inline const Numbers plane_strain = {1e-3, -5e-4, 1e-3};

}  // namespace lode::test
