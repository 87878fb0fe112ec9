// COH_TRILINEAR: bilinear softening, decoupled, in both modes (page 40; Nairn, 7.6.5 and 7.13).
#pragma once

#include "lode/cohesive/decoupled.hpp"
#include "lode/cohesive/strength_laws.hpp"

namespace lode {

struct CohTrilinear : DecoupledInterface<Bilinear, Bilinear> {
    static constexpr lode_parameter parameters[] = {
        required("K_N", "initial stiffness, mode I", "stress/length", above(0.0)),
        required("SIG_N", "stress at the elastic limit u_e, mode I", "stress", above(0.0)),
        required("SIG2_N", "stress at the break, mode I", "stress", above(0.0), "at most K_N U2_N"),
        required("U2_N", "separation at the break, mode I", "length", above(0.0), "from u_e to below u_c"),
        required("GIC", "toughness, mode I", "energy/area", above(0.0),
                 "must exceed (SIG_N U2_N + SIG2_N (U2_N - u_e))/2"),
        required("K_T", "initial stiffness, mode II", "stress/length", above(0.0)),
        required("SIG_T", "stress at the elastic limit u_e, mode II", "stress", above(0.0)),
        required("SIG2_T", "stress at the break, mode II", "stress", above(0.0), "at most K_T U2_T"),
        required("U2_T", "separation at the break, mode II", "length", above(0.0), "from u_e to below u_c"),
        required("GIIC", "toughness, mode II", "energy/area", above(0.0),
                 "must exceed (SIG_T U2_T + SIG2_T (U2_T - u_e))/2"),
        failure_exponent(),
        contact_option(),
        contact_stiffness(),
        constitutive_thickness(),
    };
    static constexpr double epoxy[] = {100000.0, 30.0, 12.0, 0.006, 0.3, 50000.0, 40.0, 10.0, 0.02, 0.9};
    static constexpr double plastic[] = {20000.0, 15.0, 15.0, 0.02, 0.5, 8000.0, 25.0,
                                         30.0,    0.04, 1.5,  2.0,  2,   0.0,    0.2};
    static constexpr double bridging[] = {100000.0, 40.0, 5.0, 0.005, 0.8, 50000.0, 60.0, 8.0, 0.01, 1.6, 0.0, 1, 4e5};
    static constexpr lode_sample samples[] = {
        {"EPOXY", "toughened epoxy adhesive, N, mm", epoxy, count_of(epoxy), 0.006, cohesive_kinds},
        {"PLASTIC",
         "ductile adhesive 0.2 mm thick with a plateau, quadratic criterion, damaged stiffness in compression, N, mm",
         plastic, count_of(plastic), 0.02, cohesive_kinds},
        {"BRIDGING", "laminate with fibre bridging, modes fail on their own, stiff contact, N, mm", bridging,
         count_of(bridging), 0.008, cohesive_kinds},
    };
    static constexpr lode_algorithm algorithms[] = {
        {"each mode by its law, failure located on the path: exact for a straight path", 0, 0.0, HUGE_VAL},
    };
    static constexpr lode_model description = {
        .keyword = "COH_TRILINEAR",
        .title = "Trilinear traction law, decoupled modes",
        .family = "cohesive",
        .purpose =
            "Linear elastic, then softening (or hardening) along two straight lines: a short steep one for the crack "
            "tip "
            "and a long flat one for fibre bridging, or a plateau, in opening and in sliding each by itself, with a "
            "mixed-mode criterion in the released energies.",
        .source = "Nairn, chapter 7, sections 7.6.5 and 7.13",
        .kinds = cohesive_kinds,
        .traits = LODE_HISTORY_STRESS | LODE_ITERATES,
        .parameters = parameters,
        .parameter_count = count_of(parameters),
        .required_count = 10,
        .state = interface_states,
        .state_count = count_of(interface_states),
        .samples = samples,
        .sample_count = count_of(samples),
        .algorithms = algorithms,
        .algorithm_count = count_of(algorithms),
        .limits =
            "- A break outside [u_e, u_c), SIG2 > K U2, or a toughness below the area up to the break would create "
            "energy: refused with the limiting value.\n"
            "- U2 = u_e drops the stress from SIG to SIG2 at once; the energy of the drop counts as released, and no "
            "tangent exists there.\n"
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

    explicit CohTrilinear(const Properties& p)
        : DecoupledInterface{Bilinear(p, {1, 2, 5, 3, 4, "n"}),
                             Bilinear(p, {6, 7, 10, 8, 9, "t"}),
                             p[11],
                             p[11],
                             Contact(p.code(12), p[13], p[1]),
                             p[14],
                             1.0 / p[14]} {}
};

}  // namespace lode
