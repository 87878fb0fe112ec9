// Johnson-Cook (HLAW 3; page 20, section 2.1; Nairn, eqs. 2.76-2.81):
// K = (Y + B alpha^n) R T with R = 1 + C ln r + [D (ln r)^n2 where r > 1], r = max(rate/EPS0, RMIN), and
// T = 1 - T*^m, T* = (theta - TREF)/(TMELT - TREF).
#pragma once

#include "lode/plasticity/hardening_law.hpp"
#include "lode/plasticity/surroundings.hpp"

namespace lode {

class JohnsonCook {
  public:
    static constexpr bool softens = false, feels_rate = true, feels_temperature = true, changes_shear = false;
    static constexpr bool melts = true, remembers = false;

    template <class Real>
    struct At {
        Real thermal, star;  // T, T*
        Mask<Real> melted;
        double log_rate_scale;  // ln(rate/EPS0) = ln(dalpha) + this
        double slowest;         // dalpha at r = RMIN; infinite where nothing depends on the rate
        // Left by `solve`: R at the end and its derivative by ln(dalpha).
        Real end_ratio, end_ratio_slope;
        bool solved = false;
    };

    // `h` is the index of H1.
    JohnsonCook(const Properties& p, int h, double yield, double reference_temperature, double radial, double axial)
        : yield_(yield),
          rise_(p[h]),
          exponent_(p[h + 1]),
          rate_factor_(p[h + 2]),
          rate_(p[h + 3]),
          thermal_exponent_(p[h + 4] != 0.0 ? p[h + 4] : 1.0),
          reference_temperature_(reference_temperature),
          fast_factor_(p[h + 6]),
          fast_exponent_(p[h + 7] != 0.0 ? p[h + 7] : 1.0),
          stiffness_{radial, axial} {
        if (rise_ < 0.0) p.refuse(h, ">= 0");
        if (exponent_ <= 0.0) p.refuse(h + 1, "> 0");
        if (rate_factor_ < 0.0) p.refuse(h + 2, ">= 0");
        if (rate_ <= 0.0 && (rate_ < 0.0 || rate_factor_ > 0.0 || fast_factor_ > 0.0)) p.refuse(h + 3, "> 0");
        if (thermal_exponent_ < 0.0) p.refuse(h + 4, "> 0");
        if (fast_factor_ < 0.0) p.refuse(h + 6, ">= 0");
        if (fast_exponent_ < 0.0) p.refuse(h + 7, "> 0");
        const double melting = p[h + 5];
        if (melting != 0.0) {
            if (melting <= reference_temperature) p.refuse(h + 5, "> TREF, or 0: the yield stress ignores temperature");
            per_range_ = 1.0 / (melting - reference_temperature);
        }
        const double lowest = rate_factor_ > 0.0 ? std::exp(-1.0 / rate_factor_) : 0.0;
        double slowest = p[h + 8];
        if (slowest == 0.0) slowest = rate_factor_ > 0.0 ? std::exp(-0.5 / rate_factor_) : 1.0;
        if (slowest <= lowest || slowest > 1.0)
            p.refuse(h + 8, "in (exp(-1/C), 1] = (" + format_number(lowest) + ", 1]: the yield stress stays positive");
        log_slowest_ = std::log(slowest);
        slowest_rate_ = slowest * rate_;
        ignores_rate_ = rate_factor_ == 0.0 && fast_factor_ == 0.0;
        slow_ratio_ = 1.0 + rate_factor_ * log_slowest_;
        log_rate_ = std::log(rate_);
    }

    template <class Real>
    LODE_INLINE At<Real> at(const Surroundings<Real>& s) const {
        At<Real> at{Real(1.0), Real(0.0), Mask<Real>(false), 0.0, HUGE_VAL, Real(slow_ratio_), Real(0.0)};
        if (per_range_ != 0.0) {
            at.star = (s.temperature - reference_temperature_) * per_range_;
            at.melted = at.star >= Real(1.0);
            const Real inside = min(max(at.star, Real(0.0)), Real(1.0));
            at.thermal = 1.0 - (thermal_exponent_ == 1.0 ? inside : quick_pow(inside, thermal_exponent_));
        }
        if (!ignores_rate_ && s.time.value > 0.0) {
            at.log_rate_scale = s.log_rate - log_rate_;
            at.slowest = slowest_rate_ * s.time.value;
        }
        return at;
    }

    // K at rate 0.
    template <class Real>
    LODE_INLINE FlowStress<Real> start(const At<Real>& at, const Real& alpha) const {
        const FlowStress<Real> h = strain_hardening(alpha);
        const Real factor = slow_ratio_ * at.thermal;
        return {factor * h.value, factor * h.slope, factor * h.curvature};
    }
    // K after dalpha = x.
    template <class Real>
    LODE_INLINE FlowStress<Real> flow(const At<Real>& at, const Real& alpha, const Real& x) const {
        return flow(at, alpha, x, quick_log(max(x, Real(1e-300))));
    }

    template <Line line, class Real>
    LODE_INLINE ReturnResult<Real> solve(At<Real>& at, const Real& q_trial, const Real& alpha,
                                         const FlowStress<Real>& k, const Mask<Real>& yields) const {
        return solve_along(stiffness_[line], at, q_trial, alpha, k, yields);
    }
    // The same on a line of any stiffness S.
    template <class Real, class Number>
    LODE_INLINE ReturnResult<Real> solve_along(const Number& S, At<Real>& at, const Real& q_trial, const Real& alpha,
                                               const FlowStress<Real>& k, const Mask<Real>& yields) const {
        at.solved = true;
        const Real upper = select(yields, (q_trial - k.value) * (1.0 / S), Real(1.0));
        if constexpr (!is_differentiated<Real>) {
            if (at.slowest < HUGE_VAL) {
                const Quick<Real> quick = solve_quickly(S, at, q_trial, alpha, k, upper);
                const Mask<Real> left = yields && !quick.solved;
                at.end_ratio = select(yields, quick.ratio, at.end_ratio);
                at.end_ratio_slope = select(yields, quick.ratio_slope, at.end_ratio_slope);
                if (!any(left)) [[likely]]
                    return quick.result;
                const Slow<Real> other = solve_slowly(*this, S, at, q_trial, alpha, k, upper, left);
                at.end_ratio = select(left, other.ratio, at.end_ratio);
                at.end_ratio_slope = select(left, other.ratio_slope, at.end_ratio_slope);
                return either(left, other.result, quick.result);
            }
        }
        const Slow<Real> all_lanes = solve_slowly(*this, S, at, q_trial, alpha, k, upper, yields);
        at.end_ratio = select(yields, all_lanes.ratio, at.end_ratio);
        at.end_ratio_slope = select(yields, all_lanes.ratio_slope, at.end_ratio_slope);
        return all_lanes.result;
    }
    template <Line line>
    double plastic_share(const At<double>&, double H) const {
        return stiffness_[line] / (stiffness_[line] + H);
    }

    template <class Real>
    LODE_INLINE PlasticWork<Real> work(const At<Real>& at, const Real& alpha, const Real& dalpha,
                                       const FlowStress<Real>& k, const FlowStress<Real>& k_end) const {
        // R T at the end, from K itself; B alpha^n at the start from K there.
        const Real h = strain_hardening_from(k.value, slow_ratio_ * at.thermal);
        const PowerHardening curve{yield_, rise_, exponent_};
        Real ratio = at.end_ratio;
        if (!at.solved) ratio = select(dalpha > Real(0.0), rate_ratio(at, dalpha), Real(slow_ratio_));
        ratio = ratio * at.thermal;
        const Real h_end = strain_hardening_from(k_end.value, ratio);
        const Real stored =
            curve.stored_energy(alpha, dalpha, FlowStress<Real>{h, h, h}, FlowStress<Real>{h_end, h_end, h_end});
        return {yield_ * ratio, ratio * stored};
    }

    // See `HeatSlopes`.
    HeatSlopes slopes(const At<double>& at, double alpha, double dalpha, const FlowStress<double>& k,
                      const FlowStress<double>& k_end) const {
        const double below = std::min(std::max(at.star, 0.0), 1.0);
        double thermal_slope = 0.0;  // T'
        if (below > 0.0 && below < 1.0)
            thermal_slope = -thermal_exponent_ * per_range_ *
                            (thermal_exponent_ == 1.0 ? 1.0 : quick_pow(below, thermal_exponent_ - 1.0));
        const double per_T = thermal_slope / at.thermal;  // T'/T
        const PlasticWork<double> w = work(at, alpha, dalpha, k, k_end);
        // (dR/d dalpha)/R; in plane stress the return does not go through solve_along, which notes it.
        const Ratio<double> r = at.solved ? Ratio<double>{at.end_ratio, at.end_ratio_slope, 0.0}
                                          : ratio(at, quick_log(std::max(dalpha, 1e-300)));
        const double per_R = r.slope / (r.value * dalpha);
        HeatSlopes s;
        s.flow_temperature = k_end.value * per_T;
        s.source_strain = w.friction * (1.0 + dalpha * per_R);
        s.source_temperature = dalpha * w.friction * per_T;
        s.work_strain = s.source_strain + (k_end.value - w.friction) + w.stored * per_R;
        s.work_temperature = s.source_temperature + w.stored * per_T;
        return s;
    }

  private:
    template <class Real>
    struct Ratio {
        Real value, slope, bend;  // R and its derivatives by ln(dalpha)
    };
    template <class Real>
    LODE_INLINE Ratio<Real> ratio(const At<Real>& at, const Real& log_x) const {
        if (at.slowest == HUGE_VAL) return {Real(slow_ratio_), Real(0.0), Real(0.0)};
        const Real L = log_x + at.log_rate_scale;
        const auto above = L > Real(log_slowest_);
        const Real bounded = max(L, Real(log_slowest_));
        Ratio<Real> r{1.0 + rate_factor_ * bounded, select(above, Real(rate_factor_), Real(0.0)), Real(0.0)};
        if (fast_factor_ != 0.0) {
            const auto fast = L > Real(0.0);
            const Real base = select(fast, L, Real(1.0));
            const Real extra = fast_factor_ * (fast_exponent_ == 1.0 ? base : quick_pow(base, fast_exponent_));
            const Real slope = fast_exponent_ * extra / base, bend = (fast_exponent_ - 1.0) * slope / base;
            r.value = r.value + select(fast, extra, Real(0.0));
            r.slope = r.slope + select(fast, slope, Real(0.0));
            r.bend = select(fast, bend, Real(0.0));
        }
        return r;
    }
    template <class Real>
    LODE_INLINE Real rate_ratio(const At<Real>& at, const Real& dalpha) const {
        return ratio(at, quick_log(max(dalpha, Real(1e-300)))).value;
    }

    // Y + B alpha^n.
    template <class Real>
    LODE_INLINE FlowStress<Real> strain_hardening(const Real& alpha) const {
        return PowerHardening{yield_, rise_, exponent_}.flow_stress(alpha);
    }
    template <class Real>
    LODE_INLINE static Real strain_hardening_from(const Real& k, const Real& factor) {
        const auto solid = factor > Real(0.0);
        return select(solid, k / select(solid, factor, Real(1.0)), Real(0.0));
    }

    template <class Real>
    LODE_INLINE FlowStress<Real> flow(const At<Real>& at, const Real& alpha, const Real& x, const Real& log_x) const {
        const FlowStress<Real> h = strain_hardening(alpha + x);
        const Ratio<Real> r = ratio(at, log_x);
        const Real per_x = 1.0 / max(x, Real(1e-300));
        const Real r1 = r.slope * per_x, r2 = (r.bend - r.slope) * (per_x * per_x);
        return {at.thermal * (h.value * r.value), at.thermal * (h.slope * r.value + h.value * r1),
                at.thermal * (h.curvature * r.value + 2.0 * h.slope * r1 + h.value * r2)};
    }

    template <class Real>
    struct Slow {
        ReturnResult<Real> result;
        Real ratio, ratio_slope;
    };
    template <class Real>
    struct Quick : Slow<Real> {
        Mask<Real> solved;
    };

    // The usual case, a hardened point that flows much faster than RMIN EPS0: one evaluation of K. It starts where the
    // hardening of the beginning, a cubic, and R at a first guess lead; a step of Halley's from there is so short that
    // series tell K at its end, and Newton's step from those is the last.
    template <class Real, class Number>
    LODE_INLINE Quick<Real> solve_quickly(const Number& S, const At<Real>& at, const Real& q_trial, const Real& alpha,
                                          const FlowStress<Real>& k, const Real& upper) const {
        const double per_slow = 1.0 / slow_ratio_, n = exponent_;
        const Real per_alpha = 1.0 / max(alpha, Real(1e-100));
        const Real h = per_slow * k.value, h1 = per_slow * k.slope, h2 = per_slow * k.curvature;  // times T
        const Real h3 = (n - 2.0) * per_alpha * h2;
        const Real first = ratio(at, quick_log(upper)).value;
        const Real guess = (q_trial - h * first) / (S + h1 * first);
        Mask<Real> sound = guess > 0.02 * upper && guess < upper && guess < 0.4 * alpha;
        Real x = select(sound, guess, upper);
        {
            const Ratio<Real> r = ratio(at, quick_log(x));
            const Real per_x = 1.0 / x, r1 = r.slope * per_x, r2 = (r.bend - r.slope) * (per_x * per_x);
            const Real g = h + x * (h1 + x * (0.5 * h2 + (1.0 / 6.0) * x * h3)), g1 = h1 + x * (h2 + 0.5 * x * h3);
            const Real g2 = h2 + x * h3;
            const Real f = q_trial - S * x - g * r.value, f1 = S + g1 * r.value + g * r1;
            const Real f2 = g2 * r.value + 2.0 * g1 * r1 + g * r2;
            const Real better = x + f * f1 / (f1 * f1 + 0.5 * f * f2);
            sound = sound && better > 0.5 * x && better < upper;
            x = select(sound, better, upper);
        }
        const Real a = alpha + x, log_x = quick_log(x), per_x = 1.0 / x, per_a = 1.0 / a;
        const Real raised = (rise_ * at.thermal) * quick_exp(n * quick_log(a));
        const Real g = yield_ * at.thermal + raised, g1 = n * raised * per_a, g2 = (n - 1.0) * g1 * per_a;
        const Real g3 = (n - 2.0) * g2 * per_a, g4 = (n - 3.0) * g3 * per_a;
        const Ratio<Real> r = ratio(at, log_x);
        const Real r1 = r.slope * per_x, r2 = (r.bend - r.slope) * (per_x * per_x);
        const Real f = q_trial - S * x - g * r.value, f1 = S + g1 * r.value + g * r1;
        const Real f2 = g2 * r.value + 2.0 * g1 * r1 + g * r2;
        const Real d = f * f1 / (f1 * f1 + 0.5 * f * f2), part = d * per_x;

        const Real log_end = log_x + part * (1.0 - part * (0.5 - part * (1.0 / 3.0 - part * (0.25 - 0.2 * part))));
        const Real per_end = per_x * (1.0 - part * (1.0 - part * (1.0 - part)));
        const Real e = g + d * (g1 + d * (0.5 * g2 + d * ((1.0 / 6.0) * g3 + (1.0 / 24.0) * d * g4)));
        const Real e1 = g1 + d * (g2 + d * (0.5 * g3 + (1.0 / 6.0) * d * g4));
        const Ratio<Real> end = ratio(at, log_end);
        const Real slope = e1 * end.value + e * (end.slope * per_end);
        const Real last = (q_trial - S * (x + d) - e * end.value) / (S + slope);
        const Real dalpha = x + d + last;
        Quick<Real> quick;
        quick.result = {dalpha, {q_trial - S * dalpha, slope, Real(0.0)}};
        quick.ratio = end.value;
        quick.ratio_slope = end.slope;
        quick.solved = sound && abs(part) < Real(4e-3) && abs(last) <= 1e-8 * x && x > Real(2.0 * at.slowest);
        return quick;
    }

    // The residual as a function of y = ln(dalpha), in which R is straight.
    template <bool with_rate, class Real, class Number>
    LODE_INLINE auto in_logarithm(const At<Real>& at, const Real& q_trial, const Real& alpha, const Number& S) const {
        return [self = *this, at, q_trial, alpha, S](const Real& y) {
            const Real x = quick_exp(y);
            const FlowStress<Real> h = self.strain_hardening(alpha + x);
            Ratio<Real> r{Real(self.slow_ratio_), Real(0.0), Real(0.0)};
            if constexpr (with_rate) r = self.ratio(at, y);
            const Real h1 = x * h.slope, h2 = x * (x * h.curvature) + h1;  // by y
            const Real k1 = at.thermal * (h1 * r.value + h.value * r.slope);
            const Real k2 = at.thermal * (h2 * r.value + 2.0 * (h1 * r.slope) + h.value * r.bend);
            const Real k = at.thermal * (h.value * r.value), drop = S * x, per_x = 1.0 / x;
            return Trial<Real>{q_trial - drop - k,
                               Real(0.0) - drop - k1,
                               Real(0.0) - drop - k2,
                               {{x, {k, k1 * per_x, Real(0.0)}}, r.value, r.slope}};
        };
    }
    template <class Real>
    struct Trial {
        Real value, slope, curvature;
        Slow<Real> end;
    };
    template <class Real>
    static Slow<Real> either_end(const Mask<Real>& first, const Slow<Real>& a, const Slow<Real>& b) {
        return {either(first, a.result, b.result), select(first, a.ratio, b.ratio),
                select(first, a.ratio_slope, b.ratio_slope)};
    }

    // Any case, out of line: bracketed, for ln(dalpha), on the one or the other side of r = RMIN.
    template <class Real, class Number>
    [[gnu::noinline]] static Slow<Real> solve_slowly(JohnsonCook self, Number S, At<Real> at, Real q_trial, Real alpha,
                                                     FlowStress<Real> k, Real upper, Mask<Real> active) {
        const auto ln = [](const Mask<Real>& lanes, const Real& x) { return quick_log(select(lanes, x, Real(1.0))); };
        const Real tolerance = return_tolerance * q_trial;
        // Molten: nothing is left to the yield stress.
        const Mask<Real> solid = active && at.thermal > Real(0.0);
        Slow<Real> end{{upper, {Real(0.0), Real(0.0), Real(0.0)}}, Real(self.slow_ratio_), Real(0.0)};
        // At r = RMIN the stress tells on which side the root is.
        Mask<Real> fast(false);
        if (at.slowest < HUGE_VAL)
            fast = solid && q_trial - S * at.slowest > self.flow(at, alpha, Real(at.slowest)).value;
        if (any(fast)) {
            const auto root = solve_bracketed<Slope::decreasing>(self.in_logarithm<true>(at, q_trial, alpha, S),
                                                                 Real(quick_log(at.slowest)), ln(fast, upper),
                                                                 ln(fast, upper), tolerance, fast);
            end = either_end(fast, root.last.end, end);
        }
        const Mask<Real> slow = solid && !fast;
        if (any(slow)) {
            const Mask<Real> virgin = alpha < Real(PowerHardening::smallest);
            const Real lower = select(slow && !virgin, (q_trial - k.value) / (S + k.slope), min(upper, Real(1e-290)));
            const Real factor = select(slow, self.slow_ratio_ * at.thermal, Real(1.0));
            Real start = upper;
            if (self.rise_ > 0.0) {
                const Real rise = positive_part(q_trial / factor - self.yield_) * (1.0 / self.rise_);
                start = max(min(upper, quick_pow(rise, 1.0 / self.exponent_) - alpha), lower);
            }
            const auto root =
                solve_bracketed<Slope::decreasing>(self.in_logarithm<false>(at, q_trial, alpha, S), ln(slow, lower),
                                                   ln(slow, upper), ln(slow, start), tolerance, slow);
            end = either_end(slow, root.last.end, end);
        }
        return end;
    }

    double yield_, rise_, exponent_, rate_factor_, rate_, thermal_exponent_, reference_temperature_;
    double fast_factor_, fast_exponent_;
    double stiffness_[2];
    double per_range_ = 0.0, log_slowest_, slowest_rate_, slow_ratio_, log_rate_;
    bool ignores_rate_;
};

}  // namespace lode
