// TI_NEO_HOOKEAN: transversely isotropic neo-Hookean solid (page 50, section 5; Nairn, 9.9). With a = F A, I4 = |a|^2,
// I5 = |F^T a|^2,
//     W = G/2 (I1 - 3 - 2 ln J) + U(J) + [al + 2 be ln J + ga (I4 - 1)] (I4 - 1) - al/2 (I5 - 1)
// at F* = F Fres^-1, Fres the free stretch along and across the axis A. The stars of the page are dropped below.
#pragma once

#include "lode/hyperelastic/dilatational_energy.hpp"
#include "lode/hyperelastic/plane_stress.hpp"
#include "lode/hyperelastic/spatial_tangent.hpp"
#include "lode/hyperelastic/ti_neo_hookean_description.hpp"
#include "lode/material/properties.hpp"

namespace lode {

struct TiNeoHookean : TiNeoHookeanDescription {
    explicit TiNeoHookean(const Properties& p)
        : local_basis(p.code(14) == 1), thermal_expansion{p[10], p[11]}, moisture_expansion{p[12], p[13]} {
        const double EA = p[1], ET = p[2], GA = p[3], nuA = p[4], nuT = p[5];
        const double compliance = 2.0 * (1.0 - nuT) / ET - 4.0 * nuA * nuA / EA;  // 1/KT
        if (!(compliance > 0.0))
            p.refuse(4, "below " + format_number(sqrt(0.5 * (1.0 - nuT) * EA / ET)) +
                            " in magnitude: 2 (1 - NUT)/ET > 4 NUA^2/EA");
        const double KT = 1.0 / compliance, GT = ET / (2.0 * (1.0 + nuT));
        shear = GT;
        dilatation = {p.code(6), KT - GT};
        al = GT - GA;
        be = 0.25 * (GT - KT * (1.0 - 2.0 * nuA));
        ga = 0.125 * (EA - 4.0 * GA + GT + KT * square(1.0 - 2.0 * nuA));

        const double length = std::hypot(p[7], p[8], p[9]);
        if (!(length > 0.0)) p.refuse(7, "different from 0, or A2 or A3 must be");
        for (int i = 0; i < 3; ++i) axis[static_cast<std::size_t>(i)] = p[7 + i] / length;
        is_normal = axis[0] == 0.0 && axis[1] == 0.0;
        kinking = first_instability(GA);
    }

    int required_state(AnalysisKind) const { return count_of(states); }

    template <AnalysisKind kind>
    void initial_stiffness(const Stress<kind, double>&, const State<double>&, Tangent<kind>& tangent) const {
        Matrix3<double> zero{};
        const auto k = kinematics_of_gradient<kind>(zero, 1.0);
        const VolumeRatio<double> v(0.0, 1.0);
        const Fibre<kind, double> fibre(axis, k);
        set_tangent_of_kind<kind>(
            tangent, Stress<kind, double>{}, false, [&](auto& full) { set_tangent(k, v, 0.0, fibre, full); },
            [](const auto&) { return Stress<with_thickness(kind), double>{}; });
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        constexpr bool is_plane_stress = kind == AnalysisKind::plane_stress;
        if constexpr (kind != AnalysisKind::solid) {
            if (!is_normal && axis[2] != 0.0) [[unlikely]]
                return point.refuse(Mask<Real>(true), "component 3 of the axial direction A", Real(axis[2]),
                                    "0, or A = (0, 0, 1), outside 3D");
        }
        State<Real>& state = point.state;
        const Real ea = residual_end(increment, state[1], 0), et = residual_end(increment, state[2], 1);
        const Real thickness_residual = is_normal ? ea : et;
        Real f33m1 = state[3];
        auto k = mechanical(increment, ea, et);

        if constexpr (is_plane_stress) {
            Mask<Real> solved = k.jacobian > Real(0.0) && is_finite(trace(k.b));
            if (all(solved)) {
                solved = solve_thickness_stretch(k, thickness_of_state(f33m1, thickness_residual), point.solves);
                if (!all(solved)) return point.fail(!solved, "no thickness stretch makes the stress 33 vanish");
            }
        }

        // J sigma = G b + [J U' + 2 be (I4-1)] I + 4 [be ln J + ga (I4-1)] a a^T - al [a (b a)^T + (b a) a^T]
        VolumeRatio<Real> v(k.j, k.jacobian);
        v.ln = v.logarithm();
        const Fibre<kind, Real> fibre(axis, k);
        const Real& i4 = fibre.i4;
        const Real along = be * v.ln + ga * i4;
        auto stress = shear * k.b + (4.0 * along) * fibre.aa - al * fibre.a_ba;
        add_to_normals(stress, 3, v.J * dilatation.derivative(v) + 2.0 * be * i4);
        stress = v.inverse * stress;
        const Real isochoric = 0.5 * first_invariant_excess<kind>(k.h) + v.excess_over_log();
        const Real energy = v.inverse * (shear * isochoric + dilatation.energy(v) + (along + be * v.ln) * i4 +
                                         0.5 * al * fibre.shear_excess(k.h));
        const Mask<Real> sound = v.J > Real(0.0) && is_finite(trace(stress) + energy);
        if (!all(sound)) [[unlikely]]
            return point.fail(!sound, "det F <= 0, or the deformation is not finite");
        if (any(i4 <= Real(kinking))) [[unlikely]]
            point.warn("axial compression beyond shear instability (kinking of fibres)");
        point.stress = without_thickness<kind>(stress);
        point.elastic_energy = energy;

        if constexpr (wants_tangent<T>) {
            set_tangent_of_kind<kind>(
                tangent, point.stress, thermal_expansion[0] != 0.0 || thermal_expansion[1] != 0.0,
                [&](auto& full) { set_tangent(k, v, along, fibre, full); },
                [&](const auto& full) { return thermal_stress(k, fibre, stress, full); });
        }

        if constexpr (is_plane_stress) {
            const Real f33m1_old = f33m1, d = k.h(2, 2);
            f33m1 = has_residual(ea, et) ? d + expm1(thickness_residual) * (1.0 + d) : d;
            if (point.wants_thickness_strain)
                point.thickness_strain_increment = thickness_strain_change(f33m1_old, f33m1);
        }
        state.set(1, ea);
        state.set(2, et);
        state.set(3, f33m1);
    }

    double shear;
    DilatationalEnergy dilatation;
    double al, be, ga;
    std::array<double, 3> axis;  // A, of unit length
    bool is_normal;              // A = (0, 0, 1): normal to the plane of the plane kinds
    bool local_basis;
    double kinking;                                               // I4 - 1 below which axial compression is unstable
    std::array<double, 2> thermal_expansion, moisture_expansion;  // along and across the axis

  private:
    // What the law needs of the axis.
    template <AnalysisKind kind, class Real>
    struct Fibre {
        static constexpr AnalysisKind full = with_thickness(kind);
        Vector<Real, 3> u, a;         // H A, F A = A + u
        Real i4;                      // I4 - 1 = 2 A.u + u.u
        Stress<full, Real> aa, a_ba;  // a a^T, a (b a)^T + (b a) a^T

        LODE_INLINE Fibre(const std::array<double, 3>& A, const Kinematics<kind, Real>& k) {
            for (int i = 0; i < 3; ++i) {
                u[i] = k.h(i, 0) * A[0] + k.h(i, 1) * A[1] + k.h(i, 2) * A[2];
                a[i] = A[static_cast<std::size_t>(i)] + u[i];
            }
            i4 = 2.0 * (A[0] * u[0] + A[1] * u[1] + A[2] * u[2]) + dot(u, u);
            const Matrix3<Real> b = to_matrix<full, Real>(k.b, 1.0);
            const Vector<Real, 3> ba = times(b, a);
            for (int c = 0; c < components(full); ++c) {
                const int i = spatial_detail::first_index[c], j = spatial_detail::second_index[c];
                aa[c] = a[i] * a[j];
                a_ba[c] = a[i] * ba[j] + a[j] * ba[i];
            }
        }
        // (I4 - 1) - a.b a = 2 (I4 - 1) - (I5 - 1), of second order in H and formed as such.
        LODE_INLINE Real shear_excess(const Matrix3<Real>& h) const {
            const Vector<Real, 3> w = times(transpose(h), a);
            return -(dot(u, u) + 2.0 * dot(w, u) + dot(w, w));
        }
        static Real dot(const Vector<Real, 3>& x, const Vector<Real, 3>& y) {
            return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
        }
        static Vector<Real, 3> times(const Matrix3<Real>& m, const Vector<Real, 3>& x) {
            Vector<Real, 3> r;
            for (int i = 0; i < 3; ++i) r[i] = m(i, 0) * x[0] + m(i, 1) * x[1] + m(i, 2) * x[2];
            return r;
        }
    };

    // Residual strain at the end of the increment, along (0) and across (1) the axis.
    template <AnalysisKind kind, class Real>
    Real residual_end(const Increment<kind, Real>& increment, const Real& start, std::size_t direction) const {
        return ResidualStrain{thermal_expansion[direction], moisture_expansion[direction]}.end(increment, start);
    }
    template <class Real>
    bool has_residual(const Real& ea, const Real& et) const {
        return thermal_expansion[0] != 0.0 || thermal_expansion[1] != 0.0 || moisture_expansion[0] != 0.0 ||
               moisture_expansion[1] != 0.0 || any(ea != Real(0.0)) || any(et != Real(0.0));
    }

    // Kinematics of F* = F Fres^-1, Fres^-1 = exp(-et) I + (exp(-ea) - exp(-et)) A A^T (9.9.4).
    template <AnalysisKind kind, class Real>
    LODE_INLINE Kinematics<kind, Real> mechanical(const Increment<kind, Real>& increment, const Real& ea,
                                                  const Real& et) const {
        Deformation<kind, Real> f(increment, local_basis);
        if (!has_residual(ea, et)) return kinematics_of_gradient<kind>(f.h, f.jacobian);
        const Real shrink = exp(-et), change = expm1(-et), axial = shrink * expm1(et - ea);
        Matrix3<Real> h;
        for (int i = 0; i < 3; ++i) {
            const Real a =
                axis[static_cast<std::size_t>(i)] + (f.h(i, 0) * axis[0] + f.h(i, 1) * axis[1] + f.h(i, 2) * axis[2]);
            for (int j = 0; j < 3; ++j) h(i, j) = shrink * f.h(i, j) + (axial * axis[static_cast<std::size_t>(j)]) * a;
            h(i, i) = h(i, i) + change;
        }
        Real volume = shrink * shrink * exp(-ea);
        if constexpr (kind == AnalysisKind::plane_stress) {
            h(2, 2) = Real(0.0);
            volume = shrink * (is_normal ? shrink : exp(-ea));
        }
        return kinematics_of_gradient<kind>(h, f.jacobian * volume);
    }

    // Section 5.2 with k = al + 2 be ln J + 2 ga (I4-1) and `along` = be ln J + ga (I4-1):
    //     J C = M(G B + 2 k a a^T - al N2) + J (J U')' 1 (x) 1 + 4 be (1 (x) aa + aa (x) 1) + 8 ga aa (x) aa - 2 al
    //     S(B, aa) N2 = a (B a)^T + (B a) a^T = 2 a a^T + a (b a)^T + (b a) a^T
    template <AnalysisKind kind, AnalysisKind full>
    LODE_INLINE void set_tangent(const Kinematics<kind, double>& k, const VolumeRatio<double>& v, double along,
                                 const Fibre<kind, double>& fibre, Tangent<full>& c) const {
        auto b = k.b;
        add_to_normals(b, 3, 1.0);
        const auto stretching = v.inverse * (shear * b + (4.0 * along) * fibre.aa - al * fibre.a_ba);
        set_coupled_tangent(c, stretching, dilatation.stiffness(v), (4.0 * be * v.inverse) * fibre.aa, 0.0);
        add_dyad(c, 8.0 * ga * v.inverse, fibre.aa);
        if (al != 0.0) add_two_sided(c, b, (-2.0 * al * v.inverse) * fibre.aa);
    }

    // C : D* - sigma tr D* + W* sigma - sigma W*, D* + W* = L* = -alphaT I - (alphaA - alphaT) (F A) (F^-T A)^T.
    template <AnalysisKind kind, AnalysisKind full>
    LODE_INLINE Stress<full, double> thermal_stress(const Kinematics<kind, double>& k, const Fibre<kind, double>& fibre,
                                                    const Stress<full, double>& stress, const Tangent<full>& c) const {
        const auto [alpha_a, alpha_t] = thermal_expansion;
        Matrix3<double> f = k.h;
        for (int i = 0; i < 3; ++i) f(i, i) += 1.0;
        const Matrix3<double> cofactor = transpose(adjugate(f));
        const double scale = -(alpha_a - alpha_t) / k.jacobian;
        Matrix3<double> d, w;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) w(i, j) = scale * fibre.a[i] * dot_axis(cofactor, j);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) d(i, j) = 0.5 * (w(i, j) + w(j, i)) - (i == j ? alpha_t : 0.0);
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < i; ++j) {
                w(i, j) = 0.5 * (w(i, j) - w(j, i));
                w(j, i) = -w(i, j);
            }
            w(i, i) = 0.0;
        }
        const auto strain = from_matrix<Strain<full, double>, full>(d, 2.0);
        const Matrix3<double> s = to_matrix<full, double>(stress, 1.0), spin = w * s;
        auto rate = from_matrix<Stress<full, double>, full>(spin + transpose(spin), 1.0) - trace(d) * stress;
        for (int j = 0; j < components(full); ++j)
            for (int i = 0; i < components(full); ++i) rate[i] += c(i, j) * strain[j];
        return rate;
    }
    double dot_axis(const Matrix3<double>& m, int row) const {
        return m(row, 0) * axis[0] + m(row, 1) * axis[1] + m(row, 2) * axis[2];
    }

    // Completes the kinematics by the thickness stretch of plane stress (section 5.1). False where there is none.
    template <class Real>
    LODE_INLINE Mask<Real> solve_thickness_stretch(Kinematics<AnalysisKind::plane_stress, Real>& k, const Real& start,
                                                   const SolveCounter<Real>& solves) const {
        const double G = shear, lambda = dilatation.modulus;
        const Real q = k.j, p = k.jacobian, p2 = p * p;
        if (is_normal || dilatation.option == 2) {
            const Real u0 = k.h(0, 0) * axis[0] + k.h(0, 1) * axis[1], u1 = k.h(1, 0) * axis[0] + k.h(1, 1) * axis[1];
            const Real in_plane = 2.0 * (axis[0] * u0 + axis[1] * u1) + (u0 * u0 + u1 * u1);
            const ThicknessEquation<Real> equation{
                G, al, be, ga, dilatation, is_normal, q, p, k.log_jacobian(), is_normal ? Real(0.0) : in_plane};
            const auto root =
                solve_thickness(equation, start, Real(abs(q) + abs(k.b[0]) + abs(k.b[1]) + abs(k.b[3])), solves);
            set_thickness(k, 1.0 + root.d, root.d);
            return root.converged;
        }
        // A in the plane: I4 does not depend on the thickness, c0 = 2 be (I4 - 1).
        const Real u0 = k.h(0, 0) * axis[0] + k.h(0, 1) * axis[1], u1 = k.h(1, 0) * axis[0] + k.h(1, 1) * axis[1];
        const Real c0 = 2.0 * be * (2.0 * (axis[0] * u0 + axis[1] * u1) + (u0 * u0 + u1 * u1));
        if (dilatation.option == 0) {  // linear in b33
            const Real denominator = 2.0 * G + lambda * p2, numerator = 2.0 * G + lambda - 2.0 * c0;
            const Real inverse = 1.0 / denominator;
            const Mask<Real> solvable = denominator > Real(0.0) && numerator > Real(0.0);
            const Real stretch = sqrt(select(solvable, numerator * inverse, Real(1.0)));
            set_thickness(k, stretch, -(lambda * q * (2.0 + q) + 2.0 * c0) * inverse / (1.0 + stretch));
            return solvable;
        }
        // a d^2 + B d + c = 0 for d = F33 - 1; the discriminant is expanded
        const Real a = G + lambda * p2, b = 2.0 * a - lambda * p, c = lambda * p * q + c0;
        const Real discriminant = square(lambda * p) + 4.0 * a * (G - c0);
        const Mask<Real> solvable = a > Real(0.0) && discriminant >= Real(0.0);
        const Real root = sqrt(select(solvable, discriminant, Real(1.0))), d = -2.0 * c / (b + root);
        set_thickness(k, 1.0 + d, d);
        return solvable && d > Real(-1.0);
    }

    // tau33 as a function of y = ln F33. A in the plane: G z + J U' + 2 be (I4 - 1), z = expm1(2y). A normal to it,
    // where I4 - 1 = z: (G + 2 be) z + J U' + [4 be ln J + (4 ga - 2 al) z] (1 + z).
    template <class Real>
    struct ThicknessEquation {
        double G, al, be, ga;
        DilatationalEnergy dilatation;
        bool is_normal;
        Real area_change, area, log_area, i4;

        LODE_INLINE Residual<Real> operator()(const Real& y) const {
            const Real d = expm1(y), z = d * (2.0 + d), rise = 2.0 * (1.0 + z);
            VolumeRatio<Real> v(area_change + d + area_change * d, area * (1.0 + d));
            v.ln = log_area + y;
            Real value = G * z + v.J * dilatation.derivative(v), slope = G * rise + v.J * dilatation.stiffness(v);
            if (is_normal) {
                const double axial = 4.0 * ga - 2.0 * al;
                const Real factor = 4.0 * be * v.ln + axial * z;
                value = value + 2.0 * be * z + factor * (1.0 + z);
                slope = slope + 2.0 * be * rise + (4.0 * be + axial * rise) * (1.0 + z) + factor * rise;
            } else {
                value = value + 2.0 * be * i4;
            }
            return {value, slope};
        }
    };

    // The largest x = I4 - 1 < 0 with GA + (4 ga - 2 al) x + 2 be ln(1 + x) <= 0 (section 5.4), or -1 if there is none.
    double first_instability(double axial_shear) const {
        const auto stiffness = [&](double x) {
            return axial_shear + (4.0 * ga - 2.0 * al) * x + 2.0 * be * std::log1p(x);
        };
        double lower = 0.0;
        constexpr int steps = 1000;
        for (int i = 1; i < steps && stiffness(lower) > 0.0; ++i) lower = -static_cast<double>(i) / steps;
        if (stiffness(lower) > 0.0) return -1.0;
        double upper = lower + 1.0 / steps;
        for (int i = 0; i < 50; ++i) {
            const double middle = 0.5 * (lower + upper);
            (stiffness(middle) > 0.0 ? upper : lower) = middle;
        }
        return lower;
    }
};

}  // namespace lode
