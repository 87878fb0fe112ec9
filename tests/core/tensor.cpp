// Kinematics, rotations, invariants, and the differentiated number the tests rest on.
#include <gtest/gtest.h>

#include "lode/tensor/invariants.hpp"
#include "lode/tensor/kinematics.hpp"
#include "lode/tensor/rotation.hpp"
#include "support/dual.hpp"
#include "support/reference.hpp"

namespace {

using namespace lode;
using namespace lode::test;

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr unsigned seed = 2718;
constexpr AnalysisKind solid = AnalysisKind::solid, plane_strain = AnalysisKind::plane_strain,
                       plane_stress = AnalysisKind::plane_stress, uniaxial = AnalysisKind::uniaxial;

// Relative to b and to j's terms; only a j that is a difference of larger strains may lose what their size demands.
TEST(Kinematics, KeepsRelativeAccuracy) {
    std::mt19937_64 random(seed);
    for (double size : {1e-12, 1e-9, 1e-6, 1e-3, 0.1, 1.0}) {
        for (int i = 0; i < 500; ++i) {
            const Matrix3<double> f = random_matrix(random, size) + Matrix3<double>::identity();
            const Matrix3<double> h = f - Matrix3<double>::identity();
            const auto k = kinematics<solid>(f);
            const Matrix3x b = cauchy_green_minus_identity(extended(h));
            ASSERT_LE(relative_error(to_matrix<solid, double>(k.b, 1.0), b), 4.0 * eps) << size;
            const Matrix3x x = extended(h);
            const auto minor = [&](std::size_t p, std::size_t q) { return x[p][p] * x[q][q] - x[p][q] * x[q][p]; };
            const Extended det = x[0][0] * (x[1][1] * x[2][2] - x[1][2] * x[2][1]) -
                                 x[0][1] * (x[1][0] * x[2][2] - x[1][2] * x[2][0]) +
                                 x[0][2] * (x[1][0] * x[2][1] - x[1][1] * x[2][0]);
            const Extended j = x[0][0] + x[1][1] + x[2][2] + minor(0, 1) + minor(0, 2) + minor(1, 2) + det;
            ASSERT_LE(std::abs(static_cast<double>(k.j - j)), 6.0 * eps * norm(h) * (1.0 + square(norm(h)))) << size;
        }
    }
}

TEST(Kinematics, VolumeNearZeroAndResidualStrain) {
    std::mt19937_64 random(seed);
    for (double c : {1e-3, 1e-6, 1e-9}) {
        const Matrix3<double> f = diagonal(1.2, 0.9, c);
        const auto k = kinematics<solid>(f);
        EXPECT_NEAR(k.jacobian / (1.2 * 0.9 * c), 1.0, 4.0 * eps);
        EXPECT_NEAR(k.log_jacobian() / std::log(1.08 * c), 1.0, 4.0 * eps);
        EXPECT_TRUE(k.valid());
    }
    EXPECT_FALSE(kinematics<solid>(diagonal(1, 1, -1)).valid());
    EXPECT_FALSE(kinematics<solid>(diagonal(1, 1, std::nan(""))).valid());
    EXPECT_FALSE(kinematics<plane_stress>(diagonal(1, -1, -1)).valid());
    // Free expansion by e is no mechanical strain: F = exp(e) I.
    for (double e : {1e-12, -1e-6, 0.01, 0.3}) {
        const double l = std::exp(e);
        const auto k = kinematics<solid>(diagonal(l, l, l), e);
        EXPECT_NEAR(k.j, 0.0, 6.0 * eps);  // the rounding of F itself
        EXPECT_NEAR(k.b[0], 0.0, 4.0 * eps);
        EXPECT_NEAR(kinematics<solid>(Matrix3<double>::identity(), e).log_jacobian(), -3.0 * e,
                    4.0 * eps * std::abs(3.0 * e));
        EXPECT_NEAR(kinematics<plane_stress>(Matrix3<double>::identity(), e).log_jacobian(), -2.0 * e,
                    4.0 * eps * std::abs(2.0 * e));
    }
}

TEST(Kinematics, PlaneKindsAreTheSolidOnes) {
    std::mt19937_64 random(seed);
    for (int i = 0; i < 200; ++i) {
        Matrix3<double> f = random_matrix(random, 0.3) + Matrix3<double>::identity();
        const auto plane = kinematics<plane_strain>(f, 0.01);
        const auto stress = kinematics<plane_stress>(f, 0.01);
        f(0, 2) = f(2, 0) = f(1, 2) = f(2, 1) = 0.0;
        const auto full = kinematics<solid>(f, 0.01);
        for (int c = 0; c < 4; ++c) EXPECT_NEAR(plane.b[c], full.b[c], 4.0 * eps);
        EXPECT_NEAR(plane.j, full.j, 8.0 * eps);
        EXPECT_NEAR(plane.jacobian, full.jacobian, 8.0 * eps);
        EXPECT_EQ(stress.b[2], 0.0);
        EXPECT_EQ(stress.b[3], plane.b[3]);
        EXPECT_NEAR((1.0 + stress.j) * (1.0 + plane.h(2, 2)), plane.jacobian, 8.0 * eps);
    }
}

TEST(Rotation, FromAngles) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> u(-400.0, 400.0);
    const auto about = [](int axis, double degrees) {
        Vector<double, 3> a{};
        a[axis] = 1.0;
        return rotation_from_axis(a, degrees * degree);
    };
    for (int i = 0; i < 200; ++i) {
        const double z = u(random), y = u(random), x = u(random);
        const Matrix3<double> r = rotation_from_angles(z, y, x);
        EXPECT_LE(norm(r - about(2, z) * about(1, y) * about(0, x)), 40.0 * eps);
        EXPECT_TRUE(is_rotation(r, 4.0 * eps));
    }
    // Exact at right angles; 1 is turned counter-clockwise towards 2.
    const Matrix3<double> quarter = rotation_from_angles(90.0, 0.0, 0.0);
    EXPECT_EQ(quarter(1, 0), 1.0);
    EXPECT_EQ(quarter(0, 0), 0.0);
    EXPECT_EQ(rotation_from_angles(-90.0, 180.0, 270.0)(1, 0), 1.0);
    EXPECT_EQ(rotation_from_angles(360.0, -720.0, 0.0)(0, 0), 1.0);
    EXPECT_FALSE(is_rotation(diagonal(1, 1, -1)));
    EXPECT_FALSE(is_rotation(diagonal(1, 1, 1.001)));
    EXPECT_FALSE(is_rotation(diagonal(1, 1, std::nan(""))));
}

TEST(Rotation, HughesWingetIsOrthogonalAndOfSecondOrder) {
    for (double size : {1e-8, 1e-3, 0.1, 1.0, 100.0}) {
        const Vector<double, 3> w{{0.3 * size, -0.5 * size, 0.2 * size}};
        const Matrix3<double> q = hughes_winget(w);
        EXPECT_LE(orthogonality_error(q), 8.0 * eps);
        const double length = size * std::sqrt(0.38);
        EXPECT_LE(norm(q - rotation_from_axis(w, 2.0 * std::atan(0.5 * length))), 8.0 * eps);
        // |2 atan(a/2) - a| <= a^3/12, |dR| = sqrt(2) times that
        EXPECT_LE(norm(q - rotation_from_axis(w, length)),
                  std::sqrt(2.0) * length * length * length / 12.0 + 8.0 * eps);
    }
    const Matrix3<double> stretch = diagonal(0.1, 0.2, 0.3);
    EXPECT_EQ(norm(hughes_winget(stretch) - Matrix3<double>::identity()), 0.0);
    EXPECT_EQ(norm(rotation_from_axis(Vector<double, 3>{}, 1.0) - Matrix3<double>::identity()), 0.0);
}

TEST(Rotation, VoigtMatrices) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    for (int repeat = 0; repeat < 100; ++repeat) {
        const Matrix3<double> q = random_rotation(random);
        Stress<solid, double> s;
        Strain<solid, double> e;
        for (int i = 0; i < 6; ++i) s[i] = u(random), e[i] = u(random);
        const auto ts = stress_rotation(q), te = strain_rotation(q);
        const auto rotated_s = rotate<solid>(s, q);
        const auto rotated_e = rotate<solid>(e, q);
        for (int i = 0; i < 6; ++i) {
            double sum_s = 0.0, sum_e = 0.0;
            for (int j = 0; j < 6; ++j) sum_s += ts(i, j) * s[j], sum_e += te(i, j) * e[j];
            EXPECT_NEAR(sum_s, rotated_s[i], 16.0 * eps);
            EXPECT_NEAR(sum_e, rotated_e[i], 16.0 * eps);
        }
        // T^-T T^T = I, and isotropic moduli do not turn: C = 1 1^T + I_sym.
        const auto identity = ts * transpose(te);
        VoigtMatrix<solid, double> c{};
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) c(i, j) = 1.0 + (i == j ? 2.0 : 0.0);
        for (int i = 3; i < 6; ++i) c(i, i) = 1.0;
        const auto turned = rotate_stiffness(c, q);
        for (int i = 0; i < 6; ++i)
            for (int j = 0; j < 6; ++j) {
                EXPECT_NEAR(identity(i, j), i == j ? 1.0 : 0.0, 20.0 * eps);
                EXPECT_NEAR(turned(i, j), c(i, j), 40.0 * eps);
            }
    }
}

TEST(Invariants, KnownStates) {
    const Stress<uniaxial, double> tension{{{3.0}}};
    EXPECT_DOUBLE_EQ(von_mises(tension), 3.0);
    EXPECT_DOUBLE_EQ(pressure(tension), -1.0);
    EXPECT_DOUBLE_EQ(third_deviatoric_invariant(tension), 2.0);
    EXPECT_NEAR(lode_angle(tension), 0.0, 1e-8);
    EXPECT_NEAR(lode_angle(Stress<uniaxial, double>{{{-3.0}}}), std::acos(-1.0) / 3.0, 1e-8);
    const Stress<plane_stress, double> shear{{{0.0, 0.0, 2.0}}};
    EXPECT_DOUBLE_EQ(von_mises(shear), 2.0 * std::sqrt(3.0));
    EXPECT_NEAR(lode_angle(shear), std::acos(-1.0) / 6.0, 4.0 * eps);
    const auto p = principal_values(shear);
    EXPECT_DOUBLE_EQ(p[0], 2.0);
    EXPECT_DOUBLE_EQ(p[1], 0.0);
    EXPECT_DOUBLE_EQ(p[2], -2.0);
    EXPECT_EQ(lode_angle(Stress<solid, double>{}), std::acos(0.0) / 3.0);
    // A pressure of 1e12 times the shear leaves q its accuracy: the differences are exact.
    const Stress<solid, double> deep{{{-1e12, -1e12, -1e12 + 1.0, 0.0, 0.0, 0.0}}};
    EXPECT_DOUBLE_EQ(von_mises(deep), 1.0);
}

TEST(Invariants, AgreeWithPrincipalValues) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    for (int i = 0; i < 500; ++i) {
        Stress<solid, double> s;
        for (double& x : s.v) x = u(random);
        const auto v = principal_values(s);
        ASSERT_GE(v[0], v[1]);
        ASSERT_GE(v[1], v[2]);
        const double mean = (v[0] + v[1] + v[2]) / 3.0;
        EXPECT_NEAR(pressure(s), -mean, 8.0 * eps);
        EXPECT_NEAR(third_deviatoric_invariant(s), (v[0] - mean) * (v[1] - mean) * (v[2] - mean), 20.0 * eps);
        EXPECT_NEAR(second_deviatoric_invariant(s),
                    (square(v[0] - v[1]) + square(v[1] - v[2]) + square(v[2] - v[0])) / 6.0, 20.0 * eps);
        // sigma_1 = mean + 2 sqrt(J2/3) cos(theta)
        EXPECT_NEAR(v[0], mean + 2.0 * std::sqrt(second_deviatoric_invariant(s) / 3.0) * std::cos(lode_angle(s)), 1e-7);
        Stress<solid, Batch> batch;
        for (int c = 0; c < 6; ++c) batch[c] = Batch(s[c]);
        EXPECT_NEAR(principal_values(batch)[0].get(0), v[0], 20.0 * eps);
        EXPECT_NEAR(lode_angle(batch).get(0), lode_angle(s), 1e-7);
    }
}

// Every function of the differentiated number against central differences: h^2/6 f''' + eps f/h at h = 1e-5.
TEST(Dual, FunctionsHaveTheRightDerivatives) {
    using D = Dual<1>;
    const auto check = [](const char* name, auto f, double x) {
        const double h = 1e-5, expected = (f(D(x + h)).value - f(D(x - h)).value) / (2.0 * h);
        const D y = f(D::variable(x, 0));
        EXPECT_NEAR(y(0), expected, 1e-8 * (1.0 + std::abs(expected))) << name << " at " << x;
        EXPECT_EQ(y.value, f(D(x)).value) << name;
    };
    for (double x : {0.3, 0.8}) {
        check(
            "+", [](D a) { return 1.0 + a + a - 2.0 - (-a); }, x);
        check(
            "*", [](D a) { return 2.0 * a * a * 3.0; }, x);
        check(
            "/", [](D a) { return 2.0 / a + a / 3.0 + a / (1.0 + a); }, x);
        check(
            "sqrt", [](D a) { return sqrt(a); }, x);
        check(
            "cbrt", [](D a) { return cbrt(a); }, x);
        check(
            "exp", [](D a) { return exp(a) + exp2(a); }, x);
        check(
            "expm1", [](D a) { return expm1(a); }, x);
        check(
            "log", [](D a) { return log(a) + log2(a) + log10(a); }, x);
        check(
            "log1p", [](D a) { return log1p(a); }, x);
        check(
            "pow", [](D a) { return pow(a, 1.7) + pow(a, 3) + pow(1.3, a) + pow(a, a); }, x);
        check(
            "sin", [](D a) { return sin(a) * cos(a) + tan(a); }, x);
        check(
            "asin", [](D a) { return asin(a) - acos(a) * atan(a); }, x);
        check(
            "atan2", [](D a) { return atan2(a, 1.0 - a * a); }, x);
        check(
            "sinh", [](D a) { return sinh(a) + cosh(a) * tanh(a); }, x);
        check(
            "asinh", [](D a) { return asinh(a) + acosh(1.0 + a) + atanh(a) + erf(a); }, x);
        check(
            "abs", [](D a) { return abs(-a) + max(a, 0.5) + min(a, 0.5) + copysign(a, -1.0); }, x);
        check(
            "fma", [](D a) { return fma(a, a, 2.0 * a); }, x);
        check(
            "hypot", [](D a) { return hypot(a, 2.0) + hypot(a, a, 1.0); }, x);
    }
    EXPECT_EQ(sqrt(D(0.0))(0), 0.0);
    EXPECT_TRUE(is_finite(D(1.0)));
    EXPECT_FALSE(is_finite(D(std::numeric_limits<double>::infinity())));
    EXPECT_EQ(select(D(1.0) < 2.0, D(3.0), D(4.0)).value, 3.0);
    EXPECT_EQ(positive_part(D(-1.0)).value, 0.0);
}

}  // namespace
