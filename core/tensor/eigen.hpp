// Eigenvalues and eigenvectors of symmetric 3x3 tensors by cyclic Jacobi rotations: accurate for close and equal
// eigenvalues, and for a matrix of small entries (B - I) accurate relative to those entries. Batches go on until every
// lane has converged; further rotations are identities for the lanes that have.
#pragma once

#include "lode/tensor/matrix3.hpp"

namespace lode {

// A = sum_i values[i] v_i v_i^T, v_i = column i of `vectors` (orthonormal, possibly a reflection). No order is promised
// but that the tensor's axis 3 stays third in the plane kinds.
template <class Real>
struct SymmetricEigen {
    Vector<Real, 3> values;
    Matrix3<Real> vectors;
};

namespace eigen_detail {

// One rotation in the plane (p, q), r the third index: annihilates A_pq.
template <int p, int q, int r, class Real>
inline void rotate_plane(Matrix3<Real>& a, Matrix3<Real>& v) {
    const Real off = a(p, q), twice = 2.0 * off;
    const Real d = a(q, q) - a(p, p);
    // tan of the smaller angle that diagonalises the 2x2 block: 2 A_pq/(d +- sqrt(d^2 + 4 A_pq^2)).
    const Real root = sqrt(d * d + twice * twice);
    const Real denominator = select(d < Real(0.0), d - root, d + root);
    const Mask<Real> needed = abs(denominator) > Real(0.0);
    const Real t = select(needed, twice / select(needed, denominator, Real(1.0)), Real(0.0));
    const Real c = 1.0 / sqrt(1.0 + t * t), s = t * c, tau = s / (1.0 + c);
    a(p, p) = a(p, p) - t * off;
    a(q, q) = a(q, q) + t * off;
    a(p, q) = a(q, p) = Real(0.0);
    const Real apr = a(p, r), aqr = a(q, r);
    a(p, r) = a(r, p) = apr - s * (aqr + tau * apr);
    a(q, r) = a(r, q) = aqr + s * (apr - tau * aqr);
    for (int i = 0; i < 3; ++i) {
        const Real vp = v(i, p), vq = v(i, q);
        v(i, p) = vp - s * (vq + tau * vp);
        v(i, q) = vq + s * (vp - tau * vq);
    }
}

// True where A_pq^2 is below rounding of the product A_pp A_qq: then it moves neither eigenvalue.
template <class Real>
inline Mask<Real> negligible(const Matrix3<Real>& a, int p, int q) {
    constexpr double eps = 0.125 * std::numeric_limits<double>::epsilon();
    return square(a(p, q)) <= square(eps) * abs(a(p, p) * a(q, q));
}

// Largest magnitude, or 1 for the zero matrix: the rotations then neither overflow nor underflow.
template <class Real>
inline Real magnitude(const Matrix3<Real>& a) {
    Real largest = max(max(abs(a(0, 0)), abs(a(1, 1))), abs(a(2, 2)));
    largest = max(largest, max(max(abs(a(0, 1)), abs(a(0, 2))), abs(a(1, 2))));
    return select(largest > Real(0.0), largest, Real(1.0));
}

template <bool plane, class Real>
inline SymmetricEigen<Real> jacobi(const Matrix3<Real>& tensor) {
    constexpr int sweeps = 12;  // quadratic convergence: 3 to 5 are used
    Matrix3<Real> a = tensor, v = Matrix3<Real>::identity();
    if constexpr (plane) a(0, 2) = a(2, 0) = a(1, 2) = a(2, 1) = Real(0.0);
    const Real scale = magnitude(a);
    a = (1.0 / scale) * a;
    if constexpr (plane) {
        rotate_plane<0, 1, 2>(a, v);
    } else {
        for (int sweep = 0; sweep < sweeps; ++sweep) {
            if (all(negligible(a, 0, 1) && negligible(a, 0, 2) && negligible(a, 1, 2))) break;
            rotate_plane<0, 1, 2>(a, v);
            rotate_plane<0, 2, 1>(a, v);
            rotate_plane<1, 2, 0>(a, v);
        }
    }
    SymmetricEigen<Real> r;
    for (int i = 0; i < 3; ++i) r.values[i] = scale * a(i, i);
    if constexpr (plane) r.values[2] = tensor(2, 2);
    r.vectors = v;
    return r;
}

}  // namespace eigen_detail

template <class Real>
inline Matrix3<double> value_of(const Matrix3<Real>& a) {
    Matrix3<double> r;
    for (std::size_t i = 0; i < 9; ++i) r.m[i] = value_of(a.m[i]);
    return r;
}

// Eigenvalues and vectors of a symmetric tensor. In the plane kinds the components 13 and 23 are not read and one
// rotation, the closed form for a 2x2 matrix, is enough.
// Derivatives of an automatic-differentiation number: dl_i = v_i.dA v_i, dv_i = sum_j v_j (v_j.dA v_i)/(l_i - l_j); the
// vectors of equal eigenvalues are taken as fixed (isotropic tensor functions need none: spectral.hpp).
// Source: Golub and Van Loan, Matrix Computations, 8.5; Rutishauser's form of the updates.
template <AnalysisKind kind = AnalysisKind::solid, class Real>
inline SymmetricEigen<Real> symmetric_eigen(const Matrix3<Real>& tensor) {
    constexpr bool plane = kind != AnalysisKind::solid;
    if constexpr (is_differentiated<Real>) {
        const SymmetricEigen<double> plain = symmetric_eigen<kind>(value_of(tensor));
        Matrix3<Real> v;
        for (std::size_t i = 0; i < 9; ++i) v.m[i] = Real(plain.vectors.m[i]);
        Matrix3<Real> t = tensor;
        if constexpr (plane) t(0, 2) = t(2, 0) = t(1, 2) = t(2, 1) = Real(0.0);
        for (std::size_t i = 0; i < 9; ++i) t.m[i] = t.m[i] - Real(value_of(t.m[i]));
        const Matrix3<Real> change = transpose(v) * t * v;
        SymmetricEigen<Real> r;
        r.vectors = v;
        for (int i = 0; i < 3; ++i) {
            r.values[i] = plain.values[i] + change(i, i);
            for (int j = 0; j < 3; ++j) {
                const double gap = plain.values[i] - plain.values[j];
                if (gap == 0.0) continue;
                for (int k = 0; k < 3; ++k) r.vectors(k, i) = r.vectors(k, i) + (change(j, i) / gap) * v(k, j);
            }
        }
        return r;
    } else {
        return eigen_detail::jacobi<plane>(tensor);
    }
}

}  // namespace lode
