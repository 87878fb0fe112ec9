// The plastic strain that the plasticity models keep in STATEV 11-16 where the host provides so many (page 20,
// section 1): 3D 11, 22, 33, 12, 13, 23; plane kinds 11, 22, 33, 12; engineering shears; rotated with DROT.
#pragma once

#include "lode/material/point.hpp"

namespace lode {

inline constexpr int plastic_strain_slot = 11;

// In plane stress as well the strain has its thickness component.
constexpr AnalysisKind plastic_strain_layout(AnalysisKind kind) {
    return kind == AnalysisKind::solid ? AnalysisKind::solid : AnalysisKind::plane_strain;
}

template <AnalysisKind kind, class Real>
LODE_INLINE bool keeps_plastic_strain(const Point<kind, Real>& point) {
    return point.state.has(plastic_strain_slot + 5);
}

// Adds an increment.
template <AnalysisKind kind, class Real>
LODE_INLINE void store_plastic_strain(const Increment<kind, Real>& increment, Point<kind, Real>& point,
                                      const Strain<plastic_strain_layout(kind), Real>& plastic_strain) {
    constexpr int n = components(plastic_strain_layout(kind));
    Strain<plastic_strain_layout(kind), Real> total;
    for (int i = 0; i < n; ++i) total[i] = point.state[plastic_strain_slot + i];
    if (increment.has_rotation()) total = rotate(total, increment.rotation());
    for (int i = 0; i < n; ++i) point.state.set(plastic_strain_slot + i, total[i] + plastic_strain[i]);
}

}  // namespace lode
