// The safeguarded scalar solve: hard functions, fuzzed brackets, batches, derivatives of the root.
#include "lode/numerics/root.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <string>
#include <vector>

#include "support/dual.hpp"

namespace {

using namespace lode;
using lode::test::Dual;

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double eps = std::numeric_limits<double>::epsilon();

struct Hard {
    std::string name;
    std::function<Residual<double>(double)> residual;
    double lower, upper, root;
};

// Functions that defeat Newton's method: infinite slopes, flats, many magnitudes, jumps, poles, undefined regions.
std::vector<Hard> hard_functions() {
    const auto sign = [](double x) { return x < 0.0 ? -1.0 : 1.0; };
    return {
        {"cube root",
         [](double x) {
             return Residual<double>{std::cbrt(x - 0.3), 1.0 / (3.0 * std::pow(std::cbrt(x - 0.3), 2))};
         },
         -1.0, 2.0, 0.3},
        {"signed square root",
         [sign](double x) {
             const double d = x - 0.3, s = std::sqrt(std::abs(d));
             return Residual<double>{sign(d) * s, 0.5 / s};
         },
         -1.0, 2.0, 0.3},
        {"ninth power",
         [](double x) {
             const double d = x - 0.7;
             return Residual<double>{std::pow(d, 9), 9.0 * std::pow(d, 8)};
         },
         0.0, 1.0, 0.7},
        {"arc tangent",
         [](double x) {
             return Residual<double>{std::atan(x - 3.0), 1.0 / (1.0 + (x - 3.0) * (x - 3.0))};
         },
         -1e6, 1e7, 3.0},
        {"exponential over 600 decades",
         [](double x) {
             return Residual<double>{std::exp(x) - 1.0, std::exp(x)};
         },
         -700.0, 700.0, 0.0},
        {"exponential, small right side",
         [](double x) {
             return Residual<double>{std::exp(x) - 1e-100, std::exp(x)};
         },
         -700.0, 700.0, -100.0 * std::log(10.0)},
        {"logarithm",
         [](double x) {
             return Residual<double>{std::log(x) + 200.0, 1.0 / x};
         },
         0.0, 1e10, std::exp(-200.0)},
        {"pole next to the root",
         [](double x) {
             return Residual<double>{1.0 - 1e-8 / x, 1e-8 / (x * x)};
         },
         0.0, 1.0, 1e-8},
        {"step",
         [](double x) {
             return Residual<double>{std::tanh(1e8 * (x - 0.123)),
                                     1e8 * (1.0 - std::pow(std::tanh(1e8 * (x - 0.123)), 2))};
         },
         0.0, 1.0, 0.123},
        {"jump",
         [](double x) {
             return Residual<double>{x < 0.25 ? -2.0 : 1.0, 0.0};
         },
         0.0, 1.0, 0.25},
        {"wrong slope",
         [](double x) {
             return Residual<double>{x - 0.4, -1.0};
         },
         0.0, 1.0, 0.4},
        {"slope not a number",
         [](double x) {
             return Residual<double>{x - 0.4, nan};
         },
         0.0, 1.0, 0.4},
        {"undefined beyond 0.9",
         [](double x) {
             return Residual<double>{x > 0.9 ? nan : x - 0.35, 1.0};
         },
         0.0, 1.0, 0.35},
        {"undefined below 0.3",
         [](double x) {
             return Residual<double>{x < 0.3 ? nan : std::sqrt(x - 0.3) - 0.1, 0.5 / std::sqrt(x - 0.3)};
         },
         0.0, 1.0, 0.31},
        {"infinite beyond 0.5",
         [](double x) {
             return Residual<double>{x > 0.5 ? inf : x - 0.4999, 1.0};
         },
         0.0, 1.0, 0.4999},
        {"root at the lower end",
         [](double x) {
             return Residual<double>{x * x * x + x, 3.0 * x * x + 1.0};
         },
         0.0, 5.0, 0.0},
        {"root at the upper end",
         [](double x) {
             return Residual<double>{std::expm1(x - 5.0), std::exp(x - 5.0)};
         },
         0.0, 5.0, 5.0},
        {"tiny root in a wide bracket",
         [](double x) {
             return Residual<double>{x - 1e-200, 0.0};
         },
         0.0, 1e300, 1e-200},
        {"two sided wide bracket",
         [](double x) {
             return Residual<double>{x - 1e-30, 0.0};
         },
         -1e200, 1e300, 1e-30},
    };
}

template <Slope direction>
void expect_root(const Hard& h, double start, double flip, const std::string& what) {
    int evaluations = 0;
    const auto residual = [&](double x) {
        EXPECT_GE(x, h.lower) << what;
        EXPECT_LE(x, h.upper) << what;
        ++evaluations;
        const Residual<double> r = h.residual(x);
        return Residual<double>{flip * r.value, flip * r.slope};
    };
    const Root<double> root = solve_bracketed<direction>(residual, h.lower, h.upper, start, 0.0);
    EXPECT_TRUE(root.converged) << h.name << what << " x = " << root.x;
    EXPECT_LE(root.iterations, 100) << h.name << what;
    EXPECT_EQ(root.iterations, evaluations) << h.name << what;
    // The bracket closes to 4 eps; the residual itself is uncertain by some eps of the largest term in it.
    EXPECT_NEAR(root.x, h.root,
                100.0 * eps * std::max(std::abs(h.root), h.name.starts_with("expo") ? 1.0 : 0.0) +
                    (h.root == 0.0 ? 1e-300 : 0.0))
        << h.name << what;
}

TEST(Root, HardFunctions) {
    for (const Hard& h : hard_functions()) {
        const double middle = 0.5 * h.lower + 0.5 * h.upper;
        for (double start : {h.lower, h.upper, middle, h.root, h.lower + 0.01 * (h.upper - h.lower), nan, -inf, inf}) {
            const std::string what = " from " + std::to_string(start);
            expect_root<Slope::unknown>(h, start, 1.0, what);
            expect_root<Slope::increasing>(h, start, 1.0, what);
            expect_root<Slope::unknown>(h, start, -1.0, what);
            expect_root<Slope::decreasing>(h, start, -1.0, what);
        }
    }
}

// Monotone functions a x^p-like of random shape, scale and bracket, including scales of 1e-12 to 1e12.
TEST(Root, RandomBrackets) {
    constexpr unsigned seed = 20240611;
    RecordProperty("seed", static_cast<int>(seed));
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    int most = 0;
    double sum = 0.0;
    constexpr int cases = 20000;
    for (int i = 0; i < cases; ++i) {
        const double scale = std::pow(10.0, 24.0 * unit(random) - 12.0);
        const double height = std::pow(10.0, 24.0 * unit(random) - 12.0);
        const double power = std::pow(10.0, 2.0 * unit(random) - 1.0);
        const double target = unit(random), left = -3.0 * unit(random), right = 1.0 + 3.0 * unit(random);
        const double start = scale * (left + (right - left) * unit(random));
        const auto residual = [&](double x) {
            const double t = x / scale, d = t - target, a = std::pow(std::abs(d), power);
            return Residual<double>{height * (d < 0.0 ? -a : a), height * power * a / (std::abs(d) * scale)};
        };
        const double tolerance = 1e-13 * height;
        const Root<double> root = solve_bracketed(residual, scale * left, scale * right, start, tolerance);
        ASSERT_TRUE(root.converged) << "case " << i << " seed " << seed;
        // |d|^p <= 1e-13, or the bracket closed to rounding around the root.
        const double reached = std::abs(root.x / scale - target);
        ASSERT_LE(reached, std::max(std::pow(1e-13, 1.0 / power), 16.0 * eps))
            << "case " << i << " seed " << seed << " power " << power;
        most = std::max(most, root.iterations);
        sum += root.iterations;
    }
    EXPECT_LE(most, 100);
    RecordProperty("mean_iterations", std::to_string(sum / cases));
    RecordProperty("most_iterations", most);
}

TEST(Root, SmoothProblemsTakeNewtonsIterations) {
    // Convex, so from the right Newton's iterates decrease to the root and halve the residual: no safeguard interferes.
    const auto residual = [](double x) { return Residual<double>{x * x - 2.0, 2.0 * x}; };
    double x = 2.0;
    int newton = 1;
    for (; std::abs(x * x - 2.0) > 1e-15; ++newton) x -= (x * x - 2.0) / (2.0 * x);
    const Root<double> root = solve_bracketed(residual, 0.0, 2.0, 2.0, 1e-15);
    EXPECT_EQ(root.iterations, newton);
    EXPECT_EQ(root.safeguards, 0);
    EXPECT_EQ(root.x, x);
}

// Newton's first step from x = 4 leaves the bracket [-5, 5]; the end that it leaves through is asked for its sign, the
// bracket is halved to x = -0.5, and from there Newton converges. An evaluation a step, and the first one.
TEST(Root, CountsTheStepsThatAreNotNewtons) {
    int evaluations = 0;
    const auto residual = [&](double x) {
        ++evaluations;
        return Residual<double>{std::atan(x), 1.0 / (1.0 + x * x)};
    };
    const Root<double> root = solve_bracketed(residual, -5.0, 5.0, 4.0, 1e-15);
    ASSERT_TRUE(root.converged);
    EXPECT_EQ(root.safeguards, 2);
    EXPECT_EQ(root.iterations, evaluations);
    // Where the sign at the ends is known nothing is asked.
    EXPECT_EQ((solve_bracketed<Slope::increasing>(residual, -5.0, 5.0, 4.0, 1e-15).safeguards), 1);
}

TEST(Root, DoesNotConvergeWithoutEnoughIterations) {
    const auto residual = [](double x) {
        return Residual<double>{std::atan(x - 3.0), 1.0 / (1.0 + (x - 3.0) * (x - 3.0))};
    };
    for (int limit : {1, 2, 3, 7, 9}) {
        const Root<double> root = solve_bracketed(residual, -1e6, 1e7, 1e6, 1e-14, true, limit);
        EXPECT_FALSE(root.converged);
        EXPECT_EQ(root.iterations, limit);
    }
}

TEST(Root, BatchLanesAreIndependent) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (int repeat = 0; repeat < 500; ++repeat) {
        alignas(64) double target[batch_lanes], start[batch_lanes];
        bool active[batch_lanes];
        for (int k = 0; k < batch_lanes; ++k) {
            target[k] = std::pow(10.0, 6.0 * unit(random) - 3.0);
            start[k] = 1e4 * unit(random) * unit(random);
            active[k] = unit(random) > 0.2;
        }
        // A rational function: the same correctly rounded operations in both, hence the same bits.
        const auto residual = [](auto x, auto t) {
            using Real = decltype(x);
            return Residual<Real>{(x - t) / (x + 3.0 * t), 4.0 * t / ((x + 3.0 * t) * (x + 3.0 * t))};
        };
        const Batch t = Batch::load_aligned(target);
        const auto root =
            solve_bracketed([&](const Batch& x) { return residual(x, t); }, Batch(0.0), Batch(1e4),
                            Batch::load_aligned(start), Batch(1e-13), Mask<Batch>::load_unaligned(active));
        ASSERT_TRUE(all(root.converged));
        for (int k = 0; k < batch_lanes; ++k) {
            const auto i = static_cast<std::size_t>(k);
            if (!active[k]) {
                EXPECT_EQ(root.x.get(i), start[k]);
                continue;
            }
            const auto alone =
                solve_bracketed([&](double x) { return residual(x, target[k]); }, 0.0, 1e4, start[k], 1e-13);
#if defined(__FMA__)
            // Contracted multiply-adds may differ between the two compilations of the residual.
            EXPECT_NEAR(root.x.get(i), alone.x, 2e-12 * target[k]);
#else
            EXPECT_EQ(root.x.get(i), alone.x);
#endif
        }
    }
}

TEST(Root, DerivativesFollowFromTheImplicitFunctionTheorem) {
    using D = Dual<2>;
    const D a = D::variable(0.7, 0), b = D::variable(2.5, 1);
    // x + a x^3 = b
    const auto residual = [&](const D& x) { return Residual<D>{x + a * x * x * x - b, 1.0 + 3.0 * a * x * x}; };
    const Root<D> root = solve_bracketed(residual, D(0.0), D(10.0), D(1.0), D(1e-15));
    ASSERT_TRUE(root.converged);
    const double x = root.x.value, slope = 1.0 + 3.0 * 0.7 * x * x;
    EXPECT_NEAR(root.x(0), -x * x * x / slope, 4 * eps);
    EXPECT_NEAR(root.x(1), 1.0 / slope, 4 * eps);
    const Root<double> plain = solve_bracketed(
        [](double y) {
            return Residual<double>{y + 0.7 * y * y * y - 2.5, 1.0 + 3.0 * 0.7 * y * y};
        },
        0.0, 10.0, 1.0, 1e-15);
    EXPECT_NEAR(x, plain.x, 4 * eps);
    EXPECT_EQ(solve_bracketed(residual, D(0.0), D(10.0), a, D(1e-15), false).x(0), 1.0);
}

}  // namespace
