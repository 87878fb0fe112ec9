// Exponential, logarithm and power for kernels. For a double they are inlined, so that a call does not push a material
// point out of the registers, without tables, and without a division but for the logarithm; errors are below 2 units in
// the last place. Batches and differentiated numbers use their own functions.
#pragma once

#include <bit>
#include <cstdint>

#include "lode/numerics/scalar.hpp"

namespace lode {
namespace functions_detail {

inline constexpr double shifter = 0x1.8p52;  // adding it rounds to an integer
inline constexpr double ln2_high = 0x1.62e42fefa38p-1, ln2_low = 0x1.ef35793c7673p-45;

struct Reduced {
    double expm1;  // of the rest
    double scale;  // 2^n
};
// x = n ln 2 + rest, |rest| <= ln(2)/2.
LODE_INLINE Reduced reduce(double x) {
    x = std::min(std::max(x, -708.0), 709.0);
    const double shifted = x * 1.4426950408889634074 + shifter, n = shifted - shifter;
    const double r = (x - n * ln2_high) - n * ln2_low;
    // Taylor series in the order that lets most of it run in parallel.
    const double r2 = r * r, r4 = r2 * r2;
    const double p0 = 1.0 / 2 + r * (1.0 / 6), p1 = 1.0 / 24 + r * (1.0 / 120);
    const double p2 = 1.0 / 720 + r * (1.0 / 5040), p3 = 1.0 / 40320 + r * (1.0 / 362880);
    const double p4 = 1.0 / 3628800 + r * (1.0 / 39916800), p5 = 1.0 / 479001600 + r * (1.0 / 6227020800);
    const double q = (p0 + r2 * p1) + r4 * ((p2 + r2 * p3) + r4 * (p4 + r2 * p5));
    const auto bits = std::bit_cast<std::uint64_t>(shifted) << 52;
    return {r + r2 * q, std::bit_cast<double>(bits + std::bit_cast<std::uint64_t>(1.0))};
}

LODE_INLINE double logarithm(double x) {
    constexpr std::uint64_t root_half = 0x3fe6a09e667f3bcdu;  // sqrt(1/2)
    const auto bits = std::bit_cast<std::uint64_t>(x);
    const auto above = bits - root_half;
    const double k = static_cast<double>(static_cast<std::int64_t>(above) >> 52);
    const double m = std::bit_cast<double>((above & 0x000fffffffffffffu) + root_half);
    // ln m = 2 artanh((m - 1)/(m + 1)), m in [sqrt(1/2), sqrt(2)]
    const double f = m - 1.0, s = f / (2.0 + f);
    const double z = s * s, z2 = z * z, z4 = z2 * z2;
    const double p0 = 2.0 / 3 + z * (2.0 / 5), p1 = 2.0 / 7 + z * (2.0 / 9), p2 = 2.0 / 11 + z * (2.0 / 13);
    const double p3 = 2.0 / 15 + z * (2.0 / 17), p4 = 2.0 / 19 + z * (2.0 / 21), p5 = 2.0 / 23;
    const double q = (p0 + z2 * p1) + z4 * ((p2 + z2 * p3) + z4 * (p4 + z2 * p5));
    return k * ln2_high + (k * ln2_low + (2.0 * s + s * z * q));
}

}  // namespace functions_detail

// e^x; clamped at x = -708 and 709.
template <class Real>
LODE_INLINE Real quick_exp(const Real& x) {
    if constexpr (std::is_same_v<Real, double>) {
        const auto [p, scale] = functions_detail::reduce(x);
        return scale * p + scale;
    } else {
        return exp(x);
    }
}
// e^x - 1.
template <class Real>
LODE_INLINE Real quick_expm1(const Real& x) {
    if constexpr (std::is_same_v<Real, double>) {
        const auto [p, scale] = functions_detail::reduce(x);
        return scale * p + (scale - 1.0);
    } else {
        return expm1(x);
    }
}
// ln x for a normal number x > 0.
template <class Real>
LODE_INLINE Real quick_log(const Real& x) {
    if constexpr (std::is_same_v<Real, double>) return functions_detail::logarithm(x);
    else return log(x);
}
// x^n of x >= 0; 0 where x < 1e-300.
template <class Real>
LODE_INLINE Real quick_pow(const Real& x, double n) {
    const auto positive = x > Real(1e-300);
    return select(positive, quick_exp(n * quick_log(select(positive, x, Real(1.0)))), Real(0.0));
}

}  // namespace lode
