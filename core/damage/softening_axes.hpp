// Axes of a crack (page 30, sections 2.3 and 4.1): x = N, y = T, z = N x T, in the frame of the host.
#pragma once

#include "lode/damage/softening_crack.hpp"
#include "lode/material/point.hpp"
#include "lode/tensor/matrix3.hpp"

namespace lode {

// Directions that a crack has in a kind.
constexpr int crack_directions(AnalysisKind kind) {
    return kind == AnalysisKind::solid ? 3 : kind == AnalysisKind::uniaxial ? 1 : 2;
}

template <class Real>
LODE_INLINE Real dot(const Vector<Real, 3>& a, const Vector<Real, 3>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class Real>
LODE_INLINE Vector<Real, 3> cross(const Vector<Real, 3>& a, const Vector<Real, 3>& b) {
    return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}
template <class Real>
LODE_INLINE Vector<Real, 3> operator*(const Matrix3<Real>& a, const Vector<Real, 3>& x) {
    Vector<Real, 3> r;
    for (int i = 0; i < 3; ++i) r[i] = a(i, 0) * x[0] + a(i, 1) * x[1] + a(i, 2) * x[2];
    return r;
}

// a (x) b + b (x) a as a stress-like Voigt vector. It is also the covector d(2 a.eps b)/d(engineering strain).
template <AnalysisKind kind, class Real>
LODE_INLINE Stress<kind, Real> symmetric_dyad(const Vector<Real, 3>& a, const Vector<Real, 3>& b) {
    constexpr int n = normal_components(kind);
    Stress<kind, Real> s;
    for (int i = 0; i < n; ++i) s[i] = 2.0 * a[i] * b[i];
    if constexpr (shear_components(kind) >= 1) s[n] = a[0] * b[1] + a[1] * b[0];
    if constexpr (shear_components(kind) == 3) {
        s[n + 1] = a[0] * b[2] + a[2] * b[0];
        s[n + 2] = a[1] * b[2] + a[2] * b[1];
    }
    return s;
}

template <class Real>
struct CrackAxes {
    Vector<Real, 3> N, T, Z;

    // From STATEV; zeros where there is no crack.
    LODE_INLINE static CrackAxes read(const State<Real>& state, int first) {
        CrackAxes axes;
        for (int i = 0; i < 3; ++i) {
            axes.N[i] = state[first + i];
            axes.T[i] = state[first + 3 + i];
        }
        return axes;
    }
    LODE_INLINE void set_third() { Z = cross(N, T); }
    LODE_INLINE void choose(const Mask<Real>& where, const Vector<Real, 3>& normal, const Vector<Real, 3>& tangent) {
        for (int i = 0; i < 3; ++i) {
            N[i] = select(where, normal[i], N[i]);
            T[i] = select(where, tangent[i], T[i]);
        }
    }

    // Turned with the host's frame.
    LODE_INLINE void turn(const Matrix3<Real>& rotation) {
        N = rotation * N;
        T = rotation * T;
        normalise(Mask<Real>(true));
    }

    // Unit vectors at right angles, also where the host has set N alone (a pre-damaged point).
    LODE_INLINE void normalise(const Mask<Real>& where, bool plane = false) {
        const Real zero(0.0), one(1.0);
        Vector<Real, 3> n = N;
        if (plane) n[2] = zero;
        Real size = sqrt(dot(n, n));
        const Mask<Real> lost = !(size > zero);
        n[0] = select(lost, one, n[0]);
        size = select(lost, one, size);
        for (int i = 0; i < 3; ++i) n[i] = n[i] / size;
        Vector<Real, 3> t = T;
        if (plane) {
            // In the plane kinds the crack contains axis 3.
            const Mask<Real> backward = n[0] * T[1] - n[1] * T[0] < zero;
            t[0] = select(backward, n[1], zero - n[1]);
            t[1] = select(backward, zero - n[0], n[0]);
            t[2] = zero;
        } else {
            t = across(t, n);
            Real length = sqrt(dot(t, t));
            const Mask<Real> along = !(length >= Real(1e-8));
            if (any(along)) {
                // The unit vector of the smallest |N_i|.
                const Mask<Real> first = abs(n[0]) <= min(abs(n[1]), abs(n[2]));
                const Mask<Real> second = !first && abs(n[1]) <= abs(n[2]);
                Vector<Real, 3> unit;
                unit[0] = select(first, one, zero);
                unit[1] = select(second, one, zero);
                unit[2] = select(first || second, zero, one);
                unit = across(unit, n);
                for (int i = 0; i < 3; ++i) t[i] = select(along, unit[i], t[i]);
                length = sqrt(dot(t, t));
            }
            for (int i = 0; i < 3; ++i) t[i] = t[i] / length;
        }
        choose(where, n, t);
    }

    // Traction on the crack plane in the directions n, y, z.
    template <AnalysisKind kind>
    LODE_INLINE Vector<Real, crack_directions(kind)> tractions(const Stress<kind, Real>& s) const {
        constexpr int m = crack_directions(kind);
        Vector<Real, m> r;
        if constexpr (m == 1) {
            r[0] = s[0] * (N[0] * N[0]);
        } else if constexpr (m == 2) {
            constexpr int shear = normal_components(kind);
            const Real t0 = s[0] * N[0] + s[shear] * N[1], t1 = s[shear] * N[0] + s[1] * N[1];
            r[0] = N[0] * t0 + N[1] * t1;
            r[1] = T[0] * t0 + T[1] * t1;
        } else {
            Vector<Real, 3> t;
            t[0] = s[0] * N[0] + s[3] * N[1] + s[4] * N[2];
            t[1] = s[3] * N[0] + s[1] * N[1] + s[5] * N[2];
            t[2] = s[4] * N[0] + s[5] * N[1] + s[2] * N[2];
            r[0] = dot(N, t);
            r[1] = dot(T, t);
            r[2] = dot(Z, t);
        }
        return r;
    }
    // N times the first component plus T times the second plus Z times the third.
    template <int m>
    LODE_INLINE Vector<Real, 3> combine(const Vector<Real, m>& c) const {
        Vector<Real, 3> v;
        for (int i = 0; i < 3; ++i) {
            v[i] = c[0] * N[i];
            if constexpr (m > 1) v[i] = v[i] + c[1] * T[i];
            if constexpr (m > 2) v[i] = v[i] + c[2] * Z[i];
        }
        return v;
    }
    LODE_INLINE const Vector<Real, 3>& operator[](int j) const { return j == 0 ? N : j == 1 ? T : Z; }

    LODE_INLINE static Vector<Real, 3> across(const Vector<Real, 3>& t, const Vector<Real, 3>& n) {
        const Real along = dot(t, n);
        Vector<Real, 3> r;
        for (int i = 0; i < 3; ++i) r[i] = t[i] - along * n[i];
        return r;
    }
};

// DROT turns the frame.
template <AnalysisKind kind, class Real>
LODE_INLINE bool frame_turns(const Increment<kind, Real>& increment) {
    if constexpr (is_batch<Real> || kind == AnalysisKind::uniaxial) return false;
    const double* r = increment.rotation_source;
    return r != nullptr && !(r[0] == 1.0 && r[4] == 1.0 && r[8] == 1.0 && r[1] == 0.0 && r[2] == 0.0 && r[3] == 0.0 &&
                             r[5] == 0.0 && r[6] == 0.0 && r[7] == 0.0);
}

}  // namespace lode
