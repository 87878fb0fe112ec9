// Isotropic hardening laws k(x) (page 20, section 2): the yield stress as a function of x = alpha or, for a softening
// law, of x = alpha h/LREF. Shared by all plasticity models. Each law is a small struct with k, its slope and the
// integral of k - Y; `HardeningLaw` holds the one that PROPS ask for.
#pragma once

#include <cmath>

#include "lode/material/properties.hpp"
#include "lode/numerics/root.hpp"

namespace lode {

// k, dk/dx and d2k/dx2.
template <class Real>
struct FlowStress {
    Real value, slope, curvature;
};

// k = Y + Ep x; Ep = 0 is perfect plasticity.
struct LinearHardening {
    static constexpr bool softens = false;
    double yield, modulus;

    template <class Real>
    LODE_INLINE FlowStress<Real> flow_stress(const Real& x) const {
        return {yield + modulus * x, Real(modulus), Real(0.0)};
    }
    // Integral of k - Y from x to x + dx, given k at both ends.
    template <class Real>
    LODE_INLINE Real stored_energy(const Real&, const Real& dx, const Real& k, const Real& k_end) const {
        return (0.5 * (k + k_end) - yield) * dx;
    }
};

// k = max(Y + Ep x, floor), Ep < 0.
struct LinearSoftening {
    static constexpr bool softens = true;
    double yield, modulus, floor, floor_at;

    template <class Real>
    LODE_INLINE FlowStress<Real> flow_stress(const Real& x) const {
        return {max(yield + modulus * x, Real(floor)), select(x < Real(floor_at), Real(modulus), Real(0.0)), Real(0.0)};
    }
    template <class Real>
    LODE_INLINE Real stored_energy(const Real& x, const Real& dx, const Real&, const Real&) const {
        const Real from = min(x, Real(floor_at)), to = min(x + dx, Real(floor_at));
        return 0.5 * modulus * ((to + from) * (to - from)) + (floor - yield) * (dx - (to - from));
    }
    double steepest_slope() const { return modulus; }
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

    template <class Real>
    LODE_INLINE FlowStress<Real> flow_stress(const Real& x) const {
        const Real bent = min(x, Real(straight_from));
        const Real decayed = expm1(-rate * bent);
        const Real slope = range * rate * (1.0 + decayed);
        return {yield - range * decayed + modulus * bent + straight_slope * (x - bent), slope + modulus, -rate * slope};
    }
    // k at x + dx by its Taylor series about x, exact to rounding where `extrapolates`.
    template <class Real>
    LODE_INLINE FlowStress<Real> extrapolated(const FlowStress<Real>& k, const Real& dx) const {
        const Real bend = -rate * k.curvature;
        return {k.value + dx * (k.slope + dx * (0.5 * k.curvature + dx * ((1.0 / 6.0) * bend))),
                k.slope + dx * (k.curvature + dx * (0.5 * bend)), k.curvature + dx * bend};
    }
    template <class Real>
    LODE_INLINE Mask<Real> extrapolates(const Real& x, const Real& dx) const {
        return abs(rate * dx) < Real(1e-4) && max(x, x + dx) < Real(straight_from);
    }
    template <class Real>
    LODE_INLINE Real stored_energy(const Real& x, const Real& dx, const Real& k, const Real& k_end) const {
        if (straight_from < HUGE_VAL) return stored_energy(x + dx) - stored_energy(x);
        return range * dx - inverse_rate * (k_end - k - modulus * dx) + modulus * dx * (x + 0.5 * dx);
    }

  private:
    // From 0 to x.
    template <class Real>
    Real stored_energy(const Real& x) const {
        const Real bent = min(x, Real(straight_from)), beyond = x - bent;
        const Real decayed = expm1(-rate * bent);
        return range * bent + inverse_rate * range * decayed + 0.5 * modulus * (bent * bent) +
               beyond * (modulus * bent - range * decayed + 0.5 * straight_slope * beyond);
    }
};

// The same with Q < 0 or H < 0, cut off at `floor`.
struct SaturationSoftening {
    static constexpr bool softens = true;
    SaturationHardening law;
    double floor, floor_at;

    template <class Real>
    LODE_INLINE FlowStress<Real> flow_stress(const Real& x) const {
        const FlowStress<Real> k = law.flow_stress(x);
        const auto above_floor = x < Real(floor_at);
        return {select(above_floor, k.value, Real(floor)), select(above_floor, k.slope, Real(0.0)),
                select(above_floor, k.curvature, Real(0.0))};
    }
    template <class Real>
    LODE_INLINE Real stored_energy(const Real& x, const Real& dx, const Real& k, const Real& k_end) const {
        const Real from = min(x, Real(floor_at)), to = min(x + dx, Real(floor_at));
        const auto ends_above = to < Real(floor_at);
        const Real falls_to = select(ends_above, k_end, law.flow_stress(to).value);
        const Real falls_from = select(ends_above, k, law.flow_stress(from).value);
        return law.stored_energy(from, to - from, falls_from, falls_to) + (floor - law.yield) * (dx - (to - from));
    }
    double steepest_slope() const {
        return law.flow_stress(law.range < 0.0 ? 0.0 : min(law.straight_from, floor_at)).slope;
    }
};

class HardeningLaw {
  public:
    // `law` and `first_constant` are the 1-based PROPS indices of HLAW and H1. Throws BadProperty.
    HardeningLaw(const Properties& p, double initial_yield, int law, int first_constant) : yield_(initial_yield) {
        const auto h = [&](int i) { return p[first_constant + i - 1]; };
        const auto need_constants = [&](int number) {
            if (p.count() < first_constant + number - 1)
                p.refuse("HLAW = " + std::to_string(p.code(law)) + " needs NPROPS >= " +
                         std::to_string(first_constant + number - 1) + ", NPROPS = " + std::to_string(p.count()));
        };
        const auto floor = [&](int i) {
            if (h(i) < 0.0 || h(i) > initial_yield)
                p.refuse(first_constant + i - 1,
                         "the floor of the yield stress, in [0, " + format_number(initial_yield) + "]");
            return h(i);
        };
        switch (p.code(law)) {
            case 0:
                kind_ = Kind::linear;
                linear_ = {initial_yield, 0.0};
                break;
            case 1:
                need_constants(1);
                kind_ = h(1) < 0.0 ? Kind::linear_softening : Kind::linear;
                linear_ = {initial_yield, h(1)};
                linear_softening_ = {initial_yield, h(1), floor(2), (floor(2) - initial_yield) / h(1)};
                break;
            case 8:
                need_constants(2);
                if (h(2) <= 0.0) p.refuse(first_constant + 1, "> 0");
                if (h(1) < 0.0 && h(3) > 0.0)
                    p.refuse(first_constant + 2, "<= 0 where the saturation range is negative");
                saturation_ = SaturationHardening(initial_yield, h(1), h(2), h(3), h(4) > 0.0 ? h(4) : HUGE_VAL);
                kind_ = h(1) < 0.0 || h(3) < 0.0 ? Kind::saturation_softening : Kind::saturation;
                if (is_softening())
                    saturation_softening_ = {saturation_, floor(5), where_it_falls_to(saturation_, floor(5))};
                break;
            default:
                p.refuse(law, "one of the laws 0, 1, 8");
        }
    }

    bool is_softening() const { return kind_ == Kind::linear_softening || kind_ == Kind::saturation_softening; }
    double initial_yield() const { return yield_; }

    // f(law).
    template <class Result, class F>
    Result visit(const F& f) const {
        switch (kind_) {
            case Kind::linear:
                return f(linear_);
            case Kind::linear_softening:
                return f(linear_softening_);
            case Kind::saturation:
                return f(saturation_);
            default:
                return f(saturation_softening_);
        }
    }

  private:
    enum class Kind { linear, linear_softening, saturation, saturation_softening };

    static double where_it_falls_to(const SaturationHardening& law, double floor) {
        double upper = 1.0 / law.rate;
        while (law.flow_stress(upper).value > floor) {
            upper *= 2.0;
            if (upper > 1e12) return HUGE_VAL;
        }
        double lower = 0.0;
        for (int i = 0; i < 200 && upper - lower > 1e-16 * upper; ++i) {
            const double middle = 0.5 * (lower + upper);
            (law.flow_stress(middle).value > floor ? lower : upper) = middle;
        }
        return upper;
    }

    Kind kind_ = Kind::linear;
    double yield_;
    LinearHardening linear_{};
    LinearSoftening linear_softening_{};
    SaturationHardening saturation_{0.0, 0.0, 1.0, 0.0, HUGE_VAL};
    SaturationSoftening saturation_softening_{saturation_, 0.0, 0.0};
};

// Residual of the scalar solution, relative to the trial stress (section 1).
inline constexpr double return_tolerance = 1e-13;
// Of the yield test, relative. Wider, so that a point just returned to the surface answers a zero increment
// elastically.
inline constexpr double yield_tolerance = 1e-11;

// The scalar return of section 2.6 along a line on which q falls with `stiffness` (3G in 3D, E in 1D):
// dalpha from q_trial - stiffness dalpha = k(scale (alpha + dalpha)); `scale` is 1 unless the law softens.
template <class Law>
class ReturnToYield {
  public:
    template <class Real>
    struct Result {
        Real dalpha;
        FlowStress<Real> flow;  // at the end
    };

    ReturnToYield(const Law& law, double stiffness)
        : law_(law), stiffness_(stiffness), inverse_stiffness_(1.0 / stiffness) {
        if constexpr (std::is_same_v<Law, LinearHardening>) compliance_ = 1.0 / (stiffness + law.modulus);
    }

    // The lanes of `yields`; `flow` is that of the start. The other lanes hold numbers without meaning.
    template <class Real>
    LODE_INLINE Result<Real> operator()(const Real& q_trial, const Real& alpha, const Real& scale,
                                        const FlowStress<Real>& flow, const Mask<Real>& yields) const {
        const Real excess = q_trial - flow.value;
        if constexpr (std::is_same_v<Law, LinearHardening>) {
            const Real dalpha = compliance_ * excess;
            return {dalpha, {flow.value + law_.modulus * dalpha, flow.slope, flow.curvature}};
        } else if constexpr (std::is_same_v<Law, LinearSoftening>) {
            const Real sloped = excess / (stiffness_ + scale * law_.modulus);
            const Real flat = inverse_stiffness_ * (q_trial - law_.floor);
            const auto on_slope = scale * alpha < Real(law_.floor_at) && scale * (alpha + sloped) < Real(law_.floor_at);
            const Real dalpha = select(on_slope, sloped, flat);
            return {dalpha, at(law_, alpha + dalpha, scale)};
        } else {
            // Everything by value: a reference would keep the point in memory.
            const auto residual = [q_trial, alpha, scale, law = law_, stiffness = stiffness_](const Real& x) {
                const FlowStress<Real> k = at(law, alpha + x, scale);
                return Trial<Real>{q_trial - stiffness * x - k.value, -stiffness - k.slope, -k.curvature, k};
            };
            const Real upper = inverse_stiffness_ * max(Law::softens ? q_trial : excess, Real(0.0));
            const Real tolerance = return_tolerance * q_trial;
            const Real compliance = 1.0 / (stiffness_ + flow.slope);
            Real start = excess * compliance;
            if constexpr (std::is_same_v<Law, SaturationHardening> && !is_differentiated<Real>) {
                // One step of third order from a start of second order is mostly so short that the series tells k at
                // its end: one exponential in all.
                start = start - 0.5 * flow.curvature * (start * start) * compliance;
                const auto at_start = residual(start);
                const Real x = root_detail::newton_iterate(start, at_start);
                const FlowStress<Real> k = law_.extrapolated(at_start.flow, x - start);
                const auto solved = yields && law_.extrapolates(alpha + start, x - start) &&
                                    abs(q_trial - stiffness_ * x - k.value) <= tolerance;
                if (all(solved || !yields)) [[likely]]
                    return {x, k};
                const auto root = solve_bracketed<Slope::decreasing>(residual, Real(0.0), upper, start, tolerance,
                                                                     Mask<Real>(yields && !solved));
                const auto& other = root.last.flow;
                return {select(solved, x, root.x),
                        {select(solved, k.value, other.value), select(solved, k.slope, other.slope),
                         select(solved, k.curvature, other.curvature)}};
            } else {
                const auto root =
                    solve_bracketed<Slope::decreasing>(residual, Real(0.0), upper, start, tolerance, yields);
                return {root.x, root.last.flow};
            }
        }
    }

    // stiffness/(stiffness + H), H = dk/dalpha: how much of a change of q_trial the elastic strain does not take.
    LODE_INLINE double plastic_share(double H) const {
        if constexpr (std::is_same_v<Law, LinearHardening>) return stiffness_ * compliance_;
        else return stiffness_ / (stiffness_ + H);
    }

    // k and dk/dalpha.
    template <class Real>
    LODE_INLINE static FlowStress<Real> at(const Law& law, const Real& alpha, const Real& scale) {
        if constexpr (!Law::softens) {
            return law.flow_stress(alpha);
        } else {
            const FlowStress<Real> k = law.flow_stress(scale * alpha);
            return {k.value, scale * k.slope, scale * scale * k.curvature};
        }
    }

  private:
    template <class Real>
    struct Trial {
        Real value, slope, curvature;
        FlowStress<Real> flow;
    };

    Law law_;
    double stiffness_, inverse_stiffness_;
    double compliance_ = 0.0;  // 1/(stiffness + H) of a straight law
};

}  // namespace lode
