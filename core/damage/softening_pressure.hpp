// Shear strength that depends on pressure (page 30, section 4; Nairn, 5.6).
#pragma once

#include "lode/damage/softening_law.hpp"

namespace lode {

// tau(P) with its derivatives, P = -tr(sigma)/3 positive in compression.
template <class Real>
struct ShearStrength {
    Real value, slope, curvature;
};

class PressureDependence {
  public:
    enum Model { none, linear, step_linear, step_exponential, sigmoidal };

    // `tauc`: the shear strength without pressure; `high`: TAUH.
    PressureDependence(int model, double tauc, double high, double p1, double p2)
        : model_(model),
          strength_(tauc),
          rise_(high - tauc),
          p1_(p1),
          p2_(p2),
          slope_(model == linear        ? tauc / high
                 : model == step_linear ? rise_ / (p2 - p1)
                                        : 0.0),
          rate_(model >= step_exponential ? ln2 / p2 : 0.0) {}

    bool active() const { return model_ != none; }

    // `rs`: relative strength of the point; `largest`: what keeps the law from snapping back.
    template <class Real>
    LODE_INLINE ShearStrength<Real> at(const Real& P, const Real& rs, const Real& largest) const {
        const Real zero(0.0);
        ShearStrength<Real> tau{rs * strength_, zero, zero};
        switch (model_) {
            case linear:
                tau.value = tau.value + slope_ * P;
                tau.slope = Real(slope_);
                break;
            case step_linear: {
                const Real x = P - p1_;
                tau.value = tau.value + slope_ * rs * min(positive_part(x), Real(p2_ - p1_));
                tau.slope = select(x > zero && P < Real(p2_), slope_ * rs, zero);
                break;
            }
            case step_exponential: {
                const Real x = P - p1_, part = quick_exp(Real(-rate_ * positive_part(x)));
                tau.value = tau.value + rise_ * rs * (1.0 - part);
                tau.slope = select(x > zero, rate_ * rise_ * rs * part, zero);
                tau.curvature = -rate_ * tau.slope;
                break;
            }
            case sigmoidal: {
                const Real part = 1.0 / (1.0 + quick_exp(bounded(Real(-rate_ * (P - p1_)))));
                tau.value = tau.value + rise_ * rs * part;
                tau.slope = rate_ * rise_ * rs * part * (1.0 - part);
                tau.curvature = rate_ * tau.slope * (1.0 - 2.0 * part);
                break;
            }
            default:
                break;
        }
        const Real smallest = least(rs);
        const Mask<Real> clamped = tau.value < smallest || tau.value > largest;
        tau.value = max(min(tau.value, largest), smallest);
        tau.slope = select(clamped, zero, tau.slope);
        tau.curvature = select(clamped, zero, tau.curvature);
        return tau;
    }

    // A sigmoid has no kinks but where it is clamped.
    template <class Real>
    LODE_INLINE Mask<Real> is_smooth(const ShearStrength<Real>& from, const ShearStrength<Real>& to, const Real& rs,
                                     const Real& largest) const {
        if (model_ != sigmoidal) return Mask<Real>(false);
        return from.slope > Real(0.0) && to.value > least(rs) && to.value < largest;
    }

  private:
    template <class Real>
    LODE_INLINE Real least(const Real& rs) const {
        return 1e-3 * rs * strength_;
    }
    // An exponential that overflows has no derivative.
    template <class Real>
    LODE_INLINE static Real bounded(const Real& exponent) {
        if constexpr (is_differentiated<Real>) return max(min(exponent, Real(700.0)), Real(-700.0));
        else return exponent;
    }

    static constexpr double ln2 = 0.693147180559945309417;

    int model_;
    double strength_, rise_, p1_, p2_;
    double slope_, rate_;
};

}  // namespace lode
