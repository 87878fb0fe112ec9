// PROPS, STATEV and samples of ELASTIC_DECOHESIVE (page 80, sections 1, 2).
#pragma once

#include "lode/material/description.hpp"
#include "lode/material/kind.hpp"

namespace lode::elastic_decohesive {

// 1-based PROPS indices.
enum Property {
    E = 1,
    NU,
    TAU_NF,
    TAU_SF,
    TAU_SM,
    F_C,
    G_F,
    F_B,
    C_N,
    C_S,
    C_PSI,
    CRIT,
    SOFT,
    N_C,
    ALPHA_TH,
    MU,
    N_X,
    N_Y,
    N_Z,
    L_C,
    SNAP,
    INTEG,
    ALPHA,
    BETA
};
// 1-based STATEV indices; then come blocks of eight, one a crack: n, u, G, phase.
enum Slot { J = 1, W, DAMAGE, LENGTH, FIRST_CRACK, CRACK_SIZE = 8, NORMAL = 0, JUMP = 3, ENERGY = 6, PHASE = 7 };

inline constexpr lode_parameter parameters[] = {
    required("E", "Young's modulus", "stress", above(0.0)),
    required("NU", "Poisson's ratio", "-", inside(-1.0, 0.5)),
    required("TAU_NF", "tensile strength", "stress", above(0.0)),
    required("TAU_SF", "shear strength at zero normal traction", "stress", above(0.0)),
    required("TAU_SM", "shear strength at large mean pressure", "stress", above(0.0), "at least TAU_SF"),
    required("F_C", "uniaxial compressive strength, positive", "stress", above(0.0)),
    required("G_F", "mode I fracture energy of one crack", "stress*length", above(0.0)),
    optional_or_zero("F_B", "equibiaxial compressive strength, positive", "stress", above(0.0), 0.0,
                     "0: 1.16 F_C; else above F_C/2"),
    optional("C_N", "coupling of normal traction and lateral stress", "-", at_least(0.0), 0.2),
    optional("C_S", "coupling in the denominator of the brittleness", "-", at_least(0.0), 0.1),
    optional("C_PSI", "curvature of the shear strength over pressure", "-", at_least(0.0), 5.0),
    optional("CRIT", "decohesion function", "code", code(0, 1), 0.0,
             "0 full; 1 Rankine in the normal traction, shear is kept until failure"),
    optional("SOFT", "softening", "code", code(0, 1), 0.0, "0 linear; 1 exponential"),
    optional("N_C", "largest number of cracks", "-", code(0, 20), 3.0, "0: elastic. NSTATV must be 4 + 8 N_C"),
    optional("ALPHA_TH", "smallest angle between crack normals", "degree", between(0.0, 90.0), 30.0),
    optional("MU", "friction coefficient of a failed, closed crack", "-", at_least(0.0), 0.0),
    optional("N_X", "prescribed crack normal, along 11", "-", any_value(), 0.0,
             "(0, 0, 0): the critical plane is searched; else N_C = 1"),
    optional("N_Y", "prescribed crack normal, along 22", "-", any_value(), 0.0),
    optional("N_Z", "prescribed crack normal, along 33", "-", any_value(), 0.0),
    optional("L_C", "smearing length", "length", at_least(0.0), 0.0, "0: the element length of the host"),
    optional("SNAP", "element too large", "code", code(0, 1), 0.0, "0 refused; 1 the tensile strength is lowered"),
    optional("INTEG", "integration", "code", code(0, 10000), 0.0,
             "0 backward Euler; 1 cutting plane; n: backward Euler in n substeps"),
    optional("ALPHA", "linear thermal expansion", "1/temp", any_value(), 0.0),
    optional("BETA", "linear expansion per unit of field 1", "1/field", any_value(), 0.0),
};

inline constexpr lode_state states[] = {
    {"J", "number of cracks", 0.0},
    {"W", "dissipated energy per volume", 0.0},
    {"D", "largest 1 - f over the cracks", 0.0},
    {"LC", "smearing length, frozen when the first crack starts", 0.0},
    {"N1X", "normal of crack 1, along 11", 0.0},
    {"N1Y", "normal of crack 1, along 22", 0.0},
    {"N1Z", "normal of crack 1, along 33", 0.0},
    {"U1X", "displacement jump of crack 1, along 11", 0.0},
    {"U1Y", "displacement jump of crack 1, along 22", 0.0},
    {"U1Z", "displacement jump of crack 1, along 33", 0.0},
    {"G1", "energy dissipated per area of crack 1", 0.0},
    {"PHASE1", "0 none, 1 softening, 2 failed and open, 3 failed and closed", 0.0},
    {"N2X", "normal of crack 2; cracks 3 to N_C follow in the same way", 0.0},
    {"N2Y", "normal of crack 2", 0.0},
    {"N2Z", "normal of crack 2", 0.0},
    {"U2X", "displacement jump of crack 2", 0.0},
    {"U2Y", "displacement jump of crack 2", 0.0},
    {"U2Z", "displacement jump of crack 2", 0.0},
    {"G2", "energy dissipated per area of crack 2", 0.0},
    {"PHASE2", "as PHASE1", 0.0},
};

// N, mm.
inline constexpr double concrete[] = {24900.0, 0.18, 2.7, 14.9, 90.0, 42.7, 0.06135};
inline constexpr double wall[] = {24900.0, 0.18, 2.7,  14.9, 90.0, 42.7, 0.06135, 0.0, 0.2, 0.1, 5.0, 0,
                                  1,       2,    45.0, 0.0,  0.0,  0.0,  0.0,     0.0, 0,   0,   1e-5};
inline constexpr double soft_rock[] = {24900.0, 0.18, 2.7,  5.0, 20.0, 42.7, 0.06135, 45.0, 0.2, 0.1, 5.0,  0,
                                       0,       1,    30.0, 0.6, 0.0,  0.0,  0.0,     0.0,  0,   4,   1e-5, 1e-3};
inline constexpr double joint[] = {24900.0, 0.18, 2.7, 14.9, 90.0, 42.7, 0.06135, 0.0, 0.2, 0.1,
                                   5.0,     0,    0,   1,    30.0, 0.6,  1.0,     0.0, 0.0, 2.0};
inline constexpr double rankine[] = {24900.0, 0.18, 2.7, 14.9, 90.0, 42.7, 0.06135, 0.0, 0.2, 0.1,
                                     5.0,     1,    0,   1,    30.0, 0.0,  0.0,     0.0, 0.0, 4.0};
inline constexpr lode_sample samples[] = {
    {"CONCRETE", "concrete, up to three cracks on searched planes, N, mm", concrete, count_of(concrete), 2e-4,
     LODE_SOLID},
    {"WALL", "concrete, exponential softening, two cracks at least 45 degrees apart, thermal expansion, N, mm, 1/K",
     wall, count_of(wall), 3e-4, LODE_PLANE_STRAIN | LODE_PLANE_STRESS},
    {"ROCK", "weak in shear: inclined planes; friction, four substeps, expansion by heat and by field 1, N, mm, 1/K",
     soft_rock, count_of(soft_rock), 2e-4, LODE_SOLID},
    {"JOINT", "a plane of weakness across axis 1, friction when closed, N, mm", joint, count_of(joint), 3e-4,
     LODE_SOLID | LODE_PLANE_STRAIN | LODE_PLANE_STRESS},
    {"RANKINE", "one crack by the normal traction alone, N, mm", rankine, count_of(rankine), 3e-4, continuum_kinds},
};

inline constexpr lode_algorithm algorithms[] = {
    {"backward Euler, start of a crack located in the increment", INTEG, 0.0, 1.0},
    {"cutting plane of the source", INTEG, 1.0, 1.0},
    {"backward Euler in 4 substeps", INTEG, 4.0, 1.0},
};

inline constexpr lode_model description = {
    .keyword = "ELASTIC_DECOHESIVE",
    .title = "Elastic decohesive material with several fixed cracks",
    .family = "decohesive",
    .purpose =
        "Concrete, rock, ice: linear elastic until a decohesion function of traction and stress says on which plane a "
        "crack starts; the crack is smeared over the element and softens in opening and shear.",
    .source = "Sanchez, sections 2.3-2.4, 3.5.2-3.5.4, 4.5, 5.2.1, 5.5 and appendix C",
    .kinds = continuum_kinds,
    .traits = LODE_UNSYMMETRIC | LODE_ROTATES_STATE | LODE_USES_CELENT | LODE_OPEN_ENERGY | LODE_ITERATES,
    .parameters = parameters,
    .parameter_count = count_of(parameters),
    .required_count = 7,
    .state = states,
    .state_count = count_of(states),
    .samples = samples,
    .sample_count = count_of(samples),
    .algorithms = algorithms,
    .algorithm_count = count_of(algorithms),
    .limits =
        "- The source's function turns back far in tension (its F becomes negative beyond 8 times the tensile strength "
        "of concrete) and divides by zero at a mean stress of 2 TAU_NF: it is continued smoothly, which leaves the "
        "failure surface as it is.\n"
        "- Snap-back: an element length of 2 G_F E_1/TAU_NF^2 or more (half of it with exponential softening) has no "
        "unique answer. It is refused with the limiting value; SNAP = 1 lowers TAU_NF instead and keeps G_F. A "
        "structure may snap back below that length: a bar with one crack when longer than E u_0/TAU_NF.\n"
        "- L_C must be the width that localises. If k columns of points of one cell soften together, that is the cell "
        "size, not a k-th of it; else k times G_F is dissipated.\n"
        "- Softening loses ellipticity at once: only the dissipated energy is independent of the mesh, and cracks "
        "oblique to it lock.\n"
        "- Several cracks: at L_C above 4 G G_F sin^2(angle)/TAU_NF^2 the split of the opening between two cracks is "
        "not unique and the first takes everything (one warning for the angle ALPHA_TH). No convergence of the "
        "coupled cracks: UMAT asks for half the increment, VUMAT goes on with a warning. A large ALPHA_TH leaves "
        "directions without any limit of the stress.\n"
        "- Failure in mixed mode drops the shear traction to friction at one instant, and a crack that ALPHA_TH has "
        "held back starts above its strength: the energy of such drops is in none of SSE, SPD, SCD. Axial splitting "
        "(no traction on the plane) does not soften before it fails: use dynamics or lateral "
        "confinement.\n"
        "- The dissipation of a crack that opens against compression with little shear is negative; it is neither "
        "clamped nor refused.\n"
        "- Equal principal stresses leave the normal open: a fixed rule decides, and a small perturbation changes the "
        "pattern. In the plane kinds cracks are in the plane or across axis 3 (plane strain), never oblique.\n"
        "- Unloading keeps the opening; a half-open crack is fully stiff in compression. Not for cyclic loading.\n"
        "- INTEG = 1: a step that jumps far outside keeps its error; where the method breaks down UMAT asks for half "
        "the increment.\n",
};

}  // namespace lode::elastic_decohesive
