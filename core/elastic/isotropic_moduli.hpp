// Isotropic linear elasticity: moduli, stiffness and energy in every continuum kind. Shared by all models that are
// elastically isotropic.
#pragma once

#include "lode/elastic/isotropic_tangent.hpp"
#include "lode/material/point.hpp"

namespace lode {

struct IsotropicModuli {
    double young, poisson, shear, bulk, lame;
    double half_compliance;               // 1/(2E)
    double plane_normal, plane_coupling;  // plane-stress stiffness

    static constexpr IsotropicModuli from_young_poisson(double e, double nu) {
        const double plane = e / (1.0 - nu * nu);
        return {.young = e,
                .poisson = nu,
                .shear = e / (2.0 * (1.0 + nu)),
                .bulk = e / (3.0 * (1.0 - 2.0 * nu)),
                .lame = e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
                .half_compliance = 0.5 / e,
                .plane_normal = plane,
                .plane_coupling = nu * plane};
    }

    static constexpr IsotropicModuli from_bulk_shear(double K, double G) {
        const double sum = 3.0 * K + G, lame = K - (2.0 / 3.0) * G, inverse = 1.0 / (lame + 2.0 * G);
        return {.young = 9.0 * K * G / sum,
                .poisson = (1.5 * K - G) / sum,
                .shear = G,
                .bulk = K,
                .lame = lame,
                .half_compliance = sum / (18.0 * K * G),
                .plane_normal = 4.0 * G * (lame + G) * inverse,
                .plane_coupling = 2.0 * G * lame * inverse};
    }

    // Diagonal and off-diagonal normal entries of the stiffness of a kind (plane stress: condensed).
    template <AnalysisKind kind>
    LODE_INLINE constexpr double normal_stiffness() const {
        if constexpr (kind == AnalysisKind::plane_stress) return plane_normal;
        else if constexpr (kind == AnalysisKind::uniaxial) return young;
        else return lame + 2.0 * shear;
    }
    template <AnalysisKind kind>
    LODE_INLINE constexpr double coupling_stiffness() const {
        if constexpr (kind == AnalysisKind::plane_stress) return plane_coupling;
        else return lame;
    }

    // C eps.
    template <AnalysisKind kind, class Real>
    LODE_INLINE Stress<kind, Real> stress(const Strain<kind, Real>& e) const {
        constexpr int normals = normal_components(kind);
        Stress<kind, Real> s;
        if constexpr (kind == AnalysisKind::uniaxial) {
            s[0] = young * e[0];
        } else {
            const double coupling = coupling_stiffness<kind>();
            const double twice_shear = normal_stiffness<kind>() - coupling;  // 2G also in plane stress
            const Real volumetric = coupling * trace(e);
            for (int i = 0; i < normals; ++i) s[i] = volumetric + twice_shear * e[i];
            for (int i = normals; i < components(kind); ++i) s[i] = shear * e[i];
        }
        return s;
    }

    template <AnalysisKind kind>
    LODE_INLINE void set_stiffness(Tangent<kind>& c) const {
        if constexpr (kind == AnalysisKind::uniaxial) c(0, 0) = young;
        else set_isotropic(c, coupling_stiffness<kind>(), 2.0 * shear);
    }

    // d sigma / d temperature at fixed strain, times -1, per unit expansion coefficient: the normal entries of C 1.
    template <AnalysisKind kind>
    LODE_INLINE constexpr double thermal_stiffness() const {
        if constexpr (kind == AnalysisKind::plane_stress) return young / (1.0 - poisson);
        else if constexpr (kind == AnalysisKind::uniaxial) return young;
        else return 3.0 * bulk;
    }

    // sigma : S : sigma / 2 per volume; `out_of_plane` is sigma33 of plane stress.
    template <AnalysisKind kind, class Real>
    LODE_INLINE Real energy(const Stress<kind, Real>& s, double out_of_plane = 0.0) const {
        Real squares = double_contraction(s, s);
        Real sum = trace(s);
        if (out_of_plane != 0.0) {
            squares = squares + out_of_plane * out_of_plane;
            sum = sum + out_of_plane;
        }
        return half_compliance * ((1.0 + poisson) * squares - poisson * (sum * sum));
    }
};

}  // namespace lode
