// The exponential strength laws (page 40, section 2, codes 4 and 5); strength_laws.hpp says what a law provides.
#pragma once

#include "lode/cohesive/strength_laws.hpp"

namespace lode {

// Code 4, exponential decay: S = sig exp(-xi (delta - u_e)). It ends where S has fallen to a sig, or never for a = 0.
struct ExponentialDecay : StrengthConstants {
    static constexpr bool has_psi = false;

    // a is the cut-off S/sig.
    ExponentialDecay(const Properties& p, const LawEntries& at)
        : StrengthConstants(p[at.k], p[at.Gc], p[at.sig] / p[at.k], end_of(p, at)),
          strength_(p[at.sig]),
          decay_(decay_of(p, at)),
          inverse_decay_(1.0 / decay_) {
        check_toughness(p, at);
        check_range(p, at);
        end_integrity = std::isfinite(end) ? p[at.a] * strength_ / (stiffness * end) : 0.0;
        scaled_limit_ = decay_ * elastic_limit;
        log_limit_ = std::log(scaled_limit_) + scaled_limit_;
    }

    template <class Real>
    Real integrity(const Real& delta) const {
        return elastic_limit / delta * exp(decay_ * (elastic_limit - delta));
    }
    template <class Real>
    Real slope(const Real& delta) const {
        return -decay_ * strength(delta);
    }
    template <class Real>
    Real released_energy(const Real& delta) const {
        const Real fallen = expm1(decay_ * (elastic_limit - delta));  // S/sig - 1
        return 0.5 * strength_ * (elastic_limit - (1.0 + fallen) * delta) - (strength_ * inverse_decay_) * fallen;
    }
    template <class Real>
    Real release_rate(const Real& delta) const {
        return 0.5 * strength(delta) * (1.0 + decay_ * delta);
    }
    // With w = xi delta: w exp(w) = xi u_e exp(xi u_e)/q, Lambert's equation, whose logarithm cannot overflow.
    template <class Real>
    Real opening(const Real& q) const {
        const Real right = log_limit_ - log(max(q, Real(1e-300)));
        const auto residual = [&](const Real& w) { return Residual<Real>{w + log(w) - right, 1.0 + 1.0 / w}; };
        const Real large = max(right, Real(1.0)), small = exp(min(right, Real(1.0)));
        const Real least(scaled_limit_), most = scaled_limit_ + (right - log_limit_);
        const Real start = max(select(right > Real(1.0), large - log(large), small / (1.0 + small)), least);
        const Root<Real> w =
            solve_bracketed<Slope::increasing>(residual, least, max(most, least), start, 4e-16 * (1.0 + abs(right)));
        return min(w.x * inverse_decay_, Real(end));
    }

  private:
    static double decay_of(const Properties& p, const LawEntries& at) {
        check_toughness(p, at);
        return 1.0 / (p[at.Gc] / p[at.sig] - 0.5 * p[at.sig] / p[at.k]);
    }
    static double end_of(const Properties& p, const LawEntries& at) {
        const double cut_off = p[at.a];
        if (!(cut_off >= 0.0 && cut_off < 1.0)) p.refuse(at.a, "in [0, 1): the cut-off S/sig of the exponential law");
        return cut_off > 0.0 ? p[at.sig] / p[at.k] - std::log(cut_off) / decay_of(p, at) : HUGE_VAL;
    }
    template <class Real>
    Real strength(const Real& delta) const {
        return strength_ * exp(decay_ * (elastic_limit - delta));
    }

    double strength_, decay_, inverse_decay_;  // sig, xi, 1/xi
    double scaled_limit_, log_limit_;          // xi u_e, ln(xi u_e) + xi u_e
};

// Code 5, Abaqus' exponential damage: S = sig (E - exp(-alpha))/(1 - exp(-alpha)), E = exp(-alpha x),
// x = (delta - u_e)/w.
struct AbaqusExponential : StrengthConstants {
    static constexpr bool has_psi = false;

    // a is alpha.
    AbaqusExponential(const Properties& p, const LawEntries& at)
        : StrengthConstants(p[at.k], p[at.Gc], p[at.sig] / p[at.k], p[at.sig] / p[at.k] + range_of(p, at)),
          range_(range_of(p, at)),
          strength_(p[at.sig]),
          alpha_(p[at.a]),
          inverse_range_(1.0 / range_),
          inverse_fall_(-1.0 / std::expm1(-alpha_)) {
        check_range(p, at);
    }

    template <class Real>
    Real integrity(const Real& delta) const {
        return elastic_limit / delta * remaining(fallen(delta));
    }
    template <class Real>
    Real slope(const Real& delta) const {
        return (strength_ * alpha_ * inverse_fall_ * inverse_range_) * (fallen(delta) - 1.0);
    }
    template <class Real>
    Real released_energy(const Real& delta) const {
        const Real x = (delta - elastic_limit) * inverse_range_;
        // int_ue^delta S/sig = w x (1 - g(alpha x)/(1 - exp(-alpha)))
        const Real area = range_ * x * (1.0 - inverse_fall_ * lag(alpha_, alpha_ * x));
        return strength_ * (0.5 * elastic_limit + area - 0.5 * remaining(fallen(delta)) * delta);
    }
    template <class Real>
    Real release_rate(const Real& delta) const {
        const Real t = fallen(delta);
        return 0.5 * strength_ * (remaining(t) + (alpha_ * inverse_fall_ * inverse_range_) * (1.0 - t) * delta);
    }
    // S - k q delta is convex in delta: Newton's method from the left is monotone.
    template <class Real>
    Real opening(const Real& q) const {
        const Real line = q * (1.0 / elastic_limit);
        const double steepness = alpha_ * inverse_fall_ * inverse_range_;
        const auto residual = [&](const Real& delta) {
            const Real t = fallen(delta);
            return Residual<Real>{remaining(t) - line * delta, -steepness * (1.0 - t) - line};
        };
        return solve_bracketed<Slope::decreasing>(residual, Real(elastic_limit), Real(end), Real(elastic_limit),
                                                  Real(2e-16))
            .x;
    }

    // f of the page: twice the area of the softening range over sig w.
    static double area_factor(double alpha) { return 2.0 * (1.0 - lag(alpha, alpha) / -std::expm1(-alpha)); }

    // g(y) = 1 - (1 - exp(-y))/y for 0 <= y <= alpha, a series where alpha is small: areas under the law without
    // cancellation.
    template <class Real>
    static Real lag(double alpha, const Real& y) {
        if (alpha > 0.3) {
            const Real positive = max(y, Real(1e-300));
            return 1.0 + expm1(-positive) / positive;
        }
        Real sum(1.0);
        for (int i = 13; i >= 3; --i) sum = 1.0 - y * sum * (1.0 / i);
        return 0.5 * y * sum;
    }

  private:
    static double range_of(const Properties& p, const LawEntries& at) {
        if (!(p[at.a] > 0.0)) p.refuse(at.a, "> 0: the exponent of the exponential law");
        check_toughness(p, at);
        return (2.0 * p[at.Gc] / p[at.sig] - p[at.sig] / p[at.k]) / area_factor(p[at.a]);
    }
    // 1 - E
    template <class Real>
    Real fallen(const Real& delta) const {
        return -expm1((elastic_limit - delta) * (alpha_ * inverse_range_));
    }
    // S/sig
    template <class Real>
    Real remaining(const Real& fallen_part) const {
        return 1.0 - fallen_part * inverse_fall_;
    }

    double range_, strength_, alpha_, inverse_range_;  // w, sig
    double inverse_fall_;                              // 1/(1 - exp(-alpha))
};

}  // namespace lode
