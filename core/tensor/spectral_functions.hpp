// Scalar functions for isotropic tensor functions: value f(x), derivative f'(x) and the divided difference
// (f(a) - f(b))/(a - b), which has no cancellation for close arguments and is f'(a) for equal ones.
#pragma once

#include "lode/numerics/scalar.hpp"

namespace lode {

namespace spectral_detail {

// sum_k c_k x^k, highest coefficient last.
template <class Real, std::size_t n>
inline Real polynomial(const Real& x, const double (&c)[n]) {
    Real sum(c[n - 1]);
    for (std::size_t k = n - 1; k-- > 0;) sum = sum * x + c[k];
    return sum;
}

// sinh(x)/x. The series is cut off below 1e-17 at |x| = 1/2.
template <class Real>
inline Real sinhc(const Real& x) {
    constexpr double c[] = {1.0,           1.0 / 6,          1.0 / 120,          1.0 / 5040,
                            1.0 / 362880., 1.0 / 39916800.0, 1.0 / 6227020800.0, 1.0 / 1307674368000.0};
    const Mask<Real> close = abs(x) < Real(0.5);
    const Real series = polynomial(x * x, c);
    if (all(close)) return series;
    const Real e = exp(x);
    return select(close, series, 0.5 * (e - 1.0 / e) / select(close, Real(1.0), x));
}

// atanh(z)/z by its series, cut off below 1e-18 at |z| = 0.1.
template <class Real>
inline Real atanhc_series(const Real& z) {
    constexpr double c[] = {1.0, 1.0 / 3, 1.0 / 5, 1.0 / 7, 1.0 / 9, 1.0 / 11, 1.0 / 13, 1.0 / 15, 1.0 / 17};
    return polynomial(z * z, c);
}

// log(a/b)/(a - b), given a - b apart from a and b.
template <class Real>
inline Real log_difference(const Real& a, const Real& b, const Real& difference) {
    const Real sum = a + b, z = difference / sum;
    const Mask<Real> close = abs(z) < Real(0.1);
    const Real series = 2.0 * atanhc_series(z) / sum;
    if (all(close)) return series;
    return select(close, series, log(a / b) / select(close, Real(1.0), difference));
}

}  // namespace spectral_detail

struct LogFunction {
    template <class Real>
    Real value(const Real& x) const {
        return log(x);
    }
    template <class Real>
    Real derivative(const Real& x) const {
        return 1.0 / x;
    }
    template <class Real>
    Real divided_difference(const Real& a, const Real& b) const {
        return spectral_detail::log_difference(a, b, a - b);
    }
};

// log(1 + x): the logarithm of B from b = B - I.
struct Log1pFunction {
    template <class Real>
    Real value(const Real& x) const {
        return log1p(x);
    }
    template <class Real>
    Real derivative(const Real& x) const {
        return 1.0 / (1.0 + x);
    }
    template <class Real>
    Real divided_difference(const Real& a, const Real& b) const {
        return spectral_detail::log_difference(1.0 + a, 1.0 + b, a - b);
    }
};

struct ExpFunction {
    template <class Real>
    Real value(const Real& x) const {
        return exp(x);
    }
    template <class Real>
    Real derivative(const Real& x) const {
        return exp(x);
    }
    template <class Real>
    Real divided_difference(const Real& a, const Real& b) const {
        const Real d = a - b;
        const Mask<Real> close = abs(d) < Real(1.0);
        const Real series = exp(0.5 * (a + b)) * spectral_detail::sinhc(select(close, 0.5 * d, Real(0.0)));
        if (all(close)) return series;
        return select(close, series, (exp(a) - exp(b)) / select(close, Real(1.0), d));
    }
};

// exp(x) - 1.
struct Expm1Function : ExpFunction {
    template <class Real>
    Real value(const Real& x) const {
        return expm1(x);
    }
};

struct SqrtFunction {
    template <class Real>
    Real value(const Real& x) const {
        return sqrt(x);
    }
    template <class Real>
    Real derivative(const Real& x) const {
        return 0.5 / sqrt(x);
    }
    template <class Real>
    Real divided_difference(const Real& a, const Real& b) const {
        return 1.0 / (sqrt(a) + sqrt(b));
    }
};

// sqrt(1 + x) - 1: the stretch V - I from b = B - I.
struct Sqrt1pm1Function {
    template <class Real>
    Real value(const Real& x) const {
        return x / (1.0 + sqrt(1.0 + x));
    }
    template <class Real>
    Real derivative(const Real& x) const {
        return 0.5 / sqrt(1.0 + x);
    }
    template <class Real>
    Real divided_difference(const Real& a, const Real& b) const {
        return 1.0 / (sqrt(1.0 + a) + sqrt(1.0 + b));
    }
};

// x^p for x > 0.
struct PowerFunction {
    double exponent = 1.0;

    template <class Real>
    Real value(const Real& x) const {
        return pow(x, Real(exponent));
    }
    template <class Real>
    Real derivative(const Real& x) const {
        return exponent * pow(x, Real(exponent - 1.0));
    }
    // (ab)^((p-1)/2) p sinhc(p t)/sinhc(t), t = log(a/b)/2: even in t, so close arguments do no harm. The square root
    // is taken before the power: the product of two stretches may leave the range.
    template <class Real>
    Real divided_difference(const Real& a, const Real& b) const {
        using spectral_detail::sinhc;
        const Real t = 0.5 * log(a / b);
        return exponent * pow(sqrt(a) * sqrt(b), Real(exponent - 1.0)) * sinhc(exponent * t) / sinhc(t);
    }
};

}  // namespace lode
