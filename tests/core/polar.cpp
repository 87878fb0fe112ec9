// Polar decomposition against extended precision: tiny and huge strains, equal and extreme stretches, det F near 0.
#include "lode/tensor/polar.hpp"

#include <gtest/gtest.h>

#include "lode/tensor/eigen.hpp"
#include "support/dual.hpp"
#include "support/reference.hpp"

namespace {

using namespace lode;
using namespace lode::test;

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr unsigned seed = 4711;

Matrix3x stretch_minus_identity_reference(const Matrix3<double>& h) {
    return spectral_reference(sqrt_one_plus_minus_one, cauchy_green_minus_identity(extended(h)));
}

// About 40 operations lie between H and E, each with an error of eps/2 relative to E.
TEST(Polar, StretchMinusIdentityKeepsRelativeAccuracy) {
    std::mt19937_64 random(seed);
    double worst = 0.0;
    for (double size : {1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-2, 0.1, 0.3}) {
        for (int i = 0; i < 2000; ++i) {
            const Matrix3<double> h = random_matrix(random, size);
            Mask<double> valid;
            const Matrix3<double> e = left_stretch_minus_identity(h, valid);
            if (!valid) continue;
            const double error = relative_error(e, stretch_minus_identity_reference(h));
            worst = std::max(worst, error);
            ASSERT_LE(error, 20.0 * eps) << "strain " << size;
        }
    }
    RecordProperty("worst_over_eps", std::to_string(worst / eps));
}

TEST(Polar, PlaneKindsKeepRelativeAccuracy) {
    std::mt19937_64 random(seed);
    for (double size : {1e-12, 1e-8, 1e-4, 0.1, 0.4}) {
        for (int i = 0; i < 1000; ++i) {
            Matrix3<double> h = random_matrix(random, size);
            h(0, 2) = h(1, 2) = h(2, 0) = h(2, 1) = std::numeric_limits<double>::quiet_NaN();
            const Matrix3<double> e = left_stretch_minus_identity<AnalysisKind::plane_strain>(h);
            const Matrix3<double> in_plane = left_stretch_minus_identity<AnalysisKind::plane_stress>(h);
            h(0, 2) = h(1, 2) = h(2, 0) = h(2, 1) = 0.0;
            if (determinant(h + Matrix3<double>::identity()) <= 0.0) continue;
            ASSERT_LE(relative_error(e, stretch_minus_identity_reference(h)), 10.0 * eps) << size;
            EXPECT_EQ(e(2, 2), h(2, 2));
            EXPECT_EQ(in_plane(0, 1), e(0, 1));
            EXPECT_EQ(in_plane(2, 2), 0.0);
        }
    }
}

struct Stretches {
    double a, b, c;
};
const Stretches stretches[] = {
    {1.0, 1.0, 1.0},  {1.0, 1.0, 1.0 + 1e-9}, {2.0, 2.0, 2.0},   {1.5, 1.5, 0.7},   {1.5, 1.5 * (1.0 + 1e-14), 0.7},
    {10.0, 0.3, 0.3}, {10.0, 1.0, 0.1},       {1e3, 1.0, 1.0},   {1e3, 1e3, 1e-3},  {1e3, 0.03, 0.03},
    {1.0, 1.0, 1e-3}, {1.0, 1.0, 1e-6},       {1.0, 1e-3, 1e-6}, {1.0, 1e-6, 1e-6}, {1e6, 1.0, 1.0},
    {1e6, 1e3, 1.0},  {1e6, 1.0, 1e-6},       {1.0, 1.0, 1e-12}};

// Whether rounding leaves the sign of det F alone.
bool determined(const Matrix3<double>& f) { return determinant(f) > 10.0 * eps * std::pow(norm(f), 3); }

// R and the stretches are exactly orthogonal and symmetric to rounding whatever F is, they multiply to F, and they are
// as accurate as F determines them: a perturbation eps |F| of F turns R by 2 eps |F|/(l_2 + l_3), the two smallest
// stretches.
TEST(Polar, FactorsForAnyStretches) {
    std::mt19937_64 random(seed);
    for (const auto& [a, b, c] : stretches) {
        for (int i = 0; i < 200; ++i) {
            const Matrix3<double> q = random_rotation(random), r = random_rotation(random);
            // Aligned with the axes in every other case.
            const Matrix3<double> f = i % 2 == 0 ? diagonal(a, b, c) * r : q * diagonal(a, b, c) * transpose(q) * r;
            if (!determined(f)) continue;
            const auto p = polar_decomposition(f);
            ASSERT_TRUE(p.valid);
            ASSERT_LE(orthogonality_error(p.rotation), 12.0 * eps);
            ASSERT_LE(std::abs(determinant(p.rotation) - 1.0), 12.0 * eps);
            ASSERT_LE(norm(p.left * p.rotation - f), 16.0 * eps * norm(f)) << a << ' ' << b << ' ' << c;
            ASSERT_LE(norm(p.rotation * p.right - f), 16.0 * eps * norm(f)) << a << ' ' << b << ' ' << c;
            const double smallest = std::min({a + b, b + c, a + c});
            ASSERT_LE(norm(p.rotation - r), 40.0 * eps * norm(f) / smallest) << a << ' ' << b << ' ' << c;
            for (int k = 0; k < 3; ++k)
                for (int l = 0; l < k; ++l) {
                    EXPECT_EQ(p.left(k, l), p.left(l, k));
                    EXPECT_EQ(p.right(k, l), p.right(l, k));
                }
        }
    }
}

// V = sqrt(F F^T) in extended precision; sqrt is Lipschitz, |dV| <= sqrt(2) |dF|, so eps |F| is what F determines.
TEST(Polar, LeftStretchForAnyStretches) {
    std::mt19937_64 random(seed);
    for (const auto& [a, b, c] : stretches) {
        for (int i = 0; i < 200; ++i) {
            const Matrix3<double> q = random_rotation(random), r = random_rotation(random);
            const Matrix3<double> f = q * diagonal(a, b, c) * r;
            if (!determined(f)) continue;
            const Matrix3x v = left_stretch_reference(extended(f));
            const Matrix3x u = left_stretch_reference(transposed(extended(f)));
            ASSERT_LE(relative_error(left_stretch(f), v), 80.0 * eps) << a << ' ' << b << ' ' << c;
            ASSERT_LE(relative_error(right_stretch(f), u), 80.0 * eps) << a << ' ' << b << ' ' << c;
            // E from H = F - I, which is exact only for F near I: its rounding counts.
            const Matrix3<double> e = left_stretch_minus_identity(f - Matrix3<double>::identity());
            const double e_error = norm(e + Matrix3<double>::identity() - rounded(v));
            ASSERT_LE(e_error, 80.0 * eps * std::max(1.0, norm(f))) << a << ' ' << b << ' ' << c;
        }
    }
}

// Whatever F is, what comes out is finite, and a rotation.
TEST(Polar, NeverFails) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    int valid = 0;
    for (double decades : {5.0, 15.0, 28.0, 60.0, 150.0, 300.0}) {
        const auto magnitude = [&] { return std::pow(10.0, decades * u(random)); };
        for (int i = 0; i < 5000; ++i) {
            Matrix3<double> f;
            for (double& x : f.m) x = u(random) * magnitude();
            if (i % 3 == 0) f = diagonal(magnitude(), magnitude(), magnitude()) * random_rotation(random);
            if (i % 3 == 1) f = random_rotation(random) * diagonal(magnitude(), magnitude(), magnitude());
            const auto p = polar_decomposition(f);
            valid += p.valid;
            ASSERT_LE(orthogonality_error(p.rotation), 12.0 * eps);
            if (p.valid) {
                ASSERT_LE(norm(p.left * p.rotation - f), 80.0 * eps * norm(f));
            }
            const Matrix3<double> e = left_stretch_minus_identity(f - Matrix3<double>::identity());
            ASSERT_TRUE(std::isfinite(norm(1e-150 * e)));
        }
    }
    EXPECT_GT(valid, 3000);
}

TEST(Polar, NotAdmissible) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    for (const Matrix3<double>& f : {diagonal(-1, 1, 1), diagonal(0, 1, 1), diagonal(nan, 1, 1), diagonal(inf, 1, 1),
                                     diagonal(-1, -1, -1), diagonal(1e200, 1, 1), diagonal(1, 1, 1e-320)}) {
        const auto p = polar_decomposition(f);
        EXPECT_FALSE(p.valid);
        for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(p.left.m[i], Matrix3<double>::identity().m[i]);
        Mask<double> valid = true;
        const Matrix3<double> e = left_stretch_minus_identity(f - Matrix3<double>::identity(), valid);
        EXPECT_FALSE(valid);
        EXPECT_EQ(norm(e), 0.0);
    }
}

// Lanes with bad, extreme and ordinary deformations side by side; contraction of multiply-adds may differ.
TEST(Polar, BatchAgreesWithScalar) {
    std::mt19937_64 random(seed);
    std::uniform_int_distribution<std::size_t> pick(0, std::size(stretches) - 1);
    for (int repeat = 0; repeat < 300; ++repeat) {
        std::array<Matrix3<double>, batch_lanes> f;
        for (auto& x : f) {
            const auto& [a, b, c] = stretches[pick(random)];
            x = random_rotation(random) * diagonal(a, b, c) * random_rotation(random);
        }
        f[0] = diagonal(-1.0, 1.0, 1.0);
        const auto p = polar_decomposition(gather(f));
        Mask<Batch> valid;
        const auto e = left_stretch_minus_identity(gather(f) - Matrix3<Batch>::identity(), valid);
        for (int k = 0; k < batch_lanes; ++k) {
            const auto& fk = f[static_cast<std::size_t>(k)];
            if (k > 0 && !determined(fk)) continue;
            // Both have the error of the closed form.
            const auto alone = polar_decomposition(fk);
            EXPECT_EQ(p.valid.get(static_cast<std::size_t>(k)), alone.valid);
            EXPECT_LE(norm(lane(p.left, k) - alone.left), 80.0 * eps * norm(fk));
            EXPECT_LE(norm(lane(e, k) - left_stretch_minus_identity(fk - Matrix3<double>::identity())),
                      80.0 * eps * std::max(1.0, norm(fk)));
        }
    }
}

// dV: V dV + dV V = dB, also at equal stretches and in the robust branch.
TEST(Polar, DerivativeOfTheStretch) {
    using D = Dual<1>;
    std::mt19937_64 random(seed);
    for (const auto& [a, b, c] :
         {Stretches{1, 1, 1}, {1.5, 1.5, 0.7}, {2, 2, 2}, {1.7, 1.1, 0.6}, {1.0, 1.0 + 1e-8, 1.0}, {500, 1, 1}}) {
        const Matrix3<double> q = random_rotation(random), direction = random_matrix(random, 1.0);
        const Matrix3<double> f = q * diagonal(a, b, c) * random_rotation(random);
        Matrix3<D> fd, hd;
        for (std::size_t i = 0; i < 9; ++i) {
            fd.m[i] = D(f.m[i]);
            fd.m[i].derivative[0] = direction.m[i];
            hd.m[i] = i % 4 == 0 ? fd.m[i] - 1.0 : fd.m[i];
        }
        const auto derivative = [](const Matrix3<D>& x) {
            Matrix3<double> r;
            for (std::size_t i = 0; i < 9; ++i) r.m[i] = x.m[i](0);
            return r;
        };
        const Matrix3<double> db = direction * transpose(f) + f * transpose(direction);
        for (const Matrix3<D>& v : {left_stretch(fd), left_stretch_minus_identity(hd) + Matrix3<D>::identity()}) {
            const Matrix3<double> dv = derivative(v), v0 = value_of(v);
            EXPECT_LE(norm(v0 * dv + dv * v0 - db), 200.0 * eps * norm(v0) * norm(dv)) << a << ' ' << b << ' ' << c;
        }
    }
}

}  // namespace
