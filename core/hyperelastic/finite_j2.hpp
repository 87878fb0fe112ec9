// J2 plasticity of the isochoric part of a neo-Hookean solid at finite strain (page 55, section 1; Nairn, 9.11; Simo,
// CMAME 66 (1988)). The state is Cp^-1; the elastic left Cauchy-Green tensor is be = F Cp^-1 F^T with bbar = J^(-2/3)
// be,
//     s = mu dev(bbar)   (Kirchhoff),    |s| <= sqrt(2/3) mY K(alpha),    mubar = mu tr(bbar)/3,
// and one backward Euler step of the flow rule along n = s/|s| returns s radially. All in von Mises' measure:
// Q = sqrt(3/2) |s| falls with the slope 3 mubar in dalpha. Shared by HE_ISO_PLASTIC and MIE_GRUNEISEN.
#pragma once

#include "lode/hyperelastic/residual_strain.hpp"
#include "lode/hyperelastic/spatial_tangent.hpp"
#include "lode/numerics/reciprocal_cbrt.hpp"
#include "lode/plasticity/hardening_law.hpp"

namespace lode::finite_j2 {

// F A F^T of a symmetric A.
template <AnalysisKind kind, class Real>
LODE_INLINE Stress<kind, Real> congruence(const Matrix3<Real>& f, const Stress<kind, Real>& a) {
    Stress<kind, Real> r;
    if constexpr (kind == AnalysisKind::solid) {
        Real m[3][3];
        for (int i = 0; i < 3; ++i) {
            m[i][0] = f(i, 0) * a[0] + f(i, 1) * a[3] + f(i, 2) * a[4];
            m[i][1] = f(i, 0) * a[3] + f(i, 1) * a[1] + f(i, 2) * a[5];
            m[i][2] = f(i, 0) * a[4] + f(i, 1) * a[5] + f(i, 2) * a[2];
        }
        const auto entry = [&](int i, int j) { return m[i][0] * f(j, 0) + m[i][1] * f(j, 1) + m[i][2] * f(j, 2); };
        r[0] = entry(0, 0), r[1] = entry(1, 1), r[2] = entry(2, 2);
        r[3] = entry(0, 1), r[4] = entry(0, 2), r[5] = entry(1, 2);
    } else {
        Real m[2][2];
        for (int i = 0; i < 2; ++i) {
            m[i][0] = f(i, 0) * a[0] + f(i, 1) * a[3];
            m[i][1] = f(i, 0) * a[3] + f(i, 1) * a[1];
        }
        r[0] = m[0][0] * f(0, 0) + m[0][1] * f(0, 1);
        r[1] = m[1][0] * f(1, 0) + m[1][1] * f(1, 1);
        r[2] = square(f(2, 2)) * a[2];
        r[3] = m[0][0] * f(1, 0) + m[0][1] * f(1, 1);
    }
    return r;
}
// adj(F) without the entries that the kind does not have.
template <AnalysisKind kind, class Real>
LODE_INLINE Matrix3<Real> adjugate_of(const Matrix3<Real>& f) {
    if constexpr (kind == AnalysisKind::solid) return adjugate(f);
    else {
        Matrix3<Real> r = f;
        r(0, 0) = f(1, 1) * f(2, 2);
        r(1, 1) = f(0, 0) * f(2, 2);
        r(0, 1) = -f(0, 1) * f(2, 2);
        r(1, 0) = -f(1, 0) * f(2, 2);
        r(2, 2) = f(0, 0) * f(1, 1) - f(0, 1) * f(1, 0);
        return r;
    }
}
template <AnalysisKind kind, class Real>
LODE_INLINE Real determinant_of(const Stress<kind, Real>& a) {
    const Real minor = a[0] * a[1] - a[3] * a[3];
    if constexpr (kind == AnalysisKind::solid)
        return a[2] * minor - a[0] * (a[5] * a[5]) - a[1] * (a[4] * a[4]) + 2.0 * (a[3] * a[4] * a[5]);
    else return a[2] * minor;
}
template <class Real>
LODE_INLINE Matrix3<Real> plus_identity(const Matrix3<Real>& h) {
    Matrix3<Real> f = h;
    for (int i = 0; i < 3; ++i) f(i, i) = 1.0 + h(i, i);
    return f;
}

// Yield stress of a curve that knows neither rate nor temperature. A flow law says: K at rate zero; the increment
// dalpha that solves q - stiffness dalpha = K(alpha + dalpha), with K and dK/dalpha (rate included) at its end; and
// dK/dtemperature there.
template <class Curve>
struct StaticFlow {
    static constexpr bool yields = true, feels_temperature = false;
    Curve curve;

    template <class Real>
    using Return = typename ReturnToYield<Curve, Real>::template Result<Real>;

    template <class Real>
    LODE_INLINE FlowStress<Real> start(const Real& alpha) const {
        return curve.flow_stress(alpha);
    }
    template <class Real>
    LODE_INLINE Return<Real> solve(const Real& q, const Real& stiffness, const Real& alpha, const FlowStress<Real>& k,
                                   const Mask<Real>& where, const SolveCounter<Real>& solves = {}) const {
        return ReturnToYield<Curve, Real>(curve, stiffness)(q, alpha, Real(1.0), k, where, solves);
    }
};
// HLAW = -1.
struct NoFlow {
    static constexpr bool yields = false, feels_temperature = false;
};

// The isochoric part at the end of an increment.
template <AnalysisKind kind, class Real>
struct Isochoric {
    Stress<kind, Real> s_trial, s;  // Kirchhoff deviators
    Real mubar;
    Mask<Real> yields = Mask<Real>(false);
    Real Q = Real(0.0);  // von Mises' measure of s_trial
    Real dalpha = Real(0.0), K = Real(0.0), slope = Real(0.0);
    Real measure = Real(1.0);  // mY
    Real share = Real(0.0);    // f = 3 mubar dalpha/Q: what the return takes off s_trial
    Real excess = Real(0.0);   // tr(bbar)/3 - 1 after the return
};

template <class Flow>
struct Plasticity {
    Flow flow;
    bool on_cauchy;  // YCAU = 1: the yield condition is on s/J

    // Steps 2 to 5 from the trial be - I. `shear` is mu = Jres G, `inverse2` J*^(-2/3), `J` the total volume ratio.
    template <AnalysisKind kind, class Real, class Law>
    LODE_INLINE Isochoric<kind, Real> respond(const Stress<kind, Real>& trial, const Real& shear, const Real& inverse2,
                                              const Real& J, const Real& alpha, const Law& law,
                                              [[maybe_unused]] const SolveCounter<Real>& solves = {}) const {
        Isochoric<kind, Real> r;
        const Real modulus = shear * inverse2;
        r.s_trial = modulus * deviator(trial);
        r.mubar = modulus * (1.0 + (1.0 / 3.0) * trace(trial));
        r.s = r.s_trial;
        if constexpr (Flow::yields) {
            r.Q = sqrt(1.5 * double_contraction(r.s_trial, r.s_trial));
            FlowStress<Real> k = law.start(alpha);
            Real q = r.Q, stiffness = 3.0 * r.mubar;
            if (on_cauchy) {
                r.measure = J;
                const Real inverse = 1.0 / J;
                q = inverse * q;
                stiffness = inverse * stiffness;
            }
            r.yields = q - k.value > yield_tolerance * max(q, k.value);
            if (any(r.yields)) {
                const auto result = law.solve(q, stiffness, alpha, k, r.yields, solves);
                r.dalpha = select(r.yields, result.dalpha, Real(0.0));
                r.K = result.flow.value;
                r.slope = result.flow.slope;
                r.share = 3.0 * r.mubar * r.dalpha / select(r.yields, r.Q, Real(1.0));
                r.s = (1.0 - r.share) * r.s_trial;
            }
        }
        return r;
    }

    // d(dalpha): D, and the second factor of the dyad s_trial (x) a in J C, of lanes that yield. With
    // X = (3/Q)(mubar s + dev s^2), Y = 2 dalpha s of the trial deviator s,
    //     d(dalpha) = [X - Y - YCAU mY K 1]/(3 mubar + mY K'),     Q a = f X - Y - 3 mubar d(dalpha).
    template <AnalysisKind kind>
    struct FlowRate {
        Stress<kind, double> dalpha, a;
        double compliance;  // 1/(3 mubar + mY K')
    };
    template <AnalysisKind kind>
    LODE_INLINE FlowRate<kind> flow_rate(const Isochoric<kind, double>& r) const {
        FlowRate<kind> rate;
        const double inverse_Q = 1.0 / r.Q, cauchy = on_cauchy ? r.measure * r.K : 0.0;
        rate.compliance = 1.0 / (3.0 * r.mubar + r.measure * r.slope);
        auto x = square_of(r.s_trial);
        const double mean = (1.0 / 3.0) * trace(x);
        for (int i = 0; i < components(kind); ++i) {
            const double xi = 3.0 * inverse_Q * (r.mubar * r.s_trial[i] + x[i] - (i < 3 ? mean : 0.0));
            const double yi = 2.0 * r.dalpha * r.s_trial[i];
            rate.dalpha[i] = rate.compliance * (xi - yi - (i < 3 ? cauchy : 0.0));
            rate.a[i] = inverse_Q * (r.share * xi - yi - 3.0 * r.mubar * rate.dalpha[i]);
        }
        return rate;
    }

    // (1/J) times the rate of s, and `volumetric` 1 (x) 1 (section 1.4, in closed form):
    //     (1 - f) [M(s) + 2 mubar (I - 1 (x) 1/3) - (2/3)(1 (x) s + s (x) 1)] + s (x) a   of the trial deviator s.
    template <AnalysisKind kind>
    LODE_INLINE void set_tangent(const Isochoric<kind, double>& r, const FlowRate<kind>* rate, double inverse_J,
                                 double volumetric, Tangent<kind>& c) const {
        constexpr int n = components(kind);
        const double theta = inverse_J * (1.0 - r.share);
        auto stretching = r.s_trial;
        add_to_normals(stretching, 3, r.mubar);
        set_coupled_tangent(c, theta * stretching, volumetric - (2.0 / 3.0) * theta * r.mubar,
                            (-2.0 / 3.0 * theta) * r.s_trial, 0.0);
        if (rate == nullptr) return;
        for (int j = 0; j < n; ++j) {
            const double along = inverse_J * rate->a[j];
            for (int i = 0; i < n; ++i) c(i, j) += along * r.s_trial[i];
        }
    }

    // d tau33/d ln F33: J C_3333 without its volumetric part.
    template <AnalysisKind kind, class Real>
    LODE_INLINE Real thickness_stiffness(const Isochoric<kind, Real>& r) const {
        const Real s3 = r.s_trial[2];
        const Real elastic = (2.0 / 3.0) * s3 + (4.0 / 3.0) * r.mubar;
        if constexpr (!Flow::yields) return elastic;
        else {
            Real stiffness = (1.0 - r.share) * elastic;
            if (!any(r.yields)) return stiffness;
            const Real inverse_Q = 1.0 / select(r.yields, r.Q, Real(1.0));
            const Real squares = (2.0 / 9.0) * r.Q * r.Q;  // tr(s^2)/3
            const Real x = 3.0 * inverse_Q * (r.mubar * s3 + s3 * s3 - squares), y = 2.0 * r.dalpha * s3;
            const Real cauchy = on_cauchy ? r.measure * r.K : Real(0.0);
            const Real dalpha = (x - y - cauchy) / (3.0 * r.mubar + r.measure * r.slope);
            const Real along = s3 * inverse_Q * (r.share * x - y - 3.0 * r.mubar * dalpha);
            return stiffness + select(r.yields, along, Real(0.0));
        }
    }
};

// tr(bbar)/3 - 1 = w for the bbar = d + (1 + w) I with det bbar = 1 (step 6): the largest root of
//     w^3 + 3 w^2 + (3 - p) w - p + det d = 0,   p = d:d/2,
// convex right of -1: Newton's method from p/3 steps to its right at the latest in the first iteration and then
// descends.
template <AnalysisKind kind, class Real>
LODE_INLINE Real mean_excess(const Stress<kind, Real>& d) {
    const Real p = 0.5 * double_contraction(d, d), det = determinant_of(d);
    Real w = (1.0 / 3.0) * p;
    for (int iteration = 0; iteration < 60; ++iteration) {
        const Real value = ((w + 3.0) * w + (3.0 - p)) * w - p + det;
        const Real step = value / ((3.0 * w + 6.0) * w + (3.0 - p));
        w = w - step;
        if (all(abs(step) <= 1e-8 * abs(w))) break;
        if (all(abs(step) <= Real(1e-160))) break;
    }
    return w;
}

// Dissipation over the plastic work |s| l of the flow rule, which takes elastic shear strains as small: the flow
// changes dev(bbar) by -2 (mubar/mu) l n and, so that det bbar stays 1, tr(bbar) by what the energy mu tr(bbar)/2 then
// loses,
//     -3 x s:bbar^-1/(d:d mu tr(bbar^-1)),   bbar = d + x I.
template <AnalysisKind kind, class Real>
LODE_INLINE Real dissipation_ratio(const Stress<kind, Real>& d, const Real& excess) {
    const Real x = 1.0 + excess, p = 0.5 * double_contraction(d, d);
    const Mask<Real> sheared = p > Real(0.0);
    const Real ratio =
        3.0 * x * (x * p - 1.5 * determinant_of(d)) / (select(sheared, p, Real(1.0)) * (3.0 * x * x - p));
    return select(sheared, ratio, Real(1.0));
}

// Sum of the entries: finite where all of them are.
template <AnalysisKind kind, class Real>
LODE_INLINE Real sum_of(const Stress<kind, Real>& a) {
    Real sum = a[0];
    for (int i = 1; i < components(kind); ++i) sum = sum + a[i];
    return sum;
}

// Cp^-1 - I = c^2 F^-1 bbar F^-T - I, c^2/J^2 = inverse2^2.
template <AnalysisKind kind, class Real>
LODE_INLINE Stress<kind, Real> inverse_plastic_strain(const Matrix3<Real>& f, const Stress<kind, Real>& d,
                                                      const Real& excess, const Real& inverse2) {
    auto bbar = square(inverse2) * d;
    add_to_normals(bbar, 3, square(inverse2) * (1.0 + excess));
    auto cpi = congruence<kind>(adjugate_of<kind>(f), bbar);
    add_to_normals(cpi, 3, Real(-1.0));
    return cpi;
}

}  // namespace lode::finite_j2
