// Polar decomposition F = R U = V R of a deformation gradient with det F > 0, without eigenvectors.
//
// With l the stretches, i1 = tr V, i2 = l1 l2 + l2 l3 + l3 l1, i3 = J, and I1 = |F|^2, I2 = |cof F|^2 (sums of squares,
// so nothing cancels), the invariants of V solve
//     i1 = sqrt(I1 + 2 i2),   i2 = sqrt(I2 + 2 J i1),
// whose slope is i3/(i1 i2) <= 1/9: Newton from sqrt(3 I1) takes 1 to 4 steps, also for equal and extreme stretches.
// Cayley-Hamilton then gives, with D = i1 i2 - i3 = (l1 + l2)(l2 + l3)(l3 + l1),
//     D R = i1 cof F + (I1 + i2) F - B F
//     D V = i1 i3 I + (I1 + i2) B - B^2
//     D (V - I) = [(1 + i1) det b/(1 + i1 + i2 + i3)] I + (I1 + i2 - 2) b - b^2,      b = B - I,
// the last with full relative accuracy at any strain: every term is of the order of b.
// Cancellation in these costs 4 eps |F|^3/D relative to |F|, at most 80 eps while D >= 0.05 i1^3 (largest stretch up to
// about 40 times the middle one). Otherwise R comes from a singular value decomposition by one-sided Jacobi rotations,
// which is accurate for any stretches, and V = sym(F R^T). Sources: Hoger and Carlson (1984), Franca (1989); Hestenes
// (1958). Page 50, section 1.9.
#pragma once

#include "lode/tensor/kinematics.hpp"

namespace lode {

namespace polar_detail {

inline constexpr double ill_conditioned = 0.05;
inline constexpr double large_strain = 8.0;  // tr b: some stretch is larger than 1.9

// Cofactors, d det F/dF.
template <class Real>
inline Matrix3<Real> cofactors(const Matrix3<Real>& f) {
    return transpose(adjugate(f));
}
template <class Real>
inline Real squared_norm(const Matrix3<Real>& a) {
    Real sum = a.m[0] * a.m[0];
    for (std::size_t i = 1; i < 9; ++i) sum = sum + a.m[i] * a.m[i];
    return sum;
}
template <class Real>
inline Matrix3<Real> select_matrix(const Mask<Real>& mask, const Matrix3<Real>& yes, const Matrix3<Real>& no) {
    Matrix3<Real> r;
    for (std::size_t i = 0; i < 9; ++i) r.m[i] = select(mask, yes.m[i], no.m[i]);
    return r;
}
// A B^T where that is symmetric but for rounding.
template <class Real>
inline Matrix3<Real> symmetric_product(const Matrix3<Real>& a, const Matrix3<Real>& b) {
    Matrix3<Real> r;
    for (int i = 0; i < 3; ++i) {
        r(i, i) = a(i, 0) * b(i, 0) + a(i, 1) * b(i, 1) + a(i, 2) * b(i, 2);
        for (int j = 0; j < i; ++j)
            r(i, j) = r(j, i) = 0.5 * ((a(i, 0) * b(j, 0) + a(i, 1) * b(j, 1) + a(i, 2) * b(j, 2)) +
                                       (a(j, 0) * b(i, 0) + a(j, 1) * b(i, 1) + a(j, 2) * b(i, 2)));
    }
    return r;
}

// Invariants of V; `denominator` is D.
template <class Real>
struct Invariants {
    Real i1, i2, i3, denominator;
    Mask<Real> ill_conditioned;
};
template <class Real>
inline Invariants<Real> stretch_invariants(const Real& first, const Real& second, const Real& j) {
    Real x = sqrt(3.0 * first);
    Mask<Real> done(false);
    for (int iteration = 0; iteration < 30; ++iteration) {
        const Real i2 = sqrt(second + 2.0 * j * x);
        const Real image = sqrt(first + 2.0 * i2);
        // x + (image - x)/(1 - j/(i1 i2)); the error left is below 0.01 step^2/x.
        const Real product = image * i2;
        const Real step = (image - x) * product / (product - j);
        x = select(done, x, x + step);
        // Derivatives lag one step behind the value.
        if (is_differentiated<Real> && all(done)) break;
        done = done || !(abs(step) > 1e-7 * x);
        if (!is_differentiated<Real> && all(done)) break;
    }
    Invariants<Real> v;
    v.i2 = sqrt(second + 2.0 * j * x);
    v.i1 = sqrt(first + 2.0 * v.i2);
    v.i3 = j;
    v.denominator = v.i1 * v.i2 - j;
    v.ill_conditioned = v.denominator < ill_conditioned * v.i1 * v.i1 * v.i1;
    return v;
}

// Rotates columns p and q of F and of Q so that those of F are orthogonal; returns the lanes that needed it.
template <class Real>
inline Mask<Real> orthogonalise(Matrix3<Real>& f, Matrix3<Real>& q, int first, int second) {
    constexpr double eps = 0.25 * std::numeric_limits<double>::epsilon();
    const auto dot = [&](int i, int j) { return f(0, i) * f(0, j) + f(1, i) * f(1, j) + f(2, i) * f(2, j); };
    const Real a = dot(first, first), b = dot(second, second), twice = 2.0 * dot(first, second), d = b - a;
    const Mask<Real> needed = abs(twice) > eps * sqrt(a) * sqrt(b);
    const Real root = sqrt(d * d + twice * twice), denominator = select(d < Real(0.0), d - root, d + root);
    const Real t = select(needed, twice / select(needed, denominator, Real(1.0)), Real(0.0));
    const Real c = 1.0 / sqrt(1.0 + t * t), s = t * c;
    for (Matrix3<Real>* m : {&f, &q}) {
        for (int i = 0; i < 3; ++i) {
            const Real x = (*m)(i, first), y = (*m)(i, second);
            (*m)(i, first) = c * x - s * y;
            (*m)(i, second) = s * x + c * y;
        }
    }
    return needed;
}

// F = sum_i stretch_i left_i right_i^T (columns i), by Hestenes' one-sided Jacobi rotations.
template <class Real>
struct SingularValues {
    Matrix3<Real> left, right;
    Vector<Real, 3> stretch;
};
template <class Real>
inline SingularValues<Real> singular_values(const Matrix3<Real>& f) {
    SingularValues<Real> s;
    s.left = f;
    s.right = Matrix3<Real>::identity();
    for (int sweep = 0; sweep < 15; ++sweep) {
        const Mask<Real> first = orthogonalise(s.left, s.right, 0, 1);
        const Mask<Real> second = orthogonalise(s.left, s.right, 0, 2);
        const Mask<Real> third = orthogonalise(s.left, s.right, 1, 2);
        if (!any(first || second || third)) break;
    }
    for (int k = 0; k < 3; ++k) {
        s.stretch[k] = sqrt(square(s.left(0, k)) + square(s.left(1, k)) + square(s.left(2, k)));
        for (int i = 0; i < 3; ++i) s.left(i, k) = s.left(i, k) / s.stretch[k];
    }
    return s;
}

// R = sum_i left_i right_i^T; its derivative in the basis of the singular vectors is
// (left^T dR right)_ij = (m_ij - m_ji)/(l_i + l_j), m = left^T dF right.
template <class Real>
[[gnu::noinline]] Matrix3<Real> robust_rotation(const Matrix3<Real>& f) {
    if constexpr (is_differentiated<Real>) {
        Matrix3<double> value;
        for (std::size_t i = 0; i < 9; ++i) value.m[i] = value_of(f.m[i]);
        const SingularValues<double> s = singular_values(value);
        Matrix3<Real> left, right, change;
        for (std::size_t i = 0; i < 9; ++i) {
            left.m[i] = Real(s.left.m[i]);
            right.m[i] = Real(s.right.m[i]);
            change.m[i] = f.m[i] - Real(value.m[i]);
        }
        const Matrix3<Real> m = transpose(left) * change * right;
        Matrix3<Real> inner = Matrix3<Real>::identity();
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                if (i != j) inner(i, j) = (m(i, j) - m(j, i)) / (s.stretch[i] + s.stretch[j]);
        return left * inner * transpose(right);
    } else {
        const SingularValues<Real> s = singular_values(f);
        return s.left * transpose(s.right);
    }
}

template <class Real>
struct Plane {
    Real cosine, sine, trace;  // trace of the in-plane V
};
template <class Real>
inline Plane<Real> plane_rotation(const Matrix3<Real>& f) {
    const Real a = f(0, 0) + f(1, 1), b = f(1, 0) - f(0, 1);
    const Real t = sqrt(a * a + b * b);
    return {a / t, b / t, t};
}

// F, or I where det F is not positive beyond the rounding error of its evaluation (four eps times the sum of the
// magnitudes of its terms), F is not finite, or det F < 1e-60 or |F| > 1e30 (squares stay in range).
template <AnalysisKind kind, class Real>
inline Matrix3<Real> admissible(const Matrix3<Real>& f, Mask<Real>& valid) {
    constexpr double eps = std::numeric_limits<double>::epsilon();
    Matrix3<Real> g = f;
    if constexpr (kind != AnalysisKind::solid) g(0, 2) = g(2, 0) = g(1, 2) = g(2, 1) = Real(0.0);
    if constexpr (kind == AnalysisKind::plane_stress) g(2, 2) = Real(1.0);
    const Real j = jacobian<kind>(g);
    Real terms = abs(g(0, 0) * g(1, 1)) + abs(g(0, 1) * g(1, 0));
    if constexpr (kind == AnalysisKind::solid)
        terms = abs(g(2, 2)) * terms + abs(g(0, 2)) * (abs(g(1, 0) * g(2, 1)) + abs(g(1, 1) * g(2, 0))) +
                abs(g(1, 2)) * (abs(g(0, 0) * g(2, 1)) + abs(g(0, 1) * g(2, 0)));
    else terms = abs(g(2, 2)) * terms;
    valid = j > 4.0 * eps * terms && j > Real(1e-60) && squared_norm(g) < Real(1e60);
    if constexpr (kind != AnalysisKind::solid) valid = valid && g(2, 2) > Real(0.0);
    return select_matrix(valid, g, Matrix3<Real>::identity());
}

}  // namespace polar_detail

// F = R U = V R. Where det F is not positive (see polar_detail::admissible) all three are I and `valid` is false.
template <class Real>
struct Polar {
    Matrix3<Real> rotation, left, right;
    Mask<Real> valid;
};

// R alone, orthogonal to rounding; where det F is not positive it is I.
template <AnalysisKind kind = AnalysisKind::solid, class Real>
inline Matrix3<Real> rotation(const Matrix3<Real>& deformation, Mask<Real>& valid) {
    using namespace polar_detail;
    const Matrix3<Real> f = admissible<kind>(deformation, valid);
    Matrix3<Real> r = Matrix3<Real>::identity();
    if constexpr (kind != AnalysisKind::solid) {
        const auto p = plane_rotation(f);
        r(0, 0) = r(1, 1) = p.cosine;
        r(1, 0) = p.sine;
        r(0, 1) = -p.sine;
    } else {
        Matrix3<Real> c = cofactors(f);
        const Real first = squared_norm(f);
        const Real j = f(0, 0) * c(0, 0) + f(0, 1) * c(0, 1) + f(0, 2) * c(0, 2);
        const auto v = stretch_invariants(first, squared_norm(c), j);
        const Real inverse = 1.0 / v.denominator, linear = (first + v.i2) * inverse, odd = v.i1 * inverse;
        const Matrix3<Real> bf = symmetric_product(f, f) * f;
        for (std::size_t i = 0; i < 9; ++i) r.m[i] = odd * c.m[i] + linear * f.m[i] - inverse * bf.m[i];
        if (any(v.ill_conditioned)) r = select_matrix(v.ill_conditioned, robust_rotation(f), r);
        // One step of Newton's iteration X <- (X + X^-T)/2 squares what is left of the error in R R^T = I.
        c = cofactors(r);
        const Real determinant_r = r(0, 0) * c(0, 0) + r(0, 1) * c(0, 1) + r(0, 2) * c(0, 2);
        r = 0.5 * r + (0.5 / determinant_r) * c;
    }
    return r;
}
template <AnalysisKind kind = AnalysisKind::solid, class Real>
inline Matrix3<Real> rotation(const Matrix3<Real>& deformation) {
    Mask<Real> valid;
    return rotation<kind>(deformation, valid);
}

namespace polar_detail {

// V - I from V = sym(F R^T); out of the way of the usual case.
template <class Real>
[[gnu::noinline]] Matrix3<Real> direct_stretch_minus_identity(const Matrix3<Real>& f) {
    Matrix3<Real> v = symmetric_product(f, rotation(f));
    for (int i = 0; i < 3; ++i) v(i, i) = v(i, i) - 1.0;
    return v;
}

}  // namespace polar_detail

// E = V - I of F = I + H, accurate relative to E at any strain. `valid` is set to det F > 0 (see
// polar_detail::admissible); elsewhere E = 0. In the plane kinds the components 13, 31, 23, 32 are not read, in plane
// stress 33 is returned as 0.
template <AnalysisKind kind = AnalysisKind::solid, class Real>
inline Matrix3<Real> left_stretch_minus_identity(const Matrix3<Real>& h, Mask<Real>& valid) {
    using namespace polar_detail;
    Matrix3<Real> f = h;
    for (int i = 0; i < 3; ++i) f(i, i) = 1.0 + h(i, i);
    f = admissible<kind>(f, valid);
    Matrix3<Real> g;
    for (std::size_t i = 0; i < 9; ++i) g.m[i] = select(valid, h.m[i], Real(0.0));

    const auto b = left_cauchy_green_minus_identity<kind>(g);
    if constexpr (kind != AnalysisKind::solid) {
        // tr V = sqrt(tr B + 2 J), V - I = (b + [det b/(1 + J + tr V)] I)/tr V in the plane.
        const Real j = f(0, 0) * f(1, 1) - f(0, 1) * f(1, 0);
        const Real t = plane_rotation(f).trace;
        const Real inverse = 1.0 / t;
        const Mask<Real> large = b[0] + b[1] > Real(large_strain);
        const Real even = select(large, 1.0 + j - t, (b[0] * b[1] - b[3] * b[3]) / (1.0 + j + t));
        Matrix3<Real> e = Matrix3<Real>::identity();
        e(0, 0) = (b[0] + even) * inverse;
        e(1, 1) = (b[1] + even) * inverse;
        e(0, 1) = e(1, 0) = b[3] * inverse;
        e(2, 2) = kind == AnalysisKind::plane_stress ? Real(0.0) : g(2, 2);
        return e;
    } else {
        const Matrix3<Real> c = cofactors(f);
        const Real first = squared_norm(f);
        const Real j = f(0, 0) * c(0, 0) + f(0, 1) * c(0, 1) + f(0, 2) * c(0, 2);
        const auto v = stretch_invariants(first, squared_norm(c), j);
        const Matrix3<Real> bm = to_matrix<AnalysisKind::solid, Real>(b, 1.0);
        const Matrix3<Real> b2 = symmetric_product(bm, bm);
        const Real inverse = 1.0 / v.denominator;
        const Real even = (1.0 + v.i1) * determinant(bm) / (1.0 + v.i1 + v.i2 + v.i3);
        const Real linear = first + v.i2 - 2.0;
        Matrix3<Real> e;
        for (std::size_t i = 0; i < 9; ++i) e.m[i] = inverse * (linear * bm.m[i] - b2.m[i]);
        for (int i = 0; i < 3; ++i) e(i, i) = e(i, i) + inverse * even;
        // The terms above cancel where V is not near I, and there V - I does not.
        const Mask<Real> far = v.ill_conditioned || first > Real(3.0 + large_strain);
        if (any(far)) {
            e = select_matrix(far, polar_detail::direct_stretch_minus_identity(f), e);
        }
        return e;
    }
}
template <AnalysisKind kind = AnalysisKind::solid, class Real>
inline Matrix3<Real> left_stretch_minus_identity(const Matrix3<Real>& h) {
    Mask<Real> valid;
    return left_stretch_minus_identity<kind>(h, valid);
}

// All three factors: V = F R^T, U = R^T F, symmetric exactly.
template <AnalysisKind kind = AnalysisKind::solid, class Real>
inline Polar<Real> polar_decomposition(const Matrix3<Real>& deformation) {
    Polar<Real> p;
    const Matrix3<Real> f = polar_detail::admissible<kind>(deformation, p.valid);
    Mask<Real> always;
    p.rotation = rotation<kind>(f, always);
    p.left = polar_detail::symmetric_product(f, p.rotation);
    p.right = polar_detail::symmetric_product(transpose(f), transpose(p.rotation));
    return p;
}
// V = sqrt(F F^T) and U = sqrt(F^T F).
template <AnalysisKind kind = AnalysisKind::solid, class Real>
inline Matrix3<Real> left_stretch(const Matrix3<Real>& deformation) {
    return polar_decomposition<kind>(deformation).left;
}
template <AnalysisKind kind = AnalysisKind::solid, class Real>
inline Matrix3<Real> right_stretch(const Matrix3<Real>& deformation) {
    return polar_decomposition<kind>(deformation).right;
}

}  // namespace lode
