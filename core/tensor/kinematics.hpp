// Kinematics of finite strain without cancellation: B - I and J - 1 are never formed from B and J, so stresses keep
// full relative accuracy at any strain (page 50, section 1.3).
#pragma once

#include "lode/numerics/functions.hpp"
#include "lode/tensor/matrix3.hpp"

namespace lode {

// Where finite-strain tensors live: plane stress carries its thickness direction along, like plane strain.
constexpr AnalysisKind with_thickness(AnalysisKind kind) {
    return kind == AnalysisKind::plane_stress ? AnalysisKind::plane_strain : kind;
}

// F - I of what the kind reads: 13, 23, 31, 32 are zero in the plane kinds, and in plane stress the host's F33 is a
// guess that is replaced by 1.
template <AnalysisKind kind, class Real>
inline Matrix3<Real> displacement_gradient(const Matrix3<Real>& f) {
    Matrix3<Real> h = f;
    for (int i = 0; i < 3; ++i) h(i, i) = f(i, i) - 1.0;
    if constexpr (kind != AnalysisKind::solid) h(0, 2) = h(2, 0) = h(1, 2) = h(2, 1) = Real(0.0);
    if constexpr (kind == AnalysisKind::plane_stress) h(2, 2) = Real(0.0);
    return h;
}

// H = F* - I of the mechanical part F* = F exp(-e) of F = I + Hx, e the linear residual strain; free = expm1(-e).
template <class Real>
inline Matrix3<Real> gradient_without(const Real& free, const Matrix3<Real>& hx) {
    const Real shrink = 1.0 + free;
    Matrix3<Real> h = shrink * hx;
    for (int i = 0; i < 3; ++i) h(i, i) = h(i, i) + free;
    return h;
}
template <class Real>
inline Matrix3<Real> mechanical_gradient(const Matrix3<Real>& hx, const Real& residual_strain) {
    return gradient_without(quick_expm1(-residual_strain), hx);
}

// In-plane det(I + H) - 1.
template <class Real>
inline Real plane_jacobian_minus_one(const Matrix3<Real>& h) {
    return (h(0, 0) + h(1, 1)) + (h(0, 0) * h(1, 1) - h(0, 1) * h(1, 0));
}

// The sum of the principal minors and the determinant of H, in an order that lets most of it run in parallel: the whole
// stress waits for it.
template <class Real>
inline Real minors_and_determinant(const Matrix3<Real>& h) {
    const Real m01 = h(0, 0) * h(1, 1) - h(0, 1) * h(1, 0), m02 = h(0, 0) * h(2, 2) - h(0, 2) * h(2, 0);
    const Real m12 = h(1, 1) * h(2, 2) - h(1, 2) * h(2, 1);
    const Real c01 = h(1, 0) * h(2, 2) - h(1, 2) * h(2, 0), c02 = h(1, 0) * h(2, 1) - h(1, 1) * h(2, 0);
    return ((m01 + m02) + (m12 + h(0, 0) * m12)) + (h(0, 2) * c02 - h(0, 1) * c01);
}
// J - 1 = det(I + H) - 1 = tr H + (sum of principal minors) + det H. Plane kinds: from the in-plane part and H33.
template <AnalysisKind kind = AnalysisKind::solid, class Real>
inline Real jacobian_minus_one(const Matrix3<Real>& h) {
    if constexpr (kind == AnalysisKind::solid) return trace(h) + minors_and_determinant(h);
    else {
        const Real q = plane_jacobian_minus_one(h);
        return q + h(2, 2) + q * h(2, 2);
    }
}

// b = B - I = H + H^T + H H^T as tensor components (11, 22, 33, 12[, 13, 23]).
template <AnalysisKind kind = AnalysisKind::solid, class Real>
inline Stress<with_thickness(kind), Real> left_cauchy_green_minus_identity(const Matrix3<Real>& h) {
    Stress<with_thickness(kind), Real> b;
    if constexpr (kind == AnalysisKind::solid) {
        for (int i = 0; i < 3; ++i) b[i] = 2.0 * h(i, i) + (h(i, 0) * h(i, 0) + h(i, 1) * h(i, 1) + h(i, 2) * h(i, 2));
        const auto off = [&](int i, int j) {
            return (h(i, j) + h(j, i)) + (h(i, 0) * h(j, 0) + h(i, 1) * h(j, 1) + h(i, 2) * h(j, 2));
        };
        b[3] = off(0, 1);
        b[4] = off(0, 2);
        b[5] = off(1, 2);
    } else {
        for (int i = 0; i < 2; ++i) b[i] = 2.0 * h(i, i) + (h(i, 0) * h(i, 0) + h(i, 1) * h(i, 1));
        b[2] = h(2, 2) * (2.0 + h(2, 2));
        b[3] = (h(0, 1) + h(1, 0)) + (h(0, 0) * h(1, 0) + h(0, 1) * h(1, 1));
    }
    return b;
}

// det F without the components that the kind does not read; accurate relative to itself also near 0, where 1 + j is
// not.
template <AnalysisKind kind, class Real>
inline Real jacobian(const Matrix3<Real>& f) {
    if constexpr (kind == AnalysisKind::solid) return determinant(f);
    else {
        const Real in_plane = f(0, 0) * f(1, 1) - f(0, 1) * f(1, 0);
        if constexpr (kind == AnalysisKind::plane_stress) return in_plane;
        else return f(2, 2) * in_plane;
    }
}

// What the hyperelastic laws are written in, all of the mechanical deformation F* (plane stress: of F33* = 1, the
// thickness stretch being an unknown of the model).
template <AnalysisKind kind, class Real>
struct Kinematics {
    Matrix3<Real> h;                       // F* - I
    Stress<with_thickness(kind), Real> b;  // B* - I
    Real j;                                // J* - 1
    Real jacobian;                         // J*

    // True where F is finite and det F > 0.
    Mask<Real> valid() const { return jacobian > Real(0.0) && is_finite(jacobian) && is_finite(trace(b)); }
    // ln J*, accurate relative to itself near J = 1 and near J = 0.
    Real log_jacobian() const {
        const Mask<Real> near_one = j > Real(-0.5);
        if (all(near_one)) return log1p(j);
        return select(near_one, log1p(j), log(jacobian));
    }
};

namespace kinematics_detail {

template <AnalysisKind kind, class Real>
LODE_INLINE Kinematics<kind, Real> complete(const Matrix3<Real>& h, const Real& determinant_of_f) {
    Kinematics<kind, Real> k;
    k.h = h;
    const auto b = left_cauchy_green_minus_identity<kind>(h);
    assign(k.b, b);
    k.j = jacobian_minus_one<kind>(h);
    k.jacobian = select(k.j > Real(-0.5), 1.0 + k.j, determinant_of_f);
    return k;
}

}  // namespace kinematics_detail

// From F = DFGRD1 (UMAT) or U (VUMAT).
template <AnalysisKind kind, class Real>
LODE_INLINE Kinematics<kind, Real> kinematics(const Matrix3<Real>& f) {
    return kinematics_detail::complete<kind>(displacement_gradient<kind>(f), jacobian<kind>(f));
}
// The same of F exp(-e), e the linear residual strain; nothing is computed for it where `is_absent`.
template <AnalysisKind kind, class Real>
LODE_INLINE Kinematics<kind, Real> kinematics(const Matrix3<Real>& f, const Real& residual_strain,
                                              bool is_absent = false) {
    Matrix3<Real> h = displacement_gradient<kind>(f);
    Real determinant_of_f = jacobian<kind>(f);
    if (!is_absent) [[unlikely]] {
        const Real free = quick_expm1(-residual_strain), shrink = 1.0 + free;
        // gradient_without() in place: a second matrix would put both into memory
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) h(i, j) = i == j ? shrink * h(i, j) + free : shrink * h(i, j);
        determinant_of_f = determinant_of_f * (shrink * shrink);
        if constexpr (kind == AnalysisKind::plane_stress) h(2, 2) = Real(0.0);
        else determinant_of_f = determinant_of_f * shrink;
    }
    return kinematics_detail::complete<kind>(h, determinant_of_f);
}

}  // namespace lode
