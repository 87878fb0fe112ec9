// The dilatational energies U(J) that all hyperelastic models share (page 50, section 1.4), written in j = J - 1.
#pragma once

#include "lode/material/description.hpp"
#include "lode/numerics/scalar.hpp"

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

    VolumeRatio(const Real& volume_change, const Real& ratio) : j(volume_change), J(ratio), inverse(1.0 / ratio) {}

    Real logarithm() const {
        const Mask<Real> near_one = j > Real(-0.5);
        return all(near_one) ? log1p(j) : select(near_one, log1p(j), log(J));
    }
    // j - ln J, of second order in j. Small j: ln J = 2 artanh(s) with s = j/(2 + j), so that nothing cancels and no
    // logarithm is needed.
    Real excess_over_log() const {
        const Mask<Real> small = abs(j) < Real(0.25);
        if (!any(small)) return j - logarithm();
        const Real s = j / (2.0 + j), x = s * s, x2 = x * x;
        const Real tail = (1.0 / 3 + x * (1.0 / 5)) + x2 * (1.0 / 7 + x * (1.0 / 9)) +
                          x2 * x2 * ((1.0 / 11 + x * (1.0 / 13)) + x2 * (1.0 / 15 + x * (1.0 / 17 + x * (1.0 / 19))));
        const Real series = s * (j - 2.0 * x * tail);
        return all(small) ? series : select(small, series, j - logarithm());
    }
};

struct DilatationalEnergy {
    int option = 0;
    double modulus = 0.0;  // k: the bulk modulus, or Lame's lambda in the neo-Hookean models

    template <class Real>
    VolumeRatio<Real> volume_ratio(const Real& j, const Real& J) const {
        VolumeRatio<Real> v(j, J);
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
