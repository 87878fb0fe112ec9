// PROPS, STATEV and samples of ISO_SOFTENING (page 30, section 2).
#pragma once

#include "lode/damage/softening_state.hpp"

namespace lode::iso_softening {

// 1-based PROPS indices.
enum Property {
    E = 1,
    NU,
    SIGC,
    TAUC,
    LAW_I,
    GIC,
    LAW_II,
    GIIC,
    SURF,
    MIX_I,
    MIX_II,
    A1_I,
    A2_I,
    A1_II,
    A2_II,
    FMIN,
    MU,
    ALPHA,
    BETA,
    HFIX,
    HPOL,
    PDM,
    TAUH,
    P1,
    P2,
    DELFLAG,
    METH
};

inline constexpr lode_parameter parameters[] = {
    required("E", "Young's modulus", "stress", above(0.0)),
    required("NU", "Poisson's ratio", "-", inside(-1.0, 0.5)),
    required("SIGC", "tensile strength", "stress", at_least(0.0), "0: never fails in tension"),
    required("TAUC", "shear strength", "stress", at_least(0.0), "0: never fails in shear"),
    required("LAW_I", "softening law of mode I", "code", code(1, 6),
             "1 linear, 2 exponential, 3 smooth step, 4 cubic, 5 double exponential, 6 stretched exponential"),
    required("GIC", "mode I toughness", "energy/area", above(0.0)),
    required("LAW_II", "softening law of mode II", "code", code(1, 6)),
    required("GIIC", "mode II toughness", "energy/area", above(0.0)),
    optional("SURF", "traction surface", "code", code(0, 4), 0.0,
             "0 cuboid, 1 cylinder, 2 ovoid, 3 coupled cuboid, 4 coupled cylinder"),
    optional("MIX_I", "exponent of mode I in the failure criterion", "-", any_value(), 1.0,
             "<= 0 switches the criterion off"),
    optional("MIX_II", "exponent of the shears in the failure criterion", "-", any_value(), 1.0,
             "<= 0 switches the criterion off"),
    optional("A1_I", "first parameter of LAW_I", "-", any_value(), 0.0,
             "law 4: initial slope >= 0; law 5: a > 1; law 6: a in [1, 100]"),
    optional("A2_I", "second parameter of LAW_I", "-", any_value(), 0.0, "law 5: b < 1"),
    optional("A1_II", "first parameter of LAW_II", "-", any_value(), 0.0),
    optional("A2_II", "second parameter of LAW_II", "-", any_value(), 0.0),
    optional("FMIN", "fraction of the strength at which laws 2, 5, 6 have failed", "-", between(1e-8, 0.5), 0.01),
    optional("MU", "Coulomb friction of the failed, closed crack", "-", at_least(0.0), 0.0),
    optional("ALPHA", "thermal expansion", "1/temp", any_value(), 0.0),
    optional("BETA", "expansion per unit of field 1", "1/field", any_value(), 0.0),
    optional("HFIX", "characteristic length", "length", at_least(0.0), 0.0, "0: the host's element length"),
    optional("HPOL", "what to do with too large an element", "code", code(0, 1), 0.0,
             "0 refuse it, 1 reduce the strength"),
    optional("PDM", "pressure dependence of TAUC", "code", code(0, 4), 0.0,
             "0 none, 1 linear, 2 step-linear, 3 step-exponential, 4 sigmoidal"),
    optional("TAUH", "hydrostatic (PDM 1) or high-pressure (PDM 2-4) shear strength", "stress", any_value(), 0.0),
    optional("P1", "onset pressure (PDM 2, 3) or centre pressure (PDM 4)", "stress", any_value(), 0.0),
    optional("P2", "end pressure (PDM 2) or half-rise width (PDM 3, 4)", "stress", any_value(), 0.0),
    optional("DELFLAG", "STATUS of a failed point", "code", code(0, 1), 0.0,
             "1: it becomes 0, so that the host deletes the element"),
    optional("METH", "damage of an increment", "code", code(0, 1), 0.0,
             "0 from the strain at its end; 1 the source's explicit step (SURF 0, 1, 2 without PDM)"),
};

// N, mm, MPa. In the plane kinds a crack contains axis 3, so where shear or a strain along 3 comes first they are not
// the constrained solid, and such materials are samples of the one or the others.
inline constexpr unsigned tension_kinds = LODE_SOLID | LODE_PLANE_STRESS | LODE_UNIAXIAL;
inline constexpr unsigned plane_kinds = LODE_PLANE_STRAIN | LODE_PLANE_STRESS;
inline constexpr double concrete[] = {30000.0, 0.2, 3.0, 0.0, 1, 0.1, 1, 0.1};
inline constexpr double gypsum[] = {4000.0, 0.2, 2.0, 0.0, 2,   0.03, 1,   0.03,   0,   1.0,
                                    1.0,    0.0, 0.0, 0.0, 0.0, 1e-3, 0.0, 1.2e-5, 0.0, 10.0};
inline constexpr double rock[] = {20000.0, 0.25, 5.0, 6.0, 1,   0.1,  1,   0.3, 0,   1.5,
                                  1.0,     0.0,  0.0, 0.0, 0.0, 0.01, 0.4, 0.0, 0.0, 40.0};
inline constexpr double ceramic[] = {20000.0, 0.25, 5.0, 4.0, 2,   0.1,  3,   0.3,  2,   1.0,
                                     1.0,     0.0,  0.0, 0.0, 0.0, 0.01, 0.0, 8e-6, 0.0, 30.0};
inline constexpr double mortar[] = {20000.0, 0.25, 5.0, 6.0, 4,   0.1,  6,   0.3, 4,   1.0,
                                    1.0,     0.5,  0.0, 1.5, 0.0, 0.01, 0.2, 0.0, 0.0, 30.0};
inline constexpr double bone[] = {15000.0, 0.3, 8.0, 7.0, 5,   0.5,  2,   0.8, 3,   1.0,
                                  1.0,     2.0, 0.4, 0.0, 0.0, 0.01, 0.0, 0.0, 0.0, 20.0};
inline constexpr double sandstone[] = {20000.0, 0.25, 5.0, 4.0,  1,   0.1,  1,   0.3, 1, 1.0, 1.0, 0.0,
                                       0.0,     0.0,  0.0, 0.01, 0.3, 1e-5, 0.0, 0.0, 0, 1,   12.0};
inline constexpr double salt[] = {25000.0, 0.25, 2.0,  3.0, 3,    0.05, 2,   0.2, 2, 1.0,  1.0, 0.0, 0.0,
                                  0.0,     0.0,  0.01, 0.3, 4e-5, 0.0,  5.0, 0,   4, 15.0, 5.0, 4.0};
// METH = 1.
inline constexpr double steps[] = {20000.0, 0.25, 5.0, 4.0,  2,   0.1,  3, 0.3, 2,   1.0, 1.0, 0.0, 0.0, 0.0,
                                   0.0,     0.01, 0.0, 8e-6, 0.0, 30.0, 0, 0,   0.0, 0.0, 0.0, 0,   1};
inline constexpr double tension_steps[] = {4000.0, 0.2,  2.0, 0.0,    2,   0.03, 1, 0.03, 0,   1.0, 1.0, 0.0, 0.0, 0.0,
                                           0.0,    1e-3, 0.0, 1.2e-5, 0.0, 10.0, 0, 0,    0.0, 0.0, 0.0, 0,   1};
inline constexpr lode_sample samples[] = {
    {"CONCRETE-C30", "plain concrete in tension, linear softening, N, mm", concrete, count_of(concrete), 5e-4,
     tension_kinds},
    {"GYPSUM", "gypsum in tension, exponential softening, thermal expansion, N, mm, K", gypsum, count_of(gypsum), 2e-3,
     tension_kinds},
    {"ROCK", "limestone, independent modes, mixed-mode criterion, friction, N, mm", rock, count_of(rock), 1e-3,
     LODE_SOLID},
    {"CERAMIC", "porous ceramic, ovoid surface, exponential and smooth softening, N, mm, K", ceramic, count_of(ceramic),
     2e-3, LODE_SOLID},
    {"MORTAR", "mortar, coupled cylinder, rising law of mode I, N, mm", mortar, count_of(mortar), 2e-3, LODE_SOLID},
    {"BONE", "cortical bone, coupled cuboid, double exponential law, N, mm", bone, count_of(bone), 2e-3, LODE_SOLID},
    {"SANDSTONE", "sandstone, cylinder, shear strength linear in pressure, friction, N, mm, K", sandstone,
     count_of(sandstone), 1e-3, LODE_SOLID},
    {"SALT", "rock salt, ovoid, sigmoidal shear strength, N, mm, K", salt, count_of(salt), 1e-3, LODE_SOLID},
    {"CERAMIC-STEPS", "the ceramic by explicit steps", steps, count_of(steps), 2e-3, LODE_SOLID},
    {"GYPSUM-STEPS", "the gypsum by explicit steps", tension_steps, count_of(tension_steps), 2e-3, tension_kinds},
    {"ROCK-2D", "the limestone in plane kinds", rock, count_of(rock), 1e-3, plane_kinds},
    {"CERAMIC-2D", "the ceramic in plane kinds", ceramic, count_of(ceramic), 2e-3, plane_kinds},
    {"MORTAR-2D", "the mortar in plane kinds", mortar, count_of(mortar), 2e-3, plane_kinds},
    {"SALT-2D", "the rock salt in plane kinds", salt, count_of(salt), 1e-3, plane_kinds},
};

inline constexpr lode_algorithm algorithms[] = {
    {"damage from the end strain: exact but for where in the increment a crack forms or fails", METH, 0.0, 1.0},
    {"explicit step of the source", METH, 1.0, 1.0},
};

inline constexpr lode_model description = {
    .keyword = "ISO_SOFTENING",
    .title = "Isotropic solid that softens on one crack plane",
    .family = "damage",
    .purpose =
        "Quasi-brittle isotropic solids. When a strength is reached, one crack plane forms at the point; the tractions "
        "on it soften to zero by a law of the given toughness, with the element length as regularisation, while the "
        "rest stays elastic. A closed crack carries compression.",
    .source = "Nairn, chapter 5 (anisotropic damage mechanics)",
    .kinds = continuum_kinds,
    .traits = LODE_UNSYMMETRIC | LODE_ROTATES_STATE | LODE_USES_CELENT | LODE_FRAME_CHOICE | LODE_ITERATES,
    .parameters = parameters,
    .parameter_count = count_of(parameters),
    .required_count = 8,
    .state = softening_state::states,
    .state_count = softening_state::count,
    .samples = samples,
    .sample_count = count_of(samples),
    .algorithms = algorithms,
    .algorithm_count = count_of(algorithms),
    .limits =
        "- Elements larger than h_max = eta G C/strength^2 would snap back: refused with the largest legal size, or "
        "with HPOL = 1 the strength is reduced. An unknown element length is refused.\n"
        "- Near h_max the response amplifies errors of the strain by 1/(1 + F'/C).\n"
        "- Softening loses ellipticity from the first damaged increment; only the element length regularises it.\n"
        "- Laws 2, 5, 6 fail at FMIN: the stress jumps by FMIN times the strength, and the tail of the toughness "
        "beyond it is not dissipated.\n"
        "- The mixed-mode criterion drops all tractions at once. The released energy is in W; a load-controlled host "
        "has no equilibrium path there. PNEWDT is never touched.\n"
        "- SURF 2-4 fail where the first of their laws ends, also for a direction that carries no load.\n"
        "- Equal principal stresses at initiation leave the normal open (the lowest axes are taken), and in 3D two "
        "planes are equally critical in shear: the one at 45 degrees from the first towards the last principal axis "
        "is taken, each axis with its largest component positive. Which one that is depends on the host's frame.\n"
        "- The normal belongs to the trial stress at the end of the increment in which the crack forms.\n"
        "- In the plane kinds the crack contains axis 3. One crack a point: stress along it is unbounded.\n"
        "- PDM 1 under tension would give a negative strength: floor 0.001 TAUC.\n"
        "- DDSDDE of an open failed crack is singular and returned as it is.\n"
        "- METH = 1 is there to be compared: of first order, with a tangent of its own. Tractions may leave the "
        "surface (they come back by no more than the next increment) and linked damages drift apart by the error of "
        "the increments, and so do SSE + SPD from the work done. The increment in which a crack forms is that of "
        "METH = 0.\n",
};

}  // namespace lode::iso_softening
