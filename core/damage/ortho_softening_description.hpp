// PROPS, STATEV and samples of ORTHO_SOFTENING (page 30, section 2).
#pragma once

#include <array>

#include "lode/damage/softening_state.hpp"
#include "lode/material/kind.hpp"

namespace lode::ortho_softening {

// 1-based PROPS indices.
enum Property {
    E1 = 1,
    S1 = 10,
    GI1 = 13,
    LAW_I = 28,
    LAW_II,
    SURF,
    TIAXIS,
    MIX_I,
    MIX_II,
    A1_I,
    A2_I,
    A1_II,
    A2_II,
    FMIN,
    MU,
    ALPHA,
    BETA = 43,
    HFIX = 46,
    HPOL,
    DELFLAG
};

inline constexpr lode_parameter parameters[] = {
    required("E1", "Young's modulus, axis 1", "stress", above(0.0)),
    required("E2", "Young's modulus, axis 2", "stress", above(0.0)),
    required("E3", "Young's modulus, axis 3", "stress", above(0.0)),
    required("NU12", "Poisson's ratio 12", "-", any_value(), "NU_ij/E_i = NU_ji/E_j"),
    required("NU13", "Poisson's ratio 13", "-", any_value()),
    required("NU23", "Poisson's ratio 23", "-", any_value()),
    required("G12", "shear modulus 12", "stress", above(0.0)),
    required("G13", "shear modulus 13", "stress", above(0.0)),
    required("G23", "shear modulus 23", "stress", above(0.0)),
    required("S1", "tensile strength across planes normal to axis 1", "stress", at_least(0.0), "0: never fails"),
    required("T12", "shear strength of planes normal to axis 1 in direction 2", "stress", at_least(0.0)),
    required("T13", "shear strength of planes normal to axis 1 in direction 3", "stress", at_least(0.0)),
    required("GI1", "mode I toughness of planes normal to axis 1", "energy/area", above(0.0)),
    required("GII12", "shear toughness of planes normal to axis 1 in direction 2", "energy/area", above(0.0)),
    required("GII13", "shear toughness of planes normal to axis 1 in direction 3", "energy/area", above(0.0)),
    required("S2", "tensile strength across planes normal to axis 2", "stress", at_least(0.0)),
    required("T21", "shear strength of planes normal to axis 2 in direction 1", "stress", at_least(0.0)),
    required("T23", "shear strength of planes normal to axis 2 in direction 3", "stress", at_least(0.0)),
    required("GI2", "mode I toughness of planes normal to axis 2", "energy/area", above(0.0)),
    required("GII21", "shear toughness of planes normal to axis 2 in direction 1", "energy/area", above(0.0)),
    required("GII23", "shear toughness of planes normal to axis 2 in direction 3", "energy/area", above(0.0)),
    required("S3", "tensile strength across planes normal to axis 3", "stress", at_least(0.0)),
    required("T31", "shear strength of planes normal to axis 3 in direction 1", "stress", at_least(0.0)),
    required("T32", "shear strength of planes normal to axis 3 in direction 2", "stress", at_least(0.0)),
    required("GI3", "mode I toughness of planes normal to axis 3", "energy/area", above(0.0)),
    required("GII31", "shear toughness of planes normal to axis 3 in direction 1", "energy/area", above(0.0)),
    required("GII32", "shear toughness of planes normal to axis 3 in direction 2", "energy/area", above(0.0)),
    required("LAW_I", "softening law of all normal directions", "code", code(1, 6),
             "1 linear, 2 exponential, 3 smooth step, 4 cubic, 5 double exponential, 6 stretched exponential"),
    required("LAW_II", "softening law of all shear directions", "code", code(1, 6)),
    optional("SURF", "traction surface", "code", code(0, 4), 0.0,
             "0 cuboid, 1 cylinder, 2 ovoid, 3 coupled cuboid, 4 coupled cylinder"),
    optional("TIAXIS", "axis of transverse isotropy", "code", code(0, 3), 0.0,
             "0 orthotropic; else cracks that contain this axis may have any normal in the isotropic plane, with the "
             "constants of the lower-numbered other axis"),
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
    optional("ALPHA1", "thermal expansion, axis 1", "1/temp", any_value(), 0.0),
    optional("ALPHA2", "thermal expansion, axis 2", "1/temp", any_value(), 0.0),
    optional("ALPHA3", "thermal expansion, axis 3", "1/temp", any_value(), 0.0),
    optional("BETA1", "expansion per unit of field 1, axis 1", "1/field", any_value(), 0.0),
    optional("BETA2", "expansion per unit of field 1, axis 2", "1/field", any_value(), 0.0),
    optional("BETA3", "expansion per unit of field 1, axis 3", "1/field", any_value(), 0.0),
    optional("HFIX", "characteristic length", "length", at_least(0.0), 0.0, "0: the host's element length"),
    optional("HPOL", "what to do with too large an element", "code", code(0, 1), 0.0,
             "0 refuse it, 1 reduce the strength"),
    optional("DELFLAG", "STATUS of a failed point", "code", code(0, 1), 0.0,
             "1: it becomes 0, so that the host deletes the element"),
};

// The material axes follow the entries of all softening solids.
enum Slot { AXIS_1 = softening_state::count + 1, AXIS_2 = AXIS_1 + 3, count = AXIS_2 + 2 };

inline constexpr auto states = [] {
    std::array<lode_state, std::size_t{count}> all{};
    std::size_t i = 0;
    for (const lode_state& s : softening_state::states) all[i++] = s;
    all[i++] = {"A11", "material axis 1, component 1; zeros on entry mean the axes of the frame", 0.0};
    all[i++] = {"A12", "material axis 1, component 2", 0.0};
    all[i++] = {"A13", "material axis 1, component 3", 0.0};
    all[i++] = {"A21", "material axis 2, component 1", 0.0};
    all[i++] = {"A22", "material axis 2, component 2", 0.0};
    all[i++] = {"A23", "material axis 2, component 3", 0.0};
    return all;
}();

// N, mm, MPa. In the plane kinds a crack contains axis 3: see ISO_SOFTENING.
inline constexpr unsigned plane_kinds = LODE_PLANE_STRAIN | LODE_PLANE_STRESS;
inline constexpr double laminate[] = {30000.0, 8000.0, 8000.0, 0.3, 0.3, 0.4, 3500.0, 3500.0, 2500.0, 500.0,
                                      60.0,    60.0,   30.0,   2.0, 2.0, 40., 50.0,   45.0,   0.3,    0.8,
                                      0.9,     40.0,   50.0,   45., 0.3, 0.8, 0.9,    1,      1,      0};
inline constexpr double wood[] = {11000.0, 900.0, 500.0, 0.37, 0.42, 0.47, 690.0, 620.0, 36.0, 60.0, 9.0, 9.0,
                                  6.0,     1.2,   1.2,   4.0,  8.0,  2.5,  0.25,  0.8,   0.3,  3.0,  8.0, 2.5,
                                  0.2,     0.8,   0.3,   2,    3,    2,    0,     1.0,   1.0,  0.0,  0.0, 0.0,
                                  0.0,     1e-2,  0.3,   4e-6, 4e-5, 5e-5, 0.0,   0.0,   0.0,  1.5};
inline constexpr double ply[] = {
    30000.0, 8000.0, 8000.0, 0.3, 0.3, 0.4,  3500.0, 3500.0, 8000.0 / 2.8, 500.0, 60.0, 60.0, 30.0, 2.0, 2.0, 40.,
    50.,     45.,    0.3,    0.8, 0.9, 40.0, 50.0,   45.0,   0.3,          0.8,   0.9,  1,    2,    1,   1,   1.2,
    0.8,     0.0,    0.0,    0.0, 0.0, 0.01, 0.2,    1e-6,   3e-5,         3e-5,  0.0,  0.0,  0.0,  0.5};
inline constexpr double shale[] = {
    20000.0, 20000.0, 12000.0, 0.2, 0.25, 0.25, 20000.0 / 2.4, 5000.0, 5000.0, 8.0,    10.0, 9.0, 0.1, 0.3, 0.3, 8.0,
    10.0,    9.0,     0.1,     0.3, 0.3,  3.0,  6.0,           6.0,    0.05,   0.2,    0.2,  1,   1,   4,   3,   1.0,
    1.0,     0.0,     0.0,     0.0, 0.0,  0.01, 0.4,           1e-5,   1e-5,   1.5e-5, 0.0,  0.0, 0.0, 10.0};
inline constexpr lode_sample samples[] = {
    {"LAMINATE", "glass-fibre laminate, independent directions, N, mm", laminate, count_of(laminate), 2e-2, LODE_SOLID},
    {"WOOD", "spruce, ovoid surface, exponential and smooth laws, friction, N, mm, K", wood, count_of(wood), 3e-2,
     LODE_SOLID},
    {"PLY", "unidirectional ply, transversely isotropic about its fibres, cylinder, N, mm, K", ply, count_of(ply), 3e-2,
     LODE_SOLID},
    {"SHALE", "bedded rock, transversely isotropic about axis 3, coupled cylinder, N, mm, K", shale, count_of(shale),
     2e-3, LODE_SOLID},
    {"LAMINATE-2D", "the laminate in plane kinds", laminate, count_of(laminate), 2e-2, plane_kinds},
    {"WOOD-2D", "the wood in plane kinds", wood, count_of(wood), 3e-2, plane_kinds},
    {"SHALE-2D", "the bedded rock in plane kinds, any normal in the plane", shale, count_of(shale), 2e-3, plane_kinds},
};

inline constexpr lode_algorithm algorithms[] = {
    {"damage from the end strain: exact but for where in the increment a crack forms or fails", 0, 0.0, 1.0},
};

inline constexpr lode_model description = {
    .keyword = "ORTHO_SOFTENING",
    .title = "Orthotropic solid that softens on one crack plane",
    .family = "damage",
    .purpose =
        "Fibre composites, wood, bedded rock: as ISO_SOFTENING, with cracks on the planes of symmetry of the "
        "material or, in a transversely isotropic one, on any plane that contains its axis.",
    .source = "Nairn, chapter 5 (anisotropic damage mechanics)",
    .kinds = LODE_SOLID | LODE_PLANE_STRAIN | LODE_PLANE_STRESS,
    .traits = LODE_UNSYMMETRIC | LODE_ROTATES_STATE | LODE_USES_CELENT | LODE_ITERATES,
    .parameters = parameters,
    .parameter_count = count_of(parameters),
    .required_count = 29,
    .state = states.data(),
    .state_count = count,
    .samples = samples,
    .sample_count = count_of(samples),
    .algorithms = algorithms,
    .algorithm_count = count_of(algorithms),
    .limits =
        "- Elements larger than h_max = eta G C/strength^2 of any direction in use would snap back: refused with the "
        "largest legal size, or with HPOL = 1 the strength is reduced. An unknown element length is refused.\n"
        "- Only planes of symmetry can crack: elsewhere tension and shear are coupled and a failed crack would keep "
        "tractions. Principal directions of stress play no part but in the isotropic plane of TIAXIS.\n"
        "- Softening loses ellipticity from the first damaged increment; only the element length regularises it.\n"
        "- Laws 2, 5, 6 fail at FMIN: the stress jumps by FMIN times the strength, and the tail of the toughness "
        "beyond it is not dissipated.\n"
        "- The mixed-mode criterion drops all tractions at once. PNEWDT is never touched.\n"
        "- SURF 2-4 fail where the first of their laws ends, also for a direction that carries no load.\n"
        "- The plane belongs to the trial stress at the end of the increment in which the crack forms.\n"
        "- In the plane kinds the crack contains axis 3. One crack a point: stress along it is unbounded.\n"
        "- DDSDDE of an open failed crack is singular and returned as it is.\n",
};

}  // namespace lode::ortho_softening
