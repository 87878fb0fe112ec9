// What the tests of the softening solids of page 30 share: a point that is led along strain increments, the rows of the
// page's tables, and the same path through VUMAT.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "umat_point.hpp"
#include "vumat_block.hpp"

namespace lode::test::softening {

enum Entry {
    STATE = 1,
    AXIS_N,
    AXIS_T = 5,
    DELTA = 8,
    D = 11,
    EC = 14,
    W = 17,
    H = 20,
    MODE,
    W_F,
    EZZ,
    REL_S,
    REL_G,
    STATUS,
    A1,
    A2 = 30
};
constexpr double printed = 6e-12;  // twelve digits

inline double entry(const Answer& a, int index) { return a.state[std::size_t(index) - 1]; }
inline Numbers entries(const Answer& a, int first, int count) {
    return {a.state.begin() + first - 1, a.state.begin() + first - 1 + count};
}

// Numbers of the page, each to its digits; rounding errors are those of the largest.
inline void expect_printed(const Numbers& actual, const Numbers& page, double largest_of_path = 0.0) {
    ASSERT_GE(actual.size(), page.size());
    const double rounding = 1e-13 * std::max(largest(page), largest_of_path);
    for (std::size_t i = 0; i < page.size(); ++i)
        EXPECT_NEAR(actual[i], page[i], printed * std::abs(page[i]) + rounding) << "entry " << i + 1;
}
inline void expect_printed(double actual, double page) { expect_printed(Numbers{actual}, Numbers{page}); }

// DDSDDE row by row, ten digits.
inline void expect_tangent(const Answer& a, const Numbers& rows, int first_row = 0) {
    const auto n = static_cast<Eigen::Index>(a.stress.size());
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const auto i = first_row + static_cast<Eigen::Index>(k) / n, j = static_cast<Eigen::Index>(k) % n;
        const double digits = std::pow(10.0, std::floor(std::log10(std::max(1.0, std::abs(rows[k])))) - 9.0);
        EXPECT_NEAR(a.tangent(i, j), rows[k], 0.6 * digits + 2e-13 * largest(rows)) << i + 1 << ", " << j + 1;
    }
}

// The answers to a path of strain increments, each a call of UMAT; the last of them stays with the point.
inline std::vector<Answer> follow(UmatPoint& point, const std::vector<Numbers>& path) {
    std::vector<Answer> answers;
    for (const Numbers& dstran : path) answers.push_back(point.advance({.dstran = dstran}));
    return answers;
}

// The path through VUMAT, 9 points abreast, ends where UMAT does.
inline void expect_same_in_vumat(const UmatPoint& fresh, const std::vector<Numbers>& path) {
    UmatPoint point = fresh;
    VumatBlock block(fresh);
    block.points.assign(9, block.fresh_point());
    for (VumatPoint& p : block.points) p.celent = fresh.celent(), p.state = fresh.state(), p.stress = fresh.stress();
    for (const Numbers& dstran : path) {
        const Answer a = point.advance({.dstran = dstran});
        for (VumatPoint& p : block.points) p.strain_increment = dstran;
        ASSERT_EQ(block.run().stops, 0);
        const double stress = std::max({largest(a.stress), 1.0, 3e4 * largest(dstran)});  // elastic predictor
        for (const VumatPoint& p : block.points) {
            EXPECT_LE(distance(p.stress, a.stress), 1e-13 * stress);
            for (std::size_t i = 0; i < a.state.size(); ++i)
                EXPECT_NEAR(p.state[i], a.state[i], 1e-11 * std::abs(a.state[i]) + 1e-14) << "STATEV " << i + 1;
        }
    }
}

}  // namespace lode::test::softening
