// The softening laws of cohesive cracking (page 30, section 3; Nairn, 5.7), shared by all damage models.
//
// A law is F(delta) = sig f(u), u = delta/L, L = G/(h sig): sig initiation strength, G toughness, h characteristic
// length. In u every law has unit area, so that h times the integral of F is G. With the modulus C of its direction,
// r = sig/(C L) = h sig^2/(G C) measures how brittle a point is, and
//     e(delta)/L = u + r f(u)       strain that continues damage at delta,
//     d = u/(u + r f)               damage,
//     Gbar(delta) = (G/h) omega(u)  energy dissipated per volume.
// e grows with delta, without snap-back, if r < eta of the law.
#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include "lode/material/properties.hpp"
#include "lode/numerics/functions.hpp"
#include "lode/numerics/lambert.hpp"
#include "lode/numerics/root.hpp"

namespace lode {

// A point of a law.
template <class Real>
struct Softened {
    Real u, f, slope;  // delta/L, F/sig, df/du

    // f - u f', positive as long as damage dissipates.
    LODE_INLINE Real phi() const { return f - u * slope; }
    // e/L.
    LODE_INLINE Real strain(const Real& r) const { return u + r * f; }
};
// The same with d2f/du2.
template <class Real>
struct BentSoftened : Softened<Real> {
    Real curvature;
};

class SofteningLaw {
  public:
    enum Code { linear = 1, exponential, smooth_step, cubic, double_exponential, stretched_exponential };

    // From PROPS: indices of the law's code, its two parameters and FMIN.
    SofteningLaw(const Properties& p, int code, int a1, int a2, int fmin)
        : SofteningLaw(p.code(code), p[a1], p[a2], p[fmin]) {
        if (code_ == cubic && !(a1_ >= 0.0)) p.refuse(a1, ">= 0 for law 4 (initial slope)");
        if (code_ == double_exponential && !(a1_ > 1.0)) p.refuse(a1, "> 1 for law 5");
        if (code_ == double_exponential && !(a2_ < 1.0)) p.refuse(a2, "< 1 for law 5");
        if (code_ == stretched_exponential && !(a1_ >= 1.0 && a1_ <= 100.0)) p.refuse(a1, "[1, 100] for law 6");
    }
    // `fmin`: the value of f at which the laws without an end of their own (2, 5, 6) are taken as failed.
    SofteningLaw(int code, double a1, double a2, double fmin)
        : code_(code), a1_(code == smooth_step ? 0.0 : a1), a2_(a2) {
        const double a = a1_, b = a2_;
        switch (code_) {
            case linear:
                end_ = 2.0, eta_ = 2.0;
                break;
            case smooth_step:
            case cubic: {
                k2_ = 1.0 + 0.5 * a;
                const double k3 = 1.0 + a / 3.0, k6 = 1.0 + a / 6.0;
                end_ = 2.0 / k6;
                eta_ = 12.0 * k2_ / ((1.0 + 2.0 * k2_) * (1.0 + 2.0 * k2_) * k6);
                peak_ = k3 * k3 * k3 / (k2_ * k2_);
                break;
            }
            case exponential:
                end_ = -std::log(fmin), end_value_ = fmin, eta_ = 1.0;
                break;
            case double_exponential: {
                k_ = (a - b) / (a * (1.0 - b)), scale_ = 1.0 / (1.0 - b);
                if (a * b > 1.0) peak_ = (a - 1.0) * scale_ / a * std::pow(a * b, -1.0 / (a - 1.0));
                if (b > 1.0 / (a * a))
                    eta_ = a * a * (1.0 - b) * (1.0 - b) * std::pow(a * a * b, 1.0 / (a - 1.0)) / ((a - b) * (a - 1.0));
                else eta_ = a * (1.0 - b) * (1.0 - b) / ((a - b) * (1.0 - a * b));
                end_ = double_exponential_end(fmin), end_value_ = fmin;
                break;
            }
            default: {
                k_ = std::tgamma(1.0 + 1.0 / a);
                end_ = std::pow(-std::log(fmin), 1.0 / a) / k_, end_value_ = fmin;
                smallest_ = std::exp(-700.0 / a) / k_;
                const double t = a - 1.0;
                eta_ = a > 1.0 ? 1.0 / (t * std::pow(a / t, 1.0 / a) * std::exp(-t / a) * k_) : 1.0;
                set_gamma();
            }
        }
        end_release_ = value_of(omega(end_)) + 0.5 * end_value_ * end_;
    }

    int code() const { return code_; }
    bool is_linear() const { return code_ == linear; }
    bool is_exponential() const { return code_ == exponential; }
    // f ends at 0, so damage ends at 1.
    bool has_end() const { return end_value_ == 0.0; }
    // u and f where the law is taken as failed.
    double end() const { return end_; }
    double end_value() const { return end_value_; }
    // Largest f.
    double peak() const { return peak_; }
    // Limit of r.
    double eta() const { return eta_; }

    // e/L and damage at the end.
    template <class Real>
    LODE_INLINE Real end_strain(const Real& r) const {
        return end_ + end_value_ * r;
    }
    template <class Real>
    LODE_INLINE Real end_damage(const Real& r) const {
        return has_end() ? Real(1.0) : Real(end_ / end_strain(r));
    }
    // Energy per volume over G/h released by a complete failure in one direction: 1 but for the tail that FMIN cuts.
    template <class Real>
    LODE_INLINE Real end_release(const Real& r) const {
        return end_release_ + (0.5 * end_value_ * end_value_) * r;
    }

    template <class Real>
    LODE_INLINE Softened<Real> at(const Real& u) const {
        if (code_ == linear) return {u, 1.0 - 0.5 * u, Real(-0.5)};
        return curved(u);
    }

    template <class Real>
    LODE_INLINE BentSoftened<Real> bent_at(const Real& u) const {
        switch (code_) {
            case linear:
                return {{u, 1.0 - 0.5 * u, Real(-0.5)}, Real(0.0)};
            case exponential:
                return bent_of<exponential>(u);
            case smooth_step:
            case cubic:
                return bent_of<cubic>(u);
            default:
                // A call would put a batch's registers into memory.
                if constexpr (is_batch<Real>) return bent_of_exponentials(u);
                else return bent(u);
        }
    }
    // The point at u, from one within 1e-5 of it. The slope, which batches do not ask for, is less accurate there.
    template <class Real>
    LODE_INLINE Softened<Real> moved(const BentSoftened<Real>& s, const Real& u) const {
        if constexpr (is_differentiated<Real>) return at(u);
        const Real step = u - s.u;
        if (code_ == exponential) {
            const Real f = s.f * (1.0 - step * (1.0 - step * (0.5 - (1.0 / 6.0) * step)));
            return {u, f, -f};
        }
        if (!is_batch<Real> && code_ > cubic) return at(u);
        const double third = code_ == smooth_step || code_ == cubic ? 12.0 * k2_ / (end_ * end_ * end_) : 0.0;
        const Real f = s.f + step * (s.slope + step * (0.5 * s.curvature + (third / 6.0) * step));
        return {u, f, s.slope + step * (s.curvature + (0.5 * third) * step)};
    }

    // 1/f at u, a guess from another point: exact of laws 1, 3, 4, of second order and positive of the others.
    template <class Real>
    LODE_INLINE Real inverse_near(const BentSoftened<Real>& s, const Real& u) const {
        if (code_ == linear) return 1.0 / (1.0 - 0.5 * u);
        if (code_ == smooth_step || code_ == cubic) {
            const Real x = u * (1.0 / end_), rest = 1.0 - x;
            return 1.0 / ((1.0 + 2.0 * k2_ * x) * (rest * rest));
        }
        const Real inverse = 1.0 / s.f, fall = (s.u - u) * (s.slope * inverse);
        const Real bend = 0.5 * square(u - s.u) * (s.curvature * inverse);
        return inverse * (1.0 + fall + fall * fall - bend);
    }

    // omega(u) = integral of f - u f/2.
    template <class Real>
    LODE_INLINE Real omega(const Real& u) const {
        if (code_ == linear) return 0.5 * u;
        return curved_omega(u);
    }

    // u + r f(u) = x: the point of the law at a strain x = eps/L between e/L at `u_old` and at the end.
    template <class Real>
    LODE_INLINE Softened<Real> at_strain(const Real& x, const Real& r, const Real& u_old, const Mask<Real>& active,
                                         const SolveCounter<Real>& solves = {}) const {
        if (code_ == linear) return at(Real((x - r) / (1.0 - 0.5 * r)));
        return solve_strain(x, r, u_old, active, solves);
    }

    // u (1 - d) = d r f(u): the point of the law at damage d. `u_start`: a value at smaller damage, or 0.
    template <class Real>
    LODE_INLINE Softened<Real> at_damage(const Real& d, const Real& r, const Real& u_start, const Mask<Real>& active,
                                         const SolveCounter<Real>& solves = {}) const {
        if (code_ == linear) return at(Real(2.0 * r * d / (2.0 * (1.0 - d) + r * d)));
        return solve_damage(d, r, u_start, active, solves);
    }

    // The same at a point that is known.
    template <class Real>
    LODE_INLINE Real omega(const Softened<Real>& s) const {
        if (code_ == linear) return 0.5 * s.u;
        if (code_ == exponential) return 1.0 - s.f * (1.0 + 0.5 * s.u);
        if (code_ == stretched_exponential) return stretched_omega(s.u, Real(-quick_log(max(s.f, Real(1e-300)))), s.f);
        return curved_omega(s.u);
    }

    // The exponential law at damage d: u e^u = X, X = r d/(1 - d), that is u = W0(X) (Lambert). A step of fourth order
    // (Fritsch, Shafer, Crowley 1973) from a point of it; `change` is its relative size, or more where it is a poor
    // one.
    template <class Real>
    LODE_INLINE Real exponential_step(const Softened<Real>& at, const Real& X, Real& change) const {
        const Real pull = X * at.f;
        return fritsch_step(at.u, Real((pull - at.u) / max(pull + at.u, Real(1e-300))), change);
    }
    // After a step that is not larger nothing but rounding is left.
    static constexpr double exact_step = 5e-4;
    // u for X times `ratio`, from the series in its logarithm.
    template <class Real>
    LODE_INLINE Real exponential_moved(const Real& u, const Real& ratio) const {
        const Real part = 1.0 / (1.0 + u), s = (ratio - 1.0) / (ratio + 1.0);
        const Real z = 2.0 * s * (1.0 + (1.0 / 3.0) * (s * s));
        return u * (1.0 + z * part * (1.0 + 0.5 * z * (part * part)));
    }
    // u in the lanes `active`.
    template <class Real>
    [[gnu::noinline]] Real solve_exponential(Real X, Real u, Mask<Real> active, SolveCounter<Real> solves) const {
        constexpr int most = 60;
        // A bound of the root from below, for guesses that would take long or that are not numbers.
        const Real lower = X / (1.0 + X);
        u = select(active && !(u > lower && u < Real(far)), lower, u);
        Mask<Real> done = !active;
        int iteration = 0;
        for (; iteration < most && !all(done); ++iteration) {
            Real change;
            const Real next = exponential_step(curved_of<exponential>(u), X, change);
            u = select(done, u, select(next > lower, next, lower));
            done = done || change <= exact_step;
        }
        solves.count(iteration);
        return u;
    }

  private:
    template <class Real>
    struct Balance {
        Real value, slope;
        Softened<Real> point;
    };

    // Out of line: a kernel asks for these in many places.
    template <class Real>
    [[gnu::noinline]] Softened<Real> curved(Real u) const {
        return with_code([&](auto code) { return curved_of<code>(u); });
    }
    // Calls f with the law's code as a compile-time constant.
    template <class F>
    LODE_INLINE auto with_code(const F& f) const {
        switch (code_) {
            case exponential:
                return f(std::integral_constant<Code, exponential>{});
            case smooth_step:
            case cubic:
                return f(std::integral_constant<Code, cubic>{});
            case double_exponential:
                return f(std::integral_constant<Code, double_exponential>{});
            default:
                return f(std::integral_constant<Code, stretched_exponential>{});
        }
    }
    template <Code code, class Real>
    LODE_INLINE Softened<Real> curved_of(const Real& u) const {
        return bent_of<code>(u);
    }
    template <class Real>
    LODE_INLINE BentSoftened<Real> bent_of_exponentials(const Real& u) const {
        if (code_ == double_exponential) return bent_of<double_exponential>(u);
        return bent_of<stretched_exponential>(u);
    }
    template <class Real>
    [[gnu::noinline]] BentSoftened<Real> bent(Real u) const {
        return bent_of_exponentials(u);
    }
    template <Code code, class Real>
    LODE_INLINE BentSoftened<Real> bent_of(const Real& u) const {
        if constexpr (code == exponential) {
            const Real f = quick_exp(Real(-u));
            return {{u, f, -f}, f};
        } else if constexpr (code == cubic) {
            const double inverse = 1.0 / end_;
            const Real x = min(Real(u * inverse), Real(1.0)), rest = 1.0 - x, bend = 6.0 * k2_ * x;
            return {{u, (1.0 + 2.0 * k2_ * x) * (rest * rest), inverse * (a1_ - bend) * rest},
                    square(inverse) * (2.0 * bend - (a1_ + 6.0 * k2_))};
        } else if constexpr (code == double_exponential) {
            const Real slow = scale_ * quick_exp(Real(-k_ * u));
            const Real fast = (scale_ * a2_) * quick_exp(Real((-a1_ * k_) * u));
            return {{u, slow - fast, k_ * (a1_ * fast - slow)}, (k_ * k_) * (slow - (a1_ * a1_) * fast)};
        } else {
            // z = (k u)^a. At u = 0 the slope is 0, or -k for a = 1.
            const Real size = max(u, Real(smallest_)), z = stretched_exponent(size), f = quick_exp(Real(-z));
            const Real inverse = 1.0 / size, rate = (a1_ * z) * inverse;
            return {{u, f, -rate * f}, rate * f * (rate - (a1_ - 1.0) * inverse)};
        }
    }
    // (k u)^a
    template <class Real>
    LODE_INLINE Real stretched_exponent(const Real& u) const {
        return quick_exp(Real(a1_ * quick_log(Real(k_ * u))));
    }

    template <class Real>
    [[gnu::noinline]] Real curved_omega(Real u) const {
        switch (code_) {
            case exponential:
                return 1.0 - quick_exp(Real(-u)) * (1.0 + 0.5 * u);
            case smooth_step:
            case cubic: {
                const Real x = u * (1.0 / end_);
                return 0.5 * u * (1.0 + x * x * ((4.0 * k2_ - 1.0) / 3.0 - k2_ * x));
            }
            case double_exponential: {
                const double a = a1_, b = a2_, inverse_k = 1.0 / k_;
                const Real slow = quick_exp(Real(-k_ * u)), fast = quick_exp(Real((-a * k_) * u));
                return scale_ *
                       ((a - b) / a * inverse_k - slow * (inverse_k + 0.5 * u) + b * fast * (inverse_k / a + 0.5 * u));
            }
            default: {
                const Real z = stretched_exponent(max(u, Real(smallest_)));
                return stretched_omega(u, z, quick_exp(Real(-z)));
            }
        }
    }

    // The integral of f is u f times a series, or 1 less that of the tail, an incomplete gamma function either way;
    // z = (k u)^a.
    template <class Real>
    LODE_INLINE Real stretched_omega(const Real& u, const Real& z, const Real& f) const {
        const Real uf = u * f;
        const Mask<Real> beyond = z > Real(split);
        Real integral = Real(0.0);
        if (!all(beyond)) integral = uf * gamma_series(z);
        if (any(beyond)) integral = select(beyond, 1.0 - uf * gamma_tail(z), integral);
        return integral - 0.5 * uf;
    }
    // 1 + z/(s + 1) (1 + z/(s + 2) (1 + ...)), s = 1/a: the lower function, four terms at a time.
    template <class Real>
    LODE_INLINE Real gamma_series(const Real& z) const {
        const Real z2 = z * z, z4 = z2 * z2;
        Real sum = Real(0.0);
        for (int n = series_terms - 4; n >= 0; n -= 4)
            sum = sum * z4 + ((series_[n] + series_[n + 1] * z) + z2 * (series_[n + 2] + series_[n + 3] * z));
        return sum;
    }
    // The upper function, smooth in 1/z: Clenshaw's sum of Chebyshev polynomials.
    template <class Real>
    LODE_INLINE Real gamma_tail(const Real& z) const {
        const Real w = 1.0 / max(min(z, Real(far)), Real(split)), x = tail_scale * w - tail_shift;
        Real a = Real(0.0), b = Real(0.0);
        for (int n = tail_terms - 1; n > 0; --n) {
            const Real next = tail_[n] + 2.0 * x * a - b;
            b = a;
            a = next;
        }
        return w * (tail_[0] + x * a - b);
    }
    void set_gamma() {
        const double s = 1.0 / a1_;
        double term = 1.0;
        for (int n = 0; n < series_terms; ++n) {
            series_[n] = term;
            term /= s + n + 1.0;
        }
        for (int i = 0; i < tail_terms; ++i) {
            const double angle = std::numbers::pi * (i + 0.5) / tail_terms;
            const double z = tail_scale / (std::cos(angle) + tail_shift);
            // Legendre's continued fraction of the upper function.
            double rest = 0.0;
            for (int n = 60; n > 0; --n) rest = n * (n - s) / (z + 2.0 * n + 1.0 - s - rest);
            const double value = z / (z + 1.0 - s - rest) * s * (2.0 / tail_terms);
            for (int n = 0; n < tail_terms; ++n) tail_[n] += (n == 0 ? 0.5 : 1.0) * value * std::cos(n * angle);
        }
    }

    // The strain grows with u. Newton starts where the increment is small at the old point, else at the upper end,
    // towards which the laws are convex.
    template <class Real>
    [[gnu::noinline]] Softened<Real> solve_strain(Real x, Real r, Real u_old, Mask<Real> active,
                                                  SolveCounter<Real> solves) const {
        if constexpr (!is_differentiated<Real>)
            if (code_ == exponential && all(!active || r < Real(0.9)))
                return solve_exponential_strain(x, r, u_old, active, solves);
        const Real lower = min(u_old, Real(end_)), upper = max(lower, min(x, Real(end_)));
        const Mask<Real> small = upper - lower < 2.0 * r;
        const Real start = select(active, select(small, lower, upper), lower);
        return with_code([&](auto code) {
            const auto residual = [=, this](const Real& u) {
                const Softened<Real> s = curved_of<code>(u);
                return Balance<Real>{s.strain(r) - x, 1.0 + r * s.slope, s};
            };
            const auto root =
                solve_bracketed<Slope::increasing>(residual, lower, upper, start, Real(tolerance * x), active);
            solves.count(root);
            return root.last.point;
        });
    }

    template <class Real>
    [[gnu::noinline]] Softened<Real> solve_damage(Real d, Real r, Real u_start, Mask<Real> active,
                                                  SolveCounter<Real> solves) const {
        switch (code_) {
            case smooth_step:
            case cubic:
                return solve_cubic(d, r, u_start, active, solves);
            case exponential:
                if constexpr (is_differentiated<Real>) {
                    return solve_by_newton<exponential>(d, r, u_start, active, solves);
                } else {
                    const Real X = d * r / max(1.0 - d, Real(1e-16));
                    const Real u = solve_exponential(X, u_start, active, solves), f = quick_exp(Real(-u));
                    return {u, f, -f};
                }
            case double_exponential:
                return solve_by_newton<double_exponential>(d, r, u_start, active, solves);
            default:
                return solve_by_lambert(d, r);
        }
    }
    // u + r e^-u = x is convex in u and, away from snap-back, rises: Newton comes from above after at most one step.
    template <class Real>
    LODE_INLINE Softened<Real> solve_exponential_strain(const Real& x, const Real& r, Real u, const Mask<Real>& active,
                                                        const SolveCounter<Real>& solves) const {
        constexpr int most = 60;
        u = select(active, u, Real(0.0));
        Real f = u;
        Mask<Real> done = Mask<Real>(false);
        for (int iteration = 0;; ++iteration) {
            const Real at = quick_exp(Real(-u)), step = (u + r * at - x) / (1.0 - r * at);
            const Mask<Real> last = !done && (!active || abs(step) <= 1e-8);
            // What is left is a few squares of the step.
            f = select(last, at * (1.0 + step * (1.0 + 0.5 * step)), f);
            u = select(done || !active, u, u - step);
            done = done || last;
            if (all(done) || iteration == most) {
                solves.count(iteration + 1);
                return {u, f, -f};
            }
        }
    }
    // The root w of w + ln w = u + ln u + z, z = 2 artanh(s), s small.
    template <class Real>
    LODE_INLINE static Real fritsch_step(const Real& u, const Real& s, Real& change) {
        const Real s2 = s * s;
        const Real z = 2.0 * s * (1.0 + s2 * (1.0 / 3 + s2 * (1.0 / 5 + s2 * (1.0 / 7 + s2 * (1.0 / 9)))));
        const Real next = 1.0 + u, q = 2.0 * next * (next + (2.0 / 3.0) * z);
        const Real step = z * (q - z) / (next * (q - 2.0 * z));
        change = max(abs(step), Real(0.02 * abs(s)));
        return u * (1.0 + step);
    }
    template <Code code, class Real>
    LODE_INLINE Softened<Real> solve_by_newton(const Real& d, const Real& r, const Real& u_start,
                                               const Mask<Real>& active, const SolveCounter<Real>& solves) const {
        // The root is not above r f_max d/(1 - d).
        const Real rest = max(1.0 - d, Real(1e-16)), weight = d * r;
        const Real upper = (1.0 + 1e-12) * peak_ * weight / rest, start = min(u_start, upper);
        const auto residual = [=, this](const Real& u) {
            const Softened<Real> s = curved_of<code>(u);
            return Balance<Real>{u * rest - weight * s.f, rest - weight * s.slope, s};
        };
        const auto root = solve_bracketed<Slope::increasing>(residual, Real(0.0), upper, start,
                                                             Real(tolerance * peak_ * weight), active);
        solves.count(root);
        return root.last.point;
    }
    // Law 6: with y = (k u)^a and t = d/(1 - d) the condition is y e^(a y) = (k t r)^a, a y = W0(a (k t r)^a) with
    // Lambert's function, and one step of Newton for u itself.
    template <class Real>
    LODE_INLINE Softened<Real> solve_by_lambert(const Real& d, const Real& r) const {
        const Real target = max(Real(d * r), Real(1e-300)) / max(Real(1.0 - d), Real(1e-16));
        const Real log_X = std::log(a1_) + a1_ * log(k_ * target);
        const Real w = lambert_w0_of_exponential(log_X);
        const double inverse = 1.0 / a1_;
        const Real near = (1.0 / k_) * pow(max(Real(inverse * w), Real(1e-300)), Real(inverse));
        const Softened<Real> s = curved_of<stretched_exponential>(near);
        const Real step = (target * s.f - near) / (1.0 - target * s.slope);
        const Mask<Real> damaged = d > Real(0.0);
        return {select(damaged, near + step, Real(0.0)), select(damaged, s.f + s.slope * step, Real(1.0)), s.slope};
    }
    // f has a double root at the end: with x = y^2 the square root of the condition is nearly linear in y,
    // 1 - y^2 = y sqrt(end (1 - d)/(d r (1 + 2 k2 y^2))).
    template <class Real>
    LODE_INLINE Softened<Real> solve_cubic(const Real& d, const Real& r, const Real& u_start, const Mask<Real>& active,
                                           const SolveCounter<Real>& solves) const {
        const Real one(1.0);
        const Real ratio = sqrt(end_ * max(one - d, Real(0.0)) / max(Real(d * r), Real(1e-280)));
        const auto residual = [=, this](const Real& y) {
            const Real x = y * y, rest = 1.0 - x, stretch = 1.0 + 2.0 * k2_ * x;
            const Real root = ratio / sqrt(stretch);
            const Softened<Real> s{end_ * x, stretch * (rest * rest), (1.0 / end_) * (a1_ - 6.0 * k2_ * x) * rest};
            return Balance<Real>{rest - y * root, -2.0 * y - root / stretch, s};
        };
        const Real start = select(d < one, sqrt(min(Real(u_start * (1.0 / end_)), one)), one);
        const auto root =
            solve_bracketed<Slope::decreasing>(residual, Real(0.0), one, start, Real(1e-15), active && d < one);
        solves.count(root);
        return root.last.point;
    }

    double double_exponential_end(double fmin) const {
        const double a = a1_, b = a2_;
        const double top = a * b > 1.0 ? std::log(a * b) / (k_ * (a - 1.0)) : 0.0;
        const double last = std::max(-std::log((1.0 - b) * fmin), -std::log(fmin)) / k_;
        const auto residual = [&](double u) {
            const Softened<double> s = at(u);
            return Residual<double>{s.f - fmin, s.slope};
        };
        return solve_bracketed<Slope::decreasing>(residual, top, std::max(last, top), last, 1e-15 * fmin).x;
    }

    static constexpr double tolerance = 2e-15;
    static constexpr double far = 40.0;  // exp(-far) is less than rounding of 1

    // Terms of the integral of law 6 on both sides of z = split, down to rounding.
    static constexpr int series_terms = 40, tail_terms = 15;
    static constexpr double split = 5.0;
    // 1/z from 1/far to 1/split onto -1 to 1.
    static constexpr double tail_scale = 2.0 / (1.0 / split - 1.0 / far);
    static constexpr double tail_shift = 0.5 * tail_scale * (1.0 / split + 1.0 / far);

    int code_;
    double series_[series_terms] = {}, tail_[tail_terms] = {};
    double a1_, a2_;
    double k2_ = 1.0, k_ = 1.0, scale_ = 1.0;
    double smallest_ = 0.0;  // law 6: u below which (k u)^a underflows
    double end_ = 0.0, end_value_ = 0.0, peak_ = 1.0, eta_ = 1.0, end_release_ = 0.0;
};

// The law of one direction at one material point.
template <class Real>
struct SofteningDirection {
    Real strength, length, modulus;   // sig, L = G/(h sig), C
    Real inverse_length, compliance;  // 1/L, 1/C
    Real inverse_energy;              // h/G
    Real brittleness;                 // r
    Mask<Real> enabled;               // a direction of zero strength never fails

    SofteningDirection() = default;
    // `energy`: G/h.
    LODE_INLINE SofteningDirection(const Real& sig, const Real& energy, const Real& C)
        : modulus(C), compliance(1.0 / C), inverse_energy(1.0 / energy) {
        enabled = sig > Real(0.0);
        set_strength(select(enabled, sig, Real(1.0)), energy);
    }
    LODE_INLINE void set_strength(const Real& sig, const Real& energy) {
        strength = sig;
        length = energy / sig;
        inverse_length = sig * inverse_energy;
        brittleness = strength * inverse_length * compliance;
    }
    // HPOL = 1: the strength that keeps r at 0.98 of the law's limit.
    LODE_INLINE void limit_strength(const SofteningLaw& law) {
        const Real most = Real(0.98 * law.eta());
        const Mask<Real> excessive = enabled && brittleness > most;
        if (!any(excessive)) return;
        const Real factor = select(excessive, sqrt(most / brittleness), Real(1.0));
        strength = factor * strength;
        length = length / factor;
        inverse_length = factor * inverse_length;
        brittleness = select(excessive, most, brittleness);
    }

    LODE_INLINE Real energy() const { return strength * length; }            // G/h
    LODE_INLINE Real onset_strain() const { return strength * compliance; }  // eps0
};

}  // namespace lode
