// PROPS, STATEV and samples of DRUCKER_PRAGER (page 20, section 4).
#pragma once

#include "lode/material/description.hpp"
#include "lode/material/kind.hpp"

namespace lode::drucker_prager {

// 1-based PROPS indices; TABS is the first of the thermal block.
enum Property { E = 1, NU, FIT, FRIC, DILA, COH, XI, HLAW, H1, ALPHA = 14, BETA, TABS, METHOD = 20, NSUB, LREF };
// 1-based STATEV indices; 5-10 are the thermal block's, 11-16 the plastic strain.
enum Slot { EQPS = 1, COHC, REGION, EPV };

inline constexpr lode_parameter parameters[] = {
    required("E", "Young's modulus", "stress", above(0.0)),
    required("NU", "Poisson's ratio", "-", inside(-1.0, 0.5)),
    required("FIT", "meaning of FRIC and DILA", "code", code(0, 3),
             "0: eta and eta_bar themselves; 1: angles, outer (compression) cone; 2: angles, inner (extension) cone; "
             "3: angles, plane strain match of Mohr-Coulomb"),
    required("FRIC", "eta (FIT 0) or friction angle", "-, degrees", at_least(0.0), "friction angle below 90"),
    required("DILA", "eta_bar (FIT 0) or dilation angle", "-, degrees", at_least(0.0), "not above FRIC"),
    required("COH", "initial cohesion c0", "stress", above(0.0)),
    optional_or_zero("XI", "factor of the cohesion, FIT 0 only", "-", above(0.0), 1.0),
    optional("HLAW", "hardening law of the cohesion", "code", code(0, 8), 0.0,
             "0 perfect; 1 linear: slope, floor; 2: c0 (1 + H1 x)^H2, floor; 6: c0 (1 + H1 x^H2), floor; 8 saturation: "
             "range, rate, linear part, strain from which it goes on straight, floor"),
    optional("H1", "constant 1 of the law", "by law", any_value(), 0.0),
    optional("H2", "constant 2 of the law", "by law", any_value(), 0.0),
    optional("H3", "constant 3 of the law", "by law", any_value(), 0.0),
    optional("H4", "constant 4 of the law", "by law", any_value(), 0.0),
    optional("H5", "constant 5 of the law", "by law", any_value(), 0.0),
    optional("ALPHA", "linear thermal expansion", "1/temp", any_value(), 0.0),
    optional("BETA", "linear moisture expansion per unit of field 1", "-", any_value(), 0.0),
    optional("TABS", "offset to absolute temperature", "temp", any_value(), 0.0, "273.15 for degrees Celsius"),
    optional("RHOCV", "heat capacity per volume at constant volume", "stress/temp", at_least(0.0), 0.0),
    optional("CHI", "plastic heat: 0 source rule, (0,1] fraction of the plastic work, -1 none", "-", between(-1.0, 1.0),
             0.0),
    optional("TMODE", "thermal mode", "code", code(0, 3), 0.0,
             "0 the host's temperature, RPL = plastic heat; 1 the same with thermoelastic heat; 2 self-adiabatic, "
             "plastic heat; 3 self-adiabatic, plastic and thermoelastic heat"),
    optional("METHOD", "integration", "code", code(0, 2), 0.0,
             "0: one backward Euler step; 2: NSUB equal backward Euler substeps"),
    optional_or_zero("NSUB", "substeps of METHOD 2", "-", code(1, 1000), 10.0),
    optional("LREF", "reference element size of softening laws", "length", at_least(0.0), 0.0,
             "> 0 for softening laws, else ignored"),
};

inline constexpr lode_state states[] = {
    {"EQPS", "hardening variable alpha, the sum of xi lambda; may start above 0", 0.0},
    {"COHC", "cohesion c(alpha) at the end", 0.0},
    {"REGION", "0 elastic, 1 cone, 2 apex in the last increment", 0.0},
    {"EPV", "plastic volume strain", 0.0},
    {"TAD", "accumulated self-heating (TMODE 2, 3)", 0.0},
    {"DTAD", "last increment of TAD", 0.0},
    {"ASTOR", "stored plastic energy per volume", 0.0},
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

inline constexpr double dense_sand[] = {50000.0, 0.3, 1, 36.0, 6.0, 10.0};
inline constexpr double clay[] = {20000.0, 0.25, 3, 25.0, 25.0, 20.0, 0.0, 1, 2000.0};
inline constexpr double concrete[] = {30000.0, 0.2, 2,   35.0, 10.0, 5.0,    0.0, 8,   6.0, 300.0,
                                      0.0,     0.0, 0.0, 1e-5, 0.0,  273.15, 2.4, 0.9, 1};
inline constexpr double polymer[] = {2500.0, 0.38, 0,   0.2,  0.05,   40.0, 1.0, 2, 20.0, 0.3, 0.0,
                                     0.0,    0.0,  0.0, 0.01, 273.15, 1.8,  0.9, 2, 2,    4};
inline constexpr double softening[] = {1000.0, 0.25, 2,   20.0, 5.0, 2.0, 0.0, 1, -40.0, 0.5, 0.0,
                                       0.0,    0.0,  0.0, 0.0,  0.0, 0.0, 0.0, 0, 0,     0.0, 10.0};
inline constexpr unsigned kinds = LODE_SOLID | LODE_PLANE_STRAIN | LODE_PLANE_STRESS;
inline constexpr lode_sample samples[] = {
    {"SAND", "cemented dense sand, perfectly plastic, kPa", dense_sand, count_of(dense_sand), 3e-3,
     LODE_SOLID | LODE_PLANE_STRAIN},
    {"CLAY", "stiff clay, associated flow, linear hardening, kPa", clay, count_of(clay), 6e-3, kinds},
    {"CONCRETE", "concrete, saturating cohesion, thermal expansion and heat (TMODE 1), MPa, degrees Celsius", concrete,
     count_of(concrete), 2e-3, kinds},
    {"POLYMER", "glassy polymer in fast loading: self-heating (TMODE 2), moisture, four substeps, MPa, degrees Celsius",
     polymer, count_of(polymer), 0.06, LODE_SOLID | LODE_PLANE_STRAIN},
    {"SOFTENING", "linear softening of the cohesion to a floor, regularised by the element size (10)", softening,
     count_of(softening), 0.015, kinds},
};

inline constexpr lode_algorithm algorithms[] = {
    {"backward Euler: return to cone or apex", METHOD, 0.0, 1.0},
    {"NSUB backward Euler substeps", METHOD, 2.0, 1.0},
};

inline constexpr lode_model description = {
    .keyword = "DRUCKER_PRAGER",
    .title = "Drucker-Prager plasticity, non-associated, with apex",
    .family = "plasticity",
    .purpose = "Pressure-dependent strength of soils, rock, concrete and polymers.",
    .source = "Nairn, chapter 2 (eqs. 2.82-2.96)",
    .kinds = kinds,
    .traits = LODE_UNSYMMETRIC | LODE_ROTATES_STATE | LODE_USES_CELENT | LODE_ITERATES,
    .parameters = parameters,
    .parameter_count = count_of(parameters),
    .required_count = 6,
    .state = states,
    .state_count = count_of(states),
    .samples = samples,
    .sample_count = count_of(samples),
    .algorithms = algorithms,
    .algorithm_count = count_of(algorithms),
    .limits =
        "- eta_bar > eta (DILA > FRIC) would make the plastic power negative under pressure: refused.\n"
        "- COH = 0 puts the apex at the origin, where relative tolerances fail: refused.\n"
        "- The tangent at the apex of a perfectly plastic material is zero, as it should be: a mesh whose points are "
        "all at the apex is singular.\n"
        "- Without dilatancy (eta_bar = 0) the cone's flow cannot lower a tension beyond the apex: the stress goes to "
        "the apex, without hardening.\n"
        "- A softening law needs LREF and a known element length; an element so large that softening is steeper than "
        "elastic unloading, xi^2 c' h/LREF <= -(G + eta eta_bar K), is refused with the largest legal size. In plane "
        "stress the unloading is that of the softest stress state on the yield surface, which is near biaxial "
        "compression: it vanishes as eta comes to sqrt3/2. At the apex softening may be steeper than unloading: the "
        "smallest solution is taken, the floor of the cohesion keeps it finite.\n"
        "- Softening, perfect plasticity and, with eta_bar < eta, even slow hardening lose ellipticity: results depend "
        "on the mesh; nothing is done about it beyond LREF.\n"
        "- eta >= sqrt3/2: no yield in biaxial compression under plane stress; eta >= sqrt3: none in uniaxial "
        "compression.\n"
        "- A hardening material at the apex stores more than the plastic work once c/c0 > 1/(1 - eta_bar/eta): heat by "
        "the source rule (CHI = 0) is clamped at 0.\n"
        "- A large non-radial increment is integrated to first order only: METHOD 2 or smaller increments.\n",
};

}  // namespace lode::drucker_prager
