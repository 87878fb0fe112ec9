// How the axes of an anisotropic material lie in the host's basis, and how they turn (page 10, sections 1.2, 1.3).
#pragma once

#include <bit>
#include <cstdint>

#include "lode/material/point.hpp"
#include "lode/material/properties.hpp"
#include "lode/tensor/rotation.hpp"

namespace lode {

// R0: columns are the material axes in the host's basis, x_host = R0 x_material.
struct MaterialAxes {
    Matrix3<double> r = Matrix3<double>::identity();

    // R0 = Rz(angz) Ry(angy) Rx(angx); PROPS(first) ... PROPS(first + 2) = angz, angy, angx in degrees.
    static MaterialAxes from_properties(const Properties& p, int first) {
        return {rotation_from_angles(p[first], p[first + 1], p[first + 2])};
    }

    // The entry of row 3 with the largest magnitude: 1 where a material axis is normal to the plane of a 2D element.
    double normal_entry() const { return std::max({std::abs(r(2, 0)), std::abs(r(2, 1)), std::abs(r(2, 2))}); }
    bool fit_plane_kinds() const { return normal_entry() >= 1.0 - 1e-9; }
    // The axes are those of the host but for order and sign: the stiffness keeps its zeros.
    bool along_host() const {
        for (const double x : r.m)
            if (x != 0.0 && std::abs(x) != 1.0) return false;
        return true;
    }

    // Ends the analysis where the kind cannot have these axes; false then.
    template <AnalysisKind kind, class Real>
    LODE_INLINE bool serve(Point<kind, Real>& point) const {
        if constexpr (kind == AnalysisKind::plane_strain || kind == AnalysisKind::plane_stress) {
            if (!fit_plane_kinds()) [[unlikely]] {
                point.refuse(Mask<Real>(true),
                             "material axes of a 2D element must keep one axis normal to the plane: the largest entry "
                             "in row 3 of Rz(ANGZ) Ry(ANGY) Rx(ANGX)",
                             Real(normal_entry()), "of magnitude 1 (ANGY, ANGX multiples of 90)");
                return false;
            }
        }
        return true;
    }
};

// The rotation Q that the host has applied so far, kept in STATEV as Q - I row by row (zeros mean I).
template <AnalysisKind kind, class Real>
struct HostRotation {
    static constexpr bool is_plane = kind == AnalysisKind::plane_strain || kind == AnalysisKind::plane_stress;
    static constexpr bool turns = kind == AnalysisKind::solid || is_plane;  // a bar has no rotation
    static constexpr int size = is_plane ? 2 : 3;

    Matrix3<Real> minus_identity;  // plane kinds: rotation about 3

    // True where neither this increment nor any before it has turned the frame; the usual case without NLGEOM.
    LODE_INLINE static bool is_identity(const Increment<kind, Real>& increment, const State<Real>& state, int first) {
        if constexpr (!turns || is_batch<Real>) return true;
        else {
            if (!increment.has_rotation()) return true;
            // Bits, which are cheaper to compare: -0 counts as turned, and gives the same result.
            std::uint64_t difference = 0;
            for (int i = 0; i < size; ++i)
                for (int j = 0; j < size; ++j) {
                    difference |= std::bit_cast<std::uint64_t>(increment.rotation_source[i + 3 * j]) ^
                                  std::bit_cast<std::uint64_t>(i == j ? 1.0 : 0.0);
                    difference |= std::bit_cast<std::uint64_t>(value_of(state[first + 3 * i + j]));
                }
            return difference == 0;
        }
    }

    // Q <- DROT Q: (Q - I) <- DROT (Q - I) + (DROT - I). STATEV is left alone.
    LODE_INLINE static HostRotation advanced(const Increment<kind, Real>& increment, const State<Real>& state,
                                             int first) {
        const Matrix3<Real> drot = increment.rotation();
        HostRotation q;
        for (Real& x : q.minus_identity.m) x = Real(0.0);
        for (int i = 0; i < size; ++i)
            for (int j = 0; j < size; ++j) {
                Real sum = i == j ? drot(i, j) - 1.0 : drot(i, j);
                for (int k = 0; k < size; ++k) sum = sum + drot(i, k) * state[first + 3 * k + j];
                q.minus_identity(i, j) = sum;
            }
        return q;
    }

    // R = Q R0.
    LODE_INLINE Matrix3<Real> times(const MaterialAxes& axes) const {
        Matrix3<Real> r;
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 3; ++i) {
                Real sum = Real(axes.r(i, j));
                if (i < size)
                    for (int k = 0; k < size; ++k) sum = sum + minus_identity(i, k) * axes.r(k, j);
                r(i, j) = sum;
            }
        return r;
    }

    LODE_INLINE void store(State<Real>& state, int first) const {
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                if (i < size && j < size) state.set(first + 3 * i + j, minus_identity(i, j));
                else state.keep(first + 3 * i + j);
            }
    }
};

}  // namespace lode
