// COH_MIXED: any strength law in each mode, any mixed-mode method (page 40; Nairn, 7.2 to 7.6 and 7.15).
#pragma once

#include "lode/cohesive/decoupled.hpp"
#include "lode/cohesive/mixed_mode.hpp"

namespace lode {

struct CohMixed {
    static constexpr lode_parameter parameters[] = {
        required("LAW_N", "strength law, mode I", "code", code(1, 6),
                 "1 sawtooth, 2 generalized cubic, 3 Needleman, 4 exponential, 5 Abaqus exponential, 6 bilinear"),
        required("K_N", "initial stiffness, mode I", "stress/length", at_least(0.0), "> 0; 0 for law 3"),
        required("SIG_N", "cohesive stress, mode I", "stress", above(0.0), "law 3: the peak"),
        required("GIC", "toughness, mode I", "energy/area", above(0.0),
                 "must exceed SIG_N^2/(2 K_N), law 6: (SIG_N B_N + A_N (B_N - u_e))/2"),
        required("LAW_T", "strength law, mode II", "code", code(1, 6), "as LAW_N"),
        required("K_T", "initial stiffness, mode II", "stress/length", at_least(0.0), "> 0; 0 for law 3"),
        required("SIG_T", "cohesive stress, mode II", "stress", above(0.0), "law 3: the peak"),
        required("GIIC", "toughness, mode II", "energy/area", above(0.0), "as GIC"),
        optional("A_N", "parameter of the law, mode I", "-", any_value(), 0.0,
                 "law 2: kc/k <= 1; law 4: cut-off S/sig in [0, 1); law 5: alpha > 0; law 6: stress at the break"),
        optional("B_N", "parameter of the law, mode I", "-", any_value(), 0.0, "law 6: separation at the break"),
        optional("A_T", "parameter of the law, mode II", "-", any_value(), 0.0, "as A_N"),
        optional("B_T", "parameter of the law, mode II", "-", any_value(), 0.0, "as B_N"),
        optional("METHOD", "mixed-mode method", "code", code(0, 5), 1.0,
                 "0 decoupled, 1 equal damage, 2 equal damage by the explicit rate update, 3 return normal to the "
                 "surface; 4 and 5 (extremum of energy) are refused"),
        optional("P", "exponent of GI in the criterion of method 0", "-", any_value(), 1.0, "<= 0: no criterion"),
        optional("Q", "exponent of GII in the criterion of method 0", "-", any_value(), 0.0, "> 0; missing: P"),
        contact_option(),
        contact_stiffness(),
        optional("COMP_COUPLE", "shear damage in compression also damages mode I", "code", code(0, 1), 1.0,
                 "method 1 only"),
        optional("NQUAD", "Gauss points of the energies", "count", code(0, 8), 4.0, "0: trapezoid rule"),
        optional("NSUB", "substeps of method 2", "count", {1.0, HUGE_VAL, LODE_INTEGER}, 1.0),
        constitutive_thickness(),
    };
    static constexpr double epoxy[] = {1, 100000.0, 30.0, 0.3, 1, 50000.0, 40.0, 0.9};
    static constexpr double bridging[] = {6,   100000.0, 30.0, 0.3, 2, 50000.0, 40.0, 0.9, 12.0, 0.006, 0.2,
                                          0.0, 1,        1.0,  1.0, 2, 0.0,     0,    8,   1,    0.2};
    static constexpr double smooth[] = {3, 0.0, 30.0, 0.3, 3, 0.0, 40.0, 0.9};
    static constexpr double normality[] = {1, 100000.0, 30.0, 0.3, 1,   70000.0, 30.0, 0.55,    0,
                                           0, 0,        0,    3,   1.0, 1.0,     1,    400000.0};
    static constexpr double decoupled[] = {4,     100000.0, 30.0, 0.3, 5, 50000.0, 40.0, 0.9,
                                           0.001, 0.0,      5.0,  0.0, 0, 2.0,     1.5};
    static constexpr lode_sample samples[] = {
        {"EPOXY", "toughened epoxy adhesive, sawtooth, equal damage, N, mm", epoxy, count_of(epoxy), 0.005,
         cohesive_kinds},
        {"BRIDGING", "bilinear and cubic law, damaged stiffness in compression, every option, N, mm", bridging,
         count_of(bridging), 0.006, cohesive_kinds},
        {"SMOOTH", "Needleman's law in both modes, N, mm", smooth, count_of(smooth), 0.006, cohesive_kinds},
        {"NORMAL", "return normal to the surface, stiff contact, N, mm", normality, count_of(normality), 0.005,
         cohesive_kinds},
        {"DECOUPLED", "exponential laws, decoupled, own exponents in the criterion, N, mm", decoupled,
         count_of(decoupled), 0.006, cohesive_kinds},
    };
    static constexpr lode_algorithm algorithms[] = {
        {"equal damage, exact return to the surface", 13, 1.0, HUGE_VAL},
        {"decoupled, failure located on the path", 13, 0.0, HUGE_VAL},
        {"equal damage, explicit rate update", 13, 2.0, 1.0},
        {"return normal to the evolved surface, exact", 13, 3.0, HUGE_VAL},
    };
    static constexpr lode_model description = {
        .keyword = "COH_MIXED",
        .title = "Mixed-mode cohesive law",
        .family = "cohesive",
        .purpose =
            "Six strength laws, one for opening and one for sliding, and four ways to couple them. In the default, the "
            "model of Nairn, both modes have the same damage and stay on the surface (T_n/S_n)^2 + (T_t/S_t)^2 = 1; "
            "the update is exact for a straight path of any length.",
        .source = "Nairn, chapter 7, sections 7.2 to 7.6 and 7.15",
        .kinds = cohesive_kinds,
        .traits = LODE_UNSYMMETRIC | LODE_HISTORY_STRESS | LODE_ITERATES,
        .parameters = parameters,
        .parameter_count = count_of(parameters),
        .required_count = 8,
        .state = interface_states,
        .state_count = count_of(interface_states),
        .samples = samples,
        .sample_count = count_of(samples),
        .algorithms = algorithms,
        .algorithm_count = count_of(algorithms),
        .limits =
            "- Constants with which the stiffness of a law would grow (phi < 0) are refused with the limiting value.\n"
            "- METHOD 4 and 5 are refused: the extremum of the energy is not where both modes evolve.\n"
            "- METHOD 3 serves the laws 1, 2, 3 and 6, METHOD 2 not law 3, METHOD 1 to 3 no law 6 with B = u_e, and "
            "law 4 without cut-off only with itself: refused.\n"
            "- METHOD 1: with u_e/u_c of the modes apart by orders of magnitude, a little opening in the mode with the "
            "small ratio uses up the other one. K_T = K_N (SIG_T^2/GIIC)/(SIG_N^2/GIC) makes sawtooths equal.\n"
            "- METHOD 2 is of first order, errs by 13 % in one step where METHOD 1 is exact, and returns the tangent "
            "of METHOD 1; it is there to be compared with.\n"
            "- METHOD 3: one mode may be used up first; the rest of the other drops (GDROP). A warning is given once "
            "if the modes differ by more than a factor of 2.\n"
            "- COMP_COUPLE = 0, and then opening: a sudden drop when shear is used up (GDROP).\n"
            "- Law 4 without cut-off in both modes never fails.\n"
            "- The tangent is unsymmetric and one-sided where u_n changes sign, at onset, reversal and at the break of "
            "law 6; after failure only contact has stiffness.\n"
            "- CONTACT = 2, or deleting the element at failure, lets the faces interpenetrate.\n"
            "- W is a trapezoid sum and inaccurate for large increments; SSE + SPD is not.\n",
    };

    explicit CohMixed(const Properties& p)
        : method(checked_method(p)),
          joint{StrengthLaw(p.code(1), p, {2, 3, 4, 9, 10, "n"}),
                StrengthLaw(p.code(5), p, {6, 7, 8, 11, 12, "t"}),
                static_cast<MixedMode>(method == 0 ? 1 : method),
                p.code(18) == 1 || method != 1,
                substeps_of(p),
                GaussPoints(p.code(19)),
                Contact(p.code(16), p[17], 0.0),
                p[21],
                1.0 / p[21]} {
        const StrengthLaw &normal = joint.normal, &shear = joint.shear;
        joint.contact = Contact(p.code(16), p[17], normal.stiffness);
        exponent_I = p[14];
        exponent_II = p.count() >= 15 ? p[15] : exponent_I;
        if (method == 0) {
            if (exponent_I > 0.0 && !(exponent_II > 0.0)) p.refuse(15, "> 0");
            return;
        }
        for (const StrengthLaw* law : {&normal, &shear}) {
            if (law->code() == 6 && !(law->break_point() > law->elastic_limit))
                p.refuse(law == &normal ? 10 : 12,
                         "greater than sig/k = " + format_number(law->elastic_limit) + " with METHOD 1 to 3");
            if (method == 3 && !law->has_psi())
                p.refuse(13, "0 or 1 for the laws 4 and 5: METHOD 3 needs law 1, 2, 3 or 6");
            if (method == 2 && law->code() == 3) p.refuse(13, "0, 1 or 3 for law 3: METHOD 2 has no start there");
        }
        if (std::isfinite(normal.end) != std::isfinite(shear.end))
            p.refuse(std::isfinite(normal.end) ? 11 : 9, "> 0: law 4 without cut-off needs the same in the other mode");
        joint.set_end();
    }

    std::string warnings() const {
        if (method != 3) return "";
        const double n = joint.normal.psi(joint.normal.end), t = joint.shear.psi(joint.shear.end);
        if (std::max(n, t) <= 2.0 * std::min(n, t)) return "";
        return "METHOD 3: Psi(u_c) differs between the modes (" + format_number(n) + " and " + format_number(t) +
               "): the interface fails while one mode still carries traction";
    }

    int required_state(AnalysisKind) const { return interface_state::count; }

    template <AnalysisKind kind>
    void initial_stiffness(const Stress<kind, double>&, const State<double>&, Tangent<kind>& tangent) const {
        constexpr int n = components(kind);
        for (int i = 0; i < n * n; ++i) tangent.stiffness[i] = 0.0;
        for (int i = 0; i < n; ++i)
            tangent(i, i) = joint.thickness * (i == 0 ? joint.normal.stiffness : joint.shear.stiffness);
    }

    // The kernels: decoupled, sawtooths with equal damage (closed form), everything else.
    template <class F>
    LODE_INLINE void specialise(const F& f) const {
        if (method == 0) {
            f(DecoupledInterface<StrengthLaw, StrengthLaw>{joint.normal, joint.shear, exponent_I, exponent_II,
                                                           joint.contact, joint.thickness, joint.inverse_thickness});
        } else if (method == 1 && joint.normal.code() == 1 && joint.shear.code() == 1) {
            f(CoupledInterface<Sawtooth, Sawtooth>{joint.normal.sawtooth(), joint.shear.sawtooth(), joint.method,
                                                   joint.compression_couples, joint.substeps, joint.gauss,
                                                   joint.contact, joint.thickness, joint.inverse_thickness, joint.end_n,
                                                   joint.end_t});
        } else {
            f(joint);
        }
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        specialise([&](const auto& kernel) { kernel.update(increment, point, tangent); });
    }

    int method;
    CoupledInterface<StrengthLaw, StrengthLaw> joint;
    double exponent_I, exponent_II;

  private:
    static int checked_method(const Properties& p) {
        const int m = p.code(13);
        if (m > 3)
            p.refuse(13,
                     "0 to 3: mixed-mode energy extremum is ill posed: one of the two damage variables never evolves");
        return m;
    }
    static int substeps_of(const Properties& p) {
        if (p[20] > 1e6) p.refuse(20, "at most 1000000");
        return p.code(20);
    }
};

}  // namespace lode
