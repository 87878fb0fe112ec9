// Degradation laws of phase-field fracture (page 35, sections 7 and 8; Nairn, 6.3.3): g(phi) = (1 - k) ghat(phi) + k,
// and the phase that solves the field equation without its gradient term, phi = -g'(phi) ELL H/GC.
#pragma once

#include "lode/damage/phase_field_description.hpp"
#include "lode/material/properties.hpp"
#include "lode/numerics/lambert.hpp"

namespace lode {

template <class Real>
struct Degraded {
    Real g, slope, curvature;  // g, g', g''
};

class Degradation {
  public:
    enum Law { quadratic = 1, exponential, cubic, linear_softening };

    explicit Degradation(const Properties& p)
        : law_(p.code(phase_field::GLAW)), residual_(p[phase_field::KSTAB]), share_(1.0 - residual_) {
        using namespace phase_field;
        constexpr double by_default[] = {1.0, 3.0, 2.0 / 3.0, 4.0};
        argument_ = p[GARG] == -1.0 ? by_default[law_ - 1] : p[GARG];
        if (law_ == exponential && !(argument_ > 0.0)) p.refuse(GARG, "> 0 for GLAW 2, or -1 for its default");
        if (law_ == linear_softening && !(argument_ > 0.0)) p.refuse(GARG, "> 0 for GLAW 4, or -1 for its default");
        if ((law_ == quadratic || law_ == cubic) && !(argument_ >= 0.0 && argument_ <= 1.0))
            p.refuse(GARG, "[0, 1] for GLAW 1 and 3, or -1 for its default");
        if (law_ == exponential) scale_ = -1.0 / std::expm1(-argument_);
        if (law_ == cubic) argument_ = 3.0 * argument_ - 2.0;
        log_ = law_ == exponential ? std::log(argument_ * argument_ * scale_) : 0.0;
    }

    // chi of linear softening.
    double argument() const { return argument_; }
    bool has_threshold() const { return law_ == linear_softening; }
    // 1 - k.
    double share() const { return share_; }

    // For phi >= 0. Beyond 1 there is nothing left to degrade.
    template <class Real>
    LODE_INLINE Degraded<Real> at(const Real& phi) const {
        const Real one(1.0), zero(0.0), rest = one - phi;
        Real ghat, slope, curvature;
        switch (law_) {
            case quadratic: {
                const double c = 2.0 * argument_ - 1.0;
                ghat = rest * (1.0 - c * phi);
                slope = -2.0 * (argument_ - c * phi);
                curvature = Real(2.0 * c);
                break;
            }
            case exponential: {
                const double a = argument_;
                // Without loss of digits where a phi is small or large.
                const Real power = -a * min(phi, one);
                const Real lost = a < 1.0 ? Real(expm1(power)) : Real(exp(power) - 1.0);
                ghat = 1.0 + scale_ * lost;
                slope = (-a * scale_) * (a < 1.0 ? Real(1.0 + lost) : Real(exp(power)));
                curvature = -a * slope;
                break;
            }
            case cubic: {
                const double b = argument_;
                const Real c = 2.0 + b - 3.0 * b * phi;
                ghat = rest * rest * (1.0 - b * phi);
                slope = -rest * c;
                curvature = c + 3.0 * b * rest;
                break;
            }
            default: {
                const double chi = argument_;
                const Real half = (0.5 * chi) * phi, S = sqrt(1.0 + chi + half * half), u = S - half;
                const Real inverse = 1.0 / S, q = u * inverse;
                ghat = rest * (1.0 + u) / (1.0 + S + half);  // 1 + chi phi^2/2 - phi S
                slope = -u * q;
                curvature = q * q * (chi + (0.25 * chi * chi) * phi * inverse);
            }
        }
        const Mask<Real> beyond = phi > one;
        ghat = select(beyond, zero, max(ghat, zero));
        return {share_ * ghat + residual_, select(beyond, zero, Real(share_ * slope)),
                select(beyond, zero, Real(share_ * curvature))};
    }

    // The local phase at x = (1 - k) ELL H/GC >= 0, in [0, 1].
    template <class Real>
    LODE_INLINE Real local_phase(const Real& x) const {
        const Real one(1.0), zero(0.0);
        switch (law_) {
            case quadratic: {
                const Real denominator = 1.0 + (2.0 * (2.0 * argument_ - 1.0)) * x;
                const Mask<Real> broken = denominator <= (2.0 * argument_) * x;
                return select(broken, one, (2.0 * argument_) * x / select(broken, one, denominator));
            }
            case exponential: {
                // a phi e^(a phi) = a^2 x/(1 - e^-a)
                const Mask<Real> drives = x > Real(1e-290);
                const Real log_y = log_ + log(select(drives, x, one));
                const Real w = lambert_w0_of_exponential(log_y);
                // One step of Newton for w itself: its logarithm is not accurate where it is small.
                const Real y = (argument_ * argument_ * scale_) * x;
                const Real decayed = y * exp(-w), better = w - (w - decayed) / (1.0 + decayed);
                return select(drives, min(Real((1.0 / argument_) * better), one), zero);
            }
            case cubic: {
                // A phi^2 + B phi + C = 0, divided by 1 + x so that nothing overflows.
                const double b = argument_;
                const Real inverse = 1.0 / (1.0 + x), part = x * inverse;
                const Real minus_B = inverse + (2.0 + 4.0 * b) * part, C = (2.0 + b) * part, A = (3.0 * b) * part;
                const Real root = sqrt(max(
                    Real(inverse * inverse + part * (4.0 * (1.0 + 2.0 * b) * inverse + square(2.0 * (1.0 - b)) * part)),
                    zero));
                const Mask<Real> ahead = minus_B > zero;
                const Real top = select(ahead, Real(2.0 * C), Real(minus_B - root));
                const Real bottom = select(ahead, Real(minus_B + root), Real(2.0 * A));
                return min(Real(top / select(bottom == zero, one, bottom)), one);
            }
            default: {
                // The inverse of the law, phi = (1 - ghat)/sqrt(1 + chi ghat).
                const double chi = argument_;
                const Real y = sqrt(1.0 + (2.0 * chi) * x);
                const Real lost = (2.0 * (1.0 + chi)) * x / (y * (1.0 + y));
                const Mask<Real> broken = lost >= one;
                return select(broken, one, lost / sqrt(1.0 + chi * max(Real(1.0 - lost), zero)));
            }
        }
    }

  private:
    int law_;
    double residual_, share_, argument_ = 0.0;
    double scale_ = 1.0, log_ = 0.0;  // 1/(1 - e^-a), ln(a^2/(1 - e^-a))
};

}  // namespace lode
