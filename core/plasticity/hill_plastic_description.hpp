// PROPS, STATEV and samples of HILL_PLASTIC (page 20, section 5).
#pragma once

#include "lode/material/description.hpp"
#include "lode/material/kind.hpp"

namespace lode::hill_plastic {

// 1-based PROPS indices; TABS is the first of the thermal block.
enum Property {
    E1 = 1,
    Y11 = 10,
    STYLE = 16,
    HLAW,
    H1,
    A1 = 23,
    B1 = 26,
    TABS = 29,
    ROTMODE = 33,
    ANGZ,
    ANGY,
    ANGX,
    METHOD,
    NSUB
};
// 1-based STATEV indices; 5-10 are the thermal block's, 11-16 the plastic strain.
enum Slot { EQPS = 1, GREL, EQPE, MU, Q = 17 };

inline constexpr lode_parameter parameters[] = {
    required("E1", "Young's modulus along axis 1", "stress", above(0.0)),
    required("E2", "Young's modulus along axis 2", "stress", above(0.0)),
    required("E3", "Young's modulus along axis 3", "stress", above(0.0)),
    required("NU12", "Poisson's ratio, -eps2/eps1 under stress along 1", "-", any_value(),
             "the compliance must be positive definite"),
    required("NU13", "Poisson's ratio, -eps3/eps1 under stress along 1", "-", any_value()),
    required("NU23", "Poisson's ratio, -eps3/eps2 under stress along 2", "-", any_value()),
    required("G12", "shear modulus in the plane 12", "stress", above(0.0)),
    required("G13", "shear modulus in the plane 13", "stress", above(0.0)),
    required("G23", "shear modulus in the plane 23", "stress", above(0.0)),
    required("Y11", "yield stress along axis 1", "stress", at_least(0.0), "0: never yields in this mode"),
    required("Y22", "yield stress along axis 2", "stress", at_least(0.0)),
    required("Y33", "yield stress along axis 3", "stress", at_least(0.0)),
    required("Y12", "shear yield stress in the plane 12", "stress", at_least(0.0)),
    required("Y13", "shear yield stress in the plane 13", "stress", at_least(0.0)),
    required("Y23", "shear yield stress in the plane 23", "stress", at_least(0.0)),
    optional_or_zero("STYLE", "hardening variable", "code", code(1, 2), 2.0,
                     "1 square-root form: dalpha = lambda/sigma_ref; 2 squared form: dalpha = sqrt(2/3) abs(dep)"),
    optional("HLAW", "hardening law of g, relative to 1", "code", code(0, 8), 0.0,
             "0 perfect; 1 linear: slope; 2: (1 + H1 x)^H2; 6: 1 + H1 x^H2; 8 saturation: range, rate, linear part, "
             "strain from which it goes on straight"),
    optional("H1", "constant 1 of the law", "by law", any_value(), 0.0),
    optional("H2", "constant 2 of the law", "by law", any_value(), 0.0),
    optional("H3", "constant 3 of the law", "by law", any_value(), 0.0),
    optional("H4", "constant 4 of the law", "by law", any_value(), 0.0),
    optional("H5", "constant 5 of the law", "by law", any_value(), 0.0),
    optional("A1", "thermal expansion along axis 1", "1/temp", any_value(), 0.0),
    optional("A2", "thermal expansion along axis 2", "1/temp", any_value(), 0.0),
    optional("A3", "thermal expansion along axis 3", "1/temp", any_value(), 0.0),
    optional("B1", "moisture expansion along axis 1 per unit of field 1", "-", any_value(), 0.0),
    optional("B2", "moisture expansion along axis 2 per unit of field 1", "-", any_value(), 0.0),
    optional("B3", "moisture expansion along axis 3 per unit of field 1", "-", any_value(), 0.0),
    optional("TABS", "offset to absolute temperature", "temp", any_value(), 0.0, "273.15 for degrees Celsius"),
    optional("RHOCV", "heat capacity per volume at constant volume", "stress/temp", at_least(0.0), 0.0),
    optional("CHI", "plastic heat: 0 source rule, (0,1] fraction of the plastic work, -1 none", "-", between(-1.0, 1.0),
             0.0),
    optional("TMODE", "thermal mode", "code", code(0, 3), 0.0,
             "0 the host's temperature, RPL = plastic heat; 1 the same with thermoelastic heat; 2 self-adiabatic, "
             "plastic heat; 3 self-adiabatic, plastic and thermoelastic heat"),
    optional("ROTMODE", "where the material axes are", "code", code(0, 1), 0.0,
             "0: components come in material axes (host orientation); 1: axes from ANGZ, ANGY, ANGX, turned with DROT"),
    optional("ANGZ", "turn of the material axes about host axis 3", "degrees", any_value(), 0.0,
             "R0 = Rz(ANGZ) Ry(ANGY) Rx(ANGX); its columns are the material axes"),
    optional("ANGY", "turn about host axis 2", "degrees", any_value(), 0.0, "3D only"),
    optional("ANGX", "turn about host axis 1", "degrees", any_value(), 0.0, "3D only"),
    optional("METHOD", "integration", "code", code(0, 2), 0.0,
             "0: one backward Euler step; 2: NSUB equal backward Euler substeps"),
    optional_or_zero("NSUB", "substeps of METHOD 2", "-", code(1, 1000), 10.0),
};

inline constexpr lode_state states[] = {
    {"EQPS", "hardening variable alpha of the style; may start above 0", 0.0},
    {"GREL", "relative yield stress g(alpha) at the end", 0.0},
    {"EQPE", "sum of sqrt(2/3) abs(dep)", 0.0},
    {"MU", "multiplier of the last increment, dep = mu A sigma", 0.0},
    {"TAD", "accumulated self-heating (TMODE 2, 3)", 0.0},
    {"DTAD", "last increment of TAD", 0.0},
    {"ASTOR", "stored plastic energy per volume", 0.0},
    {"PHI", "plastic work turned into heat per volume", 0.0},
    {"HEATQ", "heat received from outside per volume", 0.0},
    {"ENTR", "entropy per volume relative to the start", 0.0},
    {"EP1", "plastic strain 11, host axes", 0.0},
    {"EP2", "plastic strain 22, host axes", 0.0},
    {"EP3", "plastic strain 33, host axes", 0.0},
    {"EP4", "plastic shear strain 12 (engineering), host axes", 0.0},
    {"EP5", "plastic shear strain 13 (engineering), host axes, 3D", 0.0},
    {"EP6", "plastic shear strain 23 (engineering), host axes, 3D", 0.0},
    {"Q11", "rotation Q of the host since the start (ROTMODE 1, implicit host); all zero means I", 0.0},
    {"Q12", "", 0.0},
    {"Q13", "", 0.0},
    {"Q21", "", 0.0},
    {"Q22", "", 0.0},
    {"Q23", "", 0.0},
    {"Q31", "", 0.0},
    {"Q32", "", 0.0},
    {"Q33", "", 0.0},
};

inline constexpr double sheet[] = {70000.0, 70000.0, 70000.0, 0.33, 0.33, 0.33, 26316.0, 26316.0, 26316.0, 126.0, 131.0,
                                   140.0,   72.0,    74.0,    74.0, 2,    1,    4.0,     0.0,     0.0,     0.0,   0.0,
                                   0.0,     0.0,     0.0,     0.0,  0.0,  0.0,  0.0,     0.0,     0.0,     0,     1};
inline constexpr double spruce[] = {12000.0, 900.0, 500.0, 0.4, 0.5,    0.6, 800.0, 700.0, 60.0, 0.0, 6.0,  6.0,
                                    8.0,     8.0,   2.5,   1,   8,      0.8, 40.0,  2.0,   0.0,  0.0, 5e-6, 3e-5,
                                    4e-5,    0.01,  0.17,  0.3, 273.15, 0.8, 0.9,   1,     1,    30.0};
inline constexpr double composite[] = {150000.0, 10000.0, 11000.0, 0.3,  0.28,  0.4,  5000.0, 4800.0, 3600.0, 800.0,
                                       60.0,     60.0,    50.0,    45.0, 30.0,  2,    2,      30.0,   0.4,    0.0,
                                       0.0,      0.0,     0.0,     0.0,  0.0,   0.0,  0.0,    0.0,    273.15, 1.6,
                                       0.0,      2,       1,       25.0, -15.0, 40.0, 2,      4};
inline constexpr double isotropic[] = {200000.0,
                                       200000.0,
                                       200000.0,
                                       0.3,
                                       0.3,
                                       0.3,
                                       76923.076923076922,
                                       76923.076923076922,
                                       76923.076923076922,
                                       400.0,
                                       400.0,
                                       400.0,
                                       230.94010767585033,
                                       230.94010767585033,
                                       230.94010767585033,
                                       1,
                                       6,
                                       2.0,
                                       0.5};
inline constexpr unsigned kinds = LODE_SOLID | LODE_PLANE_STRAIN | LODE_PLANE_STRESS;
inline constexpr lode_sample samples[] = {
    {"SHEET", "rolled aluminium sheet, linear hardening, squared form, MPa", sheet, count_of(sheet), 6e-3, kinds},
    {"SPRUCE",
     "softwood cut at 30 degrees, yielding across and in shear, square-root form, heat and moisture (TMODE 1), "
     "MPa, degrees Celsius",
     spruce, count_of(spruce), 0.02, kinds},
    {"COMPOSITE", "fibre composite in general axes, self-heating (TMODE 2), four substeps, MPa, degrees Celsius",
     composite, count_of(composite), 0.02, LODE_SOLID},
    {"ISOTROPIC", "the isotropic limit of steel with a power law, MPa", isotropic, count_of(isotropic), 6e-3, kinds},
};

inline constexpr lode_algorithm algorithms[] = {
    {"backward Euler along the common modes of elasticity and criterion", METHOD, 0.0, 1.0},
    {"NSUB backward Euler substeps", METHOD, 2.0, 1.0},
};

inline constexpr lode_model description = {
    .keyword = "HILL_PLASTIC",
    .title = "Hill plasticity of orthotropic solids",
    .family = "plasticity",
    .purpose =
        "Rolled sheet, wood and fibre composites: orthotropic elasticity and Hill's quadratic criterion in material "
        "axes, with two styles of isotropic hardening.",
    .source = "Nairn, chapter 2 (eqs. 2.104-2.139)",
    .kinds = kinds,
    .traits = LODE_UNSYMMETRIC | LODE_ROTATES_STATE | LODE_ITERATES,
    .parameters = parameters,
    .parameter_count = count_of(parameters),
    .required_count = 15,
    .state = states,
    .state_count = count_of(states),
    .samples = samples,
    .sample_count = count_of(samples),
    .algorithms = algorithms,
    .algorithm_count = count_of(algorithms),
    .limits =
        "- Yield stresses whose Hill matrix is not positive semidefinite (some 1/Ykk > 1/Yii + 1/Yjj or < "
        "abs(1/Yii - 1/Yjj)) are refused with the numbers: strong fibres force Y22 close to Y33. Two infinite (0) "
        "normal "
        "yield stresses and a finite third fail the same condition; with one infinite the other two must be equal; all "
        "three infinite means yield in shear only.\n"
        "- Yield stresses that differ by more than a factor 1e6 are refused: eigenvalues would be lost to rounding.\n"
        "- Softening laws are refused: the root would not be unique and the result would depend on the mesh.\n"
        "- The squared form under strong anisotropy and strong hardening may have several solutions: the one with the "
        "smallest multiplier is taken.\n"
        "- HLAW 6 with n < 1 has an infinite slope at alpha = 0: the bracketed solution has no trouble with it.\n"
        "- DDSDDE is symmetric for STYLE 1 or without hardening, unsymmetric otherwise.\n"
        "- ROTMODE 0 takes the axes of the host's components as they are: for an implicit host with large rotations "
        "and no "
        "orientation of its own use ROTMODE 1. In 2D elements only ANGZ may differ from 0.\n"
        "- ROTMODE 1 needs 25 state variables. An explicit host turns its frame with the material: Q is not used "
        "there.\n"
        "- A large non-radial increment is integrated to first order only: METHOD 2 or smaller increments.\n",
};

}  // namespace lode::hill_plastic
