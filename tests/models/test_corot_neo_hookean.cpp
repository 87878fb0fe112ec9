// COROT_NEO_HOOKEAN: the verification cases and failure modes of page 50, sections 1 and 4.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "hyperelastic.hpp"
#include "lode/hyperelastic/corot_neo_hookean.hpp"

namespace lode::test::test_corot_neo_hookean {
namespace {

constexpr AnalysisKind solid = AnalysisKind::solid, plane_strain = AnalysisKind::plane_strain,
                       plane_stress = AnalysisKind::plane_stress;
constexpr double E = 10.0, nu = 0.3, G = E / (2 * (1 + nu)), lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
constexpr double printed = fourteen_digits;

const Matrix3d in_plane = matrix(1.5, 0.2, 0.0, 0.0, 0.9, 0.0, 0.0, 0.0, 7.7);  // plane stress: F33 is not read
Numbers props(int uj) { return {E, nu, double(uj)}; }

UmatPoint material(AnalysisKind kind, Numbers constants) {
    return UmatPoint("COROT_NEO_HOOKEAN-TEST", kind, std::move(constants));
}
Answer at(AnalysisKind kind, const Numbers& constants, const Matrix3d& f, double dtemp = 0.0) {
    return material(kind, constants).advance({.dtemp = dtemp, .dfgrd1 = f});
}

Matrix3d left_stretch(const Matrix3d& f) {
    return Eigen::SelfAdjointEigenSolver<Matrix3d>(f * f.transpose()).operatorSqrt();
}
const HyperelasticModel model = {"COROT_NEO_HOOKEAN-TEST",
                                 [](int uj, double alpha, double beta) {
                                     return Numbers{E, nu, double(uj), alpha, beta};
                                 },
                                 E, 1, 5.0 / 3};
const DilatationalEnergies dilatation = {lambda};
LongVector principal_stress(const LongVector& l, int uj) {
    const Long J = l.prod(), k = lambda, g = G;
    const Long mean = uj == 0 ? k / 2 * (J - 1 / J) : uj == 1 ? k * (J - 1) : k * std::log(J) / J;
    return (2 * g / J * l.array() * (l.array() - 1) + mean).matrix();
}

// --- 4.5, the printed table --------------------------------------------------------------------------------------

TEST(CorotNeoHookean, SimpleShearDoesNotDependOnTheDilatationalEnergy) {
    for (int uj = 0; uj < 3; ++uj)
        expect_close({0.77671438656774, 0.14937941776215, 0, 1.568337422014, 0, 0},
                     at(solid, props(uj), simple_shear(0.4)).stress);
}

TEST(CorotNeoHookean, ConstrainedUniaxialTable) {
    const double table[3][2] = {
        {3.8387573964497, 1.5310650887574}, {4.0384615384615, 1.7307692307692}, {3.4720307594711, 1.1643384517788}};
    for (int uj = 0; uj < 3; ++uj) {
        const auto [s11, s22] = table[uj];
        expect_close({s11, s22, s22, 0, 0, 0}, at(solid, props(uj), diagonal(1.3, 1, 1)).stress);
        expect_close({s11, s22, s22, 0}, at(plane_strain, props(uj), diagonal(1.3, 1, 1)).stress);
    }
    // UJ = 1 is the default
    EXPECT_TRUE(identical(at(solid, {E, nu}, general).stress, at(solid, {E, nu, 1}, general).stress));
}

TEST(CorotNeoHookean, HydrostaticTable) {
    const double table[3] = {-6.5609375, -5.2192307692308, -9.9470100729713};
    for (int uj = 0; uj < 3; ++uj)
        expect_close({table[uj], table[uj], table[uj], 0, 0, 0}, at(solid, props(uj), diagonal(0.8, 0.8, 0.8)).stress);
    const double triple = 5.2683760683761;
    expect_close({triple, triple, triple, 0, 0, 0}, at(solid, props(1), diagonal(1.2, 1.2, 1.2)).stress);
}

TEST(CorotNeoHookean, GeneralDeformation) {
    const Answer a = at(solid, props(1), general);
    expect_close(
        {3.7480925326604, 0.23776992991229, 2.009664648082, 1.1413317847222, -1.8532766185836, 0.9470090399437},
        a.stress);
    const double row1[6] = {21.970121897346, 7.126084109769,   7.1549412325715,
                            1.9418829194093, -2.7085512067933, -0.12336001783522};
    for (int j = 0; j < 6; ++j) {
        EXPECT_NEAR(a.tangent(0, j), row1[j], printed * row1[0]);
        EXPECT_NEAR(a.tangent(j, 0), row1[j], printed * row1[0]);
    }
    EXPECT_NEAR(a.tangent(3, 3), 4.8956284201718, printed * row1[0]);
}

TEST(CorotNeoHookean, PlaneStrainTension) {
    const double l = 1.3, ly = (2 * G + lambda * l) / (2 * G + lambda * l * l);
    EXPECT_NEAR(ly, 0.8710033076075, 1e-13);
    const Answer a = at(plane_strain, props(1), diagonal(1.3, 0.8710033076075, 1));
    expect_close({3.4127584974165, 0, 0.76329403782546, 0}, a.stress);
}

TEST(CorotNeoHookean, PlaneStressTable) {
    const double table[3][4] = {{6.0188551115355, 0.2488361284902, 0.7017590655055, -0.14533805195835},
                                {6.0706064000304, 0.2708327600758, 0.70537787512962, -0.14972273567468},
                                {5.8945210216601, 0.19538427055511, 0.69313825351277, -0.13470831116123}};
    for (int uj = 0; uj < 3; ++uj) {
        const auto [s11, s22, s12, f33m1] = table[uj];
        const Answer a = at(plane_stress, props(uj), in_plane);
        expect_close({s11, s22, s12}, a.stress);
        EXPECT_NEAR(a.state[1], f33m1, printed);
    }
}

// --- 4.3, closed solutions ---------------------------------------------------------------------------------------

TEST(CorotNeoHookean, ClosedSolutions) {
    for (int uj = 0; uj < 3; ++uj) {
        for (const double g : {0.05, 0.4, 2.0, 30.0}) {  // below that these expressions cancel
            const double r = std::sqrt(4 + g * g);
            expect_close({2 * G * (1 + g * g - (2 + g * g) / r), 2 * G * (1 - 2 / r), 0, 2 * G * (g - g / r), 0, 0},
                         at(solid, props(uj), simple_shear(g)).stress, 1e-13);
        }
        for (const double l : {0.4, 0.9, 1.1, 2.5}) {
            const double mean = dilatation.derivative(uj, l);
            expect_close({mean + 2 * G * (l - 1), mean, mean, 0, 0, 0}, at(solid, props(uj), diagonal(l, 1, 1)).stress,
                         1e-14);
            if (l < 0.5) continue;
            const double s = 2 * G * (l - 1) / (l * l) + dilatation.derivative(uj, l * l * l);
            expect_close({s, s, s, 0, 0, 0}, at(solid, props(uj), diagonal(l, l, l)).stress, 1e-13);
        }
    }
}

TEST(CorotNeoHookean, TheStressIsThatOfThePolarDecomposition) {
    for (int uj = 0; uj < 3; ++uj) {
        const double J = general.determinant();
        const Matrix3d v = left_stretch(general);
        const Matrix3d s = 2 * G / J * (v * v - v) + dilatation.derivative(uj, J) * Matrix3d::Identity();
        const Answer a = at(solid, props(uj), general);
        expect_close(to_components(s, solid, 1.0), a.stress, 1e-14);
        const double W = G * (v - Matrix3d::Identity()).squaredNorm() + dilatation.energy(uj, J);
        EXPECT_NEAR(a.sse, W / J, 1e-14 * W);
        const double l = std::exp(0.03);  // a free expansion of the reference
        const Answer grown = at(solid, {E, nu, double(uj), 1e-3}, l * general, 30.0);
        expect_close(a.stress, grown.stress, 1e-14);
        EXPECT_NEAR(a.sse, grown.sse, 1e-14 * W);
    }
}

TEST(CorotNeoHookean, MoistureActsAsHeatDoes) {
    UmatPoint wet = material(solid, {E, nu, 2, 1e-4, 3e-3});
    const Answer a = wet.advance({.dtemp = 50.0, .dpred = {2.0}, .dfgrd1 = general});
    EXPECT_NEAR(a.state[0], 0.011, 1e-17);
    expect_close(at(solid, {E, nu, 2, 0.011}, general, 1.0).stress, a.stress, 1e-14);
}

TEST(CorotNeoHookean, TinyStrainsKeepFullRelativeAccuracy) {
    for (const double wanted : {1e-9, 1e-10, 1e-12}) {
        const double h = (1.0 + wanted) - 1.0;
        for (const AnalysisKind kind : {solid, plane_strain}) {
            const Answer a = at(kind, {E, 0.4995}, diagonal(1 + h, 1, 1));
            const double g = E / (2 * 1.4995), lame = 2 * g * 0.4995 / 0.001;
            EXPECT_NEAR(a.stress[0], (lame + 2 * g) * h, 2e-15 * lame * h);
            EXPECT_NEAR(a.stress[1], lame * h, 2e-15 * lame * h);
        }
        const Answer sheared = at(solid, {E, 0.4995}, simple_shear(wanted));
        EXPECT_NEAR(sheared.stress[3], E / (2 * 1.4995) * wanted, 1e-14 * E * wanted);
        EXPECT_NEAR(sheared.sse, E / (4 * 1.4995) * wanted * wanted, 1e-13 * E * wanted * wanted);
        for (int uj = 0; uj < 3; ++uj) {
            const Answer sheet = at(plane_stress, {E, 0.4995, double(uj)}, diagonal(1 + h, 1, 1));
            EXPECT_NEAR(sheet.state[1], -0.4995 / 0.5005 * h, 4 * h * h + 1e-14 * h);
        }
    }
}

// --- tangents ----------------------------------------------------------------------------------------------------

// Also at equal stretches and where they differ so much that the closed form would cancel.
TEST(CorotNeoHookean, TangentAgainstCentralDifferences) {
    for (const Matrix3d& f : {general, diagonal(1, 1, 1), diagonal(1.2, 1.2, 1.2), diagonal(1.2, 1.2, 0.9),
                              simple_shear(0.5), simple_shear(60.0), Matrix3d(diagonal(60, 0.8, 0.7) * general)})
        expect_tangent_of_differences(model, f);
}

// The closed form of the tangent and the one in the eigenbasis of V (section 4.2).
TEST(CorotNeoHookean, TangentInTheEigenbasis) {
    const Answer a = at(solid, props(1), general);
    const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(general * general.transpose());
    const Eigen::Vector3d l = eigen.eigenvalues().cwiseSqrt();
    const Matrix3d n = eigen.eigenvectors();
    const double J = general.determinant();
    for (int column = 0; column < 6; ++column) {
        Numbers unit(6, 0.0);
        unit[std::size_t(column)] = 1;
        Matrix3d d = n.transpose() * strain_tensor(unit, solid) * n, rate;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                rate(i, j) = 2 * G * d(i, j) * (l(i) * l(i) + l(j) * l(j)) * (1 - 1 / (l(i) + l(j))) +
                             (i == j ? J * lambda * (2 * J - 1) * d.trace() : 0.0);
        const Numbers expected = to_components(n * rate * n.transpose() / J, solid, 1.0);
        for (int row = 0; row < 6; ++row) EXPECT_NEAR(a.tangent(row, column), expected[std::size_t(row)], 1e-13 * E);
    }
}

TEST(CorotNeoHookean, WaveModulusAndBulkModulus) {
    const Matrix3d f = diagonal(1.4, 0.9, 0.8);
    const double J = f.determinant();
    for (int uj = 0; uj < 3; ++uj) {
        const Answer a = at(solid, props(uj), f);
        for (int i = 0; i < 3; ++i)
            EXPECT_NEAR(a.tangent(i, i) - a.stress[std::size_t(i)],
                        (2 * G * f(i, i) * f(i, i) + J * J * dilatation.second_derivative(uj, J)) / J, 1e-13 * E);
        const double l = 1.3, J3 = l * l * l;  // (9.81)
        const Answer swollen = at(solid, props(uj), diagonal(l, l, l));
        EXPECT_NEAR(swollen.tangent.topLeftCorner(3, 3).sum() / 9 - swollen.stress[0],
                    J3 * dilatation.second_derivative(uj, J3) + 2 * G * (2 - l) / (3 * l * l), 1e-13 * E);
    }
}

TEST(CorotNeoHookean, AnyNumberOfIncrementsGivesTheSameAnswer) { expect_no_integration_error(model, in_plane); }

// A sheet is a solid with the thickness stretch that it reports: every option, both signs of NU.
TEST(CorotNeoHookean, SheetIsASolidWithoutStress33) {
    for (const double poisson : {-0.4, 0.0, 0.05, 0.25, 0.49, 0.49999})
        for (int uj = 0; uj < 3; ++uj)
            for (const Matrix3d& f : {in_plane, simple_shear(2.0), diagonal(0.7, 0.8, 1), diagonal(1.2, 1.1, 1),
                                      diagonal(3, 4, 1), diagonal(1 + 1e-9, 1, 1)}) {
                const Numbers constants = {E, poisson, double(uj)};
                const Answer sheet = material(plane_stress, constants).step({.dfgrd1 = f});
                if (!sheet.done()) {
                    EXPECT_LT(poisson, 0.0);
                    continue;
                }
                Matrix3d full = f;
                full(2, 2) = 1 + sheet.state[1];
                const Answer a = at(solid, constants, full);
                const double scale = a.tangent.cwiseAbs().maxCoeff();
                EXPECT_NEAR(a.stress[2], 0.0, 1e-14 * scale) << poisson << " " << uj << "\n" << f;
                EXPECT_NEAR(a.stress[0], sheet.stress[0], 1e-14 * scale);
                EXPECT_NEAR(a.stress[3], sheet.stress[2], 1e-14 * scale);
                EXPECT_NEAR(a.sse, sheet.sse, 1e-13 * scale);
            }
}

// --- the explicit interface (1.7) --------------------------------------------------------------------------------

TEST(CorotNeoHookean, PlaneKindsReadThePlaneOnly) { expect_plane_kinds_read_the_plane(model); }

TEST(CorotNeoHookean, DeformationGradientIsReadInFortranOrder) { expect_fortran_order(model, principal_stress); }

TEST(CorotNeoHookean, EqualStretchesSmallVolumesAndStretchesOfTen) { expect_accurate_stress(model, principal_stress); }

TEST(CorotNeoHookean, GeneralTinyStrainsFollowHooke) {
    expect_hooke_at_tiny_strains(model, isotropic_stiffness(lambda, G));
}

TEST(CorotNeoHookean, SeveralTurnsLeaveNothing) { expect_objective_over_turns(model); }

TEST(CorotNeoHookean, ExplicitAnswerIsTheImplicitOneAtTheStretch) {
    expect_explicit_is_implicit(model, general.transpose() * general, 2e-14);
}

TEST(CorotNeoHookean, ExplicitHostIsToldWhichPointHasInverted) { expect_inverted_point_is_named(model); }

// --- 4.4 and 1.1: where it fails ---------------------------------------------------------------------------------

TEST(CorotNeoHookean, InvertedOrNonFiniteDeformationAsksForLess) { expect_impossible_deformations_cut(model); }

// UJ = 1: linear in constrained compression, down to a finite stress at no length; UJ = 0, 2 resist.
TEST(CorotNeoHookean, ConstrainedCompressionReachesZeroLengthAtAFiniteStress) {
    EXPECT_NEAR(at(solid, props(1), diagonal(1e-6, 1, 1)).stress[0], -(lambda + 2 * G) * (1 - 1e-6), 1e-9 * E);
    EXPECT_LT(at(solid, props(0), diagonal(1e-9, 1, 1)).stress[0], -1e8 * E);
    EXPECT_LT(at(solid, props(2), diagonal(1e-9, 1, 1)).stress[0], -1e8 * E);
    for (const double l : {0.1, 0.5, 2.0})
        EXPECT_NEAR(at(solid, props(1), diagonal(l, 1, 1)).stress[0], (lambda + 2 * G) * (l - 1), 1e-14 * E);
}

// Where two principal stretches sum to less than 1 the Baker-Ericksen inequality fails: a warning, once a run.
TEST(CorotNeoHookean, SpuriousBucklingIsAnnounced) {
    const auto warnings = [](const char* label, const Matrix3d& f) {
        return UmatPoint(std::string("COROT_NEO_HOOKEAN-") + label, solid, props(1)).step({.dfgrd1 = f}).messages;
    };
    const Matrix3d q = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    EXPECT_TRUE(warnings("A", q * diagonal(0.55, 0.46, 2)).warnings.empty());
    EXPECT_TRUE(warnings("B", diagonal(0.2, 0.81, 0.9)).warnings.empty());
    const HostMessages first = warnings("C", q * diagonal(0.53, 0.46, 2) * q.transpose());
    ASSERT_EQ(first.warnings.size(), 1u);
    EXPECT_NE(first.warnings[0].find("buckle"), std::string::npos);
    EXPECT_EQ(warnings("D", diagonal(0.1, 0.2, 0.3)).stops, 0);
    // and there the difference of the principal stresses has the wrong sign
    const Answer a = at(solid, props(1), diagonal(0.53, 0.46, 2));
    EXPECT_LT(a.stress[0], a.stress[1]);
    const Answer b = at(solid, props(1), diagonal(0.55, 0.46, 2));
    EXPECT_GT(b.stress[0], b.stress[1]);
}

// NU < 0: no thickness stretch solves the sheet beyond a limit of the area ratio.
TEST(CorotNeoHookean, AuxeticSheetBeyondItsLimitAsksForLess) {
    const double poisson = -0.4, shear = E / (2 * (1 + poisson));
    const double lame = E * poisson / ((1 + poisson) * (1 - 2 * poisson));
    const auto sheet = [&](int uj, double p) {
        return material(plane_stress, {E, poisson, double(uj)})
            .step({.dfgrd1 = diagonal(std::sqrt(p), std::sqrt(p), 1)});
    };
    const double limit1 = std::sqrt(-2 * shear / lame);  // 2 G + lambda p^2 = 0
    EXPECT_TRUE(sheet(1, 0.999 * limit1).done());
    EXPECT_EQ(sheet(1, 1.001 * limit1).pnewdt, 0.25);
    const double limit0 = std::sqrt(-4 * shear / lame);  // 2 G + lambda p^2/2 = 0
    EXPECT_TRUE(sheet(0, 0.999 * limit0).done());
    EXPECT_EQ(sheet(0, 1.001 * limit0).pnewdt, 0.25);
    const double x = 0.25 * (1 + std::sqrt(1 - 4 * lame / shear));  // the minimum of 2 G x (x - 1) + lambda ln(p x)
    const double limit2 = std::exp(-2 * shear * x * (x - 1) / lame) / x;
    EXPECT_TRUE(sheet(2, 1.001 * limit2).done());
    EXPECT_EQ(sheet(2, 0.999 * limit2).pnewdt, 0.25);
}

TEST(CorotNeoHookean, BadConstantsAreRefusedByName) {
    const auto message = [](const Numbers& constants) {
        char text[512] = "";
        EXPECT_EQ(lode_required_state("COROT_NEO_HOOKEAN-BAD", constants.data(), int(constants.size()), 3, 3, text,
                                      sizeof text),
                  -1);
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
    EXPECT_EQ(lode_required_state("COROT_NEO_HOOKEAN", good.data(), 2, 3, 3, text, sizeof text), 2);
    EXPECT_EQ(lode_required_state("COROT_NEO_HOOKEAN", good.data(), 2, 1, 0, text, sizeof text), -1);  // 1D
    EXPECT_EQ(lode_required_state("COROT_NEO_HOOKEAN", good.data(), 2, 1, 2, text, sizeof text), -1);  // cohesive
}

}  // namespace
}  // namespace lode::test::test_corot_neo_hookean
