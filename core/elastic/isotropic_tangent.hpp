// DDSDDE of the isotropic kind, with or without a dyad taken off: coupling 1 x 1 + 2G I - factor s x s.
#pragma once

#include <cstring>
#include <type_traits>

#include "lode/material/point.hpp"

namespace lode {
namespace isotropic_tangent_detail {

// Vectors of GCC and Clang, one for each column of DDSDDE, padded to a power of two. Written entry by entry, the 36
// stores of a three-dimensional tangent cost as much as a radial return.
typedef double Two [[gnu::vector_size(2 * sizeof(double))]];
typedef double Four [[gnu::vector_size(4 * sizeof(double))]];
typedef double Eight [[gnu::vector_size(8 * sizeof(double))]];
template <int n>
using Column = std::conditional_t<(n > 4), Eight, Four>;

// The first 6 or 3 entries.
LODE_INLINE void store_exactly(double* p, const Eight& v) {
    const Four front = __builtin_shufflevector(v, v, 0, 1, 2, 3);
    const Two back = __builtin_shufflevector(v, v, 4, 5);
    std::memcpy(p, &front, sizeof front);
    std::memcpy(p + 4, &back, sizeof back);
}
LODE_INLINE void store_exactly(double* p, const Four& v) {
    const Two front = __builtin_shufflevector(v, v, 0, 1);
    std::memcpy(p, &front, sizeof front);
    p[2] = v[2];
}

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
        // The padding of a column runs over into the next one, which is written later.
        if (j + 1 < n || n == 4) std::memcpy(c.stiffness + n * j, &column, sizeof column);
        else store_exactly(c.stiffness + n * j, column);
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
