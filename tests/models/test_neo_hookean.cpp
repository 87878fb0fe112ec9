// NEO_HOOKEAN: the verification cases and failure modes of page 50, sections 1 and 3.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "hyperelastic.hpp"
#include "lode/hyperelastic/neo_hookean.hpp"

namespace lode::test::test_neo_hookean {
namespace {

constexpr AnalysisKind solid = AnalysisKind::solid, plane_strain = AnalysisKind::plane_strain,
                       plane_stress = AnalysisKind::plane_stress;
constexpr double E = 10.0, nu = 0.3, G = E / (2 * (1 + nu)), lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
constexpr double printed = fourteen_digits;

const Matrix3d in_plane = matrix(1.5, 0.2, 0.0, 0.0, 0.9, 0.0, 0.0, 0.0, 7.7);  // plane stress: F33 is not read

UmatPoint material(AnalysisKind kind, Numbers props) { return UmatPoint("NEO_HOOKEAN-TEST", kind, std::move(props)); }
Answer at(AnalysisKind kind, const Numbers& props, const Matrix3d& f, double dtemp = 0.0) {
    return material(kind, props).advance({.dtemp = dtemp, .dfgrd1 = f});
}
const HyperelasticModel model = {"NEO_HOOKEAN-TEST",
                                 [](int uj, double alpha, double beta) {
                                     return Numbers{E, nu, double(uj), alpha, beta};
                                 },
                                 E, 1};
const DilatationalEnergies dilatation = {lambda};
LongVector principal_stress(const LongVector& l, int uj) {
    const Long J = l.prod(), k = lambda, g = G;
    const Long mean = uj == 0 ? k / 2 * (J - 1 / J) : uj == 1 ? k * (J - 1) : k * std::log(J) / J;
    return (g / J * (l.array().square() - 1) + mean).matrix();
}

// --- 3.4, the printed table --------------------------------------------------------------------------------------

TEST(NeoHookean, SimpleShearDoesNotDependOnTheDilatationalEnergy) {
    for (const double uj : {0.0, 1.0, 2.0})
        expect_close({0.61538461538462, 0, 0, 1.5384615384615, 0, 0}, at(solid, {E, nu, uj}, simple_shear(0.4)).stress);
}

TEST(NeoHookean, ConstrainedUniaxialTable) {
    const double table[3][2] = {
        {3.5724852071006, 1.5310650887574}, {3.7721893491124, 1.7307692307692}, {3.205758570122, 1.1643384517788}};
    for (int uj = 0; uj < 3; ++uj) {
        const auto [s11, s22] = table[uj];
        expect_close({s11, s22, s22, 0, 0, 0}, at(solid, {E, nu, double(uj)}, diagonal(1.3, 1, 1)).stress);
        expect_close({s11, s22, s22, 0}, at(plane_strain, {E, nu, double(uj)}, diagonal(1.3, 1, 1)).stress);
    }
}

TEST(NeoHookean, HydrostaticTable) {
    const double table[3] = {-6.8614182692308, -5.5197115384615, -10.247490842202};
    for (int uj = 0; uj < 3; ++uj)
        expect_close({table[uj], table[uj], table[uj], 0, 0, 0},
                     at(solid, {E, nu, double(uj)}, diagonal(0.8, 0.8, 0.8)).stress);
}

TEST(NeoHookean, GeneralDeformation) {
    const Answer a = at(solid, {E, nu}, general);
    expect_close(
        {3.1614412663149, -0.075506803665648, 1.6688003332408, 1.1802277145237, -1.6662038322688, 1.0934462649264},
        a.stress);
    const double row1[6] = {18.472285476257, 6.3923076923077, 6.3923076923077, 1.1802277145237, -1.6662038322688, 0};
    for (int j = 0; j < 6; ++j) {
        EXPECT_NEAR(a.tangent(0, j), row1[j], printed * row1[0]);
        EXPECT_NEAR(a.tangent(j, 0), row1[j], printed * row1[0]);
    }
    EXPECT_NEAR(a.tangent(3, 3), 4.4215148569842, printed * row1[0]);
}

TEST(NeoHookean, PlaneStressTable) {
    const double table[3][4] = {{5.1377062856886, 0.23401370522495, 0.5963950435699, -0.1401328392153},
                                {5.1896098961979, 0.26052787854542, 0.59948294809287, -0.14456196885675},
                                {5.0143906511739, 0.17076215618368, 0.58908995209341, -0.12946993748894}};
    for (int uj = 0; uj < 3; ++uj) {
        const auto [s11, s22, s12, f33m1] = table[uj];
        const Answer a = at(plane_stress, {E, nu, double(uj)}, in_plane);
        expect_close({s11, s22, s12}, a.stress);
        EXPECT_NEAR(a.state[1], f33m1, printed);
    }
    const Answer heated = at(plane_stress, {E, nu, 0, 1e-3}, in_plane, 100.0);
    expect_close({3.5016638207094, -0.91059465536398, 0.53662603087379}, heated.stress);
    EXPECT_NEAR(heated.state[0], 0.1, 1e-16);
    EXPECT_NEAR(heated.state[1], 0.056143914671864, printed);
}

// --- 3.2, closed solutions ---------------------------------------------------------------------------------------

TEST(NeoHookean, ClosedSolutions) {
    for (int uj = 0; uj < 3; ++uj) {
        const Numbers props = {E, nu, double(uj)};
        for (const double l : {0.4, 0.9, 1.1, 2.5}) {
            const double mean = dilatation.derivative(uj, l);
            expect_close({G * (l - 1 / l) + mean, mean, mean, 0, 0, 0}, at(solid, props, diagonal(l, 1, 1)).stress,
                         1e-14);
            const double J = l * l * l, s = G * (l * l - 1) / J + dilatation.derivative(uj, J);
            expect_close({s, s, s, 0, 0, 0}, at(solid, props, diagonal(l, l, l)).stress, 1e-13);

            // simple tension: J from sigma22 = 0
            double lower = 1e-3, upper = 1e3;
            for (int i = 0; i < 200; ++i) {
                const double middle = std::sqrt(lower * upper);
                const double s22 = G * (middle / l - 1) + middle * dilatation.derivative(uj, middle);
                (s22 > 0 ? upper : lower) = middle;
            }
            const double width = std::sqrt(lower / l), s11 = G * (l * l * l - lower) / (lower * l);
            expect_close({s11, 0, 0, 0, 0, 0}, at(solid, props, diagonal(l, width, width)).stress, 1e-13);
            // plane stress finds the thickness by itself
            const Answer sheet = at(plane_stress, props, diagonal(l, width, 0));
            expect_close({s11, 0, 0}, sheet.stress, 1e-13);
            EXPECT_NEAR(sheet.state[1], width - 1, 1e-13);
        }
    }
}

// With residual strain J = 1 but J* = exp(-3 e): the errata of the page to 9.7.4.
TEST(NeoHookean, SimpleShearWithResidualStrain) {
    const double g = 0.3, e = 0.02, lres = std::exp(e), jres = std::exp(3 * e);
    for (int uj = 0; uj < 3; ++uj) {
        const double normal = G * (lres - jres) + dilatation.derivative(uj, 1 / jres);
        expect_close({normal + G * lres * g * g, normal, normal, G * lres * g, 0, 0},
                     at(solid, {E, nu, double(uj), e}, simple_shear(g), 1.0).stress, 1e-14);
    }
}

TEST(NeoHookean, MoistureActsAsHeatDoes) {
    UmatPoint wet = material(solid, {E, nu, 2, 1e-4, 3e-3});
    const Answer a = wet.advance({.dtemp = 50.0, .dpred = {2.0}, .dfgrd1 = general});
    EXPECT_NEAR(a.state[0], 0.011, 1e-17);
    expect_close(at(solid, {E, nu, 2, 0.011}, general, 1.0).stress, a.stress, 1e-15);
}

TEST(NeoHookean, FreeExpansionIsFreeOfStress) {
    const double l = std::exp(0.05);
    for (const AnalysisKind kind : {solid, plane_strain, plane_stress}) {
        const Answer a = at(kind, {E, nu, 0, 1e-3}, diagonal(l, l, l), 50.0);
        EXPECT_LT(largest(a.stress), 1e-15 * E);
        EXPECT_LT(a.sse, 1e-30 * E);
    }
}

// --- 1.x: accuracy, energies, tangents ---------------------------------------------------------------------------

TEST(NeoHookean, TinyStrainsKeepFullRelativeAccuracy) {
    const double nearly_incompressible = 0.4995;  // K/G = 1000
    const double shear = E / (2 * (1 + nearly_incompressible));
    const double lame = 2 * shear * nearly_incompressible / (1 - 2 * nearly_incompressible);
    for (const double wanted : {1e-9, 1e-10, 1e-11, 1e-12}) {
        const double h = (1.0 + wanted) - 1.0;  // what F11 = 1 + h holds
        for (int uj = 0; uj < 3; ++uj) {
            const Numbers props = {E, nearly_incompressible, double(uj)};
            const double mean = uj == 0   ? lame * h * (2 + h) / (2 * (1 + h))
                                : uj == 1 ? lame * h
                                          : lame * std::log1p(h) / (1 + h);
            const double s11 = shear * h * (2 + h) / (1 + h) + mean;
            for (const AnalysisKind kind : {solid, plane_strain}) {
                const Answer a = at(kind, props, diagonal(1 + h, 1, 1));
                EXPECT_NEAR(a.stress[0], s11, 1e-15 * s11);
                EXPECT_NEAR(a.stress[1], mean, 1e-15 * mean);
                EXPECT_NEAR(a.sse, 0.5 * s11 * h, 1e-8 * s11 * h);
            }
            // isochoric to first order: the deviatoric part must not drown in the bulk
            const double g = wanted;
            const Answer sheared = at(solid, props, simple_shear(g));
            EXPECT_DOUBLE_EQ(sheared.stress[3], shear * g);
            EXPECT_DOUBLE_EQ(sheared.stress[0], shear * g * g);
            EXPECT_EQ(sheared.stress[1], 0.0);
            EXPECT_NEAR(sheared.sse, 0.5 * shear * g * g, 1e-15 * shear * g * g);

            // plane stress, stretched in one direction and held in the other: to first order in h the linear sheet
            const Answer sheet = at(plane_stress, props, diagonal(1 + h, 1, 1));
            const double stiffness = E / (1 - nearly_incompressible * nearly_incompressible);
            EXPECT_NEAR(sheet.stress[0], stiffness * h, 4 * h * stiffness * h + 1e-15 * stiffness * h * 10);
            EXPECT_NEAR(sheet.state[1], -nearly_incompressible / (1 - nearly_incompressible) * h,
                        4 * h * h + 1e-14 * h);
        }
    }
}

// Long double gives the reference; sheets of moderate and tiny strain.
TEST(NeoHookean, PlaneStressThicknessToRounding) {
    using Long = long double;
    const Long g = 1.0L / (2 * (1 + (Long)nu)), l = (Long)nu / ((1 + (Long)nu) * (1 - 2 * (Long)nu));  // E = 1
    for (const double strain : {1e-12, 1e-9, 1e-6, 1e-3, 0.1, 1.0, 9.0}) {
        for (int uj = 0; uj < 3; ++uj) {
            const Matrix3d f = diagonal(1 + strain, 1 - 0.05 * strain, 1);
            const Long h1 = (Long)f(0, 0) - 1, h2 = (Long)f(1, 1) - 1, q = h1 + h2 + h1 * h2;
            // residual G b33 + J U' in d = F33 - 1, by bisection
            Long lower = -1 + 1e-9L, upper = 0;
            for (int i = 0; i < 300; ++i) {
                const Long d = (lower + upper) / 2, j = q + d + q * d, J = 1 + j;
                const Long pressure = uj == 0 ? l * j * (2 + j) / 2 : uj == 1 ? l * j * J : l * log1pl(j);
                (g * d * (2 + d) + pressure > 0 ? upper : lower) = d;
            }
            EXPECT_NEAR(at(plane_stress, {E, nu, double(uj)}, f).state[1] / static_cast<double>(lower), 1.0, 4e-15)
                << "strain " << strain << ", UJ " << uj;
        }
    }
}

TEST(NeoHookean, EnergyIsTheStoredEnergyPerCurrentVolume) {
    for (int uj = 0; uj < 3; ++uj) {
        const double J = general.determinant(), I1 = (general * general.transpose()).trace();
        const double W = G / 2 * (I1 - 3 - 2 * std::log(J)) + dilatation.energy(uj, J);
        EXPECT_NEAR(at(solid, {E, nu, double(uj)}, general).sse, W / J, 1e-14 * W);
    }
}

TEST(NeoHookean, TangentAgainstCentralDifferences) { expect_tangent_of_differences(model, general); }

TEST(NeoHookean, WaveModulusAndBulkModulus) {
    const Matrix3d f = diagonal(1.4, 0.9, 0.8);
    const double J = f.determinant(), I1 = f.squaredNorm();
    for (int uj = 0; uj < 3; ++uj) {
        const Answer a = at(solid, {E, nu, double(uj)}, f);
        const double second = dilatation.second_derivative(uj, J);
        for (int i = 0; i < 3; ++i)
            EXPECT_NEAR(a.tangent(i, i) - a.stress[std::size_t(i)], (G * (f(i, i) * f(i, i) + 1) + J * J * second) / J,
                        1e-14 * E * 10);
        const double mean = (a.stress[0] + a.stress[1] + a.stress[2]) / 3;
        const double bulk = a.tangent.topLeftCorner(3, 3).sum() / 9 - mean;
        EXPECT_NEAR(bulk, J * second + G * (9 - I1) / (9 * J), 1e-14 * E * 10);
    }
}

TEST(NeoHookean, AnyNumberOfIncrementsGivesTheSameAnswer) { expect_no_integration_error(model, in_plane); }

// A sheet is a solid with the thickness stretch that it reports: every option, both signs of NU.
TEST(NeoHookean, SheetIsASolidWithoutStress33) {
    for (const double poisson : {-0.4, 0.0, 0.25, 0.49, 0.49999})
        for (int uj = 0; uj < 3; ++uj)
            for (const Matrix3d& f : {in_plane, simple_shear(2.0), diagonal(0.7, 0.8, 1), diagonal(1.2, 1.1, 1)}) {
                const Numbers props = {E, poisson, double(uj)};
                const Answer sheet = material(plane_stress, props).step({.dfgrd1 = f});
                if (!sheet.done()) {
                    EXPECT_LT(poisson, 0.0);
                    continue;
                }
                Matrix3d full = f;
                full(2, 2) = 1 + sheet.state[1];
                const Answer a = at(solid, props, full);
                const double scale = a.tangent.cwiseAbs().maxCoeff();
                EXPECT_NEAR(a.stress[2], 0.0, 4e-15 * scale);
                EXPECT_NEAR(a.stress[0], sheet.stress[0], 4e-15 * scale);
                EXPECT_NEAR(a.stress[3], sheet.stress[2], 4e-15 * scale);
                EXPECT_NEAR(a.sse, sheet.sse, 1e-14 * scale);
            }
}

// --- 1.1: what of DFGRD1 is read ---------------------------------------------------------------------------------

TEST(NeoHookean, PlaneKindsReadThePlaneOnly) { expect_plane_kinds_read_the_plane(model); }

TEST(NeoHookean, StressOnEntryAndStrainsAreIgnored) {
    UmatPoint p = material(solid, {E, nu});
    p.stress({1, 2, 3, 4, 5, 6});
    EXPECT_TRUE(identical(p.advance({.dstran = {9, 9, 9, 9, 9, 9}, .dfgrd1 = general}).stress,
                          at(solid, {E, nu}, general).stress));
}

TEST(NeoHookean, DeformationGradientIsReadInFortranOrder) { expect_fortran_order(model, principal_stress); }

TEST(NeoHookean, EqualStretchesSmallVolumesAndStretchesOfTen) { expect_accurate_stress(model, principal_stress); }

TEST(NeoHookean, GeneralTinyStrainsFollowHooke) { expect_hooke_at_tiny_strains(model, isotropic_stiffness(lambda, G)); }

TEST(NeoHookean, SeveralTurnsLeaveNothing) { expect_objective_over_turns(model); }

// --- the explicit interface (1.7) --------------------------------------------------------------------------------

TEST(NeoHookean, ExplicitAnswerIsTheImplicitOneAtTheStretch) {
    expect_explicit_is_implicit(model, general.transpose() * general);
}

TEST(NeoHookean, ExplicitHostIsToldWhichPointHasInverted) { expect_inverted_point_is_named(model); }

// --- 3.3 and 1.1: where it fails ---------------------------------------------------------------------------------

TEST(NeoHookean, InvertedOrNonFiniteDeformationAsksForLess) { expect_impossible_deformations_cut(model); }

TEST(NeoHookean, ExtremeButPossibleDeformationsStayFinite) {
    for (int uj = 0; uj < 3; ++uj)
        for (const double l : {1e-30, 1e-8, 1e-3, 1e3, 1e20}) {
            const Answer a = at(solid, {E, nu, double(uj)}, diagonal(l, 1, 1));
            const double mean = dilatation.derivative(uj, l);
            EXPECT_NEAR(a.stress[0] / (G * (l - 1 / l) + mean), 1.0, 1e-13);
            EXPECT_TRUE(std::isfinite(a.tangent.sum()));
            const Answer sheet = at(plane_stress, {E, nu, double(uj)}, diagonal(l, 1, 1));
            EXPECT_TRUE(std::isfinite(sheet.stress[0]) && std::isfinite(sheet.tangent.sum())) << uj << " " << l;
        }
}

TEST(NeoHookean, HydrostaticTensionHasAMaximumWithTheLogarithmicEnergy) {
    const auto pressure = [](double poisson, int uj, double J) {
        const double l = std::cbrt(J);
        return at(solid, {E, poisson, double(uj)}, diagonal(l, l, l)).stress[0];
    };
    EXPECT_NEAR(pressure(nu, 2, 3.25), 3.5054, 5e-5);
    EXPECT_GT(pressure(nu, 2, 3.25), pressure(nu, 2, 3.15));
    EXPECT_GT(pressure(nu, 2, 3.25), pressure(nu, 2, 3.35));
    const double top = std::pow(3.0, 1.5);
    for (int uj = 0; uj < 3; ++uj) {
        EXPECT_GT(pressure(0, uj, top), pressure(0, uj, top - 0.01));
        EXPECT_GT(pressure(0, uj, top), pressure(0, uj, top + 0.01));
    }
    for (double J = 1; J < 1e3; J *= 1.1)
        for (int uj = 0; uj < 2; ++uj) EXPECT_GT(pressure(0.01, uj, 1.1 * J), pressure(0.01, uj, J));
}

// NU < 0: no thickness stretch solves the sheet beyond a limit of the area ratio p.
TEST(NeoHookean, AuxeticSheetBeyondItsLimitAsksForLess) {
    const double poisson = -0.4, shear = E / (2 * (1 + poisson));
    const double lame = E * poisson / ((1 + poisson) * (1 - 2 * poisson));
    const auto sheet = [&](int uj, double p) {
        return material(plane_stress, {E, poisson, double(uj)})
            .step({.dfgrd1 = diagonal(std::sqrt(p), std::sqrt(p), 1)});
    };
    const double limit0 = std::sqrt(-2 * shear / lame), limit1 = std::sqrt(-shear / lame);
    const double bottom = 0.5 * std::log(-lame / (2 * shear));
    const double limit2 = std::exp((shear + lame / 2) / lame - bottom);
    EXPECT_TRUE(sheet(0, 0.999 * limit0).done());
    EXPECT_EQ(sheet(0, 1.001 * limit0).pnewdt, 0.25);
    EXPECT_TRUE(sheet(1, 0.999 * limit1).done());
    EXPECT_EQ(sheet(1, 1.001 * limit1).pnewdt, 0.25);
    EXPECT_TRUE(sheet(2, 1.001 * limit2).done());
    EXPECT_EQ(sheet(2, 0.999 * limit2).pnewdt, 0.25);
}

TEST(NeoHookean, BadConstantsAreRefusedByName) {
    const auto message = [](const Numbers& props) {
        char text[512] = "";
        EXPECT_EQ(lode_required_state("NEO_HOOKEAN-BAD", props.data(), int(props.size()), 3, 3, text, sizeof text), -1);
        return std::string(text);
    };
    EXPECT_NE(message({E}).find("needs at least 2 constants"), std::string::npos);
    EXPECT_NE(message({0, nu}).find("PROPS(1) = 0 (E, Young's modulus) must be > 0"), std::string::npos);
    EXPECT_NE(message({E, 0.5}).find("PROPS(2) = 0.5 (NU, Poisson's ratio) must be (-1, 0.5)"), std::string::npos);
    EXPECT_NE(message({E, nu, 3}).find("UJ"), std::string::npos);
    EXPECT_NE(message({E, nu, 0.5}).find("an integer 0..2"), std::string::npos);
    EXPECT_NE(message({E, nu, 0, HUGE_VAL}).find("ALPHA"), std::string::npos);
    const Numbers good = {E, nu};
    char text[512];
    EXPECT_EQ(lode_required_state("NEO_HOOKEAN", good.data(), 2, 3, 3, text, sizeof text), 2);
    EXPECT_EQ(lode_required_state("NEO_HOOKEAN", good.data(), 2, 1, 0, text, sizeof text), -1);  // 1D is not served
    EXPECT_EQ(lode_required_state("NEO_HOOKEAN", good.data(), 2, 1, 2, text, sizeof text), -1);  // nor is cohesive
}

}  // namespace
}  // namespace lode::test::test_neo_hookean
