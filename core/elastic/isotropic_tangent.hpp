// DDSDDE of the isotropic kind, with or without a dyad taken off: coupling 1 x 1 + 2G I - factor s x s.
#pragma once

#include "lode/elastic/voigt_column.hpp"
#include "lode/material/point.hpp"

namespace lode {
namespace isotropic_tangent_detail {

template <bool with_dyad, AnalysisKind kind>
LODE_INLINE void set(Tangent<kind>& c, double coupling, double twice_shear, double factor,
                     const Stress<kind, double>* s) {
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
        if constexpr (with_dyad) column -= (factor * (*s)[j]) * dyad;
        store_column<n>(c.stiffness, j, column);
    }
}

}  // namespace isotropic_tangent_detail

// c = coupling 1 x 1 + 2G I (engineering strains: G on the shear diagonal).
template <AnalysisKind kind>
LODE_INLINE void set_isotropic(Tangent<kind>& c, double coupling, double twice_shear) {
    isotropic_tangent_detail::set<false>(c, coupling, twice_shear, 0.0,
                                         static_cast<const Stress<kind, double>*>(nullptr));
}
// c = coupling 1 x 1 + 2G I - factor s x s.
template <AnalysisKind kind>
LODE_INLINE void set_isotropic_less_dyad(Tangent<kind>& c, double coupling, double twice_shear, double factor,
                                         const Stress<kind, double>& s) {
    isotropic_tangent_detail::set<true>(c, coupling, twice_shear, factor, &s);
}

}  // namespace lode
