// Generalised Maxwell elements, the terms of a Prony series, over one reduced time increment (page 60, 1.2 and 1.3).
// Element k with modulus G_k and relaxation time tau_k carries the elastic strain b:
//     b' = e' - b/tau,     b1 = E b0 + A de + B e0,     E = exp(-x),  x = dtr/tau
#pragma once

#include <array>
#include <cstdint>

#include "lode/material/description.hpp"
#include "lode/material/properties.hpp"
#include "lode/numerics/scalar.hpp"

namespace lode {

inline constexpr int most_prony_terms = 30;

// How the recursion integrates the strain within the increment.
enum class Recursion {
    constant_rate,  // exact for a constant strain rate
    midpoint,       // all of the strain in the middle of the increment
    trapezoidal,    // trapezoidal rule of the hereditary integral
    forward_euler   // explicit Maxwell element
};
constexpr lode_parameter recursion_option(int highest, const char* note) {
    return optional("METH", "recursion of the Prony terms", "code", code(0, highest), 0.0, note);
}

// 1 - exp(-x) for x >= 0, of full relative accuracy. No division and no case distinction: unlike a general expm1 it
// hides behind the reciprocal of x, which runs at the same time.
LODE_INLINE Batch relaxed_part(const Batch& x) {
    constexpr double shifter = 0x1.8p52;  // adding it rounds to an integer
    constexpr double ln2_high = 0x1.62e42fefa38p-1, ln2_low = 0x1.ef35793c7673p-45;
    using Integer = xsimd::batch<std::int64_t>;
    // exp(-x) = 2^n exp(r), |r| <= ln(2)/2
    const Batch y = max(-x, Batch(-700.0));
    const Batch shifted = y * 1.4426950408889634074 + shifter, n = shifted - shifter;
    const Batch r = (y - n * ln2_high) - n * ln2_low;
    const Batch scale =
        xsimd::bitwise_cast<Batch>((xsimd::bitwise_cast<Integer>(shifted) << 52) + Integer(1023LL << 52));
    // exp(r) - 1 by its Taylor series, in the order that lets most of it run in parallel
    const Batch r2 = r * r, r4 = r2 * r2;
    const Batch p0 = 1.0 / 2 + r * (1.0 / 6), p1 = 1.0 / 24 + r * (1.0 / 120);
    const Batch p2 = 1.0 / 720 + r * (1.0 / 5040), p3 = 1.0 / 40320 + r * (1.0 / 362880);
    const Batch p4 = 1.0 / 3628800 + r * (1.0 / 39916800), p5 = Batch(1.0 / 479001600);
    const Batch p = r + r2 * ((p0 + r2 * p1) + r4 * ((p2 + r2 * p3) + r4 * (p4 + r2 * p5)));
    return (1.0 - scale) - scale * p;
}

// The coefficients of elements, with u = 1 - E, and of what they dissipate:
//     int b:b dy = a11 b0:b0 + 2 a12 b0:de + a22 de:de,     y = t/tau, exact for a constant strain rate
// One to a lane.
struct ElementStep {
    Batch u, A, B;
    Batch a11, twice_a12, a22;

    // For x >= 0.
    LODE_INLINE ElementStep(Recursion recursion, const Batch& ratio) {
        const Batch x = max(ratio, Batch(1e-200)), inverse = 1.0 / x;
        // With h = 1 - exp(-x/2): u = h (2 - h). One exponential serves every choice.
        const Batch h = relaxed_part(0.5 * x), one(1.0);
        u = h * (2.0 - h);
        const Batch rate = u * inverse;  // (1 - E)/x
        A = rate;
        B = Batch(0.0);
        a11 = 0.5 * u * (2.0 - u);
        twice_a12 = u * rate;
        // (x - u - u^2/2)/x^2, whose terms cancel for small x
        const Batch x2 = x * x;
        const Batch series = x * (((1.0 / 3 - x * (1.0 / 4)) + x2 * (7.0 / 60 - x * (1.0 / 24))) +
                                  x2 * x2 * ((31.0 / 2520 - x * (1.0 / 320)) + x2 * (127.0 / 181440)));
        a22 = select(x < Batch(0.04), series, (1.0 - rate - 0.5 * u * rate) * inverse);
        if (recursion == Recursion::constant_rate) return;

        if (recursion == Recursion::midpoint) {
            A = 1.0 - h;
            return;
        }
        // These two lose their sense for long increments, x > 1: the element is then integrated like the first one.
        const Mask<Batch> is_short = x <= one;
        if (recursion == Recursion::trapezoidal) {
            B = select(is_short, u - 0.5 * x * (2.0 - u), B);
            A = select(is_short, 1.0 - 0.5 * x, A);
        } else {
            u = select(is_short, x, u);
            A = select(is_short, one, A);
        }
    }
};

// The constants of a series. The arrays are padded, so that vectors of any width can be loaded.
struct PronySeries {
    static constexpr int room = 32;
    static_assert(room >= most_prony_terms && room % batch_lanes == 0);

    int count = 0;
    alignas(64) std::array<double, room> modulus{}, inverse_time{};
    double sum = 0.0;  // of the moduli

    PronySeries() = default;
    // `count` pairs of modulus and relaxation time from PROPS(first) on; the moduli are multiplied by `unit`.
    PronySeries(const Properties& p, int terms, int first, double unit = 1.0) : count(terms) {
        inverse_time.fill(1.0);
        for (int k = 0; k < terms; ++k) {
            modulus[static_cast<std::size_t>(k)] = unit * p[first + 2 * k];
            inverse_time[static_cast<std::size_t>(k)] = 1.0 / p[first + 2 * k + 1];
            sum += modulus[static_cast<std::size_t>(k)];
        }
    }
    LODE_INLINE double G(int k) const { return modulus[static_cast<std::size_t>(k)]; }
};

// What a whole series needs of an increment. X is double where all points share the reduced time increment, else Batch.
template <class X>
struct PronyStep {
    X driven = X(0.0);       // sum of G_k A_k
    X dissipated = X(0.0);   // sum of G_k a22_k
    X u[PronySeries::room];  // of each element; not set beyond the last one
    X A[PronySeries::room], B[PronySeries::room];
    X a11[PronySeries::room], twice_a12[PronySeries::room];  // times G_k

    LODE_INLINE PronyStep(const PronySeries& series, Recursion recursion, const X& dtr) {
        if constexpr (is_batch<X>) {
            for (int k = 0; k < series.count; ++k)
                set(k, series.G(k), ElementStep(recursion, dtr * series.inverse_time[static_cast<std::size_t>(k)]));
        } else {
            // One vector of elements at a time. Nearly all series fill no more than the first one: what a loop would
            // set up is then more than what it does.
            if (series.count == 0) return;
            Sums sums{Batch(0.0), Batch(0.0)};
            add(series, recursion, dtr, 0, sums);
            if (series.count > batch_lanes) [[unlikely]]
                sums = add_rest(series, recursion, dtr, sums);
            driven = xsimd::hadd(sums.driven);
            dissipated = xsimd::hadd(sums.dissipated);
        }
    }

  private:
    struct Sums {
        Batch driven, dissipated;
    };
    LODE_INLINE void add(const PronySeries& series, Recursion recursion, double dtr, int k, Sums& sums) {
        const Batch G = Batch::load_aligned(series.modulus.data() + k);
        const ElementStep s(recursion, dtr * Batch::load_aligned(series.inverse_time.data() + k));
        s.u.store_unaligned(u + k);
        s.A.store_unaligned(A + k);
        if (recursion == Recursion::trapezoidal) s.B.store_unaligned(B + k);
        (G * s.a11).store_unaligned(a11 + k);
        (G * s.twice_a12).store_unaligned(twice_a12 + k);
        sums.driven = sums.driven + G * s.A;
        sums.dissipated = sums.dissipated + G * s.a22;
    }
    [[gnu::noinline]] Sums add_rest(const PronySeries& series, Recursion recursion, double dtr, Sums sums) {
        for (int k = batch_lanes; k < series.count; k += batch_lanes) add(series, recursion, dtr, k, sums);
        return sums;
    }

    LODE_INLINE void set(int k, double G, const ElementStep& s) {
        u[k] = s.u, A[k] = s.A, B[k] = s.B;
        a11[k] = G * s.a11, twice_a12[k] = G * s.twice_a12;
        driven = driven + G * s.A;
        dissipated = dissipated + G * s.a22;
    }
};

}  // namespace lode
