// Dense Newton, LU factorisation, substepping.
#include <gtest/gtest.h>

#include <random>

#include "lode/numerics/dense_newton.hpp"
#include "lode/numerics/reciprocal_cbrt.hpp"
#include "lode/numerics/substepping.hpp"
#include "lode/tensor/voigt.hpp"
#include "support/dual.hpp"

namespace {

using namespace lode;
using lode::test::Dual;
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr unsigned seed = 99;

TEST(Lu, SolvesRandomSystemsOfAnyScale) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    constexpr int n = 8;
    for (int repeat = 0; repeat < 1000; ++repeat) {
        DenseMatrix<double, n> a;
        DenseVector<double, n> x, b{}, size{};
        for (int i = 0; i < n; ++i) {
            x[static_cast<std::size_t>(i)] = u(random);
            const double scale = std::pow(10.0, 12.0 * u(random));
            for (int j = 0; j < n; ++j) a(i, j) = scale * u(random);
        }
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < n; ++j) {
                b[i] += a.m[n * i + j] * x[j];
                size[i] += std::abs(a.m[n * i + j]);
            }
        const LuFactors<double, n> lu(a);
        ASSERT_TRUE(lu.regular());
        const auto y = lu.solve(b);
        // Backward stable: the residual is a few n eps of row size times solution, whatever the condition.
        double largest = 0.0;
        for (double v : y) largest = std::max(largest, std::abs(v));
        for (std::size_t i = 0; i < n; ++i) {
            double r = -b[i];
            for (std::size_t j = 0; j < n; ++j) r += a.m[n * i + j] * y[j];
            ASSERT_LE(std::abs(r), 20.0 * n * eps * size[i] * largest);
        }
    }
}

TEST(Lu, ReportsSingularMatrices) {
    EXPECT_FALSE((LuFactors<double, 2>(DenseMatrix<double, 2>{{1.0, 2.0, 2.0, 4.0}}).regular()));
    EXPECT_FALSE((LuFactors<double, 2>(DenseMatrix<double, 2>{{0.0, 0.0, 2.0, 4.0}}).regular()));
    EXPECT_FALSE((LuFactors<double, 2>(DenseMatrix<double, 2>{{std::nan(""), 1.0, 2.0, 4.0}}).regular()));
    EXPECT_TRUE((LuFactors<double, 2>(DenseMatrix<double, 2>{{0.0, 1e-300, 1e300, 0.0}}).regular()));
}

// Rosenbrock's valley as a system: r = (10 (y - x^2), 1 - x).
const auto valley = [](const auto& x, auto& r, auto& j) {
    r[0] = 10.0 * (x[1] - x[0] * x[0]);
    r[1] = 1.0 - x[0];
    j(0, 0) = -20.0 * x[0];
    j(0, 1) = 10.0;
    j(1, 0) = -1.0;
    j(1, 1) = 0.0;
    return true;
};

TEST(DenseNewton, Converges) {
    const auto result = solve_dense_newton<2>(valley, DenseVector<double, 2>{-1.2, 1.0}, 1e-14);
    ASSERT_TRUE(result.converged());
    EXPECT_NEAR(result.x[0], 1.0, 1e-14);
    EXPECT_NEAR(result.x[1], 1.0, 1e-14);
    EXPECT_LE(result.residual, 1e-14);
}

TEST(DenseNewton, LineSearchRescuesTheArcTangent) {
    // Undamped Newton diverges from |x| > 1.3917.
    const auto system = [](const auto& x, auto& r, auto& j) {
        r[0] = std::atan(x[0]);
        j(0, 0) = 1.0 / (1.0 + x[0] * x[0]);
        return true;
    };
    for (double start : {1.5, 10.0, -1e3, 1e5}) {
        const auto result = solve_dense_newton<1>(system, DenseVector<double, 1>{start}, 1e-14);
        EXPECT_TRUE(result.converged()) << start;
        EXPECT_NEAR(result.x[0], 0.0, 1e-14);
        EXPECT_GT(result.safeguards, 0);
    }
    EXPECT_EQ((solve_dense_newton<1>(system, DenseVector<double, 1>{1.0}, 1e-14).safeguards), 0);
}

TEST(DenseNewton, StaysInTheDomain) {
    // log x = -3, outside its domain for x <= 0; Newton's first step from 10 goes to -43.
    const auto system = [](const auto& x, auto& r, auto& j) {
        if (!(x[0] > 0.0)) return false;
        r[0] = std::log(x[0]) + 3.0;
        j(0, 0) = 1.0 / x[0];
        return true;
    };
    const auto result = solve_dense_newton<1>(system, DenseVector<double, 1>{10.0}, 1e-14);
    ASSERT_TRUE(result.converged());
    EXPECT_NEAR(result.x[0], std::exp(-3.0), 1e-14 * std::exp(-3.0) + eps);
    EXPECT_EQ((solve_dense_newton<1>(system, DenseVector<double, 1>{-1.0}, 1e-14).status),
              NewtonStatus::outside_domain);
}

TEST(DenseNewton, ReportsFailure) {
    const auto no_root = [](const auto& x, auto& r, auto& j) {
        r[0] = x[0] * x[0] + 1.0;
        j(0, 0) = 2.0 * x[0];
        return true;
    };
    const auto result = solve_dense_newton<1>(no_root, DenseVector<double, 1>{0.7}, 1e-12);
    EXPECT_FALSE(result.converged());
    EXPECT_EQ((solve_dense_newton<1>(no_root, DenseVector<double, 1>{0.0}, 1e-12).status), NewtonStatus::singular);
    EXPECT_EQ((solve_dense_newton<2>(valley, DenseVector<double, 2>{-1.2, 1.0}, 1e-14, 1).status),
              NewtonStatus::iteration_limit);
    const auto nonsense = [](const auto&, auto& r, auto& j) {
        r[0] = std::nan("");
        j(0, 0) = 1.0;
        return true;
    };
    EXPECT_FALSE((solve_dense_newton<1>(nonsense, DenseVector<double, 1>{0.7}, 1e-12).converged()));
}

TEST(DenseNewton, DerivativesFollowFromTheImplicitFunctionTheorem) {
    using D = Dual<2>;
    const D a = D::variable(3.0, 0), b = D::variable(2.0, 1);
    // x + y = a, x y = b: x and y are the roots 1 and 2 of t^2 - a t + b; dx/da = x/(x - y), dx/db = -1/(x - y).
    const auto system = [&](const auto& x, auto& r, auto& j) {
        r[0] = x[0] + x[1] - a;
        r[1] = x[0] * x[1] - b;
        j(0, 0) = D(1.0), j(0, 1) = D(1.0);
        j(1, 0) = x[1], j(1, 1) = x[0];
        return true;
    };
    const auto result = solve_dense_newton<2>(system, DenseVector<D, 2>{D(0.5), D(4.0)}, 1e-15);
    ASSERT_TRUE(result.converged());
    const double x = result.x[0].value, y = result.x[1].value;
    EXPECT_NEAR(result.x[0](0), x / (x - y), 8.0 * eps);
    EXPECT_NEAR(result.x[0](1), -1.0 / (x - y), 8.0 * eps);
    EXPECT_NEAR(result.x[1](0), y / (y - x), 8.0 * eps);
    EXPECT_NEAR(result.x[1](1), -1.0 / (y - x), 8.0 * eps);
}

TEST(Substepping, DoublingStopsAtTheTolerance) {
    // Backward Euler for y' = -y over [0, 1]: first order, so the difference of N and 2N is the error of 2N.
    const auto integrate = [](int n) { return std::pow(1.0 + 1.0 / n, -n); };
    const auto difference = [](double fine, double coarse) { return std::abs(fine - coarse); };
    for (double tolerance : {1e-1, 1e-2, 1e-3}) {
        const auto r = double_substeps(integrate, difference, tolerance);
        ASSERT_TRUE(r.converged);
        EXPECT_EQ(r.state, integrate(r.substeps));
        EXPECT_LE(r.difference, tolerance);
        EXPECT_LE(std::abs(r.state - std::exp(-1.0)), 1.5 * tolerance);
        if (r.substeps > 2) {
            EXPECT_GT(difference(integrate(r.substeps / 2), integrate(r.substeps / 4)), tolerance);
        }
    }
    const auto stuck = double_substeps(integrate, difference, 0.0, 1, 64);
    EXPECT_FALSE(stuck.converged);
    EXPECT_EQ(stuck.substeps, 64);
    EXPECT_EQ(double_substeps(integrate, difference, 1.0, 3).substeps, 6);
}

using Pair = Vector<double, 2>;

TEST(Substepping, ModifiedEulerIsOfSecondOrder) {
    // A rotation by one radian: y' = (-y2, y1). The error falls like the tolerance, the substeps grow like
    // tolerance^-1/2.
    const auto rate = [](const Pair& y) { return Pair{{-y[1], y[0]}}; };
    const auto error = [](const Pair& e, const Pair& y) { return std::hypot(e[0], e[1]) / std::hypot(y[0], y[1]); };
    double last_error = 0.0;
    int last_substeps = 0;
    for (double tolerance : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7}) {
        SubstepControl control;
        control.tolerance = tolerance;
        const auto r = modified_euler(Pair{{1.0, 0.0}}, rate, error, control);
        ASSERT_TRUE(r.completed);
        const double global = std::hypot(r.state[0] - std::cos(1.0), r.state[1] - std::sin(1.0));
        // One substep errs by h^3/6 while err = h^2/2; h^2/2 <= tolerance.
        EXPECT_LE(global, tolerance);
        EXPECT_LE(r.accepted, 2.0 * std::sqrt(0.5 / tolerance) + 2.0);
        if (tolerance < 1e-5) {
            EXPECT_NEAR(last_error / global, 10.0, 3.0);
            EXPECT_NEAR(static_cast<double>(r.accepted) / last_substeps, std::sqrt(10.0), 0.5);
        }
        last_error = global;
        last_substeps = r.accepted;
    }
}

TEST(Substepping, ModifiedEulerReportsFailureAndCallsBack) {
    const auto error = [](const Pair& e, const Pair&) { return std::hypot(e[0], e[1]); };
    // y' = y^2 from 2 blows up at t = 1/2.
    const auto blow_up = [](const Pair& y) { return Pair{{y[0] * y[0], 0.0}}; };
    SubstepControl control;
    control.tolerance = 1e-6;
    const auto failed = modified_euler(Pair{{2.0, 0.0}}, blow_up, error, control);
    EXPECT_FALSE(failed.completed);
    EXPECT_GT(failed.rejected, 0);
    const auto undefined = modified_euler(
        Pair{{2.0, 0.0}},
        [](const Pair&) {
            return Pair{{std::nan(""), 0.0}};
        },
        error, control);
    EXPECT_FALSE(undefined.completed);
    EXPECT_EQ(undefined.state[0], 2.0);
    int calls = 0;
    const auto constant = modified_euler(
        Pair{{0.0, 0.0}},
        [](const Pair&) {
            return Pair{{1.0, 2.0}};
        },
        error, [&](Pair&) { ++calls; }, control);
    EXPECT_TRUE(constant.completed);
    EXPECT_EQ(calls, 1);
    EXPECT_EQ(constant.state[1], 2.0);
}

// Two roundings of the last step and of x y^3 are what remains.
TEST(ReciprocalCbrt, IsWithinTwoUlpFromTheSmallestNormalNumberToTheLargest) {
    for (int exponent = -1021; exponent <= 1023; ++exponent)
        for (double mantissa = 1.0; mantissa < 2.0; mantissa += 0.0417) {
            const double x = std::ldexp(mantissa, exponent);
            const double exact = static_cast<double>(1.0L / std::cbrt(static_cast<long double>(x)));
            const double ulp = std::nextafter(exact, 2.0 * exact) - exact;
            EXPECT_NEAR(reciprocal_cbrt(x), exact, 2.0 * ulp) << x;
            EXPECT_NEAR(reciprocal_cbrt(Batch(x)).get(0), exact, 2.0 * ulp) << x;
            EXPECT_NEAR(reciprocal_cbrt(x - 1.0, x), exact, 2.0 * ulp) << x;
            EXPECT_NEAR(reciprocal_cbrt(Batch(x - 1.0), Batch(x)).get(0), exact, 2.0 * ulp) << x;
        }
}
TEST(ReciprocalCbrt, NearOneIsWithinTwoUlp) {
    for (int i = 0; i <= 30000; ++i) {
        const double x = 0.5 + 1.5 * i / 30000.0;
        const double exact = static_cast<double>(1.0L / std::cbrt(static_cast<long double>(x)));
        const double ulp = std::nextafter(exact, 2.0 * exact) - exact;
        EXPECT_NEAR(reciprocal_cbrt(x - 1.0, x), exact, 2.0 * ulp) << x;
    }
}

}  // namespace
