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

}  // namespace reciprocal_cbrt_detail

// For normal x > 0; within 2 ulp. Two steps of fourth order: with h = 1 - x y^3 the root is y (1 - h)^(-1/3).
template <class Real>
LODE_INLINE Real reciprocal_cbrt(const Real& x) {
    Real y = reciprocal_cbrt_detail::start(x);
    for (int step = 0; step < 2; ++step) {
        const Real h = 1.0 - x * (y * y * y);
        y = y + y * (h * (1.0 / 3 + h * (2.0 / 9 + h * (14.0 / 81))));
    }
    return y;
}

}  // namespace lode
