// What IDEAL_GAS and VDW_GAS share (page 55, section 3; Nairn, 9.12). With g the volume relative to the reference
// volume of the gas,
//     P = R T/(g - b) - a/g^2,     R = P0'/T0,     sigma = -(P - GAUGE P0) I,
// at the temperature of the host (THERM 0) or on the exact adiabat T (g - b)^(GAMMA - 1) = const (THERM 1).
#pragma once

#include "lode/material/description.hpp"
#include "lode/material/point.hpp"
#include "lode/material/properties.hpp"
#include "lode/tensor/kinematics.hpp"

namespace lode::gas {

inline constexpr unsigned served = LODE_SOLID | LODE_PLANE_STRAIN;
inline constexpr unsigned traits = LODE_FINITE_STRAIN | LODE_ELASTIC | LODE_HISTORY_STRESS | LODE_EQUATION_OF_STATE;

// 1-based STATEV indices.
enum Slot { TREL = 1, JM1, W, Q, S };
inline constexpr lode_state states[] = {
    {"TREL", "temperature - TINIT", 0.0},
    {"JM1", "volume ratio J - 1", 0.0},
    {"W", "work done on the gas by the absolute pressure, per initial volume of the point", 0.0},
    {"Q", "heat received, per initial volume of the point", 0.0},
    {"S", "change of entropy, per initial volume of the point", 0.0},
};

// The optional entries, the same in both models.
inline constexpr lode_parameter adiabatic_exponent =
    optional("GAMMA", "ratio Cp/Cv of the ideal gas", "-", above(1.0), 5.0 / 3.0, "5/3 monatomic, 7/5 diatomic");
inline constexpr lode_parameter gauge = optional("GAUGE", "pressure that acts", "code", code(0, 1), 1.0,
                                                 "1: stress from p - P0; 0: from the absolute pressure");
inline constexpr lode_parameter thermal_mode =
    optional("THERM", "thermal mode", "code", code(0, 1), 0.0, "0: temperature from the host; 1: adiabatic");
inline constexpr lode_parameter initial_temperature =
    optional_or_zero("TINIT", "initial temperature", "temp", above(0.0), 0.0, "0: T0");
inline constexpr lode_parameter gas_fraction =
    optional("PHI", "gas mass fraction of the point", "-", {0.0, 1.0, LODE_LOWER_OPEN}, 1.0);
inline constexpr lode_parameter point_volume =
    optional("JP", "initial volume of the point over the reference volume of its mass as gas", "-", above(0.0), 1.0,
             "density of the gas over that of the point");

inline constexpr lode_algorithm algorithms[] = {
    {"state function, exact for any increment", 0, 0.0, HUGE_VAL},
};

inline constexpr const char* failure = "det F <= 0, the volume is below that of the molecules, or it is not finite";

// `attracts`: with the van der Waals terms a and b, which an ideal gas does not pay for.
template <bool attracts>
struct Gas {
    double reference_pressure, reference_temperature;  // P0, T0
    double a = 0.0, b = 0.0;                           // attraction and covolume at the reference volume
    double offset;                                     // GAUGE P0
    double exponent;                                   // GAMMA - 1
    bool is_adiabatic;
    double start_temperature;    // TINIT
    double start_volume, scale;  // g_i = JP/PHI and its reciprocal: volumes of gas and of the point
    double R, heat_capacity;     // dP/dT of g - b = 1; Cv, per reference volume

    // `first` is the index of GAMMA.
    Gas(const Properties& p, int first, double attraction, double covolume)
        : reference_pressure(p[1]),
          reference_temperature(p[2]),
          a(attraction),
          b(covolume),
          offset(p[first + 1] * p[1]),
          exponent(p[first] - 1.0),
          is_adiabatic(p.code(first + 2) == 1),
          start_temperature(p[first + 3] > 0.0 ? p[first + 3] : p[2]),
          start_volume(p[first + 5] / p[first + 4]),
          scale(1.0 / start_volume),
          R((p[1] + a) * (1.0 - b) / p[2]),
          heat_capacity(R / exponent) {
        if (start_volume <= b)
            p.refuse(first + 5, "> " + format_number(b * p[first + 4]) + ": the volume of the molecules");
    }

    int required_state(AnalysisKind) const { return count_of(states); }

    // The adiabatic stiffness, which bounds the speed of sound in both modes.
    template <AnalysisKind kind>
    void initial_stiffness(const Stress<kind, double>&, const State<double>&, Tangent<kind>& tangent) const {
        const double g = start_volume, T = start_temperature, free = g - b;
        set_volumetric(tangent, g * ((1.0 + exponent) * R * T / (free * free) - 2.0 * a / (g * g * g)));
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        State<Real>& state = point.state;
        const Real theta_old = state[TREL], j_old = state[JM1], work_old = state[W], entropy_old = state[S];
        const auto k = kinematics<kind>(increment.deformation_gradient());

        // Volumes: now, at the start, free of molecules.
        const Real g = start_volume * k.jacobian, g_old = start_volume * (1.0 + j_old);
        const Real free = g - b, free_old = g_old - b;
        const Mask<Real> possible = k.valid() && free > Real(0.0) && free_old > Real(0.0);
        if (!all(possible)) [[unlikely]]
            return point.fail(!possible, failure);
        const Real dg = start_volume * (k.j - j_old);
        const Real log_growth = log1p(dg / free_old);  // ln of the ratio of the free volumes

        // Temperature relative to TINIT, and its part that compression alone brings.
        const Real T_old = start_temperature + theta_old;
        Real theta_reversible, theta;
        if (is_adiabatic) {  // (9.170)
            theta_reversible = theta_old + T_old * expm1(-exponent * log_growth);
            theta = theta_reversible + increment.temperature_increment();
        } else {
            theta = theta_reversible = increment.temperature_end() - start_temperature;
        }
        const Real temperature = start_temperature + theta;
        const Mask<Real> absolute = temperature > Real(0.0);
        if (!all(absolute)) [[unlikely]] {
            // An expansion that leaves no more than rounding errors of the temperature, or a host that cools below
            // zero.
            const Mask<Real> expanded = !absolute && theta_reversible <= Real(-start_temperature);
            if (is_adiabatic && any(expanded)) return point.fail(expanded, failure);
            return point.refuse(!absolute, "the absolute temperature of a gas", temperature, "> 0");
        }

        // P - P0 without cancellation, as P0 = R T0/(1 - b) - a.
        const double expansion = reference_pressure + a, start_excess = start_temperature - reference_temperature;
        const Real g_excess = (start_volume - 1.0) + start_volume * k.j;
        const Real inverse_free = 1.0 / free, inverse_g = attracts ? 1.0 / g : inverse_free;
        Real overpressure = (R * (theta + start_excess) - expansion * g_excess) * inverse_free;
        if constexpr (attracts) overpressure = overpressure + a * g_excess * (2.0 + g_excess) * square(inverse_g);
        const Real acting = overpressure + (reference_pressure - offset);

        // Work done on the gas and heat received since the start.
        Real attraction(0.0), attraction_step(0.0);  // a (1/g_i - 1/g), and its change in the increment
        if constexpr (attracts) {
            attraction = a * k.j * inverse_g;
            attraction_step = a * dg * inverse_g / g_old;
        }
        const Real energy = scale * (heat_capacity * theta + attraction);
        Real work = work_old, heat(0.0), entropy = entropy_old;
        if (is_adiabatic) {
            work = work + scale * (heat_capacity * (theta_reversible - theta_old) + attraction_step);
            const Real heating = theta - theta_reversible;
            if (any(heating != Real(0.0)))
                entropy = entropy + scale * heat_capacity * log1p(heating / (start_temperature + theta_reversible));
        } else {
            work = work + scale * (attraction_step - 0.5 * R * (temperature + T_old) * log_growth);
            entropy = entropy + scale * R * log_growth;
            const Real heating = theta - theta_old;
            if (any(heating != Real(0.0))) entropy = entropy + scale * heat_capacity * log1p(heating / T_old);
        }
        heat = energy - work;

        const Mask<Real> sound = is_finite(acting + work + entropy);
        if (!all(sound)) [[unlikely]]
            return point.fail(!sound, failure);

        for (int i = 0; i < 3; ++i) point.stress[i] = -acting;
        for (int i = 3; i < components(kind); ++i) point.stress[i] = Real(0.0);
        const Real inverse_J = 1.0 / k.jacobian;
        point.elastic_energy = energy * inverse_J;

        if constexpr (attracts) {
            // isothermal bulk modulus K_T <= 0
            const Mask<Real> unstable = R * temperature * (g * g * g) <= 2.0 * a * (free * free);
            if (any(unstable)) [[unlikely]]
                point.warn(
                    "the isothermal bulk modulus is not positive: the gas would condense, which is not modelled");
        }

        if constexpr (wants_tangent<T>) {
            double bulk =
                g * (R * temperature * inverse_free * inverse_free - 2.0 * a * inverse_g * inverse_g * inverse_g);
            if (is_adiabatic)
                bulk += g * exponent * R * (start_temperature + theta_reversible) * inverse_free * inverse_free;
            set_volumetric(tangent, bulk - acting);
            for (int i = 0; i < 3; ++i) tangent.thermal_stress[i] = -R * inverse_free;
            if (!is_adiabatic) {  // the heat that leaves an isothermal gas
                const double rate = scale * R * inverse_J * increment.time_increment.inverse;
                tangent.heat_rate = -rate * temperature * log_growth;
                tangent.heat_rate_temperature = -rate * log_growth;
                for (int i = 0; i < 3; ++i)
                    tangent.heat_rate_strain[i] = rate * temperature * (log_growth - g * inverse_free);
            }
        }

        state.set(TREL, theta);
        state.set(JM1, k.j);
        state.set(W, work);
        state.set(Q, heat);
        state.set(S, entropy);
    }

  private:
    template <AnalysisKind kind>
    LODE_INLINE static void set_volumetric(Tangent<kind>& tangent, double bulk) {
        constexpr int n = components(kind);
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) tangent(i, j) = i < 3 && j < 3 ? bulk : 0.0;
    }
};

}  // namespace lode::gas
