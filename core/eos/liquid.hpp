// What TAIT_LIQUID and SPH_LIQUID share (page 55, section 4; Nairn, 9.13): a pressure p(J*) of the volume relative to
// that of the liquid at zero pressure, J* = J J_init exp(-3 e), and Newtonian or rate-dependent viscosity,
//     sigma = -p I + 2 eta dev D,     D = DSTRAN/DTIME.
// A pressure law says what p, the bulk modulus K = -J* dp/dJ* and the energy are, in m = J* - 1.
#pragma once

#include <array>
#include <string>

#include "lode/elastic/isotropic_tangent.hpp"
#include "lode/hyperelastic/residual_strain.hpp"
#include "lode/material/description.hpp"
#include "lode/material/properties.hpp"

namespace lode::liquid {

inline constexpr unsigned served = LODE_SOLID | LODE_PLANE_STRAIN;
inline constexpr unsigned traits = LODE_FINITE_STRAIN | LODE_UNSYMMETRIC | LODE_HISTORY_STRESS | LODE_VISCOUS;

// 1-based indices. The table of NV pairs log10(rate), viscosity begins at TABLE.
enum Property { K0 = 1, ETA, FORM, ALPHA, BETA, PINIT, NV, TABLE };
enum Slot { EPSRES = 1, GDOT };
inline constexpr int most_pairs = 50;

inline constexpr lode_state states[] = {
    {"EPSRES", "residual strain, logarithm of the free stretch", 0.0},
    {"GDOT", "shear rate of the last increment, sqrt(2) abs(dev D)", 0.0},
};

// The optional entries after the constant that tells the two models apart; `form` describes that one.
constexpr std::array<lode_parameter, TABLE - 1 + 2 * most_pairs> make_parameters(const lode_parameter& form) {
    std::array<lode_parameter, TABLE - 1 + 2 * most_pairs> list{
        required("K0", "bulk modulus at zero pressure", "stress", above(0.0)),
        required("ETA", "viscosity", "stress time", at_least(0.0), "not used if there is a table"),
        form,
        optional("ALPHA", "linear thermal expansion", "1/temp", any_value(), 0.0),
        optional("BETA", "linear expansion per unit of field 1", "1/field", any_value(), 0.0),
        optional("PINIT", "pressure at F = I", "stress", any_value(), 0.0),
        optional("NV", "number of pairs in the table of viscosities", "-", code(0, most_pairs), 0.0),
    };
    for (int i = 0; i < most_pairs; ++i) {
        const auto at = static_cast<std::size_t>(TABLE - 1 + 2 * i);
        list[at] = optional("LGRATE", "log10 of a shear rate in the table", "log10(1/time)", any_value(), 0.0,
                            i == 0 ? "strictly increasing" : "");
        list[at + 1] = optional("ETARATE", "viscosity at that rate", "stress time", at_least(0.0), 0.0);
    }
    return list;
}

inline constexpr lode_algorithm algorithms[] = {
    {"mean strain rate of the increment", 0, 0.0, 1.0},
};

// exp(x) - 1 - x, of second order in x and formed as such where it would cancel.
template <class Real>
inline Real exp_remainder(const Real& x, const Real& expm1_x) {
    const Mask<Real> small = abs(x) < Real(0.3);
    if (!any(small)) return expm1_x - x;
    Real sum(1.0);
    for (int n = 12; n >= 3; --n) sum = 1.0 + (1.0 / n) * (x * sum);
    return select(small, 0.5 * (x * x) * sum, expm1_x - x);
}

template <class Real>
struct PressureState {
    Real pressure, bulk, energy;  // p, K, U per volume at zero pressure
};

// No viscosity, the same at all rates, or piecewise linear in the logarithm of the rate.
struct NoViscosity {
    static constexpr bool flows = false;
};
struct ConstantViscosity {
    static constexpr bool flows = true, depends_on_rate = false;
    double eta;

    template <class Real>
    LODE_INLINE Real operator()(const Real&) const {
        return Real(eta);
    }
};
struct TabulatedViscosity {
    static constexpr bool flows = true, depends_on_rate = true;
    int count = 0;
    double first_eta = 0.0;
    double log_rate[most_pairs] = {};  // natural logarithms
    double slope[most_pairs] = {};     // d eta/d(log rate) up to the next one

    template <class Real>
    LODE_INLINE Real operator()(const Real& rate) const {
        const Real x = log(rate);
        Real eta(first_eta);
        for (int i = 0; i + 1 < count; ++i)
            eta = eta + slope[i] * (min(max(x, Real(log_rate[i])), Real(log_rate[i + 1])) - log_rate[i]);
        return eta;
    }
    // d eta/d(log rate).
    double logarithmic_slope(double rate) const {
        const double x = std::log(rate);
        for (int i = 0; i + 1 < count; ++i)
            if (x >= log_rate[i] && x < log_rate[i + 1]) return slope[i];
        return 0.0;
    }
};

template <class Law, class Viscosity>
struct Kernel {
    Law law;
    Viscosity viscosity;
    ResidualStrain residual;
    double start;  // J_init - 1

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        constexpr int n = components(kind);
        State<Real>& state = point.state;
        const Real e = residual.end(increment, state[EPSRES]);
        const auto k = kinematics<kind>(increment.deformation_gradient());

        // J* - 1 and J* without cancellation
        Real m = k.j, J = k.jacobian;
        if (start != 0.0) {
            m = m + start + start * m;
            J = (1.0 + start) * J;
        }
        if (!residual.is_absent(e)) {
            const Real r = expm1(-3.0 * e);
            m = m + r + r * m;
            J = (1.0 + r) * J;
        }
        const auto p = law.at(m, J);

        Real gdot(0.0), eta(0.0);
        Stress<kind, Real> d;  // dev D
        const double per_time = increment.time_increment.inverse;
        if constexpr (Viscosity::flows) {
            d = Real(per_time) * deviator(increment.strain_increment);
            const Real rate_squared = 2.0 * double_contraction(d, d);
            gdot = sqrt(rate_squared);
            eta = viscosity(gdot);
            point.viscous_dissipation = eta * rate_squared * increment.time_increment.value;
        }
        const Mask<Real> sound = k.valid() && J > Real(0.0) && is_finite(p.pressure + p.energy + eta * gdot);
        if (!all(sound)) [[unlikely]]
            return point.fail(!sound, "det F <= 0, or the deformation is not finite");

        for (int i = 0; i < n; ++i) {
            point.stress[i] = i < 3 ? -p.pressure : Real(0.0);
            if constexpr (Viscosity::flows) point.stress[i] = point.stress[i] + 2.0 * eta * d[i];
        }
        point.elastic_energy = p.energy / J;

        if constexpr (wants_tangent<T>) {
            // (K - p) 1 (x) 1 + 2 eta dev D (x) 1 + (2 eta/DTIME) I_dev + 4 eta'/(gdot DTIME) dev D (x) dev D
            const double twice_rate = 2.0 * eta * per_time;
            set_isotropic(tangent, p.bulk - p.pressure - twice_rate / 3.0, twice_rate);
            if constexpr (Viscosity::flows) {
                double along = 0.0;  // 4 eta'/(gdot DTIME), eta' = d eta/d gdot
                if constexpr (Viscosity::depends_on_rate)
                    if (gdot > 0.0) along = 4.0 * per_time * viscosity.logarithmic_slope(gdot) / (gdot * gdot);
                for (int j = 0; j < n; ++j)
                    for (int i = 0; i < n; ++i) tangent(i, j) += d[i] * (along * d[j] + (j < 3 ? 2.0 * eta : 0.0));
                tangent.heat_rate = eta * gdot * gdot;
                const double heat = 4.0 * eta * per_time + 0.5 * along * gdot * gdot;
                for (int i = 0; i < n; ++i) tangent.heat_rate_strain[i] = heat * d[i];
            }
            if (residual.thermal_expansion != 0.0)
                for (int i = 0; i < 3; ++i) tangent.thermal_stress[i] = -3.0 * residual.thermal_expansion * p.bulk;
        }
        state.set(EPSRES, e);
        state.set(GDOT, gdot);
    }
};

template <class Law>
struct Liquid {
    explicit Liquid(const Properties& p, const Law& pressure_law)
        : law(pressure_law), residual{p[ALPHA], p[BETA]}, start(law.volume_at(p[PINIT])), eta(p[ETA]) {
        if (!(p[PINIT] > law.lowest_pressure()))
            p.refuse(PINIT, "> " + format_number(law.lowest_pressure()) + ": a liquid holds no more tension");
        if (!(start > -1.0)) p.refuse(PINIT, "lower: the liquid would have no volume left");
        if (p.code(NV) > 0) read_table(p);
    }

    std::string warnings() const {
        for (int i = 0; i + 1 < table.count; ++i) {
            double eta_end = table.first_eta;
            for (int k = 0; k <= i; ++k) eta_end += table.slope[k] * (table.log_rate[k + 1] - table.log_rate[k]);
            if (eta_end + table.slope[i] < 0.0)
                return "the viscous stress decreases with the rate on the way to pair " + std::to_string(i + 2) +
                       " of the table: the tangent is not positive there";
        }
        return "";
    }

    int required_state(AnalysisKind) const { return count_of(states); }

    template <AnalysisKind kind>
    void initial_stiffness(const Stress<kind, double>&, const State<double>&, Tangent<kind>& tangent) const {
        const auto p = law.at(start, 1.0 + start);
        set_isotropic(tangent, p.bulk - p.pressure, 0.0);
    }

    template <class F>
    LODE_INLINE void specialise(const F& f) const {
        if (table.count > 0) f(Kernel<Law, TabulatedViscosity>{law, table, residual, start});
        else if (eta > 0.0) f(Kernel<Law, ConstantViscosity>{law, {eta}, residual, start});
        else f(Kernel<Law, NoViscosity>{law, {}, residual, start});
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        specialise([&](const auto& k) LODE_INLINE_LAMBDA { k.update(increment, point, tangent); });
    }

    Law law;
    ResidualStrain residual;
    double start, eta;
    TabulatedViscosity table;

  private:
    void read_table(const Properties& p) {
        const int count = p.code(NV), last = TABLE + 2 * count - 1;
        if (p.count() < last)
            p.refuse("NV = " + std::to_string(count) + " needs NPROPS >= " + std::to_string(last) +
                     ", NPROPS = " + std::to_string(p.count()));
        table.count = count;
        table.first_eta = p[TABLE + 1];
        for (int i = 0; i < count; ++i) {
            table.log_rate[i] = std::log(10.0) * p[TABLE + 2 * i];
            if (i == 0) continue;
            const double width = table.log_rate[i] - table.log_rate[i - 1];
            const double before = p[TABLE + 2 * i - 1], after = p[TABLE + 2 * i + 1];
            if (!(width > 0.0))
                p.refuse(TABLE + 2 * i, "> " + format_number(p[TABLE + 2 * i - 2]) + ": the rates increase");
            if (after * std::exp(width) < before)
                p.refuse(TABLE + 2 * i + 1, ">= " + format_number(before * std::exp(-width)) +
                                                ": the viscous stress must not decrease with the rate");
            table.slope[i - 1] = (after - before) / width;
        }
    }
};

}  // namespace lode::liquid
