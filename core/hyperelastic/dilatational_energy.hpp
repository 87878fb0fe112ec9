// The dilatational energies U(J) that all hyperelastic models share (page 50, section 1.4), written in j = J - 1.
#pragma once

#include "lode/material/description.hpp"
#include "lode/numerics/functions.hpp"

namespace lode {

// The PROPS entry that chooses among them.
constexpr lode_parameter dilatational_option(double default_value) {
    return optional("UJ", "dilatational energy", "code", code(0, 2), default_value,
                    "with modulus k: 0 k/2 ((J^2 - 1)/2 - ln J), 1 k/2 (J - 1)^2, 2 k/2 (ln J)^2");
}

// The volume ratio in the forms that the laws need, each without cancellation.
template <class Real>
struct VolumeRatio {
    Real j;  // J - 1
    Real J;
    Real inverse;  // 1/J
    Real ln;       // ln J, present only where the energy is written in it

    VolumeRatio(const Real& volume_change, const Real& ratio) : VolumeRatio(volume_change, ratio, 1.0 / ratio) {}
    VolumeRatio(const Real& volume_change, const Real& ratio, const Real& inverse_ratio)
        : j(volume_change), J(ratio), inverse(inverse_ratio) {}

    Real logarithm() const {
        const Mask<Real> near = is_near_one();
        const Series series(j);
        const Real near_value = series.s * (2.0 + 2.0 * series.x * series.tail);
        if (all(near)) [[likely]]
            return near_value;
        return select(near, near_value, far_logarithm());
    }
    // j - ln J, of second order in j.
    Real excess_over_log() const {
        const Mask<Real> near = is_near_one();
        const Series series(j);
        const Real excess = series.s * (j - 2.0 * series.x * series.tail);
        if (all(near)) [[likely]]
            return excess;
        return select(near, excess, j - far_logarithm());
    }

  private:
    // ln J = 2 artanh(s) = 2 s (1 + x tail) with s = j/(2 + j) and x = s^2: nothing cancels, no logarithm is needed,
    // and the rest of the series is below the rounding errors for 1/2 <= J <= 2, |s| <= 1/3.
    Mask<Real> is_near_one() const { return abs(j - 0.25) <= Real(0.75); }
    struct Series {
        Real s, x, tail;

        explicit Series(const Real& j) : s(j / (2.0 + j)), x(s * s) {
            const Real x2 = x * x, x4 = x2 * x2;
            const Real t0 = (1.0 / 3 + x * (1.0 / 5)) + x2 * (1.0 / 7 + x * (1.0 / 9));
            const Real t4 = (1.0 / 11 + x * (1.0 / 13)) + x2 * (1.0 / 15 + x * (1.0 / 17));
            const Real t8 = (1.0 / 19 + x * (1.0 / 21)) + x2 * (1.0 / 23 + x * (1.0 / 25));
            const Real t12 = (1.0 / 27 + x * (1.0 / 29)) + x2 * (1.0 / 31);
            tail = (t0 + x4 * t4) + (x4 * x4) * (t8 + x4 * t12);
        }
    };
    // Elsewhere; not a number where J is not a positive one.
    Real far_logarithm() const {
        if constexpr (std::is_same_v<Real, double>)
            return J > 0.0 && is_finite(J) ? quick_log(J) : std::numeric_limits<double>::quiet_NaN();
        else return log(J);
    }
};

struct DilatationalEnergy {
    int option = 0;
    double modulus = 0.0;  // k: the bulk modulus, or Lame's lambda in the neo-Hookean models

    template <class Real>
    VolumeRatio<Real> volume_ratio(const Real& j, const Real& J) const {
        return volume_ratio(j, J, Real(1.0 / J));
    }
    template <class Real>
    VolumeRatio<Real> volume_ratio(const Real& j, const Real& J, const Real& inverse) const {
        VolumeRatio<Real> v(j, J, inverse);
        if (option == 2) v.ln = v.logarithm();
        return v;
    }

    // U per stress-free volume.
    template <class Real>
    Real energy(const VolumeRatio<Real>& v) const {
        if (option == 0) return 0.5 * modulus * (0.5 * square(v.j) + v.excess_over_log());
        return 0.5 * modulus * square(option == 1 ? v.j : v.ln);
    }
    // U' = dU/dJ, the mean stress it adds.
    template <class Real>
    Real derivative(const VolumeRatio<Real>& v) const {
        if (option == 0) return 0.5 * modulus * (v.j * (2.0 + v.j)) * v.inverse;
        return option == 1 ? modulus * v.j : modulus * v.inverse * v.ln;
    }
    // (J U')' = U' + J U'': the part of the spatial tangent along 1 (x) 1.
    template <class Real>
    Real stiffness(const VolumeRatio<Real>& v) const {
        if (option == 0) return modulus * v.J;
        return option == 1 ? modulus * (2.0 * v.J - 1.0) : modulus * v.inverse;
    }
};

}  // namespace lode
