// The analysis kinds, as the host announces them by NDI and NSHR (conventions page).
#pragma once

#include "lode/lode.h"

namespace lode {

enum class AnalysisKind { solid, plane_strain, plane_stress, uniaxial, cohesive_2d, cohesive_3d };
inline constexpr int kind_count = 6;

// Plane strain and axisymmetry share one layout (3,1) and one law: component 33 is the thickness or hoop direction.
constexpr int normal_components(AnalysisKind kind) {
    switch (kind) {
        case AnalysisKind::solid:
        case AnalysisKind::plane_strain:
            return 3;
        case AnalysisKind::plane_stress:
            return 2;
        default:
            return 1;
    }
}
constexpr int shear_components(AnalysisKind kind) {
    switch (kind) {
        case AnalysisKind::solid:
            return 3;
        case AnalysisKind::plane_strain:
        case AnalysisKind::plane_stress:
        case AnalysisKind::cohesive_2d:
            return 1;
        case AnalysisKind::cohesive_3d:
            return 2;
        default:
            return 0;
    }
}
constexpr int components(AnalysisKind kind) { return normal_components(kind) + shear_components(kind); }

constexpr bool is_cohesive(AnalysisKind kind) {
    return kind == AnalysisKind::cohesive_2d || kind == AnalysisKind::cohesive_3d;
}
constexpr unsigned kind_bit(AnalysisKind kind) { return 1u << static_cast<unsigned>(kind); }
constexpr bool serves(const lode_model& model, AnalysisKind kind) { return (model.kinds & kind_bit(kind)) != 0; }

// The kind of a UMAT call, or -1 for a combination of NDI and NSHR that does not exist.
constexpr int kind_from_layout(int ndi, int nshr) {
    for (int k = 0; k < kind_count; ++k)
        if (normal_components(static_cast<AnalysisKind>(k)) == ndi &&
            shear_components(static_cast<AnalysisKind>(k)) == nshr)
            return k;
    return -1;
}

constexpr const char* kind_name(AnalysisKind kind) {
    switch (kind) {
        case AnalysisKind::solid:
            return "3D (3,3)";
        case AnalysisKind::plane_strain:
            return "plane strain or axisymmetric (3,1)";
        case AnalysisKind::plane_stress:
            return "plane stress (2,1)";
        case AnalysisKind::uniaxial:
            return "one-dimensional (1,0)";
        case AnalysisKind::cohesive_2d:
            return "cohesive (1,1)";
        default:
            return "cohesive (1,2)";
    }
}

inline constexpr unsigned continuum_kinds = LODE_SOLID | LODE_PLANE_STRAIN | LODE_PLANE_STRESS | LODE_UNIAXIAL;
inline constexpr unsigned cohesive_kinds = LODE_COHESIVE_2D | LODE_COHESIVE_3D;

}  // namespace lode
