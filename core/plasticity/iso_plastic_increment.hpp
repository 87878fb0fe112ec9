// What every increment of ISO_PLASTIC begins and ends with, whatever the kind: thermal strain, temperature, the yield
// test, heat, state (page 20, section 1; page 25).
#pragma once

#include "lode/elastic/known_field.hpp"
#include "lode/material/thermal_block.hpp"
#include "lode/plasticity/iso_plastic_description.hpp"
#include "lode/plasticity/iso_plastic_laws.hpp"
#include "lode/plasticity/plastic_strain.hpp"
#include "lode/plasticity/softening_scale.hpp"
#include "lode/tensor/rotation.hpp"

namespace lode::iso_plastic {

// What the constants mean, whatever the hardening law.
struct Constants {
    IsotropicModuli elastic;
    ThermalBlock thermal;
    double thermal_expansion, moisture_expansion;
    double reference_length;
    bool needs_absolute_temperature;
};

// Plastic strain of an increment: 11, 22, 33 and the shears of the kind.
template <AnalysisKind kind>
inline constexpr int plastic_components = kind == AnalysisKind::uniaxial ? 3 : components(plastic_strain_layout(kind));

// A step, and what it leaves.
template <AnalysisKind kind, class Real, class Law>
struct Step {
    Strain<kind, Real> strain;  // mechanical part
    Real alpha;                 // at the start
    Surroundings<Real> surroundings;
    typename Law::template At<Real> at;
    FlowStress<Real> start, end;  // K
    Mask<Real> yields;
    Real dalpha;
    bool keeps_plastic_strain;
    Vector<Real, plastic_components<kind>> plastic_strain;
    Real released;  // stored energy that melting sets free
};

// Sums over an increment.
template <class Real>
struct Balance {
    Real source_heat, work;  // heat by the source rule, plastic work
};

template <class Law>
class IncrementRules {
  public:
    IncrementRules(const Constants& constants, const Law& hardening) : c(constants), law(hardening) {}

    // Reads the point; false where it is refused.
    template <AnalysisKind kind, class Real>
    LODE_INLINE bool begin(const Increment<kind, Real>& increment, Point<kind, Real>& point,
                           Step<kind, Real, Law>& step) const {
        Surroundings<Real>& s = step.surroundings;
        step.strain = mechanical_strain(increment, point.state);
        if (c.thermal_expansion != 0.0 || c.moisture_expansion != 0.0)
            if (!is_known(step.strain[0], point, "temperature or field 1 on entry is not finite")) return false;
        step.alpha = point.state[EQPS];
        if constexpr (Law::softens)
            if (law_softens() && !softening_scale(increment, point, c.reference_length, unloading<kind>(),
                                                  law.steepest_slope(), s.scale))
                return false;
        if (Law::feels_temperature || c.thermal.is_thermoelastic())
            s.temperature = c.thermal.temperature(increment, point.state);
        if (c.needs_absolute_temperature && !c.thermal.is_absolute(point, s.temperature)) [[unlikely]]
            return false;
        if constexpr (Law::changes_shear) s.pressure = (-1.0 / 3.0) * trace(point.stress);
        if constexpr (Law::remembers)
            if (const DislocationHardening* memory = memory_of_law())
                s.densities = memory->initial(Densities<Real>{point.state[RC], point.state[RW]});
        s.time = increment.time_increment;
        // In place, where a law can: a copy of many members would wait for the stores before it.
        if constexpr (requires { law.set(step.at, s, step.alpha); }) law.set(step.at, s, step.alpha);
        else step.at = law.at(s);
        step.keeps_plastic_strain = point.state.has(EP + 5);
        return true;
    }

    template <AnalysisKind kind, class Real>
    LODE_INLINE Balance<Real> balance_of(const Step<kind, Real, Law>& step) const {
        const PlasticWork<Real> w = law.work(step.at, step.alpha, step.dalpha, step.start, step.end);
        Balance<Real> b;
        b.source_heat = w.friction * step.dalpha;
        b.work = b.source_heat + w.stored;
        if constexpr (Law::melts)
            if (any(step.at.melted)) [[unlikely]] {
                b.source_heat = select(step.at.melted, step.released, b.source_heat);
                b.work = select(step.at.melted, step.released, b.work);
            }
        return b;
    }

    // Energies, heat and state of an increment whose steps gave `dalpha` and `balance`; step.end is that of the last.
    // Returns the heat that a host gets, per volume.
    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE Real finish(const Increment<kind, Real>& increment, Point<kind, Real>& point,
                            const Step<kind, Real, Law>& step, const Real& dalpha, const Balance<Real>& balance,
                            const Real& trace_start, T& tangent) const {
        auto& state = point.state;
        point.plastic_dissipation = balance.work;
        const Real heat = c.thermal.plastic_heat(balance.source_heat, balance.work);
        Real thermoelastic(0.0), volume_strain(0.0);
        if (c.thermal.is_thermoelastic()) {
            volume_strain = total_volume_strain(increment, point, trace_start);
            thermoelastic = c.thermal.thermoelastic_heat(step.surroundings.temperature,
                                                         (-3.0 * c.elastic.bulk * c.thermal_expansion) * volume_strain);
        }
        if constexpr (wants_tangent<T>) {
            c.thermal.set_heat_rate(tangent, increment, heat + thermoelastic);
            if constexpr (!Law::feels_temperature)
                if (c.thermal_expansion != 0.0) set_thermal_strain_by(tangent);
            if (c.thermal.is_thermoelastic() && !c.thermal.heats_itself())
                set_thermoelastic_tangent(increment, step.surroundings.temperature, volume_strain, tangent);
        }
        if constexpr (kind == AnalysisKind::plane_stress)
            if (c.thermal_expansion != 0.0 || c.moisture_expansion != 0.0)
                point.thickness_strain_increment = point.thickness_strain_increment + free_strain(increment, state);
        if constexpr (Law::remembers)
            if (memory_of_law() != nullptr)
                for (int i = TAD; i < RC; ++i) state.keep(i);
        c.thermal.store(increment, state, balance.work, heat, thermoelastic);
        if (step.keeps_plastic_strain) add_plastic_strain(increment, point, step.plastic_strain);
        const Real alpha = state[EQPS] + dalpha;
        if constexpr (Law::remembers) store_memory(state, step, alpha);
        state.set(EQPS, alpha);
        state.set(RATE, dalpha * increment.time_increment.inverse);
        state.set(FLOW, step.end.value);
        state.set(YT, thermal_part(step));
        return c.thermal.heats_itself() ? Real(0.0) : heat + thermoelastic;
    }

    template <AnalysisKind kind>
    void set_initial_stiffness(Tangent<kind>& tangent) const {
        c.elastic.template set_stiffness<kind>(tangent);
    }

    Constants c;
    Law law;

  protected:
    // G of the increment.
    template <class At>
    LODE_INLINE auto shear(const At& at) const {
        if constexpr (Law::changes_shear) return c.elastic.shear * at.shear_ratio;
        else return c.elastic.shear;
    }

    // q <= K with the relative tolerance of section 1.
    template <class Real>
    LODE_INLINE static Mask<Real> exceeds(const Real& q_trial, const Real& yield_stress) {
        return q_trial - yield_stress > yield_tolerance * max(q_trial, yield_stress);
    }

    template <AnalysisKind kind, class At>
    LODE_INLINE void set_elastic(const At& at, Tangent<kind>& tangent) const {
        if constexpr (Law::changes_shear) {
            const double G = shear(at), K = c.elastic.bulk;
            const double E = 9.0 * K * G / (3.0 * K + G), nu = (3.0 * K - 2.0 * G) / (2.0 * (3.0 * K + G));
            IsotropicModuli::from_young_poisson(E, nu).template set_stiffness<kind>(tangent);
        } else {
            c.elastic.template set_stiffness<kind>(tangent);
        }
    }

    // Which lanes leave the elastic range. An increment of nothing in no time is a host's probe: it is elastic whatever
    // the rate has made of the stress.
    template <AnalysisKind kind, class Real>
    LODE_INLINE Mask<Real> yielding(const Step<kind, Real, Law>& step, const Real& q_trial) const {
        Mask<Real> yields = exceeds(q_trial, step.start.value);
        if constexpr (Law::feels_rate)
            if (step.surroundings.time.value <= 0.0) [[unlikely]] {
                Mask<Real> moves(false);
                for (int i = 0; i < components(kind); ++i) moves = moves || step.strain[i] != Real(0.0);
                yields = yields && moves;
            }
        if constexpr (Law::melts) yields = yields || step.at.melted;
        return yields;
    }

    // Flow needs a rate where the law has a memory.
    template <AnalysisKind kind, class Real>
    LODE_INLINE bool has_rate(Point<kind, Real>& point, const Step<kind, Real, Law>& step) const {
        if constexpr (Law::remembers)
            if (step.surroundings.time.value <= 0.0 && memory_of_law() != nullptr && any(step.yields)) [[unlikely]] {
                point.refuse(step.yields, "HLAW 7 flows at a rate: DTIME", Real(0.0), "> 0");
                return false;
            }
        return true;
    }

    // The multiplier in the lanes that yield. What is molten keeps no deviator: dalpha = q_trial/S.
    template <Line line, AnalysisKind kind, class Real>
    LODE_INLINE void solve(Step<kind, Real, Law>& step, const Real& q_trial, const SolveCounter<Real>& solves) const {
        Mask<Real> solid = step.yields;
        if constexpr (Law::melts) solid = solid && !step.at.melted;
        const ReturnResult<Real> r = law.template solve<line>(step.at, q_trial, step.alpha, step.start, solid, solves);
        set_return(step, r, solid);
    }

    // A return of nothing is elastic: flow can be too slow to be a number.
    template <AnalysisKind kind, class Real>
    LODE_INLINE static void set_return(Step<kind, Real, Law>& step, const ReturnResult<Real>& r,
                                       const Mask<Real>& solid) {
        step.dalpha = select(solid, r.dalpha, Real(0.0));
        if constexpr (Law::feels_rate) step.yields = step.yields && (!solid || step.dalpha > Real(0.0));
        step.end.value = select(solid, r.flow.value, step.end.value);
        step.end.slope = select(solid, r.flow.slope, step.end.slope);
    }

    template <AnalysisKind kind, class Real>
    LODE_INLINE static void set_molten(Step<kind, Real, Law>& step, const Real& dalpha, const Real& released) {
        const Mask<Real>& molten = step.at.melted;
        step.dalpha = select(molten, dalpha, step.dalpha);
        step.end.value = select(molten, Real(0.0), step.end.value);
        step.end.slope = select(molten, Real(0.0), step.end.slope);
        step.released = released;
    }

    // dPhi by dalpha and by temperature (page 25, section 4).
    template <AnalysisKind kind>
    LODE_INLINE HeatSlopes heat_slopes(const Step<kind, double, Law>& step) const {
        if constexpr (Law::feels_temperature) {
            if constexpr (Law::melts)
                if (step.at.melted) return {};
            if (step.dalpha <= 0.0) return {};
            return law.slopes(step.at, step.alpha, step.dalpha, step.start, step.end);
        } else {
            return {.source_strain = law.work(step.at, step.alpha, step.dalpha, step.start, step.end).friction,
                    .work_strain = step.end.value};
        }
    }

    template <AnalysisKind kind>
    LODE_INLINE double heat_per_strain(const Increment<kind, double>& increment, const HeatSlopes& slopes) const {
        if (c.thermal.heats_itself()) return 0.0;
        return c.thermal.plastic_heat(slopes.source_strain, slopes.work_strain) * increment.time_increment.inverse;
    }

    template <AnalysisKind kind>
    LODE_INLINE void set_heat_temperature(const Increment<kind, double>& increment, const HeatSlopes& slopes,
                                          double dalpha_T, Tangent<kind>& tangent) const {
        if (c.thermal.heats_itself()) return;
        const double constant_strain = c.thermal.plastic_heat(slopes.source_temperature, slopes.work_temperature);
        tangent.heat_rate_temperature =
            heat_per_strain(increment, slopes) * dalpha_T + constant_strain * increment.time_increment.inverse;
    }

    template <class At>
    LODE_INLINE double shear_by_temperature(const At& at) const {
        if constexpr (requires { law.shear_temperature_factor(at); })
            return c.elastic.shear * law.shear_temperature_factor(at);
        else return 0.0;
    }

  private:
    template <AnalysisKind kind>
    LODE_INLINE double unloading() const {
        if constexpr (kind == AnalysisKind::plane_stress) return c.elastic.young / (2.0 * (1.0 - c.elastic.poisson));
        else if constexpr (kind == AnalysisKind::uniaxial) return c.elastic.young;
        else return 3.0 * c.elastic.shear;
    }

    LODE_INLINE bool law_softens() const {
        if constexpr (requires { law.is_softening(); }) return law.is_softening();
        else return Law::softens;
    }

    LODE_INLINE const DislocationHardening* memory_of_law() const {
        if constexpr (requires { law.dislocations(); }) return law.dislocations();
        else return nullptr;
    }

    // Strain without stress, per direction.
    template <AnalysisKind kind, class Real>
    LODE_INLINE Real free_strain(const Increment<kind, Real>& increment, const State<Real>& state) const {
        Real strain(0.0);
        if (c.thermal_expansion != 0.0)
            strain = strain + c.thermal_expansion * c.thermal.temperature_increment(increment, state);
        if (c.moisture_expansion != 0.0) strain = strain + c.moisture_expansion * increment.field_increment(1);
        return strain;
    }

    template <AnalysisKind kind, class Real>
    LODE_INLINE Strain<kind, Real> mechanical_strain(const Increment<kind, Real>& increment,
                                                     const State<Real>& state) const {
        Strain<kind, Real> strain = increment.strain_increment;
        if (c.thermal_expansion != 0.0 || c.moisture_expansion != 0.0)
            add_to_normals(strain, normal_components(kind), Real(0.0) - free_strain(increment, state));
        return strain;
    }

    // Thermal strain included. In plane stress and one dimension from the stress: plastic flow keeps the volume.
    template <AnalysisKind kind, class Real>
    LODE_INLINE Real total_volume_strain(const Increment<kind, Real>& increment, const Point<kind, Real>& point,
                                         const Real& trace_start) const {
        if constexpr (normal_components(kind) == 3) return trace(increment.strain_increment);
        else
            return 3.0 * free_strain(increment, point.state) +
                   (trace(point.stress) - trace_start) * (1.0 / (3.0 * c.elastic.bulk));
    }

    // DDSDDT and DRPLDT of the thermal strain. The deviator and its heat do not feel one that is equal in all
    // directions.
    template <AnalysisKind kind>
    LODE_INLINE void set_thermal_strain_by(Tangent<kind>& tangent) const {
        if constexpr (normal_components(kind) == 3)
            for (int i = 0; i < 3; ++i) tangent.thermal_stress[i] = -3.0 * c.elastic.bulk * c.thermal_expansion;
        else set_thermal_strain_tangent(tangent, [this](int) { return c.thermal_expansion; });
    }

    // What H_is adds.
    template <AnalysisKind kind>
    LODE_INLINE void set_thermoelastic_tangent(const Increment<kind, double>& increment, double theta,
                                               double volume_strain, Tangent<kind>& tangent) const {
        constexpr int normals = normal_components(kind);
        const double a = c.thermal_expansion * increment.time_increment.inverse, T = c.thermal.absolute(theta);
        const double K = c.elastic.bulk;
        if constexpr (normals == 3) {
            for (int i = 0; i < 3; ++i) tangent.heat_rate_strain[i] -= 3.0 * K * a * T;
            tangent.heat_rate_temperature -= 3.0 * K * a * volume_strain;
        } else {
            double stress_T = 0.0;
            for (int i = 0; i < normals; ++i) {
                stress_T += tangent.thermal_stress[i];
                for (int j = 0; j < components(kind); ++j) tangent.heat_rate_strain[j] -= a * T * tangent(i, j);
            }
            const double volume_T = 3.0 * c.thermal_expansion + stress_T / (3.0 * K);
            tangent.heat_rate_temperature -= 3.0 * K * a * (volume_strain + T * volume_T);
        }
    }

    template <AnalysisKind kind, class Real>
    LODE_INLINE Real thermal_part(const Step<kind, Real, Law>& step) const {
        if constexpr (requires { law.thermal_part(step.at, step.alpha, step.dalpha); })
            return law.thermal_part(step.at, step.alpha + step.dalpha, step.end.value);
        else return Real(0.0);
    }

    template <AnalysisKind kind, class Real>
    LODE_INLINE void store_memory(State<Real>& state, const Step<kind, Real, Law>& step, const Real& alpha) const {
        const DislocationHardening* memory = memory_of_law();
        if (memory == nullptr) return;
        const Densities<Real> d = memory->evolved(memory->at(step.surroundings), step.alpha, step.dalpha);
        const Real f = memory->wall_fraction(alpha);
        state.set(RC, d.interior);
        state.set(RW, d.wall);
        state.set(DCELL, memory->cell_size(d, f));
        state.set(FW, f);
    }

    template <AnalysisKind kind, class Real>
    LODE_INLINE void add_plastic_strain(const Increment<kind, Real>& increment, Point<kind, Real>& point,
                                        const Vector<Real, plastic_components<kind>>& plastic_strain) const {
        if constexpr (kind == AnalysisKind::uniaxial) {
            for (int i = 0; i < 3; ++i) {
                const Real sum = point.state[EP + i] + plastic_strain[i];
                point.state.set(EP + i, sum);
            }
        } else {
            Strain<plastic_strain_layout(kind), Real> strain;
            for (int i = 0; i < plastic_components<kind>; ++i) strain[i] = plastic_strain[i];
            store_plastic_strain(increment, point, strain);
        }
    }
};

}  // namespace lode::iso_plastic
