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

        // At x = h_trial/g - 1 times d_max/d_min every mode has come down to g at least.
        const Real start = select(end.yields, excess / g.value, zero);
        const Real upper = start * (1.0 / modes.smallest_ratio);
        auto root = solve_bracketed<Slope::increasing>(problem, zero, upper, start, Real(return_tolerance), end.yields);
        solves.count(root);
        if (squared_) {
            const auto turned = end.yields && root.last.dalpha_slope < zero;
            if (any(turned)) [[unlikely]]
                find_smallest(problem, root, turned, solves);
        }
        // With what the iteration has left, so that the answer does not depend on where it stopped.
        const auto& last = root.last;
        const Real left = select(end.yields, -last.value / last.slope, zero);
        const Real x = root.x + left, t = 1.0 / (1.0 + x);
        const auto inverse = problem.inverses(x * t, t);
        for (int k = 0; k < modes.yielding; ++k) {
            const int i = modes.place(k);
            const Real factor = modes.active[k] * (t * inverse[k]) + (1.0 - modes.active[k]);
            end.factor[k] = select(end.yields, factor, one);
            end.z[i] = end.factor[k] * y[i];
        }
        const Real more = last.dalpha_slope * left;
        end.mu = select(end.yields, x * (1.0 / modes.largest_d), zero);
        end.dalpha = select(end.yields, last.dalpha + more, zero);
        end.equivalent = problem.equivalent(end.z);
        end.g.value = select(end.yields, last.g.value + last.g.slope * more, g.value);
        end.g.slope = select(end.yields, last.g.slope, g.slope);
        end.heat = end.mu * end.g.value;
        end.work = end.heat * (1.0 + select(end.yields, stored_ratio(alpha, end.dalpha, g, end.g), zero));
        return end;
    }

    // "Consistent tangent": D = M C - N x m/den in modes, where M C = C_0 + B diag(1/(1 + mu d)) B^T, N = M C A sigma
    // and m = w M C. All rows are combinations of N and X = M C AZA sigma.
    template <AnalysisKind kind>
    LODE_INLINE void linearise(const HillModes<kind>& modes, const HillStep<kind, double>& e,
                               HillSlopes<kind>& slopes) const {
        constexpr int n = components(kind), normals = HillModes<kind>::normals;
        const double h = e.g.value, slope = e.g.slope, mu = e.mu;
        // N, X and A sigma, AZA sigma by modes.
        Strain<kind, double> A_sigma{};  // W^-T A sigma
        Stress<kind, double> N{}, X{}, AZA{};
        for (int k = 0; k < modes.yielding; ++k) {
            const int i = modes.place(k);
            const double z = e.z[i], C = k < 2 ? 1.0 : modes.shear_C[k - 2];
            A_sigma[i] = modes.weight[k] * z;
            AZA[i] = k == 0   ? 1.5 * (modes.rate_00 * e.z[0] + modes.rate_01 * e.z[1])
                     : k == 1 ? 1.5 * (modes.rate_01 * e.z[0] + modes.rate_11 * e.z[1])
                              : 1.5 * modes.shear_rate[k - 2] * z;
            N[i] = C * e.factor[k] * A_sigma[i];
            X[i] = C * e.factor[k] * AZA[i];
        }
        double A_N = 0.0, AZA_N = 0.0;
        for (int k = 0; k < modes.yielding; ++k) {
            const int i = modes.place(k);
            A_N += A_sigma[i] * N[i];
            AZA_N += AZA[i] * N[i];
        }
        // dalpha = along_A A sigma . dsigma + along_AZA AZA sigma . dsigma + by_mu dmu
        const double along_A = squared_ ? 0.0 : mu * inverse_reference_ / h;
        const double along_AZA = squared_ ? mu * (2.0 / 3.0) / e.equivalent : 0.0;
        const double by_mu = squared_ ? e.equivalent : h * inverse_reference_;
        const double w_A = 1.0 / h - slope * along_A, w_AZA = -slope * along_AZA;
        const double inverse_den = 1.0 / (w_A * A_N + w_AZA * AZA_N + slope * by_mu);

        Stress<kind, double> dmu, dalpha;
        const double back = along_A * A_N + along_AZA * AZA_N;
        for (int i = 0; i < n; ++i) {
            dmu[i] = inverse_den * (w_A * N[i] + w_AZA * X[i]);
            dalpha[i] = along_A * N[i] + along_AZA * X[i] + (by_mu - back) * dmu[i];
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
    template <class Real>
    struct Trial {
        Real value, slope;  // of g/h - 1
        Real dalpha, dalpha_slope;
        FlowStress<Real> g;
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
        // 1/b, b = t + (1 - t) d/d_max in (0, 1], so that z = t y/b: all with one division.
        LODE_INLINE Modal inverses(const Real& rest, const Real& t) const {
            Modal b, before;
            Real product(1.0);
            for (int k = 0; k < modes_count; ++k) {
                b[k] = t + rest * ratio[k];
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
        LODE_INLINE Trial<Real> operator()(const Real& x) const {
            const Real s = 1.0 + x, t = 1.0 / s, rest = x * t;
            const Modal inverse = inverses(rest, t);
            // h = t Q, Q^2 = sum part/b^2; b changes with x by -t^2 (1 - d/d_max).
            Real Q_square(0.0), third(0.0);
            for (int k = 0; k < modes_count; ++k) {
                const Real share = part[k] * (inverse[k] * inverse[k]);
                Q_square = Q_square + share;
                third = third + (1.0 - ratio[k]) * (share * inverse[k]);
            }
            const Real Q = sqrt(Q_square), inverse_Q = 1.0 / Q, t_square = t * t;
            const Real Q_slope = t_square * (third * inverse_Q);
            // dalpha = (1 - t) m
            Real m = inverse_d * inverse_reference * Q, m_slope = inverse_d * inverse_reference * Q_slope;
            if (squared) {
                const Real u0 = y[0] * inverse[0], u1 = y[1] * inverse[1];
                const Real r0 = rate_00 * u0 + rate_01 * u1, r1 = rate_01 * u0 + rate_11 * u1;
                Real square = u0 * r0 + u1 * r1;
                Real change = (1.0 - ratio[0]) * (r0 * u0 * inverse[0]) + (1.0 - ratio[1]) * (r1 * u1 * inverse[1]);
                for (int k = 0; k < modes_count - 2; ++k) {
                    const Real share = shear_rate[k] * (inverse[k + 2] * inverse[k + 2]);
                    square = square + share;
                    change = change + (1.0 - ratio[k + 2]) * (share * inverse[k + 2]);
                }
                const Real root = sqrt(max(square, Real(1e-300)));
                m = inverse_d * root;
                m_slope = inverse_d * t_square * (change / root);
            }
            const Real dalpha = rest * m, dalpha_slope = t_square * m + rest * m_slope;
            const FlowStress<Real> g = law.flow_stress(alpha + dalpha);
            const Real ratio_s = s * inverse_Q;
            return {g.value * ratio_s - 1.0,
                    ratio_s * (g.slope * dalpha_slope - g.value * (Q_slope * inverse_Q)) + g.value * inverse_Q, dalpha,
                    dalpha_slope, g};
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
