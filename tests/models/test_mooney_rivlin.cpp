// MOONEY_RIVLIN: the verification cases and failure modes of page 50, sections 1 and 2.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "hyperelastic.hpp"
#include "lode/hyperelastic/mooney_rivlin.hpp"

namespace lode::test::test_mooney_rivlin {
namespace {

constexpr AnalysisKind solid = AnalysisKind::solid, plane_strain = AnalysisKind::plane_strain,
                       plane_stress = AnalysisKind::plane_stress;
constexpr double G1 = 1.0, K = 10.0, G2 = 0.4;
constexpr double printed = fourteen_digits;

const Matrix3d in_plane = matrix(1.5, 0.2, 0.0, 0.0, 0.9, 0.0, 0.0, 0.0, 7.7);  // plane stress: F33 is not read
Numbers props(int uj) { return {G1, K, G2, double(uj)}; }

UmatPoint material(AnalysisKind kind, Numbers constants) {
    return UmatPoint("MOONEY_RIVLIN-TEST", kind, std::move(constants));
}
Answer at(AnalysisKind kind, const Numbers& constants, const Matrix3d& f, double dtemp = 0.0) {
    return material(kind, constants).advance({.dtemp = dtemp, .dfgrd1 = f});
}
const HyperelasticModel model = {
    "MOONEY_RIVLIN-TEST", [](int uj, double alpha, double beta) { return Numbers{G1, K, G2, double(uj), alpha, beta}; },
    K, 1, 2};
const DilatationalEnergies dilatation = {K};
LongVector principal_stress(const LongVector& l, int uj) {
    const Long J = l.prod(), k = K;
    const Long mean = uj == 0 ? k / 2 * (J - 1 / J) : uj == 1 ? k * (J - 1) : k * std::log(J) / J;
    const LongVector b = l.array().square().matrix() / std::pow(J, Long(2) / 3);
    const LongVector shape = Long(G1) * b + Long(G2) * (b.sum() * b - b.array().square().matrix());
    return ((shape.array() - shape.sum() / 3) / J + mean).matrix();
}

// --- 2.6, the printed table --------------------------------------------------------------------------------------

TEST(MooneyRivlin, SimpleShearDoesNotDependOnTheDilatationalEnergy) {
    for (int uj = 0; uj < 3; ++uj)
        expect_close({0.128, -0.096, -0.032, 0.56, 0, 0}, at(solid, props(uj), simple_shear(0.4)).stress, 1e-15);
}

TEST(MooneyRivlin, ConstrainedUniaxialTable) {
    const double table[3][2] = {
        {3.05067019313, 2.4554341342042}, {3.3968240392839, 2.8015879803581}, {2.4150106890338, 1.819774630108}};
    for (int uj = 0; uj < 3; ++uj) {
        const auto [s11, s22] = table[uj];
        expect_close({s11, s22, s22, 0, 0, 0}, at(solid, props(uj), diagonal(1.3, 1, 1)).stress, 1e-12);
        expect_close({s11, s22, s22, 0}, at(plane_strain, props(uj), diagonal(1.3, 1, 1)).stress, 1e-12);
    }
}

TEST(MooneyRivlin, HydrostaticTable) {
    const double table[3] = {-7.205625, -4.88, -13.074817459817};
    for (int uj = 0; uj < 3; ++uj)
        expect_close({table[uj], table[uj], table[uj], 0, 0, 0}, at(solid, props(uj), diagonal(0.8, 0.8, 0.8)).stress);
}

TEST(MooneyRivlin, GeneralDeformation) {
    const Answer a = at(solid, props(0), general);
    expect_close(
        {1.5593443372669, 0.43002005050543, 1.0927294750436, 0.47443263554026, -0.56035074834819, 0.48947637681683},
        a.stress);
    const double row1[6] = {13.282176711595,  10.040374159007,    9.917449129398,
                            0.03290916755208, -0.082938835192092, -0.0276930890474};
    const double row4[6] = {0.03290916755208, 0.03290916755208, -0.065818335104159,
                            1.5471259962107,  0.02076981678555, -0.12440825278814};
    for (int j = 0; j < 6; ++j) {
        EXPECT_NEAR(a.tangent(0, j), row1[j], printed * row1[0]);
        EXPECT_NEAR(a.tangent(j, 0), row1[j], printed * row1[0]);
        EXPECT_NEAR(a.tangent(3, j), row4[j], printed * row1[0]);
        EXPECT_NEAR(a.tangent(j, 3), row4[j], printed * row1[0]);
    }
    EXPECT_NEAR(a.tangent(1, 1), 12.987075591263, printed * row1[0]);
    EXPECT_NEAR(a.tangent(2, 2), 13.110000620872, printed * row1[0]);
    EXPECT_NEAR(a.tangent(1, 2), 10.21255024973, printed * row1[0]);
    EXPECT_NEAR(a.tangent(4, 4), 1.6393197684177, printed * row1[0]);
    EXPECT_NEAR(a.tangent(5, 5), 1.4179939281686, printed * row1[0]);
    EXPECT_NEAR(a.tangent(4, 5), 0.049363751328119, printed * row1[0]);
}

TEST(MooneyRivlin, PlaneStressTable) {
    const double table[3][4] = {{1.9075461831495, 0.27971332379349, 0.19797967208384, -0.20328669393919},
                                {1.9174455872192, 0.28502858039197, 0.19853720353304, -0.20487718104664},
                                {1.884558570233, 0.26737755933377, 0.19668417700126, -0.19955876868612}};
    for (int uj = 0; uj < 3; ++uj) {
        const auto [s11, s22, s12, f33m1] = table[uj];
        const Answer a = at(plane_stress, props(uj), in_plane);
        expect_close({s11, s22, s12}, a.stress);
        EXPECT_NEAR(a.state[1], f33m1, printed);
    }
}

TEST(MooneyRivlin, HeldAndHeated) {
    const double table[3] = {-0.30004500202504, -0.29554466451492, -0.30913636018606};
    for (int uj = 0; uj < 3; ++uj) {
        const Answer a = at(solid, {G1, K, G2, double(uj), 1e-4}, Matrix3d::Identity(), 100.0);
        expect_close({table[uj], table[uj], table[uj], 0, 0, 0}, a.stress);
        EXPECT_NEAR(a.state[0], 0.01, 1e-17);
    }
}

TEST(MooneyRivlin, SimpleTensionTable) {
    const double table[3][3] = {{1.1209972664197, 0.74866456655157, 3.4340164647337},
                                {1.1154734882597, 0.74681774492165, 3.4642046477912},
                                {1.1354741373113, 0.75348329022989, 3.3567556050752}};
    for (int uj = 0; uj < 3; ++uj) {
        const auto [J, lateral, s11] = table[uj];
        EXPECT_NEAR(2 * lateral * lateral, J, printed * 2);
        expect_close({s11, 0, 0, 0, 0, 0}, at(solid, props(uj), diagonal(2, lateral, lateral)).stress, 1e-12);
        // the sheet finds its thickness by itself
        const Answer sheet = at(plane_stress, props(uj), diagonal(2, lateral, 0));
        expect_close({s11, 0, 0}, sheet.stress, 1e-12);
        EXPECT_NEAR(1 + sheet.state[1], lateral, 1e-12);
    }
}

TEST(MooneyRivlin, TinyStrainsKeepFullRelativeAccuracy) {
    const double h = std::ldexp(1.0, -33);
    for (const AnalysisKind kind : {solid, plane_strain}) {
        const Answer a = at(kind, {1, 1000, 0.5}, diagonal(1 + h, 1, 1));
        EXPECT_NEAR(a.stress[0], 1.1664815246377e-7, 1.2e-19);
        EXPECT_NEAR(a.stress[1], 1.1629890649835e-7, 1.2e-19);
        EXPECT_NEAR(a.stress[2], 1.1629890649835e-7, 1.2e-19);
        EXPECT_NEAR(a.sse, 0.5 * a.stress[0] * h, 1e-8 * a.sse);
    }
    // shear at any size, and its energy, are not lost beside a large bulk modulus
    for (const double g : {1e-12, 1e-9, 1e-6}) {
        const Answer a = at(solid, {1, 1000, 0.5}, simple_shear(g));
        EXPECT_DOUBLE_EQ(a.stress[3], 1.5 * g);
        EXPECT_NEAR(a.sse, 0.75 * g * g, 1e-15 * g * g);
    }
    // a sheet stretched in one direction and held in the other is the linear one to first order
    const double shear = 1.5, bulk = 1000, nu = (1.5 * bulk - shear) / (3 * bulk + shear);
    const double stiffness = 2 * shear / (1 - nu);
    const Answer sheet = at(plane_stress, {1, bulk, 0.5}, diagonal(1 + h, 1, 1));
    EXPECT_NEAR(sheet.stress[0], stiffness * h, 1e-9 * stiffness * h);
    EXPECT_NEAR(sheet.state[1], -nu / (1 - nu) * h, 1e-9 * h);
}

// --- 2.4, closed solutions ---------------------------------------------------------------------------------------

TEST(MooneyRivlin, ClosedSolutions) {
    for (int uj = 0; uj < 3; ++uj) {
        for (const double g : {0.01, 0.7, 3.0})
            expect_close(
                {g * g / 3 * (2 * G1 + G2), -g * g / 3 * (G1 + 2 * G2), g * g / 3 * (G2 - G1), g * (G1 + G2), 0, 0},
                at(solid, props(uj), simple_shear(g)).stress, 1e-14);
        for (const double l : {0.4, 0.9, 1.1, 2.5}) {
            const double mean = dilatation.derivative(uj, l);
            const double dev = 2 * (l * l - 1) / (3 * std::pow(l, 5. / 3)) * (G1 + G2 * std::pow(l, -2. / 3));
            expect_close({mean + dev, mean - dev / 2, mean - dev / 2, 0, 0, 0},
                         at(solid, props(uj), diagonal(l, 1, 1)).stress, 2e-14);
            const double pressure = dilatation.derivative(uj, l * l * l);
            expect_close({pressure, pressure, pressure, 0, 0, 0}, at(solid, props(uj), diagonal(l, l, l)).stress,
                         1e-13);
        }
    }
}

// With residual strain J = 1 but J* = exp(-3 e): the errata of the page to 9.6.5.
TEST(MooneyRivlin, SimpleShearWithResidualStrain) {
    const double g = 0.3, e = 0.02;
    for (int uj = 0; uj < 3; ++uj) {
        const double mean = dilatation.derivative(uj, std::exp(-3 * e)), jres = std::exp(3 * e);
        expect_close({mean + jres * g * g / 3 * (2 * G1 + G2), mean - jres * g * g / 3 * (G1 + 2 * G2),
                      mean + jres * g * g / 3 * (G2 - G1), jres * g * (G1 + G2), 0, 0},
                     at(solid, {G1, K, G2, double(uj), e}, simple_shear(g), 1.0).stress, 1e-14);
    }
}

TEST(MooneyRivlin, MoistureActsAsHeatDoes) {
    UmatPoint wet = material(solid, {G1, K, G2, 2, 1e-4, 3e-3});
    const Answer a = wet.advance({.dtemp = 50.0, .dpred = {2.0}, .dfgrd1 = general});
    EXPECT_NEAR(a.state[0], 0.011, 1e-17);
    expect_close(at(solid, {G1, K, G2, 2, 0.011}, general, 1.0).stress, a.stress, 1e-14);
}

TEST(MooneyRivlin, FreeExpansionIsFreeOfStress) {
    const double l = std::exp(0.05);
    for (const AnalysisKind kind : {solid, plane_strain, plane_stress}) {
        const Answer a = at(kind, {G1, K, G2, 0, 1e-3}, diagonal(l, l, l), 50.0);
        EXPECT_LT(largest(a.stress), 2e-15 * K);
        EXPECT_LT(std::abs(a.sse), 1e-29 * K);
        if (kind == plane_stress) {
            EXPECT_NEAR(a.state[1], l - 1, 1e-15);
        }
    }
}

TEST(MooneyRivlin, WithoutG2ItIsTheSplitNeoHookeanSolid) {
    const double J = general.determinant();
    const Matrix3d b = general * general.transpose() / std::cbrt(J * J);
    const Matrix3d s =
        (b - b.trace() / 3 * Matrix3d::Identity()) / J + dilatation.derivative(1, J) * Matrix3d::Identity();
    expect_close(to_components(s, solid, 1.0), at(solid, {1, K, 0, 1}, general).stress, 1e-14);
}

// --- 1.x: energies, tangents, increments -------------------------------------------------------------------------

TEST(MooneyRivlin, EnergyIsTheStoredEnergyPerCurrentVolume) {
    for (int uj = 0; uj < 3; ++uj) {
        const double J = general.determinant();
        const Matrix3d b = general * general.transpose() / std::cbrt(J * J);
        const double I1 = b.trace(), I2 = 0.5 * (I1 * I1 - (b * b).trace());
        const double W = G1 / 2 * (I1 - 3) + G2 / 2 * (I2 - 3) + dilatation.energy(uj, J);
        EXPECT_NEAR(at(solid, props(uj), general).sse, W / J, 1e-14 * W);
    }
}

TEST(MooneyRivlin, TangentAgainstCentralDifferences) { expect_tangent_of_differences(model, general); }

TEST(MooneyRivlin, WaveModulus) {
    const Matrix3d f = diagonal(1.4, 0.9, 0.8);
    const double J = f.determinant();
    const Matrix3d b = f * f / std::cbrt(J * J);
    const double I1 = b.trace(), I2 = 0.5 * (I1 * I1 - (b * b).trace());
    for (int uj = 0; uj < 3; ++uj) {
        const Answer a = at(solid, props(uj), f);
        for (int i = 0; i < 3; ++i) {
            const double m = I1 * b(i, i) - b(i, i) * b(i, i);
            EXPECT_NEAR(a.tangent(i, i) - a.stress[std::size_t(i)],
                        J * dilatation.second_derivative(uj, J) +
                            (G1 * (5 * I1 - 3 * b(i, i)) / 9 + G2 * (14 * I2 - 15 * m) / 9) / J,
                        1e-13 * K);
        }
    }
}

TEST(MooneyRivlin, AnyNumberOfIncrementsGivesTheSameAnswer) { expect_no_integration_error(model, in_plane); }

// A sheet is a solid with the thickness stretch that it reports: every option, stiff and soft, far from the start.
TEST(MooneyRivlin, SheetIsASolidWithoutStress33) {
    for (const double bulk : {0.5, 10.0, 1e3, 1e6})
        for (const double second : {0.0, 0.4})
            for (int uj = 0; uj < 3; ++uj)
                for (const Matrix3d& f :
                     {in_plane, simple_shear(2.0), diagonal(0.7, 0.8, 1), diagonal(1.2, 1.1, 1), diagonal(6, 5, 1),
                      diagonal(0.1, 9, 1), diagonal(0.5, 0.4, 1), diagonal(1 + 1e-9, 1, 1)}) {
                    const Numbers constants = {G1, bulk, second, double(uj)};
                    const Answer sheet = at(plane_stress, constants, f);
                    Matrix3d full = f;
                    full(2, 2) = 1 + sheet.state[1];
                    const Answer a = at(solid, constants, full);
                    const double scale = a.tangent.cwiseAbs().maxCoeff();
                    EXPECT_NEAR(a.stress[2], 0.0, 2e-14 * scale) << bulk << " " << uj << "\n" << f;
                    EXPECT_NEAR(a.stress[0], sheet.stress[0], 2e-14 * scale);
                    EXPECT_NEAR(a.stress[3], sheet.stress[2], 2e-14 * scale);
                    EXPECT_NEAR(a.sse, sheet.sse, 1e-13 * scale);
                }
}

// Long double gives the reference; sheets of tiny to large strain.
TEST(MooneyRivlin, PlaneStressThicknessToRounding) {
    using Long = long double;
    for (const double strain : {1e-12, 1e-9, 1e-6, 1e-3, 0.1, 1.0, 9.0}) {
        for (int uj = 0; uj < 3; ++uj) {
            const Matrix3d f = diagonal(1 + strain, 1 - 0.05 * strain, 1);
            const Long h1 = (Long)f(0, 0) - 1, h2 = (Long)f(1, 1) - 1, q = h1 + h2 + h1 * h2;
            const Long x = h1 * (2 + h1), y = h2 * (2 + h2);
            Long lower = -1 + 1e-9L, upper = 0;
            for (int i = 0; i < 300; ++i) {
                const Long d = (lower + upper) / 2, z = d * (2 + d), j = q + d + q * d, J = 1 + j, c = cbrtl(J);
                const Long mean = uj == 0 ? K * j * (2 + j) / 2 : uj == 1 ? K * j * J : K * log1pl(j);
                const Long g = (Long)G1 / (c * c) * (2 * z - x - y) / 3 +
                               (Long)G2 / (c * c * c * c) * (2 * z - (x + y) + z * (x + y) - 2 * x * y) / 3 + mean;
                (g > 0 ? upper : lower) = d;
            }
            EXPECT_NEAR(at(plane_stress, {G1, K, G2, double(uj)}, f).state[1] / static_cast<double>(lower), 1.0, 1e-14)
                << "strain " << strain << ", UJ " << uj;
        }
    }
}

// --- 1.1: what of DFGRD1 is read ---------------------------------------------------------------------------------

TEST(MooneyRivlin, PlaneKindsReadThePlaneOnly) { expect_plane_kinds_read_the_plane(model); }

TEST(MooneyRivlin, DeformationGradientIsReadInFortranOrder) { expect_fortran_order(model, principal_stress); }

TEST(MooneyRivlin, EqualStretchesSmallVolumesAndStretchesOfTen) { expect_accurate_stress(model, principal_stress); }

TEST(MooneyRivlin, GeneralTinyStrainsFollowHooke) {
    expect_hooke_at_tiny_strains(model, isotropic_stiffness(K - 2 * (G1 + G2) / 3, G1 + G2));
}

TEST(MooneyRivlin, SeveralTurnsLeaveNothing) { expect_objective_over_turns(model); }

// --- the explicit interface (1.7) --------------------------------------------------------------------------------

TEST(MooneyRivlin, ExplicitAnswerIsTheImplicitOneAtTheStretch) {
    expect_explicit_is_implicit(model, general.transpose() * general);
}

TEST(MooneyRivlin, ExplicitHostIsToldWhichPointHasInverted) { expect_inverted_point_is_named(model); }

// --- 2.5 and 1.1: where it fails ---------------------------------------------------------------------------------

TEST(MooneyRivlin, InvertedOrNonFiniteDeformationAsksForLess) { expect_impossible_deformations_cut(model); }

TEST(MooneyRivlin, HydrostaticTensionHasAMaximumWithTheLogarithmicEnergy) {
    const auto pressure = [](int uj, double J) {
        const double l = std::cbrt(J);
        return at(solid, props(uj), diagonal(l, l, l)).stress[0];
    };
    EXPECT_NEAR(pressure(2, std::exp(1.0)), K / std::exp(1.0), 1e-13 * K);
    EXPECT_LT(pressure(2, 2.6), K / std::exp(1.0));
    EXPECT_LT(pressure(2, 2.8), K / std::exp(1.0));
    EXPECT_NEAR(pressure(1, 1e-3), -K * (1 - 1e-3), 1e-7 * K);  // crushed at a finite pressure
    EXPECT_NEAR(pressure(0, 1e-3), -K * (1e3 - 1e-3) / 2, 1e-7 * K);
}

// UJ = 2: the smallest lateral stretch of simple tension and where it is. UJ 0, 1 stay monotone.
TEST(MooneyRivlin, LateralContractionReversesWithTheLogarithmicEnergy) {
    const auto lateral = [](double bulk, int uj, double l) {
        double lower = 1e-3, upper = 3.0;
        for (int i = 0; i < 100; ++i) {
            const double middle = 0.5 * (lower + upper);
            (at(solid, {1, bulk, 0, double(uj)}, diagonal(l, middle, middle)).stress[1] > 0 ? upper : lower) = middle;
        }
        return lower;
    };
    const double table[3][3] = {{1, 0.9706, 1.6}, {3, 0.7853, 3.2}, {10, 0.5882, 6.1}};
    for (const auto& [ratio, smallest, l] : table) {
        EXPECT_NEAR(lateral(ratio, 2, l), smallest, 1e-4);
        EXPECT_GT(lateral(ratio, 2, 0.9 * l), smallest);
        EXPECT_GT(lateral(ratio, 2, 1.1 * l), smallest);
        for (int uj = 0; uj < 2; ++uj)
            for (double stretch = 1; stretch < 10; stretch *= 1.5)
                EXPECT_LT(lateral(ratio, uj, 1.5 * stretch), lateral(ratio, uj, stretch));
    }
}

TEST(MooneyRivlin, BadConstantsAreRefusedByName) {
    const auto message = [](const Numbers& constants) {
        char text[512] = "";
        EXPECT_EQ(
            lode_required_state("MOONEY_RIVLIN-BAD", constants.data(), int(constants.size()), 3, 3, text, sizeof text),
            -1);
        return std::string(text);
    };
    EXPECT_NE(message({G1}).find("needs at least 2 constants"), std::string::npos);
    EXPECT_NE(message({-1, K}).find("PROPS(1) = -1 (G1, first shear constant) must be >= 0"), std::string::npos);
    EXPECT_NE(message({G1, 0}).find("PROPS(2) = 0 (K, bulk modulus) must be > 0"), std::string::npos);
    EXPECT_NE(message({G1, K, -0.1}).find("PROPS(3) = -0.1 (G2, second shear constant) must be >= 0"),
              std::string::npos);
    EXPECT_NE(message({0, K}).find("PROPS(1) = 0 (G1, first shear constant) must be > 0 where G2 = 0"),
              std::string::npos);
    EXPECT_NE(message({G1, K, G2, 3}).find("UJ"), std::string::npos);
    EXPECT_NE(message({G1, K, G2, 0.5}).find("an integer 0..2"), std::string::npos);
    EXPECT_NE(message({G1, K, G2, 0, HUGE_VAL}).find("ALPHA"), std::string::npos);
    const Numbers good = {0, K, G2};
    char text[512];
    EXPECT_EQ(lode_required_state("MOONEY_RIVLIN", good.data(), 3, 3, 3, text, sizeof text), 2);
    EXPECT_EQ(lode_required_state("MOONEY_RIVLIN", good.data(), 3, 1, 0, text, sizeof text), -1);  // 1D
    EXPECT_EQ(lode_required_state("MOONEY_RIVLIN", good.data(), 3, 1, 2, text, sizeof text), -1);  // cohesive
}

}  // namespace
}  // namespace lode::test::test_mooney_rivlin
