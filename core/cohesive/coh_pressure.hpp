// COH_PRESSURE: a given traction on the faces of an open crack (page 40, section 4.7; Nairn, 7.12).
#pragma once

#include "lode/cohesive/interface.hpp"
#include "lode/material/properties.hpp"

namespace lode {

struct CohPressure {
    static constexpr lode_parameter parameters[] = {
        required("SIGMA", "traction on the open crack", "stress", any_value(), "negative: fluid pressure"),
        optional("U_MIN", "separation above which it acts", "length", any_value(), 0.0, "-1e30: always"),
        optional("CHI", "factor of the pressure in field variable 1", "-", any_value(), 0.0,
                 "the traction is SIGMA - CHI field; the field is read only if CHI is not 0"),
        optional("K_C", "penalty stiffness of the closed crack", "stress/length", at_least(0.0), 0.0),
        constitutive_thickness(),
    };
    static constexpr double fluid[] = {-3.0, 0.0002, 0.0, 100000.0};
    static constexpr double field[] = {-1.0, 0.002, 1.0, 50000.0, 0.2};
    static constexpr double bridging[] = {2.5, 0.0005, 0.0, 20000.0};
    static constexpr lode_sample samples[] = {
        {"FLUID", "fluid enters a crack that is open by 0.2 micrometres, penalty where it is closed, N, mm", fluid,
         count_of(fluid), 0.005, cohesive_kinds},
        {"FIELD", "pressure from field variable 1, acts above 2 micrometres, N, mm", field, count_of(field), 0.005,
         cohesive_kinds},
        {"BRIDGING", "constant closing traction above half a micrometre, N, mm", bridging, count_of(bridging), 0.005,
         cohesive_kinds},
    };
    static constexpr lode_algorithm algorithms[] = {
        {"closed form, exact", 0, 0.0, HUGE_VAL},
    };
    static constexpr lode_model description = {
        .keyword = "COH_PRESSURE",
        .title = "Constant traction on an open crack",
        .family = "cohesive",
        .purpose =
            "Loads the faces of a crack that is open with a normal traction of given size, a fluid pressure for "
            "instance, which may come from a field variable; a closed crack may be kept closed by a penalty.",
        .source = "Nairn, chapter 7, section 7.12",
        .kinds = cohesive_kinds,
        .traits = LODE_ELASTIC | LODE_HISTORY_STRESS,
        .parameters = parameters,
        .parameter_count = count_of(parameters),
        .required_count = 1,
        .state = interface_states,
        .state_count = count_of(interface_states),
        .samples = samples,
        .sample_count = count_of(samples),
        .algorithms = algorithms,
        .algorithm_count = count_of(algorithms),
        .limits =
            "- The open crack has no stiffness: DDSDDE is 0 there, and something else must hold the faces.\n"
            "- The traction jumps at U_MIN. An implicit host needs small increments there, or stabilisation.\n"
            "- SSE is the work done so far, W/T0, a trapezoid sum: across the jump it depends on the increments.\n"
            "- STATEV 4 to 9 and 11 stay 0 and STATUS stays 1.\n",
    };

    explicit CohPressure(const Properties& p)
        : traction(p[1]),
          threshold(p[2]),
          pressure_factor(p[3]),
          penalty(p[4]),
          thickness(p[5]),
          inverse_thickness(1.0 / p[5]) {}

    int required_state(AnalysisKind) const { return interface_state::count; }

    template <AnalysisKind kind>
    void initial_stiffness(const Stress<kind, double>&, const State<double>&, Tangent<kind>& tangent) const {
        set_stiffness<kind>(penalty, tangent);
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        constexpr int n = components(kind);
        const Real zero(0.0);
        const SeparationPath<kind, Real> path(increment, point.state, thickness);
        const Real& un = path.end[0];
        const Mask<Real> acts = un > Real(threshold);
        // The closed crack is held from u_n = 0 on, so that a host that starts there meets its stiffness.
        const Mask<Real> closed = un <= zero && !acts;

        Real given(traction);
        if (pressure_factor != 0.0) given = given - pressure_factor * increment.field_end(1);
        Vector<Real, n> tractions;
        tractions[0] = select(acts, given, select(closed, penalty * un, zero));
        for (int i = 1; i < n; ++i) tractions[i] = zero;

        Real work(0.0);
        for (int i = 0; i < n; ++i) work = work + (point.stress[i] + tractions[i]) * path.change[i];
        work = point.state[interface_state::W] + 0.5 * work;
        const auto result = InterfaceResult<kind, Real>::intact(zero, zero);
        if (!result.finish(path, tractions, inverse_thickness, point)) return;
        point.elastic_energy = inverse_thickness * work;
        if constexpr (wants_tangent<T>) set_stiffness<kind>(closed ? penalty : 0.0, tangent);
    }

    double traction, threshold, pressure_factor;  // sigma, u_min, chi
    double penalty;
    double thickness, inverse_thickness;

  private:
    template <AnalysisKind kind>
    void set_stiffness(double normal, Tangent<kind>& tangent) const {
        constexpr int n = components(kind);
        for (int i = 0; i < n * n; ++i) tangent.stiffness[i] = 0.0;
        tangent(0, 0) = thickness * normal;
    }
};

}  // namespace lode
