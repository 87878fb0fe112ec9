// DISNEY_SNOW: the verification cases and failure modes of page 50, sections 1 and 6.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "hyperelastic.hpp"
#include "lode/hyperelastic/disney_snow.hpp"

namespace lode::test::test_disney_snow {
namespace {

constexpr AnalysisKind solid = AnalysisKind::solid, plane_strain = AnalysisKind::plane_strain;
constexpr double E0 = 1.4e5, nu = 0.2, G0 = E0 / (2 * (1 + nu)), lambda0 = E0 * nu / ((1 + nu) * (1 - 2 * nu));
constexpr double printed = fourteen_digits;
const Numbers snow = {E0, nu};

const Matrix3d mixed = matrix(0.9, 0.05, 0.01, 0.02, 1.003, 0.03, 0, 0.01, 1.06);

UmatPoint material(AnalysisKind kind, Numbers constants) {
    return UmatPoint("DISNEY_SNOW-TEST", kind, std::move(constants));
}
Answer at(AnalysisKind kind, const Numbers& constants, const Matrix3d& f, double dtemp = 0.0) {
    return material(kind, constants).advance({.dtemp = dtemp, .dfgrd1 = f});
}
Numbers plastic_part(const Answer& a) { return {a.state.begin(), a.state.begin() + 7}; }

// Elastic limits far away, no hardening.
const HyperelasticModel elastic_snow = {
    "DISNEY_SNOW-ELASTIC",
    [](int uj, double alpha, double beta) { return Numbers{E0, nu, 0.99999, 1e3, 0, 0, double(uj), alpha, beta}; },
    E0,
    6,
    2,
    {0, 1, 2},
    {solid, plane_strain}};
LongVector corotated_stress(const LongVector& l, int uj) {
    const Long J = l.prod(), k = lambda0, g = G0;
    const Long mean = uj == 0 ? k / 2 * (J - 1 / J) : uj == 1 ? k * (J - 1) : k * std::log(J) / J;
    return (2 * g / J * l.array() * (l.array() - 1) + mean).matrix();
}

// --- 6.8, the printed table --------------------------------------------------------------------------------------

TEST(DisneySnow, Elastic) {
    for (const AnalysisKind kind : {solid, plane_strain}) {
        const Answer a = at(kind, snow, diagonal(0.98, 1, 1.005));
        expect_close({-2908.9469320066, -587.22222222223, 8.0158730158555, 0}, a.stress, 1e-12);
        EXPECT_EQ(largest(plastic_part(a)), 0.0);
        EXPECT_EQ(a.spd, 0.0);
    }
}

TEST(DisneySnow, ConfinedCompressionAndUnloading) {
    for (const AnalysisKind kind : {solid, plane_strain}) {
        UmatPoint point = material(kind, snow);
        const Answer a = point.advance({.dfgrd1 = diagonal(0.9, 1, 1)});
        expect_close({-8392.6326320217, -2098.1581580054, -2098.1581580054, 0}, a.stress);
        expect_close({0.17361111111111, 0, 0, 0, 0, 0, -0.076923076923077}, plastic_part(a));
        const double Jp = 0.9 / 0.975, h = std::exp(10 * (1 - Jp));  // the closed form
        expect_close({h * (0.975 - 1) * (2 * G0 + lambda0), h * lambda0 * (0.975 - 1)}, a.stress, 1e-13);
        const Eigen::MatrixXd& c = a.tangent;
        const double scale = 337964.86022026;
        EXPECT_NEAR(c(0, 0), 69077.822432794, printed * scale);
        EXPECT_NEAR(c(0, 1), 79730.010004206, printed * scale);
        EXPECT_NEAR(c(0, 2), 79730.010004206, printed * scale);
        EXPECT_NEAR(c(1, 0), 17269.455608199, printed * scale);
        EXPECT_NEAR(c(1, 1), 337964.86022026, printed * scale);
        EXPECT_NEAR(c(1, 2), 79730.010004206, printed * scale);
        EXPECT_NEAR(c(3, 3), 29981.57578413, printed * scale);
        if (kind == solid) {
            EXPECT_NEAR(c(5, 5), 129117.42510803, printed * scale);
        }
        const Answer b = point.advance({.dfgrd1 = diagonal(0.91, 1, 1)});
        expect_close({-4755.8251581456, -1188.9562895364, -1188.9562895364, 0}, b.stress, 1e-12);
        EXPECT_TRUE(identical(a.state, b.state));
        EXPECT_EQ(b.spd, a.spd);
    }
}

TEST(DisneySnow, ConfinedTension) {
    const Answer a = at(solid, snow, diagonal(1.05, 1, 1));
    expect_close({765.14834535306, 191.28708633827, 191.28708633827, 0, 0, 0}, a.stress, 1e-12);
    EXPECT_NEAR(a.state[0], -0.079314058956916, 1e-14);
    EXPECT_NEAR(a.state[6], 0.042183622828784, 1e-14);
}

TEST(DisneySnow, HydrostaticCompression) {
    const Answer a = at(solid, snow, diagonal(0.95, 0.95, 0.95));
    expect_close({-12512.732159155, -12512.732159155, -12512.732159155, 0, 0, 0}, a.stress);
    expect_close({0.053324099722992, 0.053324099722992, 0.053324099722992, 0, 0, 0, -0.07496754834033},
                 plastic_part(a));
}

TEST(DisneySnow, SimpleShear) {
    const Answer a = at(solid, snow, simple_shear(0.1));
    expect_close({-1329.5997039582, -1487.7761712786, -574.50393385081, 1581.7646732041, 0, 0}, a.stress);
    EXPECT_NEAR(a.state[0], -0.012173371087983, 1e-14);
    EXPECT_NEAR(a.state[1], -0.018768146540858, 1e-14);
    EXPECT_NEAR(a.state[3], -0.065947754528753, 1e-14);
    EXPECT_NEAR(a.state[6], 0.018005980785137, 1e-14);
}

TEST(DisneySnow, GeneralDeformation) {
    const Answer a = at(solid, snow, mixed);
    expect_close({-4180.3102757002, -59.044136533356, 577.11050342039, 1455.2362028765, -7.0713102067581, 85.686999456},
                 a.stress);
    expect_close({0.18420335811476, 0.0040932844900596, -0.096359817916373, -0.059139914301615, -0.0081374168846937,
                  -0.035341883881884, -0.033143231672153},
                 plastic_part(a));
}

TEST(DisneySnow, NeoHookeanElasticLaw) {
    expect_close({-8500.2304862784, -2125.0576215696, -2125.0576215696, 0, 0, 0},
                 at(solid, {E0, nu, 0.025, 0.0075, 10, 1, 0}, diagonal(0.9, 1, 1)).stress);
}

// --- elasticity, energies ----------------------------------------------------------------------------------------

// Within the limits the laws are those of COROT_NEO_HOOKEAN and NEO_HOOKEAN.
TEST(DisneySnow, ElasticLawsAreThoseOfTheHyperelasticModels) {
    const Matrix3d f = Matrix3d::Identity() + 0.05 * (mixed - Matrix3d::Identity());
    for (int uj = 0; uj < 3; ++uj)
        for (int elas = 0; elas < 2; ++elas)
            for (const AnalysisKind kind : {solid, plane_strain}) {
                UmatPoint reference(elas == 0 ? "COROT_NEO_HOOKEAN" : "NEO_HOOKEAN", kind, {E0, nu, double(uj), 1e-5});
                const Answer a = at(kind, {E0, nu, 0.1, 0.1, 10, double(elas), double(uj), 1e-5}, f, 20.0);
                const Answer b = reference.advance({.dtemp = 20.0, .dfgrd1 = f});
                expect_close(b.stress, a.stress, 1e-13);
                EXPECT_NEAR(a.sse, b.sse, 1e-13 * b.sse);
                EXPECT_LE((a.tangent - b.tangent).cwiseAbs().maxCoeff(), 1e-12 * E0);
                EXPECT_LE(distance(a.ddsddt, b.ddsddt), 1e-12 * largest(b.ddsddt));
            }
}

TEST(DisneySnow, TinyStrainsKeepFullRelativeAccuracy) {
    for (const double g : {1e-12, 1e-9, 1e-6})
        for (int elas = 0; elas < 2; ++elas) {
            const Answer a = at(solid, {E0, nu, 0.025, 0.0075, 10, double(elas)}, simple_shear(g));
            EXPECT_NEAR(a.stress[3], G0 * g, (1e-14 + g * g) * G0 * g);
            EXPECT_NEAR(a.sse, G0 * g * g / 2, (1e-13 + g * g) * G0 * g * g);
        }
}

// SSE + SPD is the work done: a coaxial path, on which the stress does not depend on the increments.
TEST(DisneySnow, DissipationIsTheWorkThatIsNotStored) {
    for (const double l : {0.9, 1.05})
        for (int elas = 0; elas < 2; ++elas) {
            UmatPoint point = material(solid, {E0, nu, 0.025, 0.0075, 10, double(elas)});
            const int steps = 4000;
            double work = 0.0, dissipated = 0.0, stress_old = 0.0, spd_old = 0.0;
            for (int i = 1; i <= steps; ++i) {
                const double stretch = 1 + (l - 1) * i / steps;
                const Answer a = point.advance({.dfgrd1 = diagonal(stretch, 1, 1)});
                work += 0.5 * (a.stress[0] + stress_old) * (l - 1) / steps;  // nominal stress is sigma11 here
                dissipated += stretch * (a.spd - spd_old);
                EXPECT_GE(a.spd, spd_old);
                stress_old = a.stress[0];
                spd_old = a.spd;
            }
            EXPECT_NEAR(l * point.sse() + dissipated, work, 1e-3 * work);
            EXPECT_GT(dissipated, 0.5 * work);
        }
}

TEST(DisneySnow, CoaxialMonotonicPathsDoNotDependOnTheIncrements) {
    UmatPoint many = material(solid, snow);
    Answer last;
    for (int i = 1; i <= 50; ++i) last = many.advance({.dfgrd1 = diagonal(1 - 0.1 * i / 50, 1, 1 + 0.06 * i / 50)});
    const Answer one = at(solid, snow, diagonal(0.9, 1, 1.06));
    expect_close(one.stress, last.stress, 1e-11);
    EXPECT_NEAR(one.state[0], last.state[0], 1e-13);
    EXPECT_NEAR(one.state[6], last.state[6], 1e-13);
}

// Choices of the page: the mechanical stretch is clamped, so free expansion neither stresses nor flows.
TEST(DisneySnow, FreeExpansionNeitherStressesNorFlows) {
    const double l = std::exp(0.05);
    for (const AnalysisKind kind : {solid, plane_strain}) {
        const Answer a = material(kind, {E0, nu, 0.025, 0.0075, 10, 0, 1, 1e-3, 2e-2})
                             .advance({.dtemp = 30.0, .dpred = {1.0}, .dfgrd1 = diagonal(l, l, l)});
        EXPECT_LT(largest(a.stress), 1e-14 * E0);
        EXPECT_EQ(largest(plastic_part(a)), 0.0);
        EXPECT_NEAR(a.state[7], 0.05, 1e-16);
    }
}

// --- tangents ----------------------------------------------------------------------------------------------------

TEST(DisneySnow, TangentAgainstCentralDifferences) {
    constexpr double h = 1e-7;
    const Matrix3d paths[] = {mixed,
                              diagonal(0.9, 0.91, 1.06),
                              diagonal(0.9, 1, 1.001),
                              diagonal(0.99, 1.0, 1.004),
                              simple_shear(0.1),
                              matrix(1.03, 0.02, 0, 0.01, 1.04, 0.01, 0.02, 0, 1.05)};
    for (const AnalysisKind kind : {solid, plane_strain})
        for (int elas = 0; elas < 2; ++elas)
            for (int uj = 0; uj < 3; ++uj)
                for (const Matrix3d& path : paths) {
                    Matrix3d f = path;
                    if (kind != solid) f(0, 2) = f(1, 2) = f(2, 0) = f(2, 1) = 0;
                    UmatPoint start = material(kind, {E0, nu, 0.025, 0.0075, 10, double(elas), double(uj), 1e-4});
                    // some history first
                    start.advance(
                        {.dtemp = 10.0, .dfgrd1 = Matrix3d::Identity() + 0.5 * (f.transpose() - Matrix3d::Identity())});
                    const auto kirchhoff = [&](const Matrix3d& deformed) {
                        Numbers tau = start.evaluate({.dtemp = 2.0, .dfgrd1 = deformed}).stress;
                        for (double& t : tau) t *= deformed.determinant();
                        return tau;
                    };
                    const Answer a = start.evaluate({.dtemp = 2.0, .dfgrd1 = f});
                    for (int column = 0; column < components(kind); ++column) {
                        Numbers unit(static_cast<std::size_t>(components(kind)), 0.0);
                        unit[static_cast<std::size_t>(column)] = h;
                        const Matrix3d d = strain_tensor(unit, kind);
                        const Numbers plus = kirchhoff((Matrix3d::Identity() + d) * f);
                        const Numbers minus = kirchhoff((Matrix3d::Identity() - d) * f);
                        for (int row = 0; row < components(kind); ++row)
                            EXPECT_NEAR(a.tangent(row, column),
                                        (plus[std::size_t(row)] - minus[std::size_t(row)]) / (2 * h * f.determinant()),
                                        2e-7 * E0)
                                << "ELAS " << elas << " UJ " << uj << "\n"
                                << f;
                    }
                    const auto heated = [&](double dtemp) {
                        return start.evaluate({.dtemp = dtemp, .dfgrd1 = f}).stress;
                    };
                    for (std::size_t i = 0; i < a.stress.size(); ++i)
                        EXPECT_NEAR(a.ddsddt[i], (heated(2.001)[i] - heated(1.999)[i]) / 2e-3, 1e-6 * 1e-4 * E0);
                }
}

// --- bases (1.1) -------------------------------------------------------------------------------------------------

// ORI = 1: the host gives F' = R^T F R and wants the stress in the turned axes, R^T sigma R; Cp^-1 is the same.
TEST(DisneySnow, AxesThatTurnWithTheMaterial) {
    const Matrix3d turn = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 3).normalized()).toRotationMatrix();
    UmatPoint fixed = material(solid, snow), turned = material(solid, {E0, nu, 0.025, 0.0075, 10, 0, 1, 0, 0, 1});
    for (const Matrix3d& f : {Matrix3d(mixed), Matrix3d(turn * mixed * simple_shear(0.05))}) {
        const Eigen::JacobiSVD<Matrix3d> svd(f, Eigen::ComputeFullU | Eigen::ComputeFullV);
        const Matrix3d r = svd.matrixU() * svd.matrixV().transpose();
        const Answer a = fixed.advance({.dfgrd1 = f}), b = turned.advance({.dfgrd1 = r.transpose() * f * r});
        expect_close(rotated_stress(a.stress, solid, r.transpose()), b.stress, 1e-12);
        EXPECT_LE(distance(a.state, b.state), 1e-14);
    }
}

TEST(DisneySnow, PlaneStrainIsTheSolid) {
    Matrix3d f = mixed;
    f(0, 2) = f(1, 2) = f(2, 0) = f(2, 1) = 0;
    const Answer full = at(solid, snow, f), plane = at(plane_strain, snow, f);
    expect_close({full.stress[0], full.stress[1], full.stress[2], full.stress[3]}, plane.stress, 1e-13);
    EXPECT_LE((full.tangent.topLeftCorner(4, 4) - plane.tangent).cwiseAbs().maxCoeff(), 1e-12 * E0);
    EXPECT_LE(distance(full.state, plane.state), 1e-15);
}

TEST(DisneySnow, DeformationGradientIsReadInFortranOrder) { expect_fortran_order(elastic_snow, corotated_stress); }

TEST(DisneySnow, EqualStretchesSmallVolumesAndStretchesOfTen) {
    expect_accurate_stress(elastic_snow, corotated_stress);
}

TEST(DisneySnow, GeneralTinyStrainsFollowHooke) {
    expect_hooke_at_tiny_strains(elastic_snow, isotropic_stiffness(lambda0, G0));
}

TEST(DisneySnow, SeveralTurnsLeaveNothing) { expect_objective_over_turns(elastic_snow); }

// --- the explicit interface (1.7) --------------------------------------------------------------------------------

TEST(DisneySnow, ExplicitAnswerIsTheImplicitOneAtTheStretch) {
    for (const AnalysisKind kind : {solid, plane_strain})
        for (int elas = 0; elas < 2; ++elas) {
            Matrix3d u = 0.5 * (mixed + mixed.transpose());
            if (kind != solid) u(0, 2) = u(1, 2) = u(2, 0) = u(2, 1) = 0;
            const Numbers constants = {E0, nu, 0.025, 0.0075, 10, double(elas), 1, 1e-4, 1e-3};
            VumatBlock block("DISNEY_SNOW", kind, constants);
            for (int p = 0; p < 19; ++p) {  // elastic and flowing points side by side
                VumatPoint point = block.fresh_point();
                point.stretch = Matrix3d::Identity() + (u - Matrix3d::Identity()) * ((p * 7 % 19) / 18.0);
                point.temperature_new = 10.0;
                point.fields_new = {0.5};
                point.density = 2.0;
                block.points.push_back(point);
            }
            const auto before = block.points;
            EXPECT_EQ(block.run().stops, 0);
            for (std::size_t p = 0; p < block.points.size(); ++p) {
                const VumatPoint& point = block.points[p];
                const Answer a =
                    material(kind, constants).advance({.dtemp = 10.0, .dpred = {0.5}, .dfgrd1 = before[p].stretch});
                EXPECT_LE(distance(a.stress, point.stress), 1e-14 * E0);
                EXPECT_LE(distance(a.state, point.state), 4e-15);
                EXPECT_NEAR(point.internal_energy - point.inelastic_energy, a.sse / 2.0, 1e-14 * E0);
                EXPECT_NEAR(point.inelastic_energy, a.spd / 2.0, 1e-14 * E0);
            }
        }
}

// --- 6.6 and 1.1: where it fails ---------------------------------------------------------------------------------

TEST(DisneySnow, InvertedOrNonFiniteDeformationAsksForLess) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = HUGE_VAL;
    for (const AnalysisKind kind : {solid, plane_strain}) {
        for (const Matrix3d& f :
             {diagonal(-1, 1, 1), diagonal(0, 1, 1), diagonal(-1, -1, -1), matrix(0, 1, 0, 1, 0, 0, 0, 0, 1)}) {
            const Answer a = material(kind, snow).step({.dfgrd1 = f});
            EXPECT_TRUE(a.cut);
            EXPECT_EQ(a.pnewdt, 0.25);
        }
        for (const double bad : {nan, inf, -inf})
            for (int i = 0; i < 2; ++i)
                for (int j = 0; j < 2; ++j) {
                    Matrix3d f = mixed;
                    f(i, j) = bad;
                    EXPECT_TRUE(material(kind, snow).step({.dfgrd1 = f}).cut) << i << j << bad;
                }
    }
}

TEST(DisneySnow, SofteningAndHardening) {
    const auto factor = [](double l) {
        UmatPoint point = material(solid, snow);
        const Answer a = point.advance({.dfgrd1 = diagonal(l, l, l)});
        return std::pair(std::exp(-10 * a.state[6]), a.state[6] + 1);
    };
    const auto [soft, torn] = factor(1.0075 * std::cbrt(1.5));
    EXPECT_NEAR(torn, 1.5, 1e-12);
    EXPECT_NEAR(soft, 0.0067, 5e-5);
    const auto [hard, packed] = factor(0.975 * std::cbrt(0.3));
    EXPECT_NEAR(packed, 0.3, 1e-12);
    EXPECT_NEAR(hard, 1100, 5);
}

// The limits of XI that the page prints for nu = 0.2, and the warning beyond them.
TEST(DisneySnow, HardeningThatWouldYieldWorkIsAnnounced) {
    const auto warnings = [](const std::string& label, const Numbers& constants) {
        UmatPoint point("DISNEY_SNOW-" + label, solid, constants);
        return point.step({.dfgrd1 = Matrix3d::Identity()}).messages.warnings;
    };
    EXPECT_TRUE(warnings("A", {E0, nu, 0.025, 0.0075, 26.6}).empty());
    EXPECT_TRUE(warnings("B", {E0, nu, 0.05, 0.0075, 13.3}).empty());
    const auto first = warnings("C", {E0, nu, 0.025, 0.0075, 26.8});
    ASSERT_EQ(first.size(), 1u);
    EXPECT_NE(first[0].find("(XI, hardening) is above 26.68"), std::string::npos) << first[0];
    EXPECT_EQ(warnings("D", {E0, nu, 0.05, 0.0075, 13.5}).size(), 1u);
}

TEST(DisneySnow, BadConstantsAreRefusedByName) {
    const auto message = [](const Numbers& constants) {
        char text[512] = "";
        EXPECT_EQ(
            lode_required_state("DISNEY_SNOW-BAD", constants.data(), int(constants.size()), 3, 3, text, sizeof text),
            -1);
        return std::string(text);
    };
    EXPECT_NE(message({E0}).find("needs at least 2 constants"), std::string::npos);
    EXPECT_NE(message({0, nu}).find("(E0,"), std::string::npos);
    EXPECT_NE(message({E0, 0.5}).find("(NU,"), std::string::npos);
    EXPECT_NE(message({E0, nu, 1}).find("(THC, critical compression) must be [0, 1)"), std::string::npos);
    EXPECT_NE(message({E0, nu, 0.02, -0.1}).find("(THS, critical stretch) must be >= 0"), std::string::npos);
    EXPECT_NE(message({E0, nu, 0.02, 0.01, -1}).find("(XI, hardening) must be >= 0"), std::string::npos);
    EXPECT_NE(message({E0, nu, 0.02, 0.01, 10, 2}).find("(ELAS,"), std::string::npos);
    EXPECT_NE(message({E0, nu, 0.02, 0.01, 10, 0, 3}).find("(UJ,"), std::string::npos);
    char text[512];
    EXPECT_EQ(lode_required_state("DISNEY_SNOW", snow.data(), 2, 3, 3, text, sizeof text), 8);
    EXPECT_EQ(lode_required_state("DISNEY_SNOW", snow.data(), 2, 3, 1, text, sizeof text), 8);
    EXPECT_EQ(lode_required_state("DISNEY_SNOW", snow.data(), 2, 2, 1, text, sizeof text), -1);  // plane stress
    EXPECT_NE(std::string(text).find("DISNEY_SNOW"), std::string::npos);
    EXPECT_EQ(lode_required_state("DISNEY_SNOW", snow.data(), 2, 1, 0, text, sizeof text), -1);  // 1D
    EXPECT_EQ(lode_required_state("DISNEY_SNOW", snow.data(), 2, 1, 2, text, sizeof text), -1);  // cohesive
}

}  // namespace
}  // namespace lode::test::test_disney_snow
