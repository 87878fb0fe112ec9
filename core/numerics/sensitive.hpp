// A number with its derivatives in up to eight directions, carried along by the chain rule: what an algorithm of many
// steps returns comes with the derivative of that very algorithm. The derivatives are one vector register wide.
#pragma once

#include "lode/numerics/functions.hpp"

namespace lode {

struct Sensitive {
    typedef double Slopes [[gnu::vector_size(64)]];
    static constexpr int directions = 8;

    double value = 0.0;
    Slopes slopes{};

    Sensitive() = default;
    LODE_INLINE Sensitive(double v) : value(v) {}
    LODE_INLINE Sensitive(double v, const Slopes& s) : value(v), slopes(s) {}
    // Derivative `rate` in direction k.
    LODE_INLINE static Sensitive variable(double v, int k, double rate = 1.0) {
        Sensitive x(v);
        x.slopes[k] = rate;
        return x;
    }
    LODE_INLINE double operator()(int k) const { return slopes[k]; }

    LODE_INLINE friend double value_of(const Sensitive& x) { return x.value; }

    LODE_INLINE friend Sensitive operator-(const Sensitive& x) { return {-x.value, -x.slopes}; }
    LODE_INLINE friend Sensitive operator+(const Sensitive& x, const Sensitive& y) {
        return {x.value + y.value, x.slopes + y.slopes};
    }
    LODE_INLINE friend Sensitive operator-(const Sensitive& x, const Sensitive& y) {
        return {x.value - y.value, x.slopes - y.slopes};
    }
    LODE_INLINE friend Sensitive operator*(const Sensitive& x, const Sensitive& y) {
        return {x.value * y.value, y.value * x.slopes + x.value * y.slopes};
    }
    LODE_INLINE friend Sensitive operator/(const Sensitive& x, const Sensitive& y) {
        const double inverse = 1.0 / y.value, quotient = x.value * inverse;
        return {quotient, inverse * (x.slopes - quotient * y.slopes)};
    }
    LODE_INLINE friend Sensitive operator+(const Sensitive& x, double y) { return {x.value + y, x.slopes}; }
    LODE_INLINE friend Sensitive operator+(double x, const Sensitive& y) { return {x + y.value, y.slopes}; }
    LODE_INLINE friend Sensitive operator-(const Sensitive& x, double y) { return {x.value - y, x.slopes}; }
    LODE_INLINE friend Sensitive operator-(double x, const Sensitive& y) { return {x - y.value, -y.slopes}; }
    LODE_INLINE friend Sensitive operator*(double x, const Sensitive& y) { return {x * y.value, x * y.slopes}; }
    LODE_INLINE friend Sensitive operator*(const Sensitive& x, double y) { return {x.value * y, y * x.slopes}; }
    LODE_INLINE friend Sensitive operator/(const Sensitive& x, double y) { return x * (1.0 / y); }

    // Comparisons look at the value.
    friend bool operator==(const Sensitive& x, const Sensitive& y) { return x.value == y.value; }
    friend bool operator!=(const Sensitive& x, const Sensitive& y) { return x.value != y.value; }
    friend bool operator<(const Sensitive& x, const Sensitive& y) { return x.value < y.value; }
    friend bool operator<=(const Sensitive& x, const Sensitive& y) { return x.value <= y.value; }
    friend bool operator>(const Sensitive& x, const Sensitive& y) { return x.value > y.value; }
    friend bool operator>=(const Sensitive& x, const Sensitive& y) { return x.value >= y.value; }

    // The root of a constant zero is a constant.
    friend Sensitive sqrt(const Sensitive& x) {
        const double root = std::sqrt(x.value);
        return {root, root > 0.0 ? (0.5 / root) * x.slopes : Slopes{}};
    }
    friend Sensitive exp(const Sensitive& x) {
        const double e = quick_exp(x.value);
        return {e, e * x.slopes};
    }
    friend Sensitive expm1(const Sensitive& x) {
        const double e = quick_expm1(x.value);
        return {e, (1.0 + e) * x.slopes};
    }
    friend Sensitive log(const Sensitive& x) { return {quick_log(x.value), (1.0 / x.value) * x.slopes}; }
    friend Sensitive log1p(const Sensitive& x) { return {std::log1p(x.value), (1.0 / (1.0 + x.value)) * x.slopes}; }
    friend Sensitive abs(const Sensitive& x) { return x.value < 0.0 ? -x : x; }
    friend Sensitive min(const Sensitive& x, const Sensitive& y) { return y.value < x.value ? y : x; }
    friend Sensitive max(const Sensitive& x, const Sensitive& y) { return x.value < y.value ? y : x; }
};

}  // namespace lode
