// The nonlinear pressure laws of VISCOELASTIC (page 60, section 2; Nairn, 10.1.8): -P/b = U'(Js) as Cauchy pressure,
// with Js = J/Jres the volume ratio over that of free expansion and U one of the dilatational energies.
#pragma once

#include "lode/hyperelastic/dilatational_energy.hpp"
#include "lode/numerics/root.hpp"

namespace lode {

class PressureLaw {
  public:
    PressureLaw() = default;
    // `number` is PLAW: 0 if the pressure is linear.
    PressureLaw(int number, double bulk_modulus) : number_(number), energy_{number - 1, bulk_modulus} {}

    bool is_linear() const { return number_ == 0; }
    bool is_logarithmic() const { return number_ == 3; }

    // Js from J and Jres less one.
    template <class Real>
    LODE_INLINE VolumeRatio<Real> ratio(const Real& j, const Real& res) const {
        VolumeRatio<Real> Js = unlogged_ratio(j, res);
        if (is_logarithmic()) Js.ln = Js.logarithm();
        return Js;
    }
    // -P and its derivative by ln J.
    template <class Real>
    LODE_INLINE Real tension(const VolumeRatio<Real>& Js) const {
        return energy_.derivative(Js);
    }
    template <class Real>
    LODE_INLINE Real modulus(const VolumeRatio<Real>& Js) const {
        return energy_.stiffness(Js) - energy_.derivative(Js);
    }

    // An increment in which ln Js grows by `growth`.
    template <class Real>
    struct Change {
        Real before, after;  // -P
        Real slope;          // of `after` by ln J
        Real stored;         // int -P d ln J: what the pressure stores of the work that is measured like s : de
        Mask<Real> positive, stiff;
    };
    template <class Real>
    LODE_INLINE Change<Real> change(const Real& j0, const Real& res0, const Real& j1, const Real& res1,
                                    const Real& growth) const {
        const VolumeRatio<Real> old = unlogged_ratio(j0, res0), now = unlogged_ratio(j1, res1);
        if (number_ == 1) return change_of<1>(old, now, growth);
        return number_ == 2 ? change_of<2>(old, now, growth) : change_of<3>(old, now, growth);
    }

  private:
    int number_ = 0;
    DilatationalEnergy energy_;

    template <class Real>
    LODE_INLINE static VolumeRatio<Real> unlogged_ratio(const Real& j, const Real& res) {
        const Real J = 1.0 + j, Jres = 1.0 + res, both = 1.0 / (J * Jres), inverse = J * both;
        return VolumeRatio<Real>((j - res) * inverse, J * inverse, (Jres * Jres) * both);
    }
    template <int law, class Real>
    LODE_INLINE Change<Real> change_of(VolumeRatio<Real> old, VolumeRatio<Real> now, const Real& growth) const {
        const DilatationalEnergy energy{law - 1, energy_.modulus};
        Change<Real> r;
        if constexpr (law == 1) {
            r.stored = 0.5 * energy.modulus * (square(now.j) * now.inverse);
        } else {
            // One series serves both logarithms.
            r.stored = energy.modulus * now.excess_over_log();
            if constexpr (law == 3) {
                now.ln = now.logarithm();
                old.ln = now.ln - growth;
                r.stored = r.stored * now.inverse;
            }
        }
        r.before = energy.derivative(old);
        r.after = energy.derivative(now);
        r.slope = energy.stiffness(now) - r.after;
        r.positive = now.J > Real(0.0);
        r.stiff = Mask<Real>(true);
        if constexpr (law == 3) r.stiff = now.ln < Real(1.0);  // -P has its extreme at Js = e
        return r;
    }
};

// J - 1 after a logarithmic volume strain `growth`.
template <class Real>
LODE_INLINE Real grown(const Real& j, const Real& growth) {
    return j + (1.0 + j) * quick_expm1(growth);
}

// The lateral stress of plane stress (33) or 1D (22 = 33), over b, as a function of the lateral strain increment.
template <class Real>
struct LateralStress {
    PressureLaw law;
    Real deviatoric, deviatoric_slope;  // at zero lateral strain
    Real trace, j0, res;                // in-plane part of tr DSTRAN; J - 1 before, Jres - 1 after
    double components;                  // that are lateral

    LODE_INLINE Residual<Real> operator()(const Real& lateral) const {
        const VolumeRatio<Real> Js = law.ratio(grown(j0, trace + components * lateral), res);
        return {deviatoric + deviatoric_slope * lateral + law.tension(Js),
                deviatoric_slope + components * law.modulus(Js)};
    }
};

}  // namespace lode
