// Forward-mode automatic differentiation for the tests: a value and n directional derivatives, with everything the
// kernels use. Comparisons look at the value only, so a differentiated kernel takes the branches of the plain one.
// All functions are friends found by argument-dependent look-up: kernels in namespace lode write sqrt(x).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace lode::test {

template <int n>
struct Dual {
    double value = 0.0;
    std::array<double, static_cast<std::size_t>(n)> derivative{};

    constexpr Dual() = default;
    constexpr Dual(double v) : value(v) {}

    // The independent variable number k, with derivative 1 in its own direction.
    static constexpr Dual variable(double v, int k) {
        Dual x(v);
        x.derivative[static_cast<std::size_t>(k)] = 1.0;
        return x;
    }
    constexpr double operator()(int k) const { return derivative[static_cast<std::size_t>(k)]; }
    static constexpr int size() { return n; }

    friend constexpr double value_of(const Dual& x) { return x.value; }

    // f(x) with slope df, and f(x, y) with partial derivatives. A vanishing derivative stays zero under an infinite
    // slope (sqrt at 0 of a constant is a constant).
    friend constexpr Dual chain(const Dual& x, double f, double df) {
        Dual r(f);
        for (std::size_t i = 0; i < r.derivative.size(); ++i) r.derivative[i] = product(df, x.derivative[i]);
        return r;
    }
    friend constexpr Dual chain(const Dual& x, const Dual& y, double f, double dx, double dy) {
        Dual r(f);
        for (std::size_t i = 0; i < r.derivative.size(); ++i)
            r.derivative[i] = product(dx, x.derivative[i]) + product(dy, y.derivative[i]);
        return r;
    }

    friend constexpr Dual operator+(const Dual& x) { return x; }
    friend constexpr Dual operator-(const Dual& x) { return chain(x, -x.value, -1.0); }
    friend constexpr Dual operator+(const Dual& x, const Dual& y) { return chain(x, y, x.value + y.value, 1.0, 1.0); }
    friend constexpr Dual operator-(const Dual& x, const Dual& y) { return chain(x, y, x.value - y.value, 1.0, -1.0); }
    friend constexpr Dual operator*(const Dual& x, const Dual& y) {
        return chain(x, y, x.value * y.value, y.value, x.value);
    }
    friend constexpr Dual operator/(const Dual& x, const Dual& y) {
        const double quotient = x.value / y.value;
        return chain(x, y, quotient, 1.0 / y.value, -quotient / y.value);
    }
    constexpr Dual& operator+=(const Dual& y) { return *this = *this + y; }
    constexpr Dual& operator-=(const Dual& y) { return *this = *this - y; }
    constexpr Dual& operator*=(const Dual& y) { return *this = *this * y; }
    constexpr Dual& operator/=(const Dual& y) { return *this = *this / y; }

    friend constexpr bool operator==(const Dual& x, const Dual& y) { return x.value == y.value; }
    friend constexpr bool operator!=(const Dual& x, const Dual& y) { return x.value != y.value; }
    friend constexpr bool operator<(const Dual& x, const Dual& y) { return x.value < y.value; }
    friend constexpr bool operator<=(const Dual& x, const Dual& y) { return x.value <= y.value; }
    friend constexpr bool operator>(const Dual& x, const Dual& y) { return x.value > y.value; }
    friend constexpr bool operator>=(const Dual& x, const Dual& y) { return x.value >= y.value; }

    friend Dual sqrt(const Dual& x) {
        const double root = std::sqrt(x.value);
        return chain(x, root, 0.5 / root);
    }
    friend Dual cbrt(const Dual& x) {
        const double root = std::cbrt(x.value);
        return chain(x, root, 1.0 / (3.0 * root * root));
    }
    friend Dual exp(const Dual& x) {
        const double e = std::exp(x.value);
        return chain(x, e, e);
    }
    friend Dual exp2(const Dual& x) {
        const double e = std::exp2(x.value);
        return chain(x, e, e * 0.69314718055994530942);
    }
    friend Dual expm1(const Dual& x) { return chain(x, std::expm1(x.value), std::exp(x.value)); }
    friend Dual log(const Dual& x) { return chain(x, std::log(x.value), 1.0 / x.value); }
    friend Dual log1p(const Dual& x) { return chain(x, std::log1p(x.value), 1.0 / (1.0 + x.value)); }
    friend Dual log2(const Dual& x) { return chain(x, std::log2(x.value), 1.44269504088896340736 / x.value); }
    friend Dual log10(const Dual& x) { return chain(x, std::log10(x.value), 0.43429448190325182765 / x.value); }
    friend Dual sin(const Dual& x) { return chain(x, std::sin(x.value), std::cos(x.value)); }
    friend Dual cos(const Dual& x) { return chain(x, std::cos(x.value), -std::sin(x.value)); }
    friend Dual tan(const Dual& x) {
        const double t = std::tan(x.value);
        return chain(x, t, 1.0 + t * t);
    }
    friend Dual asin(const Dual& x) {
        return chain(x, std::asin(x.value), 1.0 / std::sqrt((1.0 - x.value) * (1.0 + x.value)));
    }
    friend Dual acos(const Dual& x) {
        return chain(x, std::acos(x.value), -1.0 / std::sqrt((1.0 - x.value) * (1.0 + x.value)));
    }
    friend Dual atan(const Dual& x) { return chain(x, std::atan(x.value), 1.0 / (1.0 + x.value * x.value)); }
    friend Dual atan2(const Dual& y, const Dual& x) {
        const double r2 = x.value * x.value + y.value * y.value;
        return chain(y, x, std::atan2(y.value, x.value), x.value / r2, -y.value / r2);
    }
    friend Dual sinh(const Dual& x) { return chain(x, std::sinh(x.value), std::cosh(x.value)); }
    friend Dual cosh(const Dual& x) { return chain(x, std::cosh(x.value), std::sinh(x.value)); }
    friend Dual tanh(const Dual& x) {
        const double t = std::tanh(x.value);
        return chain(x, t, (1.0 - t) * (1.0 + t));
    }
    friend Dual asinh(const Dual& x) { return chain(x, std::asinh(x.value), 1.0 / std::hypot(x.value, 1.0)); }
    friend Dual acosh(const Dual& x) {
        return chain(x, std::acosh(x.value), 1.0 / std::sqrt((x.value - 1.0) * (x.value + 1.0)));
    }
    friend Dual atanh(const Dual& x) {
        return chain(x, std::atanh(x.value), 1.0 / ((1.0 - x.value) * (1.0 + x.value)));
    }
    friend Dual erf(const Dual& x) {
        return chain(x, std::erf(x.value), 1.12837916709551257390 * std::exp(-x.value * x.value));
    }

    friend Dual pow(const Dual& x, double a) {
        const double slope = a == 0.0 ? 0.0 : a * std::pow(x.value, a - 1.0);
        return chain(x, std::pow(x.value, a), slope);
    }
    friend Dual pow(const Dual& x, int a) { return pow(x, static_cast<double>(a)); }
    friend Dual pow(double x, const Dual& a) {
        const double power = std::pow(x, a.value);
        return chain(a, power, power == 0.0 ? 0.0 : power * std::log(x));
    }
    friend Dual pow(const Dual& x, const Dual& a) {
        const double power = std::pow(x.value, a.value);
        const double dx = a.value == 0.0 ? 0.0 : a.value * std::pow(x.value, a.value - 1.0);
        return chain(x, a, power, dx, power == 0.0 ? 0.0 : power * std::log(x.value));
    }

    friend constexpr Dual abs(const Dual& x) { return x.value < 0.0 ? -x : x; }
    friend constexpr Dual fabs(const Dual& x) { return abs(x); }
    friend constexpr Dual min(const Dual& x, const Dual& y) { return y.value < x.value ? y : x; }
    friend constexpr Dual max(const Dual& x, const Dual& y) { return x.value < y.value ? y : x; }
    friend Dual copysign(const Dual& x, const Dual& y) {
        return std::signbit(x.value) == std::signbit(y.value) ? x : -x;
    }
    friend Dual fma(const Dual& x, const Dual& y, const Dual& z) {
        Dual r = chain(x, y, std::fma(x.value, y.value, z.value), y.value, x.value);
        for (std::size_t i = 0; i < r.derivative.size(); ++i) r.derivative[i] += z.derivative[i];
        return r;
    }
    friend Dual hypot(const Dual& x, const Dual& y) {
        const double h = std::hypot(x.value, y.value);
        return h == 0.0 ? chain(x, y, h, 1.0, 1.0) : chain(x, y, h, x.value / h, y.value / h);
    }
    friend Dual hypot(const Dual& x, const Dual& y, const Dual& z) { return hypot(hypot(x, y), z); }
    friend Dual floor(const Dual& x) { return Dual(std::floor(x.value)); }
    friend Dual ceil(const Dual& x) { return Dual(std::ceil(x.value)); }
    friend bool isfinite(const Dual& x) { return std::isfinite(x.value); }
    friend bool isnan(const Dual& x) { return std::isnan(x.value); }

  private:
    static constexpr double product(double slope, double d) { return d == 0.0 ? 0.0 : slope * d; }
};

}  // namespace lode::test
