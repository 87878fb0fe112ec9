// (1 + z)^n of a constant exponent for 0 <= z <= 1: a power near a known one, in a division and two polynomials instead
// of a logarithm and an exponential.
#pragma once

#include <cmath>
#include <limits>

#include "lode/numerics/scalar.hpp"

namespace lode {

class NearPower {
  public:
    // Nothing is within reach of an exponent that the approximation does not serve.
    explicit NearPower(double exponent) {
        // The [m/m] Pade approximant around c, (1 + c)^2 = 2, from the hypergeometric series of both its parts. With
        // r = (2^(1/4) - 1)/(2^(1/4) + 1) its error at both ends is 2 sin(pi n) r^(2m + 1), 2e-16 for m = 7.
        const long double per_centre = std::sqrt(0.5L), shift = per_centre - 1.0L;
        Series up{}, down{};
        long double binomial = 1.0L, above = 1.0L, below = 1.0L;
        for (int j = 0; j <= degree; ++j) {
            up[j] = binomial * above, down[j] = binomial * below;
            const long double falling = 2.0L * degree - j;
            binomial *= (degree - j) / (j + 1.0L);
            above *= (degree - j + exponent) / falling, below *= (degree - j - exponent) / falling;
        }
        // In powers of z: (z - c)/(1 + c) = per_centre z + shift.
        substitute(up, per_centre, shift);
        substitute(down, per_centre, shift);
        const long double scale = std::pow(2.0L, 0.5L * exponent) / down[0];
        for (int j = 0; j <= degree; ++j) {
            numerator_[j] = static_cast<double>(scale * up[j]);
            denominator_[j] = static_cast<double>(down[j] / down[0]);
        }
        const auto misses = [&](double z) {
            return !(std::abs((*this)(z)*std::pow(1.0 + z, -exponent) - 1.0) < 1e-15);
        };
        if (misses(0.0) || misses(0.5) || misses(1.0)) reach_ = -1.0;
    }

    // The largest z; below 0 if there is none.
    double reach() const { return reach_; }

    template <class Real>
    LODE_INLINE Real operator()(const Real& z) const {
        const Real z2 = z * z, z4 = z2 * z2;
        return polynomial(numerator_, z, z2, z4) / polynomial(denominator_, z, z2, z4);
    }

  private:
    static constexpr int degree = 7;
    using Series = long double[degree + 1];

    // p(x) := p(a x + b).
    static void substitute(Series& p, long double a, long double b) {
        Series q{};
        for (int j = degree; j >= 0; --j) {
            for (int k = degree; k > 0; --k) q[k] = b * q[k] + a * q[k - 1];
            q[0] = b * q[0] + p[j];
        }
        for (int j = 0; j <= degree; ++j) p[j] = q[j];
    }
    template <class Real>
    LODE_INLINE static Real polynomial(const double (&p)[degree + 1], const Real& z, const Real& z2, const Real& z4) {
        return ((p[0] + z * p[1]) + z2 * (p[2] + z * p[3])) + z4 * ((p[4] + z * p[5]) + z2 * (p[6] + z * p[7]));
    }

    double numerator_[degree + 1], denominator_[degree + 1];
    double reach_ = 1.0;
};

}  // namespace lode
