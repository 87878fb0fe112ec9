// DDSDDE of the isotropic kind, with or without dyads: coupling 1 x 1 + 2G I - factor s x s and the like.
#pragma once

#include "lode/elastic/voigt_column.hpp"
#include "lode/material/point.hpp"

namespace lode {
namespace isotropic_tangent_detail {

template <bool with_dyad, AnalysisKind kind>
LODE_INLINE void set(Tangent<kind>& c, double coupling, double twice_shear, double factor,
                     const Stress<kind, double>* s, const Stress<kind, double>* right) {
    constexpr int n = components(kind), normals = normal_components(kind);
    Column<n> dyad{}, normal_column{};
    if constexpr (with_dyad && n == 6) dyad = Column<n>{(*s)[0], (*s)[1], (*s)[2], (*s)[3], (*s)[4], (*s)[5], 0.0, 0.0};
    else if constexpr (with_dyad && n == 4) dyad = Column<n>{(*s)[0], (*s)[1], (*s)[2], (*s)[3]};
    else if constexpr (with_dyad) dyad = Column<n>{(*s)[0], (*s)[1], (*s)[2], 0.0};
    for (int i = 0; i < normals; ++i) normal_column[i] = 1.0;
    normal_column = coupling * normal_column;
    for (int j = 0; j < n; ++j) {
        Column<n> unit{};
        unit[j] = 1.0;
        Column<n> column = (j < normals ? twice_shear : 0.5 * twice_shear) * unit;
        if (j < normals) column += normal_column;
        if constexpr (with_dyad) column -= (factor * (*right)[j]) * dyad;
        store_column<n>(c.stiffness, j, column);
    }
}

}  // namespace isotropic_tangent_detail

// c = coupling 1 x 1 + 2G I (engineering strains: G on the shear diagonal).
template <AnalysisKind kind>
LODE_INLINE void set_isotropic(Tangent<kind>& c, double coupling, double twice_shear) {
    const Stress<kind, double>* none = nullptr;
    isotropic_tangent_detail::set<false>(c, coupling, twice_shear, 0.0, none, none);
}
// c = coupling 1 x 1 + 2G I - factor s x s.
template <AnalysisKind kind>
LODE_INLINE void set_isotropic_less_dyad(Tangent<kind>& c, double coupling, double twice_shear, double factor,
                                         const Stress<kind, double>& s) {
    isotropic_tangent_detail::set<true>(c, coupling, twice_shear, factor, &s, &s);
}
// c = coupling 1 x 1 + 2G I - left x right.
template <AnalysisKind kind>
LODE_INLINE void set_isotropic_less_dyad(Tangent<kind>& c, double coupling, double twice_shear,
                                         const Stress<kind, double>& left, const Stress<kind, double>& right) {
    isotropic_tangent_detail::set<true>(c, coupling, twice_shear, 1.0, &left, &right);
}
// c = coupling 1 x 1 + 2G I + sum weight_k v_k x v_k.
template <int m, AnalysisKind kind>
LODE_INLINE void set_isotropic_plus_dyads(Tangent<kind>& c, double coupling, double twice_shear,
                                          const double (&weight)[m], const Stress<kind, double> (&v)[m]) {
    constexpr int n = components(kind), normals = normal_components(kind);
    Column<n> dyad[m], normal_column{};
    for (int k = 0; k < m; ++k) {
        dyad[k] = Column<n>{};
        for (int i = 0; i < n; ++i) dyad[k][i] = v[k][i];
    }
    for (int i = 0; i < normals; ++i) normal_column[i] = coupling;
    for (int j = 0; j < n; ++j) {
        Column<n> unit{};
        unit[j] = 1.0;
        Column<n> column = (j < normals ? twice_shear : 0.5 * twice_shear) * unit;
        if (j < normals) column += normal_column;
        for (int k = 0; k < m; ++k) column += (weight[k] * v[k][j]) * dyad[k];
        store_column<n>(c.stiffness, j, column);
    }
}

}  // namespace lode
