// DISNEY_SNOW: elastic-plastic snow (page 50, section 6; Nairn, 9.8). The elastic left Cauchy-Green tensor
// be = F* Cp^-1 F*^T has the stretches l_i; they are clamped to [1 - THC, 1 + THS] and what is cut off is plastic. With
// JE = l1 l2 l3, Jp = J*/JE and G, lambda proportional to h = exp(XI (1 - Jp)),
//     co-rotated:   sigma_i = (2G/JE) l_i (l_i - 1) + U'(JE)
//     neo-Hookean:  sigma_i = (G/JE) (l_i^2 - 1) + U'(JE)
#pragma once

#include <string>

#include "lode/elastic/isotropic_moduli.hpp"
#include "lode/hyperelastic/corotated.hpp"
#include "lode/hyperelastic/disney_snow_description.hpp"
#include "lode/hyperelastic/plane_stress.hpp"
#include "lode/hyperelastic/spatial_tangent.hpp"
#include "lode/material/properties.hpp"

namespace lode {

struct DisneySnow : DisneySnowDescription {
    explicit DisneySnow(const Properties& p)
        : moduli(IsotropicModuli::from_young_poisson(p[1], p[2])),
          compression(p[3]),
          extension(p[4]),
          hardening(p[5]),
          is_corotated(p.code(6) == 0),
          dilatation{p.code(7), moduli.lame},
          residual{p[8], p[9]},
          local_basis(p.code(10) == 1),
          lowest(-(compression + tolerance) * (2.0 - compression - tolerance)),
          highest((extension + tolerance) * (2.0 + extension + tolerance)) {}

    // Beyond this hardening, compaction stores more than is worked (section 6.6).
    std::string warnings() const {
        if (compression == 0.0) return "";
        const double e = -compression, l = 1.0 + e;
        const VolumeRatio<double> v = dilatation.volume_ratio(e * (3.0 + e * (3.0 + e)), l * l * l);
        const double shear_stress = is_corotated ? 2.0 * moduli.shear * l * e : moduli.shear * e * (2.0 + e);
        const double mean = shear_stress * v.inverse + dilatation.derivative(v);
        const double shear_energy =
            is_corotated ? 3.0 * moduli.shear * e * e : moduli.shear * (1.5 * e * (2.0 + e) - std::log(v.J));
        const double limit = 1.0 - v.J * mean / (shear_energy + dilatation.energy(v));
        if (hardening <= limit) return "";
        return "PROPS(5) = " + format_number(hardening) + " (XI, hardening) is above " + format_number(limit) +
               ": hydrostatic compaction stores more energy than the work done, closed cycles may yield work";
    }

    int required_state(AnalysisKind) const { return count_of(states); }

    template <AnalysisKind kind>
    void initial_stiffness(const Stress<kind, double>&, const State<double>&, Tangent<kind>& tangent) const {
        moduli.template set_stiffness<kind>(tangent);
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        State<Real>& state = point.state;
        const Real e = residual.end(increment, state[8]), jpm1_old = state[7];
        Stress<kind, Real> cpi;  // Cp^-1 - I
        for (int i = 0; i < components(kind); ++i) cpi[i] = state[1 + i];
        const Real unused[2] = {state[5], state[6]};  // 13 and 23 of the plane kinds

        const Deformation<kind, Real> total(increment, local_basis);
        const bool free_of_residual = residual.is_absent(e);
        const auto k = free_of_residual ? kinematics_of_gradient<kind>(total.h, total.jacobian)
                                        : kinematics_of_gradient<kind>(mechanical_gradient(total.h, e),
                                                                       total.jacobian * exp(-3.0 * e));
        Matrix3<Real> f = k.h;
        for (int i = 0; i < 3; ++i) f(i, i) = 1.0 + f(i, i);
        // be - I of the trial state
        auto trial = k.b + push_forward<kind>(f, cpi);
        const Mask<Real> possible =
            k.jacobian > Real(0.0) && jpm1_old > Real(-1.0) && is_finite(trace(trial) + k.jacobian);
        if (!all(possible)) [[unlikely]]
            return point.fail(!possible, "det F <= 0, or the deformation or the state is not finite");

        const Mask<Real> elastic = is_positive(trial, -lowest, 1.0) && is_positive(trial, highest, -1.0);
        Response<kind, Real> now;
        now.jpm1 = jpm1_old;
        now.cpi = cpi;
        Response<kind, Real> within = now;
        if (!all(elastic)) flow_response(k, f, trial, jpm1_old, now);
        if (any(elastic)) {
            // In one place, so that a point's last bit does not depend on what its neighbours do.
            for (int i = 0; i < components(kind); ++i) trial[i] = select(elastic, trial[i], Real(0.0));
            elastic_response(k, trial, within);
            if (all(elastic)) now = within;
            else now.take(elastic, within);
        }
        const Mask<Real> sound = is_finite(trace(now.stress) + now.energy + now.dissipation);
        if (!all(sound)) [[unlikely]]
            return point.fail(!sound, "the stress is not finite");
        point.stress = now.stress;
        point.elastic_energy = now.energy;
        point.plastic_dissipation = now.dissipation;

        if constexpr (wants_tangent<T>) {
            set_tangent_of_kind<kind>(
                tangent, point.stress, residual.thermal_expansion != 0.0,
                [&](auto& c) {
                    if (elastic) set_elastic_tangent(trial, now, c);
                    else set_flow_tangent<kind>(trial, now, c);
                },
                [&](const auto& c) { return isotropic_thermal_stress(residual.thermal_expansion, c, now.stress); });
        }

        for (int i = 0; i < components(kind); ++i) state.set(1 + i, now.cpi[i]);
        if constexpr (kind != AnalysisKind::solid) {
            state.set(5, unused[0]);
            state.set(6, unused[1]);
        }
        state.set(7, now.jpm1);
        state.set(8, e);
    }

    static constexpr double tolerance = 1e-12;  // of the elastic stretches at their limits

    IsotropicModuli moduli;  // at Jp = 1
    double compression, extension, hardening;
    bool is_corotated;
    DilatationalEnergy dilatation;
    ResidualStrain residual;
    bool local_basis;
    double lowest, highest;  // limits of the eigenvalues of be - I

  private:
    // The end of the increment.
    template <AnalysisKind kind, class Real>
    struct Response {
        Stress<kind, Real> stress, cpi;
        Real jpm1, je;  // Jp - 1, JE - 1
        Real energy, dissipation;

        void take(const Mask<Real>& where, const Response& other) {
            for (int i = 0; i < components(kind); ++i) {
                stress[i] = select(where, other.stress[i], stress[i]);
                cpi[i] = select(where, other.cpi[i], cpi[i]);
            }
            jpm1 = select(where, other.jpm1, jpm1);
            energy = select(where, other.energy, energy);
            dissipation = select(where, other.dissipation, dissipation);
        }
    };

    // F A F^T.
    template <AnalysisKind kind, class Real>
    LODE_INLINE static Stress<kind, Real> push_forward(const Matrix3<Real>& f, const Stress<kind, Real>& a) {
        return from_matrix<Stress<kind, Real>, kind>(f * to_matrix<kind, Real>(a, 1.0) * transpose(f), 1.0);
    }

    // True where sign A + shift I is positive definite (leading minors).
    template <AnalysisKind kind, class Real>
    LODE_INLINE static Mask<Real> is_positive(const Stress<kind, Real>& a, double shift, double sign) {
        const Real a1 = shift + sign * a[0], a2 = shift + sign * a[1], a3 = shift + sign * a[2];
        const Real minor = a1 * a2 - a[3] * a[3];
        Real det = a3 * minor;
        if constexpr (kind == AnalysisKind::solid)
            det = det - a1 * (a[5] * a[5]) - a2 * (a[4] * a[4]) + (2.0 * sign) * (a[3] * a[4] * a[5]);
        return a1 > Real(0.0) && minor > Real(0.0) && det > Real(0.0);
    }

    template <class Real>
    LODE_INLINE Real stiffening(const Real& jpm1) const {
        return hardening == 0.0 ? Real(1.0) : exp(-hardening * jpm1);
    }

    // No flow: the law at the trial state.
    template <AnalysisKind kind, class Real>
    LODE_INLINE void elastic_response(const Kinematics<kind, Real>& k, const Stress<kind, Real>& b,
                                      Response<kind, Real>& now) const {
        const Real h = stiffening(now.jpm1), inverse = 1.0 / (1.0 + now.jpm1);
        now.je = (k.j - now.jpm1) * inverse;
        const VolumeRatio<Real> v = dilatation.volume_ratio(now.je, 1.0 + now.je);
        Real shear_energy;
        if (is_corotated) {
            const auto strain = corotated_strain_of(b);
            now.stress = (2.0 * moduli.shear * v.inverse) * (strain + square_of(strain));
            shear_energy = double_contraction(strain, strain);
        } else {
            now.stress = (moduli.shear * v.inverse) * b;
            // I1 - 3 - 2 (JE - 1), without terms of first order: (1 + je)^2 = det(I + b)
            const Matrix3<Real> m = to_matrix<kind, Real>(b, 1.0);
            const Real excess = now.je * now.je - second_invariant(m) - determinant(m);
            shear_energy = 0.5 * excess + v.excess_over_log();
        }
        add_to_normals(now.stress, 3, dilatation.derivative(v));
        now.stress = h * now.stress;
        now.energy = h * v.inverse * (moduli.shear * shear_energy + dilatation.energy(v));
        now.dissipation = Real(0.0);
    }

    // Clamped elastic principal strains e_i = l_i - 1 of the trial state.
    template <class Real>
    struct Clamped {
        SymmetricEigen<Real> eigen;
        Vector<Real, 3> trial, e;
        Mask<Real> low[3], high[3];
    };
    template <AnalysisKind kind, class Real>
    LODE_INLINE Clamped<Real> clamp(const Stress<kind, Real>& b) const {
        Clamped<Real> c;
        c.eigen = symmetric_eigen<kind>(to_matrix<kind, Real>(b, 1.0));
        for (int i = 0; i < 3; ++i) {
            const Real& mu = c.eigen.values[i];
            c.trial[i] = mu / (1.0 + sqrt(1.0 + mu));
            c.low[i] = c.trial[i] < Real(-compression - tolerance);
            c.high[i] = c.trial[i] > Real(extension + tolerance);
            c.e[i] = select(c.low[i], Real(-compression), select(c.high[i], Real(extension), c.trial[i]));
        }
        return c;
    }

    // Steps 5 and 6 of section 6.4, and the dissipation: the plastic work less what hardening stores. With W the energy
    // per volume of the unloaded state, Jp W changes by (1 - XI Jp) W dJp at fixed elastic stretches, so
    //     D = sum sigma_i d ln(l_trial/l)_i - (1 - XI Jp) (W/JE) d ln Jp     per current volume.
    template <AnalysisKind kind, class Real>
    LODE_INLINE void flow_response(const Kinematics<kind, Real>& k, const Matrix3<Real>& f,
                                   const Stress<kind, Real>& trial, const Real& jpm1_old,
                                   Response<kind, Real>& now) const {
        const Clamped<Real> c = clamp(trial);
        const auto& e = c.e;
        const Mask<Real> flows = c.low[0] || c.low[1] || c.low[2] || c.high[0] || c.high[1] || c.high[2];
        const Real pairs = e[0] * e[1] + e[1] * e[2] + e[2] * e[0], triple = e[0] * e[1] * e[2];
        now.je = e[0] + e[1] + e[2] + pairs + triple;
        const VolumeRatio<Real> v = dilatation.volume_ratio(now.je, 1.0 + now.je);
        now.jpm1 = select(flows, (k.j - now.je) * v.inverse, jpm1_old);

        const Real h = stiffening(now.jpm1), mean = h * dilatation.derivative(v);
        const Real g = h * moduli.shear * v.inverse;
        Vector<Real, 3> sigma, elastic;
        Real plastic_work(0.0);
        for (int i = 0; i < 3; ++i) {
            sigma[i] = mean + (is_corotated ? 2.0 * g * (e[i] * (1.0 + e[i])) : g * (e[i] * (2.0 + e[i])));
            elastic[i] = square(1.0 + e[i]);
            plastic_work = plastic_work + sigma[i] * log1p((c.trial[i] - e[i]) / (1.0 + e[i]));
        }
        now.stress = from_matrix<Stress<kind, Real>, kind>(compose(sigma, c.eigen.vectors), 1.0);
        const Real squares = e[0] * e[0] + e[1] * e[1] + e[2] * e[2];
        const Real shear_energy = is_corotated ? squares : 0.5 * squares - pairs - triple + v.excess_over_log();
        now.energy = g * shear_energy + h * v.inverse * dilatation.energy(v);
        const Real volume_flow = log1p((now.jpm1 - jpm1_old) / (1.0 + jpm1_old));
        now.dissipation = plastic_work - (1.0 - hardening * (1.0 + now.jpm1)) * now.energy * volume_flow;

        // Cp^-1 = F^-1 be F^-T
        const Matrix3<Real> inverse = (1.0 / k.jacobian) * adjugate(f);
        auto cpi =
            push_forward<kind>(inverse, from_matrix<Stress<kind, Real>, kind>(compose(elastic, c.eigen.vectors), 1.0));
        add_to_normals(cpi, 3, Real(-1.0));
        for (int i = 0; i < components(kind); ++i) now.cpi[i] = select(flows, cpi[i], now.cpi[i]);
    }

    template <AnalysisKind kind>
    LODE_INLINE void set_elastic_tangent(const Stress<kind, double>& b, const Response<kind, double>& now,
                                         Tangent<kind>& c) const {
        const VolumeRatio<double> v = dilatation.volume_ratio(now.je, 1.0 + now.je);
        const double h = stiffening(now.jpm1), g = h * moduli.shear * v.inverse,
                     volumetric = h * dilatation.stiffness(v);
        if (is_corotated) return set_corotated_tangent(c, g, corotated_strain_of(b), volumetric);
        auto be = b;
        add_to_normals(be, 3, 1.0);
        set_stretching_tangent(c, g, be, volumetric);
    }

    // Section 6.5, in the eigenbasis of the trial state:
    //     (C D)_ii = X_i + JE U'' s - XI Jp sigma_i (t - s) + sigma_i t,   t = tr D,   s = sum of D_kk over unclamped k
    //     (C D)_ij = D_ij (lt_i^2 + lt_j^2)/(lt_i + lt_j) Y_ij (l_i - l_j)/(lt_i - lt_j)
    template <AnalysisKind kind>
    [[gnu::noinline]] void set_flow_tangent(const Stress<kind, double> trial, const Response<kind, double> now,
                                            const Tangent<kind> target) const {
        constexpr int n = components(kind);
        Tangent<kind> c = target;
        const Clamped<double> clamped = clamp(trial);
        const auto& e = clamped.e;
        const auto& q = clamped.eigen.vectors;
        const VolumeRatio<double> v = dilatation.volume_ratio(now.je, 1.0 + now.je);
        const double h = stiffening(now.jpm1), g = h * moduli.shear * v.inverse, u1 = h * dilatation.derivative(v);
        const double u2 = h * dilatation.stiffness(v) - u1, rate = hardening * (1.0 + now.jpm1);
        for (int i = 0; i < n * n; ++i) c.stiffness[i] = 0.0;

        double chi[3];
        for (int i = 0; i < 3; ++i) chi[i] = clamped.low[i] || clamped.high[i] ? 0.0 : 1.0;
        const auto dyad = [&q](int i, int j) {  // symmetric part of n_i n_j
            Stress<kind, double> p;
            for (int k = 0; k < n; ++k) {
                const int a = spatial_detail::first_index[k], b = spatial_detail::second_index[k];
                p[k] = 0.5 * (q(a, i) * q(b, j) + q(b, i) * q(a, j));
            }
            return p;
        };
        const Stress<kind, double> p[3] = {dyad(0, 0), dyad(1, 1), dyad(2, 2)};
        for (int i = 0; i < 3; ++i) {
            const double l = 1.0 + e[i];
            const double shear_stress = is_corotated ? 2.0 * g * l * e[i] : g * e[i] * (2.0 + e[i]);
            const double sigma = shear_stress + u1;
            const double own = is_corotated ? 2.0 * g * l * (l + e[i]) : 2.0 * g * l * l;
            for (int j = 0; j < 3; ++j) {
                const double modulus =
                    sigma * (1.0 - rate) + chi[j] * (u2 + rate * sigma - shear_stress + (i == j ? own : 0.0));
                for (int column = 0; column < n; ++column)
                    for (int row = 0; row < n; ++row) c(row, column) += modulus * p[i][row] * p[j][column];
            }
        }
        for (int i = 0; i < 3; ++i)
            for (int j = i + 1; j < 3; ++j) {
                if (kind != AnalysisKind::solid && j == 2) continue;
                const double li = 1.0 + clamped.trial[i], lj = 1.0 + clamped.trial[j];
                const double gap = clamped.trial[i] - clamped.trial[j];
                const double ratio = abs(gap) < 1e-12 * (li + lj) ? 0.5 * (chi[i] + chi[j]) : (e[i] - e[j]) / gap;
                const double y = is_corotated ? 2.0 * g * (1.0 + e[i] + e[j]) : g * (2.0 + e[i] + e[j]);
                add_dyad(c, 2.0 * (li * li + lj * lj) / (li + lj) * y * ratio, dyad(i, j));
            }
    }
};

}  // namespace lode
