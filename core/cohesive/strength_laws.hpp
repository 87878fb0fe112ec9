// Strength laws S(delta) of one mode (page 40, section 2): the traction at the largest opening delta so far, beyond the
// elastic limit u_e and up to the end of the law u_c. Unloading goes to the origin,
//     T = (S/delta) u = k (1 - D) u,     D = 1 - S/(k delta).
// A law provides, for u_e <= delta <= u_c,
//     integrity(delta)         1 - D; exactly 1 at u_e, and never formed as a difference from D
//     slope(delta)             S'
//     released_energy(delta)   Omega = int_0^delta S - S delta/2, which ends at the toughness Gc
//     release_rate(delta)      dOmega/ddelta = phi/2 = (S - delta S')/2, not negative: damage only grows
//     opening(q)               the delta at which the integrity is q
// and the members stiffness (k), elastic_limit (u_e), end (u_c), toughness (Gc), the inverses of the last two, and
// end_integrity, the integrity at u_c (0, but for a law that is cut off). Laws that the return normal to the surface
// (method 3) can use have has_psi = true and provide psi(delta) = int_ue^delta S phi/delta' ddelta'.
//
// This header has the piecewise linear laws; cubic_laws.hpp and exponential_laws.hpp have the others.
#pragma once

#include "lode/material/properties.hpp"
#include "lode/numerics/functions.hpp"
#include "lode/numerics/root.hpp"

namespace lode {

// Where in PROPS the constants of one mode stand (1-based, 0 if the law has none), and the letter of the mode in
// messages, "n" or "t".
struct LawEntries {
    int k, sig, Gc, a, b;
    const char* mode;
};

// What all laws are described by.
struct StrengthConstants {
    double stiffness, toughness, elastic_limit, end, inverse_end, inverse_toughness;
    double end_integrity = 0.0;

    StrengthConstants(double k, double Gc, double u_e, double u_c)
        : stiffness(k),
          toughness(Gc),
          elastic_limit(u_e),
          end(u_c),
          inverse_end(1.0 / u_c),
          inverse_toughness(1.0 / Gc) {}

    // phi >= 0 demands Gc > sig^2/(2 k) of the laws with an elastic range.
    static void check_toughness(const Properties& p, const LawEntries& at) {
        const double k = p[at.k], sig = p[at.sig], Gc = p[at.Gc], least = 0.5 * sig * sig / k;
        if (!(Gc > least) || !(2.0 * Gc / sig > sig / k))
            p.refuse(at.Gc,
                     std::string("greater than sig_") + at.mode + "^2/(2 k_" + at.mode + ") = " + format_number(least));
    }
    void check_range(const Properties& p, const LawEntries& at) const {
        if (!(elastic_limit > 0.0) || !(end > elastic_limit) || !std::isfinite(toughness / p[at.sig]))
            p.refuse(at.k, "such that sig/k and 2 Gc/sig are ordinary numbers");
    }
};

// R = dD/ddelta = phi/(k delta^2), where a law has nothing simpler.
template <class Law, class Real>
Real damage_rate(const Law& law, const Real& delta) {
    if constexpr (requires { law.damage_rate(delta); }) return law.damage_rate(delta);
    else return 2.0 * law.release_rate(delta) / (law.stiffness * delta * delta);
}

// delta(psi) of a law by Newton's method: psi grows with delta, and with a falling slope S phi/delta but for a law
// without elastic range. `start` should be on the left of the root.
template <class Law, class Real>
Real opening_at_psi(const Law& law, const Real& psi, const Real& start) {
    const auto residual = [&](const Real& delta) {
        const Real strength = law.stiffness * law.integrity(delta) * delta;
        return Residual<Real>{law.psi(delta) - psi, 2.0 * strength * law.release_rate(delta) / delta};
    };
    const Real least(max(law.elastic_limit, 1e-12 * law.end)), most(law.end);
    return solve_bracketed<Slope::increasing>(residual, least, most, start, 4e-16 * law.psi(most)).x;
}
// A start for it: S phi is about what it is at u_e.
template <class Law, class Real>
Real start_at_psi(const Law& law, const Real& psi) {
    const double first = 2.0 * law.stiffness * law.elastic_limit * law.release_rate(law.elastic_limit);
    return min(law.elastic_limit * quick_exp(min(psi * (1.0 / first), Real(100.0))), Real(law.end));
}

// Code 1, linear softening: S = sig (u_c - delta)/w with w = u_c - u_e.
struct Sawtooth : StrengthConstants {
    static constexpr bool has_psi = true;

    Sawtooth(const Properties& p, const LawEntries& at)
        : StrengthConstants(p[at.k], p[at.Gc], p[at.sig] / p[at.k], 2.0 * p[at.Gc] / p[at.sig]),
          range_(end - elastic_limit),
          slope_(-p[at.sig] / range_),
          release_rate_(toughness / range_),
          psi_scale_(square(slope_) * end) {
        check_toughness(p, at);
        check_range(p, at);
    }

    template <class Real>
    Real integrity(const Real& delta) const {
        return elastic_limit * (end - delta) / (range_ * delta);
    }
    template <class Real>
    Real slope(const Real&) const {
        return Real(slope_);
    }
    template <class Real>
    Real released_energy(const Real& delta) const {
        return release_rate_ * (delta - elastic_limit);
    }
    template <class Real>
    Real release_rate(const Real&) const {
        return Real(release_rate_);
    }
    template <class Real>
    Real opening(const Real& q) const {
        return elastic_limit * end / (elastic_limit + q * range_);
    }
    // e of 1/delta = 1/u_c + e q
    double inverse_fall() const { return range_ / (elastic_limit * end); }
    template <class Real>
    Real psi(const Real& delta) const {
        return psi_scale_ *
               (end * quick_log1p(Real((delta - elastic_limit) / elastic_limit)) - (delta - elastic_limit));
    }
    // Halley's method: psi flattens towards u_c, where Newton's steps fall short.
    template <class Real>
    Real opening_at(const Real& psi_value) const {
        const auto residual = [&](const Real& delta) {
            const Real inverse = 1.0 / delta, share = end * inverse;
            return CurvedResidual<Real>{psi(delta) - psi_value, psi_scale_ * (share - 1.0),
                                        -psi_scale_ * (share * inverse)};
        };
        const Real least(max(elastic_limit, 1e-12 * end)), most(end);
        return solve_bracketed<Slope::increasing>(residual, least, most, start_at_psi(*this, psi_value),
                                                  4e-16 * psi(most))
            .x;
    }

  private:
    double range_, slope_, release_rate_, psi_scale_;  // w, S', phi/2, sig^2 u_c/w^2
};

// Code 6, bilinear softening: from sig at u_e to sig2 at u2 and from there to 0 at u_c. With u2 = u_e (which only the
// decoupled methods allow) the strength drops from sig to sig2 beyond u_e.
struct Bilinear : StrengthConstants {
    static constexpr bool has_psi = true;
    double break_point;  // u2

    // a is sig2, b is u2.
    Bilinear(const Properties& p, const LawEntries& at)
        : StrengthConstants(p[at.k], p[at.Gc], p[at.sig] / p[at.k],
                            elastic_limit_of(p, at) + (2.0 * p[at.Gc] - p[at.sig] * p[at.b]) / p[at.a]),
          break_point(p[at.b]) {
        const double sig = p[at.sig], sig2 = p[at.a], u2 = break_point, u_e = elastic_limit;
        if (!(sig2 > 0.0)) p.refuse(at.a, "> 0: the stress at the break");
        if (!(u2 >= u_e)) p.refuse(at.b, "at least sig/k = " + format_number(u_e));
        if (!(sig2 <= stiffness * u2)) p.refuse(at.a, "at most k u2 = " + format_number(stiffness * u2));
        const double least = 0.5 * (sig * u2 + sig2 * (u2 - u_e));
        if (!(toughness > least) || !(end > u2))
            p.refuse(at.Gc, "greater than (sig u2 + sig2 (u2 - u_e))/2 = " + format_number(least));
        check_range(p, at);

        // S = strength - softening delta on each branch
        drops_ = u2 == u_e;
        const double reach = u2 - u_e;
        first_ = drops_ ? Branch{sig, 0.0} : Branch{(sig * u2 - sig2 * u_e) / reach, (sig - sig2) / reach};
        second_ = {sig2 * end / (end - u2), sig2 / (end - u2)};
        release_second_ = 0.5 * sig2 * end / (end - u2);
        energy_first_ = toughness - 0.5 * sig2 * end;
        release_first_ = drops_ ? 0.0 : energy_first_ / reach;
        break_integrity = sig2 / (stiffness * u2);
        first_fall_ = first_.softening / stiffness;
        second_fall_ = second_.softening / stiffness;
        psi_break_ = drops_ ? 0.0 : branch_psi(first_, u_e, u2);
    }
    bool drops() const { return drops_; }
    double break_integrity;

    template <class Real>
    Real integrity(const Real& delta) const {
        const Mask<Real> first = on_first(delta);
        // The differences from the ends of the branches keep q exact there.
        const Real from_limit = elastic_limit - first_fall_ * (delta - elastic_limit);
        const Real to_end = second_fall_ * (end - delta);
        return select(first, from_limit, to_end) / delta;
    }
    template <class Real>
    Real slope(const Real& delta) const {
        return select(on_first(delta), Real(-first_.softening), Real(-second_.softening));
    }
    template <class Real>
    Real released_energy(const Real& delta) const {
        return select(on_first(delta), release_first_ * (delta - elastic_limit),
                      energy_first_ + release_second_ * (delta - break_point));
    }
    template <class Real>
    Real release_rate(const Real& delta) const {
        return select(on_first(delta), Real(release_first_), Real(release_second_));
    }
    template <class Real>
    Real opening(const Real& q) const {
        const Mask<Real> first = q >= Real(break_integrity);
        const Real delta = select(first, Real(first_.strength), Real(second_.strength)) /
                           (select(first, Real(first_.softening), Real(second_.softening)) + stiffness * q);
        return min(delta, Real(end));
    }
    template <class Real>
    Real psi(const Real& delta) const {
        const Mask<Real> first = on_first(delta);
        const Real one = branch_psi(first_, elastic_limit, min(delta, Real(break_point)));
        if (all(first)) return one;
        return select(first, one, psi_break_ + branch_psi(second_, break_point, max(delta, Real(break_point))));
    }
    template <class Real>
    Real opening_at(const Real& psi_value) const {
        return opening_at_psi(*this, psi_value, start_at_psi(*this, psi_value));
    }

  private:
    struct Branch {
        double strength, softening;  // P, M of S = P - M delta; phi = P
    };
    static double elastic_limit_of(const Properties& p, const LawEntries& at) { return p[at.sig] / p[at.k]; }

    template <class Real>
    Mask<Real> on_first(const Real& delta) const {
        return delta <= Real(break_point);
    }
    template <class Real>
    static Real branch_psi(const Branch& b, double from, const Real& delta) {
        return b.strength * (b.strength * quick_log1p(Real((delta - from) / from)) - b.softening * (delta - from));
    }

    Branch first_, second_;
    double release_first_, release_second_, energy_first_;  // phi/2 on the branches, G1
    double first_fall_, second_fall_;                       // M/k
    double psi_break_;
    bool drops_;
};

}  // namespace lode
