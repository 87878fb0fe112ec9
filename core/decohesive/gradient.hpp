// A number that carries its derivatives by n variables (forward mode). An increment in which a crack starts is
// differentiated by running it on these: the crack normal depends on the strain, and no short formula says how.
#pragma once

#include <array>
#include <cmath>

#include "lode/numerics/scalar.hpp"

namespace lode {

template <int n>
struct Gradient {
    double value;
    std::array<double, std::size_t{n}> slope;

    Gradient() = default;  // not set
    Gradient(double constant) : value(constant), slope{} {}
    static Gradient variable(double v, int k) {
        Gradient x(v);
        x.slope[static_cast<std::size_t>(k)] = 1.0;
        return x;
    }

    friend double value_of(const Gradient& x) { return x.value; }
    // f(x) of slope df; f(x, y) of slopes dx, dy.
    friend Gradient chain(const Gradient& x, double f, double df) {
        Gradient r;
        r.value = f;
        for (std::size_t i = 0; i < n; ++i) r.slope[i] = df * x.slope[i];
        return r;
    }
    friend Gradient chain(const Gradient& x, const Gradient& y, double f, double dx, double dy) {
        Gradient r;
        r.value = f;
        for (std::size_t i = 0; i < n; ++i) r.slope[i] = dx * x.slope[i] + dy * y.slope[i];
        return r;
    }

    friend Gradient operator-(const Gradient& x) { return chain(x, -x.value, -1.0); }
    friend Gradient operator+(const Gradient& x, const Gradient& y) { return chain(x, y, x.value + y.value, 1.0, 1.0); }
    friend Gradient operator-(const Gradient& x, const Gradient& y) {
        return chain(x, y, x.value - y.value, 1.0, -1.0);
    }
    friend Gradient operator*(const Gradient& x, const Gradient& y) {
        return chain(x, y, x.value * y.value, y.value, x.value);
    }
    friend Gradient operator/(const Gradient& x, const Gradient& y) {
        const double quotient = x.value / y.value;
        return chain(x, y, quotient, 1.0 / y.value, -quotient / y.value);
    }

    friend bool operator==(const Gradient& x, const Gradient& y) { return x.value == y.value; }
    friend bool operator<(const Gradient& x, const Gradient& y) { return x.value < y.value; }
    friend bool operator<=(const Gradient& x, const Gradient& y) { return x.value <= y.value; }
    friend bool operator>(const Gradient& x, const Gradient& y) { return x.value > y.value; }
    friend bool operator>=(const Gradient& x, const Gradient& y) { return x.value >= y.value; }

    friend Gradient sqrt(const Gradient& x) {
        const double root = std::sqrt(x.value);
        return chain(x, root, root > 0.0 ? 0.5 / root : 0.0);
    }
    friend Gradient exp(const Gradient& x) {
        const double e = std::exp(x.value);
        return chain(x, e, e);
    }
    friend Gradient expm1(const Gradient& x) { return chain(x, std::expm1(x.value), std::exp(x.value)); }
    friend Gradient sin(const Gradient& x) { return chain(x, std::sin(x.value), std::cos(x.value)); }
    friend Gradient cos(const Gradient& x) { return chain(x, std::cos(x.value), -std::sin(x.value)); }
    friend Gradient atan2(const Gradient& y, const Gradient& x) {
        const double r = x.value * x.value + y.value * y.value;
        return chain(y, x, std::atan2(y.value, x.value), x.value / r, -y.value / r);
    }
    friend Gradient abs(const Gradient& x) { return x.value < 0.0 ? -x : x; }
    friend Gradient max(const Gradient& x, const Gradient& y) { return x.value < y.value ? y : x; }
    friend Gradient min(const Gradient& x, const Gradient& y) { return y.value < x.value ? y : x; }
};

}  // namespace lode
