// COH_COUPLED: Hoegberg's coupled law, one damage variable for both modes (page 40, section 4.6; Nairn, 7.14).
#pragma once

#include "lode/cohesive/exponential_laws.hpp"
#include "lode/cohesive/interface.hpp"

namespace lode {

struct CohCoupled {
    static constexpr lode_parameter parameters[] = {
        required("K_N", "initial stiffness, mode I", "stress/length", above(0.0)),
        required("SIG_N", "cohesive stress, mode I", "stress", above(0.0)),
        required("GIC", "toughness, mode I", "energy/area", above(0.0), "must exceed SIG_N^2/(2 K_N)"),
        required("K_T", "initial stiffness, mode II", "stress/length", above(0.0)),
        required("SIG_T", "cohesive stress, mode II", "stress", above(0.0)),
        required("GIIC", "toughness, mode II", "energy/area", above(0.0), "must exceed SIG_T^2/(2 K_T)"),
        optional("ALPHA", "softening", "-", at_least(0.0), 0.0, "0 linear, > 0 exponent of the decay"),
        contact_option(),
        contact_stiffness(),
        constitutive_thickness(),
    };
    static constexpr lode_state states[] = {
        interface_states[0],
        interface_states[1],
        interface_states[2],
        {"LAMBDA", "largest relative separation, 0 = not initiated, 1 = failed", 0.0},
        {"LAMBDAP", "relative separation at the peak for the mixity of the last loaded state", 0.0},
        interface_states[5],
        interface_states[6],
        interface_states[7],
        interface_states[8],
        interface_states[9],
        interface_states[10],
        interface_states[11],
    };
    static constexpr double epoxy[] = {100000.0, 30.0, 0.3, 100000.0, 60.0, 1.2};
    static constexpr double layer[] = {20000.0, 15.0, 0.5, 40000.0, 30.0, 1.0, 3.0, 2, 0.0, 0.2};
    static constexpr double joint[] = {50000.0, 20.0, 0.4, 50000.0, 20.0, 0.4, 6.0, 0};
    static constexpr lode_sample samples[] = {
        {"EPOXY", "toughened epoxy adhesive, linear softening, N, mm", epoxy, count_of(epoxy), 0.006, cohesive_kinds},
        {"LAYER", "adhesive layer 0.2 mm thick, exponential, damaged stiffness in compression, N, mm", layer,
         count_of(layer), 0.02, cohesive_kinds},
        {"JOINT", "the same in both modes, steep exponential, no contact, N, mm", joint, count_of(joint), 0.01,
         cohesive_kinds},
    };
    static constexpr lode_algorithm algorithms[] = {
        {"exact for constant mixity: energies by the mixity at the end of the increment", 0, 0.0, 1.0},
    };
    static constexpr lode_model description = {
        .keyword = "COH_COUPLED",
        .title = "Coupled traction law (Hoegberg)",
        .family = "cohesive",
        .purpose =
            "Both modes soften together as a function of one relative separation, linearly or exponentially; at "
            "constant mixity failure is at GI/GIC + GII/GIIC = 1.",
        .source = "Nairn, chapter 7, section 7.14, eq. 7.43",
        .kinds = cohesive_kinds,
        .traits = LODE_UNSYMMETRIC | LODE_HISTORY_STRESS,
        .parameters = parameters,
        .parameter_count = count_of(parameters),
        .required_count = 6,
        .state = states,
        .state_count = count_of(states),
        .samples = samples,
        .sample_count = count_of(samples),
        .algorithms = algorithms,
        .algorithm_count = count_of(algorithms),
        .limits =
            "- GIC <= SIG_N^2/(2 K_N), or the same in mode II, would create energy: refused with the limiting value.\n"
            "- Where u_e/u_c differs between the modes the stiffness depends on the mixity: damage may be negative in "
            "one mode, and elastic cycles gain or lose energy. The secant is capped at that of the virgin interface; "
            "a warning is given once. K_T = K_N (SIG_T^2/GIIC)/(SIG_N^2/GIC) avoids it.\n"
            "- Energies of an increment whose mixity turns are of first order in its size.\n"
            "- At zero separation, where the mixity is not defined, the tractions are 0 and DDSDDE is the initial "
            "stiffness (0 after failure).\n"
            "- The tangent is unsymmetric, and jumps where u_n changes sign, at the onset of damage and at load "
            "reversal.\n"
            "- CONTACT = 2, or deleting the element at failure, lets the faces interpenetrate; use CONTACT = 1 and do "
            "not delete in compression.\n",
    };

    explicit CohCoupled(const Properties& p)
        : stiffness{p[1], p[4]},
          strength{p[2], p[5]},
          alpha(p[7]),
          fall(alpha > 0.0 ? -std::expm1(-alpha) : 1.0),
          contact(p.code(8), p[9], p[1]),
          thickness(p[10]),
          inverse_thickness(1.0 / p[10]) {
        const LawEntries entries[2] = {{1, 2, 3, 7, 0, "n"}, {4, 5, 6, 7, 0, "t"}};
        for (int mode = 0; mode < 2; ++mode) {
            const double u_c = alpha > 0.0 ? AbaqusExponential(p, entries[mode]).end : Sawtooth(p, entries[mode]).end;
            end_inverse[mode] = 1.0 / u_c;
            ratio[mode] = strength[mode] / (stiffness[mode] * u_c);
            toughness_scale[mode] = 0.5 * strength[mode] * u_c;
            secant_scale[mode] = strength[mode] / u_c;
        }
        inverse_fall = 1.0 / fall;
    }

    std::string warnings() const {
        if (std::abs(ratio[0] - ratio[1]) <= 1e-6 * ratio[0]) return "";
        return "u_e/u_c differs between the modes (" + format_number(ratio[0]) + " and " + format_number(ratio[1]) +
               "): valid only at constant mixity";
    }

    int required_state(AnalysisKind) const { return interface_state::count; }

    template <AnalysisKind kind>
    void initial_stiffness(const Stress<kind, double>&, const State<double>&, Tangent<kind>& tangent) const {
        constexpr int n = components(kind);
        for (int i = 0; i < n * n; ++i) tangent.stiffness[i] = 0.0;
        for (int i = 0; i < n; ++i) tangent(i, i) = thickness * stiffness[i > 0];
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        namespace index = interface_state;
        using Path = SeparationPath<kind, Real>;
        const Real zero(0.0), one(1.0), smallest(1e-150), largest(1e100);
        const State<Real>& state = point.state;
        const Path path(increment, state, thickness);
        const Real history = state[index::dn];
        const Mask<Real> failed_before = history >= one;

        // relative separation, lam = |b|, and its value lam_p at the peak for this mixity (7.43)
        const Real bn = min(Path::opening(path.end) * end_inverse[0], largest);
        const Real bt = min(Path::sliding(path.end) * end_inverse[1], largest);
        const Real lam2 = bn * bn + bt * bt;
        const Real elastic2 = square(bn * (1.0 / ratio[0])) + square(bt * (1.0 / ratio[1]));
        const Mask<Real> separated = lam2 > smallest * smallest;
        const Real lam = sqrt(select(separated, lam2, one)), elastic = sqrt(select(separated, elastic2, Real(4.0)));
        const Real peak = lam / elastic;

        // 1. onset, 2. growth to l1
        const Mask<Real> initiated = history > zero || (separated && elastic > one);
        const Real before = select(history > zero, history, peak);
        const Mask<Real> grows = separated && initiated && lam > before && !failed_before;
        const Real reached = select(grows, min(lam, one), before);

        InterfaceResult<kind, Real> result;
        result.GI = state[index::GI];
        result.GII = state[index::GII];
        result.Gdrop = state[index::Gdrop];
        if (any(grows)) {
            const Real from = min(max(before, peak), one), to = min(max(reached, peak), one);
            const Real released = select(grows, release_integral(from, to, peak), zero) / (lam * lam);
            result.GI = result.GI + toughness_scale[0] * bn * bn * released;
            result.GII = result.GII + toughness_scale[1] * bt * bt * released;
        }

        // 3. the secant, not stiffer than that of the virgin interface
        result.failed = initiated && reached >= one;
        const Real virgin = one / peak;
        const Shape<Real> shape = shape_at(reached, peak);
        const Real damaged = shape.value / reached;
        const Mask<Real> capped = !initiated || damaged >= virgin;
        const Real factor = select(result.failed, zero, select(capped, virgin, damaged));

        // 4. T_i = M sig_i b_i; where nothing is separated the old damage stays
        const auto mode_secant = [&](int mode, int damage) {
            const Real secant = factor * secant_scale[mode];
            return select(separated || result.failed, secant, stiffness[mode] * (1.0 - state[damage]));
        };
        result.normal_stiffness = mode_secant(0, index::Dn);
        result.shear_stiffness = mode_secant(1, index::Dt);
        result.dn = select(initiated, reached, history);
        result.dt = select(separated && !failed_before, peak, state[index::dt]);
        // Damage below 1 marks an interface that has not failed.
        const Real most(1.0 - 0.5 * std::numeric_limits<double>::epsilon());
        const auto damage = [&](int mode, int old) {
            return select(result.failed, one, select(separated, min(1.0 - factor * ratio[mode], most), state[old]));
        };
        result.normal_damage = damage(0, index::Dn);
        result.shear_damage = damage(1, index::Dt);
        if (!result.finish(path, contact, inverse_thickness, point)) return;

        if constexpr (wants_tangent<T>) {
            constexpr int n = components(kind);
            const auto& u = path.end;
            for (int i = 0; i < n * n; ++i) tangent.stiffness[i] = 0.0;
            const bool closed = u[0] < 0.0, free_normal = closed && contact.option != 2;
            if (!separated || result.failed) {
                const double normal = closed ? result.secant(u[0], contact) : result.failed ? 0.0 : stiffness[0];
                tangent(0, 0) = thickness * normal;
                for (int i = 1; i < n; ++i) tangent(i, i) = result.failed ? 0.0 : thickness * stiffness[1];
                return;
            }
            // dM = along_lam dlam + along_peak dlam_p
            double along_lam = 0.0, along_peak = 0.0;
            if (capped) {
                along_peak = -virgin * virgin;
            } else {
                along_peak = shape.by_peak / reached;
                if (grows) along_lam = (shape.by_lam - damaged) / lam;
            }
            double b[n], change[n];  // b_i, dM/du_i
            b[0] = bn;
            for (int i = 1; i < n; ++i) b[i] = u[i] * end_inverse[1];
            for (int i = 0; i < n; ++i) {
                const int mode = i > 0;
                const double by_b = along_lam * b[i] / lam +
                                    along_peak * peak * (b[i] / (lam * lam) - b[i] / square(ratio[mode] * elastic));
                change[i] = closed && i == 0 ? 0.0 : by_b * end_inverse[mode];
            }
            for (int j = 0; j < n; ++j) {
                if (!free_normal) tangent(0, j) = thickness * secant_scale[0] * u[0] * change[j];
                for (int i = 1; i < n; ++i) tangent(i, j) = thickness * secant_scale[1] * u[i] * change[j];
            }
            tangent(0, 0) += thickness * result.secant(u[0], contact);
            for (int i = 1; i < n; ++i) tangent(i, i) += thickness * result.shear_stiffness;
        }
    }

    // Both modes: k, sig, 1/u_c, p = u_e/u_c, sig u_c/2, sig/u_c.
    double stiffness[2], strength[2], end_inverse[2], ratio[2], toughness_scale[2], secant_scale[2];
    double alpha, fall, inverse_fall;  // fall: 1 - exp(-alpha)
    Contact contact;
    double thickness, inverse_thickness;

  private:
    // Sb(l; lam_p) and its derivatives.
    template <class Real>
    struct Shape {
        Real value, by_lam, by_peak;
    };
    template <class Real>
    Shape<Real> shape_at(const Real& l, const Real& peak) const {
        const Real inverse = 1.0 / (1.0 - peak);
        if (alpha == 0.0) return {(1.0 - l) * inverse, -inverse, (1.0 - l) * inverse * inverse};
        const Real fallen = -expm1(-alpha * (l - peak) * inverse);
        const Real slope = (alpha * inverse_fall) * (1.0 - fallen) * inverse;
        return {1.0 - fallen * inverse_fall, -slope, slope * (1.0 - l) * inverse};
    }

    // int_x0^x1 (Sb - l dSb/dl) dl, lam_p <= x0 <= x1 <= 1
    template <class Real>
    Real release_integral(const Real& x0, const Real& x1, const Real& peak) const {
        const Real range = 1.0 - peak, inverse = 1.0 / range;
        if (alpha == 0.0) return (x1 - x0) * inverse;
        const auto area = [&](const Real& x) {  // int_lam_p^x Sb dl
            const Real part = (x - peak) * inverse;
            return range * part * (1.0 - inverse_fall * AbaqusExponential::lag(alpha, alpha * part));
        };
        return 2.0 * (area(x1) - area(x0)) - (x1 * shape_at(x1, peak).value - x0 * shape_at(x0, peak).value);
    }
};

}  // namespace lode
