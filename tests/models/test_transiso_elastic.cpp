// TRANSISO_ELASTIC against the verification cases of page 10, sections 3 and 6, and its refusals.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "large_rotation.hpp"
#include "lode/elastic/orthotropic_moduli.hpp"
#include "vumat_block.hpp"

namespace lode::test::test_transiso_elastic {
namespace {

using enum AnalysisKind;

const Numbers T = {140000.0, 9000.0, 0.3, 0.4, 5000.0};
const Numbers increment = {1e-3, -2e-4, 5e-4, 4e-4, -6e-4, 8e-4};

Numbers with(Numbers props, const Numbers& more) {
    props.insert(props.end(), more.begin(), more.end());
    return props;
}
UmatPoint material(AnalysisKind kind, const Numbers& more = {}) {
    return UmatPoint("TRANSISO_ELASTIC-TEST", kind, with(T, more));
}
Matrix3d about_3(double degrees) {
    return Eigen::AngleAxisd(degrees * std::numbers::pi / 180.0, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}
Matrix3d simple_shear(double gamma) {
    Matrix3d f = Matrix3d::Identity();
    f(0, 1) = gamma;
    return f;
}

TEST(TransisoElastic, StiffnessEntries) {
    const Answer answer = material(solid).advance({});
    const double C33 = 142753.095412, C13 = 4588.49235251, C11 = 10861.7729685, C12 = 4433.2015399, GT = 3214.28571429;
    const Eigen::MatrixXd& c = answer.tangent;
    EXPECT_NEAR(c(2, 2), C33, 1e-6);
    EXPECT_NEAR(c(0, 2), C13, 1e-8);
    EXPECT_NEAR(c(1, 2), C13, 1e-8);
    EXPECT_NEAR(c(0, 0), C11, 1e-7);
    EXPECT_NEAR(c(1, 1), C11, 1e-7);
    EXPECT_NEAR(c(0, 1), C12, 1e-7);
    EXPECT_NEAR(c(3, 3), GT, 1e-8);
    EXPECT_EQ(c(4, 4), 5000.0);
    EXPECT_EQ(c(5, 5), 5000.0);
    EXPECT_EQ(c(0, 3), 0.0);
    // Bound of rho c^2 (section 1.9).
    EXPECT_NEAR(OrthotropicModuli::transversely_isotropic(T[0], T[1], T[2], T[3], T[4], 3).wave_modulus(), 143082.6,
                0.05);
}

TEST(TransisoElastic, T1_SolidIncrement) {
    const Answer answer = material(solid).advance({.dstran = increment});
    expect_digits(answer.stress, {12.2693788367, 4.55509312246, 75.0473415878, 1.28571428571, -3.0, 4.0});
    double work = 0.0;
    for (std::size_t i = 0; i < 6; ++i) work += 0.5 * answer.stress[i] * increment[i];
    EXPECT_NEAR(answer.sse, work, 1e-14);
}

TEST(TransisoElastic, T2_GeneralAxesAndHeat) {
    UmatPoint point = material(solid, {-1e-6, 3e-5, 0.0, 0.0, 1.0, 30.0, 20.0, 10.0});
    expect_digits(point.advance({.dstran = increment, .dtemp = 50.0}).stress,
                  {77.8051642666, 9.11044423936, 1.49440277687, 50.3100857203, -38.4196708586, -17.7010847222});
    EXPECT_EQ(point.state(3), 50.0);
}

TEST(TransisoElastic, T3_PlaneStress) {
    UmatPoint point = material(plane_stress, {-1e-6, 3e-5, 0.0, 0.0, 1.0, 30.0});
    expect_digits(point.advance({.dstran = {1e-3, 2e-4, 5e-4}, .dtemp = 50.0}).stress,
                  {109.615572693, 27.9677772344, 66.2808617995});
    EXPECT_NEAR(point.state(1), 1.58678893858e-3, 5e-15);
}

TEST(TransisoElastic, T4_PlaneStrainAcrossTheFibres) {
    UmatPoint point = material(plane_strain, {-1e-6, 3e-5, 0.0, 0.0, 3.0});
    expect_digits(point.advance({.dstran = {1e-3, 2e-4, 0, 5e-4}, .dtemp = 50.0}).stress,
                  {-10.9646238685, -16.1074810113, -1.12163146395, 1.60714285714});
}

TEST(TransisoElastic, T5_AxesTurnWithTheHost) {
    UmatPoint point = material(solid, {0.0, 0.0, 0.0, 0.0, 1.0});
    const Numbers pull = {1e-3, 0, 0, 0, 0, 0};
    expect_digits(point.advance({.dstran = pull}).stress, {142.753095412, 4.58849235251, 4.58849235251, 0, 0, 0});
    expect_digits(point.advance({.drot = about_3(40.0)}).stress,
                  {85.6668096516, 61.6747781124, 4.58849235251, 68.0327861422, 0, 0});
    expect_digits(point.advance({.dstran = pull}).stress,
                  {143.754182149, 96.4346760537, 9.11282228203, 105.824718218, 0, 0});
    EXPECT_NEAR(point.state(5), -0.233955556881, 5e-13);
    EXPECT_NEAR(point.state(6), -0.642787609687, 5e-13);
    EXPECT_NEAR(point.state(8), 0.642787609687, 5e-13);
    EXPECT_NEAR(point.state(9), -0.233955556881, 5e-13);
}

TEST(TransisoElastic, T6_TotalLawInSimpleShear) {
    UmatPoint point = material(solid, {0, 0, 0, 0, 1, 0, 0, 0, 1});
    expect_digits(point.advance({.dfgrd1 = simple_shear(0.2)}).stress,
                  {-435.160018914, -65.2732114505, 43.4510573062, 1052.50125541, 0, 0});
    // STATEV 5-13: Rp - I; Rp turns clockwise by atan(gamma/2).
    const double angle = -std::atan(0.1);
    EXPECT_NEAR(point.state(5), std::cos(angle) - 1.0, 1e-16);
    EXPECT_NEAR(point.state(6), -std::sin(angle), 1e-16);
    EXPECT_NEAR(point.state(8), std::sin(angle), 1e-16);
    EXPECT_NEAR(point.state(13), 0.0, 1e-16);
}

// The plane kinds turn like the solid.
TEST(TransisoElastic, PlaneKindsTurnWithTheHost) {
    UmatPoint full = material(solid, {-1e-6, 3e-5, 0, 0, 1, 20}),
              flat = material(plane_strain, {-1e-6, 3e-5, 0, 0, 1, 20});
    for (int i = 0; i < 3; ++i) {
        const Matrix3d drot = about_3(25.0);
        full.advance({.dstran = {1e-3, -4e-4, 0, 6e-4, 0, 0}, .dtemp = 10.0, .drot = drot});
        flat.advance({.dstran = {1e-3, -4e-4, 0, 6e-4}, .dtemp = 10.0, .drot = drot});
    }
    const Numbers s = full.stress();
    EXPECT_LE(distance(flat.stress(), {s[0], s[1], s[2], s[3]}), 1e-13 * largest(s));
    EXPECT_LE(distance(flat.state(), full.state()), 1e-15);
}

// KIN = 2 is KIN = 1 seen from axes that turn with the material: components of V and of the tangent, rotated (1.8).
TEST(TransisoElastic, TurningBasisIsTheFixedOneRotated) {
    Matrix3d f;
    f << 1.2, 0.3, -0.1, -0.2, 0.9, 0.15, 0.1, -0.25, 1.1;
    const Matrix3d r = polar_rotation(f);
    const Numbers more = {-1e-6, 3e-5, 0, 0, 1, 30, 20, 10};
    const Answer fixed = material(solid, with(more, {1})).advance({.dtemp = 20.0, .dfgrd1 = f});
    // F in the turned basis, both indices.
    const Answer turning = material(solid, with(more, {2})).advance({.dtemp = 20.0, .dfgrd1 = r.transpose() * f});
    const Numbers back = rotated_stress(turning.stress, solid, r);
    EXPECT_LE(distance(fixed.stress, back), 1e-14 * largest(fixed.stress) * 10.0);
    for (int j = 0; j < 6; ++j) {
        Numbers unit(6, 0.0);
        unit[static_cast<std::size_t>(j)] = 1.0;
        const Numbers local = rotated_strain(unit, solid, r.transpose());
        const Eigen::VectorXd rate = turning.tangent * Eigen::Map<const Eigen::VectorXd>(local.data(), 6);
        const Numbers column = rotated_stress({rate.data(), rate.data() + 6}, solid, r);
        for (int i = 0; i < 6; ++i)
            EXPECT_NEAR(fixed.tangent(i, j), column[static_cast<std::size_t>(i)], 1e-14 * 140000.0 * 10.0);
    }
    for (int i = 5; i <= 13; ++i) EXPECT_EQ(turning.state[static_cast<std::size_t>(i) - 1], 0.0);
}

// A VUMAT works in the frame that turns with R: KIN = 1, 2 see U, KIN = 0 the strain increment.
TEST(TransisoElastic, ExplicitHostsTurnTheFrame) {
    Matrix3d f;
    f << 1.1, 0.2, 0.0, -0.1, 0.95, 0.0, 0.0, 0.0, 1.05;
    const Matrix3d r = polar_rotation(f), u = r.transpose() * f;
    const Numbers more = {0, 0, 0, 0, 1, 30, 0, 0};
    const Numbers implicit = material(solid, with(more, {1})).advance({.dfgrd1 = f}).stress;
    for (const double kin : {1.0, 2.0}) {
        VumatBlock block("TRANSISO_ELASTIC-TEST", solid, with(T, with(more, {kin})));
        for (int i = 0; i < 11; ++i) block.points.push_back(block.fresh_point());
        for (VumatPoint& p : block.points) p.stretch = u;
        ASSERT_EQ(block.run().stops, 0);
        for (const VumatPoint& p : block.points)
            EXPECT_LE(distance(rotated_stress(p.stress, solid, r), implicit), 1e-14 * 140000.0);
    }
    VumatBlock block("TRANSISO_ELASTIC-TEST", solid, with(T, more));
    for (int i = 0; i < 11; ++i) block.points.push_back(block.fresh_point());
    for (VumatPoint& p : block.points) p.strain_increment = increment;
    ASSERT_EQ(block.run().stops, 0);
    const Numbers small = material(solid, more).advance({.dstran = increment}).stress;
    for (const VumatPoint& p : block.points) EXPECT_LE(distance(p.stress, small), 1e-15 * largest(small) * 10.0);
}

// Section 6: F = Rz(t) (I + t A), 57.3 degrees with 2-3 % strain; relative errors of the host's increments.
Matrix3d turn_and_stretch(double t) {
    Matrix3d stretch = Matrix3d::Identity();
    stretch(0, 0) += 0.02 * t;
    stretch(0, 1) += 0.03 * t;
    stretch(1, 1) -= 0.01 * t;
    return Eigen::AngleAxisd(t, Eigen::Vector3d::UnitZ()).toRotationMatrix() * stretch;
}
const Numbers reference = {688.99588154, 2043.7987254, 46.27409905, 1215.54555136, 0, 0};

double turning_error(int increments, Load (*make)(const Matrix3d&, const Matrix3d&, AnalysisKind)) {
    UmatPoint point = material(solid, {0, 0, 0, 0, 1});
    follow(point, increments, turn_and_stretch, make);
    // The norm of the six components.
    const Eigen::Map<const Eigen::VectorXd> s(point.stress().data(), 6), exact(reference.data(), 6);
    return (s - exact).norm() / exact.norm();
}

TEST(TransisoElastic, LargeRotationWithHughesWinget) {
    const std::pair<int, double> table[] = {{1, 0.66}, {4, 0.17}, {16, 0.045}, {64, 0.011}, {256, 2.8e-3}};
    for (const auto& [increments, error] : table)
        EXPECT_NEAR(turning_error(increments, hughes_winget_increment), error, 0.05 * error) << increments;
}

TEST(TransisoElastic, LargeRotationWithPolarIncrements) {
    const std::pair<int, double> table[] = {{1, 3.7e-6}, {4, 2.3e-7}, {16, 1.4e-8}};
    for (const auto& [increments, error] : table)
        EXPECT_NEAR(turning_error(increments, polar_increment), error, 0.05 * error) << increments;
    EXPECT_LE(turning_error(256, polar_increment), 1e-10);
}

TEST(TransisoElastic, LargeRotationWithTheTotalLaw) {
    UmatPoint point = material(solid, {0, 0, 0, 0, 1, 0, 0, 0, 1});
    const auto at = [](double, double) { return turn_and_stretch(1.0); };
    expect_digits(point.advance({.dfgrd1 = at(0.0, 1.0)}).stress,
                  {704.20841774, 2076.59769785, 48.41264439, 1234.43272292, 0, 0});
}

std::string refusal(const Numbers& props, int ndi = 3, int nshr = 3) {
    char text[512] = "";
    EXPECT_EQ(lode_required_state("TRANSISO_ELASTIC-BAD", props.data(), static_cast<int>(props.size()), ndi, nshr, text,
                                  sizeof text),
              -1);
    return text;
}

TEST(TransisoElastic, RefusesWhatCannotBe) {
    // KT > 0: nuA^2 < (1 - nuT) EA/(2 ET) = 14/3.
    const double limit = std::sqrt(0.6 * 140000.0 / 18000.0);
    EXPECT_NE(refusal({140000, 9000, 2.2, 0.4, 5000}).find("PROPS(3) = 2.2 (NUA"), std::string::npos);
    EXPECT_NE(refusal({140000, 9000, -2.2, 0.4, 5000}).find("2.16024"), std::string::npos);
    EXPECT_NE(refusal({140000, 9000, limit, 0.4, 5000}).find("NUA"), std::string::npos);
    const Numbers nearly = {140000, 9000, limit * (1.0 - 1e-9), 0.4, 5000};
    EXPECT_EQ(lode_required_state("TRANSISO_ELASTIC", nearly.data(), 5, 3, 3, nullptr, 0), 13);
    EXPECT_NE(refusal({140000, 9000, 0.3, 1.0, 5000}).find("NUT"), std::string::npos);
    EXPECT_NE(refusal({140000, 9000, 0.3, -1.0, 5000}).find("NUT"), std::string::npos);
    EXPECT_NE(refusal({0, 9000, 0.3, 0.4, 5000}).find("(EA,"), std::string::npos);
    EXPECT_NE(refusal({140000, 0, 0.3, 0.4, 5000}).find("(ET,"), std::string::npos);
    EXPECT_NE(refusal({140000, 9000, 0.3, 0.4, 0}).find("(GA,"), std::string::npos);
    EXPECT_NE(refusal(with(T, {0, 0, 0, 0, 4})).find("AXIS"), std::string::npos);
    EXPECT_NE(refusal(with(T, {0, 0, 0, 0, 1.5})).find("AXIS"), std::string::npos);
    EXPECT_NE(refusal(with(T, {0, 0, 0, 0, 1, 0, 0, 0, 3})).find("KIN"), std::string::npos);
    EXPECT_NE(refusal(with(T, {0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -1})).find("TOOP"), std::string::npos);
    EXPECT_NE(refusal({140000, 9000, 0.3, 0.4}).find("GA"), std::string::npos);
}

// 2D elements keep one material axis normal to the plane; multiples of 90 degrees are fine.
TEST(TransisoElastic, PlaneElementsRefuseTiltedAxes) {
    for (const AnalysisKind kind : {plane_strain, plane_stress}) {
        for (const Numbers& angles : {Numbers{0, 20, 0}, Numbers{30, 0, 0.01}}) {
            UmatPoint tilted = material(kind, with({0, 0, 0, 0, 1}, angles));
            const Answer answer = tilted.step({});
            EXPECT_EQ(answer.messages.stops, 1);
            EXPECT_NE(answer.first_error().find("material axes of a 2D element must keep one axis normal to the plane"),
                      std::string::npos)
                << answer.first_error();
        }
        EXPECT_TRUE(material(kind, {0, 0, 0, 0, 1, 30, 90, 180}).step({}).done());
    }
    EXPECT_TRUE(material(uniaxial, {0, 0, 0, 0, 1, 30, 20, 10}).step({}).done());
    EXPECT_NE(refusal(T, 1, 2).find("not served"), std::string::npos);
    EXPECT_NE(refusal(T, 1, 1).find("not served"), std::string::npos);
}

// Axis 1 turned onto axis 3 is axis 3: zeros stay exact.
TEST(TransisoElastic, QuarterTurnsPermuteTheAxes) {
    const Answer turned =
        material(solid, {-1e-6, 3e-5, 0, 0, 1, 0, -90, 0}).advance({.dstran = increment, .dtemp = 10});
    const Answer direct = material(solid, {-1e-6, 3e-5, 0, 0, 3}).advance({.dstran = increment, .dtemp = 10});
    EXPECT_LE(distance(turned.stress, direct.stress), 1e-15 * 140.0);
    EXPECT_LE((turned.tangent - direct.tangent).cwiseAbs().maxCoeff(), 1e-15 * 140000.0);
}

TEST(TransisoElastic, InvertedElementAsksForASmallerIncrement) {
    for (const AnalysisKind kind : {solid, plane_strain, plane_stress}) {
        for (const double kin : {1.0, 2.0}) {
            UmatPoint point = material(kind, {0, 0, 0, 0, 1, 30, 0, 0, kin});
            for (const double stretch : {0.0, -0.5}) {
                const Answer answer = point.step({.dfgrd1 = Eigen::Vector3d(stretch, 1.0, 1.0).asDiagonal()});
                EXPECT_TRUE(answer.cut);
                EXPECT_EQ(answer.pnewdt, 0.25);
            }
        }
    }
    VumatBlock block("TRANSISO_ELASTIC-TEST", solid, with(T, {0, 0, 0, 0, 1, 30, 0, 0, 1}));
    for (int i = 0; i < 9; ++i) block.points.push_back(block.fresh_point());
    block.points[4].stretch = Eigen::Vector3d(-0.5, 1.0, 1.0).asDiagonal();
    const HostMessages messages = block.run();
    EXPECT_EQ(messages.stops, 1);
    EXPECT_NE(messages.errors.front().find("det F <= 0"), std::string::npos);
}

}  // namespace
}  // namespace lode::test::test_transiso_elastic
