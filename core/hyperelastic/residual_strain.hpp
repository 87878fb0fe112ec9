// Residual (thermal, moisture) strain of the isotropic hyperelastic models and the deformation F* = F exp(-e) at which
// their laws are evaluated (page 50, sections 1.2 and 1.3).
#pragma once

#include "lode/material/point.hpp"
#include "lode/tensor/kinematics.hpp"
#include "lode/tensor/polar.hpp"

namespace lode {

// Thickness strain increment (logarithmic) of plane stress from the total F33 - 1.
template <class Real>
inline Real thickness_strain_change(const Real& f33m1_old, const Real& f33m1) {
    return log1p(f33m1) - log1p(f33m1_old);
}

struct ResidualStrain {
    double thermal_expansion = 0.0, moisture_expansion = 0.0;

    // e at the end of the increment, the logarithm of the free stretch since the first call.
    template <AnalysisKind kind, class Real>
    Real end(const Increment<kind, Real>& increment, const Real& start) const {
        Real e = start;
        if (thermal_expansion != 0.0) e = e + thermal_expansion * increment.temperature_increment();
        if (moisture_expansion != 0.0) e = e + moisture_expansion * increment.field_increment(1);
        return e;
    }

    // True where there is none: nothing needs to be computed for it. (A derivative can be there nevertheless.)
    template <class Real>
    bool is_absent(const Real& e) const {
        if constexpr (is_differentiated<Real>)
            if (thermal_expansion != 0.0 || moisture_expansion != 0.0) return false;
        return !any(e != Real(0.0));
    }

    // Kinematics of F*.
    template <AnalysisKind kind, class Real>
    LODE_INLINE Kinematics<kind, Real> mechanical(const Increment<kind, Real>& increment, const Real& e) const {
        return kinematics<kind>(increment.deformation_gradient(), e, is_absent(e));
    }

    // F33 - 1 from d = F33* - 1, plane stress.
    template <class Real>
    Real total_thickness_change(const Real& d, const Real& e) const {
        return is_absent(e) ? d : d + expm1(e) * (1.0 + d);
    }

    // STATEV 1 and 2, e and F33 - 1, of models that keep nothing else; in plane stress the change of the thickness too.
    template <AnalysisKind kind, class Real>
    LODE_INLINE void store(Point<kind, Real>& point, const Kinematics<kind, Real>& k, const Real& e) const {
        State<Real>& state = point.state;
        if constexpr (kind == AnalysisKind::plane_stress) {
            const Real before = state[2], f33m1 = total_thickness_change(k.h(2, 2), e);
            if (point.wants_thickness_strain) point.thickness_strain_increment = thickness_strain_change(before, f33m1);
            state.set(2, f33m1);
        } else {
            state.keep(2);
        }
        state.set(1, e);
    }
};

// F - I and det F as the host gives them. With `local_basis` (ORI = 1) both indices of F refer to axes that turn with
// the material: F is then U in the reference basis turned on one side, and its left stretch is that U (section 1.1). An
// explicit host passes U itself.
template <AnalysisKind kind, class Real>
struct Deformation {
    Matrix3<Real> h;
    Real jacobian;

    Deformation(const Increment<kind, Real>& increment, bool local_basis) {
        const Matrix3<Real> f = increment.deformation_gradient();
        h = displacement_gradient<kind>(f);
        jacobian = lode::jacobian<kind>(f);
        if constexpr (!is_batch<Real>) {
            if (local_basis) h = turned_to_reference(h);
        }
    }

  private:
    [[gnu::noinline]] static Matrix3<Real> turned_to_reference(const Matrix3<Real> gradient) {
        return left_stretch_minus_identity<kind>(gradient);
    }
};

// Kinematics of F* = I + H with J* = det F*, which counts where J* is not near 1.
template <AnalysisKind kind, class Real>
inline Kinematics<kind, Real> kinematics_of_gradient(const Matrix3<Real>& h, const Real& jacobian) {
    Kinematics<kind, Real> k;
    k.h = h;
    k.b = left_cauchy_green_minus_identity<kind>(h);
    k.j = jacobian_minus_one<kind>(h);
    k.jacobian = select(k.j > Real(-0.5), 1.0 + k.j, jacobian);
    return k;
}

// Plane stress: completes the kinematics by the thickness stretch F33* and, without cancellation, d = F33* - 1.
template <class Real>
inline void set_thickness(Kinematics<AnalysisKind::plane_stress, Real>& k, const Real& stretch, const Real& d) {
    k.h(2, 2) = d;
    k.b[2] = d * (2.0 + d);
    k.jacobian = k.jacobian * stretch;
    k.j = k.j + d + k.j * d;
}

// I1 - 3 - 2 (J - 1) = H:H - 2 (sum of principal minors of H) - 2 det H: of second order in H, and formed as such.
template <AnalysisKind kind, class Real>
inline Real first_invariant_excess(const Matrix3<Real>& h) {
    const auto square_of_row = [&h](int i) { return h(i, 0) * h(i, 0) + h(i, 1) * h(i, 1) + h(i, 2) * h(i, 2); };
    if constexpr (kind == AnalysisKind::solid) {
        return square_of_row(0) + square_of_row(1) + square_of_row(2) - 2.0 * minors_and_determinant(h);
    } else {
        const Real squares = h(0, 0) * h(0, 0) + h(0, 1) * h(0, 1) + h(1, 0) * h(1, 0) + h(1, 1) * h(1, 1);
        const Real minor = h(0, 0) * h(1, 1) - h(0, 1) * h(1, 0);
        return squares - 2.0 * minor + h(2, 2) * (h(2, 2) - 2.0 * plane_jacobian_minus_one(h));
    }
}

// A^2 of a symmetric tensor with three normal components.
template <AnalysisKind kind, class Real>
inline Stress<kind, Real> square_of(const Stress<kind, Real>& a) {
    Stress<kind, Real> r;
    const Real s12 = a[3] * a[3];
    if constexpr (kind == AnalysisKind::solid) {
        const Real s13 = a[4] * a[4], s23 = a[5] * a[5];
        r[0] = a[0] * a[0] + s12 + s13;
        r[1] = a[1] * a[1] + s12 + s23;
        r[2] = a[2] * a[2] + s13 + s23;
        r[3] = (a[0] + a[1]) * a[3] + a[4] * a[5];
        r[4] = (a[0] + a[2]) * a[4] + a[3] * a[5];
        r[5] = (a[1] + a[2]) * a[5] + a[3] * a[4];
    } else {
        r[0] = a[0] * a[0] + s12;
        r[1] = a[1] * a[1] + s12;
        r[2] = a[2] * a[2];
        r[3] = (a[0] + a[1]) * a[3];
    }
    return r;
}

}  // namespace lode
