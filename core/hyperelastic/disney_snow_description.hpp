// What DISNEY_SNOW says about itself.
#pragma once

#include "lode/hyperelastic/dilatational_energy.hpp"

namespace lode {

struct DisneySnowDescription {
    static constexpr lode_parameter parameters[] = {
        required("E0", "initial Young's modulus", "stress", above(0.0)),
        required("NU", "Poisson's ratio", "-", inside(-1.0, 0.5)),
        optional("THC", "critical compression", "-", {0.0, 1.0, LODE_UPPER_OPEN}, 0.025,
                 "smallest elastic principal stretch 1 - THC"),
        optional("THS", "critical stretch", "-", at_least(0.0), 0.0075, "largest elastic principal stretch 1 + THS"),
        optional("XI", "hardening", "-", at_least(0.0), 10.0, "moduli are multiplied by exp(XI (1 - Jp))"),
        optional("ELAS", "elastic law", "code", code(0, 1), 0.0, "0 co-rotated, 1 neo-Hookean"),
        dilatational_option(1.0),
        optional("ALPHA", "thermal expansion", "1/temp", any_value(), 0.0),
        optional("BETA", "expansion per unit of field 1", "1/field", any_value(), 0.0),
        optional("ORI", "basis of F", "code", code(0, 1), 0.0,
                 "0 the second index of F refers to a fixed basis, 1 both refer to axes that turn with the material "
                 "(continuum elements with a local orientation in Abaqus/Standard)"),
    };
    static constexpr lode_state states[] = {
        {"CPI11", "inverse plastic right Cauchy-Green tensor - 1, reference basis", 0.0},
        {"CPI22", "component 22", 0.0},
        {"CPI33", "component 33", 0.0},
        {"CPI12", "component 12", 0.0},
        {"CPI13", "component 13", 0.0},
        {"CPI23", "component 23", 0.0},
        {"JPM1", "plastic volume ratio Jp - 1", 0.0},
        {"EPSRES", "residual strain, logarithm of the free stretch", 0.0},
    };
    static constexpr double snow[] = {1.4e5, 0.2};
    static constexpr double packed[] = {1e6, 0.2, 0.02, 0.01, 8.0, 1.0, 0.0, 1e-5, 2e-5};
    static constexpr double powder[] = {5e4, 0.15, 0.03, 0.005, 12.0, 0.0, 2.0, 4e-5};
    static constexpr unsigned served = LODE_SOLID | LODE_PLANE_STRAIN;
    static constexpr lode_sample samples[] = {
        {"SNOW", "snow of 400 kg/m3, Pa", snow, count_of(snow), 0.05, served},
        {"PACKED", "packed snow, neo-Hookean elastic law, heat and moisture, Pa, 1/K, 1/(kg/m3)", packed,
         count_of(packed), 0.05, served},
        {"POWDER", "dry powder, U = lambda/2 (ln J)^2, Pa, 1/K", powder, count_of(powder), 0.05, served},
    };
    static constexpr lode_algorithm algorithms[] = {
        {"projection of the trial stretches", 0, 0.0, 1.0},
    };
    static constexpr lode_model description = {
        .keyword = "DISNEY_SNOW",
        .title = "Elastic-plastic snow",
        .family = "hyperelastic",
        .purpose =
            "Snow and other compactable media in explicit and material-point analyses: elastic within limits of the "
            "principal stretches, flowing at the limits, hardening when compacted and softening when torn.",
        .source = "Nairn, chapter 9, section 9.8 (eqs. 9.71-9.90)",
        .kinds = served,
        .traits = LODE_FINITE_STRAIN | LODE_UNSYMMETRIC | LODE_HISTORY_STRESS,
        .parameters = parameters,
        .parameter_count = count_of(parameters),
        .required_count = 2,
        .state = states,
        .state_count = count_of(states),
        .samples = samples,
        .sample_count = count_of(samples),
        .algorithms = algorithms,
        .algorithm_count = count_of(algorithms),
        .limits =
            "- Geometric non-linearity is required; without it the host passes F = I and the stress stays zero.\n"
            "- det F <= 0 or a deformation that is not finite asks for a smaller increment.\n"
            "- Tension softens by exp(-XI (Jp - 1)): 0.0067 at Jp = 1.5 with XI = 10, singular for an implicit "
            "solver. Softening is not regularised by the element length: the localised zone is one element wide.\n"
            "- Compaction hardens: the moduli are 1100 times larger at Jp = 0.3, and the stable time step of an "
            "explicit host shrinks accordingly.\n"
            "- Compaction raises the stored energy. Beyond XI = 1 - JE sigma_m/W at the limit of hydrostatic "
            "compression a closed cycle yields work; a warning is given when the material is made. With little "
            "hardening a body compressed in two directions also yields work while it flows in the third, where the "
            "stress can be compressive at the limit of stretch. SPD is then reported as it is: it decreases.\n"
            "- DDSDDE is unsymmetric while the material flows and jumps at the limits; with two stretches at limits "
            "Newton may cycle. Each stretch has a tolerance of 1e-12 at the limits, so that a zero increment is "
            "elastic.\n"
            "- Coaxial monotonic paths do not depend on the increments; on others the error is of first order.\n"
            "- Plane stress is refused: softening makes the thickness equation ambiguous.\n",
    };
};

}  // namespace lode
