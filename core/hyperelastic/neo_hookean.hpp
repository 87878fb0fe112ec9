// NEO_HOOKEAN: compressible neo-Hookean solid (page 50, section 3; Nairn, 9.7).
//     W = G/2 (I1 - 3 - 2 ln J) + U(J),     sigma = (G/J) (B - I) + U' I
// at the mechanical deformation F* = F exp(-e). The stars of the page are dropped below.
#pragma once

#include "lode/elastic/isotropic_moduli.hpp"
#include "lode/hyperelastic/dilatational_energy.hpp"
#include "lode/hyperelastic/residual_strain.hpp"
#include "lode/hyperelastic/spatial_tangent.hpp"
#include "lode/material/properties.hpp"
#include "lode/numerics/root.hpp"

namespace lode {

struct NeoHookean {
    static constexpr lode_parameter parameters[] = {
        required("E", "Young's modulus", "stress", above(0.0)),
        required("NU", "Poisson's ratio", "-", inside(-1.0, 0.5)),
        dilatational_option(0.0),
        optional("ALPHA", "thermal expansion", "1/temp", any_value(), 0.0),
        optional("BETA", "expansion per unit of field 1", "1/field", any_value(), 0.0),
    };
    static constexpr lode_state states[] = {
        {"EPSRES", "residual strain, logarithm of the free stretch", 0.0},
        {"F33M1", "total thickness stretch - 1, plane stress only", 0.0},
    };
    static constexpr double rubber[] = {3.0, 0.49};
    static constexpr double foam[] = {10.0, 0.3, 1.0};
    static constexpr double gel[] = {0.5, 0.45, 2.0, 1e-4, 2e-3};
    static constexpr double auxetic[] = {8.0, -0.3};
    static constexpr unsigned served = LODE_SOLID | LODE_PLANE_STRAIN | LODE_PLANE_STRESS;
    static constexpr lode_sample samples[] = {
        {"RUBBER", "unfilled rubber, MPa", rubber, count_of(rubber), 0.4, served},
        {"FOAM", "soft foam, U = lambda/2 (J - 1)^2, MPa", foam, count_of(foam), 0.3, served},
        {"GEL", "swelling gel, U = lambda/2 (ln J)^2, MPa, 1/K, 1/(kg/m3)", gel, count_of(gel), 0.3, served},
        {"AUXETIC", "re-entrant foam with negative Poisson's ratio, MPa", auxetic, count_of(auxetic), 0.2, served},
    };
    static constexpr lode_algorithm algorithms[] = {
        {"total, exact for any increment", 0, 0.0, HUGE_VAL},
    };
    static constexpr lode_model description = {
        .keyword = "NEO_HOOKEAN",
        .title = "Compressible neo-Hookean solid",
        .family = "hyperelastic",
        .purpose =
            "The simplest hyperelastic law, for rubber-like solids up to stretches of about 1.5 and for any elastic "
            "solid under large rotation; with thermal and moisture expansion and three dilatational energies.",
        .source = "Nairn, chapter 9, section 9.7 (eqs. 9.57-9.70)",
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
            "- UJ = 2: hydrostatic tension has a maximum, where lambda (1 - ln J) + G (3 - J^(2/3))/3 = 0 (E = 10, "
            "NU = 0.3: 3.5054 at J = 3.25); beyond it the tangent is not positive definite. NU = 0: the maximum is at "
            "J = 5.196 for every UJ. UJ = 0, 1 with NU >= 0.01 have none.\n"
            "- NU -> 0.5: stress and tangent keep their accuracy, but lambda/G > 1e4 spoils the conditioning of DDSDDE "
            "and low-order elements lock.\n"
            "- Plane stress with NU < 0: the thickness equation has no solution when the sheet is stretched (UJ = 0, "
            "1) or compressed (UJ = 2) too far; a smaller increment is asked for.\n"
            "- The residual strain accumulates from the first call: the state there is free of it.\n",
    };

    explicit NeoHookean(const Properties& p)
        : moduli(IsotropicModuli::from_young_poisson(p[1], p[2])),
          shear(moduli.shear),
          dilatation{p.code(3), moduli.lame},
          residual{p[4], p[5]} {}

    int required_state(AnalysisKind) const { return count_of(states); }

    template <AnalysisKind kind>
    void initial_stiffness(const Stress<kind, double>&, const State<double>&, Tangent<kind>& tangent) const {
        moduli.template set_stiffness<kind>(tangent);
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        constexpr bool is_plane_stress = kind == AnalysisKind::plane_stress;
        constexpr int normals = normal_components(kind);
        const Real e = residual.end(increment, point.state[1]);
        auto k = residual.mechanical(increment, e);

        if constexpr (is_plane_stress) {
            Mask<Real> solved = k.jacobian > Real(0.0) && is_finite(trace(k.b));
            if (all(solved)) {
                solved = solve_thickness(k, point.solves);
                if (!all(solved)) return point.fail(!solved, "no thickness stretch makes the stress 33 vanish");
            }
        }

        // sigma = (G/J) b + U' I (9.59)
        const VolumeRatio<Real> v = dilatation.volume_ratio(k.j, k.jacobian);
        const Real g = shear * v.inverse, mean = dilatation.derivative(v);
        auto stretching = g * k.b, stress = stretching;
        add_to_normals(stress, 3, mean);
        // W/J, in which I1 - 3 - 2 ln J = (I1 - 3 - 2 j) + 2 (j - ln J)
        const Real isochoric = 0.5 * first_invariant_excess<kind>(k.h) + v.excess_over_log();
        const Real energy = v.inverse * (shear * isochoric + dilatation.energy(v));
        const Mask<Real> sound = v.J > Real(0.0) && is_finite(trace(stress) + energy);
        if (!all(sound)) [[unlikely]]
            return point.fail(!sound, "det F <= 0, or the deformation is not finite");
        for (int i = 0; i < normals; ++i) point.stress[i] = stress[i];
        for (int i = normals; i < components(kind); ++i) point.stress[i] = stress[i + 3 - normals];
        point.elastic_energy = energy;

        if constexpr (wants_tangent<T>) {
            add_to_normals(stretching, 3, g);
            set_tangent<kind>(stretching, dilatation.stiffness(v), point.stress, tangent);
        }

        residual.store(point, k, e);
    }

    IsotropicModuli moduli;
    double shear;
    DilatationalEnergy dilatation;
    ResidualStrain residual;

  private:
    // C = M(A) + (J U')' 1 (x) 1 with A = (G/J) B, and its companion for temperature (1.8).
    template <AnalysisKind kind>
    LODE_INLINE void set_tangent(const Stress<with_thickness(kind), double>& a, double volumetric,
                                 const Stress<kind, double>& stress, Tangent<kind>& tangent) const {
        constexpr int normals = normal_components(kind);
        double condensed = volumetric;
        if constexpr (kind == AnalysisKind::plane_stress) {
            // C_ab - C_a3 C_3b/C_33 with C_a3 = volumetric in the normal components, zero in shear
            const double thickness = 2.0 * a[2];
            condensed = volumetric * thickness / (thickness + volumetric);
        }
        set_stretching_tangent(tangent, 1.0, a, condensed);

        const double alpha = residual.thermal_expansion;
        if (alpha == 0.0) return;
        // -alpha (C : 1 - 3 sigma), in which C : 1 = 2 A + 3 volumetric 1
        const auto thermal = [&](int i, double sigma) {
            return -alpha * (2.0 * a[i] + 3.0 * volumetric - 3.0 * sigma);
        };
        for (int i = 0; i < normals; ++i) tangent.thermal_stress[i] = thermal(i, stress[i]);
        for (int i = normals; i < components(kind); ++i) tangent.thermal_stress[i] = alpha * stress[i];
        if constexpr (kind == AnalysisKind::plane_stress) {
            // the thickness follows so that the stress 33 stays zero
            const double stretching = -thermal(2, 0.0) / (2.0 * a[2] + volumetric);
            for (int i = 0; i < 2; ++i) tangent.thermal_stress[i] += (volumetric - stress[i]) * stretching;
            tangent.thermal_stress[2] -= stress[2] * stretching;
        }
    }

    // F33* - 1 of plane stress, G b33 + J U' = 0, with q and p = 1 + q the change and ratio of the area (section 3.1).
    // False where there is no solution, which takes NU < 0.
    template <class Real>
    LODE_INLINE Mask<Real> solve_thickness(Kinematics<AnalysisKind::plane_stress, Real>& k,
                                           const SolveCounter<Real>& solves) const {
        const double G = shear, lambda = dilatation.modulus;
        const Real q = k.j, p = k.jacobian, p2 = p * p;
        if (dilatation.option == 0) {  // (9.68): linear in b33
            const Real denominator = 2.0 * G + lambda * p2;
            const Real inverse = 1.0 / denominator;
            const Real stretch = sqrt((2.0 * G + lambda) * inverse);
            set_thickness(k, stretch, -lambda * q * (2.0 + q) * inverse / (1.0 + stretch));
            return denominator > Real(0.0);
        }
        if (dilatation.option == 1) {  // (9.69): quadratic in F33
            const Real a = G + lambda * p2;
            const Real root = sqrt(4.0 * G * a + square(lambda * p));  // of the discriminant, expanded
            const Real d = -2.0 * lambda * p * q / (2.0 * a - lambda * p + root);
            const Real stretch = lambda > 0.0 ? 0.5 * (lambda * p + root) / a : 1.0 + d;
            set_thickness(k, stretch, d);
            return a > Real(0.0);
        }
        // (9.70): g(y) = G expm1(2 y) + lambda (y + log1p(q)) = 0 for y = ln F33 is convex, so Newton's iterate from
        // y = 0 is on the right of the root and the next ones descend to it.
        const Real area = k.log_jacobian();
        const Real upper = -(lambda / (2.0 * G + lambda)) * area;
        Real lower = min(Real(0.0), -area);
        Mask<Real> solvable = area == area;
        if (lambda < 0.0) {  // g falls on the left of its minimum, which must lie below zero
            const double bottom = 0.5 * log(-lambda / (2.0 * G));
            lower = Real(bottom);
            solvable = lambda * (bottom + area) < Real(G + 0.5 * lambda);
        }
        const auto residual_of = [&](const Real& y) {
            const Real z = expm1(2.0 * y);
            return Residual<Real>{G * z + lambda * (y + area), 2.0 * G * (1.0 + z) + lambda};
        };
        const Root<Real> root =
            solve_bracketed<Slope::increasing>(residual_of, lower, upper, upper, 1e-15 * abs(lambda * area), solvable);
        solves.count(root);
        set_thickness(k, exp(root.x), expm1(root.x));
        return solvable && root.converged;
    }
};

}  // namespace lode
