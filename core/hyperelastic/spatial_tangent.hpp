// Matrix forms of the Jaumann tangent of hyperelastic laws (page 50, section 1.5). Columns are engineering strains.
#pragma once

#include <type_traits>

#include "lode/material/point.hpp"
#include "lode/tensor/kinematics.hpp"

namespace lode {

// C = factor M(A) + volumetric 1 (x) 1, where M(A) : D = D A + A D for a symmetric A. In plane stress this is the
// in-plane part, which is not condensed.
template <AnalysisKind kind>
LODE_INLINE void set_stretching_tangent(Tangent<kind>& c, double factor, const Stress<with_thickness(kind), double>& a,
                                        double volumetric) {
    constexpr int n = normal_components(kind);
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) c(i, j) = i == j ? volumetric + 2.0 * factor * a[i] : volumetric;

    const double a12 = factor * a[3];
    c(0, n) = c(1, n) = c(n, 0) = c(n, 1) = a12;
    c(n, n) = 0.5 * factor * (a[0] + a[1]);
    if constexpr (n == 3) c(2, n) = c(n, 2) = 0.0;
    if constexpr (kind == AnalysisKind::solid) {
        const double a13 = factor * a[4], a23 = factor * a[5];
        c(0, 4) = c(2, 4) = c(4, 0) = c(4, 2) = a13;
        c(1, 4) = c(4, 1) = 0.0;
        c(1, 5) = c(2, 5) = c(5, 1) = c(5, 2) = a23;
        c(0, 5) = c(5, 0) = 0.0;
        c(4, 4) = 0.5 * factor * (a[0] + a[2]);
        c(5, 5) = 0.5 * factor * (a[1] + a[2]);
        c(3, 4) = c(4, 3) = 0.5 * a23;
        c(3, 5) = c(5, 3) = 0.5 * a13;
        c(4, 5) = c(5, 4) = 0.5 * a12;
    }
}

// The following serve the kinds with three normal components; plane stress is condensed from them.

// C = M(A) + volumetric 1 (x) 1 + 1 (x) B + B (x) 1 + [X (x) X - (D -> X D X)], the last of which comes as k = cof X,
// of which it consists, or as the number 0. Every entry is formed once: adding to what was just stored waits for the
// store.
template <AnalysisKind kind, class Cofactors>
LODE_INLINE void set_coupled_tangent(Tangent<kind>& c, const Stress<kind, double>& a, double volumetric,
                                     const Stress<kind, double>& b, const Cofactors& k) {
    const auto cofactor = [&k]([[maybe_unused]] int i) {
        if constexpr (std::is_same_v<Cofactors, Stress<kind, double>>) return k[i];
        else return k;
    };
    const auto set = [&c](int i, int j, double x) LODE_INLINE_LAMBDA { c(i, j) = c(j, i) = x; };
    for (int i = 0; i < 3; ++i) c(i, i) = volumetric + 2.0 * (a[i] + b[i]);
    set(0, 1, volumetric + (b[0] + b[1]) + cofactor(2));
    set(0, 2, volumetric + (b[0] + b[2]) + cofactor(1));
    set(1, 2, volumetric + (b[1] + b[2]) + cofactor(0));
    set(0, 3, a[3] + b[3]);
    set(1, 3, a[3] + b[3]);
    set(2, 3, b[3] - cofactor(3));
    set(3, 3, 0.5 * (a[0] + a[1] - cofactor(2)));
    if constexpr (kind == AnalysisKind::solid) {
        set(0, 4, a[4] + b[4]);
        set(2, 4, a[4] + b[4]);
        set(1, 4, b[4] - cofactor(4));
        set(1, 5, a[5] + b[5]);
        set(2, 5, a[5] + b[5]);
        set(0, 5, b[5] - cofactor(5));
        set(4, 4, 0.5 * (a[0] + a[2] - cofactor(1)));
        set(5, 5, 0.5 * (a[1] + a[2] - cofactor(0)));
        set(3, 4, 0.5 * (a[5] + cofactor(5)));
        set(3, 5, 0.5 * (a[4] + cofactor(4)));
        set(4, 5, 0.5 * (a[3] + cofactor(3)));
    }
}

namespace spatial_detail {

inline constexpr int first_index[] = {0, 1, 2, 0, 0, 1}, second_index[] = {0, 1, 2, 1, 2, 2};

// f(row, column, i, j, k, l) for the upper triangle.
template <AnalysisKind kind, class F>
LODE_INLINE void for_each_modulus(const F& f) {
    for (int column = 0; column < components(kind); ++column)
        for (int row = 0; row <= column; ++row)
            f(row, column, first_index[row], second_index[row], first_index[column], second_index[column]);
}
template <AnalysisKind kind>
LODE_INLINE void add_to_both(Tangent<kind>& c, int row, int column, double x) {
    c(row, column) += x;
    if (row != column) c(column, row) += x;
}

}  // namespace spatial_detail

// C += S(A, C), where S(A, C) : D = A D C + C D A for symmetric A, C.
template <AnalysisKind kind>
LODE_INLINE void add_two_sided(Tangent<kind>& tangent, const Stress<kind, double>& first,
                               const Stress<kind, double>& second) {
    const Matrix3<double> a = to_matrix<kind, double>(first, 1.0), c = to_matrix<kind, double>(second, 1.0);
    spatial_detail::for_each_modulus<kind>([&](int row, int column, int i, int j, int k, int l) {
        const double s = 0.5 * (a(i, k) * c(j, l) + a(i, l) * c(j, k) + c(i, k) * a(j, l) + c(i, l) * a(j, k));
        spatial_detail::add_to_both(tangent, row, column, s);
    });
}
// C += factor S(A, A)/2: D -> factor A D A.
template <AnalysisKind kind>
LODE_INLINE void add_sandwich(Tangent<kind>& tangent, double factor, const Stress<kind, double>& tensor) {
    const Matrix3<double> a = to_matrix<kind, double>(tensor, 1.0);
    spatial_detail::for_each_modulus<kind>([&](int row, int column, int i, int j, int k, int l) {
        spatial_detail::add_to_both(tangent, row, column, 0.5 * factor * (a(i, k) * a(j, l) + a(i, l) * a(j, k)));
    });
}
// C += factor A (x) A.
template <AnalysisKind kind>
LODE_INLINE void add_dyad(Tangent<kind>& tangent, double factor, const Stress<kind, double>& a) {
    for (int j = 0; j < components(kind); ++j) {
        const double scaled = factor * a[j];
        for (int i = 0; i < components(kind); ++i) tangent(i, j) += scaled * a[i];
    }
}

}  // namespace lode
