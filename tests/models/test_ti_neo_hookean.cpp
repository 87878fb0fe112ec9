// TI_NEO_HOOKEAN: the verification cases and failure modes of page 50, sections 1 and 5.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "hyperelastic.hpp"
#include "lode/hyperelastic/ti_neo_hookean.hpp"

namespace lode::test::test_ti_neo_hookean {
namespace {

constexpr AnalysisKind solid = AnalysisKind::solid, plane_strain = AnalysisKind::plane_strain,
                       plane_stress = AnalysisKind::plane_stress;
constexpr double EA = 30, ET = 10, GA = 5, nuA = 0.25, nuT = 0.4;
const double KT = 1 / (2 * (1 - nuT) / ET - 4 * nuA * nuA / EA), GT = ET / (2 * (1 + nuT)), lambda = KT - GT;
const double al = GT - GA, be = (GT - KT * (1 - 2 * nuA)) / 4,
             ga = (EA - 4 * GA + GT + KT * (1 - 2 * nuA) * (1 - 2 * nuA)) / 8;
constexpr double printed = fourteen_digits;

const Matrix3d in_plane = matrix(1.2, 0.2, 0.0, 0.0, 0.9, 0.0, 0.0, 0.0, 7.7);  // plane stress: F33 is not read

Numbers props(int uj, Numbers axis = {1, 0, 0}, Numbers more = {}) {
    Numbers p = {EA, ET, GA, nuA, nuT, double(uj)};
    p.insert(p.end(), axis.begin(), axis.end());
    p.insert(p.end(), more.begin(), more.end());
    return p;
}
UmatPoint material(AnalysisKind kind, Numbers constants) {
    return UmatPoint("TI_NEO_HOOKEAN-TEST", kind, std::move(constants));
}
Answer at(AnalysisKind kind, const Numbers& constants, const Matrix3d& f, double dtemp = 0.0) {
    return material(kind, constants).advance({.dtemp = dtemp, .dfgrd1 = f});
}
const DilatationalEnergies dilatation = {lambda};

// Along each axis that the kinds can have.
std::vector<HyperelasticModel> models() {
    std::vector<HyperelasticModel> all;
    for (const Numbers& axis : {Numbers{1, 2, -0.5}, Numbers{1, 2, 0}, Numbers{0, 0, 2}}) {
        HyperelasticModel model = {"TI_NEO_HOOKEAN-TEST",
                                   [axis](int uj, double alpha, double beta) {
                                       return props(uj, axis, {0.1 * alpha, 0.2 * alpha, beta, 2 * beta});
                                   },
                                   EA, 2};
        if (axis[2] == -0.5) model.kinds = {solid};
        all.push_back(model);
    }
    return all;
}

// --- 5.5, the printed table --------------------------------------------------------------------------------------

TEST(TiNeoHookean, Constants) {
    EXPECT_NEAR(GT, 3.5714285714286, 1e-13);
    EXPECT_NEAR(lambda, 5.3837953091684, 1e-13);
    EXPECT_NEAR(al, -1.4285714285714, 1e-13);
    EXPECT_NEAR(be, -0.22654584221748, 1e-14);
    EXPECT_NEAR(ga, 1.9762793176972, 1e-13);
    EXPECT_NEAR(KT, 8.955223880597, 1e-12);
}

TEST(TiNeoHookean, ConstrainedStretchTables) {
    const double axial[3][2] = {
        {12.428565880017, 1.1882893226177}, {12.614928025334, 1.3746514679351}, {12.086339814379, 0.84606325697952}};
    const double transverse[3][3] = {{1.2458917297053, 3.3243808430376, 1.4287764474332},
                                     {1.4322538750227, 3.5107429883549, 1.6151385927505},
                                     {0.90366566406713, 2.9821547773994, 1.086550381795}};
    for (int uj = 0; uj < 3; ++uj) {
        const auto [a11, a22] = axial[uj];
        const auto [t11, t22, t33] = transverse[uj];
        expect_close({a11, a22, a22, 0, 0, 0}, at(solid, props(uj), diagonal(1.3, 1, 1)).stress);
        expect_close({t11, t22, t33, 0, 0, 0}, at(solid, props(uj), diagonal(1, 1.3, 1)).stress);
        expect_close({a11, a22, a22, 0}, at(plane_strain, props(uj), diagonal(1.3, 1, 1)).stress);
        expect_close({t11, t22, t33, 0}, at(plane_strain, props(uj), diagonal(1, 1.3, 1)).stress);
    }
}

TEST(TiNeoHookean, SimpleShear) {
    for (int uj = 0; uj < 3; ++uj)
        expect_close({1.0285714285714, 0, 0, 2, 0, 0}, at(solid, props(uj), simple_shear(0.4)).stress);
}

TEST(TiNeoHookean, SimpleAxialTension) {
    const double lateral = 0.93392356683756;
    EXPECT_NEAR(1.3 * lateral * lateral, 1.133877197303, 1e-12);
    expect_close({13.474230537583, 0, 0, 0, 0, 0}, at(solid, props(0), diagonal(1.3, lateral, lateral)).stress);
    const Answer sheet = at(plane_stress, props(0), diagonal(1.3, lateral, 1));
    expect_close({13.474230537583, 0, 0}, sheet.stress);
    EXPECT_NEAR(1 + sheet.state[2], lateral, 1e-12);
}

TEST(TiNeoHookean, StiffnessOfTheUndeformedBody) {
    for (int uj = 0; uj < 3; ++uj) {
        const Answer a = at(solid, props(uj), Matrix3d::Identity());
        EXPECT_NEAR(a.tangent(0, 0), 32.238805970149, 1e-12);
        EXPECT_NEAR(a.tangent(0, 1), 4.4776119402985, 1e-12);
        EXPECT_NEAR(a.tangent(0, 2), 4.4776119402985, 1e-12);
        EXPECT_NEAR(a.tangent(1, 1), 12.526652452026, 1e-12);
        EXPECT_NEAR(a.tangent(1, 2), 5.3837953091684, 1e-12);
        EXPECT_NEAR(a.tangent(3, 3), 5, 1e-12);
        EXPECT_NEAR(a.tangent(4, 4), 5, 1e-12);
        EXPECT_NEAR(a.tangent(5, 5), 3.5714285714286, 1e-12);
        // the engineering constants come back
        const Eigen::MatrixXd compliance = a.tangent.inverse();
        EXPECT_NEAR(1 / compliance(0, 0), EA, 1e-12);
        EXPECT_NEAR(1 / compliance(1, 1), ET, 1e-12);
        EXPECT_NEAR(-compliance(1, 0) / compliance(0, 0), nuA, 1e-13);
        EXPECT_NEAR(-compliance(2, 1) / compliance(1, 1), nuT, 1e-13);
    }
}

TEST(TiNeoHookean, GeneralDeformationAndAxis) {
    for (const double length : {1.0, 1e-3, 50.0}) {  // A is normalised
        const Answer a = at(solid, props(0, {length, 2 * length, -0.5 * length}), general);
        expect_close(
            {5.6402600216518, 0.77256483103502, 1.7427232069674, 2.9479384476845, -2.4497075829832, 0.46157692813362},
            a.stress);
        const double row1[6] = {31.910729039092, 10.750608830067,  6.6285622068933,
                                10.35515760589,  -5.7701417923729, -2.5046971682148};
        for (int j = 0; j < 6; ++j) {
            EXPECT_NEAR(a.tangent(0, j), row1[j], printed * row1[0]);
            EXPECT_NEAR(a.tangent(j, 0), row1[j], printed * row1[0]);
        }
        EXPECT_NEAR(a.tangent(3, 3), 13.071642937293, printed * row1[0]);
    }
}

TEST(TiNeoHookean, Heated) {
    const Numbers p = props(0, {1, 2, -0.5}, {1e-5, 8e-5});
    const Answer held = at(solid, p, Matrix3d::Identity(), 100.0);
    expect_close({-0.13984688210819, -0.11458290197449, -0.14616287714162, 0.016842653422469, -0.0042106633556171,
                  -0.0084213267112343},
                 held.stress);
    EXPECT_NEAR(held.state[0], 1e-3, 1e-18);
    EXPECT_NEAR(held.state[1], 8e-3, 1e-17);
    expect_close(
        {5.5361772868084, 0.66617593483883, 1.6045149602793, 2.9874899245616, -2.4655412809405, 0.44817543474316},
        at(solid, p, general, 100.0).stress);
}

TEST(TiNeoHookean, PlaneStressTable) {
    const Answer a = at(plane_stress, props(0, {1, 2, 0}), in_plane);
    expect_close({3.3713132062713, 0.24490120709489, 1.7945850123944}, a.stress);
    EXPECT_NEAR(a.state[2], -0.028373214599962, printed);
}

TEST(TiNeoHookean, IsotropicConstantsGiveTheNeoHookeanSolid) {
    const double E = 10, nu = 0.3;
    for (int uj = 0; uj < 3; ++uj)
        for (const AnalysisKind kind : {solid, plane_strain, plane_stress}) {
            Matrix3d f = general;
            const Answer a = at(kind, {E, E, E / (2 * (1 + nu)), nu, nu, double(uj), 3, 4, 0, 1e-3, 1e-3}, f, 20.0);
            UmatPoint isotropic("NEO_HOOKEAN-TEST", kind, {E, nu, double(uj), 1e-3});
            const Answer b = isotropic.advance({.dtemp = 20.0, .dfgrd1 = f});
            expect_close(b.stress, a.stress, 1e-14);
            EXPECT_NEAR(a.sse, b.sse, 1e-14 * E);
            EXPECT_LE((a.tangent - b.tangent).cwiseAbs().maxCoeff(), 1e-13 * E);
            EXPECT_LE(distance(a.ddsddt, b.ddsddt), 1e-15 * E);
        }
}

// --- 5.3, closed solutions ---------------------------------------------------------------------------------------

TEST(TiNeoHookean, ClosedSolutions) {
    for (const double l : {0.7, 0.95, 1.1, 2.0}) {
        const double x = l * l - 1;
        const double t11 = (KT * nuA + GT + 2 * (2 * ga - al) * l * l) * x + 4 * be * l * l * std::log(l);
        const double t22 = KT * nuA * x;
        expect_close({t11 / l, t22 / l, t22 / l, 0, 0, 0}, at(solid, props(0), diagonal(l, 1, 1)).stress, 1e-13);
        const double s11 = (KT - GT) / 2 * x + 4 * be * std::log(l), s22 = (KT + GT) / 2 * x, s33 = (KT - GT) / 2 * x;
        expect_close({s11 / l, s22 / l, s33 / l, 0, 0, 0}, at(solid, props(0), diagonal(1, l, 1)).stress, 1e-13);
        const double J =
            (-GT + std::sqrt(std::pow(lambda * l * l + GT, 2) - lambda * (lambda + 4 * be) * x * l * l)) / (lambda * l);
        const double tau = GT * (l * l * l - J) / l + 2 * ((2 * ga - al) * x + 2 * be * std::log(J)) * l * l;
        const double width = std::sqrt(J / l);
        expect_close({tau / J, 0, 0, 0, 0, 0}, at(solid, props(0), diagonal(l, width, width)).stress, 1e-13);
    }
}

// The printed energy itself, and its derivative dW/dF F^T/J by differences.
TEST(TiNeoHookean, StressIsTheDerivativeOfTheEnergy) {
    const Eigen::Vector3d A = Eigen::Vector3d(1, 2, -0.5).normalized();
    for (int uj = 0; uj < 3; ++uj) {
        const auto energy = [&](const Matrix3d& f) {
            const double J = f.determinant(), I4 = (f * A).squaredNorm(), I5 = (f.transpose() * f * A).squaredNorm();
            return GT / 2 * (f.squaredNorm() - 3 - 2 * std::log(J)) + dilatation.energy(uj, J) +
                   (al + 2 * be * std::log(J) + ga * (I4 - 1)) * (I4 - 1) - al / 2 * (I5 - 1);
        };
        const double J = general.determinant(), h = 1e-5;
        const Answer a = at(solid, props(uj, {1, 2, -0.5}), general);
        EXPECT_NEAR(a.sse, energy(general) / J, 1e-14 * EA);
        Matrix3d p;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                Matrix3d plus = general, minus = general;
                plus(i, j) += h;
                minus(i, j) -= h;
                p(i, j) = (energy(plus) - energy(minus)) / (2 * h);
            }
        expect_close(to_components(p * general.transpose() / J, solid, 1.0), a.stress, 1e-8);
    }
}

TEST(TiNeoHookean, FreeExpansionIsFreeOfStress) {
    const Eigen::Vector3d A = Eigen::Vector3d(1, 2, 0).normalized();
    const double ea = 0.01, et = -0.02;
    const Matrix3d free = std::exp(et) * Matrix3d::Identity() + (std::exp(ea) - std::exp(et)) * A * A.transpose();
    for (const AnalysisKind kind : {solid, plane_strain, plane_stress}) {
        const Answer a =
            material(kind, props(0, {1, 2, 0}, {1e-4, -2e-4, 3e-3, 5e-3})).advance({.dtemp = 100.0, .dfgrd1 = free});
        EXPECT_LT(largest(a.stress), 1e-14 * EA);
        EXPECT_LT(std::abs(a.sse), 1e-28 * EA);
        if (kind == plane_stress) {
            EXPECT_NEAR(a.state[2], std::exp(et) - 1, 1e-15);
        }
    }
    // moisture does what heat does
    const Answer wet = material(solid, props(1, {1, 2, 0}, {1e-4, -2e-4, 3e-3, 5e-3}))
                           .advance({.dtemp = 50.0, .dpred = {2.0}, .dfgrd1 = general});
    const Answer hot = material(solid, props(1, {1, 2, 0}, {0.011, 0.0})).advance({.dtemp = 1.0, .dfgrd1 = general});
    expect_close(hot.stress, wet.stress, 1e-13);
}

TEST(TiNeoHookean, TinyStrainsKeepFullRelativeAccuracy) {
    for (const double wanted : {1e-9, 1e-10, 1e-12}) {
        const double h = (1.0 + wanted) - 1.0;
        for (int uj = 0; uj < 3; ++uj) {
            const Answer a = at(solid, props(uj), diagonal(1 + h, 1, 1));
            EXPECT_NEAR(a.stress[0], (EA + 4 * KT * nuA * nuA) * h, 10 * EA * h * h + 2e-15 * EA * h);
            EXPECT_NEAR(a.stress[1], 2 * KT * nuA * h, 10 * EA * h * h + 2e-15 * EA * h);
            const Answer sheared = at(solid, props(uj), simple_shear(wanted));
            EXPECT_NEAR(sheared.stress[3], GA * wanted, 1e-15 * EA * wanted);
            EXPECT_NEAR(sheared.sse, GA * wanted * wanted / 2, 1e-14 * EA * wanted * wanted);
            for (const Numbers& axis : {Numbers{1, 0, 0}, Numbers{0, 0, 1}}) {
                const Answer sheet = at(plane_stress, props(uj, axis), diagonal(1 + h, 1 - 0.5 * h, 1));
                const double along = (1 + h) - 1, across = (1 - 0.5 * h) - 1;
                const Eigen::MatrixXd c = at(solid, props(uj, axis), Matrix3d::Identity()).tangent;
                const double e33 = -(c(2, 0) * along + c(2, 1) * across) / c(2, 2);
                EXPECT_NEAR(sheet.state[2], e33, 10 * h * h + 1e-14 * h);
            }
        }
    }
}

// --- tangents ----------------------------------------------------------------------------------------------------

TEST(TiNeoHookean, TangentAgainstCentralDifferences) {
    for (const HyperelasticModel& model : models())
        expect_tangent_of_differences(model, Matrix3d::Identity() + 0.5 * (general - Matrix3d::Identity()), 100.0);
}

TEST(TiNeoHookean, SheetIsASolidWithoutStress33) {
    for (const Numbers& axis : {Numbers{1, 0, 0}, Numbers{1, 2, 0}, Numbers{0, 0, 1}})
        for (int uj = 0; uj < 3; ++uj)
            for (const Matrix3d& f : {in_plane, simple_shear(0.8), diagonal(0.85, 0.9, 1), diagonal(1.2, 1.1, 1),
                                      diagonal(1 + 1e-9, 1, 1)}) {
                const Answer sheet = at(plane_stress, props(uj, axis), f);
                Matrix3d full = f;
                full(2, 2) = 1 + sheet.state[2];
                const Answer a = at(solid, props(uj, axis), full);
                const double scale = a.tangent.cwiseAbs().maxCoeff();
                EXPECT_NEAR(a.stress[2], 0.0, 1e-14 * scale) << uj << "\n" << f;
                EXPECT_NEAR(a.stress[0], sheet.stress[0], 1e-14 * scale);
                EXPECT_NEAR(a.stress[3], sheet.stress[2], 1e-14 * scale);
                EXPECT_NEAR(a.sse, sheet.sse, 1e-14 * scale);
            }
}

// --- 1.1: bases --------------------------------------------------------------------------------------------------

// ORI = 1: the host gives F' = R^T F R and wants the stress in the turned axes, R^T sigma R.
TEST(TiNeoHookean, AxesThatTurnWithTheMaterial) {
    const Eigen::JacobiSVD<Matrix3d> svd(general, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Matrix3d turn = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 3).normalized()).toRotationMatrix();
    const Matrix3d f = turn * general, r = turn * svd.matrixU() * svd.matrixV().transpose();
    const Numbers more = {1e-5, 8e-5, 0, 0};
    Numbers fixed = props(0, {1, 2, -0.5}, more), turned = fixed;
    turned.push_back(1);
    const Answer a = at(solid, fixed, f, 100.0), b = at(solid, turned, r.transpose() * f * r, 100.0);
    expect_close(rotated_stress(a.stress, solid, r.transpose()), b.stress, 1e-14);
    EXPECT_NEAR(a.sse, b.sse, 1e-14 * EA);
    // DDSDDE in the turned axes: C : D turned back is C' : (R^T D R)
    for (int column = 0; column < 6; ++column) {
        Numbers unit(6, 0.0);
        unit[std::size_t(column)] = 1.0;
        const Numbers back = rotated_strain(unit, solid, r);
        Numbers fixed_rate(6, 0.0);
        for (int i = 0; i < 6; ++i)
            for (int j = 0; j < 6; ++j) fixed_rate[std::size_t(i)] += a.tangent(i, j) * back[std::size_t(j)];
        const Numbers rate = rotated_stress(fixed_rate, solid, r.transpose());
        for (int i = 0; i < 6; ++i) EXPECT_NEAR(b.tangent(i, column), rate[std::size_t(i)], 1e-12 * EA);
    }
    // in the plane kinds as well
    Matrix3d flat = in_plane;
    const Eigen::JacobiSVD<Matrix3d> plane(Matrix3d(matrix(1.2, 0.2, 0, 0, 0.9, 0, 0, 0, 1)),
                                           Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Matrix3d q = plane.matrixU() * plane.matrixV().transpose();
    Numbers flat_fixed = props(0, {1, 2, 0}, {0, 0, 0, 0}), flat_turned = flat_fixed;
    flat_turned.push_back(1);
    expect_close(rotated_stress(at(plane_stress, flat_fixed, flat).stress, plane_stress, q.transpose()),
                 at(plane_stress, flat_turned, q.transpose() * flat * q).stress, 1e-14);
}

TEST(TiNeoHookean, TheAxisTurnsWithTheMaterial) {
    const Matrix3d q = Eigen::AngleAxisd(2.0, Eigen::Vector3d(3, 1, -1).normalized()).toRotationMatrix();
    const Numbers p = props(1, {1, 2, -0.5});
    expect_close(rotated_stress(at(solid, p, general).stress, solid, q), at(solid, p, q * general).stress, 1e-14);
}

TEST(TiNeoHookean, PlaneStrainIsTheSolid) {
    Matrix3d f = general;
    f(0, 2) = f(1, 2) = f(2, 0) = f(2, 1) = 0;
    for (const Numbers& axis : {Numbers{1, 2, 0}, Numbers{0, 0, -3}}) {
        const Answer full = at(solid, props(0, axis), f), plane = at(plane_strain, props(0, axis), f);
        expect_close({full.stress[0], full.stress[1], full.stress[2], full.stress[3]}, plane.stress, 1e-15);
        EXPECT_LE((full.tangent.topLeftCorner(4, 4) - plane.tangent).cwiseAbs().maxCoeff(), 1e-13 * EA);
    }
}

// --- the explicit interface (1.7) --------------------------------------------------------------------------------

TEST(TiNeoHookean, EqualStretchesSmallVolumesAndStretchesOfTen) {
    const double E = 10, nu = 0.3, g = E / (2 * (1 + nu)), k = E * nu / ((1 + nu) * (1 - 2 * nu));
    const HyperelasticModel isotropic = {
        "TI_NEO_HOOKEAN-ISO", [=](int uj, double, double) { return Numbers{E, E, g, nu, nu, double(uj), 3, 4, 1}; }, E,
        2};
    expect_accurate_stress(isotropic, [=](const LongVector& l, int uj) -> LongVector {
        const Long J = l.prod(), K = k;
        const Long mean = uj == 0 ? K / 2 * (J - 1 / J) : uj == 1 ? K * (J - 1) : K * std::log(J) / J;
        return (Long(g) / J * (l.array().square() - 1) + mean).matrix();
    });
}

TEST(TiNeoHookean, GeneralTinyStrainsFollowHooke) {
    for (const HyperelasticModel& model : models())
        expect_hooke_at_tiny_strains(model, model.at(solid, 0, Matrix3d::Identity()).tangent);
}

TEST(TiNeoHookean, SeveralTurnsLeaveNothing) {
    for (const HyperelasticModel& model : models()) expect_objective_over_turns(model);
}

// Shear over the fibres stretches them, shear along them does not.
TEST(TiNeoHookean, DeformationGradientIsReadInFortranOrder) {
    const Answer along = at(solid, props(0), simple_shear(0.4)),
                 across = at(solid, props(0), simple_shear(0.4).transpose());
    EXPECT_GT(across.sse, 1.05 * along.sse);
    EXPECT_GT(distance(across.stress, along.stress), 0.1 * GA);
    EXPECT_GT(along.stress[0] - along.stress[1], 0.05 * GA) << "the longer side of the matrix is direction 1";
}

TEST(TiNeoHookean, ExplicitAnswerIsTheImplicitOneAtTheStretch) {
    for (const HyperelasticModel& model : models())
        expect_explicit_is_implicit(
            model, Matrix3d::Identity() + 0.4 * (general.transpose() * general - Matrix3d::Identity()));
}

TEST(TiNeoHookean, ExplicitHostIsToldWhichPointHasInverted) { expect_inverted_point_is_named(models()[1]); }

// --- 5.4 and 1.1: where it fails ---------------------------------------------------------------------------------

TEST(TiNeoHookean, InvertedOrNonFiniteDeformationAsksForLess) { expect_impossible_deformations_cut(models()[1]); }

// The stiffness of a compressed fibre against shear vanishes where the warning begins.
TEST(TiNeoHookean, KinkingOfFibresIsAnnounced) {
    const auto critical = [](const Numbers& p) {
        double lower = 0.3, upper = 1.0;
        for (int i = 0; i < 60; ++i) {
            const double l = 0.5 * (lower + upper);
            const Answer a = at(solid, p, diagonal(l, 1, 1));
            // c_2121 + s11: the acoustic tensor for shear that turns the fibre
            (a.tangent(3, 3) + 0.5 * (a.stress[0] - a.stress[1]) > 0 ? upper : lower) = l;
        }
        return lower;
    };
    const Numbers carbon = {140, 9.5, 5.8, 0.3, 0.45};
    EXPECT_NEAR(critical(props(0)), 0.71, 0.005);
    EXPECT_NEAR(critical(carbon), 0.95, 0.005);
    EXPECT_NEAR(critical(props(1)), critical(props(0)), 1e-12);  // independent of UJ
    const auto warned = [](const std::string& label, const Numbers& p, double l) {
        UmatPoint point("TI_NEO_HOOKEAN-" + label, solid, p);
        return point.step({.dfgrd1 = diagonal(l, 1, 1)}).messages.warnings;
    };
    for (const Numbers& p : {props(0), carbon}) {
        const double l = critical(p);
        const std::string label = p == carbon ? "CARBON" : "TENDON";
        EXPECT_TRUE(warned(label, p, l + 1e-6).empty());
        const auto warnings = warned(label, p, l - 1e-6);
        ASSERT_EQ(warnings.size(), 1u);
        EXPECT_NE(warnings[0].find("kinking"), std::string::npos);
    }
}

TEST(TiNeoHookean, ObliqueAxisIsRefusedInThePlaneKinds) {
    for (const AnalysisKind kind : {plane_strain, plane_stress}) {
        const Answer a = material(kind, props(0, {1, 0, 0.5})).step({.dfgrd1 = Matrix3d::Identity()});
        EXPECT_EQ(a.messages.stops, 1);
        EXPECT_NE(a.first_error().find("axial direction"), std::string::npos) << a.first_error();
        EXPECT_TRUE(material(kind, props(0, {0, 0, -2})).step({.dfgrd1 = Matrix3d::Identity()}).done());
        EXPECT_TRUE(material(kind, props(0, {-1, 3, 0})).step({.dfgrd1 = Matrix3d::Identity()}).done());
    }
}

TEST(TiNeoHookean, BadConstantsAreRefusedByName) {
    const auto message = [](const Numbers& constants) {
        char text[512] = "";
        EXPECT_EQ(
            lode_required_state("TI_NEO_HOOKEAN-BAD", constants.data(), int(constants.size()), 3, 3, text, sizeof text),
            -1);
        return std::string(text);
    };
    EXPECT_NE(message({EA, ET, GA, nuA}).find("needs at least 5 constants"), std::string::npos);
    EXPECT_NE(message({0, ET, GA, nuA, nuT}).find("PROPS(1) = 0 (EA, axial Young's modulus) must be > 0"),
              std::string::npos);
    EXPECT_NE(message({EA, -1, GA, nuA, nuT}).find("(ET,"), std::string::npos);
    EXPECT_NE(message({EA, ET, 0, nuA, nuT}).find("(GA,"), std::string::npos);
    const double limit = std::sqrt(0.5 * (1 - nuT) * EA / ET);
    EXPECT_NE(
        message({EA, ET, GA, 1.0001 * limit, nuT}).find("(NUA, axial Poisson's ratio) must be below 0.948683298051 in"),
        std::string::npos);
    EXPECT_NE(message({EA, ET, GA, -1.01 * limit, nuT}).find("(NUA,"), std::string::npos);
    EXPECT_NE(message({EA, ET, GA, nuA, 1}).find("(NUT,"), std::string::npos);
    EXPECT_NE(message(props(3)).find("(UJ,"), std::string::npos);
    EXPECT_NE(message(props(0, {0, 0, 0})).find("(A1,"), std::string::npos);
    EXPECT_NE(message(props(0, {1, 0, 0}, {0, 0, 0, 0, 2})).find("(ORI,"), std::string::npos);
    const Numbers good = {EA, ET, GA, 0.999 * limit, nuT};
    char text[512];
    EXPECT_EQ(lode_required_state("TI_NEO_HOOKEAN", good.data(), 5, 3, 3, text, sizeof text), 3);
    EXPECT_EQ(lode_required_state("TI_NEO_HOOKEAN", good.data(), 5, 1, 0, text, sizeof text), -1);  // 1D
    EXPECT_EQ(lode_required_state("TI_NEO_HOOKEAN", good.data(), 5, 1, 2, text, sizeof text), -1);  // cohesive
}

}  // namespace
}  // namespace lode::test::test_ti_neo_hookean
