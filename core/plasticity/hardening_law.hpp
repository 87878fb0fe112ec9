// Isotropic hardening laws k(x) (page 20, section 2), x = alpha or, for a softening law, alpha h/LREF. Shared by all
// plasticity models. `numbers` of the laws are those of the page.
#pragma once

#include <cmath>

#include "lode/material/properties.hpp"
#include "lode/numerics/root.hpp"

namespace lode {

class HardeningLaw {
  public:
    enum class Kind { perfect = 0, linear = 1, saturation = 8 };

    HardeningLaw() = default;
    // `law` and `first_constant` are the 1-based PROPS indices of HLAW and H1. Throws BadProperty.
    HardeningLaw(const Properties& p, double initial_yield, int law, int first_constant)
        : kind_(static_cast<Kind>(p.code(law))), yield_(initial_yield) {
        const auto h = [&](int i) { return p[first_constant + i - 1]; };
        switch (kind_) {
            case Kind::perfect:
                floor_ = initial_yield;
                break;
            case Kind::linear:
                need_constants(p, law, first_constant, 1);
                modulus_ = h(1);
                set_floor(p, first_constant + 1);
                softening_ = modulus_ < 0.0;
                if (softening_) floor_at_ = (floor_ - yield_) / modulus_;
                break;
            case Kind::saturation:
                need_constants(p, law, first_constant, 2);
                range_ = h(1);
                rate_ = h(2);
                modulus_ = h(3);
                straight_from_ = h(4) > 0.0 ? h(4) : HUGE_VAL;
                if (rate_ <= 0.0) p.refuse(first_constant + 1, "> 0");
                set_floor(p, first_constant + 4);
                softening_ = range_ < 0.0 || modulus_ < 0.0;
                if (range_ < 0.0 && modulus_ > 0.0)
                    p.refuse(first_constant + 2, "<= 0 where the saturation range is negative");
                if (softening_) floor_at_ = find_floor();
                break;
            default:
                p.refuse(law, "one of the laws 0, 1, 8");
        }
    }

    bool is_softening() const { return softening_; }
    bool is_closed_form() const { return kind_ != Kind::saturation; }
    double initial_yield() const { return yield_; }
    // The most negative slope dk/dx.
    double steepest_slope() const {
        if (!softening_) return 0.0;
        if (kind_ == Kind::linear) return modulus_;
        return range_ < 0.0 ? range_ * rate_ + modulus_ : saturation_slope(min(straight_from_, floor_at_));
    }

    // k, dk/dx, and the integral of k - Y from 0 to x.
    template <class Real>
    Real flow_stress(const Real& x) const {
        if (kind_ == Kind::perfect) return Real(yield_);
        if (kind_ == Kind::linear) return floored(x, yield_ + modulus_ * x, Real(floor_));
        const Real bent = min(x, Real(straight_from_));
        Real k = yield_ - range_ * expm1(-rate_ * bent) + modulus_ * bent;
        if (std::isfinite(straight_from_)) k = k + tail_slope() * (x - bent);
        return floored(x, k, Real(floor_));
    }
    template <class Real>
    Real slope(const Real& x) const {
        if (kind_ == Kind::perfect) return Real(0.0);
        if (kind_ == Kind::linear) return floored(x, Real(modulus_), Real(0.0));
        const Real bent = min(x, Real(straight_from_));
        return floored(x, range_ * rate_ * exp(-rate_ * bent) + modulus_, Real(0.0));
    }
    template <class Real>
    Real stored_energy(const Real& x) const {
        if (kind_ == Kind::perfect) return Real(0.0);
        const Real hard = softening_ ? min(x, Real(floor_at_)) : x;
        Real a;
        if (kind_ == Kind::linear) {
            a = 0.5 * modulus_ * hard * hard;
        } else {
            const Real bent = min(hard, Real(straight_from_));
            a = range_ * bent + (range_ / rate_) * expm1(-rate_ * bent) + 0.5 * modulus_ * bent * bent;
            if (std::isfinite(straight_from_)) {
                const Real beyond = hard - bent;
                a = a + beyond * (modulus_ * bent - range_ * expm1(-rate_ * bent) + 0.5 * tail_slope() * beyond);
            }
        }
        return softening_ ? a + (floor_ - yield_) * (x - hard) : a;
    }

    // dalpha from q_trial - stiffness dalpha - k(scale (alpha + dalpha)) = 0 in the lanes of `active`, zero elsewhere
    // (section 2.6). `stiffness` is 3G in 3D and E in 1D, `flow` is k at alpha.
    template <class Real>
    Real return_to_yield(const Real& trial, double stiffness, const Real& alpha, const Real& scale, const Real& flow,
                         const Mask<Real>& active) const {
        if (is_closed_form()) {
            const Real excess = trial - flow;
            if (kind_ == Kind::perfect) return select(active, excess * (1.0 / stiffness), Real(0.0));
            Real increment = excess / (stiffness + scale * modulus_);
            if (softening_)
                increment = select(scale * (alpha + increment) < Real(floor_at_), increment,
                                   (trial - floor_) * (1.0 / stiffness));
            return select(active, increment, Real(0.0));
        }
        const auto residual = [&](const Real& x) {
            const Real total = scale * (alpha + x);
            return Residual<Real>{trial - stiffness * x - flow_stress(total), -stiffness - scale * slope(total)};
        };
        const Real upper = (softening_ ? trial : trial - flow) * (1.0 / stiffness);
        const Real start = (trial - flow) / (stiffness + scale * slope(scale * alpha));
        const Real root = solve_bracketed<Slope::decreasing>(residual, Real(0.0), max(upper, Real(0.0)), start,
                                                             Real(relative_tolerance * value_of(trial)), active)
                              .x;
        return select(active, root, Real(0.0));
    }

    static constexpr double relative_tolerance = 1e-13;  // of the trial stress, section 1

  private:
    static void need_constants(const Properties& p, int law, int first_constant, int number) {
        if (p.count() < first_constant + number - 1)
            p.refuse("HLAW = " + std::to_string(p.code(law)) + " needs NPROPS >= " +
                     std::to_string(first_constant + number - 1) + ", NPROPS = " + std::to_string(p.count()));
    }
    void set_floor(const Properties& p, int index) {
        floor_ = p[index];
        if (floor_ < 0.0 || floor_ > yield_)
            p.refuse(index, "the floor of the yield stress in [0, " + format_number(yield_) + "]");
    }
    double saturation_slope(double x) const { return range_ * rate_ * std::exp(-rate_ * x) + modulus_; }
    double tail_slope() const { return saturation_slope(straight_from_); }
    double saturation_value(double x) const {
        const double bent = std::min(x, straight_from_);
        return yield_ - range_ * std::expm1(-rate_ * bent) + modulus_ * bent +
               (x > bent ? tail_slope() * (x - bent) : 0.0);
    }
    // Where the saturation law first falls to its floor; infinite if it never does.
    double find_floor() const {
        double upper = 1.0 / rate_;
        while (saturation_value(upper) > floor_) {
            upper *= 2.0;
            if (upper > 1e12) return HUGE_VAL;
        }
        double lower = 0.0;
        for (int i = 0; i < 200 && upper - lower > 1e-16 * upper; ++i) {
            const double middle = 0.5 * (lower + upper);
            (saturation_value(middle) > floor_ ? lower : upper) = middle;
        }
        return upper;
    }
    // `beyond` where a softening law has reached its floor.
    template <class Real>
    Real floored(const Real& x, const Real& law, const Real& beyond) const {
        return softening_ ? select(x < Real(floor_at_), law, beyond) : law;
    }

    Kind kind_ = Kind::perfect;
    double yield_ = 0.0, floor_ = 0.0, floor_at_ = HUGE_VAL;
    double modulus_ = 0.0;                                        // linear part: Ep, H3
    double range_ = 0.0, rate_ = 1.0, straight_from_ = HUGE_VAL;  // saturation: Q, k, ALPHAMAX
    bool softening_ = false;
};

}  // namespace lode
