// Exponential, logarithm and power for kernels, inlined, so that a call does not push a material point out of the
// registers; errors are below 2.5 units in the last place. Differentiated numbers use their own functions.
#pragma once

#include <bit>
#include <cstdint>

#include "lode/numerics/scalar.hpp"

namespace lode {
namespace functions_detail {

inline constexpr double shifter = 0x1.8p52;  // adding it rounds to an integer
inline constexpr double ln2_high = 0x1.62e42fefa38p-1, ln2_low = 0x1.ef35793c7673p-45;

// What is not a number stays so.
LODE_INLINE double clamp_exponent(double x) { return std::min(std::max(x, -708.0), 709.0); }
LODE_INLINE Batch clamp_exponent(const Batch& x) { return min(Batch(709.0), max(Batch(-708.0), x)); }
// 2^n from n + shifter.
LODE_INLINE Batch power_of_two(const Batch& shifted) {
    using Integer = xsimd::batch<std::int64_t>;
    const Integer one(std::bit_cast<std::int64_t>(1.0));
    return xsimd::bitwise_cast<Batch>((xsimd::bitwise_cast<Integer>(shifted) << 52) + one);
}

struct ReducedBatch {
    Batch expm1;  // of the rest
    Batch scale;  // 2^n
};
// x = n ln 2 + rest, |rest| <= ln(2)/2.
LODE_INLINE ReducedBatch reduce(const Batch& exponent) {
    const Batch x = clamp_exponent(exponent);
    const Batch shifted = x * 1.4426950408889634074 + shifter, n = shifted - shifter;
    const Batch r = (x - n * ln2_high) - n * ln2_low;
    // Taylor series in the order that lets most of it run in parallel.
    const Batch r2 = r * r, r4 = r2 * r2;
    const Batch p0 = 1.0 / 2 + r * (1.0 / 6), p1 = 1.0 / 24 + r * (1.0 / 120);
    const Batch p2 = 1.0 / 720 + r * (1.0 / 5040), p3 = 1.0 / 40320 + r * (1.0 / 362880);
    const Batch p4 = 1.0 / 3628800 + r * (1.0 / 39916800), p5 = 1.0 / 479001600 + r * (1.0 / 6227020800);
    const Batch q = (p0 + r2 * p1) + r4 * ((p2 + r2 * p3) + r4 * (p4 + r2 * p5));
    return {r + r2 * q, power_of_two(shifted)};
}

// 2^(i/size): the bits of the nearest number, and what that lacks as a fraction of it.
struct ExponentialTable {
    static constexpr int bits = 7, size = 1 << bits;
    // ln(2)/size; times a whole number below 2^18 the first is exact.
    static constexpr double step_high = 0x1.62e42fefcp-1 / size, step_low = -0x1.c610ca86c3899p-37 / size;
    std::uint64_t power[size] = {};
    double rest[size] = {};

    constexpr ExponentialTable() {
        for (int i = 0; i < size; ++i) {
            const long double x = 0.693147180559945309417232121458176568L * i / size;
            long double term = 1.0L, sum = 0.0L;
            for (int k = 1; k < 40; ++k) {
                sum += term;
                term *= x / k;
            }
            const auto nearest = static_cast<double>(sum);
            power[i] = std::bit_cast<std::uint64_t>(nearest);
            rest[i] = static_cast<double>((sum - nearest) / sum);
        }
    }
};
inline constexpr ExponentialTable exponential_table;

struct ReducedNumber {
    double expm1;  // of the rest
    double scale;  // 2^(n/size), rounded
    double error;  // what rounding has taken from it, as a fraction of it
};
// The same with fewer terms: x = n ln(2)/size + rest.
LODE_INLINE ReducedNumber reduce(double exponent) {
    constexpr int size = ExponentialTable::size;
    const double x = clamp_exponent(exponent);
    const double shifted = x * (size * 1.4426950408889634074) + shifter, n = shifted - shifter;
    const double r = (x - n * ExponentialTable::step_high) - n * ExponentialTable::step_low;  // |r| < 0.0028
    const double r2 = r * r, q = (0.5 + r * (1.0 / 6)) + r2 * (1.0 / 24 + r * (1.0 / 120));
    const auto steps = std::bit_cast<std::uint64_t>(shifted), bin = steps % size;
    const double scale = std::bit_cast<double>(exponential_table.power[bin] + ((steps / size) << 52));
    return {r + r2 * q, scale, exponential_table.rest[bin]};
}

// 1/c and ln c of the bins of the mantissa, c their middle; the bin around 1 has c = 1.
struct LogarithmTable {
    static constexpr int bits = 5, size = 1 << bits;
    static constexpr std::uint64_t first = 0x3fe6400000000000u;  // 0.695
    double inverse[size] = {}, logarithm[size] = {};

    constexpr LogarithmTable() {
        for (int i = 0; i < size; ++i) {
            const auto middle = first + (static_cast<std::uint64_t>(2 * i + 1) << (51 - bits));
            inverse[i] = 1.0 / std::bit_cast<double>(middle);
            // -ln(1/c) = -2 artanh(s)
            const long double y = inverse[i], s = (y - 1.0L) / (y + 1.0L);
            long double power = s, sum = 0.0L;
            for (int k = 1; k < 60; k += 2) {
                sum += power / k;
                power *= s * s;
            }
            logarithm[i] = static_cast<double>(-2.0L * sum);
        }
    }
};
inline constexpr LogarithmTable logarithm_table;

LODE_INLINE double logarithm(double x) {
    const auto above = std::bit_cast<std::uint64_t>(x) - LogarithmTable::first;
    const double k = static_cast<double>(static_cast<std::int64_t>(above) >> 52);
    const auto mantissa = above & 0x000fffffffffffffu;
    const auto bin = mantissa >> (52 - LogarithmTable::bits);
    const double m = std::bit_cast<double>(mantissa + LogarithmTable::first);
    const double r = fma(m, logarithm_table.inverse[bin], -1.0);  // |r| < 1/63
    const double r2 = r * r, r4 = r2 * r2;
    const double p0 = -1.0 / 2 + r * (1.0 / 3), p1 = -1.0 / 4 + r * (1.0 / 5), p2 = -1.0 / 6 + r * (1.0 / 7);
    const double p3 = -1.0 / 8 + r * (1.0 / 9);
    const double q = (p0 + r2 * p1) + r4 * (p2 + r2 * p3);
    return k * ln2_high + (logarithm_table.logarithm[bin] + (k * ln2_low + (r + r2 * q)));
}

// Two numbers at once.
typedef double Pair [[gnu::vector_size(16)]];
typedef std::uint64_t PairBits [[gnu::vector_size(16)]];

struct PowerPair {
    Pair exact, rough;
};
// x^n of both lanes in the steps of `logarithm` and `reduce`, and sooner from fewer terms, for what may begin with a
// guess (relative error 3e-6 + 1.4e-6 n); `usual` is false where the steps are not enough.
LODE_INLINE PowerPair power(const Pair& x, const Pair& n, bool& usual) {
    constexpr std::uint64_t one = std::bit_cast<std::uint64_t>(1.0), integer = std::bit_cast<std::uint64_t>(0x1p52);
    const auto bits = std::bit_cast<PairBits>(x), above = bits - LogarithmTable::first;
    const Pair k = std::bit_cast<Pair>(((above + one) >> 52) | integer) - (0x1p52 + 1023.0);
    const PairBits mantissa = above & 0x000fffffffffffffu, bin = mantissa >> (52 - LogarithmTable::bits);
    const auto m = std::bit_cast<Pair>(mantissa + LogarithmTable::first);
    const Pair inverse{logarithm_table.inverse[bin[0]], logarithm_table.inverse[bin[1]]};
    const Pair table{logarithm_table.logarithm[bin[0]], logarithm_table.logarithm[bin[1]]};
    const Pair r = m * inverse - 1.0, r2 = r * r, r4 = r2 * r2;
    const Pair p0 = -1.0 / 2 + r * (1.0 / 3), p1 = -1.0 / 4 + r * (1.0 / 5), p2 = -1.0 / 6 + r * (1.0 / 7);
    const Pair p3 = -1.0 / 8 + r * (1.0 / 9), p = (p0 + r2 * p1) + r4 * (p2 + r2 * p3);
    const Pair y = n * ((k * ln2_high + table) + ((k * ln2_low + r) + r2 * p));
    const auto inside = (x > 1e-300) & (x < 1e300) & (y > -708.0) & (y < 709.0);
    usual = (inside[0] & inside[1]) != 0;

    constexpr int size = ExponentialTable::size;
    const Pair shifted = y * (size * 1.4426950408889634074) + shifter, whole = shifted - shifter;
    const Pair e = (y - whole * ExponentialTable::step_high) - whole * ExponentialTable::step_low, e2 = e * e;
    const Pair q = (0.5 + e * (1.0 / 6)) + e2 * (1.0 / 24 + e * (1.0 / 120));
    const auto steps = std::bit_cast<PairBits>(shifted), step = steps % size;
    const PairBits powers{exponential_table.power[step[0]], exponential_table.power[step[1]]};
    const auto scale = std::bit_cast<Pair>(powers + ((steps / size) << 52));

    const Pair z = (n * 1.4426950408889634074) * ((k * 0.69314718055994530942 + table) + (r - 0.5 * r2));
    const Pair z_shifted = z + shifter, f = 0.69314718055994530942 * (z - (z_shifted - shifter)), f2 = f * f;
    const auto z_scale = std::bit_cast<Pair>((std::bit_cast<PairBits>(z_shifted) << 52) + one);
    const Pair rough = (1.0 + f) + f2 * ((0.5 + f * (1.0 / 6)) + f2 * (1.0 / 24 + f * (1.0 / 120)));
    return {(scale * e2) * q + (scale * e + scale), z_scale * rough};
}

// The same without a table: ln m = 2 artanh(f/(2 + f)), f = m - 1 in [-0.29, 0.41] (coefficients of Sun's fdlibm).
LODE_INLINE Batch logarithm(const Batch& x) {
    using Bits = xsimd::batch<std::uint64_t>;
    constexpr std::uint64_t lowest = 0x3fe6a09e667f3bcdu, one = 0x3ff0000000000000u, integer = 0x4330000000000000u;
    const Bits bits = xsimd::bitwise_cast<Bits>(x);
    const Bits exponent = (bits + Bits(one - lowest)) >> 52;  // biased
    const Batch k = xsimd::bitwise_cast<Batch>(exponent | Bits(integer)) - (0x1p52 + 1023.0);
    const Batch f = xsimd::bitwise_cast<Batch>(bits - (exponent << 52) + Bits(one)) - 1.0;
    const Batch s = f / (2.0 + f), z = s * s, w = z * z, half_square = 0.5 * f * f;
    const Batch even = w * (3.999999999940941908e-01 + w * (2.222219843214978396e-01 + w * 1.531383769920937332e-01));
    const Batch odd =
        z * (6.666666666666735130e-01 +
             w * (2.857142874366239149e-01 + w * (1.818357216161805012e-01 + w * 1.479819860511658591e-01)));
    return k * ln2_high - ((half_square - (s * (half_square + (even + odd)) + k * ln2_low)) - f);
}

}  // namespace functions_detail

// e^x; clamped at x = -708 and 709.
template <class Real>
LODE_INLINE Real quick_exp(const Real& x) {
    if constexpr (std::is_same_v<Real, double> || is_batch<Real>) {
        const auto reduced = functions_detail::reduce(x);
        return reduced.scale * reduced.expm1 + reduced.scale;
    } else {
        return exp(x);
    }
}
// e^x - 1.
template <class Real>
LODE_INLINE Real quick_expm1(const Real& x) {
    if constexpr (std::is_same_v<Real, double>) {
        const auto [p, scale, error] = functions_detail::reduce(x);
        return scale * (p + error) + (scale - 1.0);
    } else if constexpr (is_batch<Real>) {
        const auto [p, scale] = functions_detail::reduce(x);
        return scale * p + (scale - 1.0);
    } else {
        return expm1(x);
    }
}
// ln x for a normal number x > 0.
template <class Real>
LODE_INLINE Real quick_log(const Real& x) {
    if constexpr (std::is_same_v<Real, double> || is_batch<Real>) return functions_detail::logarithm(x);
    else return log(x);
}
// ln x of x > 0 within 0.03, for a first guess: the bits of a number are nearly its logarithm.
template <class Real>
LODE_INLINE Real estimated_log(const Real& x) {
    constexpr double per_bit = 0.69314718055994530942 / 0x1p52, of_one = 1022.957 * 0.69314718055994530942;
    if constexpr (std::is_same_v<Real, double>) {
        using functions_detail::Pair;
        // All but the last 11 bits become the fraction of a number from 2^52 on, without leaving the vector registers.
        const auto bits = std::bit_cast<functions_detail::PairBits>(Pair{x, 0.0});
        const auto number = std::bit_cast<Pair>((bits >> 11) | std::bit_cast<std::uint64_t>(0x1p52));
        return number[0] * (0x1p11 * per_bit) - (of_one + 0x1p63 * per_bit);
    } else if constexpr (is_batch<Real>) {
        return xsimd::to_float(xsimd::bitwise_cast<xsimd::batch<std::int64_t>>(x)) * per_bit - of_one;
    } else {
        return log(x);
    }
}
// ln(1 + x), accurate relative to itself, for a normal number 1 + x > 0: what rounding takes from 1 + x is given back.
template <class Real>
LODE_INLINE Real quick_log1p(const Real& x) {
    if constexpr (std::is_same_v<Real, double>) {
        const double u = 1.0 + x, lost = x - (u - 1.0);
        return functions_detail::logarithm(u) + lost / u;
    } else {
        return log1p(x);
    }
}
// x^n of x >= 0; 0 where x < 1e-300.
template <class Real>
LODE_INLINE Real quick_pow(const Real& x, double n) {
    const auto positive = x > Real(1e-300);
    return select(positive, quick_exp(n * quick_log(select(positive, x, Real(1.0)))), Real(0.0));
}

template <class Real>
struct TwoPowers {
    Real first, second;
    Real rough_first, rough_second;  // within 1e-5 where n, m <= 3; the same where nothing is gained by a guess
};
template <class Real>
[[gnu::noinline, gnu::cold]] TwoPowers<Real> powers_apart(Real x, double n, Real y, double m) {
    const Real first = quick_pow(x, n), second = quick_pow(y, m);
    return {first, second, first, second};
}
// x^n and y^m. Side by side where one number leaves registers unused.
template <class Real>
LODE_INLINE TwoPowers<Real> quick_pow(const Real& x, double n, const Real& y, double m) {
#if defined(__FMA__)
    if constexpr (std::is_same_v<Real, double>) {
        using functions_detail::Pair;
        bool usual;
        const auto [exact, rough] = functions_detail::power(Pair{x, y}, Pair{n, m}, usual);
        if (!usual) [[unlikely]]
            return powers_apart(x, n, y, m);
        return {exact[0], exact[1], rough[0], rough[1]};
    }
#endif
    const Real first = quick_pow(x, n), second = quick_pow(y, m);
    return {first, second, first, second};
}

}  // namespace lode
