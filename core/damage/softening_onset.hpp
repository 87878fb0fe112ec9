// Where a crack forms in an isotropic solid (page 30, section 4.1).
#pragma once

#include "lode/damage/softening_axes.hpp"
#include "lode/numerics/lanes.hpp"
#include "lode/tensor/eigen.hpp"

namespace lode {

// The crack plane: N = cos(theta) e1 + sin(theta) e3, T = -sin(theta) e1 + cos(theta) e3, e1 and e3 the directions of
// the largest and the smallest principal stress.
template <class Real>
struct OnsetPlane {
    Mask<Real> cracks = Mask<Real>(false);
    Vector<Real, 3> N, T;
    Real mode;
    // For the tangent.
    Real cosine, sine;               // of theta
    Real s1, s2, s3;                 // principal stresses, s2 out of the (e1, e3) plane
    Real mean, radius, by_pressure;  // (s1 + s3)/2, (s1 - s3)/2, d ln(cos 2 theta)/dP
};

template <class Real>
struct IsotropicOnset {
    Real tensile, shear;  // strengths of the point
    Real shear_slope;     // d(shear)/dP
    bool in_tension, in_shear, ovoid;

    // True where no plane can be critical, from invariants alone: s1 <= mean + 2 sqrt(J2/3), (s1 - s3)/2 <= sqrt(J2).
    LODE_INLINE Mask<Real> is_safe(const Real& mean, const Real& J2) const {
        const Real s1 = positive_part(Real(mean + sqrt((4.0 / 3.0) * J2)));
        if (ovoid) return square(s1 * shear) + J2 * square(tensile) < square(tensile * shear);
        Mask<Real> safe = Mask<Real>(true);
        if (in_tension) safe = safe && s1 < tensile;
        if (in_shear) safe = safe && J2 < square(shear);
        return safe;
    }

    // Sets mode and theta; true where the surface is reached.
    LODE_INLINE Mask<Real> reached(OnsetPlane<Real>& plane) const {
        const Real one(1.0), never(-1.0);
        const double root_half = 0.70710678118654752440;
        plane.mean = 0.5 * (plane.s1 + plane.s3);
        plane.radius = 0.5 * (plane.s1 - plane.s3);
        const Real v_t = in_tension ? plane.s1 / tensile : never, v_s = in_shear ? plane.radius / shear : never;
        Mask<Real> tension = v_t >= v_s, mixed = Mask<Real>(false);
        Real v = select(tension, v_t, v_s);
        if (ovoid) {
            const Mask<Real> pulls = plane.mean > Real(0.0);
            const Real gap = square(tensile) - square(shear), p = plane.mean * square(shear), r = plane.radius * gap;
            mixed = pulls && tensile > shear && p < r;
            tension = tension || pulls;
            v = select(tension, v_t, v_s);
            const Real ratio = p / select(mixed, r, one);  // cos(2 theta)
            v = select(mixed, sqrt(square(v_s) + square(plane.mean) / select(mixed, gap, one)), v);
            plane.cosine = select(mixed, sqrt(0.5 * (1.0 + ratio)), Real(0.0));
            plane.sine = select(mixed, sqrt(0.5 * (1.0 - ratio)), Real(0.0));
            plane.by_pressure = 2.0 * shear_slope * (1.0 / shear + shear / select(mixed, gap, one));
        }
        plane.mode = select(mixed, Real(3.0), select(tension, one, Real(2.0)));
        const Real cosine = select(tension, one, Real(root_half)), sine = select(tension, Real(0.0), Real(root_half));
        plane.cosine = select(mixed, plane.cosine, cosine);
        plane.sine = select(mixed, plane.sine, sine);
        return v >= one;
    }
};

namespace onset_detail {

// Plane kinds: e1 at the angle a = atan2(2 s12, s11 - s22)/2, in (-pi/2, pi/2].
template <AnalysisKind kind, class Real>
LODE_INLINE OnsetPlane<Real> in_plane(const IsotropicOnset<Real>& strengths, const Stress<kind, Real>& s,
                                      const Mask<Real>& where) {
    constexpr int shear = normal_components(kind);
    const Real zero(0.0), one(1.0);
    OnsetPlane<Real> plane{};
    const Real half_difference = 0.5 * (s[0] - s[1]), tau = s[shear];
    const Real radius = sqrt(half_difference * half_difference + tau * tau), mean = 0.5 * (s[0] + s[1]);
    plane.s1 = mean + radius;
    plane.s3 = mean - radius;
    plane.s2 = zero;
    plane.cracks = where && strengths.reached(plane);
    if (!any(plane.cracks)) return plane;

    // cos 2a = x, sin 2a = y; the larger of cos a and sin a by the half-angle formula, the other from sin 2a.
    const Mask<Real> round = !(radius > zero);
    const Real x = select(round, one, half_difference / select(round, one, radius));
    const Real y = select(round, zero, tau / select(round, one, radius));
    const Real large = sqrt(0.5 * (1.0 + abs(x))), small = 0.5 * abs(y) / large;
    const Mask<Real> wide = x < zero, down = y < zero;
    const Real cosine = select(wide, small, large), magnitude = select(wide, large, small);
    const Real sine = select(down, zero - magnitude, magnitude);
    plane.N[0] = plane.cosine * cosine - plane.sine * sine;
    plane.N[1] = plane.cosine * sine + plane.sine * cosine;
    plane.T[0] = zero - plane.N[1];
    plane.T[1] = plane.N[0];
    plane.N[2] = plane.T[2] = zero;
    return plane;
}

// One point in 3D. Principal stresses in descending order, ties in the order of the axes; every direction with its
// largest component positive.
template <class Real>
[[gnu::noinline]] OnsetPlane<Real> in_space(const IsotropicOnset<Real>& strengths,
                                            const Stress<AnalysisKind::solid, Real>& s) {
    const SymmetricEigen<Real> eigen =
        symmetric_eigen<AnalysisKind::solid>(to_matrix<AnalysisKind::solid, Real>(s, 1.0));
    int order[3] = {0, 1, 2};
    const auto ahead = [&](int a, int b) { return eigen.values[b] > eigen.values[a]; };
    if (ahead(order[0], order[1])) std::swap(order[0], order[1]);
    if (ahead(order[1], order[2])) std::swap(order[1], order[2]);
    if (ahead(order[0], order[1])) std::swap(order[0], order[1]);
    OnsetPlane<Real> plane{};
    plane.s1 = eigen.values[order[0]];
    plane.s2 = eigen.values[order[1]];
    plane.s3 = eigen.values[order[2]];
    plane.cracks = strengths.reached(plane);
    if (!plane.cracks) return plane;
    Vector<Real, 3> e[2];
    for (int k = 0; k < 2; ++k) {
        const int column = order[2 * k];
        int largest = 0;
        for (int i = 1; i < 3; ++i)
            if (abs(eigen.vectors(i, column)) > abs(eigen.vectors(largest, column))) largest = i;
        const double sign = eigen.vectors(largest, column) < Real(0.0) ? -1.0 : 1.0;
        for (int i = 0; i < 3; ++i) e[k][i] = sign * eigen.vectors(i, column);
    }
    for (int i = 0; i < 3; ++i) {
        plane.N[i] = plane.cosine * e[0][i] + plane.sine * e[1][i];
        plane.T[i] = plane.cosine * e[1][i] - plane.sine * e[0][i];
    }
    return plane;
}

// The lanes of `where`, one by one.
[[gnu::noinline]] inline OnsetPlane<Batch> in_space_lanes(const IsotropicOnset<Batch>& strengths,
                                                          const Stress<AnalysisKind::solid, Batch>& s,
                                                          const Mask<Batch>& where) {
    Lanes<Batch> stress[6], out[8] = {}, tensile = to_lanes(strengths.tensile), shear = to_lanes(strengths.shear);
    for (int i = 0; i < 6; ++i) stress[i] = to_lanes(s[i]);
    for (std::size_t lane = 0; lane < Lanes<Batch>{}.size(); ++lane) {
        if (!is_set<Batch>(where, lane)) continue;
        Stress<AnalysisKind::solid, double> one;
        for (int i = 0; i < 6; ++i) one[i] = stress[i][lane];
        const IsotropicOnset<double> at{tensile[lane],        shear[lane],        0.0,
                                        strengths.in_tension, strengths.in_shear, strengths.ovoid};
        const OnsetPlane<double> plane = in_space<double>(at, one);
        if (!plane.cracks) continue;
        out[0][lane] = plane.mode;
        for (int i = 0; i < 3; ++i) {
            out[1 + i][lane] = plane.N[i];
            out[4 + i][lane] = plane.T[i];
        }
    }
    OnsetPlane<Batch> plane{};
    plane.mode = from_lanes<Batch>(out[0]);
    plane.cracks = plane.mode > Batch(0.0);
    for (int i = 0; i < 3; ++i) {
        plane.N[i] = from_lanes<Batch>(out[1 + i]);
        plane.T[i] = from_lanes<Batch>(out[4 + i]);
    }
    return plane;
}

}  // namespace onset_detail

// The plane of the lanes `where` that crack under the stress s.
template <AnalysisKind kind, class Real>
LODE_INLINE OnsetPlane<Real> find_onset(const IsotropicOnset<Real>& strengths, const Stress<kind, Real>& s,
                                        const Mask<Real>& where) {
    if constexpr (kind == AnalysisKind::uniaxial) {
        OnsetPlane<Real> plane{};
        plane.cracks = where && Mask<Real>(strengths.in_tension) && s[0] >= strengths.tensile;
        plane.mode = Real(1.0);
        for (int i = 0; i < 3; ++i) {
            plane.N[i] = Real(i == 0 ? 1.0 : 0.0);
            plane.T[i] = Real(i == 1 ? 1.0 : 0.0);
        }
        return plane;
    } else if constexpr (kind != AnalysisKind::solid) {
        return onset_detail::in_plane(strengths, s, where);
    } else {
        const Real mean = (1.0 / 3.0) * (s[0] + s[1] + s[2]);
        const Real J2 = (1.0 / 6.0) * (square(s[0] - s[1]) + square(s[1] - s[2]) + square(s[2] - s[0])) + square(s[3]) +
                        square(s[4]) + square(s[5]);
        const Mask<Real> near = where && !strengths.is_safe(mean, J2);
        if (!any(near)) return OnsetPlane<Real>{};
        if constexpr (is_batch<Real>) return onset_detail::in_space_lanes(strengths, s, near);
        else return onset_detail::in_space(strengths, s);
    }
}

}  // namespace lode
