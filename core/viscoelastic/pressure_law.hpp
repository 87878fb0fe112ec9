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
    // -P has its extreme at Js = e.
    bool is_logarithmic() const { return number_ == 3; }

    // Js from J and Jres less one.
    template <class Real>
    LODE_INLINE VolumeRatio<Real> ratio(const Real& j, const Real& res) const {
        const Real J = 1.0 + j, Jres = 1.0 + res, both = 1.0 / (J * Jres), inverse = J * both;
        return energy_.volume_ratio((j - res) * inverse, J * inverse, (Jres * Jres) * both);
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
    // int -P d ln J: what the pressure stores of the work that is measured like s : de.
    template <class Real>
    LODE_INLINE Real stored(const VolumeRatio<Real>& Js) const {
        if (number_ == 1) return 0.5 * energy_.modulus * (square(Js.j) * Js.inverse);
        const Real excess = energy_.modulus * Js.excess_over_log();
        return number_ == 2 ? excess : excess * Js.inverse;
    }

  private:
    int number_ = 0;
    DilatationalEnergy energy_;
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
