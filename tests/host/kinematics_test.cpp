// Large rotation: what the host makes of F, and what it hands to a UMAT.
#include <cmath>
#include <numbers>

#include "replay/kinematics.hpp"
#include "support.hpp"

namespace lode::host::test {
namespace {

const std::string echo = "[material]\nname = \"ECHO\"\nconstants = [1000, 0.3]\nstate_variables = 70\n";
const std::string neo = "[material]\nname = \"NEO\"\nconstants = [10, 40]\n[analysis]\nlarge_rotation = true\n";

TEST(Kinematics, PolarDecompositionOfAShear) {
    Matrix3 F = Matrix3::Identity();
    F(0, 1) = 0.8;
    F(2, 2) = 1.3;
    const Polar p = polar(F);
    EXPECT_LT((p.rotation * p.right_stretch - F).norm(), 1e-14);
    EXPECT_LT((p.left_stretch * p.rotation - F).norm(), 1e-14);
    EXPECT_NEAR(p.rotation(0, 1), std::sin(std::atan(0.4)), 1e-15) << "tan of the angle is half the shear";
}

TEST(Kinematics, ExponentialInvertsLogarithm) {
    Matrix3 E;
    E << 0.3, 0.1, -0.2, 0.1, -0.4, 0.05, -0.2, 0.05, 0.2;
    EXPECT_LT((logarithm(exponential(E)) - E).norm(), 1e-14);
}

TEST(Kinematics, IncrementOfARigidRotationIsThatRotation) {
    const Matrix3 F0 = exponential(Matrix3{{0.2, 0.1, 0}, {0.1, 0, 0}, {0, 0, -0.1}});
    const Matrix3 R = rotation_about({1, 2, -1}, 1.1);
    const MotionIncrement motion = motion_increment(F0, R * F0);
    EXPECT_LT(motion.strain.norm(), 1e-15);
    EXPECT_LT((motion.rotation - R).norm(), 1e-14);
}

TEST(Kinematics, RigidRotationTurnsTheStress) {
    const History run = finished_run(
        "[material]\nname = \"ELASTIC\"\nconstants = [1000, 0.3]\n[analysis]\nlarge_rotation = true\nunnamed = "
        "\"strain\"\n"
        "[[step]]\nstrain = { 11 = 0.01, 12 = 0.004 }\nincrements = 2\n"
        "[[step]]\nrotation = { axis = [0, 0, 1], angle_degrees = 90 }\nincrements = 7\n");
    const PointState& before = run.records[2].point;
    const PointState& after = run.end();
    // Seven increments, each exact to round-off.
    EXPECT_NEAR(after.stress[0], before.stress[1], 1e-12);
    EXPECT_NEAR(after.stress[1], before.stress[0], 1e-12);
    EXPECT_NEAR(after.stress[3], -before.stress[3], 1e-12);
    EXPECT_NEAR(after.strain[1], before.strain[0], 1e-15) << "STRAN turns too";
    EXPECT_NEAR(after.work, before.work, 1e-15);
}

TEST(Kinematics, SimpleShearInFortranOrder) {
    const double shear = 0.3;
    const History run =
        finished_run(echo + "[[step]]\nincrements = 1\ndeformation_gradient = [[1, 0.3, 0], [0, 1, 0], [0, 0, 1]]\n");
    EXPECT_EQ(run.state(30 + 3), shear) << "DFGRD1(1,2) is the fourth of nine";
    EXPECT_EQ(run.state(30 + 1), 0);
    // Mid-increment velocity gradient: shear e1 e2; Hughes-Winget turns by 2 atan(shear / 4).
    const double angle = 2 * std::atan(shear / 4);
    EXPECT_NEAR(run.state(40), std::cos(angle), 1e-15);
    EXPECT_NEAR(run.state(40 + 3), std::sin(angle), 1e-15) << "DROT(1,2)";
    EXPECT_NEAR(run.state(40 + 1), -std::sin(angle), 1e-15) << "DROT(2,1)";
    EXPECT_NEAR(run.state(60 + 3), shear, 1e-15) << "engineering shear";
    EXPECT_NEAR(run.state(60), 0, 1e-15);
}

TEST(Kinematics, StretchWithoutRotationHasLogarithmicStrain) {
    const History run =
        finished_run(echo + "[[step]]\nincrements = 2\ndeformation_gradient = [[1.5, 0, 0], [0, 0.8, 0], [0, 0, 1]]\n");
    EXPECT_NEAR(run.strain(0), std::log(1.5), 1e-15);
    EXPECT_NEAR(run.strain(1), std::log(0.8), 1e-15);
    EXPECT_NEAR(run.state(60), std::log(1.5 / 1.25), 1e-15);
    EXPECT_EQ(run.state(40), 1) << "DROT is exactly one";
}

TEST(Kinematics, SmallRotationAnalysesPassUnitGradients) {
    const History run = finished_run(echo + "[[step]]\nincrements = 1\nstrain = { 11 = 0.2, 12 = 0.3 }\n");
    EXPECT_TRUE(run.end().F.isIdentity(0));
}

TEST(Kinematics, UniaxialTensionOfAHyperelasticMaterial) {
    const History run = finished_run(neo + "[[step]]\nstrain = { 11 = 0.6931471805599453 }\nincrements = 5\n");
    // mu (t^2 - 1) + lambda ln(2 t^2) = 0 gives the lateral stretch t.
    double low = 0.1, high = 1;
    for (int i = 0; i < 200; ++i) {
        const double t = 0.5 * (low + high);
        (10 * (t * t - 1) + 40 * std::log(2 * t * t) > 0 ? high : low) = t;
    }
    const double t = low, J = 2 * t * t;
    const double stress = (10 * 3 + 40 * std::log(J)) / J;
    EXPECT_NEAR(run.end().F(0, 0), 2, 1e-14);
    EXPECT_NEAR(run.end().F(1, 1), t, 1e-9);
    EXPECT_NEAR(run.stress(0), stress, 1e-8);
    EXPECT_NEAR(run.stress(2), 0, stress * 1e-9);
    EXPECT_EQ(run.outcome.statistics.cut_backs, 0);
}

TEST(Kinematics, MixedControlWithShearAtLargeStrain) {
    const History run = finished_run(neo + "[[step]]\nstrain = { 12 = 0.8 }\nstress = { 11 = 3 }\nincrements = 4\n");
    EXPECT_NEAR(run.stress(0), 3, 1e-7);
    EXPECT_NEAR(run.stress(1), 0, 1e-7);
    EXPECT_LT((logarithm(run.end().F) - Layout(Kind::solid).strain_tensor(run.end().strain)).norm(), 1e-13)
        << "F is the exponential of the strain";
}

TEST(Kinematics, ShearOfAHyperelasticMaterialThroughF) {
    const History run =
        finished_run(neo + "[[step]]\ndeformation_gradient = [[1, 0.5, 0], [0, 1, 0], [0, 0, 1]]\nincrements = 3\n");
    EXPECT_NEAR(run.stress(3), 10 * 0.5, 1e-13);
    EXPECT_NEAR(run.stress(0), 10 * 0.25, 1e-13);
}

TEST(Kinematics, StrainControlGoesOnFromARotatedBody) {
    const History run = finished_run(neo +
                                     "[[step]]\ndeformation_gradient = [[1.2, 0, 0], [0, 1, 0], [0, 0, 1]]\n"
                                     "rotation = { axis = [0, 0, 1], angle_degrees = 90 }\nincrements = 10\n"
                                     "[[step]]\nrelative = true\nstrain = { 22 = 0.1 }\nincrements = 3\n");
    const PointState& before = run.records[10].point;
    // The stretched fibre lies along 2 now; stretching that axis further multiplies it.
    EXPECT_NEAR(before.F(1, 0), 1.2, 1e-14);
    EXPECT_NEAR(run.end().F(1, 0), 1.2 * std::exp(0.1), 1e-13);
    EXPECT_NEAR(run.end().F(0, 1), before.F(0, 1), 1e-13);
    EXPECT_GT(run.stress(1), before.stress[1]);
}

TEST(Kinematics, PlaneKindsFillTheThirdDirection) {
    const std::string step =
        "large_rotation = true\nunnamed = \"strain\"\n[[step]]\nstrain = { 11 = 0.2, 22 = 0.1 }\nincrements = 1\n";
    const History stress = finished_run(echo + "[analysis]\nkind = \"plane_stress\"\n" + step);
    EXPECT_NEAR(stress.end().F(2, 2), std::exp(-0.3), 1e-14);
    const History strain = finished_run(echo + "[analysis]\nkind = \"plane_strain\"\n" + step);
    EXPECT_EQ(strain.end().F(2, 2), 1);
    const History hoop = finished_run(echo +
                                      "[analysis]\nkind = \"axisymmetric\"\nlarge_rotation = true\nunnamed = "
                                      "\"strain\"\n[[step]]\nstrain = { 33 = 0.2 }\n");
    EXPECT_NEAR(hoop.end().F(2, 2), std::exp(0.2), 1e-14);
}

}  // namespace
}  // namespace lode::host::test
