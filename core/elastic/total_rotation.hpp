// The total large-rotation law of chapter 3 (page 10, sections 1.3, 1.7, 1.8): strain E = V - I from F = V Rp.
// The tangent is (1/J) d(J sigma) in the Jaumann sense for F <- (I + D) F. Section 1.8 writes it in the eigenbasis of
// V; here it is in matrix form. With a = axial(D V - V D) the spin of Rp has the axial vector
//     w = (tr V I - V)^-1 a,     and     E* = (D - Omega) V = (D V + V D)/2 - (Omega V - V Omega)/2
// is the rate of E seen from the turning axes. Both follow from N(X): w -> Omega X - X Omega, since a = N(V)^T D/2.
#pragma once

#include "lode/elastic/isotropic_moduli.hpp"
#include "lode/elastic/material_axes.hpp"
#include "lode/elastic/rotated_moduli.hpp"
#include "lode/tensor/polar.hpp"

namespace lode {

template <AnalysisKind kind, class Real>
struct TotalRotation {
    static constexpr int n = components(kind), normals = normal_components(kind);
    static constexpr int spins = kind == AnalysisKind::solid ? 3 : 1;

    Matrix3<Real> gradient;       // H = F - I
    Matrix3<Real> stretch_minus;  // E = V - I
    Strain<kind, Real> strain;    // E with engineering shears

    // False, with the point marked as failed, where det F <= 0 (plane stress: of its in-plane part).
    LODE_INLINE bool from(const Increment<kind, Real>& increment, Point<kind, Real>& point) {
        Matrix3<Real> f = increment.deformation_gradient();
        if constexpr (kind != AnalysisKind::solid) {
            f(0, 2) = f(2, 0) = f(1, 2) = f(2, 1) = Real(0.0);
            if constexpr (kind == AnalysisKind::plane_stress) f(2, 2) = Real(1.0);  // the host's value is a guess
        }
        gradient = f;
        for (int i = 0; i < 3; ++i) gradient(i, i) = f(i, i) - 1.0;
        const Real volume = jacobian<kind>(f);
        Mask<Real> valid = volume > Real(0.0) && is_finite(volume);
        if constexpr (is_batch<Real>) stretch_minus = gradient;  // VUMAT passes the stretch itself
        else if (valid) stretch_minus = left_stretch_minus_identity<kind>(gradient, valid);
        if (!all(valid)) [[unlikely]] {
            point.fail(!valid, "det F <= 0");
            return false;
        }
        strain = from_matrix<Strain<kind, Real>, kind>(stretch_minus, 2.0);
        return true;
    }

    // Rp - I = V^-1 (H - E), accurate relative to itself. The frame of a VUMAT has taken Rp out.
    LODE_INLINE HostRotation<kind, Real> rotation() const {
        HostRotation<kind, Real> q;
        for (Real& x : q.minus_identity.m) x = Real(0.0);
        if constexpr (!is_batch<Real>) {
            Matrix3<Real> v = stretch_minus;
            for (int i = 0; i < 3; ++i) v(i, i) = v(i, i) + 1.0;
            if constexpr (kind == AnalysisKind::solid) {
                const Matrix3<Real> cofactors = adjugate(v);
                const Real det = v(0, 0) * cofactors(0, 0) + v(0, 1) * cofactors(1, 0) + v(0, 2) * cofactors(2, 0);
                if (det < ill_conditioned * square(trace(v)) * trace(v)) [[unlikely]]
                    return robust(gradient);
                q.minus_identity = (1.0 / det) * (cofactors * (gradient - stretch_minus));
            } else {
                // tan of the angle is (F21 - F12)/(F11 + F22).
                const Real sine = gradient(1, 0) - gradient(0, 1);
                const Real cosine = 2.0 + (gradient(0, 0) + gradient(1, 1));
                const Real length = sqrt(sine * sine + cosine * cosine), inverse = 1.0 / length;
                // cos - 1 = -sin^2/(1 + cos)
                const Real s = sine * inverse, c = cosine * inverse;
                const Real versed = select(c > Real(0.0), -(s * s) / (1.0 + c), c - 1.0);
                q.minus_identity(0, 0) = q.minus_identity(1, 1) = versed;
                q.minus_identity(1, 0) = s;
                q.minus_identity(0, 1) = -s;
            }
        }
        return q;
    }

    // DDSDDE of an isotropic stiffness coupling 1 (x) 1 + 2G I. Its stress is coaxial with V, so N(sigma) = 2G N(V):
    //     coupling 1 (x) V + G M(V) + (G/2) N(V) (tr V I - V)^-1 N(V)^T + sigma (x) 1,     M(V) D = D V + V D
    LODE_INLINE void set_tangent(double coupling, double shear, const Stress<kind, double>& stress,
                                 Tangent<kind>& tangent) const {
        const Stress<kind, double> v = stretch();
        const Columns commutator = commutators(v), spin = times_inverse(v, commutator);
        Column<n> ones{};
        for (int i = 0; i < normals; ++i) ones[i] = coupling;
        const Column<n> s = as_column(stress);
        for (int j = 0; j < n; ++j) {
            Column<n> c = (2.0 * shear) * half_stretching(v, j) + v[j] * ones;
            for (int k = 0; k < spins; ++k) c += (shear * spin.at[k][j]) * commutator.at[k];
            if (kind != AnalysisKind::plane_stress && j < normals) c += s;
            store_column<n>(tangent.stiffness, j, c);
        }
    }

    // DDSDDE of a stiffness C in the host's axes: C P + N(sigma) W + sigma (x) 1, w = W D, E* = P D.
    LODE_INLINE void set_tangent(const RotatedModuli<kind, double>& moduli, const Stress<kind, double>& stress,
                                 Tangent<kind>& tangent) const {
        const Stress<kind, double> v = stretch();
        const Columns commutator = commutators(v), spin = times_inverse(v, commutator);
        const Columns turn = commutators(stress);
        const Column<n> s = as_column(stress);
        for (int j = 0; j < n; ++j) {
            Column<n> rate = half_stretching(v, j);
            for (int k = 0; k < spins; ++k) rate -= (0.5 * spin.at[k][j]) * commutator.at[k];
            Column<n> c{};
            for (int i = 0; i < n; ++i) c += (i < normals ? rate[i] : 2.0 * rate[i]) * moduli.column(i);
            for (int k = 0; k < spins; ++k) c += spin.at[k][j] * turn.at[k];
            if (kind != AnalysisKind::plane_stress && j < normals) c += s;
            store_column<n>(tangent.stiffness, j, c);
        }
    }

  private:
    static constexpr double ill_conditioned = 1e-5;  // det V/(tr V)^3
    struct Columns {
        Column<n> at[spins];
    };

    [[gnu::noinline]] static HostRotation<kind, Real> robust(Matrix3<Real> h) {
        for (int i = 0; i < 3; ++i) h(i, i) = h(i, i) + 1.0;
        HostRotation<kind, Real> q{lode::rotation<kind>(h)};
        for (int i = 0; i < 3; ++i) q.minus_identity(i, i) = q.minus_identity(i, i) - 1.0;
        return q;
    }

    LODE_INLINE Stress<kind, double> stretch() const {
        auto v = from_matrix<Stress<kind, double>, kind>(stretch_minus, 1.0);
        add_to_normals(v, normals, 1.0);
        return v;
    }
    LODE_INLINE static Column<n> make(double c1, double c2, double c3, double c4 = 0.0, double c5 = 0.0,
                                      double c6 = 0.0) {
        if constexpr (n == 6) return Column<n>{c1, c2, c3, c4, c5, c6, 0.0, 0.0};
        else return Column<n>{c1, c2, c3, c4};
    }
    LODE_INLINE static Column<n> as_column(const Stress<kind, double>& x) {
        if constexpr (n == 6) return make(x[0], x[1], x[2], x[3], x[4], x[5]);
        else if constexpr (n == 4) return make(x[0], x[1], x[2], x[3]);
        else return make(x[0], x[1], x[2]);
    }
    // Columns of N(X), one for each component of the spin; in the plane kinds about 3 alone.
    LODE_INLINE static Columns commutators(const Stress<kind, double>& x) {
        if constexpr (kind == AnalysisKind::solid)
            return {{make(0.0, -2.0 * x[5], 2.0 * x[5], -x[4], x[3], x[1] - x[2]),
                     make(2.0 * x[4], 0.0, -2.0 * x[4], x[5], x[2] - x[0], -x[3]),
                     make(-2.0 * x[3], 2.0 * x[3], 0.0, x[0] - x[1], -x[5], x[4])}};
        else if constexpr (kind == AnalysisKind::plane_strain)
            return {{make(-2.0 * x[3], 2.0 * x[3], 0.0, x[0] - x[1])}};
        else return {{make(-2.0 * x[2], 2.0 * x[2], x[0] - x[1])}};
    }
    // Rows of (tr V I - V)^-1 N^T/2: the spin per unit strain increment.
    LODE_INLINE static Columns times_inverse(const Stress<kind, double>& v, const Columns& commutator) {
        Columns w;
        if constexpr (kind == AnalysisKind::solid) {
            Matrix3<double> sums;
            sums.m = {v[1] + v[2], -v[3], -v[4], -v[3], v[0] + v[2], -v[5], -v[4], -v[5], v[0] + v[1]};
            const Matrix3<double> cofactors = adjugate(sums);
            const double half_inverse =
                0.5 / (sums(0, 0) * cofactors(0, 0) + sums(0, 1) * cofactors(1, 0) + sums(0, 2) * cofactors(2, 0));
            for (int k = 0; k < 3; ++k)
                w.at[k] = half_inverse * (cofactors(k, 0) * commutator.at[0] + cofactors(k, 1) * commutator.at[1] +
                                          cofactors(k, 2) * commutator.at[2]);
        } else {
            w.at[0] = (0.5 / (v[0] + v[1])) * commutator.at[0];
        }
        return w;
    }
    // (D V + V D)/2 of the unit strain increment j.
    LODE_INLINE static Column<n> half_stretching(const Stress<kind, double>& v, int j) {
        if constexpr (kind == AnalysisKind::solid) {
            const double h = 0.5, q = 0.25;
            switch (j) {
                case 0:
                    return make(v[0], 0.0, 0.0, h * v[3], h * v[4], 0.0);
                case 1:
                    return make(0.0, v[1], 0.0, h * v[3], 0.0, h * v[5]);
                case 2:
                    return make(0.0, 0.0, v[2], 0.0, h * v[4], h * v[5]);
                case 3:
                    return make(h * v[3], h * v[3], 0.0, q * (v[0] + v[1]), q * v[5], q * v[4]);
                case 4:
                    return make(h * v[4], 0.0, h * v[4], q * v[5], q * (v[0] + v[2]), q * v[3]);
                default:
                    return make(0.0, h * v[5], h * v[5], q * v[4], q * v[3], q * (v[1] + v[2]));
            }
        } else {
            const double shear = 0.5 * v[normals];
            Column<n> c{};
            if (j < normals) c[j] = v[j];
            if (j < 2) c[normals] = shear;
            if (j == normals) c[0] = c[1] = shear, c[normals] = 0.25 * (v[0] + v[1]);
            return c;
        }
    }
};

}  // namespace lode
