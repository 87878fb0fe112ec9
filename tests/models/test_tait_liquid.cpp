// TAIT_LIQUID: the verification cases and failure modes of page 55, section 4.
#include <gtest/gtest.h>

#include "liquid_support.hpp"

namespace lode::test::test_tait_liquid {
namespace {

constexpr AnalysisKind solid = AnalysisKind::solid;
constexpr double K0 = liquid_K0, C = 0.0894;
constexpr double printed = 1e-13;  // fourteen digits
const std::string name = "TAIT_LIQUID-TEST";

TEST(TaitLiquid, PressureAndBulkModulus) {
    const double table[4][3] = {{0.9, 0.18420594514451, 2.7544222665555},
                                {0.7, 2.4733223237373, 20.066058463268},
                                {0.5, 23.914265947803, 134.24869098324},
                                {1.05, -0.038297339223291, 0.60019903596806}};
    for (const auto& [J, p, K] : table) {
        const Answer a = liquid_at(name, {K0, 0}, {.dfgrd1 = diagonal_gradient(1, J, 1)});
        // exp(-m/C) magnifies the rounding of J by 1/C
        expect_hydrostatic(-p * K0, a.stress, 1e-13);
        EXPECT_NEAR(a.tangent(0, 0), (K - p) * K0, 1e-13 * K * K0);
        EXPECT_EQ(a.tangent(3, 3), 0.0);
    }
}

TEST(TaitLiquid, ViscousCompression) {
    const Load load{.dstran = {-0.05 / 0.975, 0, 0, 0, 0, 0}, .dtime = 1e-3, .dfgrd1 = diagonal_gradient(0.95, 1, 1)};
    const Answer a = liquid_at(name, {K0, 1e-9}, load);
    expect_close({-147.39586094828, -147.39586084572, -147.39586084572, 0, 0, 0}, a.stress, printed);
    // plane strain is the same
    const Load plane{.dstran = {-0.05 / 0.975, 0, 0, 0}, .dtime = 1e-3, .dfgrd1 = load.dfgrd1};
    expect_close({-147.39586094828, -147.39586084572, -147.39586084572, 0},
                 liquid_at(name, {K0, 1e-9}, plane, AnalysisKind::plane_strain).stress, printed);
}

TEST(TaitLiquid, HeatAndInitialPressure) {
    const Matrix3d one = Matrix3d::Identity();
    const Answer heated = liquid_at(name, {K0, 0, C, 7e-5}, {.dtemp = 20.0, .dfgrd1 = one});
    expect_hydrostatic(-9.4401783172319, heated.stress, printed);
    EXPECT_NEAR(heated.state[0], 1.4e-3, 1e-18);
    // moisture acts as heat does
    expect_hydrostatic(heated.stress[0], liquid_at(name, {K0, 0, C, 0, 1.4e-3}, {.dpred = {1.0}, .dfgrd1 = one}).stress,
                       1e-15);
    expect_hydrostatic(-5.0, liquid_at(name, {K0, 0, C, 0, 0, 5.0}, {.dfgrd1 = one}).stress, 1e-14);
    // free expansion
    const double l = std::exp(1.4e-3);
    const Answer free = liquid_at(name, {K0, 0, C, 7e-5}, {.dtemp = 20.0, .dfgrd1 = diagonal_gradient(l, l, l)});
    EXPECT_LE(largest(free.stress), 1e-15 * K0);
    EXPECT_LE(free.sse, 1e-30 * K0);
}

TEST(TaitLiquid, ViscousTangentTable) {
    const Load load{.dstran = {-0.05 / 0.975, 0, 0, 0, 0, 0}, .dtime = 0.01, .dfgrd1 = diagonal_gradient(0.95, 1, 1)};
    const Answer a = liquid_at(name, {K0, 0.5}, load);
    EXPECT_NEAR(a.tangent(0, 0), 3572.1391146265, printed * 3572);
    EXPECT_NEAR(a.tangent(0, 1), 3472.1391146265, printed * 3572);
    EXPECT_NEAR(a.tangent(1, 0), 3477.2673197547, printed * 3572);
    EXPECT_NEAR(a.tangent(3, 3), 50.0, printed * 3572);
}

TEST(TaitLiquid, TinyStrainsKeepFullRelativeAccuracy) {
    for (const double wanted : {1e-6, 1e-9, 1e-12}) {
        const double h = (1.0 + wanted) - 1.0;
        const Answer a = liquid_at(name, {K0, 0}, {.dfgrd1 = diagonal_gradient(1 + h, 1, 1)});
        EXPECT_NEAR(a.stress[0], -C * K0 * std::expm1(-h / C), 1e-15 * K0 * h);
    }
}

TEST(TaitLiquid, TensionIsLimited) {
    const Answer a = liquid_at(name, {K0, 0}, {.dfgrd1 = diagonal_gradient(5, 1, 1)});
    EXPECT_NEAR(a.stress[0], C * K0, 1e-12 * K0);
    // 1/C = 11.2: no overflow on the way to no volume at all
    EXPECT_TRUE(std::isfinite(liquid_at(name, {K0, 0}, {.dfgrd1 = diagonal_gradient(1e-12, 1, 1)}).stress[0]));
}

TEST(TaitLiquid, Viscosity) { expect_liquid_viscosity(name, C); }
TEST(TaitLiquid, Tangent) { expect_liquid_tangents(name, C); }
TEST(TaitLiquid, Energies) { expect_liquid_energies(name, C); }
TEST(TaitLiquid, Failures) {
    expect_liquid_failures(name, C);
    expect_refused(name, {K0, 0, C, 0, 0, -C * K0}, {"PROPS(6)", "PINIT", "tension"});
    EXPECT_EQ(refusal(name, {K0, 0, C, 0, 0, -0.999 * C * K0}), "");
    expect_refused(name, {K0, 0, C, 0, 0, 1e9}, {"PROPS(6)", "PINIT", "volume"});
}

TEST(TaitLiquid, ProbeOfAnExplicitHost) {
    VumatBlock block(name, solid, {K0, 0.5});
    block.points.push_back(block.fresh_point());
    block.points[0].strain_increment = {1e-3, 2e-3, 0, 5e-3, 0, 0};
    block.step_time = block.total_time = 0.0;
    ASSERT_EQ(block.run().stops, 0);
    expect_hydrostatic(K0 * 3e-3, block.points[0].stress, 1e-15);
}

}  // namespace
}  // namespace lode::test::test_tait_liquid
