// 1/cbrt(x) without a division: the laws that split off the volume change need J^(-1/3) and its powers.
#pragma once

#include <bit>
#include <cstdint>

#include "lode/numerics/scalar.hpp"

namespace lode {

namespace reciprocal_cbrt_detail {

// Exponent and mantissa divided by -3 as one integer: within 3.5 %, the integer being chosen for the smallest error.
inline constexpr std::int64_t magic = 0x553EF0FF289DD796;

LODE_INLINE double start(double x) { return std::bit_cast<double>(magic - std::bit_cast<std::int64_t>(x) / 3); }
LODE_INLINE Batch start(const Batch& x) {
    // A division of integers is not a vector instruction: the bit pattern as a number is exact enough.
    using Integer = xsimd::batch<std::int64_t>;
    const Batch bits = xsimd::to_float(xsimd::bitwise_cast<Integer>(x)) * (-1.0 / 3.0) + static_cast<double>(magic);
    return xsimd::bitwise_cast<Batch>(xsimd::to_int(bits));
}

// The derivatives of a differentiated number come from the steps that follow.
template <class Real>
Real start(const Real& x) {
    return Real(start(value_of(x)));
}

// Coefficients of (1 - h)^(-1/3) = 1 + c[0] h + c[1] h^2 + ...
struct BinomialSeries {
    double c[16];

    constexpr BinomialSeries() : c{1.0 / 3} {
        for (int k = 1; k < 16; ++k) c[k] = c[k - 1] * (3 * k + 1) / (3 * k + 3);
    }
};
inline constexpr BinomialSeries binomial;

// c[first] + c[first + 1] h + ... of 2, 4, 8 or 16 terms, in the order that lets most of it run in parallel; then come
// h^(count/2), ..., h^2, h.
template <int count, class Real, class... Powers>
LODE_INLINE Real terms(int first, const Real& h_half, const Powers&... lower) {
    if constexpr (count == 2) return binomial.c[first] + h_half * binomial.c[first + 1];
    else return terms<count / 2>(first, lower...) + h_half * terms<count / 2>(first + count / 2, lower...);
}

}  // namespace reciprocal_cbrt_detail

// For normal x > 0; within 2 ulp. With h = 1 - x y^3 the root is y (1 - h)^(-1/3); of the start |h| < 0.11, and the
// rest of the series is below 1e-17. One long step takes less time than two short ones, which have to wait for one
// another.
template <class Real>
LODE_INLINE Real reciprocal_cbrt(const Real& x) {
    const Real y = reciprocal_cbrt_detail::start(x);
    const Real h = 1.0 - x * (y * y * y), h2 = h * h, h4 = h2 * h2;
    return y + (y * h) * reciprocal_cbrt_detail::terms<16>(0, Real(h4 * h4), h4, h2, h);
}

// The same of x = 1 + j, given both: for 1/2 <= x <= 2 a cubic in j (minimax) is within 0.4 % of the root, |h| < 0.012,
// and half the series leaves less than 1e-18. The start does not wait for the bits of x either.
template <class Real>
LODE_INLINE Real reciprocal_cbrt(const Real& j, const Real& x) {
    const Real y = (0.9979684437 - 0.3505912330 * j) + (j * j) * (0.2662573146 - 0.1229128056 * j);
    const Real h = 1.0 - x * (y * y * y), h2 = h * h;
    const Real near_value = y + (y * h) * reciprocal_cbrt_detail::terms<8>(0, Real(h2 * h2), h2, h);
    const Mask<Real> near = abs(j - 0.25) <= Real(0.75);
    if (all(near)) [[likely]]
        return near_value;
    return select(near, near_value, reciprocal_cbrt(x));
}

}  // namespace lode
