// Eigenvalues and eigenvectors of a symmetric 3x3 tensor without iterations, accurate relative to its largest entry,
// also for close and equal eigenvalues: the eigenvalue farthest from the other two from the characteristic polynomial,
// its vector from the adjugate, the other two from the 2x2 tensor across it. A third of the time of the rotations of
// eigen.hpp, whose small eigenvalues of graded tensors are better.
// Source: Scherzinger and Dohrmann, Comput. Methods Appl. Mech. Engrg. 197 (2008) 4007-4015.
#pragma once

#include "lode/tensor/eigen.hpp"

namespace lode {

namespace eigen_detail {

// cos(arccos(c)/3) for c in [0, 1], the largest root of 4 x^3 - 3 x = c: a polynomial that is right to 5e-6, then one
// step of Halley.
template <class Real>
LODE_INLINE Real third_of_angle(const Real& c) {
    const Real guess = 0.86603043202269 +
                       c * (0.16641172178760 + c * (-0.04592193313076 + c * (0.01751218857521 - c * 0.00403539871666)));
    const Real square = guess * guess, f = guess * (4.0 * square - 3.0) - c, slope = 12.0 * square - 3.0;
    return guess - f * slope / (slope * slope - 12.0 * guess * f);
}

}  // namespace eigen_detail

template <class Real>
LODE_INLINE SymmetricEigen<Real> eigen_by_deflation(const Matrix3<Real>& tensor) {
    const Real zero(0.0), one(1.0);
    // A tensor of a plane keeps its axis 3, and what is zero in it.
    if constexpr (std::is_same_v<Real, double>)
        if (tensor(0, 2) == 0.0 && tensor(1, 2) == 0.0) return eigen_detail::jacobi<true>(tensor);
    // Deviator over its size.
    const Real mean = (1.0 / 3.0) * trace(tensor);
    const Real d0 = tensor(0, 0) - mean, d1 = tensor(1, 1) - mean, d2 = tensor(2, 2) - mean;
    const Real largest =
        max(max(max(abs(d0), abs(d1)), abs(d2)), max(max(abs(tensor(0, 1)), abs(tensor(0, 2))), abs(tensor(1, 2))));
    const Real scale = select(largest > Real(1e-300), largest, one), inverse = 1.0 / scale;
    const Real a = inverse * d0, b = inverse * d1, c = inverse * d2;
    const Real f = inverse * tensor(0, 1), g = inverse * tensor(0, 2), h = inverse * tensor(1, 2);
    const Real J2 = 0.5 * (a * a + b * b + c * c) + f * f + g * g + h * h;
    const Real J3 = a * (b * c - h * h) - f * (f * c - h * g) + g * (f * h - b * g);
    const Real radius = sqrt(max(Real((1.0 / 3.0) * J2), Real(1e-300)));
    const Mask<Real> down = J3 < zero;
    const Real angle = min(Real(0.5 * abs(J3) / (radius * radius * radius)), one);
    const Real size = 2.0 * radius * eigen_detail::third_of_angle(angle), first = select(down, -size, size);

    // adj(S - first 1) = (gaps) n n^T; its column of the largest diagonal entry.
    const Real p = a - first, q = b - first, r = c - first;
    const Real A = q * r - h * h, B = p * r - g * g, C = p * q - f * f;
    const Real D = g * h - f * r, E = f * h - g * q, F = f * g - h * p;
    const Mask<Real> is_A = A >= B && A >= C, is_B = !is_A && B >= C;
    Vector<Real, 3> n;
    n[0] = select(is_A, A, select(is_B, D, E));
    n[1] = select(is_A, D, select(is_B, B, F));
    n[2] = select(is_A, E, select(is_B, F, C));
    const Real norm = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
    const Mask<Real> round = !(norm > Real(1e-60));  // equal eigenvalues
    const Real shorten = 1.0 / sqrt(select(round, one, norm));
    n[0] = select(round, zero, shorten * n[0]);
    n[1] = select(round, zero, shorten * n[1]);
    n[2] = select(round, one, shorten * n[2]);

    // u, v across n (Duff et al., J. Comput. Graph. Tech. 6 (2017) 1-8).
    const Real sign = select(n[2] < zero, Real(-1.0), one);
    const Real k = -1.0 / (sign + n[2]), l = n[0] * n[1] * k;
    Vector<Real, 3> u, v;
    u[0] = 1.0 + sign * (n[0] * n[0]) * k;
    u[1] = sign * l;
    u[2] = -sign * n[0];
    v[0] = l;
    v[1] = sign + n[1] * n[1] * k;
    v[2] = zero - n[1];
    const auto times = [&](const Vector<Real, 3>& x) {
        Vector<Real, 3> y;
        y[0] = a * x[0] + f * x[1] + g * x[2];
        y[1] = f * x[0] + b * x[1] + h * x[2];
        y[2] = g * x[0] + h * x[1] + c * x[2];
        return y;
    };
    const auto product = [](const Vector<Real, 3>& x, const Vector<Real, 3>& y) {
        return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
    };
    const Vector<Real, 3> Su = times(u), Sv = times(v);
    const Real uu = product(u, Su), uv = product(u, Sv), vv = product(v, Sv);
    const Real half = 0.5 * (uu - vv), middle = 0.5 * (uu + vv), reach = sqrt(half * half + uv * uv);
    // cos 2a = half/reach, sin 2a = uv/reach; the larger of cos a and sin a by the half-angle formula.
    const Mask<Real> equal = !(reach > zero);
    const Real over = 1.0 / select(equal, one, reach);
    const Real x = select(equal, one, half * over), y = uv * over;
    const Real large = sqrt(0.5 * (1.0 + abs(x))), small = 0.5 * y / large;
    const Mask<Real> wide = x < zero;
    const Real cosine = select(wide, small, large), sine = select(wide, large, small);

    SymmetricEigen<Real> e;
    e.values[0] = mean + scale * first;
    e.values[1] = mean + scale * (middle + reach);
    e.values[2] = mean + scale * (middle - reach);
    for (int i = 0; i < 3; ++i) {
        e.vectors(i, 0) = n[i];
        e.vectors(i, 1) = cosine * u[i] + sine * v[i];
        e.vectors(i, 2) = cosine * v[i] - sine * u[i];
    }
    return e;
}

}  // namespace lode
