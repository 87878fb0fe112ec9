// Johnson-Cook (HLAW 3; page 20, section 2.1; Nairn, eqs. 2.76-2.81):
// K = (Y + B alpha^n) R T with R = 1 + C ln r + [D (ln r)^n2 where r > 1], r = max(rate/EPS0, RMIN), and
// T = 1 - T*^m, T* = (theta - TREF)/(TMELT - TREF).
#pragma once

#include "lode/numerics/near_power.hpp"
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
        bool solved, starts_at_power;
        Real power;                       // alpha^n, where it starts so
        Real rough_power, rough_thermal;  // nearly alpha^n and T
        Real thermal, star, star_power;   // T, T*, T*^m
        double rate_scale;                // rate/EPS0 of dalpha = 1; 0 where nothing depends on the rate
        // Left by `solve`: R at the end and its derivative by dalpha over R; (Y + B alpha^n) T there; S/(S + H),
        // H = dK/dalpha.
        Real end_ratio, end_ratio_change, end_hardening, end_share;
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
          inverse_stiffness_{1.0 / radial, 1.0 / axial},
          near_power_(exponent_) {
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
        slowest_ = slowest;
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
        At<Real> at;
        set_surroundings(at, s);
        if (has_power_of_temperature()) at.star_power = quick_pow(at.star_power, thermal_exponent_);
        at.thermal = 1.0 - at.star_power;
        return at;
    }
    // The same for a step from `alpha`.
    template <class Real>
    LODE_INLINE void set(At<Real>& at, const Surroundings<Real>& s, const Real& alpha) const {
        set_surroundings(at, s);
        const Real base = bounded(alpha);
        at.starts_at_power = true;
        if (has_power_of_temperature()) {
            const auto powers = quick_pow(base, exponent_, at.star_power, thermal_exponent_);
            at.power = powers.first, at.star_power = powers.second;
            at.rough_power = powers.rough_first, at.rough_thermal = 1.0 - powers.rough_second;
            at.thermal = 1.0 - at.star_power;
        } else {
            at.power = quick_pow(base, exponent_);
            at.thermal = 1.0 - at.star_power;
            at.rough_power = at.power, at.rough_thermal = at.thermal;
        }
    }

    // K at rate 0.
    template <class Real>
    LODE_INLINE FlowStress<Real> start(const At<Real>& at, const Real& alpha) const {
        const FlowStress<Real> h = at.starts_at_power ? strain_hardening(alpha, at.power) : strain_hardening(alpha);
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
        Solution<Real> end{{upper, k},       at.end_ratio, at.end_ratio_change,
                           at.end_hardening, at.end_share, Mask<Real>(false)};
        if constexpr (!is_differentiated<Real>)
            if (at.rate_scale > 0.0) {
                Real x = at.starts_at_power ? start_near(S, inverse_S, at, q_trial, alpha)
                                            : start_of(S, at, q_trial, inverse_slow_ratio_ * k.value,
                                                       inverse_slow_ratio_ * k.slope, upper);
                if constexpr (is_batch<Real>) x = select(yields, x, upper);  // a number in every lane
                end = step_from(x, risen(at, k, alpha, x, yields), S, at, q_trial, alpha);
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
        at.end_share = select(yields, end.share, at.end_share);
        return end.result;
    }
    template <Line line>
    LODE_INLINE double plastic_share(const At<double>& at, double H) const {
        return at.solved ? at.end_share : stiffness_[line] / (stiffness_[line] + H);
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
    // All but the powers: T* within [0, 1] in place of T*^m.
    template <class Real>
    LODE_INLINE void set_surroundings(At<Real>& at, const Surroundings<Real>& s) const {
        at.melted = Mask<Real>(false), at.solved = false, at.starts_at_power = false;
        at.star = Real(0.0), at.star_power = Real(0.0), at.power = Real(0.0);
        at.rough_power = Real(0.0), at.rough_thermal = Real(0.0);
        if (per_range_ != 0.0) {
            at.star = (s.temperature - reference_temperature_) * per_range_;
            at.melted = at.star >= Real(1.0);
            at.star_power = min(max(at.star, Real(0.0)), Real(1.0));
        }
        at.rate_scale = ignores_rate_ || !(s.time.value > 0.0) ? 0.0 : min(s.time.inverse * inverse_rate_, 1e280);
        at.end_ratio = Real(slow_ratio_), at.end_ratio_change = Real(0.0), at.end_hardening = Real(0.0);
        at.end_share = Real(1.0);
    }

    LODE_INLINE bool has_power_of_temperature() const { return per_range_ != 0.0 && thermal_exponent_ != 1.0; }

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
        if (at.rate_scale == 0.0) return {Real(slow_ratio_), Real(0.0), Real(0.0)};
        const auto above = L > Real(log_slowest_);
        const Real bounded = max(L, Real(log_slowest_));
        Ratio<Real> r{1.0 + rate_factor_ * bounded, select(above, Real(rate_factor_), Real(0.0)), Real(0.0)};
        const auto fast = L > Real(0.0);
        if (fast_factor_ != 0.0 && any(fast)) {
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
    // The same with the power at hand.
    template <class Real>
    LODE_INLINE FlowStress<Real> strain_hardening(const Real& alpha, const Real& power) const {
        const Real per_base = 1.0 / bounded(alpha);
        Real rise = rise_ * power;
        const Real slope = exponent_ * rise * per_base;
        const auto tiny = alpha < Real(PowerHardening::smallest);
        if (any(tiny)) [[unlikely]]
            rise = select(tiny, rise_ * quick_pow(alpha, exponent_), rise);
        return {yield_ + rise, slope, (exponent_ - 1.0) * slope * per_base};
    }
    template <class Real>
    LODE_INLINE static Real bounded(const Real& alpha) {
        return max(alpha, Real(PowerHardening::smallest));
    }

    template <class Real>
    struct Solution {
        ReturnResult<Real> result;
        Real ratio, ratio_change, hardening, share;  // see At
        Mask<Real> found;
    };
    template <class Real>
    LODE_INLINE static Solution<Real> either_end(const Mask<Real>& first, const Solution<Real>& a,
                                                 const Solution<Real>& b) {
        return {either(first, a.result, b.result),
                select(first, a.ratio, b.ratio),
                select(first, a.ratio_change, b.ratio_change),
                select(first, a.hardening, b.hardening),
                select(first, a.share, b.share),
                (first && a.found) || (!first && b.found)};
    }

    // The usual case, a hardened point that flows faster than RMIN EPS0, takes one evaluation of K: a step of fourth
    // order from a good start is so short that series tell K at its end, and Newton's step from those is the last.

    // Where the return would end if the strain hardening went on straight and R were straight in ln x. With v = x/upper
    // that is c v + B ln v = over, Newton's steps for which come near enough with estimates of the logarithm.
    // `h` is the strain hardening at the start, `h1` its slope; they may be estimates.
    template <class Real, class Number>
    LODE_INLINE Real start_of(const Number& S, const At<Real>& at, const Real& q_trial, const Real& h, const Real& h1,
                              const Real& upper) const {
        const Real fastest = at.rate_scale * upper;
        const Ratio<Real> r = ratio(at, estimated_log(fastest));
        const Real B = h * r.slope, c = upper * (S + h1 * r.value), over = q_trial - h * r.value;
        // Where the logarithm rules, a third step is needed and an estimate not enough.
        const auto ruled = over < B;
        const bool any_ruled = any(ruled);
        Real slow(1.0);
        if (any_ruled) slow = quick_exp(min(over, Real(0.0)) / max(B, Real(1e-300)));
        // The first step leads from v = slow to v = first/per, and the second from there.
        const Real first = slow * (B + positive_part(over)), per = B + c * slow;
        const Real log_v = estimated_log(first) - estimated_log(per);
        Real v = first * (B + over - B * log_v) / (B * per + c * first);
        if (any_ruled) {
            // The fast term bends R: the logarithm is approached in several steps.
            for (int i = fast_factor_ == 0.0 ? 1 : 3; i > 0; --i) {
                const Ratio<Real> there = ratio(at, quick_log(max(fastest * v, Real(1e-300))));
                const Real cv = c * v, step = (q_trial - h * there.value - cv) / (h * there.slope + cv);
                v = select(ruled, i == 1 ? v + v * step : v * quick_exp(min(step, Real(30.0))), v);
            }
        }
        return upper * v;
    }
    // The same without waiting for the powers.
    template <class Real, class Number>
    LODE_INLINE Real start_near(const Number& S, const Number& inverse_S, const At<Real>& at, const Real& q_trial,
                                const Real& alpha) const {
        const Real raised = (rise_ * at.rough_thermal) * at.rough_power;
        const Real h = yield_ * at.rough_thermal + raised, h1 = (exponent_ * raised) * (1.0 / bounded(alpha));
        return start_of(S, at, q_trial, h, h1, (q_trial - slow_ratio_ * h) * inverse_S);
    }

    // B T (alpha + x)^n.
    template <class Real>
    LODE_INLINE Real risen(const At<Real>& at, const Real& alpha, const Real& x) const {
        return (rise_ * at.thermal) * quick_exp(exponent_ * quick_log(alpha + x));
    }
    // The same from its value at alpha, that of `k`, where x < alpha.
    template <class Real>
    LODE_INLINE Real risen(const At<Real>& at, const FlowStress<Real>& k, const Real& alpha, const Real& x,
                           const Mask<Real>& yields) const {
        const Real z = select(yields, x * (1.0 / bounded(alpha)), Real(0.0));
        const auto near = z <= Real(near_power_.reach());
        const Real power = (inverse_slow_ratio_ * k.value - yield_ * at.thermal) * near_power_(z);
        if (all(near || !yields)) [[likely]]
            return power;
        return select(near, power, risen(at, alpha, x));
    }

    // From x to x (1 + p); `raised` is B T (alpha + x)^n.
    template <class Real, class Number>
    LODE_INLINE Solution<Real> step_from(const Real& x, const Real& raised, const Number& S, const At<Real>& at,
                                         const Real& q_trial, const Real& alpha) const {
        const double(&c)[4] = binomial_;
        const Real a = alpha + x, per_a = 1.0 / a, t = x * per_a, L = log_rate(at, x);
        const Real base = yield_ * at.thermal, drop = S * x;
        const Ratio<Real> r = ratio(at, L);
        // g R, g = base + raised, and its derivatives by p; sums begin with what is known before `raised`.
        const Real g = base + raised, r2 = r.bend - r.slope, r3 = 2.0 * r.slope - 3.0 * r.bend;
        const Real t1 = c[0] * t, t2 = (2.0 * c[1]) * (t * t), t3 = (6.0 * c[2]) * (t * t * t);
        const Real f1 = (drop + base * r.slope) + raised * (t1 * r.value + r.slope);
        const Real f2 = base * r2 + raised * ((t2 * r.value + r2) + 2.0 * (t1 * r.slope));
        const Real f3 = base * r3 + raised * ((t3 * r.value + r3) + 3.0 * (t2 * r.slope + t1 * r2));
        const Real inverse = 1.0 / f1, b = inverse * (0.5 * f2);
        const Real first = inverse * ((q_trial - drop - base * r.value) - raised * r.value), first2 = first * first;
        const Real p = (first - first2 * b) + (first2 * first) * (2.0 * (b * b) - inverse * (1.0 / 6.0 * f3));

        const Real u = p * t, u2 = u * u, p2 = p * p;
        const Real e = g + (raised * u) * ((c[0] + u * c[1]) + u2 * (c[2] + u * c[3]));
        const Real e1 = (raised * per_a) * ((c[0] + u * (2.0 * c[1])) + u2 * (3.0 * c[2] + u * (4.0 * c[3])));
        const Real longer = p + p2 * ((p * (1.0 / 3) - 0.5) + p2 * ((0.2 * p - 0.25) - (1.0 / 6) * p2));
        Ratio<Real> there{r.value + rate_factor_ * longer, r.slope, Real(0.0)};
        if (fast_factor_ != 0.0) there = ratio(at, L + longer);
        const Real last = ((q_trial - drop) - drop * p - e * there.value) * (inverse * (1.0 - 2.0 * (b * p)));
        const Real dalpha = (x + x * p) + x * last;
        const Real change = there.slope / (there.value * dalpha);
        Mask<Real> found = abs(p) < Real(6e-3) && abs(u) < Real(1.5e-3) && abs(last) <= Real(1e-9) &&
                           at.rate_scale * x > Real(2.0 * slowest_) && at.thermal > Real(0.0);
        if (fast_factor_ != 0.0) found = found && abs(longer) < abs(L);
        return {{dalpha, {q_trial - S * dalpha, there.value * (e1 + e * change), Real(0.0)}},
                there.value + there.slope * last,
                change,
                e + e1 * (x * last),
                S * dalpha / (dalpha * (S + there.value * e1) + e * there.slope),
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
            return Trial<Real>{q_trial - drop - k,
                               Real(0.0) - drop - k1,
                               Real(0.0) - drop - k2,
                               {{x, {k, k1 * per_x, Real(0.0)}},
                                r.value,
                                r.slope * per_x / r.value,
                                g,
                                drop / (drop + k1),
                                Mask<Real>(true)}};
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
            {upper, {Real(0.0), Real(0.0), Real(0.0)}}, Real(self.slow_ratio_), Real(0.0), Real(0.0), Real(1.0), found};
        if constexpr (!is_differentiated<Real>)
            for (int i = 0; i < 2 && at.rate_scale > 0.0; ++i) {
                x = select(x > Real(0.0), min(x, upper), 0.01 * upper);
                const Solution<Real> next = self.step_from(x, self.risen(at, alpha, x), S, at, q_trial, alpha);
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
        const double slowest = at.rate_scale > 0.0 ? self.slowest_ / at.rate_scale : 1.0;
        if (at.rate_scale > 0.0) fast = solid && q_trial - S * slowest > self.flow(at, alpha, Real(slowest)).value;
        if (any(fast)) {
            const auto root = solve_bracketed<Slope::decreasing>(self.in_logarithm<true>(at, q_trial, alpha, S),
                                                                 Real(quick_log(slowest)), ln(fast, upper),
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
    double per_range_ = 0.0, slowest_, log_slowest_, slow_ratio_, inverse_slow_ratio_, inverse_rate_;
    double binomial_[4];  // of the exponent
    NearPower near_power_;
    bool ignores_rate_;
};

}  // namespace lode
