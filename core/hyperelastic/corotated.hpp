// The shear part of the co-rotated neo-Hookean law (page 50, section 4): with V = I + E the left stretch and B = V^2,
//     W = G |E|^2,     tau = 2 G (B - V) = 2 G (E + E^2)
// Shared by COROT_NEO_HOOKEAN and the snow model.
#pragma once

#include "lode/hyperelastic/residual_strain.hpp"
#include "lode/hyperelastic/spatial_tangent.hpp"
#include "lode/tensor/polar.hpp"
#include "lode/tensor/spectral.hpp"

namespace lode {

// E = V - I of F = I + H, completed by the known thickness stretch in plane stress. An explicit host passes U, whose V
// it is.
template <AnalysisKind kind, class Real>
LODE_INLINE Stress<with_thickness(kind), Real> corotated_strain(const Matrix3<Real>& h, Mask<Real>& valid) {
    constexpr AnalysisKind full = with_thickness(kind);
    if constexpr (is_batch<Real>) return from_matrix<Stress<full, Real>, full>(h, 1.0);
    else {
        auto e = from_matrix<Stress<full, Real>, full>(left_stretch_minus_identity<kind>(h, valid), 1.0);
        if constexpr (kind == AnalysisKind::plane_stress) e[2] = h(2, 2);
        return e;
    }
}

// The same of a tensor b = V^2 - I, from its Cholesky factor L: L L^T = I + b and L has the left stretch V.
template <AnalysisKind kind, class Real>
LODE_INLINE Stress<kind, Real> corotated_strain_of(const Stress<kind, Real>& b) {
    const auto root_minus_one = [](const Real& x) { return x / (1.0 + sqrt(1.0 + x)); };
    Matrix3<Real> h = to_matrix<kind, Real>(b, 0.0);
    h(0, 0) = root_minus_one(b[0]);
    h(1, 0) = b[3] / (1.0 + h(0, 0));
    h(1, 1) = root_minus_one(b[1] - h(1, 0) * h(1, 0));
    if constexpr (kind == AnalysisKind::solid) {
        h(2, 0) = b[4] / (1.0 + h(0, 0));
        h(2, 1) = (b[5] - h(2, 0) * h(1, 0)) / (1.0 + h(1, 1));
        h(2, 2) = root_minus_one(b[2] - (h(2, 0) * h(2, 0) + h(2, 1) * h(2, 1)));
    } else {
        h(2, 2) = root_minus_one(b[2]);
    }
    return from_matrix<Stress<kind, Real>, kind>(left_stretch_minus_identity<kind>(h), 1.0);
}

// True where two principal stretches sum to less than 1: tau_i - tau_j = 2 G (l_i - l_j)(l_i + l_j - 1) then has the
// wrong sign (Baker and Ericksen). The sums l_i + l_j - 1 are the eigenvalues of (1 + tr E) I - E.
template <AnalysisKind kind, class Real>
LODE_INLINE Mask<Real> violates_baker_ericksen(const Stress<kind, Real>& e) {
    const Real t = 1.0 + trace(e);
    const Real a = t - e[0], b = t - e[1], c = t - e[2], minor = a * b - e[3] * e[3];
    Real det = c * minor;
    if constexpr (kind == AnalysisKind::solid) det = det - a * e[5] * e[5] - b * e[4] * e[4] - 2.0 * e[3] * e[4] * e[5];
    return a < Real(0.0) || minor < Real(0.0) || det < Real(0.0);
}

namespace corotated_detail {

// 2 (l_i^2 + l_j^2) [1 - 1/(l_i + l_j)] of E's eigenvalues e_i = l_i - 1.
struct ShearModuli {
    double derivative(double e) const { return divided_difference(e, e); }
    double divided_difference(double e1, double e2) const {
        const double sum = 2.0 + e1 + e2;
        return 2.0 * (square(1.0 + e1) + square(1.0 + e2)) * (1.0 + e1 + e2) / sum;
    }
};

template <AnalysisKind kind>
[[gnu::noinline]] VoigtMatrix<kind, double> spectral_moduli(const Stress<kind, double> e) {
    return spectral_derivative<kind>(ShearModuli{}, symmetric_eigen<kind>(to_matrix<kind, double>(e, 1.0)));
}

}  // namespace corotated_detail

// C = 2 g [M(B) - X] + volumetric 1 (x) 1, X the solution of V X + X V = D B + B D (section 4.2). With i1, i2, i3 the
// invariants of V, dl = i1 i2 - i3 and Z = B - i1 V, Cayley-Hamilton gives
//     dl X = i1 i2 M(V) - Z D Z - i2 V D V - i1 i3 D
template <AnalysisKind kind>
LODE_INLINE void set_corotated_tangent(Tangent<kind>& c, double g, const Stress<kind, double>& e, double volumetric) {
    auto v = e;
    add_to_normals(v, 3, 1.0);
    const auto b = square_of(v);
    const double i1 = trace(v), i2 = 0.5 * (i1 * i1 - trace(b)), i3 = determinant(to_matrix<kind, double>(v, 1.0));
    const double dl = i1 * i2 - i3;
    if (!(dl > polar_detail::ill_conditioned * i1 * i1 * i1)) [[unlikely]] {  // cancellation: very unequal stretches
        const auto m = corotated_detail::spectral_moduli<kind>(e);
        for (int j = 0; j < components(kind); ++j)
            for (int i = 0; i < components(kind); ++i) c(i, j) = g * m(i, j) + (i < 3 && j < 3 ? volumetric : 0.0);
        return;
    }
    const double inverse = 1.0 / dl, scaled = 2.0 * g * inverse;
    set_stretching_tangent(c, 2.0 * g, b - (i1 * i2 * inverse) * v, volumetric);
    add_sandwich(c, scaled, b - i1 * v);
    add_sandwich(c, scaled * i2, v);
    for (int i = 0; i < components(kind); ++i) c(i, i) += (i < 3 ? 1.0 : 0.5) * scaled * i1 * i3;
}

}  // namespace lode
