// PROPS, STATEV and samples of CAM_CLAY (page 70).
#pragma once

#include "lode/material/description.hpp"
#include "lode/material/kind.hpp"

namespace lode::cam_clay {

// 1-based PROPS indices.
enum Property { P_REF = 1, KAPPA, LAMBDA, M, MU0, ALPHA, PC0, PCMODE, P_INI, BIOT, ALPHA_T, NSUB, STOL, METHOD };
// How the equations of a backward Euler step are solved.
enum Method { SCALAR_EQUATION, NEWTON_FROM_TRIAL, NEWTON_FROM_START };
// 1-based STATEV indices; EE is the first of six tensor components, 11, 22, 33, 12, 13, 23 in UMAT and VUMAT.
enum Slot { INIT = 1, PC, EE, EPV = 9, ESP, P, Q, ZONE };

inline constexpr lode_parameter parameters[] = {
    required("p_ref", "reference pressure of the elastic law", "stress", above(0.0)),
    required("kappa", "elastic compressibility", "-", above(0.0), "natural strain per ln p; less than lambda"),
    required("lambda", "virgin compressibility", "-", above(0.0), "natural strain per ln p; more than kappa"),
    required("M", "slope of the critical state line", "-", inside(0.0, 3.0), "in the (p, q) plane"),
    required("mu0", "constant part of the shear modulus", "stress", at_least(0.0)),
    required("alpha", "pressure-proportional part of the shear modulus", "-", at_least(0.0),
             "mu = mu0 + alpha p_ref exp(v/kappa); mu0 + alpha > 0"),
    required("pc0", "preconsolidation pressure, or overconsolidation ratio", "stress or -", above(0.0),
             "pcmode 0: a pressure; pcmode 1: a ratio >= 1"),
    optional("pcmode", "meaning of pc0", "code", code(0, 1), 0.0, "0 pressure; 1 overconsolidation ratio"),
    optional_or_zero("p_ini", "initial effective pressure where the host gives no stress", "stress", above(0.0), 0.0,
                     "missing or 0: p_ref"),
    optional("biot", "Biot coefficient", "-", between(0.0, 1.0), 0.0,
             "the pore pressure is field 1, positive in compression"),
    optional("alphaT", "linear thermal expansion, drained", "1/temp", any_value(), 0.0),
    optional("nsub", "equal backward Euler substeps", "count", code(1, 1024), 1.0),
    optional("stol", "stress tolerance relative to pc", "-", at_least(0.0), 0.0,
             "> 0: substeps are doubled until the stress changes by less"),
    optional(
        "method", "solution of the step", "code", code(0, 2), 0.0,
        "0 one bracketed equation, never fails; 1 Newton on v, s, dgamma from the trial state, 2 from the old state"),
};
inline constexpr lode_state states[] = {
    {"init", "0 not initialised, 1 initialised", 0.0},
    {"pc", "preconsolidation pressure; > 0 on the first call overrides pc0", 0.0},
    {"ee11", "elastic strain, tensor component 11", 0.0},
    {"ee22", "elastic strain, tensor component 22", 0.0},
    {"ee33", "elastic strain, tensor component 33", 0.0},
    {"ee12", "elastic strain, tensor component 12", 0.0},
    {"ee13", "elastic strain, tensor component 13", 0.0},
    {"ee23", "elastic strain, tensor component 23", 0.0},
    {"epv", "volumetric plastic strain (compaction negative)", 0.0},
    {"esp", "accumulated plastic shear strain", 0.0},
    {"p", "effective mean pressure (compression positive)", 0.0},
    {"q", "sqrt(3/2 s:s)", 0.0},
    {"zone", "0 elastic, 1 plastic contractive, 2 plastic dilatant; +10 elastic convexity lost", 0.0},
};
inline constexpr unsigned served_kinds = LODE_SOLID | LODE_PLANE_STRAIN;
inline constexpr double clay[] = {100.0, 0.02, 0.1, 1.2, 3000.0, 0.0, 120.0};
inline constexpr double coupled[] = {90.0, 0.018, 0.13, 1.05, 2700.0, 60.0, 100.0};
inline constexpr double stiff[] = {100.0, 0.01, 0.08, 0.9, 5000.0, 60.0, 2.0, 1.0, 100.0, 1.0, 1e-5, 2.0, 1e-2};
inline constexpr lode_sample samples[] = {
    {"CLAY", "lightly overconsolidated clay, kPa", clay, count_of(clay), 0.02, served_kinds},
    {"COUPLED", "clay whose shear modulus grows with pressure, kPa", coupled, count_of(coupled), 0.02, served_kinds},
    {"OCR2", "overconsolidation ratio 2, pore pressure, thermal expansion, error-controlled substeps, kPa, 1/K", stiff,
     count_of(stiff), 0.02, served_kinds},
};
inline constexpr lode_algorithm algorithms[] = {
    {"backward Euler", 12, 1.0, 1.0},
    {"backward Euler, 4 substeps", 12, 4.0, 1.0},
    {"backward Euler, 16 substeps", 12, 16.0, 1.0},
    {"textbook Newton from the trial state", 14, 1.0, 1.0},
    {"textbook Newton from the old state", 14, 2.0, 1.0},
};
inline constexpr lode_model description = {
    .keyword = "CAM_CLAY",
    .title = "Modified Cam-clay with coupled hyperelasticity",
    .family = "soil",
    .purpose =
        "Rate-independent elastoplastic law for clays and other compressible granular media: pressure "
        "dependent hyperelasticity, an elliptic yield surface that grows with plastic compaction, "
        "associated flow.",
    .source = "Banerjee, Cam-Clay model based on Borja et al. 1997, sections 2.1-3.4 (with corrected signs)",
    .kinds = served_kinds,
    .traits = LODE_UNSYMMETRIC | LODE_ROTATES_STATE | LODE_HISTORY_STRESS | LODE_ITERATES,
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
        "- The first call replaces a stress of zero by the pressure p_ini: give the host an initial stress. A "
        "stress that is not compressive, or a q/p that alpha and mu0 cannot carry, is refused.\n"
        "- alpha > 0: the critical state exists only up to pc = 4 mu0/(M sqrt(2 alpha/(3 kappa)) - alpha), unless "
        "alpha >= 2 M^2/(3 kappa). Beyond it shearing stays contractive and creeps along the surface (warning).\n"
        "- alpha > 0 and mu0 small: the elastic law loses convexity at high q/p. Stress stays bounded, DDSDDE "
        "loses positive definiteness, zone is 10 higher (warning). More mu0 or a smaller OCR helps.\n"
        "- Poisson's ratio is negative where mu0 + alpha p > 3 p/(2 kappa), with alpha = 0 at every low enough "
        "pressure (warning at the first call).\n"
        "- No tensile strength and no apex: in extension p tends to 0 but stays positive. Where it has fallen "
        "below 1e-10 p_ref a bulk modulus of 1e-10 p_ref/kappa is added to DDSDDE.\n"
        "- Dry side: softening. Load control has no solution past the peak, and the law has no length scale, so "
        "a shear band is as wide as an element.\n"
        "- Backward Euler of order 1, safe for any increment; nsub and stol reduce the error. Undrained steps "
        "stay on the exact stress path.\n"
        "- method 1 and 2, the source's Newton on three unknowns, are there for comparison. They give the same answer "
        "or none: where the iteration diverges, or ends with dgamma < 0 or s < 0, a smaller increment is asked for "
        "(increments of 1 to 10 % from random states: in 5 % and 28 % of cases; the default: never).\n"
        "- Guards: a strain increment above 0.5, or an extension beyond about 600 kappa, asks for a smaller "
        "increment; VUMAT clips it to that bound, warns, and adds 10 to zone.\n"
        "- DDSDDE is not symmetric: ask the host for its unsymmetric solver.\n",
};

}  // namespace lode::cam_clay
