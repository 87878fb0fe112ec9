// MOONEY_RIVLIN: compressible Mooney-Rivlin solid (page 50, section 2; Nairn, 9.6).
//     W = G1/2 (I1bar - 3) + G2/2 (I2bar - 3) + U(J),     Bbar = J^(-2/3) B
//     J sigma = G1 dev(Bbar) + G2 dev(I1bar Bbar - Bbar^2) + J U' I
// at the mechanical deformation F* = F exp(-e). The stars of the page are dropped below.
#pragma once

#include "lode/elastic/isotropic_moduli.hpp"
#include "lode/hyperelastic/dilatational_energy.hpp"
#include "lode/hyperelastic/plane_stress.hpp"
#include "lode/hyperelastic/spatial_tangent.hpp"
#include "lode/material/properties.hpp"
#include "lode/numerics/reciprocal_cbrt.hpp"

namespace lode {

struct MooneyRivlin {
    static constexpr lode_parameter parameters[] = {
        required("G1", "first shear constant", "stress", at_least(0.0)),
        required("K", "bulk modulus", "stress", above(0.0)),
        optional("G2", "second shear constant", "stress", at_least(0.0), 0.0, "G1 + G2 must be > 0"),
        dilatational_option(0.0),
        optional("ALPHA", "thermal expansion", "1/temp", any_value(), 0.0),
        optional("BETA", "expansion per unit of field 1", "1/field", any_value(), 0.0),
    };
    static constexpr lode_state states[] = {
        {"EPSRES", "residual strain, logarithm of the free stretch", 0.0},
        {"F33M1", "total thickness stretch - 1, plane stress only", 0.0},
    };
    static constexpr double rubber[] = {0.4, 500.0, 0.1};
    static constexpr double silicone[] = {0.2, 5.0};
    static constexpr double foam[] = {0.0, 1.0, 0.5, 1.0};
    static constexpr double tyre[] = {0.5, 60.0, 0.2, 2.0, 2e-4, 3e-3};
    static constexpr unsigned served = LODE_SOLID | LODE_PLANE_STRAIN | LODE_PLANE_STRESS;
    static constexpr lode_sample samples[] = {
        {"RUBBER", "natural rubber, nearly incompressible, MPa", rubber, count_of(rubber), 0.5, served},
        {"SILICONE", "soft silicone without second constant, MPa", silicone, count_of(silicone), 0.4, served},
        {"FOAM", "second constant only, U = K/2 (J - 1)^2, MPa", foam, count_of(foam), 0.3, served},
        {"TYRE", "filled rubber that swells, U = K/2 (ln J)^2, MPa, 1/K, 1/(kg/m3)", tyre, count_of(tyre), 0.3, served},
    };
    static constexpr lode_algorithm algorithms[] = {
        {"total, exact for any increment", 0, 0.0, HUGE_VAL},
    };
    static constexpr lode_model description = {
        .keyword = "MOONEY_RIVLIN",
        .title = "Compressible Mooney-Rivlin solid",
        .family = "hyperelastic",
        .purpose =
            "Rubber with split shape and volume response, for stretches up to about 2; with the second constant G2 = 0 "
            "a neo-Hookean solid. Thermal and moisture expansion and three dilatational energies.",
        .source = "Nairn, chapter 9, section 9.6 (eqs. 9.48-9.56)",
        .kinds = served,
        .traits = LODE_FINITE_STRAIN | LODE_ELASTIC | LODE_HISTORY_STRESS | LODE_ITERATES,
        .parameters = parameters,
        .parameter_count = count_of(parameters),
        .required_count = 2,
        .state = states,
        .state_count = count_of(states),
        .samples = samples,
        .sample_count = count_of(samples),
        .algorithms = algorithms,
        .algorithm_count = count_of(algorithms),
        .limits =
            "- Geometric non-linearity is required; without it the host passes F = I and the stress stays zero.\n"
            "- det F <= 0 or a deformation that is not finite asks for a smaller increment.\n"
            "- G2 < 0 is refused: W would be unbounded below in equibiaxial stretch.\n"
            "- UJ = 2: hydrostatic tension has its maximum K/e = 0.36788 K at J = e; beyond it the bulk modulus is "
            "negative. UJ = 1: the pressure stays below K as J -> 0, so an element can be crushed to nothing, and "
            "(J U')' < 0 for J < 1/2. Only UJ = 0 has infinite energy at both ends.\n"
            "- UJ = 2 with low K/G: the lateral contraction in tension reverses (K/G = 10: at stretch 6.1). Use it "
            "for K/G > 50.\n"
            "- Plane stress with UJ = 1: the thickness equation may have several roots for J < 1/2; the one reached "
            "from the last thickness is taken. If there is none a smaller increment is asked for.\n"
            "- K/G > 1e3: stress and tangent keep their accuracy, but low-order elements lock.\n"
            "- G2 > 0 is not polyconvex in I2bar: ellipticity can be lost at extreme combined compression and shear.\n"
            "- The residual strain accumulates from the first call: the state there is free of it.\n",
    };

    explicit MooneyRivlin(const Properties& p)
        : shear1(p[1]), shear2(p[3]), dilatation{p.code(4), p[2]}, residual{p[5], p[6]} {
        if (!(shear1 + shear2 > 0.0)) p.refuse(1, "> 0 where G2 = 0");
    }

    int required_state(AnalysisKind) const { return count_of(states); }

    template <AnalysisKind kind>
    void initial_stiffness(const Stress<kind, double>&, const State<double>&, Tangent<kind>& tangent) const {
        const double g = shear1 + shear2, k = dilatation.modulus;
        IsotropicModuli moduli =
            IsotropicModuli::from_young_poisson(9.0 * k * g / (3.0 * k + g), (1.5 * k - g) / (3.0 * k + g));
        moduli.shear = g;  // without the rounding errors of nu near 1/2
        moduli.lame = k - 2.0 / 3.0 * g;
        moduli.template set_stiffness<kind>(tangent);
    }

    template <bool has_second>
    struct Kernel;
    template <class F>
    LODE_INLINE void specialise(const F& f) const;
    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        specialise([&](const auto& k) LODE_INLINE_LAMBDA { k.update(increment, point, tangent); });
    }

    // G1/2 (I1bar - 3) + G2/2 (I2bar - 3) in terms of second order: with c^3 = J and x = I1 - 3 - 2 (J - 1)
    //     c^2 (I1bar - 3) = x + (c - 1)^2 (2 c + 1),
    //     c^4 (I2bar - 3) = 2 x + (second invariant of b) - (c - 1)^2 (3 c^2 + 2 c + 1)
    template <AnalysisKind kind, class Real>
    LODE_INLINE static Real shape_energy(double G1, double G2, const Kinematics<kind, Real>& k, const Real& c,
                                         const Real& inverse2) {
        const Real x = first_invariant_excess<kind>(k.h);
        const Real r = square(k.j / (1.0 + c + c * c));  // (c - 1)^2
        Real energy = 0.5 * G1 * inverse2 * (x + r * (2.0 * c + 1.0));
        if (G2 == 0.0) return energy;
        const Real t = trace(k.b), second = 0.5 * (t * t - double_contraction(k.b, k.b));
        const Real excess = 2.0 * x + second - r * (1.0 + c * (2.0 + 3.0 * c));
        return energy + 0.5 * G2 * square(inverse2) * excess;
    }

    // 3 tau33 = G1 c^-2 (2z - s) + G2 c^-4 [2z - s + z s - 2 d] + 3 J U' with z = b33 = expm1(2y), and s, d the trace
    // and determinant of the in-plane b (section 2.2).
    template <class Real, class Shear = double>
    struct ThicknessEquation {
        Shear shear1, shear2;
        bool has_second;
        DilatationalEnergy dilatation;
        Real area_change, area, log_area, trace_b, det_b;

        ThicknessEquation(const Shear& g1, const Shear& g2, const DilatationalEnergy& volumetric,
                          const Kinematics<AnalysisKind::plane_stress, Real>& k)
            : shear1(g1),
              shear2(g2),
              has_second(any(g2 != Shear(0.0))),
              dilatation(volumetric),
              area_change(k.j),
              area(k.jacobian),
              log_area(dilatation.option == 2 ? k.log_jacobian() : Real(0.0)),
              trace_b(k.b[0] + k.b[1]),
              det_b(k.b[0] * k.b[1] - k.b[3] * k.b[3]) {}

        Real scale() const { return abs(area_change) + abs(trace_b) + sqrt(abs(det_b)); }

        LODE_INLINE Residual<Real> operator()(const Real& y) const {
            const Real d = expm1(y), z = d * (2.0 + d);
            VolumeRatio<Real> v(area_change + d + area_change * d, area * (1.0 + d));
            if (dilatation.option == 2) v.ln = log_area + y;
            const Real inverse2 = square(reciprocal_cbrt(v.J));
            const Real g1 = shear1 * inverse2, first = 2.0 * z - trace_b, rise = 2.0 * (1.0 + z);
            Real value = g1 * first, slope = g1 * (2.0 * rise - (2.0 / 3.0) * first);
            if (has_second) {
                const Real g2 = shear2 * inverse2 * inverse2;
                const Real second = first + z * trace_b - 2.0 * det_b;
                value = value + g2 * second;
                slope = slope + g2 * (rise * (2.0 + trace_b) - (4.0 / 3.0) * second);
            }
            return {(1.0 / 3.0) * value + v.J * dilatation.derivative(v),
                    (1.0 / 3.0) * slope + v.J * dilatation.stiffness(v)};
        }
    };

    double shear1, shear2;
    DilatationalEnergy dilatation;
    ResidualStrain residual;

  private:
    // One kernel with the second constant, one without.
    template <bool has_second, AnalysisKind kind, class Real, class T>
    LODE_INLINE void update_of(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        constexpr bool is_plane_stress = kind == AnalysisKind::plane_stress;
        State<Real>& state = point.state;
        const Real e = residual.end(increment, state[1]);
        auto k = residual.mechanical(increment, e);

        if constexpr (is_plane_stress) {
            const Mask<Real> possible = k.jacobian > Real(0.0) && is_finite(trace(k.b));
            if (all(possible)) {
                const ThicknessEquation<Real> equation(shear1, shear2, dilatation, k);
                const auto root =
                    solve_thickness(equation, thickness_of_state(state[2], e), equation.scale(), point.solves);
                if (!all(root.converged))
                    return point.fail(!root.converged, "no thickness stretch makes the stress 33 vanish");
                set_thickness(k, 1.0 + root.d, root.d);
            }
        }

        // J sigma = G1 c^-2 dev b + G2 c^-4 [(1 + tr b) dev b - dev b^2] + J U' I,   c = cbrt J
        const Real inverse2 = square(reciprocal_cbrt(k.j, k.jacobian)), c = k.jacobian * inverse2;  // J^(-2/3)
        const VolumeRatio<Real> v = dilatation.volume_ratio(k.j, k.jacobian);
        const Real mean = dilatation.derivative(v);
        const Real g1 = shear1 * inverse2 * v.inverse, g2 = shear2 * inverse2 * inverse2 * v.inverse;
        Stress<with_thickness(kind), Real> first, second, stress;
        assign(first, g1 * k.b);
        assign(stress, first);
        if constexpr (has_second) {
            // I1 B - B^2 = (2 + tr b) I + (1 + tr b) b - b^2
            assign(second, g2 * ((1.0 + trace(k.b)) * k.b - square_of(k.b)));
            stress += second;
        }
        add_to_normals(stress, 3, mean - trace(stress) * (1.0 / 3.0));

        const Real energy = v.inverse * (shape_energy(shear1, shear2, k, c, inverse2) + dilatation.energy(v));
        const Mask<Real> sound = v.J > Real(0.0) && is_finite(trace(stress) + energy);
        if (!all(sound)) [[unlikely]]
            return point.fail(!sound, "det F <= 0, or the deformation is not finite");
        assign(point.stress, without_thickness<kind>(stress));
        point.elastic_energy = energy;

        if constexpr (wants_tangent<T>) {
            // `first` and `second` become P = G1 Bbar/J and Q = G2 m/J.
            add_to_normals(first, 3, g1);
            if constexpr (has_second) add_to_normals(second, 3, g2 * (2.0 + trace(k.b)));
            const double volumetric = dilatation.stiffness(v), alpha = residual.thermal_expansion;
            set_tangent_of_kind<kind>(
                tangent, point.stress, alpha != 0.0,
                [&](auto& full) LODE_INLINE_LAMBDA { set_tangent<has_second>(first, second, volumetric, full); },
                [&](const auto&) {
                    // -alpha (C : 1 - 3 sigma), and Bbar does not change with the volume: C : 1 = 3 (J U')' 1
                    Stress<with_thickness(kind), double> thermal;
                    assign(thermal, (3.0 * alpha) * stress);
                    add_to_normals(thermal, 3, -3.0 * alpha * volumetric);
                    return thermal;
                });
        }

        residual.store(point, k, e);
    }

    // Section 2.3, with m = I1bar Bbar - Bbar^2, P = G1 Bbar and Q = G2 m, both over J:
    //     C = M(P + Q) - (2/3) [(P + 2 Q) (x) 1 + 1 (x) (P + 2 Q)] + [2/9 (tr P + 2 tr Q) + (J U')'] 1 (x) 1
    //         + 2 G2/J [Bbar (x) Bbar - (D -> Bbar D Bbar)],
    // where cof Bbar = I2bar I - m (Cayley and Hamilton), 2 I2bar = tr m.
    template <bool has_second, AnalysisKind full>
    LODE_INLINE static void set_tangent(const Stress<full, double>& P, const Stress<full, double>& Q, double volumetric,
                                        Tangent<full>& c) {
        Stress<full, double> coupling;
        if constexpr (has_second) {
            Stress<full, double> stretching, cofactors;
            assign(stretching, P + Q);
            assign(coupling, (-2.0 / 3.0) * (stretching + Q));
            assign(cofactors, -2.0 * Q);
            const double trace_Q = trace(Q);
            add_to_normals(cofactors, 3, trace_Q);
            set_coupled_tangent(c, stretching, volumetric + 2.0 / 9.0 * (trace(P) + 2.0 * trace_Q), coupling,
                                cofactors);
        } else {
            assign(coupling, (-2.0 / 3.0) * P);
            set_coupled_tangent(c, P, volumetric + 2.0 / 9.0 * trace(P), coupling, 0.0);
        }
    }
};

template <bool has_second>
struct MooneyRivlin::Kernel {
    MooneyRivlin model;

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        model.update_of<has_second>(increment, point, tangent);
    }
};

template <class F>
LODE_INLINE void MooneyRivlin::specialise(const F& f) const {
    if (shear2 != 0.0) f(Kernel<true>{*this});
    else f(Kernel<false>{*this});
}

}  // namespace lode
