// The frame {n, t, p} of a crack, stresses in it, and the stress that a displacement jump takes off (page 80, 3.1).
#pragma once

#include "lode/decohesive/crack_law.hpp"
#include "lode/tensor/matrix3.hpp"

namespace lode {

template <class Real>
LODE_INLINE Real dot(const Vector<Real, 3>& a, const Vector<Real, 3>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class Real>
LODE_INLINE Vector<Real, 3> cross(const Vector<Real, 3>& a, const Vector<Real, 3>& b) {
    Vector<Real, 3> r;
    r[0] = a[1] * b[2] - a[2] * b[1];
    r[1] = a[2] * b[0] - a[0] * b[2];
    r[2] = a[0] * b[1] - a[1] * b[0];
    return r;
}
// Global axis i (0-based).
template <class Real>
LODE_INLINE Vector<Real, 3> axis(int i) {
    Vector<Real, 3> r;
    for (int k = 0; k < 3; ++k) r[k] = Real(k == i ? 1.0 : 0.0);
    return r;
}
// -1 for a vector whose first component of magnitude above 1e-9 is negative, else 1: the sign that orients a normal.
template <class Real>
LODE_INLINE double orientation(const Vector<Real, 3>& v) {
    for (int i = 0; i < 3; ++i)
        if (std::abs(value_of(v[i])) > 1e-9) return value_of(v[i]) < 0.0 ? -1.0 : 1.0;
    return 1.0;
}
template <class Real>
LODE_INLINE Vector<Real, 3> oriented(const Vector<Real, 3>& v) {
    return Real(orientation(v)) * v;
}

// sigma v.
template <AnalysisKind kind, class Real>
LODE_INLINE Vector<Real, 3> apply(const Stress<kind, Real>& s, const Vector<Real, 3>& v) {
    Vector<Real, 3> r;
    if constexpr (kind == AnalysisKind::solid) {
        r[0] = s[0] * v[0] + s[3] * v[1] + s[4] * v[2];
        r[1] = s[3] * v[0] + s[1] * v[1] + s[5] * v[2];
        r[2] = s[4] * v[0] + s[5] * v[1] + s[2] * v[2];
    } else if constexpr (kind == AnalysisKind::uniaxial) {
        r[0] = s[0] * v[0];
        r[1] = r[2] = Real(0.0);
    } else {
        constexpr int shear = normal_components(kind);
        r[0] = s[0] * v[0] + s[shear] * v[1];
        r[1] = s[shear] * v[0] + s[1] * v[1];
        if constexpr (kind == AnalysisKind::plane_strain) r[2] = s[2] * v[2];
        else r[2] = Real(0.0);
    }
    return r;
}

template <AnalysisKind kind, class Real>
struct CrackFrame {
    using V = Vector<Real, 3>;
    V n, t, p;
    // C:sym(n n), C:sym(n t), C:sym(n p): what a unit jump takes off the stress, times the length; and as well the
    // rates of tau_n, tau_t and tau_p by the strain.
    Stress<kind, Real> Q[3];

    // In the plane kinds n lies in the plane or along axis 3.
    void set(const V& normal, const KindStiffness<kind>& c) {
        set_axes(normal);
        Q[0] = stress_of(n, n, c);
        Q[1] = stress_of(n, t, c);
        Q[2] = stress_of(n, p, c);
    }
    void set_axes(const V& normal) {
        n = normal;
        if constexpr (kind == AnalysisKind::solid) {
            int least = 0;
            for (int i = 1; i < 3; ++i)
                if (std::abs(value_of(n[i])) < std::abs(value_of(n[least]))) least = i;
            t = axis<Real>(least);
            t = t - n[least] * n;
            t = (1.0 / sqrt(dot(t, t))) * t;
            p = cross(n, t);
        } else if (std::abs(value_of(n[2])) > 0.5) {
            t = axis<Real>(0);
            p = axis<Real>(1);
        } else {
            t[0] = -n[1];
            t[1] = n[0];
            t[2] = Real(0.0);
            p = axis<Real>(2);
        }
    }

    LODE_INLINE PlaneStresses<Real> stresses(const Stress<kind, Real>& s) const {
        const V traction = apply(s, n), on_t = apply(s, t), on_p = apply(s, p);
        return {dot(n, traction), dot(t, traction), dot(p, traction), dot(t, on_t), dot(p, on_p), dot(t, on_p)};
    }

    // The rates of tt, pp and tp by the strain: C:sym(t t), C:sym(p p), C:sym(t p).
    Stress<kind, Real> lateral_rate(int i, const KindStiffness<kind>& c) const {
        if (i == 0) return stress_of(t, t, c);
        if (i == 1) return stress_of(p, p, c);
        return stress_of(t, p, c);
    }

  private:
    // C:sym(a b) for a = b (the same object) or orthogonal a and b.
    static Stress<kind, Real> stress_of(const V& a, const V& b, const KindStiffness<kind>& c) {
        const bool same = &a == &b;
        [[maybe_unused]] const double G = 0.5 * c.twice_shear;
        Stress<kind, Real> s;
        constexpr int normals = normal_components(kind);
        Real volume = Real(0.0);
        if (same) {
            volume = Real(1.0);
            // sigma33 = 0: nothing comes from the strain along axis 3.
            if constexpr (kind == AnalysisKind::plane_stress) volume = a[0] * a[0] + a[1] * a[1];
        }
        for (int i = 0; i < normals; ++i) s[i] = c.twice_shear * (a[i] * b[i]) + c.E_2 * volume;
        if constexpr (kind != AnalysisKind::uniaxial) s[normals] = G * (a[0] * b[1] + a[1] * b[0]);
        if constexpr (kind == AnalysisKind::solid) {
            s[4] = G * (a[0] * b[2] + a[2] * b[0]);
            s[5] = G * (a[1] * b[2] + a[2] * b[1]);
        }
        return s;
    }
};

}  // namespace lode
