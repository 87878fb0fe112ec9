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
        // No flag comes last: GCC would copy the struct byte by byte, and keep it in memory.
        Mask<Real> melted;
        bool solved;
        Real thermal, star, star_power;  // T, T*, T*^m
        double rate_scale;               // rate/EPS0 of dalpha = 1
        double slowest;                  // dalpha at r = RMIN; infinite where nothing depends on the rate
        // Left by `solve`: R at the end and its derivative by dalpha over R; (Y + B alpha^n) T there.
        Real end_ratio, end_ratio_change, end_hardening;
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
          stiffness_{radial, axial},
          inverse_stiffness_{1.0 / radial, 1.0 / axial} {
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
        inverse_slow_ratio_ = 1.0 / slow_ratio_;
        inverse_rate_ = ignores_rate_ ? 0.0 : 1.0 / rate_;
        double binomial = 1.0;
        for (int i = 0; i < 4; ++i) {
            binomial *= (exponent_ - i) / (i + 1.0);
            binomial_[i] = binomial;
        }
    }

    template <class Real>
    LODE_INLINE At<Real> at(const Surroundings<Real>& s) const {
        At<Real> at{.melted = Mask<Real>(false),
                    .solved = false,
                    .thermal = Real(1.0),
                    .star = Real(0.0),
                    .star_power = Real(0.0),
                    .rate_scale = 0.0,
                    .slowest = HUGE_VAL,
                    .end_ratio = Real(slow_ratio_),
                    .end_ratio_change = Real(0.0),
                    .end_hardening = Real(0.0)};
        if (per_range_ != 0.0) {
            at.star = (s.temperature - reference_temperature_) * per_range_;
            at.melted = at.star >= Real(1.0);
            const Real inside = min(max(at.star, Real(0.0)), Real(1.0));
            at.star_power = thermal_exponent_ == 1.0 ? inside : quick_pow(inside, thermal_exponent_);
            at.thermal = 1.0 - at.star_power;
        }
        if (!ignores_rate_ && s.time.value > 0.0) {
            at.rate_scale = min(s.time.inverse * inverse_rate_, 1e280);
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
        const FlowStress<Real> h = strain_hardening(alpha + x);
        const Ratio<Real> r = ratio(at, log_rate(at, x));
        const Real per_x = 1.0 / max(x, Real(1e-300));
        const Real r1 = r.slope * per_x, r2 = (r.bend - r.slope) * (per_x * per_x);
        return {at.thermal * (h.value * r.value), at.thermal * (h.slope * r.value + h.value * r1),
                at.thermal * (h.curvature * r.value + 2.0 * h.slope * r1 + h.value * r2)};
    }

    template <Line line, class Real>
    LODE_INLINE ReturnResult<Real> solve(At<Real>& at, const Real& q_trial, const Real& alpha,
                                         const FlowStress<Real>& k, const Mask<Real>& yields,
                                         const SolveCounter<Real>& solves = {}) const {
        return solve_along(stiffness_[line], inverse_stiffness_[line], at, q_trial, alpha, k, yields, solves);
    }
    // The same on a line of any stiffness S.
    template <class Real, class Number>
    LODE_INLINE ReturnResult<Real> solve_along(const Number& S, const Number& inverse_S, At<Real>& at,
                                               const Real& q_trial, const Real& alpha, const FlowStress<Real>& k,
                                               const Mask<Real>& yields, const SolveCounter<Real>& solves) const {
        at.solved = true;
        at.end_hardening = inverse_slow_ratio_ * k.value;
        const Real upper = select(yields, (q_trial - k.value) * inverse_S, Real(1.0));
        Solution<Real> end{{upper, k}, at.end_ratio, at.end_ratio_change, at.end_hardening, Mask<Real>(false)};
        if constexpr (!is_differentiated<Real>)
            if (at.slowest < HUGE_VAL) {
                end = step_from(start_of(S, at, q_trial, k, upper), S, at, q_trial, alpha);
                solves.count(1);
            }
        if (!all(end.found || !yields)) [[unlikely]] {
            const Mask<Real> left = yields && !end.found;
            const Solution<Real> other =
                solve_slowly(*this, S, at, q_trial, alpha, k, upper, Real(end.result.dalpha), left, solves);
            end = either_end(left, other, end);
        }
        at.end_ratio = select(yields, end.ratio, at.end_ratio);
        at.end_ratio_change = select(yields, end.ratio_change, at.end_ratio_change);
        at.end_hardening = select(yields, end.hardening, at.end_hardening);
        return end.result;
    }
    template <Line line>
    double plastic_share(const At<double>&, double H) const {
        return stiffness_[line] / (stiffness_[line] + H);
    }

    template <class Real>
    LODE_INLINE PlasticWork<Real> work(const At<Real>& at, const Real& alpha, const Real& dalpha,
                                       const FlowStress<Real>& k, const FlowStress<Real>& k_end) const {
        // In plane stress the return does not go through `solve`.
        Real ratio = at.end_ratio, h_end = at.end_hardening;
        if (!at.solved) {
            ratio = select(dalpha > Real(0.0), this->ratio(at, log_rate(at, dalpha)).value, Real(slow_ratio_));
            h_end = select(at.thermal > Real(0.0), k_end.value / ratio, Real(0.0));
        }
        const Real base = yield_ * at.thermal, h = inverse_slow_ratio_ * k.value;
        const Real stored = PowerHardening::integral(exponent_, alpha, dalpha, h - base, h_end - base);
        return {ratio * base, ratio * stored};
    }

    // See `HeatSlopes`.
    LODE_INLINE HeatSlopes slopes(const At<double>& at, double alpha, double dalpha, const FlowStress<double>& k,
                                  const FlowStress<double>& k_end) const {
        const double below = min(max(at.star, 0.0), 1.0);
        double per_T = 0.0;  // T'/T
        if (below > 0.0 && below < 1.0) per_T = -thermal_exponent_ * per_range_ * at.star_power / (below * at.thermal);
        const PlasticWork<double> w = work(at, alpha, dalpha, k, k_end);
        double per_R = at.end_ratio_change;  // (dR/d dalpha)/R
        if (!at.solved) {
            const Ratio<double> r = ratio(at, log_rate(at, dalpha));
            per_R = r.slope / (r.value * dalpha);
        }
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
    // L = ln(rate/EPS0) of dalpha = x, and R there.
    template <class Real>
    LODE_INLINE static Real log_rate(const At<Real>& at, const Real& x) {
        return quick_log(max(at.rate_scale * x, Real(1e-300)));
    }
    template <class Real>
    LODE_INLINE Ratio<Real> ratio(const At<Real>& at, const Real& L) const {
        if (at.slowest == HUGE_VAL) return {Real(slow_ratio_), Real(0.0), Real(0.0)};
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
    // Y + B alpha^n.
    template <class Real>
    LODE_INLINE FlowStress<Real> strain_hardening(const Real& alpha) const {
        return PowerHardening{yield_, rise_, exponent_}.flow_stress(alpha);
    }

    template <class Real>
    struct Solution {
        ReturnResult<Real> result;
        Real ratio, ratio_change, hardening;  // see At
        Mask<Real> found;
    };
    template <class Real>
    LODE_INLINE static Solution<Real> either_end(const Mask<Real>& first, const Solution<Real>& a,
                                                 const Solution<Real>& b) {
        return {either(first, a.result, b.result), select(first, a.ratio, b.ratio),
                select(first, a.ratio_change, b.ratio_change), select(first, a.hardening, b.hardening),
                (first && a.found) || (!first && b.found)};
    }

    // The usual case, a hardened point that flows faster than RMIN EPS0, takes one evaluation of K: a step of fourth
    // order from a good start is so short that series tell K at its end, and Newton's step from those is the last.

    // Where the return would end if the strain hardening went on straight and R were straight in ln x. With v = x/upper
    // that is c v + B ln v = over, Newton's steps for which come near enough with estimates of the logarithm.
    template <class Real, class Number>
    LODE_INLINE Real start_of(const Number& S, const At<Real>& at, const Real& q_trial, const FlowStress<Real>& k,
                              const Real& upper) const {
        const Real h = inverse_slow_ratio_ * k.value, h1 = inverse_slow_ratio_ * k.slope;
        const Ratio<Real> r = ratio(at, estimated_log(at.rate_scale * upper));
        const Real B = h * r.slope, c = upper * (S + h1 * r.value), over = q_trial - h * r.value;
        Real slow(1.0);
        if (any(over < Real(0.0))) slow = quick_exp(min(over, Real(0.0)) / max(B, Real(1e-300)));
        Real v = slow * (B + positive_part(over)) / (B + c * slow);
        v = v * (B + over - B * estimated_log(v)) / (B + c * v);
        return upper * min(max(v, Real(1e-12)), Real(1.0));
    }

    // From x to x (1 + p).
    template <class Real, class Number>
    LODE_INLINE Solution<Real> step_from(const Real& x, const Number& S, const At<Real>& at, const Real& q_trial,
                                         const Real& alpha) const {
        const double(&c)[4] = binomial_;
        const Real a = alpha + x, per_a = 1.0 / a, t = x * per_a, L = log_rate(at, x);
        const Real base = yield_ * at.thermal, raised = (rise_ * at.thermal) * quick_exp(exponent_ * quick_log(a));
        const Ratio<Real> r = ratio(at, L);
        // g R and its derivatives by p.
        const Real g = base + raised, turn = t * raised;
        const Real g1 = c[0] * turn, g2 = (2.0 * c[1]) * (t * turn), g3 = (6.0 * c[2]) * (t * t * turn);
        const Real r2 = r.bend - r.slope, r3 = 2.0 * r.slope - 3.0 * r.bend;
        const Real f1 = S * x + g1 * r.value + g * r.slope, f2 = g2 * r.value + 2.0 * g1 * r.slope + g * r2;
        const Real f3 = g3 * r.value + 3.0 * g2 * r.slope + 3.0 * g1 * r2 + g * r3;
        const Real inverse = 1.0 / f1, b = (0.5 * inverse) * f2;
        const Real first = inverse * (q_trial - S * x - g * r.value);
        const Real p = first * (1.0 - first * (b - first * (2.0 * (b * b) - (1.0 / 6.0 * inverse) * f3)));

        const Real u = p * t, u2 = u * u, p2 = p * p;
        const Real e = g + raised * (u * ((c[0] + u * c[1]) + u2 * (c[2] + u * c[3])));
        const Real e1 = (raised * per_a) * ((c[0] + u * (2.0 * c[1])) + u2 * (3.0 * c[2] + u * (4.0 * c[3])));
        const Real longer = p * ((1.0 - 0.5 * p) + p2 * ((1.0 / 3 - 0.25 * p) + p2 * (0.2 - (1.0 / 6) * p)));
        const Ratio<Real> there = ratio(at, L + longer);
        const Real last = inverse * (q_trial - S * (x + p * x) - e * there.value) * (1.0 - 2.0 * (b * p));
        const Real dalpha = x + x * (p + last);
        const Real change = there.slope / (there.value * dalpha);
        Mask<Real> found = abs(p) < Real(6e-3) && abs(u) < Real(1.5e-3) && abs(last) <= Real(1e-9) &&
                           x > Real(2.0 * at.slowest) && at.thermal > Real(0.0);
        if (fast_factor_ != 0.0) found = found && abs(longer) < abs(L);
        return {{dalpha, {q_trial - S * dalpha, there.value * (e1 + e * change), Real(0.0)}},
                there.value + there.slope * last,
                change,
                e + e1 * (x * last),
                found};
    }

    // The residual as a function of y = ln(dalpha), in which R is straight.
    template <bool with_rate, class Real, class Number>
    LODE_INLINE auto in_logarithm(const At<Real>& at, const Real& q_trial, const Real& alpha, const Number& S) const {
        const double log_scale = with_rate ? quick_log(at.rate_scale) : 0.0;
        return [self = *this, at, q_trial, alpha, S, log_scale](const Real& y) {
            const Real x = quick_exp(y);
            const FlowStress<Real> h = self.strain_hardening(alpha + x);
            Ratio<Real> r{Real(self.slow_ratio_), Real(0.0), Real(0.0)};
            [[maybe_unused]] const Real L = y + log_scale;
            if constexpr (with_rate) r = self.ratio(at, L);
            const Real h1 = x * h.slope, h2 = x * (x * h.curvature) + h1;  // by y
            const Real k1 = at.thermal * (h1 * r.value + h.value * r.slope);
            const Real k2 = at.thermal * (h2 * r.value + 2.0 * (h1 * r.slope) + h.value * r.bend);
            const Real g = at.thermal * h.value, k = g * r.value, drop = S * x, per_x = 1.0 / x;
            return Trial<Real>{
                q_trial - drop - k,
                Real(0.0) - drop - k1,
                Real(0.0) - drop - k2,
                {{x, {k, k1 * per_x, Real(0.0)}}, r.value, r.slope * per_x / r.value, g, Mask<Real>(true)}};
        };
    }
    template <class Real>
    struct Trial {
        Real value, slope, curvature;
        Solution<Real> end;
    };

    // Any case, out of line: more such steps; then bracketed, for ln(dalpha), on the one or the other side of r = RMIN.
    template <class Real, class Number>
    [[gnu::noinline]] static Solution<Real> solve_slowly(JohnsonCook self, Number S, At<Real> at, Real q_trial,
                                                         Real alpha, FlowStress<Real> k, Real upper, Real x,
                                                         Mask<Real> active, SolveCounter<Real> solves) {
        const Mask<Real> found(true);
        Solution<Real> end{
            {upper, {Real(0.0), Real(0.0), Real(0.0)}}, Real(self.slow_ratio_), Real(0.0), Real(0.0), found};
        if constexpr (!is_differentiated<Real>)
            for (int i = 0; i < 2 && at.slowest < HUGE_VAL; ++i) {
                x = max(min(x, upper), 0.01 * upper);
                const Solution<Real> next = self.step_from(x, S, at, q_trial, alpha);
                solves.count(1);
                const Mask<Real> here = active && next.found;
                end = either_end(here, next, end);
                active = active && !here;
                if (!any(active)) return end;
                x = next.result.dalpha;
            }
        const auto ln = [](const Mask<Real>& lanes, const Real& z) { return quick_log(select(lanes, z, Real(1.0))); };
        const Real tolerance = return_tolerance * q_trial;
        // Molten: nothing is left to the yield stress.
        const Mask<Real> solid = active && at.thermal > Real(0.0);
        // At r = RMIN the stress tells on which side the root is.
        Mask<Real> fast(false);
        if (at.slowest < HUGE_VAL)
            fast = solid && q_trial - S * at.slowest > self.flow(at, alpha, Real(at.slowest)).value;
        if (any(fast)) {
            const auto root = solve_bracketed<Slope::decreasing>(self.in_logarithm<true>(at, q_trial, alpha, S),
                                                                 Real(quick_log(at.slowest)), ln(fast, upper),
                                                                 ln(fast, upper), tolerance, fast);
            solves.count(root);
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
            solves.count(root);
            end = either_end(slow, root.last.end, end);
        }
        return end;
    }

    double yield_, rise_, exponent_, rate_factor_, rate_, thermal_exponent_, reference_temperature_;
    double fast_factor_, fast_exponent_;
    double stiffness_[2], inverse_stiffness_[2];
    double per_range_ = 0.0, log_slowest_, slowest_rate_, slow_ratio_, inverse_slow_ratio_, inverse_rate_;
    double binomial_[4];  // of the exponent
    bool ignores_rate_;
};

}  // namespace lode
