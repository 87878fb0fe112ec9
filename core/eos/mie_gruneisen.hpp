// MIE_GRUNEISEN: shock equation of state with optional strength (page 55, section 2; Nairn, 9.10). In the compression
// eta = 1 - J and the temperature T,
//     P = P_s(eta) + gamma rc [T - T0 exp(gamma eta)],     sigma = -P I + s/J,     rc = RHO0 CV,
// with P_s the isentrope through the reference state (shock_curve.hpp), in tension -U'(J), and s of finite_j2.hpp.
#pragma once

#include <variant>

#include "lode/elastic/isotropic_tangent.hpp"
#include "lode/eos/mie_gruneisen_description.hpp"
#include "lode/eos/shock_curve.hpp"
#include "lode/hyperelastic/finite_j2_flow.hpp"

namespace lode {
namespace mie_gruneisen {

struct Constants {
    double gamma, heat_capacity, T0;  // heat_capacity: rc
    double inverse_heat_capacity;     // 0 if there is none
    DilatationalEnergy tension;
    double shear, heat_fraction;
    bool is_adiabatic, local_basis;
};

// G = 0.
struct NoShear : finite_j2::NoFlow {};

template <class Flow>
struct Kernel {
    Constants c;
    Isentrope isentrope;
    finite_j2::Plasticity<Flow> plasticity;
    static constexpr bool has_shear = !std::is_same_v<Flow, NoShear>;

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        constexpr int n = components(kind);
        State<Real>& state = point.state;
        const Real theta_old = state[TREL], eta_old = state[ETA], work_old = state[PDISS], alpha = state[ALPHA];
        Stress<kind, Real> cpi;  // Cp^-1 - I
        if constexpr (has_shear)
            for (int i = 0; i < n; ++i) cpi[i] = state[CPI11 + i];

        const Deformation<kind, Real> total(increment, c.local_basis);
        const auto k = kinematics_of_gradient<kind>(total.h, total.jacobian);
        const Real eta = -k.j, J = k.jacobian;
        const Mask<Real> possible = k.valid() && is_finite(theta_old + eta_old + alpha);
        if (!all(possible)) [[unlikely]]
            return point.fail(!possible, "det F <= 0, or the deformation or the state is not finite");
        const Mask<Real> in_range = eta < Real(isentrope.curve().limit);
        if (!all(in_range)) [[unlikely]]
            return point.fail(!in_range,
                              "the compression 1 - J reaches the pole of the Hugoniot, or its bulk modulus vanishes: "
                              "KMAX > 1 limits the stiffness instead");

        // Deviator.
        const VolumeRatio<Real> v = c.tension.volume_ratio(k.j, J);
        finite_j2::Isochoric<kind, Real> r;
        const Matrix3<Real> f = finite_j2::plus_identity(k.h);
        Real inverse2(1.0), excess(0.0), work(0.0);
        Stress<kind, Real> d;  // dev(bbar)
        [[maybe_unused]] const auto law = law_of(increment, theta_old);
        if constexpr (has_shear) {
            inverse2 = square(reciprocal_cbrt(J));
            const auto trial = k.b + finite_j2::congruence<kind>(f, cpi);
            r = plasticity.respond(trial, Real(c.shear), inverse2, J, alpha, law, point.solves);
            d = Real(1.0 / c.shear) * r.s;
            excess = finite_j2::mean_excess(d);
            work = r.dalpha * r.measure * r.K;
        }

        // Temperature relative to T0.
        Real theta, reversible(0.0);
        if (c.is_adiabatic) {
            reversible = theta_old + (c.T0 + theta_old) * quick_expm1(Real(c.gamma * (eta - eta_old)));
            theta = reversible + increment.temperature_increment();
            if constexpr (Flow::yields) theta = theta + (c.heat_fraction * c.inverse_heat_capacity) * work;
        } else {
            const Real host = increment.temperature_end();
            const Mask<Real> absolute = host > Real(0.0) || Mask<Real>(c.T0 <= 0.0 || c.heat_capacity <= 0.0);
            if (!all(absolute)) [[unlikely]]
                return point.refuse(!absolute, "the absolute temperature TEMP + DTEMP", host, "> 0");
            theta = host - c.T0;
        }

        // Isentrope, and what the temperature is above it: T - T0 exp(gamma eta).
        const Real isentropic = c.T0 * quick_expm1(Real(c.gamma * eta)), above = theta - isentropic;
        const Mask<Real> compressed = eta > Real(0.0);
        Real energy(0.0), pressure(0.0);
        if (any(compressed)) {
            const Real x = max(eta, Real(0.0));
            energy = isentrope.energy(x);
            pressure = isentrope.hugoniot(x) + c.gamma * energy;
        }
        if (!all(compressed)) {
            energy = select(compressed, energy, c.tension.energy(v));
            pressure = select(compressed, pressure, -c.tension.derivative(v));
        }
        const Real heated = c.heat_capacity * above;
        pressure = pressure + c.gamma * heated;
        const Real internal = energy + heated;
        const Real shear_energy = 1.5 * c.shear * excess;

        if constexpr (Flow::yields) {
            if (any(r.yields)) {
                const auto flowed = finite_j2::inverse_plastic_strain<kind>(f, d, excess, inverse2);
                for (int i = 0; i < n; ++i) cpi[i] = select(r.yields, flowed[i], cpi[i]);
            }
        }
        Mask<Real> sound = is_finite(pressure + internal + shear_energy + work);
        if constexpr (has_shear) sound = sound && is_finite(finite_j2::sum_of(cpi));
        if (!all(sound)) [[unlikely]]
            return point.fail(!sound, "the stress is not finite");
        for (int i = 0; i < n; ++i) {
            point.stress[i] = i < 3 ? -pressure : Real(0.0);
            if constexpr (has_shear) point.stress[i] = point.stress[i] + v.inverse * r.s[i];
        }
        const Real work_total = work_old + work;
        // An explicit host adds the plastic work itself; EINT holds what of it is heat.
        point.elastic_energy = v.inverse * (shear_energy + (is_batch<Real> ? internal - work_total : energy));
        point.plastic_dissipation = v.inverse * work;
        const Mask<Real> stiff = eta > Real(isentrope.curve().stiff_from);
        if (any(stiff)) [[unlikely]]
            point.warn("the compression is beyond the KMAX limit: the Hugoniot bulk modulus is held");

        if constexpr (wants_tangent<T>) {
            // dP_s/deta
            const double slope = compressed ? isentrope.curve().slope_at(eta) + c.gamma * (pressure - c.gamma * heated)
                                            : v.inverse * (c.tension.stiffness(v) - c.tension.derivative(v));
            set_tangent(increment, v, r, alpha, work, law, pressure, slope,
                        {c.T0 + isentropic, c.T0 + theta, c.T0 + reversible, eta_old - eta}, tangent);
        }

        if constexpr (has_shear) {
            for (int i = 0; i < n; ++i) state.set(CPI11 + i, cpi[i]);
        } else {
            for (int i = 0; i < n; ++i) state.keep(CPI11 + i);
        }
        if constexpr (kind != AnalysisKind::solid) {
            state.keep(CPI13);
            state.keep(CPI23);
        }
        state.set(ALPHA, alpha + r.dalpha);
        state.set(TREL, theta);
        state.set(ETA, eta);
        state.set(PDISS, work_total);
        state.set(EINT, internal);
        state.set(XFLAG, select(stiff, Real(1.0), Real(0.0)));
    }

  private:
    struct Temperatures {
        double isentropic, end, reversible;  // T0 exp(gamma eta), T, T after the reversible part (THERM 1)
        double volume_change;                // J - J_n
    };

    template <AnalysisKind kind, class Real>
    LODE_INLINE auto law_of(const Increment<kind, Real>& increment, const Real& theta_old) const {
        if constexpr (Flow::feels_temperature) {
            const Real T = c.is_adiabatic ? Real(c.T0 + theta_old) : increment.temperature_end();
            return plasticity.flow.at(increment, T);
        } else if constexpr (Flow::yields) {
            return plasticity.flow;
        } else {
            return finite_j2::NoFlow{};
        }
    }

    // Section 2.6. `slope` is dP_s/deta.
    template <AnalysisKind kind, class Law>
    LODE_INLINE void set_tangent(const Increment<kind, double>& increment, const VolumeRatio<double>& v,
                                 const finite_j2::Isochoric<kind, double>& r, [[maybe_unused]] double alpha,
                                 double work, [[maybe_unused]] const Law& law, double pressure, double slope,
                                 const Temperatures& T, Tangent<kind>& tangent) const {
        const double thermal = c.gamma * c.heat_capacity;  // dP/dT
        double bulk = v.J * (slope - c.gamma * thermal * T.isentropic);
        if (c.is_adiabatic) bulk += v.J * c.gamma * thermal * T.reversible;
        for (int i = 0; i < 3; ++i) tangent.thermal_stress[i] = -thermal;
        const double rate = c.is_adiabatic ? 0.0 : v.inverse * increment.time_increment.inverse;
        const double volume_heat = -c.heat_capacity * c.gamma * T.end;
        double heat = volume_heat * T.volume_change, heat_by_temperature = -c.heat_capacity * c.gamma * T.volume_change;
        const double heat_by_volume = volume_heat * v.J;
        double work_by_volume = 0.0;

        if constexpr (!has_shear) {
            set_isotropic(tangent, bulk - pressure, 0.0);
        } else if constexpr (!Flow::yields) {
            plasticity.template set_tangent<kind>(r, nullptr, v.inverse, bulk - pressure, tangent);
        } else if (!r.yields) {
            plasticity.template set_tangent<kind>(r, nullptr, v.inverse, bulk - pressure, tangent);
        } else {
            const auto flow = plasticity.flow_rate(r);
            // plastic work: mY (K + K' dalpha) d(dalpha) + YCAU mY K dalpha tr D
            const double per_flow = r.measure * (r.K + r.slope * r.dalpha);
            if (plasticity.on_cauchy) work_by_volume = work;
            double volumetric = bulk - pressure;
            if (c.is_adiabatic) volumetric -= thermal * c.heat_fraction * c.inverse_heat_capacity * work_by_volume;
            plasticity.set_tangent(r, &flow, v.inverse, volumetric, tangent);
            if (c.is_adiabatic) {
                const double heating = thermal * c.heat_fraction * c.inverse_heat_capacity * per_flow;
                for (int j = 0; j < components(kind); ++j)
                    for (int i = 0; i < 3; ++i) tangent(i, j) -= heating * flow.dalpha[j];
            } else {
                heat += c.heat_fraction * work;
                const double by_flow = rate * c.heat_fraction * per_flow;
                for (int i = 0; i < components(kind); ++i) tangent.heat_rate_strain[i] = by_flow * flow.dalpha[i];
                if constexpr (Flow::feels_temperature) {
                    const double resistance = r.measure * law.temperature_slope(alpha, r.dalpha, r.K);
                    const double slower = flow.compliance * resistance;  // -d(dalpha)/dT
                    heat_by_temperature += c.heat_fraction * (r.dalpha * resistance - per_flow * slower);
                    const double stiffer = 3.0 * r.mubar * slower * v.inverse / r.Q;
                    for (int i = 0; i < components(kind); ++i) tangent.thermal_stress[i] += stiffer * r.s_trial[i];
                }
            }
        }
        tangent.heat_rate = rate * heat;
        tangent.heat_rate_temperature = rate * heat_by_temperature;
        for (int i = 0; i < 3; ++i)
            tangent.heat_rate_strain[i] += rate * (heat_by_volume + c.heat_fraction * work_by_volume - heat);
    }
};

}  // namespace mie_gruneisen

struct MieGruneisen {
    static constexpr const lode_model& description = mie_gruneisen::description;

    explicit MieGruneisen(const Properties& p) : kernel(make_kernel(p, table)) {}
    MieGruneisen(const MieGruneisen&) = delete;  // the kernel refers to the table
    MieGruneisen& operator=(const MieGruneisen&) = delete;

    int required_state(AnalysisKind) const { return mie_gruneisen::XFLAG; }

    template <AnalysisKind kind>
    void initial_stiffness(const Stress<kind, double>&, const State<double>&, Tangent<kind>& tangent) const {
        specialise([&](const auto& k) {
            set_isotropic(tangent, k.isentrope.curve().K0 - (2.0 / 3.0) * k.c.shear, 2.0 * k.c.shear);
        });
    }

    // Calls f with the kernel of the deviator at hand.
    template <class F>
    LODE_INLINE void specialise(const F& f) const {
        if (const auto* fluid = std::get_if<FluidKernel>(&kernel)) return f(*fluid);
        finite_j2::visit(*std::get_if<SolidKernel>(&kernel), f);
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        specialise([&](const auto& k) LODE_INLINE_LAMBDA { k.update(increment, point, tangent); });
    }

  private:
    using SolidKernel = finite_j2::AnyKernel<mie_gruneisen::Kernel>;
    using FluidKernel = mie_gruneisen::Kernel<mie_gruneisen::NoShear>;
    using Kernel = std::variant<FluidKernel, SolidKernel>;

    static Kernel make_kernel(const Properties& p, std::vector<double>& table) {
        using namespace mie_gruneisen;
        const double K0 = p[RHO0] * p[C0] * p[C0], rc = p[RHO0] * p[CV];
        const bool adiabatic = p.code(THERM) == 1;
        if (adiabatic && rc > 0.0 && !(p[T0] > 0.0)) p.refuse(T0, "> 0: THERM = 1 with CV > 0 needs it");
        const Constants c{p[GAMMA0], rc,     p[T0],     rc > 0.0 ? 1.0 / rc : 0.0, {p.code(UJ), K0},
                          p[G],      p[CHI], adiabatic, p.code(ORI) == 1};
        Isentrope isentrope(ShockCurve(K0, p[GAMMA0], p[S1], p[S2], p[S3], p[KMAX]));
        isentrope.tabulate(table);
        const finite_j2::FlowIndices indices{HLAW, SY, H1, TREF};
        const auto solid = finite_j2::with_flow<SolidKernel>(p, indices, [&](const auto& flow) -> SolidKernel {
            using Flow = std::decay_t<decltype(flow)>;
            return mie_gruneisen::Kernel<Flow>{c, isentrope, {flow, p.code(YCAU) == 1}};
        });
        if (c.shear == 0.0) return FluidKernel{c, isentrope, {}};
        return solid;
    }

    std::vector<double> table;  // of the isentrope
    Kernel kernel;
};

}  // namespace lode
