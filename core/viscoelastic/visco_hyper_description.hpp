// PROPS, STATEV and samples of VISCO_HYPER (page 60, section 3).
#pragma once

#include "lode/hyperelastic/dilatational_energy.hpp"
#include "lode/material/kind.hpp"
#include "lode/viscoelastic/prony_series.hpp"
#include "lode/viscoelastic/reduced_time.hpp"

namespace lode::visco_hyper {

// 1-based PROPS indices before the Prony terms.
enum Property { G1 = 1, K, G2, NG, FIRST_TERM };
// Behind them, counted from the first entry there.
enum Option { ALPHA = 0, BETA, UJ, METH, SHIFTS };
// 1-based STATEV indices.
enum Slot { ERES = 1, TR, DISS, F33M1, ELASTIC, FIRST_ELEMENT = ELASTIC + 6 };

inline constexpr int NG_NUMBER = 4, METH_NUMBER = 10;  // in the table

inline constexpr auto& shift = ReducedTime::parameters;
inline constexpr lode_parameter parameters[] = {
    required("G1", "instantaneous first shear constant", "stress", at_least(0.0)),
    required("K", "bulk modulus", "stress", above(0.0)),
    required("G2", "instantaneous second shear constant", "stress", at_least(0.0), "G1 + G2 must be > 0"),
    required("NG", "number of terms", "-", code(0, most_prony_terms)),
    repeated(NG_NUMBER, required("gk", "share of the instantaneous shear modulus in a term", "-", at_least(0.0),
                                 "the sum must be < 1")),
    repeated(NG_NUMBER, required("tauk", "relaxation time of a term", "time", above(0.0))),
    optional("ALPHA", "thermal expansion", "1/temp", any_value(), 0.0),
    optional("BETA", "expansion per unit of field 1", "1/field", any_value(), 0.0),
    dilatational_option(0.0),
    recursion_option(1, "0 constant rate; 1 midpoint"),
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
};

inline constexpr lode_state states[] = {
    {"EPSRES", "residual strain, logarithm of the free stretch", 0.0},
    {"TR", "reduced time", 0.0},
    {"DISS", "dissipated energy per current volume", 0.0},
    {"F33M1", "total thickness stretch - 1, plane stress only", 0.0},
    {"T1", "instantaneous stress 11 at the end, in the reference frame", 0.0},
    {"T2", "instantaneous stress 22", 0.0},
    {"T3", "instantaneous stress 33", 0.0},
    {"T4", "instantaneous stress 12", 0.0},
    {"T5", "instantaneous stress 13, 3D", 0.0},
    {"T6", "instantaneous stress 23, 3D", 0.0},
};

inline constexpr double rubber[] = {0.4, 200, 0.1, 3, 0.2, 0.1, 0.15, 1, 0.1, 10};
inline constexpr double silicone[] = {0.3, 6, 0, 1, 0.5, 0.8, 0, 0, 1, 1};
inline constexpr double gel[] = {0.2, 10, 0.3,  2,     0.3, 0.5,  0.2, 4,    2e-4, 3e-3, 2, 0,
                                 1,   10, 8.86, 101.6, 1,   0.02, 1,   0.06, 10,   -2,   3};
inline constexpr unsigned served = LODE_SOLID | LODE_PLANE_STRAIN | LODE_PLANE_STRESS;
inline constexpr lode_sample samples[] = {
    {"RUBBER", "natural rubber, three terms, MPa, s", rubber, count_of(rubber), 0.4, served},
    {"SILICONE", "soft silicone without second constant, midpoint recursion, U = K/2 (J - 1)^2, MPa, s", silicone,
     count_of(silicone), 0.3, served},
    {"GEL", "swelling gel with shifts by temperature and moisture, U = K/2 (ln J)^2, MPa, s, degrees Celsius", gel,
     count_of(gel), 0.3, served},
};

inline constexpr lode_algorithm algorithms[] = {
    {"constant rate of the instantaneous stress in the increment", METH_NUMBER, 0.0, 2.0},
    {"midpoint", METH_NUMBER, 1.0, 2.0},
};

inline constexpr lode_model description = {
    .keyword = "VISCO_HYPER",
    .title = "Viscoelastic Mooney-Rivlin solid at finite strain",
    .family = "viscoelastic",
    .purpose =
        "Rubber that relaxes at finite strain: the isochoric part of a Mooney-Rivlin solid relaxes as a Prony series, "
        "the volume responds elastically. STATEV goes on after entry 10 with the stress H_k of each term, tensor "
        "components 11, 22, 33, 12, 13, 23 in the reference frame: 10 + 6 NG in all.",
    .source = "Nairn, chapter 10, sections 10.1.10 and 10.1.11",
    .kinds = served,
    .traits = LODE_FINITE_STRAIN | LODE_HISTORY_STRESS | LODE_ENERGY_ESTIMATE | LODE_ITERATES,
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
        "- Geometric non-linearity is required; without it the host passes F = I and the stress stays zero.\n"
        "- det F <= 0 or a deformation that is not finite asks for a smaller increment.\n"
        "- A local orientation of continuum elements (*ORIENTATION) must not be used: DFGRD1 then comes in a basis "
        "that "
        "turns with the material, the stored H_k no longer match it, and the model cannot see that. An isotropic "
        "material needs no orientation.\n"
        "- UJ = 2: the bulk tangent is <= 0 where J over the free volume ratio >= e.\n"
        "- Strongly non-proportional large strain: the pushed-forward stress of a frozen H is not free of stress in "
        "turned principal axes. The model is Simo's linear overlay; its dissipation is not negative near equilibrium "
        "only, and SSE and SCD are estimates.\n"
        "- METH = 2, 3 of VISCOELASTIC are refused.\n"
        "- Absolute T <= 0 (Arrhenius), CC2 + c <= 0 or 1/a_mu <= 0 end the analysis with a message. At and below the "
        "pole TREF - C2 of WLF time stands still.\n"
        "- DDSDDT holds the free expansion; what temperature does to the shifts is left out.\n"
        "- The residual strain accumulates from the first call: the state there is free of it.\n",
};

}  // namespace lode::visco_hyper
