// What MIE_GRUNEISEN says about itself.
#pragma once

#include "lode/hyperelastic/dilatational_energy.hpp"

namespace lode::mie_gruneisen {

// 1-based PROPS indices.
enum Property { RHO0 = 1, C0, GAMMA0, S1, S2, S3, CV, T0, THERM, UJ, KMAX, G, HLAW, SY, H1, TREF = 24, YCAU, CHI, ORI };
// 1-based STATEV indices.
enum Slot { CPI11 = 1, CPI13 = 5, CPI23, ALPHA, TREL, ETA, PDISS, EINT, XFLAG };

inline constexpr lode_parameter parameters[] = {
    required("RHO0", "initial density", "mass/volume", above(0.0)),
    required("C0", "bulk wave speed", "length/time", above(0.0)),
    required("GAMMA0", "Grueneisen constant", "-", at_least(0.0)),
    required("S1", "Hugoniot slope", "-", at_least(0.0)),
    optional("S2", "second Hugoniot constant", "-", any_value(), 0.0),
    optional("S3", "third Hugoniot constant", "-", any_value(), 0.0),
    optional("CV", "heat capacity per mass", "energy/(mass temp)", at_least(0.0), 0.0, "0: isentrope only"),
    optional("T0", "stress-free absolute temperature", "temp", at_least(0.0), 0.0, "> 0 if THERM = 1 and CV > 0"),
    optional("THERM", "thermal mode", "code", code(0, 1), 0.0,
             "0: temperature from the host; 1: adiabatic, the model keeps the temperature"),
    optional("UJ", "dilatational energy in tension", "code", code(0, 2), 1.0,
             "with modulus k = RHO0 C0^2: 0 k/2 ((J^2 - 1)/2 - ln J), 1 k/2 (J - 1)^2, 2 k/2 (ln J)^2"),
    optional("KMAX", "limit of the Hugoniot bulk modulus over RHO0 C0^2", "-", any_value(), 0.0, "<= 1: none"),
    optional("G", "shear modulus", "stress", at_least(0.0), 0.0, "0: fluid"),
    optional("HLAW", "hardening law", "code", code(-1, 6), -1.0,
             "-1 none, elastic; 0 perfect; 1 linear: H1 = Ep; 2 SY (1 + H1 alpha)^H2; 3 Johnson-Cook: H1-H9 = B, n, C, "
             "EPS0, m, TMELT, D, n2, RMIN; 6 SY (1 + H1 alpha^H2)"),
    optional("SY", "initial yield stress", "stress", any_value(), 0.0, "> 0 unless HLAW = -1; A of law 3"),
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
    {"TREL", "temperature - T0", 0.0},
    {"ETA", "compression 1 - J", 0.0},
    {"PDISS", "plastic work per reference volume", 0.0},
    {"EINT", "thermal and volumetric internal energy per reference volume", 0.0},
    {"XFLAG", "1 where the compression is beyond the KMAX limit", 0.0},
};

inline constexpr unsigned served = LODE_SOLID | LODE_PLANE_STRAIN;
inline constexpr double copper[] = {8.93e-9, 3.94e6, 1.99, 1.489,   0.0, 0.0,   3.83e8, 300.0,
                                    1,       1,      0.0,  47700.0, 1,   120.0, 200.0};
inline constexpr double tungsten[] = {1.93e-8, 4.029e6, 1.54, 1.24,     0.0, 0.0,    1.32e8, 300.0,
                                      0,       0,       5.0,  160000.0, 2,   1000.0, 20.0,   0.2};
inline constexpr double steel[] = {7.85e-9, 4.57e6, 2.17,    1.49, 0.0,   0.0,   4.77e8, 300.0, 1,
                                   2,       0.0,    77000.0, 3,    350.0, 275.0, 0.36,   0.022, 1.0,
                                   1.0,     1811.0, 0.0,     0.0,  0.0,   293.0, 1.0,    0.9};
inline constexpr lode_sample samples[] = {
    {"COPPER", "copper, adiabatic, linear hardening, t, mm, s, K", copper, count_of(copper), 0.05, served},
    {"TUNGSTEN", "tungsten at the host's temperature, power law, stiffness limit, t, mm, s, K", tungsten,
     count_of(tungsten), 0.05, served},
    {"STEEL", "structural steel, adiabatic, Johnson-Cook, yield on Cauchy stress, t, mm, s, K", steel, count_of(steel),
     0.05, served},
};

inline constexpr lode_algorithm algorithms[] = {
    {"backward Euler, radial return: the pressure is a function of state", 0, 0.0, 1.0},
};

inline constexpr lode_model description = {
    .keyword = "MIE_GRUNEISEN",
    .title = "Shock equation of state with optional strength",
    .family = "eos",
    .purpose =
        "Solids and liquids under impact: Mie-Grueneisen pressure from the Hugoniot, isothermal, heated by the host or "
        "adiabatic, with a neo-Hookean deviator and J2 plasticity.",
    .source = "Nairn, chapter 9, section 9.10 (eqs. 9.94-9.115)",
    .kinds = served,
    .traits = LODE_FINITE_STRAIN | LODE_UNSYMMETRIC | LODE_HISTORY_STRESS | LODE_EQUATION_OF_STATE | LODE_ITERATES,
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
        "- Without KMAX the compression is limited by the pole of the Hugoniot (eta = 1/S1 if S2 = S3 = 0; copper "
        "0.672, tungsten 0.806) or by the point where the Hugoniot bulk modulus vanishes (2.56, -1.986, 0.2268: "
        "0.759): beyond it a smaller increment is asked for, an explicit analysis ends. With KMAX the modulus is held "
        "from where it reaches KMAX K0, one warning is given, and any compression below 1 is possible.\n"
        "- THERM = 0 with T0, CV > 0 refuses TEMP <= 0: temperatures are absolute.\n"
        "- THERM = 1 in a host that conducts heat counts it twice: use THERM = 0 with RPL there.\n"
        "- G = 0: no shear stiffness, an implicit system is singular without a small G.\n"
        "- CV and GAMMA0/V are constants: not for melting or vaporisation. Thermal expansion follows from them, "
        "3 alpha = RHO0 GAMMA0 CV/K0.\n"
        "- Tension with UJ = 2: the largest tension is K0/e, at J = e.\n"
        "- The pressure has no integration error; plastic flow is of first order in the increment.\n"
        "- Elastic shear energy is not part of EINT. SSE is the energy on the isentrope and in shear; an explicit host "
        "gets EINT and the shear energy as internal energy.\n",
};

}  // namespace lode::mie_gruneisen
