// The isotropic stiffness of a kind from its shear and bulk modulus, condensed where stresses vanish.
#pragma once

#include "lode/elastic/isotropic_tangent.hpp"

namespace lode {

// Returns the normal entries of C 1: the stress that a free strain held back causes, per unit of it.
template <AnalysisKind kind>
LODE_INLINE double set_isotropic_stiffness(Tangent<kind>& c, double G, double K) {
    const double lambda = K - (2.0 / 3.0) * G, shear = 2.0 * G;
    if constexpr (kind == AnalysisKind::uniaxial) {
        c(0, 0) = 9.0 * K * G / (3.0 * K + G);
        return c(0, 0);
    } else if constexpr (kind == AnalysisKind::plane_stress) {
        const double coupling = lambda * shear / (lambda + shear);
        set_isotropic(c, coupling, shear);
        return shear + 2.0 * coupling;
    } else {
        set_isotropic(c, lambda, shear);
        return 3.0 * K;
    }
}

}  // namespace lode
