// COH_CUBIC: Needleman's cubic law, decoupled, in both modes (page 40; Nairn, 7.6.2 and 7.11).
#pragma once

#include "lode/cohesive/cubic_laws.hpp"
#include "lode/cohesive/decoupled.hpp"

namespace lode {

struct CohCubic : DecoupledInterface<Needleman, Needleman> {
    static constexpr lode_parameter parameters[] = {
        required("SIG_N", "peak stress, mode I", "stress", above(0.0)),
        required("GIC", "toughness, mode I", "energy/area", above(0.0)),
        required("SIG_T", "peak stress, mode II", "stress", above(0.0)),
        required("GIIC", "toughness, mode II", "energy/area", above(0.0)),
        failure_exponent(),
        contact_option(),
        contact_stiffness(),
        constitutive_thickness(),
    };
    static constexpr double epoxy[] = {30.0, 0.3, 40.0, 0.9};
    static constexpr double layer[] = {15.0, 0.5, 25.0, 1.5, 2.0, 2, 0.0, 0.2};
    static constexpr double interface[] = {600.0, 0.05, 800.0, 0.12, 0.0, 1, 1e8};
    static constexpr lode_sample samples[] = {
        {"EPOXY", "toughened epoxy adhesive, N, mm", epoxy, count_of(epoxy), 0.006, cohesive_kinds},
        {"LAYER", "adhesive layer 0.2 mm thick, quadratic criterion, damaged stiffness in compression, N, mm", layer,
         count_of(layer), 0.02, cohesive_kinds},
        {"INTERFACE", "particle and matrix, modes fail on their own, stiff contact, N, mm", interface,
         count_of(interface), 5e-5, cohesive_kinds},
    };
    static constexpr lode_algorithm algorithms[] = {
        {"each mode by its law, failure located on the path: exact for a straight path", 0, 0.0, HUGE_VAL},
    };
    static constexpr lode_model description = {
        .keyword = "COH_CUBIC",
        .title = "Cubic (Needleman) traction law, decoupled modes",
        .family = "cohesive",
        .purpose =
            "A smooth law without a kink at its peak: the traction rises to the peak at a third of the critical "
            "separation and falls as a cubic, in opening and in sliding each by itself, with a mixed-mode criterion in "
            "the released energies. The stiffness follows from peak stress and toughness.",
        .source = "Nairn, chapter 7, sections 7.6.2 and 7.11",
        .kinds = cohesive_kinds,
        .traits = LODE_HISTORY_STRESS | LODE_ITERATES,
        .parameters = parameters,
        .parameter_count = count_of(parameters),
        .required_count = 4,
        .state = interface_states,
        .state_count = count_of(interface_states),
        .samples = samples,
        .sample_count = count_of(samples),
        .algorithms = algorithms,
        .algorithm_count = count_of(algorithms),
        .limits =
            "- There is no elastic range: any opening damages, and the initial stiffness 27 sig/(4 u_c), "
            "u_c = 16 G/(9 sig), is a compliance that the structure did not have.\n"
            "- Failure by the mixed criterion drops the tractions to zero at one instant; up to half of the energy "
            "released before goes into that drop (GDROP). No tangent exists there: stabilise, or use small "
            "increments.\n"
            "- The tangent jumps where u_n changes sign, at the onset of damage and at load reversal; DDSDDE is the "
            "one-sided tangent of the increment.\n"
            "- CONTACT = 2, or deleting the element at failure, lets the faces interpenetrate; use CONTACT = 1 and do "
            "not delete in compression.\n"
            "- W is a trapezoid sum and inaccurate for large increments; SSE + SPD is exact.\n"
            "- The element must resolve the softening zone (length about E GIC/SIG_N^2) by at least three elements, "
            "and softening in series with a bar of length L snaps back where -S'(u_n) > E/L.\n"
            "- The modes do not weaken each other before failure: for mixed-mode work a coupled law is better.\n",
    };

    explicit CohCubic(const Properties& p)
        : DecoupledInterface{Needleman(p, {0, 1, 2, 0, 0, "n"}),
                             Needleman(p, {0, 3, 4, 0, 0, "t"}),
                             p[5],
                             p[5],
                             Contact(p.code(6), p[7], Needleman(p, {0, 1, 2, 0, 0, "n"}).stiffness),
                             p[8],
                             1.0 / p[8]} {}
};

}  // namespace lode
