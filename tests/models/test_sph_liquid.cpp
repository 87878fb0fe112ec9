// SPH_LIQUID: the verification cases and failure modes of page 55, section 4.
#include <gtest/gtest.h>

#include "liquid_support.hpp"

namespace lode::test::test_sph_liquid {
namespace {

constexpr double K0 = liquid_K0;
constexpr double printed = 1e-13;  // fourteen digits
const std::string name = "SPH_LIQUID-TEST";

TEST(SphLiquid, PressureAndBulkModulus) {
    struct Row {
        double J, p5, p7, p9;
    };
    for (const Row& row :
         {Row{0.9, 0.13870175616861, 0.15582165446967, 0.17568608796813},
          Row{0.7, 0.98998036532397, 1.5918081127172, 2.6423258024989}, Row{0.5, 6.2, 18.142857142857, 56.777777777778},
          Row{1.05, -0.043294766706308, -0.04133123855284, -0.039487898198023}}) {
        const double gam[] = {5, 7, 9}, p[] = {row.p5, row.p7, row.p9};
        for (int i = 0; i < 3; ++i) {
            const Answer a = liquid_at(name, {K0, 0, gam[i]}, {.dfgrd1 = diagonal_gradient(1, row.J, 1)});
            expect_hydrostatic(-p[i] * K0, a.stress, printed);
            const double K = std::pow(row.J, -gam[i]);
            EXPECT_NEAR(a.tangent(0, 0), (K - p[i]) * K0, printed * K * K0);
        }
    }
}

TEST(SphLiquid, ViscousCompression) {
    const Load load{.dstran = {-0.05 / 0.975, 0, 0, 0, 0, 0}, .dtime = 1e-3, .dfgrd1 = diagonal_gradient(0.95, 1, 1)};
    expect_close({-135.76287411342, -135.76287401086, -135.76287401086, 0, 0, 0},
                 liquid_at(name, {K0, 1e-9, 7}, load).stress, printed);
}

TEST(SphLiquid, HeatAndInitialPressure) {
    const Matrix3d one = Matrix3d::Identity();
    const double x = 7.0 * 3 * 7e-5 * 20;  // J* = exp(-3 alpha dT)
    expect_hydrostatic(-K0 / 7 * std::expm1(x),
                       liquid_at(name, {K0, 0, 7, 7e-5}, {.dtemp = 20.0, .dfgrd1 = one}).stress, 1e-14);
    expect_hydrostatic(-5.0, liquid_at(name, {K0, 0, 9, 0, 0, 5.0}, {.dfgrd1 = one}).stress, 1e-14);
}

// GAM = 1: p = K0 (1/J - 1), U = K0 (m - ln J)
TEST(SphLiquid, UnitExponent) {
    const Answer a = liquid_at(name, {K0, 0, 1}, {.dfgrd1 = diagonal_gradient(0.8, 1, 1)});
    expect_hydrostatic(-K0 * 0.25, a.stress, 1e-14);
    EXPECT_NEAR(a.sse, K0 * (-0.2 - std::log(0.8)) / 0.8, 1e-13 * K0);
}

TEST(SphLiquid, TensionIsLimited) {
    const Answer a = liquid_at(name, {K0, 0, 7}, {.dfgrd1 = diagonal_gradient(100, 1, 1)});
    EXPECT_NEAR(a.stress[0], K0 / 7, 1e-12 * K0);
}

TEST(SphLiquid, Viscosity) { expect_liquid_viscosity(name, 7); }
TEST(SphLiquid, Tangent) { expect_liquid_tangents(name, 7); }
TEST(SphLiquid, Energies) {
    expect_liquid_energies(name, 7);
    expect_liquid_energies(name, 1);
}
TEST(SphLiquid, Failures) {
    expect_liquid_failures(name, 7);
    expect_refused(name, {K0, 0, 7, 0, 0, -K0 / 7}, {"PROPS(6)", "PINIT", "tension"});
}

}  // namespace
}  // namespace lode::test::test_sph_liquid
