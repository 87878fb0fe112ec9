// Matrix forms of the Jaumann tangent of hyperelastic laws (page 50, section 1.5). Columns are engineering strains.
#pragma once

#include "lode/material/point.hpp"
#include "lode/tensor/kinematics.hpp"

namespace lode {

// C = factor M(A) + volumetric 1 (x) 1, where M(A) : D = D A + A D for a symmetric A. In plane stress this is the
// in-plane part, which is not condensed.
template <AnalysisKind kind>
LODE_INLINE void set_stretching_tangent(Tangent<kind>& c, double factor, const Stress<with_thickness(kind), double>& a,
                                        double volumetric) {
    constexpr int n = normal_components(kind);
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) c(i, j) = i == j ? volumetric + 2.0 * factor * a[i] : volumetric;

    const double a12 = factor * a[3];
    c(0, n) = c(1, n) = c(n, 0) = c(n, 1) = a12;
    c(n, n) = 0.5 * factor * (a[0] + a[1]);
    if constexpr (n == 3) c(2, n) = c(n, 2) = 0.0;
    if constexpr (kind == AnalysisKind::solid) {
        const double a13 = factor * a[4], a23 = factor * a[5];
        c(0, 4) = c(2, 4) = c(4, 0) = c(4, 2) = a13;
        c(1, 4) = c(4, 1) = 0.0;
        c(1, 5) = c(2, 5) = c(5, 1) = c(5, 2) = a23;
        c(0, 5) = c(5, 0) = 0.0;
        c(4, 4) = 0.5 * factor * (a[0] + a[2]);
        c(5, 5) = 0.5 * factor * (a[1] + a[2]);
        c(3, 4) = c(4, 3) = 0.5 * a23;
        c(3, 5) = c(5, 3) = 0.5 * a13;
        c(4, 5) = c(5, 4) = 0.5 * a12;
    }
}

}  // namespace lode
