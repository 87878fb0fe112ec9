// COROT_NEO_HOOKEAN: co-rotated neo-Hookean solid (page 50, section 4; Nairn, 9.8, the elastic part).
//     W = G |V - I|^2 + U(J),     J sigma = 2 G (B - V) + J U' I
// at the mechanical deformation F* = F exp(-e). The stars of the page are dropped below.
#pragma once

#include "lode/elastic/isotropic_moduli.hpp"
#include "lode/hyperelastic/corotated.hpp"
#include "lode/hyperelastic/dilatational_energy.hpp"
#include "lode/hyperelastic/plane_stress.hpp"
#include "lode/material/properties.hpp"

namespace lode {

struct CorotNeoHookean {
    static constexpr lode_parameter parameters[] = {
        required("E", "Young's modulus", "stress", above(0.0)),
        required("NU", "Poisson's ratio", "-", inside(-1.0, 0.5)),
        dilatational_option(1.0),
        optional("ALPHA", "thermal expansion", "1/temp", any_value(), 0.0),
        optional("BETA", "expansion per unit of field 1", "1/field", any_value(), 0.0),
    };
    static constexpr lode_state states[] = {
        {"EPSRES", "residual strain, logarithm of the free stretch", 0.0},
        {"F33M1", "total thickness stretch - 1, plane stress only", 0.0},
    };
    static constexpr double flesh[] = {0.05, 0.45};
    static constexpr double snow[] = {0.14, 0.2, 0.0};
    static constexpr double gel[] = {0.5, 0.4, 2.0, 1e-4, 2e-3};
    static constexpr double auxetic[] = {8.0, -0.3, 1.0, 1e-4};
    static constexpr unsigned served = LODE_SOLID | LODE_PLANE_STRAIN | LODE_PLANE_STRESS;
    static constexpr lode_sample samples[] = {
        {"FLESH", "soft tissue of an animated body, MPa", flesh, count_of(flesh), 0.2, served},
        {"SNOW", "cohesive snow before it yields, U = lambda/2 ((J^2 - 1)/2 - ln J), MPa", snow, count_of(snow), 0.2,
         served},
        {"GEL", "swelling gel, U = lambda/2 (ln J)^2, MPa, 1/K, 1/(kg/m3)", gel, count_of(gel), 0.2, served},
        {"AUXETIC", "re-entrant foam with negative Poisson's ratio, MPa, 1/K", auxetic, count_of(auxetic), 0.2, served},
    };
    static constexpr lode_algorithm algorithms[] = {
        {"total, exact for any increment", 0, 0.0, HUGE_VAL},
    };
    static constexpr lode_model description = {
        .keyword = "COROT_NEO_HOOKEAN",
        .title = "Co-rotated neo-Hookean solid",
        .family = "hyperelastic",
        .purpose =
            "Elasticity that is linear in the principal stretches, for moderate strain under any rotation: the "
            "elastic law of co-rotated animation and material-point codes; with thermal and moisture expansion and "
            "three dilatational energies.",
        .source = "Nairn, chapter 9, section 9.8 (eqs. 9.71-9.90)",
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
            "- Two principal stretches that sum to less than 1: the Baker-Ericksen inequality fails and the body "
            "buckles spuriously. A warning is given once.\n"
            "- UJ = 1: the energy is finite at zero volume, so constrained compression reaches zero length at the "
            "stress -(lambda + 2G). UJ = 0, 2 keep the volume positive.\n"
            "- Plane stress with NU < 0: the thickness equation has no solution when the sheet is stretched (UJ = 0, "
            "1) or compressed (UJ = 2) too far; a smaller increment is asked for.\n"
            "- NU -> 0.5: stress and tangent keep their accuracy, but low-order elements lock.\n"
            "- The residual strain accumulates from the first call: the state there is free of it.\n",
    };

    explicit CorotNeoHookean(const Properties& p)
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
        const Real e = residual.end(increment, point.state[1]);
        auto k = residual.mechanical(increment, e);
        Mask<Real> valid = k.jacobian > Real(0.0) && is_finite(trace(k.b));

        if constexpr (is_plane_stress) {
            if (all(valid)) {
                valid = solve_thickness_stretch(k, point.solves) &&
                        k.h(2, 2) > Real(-1.0);  // F33M1 = -1: thinner than rounding
                if (!all(valid)) return point.fail(!valid, "no thickness stretch makes the stress 33 vanish");
            }
        }

        // sigma = (2 G/J) (E + E^2) + U' I (9.78)
        const auto strain = corotated_strain<kind>(k.h, valid);
        const VolumeRatio<Real> v = dilatation.volume_ratio(k.j, k.jacobian);
        auto stress = (2.0 * shear * v.inverse) * (strain + square_of(strain));
        add_to_normals(stress, 3, dilatation.derivative(v));
        const Real energy = v.inverse * (shear * double_contraction(strain, strain) + dilatation.energy(v));
        const Mask<Real> sound = valid && v.J > Real(0.0) && is_finite(trace(stress) + energy);
        if (!all(sound)) [[unlikely]]
            return point.fail(!sound, "det F <= 0, or the deformation is not finite");
        if (any(violates_baker_ericksen(strain))) [[unlikely]]
            point.warn("two principal stretches sum to less than 1: the material may buckle spuriously");
        point.stress = without_thickness<kind>(stress);
        point.elastic_energy = energy;

        if constexpr (wants_tangent<T>) {
            set_tangent_of_kind<kind>(
                tangent, point.stress, residual.thermal_expansion != 0.0,
                [&](auto& full) { set_corotated_tangent(full, shear * v.inverse, strain, dilatation.stiffness(v)); },
                [&](const auto& full) { return isotropic_thermal_stress(residual.thermal_expansion, full, stress); });
        }

        residual.store(point, k, e);
    }

    IsotropicModuli moduli;
    double shear;
    DilatationalEnergy dilatation;
    ResidualStrain residual;

  private:
    // x = F33* of plane stress, 2 G x (x - 1) + J U' = 0, with q and p = 1 + q the change and ratio of the area
    // (section 4.1); d = x - 1. False where there is no solution, which takes NU < 0.
    template <class Real>
    LODE_INLINE Mask<Real> solve_thickness_stretch(Kinematics<AnalysisKind::plane_stress, Real>& k,
                                                   const SolveCounter<Real>& solves) const {
        const double G = shear, lambda = dilatation.modulus;
        const Real q = k.j, p = k.jacobian, p2 = p * p;
        if (dilatation.option == 1) {  // (9.85): linear in x
            const Real denominator = 2.0 * G + lambda * p2, inverse = 1.0 / denominator;
            const Real stretch = (2.0 * G + lambda * p) * inverse;
            set_thickness(k, stretch, -lambda * p * q * inverse);
            return denominator > Real(0.0) && stretch > Real(0.0);
        }
        if (dilatation.option == 0) {  // quadratic in x: a x^2 - 2 G x - lambda/2 = 0
            const Real a = 2.0 * G + 0.5 * lambda * p2;
            const Real discriminant = 4.0 * G * G + 2.0 * lambda * a;
            const Real root = sqrt(max(discriminant, Real(0.0)));
            set_thickness(k, (G + 0.5 * root) / a, -lambda * q * (2.0 + q) / (2.0 * G + lambda * p2 + root));
            return a > Real(0.0) && discriminant >= Real(0.0);
        }
        // g(y) = 2 G exp(y) expm1(y) + lambda (y + log p) = 0 for y = ln x; y = 0 and y = -log p bracket the root, and
        // the first step of Newton's from x = 1 bounds it from above where it is positive, g being convex there.
        const Real area = k.log_jacobian();
        const Real start = -(lambda / (2.0 * G + lambda)) * area;
        Real lower = min(Real(0.0), -area), upper = max(Real(0.0), start);
        Mask<Real> solvable = area == area;
        if (lambda < 0.0) {  // g falls on the left of its minimum, 2 x^2 - x = -lambda/2G, which must lie below zero
            const double x = 0.25 * (1.0 + sqrt(1.0 - 4.0 * lambda / G)), bottom = log(x);
            lower = Real(bottom);
            solvable = lambda * (bottom + area) < Real(2.0 * G * x * (1.0 - x));
        }
        const auto residual_of = [G, lambda, area](const Real& y) {
            const Real d = expm1(y), x = 1.0 + d;
            return Residual<Real>{2.0 * G * x * d + lambda * (y + area), 2.0 * G * x * (x + d) + lambda};
        };
        const Root<Real> root =
            solve_bracketed<Slope::increasing>(residual_of, lower, upper, start, 1e-15 * abs(lambda * area), solvable);
        solves.count(root);
        set_thickness(k, exp(root.x), expm1(root.x));
        return solvable && root.converged;
    }
};

}  // namespace lode
