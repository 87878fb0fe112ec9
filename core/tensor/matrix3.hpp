// 3x3 tensors (deformation gradients, rotations) and rotation of Voigt tensors, generic in the number type.
#pragma once

#include <array>

#include "lode/tensor/voigt.hpp"

namespace lode {

template <class Real>
struct Matrix3 {
    std::array<Real, 9> m;  // row by row, not set

    constexpr Real& operator()(int i, int j) { return m[static_cast<std::size_t>(3 * i + j)]; }
    constexpr const Real& operator()(int i, int j) const { return m[static_cast<std::size_t>(3 * i + j)]; }

    static Matrix3 identity() {
        Matrix3 r;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) r(i, j) = Real(i == j ? 1.0 : 0.0);
        return r;
    }
};

template <class Real>
inline Matrix3<Real> operator*(const Matrix3<Real>& a, const Matrix3<Real>& b) {
    Matrix3<Real> r;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) r(i, j) = a(i, 0) * b(0, j) + a(i, 1) * b(1, j) + a(i, 2) * b(2, j);
    return r;
}
template <class Real>
inline Matrix3<Real> operator+(const Matrix3<Real>& a, const Matrix3<Real>& b) {
    Matrix3<Real> r;
    for (std::size_t i = 0; i < 9; ++i) r.m[i] = a.m[i] + b.m[i];
    return r;
}
template <class Real>
inline Matrix3<Real> operator-(const Matrix3<Real>& a, const Matrix3<Real>& b) {
    Matrix3<Real> r;
    for (std::size_t i = 0; i < 9; ++i) r.m[i] = a.m[i] - b.m[i];
    return r;
}
template <class Real, class Factor>
inline Matrix3<Real> operator*(const Factor& factor, const Matrix3<Real>& a) {
    Matrix3<Real> r;
    for (std::size_t i = 0; i < 9; ++i) r.m[i] = factor * a.m[i];
    return r;
}
template <class Real>
inline Matrix3<Real> transpose(const Matrix3<Real>& a) {
    Matrix3<Real> r;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) r(i, j) = a(j, i);
    return r;
}
template <class Real>
inline Real trace(const Matrix3<Real>& a) {
    return a(0, 0) + a(1, 1) + a(2, 2);
}
// Second invariant, (tr^2 A - tr A^2)/2: the sum of the principal 2x2 minors.
template <class Real>
inline Real second_invariant(const Matrix3<Real>& a) {
    return a(0, 0) * a(1, 1) - a(0, 1) * a(1, 0) + a(0, 0) * a(2, 2) - a(0, 2) * a(2, 0) + a(1, 1) * a(2, 2) -
           a(1, 2) * a(2, 1);
}
template <class Real>
inline Real determinant(const Matrix3<Real>& a) {
    return a(0, 0) * (a(1, 1) * a(2, 2) - a(1, 2) * a(2, 1)) - a(0, 1) * (a(1, 0) * a(2, 2) - a(1, 2) * a(2, 0)) +
           a(0, 2) * (a(1, 0) * a(2, 1) - a(1, 1) * a(2, 0));
}
// Transposed cofactors: A adj(A) = det(A) I, also for a singular A.
template <class Real>
inline Matrix3<Real> adjugate(const Matrix3<Real>& a) {
    Matrix3<Real> r;
    r(0, 0) = a(1, 1) * a(2, 2) - a(1, 2) * a(2, 1);
    r(0, 1) = a(0, 2) * a(2, 1) - a(0, 1) * a(2, 2);
    r(0, 2) = a(0, 1) * a(1, 2) - a(0, 2) * a(1, 1);
    r(1, 0) = a(1, 2) * a(2, 0) - a(1, 0) * a(2, 2);
    r(1, 1) = a(0, 0) * a(2, 2) - a(0, 2) * a(2, 0);
    r(1, 2) = a(0, 2) * a(1, 0) - a(0, 0) * a(1, 2);
    r(2, 0) = a(1, 0) * a(2, 1) - a(1, 1) * a(2, 0);
    r(2, 1) = a(0, 1) * a(2, 0) - a(0, 0) * a(2, 1);
    r(2, 2) = a(0, 0) * a(1, 1) - a(0, 1) * a(1, 0);
    return r;
}

// Voigt <-> matrix. `shear_factor` is 1 for stress-like components and 1/2 (2 on the way back) for engineering shears.
template <AnalysisKind kind, class Real, class V>
inline Matrix3<Real> to_matrix(const V& s, double shear_factor) {
    Matrix3<Real> r;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) r(i, j) = Real(0.0);
    constexpr int n = normal_components(kind);
    for (int i = 0; i < n; ++i) r(i, i) = s[i];
    if constexpr (shear_components(kind) >= 1) r(0, 1) = r(1, 0) = shear_factor * s[n];
    if constexpr (shear_components(kind) == 3) {
        r(0, 2) = r(2, 0) = shear_factor * s[n + 1];
        r(1, 2) = r(2, 1) = shear_factor * s[n + 2];
    }
    return r;
}
template <class V, AnalysisKind kind, class Real>
inline V from_matrix(const Matrix3<Real>& a, double shear_factor) {
    V s;
    constexpr int n = normal_components(kind);
    for (int i = 0; i < n; ++i) s[i] = a(i, i);
    if constexpr (shear_components(kind) >= 1) s[n] = shear_factor * a(0, 1);
    if constexpr (shear_components(kind) == 3) {
        s[n + 1] = shear_factor * a(0, 2);
        s[n + 2] = shear_factor * a(1, 2);
    }
    return s;
}

// Q A Q^T of a symmetric tensor in Voigt form. In the plane kinds Q is a rotation about axis 3.
template <AnalysisKind kind, class Real>
inline Stress<kind, Real> rotate(const Stress<kind, Real>& s, const Matrix3<Real>& q) {
    return from_matrix<Stress<kind, Real>, kind>(q * to_matrix<kind, Real>(s, 1.0) * transpose(q), 1.0);
}
template <AnalysisKind kind, class Real>
inline Strain<kind, Real> rotate(const Strain<kind, Real>& e, const Matrix3<Real>& q) {
    return from_matrix<Strain<kind, Real>, kind>(q * to_matrix<kind, Real>(e, 0.5) * transpose(q), 2.0);
}

}  // namespace lode
