// The total large-rotation law of chapter 3 (page 10, sections 1.3, 1.7, 1.8): strain E = V - I from F = V R.
#pragma once

#include "lode/elastic/isotropic_moduli.hpp"
#include "lode/tensor/eigen.hpp"
#include "lode/tensor/polar.hpp"

namespace lode {

template <AnalysisKind kind, class Real>
struct TotalRotation {
    Strain<kind, Real> strain;  // V - I, engineering shears

    // False, with the point marked as failed, where det F <= 0.
    bool from(const Increment<kind, Real>& increment, Point<kind, Real>& point) {
        Matrix3<Real> f = increment.deformation_gradient();
        if constexpr (kind != AnalysisKind::solid) {
            f(0, 2) = f(2, 0) = f(1, 2) = f(2, 1) = Real(0.0);
            if constexpr (kind == AnalysisKind::plane_stress) f(2, 2) = Real(1.0);  // the host's value is a guess
        }
        const Real volume = determinant(f);
        const auto inverted = !(volume > Real(0.0) && is_finite(volume));
        if (any(inverted)) {
            point.fail(inverted, "det F <= 0");
            return false;
        }
        for (int i = 0; i < 3; ++i) f(i, i) = f(i, i) - 1.0;
        const Matrix3<Real> e = [&] {
            if constexpr (is_batch<Real>) return f;  // VUMAT passes the stretch itself
            else return left_stretch_minus_identity(f);
        }();
        strain = from_matrix<Strain<kind, Real>, kind>(e, 2.0);
        return true;
    }

    // Column by column, (1/J) d(J sigma) in the Jaumann sense for F <- (I + D) F: in the eigenbasis of V
    // E*_ij = D_ij 2 l_i l_j / (l_i + l_j), Omega_ij = D_ij (l_j - l_i)/(l_i + l_j) (section 1.8).
    template <class Stiffness>
    void set_tangent(const Stiffness& moduli, const Stress<kind, Real>& stress, Tangent<kind>& tangent) const {
        constexpr int n = components(kind), normals = normal_components(kind);
        const auto eigen = symmetric_eigen(to_matrix<kind, double>(strain, 0.5));
        const Matrix3<double>& q = eigen.vectors;
        const Matrix3<double> s = to_matrix<kind, double>(stress, 1.0);
        for (int column = 0; column < n; ++column) {
            Strain<kind, double> unit{};
            unit[column] = 1.0;
            Matrix3<double> d = transpose(q) * to_matrix<kind, double>(unit, 0.5) * q;
            Matrix3<double> spin;
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) {
                    const double li = 1.0 + eigen.values[i], lj = 1.0 + eigen.values[j];
                    spin(i, j) = d(i, j) * (lj - li) / (li + lj);
                    d(i, j) *= 2.0 * li * lj / (li + lj);
                }
            d = q * d * transpose(q);
            spin = q * spin * transpose(q);
            const auto rate = moduli.template stress<kind>(from_matrix<Strain<kind, double>, kind>(d, 2.0));
            const auto turn = from_matrix<Stress<kind, double>, kind>(spin * s - s * spin, 1.0);
            for (int i = 0; i < n; ++i) tangent(i, column) = rate[i] + turn[i];
            if (kind != AnalysisKind::plane_stress && column < normals)
                for (int i = 0; i < n; ++i) tangent(i, column) += stress[i];
        }
    }
};

}  // namespace lode
