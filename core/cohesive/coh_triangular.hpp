// COH_TRIANGULAR: decoupled linear softening in both modes (page 40; Nairn, 7.6.1 and 7.8).
#pragma once

#include "lode/cohesive/decoupled.hpp"
#include "lode/cohesive/strength_laws.hpp"

namespace lode {

struct CohTriangular : DecoupledInterface<Sawtooth, Sawtooth> {
    static constexpr lode_parameter parameters[] = {
        required("K_N", "initial stiffness, mode I", "stress/length", above(0.0)),
        required("SIG_N", "cohesive stress, mode I", "stress", above(0.0)),
        required("GIC", "toughness, mode I", "energy/area", above(0.0), "must exceed SIG_N^2/(2 K_N)"),
        required("K_T", "initial stiffness, mode II", "stress/length", above(0.0)),
        required("SIG_T", "cohesive stress, mode II", "stress", above(0.0)),
        required("GIIC", "toughness, mode II", "energy/area", above(0.0), "must exceed SIG_T^2/(2 K_T)"),
        failure_exponent(),
        contact_option(),
        contact_stiffness(),
        constitutive_thickness(),
    };
    static constexpr double epoxy[] = {100000.0, 30.0, 0.3, 50000.0, 40.0, 0.9};
    static constexpr double layer[] = {20000.0, 15.0, 0.5, 8000.0, 25.0, 1.5, 2.0, 2, 0.0, 0.2};
    static constexpr double mortar[] = {3000.0, 0.8, 0.02, 1500.0, 1.6, 0.12, 0.0, 1, 30000.0};
    static constexpr lode_sample samples[] = {
        {"EPOXY", "toughened epoxy adhesive, N, mm", epoxy, count_of(epoxy), 0.005, cohesive_kinds},
        {"LAYER", "adhesive layer 0.2 mm thick, quadratic criterion, damaged stiffness in compression, N, mm", layer,
         count_of(layer), 0.02, cohesive_kinds},
        {"MORTAR", "masonry joint, modes fail on their own, stiff contact, N, mm", mortar, count_of(mortar), 0.02,
         cohesive_kinds},
    };
    static constexpr lode_algorithm algorithms[] = {
        {"each mode by its law, failure located on the path: exact for a straight path", 0, 0.0, HUGE_VAL},
    };
    static constexpr lode_model description = {
        .keyword = "COH_TRIANGULAR",
        .title = "Triangular traction law, decoupled modes",
        .family = "cohesive",
        .purpose =
            "The standard cohesive law: linear elastic up to the cohesive stress, then linear softening, in opening "
            "and in sliding each by itself, with a mixed-mode criterion in the released energies.",
        .source = "Nairn, chapter 7, sections 7.6.1 and 7.8",
        .kinds = cohesive_kinds,
        .traits = LODE_HISTORY_STRESS | LODE_ITERATES,
        .parameters = parameters,
        .parameter_count = count_of(parameters),
        .required_count = 6,
        .state = interface_states,
        .state_count = count_of(interface_states),
        .samples = samples,
        .sample_count = count_of(samples),
        .algorithms = algorithms,
        .algorithm_count = count_of(algorithms),
        .limits =
            "- GIC <= SIG_N^2/(2 K_N), or the same in mode II, would create energy: refused with the limiting value.\n"
            "- Failure by the mixed criterion drops the tractions to zero at one instant; up to half of the energy "
            "released before goes into that drop (GDROP). No tangent exists there: stabilise, or use small "
            "increments.\n"
            "- The tangent jumps where u_n changes sign, at the onset of damage and at load reversal; DDSDDE is the "
            "one-sided tangent of the increment.\n"
            "- CONTACT = 2, or deleting the element at failure, lets the faces interpenetrate; use CONTACT = 1 and do "
            "not delete in compression.\n"
            "- W is a trapezoid sum and inaccurate for large increments; SSE + SPD is exact.\n"
            "- The element must resolve the softening zone (length about E GIC/SIG_N^2) by at least three elements, "
            "and softening in series with a bar of length L snaps back where L > E (u_c - u_e)/SIG_N.\n"
            "- The modes do not weaken each other before failure: for mixed-mode work a coupled law is better.\n",
    };

    explicit CohTriangular(const Properties& p)
        : DecoupledInterface{Sawtooth(p, {1, 2, 3, 0, 0, "n"}),
                             Sawtooth(p, {4, 5, 6, 0, 0, "t"}),
                             p[7],
                             p[7],
                             Contact(p.code(8), p[9], p[1]),
                             p[10],
                             1.0 / p[10]} {}
};

}  // namespace lode
