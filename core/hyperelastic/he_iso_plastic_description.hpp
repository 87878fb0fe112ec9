// What HE_ISO_PLASTIC says about itself.
#pragma once

#include "lode/hyperelastic/dilatational_energy.hpp"

namespace lode::he_iso_plastic {

// 1-based PROPS indices.
enum Property { E = 1, NU, HLAW, SY, H1, TREF = 14, UJ, ALPHA, BETA, YCAU, CHI, ORI };
// 1-based STATEV indices.
enum Slot { CPI11 = 1, CPI13 = 5, CPI23, ALPHA_P, EPSRES, F33M1, PDISS };

inline constexpr lode_parameter parameters[] = {
    required("E", "Young's modulus", "stress", above(0.0)),
    required("NU", "Poisson's ratio", "-", inside(-1.0, 0.5)),
    required("HLAW", "hardening law", "code", code(-1, 6),
             "-1 none, elastic; 0 perfect; 1 linear: H1 = Ep; 2 SY (1 + H1 alpha)^H2; 3 Johnson-Cook: H1-H9 = B, n, C, "
             "EPS0, m, TMELT, D, n2, RMIN; 6 SY (1 + H1 alpha^H2)"),
    required("SY", "initial yield stress", "stress", any_value(), "> 0 unless HLAW = -1; A of law 3"),
    optional("H1", "constant 1 of the law", "by law", any_value(), 0.0),
    optional("H2", "constant 2 of the law", "by law", any_value(), 0.0),
    optional("H3", "constant 3 of the law", "by law", any_value(), 0.0),
    optional("H4", "constant 4 of the law", "by law", any_value(), 0.0),
    optional("H5", "constant 5 of the law", "by law", any_value(), 0.0),
    optional("H6", "constant 6 of the law", "by law", any_value(), 0.0),
    optional("H7", "constant 7 of the law", "by law", any_value(), 0.0),
    optional("H8", "constant 8 of the law", "by law", any_value(), 0.0),
    optional("H9", "constant 9 of the law", "by law", any_value(), 0.0),
    optional("TREF", "reference temperature of law 3", "temp", any_value(), 0.0),
    dilatational_option(0.0),
    optional("ALPHA", "linear thermal expansion", "1/temp", any_value(), 0.0),
    optional("BETA", "linear expansion per unit of field 1", "1/field", any_value(), 0.0),
    optional("YCAU", "stress of the yield condition", "code", code(0, 1), 0.0, "0 Kirchhoff, 1 Cauchy"),
    optional("CHI", "fraction of the plastic work that becomes heat", "-", between(0.0, 1.0), 1.0),
    optional("ORI", "basis of F", "code", code(0, 1), 0.0,
             "0 the second index of F refers to a fixed basis, 1 both refer to axes that turn with the material "
             "(continuum elements with a local orientation in Abaqus/Standard)"),
};

inline constexpr lode_state states[] = {
    {"CPI11", "inverse plastic right Cauchy-Green tensor - 1, reference basis", 0.0},
    {"CPI22", "component 22", 0.0},
    {"CPI33", "component 33", 0.0},
    {"CPI12", "component 12", 0.0},
    {"CPI13", "component 13", 0.0},
    {"CPI23", "component 23", 0.0},
    {"ALPHA", "equivalent plastic strain", 0.0},
    {"EPSRES", "residual strain, logarithm of the free stretch", 0.0},
    {"F33M1", "total thickness stretch - 1, plane stress only", 0.0},
    {"PDISS", "plastic work per reference volume", 0.0},
};

inline constexpr unsigned served = LODE_SOLID | LODE_PLANE_STRAIN | LODE_PLANE_STRESS;
inline constexpr double steel[] = {200000.0, 0.3, 1, 400.0, 1000.0};
inline constexpr double aluminium[] = {70000.0, 0.33, 2,   150.0, 40.0, 0.25,   0.0, 0.0, 0.0, 0.0,
                                       0.0,     0.0,  0.0, 0.0,   1.0,  2.3e-5, 0.0, 1.0, 0.9};
inline constexpr double polymer[] = {2000.0, 0.38, 6,   40.0, 0.8, 0.7,  0.0,  0.0, 0.0, 0.0,
                                     0.0,    0.0,  0.0, 0.0,  2.0, 7e-5, 2e-3, 0.0, 0.6};
inline constexpr double copper[] = {124000.0, 0.34,   3,    90.0, 292.0,  0.31,  0.025, 1.0,
                                    1.09,     1083.0, 0.01, 1.5,  0.0001, -20.0, 0.0,   1.7e-5};
inline constexpr lode_sample samples[] = {
    {"STEEL", "mild steel, linear hardening, MPa", steel, count_of(steel), 0.05, served},
    {"ALUMINIUM", "aluminium alloy, power law, heat, yield on Cauchy stress, MPa, 1/K", aluminium, count_of(aluminium),
     0.05, served},
    {"POLYMER", "glassy polymer, alternate power law, heat and moisture, MPa, 1/K", polymer, count_of(polymer), 0.1,
     served},
    {"COPPER", "copper, Johnson-Cook with the fast term, heat, MPa, s, degrees Celsius", copper, count_of(copper), 0.05,
     served},
};

inline constexpr lode_algorithm algorithms[] = {
    {"backward Euler, radial return", 0, 0.0, 1.0},
};

inline constexpr lode_model description = {
    .keyword = "HE_ISO_PLASTIC",
    .title = "Neo-Hookean solid with J2 plasticity",
    .family = "hyperelastic",
    .purpose =
        "Metals and other solids at large plastic strain: hyperelastic, so that no energy is created on closed elastic "
        "paths and nothing depends on an objective rate, with isotropic hardening.",
    .source = "Nairn, chapter 9, section 9.11 (eqs. 9.116-9.130)",
    .kinds = served,
    .traits = LODE_FINITE_STRAIN | LODE_UNSYMMETRIC | LODE_HISTORY_STRESS | LODE_ITERATES,
    .parameters = parameters,
    .parameter_count = count_of(parameters),
    .required_count = 4,
    .state = states,
    .state_count = count_of(states),
    .samples = samples,
    .sample_count = count_of(samples),
    .algorithms = algorithms,
    .algorithm_count = count_of(algorithms),
    .limits =
        "- Geometric non-linearity is required; without it the host passes F = I and the stress stays zero.\n"
        "- det F <= 0 or a deformation that is not finite asks for a smaller increment.\n"
        "- First order in the increment; relative error of the deviator on simple shear 0 to 2 of a steel in 4, 16, 64 "
        "increments: 0.27, 0.071, 0.018; on a coaxial path of 20 % stretch 0.018 and 0.0046 in 4 and 16.\n"
        "- Softening laws are refused: the scalar equation would have several solutions.\n"
        "- Elastic shear strains are taken as small against 1 in the flow rule (tr be/3 for be): for SY/G > 0.1 it is "
        "a "
        "model choice.\n"
        "- Law 3: steps with rates below RMIN EPS0 yield at that rate, by default at half of A: RMIN = 1 avoids it. "
        "DTIME = 0 counts as rate zero.\n"
        "- PDISS and RPL are the plastic work of the flow rule, mY K dalpha; SPD is what the stress power leaves after "
        "SSE, which differs from it by the elastic shear strain: by some SY/(3 G) of it.\n"
        "- DDSDDE is unsymmetric by 6e-4 to 2e-2 of its largest entry while the material yields.\n"
        "- The residual strain accumulates from the first call: the state there is free of it.\n",
};

}  // namespace lode::he_iso_plastic
