// PROPS, STATEV and samples of ISO_DAMAGE (page 35, section 2).
#pragma once

#include "lode/material/description.hpp"
#include "lode/material/kind.hpp"

namespace lode::iso_damage {

// 1-based PROPS indices.
enum Property {
    E = 1,
    NU,
    SIGC,
    LAW,
    GC,
    METRIC,
    TAUC,
    LAW_II,
    GIIC,
    A1_I,
    A2_I,
    A1_II,
    A2_II,
    FMIN,
    KRES,
    ALPHA,
    BETA,
    HFIX,
    HPOL,
    DELFLAG,
    METH
};
// 1-based STATEV indices; the effective strain comes first.
enum Slot { D = 7, DELTA_N, DELTA_S, STATE, W, H, MODE, STATUS, REL_S, REL_G, count = REL_G };

inline constexpr lode_parameter parameters[] = {
    required("E", "Young's modulus", "stress", above(0.0)),
    required("NU", "Poisson's ratio", "-", inside(-1.0, 0.5)),
    required("SIGC", "strength", "stress", above(0.0)),
    required("LAW", "softening law", "code", code(1, 6),
             "1 linear, 2 exponential, 3 smooth step, 4 cubic, 5 double exponential, 6 stretched exponential"),
    required("GC", "toughness", "energy/area", above(0.0)),
    optional("METRIC", "strain that drives the damage", "code", code(0, 2), 0.0,
             "0 of the strain energy, 1 of the tensile strain energy, 2 largest principal stress and largest shear"),
    optional("TAUC", "shear strength, METRIC 2", "stress", at_least(0.0), 0.0, "METRIC 2: > 0"),
    optional("LAW_II", "softening law in shear, METRIC 2", "code", code(1, 6), 1.0),
    optional("GIIC", "shear toughness, METRIC 2", "energy/area", at_least(0.0), 0.0, "METRIC 2: > 0"),
    optional("A1_I", "first parameter of LAW", "-", any_value(), 0.0,
             "law 4: initial slope >= 0; law 5: a > 1; law 6: a in [1, 100]"),
    optional("A2_I", "second parameter of LAW", "-", any_value(), 0.0, "law 5: b < 1"),
    optional("A1_II", "first parameter of LAW_II", "-", any_value(), 0.0),
    optional("A2_II", "second parameter of LAW_II", "-", any_value(), 0.0),
    optional("FMIN", "fraction of the strength at which laws 2, 5, 6 have failed", "-", between(1e-8, 0.5), 0.01),
    optional("KRES", "residual stiffness over that of the sound material", "-", between(0.0, 0.1), 0.0),
    optional("ALPHA", "thermal expansion", "1/temp", any_value(), 0.0),
    optional("BETA", "expansion per unit of field 1", "1/field", any_value(), 0.0),
    optional("HFIX", "characteristic length", "length", at_least(0.0), 0.0, "0: the host's element length"),
    optional("HPOL", "what to do with too large an element", "code", code(0, 1), 0.0,
             "0 refuse it, 1 reduce the strength"),
    optional("DELFLAG", "STATUS of a failed point", "code", code(0, 1), 0.0,
             "1: it becomes 0, so that the host deletes the element"),
    optional("METH", "damage of an increment", "code", code(0, 1), 0.0,
             "0 from the strain at its end; 1 by the rate at its start (METRIC 0)"),
};
inline constexpr lode_state states[] = {
    {"E11", "effective (mechanical) strain 11", 0.0},
    {"E22", "effective strain 22", 0.0},
    {"E33", "effective strain 33", 0.0},
    {"E12", "effective strain 12 (engineering)", 0.0},
    {"E13", "effective strain 13 (engineering)", 0.0},
    {"E23", "effective strain 23 (engineering)", 0.0},
    {"D", "damage", 0.0},
    {"DELTA_N", "critical cracking strain of LAW", 0.0},
    {"DELTA_S", "critical cracking strain of LAW_II, METRIC 2; METH 1: largest effective strain", 0.0},
    {"STATE", "0 intact, 1 damaged, 2 failed", 0.0},
    {"W", "dissipated energy per volume; H W per area", 0.0},
    {"H", "characteristic length, frozen at the first damage", 0.0},
    {"MODE", "what has damaged last: 1 tension or the single strain, 2 shear", 0.0},
    {"STATUS", "1 active, 0 deleted", 0.0},
    {"REL_S", "relative strength of this point, 0 is read as 1", 0.0},
    {"REL_G", "relative toughness of this point, 0 is read as 1", 0.0},
};
static_assert(count_of(states) == count);

// N, mm, MPa, K.
inline constexpr double resin[] = {3500, 0.35, 60, 1, 0.4, 0, 0, 1, 0, 0, 0, 0, 0, 0.01, 1e-6, 0, 0, 0.3};
inline constexpr double concrete[] = {30000, 0.2, 3, 2, 0.1, 1, 0, 1, 0, 0, 0, 0, 0, 0.01, 1e-4, 1e-5, 0, 100};
inline constexpr double limestone[] = {20000, 0.25, 5, 3, 0.1, 2, 4, 2, 0.3, 0, 0, 0, 0, 0.01, 1e-6, 0, 0, 30};
inline constexpr double bone[] = {15000, 0.3, 8,   5,    0.5,  2,    7,   6,   0.8, 3,
                                  0.6,   1.5, 0.0, 0.01, 1e-3, 2e-5, 0.1, 100, 1,   1};
inline constexpr double steps[] = {3500, 0.35, 60, 2, 0.4, 0, 0, 1, 0, 0, 0, 0, 0, 0.01, 1e-6, 0, 0, 0.3, 0, 0, 1};
inline constexpr lode_sample samples[] = {
    {"RESIN", "brittle resin, strain energy, linear softening, N, mm", resin, count_of(resin), 0.03, continuum_kinds},
    {"CONCRETE-C30", "plain concrete, tensile strain energy, exponential softening, residual stiffness, N, mm, K",
     concrete, count_of(concrete), 6e-4, continuum_kinds},
    {"LIMESTONE", "limestone, tension and shear with laws of their own, N, mm", limestone, count_of(limestone), 1e-3,
     continuum_kinds},
    {"RESIN-STEPS", "tougher resin, exponential softening, damage by its rate, N, mm", steps, count_of(steps), 0.03,
     continuum_kinds},
    {"BONE", "cortical bone, rising laws, strength reduced for a large element, all options, N, mm, K", bone,
     count_of(bone), 2e-3, continuum_kinds},
};

inline constexpr lode_algorithm algorithms[] = {
    {"damage from the end strain: exact; the dissipation is exact for METRIC 0 and on "
     "proportional paths",
     METH, 0.0, 1.0},
    {"damage by the rate at the start (the source)", METH, 1.0, 1.0},
};

inline constexpr lode_model description = {
    .keyword = "ISO_DAMAGE",
    .title = "Isotropic solid with scalar damage",
    .family = "damage",
    .purpose =
        "Quasi-brittle isotropic solids whose stiffness is lost alike in all directions, stress (1 - D) C strain. A "
        "scalar measure of the strain drives the damage by a softening law of given strength and toughness, with the "
        "element length as regularisation.",
    .source = "Nairn, section 6.2 (isotropic damage mechanics)",
    .kinds = continuum_kinds,
    .traits = LODE_UNSYMMETRIC | LODE_ROTATES_STATE | LODE_USES_CELENT | LODE_ITERATES,
    .parameters = parameters,
    .parameter_count = count_of(parameters),
    .required_count = 5,
    .state = states,
    .state_count = count,
    .samples = samples,
    .sample_count = count_of(samples),
    .algorithms = algorithms,
    .algorithm_count = count_of(algorithms),
    .limits =
        "- Elements of length h_max = eta GC E/SIGC^2 (METRIC 2: eta GIIC G/TAUC^2 as well) or more would snap back: "
        "refused with the largest legal size, or with HPOL = 1 the strength is reduced. An unknown element length is "
        "refused.\n"
        "- D = 1 with KRES = 0: no stiffness in any direction, compression too; elements interpenetrate and DDSDDE is "
        "zero. Use KRES = 1e-6..1e-3 or DELFLAG.\n"
        "- METRIC 0: tension and compression damage alike.\n"
        "- METRIC 1 with NU < 0: where the argument of the root is negative the strain is 0.\n"
        "- METRIC 2: where tension and shear take turns, and where s1 = s2 under tension, DDSDDE is that of the active "
        "branch, with any of the equivalent eigenvectors.\n"
        "- 1 - D < 1e-10 loses digits of the stress: use KRES.\n"
        "- Growing damage: DDSDDE is not positive definite, and ellipticity is lost at about the first damage; only "
        "the element length regularises it.\n"
        "- Laws 2, 5, 6 fail at FMIN: the stress jumps by FMIN times the strength, and the tail of the toughness "
        "beyond it is not dissipated.\n"
        "- KRES > 0: W ends where the stress stops to fall, at D = 1 - KRES.\n"
        "- METH = 1 is there to be compared: of first order, with a tangent of its own. The stress may leave the "
        "surface, "
        "and SSE + SPD the work done, by the error of the increments.\n"
        "- An initial stress is taken as that of the sound material. PNEWDT is not touched unless a value on entry is "
        "not finite.\n",
};

}  // namespace lode::iso_damage
