// Exponential and logarithm of the kernels against the standard library's in long double, for a single number and for a
// batch.
#include "lode/numerics/functions.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "lode/numerics/near_power.hpp"

using namespace lode;

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

// f of x as a double and as every lane of a batch.
template <class F>
std::array<double, 2> both(const F& f, double x) {
    const Batch result = f(Batch(x));
    for (std::size_t lane = 0; lane < Batch::size; ++lane) EXPECT_EQ(result.get(lane), result.get(0)) << x;
    return {f(x), result.get(0)};
}

template <class F, class Exact>
void expect_close(const F& f, const Exact& exact, double x, double tolerance = 2.0 * epsilon) {
    const auto reference = static_cast<double>(exact(static_cast<long double>(x)));
    for (const double result : both(f, x)) EXPECT_NEAR(result, reference, tolerance * std::abs(reference)) << x;
}

const auto exponential = [](const auto& x) { return quick_exp(x); };
const auto exponential_less_1 = [](const auto& x) { return quick_expm1(x); };
const auto logarithm = [](const auto& x) { return quick_log(x); };

}  // namespace

TEST(Functions, Exponential) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (int i = 0; i < 20000; ++i) {
        const double x = uniform(random) * std::pow(10.0, i % 6 - 3.0);
        const double inside = std::max(-700.0, std::min(700.0, x));
        expect_close(
            exponential, [](long double y) { return std::exp(y); }, inside);
        expect_close(
            exponential_less_1, [](long double y) { return std::expm1(y); }, inside);
    }
    expect_close(
        exponential, [](long double) { return 1.0L; }, 0.0);
    expect_close(
        exponential_less_1, [](long double) { return 0.0L; }, 0.0);
    for (const double x : {-1e4, 1e4})
        for (const double result : both(exponential, x)) EXPECT_TRUE(result > 0.0 && std::isfinite(result));
    EXPECT_TRUE(std::isnan(quick_exp(std::nan(""))));
    EXPECT_TRUE(std::isnan(quick_exp(Batch(std::nan(""))).get(0)));
}

TEST(Functions, Logarithm) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> magnitude(-300.0, 300.0), near_1(-0.5, 0.5);
    for (int i = 0; i < 20000; ++i) {
        const double x = i % 2 == 0 ? std::pow(10.0, magnitude(random)) : 1.0 + near_1(random);
        expect_close(
            logarithm, [](long double y) { return std::log(y); }, x);
        for (const double estimate : both([](const auto& y) { return estimated_log(y); }, x))
            EXPECT_NEAR(estimate, std::log(x), 0.03) << x;
    }
    for (const double result : both(logarithm, 1.0)) EXPECT_EQ(result, 0.0);
}

TEST(Functions, Power) {
    for (const double x : {0.0, 1e-12, 0.3, 1.0, 40.0})
        for (const double n : {0.26, 0.5, 1.03, 3.0})
            // The error of the logarithm grows with the exponent.
            for (const double result : both([n](const auto& y) { return quick_pow(y, n); }, x))
                EXPECT_NEAR(result, std::pow(x, n),
                            2.0 * epsilon * (1.0 + std::abs(n * std::log(std::max(x, 1e-12)))) * std::pow(x, n));
}

// Two powers at once are those of one number each, also where one of them needs more than the common steps.
TEST(Functions, TwoPowers) {
    const auto allowed = [](double x, double n) {
        return 2.0 * epsilon * (1.0 + std::abs(n * std::log(std::max(x, 1e-300)))) * std::pow(x, n);
    };
    std::mt19937 random(3);
    std::uniform_real_distribution<double> magnitude(-20.0, 5.0), exponent(0.01, 3.0);
    for (int i = 0; i < 20000; ++i) {
        const double x = i % 50 == 0 ? 0.0 : std::exp(magnitude(random)), y = std::exp(magnitude(random));
        const double n = exponent(random), m = exponent(random);
        const auto powers = quick_pow(x, n, y, m);
        EXPECT_NEAR(powers.first, std::pow(x, n), allowed(x, n)) << x << " " << n;
        EXPECT_NEAR(powers.second, std::pow(y, m), allowed(y, m)) << y << " " << m;
        // What the series of the guess leave out.
        EXPECT_NEAR(powers.rough_first, powers.first, (3e-6 + 1.4e-6 * n) * powers.first) << x << " " << n;
        EXPECT_NEAR(powers.rough_second, powers.second, (3e-6 + 1.4e-6 * m) * powers.second) << y << " " << m;
    }
    const auto of_batch = quick_pow(Batch(0.3), 0.26, Batch(2.0), 1.5);
    EXPECT_EQ(of_batch.first.get(0), quick_pow(Batch(0.3), 0.26).get(0));
    EXPECT_EQ(of_batch.second.get(0), quick_pow(Batch(2.0), 1.5).get(0));
    EXPECT_EQ(quick_pow(1e-280, 3.0, 0.5, 1.0).first, quick_pow(1e-280, 3.0));
}

// (1 + z)^n within its reach; exponents that are too large for the approximation say so.
TEST(Functions, NearPower) {
    for (const double n : {0.01, 0.26, 0.5, 0.9, 1.0, 1.5, 3.0}) {
        const NearPower power(n);
        ASSERT_EQ(power.reach(), 1.0) << n;
        for (int i = 0; i <= 1000; ++i) {
            const double z = 1e-3 * i;
            const auto exact = static_cast<double>(std::pow(1.0L + z, static_cast<long double>(n)));
            EXPECT_NEAR(power(z), exact, 6.0 * epsilon * exact) << n << " " << z;
            EXPECT_NEAR(power(Batch(z)).get(0), exact, 6.0 * epsilon * exact) << n << " " << z;
        }
    }
    EXPECT_LT(NearPower(20.0).reach(), 0.0);
    EXPECT_LT(NearPower(std::nan("")).reach(), 0.0);
}
