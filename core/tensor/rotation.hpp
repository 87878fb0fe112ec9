// Rotations: from angles, from an axis, from a spin increment; and as matrices over Voigt components.
#pragma once

#include "lode/tensor/matrix3.hpp"
#include "lode/tensor/voigt_matrix.hpp"

namespace lode {

inline constexpr double degree = 0.017453292519943295769;

// cos and sin of an angle in degrees, exact at multiples of 90.
inline void cosine_and_sine(double degrees, double& cosine, double& sine) {
    double turn = std::fmod(degrees, 360.0);
    if (turn < 0.0) turn += 360.0;
    const double quarter = std::round(turn / 90.0), rest = (turn - 90.0 * quarter) * degree;
    const double c = std::cos(rest), s = std::sin(rest);
    switch (static_cast<int>(quarter) % 4) {
        case 0:
            cosine = c, sine = s;
            break;
        case 1:
            cosine = -s, sine = c;
            break;
        case 2:
            cosine = -c, sine = -s;
            break;
        default:
            cosine = s, sine = -c;
            break;
    }
}

// R = Rz(z) Ry(y) Rx(x), right-hand rotations in degrees about the fixed axes 3, 2, 1; the columns are the turned axes
// (page 10, section 1.2).
inline Matrix3<double> rotation_from_angles(double z, double y, double x) {
    double cz, sz, cy, sy, cx, sx;
    cosine_and_sine(z, cz, sz);
    cosine_and_sine(y, cy, sy);
    cosine_and_sine(x, cx, sx);
    Matrix3<double> r;
    r(0, 0) = cz * cy;
    r(0, 1) = cz * sy * sx - sz * cx;
    r(0, 2) = cz * sy * cx + sz * sx;
    r(1, 0) = sz * cy;
    r(1, 1) = sz * sy * sx + cz * cx;
    r(1, 2) = sz * sy * cx - cz * sx;
    r(2, 0) = -sy;
    r(2, 1) = cy * sx;
    r(2, 2) = cy * cx;
    return r;
}

// Skew tensor W with W x = w x x (cross product).
template <class Real>
inline Matrix3<Real> skew(const Vector<Real, 3>& w) {
    Matrix3<Real> r;
    r(0, 0) = r(1, 1) = r(2, 2) = Real(0.0);
    r(2, 1) = w[0], r(1, 2) = -w[0];
    r(0, 2) = w[1], r(2, 0) = -w[1];
    r(1, 0) = w[2], r(0, 1) = -w[2];
    return r;
}

// Rotation by `angle` (radians, right-hand) about `axis`, which need not be normalised; I for a zero axis.
// Rodrigues: R = I + sin(a) W + 2 sin^2(a/2) W^2.
template <class Real>
inline Matrix3<Real> rotation_from_axis(const Vector<Real, 3>& axis, const Real& angle) {
    const Real length = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
    const Mask<Real> sound = length > Real(0.0);
    const Real inverse = select(sound, 1.0 / select(sound, length, Real(1.0)), Real(0.0));
    Vector<Real, 3> n;
    for (int i = 0; i < 3; ++i) n[i] = inverse * axis[i];
    const Matrix3<Real> w = skew(n);
    const Real half = sin(0.5 * angle);
    return Matrix3<Real>::identity() + sin(angle) * w + (2.0 * half * half) * (w * w);
}

// Orthogonal rotation increment for a spin increment: (I - W/2)^-1 (I + W/2) = I + [W + W^2/2]/(1 + |w|^2/4), w the
// axial vector of W. Exactly orthogonal; the angle is 2 atan(|w|/2), second order. Source: Hughes and Winget (1980).
template <class Real>
inline Matrix3<Real> hughes_winget(const Vector<Real, 3>& w) {
    const Matrix3<Real> spin = skew(w);
    const Real inverse = 1.0 / (1.0 + 0.25 * (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]));
    return Matrix3<Real>::identity() + inverse * spin + (0.5 * inverse) * (spin * spin);
}
// The same for a displacement-gradient increment; its symmetric part does not matter.
template <class Real>
inline Matrix3<Real> hughes_winget(const Matrix3<Real>& gradient) {
    Vector<Real, 3> w;
    w[0] = 0.5 * (gradient(2, 1) - gradient(1, 2));
    w[1] = 0.5 * (gradient(0, 2) - gradient(2, 0));
    w[2] = 0.5 * (gradient(1, 0) - gradient(0, 1));
    return hughes_winget(w);
}

// True where Q Q^T = I within `tolerance` in every entry and det Q > 0.
template <class Real>
inline Mask<Real> is_rotation(const Matrix3<Real>& q, double tolerance = 1e-9) {
    const Matrix3<Real> error = q * transpose(q) - Matrix3<Real>::identity();
    Mask<Real> good = determinant(q) > Real(0.0);
    for (const Real& x : error.m) good = good && abs(x) <= Real(tolerance);
    return good;
}

// T of eps' = T eps for tensors turned by Q: Q eps Q^T with engineering shears (plane kinds: Q about axis 3).
template <AnalysisKind kind = AnalysisKind::solid, class Real>
inline VoigtMatrix<kind, Real> strain_rotation(const Matrix3<Real>& q) {
    VoigtMatrix<kind, Real> t;
    for (int j = 0; j < components(kind); ++j) {
        Strain<kind, Real> unit;
        for (int i = 0; i < unit.size(); ++i) unit[i] = Real(i == j ? 1.0 : 0.0);
        const auto column = rotate<kind>(unit, q);
        for (int i = 0; i < unit.size(); ++i) t(i, j) = column[i];
    }
    return t;
}
// T^-T, the same for stresses: Q sigma Q^T. C' = T^-T C T^-1, S' = T S T^T, T^-1 = strain_rotation(Q^T).
template <AnalysisKind kind = AnalysisKind::solid, class Real>
inline VoigtMatrix<kind, Real> stress_rotation(const Matrix3<Real>& q) {
    return transpose(strain_rotation<kind>(transpose(q)));
}
// T^-T C T^-1 of a stiffness (stress rows, engineering-strain columns).
template <AnalysisKind kind = AnalysisKind::solid, class Real>
inline VoigtMatrix<kind, Real> rotate_stiffness(const VoigtMatrix<kind, Real>& c, const Matrix3<Real>& q) {
    const auto t = stress_rotation<kind>(q);
    return t * c * transpose(t);
}
// T S T^T of a compliance.
template <AnalysisKind kind = AnalysisKind::solid, class Real>
inline VoigtMatrix<kind, Real> rotate_compliance(const VoigtMatrix<kind, Real>& s, const Matrix3<Real>& q) {
    const auto t = strain_rotation<kind>(q);
    return t * s * transpose(t);
}

}  // namespace lode
