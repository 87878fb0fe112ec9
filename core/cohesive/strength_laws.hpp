// Strength laws S(delta) of one mode (page 40, section 2): the traction at the largest opening delta so far, beyond the
// elastic limit u_e and up to the end of the law u_c. Unloading goes to the origin,
//     T = (S/delta) u = k (1 - D) u,     D = 1 - S/(k delta).
// A law provides, for u_e <= delta <= u_c,
//     integrity(delta)         1 - D; exactly 1 at u_e, and never formed as a difference from D
//     slope(delta)             S'
//     released_energy(delta)   Omega = int_0^delta S - S delta/2, which ends at the toughness Gc
//     release_rate(delta)      dOmega/ddelta = (S - delta S')/2, not negative: damage only grows
// and the members stiffness (k), elastic_limit (u_e), end (u_c), toughness (Gc) and the inverses of the last two.
#pragma once

#include "lode/material/properties.hpp"

namespace lode {

// Code 1, linear softening: S = sig (u_c - delta)/w with w = u_c - u_e.
struct Sawtooth {
    double stiffness, toughness, elastic_limit, end, inverse_end, inverse_toughness;

    // Reads k, sig, Gc from PROPS(first), (first + 1), (first + 2); `mode` is "n" or "t" for the message.
    Sawtooth(const Properties& p, int first, const char* mode)
        : stiffness(p[first]),
          toughness(p[first + 2]),
          elastic_limit(p[first + 1] / stiffness),
          end(2.0 * toughness / p[first + 1]),
          inverse_end(1.0 / end),
          inverse_toughness(1.0 / toughness),
          range_(end - elastic_limit),
          slope_(-p[first + 1] / range_),
          release_rate_(toughness / range_) {
        const double sig = p[first + 1], elastic_energy = 0.5 * sig * sig / stiffness;
        if (!(toughness > elastic_energy) || !(end > elastic_limit))
            p.refuse(first + 2, std::string("greater than sig_") + mode + "^2/(2 k_" + mode +
                                    ") = " + format_number(elastic_energy));
        if (!(elastic_limit > 0.0) || !std::isfinite(end))
            p.refuse(first, "such that sig/k and 2 Gc/sig are ordinary numbers");
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

  private:
    double range_, slope_, release_rate_;  // w, S', phi/2
};

}  // namespace lode
