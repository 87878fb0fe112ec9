// A function of time at one moment: its value and its first two derivatives, through the arithmetic of closed forms.
#ifndef LODE_HOST_VERIFY_TAYLOR_HPP
#define LODE_HOST_VERIFY_TAYLOR_HPP

#include <cmath>

namespace lode::host {

struct Taylor {
    double value = 0, first = 0, second = 0;

    Taylor() = default;
    Taylor(double constant) : value(constant) {}
    Taylor(double v, double d, double dd) : value(v), first(d), second(dd) {}

    friend Taylor operator-(const Taylor& x) { return {-x.value, -x.first, -x.second}; }
    friend Taylor operator+(const Taylor& x, const Taylor& y) {
        return {x.value + y.value, x.first + y.first, x.second + y.second};
    }
    friend Taylor operator-(const Taylor& x, const Taylor& y) { return x + (-y); }
    friend Taylor operator*(const Taylor& x, const Taylor& y) {
        return {x.value * y.value, x.value * y.first + x.first * y.value,
                x.value * y.second + 2 * x.first * y.first + x.second * y.value};
    }
    friend Taylor operator/(const Taylor& x, const Taylor& y) { return x * y.composed(1 / y.value, -1, 2); }

    friend Taylor sqrt(const Taylor& x) { return x.composed(std::sqrt(x.value), 0.5, -0.25); }
    friend Taylor pow(const Taylor& x, double n) { return x.composed(std::pow(x.value, n), n, n * (n - 1)); }
    friend Taylor log(const Taylor& x) {
        const double slope = 1 / x.value;
        return {std::log(x.value), slope * x.first, slope * x.second - slope * slope * x.first * x.first};
    }

  private:
    // f(x) of a power: f' = a f/x, f'' = b f/x^2.
    Taylor composed(double f, double a, double b) const {
        const double slope = a * f / value, curvature = b * f / (value * value);
        return {f, slope * first, slope * second + curvature * first * first};
    }
};

}  // namespace lode::host

#endif
