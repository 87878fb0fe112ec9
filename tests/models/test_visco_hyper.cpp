// VISCO_HYPER: the verification cases and failure modes of page 60, section 3.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "lode/viscoelastic/visco_hyper.hpp"
#include "umat_point.hpp"
#include "vumat_block.hpp"

namespace lode::test::test_visco_hyper {
namespace {

constexpr AnalysisKind solid = AnalysisKind::solid, plane_strain = AnalysisKind::plane_strain,
                       plane_stress = AnalysisKind::plane_stress;
constexpr double printed = 6e-12;  // twelve digits
constexpr int DISS = 3, F33M1 = 4, H1 = 11;
const Numbers HY = {200, 1000, 100, 2, 0.3, 0.5, 0.2, 4};

Numbers operator+(Numbers a, const Numbers& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}
UmatPoint material(AnalysisKind kind, Numbers props) { return UmatPoint("VISCO_HYPER-TEST", kind, std::move(props)); }
Matrix3d matrix(double f11, double f12, double f21, double f22, double f33 = 1.0) {
    Matrix3d f;
    f << f11, f12, 0, f21, f22, 0, 0, 0, f33;
    return f;
}
Matrix3d shear(double gamma) { return matrix(1, gamma, 0, 1); }

// Components that are not given are zero.
void expect_stress(const Numbers& expected, const Numbers& actual, double relative = printed) {
    for (std::size_t i = 0; i < actual.size(); ++i) {
        const double x = i < expected.size() ? expected[i] : 0.0;
        EXPECT_NEAR(actual[i], x, relative * std::abs(x) + 1e-13 * largest(actual)) << "component " << i + 1;
    }
}
void expect_close(double expected, double actual, double relative = printed) {
    EXPECT_NEAR(actual, expected, relative * std::abs(expected));
}

// --- Verification table -------------------------------------------------------------------------------------------

TEST(ViscoHyper, H1_RelaxationAtFixedDeformation) {
    UmatPoint p = material(solid, HY);
    p.advance({.dtime = 1e-12, .dfgrd1 = shear(0.8)});
    expect_stress({106.666666667, -85.3333333333, -21.3333333333, 240}, p.stress(), 1e-11);
    p.advance({.dtime = 1});
    expect_stress({74.2784791024, -59.4227832819, -14.8556958205, 167.12657798}, p.stress(), 1e-11);
    const double g = 0.5 + 0.3 * std::exp(-2.0) + 0.2 * std::exp(-0.25);
    expect_close(0.696360741585, g);
    expect_close(240 * g, p.stress()[3], 1e-11);
}

TEST(ViscoHyper, H2_UniaxialStrainAndHeating) {
    UmatPoint p = material(solid, HY + Numbers{1e-3});
    p.advance({.dtime = 0.5, .dtemp = 10, .dfgrd1 = matrix(1.25, 0, 0, 1)});
    expect_stress({261.257363383, 160.891285638, 160.891285638}, p.stress());
    expect_close(43.4156664419, p.state(H1));
    p.advance({.dtime = 0.5, .dtemp = 10, .dfgrd1 = matrix(1.5, 0, 0, 1)});
    expect_stress({450.905329074, 303.114162473, 303.114162473}, p.stress());
    expect_close(37.2464123999, p.state(H1));
}

TEST(ViscoHyper, H3_PlaneStress) {
    UmatPoint p = material(plane_stress, HY + Numbers{0, 0, 2});
    p.advance({.dtime = 0.5, .dfgrd1 = matrix(1.3, 0.4, 0, 1)});
    expect_stress({228.85897678, 61.6244945637, 78.6985798666}, p.stress());
    expect_close(-0.143164274451, p.state(F33M1));
    p.advance({.dtime = 0.5, .dfgrd1 = matrix(1.5, -0.2, 0, 1)});
    expect_stress({307.977187585, 97.5637519894, -51.3263346036}, p.stress());
    expect_close(-0.218926912169, p.state(F33M1));
}

TEST(ViscoHyper, H4_LargeRotation) {
    UmatPoint p = material(solid, HY + Numbers{0, 0, 1, 1});
    const Numbers table[2] = {
        {142.957924617, 91.6070269858, 65.4350483968, 58.7828340153, -1.3279019313, -29.140282231},
        {165.819539345, 146.339788348, -12.1593276936, 79.8028683996, -27.6786488632, -50.4390842836}};
    for (const int i : {1, 2}) {
        const Matrix3d r = Eigen::AngleAxisd(40 * i * std::numbers::pi / 180, Eigen::Vector3d(1, 1, 0).normalized())
                               .toRotationMatrix();
        p.advance({.dtime = 0.4, .dfgrd1 = r * matrix(1.1, 0.3 * i, 0, 1)});
        expect_stress(table[i - 1], p.stress());
    }
}

TEST(ViscoHyper, H5_WithoutTerms) {
    UmatPoint p = material(plane_strain, {200, 1000, 0, 0});
    p.advance({.dfgrd1 = matrix(1.2, 0.5, 0, 1)});
    expect_stress({251.225408587, 149.387295707, 149.387295707, 73.795733971}, p.stress());
}

TEST(ViscoHyper, H6_OneIncrementAndTangent) {
    UmatPoint p = material(solid, HY);
    const Answer a = p.advance({.dtime = 1, .dfgrd1 = shear(0.8)});
    expect_stress({86.04363531, -68.83490825, -17.20872706, 193.59817945}, p.stress(), 3e-10);  // ten digits
    expect_close(1425.9159948, a.tangent(0, 0), 6e-11);
    expect_close(769.833275538, a.tangent(0, 1));
    expect_close(319.436996099, a.tangent(3, 3));
    expect_close(21.5109088282, a.tangent(0, 3));
}

// --- Convergence and limits ---------------------------------------------------------------------------------------

TEST(ViscoHyper, ConvergesAsPrinted) {
    // Simple shear to 1.5 in time 1; 2, 4, ..., 32 increments.
    const double table[2][5] = {{1.8e-2, 4.7e-3, 1.2e-3, 3.0e-4, 7.5e-5}, {1.9e-2, 5.1e-3, 1.3e-3, 3.3e-4, 8.2e-5}};
    const auto stress = [](int meth, int n) {
        UmatPoint p = material(solid, HY + Numbers{0, 0, 0, double(meth)});
        for (int i = 1; i <= n; ++i) p.advance({.dtime = 1.0 / n, .dfgrd1 = shear(1.5 * i / n)});
        return p.stress();
    };
    const Numbers exact = stress(0, 4096);
    for (const int meth : {0, 1})
        for (int level = 0; level < 5; ++level) {
            const Numbers stresses = stress(meth, 2 << level);
            const auto vector = [](const Numbers& v) { return Eigen::Map<const Eigen::VectorXd>(v.data(), 6); };
            const double error = (vector(stresses) - vector(exact)).norm() / vector(exact).norm();
            EXPECT_NEAR(error, table[meth][level], 0.03 * table[meth][level]) << "METH " << meth << ", level " << level;
        }
}

// The linear model with K = 1000, G0 = 150 and terms 90/0.5 and 60/4.
TEST(ViscoHyper, SmallStrainLimit) {
    LODE_NEEDS("VISCOELASTIC");
    UmatPoint finite = material(solid, HY);
    UmatPoint linear("VISCOELASTIC-TEST", solid, {1000, 150, 2, 0, 90, 0.5, 60, 4});
    const Numbers d = {1e-6, -4e-7, 2e-7, 8e-7, -6e-7, 3e-7};
    Matrix3d f = Matrix3d::Identity();
    for (int i = 0; i < 40; ++i) {
        const double way = i < 20 ? 0.05 : 0.0;
        Numbers de = d;
        for (double& x : de) x *= way;
        f += strain_tensor(de, solid);
        const Answer a = finite.advance({.dtime = 0.05, .dfgrd1 = f});
        const Answer b = linear.advance({.dstran = de, .dtime = 0.05});
        EXPECT_LE(distance(a.stress, b.stress), 3e-6 * largest(b.stress));
        EXPECT_LE((a.tangent - b.tangent).cwiseAbs().maxCoeff(), 3e-6 * b.tangent(0, 0));
        EXPECT_NEAR(a.sse, b.sse, 1e-5 * b.sse);
    }
    EXPECT_NEAR(finite.scd(), linear.scd(), 1e-5 * linear.scd());
}

// dev(J sigma)(t) = g(t) dev(J sigma)(0) at fixed F, the pressure stays; for METH = 0 in increments of any length.
TEST(ViscoHyper, RelaxationIsExactAtFixedDeformation) {
    Matrix3d f;
    f << 1.3, 0.4, -0.2, 0.1, 0.9, 0.3, 0.2, -0.1, 1.1;
    UmatPoint p = material(solid, HY);
    p.advance({.dtime = 0.0, .dfgrd1 = f});
    const Numbers start = p.stress();
    const double mean = (start[0] + start[1] + start[2]) / 3;
    double t = 0.0;
    for (const double dt : {0.01, 3.0, 0.4, 20.0}) {
        t += dt;
        p.advance({.dtime = dt});
        const double g = 0.5 + 0.3 * std::exp(-t / 0.5) + 0.2 * std::exp(-t / 4);
        for (std::size_t i = 0; i < 6; ++i) {
            const double m = i < 3 ? mean : 0.0;
            EXPECT_NEAR(p.stress()[i], m + g * (start[i] - m), 1e-13 * largest(start));
        }
    }
}

// An element cannot dissipate more than it has stored, however long the increment.
TEST(ViscoHyper, RelaxationDissipatesWhatTheElementsHaveStored) {
    for (const double dt : {0.01, 1.0, 1e6}) {
        UmatPoint p = material(solid, HY);
        p.advance({.dtime = 0.0, .dfgrd1 = shear(0.8)});
        const double stored = p.sse();
        p.advance({.dtime = dt});
        EXPECT_NEAR(p.sse() + p.scd(), stored, 1e-12 * stored) << "DTIME " << dt;
        EXPECT_EQ(p.scd(), p.state(DISS));
    }
}

TEST(ViscoHyper, ExplicitEntryPointReadsTheStretch) {
    Matrix3d u;
    u << 1.3, 0.1, 0.05, 0.1, 0.9, -0.2, 0.05, -0.2, 1.2;
    const Answer umat = material(solid, HY).advance({.dtime = 0.3, .dfgrd1 = u});
    VumatBlock block("VISCO_HYPER-TEST", solid, HY);
    block.dtime = 0.3;
    VumatPoint p = block.fresh_point();
    p.stretch = u;
    block.points.assign(9, p);
    ASSERT_EQ(block.run().stops, 0);
    for (const VumatPoint& q : block.points) expect_stress(umat.stress, q.stress, 1e-13);
}

// A sheet that is stretched, held and released keeps its free surface.
TEST(ViscoHyper, PlaneStressFollowsTheHistory) {
    UmatPoint sheet = material(plane_stress, HY), block = material(solid, HY);
    for (const double stretch : {1.4, 1.4, 1.0, 1.0, 1.0}) {
        const Matrix3d flat = matrix(stretch, 0.1, 0, 1, 0.0);
        sheet.advance({.dtime = 0.5, .dfgrd1 = flat});
        Matrix3d full = flat;
        full(2, 2) = 1.0 + sheet.state(F33M1);
        const Answer a = block.advance({.dtime = 0.5, .dfgrd1 = full});
        EXPECT_NEAR(a.stress[2], 0.0, 1e-11);
        EXPECT_NEAR(a.stress[0], sheet.stress()[0], 1e-11);
        EXPECT_NEAR(a.stress[3], sheet.stress()[2], 1e-11);
    }
    EXPECT_GT(std::abs(sheet.state(F33M1)), 1e-3);  // the released sheet is still stressed by its history
}

// --- Failure modes ------------------------------------------------------------------------------------------------

TEST(ViscoHyper, InvertedElementsAskForASmallerIncrement) {
    for (const AnalysisKind kind : {solid, plane_strain, plane_stress})
        for (const double stretch : {0.0, -0.5}) {
            const Answer a = material(kind, HY).evaluate({.dfgrd1 = matrix(stretch, 0, 0, 1)});
            EXPECT_TRUE(a.cut);
            EXPECT_EQ(a.pnewdt, 0.25);
        }
}

// UJ = 2: no bulk stiffness from J = e on.
TEST(ViscoHyper, LogarithmicEnergyLosesItsBulkStiffness) {
    const auto bulk = [](double J) {
        const double l = std::cbrt(J);
        const Answer a = material(solid, HY + Numbers{0, 0, 2}).advance({.dfgrd1 = matrix(l, 0, 0, l, l)});
        return (a.tangent(0, 0) + 2 * a.tangent(0, 1)) / 3 - a.stress[0];
    };
    EXPECT_GT(bulk(0.99 * std::exp(1.0)), 0.0);
    EXPECT_LT(bulk(1.01 * std::exp(1.0)), 0.0);
}

TEST(ViscoHyper, ImpossibleShiftEndsTheAnalysis) {
    UmatPoint p = material(solid, HY + Numbers{0, 0, 0, 0, 2, 300, 8000});
    p.temperature(-5);
    const Answer a = p.evaluate({});
    EXPECT_EQ(a.messages.stops, 1);
    EXPECT_NE(a.first_error().find("temperature = -5"), std::string::npos) << a.first_error();
}

TEST(ViscoHyper, RefusesBadConstants) {
    const auto expect_refusal = [](const Numbers& props, const std::vector<std::string>& words) {
        char error[400] = "";
        EXPECT_EQ(lode_required_state("VISCO_HYPER-TEST", props.data(), static_cast<int>(props.size()), 3, 3, error,
                                      sizeof error),
                  -1);
        for (const std::string& word : words) EXPECT_NE(std::string(error).find(word), std::string::npos) << error;
    };
    expect_refusal({0, 1000, 0, 0}, {"PROPS(1) = 0", "> 0 where G2 = 0"});
    expect_refusal({200, 1000, 100, 2, 0.5, 1, 0.5, 2}, {"PROPS(5) = 0.5", "gk", "< 1"});
    expect_refusal({200, 1000, 100, 2, 0.5, 1}, {"at least 8", "NPROPS = 6", "gk", "number 2"});
    for (const double meth : {2.0, 3.0}) expect_refusal(HY + Numbers{0, 0, 0, meth}, {"PROPS(12)", "METH", "0..1"});
    char error[200] = "";
    EXPECT_EQ(lode_required_state("VISCO_HYPER", HY.data(), 8, 3, 3, error, sizeof error), 22);
    EXPECT_EQ(lode_required_state("VISCO_HYPER", HY.data(), 8, 1, 0, error, sizeof error), -1);
}

}  // namespace
}  // namespace lode::test::test_visco_hyper
