// PROPS, STATEV and samples of ISO_PLASTIC (page 20, section 3).
#pragma once

#include "lode/material/description.hpp"
#include "lode/material/kind.hpp"

namespace lode::iso_plastic {

// 1-based PROPS indices.
enum Property {
    E = 1,
    NU,
    SIGY,
    HLAW,
    H1,
    ALPHA = 15,
    BETA,
    TREF,
    TABS,
    RHOCV,
    CHI,
    TMODE,
    METHOD,
    NSUB,
    LREF,
    H11,
    H15 = 29,
    STOL = 34
};
// 1-based STATEV indices; the slots from TAD on are kept if NSTATV reaches them or an option needs them.
enum Slot { EQPS = 1, RATE, FLOW, YT, TAD, DTAD, ASTOR, PHI, HEATQ, ENTR, EP, RC = 17, RW, DCELL, FW };

constexpr lode_parameter law_constant(const char* symbol, const char* name) {
    return optional(symbol, name, "by law", any_value(), 0.0);
}

inline constexpr lode_parameter parameters[] = {
    required("E", "Young's modulus", "stress", above(0.0)),
    required("NU", "Poisson's ratio", "-", inside(-1.0, 0.5)),
    required("SIGY", "initial yield stress Y (A of Johnson-Cook)", "stress", above(0.0)),
    required(
        "HLAW", "hardening law", "code", code(0, 8),
        "0 perfect: K = Y. 1 linear: Y + Ep x; H = Ep, YMIN. 2 nonlinear: Y (1 + b x)^n; H = b, n, YMIN. "
        "3 Johnson-Cook: (Y + B alpha^n)(1 + C ln(rate/EPS0))(1 - T*^m); H = B, n, C, EPS0, m, TMELT, D, n2, RMIN. "
        "4 Steinberg-Cochran-Guinan: min(Y (1 + b alpha)^n, YMAX)(1 + GP p + GT (T - TREF)); H = b, n, YMAX, GP, "
        "GT. 5 Steinberg-Lund: the same with a thermal part; H = b, n, YMAX, GP, GT, YP, UK, C1, C2. "
        "6 power: Y (1 + b x^n); H = b, n, YMIN. 7 dislocation densities: H = rc0, rw0, b, g0, ad, M, f0, finf, gt, "
        "m, n, Kd, as, bs, k0, TDEP, Am, An, Gm. 8 saturation: Y + Q (1 - exp(-k x)) + H3 x, straight from "
        "ALPHAMAX on; H = Q, k, H3, ALPHAMAX, YMIN. x is alpha, or alpha CELENT/LREF where the law softens; "
        "YMIN is the floor of a law that softens"),
    law_constant("H1", "constant 1 of the law"),
    law_constant("H2", "constant 2 of the law"),
    law_constant("H3", "constant 3 of the law"),
    law_constant("H4", "constant 4 of the law"),
    law_constant("H5", "constant 5 of the law"),
    law_constant("H6", "constant 6 of the law"),
    law_constant("H7", "constant 7 of the law"),
    law_constant("H8", "constant 8 of the law"),
    law_constant("H9", "constant 9 of the law"),
    law_constant("H10", "constant 10 of the law"),
    optional("ALPHA", "linear thermal expansion", "1/temp", any_value(), 0.0),
    optional("BETA", "linear moisture expansion per unit of field 1", "-", any_value(), 0.0),
    optional("TREF", "reference temperature of laws 3, 4, 5", "temp", any_value(), 0.0),
    optional("TABS", "offset to absolute temperature", "temp", any_value(), 0.0, "273.15 for degrees Celsius"),
    optional("RHOCV", "heat capacity per volume at constant volume", "stress/temp", at_least(0.0), 0.0,
             "> 0 for TMODE 2, 3"),
    optional("CHI", "plastic heat: 0 source rule, (0,1] fraction of the plastic work, -1 none", "-", between(-1.0, 1.0),
             0.0),
    optional("TMODE", "thermal mode", "code", code(0, 3), 0.0,
             "0: the host's temperature, RPL = plastic heat; 1: with the thermoelastic heat; 2: the point heats itself "
             "by plastic work; 3: by plastic work and volume change"),
    optional(
        "METHOD", "integration", "code", code(0, 6), 0.0,
        "0: one backward Euler step; 1: exact for a constant strain rate; 2: NSUB backward Euler substeps; 3: "
        "cutting plane; 4: modified Euler, error controlled; 5: trapezoidal return (HLAW 0); 6: NSUB forward Euler "
        "substeps with radial correction. 1 and 3 to 6: HLAW 0, 1, 2, 6, 8 in 3D and (3,1)"),
    optional_or_zero("NSUB", "substeps of METHOD 2 and 6", "-", code(1, 1000), 10.0),
    optional("LREF", "reference element size of softening laws", "length", at_least(0.0), 0.0),
    law_constant("H11", "constant 11 of law 7"),
    law_constant("H12", "constant 12 of law 7"),
    law_constant("H13", "constant 13 of law 7"),
    law_constant("H14", "constant 14 of law 7"),
    law_constant("H15", "constant 15 of law 7"),
    law_constant("H16", "constant 16 of law 7"),
    law_constant("H17", "constant 17 of law 7"),
    law_constant("H18", "constant 18 of law 7"),
    law_constant("H19", "constant 19 of law 7"),
    optional_or_zero("STOL", "relative error of a substep of METHOD 4", "-", between(1e-10, 0.1), 1e-4),
};

inline constexpr lode_state states[] = {
    {"EQPS", "equivalent plastic strain alpha, the sum of sqrt(2/3) abs(dep); may start above 0", 0.0},
    {"RATE", "dalpha/DTIME of the last increment", 0.0},
    {"FLOW", "flow stress K at the end", 0.0},
    {"YT", "thermal part of the yield stress (law 5)", 0.0},
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
    {"RC", "dislocation density of cell interiors (law 7)", 0.0},
    {"RW", "dislocation density of cell walls (law 7)", 0.0},
    {"DCELL", "cell size (law 7)", 0.0},
    {"FW", "wall fraction (law 7)", 0.0},
};

// E, NU, SIGY, HLAW, H1..H10, ALPHA, BETA, TREF, TABS, RHOCV, CHI, TMODE, METHOD, NSUB, LREF, H11..H19, STOL
namespace sample {
inline constexpr double steel[] = {210000.0, 0.3, 250.0, 1, 2000.0};
inline constexpr double aluminium[] = {70000.0, 0.33, 200.0, 8,   150.0, 25.0, 0.0,   0.0,
                                       0.0,     0.0,  0.0,   0.0, 0.0,   0,    2.3e-5};
inline constexpr double perfect[] = {200000.0, 0.3, 400.0, 0};
inline constexpr double voce[] = {200000.0, 0.3, 400.0, 8, 300.0, 12.0, 500.0};
inline constexpr double softening[] = {30000.0, 0.2, 30.0, 1, -1500.0, 3.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0,
                                       0.0,     0.0, 1e-5, 0, 0.0,     0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 50.0};
inline constexpr double armour[] = {200000.0, 0.29, 792.0, 3,   510.0, 0.26, 0.014,  1.0, 1.03, 1520.0, 0.0,
                                    0.0,      0.0,  0.0,   0.0, 0,     0.0,  273.15, 3.6, 0.9,  2};
inline constexpr double impact[] = {200000.0, 0.29, 792.0, 3,      510.0, 0.26, 0.014,  1.0, 1.03, 1520.0, 0.0,
                                    0.0,      0.0,  0.0,   1.2e-5, 0,     0.0,  273.15, 3.6, 0.0,  1};
inline constexpr double nonlinear[] = {200000.0, 0.3, 400.0, 2, 20.0, 0.4};
inline constexpr double power[] = {200000.0, 0.3, 400.0, 6, 3.0, 0.35};
inline constexpr double tungsten[] = {410000.0, 0.28, 2200.0, 4,      7.7, 0.13, 4000.0, 0.0, -2.2e-4, 0.0, 0.0,
                                      0.0,      0.0,  0.0,    4.5e-6, 0,   0.0,  273.15, 2.6, 0.9,     1};
inline constexpr double tantalum[] = {184920.0, 0.34,  375.0, 5,      1.0, 0.1, 1000.0, 0.0, -2e-4, 1000.0, 3597.4,
                                      710000.0, 0.012, 0.0,   6.3e-6, 0,   0.0, 273.15, 2.3, 0.0,   1};
inline constexpr double copper[] = {128000.0, 0.34, 10.0, 7,      1e7,  1e8,   2.56e-7, 1e6, 0.25,    3.06,   0.25,
                                    0.06,     3.2,  50.0, 1.7e-5, 0.0,  0.0,   273.15,  3.4, 0.0,     1,      0,
                                    0,        0.0,  10.0, 10.0,   0.12, 0.006, 5.8,     1,   30000.0, 14900.0};
inline constexpr double exact[] = {200000.0, 0.3, 400.0, 1,   2000.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0,
                                   0.0,      0.0, 0.0,   0.0, 0,      0.0, 0.0, 0.0, 0.0, 0,   1};
inline constexpr double substeps[] = {200000.0, 0.3, 400.0,  8, 300.0, 12.0,   500.0, 0.0, 0.0, 0.0, 0.0, 0.0,
                                      0.0,      0.0, 1.2e-5, 0, 0.0,   273.15, 3.6,   0.9, 1,   2,   4};
inline constexpr double controlled[] = {200000.0, 0.3, 400.0, 0,   0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0,
                                        0.0,      0.0, 0.0,   0.0, 0,   0.0, 0.0, 0.0, 0.0, 0,   4};
}  // namespace sample
inline constexpr lode_sample samples[] = {
    {"STEEL", "mild steel, linear hardening, MPa", sample::steel, count_of(sample::steel), 4e-3, continuum_kinds},
    {"ALUMINIUM", "aluminium alloy, saturating hardening and thermal expansion, MPa, 1/K", sample::aluminium,
     count_of(sample::aluminium), 8e-3, continuum_kinds},
    {"PERFECT", "perfectly plastic, MPa", sample::perfect, count_of(sample::perfect), 6e-3, continuum_kinds},
    {"VOCE", "saturating and linear hardening, MPa", sample::voce, count_of(sample::voce), 6e-3, continuum_kinds},
    {"SOFTENING", "linear softening regularised by the element size (50 mm), MPa", sample::softening,
     count_of(sample::softening), 3e-3, continuum_kinds},
    {"ARMOUR", "Johnson-Cook steel that heats itself, MPa, s, degrees Celsius", sample::armour,
     count_of(sample::armour), 1.5e-2, continuum_kinds},
    {"IMPACT", "the same steel for a coupled analysis, with thermoelastic heat", sample::impact,
     count_of(sample::impact), 1.5e-2, continuum_kinds},
    {"NONLINEAR", "hardening with a power of 1 + b alpha, MPa", sample::nonlinear, count_of(sample::nonlinear), 6e-3,
     continuum_kinds},
    {"POWER", "hardening with a power of alpha, MPa", sample::power, count_of(sample::power), 6e-3, continuum_kinds},
    {"TUNGSTEN", "Steinberg-Cochran-Guinan without pressure hardening (GP = 1e-5), MPa, degrees Celsius",
     sample::tungsten, count_of(sample::tungsten), 2e-2, continuum_kinds},
    {"TANTALUM", "Steinberg-Lund without pressure hardening (GP = 1e-5), MPa, s, degrees Celsius", sample::tantalum,
     count_of(sample::tantalum), 1e-2, continuum_kinds},
    {"COPPER", "dislocation densities, N, mm, s, degrees Celsius", sample::copper, count_of(sample::copper), 4e-3,
     continuum_kinds},
    {"EXACT", "linear hardening, exact for a constant strain rate, MPa", sample::exact, count_of(sample::exact), 6e-3,
     LODE_SOLID | LODE_PLANE_STRAIN},
    {"SUBSTEPS", "saturating hardening in four substeps, with heat, MPa, degrees Celsius", sample::substeps,
     count_of(sample::substeps), 6e-3, LODE_SOLID | LODE_PLANE_STRAIN | LODE_UNIAXIAL},
    {"CONTROLLED", "perfectly plastic, error-controlled explicit substeps, MPa", sample::controlled,
     count_of(sample::controlled), 6e-3, LODE_SOLID | LODE_PLANE_STRAIN},
};

inline constexpr lode_algorithm algorithms[] = {
    {"backward Euler (radial return)", METHOD, 0.0, 1.0},
    {"exact for a constant strain rate", METHOD, 1.0, HUGE_VAL},
    {"backward Euler, NSUB substeps", METHOD, 2.0, 1.0},
    {"cutting plane", METHOD, 3.0, 1.0},
    {"modified Euler, error controlled", METHOD, 4.0, 2.0},
    {"trapezoidal return (perfect plasticity)", METHOD, 5.0, 2.0},
    {"forward Euler with radial correction, NSUB substeps", METHOD, 6.0, 1.0},
};

inline constexpr lode_model description = {
    .keyword = "ISO_PLASTIC",
    .title = "Von Mises plasticity with isotropic hardening",
    .family = "plasticity",
    .purpose = "Metals and other pressure-insensitive isotropic solids at small elastic strain.",
    .source = "Nairn, chapter 2 (eqs. 2.14-2.81, 2.125), chapter 4",
    .kinds = continuum_kinds,
    .traits = LODE_ROTATES_STATE | LODE_USES_CELENT | LODE_UNSYMMETRIC | LODE_ITERATES,
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
