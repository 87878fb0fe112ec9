// PROPS, STATEV and samples of ISO_PLASTIC (page 20, section 3).
#pragma once

#include "lode/material/description.hpp"
#include "lode/material/kind.hpp"

namespace lode::iso_plastic {

// 1-based PROPS indices.
enum Property { E = 1, NU, SIGY, HLAW, H1, ALPHA = 15, BETA, TREF, TABS, RHOCV, CHI, TMODE, METHOD, NSUB, LREF };
// 1-based STATEV indices; the slots from TAD on are kept if NSTATV reaches them.
enum Slot { EQPS = 1, RATE, FLOW, YT, TAD, DTAD, ASTOR, PHI, HEATQ, ENTR, EP };

inline constexpr lode_parameter parameters[] = {
    required("E", "Young's modulus", "stress", above(0.0)),
    required("NU", "Poisson's ratio", "-", inside(-1.0, 0.5)),
    required("SIGY", "initial yield stress", "stress", above(0.0)),
    required("HLAW", "hardening law", "code", code(0, 8),
             "0 perfect; 1 linear: H1 = Ep, H2 = floor; 8 saturation: H1 = Q, H2 = k, H3 = linear part, H4 = strain "
             "from which the law continues straight, H5 = floor"),
    optional("H1", "constant 1 of the law", "by law", any_value(), 0.0),
    optional("H2", "constant 2 of the law", "by law", any_value(), 0.0),
    optional("H3", "constant 3 of the law", "by law", any_value(), 0.0),
    optional("H4", "constant 4 of the law", "by law", any_value(), 0.0),
    optional("H5", "constant 5 of the law", "by law", any_value(), 0.0),
    optional("H6", "constant 6 of the law", "by law", any_value(), 0.0),
    optional("H7", "constant 7 of the law", "by law", any_value(), 0.0),
    optional("H8", "constant 8 of the law", "by law", any_value(), 0.0),
    optional("H9", "constant 9 of the law", "by law", any_value(), 0.0),
    optional("H10", "constant 10 of the law", "by law", any_value(), 0.0),
    optional("ALPHA", "linear thermal expansion", "1/temp", any_value(), 0.0),
    optional("BETA", "linear moisture expansion per unit of field 1", "-", any_value(), 0.0),
    optional("TREF", "reference temperature of rate-dependent laws", "temp", any_value(), 0.0),
    optional("TABS", "offset to absolute temperature", "temp", any_value(), 0.0, "273.15 for degrees Celsius"),
    optional("RHOCV", "heat capacity per volume at constant volume", "stress/temp", at_least(0.0), 0.0),
    optional("CHI", "plastic heat: 0 source rule, (0,1] fraction of the plastic work, -1 none", "-", between(-1.0, 1.0),
             0.0),
    optional("TMODE", "thermal mode", "code", code(0, 0), 0.0, "0: the host's temperature, RPL = plastic heat"),
    optional("METHOD", "integration", "code", code(0, 0), 0.0, "0: one backward Euler step"),
    optional_or_zero("NSUB", "substeps of METHOD 2", "-", code(1, 1000), 10.0),
    optional("LREF", "reference element size of softening laws", "length", at_least(0.0), 0.0),
};

inline constexpr lode_state states[] = {
    {"EQPS", "equivalent plastic strain alpha, the sum of sqrt(2/3) abs(dep); may start above 0", 0.0},
    {"RATE", "dalpha/DTIME of the last increment", 0.0},
    {"FLOW", "flow stress K at the end", 0.0},
    {"YT", "thermal part of the yield stress, 0 for these laws", 0.0},
    {"TAD", "accumulated self-heating", 0.0},
    {"DTAD", "last increment of TAD", 0.0},
    {"ASTOR", "stored energy of cold work per volume", 0.0},
    {"PHI", "plastic work turned into heat per volume", 0.0},
    {"HEATQ", "heat received from outside per volume", 0.0},
    {"ENTR", "entropy per volume relative to the start", 0.0},
    {"EP1", "plastic strain 11", 0.0},
    {"EP2", "plastic strain 22", 0.0},
    {"EP3", "plastic strain 33", 0.0},
    {"EP4", "plastic shear strain 12 (engineering)", 0.0},
    {"EP5", "plastic shear strain 13 (engineering), 3D", 0.0},
    {"EP6", "plastic shear strain 23 (engineering), 3D", 0.0},
};

inline constexpr double steel[] = {210000.0, 0.3, 250.0, 1, 2000.0};
inline constexpr double aluminium[] = {70000.0, 0.33, 200.0, 8,   150.0, 25.0, 0.0,   0.0,
                                       0.0,     0.0,  0.0,   0.0, 0.0,   0,    2.3e-5};
inline constexpr double perfect[] = {200000.0, 0.3, 400.0, 0};
inline constexpr double voce[] = {200000.0, 0.3, 400.0, 8, 300.0, 12.0, 500.0};
inline constexpr double softening[] = {30000.0, 0.2, 30.0, 1, -1500.0, 3.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0,
                                       0.0,     0.0, 1e-5, 0, 0.0,     0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 50.0};
inline constexpr lode_sample samples[] = {
    {"STEEL", "mild steel, linear hardening, MPa", steel, count_of(steel), 4e-3, continuum_kinds},
    {"ALUMINIUM", "aluminium alloy, saturating hardening and thermal expansion, MPa, 1/K", aluminium,
     count_of(aluminium), 8e-3, continuum_kinds},
    {"PERFECT", "perfectly plastic, MPa", perfect, count_of(perfect), 6e-3, continuum_kinds},
    {"VOCE", "saturating and linear hardening, MPa", voce, count_of(voce), 6e-3, continuum_kinds},
    {"SOFTENING", "linear softening regularised by the element size (50 mm), MPa", softening, count_of(softening), 3e-3,
     continuum_kinds},
};

inline constexpr lode_algorithm algorithms[] = {
    {"backward Euler (radial return)", METHOD, 0.0, 1.0},
};

inline constexpr lode_model description = {
    .keyword = "ISO_PLASTIC",
    .title = "Von Mises plasticity with isotropic hardening",
    .family = "plasticity",
    .purpose = "Metals and other pressure-insensitive isotropic solids at small elastic strain.",
    .source = "Nairn, chapter 2 (eqs. 2.14-2.64, 2.125)",
    .kinds = continuum_kinds,
    .traits = LODE_ROTATES_STATE | LODE_USES_CELENT,
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
        "- A softening law needs LREF and a known element length; an element so large that softening is steeper than "
        "the elastic unloading of the point is refused with the largest legal size.\n"
        "- A large non-radial increment is integrated to first order only: up to 22 % stress error at a tangential "
        "trial increment of three yield radii.\n"
        "- Softening and perfect plasticity lose ellipticity: results depend on the mesh; nothing is done about it "
        "beyond LREF.\n"
        "- A yield stress that has fallen to a floor of 0 gives zero deviatoric stress without division.\n",
};

}  // namespace lode::iso_plastic
