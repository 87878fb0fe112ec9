// ISO_DAMAGE: an isotropic solid with one scalar damage variable (page 35, part A; Nairn, 6.2): sigma = max(1 - D,
// KRES) C eps. The surface E (1 - D) eps_eff = F(D) is eps_eff = e(delta) of the softening law, so that damage after an
// increment follows from the strain at its end by one inverse of the law.
#pragma once

#include "lode/damage/effective_strain.hpp"
#include "lode/damage/iso_damage_description.hpp"
#include "lode/damage/softening_law.hpp"
#include "lode/damage/softening_size.hpp"
#include "lode/damage/strain_metric.hpp"
#include "lode/material/thermal_block.hpp"

namespace lode {

struct IsoDamage {
    static constexpr const lode_model& description = iso_damage::description;

    explicit IsoDamage(const Properties& p)
        : elastic(IsotropicModuli::from_young_poisson(p[iso_damage::E], p[iso_damage::NU])),
          metric(static_cast<StrainMetric>(p.code(iso_damage::METRIC))),
          normal_law(p, iso_damage::LAW, iso_damage::A1_I, iso_damage::A2_I, iso_damage::FMIN),
          shear_law(is_mixed()
                        ? SofteningLaw(p, iso_damage::LAW_II, iso_damage::A1_II, iso_damage::A2_II, iso_damage::FMIN)
                        : SofteningLaw(SofteningLaw::linear, 0.0, 0.0, 0.01)),
          strength(p[iso_damage::SIGC]),
          toughness(p[iso_damage::GC]),
          shear_strength(p[iso_damage::TAUC]),
          shear_toughness(p[iso_damage::GIIC]),
          residual_stiffness(p[iso_damage::KRES]),
          expansion{p[iso_damage::ALPHA], p[iso_damage::BETA]},
          fixed_length(p[iso_damage::HFIX]),
          reduces_strength(p.code(iso_damage::HPOL) == 1),
          deletes(p.code(iso_damage::DELFLAG) == 1),
          steps(p.code(iso_damage::METH) == 1) {
        if (steps && metric != StrainMetric::energy) p.refuse(iso_damage::METH, "0 for METRIC 1, 2");
        if (!is_mixed()) return;
        if (shear_strength == 0.0) p.refuse(iso_damage::TAUC, "> 0 for METRIC 2");
        if (shear_toughness == 0.0) p.refuse(iso_damage::GIIC, "> 0 for METRIC 2");
    }

    int required_state(AnalysisKind) const { return iso_damage::count; }

    template <AnalysisKind kind>
    void initial_stiffness(const Stress<kind, double>&, const State<double>&, Tangent<kind>& tangent) const {
        elastic.set_stiffness<kind>(tangent);
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        using namespace iso_damage;
        const Real zero(0.0), one(1.0);
        State<Real>& state = point.state;
        Step<kind, Real> step;
        if (!expansion.of(increment, point, step.residual)) return;
        const Real stage = state[STATE];
        const Mask<Real> intact = stage == zero, failed_before = stage > Real(1.5);
        if (!set_size(increment, point, intact, step.size)) return;

        // Step 1: effective strain.
        Mask<Real> fresh;
        step.strain = effective_strain::start(increment, point, elastic, fresh);
        step.change = increment.strain_increment;
        if (!expansion.is_absent()) add_to_normals(step.change, normal_components(kind), -step.residual);
        for (int i = 0; i < components(kind); ++i) step.strain[i] = step.strain[i] + step.change[i];

        // Step 2: effective stress and energy.
        step.stress = elastic.stress<kind>(step.strain);
        step.energy = 0.5 * double_contraction(step.stress, step.strain);

        Damage<Real> damage{state[D], state[DELTA_N], state[DELTA_S]};
        const Real mode = state[MODE];
        Outcome<Real> outcome{failed_before, Mask<Real>(false), mode, zero, zero};
        [[maybe_unused]] Stress<kind, Real> gradient{};
        if (steps) [[unlikely]] {
            const RateStep<kind, Real> rate = step_by_rate(!failed_before, intact, step, damage, outcome, point.solves);
            damage = rate.damage;
            outcome = rate.outcome;
            gradient = rate.gradient;
        } else if (!all(failed_before)) {
            grow(!failed_before, intact, step, damage, outcome, tangent, point.solves);
        }

        // Step 6.
        const Real intactness = max(one - damage.value, Real(residual_stiffness));
        point.stress = intactness * step.stress;
        point.elastic_energy = intactness * step.energy;
        point.plastic_dissipation = outcome.dissipated;
        if constexpr (kind == AnalysisKind::plane_stress)
            point.thickness_strain_increment = step.residual - lateral<kind>() * trace(step.change);
        if constexpr (wants_tangent<T>) set_tangent(step, damage, outcome, gradient, intactness, tangent);

        const Mask<Real> damaged = !intact || outcome.grows || outcome.failed;
        const Real total = state[W] + outcome.dissipated, length = select(damaged, step.size.length, state[H]);
        effective_strain::store<kind>(state, step.strain, Real(-lateral<kind>() * trace(step.strain)));
        state.set(D, damage.value);
        state.set(DELTA_N, damage.normal);
        state.set(DELTA_S, damage.shear);
        state.set(STATE, select(outcome.failed, Real(2.0), select(damaged, one, zero)));
        state.set(W, total);
        state.set(H, length);
        state.set(MODE, outcome.mode);
        state.set(STATUS, deletes ? select(outcome.failed, zero, one) : one);
        state.keep(REL_S);
        state.keep(REL_G);
    }

    IsotropicModuli elastic;
    StrainMetric metric;
    SofteningLaw normal_law, shear_law;
    double strength, toughness, shear_strength, shear_toughness;
    double residual_stiffness;
    ResidualExpansion expansion;
    double fixed_length;
    bool reduces_strength, deletes;
    bool steps;  // METH = 1

  private:
    template <AnalysisKind kind, class Real>
    struct Step {
        Strain<kind, Real> change, strain;  // mechanical: of the increment, at its end
        Stress<kind, Real> stress;          // s~
        Real residual, energy;              // energy: Psi0
        SofteningSize<Real> size;
        MeasuredStrain<kind, Real> measured;
    };
    // D with the critical cracking strains that belong to it.
    template <class Real>
    struct Damage {
        Real value, normal, shear;
    };
    template <class Real>
    struct Outcome {
        Mask<Real> failed, grows;
        Real mode, dissipated;
        Real rate;  // dD/d(eps_eff) of the active strain
    };
    // A law and how far it has come.
    template <class Real>
    struct Branch {
        SofteningDirection<Real> direction;
        Real u_old;                                                 // delta/L at the start
        Mask<Real> reached, fails;                                  // surface; end of the law
        Real u = Real(0.0), damage = Real(0.0), slope = Real(0.0);  // slope: F'/M
    };

    bool is_mixed() const { return metric == StrainMetric::mixed_mode; }
    // -eps33/(eps11 + eps22) of plane stress, -eps22/eps11 of a bar.
    template <AnalysisKind kind>
    LODE_INLINE double lateral() const {
        return kind == AnalysisKind::uniaxial ? elastic.poisson : elastic.poisson / (1.0 - elastic.poisson);
    }

    // h and its limits; false where the point cannot be used.
    template <AnalysisKind kind, class Real>
    LODE_INLINE bool set_size(const Increment<kind, Real>& increment, Point<kind, Real>& point,
                              const Mask<Real>& intact, SofteningSize<Real>& size) const {
        using namespace iso_damage;
        if (!size.read(increment, point, {H, REL_S, REL_G}, intact, fixed_length)) return false;
        if (reduces_strength || all(size.frozen)) return true;
        if (!size.fits(point, normal_law.eta() * toughness * elastic.young / square(strength),
                       "the softening would snap back (refine, raise GC or lower SIGC): element length h"))
            return false;
        return !is_mixed() ||
               size.fits(point, shear_law.eta() * shear_toughness * elastic.shear / square(shear_strength),
                         "the softening in shear would snap back (refine, raise GIIC or lower TAUC): element length h");
    }

    template <class Real>
    LODE_INLINE SofteningDirection<Real> direction(const SofteningLaw& law, const SofteningSize<Real>& size, double sig,
                                                   double G, double modulus) const {
        SofteningDirection<Real> d(Real(size.strength * sig), Real(size.toughness * G / size.length), Real(modulus));
        if (reduces_strength) d.limit_strength(law);
        return d;
    }

    // Steps 3 to 5.
    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void grow(const Mask<Real>& alive, const Mask<Real>& intact, Step<kind, Real>& step,
                          Damage<Real>& damage, Outcome<Real>& outcome, T& tangent,
                          const SolveCounter<Real>& solves) const {
        Branch<Real> normal, shear;
        normal.direction = direction(normal_law, step.size, strength, toughness, elastic.young);
        if (is_mixed())
            shear.direction = direction(shear_law, step.size, shear_strength, shear_toughness, elastic.shear);
        // A host may start with damage alone (STATE 1, H = 0).
        const Mask<Real> preset = alive && !intact && !step.size.frozen;
        if (any(preset)) [[unlikely]] {
            damage.normal =
                select(preset, cracking_strain(normal_law, normal.direction, damage.value, Real(0.0), preset, solves),
                       damage.normal);
            if (is_mixed())
                damage.shear =
                    select(preset, cracking_strain(shear_law, shear.direction, damage.value, Real(0.0), preset, solves),
                           damage.shear);
        }
        // e(delta) = delta/D, at the start eps0.
        const Mask<Real> damaged = damage.value > Real(0.0);
        const Real inverse = 1.0 / select(damaged, damage.value, Real(1.0));
        const auto threshold = [&](const Branch<Real>& b, const Real& delta) {
            return Real((1.0 + softening_growth_tolerance) *
                        select(damaged, Real(delta * inverse), b.direction.onset_strain()));
        };
        const Real e_normal = threshold(normal, damage.normal);
        const Real e_shear = is_mixed() ? threshold(shear, damage.shear) : Real(0.0);
        auto& measured = step.measured;
        if (metric == StrainMetric::energy) {
            measured.normal = sqrt(positive_part(Real((4.0 * elastic.half_compliance) * step.energy)));
        } else {
            if (all(!alive || measured.is_below(metric, elastic, step.stress, e_normal, e_shear))) return;
            measured.measure(metric, elastic, step.stress, tangent);
        }
        normal.reached = alive && measured.normal > e_normal;
        shear.reached = is_mixed() ? alive && measured.shear > e_shear : Mask<Real>(false);
        if (!any(normal.reached || shear.reached)) return;

        soften(normal_law, measured.normal, damage.normal, normal, solves);
        if (is_mixed()) soften(shear_law, measured.shear, damage.shear, shear, solves);
        else shear.fails = Mask<Real>(false);
        const Mask<Real> fails = normal.fails || shear.fails;
        const Mask<Real> by_normal =
            is_mixed() ? normal.fails || (!shear.fails && normal.damage >= shear.damage) : Mask<Real>(true);
        const Real grown = select(by_normal, normal.damage, shear.damage);
        const Mask<Real> grows = (normal.reached || shear.reached) && !fails && grown > damage.value;
        const Real now = select(fails, Real(1.0), select(grows, grown, damage.value));

        // Dissipation of the active law.
        const Mask<Real> active = grows || fails;
        if (!is_mixed()) {
            outcome.dissipated = dissipation(normal_law, normal, damage.value, now, fails, solves);
        } else {
            Real by_tension(0.0), by_shear(0.0);
            if (any(active && by_normal))
                by_tension = dissipation(normal_law, normal, damage.value, now, fails, solves);
            if (any(active && !by_normal)) by_shear = dissipation(shear_law, shear, damage.value, now, fails, solves);
            outcome.dissipated = select(by_normal, by_tension, by_shear);
        }
        if (metric != StrainMetric::energy) {
            // Psi0/(M eps_act^2/2)
            const Real size = select(by_normal, Real((0.5 * elastic.young) * square(measured.normal)),
                                     Real((0.5 * elastic.shear) * square(measured.shear)));
            outcome.dissipated = outcome.dissipated * step.energy / select(active, size, Real(1.0));
        }
        outcome.dissipated = select(active, outcome.dissipated, Real(0.0));
        outcome.failed = outcome.failed || fails;
        outcome.grows = grows;
        outcome.mode = select(active, select(by_normal, Real(1.0), Real(2.0)), outcome.mode);
        if constexpr (wants_tangent<T>)
            outcome.rate = by_normal ? (1.0 / (1.0 + normal.slope) - now) / measured.normal
                                     : (1.0 / (1.0 + shear.slope) - now) / measured.shear;

        damage.value = now;
        if (!is_mixed()) {
            const Real u = select(fails, Real(normal_law.end()), normal.u);
            damage.normal = select(active, Real(normal.direction.length * u), damage.normal);
        } else {
            // The passive law follows.
            const Mask<Real> passive_shear = grows && by_normal, passive_normal = grows && !by_normal;
            Real delta_n = normal.direction.length * normal.u, delta_s = shear.direction.length * shear.u;
            if (any(passive_normal))
                delta_n =
                    select(by_normal, delta_n,
                           cracking_strain(normal_law, normal.direction, now, normal.u_old, passive_normal, solves));
            if (any(passive_shear))
                delta_s = select(by_normal,
                                 cracking_strain(shear_law, shear.direction, now, shear.u_old, passive_shear, solves),
                                 delta_s);
            delta_n = select(fails, Real(normal_law.end() * normal.direction.length), delta_n);
            delta_s = select(fails, Real(shear_law.end() * shear.direction.length), delta_s);
            damage.normal = select(active, delta_n, damage.normal);
            damage.shear = select(active, delta_s, damage.shear);
        }
    }

    // METH = 1 (Nairn, 6.2.3): d(delta) = sigma : d(eps)/(F (1 + F'/E)) at the rates of the start, from where the
    // strain of the start, drawn out, reaches the surface or the largest strain so far. METRIC 0 only. By value, so
    // that the point of the caller stays in registers.
    template <AnalysisKind kind, class Real>
    struct RateStep {
        Damage<Real> damage;
        Outcome<Real> outcome;
        Stress<kind, Real> gradient{};  // of the strain beyond the surface
    };
    template <AnalysisKind kind, class Real>
    [[gnu::noinline, gnu::cold]] RateStep<kind, Real> step_by_rate(Mask<Real> alive, Mask<Real> intact,
                                                                   Step<kind, Real> step, Damage<Real> damage,
                                                                   Outcome<Real> outcome,
                                                                   SolveCounter<Real> solves) const {
        const Real one(1.0), tiny(1e-300);
        Branch<Real> b;
        b.direction = direction(normal_law, step.size, strength, toughness, elastic.young);
        const Mask<Real> preset = alive && !intact && !step.size.frozen;
        if (any(preset))
            damage.normal =
                select(preset, cracking_strain(normal_law, b.direction, damage.value, Real(0.0), preset, solves),
                       damage.normal);
        const Real r = b.direction.brittleness, L = b.direction.length;
        b.u_old = damage.normal / L;
        const Softened<Real> s = normal_law.at(b.u_old);
        const Real surface = L * s.strain(r);  // e(delta)

        Strain<kind, Real> strain_old = step.strain;
        for (int i = 0; i < components(kind); ++i) strain_old[i] = strain_old[i] - step.change[i];
        const Stress<kind, Real> stress_old = elastic.stress<kind>(strain_old);
        const double compliance = 1.0 / elastic.young;
        const Real old_square = compliance * double_contraction(stress_old, strain_old),
                   square_now = (2.0 * compliance) * step.energy;
        const Real old = sqrt(max(old_square, tiny)), now = sqrt(max(square_now, tiny));
        // Where the last steps have left the surface, it is not reached again before the largest strain.
        const Real reached = max(surface, damage.shear);
        const Mask<Real> grows = alive && now > (1.0 + softening_growth_tolerance) * reached;
        // Where it leads nowhere, or there is no strain at the start, along the strain of the end.
        const Real stretch = reached / old;
        const Real beyond =
            (compliance * stretch * double_contraction(stress_old, step.strain) - square(reached)) / surface;
        const Mask<Real> from_start = old > 1e-6 * surface && beyond > Real(0.0);
        const Real excess = select(from_start, beyond, now - reached);
        const Real stiff = L * (1.0 + r * s.slope);
        b.u = b.u_old + select(grows, excess, Real(0.0)) / stiff;
        const Mask<Real> fails = grows && b.u >= Real(normal_law.end());
        b.u = select(fails, Real(normal_law.end()), b.u);
        const Softened<Real> at = normal_law.at(b.u);
        const Real strain = at.strain(r);
        const Mask<Real> softens = grows && !fails;
        const Real value = select(fails, one, select(softens, max(Real(b.u / strain), damage.value), damage.value));

        RateStep<kind, Real> result{damage, outcome};
        result.outcome.dissipated =
            select(grows, dissipation(normal_law, b, damage.value, value, fails, solves), Real(0.0));
        result.outcome.failed = outcome.failed || fails;
        result.outcome.grows = softens;
        result.outcome.mode = select(grows, one, outcome.mode);
        result.damage.value = value;
        result.damage.normal = select(grows, b.u * L, damage.normal);
        result.damage.shear = select(alive, max(damage.shear, now), damage.shear);
        if constexpr (std::is_same_v<Real, double>) {
            result.outcome.rate = r * at.phi() / (square(strain) * stiff);
            const double factor = compliance * (from_start ? stretch / surface : 1.0 / now);
            result.gradient = factor * (from_start ? stress_old : step.stress);
        }
        return result;
    }

    // The point of the law at eps_eff, where that is beyond the surface.
    template <class Real>
    LODE_INLINE void soften(const SofteningLaw& law, const Real& strain, const Real& delta, Branch<Real>& b,
                            const SolveCounter<Real>& solves) const {
        const Real inverse = 1.0 / b.direction.length, r = b.direction.brittleness;
        const Real x = inverse * strain;
        b.u_old = inverse * delta;
        b.fails = b.reached && x >= law.end_strain(r);
        const Mask<Real> softens = b.reached && !b.fails;
        if (!any(softens)) return;
        const Softened<Real> s = law.at_strain(x, r, b.u_old, softens, solves);
        b.u = s.u;
        b.slope = r * s.slope;
        b.damage = select(softens, s.u / select(softens, x, Real(1.0)), Real(0.0));
    }

    // delta(D), not beyond the end of the law; `u_start`: delta/L at smaller damage, or 0.
    template <class Real>
    LODE_INLINE Real cracking_strain(const SofteningLaw& law, const SofteningDirection<Real>& d, const Real& damage,
                                     const Real& u_start, const Mask<Real>& active,
                                     const SolveCounter<Real>& solves) const {
        const Mask<Real> before_end = damage < law.end_damage(d.brittleness), inside = active && before_end;
        const Real end(law.end());
        if (!any(inside)) return d.length * end;
        const Real u = law.at_damage(damage, d.brittleness, u_start, inside, solves).u;
        return d.length * select(before_end, min(u, end), end);
    }

    // Gbar(delta) - Gbar(delta_old), with what is left at the end of the law where it fails. Beyond D = 1 - KRES the
    // stress does not fall, and nothing is dissipated.
    template <class Real>
    LODE_INLINE Real dissipation(const SofteningLaw& law, const Branch<Real>& b, const Real& old, const Real& now,
                                 const Mask<Real>& fails, const SolveCounter<Real>& solves) const {
        const Real r = b.direction.brittleness;
        Real release = law.omega(b.u), release_old = law.omega(b.u_old);
        if (any(fails)) release = select(fails, law.end_release(r), release);
        if (residual_stiffness > 0.0) {
            const Real last(1.0 - residual_stiffness);
            const Mask<Real> rests = now > last;
            if (any(rests)) {
                // At the end of a law with a tail the stress jumps to the residual one.
                const Real end = law.end_strain(r);
                Real most = law.end_release(r) - (0.5 * residual_stiffness) * end * end / r;
                const Mask<Real> before_end = rests && last < law.end_damage(r);
                if (any(before_end)) {
                    const Real u = min(law.at_damage(last, r, Real(0.0), before_end, solves).u, Real(law.end()));
                    most = select(before_end, law.omega(u), most);
                }
                release = select(rests, most, release);
                release_old = select(old > last, most, release_old);
            }
        }
        return b.direction.energy() * (release - release_old);
    }

    // (1 - D) C - s~ (x) dD/d(eps)
    template <AnalysisKind kind>
    LODE_INLINE void set_tangent(const Step<kind, double>& step, const Damage<double>& damage,
                                 const Outcome<double>& outcome, const Stress<kind, double>& gradient,
                                 double intactness, Tangent<kind>& tangent) const {
        const bool by_damage = outcome.grows && 1.0 - damage.value >= residual_stiffness;
        Stress<kind, double> rate{};
        if (by_damage && steps) rate = outcome.rate * gradient;
        else if (by_damage)
            rate =
                outcome.rate * step.measured.gradient(metric, elastic, step.stress, is_mixed() && outcome.mode == 2.0);
        if constexpr (kind == AnalysisKind::uniaxial) {
            tangent(0, 0) = intactness * elastic.young - (by_damage ? step.stress[0] * rate[0] : 0.0);
        } else {
            const double coupling = intactness * elastic.coupling_stiffness<kind>();
            const double twice_shear = intactness * 2.0 * elastic.shear;
            if (by_damage) set_isotropic_less_dyad(tangent, coupling, twice_shear, step.stress, rate);
            else set_isotropic(tangent, coupling, twice_shear);
        }
        if (expansion.thermal != 0.0) set_thermal_strain_tangent(tangent, [this](int) { return expansion.thermal; });
    }
};

}  // namespace lode
