// What the tests of ISO_PLASTIC share.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "umat_point.hpp"

namespace lode::test::iso_plastic_cases {

inline constexpr auto solid = AnalysisKind::solid;
inline constexpr auto plane_strain = AnalysisKind::plane_strain;
inline constexpr auto plane_stress = AnalysisKind::plane_stress;
inline constexpr auto uniaxial = AnalysisKind::uniaxial;

// The first constants, then others by their PROPS index; zeros between.
inline Numbers iso_plastic_props(Numbers first, std::initializer_list<std::pair<int, double>> others = {}) {
    for (const auto& [index, value] : others) {
        if (first.size() < static_cast<std::size_t>(index)) first.resize(static_cast<std::size_t>(index), 0.0);
        first[static_cast<std::size_t>(index) - 1] = value;
    }
    return first;
}

// The page prints 12 significant digits.
inline void expect_printed(double value, double printed) {
    EXPECT_NEAR(value, printed, 1e-11 * std::fabs(printed) + 1e-11);
}
inline void expect_printed(const Numbers& values, const Numbers& printed) {
    ASSERT_EQ(values.size(), printed.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        SCOPED_TRACE("component " + std::to_string(i));
        expect_printed(values[i], printed[i]);
    }
}

inline std::string iso_plastic_refusal(const Numbers& props) {
    char message[400] = "";
    const int needed =
        lode_required_state("ISO_PLASTIC-BAD", props.data(), static_cast<int>(props.size()), 3, 3, message, 400);
    return needed < 0 ? message : "accepted";
}

}  // namespace lode::test::iso_plastic_cases
