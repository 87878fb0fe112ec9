// Eigenvalues, isotropic tensor functions and their derivatives at distinct, close and equal eigenvalues.
#include "lode/tensor/spectral.hpp"

#include "lode/tensor/eigen_deflation.hpp"

#include <gtest/gtest.h>

#include "support/dual.hpp"
#include "support/reference.hpp"

namespace {

using namespace lode;
using namespace lode::test;

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr unsigned seed = 31415;
constexpr AnalysisKind solid = AnalysisKind::solid, plane = AnalysisKind::plane_strain;

Matrix3<double> symmetric(const Matrix3<double>& a) { return 0.5 * (a + transpose(a)); }
// Q diag(a, b, c) Q^T, symmetric exactly.
Matrix3<double> turned(double a, double b, double c, const Matrix3<double>& q) {
    return symmetric(q * diagonal(a, b, c) * transpose(q));
}
std::array<double, 3> sorted(const Vector<double, 3>& v) {
    std::array<double, 3> s = v.v;
    std::sort(s.begin(), s.end());
    return s;
}

// Eigenvalues distinct, close, equal, of mixed sign, of very different size, in any unit.
const std::array<double, 3> spectra[] = {
    {3.0, 2.0, 1.0},         {1.0, 1.0, 1.0},         {1.0, 1.0, 2.0},       {2.0, 1.0, 1.0 + 1e-8},
    {1.0, 1.0 + 1e-15, 0.5}, {1.0, 1.0 + 1e-12, 1.0}, {1e-6, 1.0, 1.0},      {1e6, 1.0, 1e-6},
    {1e-3, 1e-3, 1e3},       {0.2, 1.0, 5.0},         {1e-12, 2e-12, 3e-12}, {1e100, 2e100, 1e99},
};

TEST(Eigen, DecompositionReproducesTheTensor) {
    std::mt19937_64 random(seed);
    for (const auto& [a, b, c] : spectra) {
        for (int i = 0; i < 200; ++i) {
            const double sign = i % 3 == 0 ? -1.0 : 1.0;
            const Matrix3<double> m =
                i % 10 == 0 ? diagonal(sign * a, b, c) : turned(sign * a, b, c, random_rotation(random));
            const auto e = symmetric_eigen(m);
            ASSERT_LE(orthogonality_error(e.vectors), 20.0 * eps);
            double size = 0.0;
            for (double x : m.m) size = std::max(size, std::abs(x));
            ASSERT_LE(norm((1.0 / size) * (compose(e.values, e.vectors) - m)), 20.0 * eps);
            const EigenX exact = eigen_reference(extended(m));
            const auto found = sorted(e.values);
            std::array<Extended, 3> expected = exact.values;
            std::sort(expected.begin(), expected.end());
            for (std::size_t k = 0; k < 3; ++k)
                ASSERT_LE(std::abs(static_cast<double>(found[k] - expected[k])), 10.0 * eps * size);
        }
    }
    const auto zero = symmetric_eigen(diagonal(0, 0, 0));
    for (int i = 0; i < 3; ++i) EXPECT_EQ(zero.values[i], 0.0);
}

// The same without iterations, relative to the largest entry, one point and several abreast.
TEST(Eigen, DeflationReproducesTheTensor) {
    std::mt19937_64 random(seed);
    constexpr std::size_t lanes = Batch::size;
    std::array<Matrix3<double>, lanes> block;
    std::size_t filled = 0;
    for (const auto& [a, b, c] : spectra) {
        for (int i = 0; i < 400; ++i) {
            const double sign = i % 3 == 0 ? -1.0 : 1.0;
            const Matrix3<double> m =
                i % 10 == 0 ? diagonal(sign * a, b, c) : turned(sign * a, b, c, random_rotation(random));
            double size = 0.0;
            for (double x : m.m) size = std::max(size, std::abs(x));
            const auto check = [&](const SymmetricEigen<double>& e, const Matrix3<double>& of) {
                ASSERT_LE(orthogonality_error(e.vectors), 20.0 * eps);
                ASSERT_LE(norm((1.0 / size) * (compose(e.values, e.vectors) - of)), 20.0 * eps);
                const auto found = sorted(e.values);
                std::array<Extended, 3> expected = eigen_reference(extended(of)).values;
                std::sort(expected.begin(), expected.end());
                for (std::size_t k = 0; k < 3; ++k)
                    ASSERT_LE(std::abs(static_cast<double>(found[k] - expected[k])), 10.0 * eps * size);
            };
            ASSERT_NO_FATAL_FAILURE(check(eigen_by_deflation(m), m)) << a << " " << b << " " << c << ", " << i;
            block[filled++] = m;
            if (filled < lanes) continue;
            filled = 0;
            Matrix3<Batch> many;
            for (std::size_t k = 0; k < 9; ++k) {
                std::array<double, lanes> x;
                for (std::size_t j = 0; j < lanes; ++j) x[j] = block[j].m[k];
                many.m[k] = Batch::load_unaligned(x.data());
            }
            const SymmetricEigen<Batch> found = eigen_by_deflation(many);
            for (std::size_t j = 0; j < lanes; ++j) {
                SymmetricEigen<double> e;
                for (int k = 0; k < 3; ++k) e.values[k] = found.values[k].get(j);
                for (std::size_t k = 0; k < 9; ++k) e.vectors.m[k] = found.vectors.m[k].get(j);
                size = 0.0;
                for (double x : block[j].m) size = std::max(size, std::abs(x));
                ASSERT_NO_FATAL_FAILURE(check(e, block[j]));
            }
        }
    }
    const auto zero = eigen_by_deflation(diagonal(0, 0, 0));
    for (int i = 0; i < 3; ++i) EXPECT_EQ(zero.values[i], 0.0);
}

// A positive definite matrix D A D with D graded and A well conditioned determines its small eigenvalues to rounding,
// and Jacobi's method finds them (Demmel and Veselic 1992).
TEST(Eigen, SmallEigenvaluesOfGradedMatrices) {
    const double grades[] = {1.0, 1e-5, 1e-10};
    Matrix3<double> m;
    const double a[3][3] = {{2.0, 0.3, -0.5}, {0.3, 1.5, 0.4}, {-0.5, 0.4, 1.0}};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) m(i, j) = a[i][j] * grades[i] * grades[j];
    const auto found = sorted(symmetric_eigen(m).values);
    std::array<Extended, 3> expected = eigen_reference(extended(m)).values;
    std::sort(expected.begin(), expected.end());
    for (std::size_t k = 0; k < 3; ++k)
        EXPECT_NEAR(found[k] / static_cast<double>(expected[k]), 1.0, 20.0 * eps) << found[k];
}

TEST(Eigen, PlaneKindIsClosedForm) {
    std::mt19937_64 random(seed);
    for (int i = 0; i < 1000; ++i) {
        Matrix3<double> m = symmetric(random_matrix(random, std::pow(10.0, i % 20 - 10)));
        m(0, 2) = m(2, 0) = m(1, 2) = m(2, 1) = std::nan("");
        const auto e = symmetric_eigen<plane>(m);
        m(0, 2) = m(2, 0) = m(1, 2) = m(2, 1) = 0.0;
        EXPECT_LE(norm(compose(e.values, e.vectors) - m), 8.0 * eps * norm(m));
        EXPECT_EQ(e.values[2], m(2, 2));
    }
}

TEST(Eigen, BatchAgreesWithScalar) {
    std::mt19937_64 random(seed);
    for (int repeat = 0; repeat < 200; ++repeat) {
        std::array<Matrix3<double>, batch_lanes> m;
        for (std::size_t k = 0; k < m.size(); ++k) {
            const auto& [a, b, c] = spectra[static_cast<std::size_t>(random() % std::size(spectra))];
            m[k] = turned(a, b, c, random_rotation(random));
        }
        m[0] = diagonal(0, 0, 0);
        const auto e = symmetric_eigen(gather(m));
        for (int k = 0; k < batch_lanes; ++k) {
            const auto i = static_cast<std::size_t>(k);
            const auto alone = symmetric_eigen(m[i]);
            Vector<double, 3> values;
            for (int l = 0; l < 3; ++l) values[l] = e.values[l].get(i);
            double size = std::max({std::abs(alone.values[0]), std::abs(alone.values[1]), std::abs(alone.values[2])});
            for (std::size_t l = 0; l < 3; ++l)
                EXPECT_NEAR(sorted(values)[l], sorted(alone.values)[l], 10.0 * eps * size);
            EXPECT_LE(orthogonality_error(lane(e.vectors, k)), 20.0 * eps);
        }
    }
}

TEST(Eigen, DerivativesOfEigenvalues) {
    using D = Dual<1>;
    std::mt19937_64 random(seed);
    const Matrix3<double> q = random_rotation(random), m = turned(3.0, 1.0, -2.0, q),
                          direction = symmetric(random_matrix(random, 1.0));
    Matrix3<D> md;
    for (std::size_t i = 0; i < 9; ++i) {
        md.m[i] = D(m.m[i]);
        md.m[i].derivative[0] = direction.m[i];
    }
    const auto e = symmetric_eigen(md);
    // A n = l n differentiated: dA n + A dn = dl n + l dn.
    for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 3; ++i) {
            D residual = -e.values[k] * e.vectors(i, k);
            for (int j = 0; j < 3; ++j) residual += md(i, j) * e.vectors(j, k);
            EXPECT_NEAR(residual.value, 0.0, 20.0 * eps);
            EXPECT_NEAR(residual(0), 0.0, 60.0 * eps);
        }
}

// Divided differences in extended precision: exact to about 1e-19/(relative distance), so by f' and f''' where that is
// small.
template <class F, class Exact, class Derivative, class Third>
void expect_divided_differences(const F& f, const Exact& exact, const Derivative& slope, const Third& third,
                                double scale) {
    for (double base : {1.0, 0.3, 2.7}) {
        for (double distance :
             {0.0, 1e-300, 1e-16, 1e-12, 1e-8, 1e-5, 1e-3, 0.01, 0.09, 0.11, 0.3, 0.5, 1.0, 1.1, 3.0, 20.0}) {
            const double a = scale * base * (1.0 + distance), b = scale * base;
            const Extended d = static_cast<Extended>(a) - static_cast<Extended>(b),
                           mean = 0.5L * (static_cast<Extended>(a) + b);
            const Extended expected =
                distance < 1e-4 ? slope(mean) + d * d / 24.0L * third(mean) : (exact(a) - exact(b)) / d;
            const double bound = 16.0 * eps * static_cast<double>(std::abs(expected));
            EXPECT_NEAR(f.divided_difference(a, b), static_cast<double>(expected), bound) << a << ' ' << b;
            EXPECT_NEAR(f.divided_difference(b, a), static_cast<double>(expected), bound) << a << ' ' << b;
            const Batch in_batch = f.divided_difference(Batch(a), Batch(b));
            EXPECT_NEAR(in_batch.get(0), static_cast<double>(expected), bound);
        }
    }
}
TEST(SpectralFunctions, DividedDifferences) {
    using X = Extended;
    expect_divided_differences(
        LogFunction{}, [](X x) { return std::log(x); }, [](X x) { return 1.0L / x; },
        [](X x) { return 2.0L / (x * x * x); }, 1.0);
    expect_divided_differences(
        ExpFunction{}, [](X x) { return std::exp(x); }, [](X x) { return std::exp(x); },
        [](X x) { return std::exp(x); }, 1.0);
    expect_divided_differences(
        SqrtFunction{}, [](X x) { return std::sqrt(x); }, [](X x) { return 0.5L / std::sqrt(x); },
        [](X x) { return 0.375L * std::pow(x, -2.5L); }, 1e6);
    for (double scale : {1.0, 1e-8})
        expect_divided_differences(
            Log1pFunction{}, [](X x) { return std::log1p(x); }, [](X x) { return 1.0L / (1.0L + x); },
            [](X x) { return 2.0L / std::pow(1.0L + x, 3.0L); }, scale);
    expect_divided_differences(
        Sqrt1pm1Function{}, sqrt_one_plus_minus_one, [](X x) { return 0.5L / std::sqrt(1.0L + x); },
        [](X x) { return 0.375L * std::pow(1.0L + x, -2.5L); }, 1e-3);
    for (double p : {-2.0, -0.5, 0.3, 1.0, 2.0, 7.0}) {
        const X q = p;
        expect_divided_differences(
            PowerFunction{p}, [q](X x) { return std::pow(x, q); }, [q](X x) { return q * std::pow(x, q - 1.0L); },
            [q](X x) { return q * (q - 1.0L) * (q - 2.0L) * std::pow(x, q - 3.0L); }, 1.0);
    }
}

TEST(Spectral, SmallStrainsKeepRelativeAccuracy) {
    std::mt19937_64 random(seed);
    for (double size : {1e-12, 1e-9, 1e-6, 1e-3, 0.1}) {
        for (int i = 0; i < 300; ++i) {
            const Matrix3<double> b = symmetric(random_matrix(random, size));
            ASSERT_LE(relative_error(tensor_log1p(b),
                                     spectral_reference([](Extended x) { return std::log1p(x); }, extended(b))),
                      20.0 * eps);
            ASSERT_LE(relative_error(tensor_sqrt1pm1(b), spectral_reference(sqrt_one_plus_minus_one, extended(b))),
                      20.0 * eps);
        }
    }
}

TEST(Spectral, FunctionsAgreeWithExtendedPrecision) {
    std::mt19937_64 random(seed);
    for (const auto& [a, b, c] :
         {std::array{3.0, 2.0, 1.0}, {1.0, 1.0, 1.0}, {2.0, 1.0, 1.0 + 1e-8}, {0.2, 1.0, 5.0}, {2.0, 2.0, 0.5}}) {
        for (int i = 0; i < 100; ++i) {
            const Matrix3<double> m = turned(a, b, c, random_rotation(random));
            const Matrix3x x = extended(m);
            // Eigenvalue errors of a few eps |m| times the condition of f here (at most 5).
            const double bound = 100.0 * eps;
            ASSERT_LE(norm(tensor_log(m) - rounded(spectral_reference([](Extended l) { return std::log(l); }, x))),
                      bound);
            ASSERT_LE(relative_error(tensor_exp(m), spectral_reference([](Extended l) { return std::exp(l); }, x)),
                      bound);
            ASSERT_LE(relative_error(tensor_sqrt(m), spectral_reference([](Extended l) { return std::sqrt(l); }, x)),
                      bound);
            ASSERT_LE(relative_error(tensor_power(m, 0.3),
                                     spectral_reference([](Extended l) { return std::pow(l, 0.3L); }, x)),
                      bound);
            ASSERT_LE(norm(tensor_exp(tensor_log(m)) - m), bound * norm(m));
        }
    }
}

// Analytic 6x6 against the derivative of identities that determine it, at any spectrum: with S = sqrt(A), S dS + dS S =
// dA; exp by its Taylor series, differentiated term by term; log as the inverse of exp.
template <AnalysisKind kind, class F>
VoigtMatrix<kind, double> by_ad(const F& function, const Matrix3<double>& m) {
    constexpr int n = components(kind);
    using D = Dual<n>;
    Strain<kind, D> strain = from_matrix<Strain<kind, D>, kind>(
        [&] {
            Matrix3<D> d;
            for (std::size_t i = 0; i < 9; ++i) d.m[i] = D(m.m[i]);
            return d;
        }(),
        2.0);
    for (int k = 0; k < n; ++k) strain[k] = D::variable(strain[k].value, k);
    const auto y = from_matrix<Stress<kind, D>, kind>(function(to_matrix<kind, D>(strain, 0.5)), 1.0);
    VoigtMatrix<kind, double> r;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) r(i, k) = y[i](k);
    return r;
}
template <AnalysisKind kind>
void expect_close(const VoigtMatrix<kind, double>& a, const VoigtMatrix<kind, double>& b, double relative) {
    double size = 0.0, difference = 0.0;
    for (std::size_t i = 0; i < a.m.size(); ++i) {
        size = std::max(size, std::abs(b.m[i]));
        difference = std::max(difference, std::abs(a.m[i] - b.m[i]));
    }
    EXPECT_LE(difference, relative * size);
}
template <class D>
Matrix3<D> taylor_exp(const Matrix3<D>& a) {
    // exp(A) = exp(A/16)^16
    const Matrix3<D> s = 0.0625 * a;
    Matrix3<D> sum = Matrix3<D>::identity(), term = sum;
    for (int k = 1; k < 20; ++k) {
        term = (1.0 / k) * (term * s);
        sum = sum + term;
    }
    for (int k = 0; k < 4; ++k) sum = sum * sum;
    return sum;
}

template <AnalysisKind kind>
void check_derivatives(const Matrix3<double>& m) {
    const auto e = symmetric_eigen<kind>(m);
    // Exponential: an algorithm without eigenvectors.
    expect_close<kind>(spectral_derivative<kind>(ExpFunction{}, e),
                       by_ad<kind>([](const auto& x) { return taylor_exp(x); }, m), 1e-12);
    // Differentiated tensor functions are the analytic derivative.
    expect_close<kind>(by_ad<kind>([](const auto& x) { return tensor_exp<kind>(x); }, m),
                       spectral_derivative<kind>(ExpFunction{}, e), 1e-13);
    expect_close<kind>(by_ad<kind>([](const auto& x) { return tensor_log<kind>(x); }, m),
                       spectral_derivative<kind>(LogFunction{}, e), 1e-13);
    // exp(log A) = A, sqrt(A)^2 = A, (A^0.3)^(1/0.3) = A: the products of the derivatives are the identity, with
    // engineering columns turned to tensor columns in between.
    const auto unit = by_ad<kind>([](const auto& x) { return taylor_exp(tensor_log<kind>(x)); }, m);
    const auto square_root = by_ad<kind>(
        [](const auto& x) {
            const auto s = tensor_sqrt<kind>(x);
            return s * s;
        },
        m);
    const auto power =
        by_ad<kind>([](const auto& x) { return tensor_power<kind>(tensor_power<kind>(x, 0.3), 1.0 / 0.3); }, m);
    const auto inverse = by_ad<kind>([](const auto& x) { return x * tensor_power<kind>(x, -1.0); }, m);
    for (int i = 0; i < components(kind); ++i)
        for (int j = 0; j < components(kind); ++j) {
            const double expected = i != j ? 0.0 : i < 3 ? 1.0 : 0.5;
            EXPECT_NEAR(unit(i, j), expected, 1e-12);
            EXPECT_NEAR(square_root(i, j), expected, 1e-12);
            EXPECT_NEAR(power(i, j), expected, 1e-12);
            EXPECT_NEAR(inverse(i, j), 0.0, 1e-12);
        }
}

TEST(Spectral, DerivativesForAnySpectrum) {
    std::mt19937_64 random(seed);
    for (const auto& [a, b, c] : {std::array{1.3, 0.9, 0.7},
                                  {1.0, 1.0, 1.0},
                                  {1.2, 1.2, 0.8},
                                  {0.8, 1.2, 1.2},
                                  {1.1, 1.1 + 1e-15, 1.1},
                                  {1.1, 1.1 + 1e-12, 0.9},
                                  {1.1, 1.1 + 1e-9, 1.1 - 1e-9},
                                  {1.1, 1.1 + 1e-6, 1.1},
                                  {1.1, 1.1 + 1e-3, 0.9},
                                  {2.0, 1.0, 0.5}}) {
        for (int i = 0; i < 5; ++i) {
            const Matrix3<double> q = random_rotation(random);
            check_derivatives<solid>(i == 0 ? diagonal(a, b, c) : turned(a, b, c, q));
            const double angle = 0.7 * i;
            Matrix3<double> about_3 = diagonal(std::cos(angle), std::cos(angle), 1.0);
            about_3(1, 0) = std::sin(angle), about_3(0, 1) = -std::sin(angle);
            check_derivatives<plane>(turned(a, b, c, about_3));
        }
    }
}

}  // namespace
