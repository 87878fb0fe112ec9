// The return of HILL_PLASTIC to h = g(alpha) along the modes of hill_modes.hpp (page 20, section 5, step 3), and its
// linearisation. The unknown is x = mu d_max, the equation g/h - 1 = 0, nearly linear in x.
#pragma once

#include "lode/plasticity/hardening_law.hpp"
#include "lode/plasticity/hill_modes.hpp"

namespace lode {

// End of a step.
template <AnalysisKind kind, class Real>
struct HillStep {
    Mask<Real> yields;
    Stress<kind, Real> z;                            // stress in modes
    Vector<Real, HillModes<kind>::yielding> factor;  // 1/(1 + mu d)
    Real mu, dalpha;
    Real equivalent;  // sqrt(2/3) |dep|/mu
    FlowStress<Real> g;
    Real work, heat;  // of the increment: sigma : dep, and mu g
};

// How it answers to the trial stress in modes, y, and to alpha at the start, a: den dmu = yield . dy - slope da,
// dalpha = hardening . dy + by_mu dmu, dz = factor dy - flow dmu.
template <AnalysisKind kind>
struct HillResponse {
    using Modal = Vector<double, HillModes<kind>::yielding>;
    Modal flow, yield, hardening;
    double slope, inverse_den, by_mu;
};

// How it answers to the strain: D, d(mu), d(alpha), in material axes.
template <AnalysisKind kind>
struct HillSlopes {
    VoigtMatrix<kind, double> stiffness;
    Vector<double, components(kind)> mu, alpha;
};

template <class Law>
class HillReturn {
  public:
    // `style` 1: dalpha = mu h/reference; 2: dalpha = sqrt(2/3) |dep|.
    HillReturn(const Law& law, int style, double reference)
        : law_(law), inverse_reference_(1.0 / reference), squared_(style == 2) {}

    // y: trial stress in modes; g at the start.
    template <AnalysisKind kind, class Real>
    LODE_INLINE HillStep<kind, Real> operator()(const HillModes<kind>& modes, const Stress<kind, Real>& y,
                                                const Real& alpha, const FlowStress<Real>& g,
                                                const SolveCounter<Real>& solves = {}) const {
        const Real one(1.0), zero(0.0);
        const Problem<kind, Real> problem(modes, y, alpha, law_, inverse_reference_, squared_);
        HillStep<kind, Real> end;
        const Real h_trial = sqrt(problem.h_square());
        const Real excess = h_trial - g.value;
        end.yields = excess > yield_tolerance * max(h_trial, g.value);
        end.z = y;
        for (int k = 0; k < modes.yielding; ++k) end.factor[k] = one;
        end.mu = end.dalpha = end.equivalent = end.work = end.heat = zero;
        end.g = g;
        if (!any(end.yields)) return end;

        // At x = h_trial/g - 1 times d_max/d_min every mode has come down to g at least. Halley's step from x = 0,
        // where the law is known, is the better start, unless the curvature there rules: the longer step then, of twice
        // Newton's (soft modes go on when stiff ones are used up) and far (a power law at alpha = 0).
        const Real far = select(end.yields, excess / g.value, zero);
        const Real upper = far * (1.0 / modes.smallest_ratio);
        const auto first = problem.at_start(g);
        const Real slope2 = first.slope * first.slope, bend = 0.5 * first.value * first.curvature;
        const Mask<Real> mild = abs(bend) < 0.5 * slope2;
        const Real divisor = select(mild, slope2 - bend, select(end.yields, 0.5 * slope2, one));
        const Real step = -first.value * first.slope / divisor, start = select(mild, step, max(step, far));
        const Real tolerance = max(early * min(far, one), Real(return_tolerance));
        auto root = solve(problem, modes, y, upper, start, tolerance, end.yields);
        solves.count(root);
        if (squared_) {
            const auto turned = end.yields && root.last.dalpha_slope < zero;
            if (any(turned)) [[unlikely]]
                find_smallest(problem, root, turned, solves);
        }
        Real left = last_step(root.last);
        const Mask<Real> unfinished = end.yields && abs(left) > 10.0 * max(early * root.x, Real(return_tolerance));
        if (any(unfinished)) [[unlikely]] {
            const auto more =
                solve_bracketed<Slope::increasing>(problem, zero, upper, root.x, Real(return_tolerance), unfinished);
            solves.count(more);
            root.x = select(unfinished, more.x, root.x);
            root.last = problem(root.x);
            left = last_step(root.last);
        }
        // With what the iteration has left, which is so small that series to its square take everything along.
        const auto& last = root.last;
        left = select(end.yields, left, zero);
        const Real x = root.x + left;
        for (int k = 0; k < modes.yielding; ++k) {
            const int i = modes.place(k);
            const Real change = (modes.ratio[k] * left) * last.inverse[k];
            const Real inverse = last.inverse[k] - last.inverse[k] * (change * (1.0 - change));
            const Real factor = modes.active[k] * inverse + (1.0 - modes.active[k]);
            end.factor[k] = select(end.yields, factor, one);
            end.z[i] = end.factor[k] * y[i];
        }
        const Real more = left * (last.dalpha_slope + 0.5 * left * last.dalpha_curvature);
        end.mu = select(end.yields, x * (1.0 / modes.largest_d), zero);
        end.dalpha = select(end.yields, last.dalpha + more, zero);
        end.equivalent = problem.equivalent(end.z);
        const Real slope = last.g.slope + last.g.curvature * more;
        end.g.value = select(end.yields, last.g.value + more * (0.5 * (last.g.slope + slope)), g.value);
        end.g.slope = select(end.yields, slope, g.slope);
        end.g.curvature = select(end.yields, last.g.curvature, g.curvature);
        end.heat = end.mu * end.g.value;
        end.work = end.heat * (1.0 + select(end.yields, stored_ratio(alpha, end.dalpha, g, end.g), zero));
        return end;
    }

    // "Consistent tangent" in modes: M = (I + mu C A)^-1 is diagonal there, F = 1/(1 + mu d). With N = M C A sigma and
    // w of the page, w . (F dy - N dmu) = g' (dalpha_mu dmu + dalpha_n), the last by a change of alpha at the start.
    template <AnalysisKind kind>
    LODE_INLINE HillResponse<kind> respond(const HillModes<kind>& modes, const HillStep<kind, double>& e) const {
        constexpr int count = HillModes<kind>::yielding;
        const double h = e.g.value, slope = e.g.slope, mu = e.mu;
        HillResponse<kind> r;
        double A_N = 0.0, AZA_N = 0.0;
        typename HillResponse<kind>::Modal A_sigma, AZA;
        for (int k = 0; k < count; ++k) {
            const double z = e.z[modes.place(k)];
            A_sigma[k] = modes.weight[k] * z;
            AZA[k] = k == 0   ? 1.5 * (modes.rate_00 * e.z[0] + modes.rate_01 * e.z[1])
                     : k == 1 ? 1.5 * (modes.rate_01 * e.z[0] + modes.rate_11 * e.z[1])
                              : 1.5 * modes.shear_rate[k - 2] * z;
            const double C = k < 2 ? 1.0 : modes.shear_C[k - 2];
            r.flow[k] = C * e.factor[k] * A_sigma[k];
            A_N += A_sigma[k] * r.flow[k];
            AZA_N += AZA[k] * r.flow[k];
        }
        // dalpha = along_A A sigma . dsigma + along_AZA AZA sigma . dsigma + by_mu dmu
        const double along_A = squared_ ? 0.0 : mu * inverse_reference_ / h;
        const double along_AZA = squared_ ? mu * (2.0 / 3.0) / e.equivalent : 0.0;
        const double by_mu = squared_ ? e.equivalent : h * inverse_reference_;
        const double w_A = 1.0 / h - slope * along_A, w_AZA = -slope * along_AZA;
        r.inverse_den = 1.0 / (w_A * A_N + w_AZA * AZA_N + slope * by_mu);
        r.by_mu = by_mu - (along_A * A_N + along_AZA * AZA_N);
        for (int k = 0; k < count; ++k) {
            r.yield[k] = e.factor[k] * (w_A * A_sigma[k] + w_AZA * AZA[k]);
            r.hardening[k] = e.factor[k] * (along_A * A_sigma[k] + along_AZA * AZA[k]);
        }
        r.slope = slope;
        return r;
    }

    // D = M C - N x dmu, where the strain moves y by B^T: M C = C_0 + B F B^T.
    template <AnalysisKind kind>
    LODE_INLINE void linearise(const HillModes<kind>& modes, const HillStep<kind, double>& e,
                               HillSlopes<kind>& slopes) const {
        constexpr int n = components(kind), normals = HillModes<kind>::normals;
        const HillResponse<kind> r = respond(modes, e);
        Stress<kind, double> N{}, dmu{}, dalpha{};
        for (int k = 0; k < modes.yielding; ++k) {
            const int i = modes.place(k);
            const double C = k < 2 ? 1.0 : modes.shear_C[k - 2];
            N[i] = r.flow[k];
            dmu[i] = r.inverse_den * (C * r.yield[k]);
            dalpha[i] = C * r.hardening[k] + r.by_mu * dmu[i];
        }
        const Stress<kind, double> flow = modes.from_modes(N);
        dmu = modes.from_modes(dmu);
        dalpha = modes.from_modes(dalpha);
        for (int i = 0; i < n; ++i) slopes.mu[i] = dmu[i], slopes.alpha[i] = dalpha[i];

        double by_mode[normals];  // 1/(1 + mu d), 1 of the mode that cannot yield
        for (int k = 0; k < normals; ++k) by_mode[k] = k < 2 ? e.factor[k] : 1.0;
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                double C = 0.0;
                if (i < normals && j < normals)
                    for (int k = 0; k < normals; ++k) C += modes.B[i][k] * by_mode[k] * modes.B[j][k];
                else if (i == j) C = modes.shear_C[i - normals] * e.factor[i - normals + 2];
                slopes.stiffness(i, j) = C - flow[i] * dmu[j];
            }
    }

    // [int (g - 1) dalpha]/dalpha over the step.
    template <class Real>
    LODE_INLINE Real stored_ratio(const Real& alpha, const Real& dalpha, const FlowStress<Real>& g,
                                  const FlowStress<Real>& g_end) const {
        const Mask<Real> sound = dalpha > Real(0.0);
        return select(sound, law_.stored_energy(alpha, dalpha, g, g_end) / select(sound, dalpha, Real(1.0)), Real(0.0));
    }
    template <class Real>
    LODE_INLINE FlowStress<Real> at(const Real& alpha) const {
        return law_.flow_stress(alpha);
    }

  private:
    // The iteration stops where its residual is so small a part of x: the step that it leaves is of the third order.
    static constexpr double early = 2e-8;

    template <AnalysisKind kind, class Real>
    struct Trial;
    template <AnalysisKind kind, class Real>
    struct Problem;

    // Numbers that carry derivatives are solved for their value; the last step brings the derivatives.
    template <AnalysisKind kind, class Real>
    LODE_INLINE auto solve(const Problem<kind, Real>& problem, const HillModes<kind>& modes,
                           const Stress<kind, Real>& y, const Real& upper, const Real& start, const Real& tolerance,
                           const Mask<Real>& yields) const {
        if constexpr (is_differentiated<Real>) {
            Stress<kind, double> values;
            for (int i = 0; i < components(kind); ++i) values[i] = value_of(y[i]);
            const Problem<kind, double> plain(modes, values, value_of(problem.alpha), law_, inverse_reference_,
                                              squared_);
            const auto root = solve_bracketed<Slope::increasing>(plain, 0.0, value_of(upper), value_of(start),
                                                                 value_of(tolerance), yields);
            const Real x(root.x);
            return Root<Real, Trial<kind, Real>>{x, root.converged, root.iterations, problem(x), root.safeguards};
        } else {
            return solve_bracketed<Slope::increasing>(problem, Real(0.0), upper, start, tolerance, yields);
        }
    }

    template <class Trial>
    LODE_INLINE static auto last_step(const Trial& r) {
        return -r.value * r.slope / (r.slope * r.slope - 0.5 * r.value * r.curvature);
    }

    template <AnalysisKind kind, class Real>
    struct Trial {
        Real value, slope, curvature;  // of g/h - 1
        Real dalpha, dalpha_slope, dalpha_curvature;
        FlowStress<Real> g;
        Vector<Real, HillModes<kind>::yielding> inverse;  // 1/(1 + mu d)
    };

    // The equation, by value: a reference would keep the point in memory.
    template <AnalysisKind kind, class Real>
    struct Problem {
        static constexpr int modes_count = HillModes<kind>::yielding, normals = HillModes<kind>::normals;
        using Modal = Vector<Real, modes_count>;

        Modal part;                                // of h^2
        Vector<Real, 2> y;                         // normal modes
        Vector<Real, modes_count - 2> shear_rate;  // part of (2/3) |dep|^2/mu^2
        double ratio[modes_count], rate_00, rate_01, rate_11, unit_rate[modes_count - 2];
        double inverse_d, inverse_reference;
        Real alpha;
        Law law;
        bool squared;

        LODE_INLINE Problem(const HillModes<kind>& m, const Stress<kind, Real>& trial, const Real& alpha_n,
                            const Law& hardening, double per_reference, bool style_2)
            : rate_00(m.rate_00),
              rate_01(m.rate_01),
              rate_11(m.rate_11),
              inverse_d(1.0 / m.largest_d),
              inverse_reference(per_reference),
              alpha(alpha_n),
              law(hardening),
              squared(style_2) {
            for (int k = 0; k < modes_count; ++k) {
                const Real& mode = trial[HillModes<kind>::place(k)];
                const Real square = mode * mode;
                part[k] = m.weight[k] * square;
                ratio[k] = m.ratio[k];
                if (k < 2) y[k] = mode;
                else unit_rate[k - 2] = m.shear_rate[k - 2], shear_rate[k - 2] = m.shear_rate[k - 2] * square;
            }
        }
        LODE_INLINE Real h_square() const {
            Real sum = part[0];
            for (int k = 1; k < modes_count; ++k) sum = sum + part[k];
            return sum;
        }
        // 1/(1 + mu d), all with one division.
        LODE_INLINE Modal inverses(const Real& x) const {
            Modal b, before;
            Real product(1.0);
            for (int k = 0; k < modes_count; ++k) {
                b[k] = 1.0 + x * ratio[k];
                before[k] = product;
                product = product * b[k];
            }
            Real inverse = 1.0 / product;
            Modal result;
            for (int k = modes_count - 1; k >= 0; --k) {
                result[k] = inverse * before[k];
                inverse = inverse * b[k];
            }
            return result;
        }
        // sqrt(2/3) |dep|/mu of a stress in modes.
        LODE_INLINE Real equivalent(const Stress<kind, Real>& z) const {
            Real sum = z[0] * (rate_00 * z[0] + (2.0 * rate_01) * z[1]) + rate_11 * (z[1] * z[1]);
            for (int s = 0; s < modes_count - 2; ++s) sum = sum + unit_rate[s] * (z[normals + s] * z[normals + s]);
            return sqrt(max(sum, Real(0.0)));
        }
        LODE_INLINE Trial<kind, Real> operator()(const Real& x) const {
            return at(x, inverses(x), [this](const Real& dalpha) { return law.flow_stress(alpha + dalpha); });
        }
        // At x = 0, given g there.
        LODE_INLINE Trial<kind, Real> at_start(const FlowStress<Real>& g) const {
            Modal ones;
            for (int k = 0; k < modes_count; ++k) ones[k] = Real(1.0);
            return at(Real(0.0), ones, [&g](const Real&) { return g; });
        }
        // With i = 1/(1 + x ratio), so that i' = -ratio i^2 and i + x i' = i^2: dalpha = c x h gives dalpha' = c sum
        // part i^3/h without cancellation.
        template <class F>
        LODE_INLINE Trial<kind, Real> at(const Real& x, const Modal& i, const F& flow_stress) const {
            Real h2(0.0), P3(0.0), S3(0.0), P4(0.0), S4(0.0);  // sum part i^n, sum part ratio i^3, ratio^2 i^4
            for (int k = 0; k < modes_count; ++k) {
                const Real q2 = part[k] * (i[k] * i[k]), q3 = q2 * i[k], q4 = ratio[k] * (q3 * i[k]);
                h2 = h2 + q2, P3 = P3 + q3, S3 = S3 + ratio[k] * q3, P4 = P4 + q4, S4 = S4 + ratio[k] * q4;
            }
            const Real h = sqrt(h2), v = h * (1.0 / h2), v2 = v * v;
            // 1/h: v' = S3 v^3
            const Real v_slope = S3 * (v2 * v), v_curvature = (3.0 * (v2 * v)) * (S3 * S3 * v2 - S4);
            // dalpha = x m, (x m)' and (x m)''
            Real m = h, m_slope = P3 * v, m_curvature = P3 * v_slope - (3.0 * P4) * v;
            double per_m = inverse_d * inverse_reference;
            if (squared) {
                const Real u0 = y[0] * i[0], u1 = y[1] * i[1], w0 = u0 * i[0], w1 = u1 * i[1];
                const Real r0 = rate_00 * u0 + rate_01 * u1, r1 = rate_01 * u0 + rate_11 * u1;
                const Real t0 = ratio[0] * w0, t1 = ratio[1] * w1;
                // E^2 = u.R u, with u' = -t, w' = -2 t i, u + x u' = w
                Real E2 = u0 * r0 + u1 * r1, uw = w0 * r0 + w1 * r1, ut = t0 * r0 + t1 * r1;
                Real tw = t0 * (rate_00 * w0 + rate_01 * w1) + t1 * (rate_01 * w0 + rate_11 * w1) +
                          2.0 * (r0 * (t0 * i[0]) + r1 * (t1 * i[1]));
                for (int k = 2; k < modes_count; ++k) {
                    const Real q2 = shear_rate[k - 2] * (i[k] * i[k]), q3 = q2 * i[k], q3_ratio = ratio[k] * q3;
                    E2 = E2 + q2, uw = uw + q3, ut = ut + q3_ratio, tw = tw + (3.0 * i[k]) * q3_ratio;
                }
                m = sqrt(max(E2, Real(1e-300)));
                const Real inverse = 1.0 / m;
                m_slope = uw * inverse;
                m_curvature = inverse * (inverse * (m_slope * ut) - tw);
                per_m = inverse_d;
            }
            const Real dalpha = (per_m * x) * m, slope = per_m * m_slope, curvature = per_m * m_curvature;
            const FlowStress<Real> g = flow_stress(dalpha);
            const Real g_slope = g.slope * slope, g_curvature = g.curvature * (slope * slope) + g.slope * curvature;
            return {g.value * v - 1.0,
                    g_slope * v + g.value * v_slope,
                    g_curvature * v + (2.0 * g_slope * v_slope + g.value * v_curvature),
                    dalpha,
                    slope,
                    curvature,
                    g,
                    i};
        }
    };

    // Under strong anisotropy dalpha of the squared form may turn back as mu grows: then the first change of sign from
    // mu = 0 is sought.
    template <AnalysisKind kind, class Real, class Solution>
    LODE_INLINE void find_smallest(const Problem<kind, Real>& problem, Solution& root, const Mask<Real>& turned,
                                   const SolveCounter<Real>& solves) const {
        constexpr int intervals = 64;
        Real upper = root.x, lower = Real(0.0);
        Mask<Real> found(false);
        for (int i = 1; i < intervals; ++i) {
            const Real x = (static_cast<double>(i) / intervals) * root.x;
            const Mask<Real> beyond = turned && !found && problem(x).value > Real(0.0);
            upper = select(beyond, x, upper);
            found = found || beyond;
            lower = select(turned && !found, x, lower);
        }
        solves.count(intervals - 1, intervals - 1);
        if (!any(found)) return;
        const auto first = solve_bracketed<Slope::increasing>(problem, lower, upper, 0.5 * (lower + upper),
                                                              Real(return_tolerance), found);
        solves.count(first);
        root.x = select(found, first.x, root.x);
        root.last = problem(root.x);
    }

    Law law_;
    double inverse_reference_;
    bool squared_;
};

}  // namespace lode
