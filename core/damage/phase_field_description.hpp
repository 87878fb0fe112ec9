// PROPS, STATEV and samples of PHASE_FIELD (page 35, section 7).
#pragma once

#include "lode/material/description.hpp"
#include "lode/material/kind.hpp"

namespace lode::phase_field {

// 1-based PROPS indices.
enum Property { E = 1, NU, GC, ELL, GLAW, GARG, PART, KSTAB, PHISRC, ALPHA, BETA, PSII, METH };
// 1-based STATEV indices; the effective strain comes first.
enum Slot { HIST = 7, PHI, G, GP, PSIP, PSIM, W, SRC, DSRC, FAILED, count = FAILED };

inline constexpr lode_parameter parameters[] = {
    required("E", "Young's modulus", "stress", above(0.0)),
    required("NU", "Poisson's ratio", "-", inside(-1.0, 0.5), "PART 2: >= 0"),
    required("GC", "toughness", "energy/area", above(0.0)),
    required("ELL", "length scale of the phase field", "length", above(0.0)),
    optional("GLAW", "degradation law", "code", code(1, 4), 1.0,
             "1 quadratic, 2 exponential, 3 cubic, 4 linear softening"),
    optional("GARG", "its parameter", "-", at_least(-1.0), -1.0,
             "GLAW 1 and 3: xi in [0, 1], default 1 and 2/3; GLAW 2: a > 0, default 3; GLAW 4: chi > 0, default 4; -1 "
             "asks for the default"),
    optional("PART", "part of the energy that drives and is degraded", "code", code(1, 2), 1.0,
             "1 dilation and shape, 2 positive principal strains"),
    optional("KSTAB", "residual stiffness over that of the sound material", "-", Range{0.0, 1.0, LODE_UPPER_OPEN}, 0.0),
    optional("PHISRC", "where the phase comes from", "code", code(0, 2), 0.0,
             "0 field variable 1 of the host, 1 local solution, 2 temperature degree of freedom"),
    optional("ALPHA", "thermal expansion", "1/temp", any_value(), 0.0, "PHISRC 2: 0"),
    optional("BETA", "expansion per unit of field 2", "1/field", any_value(), 0.0,
             "field 2 is read only if it is not 0"),
    optional("PSII", "energy at which damage begins", "energy/volume", any_value(), -1.0,
             "< 0: by the law, GC/(2 ELL GARG) of GLAW 4 and 0 of the others"),
    optional("METH", "form of the update", "code", code(0, 2), 0.0,
             "0 stress of the strain, H of the end; 1 stress by increments, H of the start; 2 stress of the strain, H "
             "of the start"),
};
inline constexpr lode_state states[] = {
    {"E11", "effective (mechanical) strain 11", 0.0},
    {"E22", "effective strain 22", 0.0},
    {"E33", "effective strain 33", 0.0},
    {"E12", "effective strain 12 (engineering)", 0.0},
    {"E13", "effective strain 13 (engineering)", 0.0},
    {"E23", "effective strain 23 (engineering)", 0.0},
    {"HIST", "crack driving energy H, the largest Psi+ - Psi_i so far", 0.0},
    {"PHI", "phase value of this increment", 0.0},
    {"G", "degradation g", 0.0},
    {"GP", "g'", 0.0},
    {"PSIP", "Psi+, undegraded", 0.0},
    {"PSIM", "Psi-", 0.0},
    {"W", "dissipated energy per volume", 0.0},
    {"SRC", "source of the field equation, -g' H - GC PHI/ELL", 0.0},
    {"DSRC", "its derivative with PHI, -g'' H - GC/ELL", 0.0},
    {"FAILED", "1 once PHI has reached 1", 0.0},
};
static_assert(count_of(states) == count);

// N, mm, MPa, K.
inline constexpr double concrete[] = {30000, 0.2, 0.08, 5, 1, 1, 2, 1e-6};
inline constexpr double local_quadratic[] = {30000, 0.2, 0.08, 5, 1, 1, 1, 1e-4, 1};
inline constexpr double local_bilinear[] = {30000, 0.2, 0.08, 5, 4, 4, 2, 1e-6, 1, 1e-5};
inline constexpr double local_exponential[] = {210000, 0.3, 2.7, 0.1, 2, 3, 2, 1e-5, 1, 1.2e-5};
inline constexpr double local_cubic[] = {30000, 0.2, 0.08, 5, 3, 0.9, 1, 0, 1, 0, 0, 5e-4};
inline constexpr double steel[] = {210000, 0.3, 2.7, 0.1, 1, 1, 2, 1e-6, 2};
inline constexpr double increments[] = {210000, 0.3, 2.7, 0.1, 1, 1, 2, 1e-6, 2, 0, 0, -1, 1};
inline constexpr unsigned with_all_strains = LODE_SOLID | LODE_PLANE_STRAIN;
inline constexpr unsigned all_kinds = with_all_strains | LODE_PLANE_STRESS;
inline constexpr lode_sample samples[] = {
    {"CONCRETE", "concrete, phase from field variable 1, principal strains, N, mm", concrete, count_of(concrete), 1e-3,
     all_kinds},
    {"LOCAL", "concrete, quadratic degradation, local solution, N, mm", local_quadratic, count_of(local_quadratic),
     1e-3, with_all_strains},
    {"LOCAL-BILINEAR", "concrete, linear softening, principal strains, local solution, N, mm, K", local_bilinear,
     count_of(local_bilinear), 1e-3, with_all_strains},
    {"LOCAL-STEEL", "brittle steel, exponential degradation, principal strains, local solution, N, mm, K",
     local_exponential, count_of(local_exponential), 2e-2, with_all_strains},
    {"LOCAL-CUBIC", "concrete, cubic degradation with a threshold, local solution, N, mm", local_cubic,
     count_of(local_cubic), 1e-3, with_all_strains},
    {"STEEL-INCREMENTAL", "the steel by increments of stress", increments, count_of(increments), 1e-2,
     with_all_strains},
    {"STEEL", "brittle steel, the temperature is the phase, N, mm", steel, count_of(steel), 1e-2, all_kinds},
};

inline constexpr lode_algorithm algorithms[] = {
    {"total form in the end strain: exact; the dissipation by the trapezoid rule", METH, 0.0, 2.0},
    {"increments of stress, staggered (the source)", METH, 1.0, 1.0},
    {"total form, staggered", METH, 2.0, 1.0},
};

inline constexpr lode_model description = {
    .keyword = "PHASE_FIELD",
    .title = "Local part of phase-field fracture",
    .family = "damage",
    .purpose =
        "The constitutive side of phase-field fracture: stress degraded by a phase value, the crack driving energy and "
        "the source of the field equation GC ELL lap(phi) + SRC = 0, which the host solves. The phase comes from a "
        "field "
        "variable, from the temperature of a heat conduction element, or from the solution without gradient.",
    .source = "Nairn, section 6.3 (phase field fracture)",
    .kinds = all_kinds,
    .traits = LODE_ROTATES_STATE,
    .parameters = parameters,
    .parameter_count = count_of(parameters),
    .required_count = 4,
    .state = states,
    .state_count = count,
    .samples = samples,
    .sample_count = count_of(samples),
    .algorithms = algorithms,
    .algorithm_count = count_of(algorithms),
    .limits =
        "- KSTAB = 0 and PHI = 1: no stiffness in tension (PART 1: none in shear under compression either). Use KSTAB "
        "= "
        "1e-6..1e-4.\n"
        "- Elements should not exceed ELL/4: a band that the mesh does not resolve takes too much energy. The mesh is "
        "not checked.\n"
        "- PART 2 under shear never unloads: tau = (1 + g) G gamma/2, s11 = s22 = -(1 - g) G gamma/2.\n"
        "- PART 2 with a small xi under uniaxial stress: the strain of the homogeneous solution falls as PHI grows "
        "(snap-back); not at prescribed strain.\n"
        "- GLAW 1 with xi = 0: PHI jumps from 0 to 1 at H = GC/(2 ELL). Beyond that DSRC >= 0, and a host's Newton "
        "iteration fails.\n"
        "- g'(1) < 0 (GLAW 1 with xi < 1, GLAW 2, 4): the field solution overshoots 1. g' = 0 beyond it, and the host "
        "must clip the phase.\n"
        "- 1 + g'' H ELL/GC <= 0 (xi < 0.5): DSRC >= 0, the host's matrix is no longer definite.\n"
        "- PHISRC = 1 has no gradient term: the energy per volume is fixed by GC/ELL, results depend on the mesh. For "
        "verification and single elements; not in plane stress.\n"
        "- PHISRC = 0: the phase is used as it is supplied, clipped to [0, 1]. It may fall, and energy then comes "
        "back: "
        "irreversibility is in HIST, the host enforces growth if it wants it.\n"
        "- PHISRC = 2: for a steady heat conduction element of unit conductivity. DRPLDT and DDSDDT are those of "
        "PHI = TEMP + DTEMP >= 0; below 0 they vanish.\n"
        "- The strength is tied to sqrt(GC E/ELL): choose ELL by it, or GLAW 4 with GARG = GC E/(ELL strength^2).\n"
        "- tr eps = 0 and, in PART 2, a principal strain of 0 are kinks: DDSDDE is that of the compressive side.\n"
        "- PART 2 with NU < 0 is refused: plane stress would not be unique.\n"
        "- An initial stress is taken as that of the sound material.\n"
        "- METH = 1 and 2 are there to be compared, of first order. The history that drives the phase (PHISRC 1), SRC "
        "and "
        "RPL is that of the start: an increment without strain lets the local phase catch up. METH = 1 sums up stress "
        "at "
        "the rates of the start, which drifts: a failed point may keep a stress, and SSE is that of the strain. Not in "
        "plane stress.\n",
};

}  // namespace lode::phase_field
