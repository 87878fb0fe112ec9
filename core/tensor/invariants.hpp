// Invariants of the stress tensor in any continuum kind; components that a kind does not carry are zero.
#pragma once

#include "lode/tensor/eigen.hpp"

namespace lode {

// Pressure p = -tr(sigma)/3, positive in compression.
template <AnalysisKind kind, class Real>
inline Real pressure(const Stress<kind, Real>& s) {
    return (-1.0 / 3.0) * trace(s);
}

// J2 = s:s/2 from the stress differences, so that a large pressure does not spoil it.
template <AnalysisKind kind, class Real>
inline Real second_deviatoric_invariant(const Stress<kind, Real>& s) {
    constexpr int normals = normal_components(kind);
    const auto normal = [&](int i) { return i < normals ? s[i] : Real(0.0); };
    Real sum;
    if constexpr (normals == 1) sum = (1.0 / 3.0) * square(s[0]);
    else
        sum = (1.0 / 6.0) *
              (square(normal(0) - normal(1)) + square(normal(1) - normal(2)) + square(normal(2) - normal(0)));
    for (int i = normals; i < components(kind); ++i) sum = sum + square(s[i]);
    return sum;
}
// von Mises stress q = sqrt(3 J2).
template <AnalysisKind kind, class Real>
inline Real von_mises(const Stress<kind, Real>& s) {
    return sqrt(3.0 * second_deviatoric_invariant(s));
}

// J3 = det s, s the deviator.
template <AnalysisKind kind, class Real>
inline Real third_deviatoric_invariant(const Stress<kind, Real>& s) {
    if constexpr (normal_components(kind) == 1) return (2.0 / 27.0) * s[0] * s[0] * s[0];
    else {
        Matrix3<Real> d = to_matrix<kind, Real>(s, 1.0);
        // Deviatoric normals from differences: s1 = ((sigma1 - sigma2) + (sigma1 - sigma3))/3.
        const Real a = d(0, 0) - d(1, 1), b = d(1, 1) - d(2, 2), c = d(2, 2) - d(0, 0);
        d(0, 0) = (1.0 / 3.0) * (a - c);
        d(1, 1) = (1.0 / 3.0) * (b - a);
        d(2, 2) = (1.0 / 3.0) * (c - b);
        return determinant(d);
    }
}

// Lode angle in [0, pi/3] by cos(3 theta) = (3 sqrt(3)/2) J3/J2^(3/2): 0 in triaxial extension (sigma1 > sigma2 =
// sigma3), pi/6 in shear, pi/3 in triaxial compression. pi/6 where the deviator vanishes. Near 0 and pi/3 it is
// uncertain by sqrt(eps).
template <AnalysisKind kind, class Real>
inline Real lode_angle(const Stress<kind, Real>& s) {
    const Real j2 = second_deviatoric_invariant(s);
    const Mask<Real> sound = j2 > Real(0.0);
    const Real safe = select(sound, j2, Real(1.0));
    const Real cosine = (1.5 * 1.7320508075688772935) * (third_deviatoric_invariant(s) / safe) / sqrt(safe);
    const Real clamped = max(min(select(sound, cosine, Real(0.0)), Real(1.0)), Real(-1.0));
    using std::acos;
    return (1.0 / 3.0) * acos(clamped);
}

// Principal stresses, largest first. Kinds with fewer normal components have zeros among them.
template <AnalysisKind kind, class Real>
inline Vector<Real, 3> principal_values(const Stress<kind, Real>& s) {
    Vector<Real, 3> v = symmetric_eigen<kind>(to_matrix<kind, Real>(s, 1.0)).values;
    const auto order = [](Real& x, Real& y) {
        const Real larger = max(x, y);
        y = min(x, y);
        x = larger;
    };
    order(v[0], v[1]);
    order(v[1], v[2]);
    order(v[0], v[1]);
    return v;
}

}  // namespace lode
