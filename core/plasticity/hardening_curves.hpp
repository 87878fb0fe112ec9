// Hardening curves k(x) (page 20, section 2): the yield stress as a function of x = alpha or, for a softening law, of
// x = alpha h/LREF, free of rate and temperature. Each is a small struct with k, its slope and curvature, and the
// integral of k - Y.
#pragma once

#include <variant>

#include "lode/numerics/functions.hpp"

namespace lode {

// k, dk/dx and d2k/dx2.
template <class Real>
struct FlowStress {
    Real value, slope, curvature;
};

namespace hardening_detail {

// Mean of (1 + t)^n over t in [0, z], given (1 + z)^n; by its series where the difference would cancel.
template <class Real>
LODE_INLINE Real mean_power(const Real& z, double n, const Real& power) {
    const Real series = 1.0 + z * (n / 2 + z * (n * (n - 1) / 6 + z * (n * (n - 1) * (n - 2) / 24 +
                                                                       z * (n * (n - 1) * (n - 2) * (n - 3) / 120))));
    const auto is_short = abs(z) < Real(1e-3);
    if (all(is_short)) return series;
    const Real length = select(is_short, Real(1.0), z);
    if (n == -1.0) return select(is_short, series, log1p(length) / length);
    return select(is_short, series, (power * (1.0 + length) - 1.0) / ((n + 1.0) * length));
}

// z - 1 + exp(-z).
struct DecayRemainder {
    // Up to z = 1/16.
    template <class Real>
    LODE_INLINE static Real short_series(const Real& z) {
        const Real z2 = z * z;
        return z2 * first_terms(z, z2, z2 * z2);
    }
    // Up to z = 1/2.
    template <class Real>
    LODE_INLINE static Real series(const Real& z) {
        const Real z2 = z * z, z4 = z2 * z2;
        const Real p4 = 1.0 / 3628800 - z * (1.0 / 39916800), p5 = 1.0 / 479001600 - z * (1.0 / 6227020800);
        const double p6 = 1.0 / 87178291200;
        return z2 * (first_terms(z, z2, z4) + (z4 * z4) * (p4 + z2 * p5 + z4 * p6));
    }
    template <class Real>
    LODE_INLINE static Real of(const Real& z) {
        const auto is_short = abs(z) < Real(0.5);
        const Real near = series(z);
        if (all(is_short)) [[likely]]
            return near;
        return select(is_short, near, z + quick_expm1(-z));
    }

  private:
    template <class Real>
    LODE_INLINE static Real first_terms(const Real& z, const Real& z2, const Real& z4) {
        const Real p0 = 1.0 / 2 - z * (1.0 / 6), p1 = 1.0 / 24 - z * (1.0 / 120);
        const Real p2 = 1.0 / 720 - z * (1.0 / 5040), p3 = 1.0 / 40320 - z * (1.0 / 362880);
        return (p0 + z2 * p1) + z4 * (p2 + z2 * p3);
    }
};

}  // namespace hardening_detail

// k = Y + Ep x; Ep = 0 is perfect plasticity.
struct LinearHardening {
    static constexpr bool softens = false;
    double yield, modulus;

    double initial_yield() const { return yield; }
    template <class Real>
    LODE_INLINE FlowStress<Real> flow_stress(const Real& x) const {
        return {yield + modulus * x, Real(modulus), Real(0.0)};
    }
    // Integral of k - Y from x to x + dx, given k at both ends.
    template <class Real>
    LODE_INLINE Real stored_energy(const Real&, const Real& dx, const FlowStress<Real>& k,
                                   const FlowStress<Real>& k_end) const {
        return (0.5 * (k.value + k_end.value) - yield) * dx;
    }
};

// k = max(Y + Ep x, floor), Ep < 0.
struct LinearSoftening {
    static constexpr bool softens = true;
    double yield, modulus, floor, floor_at;

    double initial_yield() const { return yield; }
    template <class Real>
    LODE_INLINE FlowStress<Real> flow_stress(const Real& x) const {
        return {max(yield + modulus * x, Real(floor)), select(x < Real(floor_at), Real(modulus), Real(0.0)), Real(0.0)};
    }
    template <class Real>
    LODE_INLINE Real stored_energy(const Real& x, const Real& dx, const FlowStress<Real>&,
                                   const FlowStress<Real>&) const {
        const Real from = min(x, Real(floor_at)), to = min(x + dx, Real(floor_at));
        return 0.5 * modulus * ((to + from) * (to - from)) + (floor - yield) * (dx - (to - from));
    }
    double steepest_slope() const { return modulus; }
};

// k = Y (1 + b x)^n, eq. 2.68. With b n < 0 only under a Floored.
struct NonlinearHardening {
    static constexpr bool softens = false;
    double yield, rate, exponent;

    double initial_yield() const { return yield; }
    template <class Real>
    LODE_INLINE FlowStress<Real> flow_stress(const Real& x) const {
        const Real base = max(1.0 + rate * x, Real(1e-30)), per_base = rate / base;
        const Real k = yield * quick_pow(base, exponent);
        const Real slope = exponent * k * per_base;
        return {k, slope, (exponent - 1.0) * slope * per_base};
    }
    template <class Real>
    LODE_INLINE Real stored_energy(const Real& x, const Real& dx, const FlowStress<Real>& k,
                                   const FlowStress<Real>& k_end) const {
        const Real z = rate * dx / max(1.0 + rate * x, Real(1e-30));
        const Real power = k_end.value / max(k.value, Real(1e-300));
        return dx * (k.value * hardening_detail::mean_power(z, exponent, power) - yield);
    }
    double falls_to(double floor) const { return (std::pow(floor / yield, 1.0 / exponent) - 1.0) / rate; }
};

// k = Y (1 + b x^n), eq. 2.72. With b < 0 only under a Floored.
struct PowerHardening {
    static constexpr bool softens = false;
    static constexpr double smallest = 1e-90;  // below which the slope is not followed
    double yield, factor, exponent;            // factor: Y b

    double initial_yield() const { return yield; }
    template <class Real>
    LODE_INLINE FlowStress<Real> flow_stress(const Real& x) const {
        // The slope at 0 is infinite for n < 1: a large number stands for it.
        const Real base = max(x, Real(smallest)), per_base = 1.0 / base;
        Real rise = factor * quick_pow(base, exponent);
        const Real slope = exponent * rise * per_base;
        const auto tiny = x < Real(smallest);
        if (any(tiny)) rise = select(tiny, factor * quick_pow(x, exponent), rise);
        return {yield + rise, slope, (exponent - 1.0) * slope * per_base};
    }
    template <class Real>
    LODE_INLINE Real stored_energy(const Real& x, const Real& dx, const FlowStress<Real>& k,
                                   const FlowStress<Real>& k_end) const {
        return integral(exponent, x, dx, k.value - yield, k_end.value - yield);
    }
    // Of what rises with x^n from `rise` to `rise_end`.
    template <class Real>
    LODE_INLINE static Real integral(double exponent, const Real& x, const Real& dx, const Real& rise,
                                     const Real& rise_end) {
        const Real whole = (rise_end * (x + dx) - rise * x) * (1.0 / (exponent + 1.0));
        const auto is_short = dx < 1e-3 * x;
        if (!any(is_short)) return whole;
        const Real z = select(is_short, dx / select(is_short, x, Real(1.0)), Real(0.0));
        return select(is_short, dx * rise * hardening_detail::mean_power(z, exponent, Real(1.0)), whole);
    }
    double falls_to(double floor) const { return std::pow((floor - yield) / factor, 1.0 / exponent); }
};

// k = Y + Q (1 - exp(-b x)) + H x (Voce), continued straight from `straight_from` on.
struct SaturationHardening {
    static constexpr bool softens = false;
    double yield, range, rate, modulus, straight_from;
    double straight_slope, inverse_rate;

    SaturationHardening(double y, double q, double b, double h, double alpha_max)
        : yield(y),
          range(q),
          rate(b),
          modulus(h),
          straight_from(alpha_max),
          straight_slope(alpha_max < HUGE_VAL ? q * b * std::exp(-b * alpha_max) + h : 0.0),
          inverse_rate(1.0 / b) {}

    double initial_yield() const { return yield; }
    template <class Real>
    LODE_INLINE FlowStress<Real> flow_stress(const Real& x) const {
        const Real bent = min(x, Real(straight_from));
        const Real decayed = quick_expm1(-rate * bent);
        const Real bend = range * rate * (1.0 + decayed);
        FlowStress<Real> k{(yield + modulus * bent) - range * decayed, bend + modulus, -rate * bend};
        if (straight_from < HUGE_VAL) {
            k.value = k.value + straight_slope * (x - bent);
            k.curvature = select(x < Real(straight_from), k.curvature, Real(0.0));
        }
        return k;
    }
    // The mean of both ends with Euler and Maclaurin's corrections, of which each is z^2, z = b dx, times the one
    // before. Where z is not small: with u = Q exp(-b x), k = k(x) + u (1 - exp(-z)) + H dx.
    template <class Real>
    LODE_INLINE Real stored_energy(const Real& x, const Real& dx, const FlowStress<Real>& k,
                                   const FlowStress<Real>& k_end) const {
        if (straight_from < HUGE_VAL) return stored_energy(x + dx) - stored_energy(x);
        const Real z = rate * dx, z2 = z * z;
        const Real corrections = 1.0 / 12 - z2 * (1.0 / 720 - z2 * (1.0 / 30240));
        const Real near = dx * ((0.5 * (k.value + k_end.value) - yield) + dx * ((k.slope - k_end.slope) * corrections));
        const auto is_near = z < Real(1.0 / 16);
        if (all(is_near)) [[likely]]
            return near;
        const Real u_over_rate = (k.slope - modulus) * (inverse_rate * inverse_rate);
        const Real remainder = u_over_rate * hardening_detail::DecayRemainder::of(z);
        return select(is_near, near, dx * (k.value - yield + 0.5 * modulus * dx) + remainder);
    }
    double falls_to(double floor) const {
        double upper = 1.0 / rate;
        while (flow_stress(upper).value > floor) {
            upper *= 2.0;
            if (upper > 1e12) return HUGE_VAL;
        }
        double lower = 0.0;
        for (int i = 0; i < 200 && upper - lower > 1e-16 * upper; ++i) {
            const double middle = 0.5 * (lower + upper);
            (flow_stress(middle).value > floor ? lower : upper) = middle;
        }
        return upper;
    }

  private:
    // From 0 to x.
    template <class Real>
    Real stored_energy(Real x) const {
        const Real bent = min(x, Real(straight_from)), beyond = x - bent;
        const Real decayed = quick_expm1(-rate * bent);
        return range * bent + inverse_rate * range * decayed + 0.5 * modulus * (bent * bent) +
               beyond * (modulus * bent - range * decayed + 0.5 * straight_slope * beyond);
    }
};

// One of several curves, chosen at run time: those whose powers cost more than a call share the code around them.
template <class... Curves>
class AnyCurve {
  public:
    static constexpr bool softens = false;

    template <class Curve>
    explicit AnyCurve(const Curve& curve) : yield(curve.yield), curve_(curve) {}

    double initial_yield() const { return yield; }
    // Everything by value: a reference would keep the point in memory.
    template <class Real>
    [[gnu::noinline]] FlowStress<Real> flow_stress(Real x) const {
        return std::visit([&](const auto& curve) { return curve.flow_stress(x); }, curve_);
    }
    template <class Real>
    [[gnu::noinline]] Real stored_energy(Real x, Real dx, FlowStress<Real> k, FlowStress<Real> k_end) const {
        return std::visit([&](const auto& curve) { return curve.stored_energy(x, dx, k, k_end); }, curve_);
    }

    double yield;

  private:
    std::variant<Curves...> curve_;
};
using PowerLaw = AnyCurve<NonlinearHardening, PowerHardening>;
using FallingCurve = AnyCurve<NonlinearHardening, PowerHardening, SaturationHardening>;

// A curve that falls, cut off at `floor`.
template <class Curve>
struct Floored {
    static constexpr bool softens = true;
    Curve law;
    double floor, floor_at;

    double initial_yield() const { return law.yield; }
    template <class Real>
    LODE_INLINE FlowStress<Real> flow_stress(const Real& x) const {
        const FlowStress<Real> k = law.flow_stress(min(x, Real(floor_at)));
        const auto above_floor = x < Real(floor_at);
        return {select(above_floor, k.value, Real(floor)), select(above_floor, k.slope, Real(0.0)),
                select(above_floor, k.curvature, Real(0.0))};
    }
    template <class Real>
    LODE_INLINE Real stored_energy(const Real& x, const Real& dx, const FlowStress<Real>&,
                                   const FlowStress<Real>&) const {
        const Real from = min(x, Real(floor_at)), to = min(x + dx, Real(floor_at));
        const Real stored = law.stored_energy(from, to - from, law.flow_stress(from), law.flow_stress(to));
        return stored + (floor - law.yield) * (dx - (to - from));
    }
    // The slopes of these curves are monotone.
    double steepest_slope() const {
        return min(law.flow_stress(0.0).slope, law.flow_stress(min(floor_at, 1e300)).slope);
    }
};

// The same curve with its floor, its kind left to run time.
template <class Curve>
Floored<FallingCurve> any_falling(const Floored<Curve>& curve) {
    return {FallingCurve(curve.law), curve.floor, curve.floor_at};
}

}  // namespace lode
