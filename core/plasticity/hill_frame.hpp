// Material axes of HILL_PLASTIC in the host's: R = Q R0, where Q is what the host has turned so far (page 20, section
// 5). Q itself is kept in STATEV, row by row; all zero means I. An explicit host and one that keeps stress in the
// unrotated frame need no Q: R = R0 there.
#pragma once

#include "lode/elastic/material_axes.hpp"

namespace lode {

template <AnalysisKind kind, class Real>
struct MaterialFrame {
    bool is_turned = false;  // the axes are not those of the host
    bool is_kept = false;    // Q belongs into STATEV
    Matrix3<Real> R, Q;

    // At the end of the increment: Q <- DROT Q.
    LODE_INLINE static MaterialFrame at_end(const Increment<kind, Real>& increment, const State<Real>& state, int first,
                                            const MaterialAxes& axes) {
        MaterialFrame frame;
        Matrix3<Real> own;
        for (std::size_t i = 0; i < 9; ++i) own.m[i] = Real(axes.r.m[i]);
        frame.R = own;
        frame.is_turned = axes.r.m != Matrix3<double>::identity().m;
        if constexpr (!is_batch<Real>) {
            if (!increment.has_rotation()) return frame;
            bool is_zero = true, is_identity = true, is_still = true;
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) {
                    const double unit = i == j ? 1.0 : 0.0;
                    frame.Q(i, j) = state[first + 3 * i + j];
                    is_zero = is_zero && frame.Q(i, j) == Real(0.0);
                    is_identity = is_identity && frame.Q(i, j) == Real(unit);
                    is_still = is_still && increment.rotation_source[i + 3 * j] == unit;
                }
            frame.is_kept = true;
            if (is_zero) frame.Q = Matrix3<Real>::identity();
            if (!is_still) frame.Q = increment.rotation() * frame.Q;
            if (!is_still || !(is_zero || is_identity)) {
                frame.R = frame.Q * own;
                frame.is_turned = true;
            }
        }
        return frame;
    }

    template <class V>
    LODE_INLINE V to_material(const V& x) const {
        return is_turned ? rotate(x, transpose(R)) : x;
    }
    template <class V>
    LODE_INLINE V to_host(const V& x) const {
        return is_turned ? rotate(x, R) : x;
    }

    // D_host = T^T D T of eps_material = T eps_host, and DDSDDT, DRPLDE with it.
    LODE_INLINE void turn(Tangent<kind>& tangent) const {
        if constexpr (std::is_same_v<Real, double>) {
            if (!is_turned) return;
            constexpr int n = components(kind);
            VoigtMatrix<kind, double> d;
            std::copy_n(tangent.stiffness, n * n, d.m.begin());
            d = rotate_stiffness<kind>(d, R);
            std::copy_n(d.m.begin(), n * n, tangent.stiffness);
            Stress<kind, double> by_temperature, heat;
            for (int i = 0; i < n; ++i)
                by_temperature[i] = tangent.thermal_stress[i], heat[i] = tangent.heat_rate_strain[i];
            by_temperature = rotate(by_temperature, R);
            heat = rotate(heat, R);
            for (int i = 0; i < n; ++i)
                tangent.thermal_stress[i] = by_temperature[i], tangent.heat_rate_strain[i] = heat[i];
        }
    }

    LODE_INLINE void store(State<Real>& state, int first) const {
        for (int i = 0; i < 9; ++i) {
            if (is_kept) state.set(first + i, Q.m[static_cast<std::size_t>(i)]);
            else state.keep(first + i);
        }
    }
};

}  // namespace lode
