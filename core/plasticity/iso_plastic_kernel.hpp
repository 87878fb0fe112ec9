// The update of ISO_PLASTIC with one hardening law: one step of backward Euler (page 20, section 3) with its tangent,
// and what the increment leaves behind. The multiplier is written as the increment of equivalent plastic strain,
// dalpha = sqrt(2/3) |dep|, whose sum alpha is the hardening variable: q <= K, dep = (3/2) dalpha s/q.
#pragma once

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
class Kernel {
  public:
    Kernel(const Constants& constants, const Law& hardening) : c(constants), law(hardening), plane(c.elastic) {}

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        Step<kind, Real, Law> step;
        if (!begin(increment, point, step)) return;
        const Real trace_start = trace(point.stress);
        if (!correct(increment, point, step, tangent)) return;
        const Balance<Real> balance = balance_of(step);
        finish(increment, point, step, step.dalpha, balance, trace_start, tangent);
    }

    // Reads the point; false where it is refused.
    template <AnalysisKind kind, class Real>
    LODE_INLINE bool begin(const Increment<kind, Real>& increment, Point<kind, Real>& point,
                           Step<kind, Real, Law>& step) const {
        Surroundings<Real>& s = step.surroundings;
        step.strain = mechanical_strain(increment, point.state);
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
        set_time(s, increment.time_increment);
        step.at = law.at(s);
        step.keeps_plastic_strain = iso_plastic::Kernel<Law>::keeps(point);
        return true;
    }
    template <class Real>
    LODE_INLINE static void set_time(Surroundings<Real>& s, const TimeIncrement& time) {
        s.time = time;
        if constexpr (Law::feels_rate) s.log_rate = time.value > 0.0 ? -quick_log(time.value) : 0.0;
    }

    // Stress at the end of the step, from step.strain, step.alpha and point.stress; the elastic energy, and in plane
    // stress the thickness strain. False where the point is refused.
    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE bool correct(const Increment<kind, Real>& increment, Point<kind, Real>& point,
                             Step<kind, Real, Law>& step, T& tangent) const {
        step.start = law.start(step.at, step.alpha);
        step.end = step.start;
        step.dalpha = Real(0.0);
        if constexpr (kind == AnalysisKind::plane_stress)
            return return_in_plane_stress(increment, point, step, tangent);
        else if constexpr (kind == AnalysisKind::uniaxial) return return_in_tension(increment, point, step, tangent);
        else return return_radially(increment, point, step, tangent);
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
                if (c.thermal_expansion != 0.0)
                    set_thermal_strain_tangent(tangent, [this](int) { return c.thermal_expansion; });
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

    // The host keeps the plastic strain.
    template <AnalysisKind kind, class Real>
    LODE_INLINE static bool keeps(const Point<kind, Real>& point) {
        return point.state.has(EP + 5);
    }

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

    Constants c;
    Law law;

  private:
    // Of plane stress: A = E/(3(1 - nu)), rho = 2G/A.
    template <class Number>
    struct PlaneStress {
        Number shear, inverse_A, rho;
        Number sum_stiffness;       // E/(1 - nu)
        Number lateral_compliance;  // nu/E
        Number half_compliance, poisson;

        explicit PlaneStress(const IsotropicModuli& e)
            : shear(e.shear),
              inverse_A(3.0 * (1.0 - e.poisson) / e.young),
              rho(2.0 * e.shear * inverse_A),
              sum_stiffness(e.young / (1.0 - e.poisson)),
              lateral_compliance(e.poisson / e.young),
              half_compliance(e.half_compliance),
              poisson(e.poisson) {}
        PlaneStress(double K, const Number& G) : shear(G) {
            const Number E = 9.0 * K * G / (3.0 * K + G);
            poisson = (3.0 * K - 2.0 * G) / (2.0 * (3.0 * K + G));
            inverse_A = 3.0 * (1.0 - poisson) / E;
            rho = 2.0 * G * inverse_A;
            sum_stiffness = E / (1.0 - poisson);
            lateral_compliance = poisson / E;
            half_compliance = 0.5 / E;
        }
    };
    PlaneStress<double> plane;

    template <class At>
    LODE_INLINE auto plane_stress(const At& at) const {
        if constexpr (Law::changes_shear) {
            const auto G = shear(at);
            return PlaneStress<std::decay_t<decltype(G)>>(c.elastic.bulk, G);
        } else {
            return plane;
        }
    }
    template <class At>
    LODE_INLINE auto young(const At& at) const {
        if constexpr (Law::changes_shear) {
            const auto G = shear(at);
            return 9.0 * c.elastic.bulk * G / (3.0 * c.elastic.bulk + G);
        } else {
            return c.elastic.young;
        }
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
        else if constexpr (Law::remembers) return &law;
        else return nullptr;
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
    LODE_INLINE void solve(Step<kind, Real, Law>& step, const Real& q_trial) const {
        Mask<Real> solid = step.yields;
        if constexpr (Law::melts) solid = solid && !step.at.melted;
        const ReturnResult<Real> r = law.template solve<line>(step.at, q_trial, step.alpha, step.start, solid);
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

    // Three normal components: the trial deviator shrinks, s = (1 - 3G dalpha/q_trial) s_trial; the pressure is
    // elastic.
    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE bool return_radially(const Increment<kind, Real>& increment, Point<kind, Real>& point,
                                     Step<kind, Real, Law>& step, T& tangent) const {
        constexpr int n = components(kind);
        const auto G = shear(step.at);
        const double K = c.elastic.bulk;
        const Real mean = (1.0 / 3.0) * trace(point.stress) + K * trace(step.strain);
        const Stress<kind, Real> s_start = deviator(point.stress), strain = deviator(step.strain);
        const Stress<kind, Real> s_trial = s_start + Real(2.0 * G) * strain;
        const Real q_trial = sqrt(1.5 * double_contraction(s_trial, s_trial));

        Real theta = Real(1.0), inverse_q = Real(0.0), flow = Real(0.0);
        step.yields = yielding(step, q_trial);
        if (!has_rate(point, step)) return false;
        if (any(step.yields)) {
            inverse_q = 1.0 / select(step.yields, max(q_trial, Real(1e-300)), Real(1.0));
            solve<radial>(step, q_trial);
            if constexpr (Law::melts)
                if (any(step.at.melted)) [[unlikely]]
                    set_molten(step, q_trial / (3.0 * G), double_contraction(s_start, s_start) / (4.0 * G));
            flow = step.dalpha * inverse_q;
            theta = 1.0 - (3.0 * G) * flow;
            if constexpr (Law::melts) theta = select(step.at.melted, Real(0.0), theta);
        }
        if (step.keeps_plastic_strain)
            for (int i = 0; i < n; ++i) step.plastic_strain[i] = (i < 3 ? 1.5 : 3.0) * flow * s_trial[i];
        for (int i = 0; i < n; ++i) point.stress[i] = i < 3 ? theta * s_trial[i] + mean : theta * s_trial[i];
        point.elastic_energy = deviatoric_energy(step.at, theta * q_trial, mean);

        if constexpr (wants_tangent<T>) {
            if (step.yields) {
                // D = K 1x1 + 2G theta I_dev - 2G theta_bar n x n, n = s_trial/|s_trial| = sqrt(3/2) s_trial/q_trial
                const double share = law.template plastic_share<radial>(step.at, step.end.slope);
                const double theta_bar = share - (1.0 - theta);
                const double along_flow = 3.0 * G * theta_bar * inverse_q * inverse_q;
                set_isotropic_less_dyad(tangent, K - (2.0 / 3.0) * G * theta, 2.0 * G * theta, along_flow, s_trial);
                const HeatSlopes slopes = heat_slopes(step);
                const double heat = heat_per_strain(increment, slopes) * share * inverse_q;
                for (int i = 0; i < n; ++i) tangent.heat_rate_strain[i] = heat * s_trial[i];
                if constexpr (Law::feels_temperature) {
                    const double G_T = shear_by_temperature(step.at);
                    const double q_T = 3.0 * G_T * inverse_q * double_contraction(s_trial, strain);
                    const double dalpha_T =
                        (q_T - 3.0 * G_T * step.dalpha - slopes.flow_temperature) * share / (3.0 * G);
                    const double along = 3.0 * inverse_q * (G * flow * q_T - G_T * step.dalpha - G * dalpha_T);
                    for (int i = 0; i < n; ++i)
                        tangent.thermal_stress[i] = 2.0 * G_T * theta * strain[i] + along * s_trial[i];
                    set_heat_temperature(increment, slopes, dalpha_T, tangent);
                }
            } else {
                set_elastic<kind>(step.at, tangent);
                if constexpr (Law::changes_shear)
                    for (int i = 0; i < n; ++i)
                        tangent.thermal_stress[i] = 2.0 * shear_by_temperature(step.at) * strain[i];
            }
            if constexpr (Law::feels_temperature)
                for (int i = 0; i < 3; ++i) tangent.thermal_stress[i] -= 3.0 * K * c.thermal_expansion;
        }
        return true;
    }

    // sigma33 = 0. The multiplier mu (dep = mu s) is replaced by t = 1/(1 + A mu), which stays in [0, 1]; laws that
    // feel the rate take ln(1 - t), in which the logarithm of dalpha is nearly straight.
    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE bool return_in_plane_stress(const Increment<kind, Real>& increment, Point<kind, Real>& point,
                                            Step<kind, Real, Law>& step, T& tangent) const {
        const auto e = plane_stress(step.at);
        const Stress<kind, Real> start = point.stress;
        const Real de_sum = step.strain[0] + step.strain[1], de_difference = step.strain[1] - step.strain[0];
        const Real S = start[0] + start[1] + e.sum_stiffness * de_sum;
        const Real D = start[1] - start[0] + 2.0 * e.shear * de_difference;
        const Real tau = start[2] + e.shear * step.strain[2];
        const Real sum = 0.25 * (S * S), shear_part = 0.75 * (D * D) + 3.0 * (tau * tau);
        const Real q_trial = sqrt(sum + shear_part);

        Real t = Real(1.0), b = Real(1.0);
        for (int i = 0; i < 4; ++i) step.plastic_strain[i] = Real(0.0);
        point.stress[0] = 0.5 * (S - D), point.stress[1] = 0.5 * (S + D), point.stress[2] = tau;
        step.yields = yielding(step, q_trial);
        if (!has_rate(point, step)) return false;
        if (any(step.yields)) {
            t = solve_in_plane_stress(step, e, sum, shear_part, q_trial);
            if constexpr (Law::melts)
                if (any(step.at.melted)) [[unlikely]] {
                    set_molten(step, q_trial / (3.0 * e.shear), stored_energy(e, start));
                    t = select(step.at.melted, Real(0.0), t);
                }
            b = t + e.rho * (1.0 - t);
            // mu = (1 - t)/(A t), 1 + 2G mu = b/t: the stress over t stays finite when the yield stress falls to zero.
            const Real inverse_b = 1.0 / b, D_over_t = D * inverse_b, tau_over_t = tau * inverse_b;
            point.stress[0] = select(step.yields, 0.5 * t * (S - D_over_t), point.stress[0]);
            point.stress[1] = select(step.yields, 0.5 * t * (S + D_over_t), point.stress[1]);
            point.stress[2] = select(step.yields, t * tau_over_t, point.stress[2]);
            const Real mu_t = e.inverse_A * (1.0 - t);
            step.plastic_strain[0] = (1.0 / 6.0) * mu_t * (S - 3.0 * D_over_t);
            step.plastic_strain[1] = (1.0 / 6.0) * mu_t * (S + 3.0 * D_over_t);
            step.plastic_strain[2] = Real(0.0) - (step.plastic_strain[0] + step.plastic_strain[1]);
            step.plastic_strain[3] = 2.0 * mu_t * tau_over_t;
        }
        point.elastic_energy = stored_energy(e, point.stress);
        point.thickness_strain_increment =
            e.lateral_compliance * (trace(start) - trace(point.stress)) + step.plastic_strain[2];

        if constexpr (wants_tangent<T>) {
            const auto strain_change = Vector<double, 3>{{de_sum, de_difference, step.strain[2]}};
            if (step.yields) set_plane_stress_tangent(increment, point.stress, step, e, t, b, strain_change, tangent);
            else {
                set_elastic<kind>(step.at, tangent);
                if constexpr (Law::feels_temperature)
                    set_from_modes(temperature_modes(step.at, e, strain_change, {{0.0, 0.0, 0.0}}, 0.0),
                                   tangent.thermal_stress);
            }
        }
        return true;
    }

    template <AnalysisKind kind, class Real, class E>
    LODE_INLINE Real solve_in_plane_stress(Step<kind, Real, Law>& step, const E& e, const Real& sum,
                                           const Real& shear_part, const Real& q_trial) const {
        Mask<Real> solid = step.yields;
        if constexpr (Law::melts) solid = solid && !step.at.melted;
        const auto rho = e.rho;
        const auto A_factor = (2.0 / 3.0) * e.inverse_A;
        // As a function of 1 - t. Everything by value: a reference would keep the point in memory.
        const auto residual = [sum, shear_part, rho, A_factor, alpha = step.alpha, at = step.at,
                               hardening = law](const Real& gone) {
            // Q = sqrt(S^2/4 + shear/b^2) with its two derivatives at the price of one root and one division.
            const Real x = 1.0 - gone, b_x = x + rho * gone;
            const Real Q_b = sqrt(sum * (b_x * b_x) + shear_part);
            const Real inverse = 1.0 / (b_x * Q_b), inverse_b = inverse * Q_b;
            const Real Q = Q_b * inverse_b, w = (rho - 1.0) * shear_part * inverse_b * inverse;
            const Real Q_slope = w, Q_bend = 3.0 * (rho - 1.0) * w * inverse_b - w * w * (b_x * b_x) * inverse;
            const Real dalpha = A_factor * gone * Q;
            const Real dalpha_slope = A_factor * (gone * Q_slope - Q);
            const Real dalpha_bend = A_factor * (gone * Q_bend - 2.0 * Q_slope);
            const FlowStress<Real> k = hardening.flow(at, alpha, dalpha);
            // Derivatives by t.
            return ReturnTrial<Real>{
                x * Q - k.value, Q + x * Q_slope - k.slope * dalpha_slope,
                2.0 * Q_slope + x * Q_bend - k.slope * dalpha_bend - k.curvature * (dalpha_slope * dalpha_slope),
                dalpha, k};
        };
        const Real tolerance = return_tolerance * q_trial;
        const Real start = select(solid, step.start.value / q_trial, Real(1.0));
        if constexpr (Law::feels_rate) {
            // t = 1 - exp(y)
            const auto in_logarithm = [residual](const Real& y) {
                const Real gone = quick_exp(y);
                auto r = residual(gone);
                r.curvature = gone * (gone * r.curvature - r.slope);
                r.slope = Real(0.0) - gone * r.slope;
                return r;
            };
            const Real first = quick_log(max(1.0 - start, Real(1e-12)));
            // Where the stress at the smallest multiplier is below K the point hardly flows.
            const Real lowest(-690.0);
            const Mask<Real> flows = solid && in_logarithm(lowest).value > Real(0.0);
            const auto root =
                solve_bracketed<Slope::decreasing>(in_logarithm, lowest, Real(0.0), first, tolerance, flows);
            set_return(step, {root.last.dalpha, root.last.flow}, flows);
            step.yields = step.yields && (flows || !solid);
            return select(flows, 1.0 - quick_exp(root.x), Real(1.0));
        } else {
            const auto of_t = [residual](const Real& x) { return residual(1.0 - x); };
            const auto root = solve_bracketed<Slope::increasing>(of_t, Real(0.0), Real(1.0), start, tolerance, solid);
            set_return(step, {root.last.dalpha, root.last.flow}, solid);
            return select(solid, root.x, Real(1.0));
        }
    }

    // In the modes 11 + 22, 22 - 11, 12 of plane stress: the stress by temperature, times 1 + 2G mu or 1 + A mu, at
    // constant multiplier: -C a + C_T (de - mu P sigma).
    template <class At, class E>
    LODE_INLINE Vector<double, 3> temperature_modes(const At& at, const E& e, const Vector<double, 3>& de,
                                                    const Vector<double, 3>& P_sigma, double mu) const {
        Vector<double, 3> v{{-2.0 * c.thermal_expansion * e.sum_stiffness, 0.0, 0.0}};
        if constexpr (Law::changes_shear) {
            const double G_T = shear_by_temperature(at), K = c.elastic.bulk;
            const double sum_by_shear = 54.0 * K * K / square(3.0 * K + 4.0 * e.shear);
            v[0] += sum_by_shear * G_T * (de[0] - mu * P_sigma[0]);
            v[1] += 2.0 * G_T * (de[1] - mu * P_sigma[1]);
            v[2] += G_T * (de[2] - mu * P_sigma[2]);
        }
        return v;
    }
    LODE_INLINE static void set_from_modes(const Vector<double, 3>& v, double* stress) {
        stress[0] = 0.5 * (v[0] - v[1]);
        stress[1] = 0.5 * (v[0] + v[1]);
        stress[2] = v[2];
    }

    template <AnalysisKind kind, class E>
    LODE_INLINE void set_plane_stress_tangent(const Increment<kind, double>& increment, const Stress<kind, double>& s,
                                              const Step<kind, double, Law>& step, const E& e, double t, double b,
                                              const Vector<double, 3>& de, Tangent<kind>& tangent) const {
        // D = Xi - radial N x N/(radial P sigma : N + (2/3) q^2 H), Xi = (C^-1 + mu P)^-1, N = Xi P sigma
        const double H = step.end.slope;
        const double mu = e.inverse_A * (1.0 - t) / max(t, 1e-300);
        const double xi_sum = t * e.sum_stiffness, xi_difference = 2.0 * e.shear * t / b;
        const double xi_coupling = 0.5 * (xi_sum - xi_difference), xi_normal = xi_coupling + xi_difference;
        const Stress<kind, double> P_sigma{
            {(1.0 / 3.0) * (2.0 * s[0] - s[1]), (1.0 / 3.0) * (2.0 * s[1] - s[0]), 2.0 * s[2]}};
        const Stress<kind, double> N{{xi_normal * P_sigma[0] + xi_coupling * P_sigma[1],
                                      xi_coupling * P_sigma[0] + xi_normal * P_sigma[1],
                                      0.5 * xi_difference * P_sigma[2]}};
        const auto along = [](const auto& a, const auto& v) { return a[0] * v[0] + a[1] * v[1] + a[2] * v[2]; };
        const double P_sigma_N = along(P_sigma, N);
        const double q_squared = s[0] * s[0] + s[1] * s[1] - s[0] * s[1] + 3.0 * s[2] * s[2];
        const double radial_part = 1.5 * (1.0 - (2.0 / 3.0) * mu * H);
        const double denominator = radial_part * P_sigma_N + (2.0 / 3.0) * q_squared * H;
        const double inverse = denominator > 0.0 ? 1.0 / denominator : 0.0;
        const double factor = radial_part * inverse;
        set_isotropic_less_dyad(tangent, xi_coupling, xi_difference, factor, N);
        // dalpha = (2/3) mu q: d(dalpha) = (2/3)(q dmu + mu dq), dmu = q factor N, dq = (3/(2q)) P sigma D, and
        // P sigma D = (1 - factor P sigma : N) N
        const double q = sqrt(q_squared), inverse_q = q > 0.0 ? 1.0 / q : 0.0;
        const HeatSlopes slopes = heat_slopes(step);
        const double heat = heat_per_strain(increment, slopes) *
                            ((2.0 / 3.0) * q * factor + mu * inverse_q * (1.0 - factor * P_sigma_N));
        for (int j = 0; j < 3; ++j) tangent.heat_rate_strain[j] = heat * N[j];
        if constexpr (Law::feels_temperature) {
            Vector<double, 3> modes =
                temperature_modes(step.at, e, de, {{P_sigma[0] + P_sigma[1], P_sigma[1] - P_sigma[0], P_sigma[2]}}, mu);
            modes[0] *= t;
            modes[1] *= t / b;
            modes[2] *= t / b;
            double change[3];
            set_from_modes(modes, change);
            const double mu_T = (radial_part * along(P_sigma, change) - q * slopes.flow_temperature) * inverse;
            for (int i = 0; i < 3; ++i) tangent.thermal_stress[i] = change[i] - mu_T * N[i];
            const double q_T = 1.5 * inverse_q * along(P_sigma, tangent.thermal_stress);
            set_heat_temperature(increment, slopes, (2.0 / 3.0) * (q * mu_T + mu * q_T), tangent);
        }
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE bool return_in_tension(const Increment<kind, Real>& increment, Point<kind, Real>& point,
                                       Step<kind, Real, Law>& step, T& tangent) const {
        const auto E = young(step.at);
        const Real start = point.stress[0], trial = start + E * step.strain[0];
        const Real sign = select(trial < Real(0.0), Real(-1.0), Real(1.0)), q_trial = abs(trial);
        step.yields = yielding(step, q_trial);
        if (!has_rate(point, step)) return false;
        if (any(step.yields)) {
            solve<axial>(step, q_trial);
            if constexpr (Law::melts)
                if (any(step.at.melted)) [[unlikely]]
                    set_molten(step, q_trial / E, start * start / (2.0 * E));
        }
        const Real plastic = sign * step.dalpha;
        point.stress[0] = trial - E * plastic;
        if constexpr (Law::melts) point.stress[0] = select(step.at.melted, Real(0.0), point.stress[0]);
        if (step.keeps_plastic_strain) step.plastic_strain = {{plastic, -0.5 * plastic, -0.5 * plastic}};
        if constexpr (Law::changes_shear) point.elastic_energy = point.stress[0] * point.stress[0] / (2.0 * E);
        else point.elastic_energy = c.elastic.energy(point.stress);

        if constexpr (wants_tangent<T>) {
            double E_T = 0.0;
            if constexpr (Law::changes_shear) {
                const double K = c.elastic.bulk;
                E_T = 27.0 * K * K * shear_by_temperature(step.at) / square(3.0 * K + shear(step.at));
            }
            const double elastic_T = E_T * step.strain[0] - E * c.thermal_expansion;
            if (step.yields) {
                const double H = step.end.slope;
                const double share = law.template plastic_share<axial>(step.at, H);
                tangent(0, 0) = H * share;
                const HeatSlopes slopes = heat_slopes(step);
                tangent.heat_rate_strain[0] = heat_per_strain(increment, slopes) * sign * share;
                if constexpr (Law::feels_temperature) {
                    const double dalpha_T =
                        (sign * elastic_T - E_T * step.dalpha - slopes.flow_temperature) * share / E;
                    tangent.thermal_stress[0] = elastic_T - sign * (E_T * step.dalpha + E * dalpha_T);
                    set_heat_temperature(increment, slopes, dalpha_T, tangent);
                }
            } else {
                tangent(0, 0) = E;
                if constexpr (Law::feels_temperature) tangent.thermal_stress[0] = elastic_T;
            }
        }
        return true;
    }

    // s:s/(4G) + p^2/(2K)
    template <class At, class Real>
    LODE_INLINE Real deviatoric_energy(const At& at, const Real& q, const Real& mean) const {
        if constexpr (Law::changes_shear) return q * q / (6.0 * shear(at)) + mean * mean * (0.5 / c.elastic.bulk);
        else
            return c.elastic.half_compliance * ((2.0 / 3.0) * (1.0 + c.elastic.poisson) * (q * q) +
                                                3.0 * (1.0 - 2.0 * c.elastic.poisson) * (mean * mean));
    }
    // sigma:C^-1:sigma/2 in plane stress
    template <class E, AnalysisKind kind, class Real>
    LODE_INLINE static Real stored_energy(const E& e, const Stress<kind, Real>& s) {
        const Real sum = trace(s);
        return e.half_compliance * ((1.0 + e.poisson) * double_contraction(s, s) - e.poisson * (sum * sum));
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

    template <class At>
    LODE_INLINE double shear_by_temperature(const At& at) const {
        if constexpr (requires { law.shear_temperature_factor(at); })
            return c.elastic.shear * law.shear_temperature_factor(at);
        else return 0.0;
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
