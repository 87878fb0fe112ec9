// PHASE_FIELD: the constitutive part of phase-field fracture (page 35, part B; Nairn, 6.3). sigma = g(phi) sigma+ +
// sigma- of the total strain; H = max over time of (Psi+ - Psi_i) drives the field equation GC ELL lap(phi) + SRC = 0
// of the host.
#pragma once

#include "lode/damage/degradation.hpp"
#include "lode/damage/effective_strain.hpp"
#include "lode/damage/energy_split.hpp"
#include "lode/material/thermal_block.hpp"

namespace lode {

struct PhaseField {
    static constexpr const lode_model& description = phase_field::description;

    explicit PhaseField(const Properties& p)
        : elastic(IsotropicModuli::from_young_poisson(p[phase_field::E], p[phase_field::NU])),
          degradation(p),
          toughness(p[phase_field::GC]),
          length(p[phase_field::ELL]),
          part(static_cast<EnergySplitCode>(p.code(phase_field::PART))),
          source(static_cast<Source>(p.code(phase_field::PHISRC))),
          expansion{p[phase_field::ALPHA], p[phase_field::BETA], 2},
          initiation_energy(p[phase_field::PSII]),
          method(static_cast<Method>(p.code(phase_field::METH))) {
        using namespace phase_field;
        if (part == EnergySplitCode::principal_strains && p[NU] < 0.0) p.refuse(NU, ">= 0 for PART 2");
        if (source == Source::temperature && p[ALPHA] != 0.0)
            p.refuse(ALPHA, "0 for PHISRC 2, where the temperature is the phase");
        if (initiation_energy < 0.0)
            initiation_energy = degradation.has_threshold() ? toughness / (2.0 * length * degradation.argument()) : 0.0;
        resistance = toughness / length;
        drive_scale = degradation.share() / resistance;
    }

    int required_state(AnalysisKind) const { return phase_field::count; }

    template <AnalysisKind kind>
    void initial_stiffness(const Stress<kind, double>&, const State<double>&, Tangent<kind>& tangent) const {
        elastic.set_stiffness<kind>(tangent);
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        using namespace phase_field;
        const Real one(1.0);
        State<Real>& state = point.state;
        if constexpr (kind == AnalysisKind::plane_stress)
            if (source == Source::local) [[unlikely]]
                return point.refuse(Mask<Real>(true), "the local solution does not serve plane stress (2,1): PHISRC",
                                    one, "0 or 2");
        if constexpr (kind == AnalysisKind::plane_stress)
            if (method == Method::increments) [[unlikely]]
                return point.refuse(Mask<Real>(true), "increments of stress do not serve plane stress (2,1): METH", one,
                                    "0 or 2");
        Step<kind, Real> step;
        Real residual;
        if (!expansion.of(increment, point, residual)) return;
        const Real phase_old = state[PHI];
        Real phase;
        if (!read_phase(increment, point, phase_old, phase)) return;

        // Step 1: effective strain.
        Mask<Real> fresh;
        Strain<kind, Real> strain = effective_strain::start(increment, point, elastic, fresh);
        Real lateral_old(0.0);
        if constexpr (kind == AnalysisKind::plane_stress)
            lateral_old = select(fresh, Real((-elastic.poisson / elastic.young) * trace(point.stress)),
                                 state[effective_strain::E33]);
        Start<full(kind), Real> start;
        if constexpr (kind != AnalysisKind::plane_stress)
            if (method == Method::increments) [[unlikely]]
                start = at_start<kind, Real>(strain, phase_old);
        for (int i = 0; i < components(kind); ++i) strain[i] = strain[i] + increment.strain_increment[i];
        if (!expansion.is_absent()) add_to_normals(strain, normal_components(kind), -residual);

        // Step 3: energies, history, local phase.
        const Real degraded_old = degradation_at_start(state, phase_old);
        step.degraded = degradation.at(phase);
        step.strain = with_third(strain, step.degraded.g);
        if (part == EnergySplitCode::dilation) step.split.by_dilation(elastic, step.strain);
        else step.split.by_principal_strains(elastic, step.strain, tangent);
        const Real history_old = state[HIST], drive = step.split.energy - initiation_energy;
        step.grows = drive > (1.0 + growth_tolerance) * history_old;
        step.history = select(step.grows, drive, history_old);
        step.advances = Mask<Real>(false);
        Real driving = step.history;
        Mask<Real> driven = step.grows;
        if (method != Method::total) [[unlikely]] {
            driving = history_old;
            driven = Mask<Real>(true);
        }
        if (source == Source::local && any(driven)) {
            const Real root = degradation.local_phase(Real(drive_scale * driving));
            const Mask<Real> ahead = driven && root > phase_old;
            phase = select(ahead, root, phase_old);
            step.advances = ahead && root < one;
            step.degraded = degradation.at(phase);
        }
        const auto& [g, slope, curvature] = step.degraded;

        // Step 4.
        const auto& split = step.split;
        if (method == Method::increments) [[unlikely]] {
            if constexpr (kind != AnalysisKind::plane_stress)
                point.stress = start.advanced(point.stress, split.active, split.passive, Real(phase - phase_old));
        } else {
            for (int i = 0; i < components(kind); ++i) {
                const int k = i < normal_components(kind) ? i : i - normal_components(kind) + 3;
                point.stress[i] = g * split.active[k] + split.passive[k];
            }
        }
        point.elastic_energy = g * split.energy + split.passive_energy;
        point.plastic_dissipation = 0.5 * (state[PSIP] + split.energy) * (degraded_old - g);
        const Real dissipated = state[W] + point.plastic_dissipation;
        if constexpr (kind == AnalysisKind::plane_stress)
            point.thickness_strain_increment = step.strain[2] - lateral_old + residual;
        Real drives = -slope * driving - resistance * phase;
        // The local solution has none, but for rounding.
        if (source == Source::local) drives = select(step.advances, Real(0.0), select(step.grows, drives, state[SRC]));
        const Real drives_rate = -curvature * driving - resistance;
        if constexpr (wants_tangent<T>) set_tangent(increment, step, start, drives, drives_rate, tangent);

        effective_strain::store<kind>(state, strain, step.strain[2]);
        const Real failed = select(phase >= one, one, state[FAILED]);
        state.set(HIST, step.history);
        state.set(PHI, phase);
        state.set(G, g);
        state.set(GP, slope);
        state.set(PSIP, split.energy);
        state.set(PSIM, split.passive_energy);
        state.set(W, dissipated);
        state.set(SRC, drives);
        state.set(DSRC, drives_rate);
        state.set(FAILED, failed);
    }

    enum class Source { field, local, temperature };
    // How stress follows the strain, and the phase the history: `total` and `staggered` sum nothing up, `increments` is
    // the source's d(sigma) = g d(sigma+) + d(sigma-) + g' sigma+ d(phi); both latter ones take H at the start.
    enum class Method { total, increments, staggered };

    IsotropicModuli elastic;
    Degradation degradation;
    double toughness, length;
    EnergySplitCode part;
    Source source;
    ResidualExpansion expansion;
    double initiation_energy;  // Psi_i
    double resistance = 0.0;   // GC/ELL
    double drive_scale = 0.0;  // (1 - k) ELL/GC
    Method method;

  private:
    // A zero increment must not grow H.
    static constexpr double growth_tolerance = 1e-10;

    // Plane stress carries eps33 along.
    static constexpr AnalysisKind full(AnalysisKind kind) {
        return kind == AnalysisKind::plane_stress ? AnalysisKind::plane_strain : kind;
    }
    // METH = 1: at the start, in the frame of the end.
    template <AnalysisKind kind, class Real>
    struct Start {
        Degraded<Real> degraded;
        Stress<kind, Real> active, passive;  // sigma+, sigma-

        // The stress after an increment. By value, so that the point of the caller stays in registers.
        [[gnu::noinline, gnu::cold]] Stress<kind, Real> advanced(Stress<kind, Real> stress,
                                                                 Stress<kind, Real> to_active,
                                                                 Stress<kind, Real> to_passive, Real phase) const {
            const Real rate = degraded.slope * phase;
            for (int i = 0; i < components(kind); ++i)
                stress[i] = stress[i] + degraded.g * (to_active[i] - active[i]) + (to_passive[i] - passive[i]) +
                            rate * active[i];
            return stress;
        }
    };
    template <AnalysisKind kind, class Real>
    struct Step {
        Strain<full(kind), Real> strain;
        Degraded<Real> degraded;
        EnergySplit<full(kind), Real> split;
        Real history;
        Mask<Real> grows, advances;  // H; the local phase, short of 1
    };
    template <AnalysisKind kind, class Real>
    [[gnu::noinline, gnu::cold]] Start<kind, Real> at_start(Strain<kind, Real> strain, Real phase) const {
        EnergySplit<kind, Real> split;
        NoTangent none;
        if (part == EnergySplitCode::dilation) split.by_dilation(elastic, strain);
        else split.by_principal_strains(elastic, strain, none);
        return {degradation.at(phase), split.active, split.passive};
    }

    // Step 2. False where the field of the host cannot be used.
    template <AnalysisKind kind, class Real>
    LODE_INLINE bool read_phase(const Increment<kind, Real>& increment, Point<kind, Real>& point, const Real& phase_old,
                                Real& phase) const {
        phase = phase_old;
        if (source == Source::temperature) {
            phase = max(increment.temperature_end(), Real(0.0));
        } else if (source == Source::field) {
            if (increment.field_count < 1) [[unlikely]] {
                point.refuse(Mask<Real>(true), "PHISRC 0 reads the phase from field variable 1: their number",
                             Real(0.0), ">= 1");
                return false;
            }
            phase = increment.field_end(1);
            if (!is_known(phase, point)) return false;
            phase = min(max(phase, Real(0.0)), Real(1.0));
        }
        return true;
    }

    // g(PHI) of the increment before. A fresh point has none yet.
    template <class Real>
    LODE_INLINE Real degradation_at_start(const State<Real>& state, const Real& phase_old) const {
        const Real stored = state[phase_field::G];
        const Mask<Real> unknown = stored == Real(0.0);
        if (!any(unknown)) [[likely]]
            return stored;
        return select(unknown, degradation.at(phase_old).g, stored);
    }

    // Section 8: eps33 of plane stress from sigma33 = 0 at this g.
    template <AnalysisKind kind, class Real>
    LODE_INLINE Strain<full(kind), Real> with_third(const Strain<kind, Real>& e, const Real& g) const {
        if constexpr (kind != AnalysisKind::plane_stress) {
            return e;
        } else {
            const double K = elastic.bulk, lambda = elastic.lame, mu = elastic.shear, nu = elastic.poisson;
            const Real t = e[0] + e[1];
            const Mask<Real> dilates = t >= Real(0.0);
            Real ratio;  // -eps33/t
            if (part == EnergySplitCode::dilation) {
                const Real shape = (2.0 / 3.0 * mu) * g;
                ratio = select(dilates, Real(nu / (1.0 - nu)), Real((K - shape) / (K + 2.0 * shape)));
            } else {
                const Real pull = select(dilates, Real(g * lambda), Real(lambda)),
                           resist = (2.0 * mu) * select(dilates, Real(1.0), g);
                ratio = pull / max(pull + resist, Real(1e-300));
            }
            return {{{e[0], e[1], -ratio * t, e[2]}}};
        }
    }

    template <AnalysisKind kind>
    LODE_INLINE void set_tangent(const Increment<kind, double>& increment, const Step<kind, double>& step,
                                 const Start<full(kind), double>& start, double drives, double drives_rate,
                                 Tangent<kind>& tangent) const {
        constexpr int n = components(kind);
        const bool sums = method == Method::increments, follows_history = method == Method::total;
        const double g = sums ? start.degraded.g : step.degraded.g, slope = step.degraded.slope;
        // g' d(phi)/dH of the local solution
        const double weight = step.advances && follows_history ? slope * slope / drives_rate : 0.0;
        Stress<kind, double> active;  // sigma+, as the in-plane strain feels it
        double third = 0.0;           // d(sigma+ : eps)/d(eps33), condensed
        if constexpr (kind != AnalysisKind::plane_stress) {
            step.split.set_tangent(part, elastic, g, weight, tangent);
            active = step.split.active;
        } else {
            double entries[16];
            Tangent<AnalysisKind::plane_strain> whole{entries};
            step.split.set_tangent(part, elastic, g, weight, whole);
            // Static condensation of eps33.
            constexpr int at[] = {0, 1, 3};
            const double pivot = whole(2, 2), inverse = pivot > 0.0 ? 1.0 / pivot : 0.0;
            third = inverse * step.split.active[2];
            for (int i = 0; i < n; ++i) {
                active[i] = step.split.active[at[i]] - whole(at[i], 2) * third;
                for (int j = 0; j < n; ++j)
                    tangent(i, j) = whole(at[i], at[j]) - whole(at[i], 2) * (inverse * whole(2, at[j]));
            }
        }
        if (expansion.thermal != 0.0) set_thermal_strain_tangent(tangent, [this](int) { return expansion.thermal; });
        if (source != Source::temperature) return;
        // The temperature is the phase: RPL = SRC/(GC ELL) and its derivatives.
        const double inverse = 1.0 / (toughness * length);
        tangent.heat_rate = inverse * drives;
        const bool follows = increment.temperature_end() >= 0.0;
        if (follows) tangent.heat_rate_temperature = inverse * drives_rate;
        for (int i = 0; i < n; ++i) {
            if (follows) tangent.thermal_stress[i] = sums ? start.degraded.slope * start.active[i] : slope * active[i];
            if (step.grows && follows_history) tangent.heat_rate_strain[i] = -inverse * slope * active[i];
        }
        // Through eps33 of plane stress.
        if (follows && step.grows && follows_history)
            tangent.heat_rate_temperature += inverse * slope * slope * third * step.split.active[2];
    }
};

}  // namespace lode
