// HE_ISO_PLASTIC: neo-Hookean solid with J2 plasticity (page 55, section 1; Nairn, 9.11),
//     sigma = s/J + U'(J*) I,     s = Jres G dev(bbar),
// with bbar of the elastic deformation F* Cp^-1 F*^T, F* = F exp(-e). The isochoric part is in finite_j2.hpp.
#pragma once

#include <variant>

#include "lode/elastic/isotropic_moduli.hpp"
#include "lode/hyperelastic/finite_j2_flow.hpp"
#include "lode/hyperelastic/he_iso_plastic_description.hpp"
#include "lode/hyperelastic/plane_stress.hpp"

namespace lode {
namespace he_iso_plastic {

struct Constants {
    IsotropicModuli moduli;
    DilatationalEnergy dilatation;
    ResidualStrain residual;
    double heat_fraction;
    bool local_basis;
};

template <class Flow>
struct Kernel {
    Constants c;
    finite_j2::Plasticity<Flow> plasticity;

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        constexpr AnalysisKind full = with_thickness(kind);
        constexpr int n = components(full);
        State<Real>& state = point.state;
        const Real e = c.residual.end(increment, state[EPSRES]);
        const Real alpha = state[ALPHA_P], work_old = state[PDISS];
        Real f33m1 = state[F33M1];
        Stress<full, Real> cpi;  // Cp^-1 - I
        for (int i = 0; i < n; ++i) cpi[i] = state[CPI11 + i];
        const Real unused[2] = {state[CPI13], state[CPI23]};  // in the plane kinds

        auto k = mechanical(increment, e);
        const Real expansion = c.residual.is_absent(e) ? Real(1.0) : exp(3.0 * e);  // Jres
        const Real shear = expansion * c.moduli.shear;
        // be - I of the trial state; plane stress: with F33* = 1
        Matrix3<Real> f = finite_j2::plus_identity(k.h);
        auto trial = k.b + finite_j2::congruence<full>(f, cpi);
        const Mask<Real> possible = k.valid() && is_finite(trace(trial) + alpha);
        if (!all(possible)) [[unlikely]]
            return point.fail(!possible, "det F <= 0, or the deformation or the state is not finite");

        const auto law = law_of(increment);
        if constexpr (kind == AnalysisKind::plane_stress) {
            const ThicknessEquation<Real, decltype(law)> equation{*this,      law,   trial,     cpi[2], k.j,
                                                                  k.jacobian, shear, expansion, alpha};
            const auto root =
                solve_thickness(equation, thickness_of_state(f33m1, e), equation.scale(k.b), point.solves);
            if (!all(root.converged)) [[unlikely]]
                return point.fail(!root.converged, "no thickness stretch makes the stress 33 vanish");
            set_thickness(k, 1.0 + root.d, root.d);
            f(2, 2) = 1.0 + root.d;
            trial[2] = k.b[2] + square(f(2, 2)) * cpi[2];
        }

        const VolumeRatio<Real> v = c.dilatation.volume_ratio(k.j, k.jacobian);
        const Real inverse2 = square(reciprocal_cbrt(v.J)), J = expansion * v.J;
        const Real inverse_J = v.inverse / expansion;
        const auto r = plasticity.respond(trial, shear, inverse2, J, alpha, law, point.solves);

        auto stress = inverse_J * r.s;
        add_to_normals(stress, 3, c.dilatation.derivative(v));
        const auto d = (1.0 / shear) * r.s;  // dev(bbar)
        const Real excess = finite_j2::mean_excess(d);
        point.elastic_energy = v.inverse * (c.dilatation.energy(v) + 1.5 * c.moduli.shear * excess);
        const Real work = r.dalpha * r.measure * r.K;
        Real dissipated(0.0);
        if (any(r.yields)) {
            dissipated = work * finite_j2::dissipation_ratio(d, excess);
            const auto flowed = finite_j2::inverse_plastic_strain<full>(f, d, excess, inverse2);
            for (int i = 0; i < n; ++i) cpi[i] = select(r.yields, flowed[i], cpi[i]);
        }
        Real everything = trace(stress) + point.elastic_energy + work + dissipated + finite_j2::sum_of(cpi);
        // The tangent squares the trial stress.
        if constexpr (wants_tangent<T>) everything = everything + inverse_J * square(r.mubar);
        const Mask<Real> sound = is_finite(everything);
        if (!all(sound)) [[unlikely]]
            return point.fail(!sound, "the stress or the tangent is not finite");
        point.stress = without_thickness<kind>(stress);
        point.plastic_dissipation = inverse_J * dissipated;

        if constexpr (wants_tangent<T>) set_tangent(increment, point, v, inverse_J, r, alpha, work, law, tangent);

        for (int i = 0; i < n; ++i) state.set(CPI11 + i, cpi[i]);
        if constexpr (full != AnalysisKind::solid) {
            state.set(CPI13, unused[0]);
            state.set(CPI23, unused[1]);
        }
        if constexpr (kind == AnalysisKind::plane_stress) {
            const Real old = f33m1;
            f33m1 = c.residual.total_thickness_change(k.h(2, 2), e);
            if (point.wants_thickness_strain) point.thickness_strain_increment = thickness_strain_change(old, f33m1);
        }
        state.set(ALPHA_P, alpha + r.dalpha);
        state.set(EPSRES, e);
        state.set(F33M1, f33m1);
        state.set(PDISS, work_old + work);
    }

  private:
    // Kinematics of F*; in plane stress with F33* = 1.
    template <AnalysisKind kind, class Real>
    LODE_INLINE Kinematics<kind, Real> mechanical(const Increment<kind, Real>& increment, const Real& e) const {
        constexpr double dimensions = kind == AnalysisKind::plane_stress ? 2.0 : 3.0;
        const Deformation<kind, Real> total(increment, c.local_basis);
        if (c.residual.is_absent(e)) return kinematics_of_gradient<kind>(total.h, total.jacobian);
        auto h = mechanical_gradient(total.h, e);
        if constexpr (kind == AnalysisKind::plane_stress) h(2, 2) = Real(0.0);
        return kinematics_of_gradient<kind>(h, total.jacobian * exp(-dimensions * e));
    }

    template <AnalysisKind kind, class Real>
    LODE_INLINE auto law_of(const Increment<kind, Real>& increment) const {
        if constexpr (Flow::feels_temperature) return plasticity.flow.at(increment, increment.temperature_end());
        else return plasticity.flow;
    }

    // tau33 and its derivative as a function of y = ln F33*.
    template <class Real, class Law>
    struct ThicknessEquation {
        Kernel kernel;
        Law law;
        Stress<AnalysisKind::plane_strain, Real> trial;
        Real cpi33, area_change, area, shear, expansion, alpha;

        Real scale(const Stress<AnalysisKind::plane_strain, Real>& b) const {
            return abs(area_change) + abs(b[0]) + abs(b[1]) + abs(b[3]) + abs(cpi33);
        }
        LODE_INLINE Residual<Real> operator()(const Real& y) const {
            const DilatationalEnergy& dilatation = kernel.c.dilatation;
            const Real d = expm1(y), z = d * (2.0 + d);
            const VolumeRatio<Real> v =
                dilatation.volume_ratio(Real(area_change + d + area_change * d), Real(area * (1.0 + d)));
            auto be = trial;
            be[2] = z + (1.0 + z) * cpi33;
            const Real J = expansion * v.J;
            const auto r = kernel.plasticity.respond(be, shear, Real(square(reciprocal_cbrt(v.J))), J, alpha, law);
            return {r.s[2] + J * dilatation.derivative(v),
                    kernel.plasticity.thickness_stiffness(r) + J * dilatation.stiffness(v)};
        }
    };

    // DDSDDE, DDSDDT, RPL and its companions. A change of temperature at fixed F leaves bbar as it is and changes
    // Jres: d s_trial = 3 alpha s_trial dT.
    template <AnalysisKind kind, AnalysisKind full, class Law>
    LODE_INLINE void set_tangent(const Increment<kind, double>& increment, const Point<kind, double>& point,
                                 const VolumeRatio<double>& v, double inverse_J,
                                 const finite_j2::Isochoric<full, double>& r, [[maybe_unused]] double alpha_start,
                                 double work, [[maybe_unused]] const Law& law, Tangent<kind>& tangent) const {
        const double volumetric = c.dilatation.stiffness(v), alpha = c.residual.thermal_expansion;
        const bool is_thermal = alpha != 0.0 || (Flow::feels_temperature && r.yields);
        typename finite_j2::Plasticity<Flow>::template FlowRate<full> rate;
        if constexpr (Flow::yields)
            if (r.yields) rate = plasticity.flow_rate(r);
        double flow_by_temperature = 0.0;   // d(dalpha)/dT
        double resistance = 0.0;            // mY dK/dT
        double thickness[n_of(full)] = {};  // how ln F33 follows the strains, and the temperature
        double thickness_by_temperature = 0.0;

        set_tangent_of_kind<kind>(
            tangent, point.stress, is_thermal,
            [&](auto& full_tangent) {
                plasticity.set_tangent(r, r.yields ? &rate : nullptr, inverse_J, volumetric, full_tangent);
                if constexpr (kind == AnalysisKind::plane_stress)
                    for (int i = 0; i < n_of(full); ++i) thickness[i] = -full_tangent(2, i) / full_tangent(2, 2);
            },
            [&](const auto& full_tangent) {
                auto thermal = (3.0 * alpha * inverse_J) * r.s;
                add_to_normals(thermal, 3, -3.0 * alpha * (volumetric - c.dilatation.derivative(v)));
                if constexpr (Flow::yields) {
                    if (r.yields) {
                        if constexpr (Flow::feels_temperature)
                            resistance = r.measure * law.temperature_slope(alpha_start, r.dalpha, r.K);
                        flow_by_temperature = rate.compliance * (3.0 * alpha * r.measure * r.K - resistance);
                        thermal = thermal - (3.0 * r.mubar * flow_by_temperature * inverse_J / r.Q) * r.s_trial;
                    }
                }
                if constexpr (kind == AnalysisKind::plane_stress)
                    thickness_by_temperature = -thermal[2] / full_tangent(2, 2);
                return thermal;
            });

        if constexpr (Flow::yields) {
            if (!r.yields) return;
            // RPL = CHI mY K dalpha/(J DTIME)
            const double heat = c.heat_fraction * inverse_J * increment.time_increment.inverse;
            tangent.heat_rate = heat * work;
            const double per_flow = heat * r.measure * (r.K + r.slope * r.dalpha);
            const double per_volume = heat * work * ((plasticity.on_cauchy ? 1.0 : 0.0) - 1.0);
            const auto along = [&](int i) { return per_flow * rate.dalpha[i] + (i < 3 ? per_volume : 0.0); };
            tangent.heat_rate_temperature = per_flow * flow_by_temperature + heat * r.dalpha * resistance;
            if constexpr (kind == AnalysisKind::plane_stress) {
                constexpr int in_plane[] = {0, 1, 3};
                for (int i = 0; i < 3; ++i)
                    tangent.heat_rate_strain[i] = along(in_plane[i]) + along(2) * thickness[in_plane[i]];
                tangent.heat_rate_temperature += along(2) * thickness_by_temperature;
            } else {
                for (int i = 0; i < n_of(full); ++i) tangent.heat_rate_strain[i] = along(i);
            }
        }
    }
    static constexpr int n_of(AnalysisKind kind) { return components(kind); }
};

}  // namespace he_iso_plastic

struct HeIsoPlastic {
    static constexpr const lode_model& description = he_iso_plastic::description;

    explicit HeIsoPlastic(const Properties& p) : kernel(make_kernel(p)) {}

    int required_state(AnalysisKind) const { return he_iso_plastic::PDISS; }

    template <AnalysisKind kind>
    void initial_stiffness(const Stress<kind, double>&, const State<double>&, Tangent<kind>& tangent) const {
        specialise([&](const auto& k) { k.c.moduli.template set_stiffness<kind>(tangent); });
    }

    // Calls f with the kernel of the hardening law at hand.
    template <class F>
    LODE_INLINE void specialise(const F& f) const {
        finite_j2::visit(kernel, f);
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        specialise([&](const auto& k) LODE_INLINE_LAMBDA { k.update(increment, point, tangent); });
    }

  private:
    using Kernel = finite_j2::AnyKernel<he_iso_plastic::Kernel>;

    static Kernel make_kernel(const Properties& p) {
        using namespace he_iso_plastic;
        const IsotropicModuli moduli = IsotropicModuli::from_young_poisson(p[E], p[NU]);
        const Constants c{moduli, {p.code(UJ), moduli.bulk}, {p[ALPHA], p[BETA]}, p[CHI], p.code(ORI) == 1};
        const finite_j2::FlowIndices indices{HLAW, SY, H1, TREF};
        return finite_j2::with_flow<Kernel>(p, indices, [&](const auto& flow) -> Kernel {
            using Flow = std::decay_t<decltype(flow)>;
            return he_iso_plastic::Kernel<Flow>{c, {flow, p.code(YCAU) == 1}};
        });
    }

    Kernel kernel;
};

}  // namespace lode
