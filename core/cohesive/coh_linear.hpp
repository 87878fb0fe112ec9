// COH_LINEAR: an elastic interface that never fails (page 40, section 4.7; Nairn, 7.10).
#pragma once

#include "lode/cohesive/interface.hpp"
#include "lode/material/properties.hpp"

namespace lode {

struct CohLinear {
    static constexpr lode_parameter parameters[] = {
        required("K_N", "normal stiffness", "stress/length", at_least(0.0)),
        required("K_T", "shear stiffness", "stress/length", at_least(0.0)),
        contact_option(),
        contact_stiffness(),
        constitutive_thickness(),
    };
    static constexpr double gasket[] = {100000.0, 40000.0};
    static constexpr double foundation[] = {50.0, 20.0, 1, 5000.0, 0.5};
    static constexpr double one_sided[] = {2000.0, 800.0, 0};
    static constexpr lode_sample samples[] = {
        {"GASKET", "thin elastic layer, N, mm", gasket, count_of(gasket), 0.002, cohesive_kinds},
        {"FOUNDATION", "soft bedding with a stiff stop in compression, N, mm", foundation, count_of(foundation), 0.01,
         cohesive_kinds},
        {"ONESIDED", "carries tension only, contact is left to the host, N, mm", one_sided, count_of(one_sided), 0.01,
         cohesive_kinds},
    };
    static constexpr lode_algorithm algorithms[] = {
        {"closed form, exact", 0, 0.0, HUGE_VAL},
    };
    static constexpr lode_model description = {
        .keyword = "COH_LINEAR",
        .title = "Linear elastic interface",
        .family = "cohesive",
        .purpose =
            "An elastic layer of no thickness between two faces: traction proportional to separation in opening "
            "and in sliding, with a choice for compression, and no damage.",
        .source = "Nairn, chapter 7, section 7.10",
        .kinds = cohesive_kinds,
        .traits = LODE_ELASTIC | LODE_HISTORY_STRESS,
        .parameters = parameters,
        .parameter_count = count_of(parameters),
        .required_count = 2,
        .state = interface_states,
        .state_count = count_of(interface_states),
        .samples = samples,
        .sample_count = count_of(samples),
        .algorithms = algorithms,
        .algorithm_count = count_of(algorithms),
        .limits =
            "- The interface never fails: STATEV 4 to 9 and 11 stay 0 and STATUS stays 1.\n"
            "- A stiffness of 0 (also in compression with CONTACT = 0) leaves a direction free: the host needs other "
            "stiffness there.\n"
            "- The tangent jumps where u_n changes sign if K_COMP differs from K_N.\n"
            "- The initial stiffness adds a compliance 1/K to the structure: K_N of at least 50 E/h, h the thickness "
            "of the neighbours, makes it invisible; the explicit time step falls as 1/sqrt(K).\n"
            "- W is a trapezoid sum and inaccurate for large increments across u_n = 0; SSE is exact.\n",
    };

    explicit CohLinear(const Properties& p)
        : normal(p[1]), shear(p[2]), contact(p.code(3), p[4], p[1]), thickness(p[5]), inverse_thickness(1.0 / p[5]) {}

    int required_state(AnalysisKind) const { return interface_state::count; }

    template <AnalysisKind kind>
    void initial_stiffness(const Stress<kind, double>&, const State<double>&, Tangent<kind>& tangent) const {
        set_stiffness<kind>(normal, tangent);
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        const SeparationPath<kind, Real> path(increment, point.state, thickness);
        const auto result = InterfaceResult<kind, Real>::intact(Real(normal), Real(shear));
        if (!result.finish(path, contact, inverse_thickness, point)) return;
        if constexpr (wants_tangent<T>) set_stiffness<kind>(result.secant(path.end[0], contact), tangent);
    }

    double normal, shear;  // k
    Contact contact;
    double thickness, inverse_thickness;

  private:
    template <AnalysisKind kind>
    void set_stiffness(double normal_stiffness, Tangent<kind>& tangent) const {
        constexpr int n = components(kind);
        for (int i = 0; i < n * n; ++i) tangent.stiffness[i] = 0.0;
        tangent(0, 0) = thickness * normal_stiffness;
        for (int i = 1; i < n; ++i) tangent(i, i) = thickness * shear;
    }
};

}  // namespace lode
