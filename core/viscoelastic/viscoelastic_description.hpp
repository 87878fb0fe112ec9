// PROPS, STATEV and samples of VISCOELASTIC (page 60, section 2).
#pragma once

#include "lode/material/kind.hpp"
#include "lode/viscoelastic/prony_series.hpp"
#include "lode/viscoelastic/reduced_time.hpp"

namespace lode::viscoelastic {

// 1-based PROPS indices before the Prony terms.
enum Property { K0 = 1, G0, NG, NK, FIRST_TERM };
// Behind them, counted from the first entry there.
enum Option { ALPHA = 0, BETA, METH, PLAW, SHIFTS, NBT = SHIFTS + ReducedTime::constant_count, NBC, FIRST_POINT };
// 1-based STATEV indices.
enum Slot { EPS = 1, ERES = 7, TR, DISS, JM1, JRESM1, FIRST_ELEMENT };

inline constexpr int NG_NUMBER = 3, NK_NUMBER = 4, METH_NUMBER = 11, NBT_NUMBER = 24, NBC_NUMBER = 25;  // in the table
inline constexpr int most_points = 50;

inline constexpr auto& shift = ReducedTime::parameters;
inline constexpr lode_parameter parameters[] = {
    required("K0", "long-time bulk modulus", "stress", above(0.0)),
    required("G0", "long-time shear modulus", "stress", at_least(0.0), "G0 + sum of Gk must be > 0"),
    required("NG", "number of shear terms", "-", code(0, most_prony_terms)),
    required("NK", "number of bulk terms", "-", code(0, most_prony_terms), "0 where PLAW > 0"),
    repeated(NG_NUMBER, required("Gk", "shear modulus of a term", "stress", at_least(0.0))),
    repeated(NG_NUMBER, required("tauk", "relaxation time of a shear term", "time", above(0.0))),
    repeated(NK_NUMBER, required("Kk", "bulk modulus of a term", "stress", at_least(0.0))),
    repeated(NK_NUMBER, required("tauKk", "relaxation time of a bulk term", "time", above(0.0))),
    optional("ALPHA", "thermal expansion", "1/temp", any_value(), 0.0),
    optional("BETA", "expansion per unit of field 1", "1/field", any_value(), 0.0),
    recursion_option(3,
                     "0 constant strain rate; 1 midpoint; 2 trapezoidal; 3 explicit. Terms with dtr > tau take 0 "
                     "instead of 2 and 3"),
    optional("PLAW", "pressure law", "code", code(0, 3), 0.0,
             "0 linear; -P = 1 K0/2 (J - 1/J), 2 K0 (J - 1), 3 K0 ln(J)/J with J over the ratio of free expansion"),
    shift[ReducedTime::TSHIFT],
    shift[ReducedTime::TREF],
    shift[ReducedTime::C1],
    shift[ReducedTime::C2],
    shift[ReducedTime::CSHIFT],
    shift[ReducedTime::CREF],
    shift[ReducedTime::CC1],
    shift[ReducedTime::CC2],
    shift[ReducedTime::TAUMS],
    shift[ReducedTime::C5],
    shift[ReducedTime::DTRM],
    optional("NBT", "points of the vertical shift b_T(T)", "-", code(0, most_points), 0.0),
    optional("NBC", "points of the vertical shift b_c(c)", "-", code(0, most_points), 0.0),
    repeated(NBT_NUMBER, required("T", "temperature of a point of b_T", "temp", any_value(), "increasing")),
    repeated(NBT_NUMBER, required("bT", "b_T there", "-", above(0.0), "straight in between, constant outside")),
    repeated(NBC_NUMBER, required("c", "concentration of a point of b_c", "field", any_value(), "increasing")),
    repeated(NBC_NUMBER, required("bc", "b_c there", "-", above(0.0), "straight in between, constant outside")),
};

inline constexpr lode_state states[] = {
    {"EPS1", "total strain 11", 0.0},
    {"EPS2", "total strain 22; found by the model in 1D", 0.0},
    {"EPS3", "total strain 33; found by the model in plane stress and 1D", 0.0},
    {"EPS4", "total shear strain 12 (engineering)", 0.0},
    {"EPS5", "total shear strain 13 (engineering), 3D", 0.0},
    {"EPS6", "total shear strain 23 (engineering), 3D", 0.0},
    {"ERES", "free linear strain, the sum of ALPHA dT + BETA dc", 0.0},
    {"TR", "reduced time", 0.0},
    {"DISS", "dissipated energy per volume", 0.0},
    {"JM1", "volume ratio - 1 (PLAW > 0)", 0.0},
    {"JRESM1", "volume ratio of free expansion - 1 (PLAW > 0)", 0.0},
};

inline constexpr double polymer[] = {2000, 300, 3, 0, 200, 0.1, 150, 1, 100, 10};
inline constexpr double epoxy[] = {3000, 100, 3, 3, 500, 0.02, 400, 0.3, 300, 5, 800, 0.05, 500, 1, 300, 20, 6e-5,
                                   0,    1,   0, 0, 0,   1,    1,   0,   0,   1, 1,   0,    0,   0, 0,   0};
inline constexpr double wood[] = {1000, 300, 2,  1,    200,   0.5, 100,  5, 400,  2,   3e-5, 0.2, 0,
                                  0,    1,   10, 8.86, 101.6, 1,   0.02, 1, 0.06, 10,  -2,   3,   3,
                                  2,    0,   1,  40,   0.8,   80,  0.4,  0, 1,    0.2, 0.7};
inline constexpr double foam[] = {50, 10, 2, 0, 20, 0.2, 10, 3, 1e-4, 0, 0, 1};
inline constexpr double bitumen[] = {2000, 0, 2, 0, 300, 2, 100, 40, 0, 0, 2, 0};
inline constexpr double explicit_polymer[] = {1000, 300, 2, 0, 200, 3, 100, 20, 0, 0, 3, 3};
inline constexpr lode_sample samples[] = {
    {"POLYMER", "amorphous polymer, three shear terms, MPa, s", polymer, count_of(polymer), 0.01, continuum_kinds},
    {"EPOXY", "cured resin, three shear and three bulk terms, midpoint recursion, MPa, s", epoxy, count_of(epoxy), 0.01,
     continuum_kinds},
    {"WOOD", "shifts by temperature and moisture, mechanosorption, vertical shifts, expansion, MPa, s, degrees Celsius",
     wood, count_of(wood), 0.005, continuum_kinds},
    {"FOAM", "nonlinear pressure, MPa, s", foam, count_of(foam), 0.05, continuum_kinds},
    {"BITUMEN", "fluid in the long run, trapezoidal recursion, MPa, s", bitumen, count_of(bitumen), 0.005,
     continuum_kinds},
    {"EXPLICIT", "explicit Maxwell elements, logarithmic pressure law, MPa, s", explicit_polymer,
     count_of(explicit_polymer), 0.02, continuum_kinds},
};

inline constexpr lode_algorithm algorithms[] = {
    {"constant strain rate in the increment", METH_NUMBER, 0.0, 2.0},
    {"midpoint", METH_NUMBER, 1.0, 2.0},
    {"trapezoidal rule of the hereditary integral", METH_NUMBER, 2.0, 2.0},
    {"explicit Maxwell elements", METH_NUMBER, 3.0, 1.0},
};

inline constexpr lode_model description = {
    .keyword = "VISCOELASTIC",
    .title = "Isotropic linear viscoelasticity",
    .family = "viscoelastic",
    .purpose =
        "Polymers, wood and any isotropic solid at small strain whose moduli relax as Prony series in shear and in "
        "volume, with shifts of time and of moduli by temperature and moisture and an optional nonlinear pressure. "
        "STATEV goes on after entry 11 with the elastic deviatoric strain of each shear element (11, 22, 33, and "
        "engineering shears 12, 13, 23) and the elastic volumetric strain of each bulk element: 11 + 6 NG + NK in all.",
    .source = "Nairn, chapter 10 (eqs. 10.1-10.30)",
    .kinds = continuum_kinds,
    .traits = LODE_ROTATES_STATE | LODE_ITERATES,
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
        "- METH = 2 has a wrong relaxed state (8 % of the element's strain at dtr = tau), METH = 3 oscillates for dtr "
        "> "
        "tau and diverges for dtr > 2 tau: elements with dtr > tau are integrated by METH = 0 instead.\n"
        "- METH = 0 is exact for a strain that is linear in time. Plane stress and 1D are of second order all the "
        "same, "
        "because the lateral strain is not (relaxation in 8 increments: 3e-4).\n"
        "- A step of strain inside an increment counts as a ramp: use a short increment.\n"
        "- WLF: at and below TREF - C2, the pole, time stands still (dtr = 0). Above TREF dtr grows by decades with "
        "the "
        "temperature: steps of many degrees want DTRM = 3, the other rules are off by the fourth part and more. The "
        "increment is taken as it comes.\n"
        "- Absolute T <= 0 (Arrhenius), CC2 + c <= 0 or 1/a_mu <= 0 end the analysis with a message.\n"
        "- G0 = 0 is a fluid: in increments much longer than the relaxation times DDSDDE loses its shear part and the "
        "host must supply stiffness.\n"
        "- PLAW = 2: -P stays above -K0 as J -> 0, a finite resistance against crushing. PLAW = 3: the pressure has "
        "its "
        "extreme K0/e at J/Jres = e; from there on a smaller increment is asked for.\n"
        "- Vertical shifts that vary with time change the stored energy: SSE + SCD is then not the stress work. The "
        "shift acts on the total stress, so that also a held strain answers to it.\n"
        "- DDSDDT holds the free expansion; what temperature does to the shifts is left out. RPL is zero.\n"
        "- A first explicit call answers with the instantaneous moduli times the largest vertical shift, which makes "
        "the time increment safe.\n"
        "- The strain measure is the host's: the deviator is hypoelastic under large strain.\n",
};

}  // namespace lode::viscoelastic
