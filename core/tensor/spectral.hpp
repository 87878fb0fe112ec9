// Isotropic functions of a symmetric tensor, Y = sum f(l_i) n_i n_i^T, and their exact derivatives, for distinct, close
// and equal eigenvalues alike: dY = sum_ij g_ij n_i (n_i.dX n_j) n_j^T with g_ii = f'(l_i), g_ij the divided
// difference. Source: Hill (1978); Higham, Functions of Matrices, 3.2 (Daleckii and Krein).
#pragma once

#include "lode/tensor/eigen.hpp"
#include "lode/tensor/spectral_functions.hpp"
#include "lode/tensor/voigt_matrix.hpp"

namespace lode {

// sum values_i n_i n_i^T, symmetric exactly.
template <class Real>
inline Matrix3<Real> compose(const Vector<Real, 3>& values, const Matrix3<Real>& vectors) {
    Matrix3<Real> r;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j <= i; ++j)
            r(i, j) = r(j, i) = values[0] * vectors(i, 0) * vectors(j, 0) + values[1] * vectors(i, 1) * vectors(j, 1) +
                                values[2] * vectors(i, 2) * vectors(j, 2);
    return r;
}

// f of the tensor that `eigen` belongs to.
template <class Function, class Real>
inline Matrix3<Real> spectral_function(const Function& f, const SymmetricEigen<Real>& eigen) {
    Vector<Real, 3> values;
    for (int i = 0; i < 3; ++i) values[i] = f.value(eigen.values[i]);
    return compose(values, eigen.vectors);
}

// f of a symmetric tensor; in the plane kinds 13 and 23 are taken as zero.
template <AnalysisKind kind = AnalysisKind::solid, class Function, class Real>
inline Matrix3<Real> spectral_function(const Function& f, const Matrix3<Real>& tensor) {
    if constexpr (is_differentiated<Real>) {
        const Matrix3<double> plain = value_of(tensor);
        const SymmetricEigen<double> eigen = symmetric_eigen<kind>(plain);
        const Matrix3<double> at = spectral_function(f, eigen);
        Matrix3<Real> change, v;
        for (std::size_t i = 0; i < 9; ++i) {
            change.m[i] = tensor.m[i] - Real(plain.m[i]);
            v.m[i] = Real(eigen.vectors.m[i]);
        }
        if constexpr (kind != AnalysisKind::solid)
            change(0, 2) = change(2, 0) = change(1, 2) = change(2, 1) = Real(0.0);
        Matrix3<Real> inner = transpose(v) * change * v;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                const double g =
                    i == j ? f.derivative(eigen.values[i]) : f.divided_difference(eigen.values[i], eigen.values[j]);
                inner(i, j) = g * inner(i, j);
            }
        Matrix3<Real> r = v * inner * transpose(v);
        for (std::size_t i = 0; i < 9; ++i) r.m[i] = r.m[i] + Real(at.m[i]);
        return r;
    } else {
        return spectral_function(f, symmetric_eigen<kind>(tensor));
    }
}

// dY/dX: row = stress-like component of Y, column = engineering-shear component of X (6x6, plane kinds 4x4 or 3x3).
// Entry (I, J) = dY_ij/dX_kl with both minor symmetries; symmetric.
template <AnalysisKind kind = AnalysisKind::solid, class Function, class Real>
inline VoigtMatrix<kind, Real> spectral_derivative(const Function& f, const SymmetricEigen<Real>& eigen) {
    constexpr int n = components(kind);
    VoigtMatrix<kind, Real> d;
    for (Real& x : d.m) x = Real(0.0);
    const Matrix3<Real>& v = eigen.vectors;
    for (int a = 0; a < 3; ++a) {
        for (int b = a; b < 3; ++b) {
            const Real g =
                a == b ? f.derivative(eigen.values[a]) : 2.0 * f.divided_difference(eigen.values[a], eigen.values[b]);
            Matrix3<Real> dyad;  // sym(n_a n_b)
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) dyad(i, j) = 0.5 * (v(i, a) * v(j, b) + v(j, a) * v(i, b));
            const auto p = from_matrix<Stress<kind, Real>, kind>(dyad, 1.0);
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j) d(i, j) = d(i, j) + g * p[i] * p[j];
        }
    }
    return d;
}

// Common cases. `b` is B - I, with full relative accuracy at any strain.
template <AnalysisKind kind = AnalysisKind::solid, class Real>
inline Matrix3<Real> tensor_log(const Matrix3<Real>& a) {
    return spectral_function<kind>(LogFunction{}, a);
}
template <AnalysisKind kind = AnalysisKind::solid, class Real>
inline Matrix3<Real> tensor_exp(const Matrix3<Real>& a) {
    return spectral_function<kind>(ExpFunction{}, a);
}
template <AnalysisKind kind = AnalysisKind::solid, class Real>
inline Matrix3<Real> tensor_sqrt(const Matrix3<Real>& a) {
    return spectral_function<kind>(SqrtFunction{}, a);
}
template <AnalysisKind kind = AnalysisKind::solid, class Real>
inline Matrix3<Real> tensor_power(const Matrix3<Real>& a, double exponent) {
    return spectral_function<kind>(PowerFunction{exponent}, a);
}
// log B.
template <AnalysisKind kind = AnalysisKind::solid, class Real>
inline Matrix3<Real> tensor_log1p(const Matrix3<Real>& b) {
    return spectral_function<kind>(Log1pFunction{}, b);
}
// sqrt(B) - I; without eigenvectors: polar.hpp.
template <AnalysisKind kind = AnalysisKind::solid, class Real>
inline Matrix3<Real> tensor_sqrt1pm1(const Matrix3<Real>& b) {
    return spectral_function<kind>(Sqrt1pm1Function{}, b);
}

}  // namespace lode
