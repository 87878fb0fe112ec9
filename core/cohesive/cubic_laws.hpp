// The cubic strength laws (page 40, section 2, codes 2 and 3); strength_laws.hpp says what a law provides.
#pragma once

#include "lode/cohesive/strength_laws.hpp"

namespace lode {

// Code 3, Needleman's law: S = k delta (1 - y)^2, y = delta/u_c, without elastic range. sig is the peak, at u_c/3.
struct Needleman : StrengthConstants {
    static constexpr bool has_psi = true;

    Needleman(const Properties& p, const LawEntries& at)
        : StrengthConstants(27.0 * p[at.sig] / (4.0 * end_of(p, at)), p[at.Gc], 0.0, end_of(p, at)),
          psi_scale_(2.0 * square(stiffness * end)) {
        if (at.k != 0 && p[at.k] != 0.0) p.refuse(at.k, "0: the Needleman law has a stiffness of its own");
        if (!std::isfinite(stiffness) || !(stiffness > 0.0) || !std::isfinite(end) || !(end > 0.0))
            p.refuse(at.Gc, "such that 16 Gc/(9 sig) is an ordinary number");
    }

    template <class Real>
    Real integrity(const Real& delta) const {
        return square(rest(delta));
    }
    template <class Real>
    Real slope(const Real& delta) const {
        const Real y = delta * inverse_end;
        return stiffness * rest(delta) * (1.0 - 3.0 * y);
    }
    template <class Real>
    Real released_energy(const Real& delta) const {
        const Real y = delta * inverse_end;
        return toughness * (4.0 - 3.0 * y) * (y * y * y);
    }
    // phi = 2 k u_c y^2 (1 - y)
    template <class Real>
    Real release_rate(const Real& delta) const {
        const Real y = delta * inverse_end;
        return (stiffness * end) * y * y * rest(delta);
    }
    template <class Real>
    Real damage_rate(const Real& delta) const {
        return (2.0 * inverse_end) * rest(delta);
    }
    template <class Real>
    Real opening(const Real& q) const {
        return end * (1.0 - q) / (1.0 + sqrt(max(q, Real(1e-300))));
    }
    template <class Real>
    Real psi(const Real& delta) const {
        const Real y = delta * inverse_end;
        return psi_scale_ * (y * y * y) * (1.0 / 3.0 + y * (-0.75 + y * (0.6 - y * (1.0 / 6.0))));
    }
    template <class Real>
    Real opening_at(const Real& psi_value) const {
        const Real cube = max(psi_value * (3.0 / psi_scale_), Real(1e-300));
        return opening_at_psi(*this, psi_value, min(end * cbrt(cube), Real(end)));
    }

  private:
    static double end_of(const Properties& p, const LawEntries& at) { return 16.0 * p[at.Gc] / (9.0 * p[at.sig]); }
    // 1 - y
    template <class Real>
    Real rest(const Real& delta) const {
        return (end - delta) * inverse_end;
    }

    double psi_scale_;  // 2 (k u_c)^2
};

// Code 2, generalized cubic: S = (sig + A x)(1 - x)^2, x = (delta - u_e)/w, A = 2 sig + kc w. It starts at sig with
// the slope kc and ends with slope 0; phi >= 0 on the whole range if and only if -3 sig <= kc w and kc <= k.
struct GeneralCubic : StrengthConstants {
    static constexpr bool has_psi = true;

    // a is kc/k.
    GeneralCubic(const Properties& p, const LawEntries& at)
        : StrengthConstants(p[at.k], p[at.Gc], p[at.sig] / p[at.k], p[at.sig] / p[at.k] + range_of(p, at)),
          range_(range_of(p, at)),
          strength_(p[at.sig]) {
        const double first_slope = p[at.a] * stiffness;
        if (!(p[at.a] <= 1.0)) p.refuse(at.a, "at most 1: the strength cannot start steeper than the stiffness");
        if (!(range_ > 0.0) || !(first_slope * range_ >= -3.0 * strength_)) {
            // kc w = -3 sig where w = 4 (Gc - sig u_e/2)/sig
            const double least = -0.75 * square(strength_) / (toughness - 0.5 * strength_ * elastic_limit) / stiffness;
            p.refuse(at.a, "at least " + format_number(least) + ", where the strength starts to fall below zero");
        }
        check_range(p, at);
        inverse_range_ = 1.0 / range_;
        linear_ = 2.0 * strength_ + first_slope * range_;
        relative_ = linear_ / strength_;
        first_slope_ = first_slope;
        const double r = elastic_limit * inverse_range_;
        phi0_ = strength_ - elastic_limit * first_slope;
        phi1_ = strength_ + 3.0 * linear_ * r;
        phi2_ = 2.0 * linear_;

        // S phi/(r + x) as polynomial + remainder/(r + x), by synthetic division at x = -r
        const double a[2] = {strength_, linear_}, b[3] = {phi0_, phi1_, phi2_}, cube[4] = {1.0, -3.0, 3.0, -1.0};
        double n[7] = {};
        for (int i = 0; i < 2; ++i)
            for (int j = 0; j < 3; ++j)
                for (int l = 0; l < 4; ++l) n[i + j + l] += a[i] * b[j] * cube[l];
        double carried = n[6];
        for (int i = 5; i >= 0; --i) {
            psi_[i] = carried / (i + 1);  // integrated
            carried = n[i] - r * carried;
        }
        psi_remainder_ = carried;
        check_toughness(p, at);
    }

    template <class Real>
    Real integrity(const Real& delta) const {
        const Real x = (delta - elastic_limit) * inverse_range_;
        return elastic_limit / delta * (1.0 + relative_ * x) * square(1.0 - x);
    }
    template <class Real>
    Real slope(const Real& delta) const {
        const Real x = (delta - elastic_limit) * inverse_range_;
        return (first_slope_ - (3.0 * linear_ * inverse_range_) * x) * (1.0 - x);
    }
    template <class Real>
    Real released_energy(const Real& delta) const {
        const Real x = (delta - elastic_limit) * inverse_range_;
        const Real work =
            x * (strength_ * (1.0 + x * (-1.0 + x * (1.0 / 3.0))) + linear_ * x * (0.5 + x * (-2.0 / 3.0 + 0.25 * x)));
        const Real strength = (strength_ + linear_ * x) * square(1.0 - x);
        return 0.5 * strength_ * elastic_limit + range_ * work - 0.5 * strength * delta;
    }
    template <class Real>
    Real release_rate(const Real& delta) const {
        const Real x = (delta - elastic_limit) * inverse_range_;
        return 0.5 * (1.0 - x) * (phi0_ + x * (phi1_ + x * phi2_));
    }
    // The root of sqrt(S/(k delta)) = sqrt(q), which is almost straight near the end.
    template <class Real>
    Real opening(const Real& q) const {
        const Real root = sqrt(max(q, Real(1e-300)));
        const auto residual = [&](const Real& delta) {
            const Real x = (delta - elastic_limit) * inverse_range_, inverse = 1.0 / delta;
            const Real ratio = max(elastic_limit * (1.0 + relative_ * x) * inverse, Real(1e-300)), part = sqrt(ratio);
            const Real ratio_slope = (elastic_limit * relative_ * inverse_range_ - ratio) * inverse;
            return Residual<Real>{(1.0 - x) * part - root,
                                  -part * inverse_range_ + (1.0 - x) * ratio_slope * 0.5 / part};
        };
        const Real start = elastic_limit * end / (elastic_limit + q * range_);
        // The residual has three roundings of the size of the root.
        return solve_bracketed<Slope::decreasing>(residual, Real(elastic_limit), Real(end), start, 6e-16 * root).x;
    }
    template <class Real>
    Real psi(const Real& delta) const {
        const Real x = (delta - elastic_limit) * inverse_range_;
        Real sum(psi_[5]);
        for (int i = 4; i >= 0; --i) sum = psi_[i] + x * sum;
        return x * sum + psi_remainder_ * quick_log1p(Real((delta - elastic_limit) / elastic_limit));
    }
    template <class Real>
    Real opening_at(const Real& psi_value) const {
        return opening_at_psi(*this, psi_value, start_at_psi(*this, psi_value));
    }

  private:
    static double range_of(const Properties& p, const LawEntries& at) {
        const double sig = p[at.sig], rest = p[at.Gc] - 0.5 * sig * sig / p[at.k];
        check_toughness(p, at);
        return 2.0 * rest / (0.5 * sig + std::sqrt(0.25 * sig * sig + p[at.a] * p[at.k] / 3.0 * rest));
    }

    double range_, strength_;                                 // w, sig
    double inverse_range_, linear_, relative_, first_slope_;  // 1/w, A, A/sig, kc
    double phi0_, phi1_, phi2_;                               // phi/(1 - x)
    double psi_[6], psi_remainder_;
};

}  // namespace lode
