// ORTHO_ELASTIC against the verification cases of page 10, section 4, its closed forms and its refusals.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "large_rotation.hpp"
#include "lode/elastic/orthotropic_moduli.hpp"

namespace lode::test::test_ortho_elastic {
namespace {

using enum AnalysisKind;

const Numbers O = {12000.0, 900.0, 500.0, 0.4, 0.5, 0.6, 800.0, 700.0, 60.0};
const Numbers increment = {1e-3, -2e-4, 5e-4, 4e-4, -6e-4, 8e-4};

Numbers with(Numbers props, const Numbers& more) {
    props.insert(props.end(), more.begin(), more.end());
    return props;
}
UmatPoint material(AnalysisKind kind, const Numbers& more = {}) {
    return UmatPoint("ORTHO_ELASTIC-TEST", kind, with(O, more));
}

TEST(OrthoElastic, StiffnessEntries) {
    const Eigen::MatrixXd c = material(solid).advance({}).tangent;
    EXPECT_NEAR(c(0, 0), 12506.7853653, 5e-8);
    EXPECT_NEAR(c(0, 1), 664.422972533, 5e-10);
    EXPECT_NEAR(c(0, 2), 482.032352622, 5e-10);
    EXPECT_NEAR(c(1, 1), 1160.29747042, 5e-9);
    EXPECT_NEAR(c(1, 2), 400.607968733, 5e-10);
    EXPECT_NEAR(c(2, 2), 643.578330257, 5e-10);
    EXPECT_EQ(c(3, 3), 800.0);
    EXPECT_EQ(c(4, 4), 700.0);
    EXPECT_EQ(c(5, 5), 60.0);
    EXPECT_EQ(c, c.transpose());
    const auto moduli = OrthotropicModuli::from_constants({O[0], O[1], O[2], O[3], O[4], O[5], O[6], O[7], O[8]});
    EXPECT_NEAR(moduli.wave_modulus(), 12566.93, 5e-3);
    // C S = 1
    const auto product = moduli.stiffness_matrix() * moduli.compliance_matrix();
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j) EXPECT_NEAR(product(i, j), i == j ? 1.0 : 0.0, 1e-15);
}

// Counter-clockwise angles: the signs of section 7.
TEST(OrthoElastic, RotatedEntries) {
    const double angle = 30.0, s = 0.5, c = std::sqrt(0.75);
    const Eigen::MatrixXd C = material(solid).advance({}).tangent;
    const Numbers turned = {0, 0, 0, 0, 0, 0, angle};
    const Eigen::MatrixXd R = material(solid, turned).advance({}).tangent;
    EXPECT_NEAR(R(0, 3), 3445.82985182, 5e-9);
    EXPECT_NEAR(R(2, 3), 35.2577924676, 5e-11);
    EXPECT_NEAR(R(2, 3), (C(0, 2) - C(1, 2)) * s * c, 1e-12);
    EXPECT_NEAR(R(0, 3),
                c * c * c * s * (C(0, 0) - C(0, 1) - 2 * C(3, 3)) + c * s * s * s * (C(0, 1) - C(1, 1) + 2 * C(3, 3)),
                1e-11);
    const Eigen::MatrixXd S = C.inverse(), S_turned = R.inverse();
    EXPECT_NEAR(S_turned(2, 3), 2.0 * (S(0, 2) - S(1, 2)) * s * c, 1e-16);
    // Plane stress: Q = (S_ab)^-1 of the rotated compliance.
    const Eigen::Vector3i in_plane(0, 1, 3);
    const Eigen::Matrix3d Q = S_turned(in_plane, in_plane).inverse();
    EXPECT_LE((material(plane_stress, turned).advance({}).tangent - Q).cwiseAbs().maxCoeff(), 1e-11);
    EXPECT_NEAR(material(uniaxial, turned).advance({}).tangent(0, 0), 1.0 / S_turned(0, 0), 1e-11);
    const Eigen::Vector4i with_thickness(0, 1, 2, 3);
    EXPECT_LE(
        (material(plane_strain, turned).advance({}).tangent - R(with_thickness, with_thickness)).cwiseAbs().maxCoeff(),
        1e-11);
}

TEST(OrthoElastic, O1_SolidIncrement) {
    const Answer answer = material(solid).advance({.dstran = increment});
    expect_digits(answer.stress, {12.6149169471, 0.632667462816, 0.723699924004, 0.32, -0.42, 0.048});
}

TEST(OrthoElastic, O2_PlaneStress) {
    UmatPoint point = material(plane_stress, {5e-6, 3e-5, 4e-5, 0.0, 0.2, 0.35, 30.0});
    expect_digits(point.advance({.dstran = {1e-3, 2e-4, 5e-4}, .dtemp = 20.0, .dpred = {0.01}}).stress,
                  {7.52832537105, 0.855501041405, 5.07032286762});
    EXPECT_NEAR(point.state(1), 5.11774970256e-3, 5e-15);
    EXPECT_EQ(point.state(3), 20.0);
    EXPECT_EQ(point.state(4), 0.01);
}

TEST(OrthoElastic, O3_PlaneStrain) {
    UmatPoint point = material(plane_strain, {5e-6, 3e-5, 4e-5, 0.0, 0.2, 0.35, 30.0});
    expect_digits(point.advance({.dstran = {1e-3, 2e-4, 0, 5e-4}, .dtemp = 20.0, .dpred = {0.01}}).stress,
                  {5.1655818459, -1.29888767553, -3.29367280825, 4.8898823107});
}

TEST(OrthoElastic, O4_Uniaxial) {
    UmatPoint point = material(uniaxial, {5e-6, 3e-5, 4e-5, 0, 0, 0, 30});
    expect_digits(point.advance({.dstran = {1e-3}, .dtemp = 20.0}).stress, {2.29158110883});
}

TEST(OrthoElastic, O5_GeneralAxes) {
    UmatPoint point = material(solid, {0, 0, 0, 0, 0, 0, 25, -15, 40});
    const Answer answer = point.advance({.dstran = increment});
    expect_digits(answer.stress,
                  {9.13595229172, 2.33091654556, 1.41811707774, 3.43080327896, 1.93819935793, 1.22302870601});
    double work = 0.0;
    for (std::size_t i = 0; i < 6; ++i) work += 0.5 * answer.stress[i] * increment[i];
    EXPECT_NEAR(answer.sse, work, 1e-15);
}

// Generalized plane strain is the (3,1) law with eps33 given; generalized plane stress imposes sigma33 (1.4, 1.6).
TEST(OrthoElastic, GeneralizedPlaneStrain) {
    const Numbers expansion = {5e-6, 3e-5, 4e-5, 0.0, 0.2, 0.35, 30.0, 0, 0};
    UmatPoint option = material(plane_strain, with(expansion, {0, 1e-3, 2}));
    UmatPoint element = material(plane_strain, expansion);
    for (int i = 0; i < 3; ++i) {  // the ramp ends after two increments
        option.advance({.dstran = {1e-3, 2e-4, 0, 5e-4}, .dtemp = 20.0});
        element.advance({.dstran = {1e-3, 2e-4, i < 2 ? 5e-4 : 0.0, 5e-4}, .dtemp = 20.0});
    }
    EXPECT_LE(distance(option.stress(), element.stress()), 1e-14 * largest(element.stress()));
    EXPECT_EQ(option.state(2), 1e-3);
}

TEST(OrthoElastic, GeneralizedPlaneStress) {
    for (const double kin : {0.0, 1.0}) {
        UmatPoint flat = material(plane_stress, {5e-6, 3e-5, 4e-5, 0.0, 0.2, 0.35, 30, 0, 0, kin, -2.0, 2.0});
        UmatPoint full = material(solid, {5e-6, 3e-5, 4e-5, 0.0, 0.2, 0.35, 30, 0, 0, kin});
        Matrix3d f = Matrix3d::Identity();
        double ezz = 0.0, sse = 0.0;
        for (int i = 1; i <= 3; ++i) {
            f(0, 0) += 1e-3, f(0, 1) += 5e-4, f(1, 1) += 2e-4;
            const Answer answer =
                flat.advance({.dstran = {1e-3, 2e-4, 5e-4}, .dtemp = 20.0, .dpred = {0.01}, .dfgrd1 = f});
            const double thickness = flat.state(1) - ezz;
            ezz = flat.state(1);
            Matrix3d f_full = f;
            f_full(2, 2) = 1.0 + ezz;
            sse = answer.sse;
            const Answer check = full.advance(
                {.dstran = {1e-3, 2e-4, thickness, 5e-4, 0, 0}, .dtemp = 20.0, .dpred = {0.01}, .dfgrd1 = f_full});
            EXPECT_EQ(flat.state(2), i == 1 ? -1.0 : -2.0);
            EXPECT_NEAR(check.stress[2], flat.state(2), 1e-11);
            for (const std::size_t k : {0u, 1u, 3u}) EXPECT_NEAR(check.stress[k], answer.stress[k == 3 ? 2 : k], 1e-11);
            EXPECT_NEAR(check.sse, sse, 1e-13);
        }
    }
}

// The total law forgets nothing but the path: increments, heat and moisture in any order give the same stress.
TEST(OrthoElastic, TotalLawIsIndependentOfThePath) {
    const Numbers more = {5e-6, 3e-5, 4e-5, 0.01, 0.2, 0.35, 25, -15, 40, 1};
    Matrix3d f;
    f << 1.05, 0.2, -0.1, -0.1, 0.97, 0.05, 0.02, -0.1, 1.02;
    const Numbers once = material(solid, more).advance({.dtemp = 50.0, .dpred = {0.02}, .dfgrd1 = f}).stress;
    UmatPoint point = material(solid, more);
    point.advance({.dtemp = 80.0, .dfgrd1 = Eigen::AngleAxisd(2.0, Eigen::Vector3d(1, 2, 3).normalized()) * f});
    point.advance({.dtemp = -30.0, .dpred = {0.03}});
    const Numbers twice = point.advance({.dpred = {-0.01}, .dfgrd1 = f}).stress;
    EXPECT_LE(distance(once, twice), 1e-14 * 12000.0);
}

std::string refusal(const Numbers& props) {
    char text[512] = "";
    EXPECT_EQ(
        lode_required_state("ORTHO_ELASTIC-BAD", props.data(), static_cast<int>(props.size()), 3, 3, text, sizeof text),
        -1);
    return text;
}

TEST(OrthoElastic, RefusesWhatCannotBe) {
    // nu12^2 < E1/E2 = 13.33, nu23^2 < E2/E3 = 1.8; the message has the limit and the offending product.
    Numbers bad = O;
    bad[3] = 4.0;
    EXPECT_NE(refusal(bad).find("PROPS(4) = 4 (NU12"), std::string::npos);
    EXPECT_NE(refusal(bad).find("3.6514"), std::string::npos);
    EXPECT_NE(refusal(bad).find("1.2 < 1"), std::string::npos);
    bad = O, bad[4] = -5.0;
    EXPECT_NE(refusal(bad).find("(NU13"), std::string::npos);
    bad = O, bad[5] = 1.4;
    EXPECT_NE(refusal(bad).find("(NU23"), std::string::npos);
    // All products below 1, but D = 1 - 0.81 * 3 - 2 * 0.729 < 0.
    EXPECT_NE(refusal({100, 100, 100, 0.9, 0.9, 0.9, 50, 50, 50}).find("= -2.888 must be > 0"), std::string::npos);
    // The isotropic limit nu = 0.5 is D = 0: strict.
    EXPECT_NE(refusal({100, 100, 100, 0.5, 0.5, 0.5, 50, 50, 50}).find("must be > 0"), std::string::npos);
    for (std::size_t i = 0; i < 9; ++i) {
        if (i >= 3 && i < 6) continue;
        bad = O, bad[i] = 0.0;
        EXPECT_NE(refusal(bad).find("PROPS(" + std::to_string(i + 1) + ") = 0"), std::string::npos);
    }
    EXPECT_NE(refusal(with(O, {0, 0, 0, 0, 0, 0, 0, 0, 0, 3})).find("KIN"), std::string::npos);
    EXPECT_NE(refusal(with(O, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, -1})).find("TOOP"), std::string::npos);
    EXPECT_NE(refusal({1, 2, 3, 0, 0, 0, 1, 1}).find("G23"), std::string::npos);
}

TEST(OrthoElastic, PlaneElementsRefuseTiltedAxes) {
    UmatPoint tilted = material(plane_stress, {0, 0, 0, 0, 0, 0, 30, 10, 0});
    const Answer answer = tilted.step({});
    EXPECT_EQ(answer.messages.stops, 1);
    EXPECT_NE(answer.first_error().find("one axis normal to the plane"), std::string::npos) << answer.first_error();
    // Axis 1 normal to the plane.
    const Eigen::MatrixXd c = material(plane_strain, {0, 0, 0, 0, 0, 0, 0, 90, 0}).advance({}).tangent;
    EXPECT_NEAR(c(2, 2), 12506.7853653, 5e-8);
    EXPECT_NEAR(c(0, 0), 643.578330257, 5e-10);
    EXPECT_NEAR(c(3, 3), 60.0, 1e-13);
}

}  // namespace
}  // namespace lode::test::test_ortho_elastic
