// What ORTHO_SOFTENING is made of: the stiffness in material axes, the planes that may crack, where a crack forms
// (page 30, sections 2.2 and 4.1).
#pragma once

#include "lode/damage/ortho_softening_description.hpp"
#include "lode/elastic/orthotropic_moduli.hpp"

namespace lode {

template <class Real>
struct OrthotropicOnset {
    Mask<Real> cracks;
    Vector<Real, 3> N, T;  // in material axes
    Real mode;
    Real turning;  // 0: a plane of symmetry; the normal turns with 1 the principal axes, 2 the axial shear
};

class OrthotropicPlanes {
  public:
    struct Limit {
        double length = HUGE_VAL;  // h_max
        const char* text = "";
    };

    Matrix3<double> compliance;

    OrthotropicPlanes(const Properties& p, const SofteningLaw& normal_law, const SofteningLaw& shear_law,
                      TractionSurface surface, bool plane_stress)
        : surface_(surface), axial_(p.code(ortho_softening::TIAXIS) - 1) {
        using namespace ortho_softening;
        const auto moduli = OrthotropicModuli::from_properties(p, E1);
        compliance = moduli.compliance;
        normal_ = moduli.stiffness;
        if (plane_stress) {
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j)
                    normal_(i, j) = i == 2 || j == 2
                                        ? 0.0
                                        : moduli.stiffness(i, j) -
                                              moduli.stiffness(i, 2) * moduli.stiffness(j, 2) / moduli.stiffness(2, 2);
        }
        shear_[0][1] = shear_[1][0] = moduli.shear[0];
        shear_[0][2] = shear_[2][0] = moduli.shear[1];
        shear_[1][2] = shear_[2][1] = moduli.shear[2];
        for (int i = 0; i < 3; ++i) {
            const int first = S1 + 6 * i, j = i == 0 ? 1 : 0, k = i == 2 ? 1 : 2;
            shear_[i][i] = normal_(i, i);
            strength_[i][i] = p[first], strength_[i][j] = p[first + 1], strength_[i][k] = p[first + 2];
            toughness_[i][i] = p[first + 3], toughness_[i][j] = p[first + 4], toughness_[i][k] = p[first + 5];
        }
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                const SofteningLaw& law = i == j ? normal_law : shear_law;
                hardest_[i][j] = std::sqrt(law.eta() * toughness_[i][j] * shear_[i][j]);
            }
        check(p);
        solid_limit_ = find_limit(false);
        plane_limit_ = find_limit(true);
    }

    // A plane that may crack in 3D has a zero strength which its surface does not allow.
    bool incomplete() const { return incomplete_; }

    template <AnalysisKind kind>
    LODE_INLINE const Limit& limit() const {
        return kind == AnalysisKind::solid ? solid_limit_ : plane_limit_;
    }

    template <AnalysisKind kind, class Real>
    LODE_INLINE Stress<kind, Real> stress(const Strain<kind, Real>& e) const {
        constexpr int normals = normal_components(kind);
        Stress<kind, Real> s;
        for (int i = 0; i < normals; ++i) {
            s[i] = normal_(i, 0) * e[0];
            for (int j = 1; j < normals; ++j) s[i] = s[i] + normal_(i, j) * e[j];
        }
        s[normals] = shear_[0][1] * e[normals];
        if constexpr (kind == AnalysisKind::solid) {
            s[4] = shear_[0][2] * e[4];
            s[5] = shear_[1][2] * e[5];
        }
        return s;
    }
    template <AnalysisKind kind, class Real>
    LODE_INLINE Real energy(const Stress<kind, Real>& s) const {
        constexpr int normals = normal_components(kind);
        Real sum = square(s[normals]) * (1.0 / shear_[0][1]);
        if constexpr (kind == AnalysisKind::solid)
            sum = sum + square(s[4]) * (1.0 / shear_[0][2]) + square(s[5]) * (1.0 / shear_[1][2]);
        for (int i = 0; i < normals; ++i)
            for (int j = 0; j < normals; ++j) sum = sum + compliance(i, j) * (s[i] * s[j]);
        return 0.5 * sum;
    }
    template <AnalysisKind kind>
    void set(Tangent<kind>& tangent) const {
        constexpr int n = components(kind), normals = normal_components(kind);
        for (int i = 0; i < n * n; ++i) tangent.stiffness[i] = 0.0;
        for (int i = 0; i < normals; ++i)
            for (int j = 0; j < normals; ++j) tangent(i, j) = normal_(i, j);
        tangent(normals, normals) = shear_[0][1];
        if constexpr (kind == AnalysisKind::solid) tangent(4, 4) = shear_[0][2], tangent(5, 5) = shear_[1][2];
    }

    // Constants of the crack with these axes, read from the material axes nearest to N and T, and its stiffness vectors
    // C:(N N), C:(N T + T N)/2 x 2, ... in material axes.
    template <AnalysisKind kind, class Real>
    LODE_INLINE void set_crack(const CrackAxes<Real>& axes, const softening_state::PointSize<Real>& size,
                               Vector<SofteningDirection<Real>, crack_directions(kind)>& law,
                               Stress<kind, Real> (&stiffness)[crack_directions(kind)]) const {
        constexpr bool plane = kind != AnalysisKind::solid;
        constexpr int m = crack_directions(kind);
        Mask<Real> family[3], along[3];
        nearest<plane>(axes, family, along);
        const Real energy = size.toughness / size.length;
        for (int d = 0; d < m; ++d) {
            Real strength = Real(0.0), toughness = Real(1.0), modulus = Real(1.0);
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) {
                    if ((d == 0) != (i == j) || (plane && (i == 2 || j == 2))) continue;
                    const Mask<Real> here = d == 0 ? family[i] : family[i] && (d == 1 ? along[j] : !along[j]);
                    strength = select(here, Real(strength_[i][j]), strength);
                    toughness = select(here, Real(toughness_[i][j]), toughness);
                    modulus = select(here, Real(shear_[i][j]), modulus);
                }
            law[d] = {Real(size.strength * strength), Real(energy * toughness), modulus};

            // Strain of the direction: N N, or (N T + T N)/2 with engineering shears.
            const auto dyad = symmetric_dyad<kind>(axes.N, axes[d]);
            Strain<kind, Real> unit;
            for (int i = 0; i < components(kind); ++i) unit[i] = i < normal_components(kind) ? 0.5 * dyad[i] : dyad[i];
            stiffness[d] = stress<kind, Real>(unit);
        }
    }

    // The plane with the largest surface value under the stress s (material axes). `limit`: see OrthoSoftening.
    template <AnalysisKind kind, class Real>
    LODE_INLINE OrthotropicOnset<Real> onset(const Stress<kind, Real>& s, const Real& relative_strength,
                                             const Real& limit) const {
        constexpr bool plane = kind != AnalysisKind::solid;
        const Real zero(0.0), one(1.0);
        const Matrix3<Real> sigma = to_matrix<kind, Real>(s, 1.0);
        OrthotropicOnset<Real> best;
        Real value = Real(-1.0);
        best.mode = best.turning = zero;
        for (int i = 0; i < 3; ++i) best.N[i] = best.T[i] = zero;

        // A candidate: axes, its family and the material axis that stands for T.
        const auto offer = [&](const Vector<Real, 3>& N, const Vector<Real, 3>& T, int i, int j, double turning,
                               const Mask<Real>& where) {
            const int k = 3 - i - j;
            const Vector<Real, 3> t = sigma * N, Z = cross(N, T);
            const auto ratio = [&](const Real& traction, int direction) {
                if (strength_[i][direction] == 0.0) return zero;
                return traction / min(relative_strength * strength_[i][direction], limit * hardest_[i][direction]);
            };
            const Real R_n = ratio(positive_part(dot(N, t)), i), R_y = ratio(abs(dot(T, t)), j);
            const Real R_z = plane ? zero : ratio(abs(dot(Z, t)), k);
            const bool largest =
                surface_ == TractionSurface::cuboid || surface_ == TractionSurface::coupled_cuboid || plane;
            const Real shear = largest ? max(R_y, R_z) : sqrt(R_y * R_y + R_z * R_z);
            const bool ovoid = surface_ == TractionSurface::ovoid;
            const Real v = ovoid ? sqrt(R_n * R_n + shear * shear) : max(R_n, shear);
            const Mask<Real> mixed = Mask<Real>(ovoid) && min(R_n, shear) > 1e-6 * v;
            const Mask<Real> better = where && v > value + 1e-12;
            value = select(better, v, value);
            best.mode = select(better, select(mixed, Real(3.0), select(R_n >= shear, one, Real(2.0))), best.mode);
            best.turning = select(better, Real(turning), best.turning);
            for (int c = 0; c < 3; ++c) {
                best.N[c] = select(better, N[c], best.N[c]);
                best.T[c] = select(better, T[c], best.T[c]);
            }
        };
        const auto unit = [&](int i) {
            Vector<Real, 3> v{zero, zero, zero};
            v[i] = one;
            return v;
        };
        const auto symmetry_plane = [&](int i) {
            const int j = i == 0 ? 1 : 0;
            offer(unit(i), unit(j), i, j, 0.0, Mask<Real>(true));
        };
        if (!any_normal(plane)) {
            for (int i = 0; i < (plane ? 2 : 3); ++i) symmetry_plane(i);
        } else {
            if (!plane) offer(unit(axial_), unit(b1()), axial_, b1(), 0.0, Mask<Real>(true));
            const auto at_angle = [&](const Real& c, const Real& sine, double turning, const Mask<Real>& where) {
                Vector<Real, 3> N{zero, zero, zero}, T{zero, zero, zero};
                N[b1()] = c, N[b2()] = sine;
                T[b1()] = zero - sine, T[b2()] = c;
                offer(N, T, b1(), b2(), turning, where);
            };
            // w0 = atan2(2 s_12, s_11 - s_22)/2 by half-angle formulas, w0 + 45 degrees, and the axial shear's.
            const Real x = 0.5 * (sigma(b1(), b1()) - sigma(b2(), b2())), y = sigma(b1(), b2());
            const Real radius = sqrt(x * x + y * y);
            const Mask<Real> round = !(radius > zero);
            const Real inverse = one / select(round, one, radius);
            const Real large = sqrt(0.5 * (1.0 + select(round, one, abs(x) * inverse)));
            const Real small = 0.5 * abs(y) * inverse / large;
            const Mask<Real> wide = x < zero;
            const Real c = select(wide, small, large), magnitude = select(wide, large, small);
            const Real sine = select(y < zero, zero - magnitude, magnitude);
            at_angle(c, sine, 1.0, Mask<Real>(true));
            const double root_half = 0.70710678118654752440;
            at_angle(root_half * (c - sine), root_half * (c + sine), 1.0, Mask<Real>(true));
            if constexpr (!plane) {
                const Real t1 = sigma(axial_, b1()), t2 = sigma(axial_, b2()), size = sqrt(t1 * t1 + t2 * t2);
                const Mask<Real> shears = size > zero;
                const Real over = one / select(shears, size, one);
                at_angle(t1 * over, t2 * over, 2.0, shears);
            }
        }
        best.cracks = value >= one;
        return best;
    }

    // d(angle) of the normal in the isotropic plane under a change of stress.
    double turn(double turning, const Matrix3<double>& s, const Matrix3<double>& ds) const {
        const int i = b1(), j = b2();
        if (turning == 1.0) {
            const double x = s(i, i) - s(j, j), y = 2.0 * s(i, j), square_size = x * x + y * y;
            return square_size > 0.0 ? 0.5 * (x * 2.0 * ds(i, j) - y * (ds(i, i) - ds(j, j))) / square_size : 0.0;
        }
        const double x = s(axial_, i), y = s(axial_, j), square_size = x * x + y * y;
        return square_size > 0.0 ? (x * ds(axial_, j) - y * ds(axial_, i)) / square_size : 0.0;
    }

  private:
    TractionSurface surface_;
    int axial_;  // TIAXIS - 1, or -1
    bool incomplete_ = false;
    Matrix3<double> normal_;
    double shear_[3][3];                       // G_ij; C_ii on the diagonal
    double strength_[3][3], toughness_[3][3];  // [i][j]: planes normal to i; [i][i] across them, [i][j] in direction j
    double hardest_[3][3];                     // sqrt(eta G C)
    Limit solid_limit_, plane_limit_;

    // The axes of the isotropic plane, b1 < b2.
    LODE_INLINE int b1() const { return axial_ == 0 ? 1 : 0; }
    LODE_INLINE int b2() const { return axial_ == 2 ? 1 : 2; }
    // Cracks may have any normal in the isotropic plane: in the plane kinds if that is the plane.
    LODE_INLINE bool any_normal(bool plane) const { return plane ? axial_ == 2 : axial_ >= 0; }
    // Planes normal to axis i may crack.
    bool in_use(int i, bool plane) const {
        if (any_normal(plane)) return i == b1() || (!plane && i == axial_);
        return !plane || i < 2;
    }

    // One of three for N and one of three for T.
    template <bool plane, class Real>
    LODE_INLINE void nearest(const CrackAxes<Real>& axes, Mask<Real> (&family)[3], Mask<Real> (&along)[3]) const {
        const Mask<Real> yes(true), no(false);
        Vector<Real, 3> n, t;
        for (int i = 0; i < 3; ++i) n[i] = abs(axes.N[i]), t[i] = abs(axes.T[i]);
        if (any_normal(plane)) {
            const Mask<Real> across = plane ? no : n[axial_] > Real(0.70710678118654752440);
            const Mask<Real> lengthwise = plane ? no : t[axial_] > Real(0.70710678118654752440);
            const Mask<Real> first = t[b1()] >= t[b2()];
            family[axial_] = across;
            family[b1()] = !across;
            family[b2()] = no;
            along[axial_] = !across && lengthwise;
            along[b1()] = across && first;
            along[b2()] = (across && !first) || (!across && !lengthwise);
            return;
        }
        if constexpr (plane) {
            family[0] = n[0] >= n[1];
            family[1] = !family[0];
            family[2] = along[2] = no;
            along[0] = family[1];
            along[1] = family[0];
            return;
        }
        family[0] = n[0] >= n[1] && n[0] >= n[2];
        family[1] = !family[0] && n[1] >= n[2];
        family[2] = !family[0] && !family[1];
        // The largest of the other two components of T.
        for (int i = 0; i < 3; ++i) t[i] = select(family[i], Real(-1.0), t[i]);
        along[0] = t[0] >= t[1] && t[0] >= t[2];
        along[1] = !along[0] && t[1] >= t[2];
        along[2] = yes && !along[0] && !along[1];
    }

    Limit find_limit(bool plane) const {
        static constexpr const char* texts[3][3] = {
            {"normal to 1 would snap back (refine, raise GI1 or lower S1): element length h",
             "shear 12 would snap back (refine, raise GII12 or lower T12): element length h",
             "shear 13 would snap back (refine, raise GII13 or lower T13): element length h"},
            {"shear 21 would snap back (refine, raise GII21 or lower T21): element length h",
             "normal to 2 would snap back (refine, raise GI2 or lower S2): element length h",
             "shear 23 would snap back (refine, raise GII23 or lower T23): element length h"},
            {"shear 31 would snap back (refine, raise GII31 or lower T31): element length h",
             "shear 32 would snap back (refine, raise GII32 or lower T32): element length h",
             "normal to 3 would snap back (refine, raise GI3 or lower S3): element length h"}};
        Limit limit;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                if (!in_use(i, plane) || (plane && j == 2) || strength_[i][j] == 0.0) continue;
                const double length = square(hardest_[i][j] / strength_[i][j]);
                if (length < limit.length) limit = {length, texts[i][j]};
            }
        return limit;
    }

    void check(const Properties& p) {
        using namespace ortho_softening;
        if (surface_ != TractionSurface::cuboid && surface_ != TractionSurface::cylinder)
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) {
                    if (strength_[i][j] > 0.0) continue;
                    // The plane kinds do without what has to do with axis 3.
                    if (in_use(i, true) && j < 2) {
                        const int place = i == j ? 0 : j < 3 - i - j ? 1 : 2;
                        p.refuse(S1 + 6 * i + place, "> 0 for SURF 2, 3, 4");
                    }
                    incomplete_ = incomplete_ || in_use(i, false);
                }
        if (axial_ < 0) return;
        // PROPS indices of nu_ab, G_ab.
        const int a = axial_, b = b1(), c = b2();
        const auto pair = [](int i, int j) { return i + j - 1; };  // 12, 13, 23
        const auto same = [](double x, double y) {
            return std::abs(x - y) <= 1e-6 * std::max(std::abs(x), std::abs(y));
        };
        const auto nu = [&](int i, int j) {
            return i < j ? p[4 + pair(i, j)] : p[4 + pair(i, j)] * p[1 + i] / p[1 + j];
        };
        const std::string axis = " for TIAXIS = " + std::to_string(a + 1);
        if (!same(p[1 + b], p[1 + c])) p.refuse(1 + c, "E" + std::to_string(b + 1) + axis);
        if (!same(nu(a, b), nu(a, c)))
            p.refuse(4 + pair(a, c), "such that NU_ab is the same in both directions of the isotropic plane" + axis);
        if (!same(p[7 + pair(a, b)], p[7 + pair(a, c)]))
            p.refuse(7 + pair(a, c),
                     "G" + std::to_string(std::min(a, b) + 1) + std::to_string(std::max(a, b) + 1) + axis);
        const double G = 0.5 * p[1 + b] / (1.0 + p[4 + pair(b, c)]);
        if (!same(p[7 + pair(b, c)], G)) p.refuse(7 + pair(b, c), "E/(2(1 + NU)) = " + format_number(G) + axis);
    }
};

}  // namespace lode
