// Matrix forms of the Jaumann tangent of hyperelastic laws (page 50, section 1.5). Columns are engineering strains.
#pragma once

#include "lode/material/point.hpp"
#include "lode/tensor/kinematics.hpp"

namespace lode {

// Sets C from its columns.
template <AnalysisKind kind>
inline void set_columns(Tangent<kind>& c, const double (&columns)[components(kind)][components(kind)]) {
    for (int j = 0; j < components(kind); ++j)
        for (int i = 0; i < components(kind); ++i) c(i, j) = columns[j][i];
}

// C = factor M(A) + volumetric 1 (x) 1, where M(A) : D = D A + A D for a symmetric A. In plane stress this is the
// in-plane part, which is not condensed.
template <AnalysisKind kind>
inline void set_stretching_tangent(Tangent<kind>& c, double factor, const Stress<with_thickness(kind), double>& a,
                                   double volumetric) {
    const double v = volumetric, d1 = factor * a[0], d2 = factor * a[1], d3 = factor * a[2], a12 = factor * a[3];
    if constexpr (kind == AnalysisKind::solid) {
        const double a13 = factor * a[4], a23 = factor * a[5];
        set_columns(c, {{v + 2.0 * d1, v, v, a12, a13, 0.0},
                        {v, v + 2.0 * d2, v, a12, 0.0, a23},
                        {v, v, v + 2.0 * d3, 0.0, a13, a23},
                        {a12, a12, 0.0, 0.5 * (d1 + d2), 0.5 * a23, 0.5 * a13},
                        {a13, 0.0, a13, 0.5 * a23, 0.5 * (d1 + d3), 0.5 * a12},
                        {0.0, a23, a23, 0.5 * a13, 0.5 * a12, 0.5 * (d2 + d3)}});
    } else if constexpr (kind == AnalysisKind::plane_strain) {
        set_columns(c, {{v + 2.0 * d1, v, v, a12},
                        {v, v + 2.0 * d2, v, a12},
                        {v, v, v + 2.0 * d3, 0.0},
                        {a12, a12, 0.0, 0.5 * (d1 + d2)}});
    } else {
        set_columns(c, {{v + 2.0 * d1, v, a12}, {v, v + 2.0 * d2, a12}, {a12, a12, 0.5 * (d1 + d2)}});
    }
}

}  // namespace lode
