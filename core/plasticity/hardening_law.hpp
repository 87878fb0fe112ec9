// Isotropic hardening laws k(x) (page 20, section 2): the yield stress as a function of x = alpha or, for a softening
// law, of x = alpha h/LREF. Shared by all plasticity models. Each law is a small struct with k, its slope, the integral
// of k - Y, and the scalar return to the yield surface; `HardeningLaw` holds the one that PROPS ask for.
#pragma once

#include <cmath>

#include "lode/material/properties.hpp"
#include "lode/numerics/root.hpp"

namespace lode {

// k = Y + Ep x; Ep = 0 is perfect plasticity.
struct LinearHardening {
    static constexpr bool softens = false;
    double yield, modulus;

    template <class Real>
    Real flow_stress(const Real& x) const {
        return yield + modulus * x;
    }
    template <class Real>
    Real slope(const Real&) const {
        return Real(modulus);
    }
    template <class Real>
    Real stored_energy(const Real& x) const {
        return 0.5 * modulus * (x * x);
    }
};

// k = max(Y + Ep x, floor), Ep < 0.
struct LinearSoftening {
    static constexpr bool softens = true;
    double yield, modulus, floor, floor_at;

    template <class Real>
    Real flow_stress(const Real& x) const {
        return max(yield + modulus * x, Real(floor));
    }
    template <class Real>
    Real slope(const Real& x) const {
        return select(x < Real(floor_at), Real(modulus), Real(0.0));
    }
    template <class Real>
    Real stored_energy(const Real& x) const {
        const Real sloped = min(x, Real(floor_at));
        return 0.5 * modulus * (sloped * sloped) + (floor - yield) * (x - sloped);
    }
    double steepest_slope() const { return modulus; }
};

// k = Y + Q (1 - exp(-b x)) + H x (Voce), continued straight from `straight_from` on.
struct SaturationHardening {
    static constexpr bool softens = false;
    double yield, range, rate, modulus, straight_from;

    template <class Real>
    Real flow_stress(const Real& x) const {
        const Real bent = min(x, Real(straight_from));
        return yield - range * expm1(-rate * bent) + modulus * bent + straight_slope() * (x - bent);
    }
    template <class Real>
    Real slope(const Real& x) const {
        return range * rate * exp(-rate * min(x, Real(straight_from))) + modulus;
    }
    template <class Real>
    Real stored_energy(const Real& x) const {
        const Real bent = min(x, Real(straight_from)), beyond = x - bent;
        const Real decayed = expm1(-rate * bent);
        return range * bent + (range / rate) * decayed + 0.5 * modulus * (bent * bent) +
               beyond * (modulus * bent - range * decayed + 0.5 * straight_slope() * beyond);
    }
    double straight_slope() const {
        return straight_from < HUGE_VAL ? range * rate * std::exp(-rate * straight_from) + modulus : 0.0;
    }
};

// The same with Q < 0 or H < 0, cut off at `floor`.
struct SaturationSoftening {
    static constexpr bool softens = true;
    SaturationHardening law;
    double floor, floor_at;

    template <class Real>
    Real flow_stress(const Real& x) const {
        return select(x < Real(floor_at), law.flow_stress(x), Real(floor));
    }
    template <class Real>
    Real slope(const Real& x) const {
        return select(x < Real(floor_at), law.slope(x), Real(0.0));
    }
    template <class Real>
    Real stored_energy(const Real& x) const {
        const Real bent = min(x, Real(floor_at));
        return law.stored_energy(bent) + (floor - law.yield) * (x - bent);
    }
    double steepest_slope() const {
        return law.range < 0.0 ? law.slope(0.0) : law.slope(min(law.straight_from, floor_at));
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
                saturation_ = {initial_yield, h(1), h(2), h(3), h(4) > 0.0 ? h(4) : HUGE_VAL};
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

    // Calls f with the law.
    template <class F>
    LODE_INLINE void visit(const F& f) const {
        switch (kind_) {
            case Kind::linear:
                return f(linear_);
            case Kind::linear_softening:
                return f(linear_softening_);
            case Kind::saturation:
                return f(saturation_);
            case Kind::saturation_softening:
                return f(saturation_softening_);
        }
    }

  private:
    enum class Kind { linear, linear_softening, saturation, saturation_softening };

    static double where_it_falls_to(const SaturationHardening& law, double floor) {
        double upper = 1.0 / law.rate;
        while (law.flow_stress(upper) > floor) {
            upper *= 2.0;
            if (upper > 1e12) return HUGE_VAL;
        }
        double lower = 0.0;
        for (int i = 0; i < 200 && upper - lower > 1e-16 * upper; ++i) {
            const double middle = 0.5 * (lower + upper);
            (law.flow_stress(middle) > floor ? lower : upper) = middle;
        }
        return upper;
    }

    Kind kind_ = Kind::linear;
    double yield_;
    LinearHardening linear_{};
    LinearSoftening linear_softening_{};
    SaturationHardening saturation_{};
    SaturationSoftening saturation_softening_{};
};

// Relative to the trial stress (section 1): of the yield test and of the scalar solution.
inline constexpr double yield_tolerance = 1e-13;

// dalpha from q_trial - stiffness dalpha - k(scale (alpha + dalpha)) = 0 in the lanes of `active`, zero elsewhere
// (section 2.6). `stiffness` is 3G in 3D and E in 1D, `flow` is k at the start, `scale` is 1 unless the law softens.
template <class Law, class Real>
LODE_INLINE Real return_to_yield(const Law& law, const Real& q_trial, double stiffness, const Real& alpha,
                                 const Real& scale, const Real& flow, const Mask<Real>& active) {
    const Real excess = q_trial - flow;
    if constexpr (std::is_same_v<Law, LinearHardening>) {
        return select(active, (1.0 / (stiffness + law.modulus)) * excess, Real(0.0));
    } else if constexpr (std::is_same_v<Law, LinearSoftening>) {
        const Real sloped = excess / (stiffness + scale * law.modulus);
        const Real flat = (1.0 / stiffness) * (q_trial - law.floor);
        const auto on_slope = scale * alpha < Real(law.floor_at) && scale * (alpha + sloped) < Real(law.floor_at);
        return select(active, select(on_slope, sloped, flat), Real(0.0));
    } else {
        const auto scaled = [&](const Real& x) { return Law::softens ? scale * x : x; };
        const auto slope = [&](const Real& x) { return scaled(law.slope(x)); };
        const auto residual = [&](const Real& x) {
            const Real total = scaled(alpha + x);
            return Residual<Real>{q_trial - stiffness * x - law.flow_stress(total), -stiffness - slope(total)};
        };
        const Real upper = (1.0 / stiffness) * max(Law::softens ? q_trial : excess, Real(0.0));
        const Real start = excess / (stiffness + slope(scaled(alpha)));
        const Real root = solve_bracketed<Slope::decreasing>(residual, Real(0.0), upper, start,
                                                             Real(yield_tolerance * q_trial), active)
                              .x;
        return select(active, root, Real(0.0));
    }
}

}  // namespace lode
