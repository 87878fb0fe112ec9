// The curve f = 0 of CAM_CLAY in the elastic invariants, along which a backward Euler step is one scalar equation
// R = 0 (page 70, "Update algorithm", steps 5 to 7). Its parameter delta = v_max - v >= 0 is measured from the
// isotropic tip of the hardened surface.
#pragma once

#include "lode/numerics/lanes.hpp"
#include "lode/numerics/root.hpp"
#include "lode/soil/cam_clay_elasticity.hpp"

namespace lode {

struct CamClayCurve {
    CamClayElasticity elasticity;
    double M, theta;  // theta = lambda - kappa
    double inverse_theta, w, inverse_w;
    double half_delta;   // w delta = ln 2: critical state for alpha = 0; h > 0 wherever delta is less
    double flow_factor;  // 6/M^2
    double inverse_M_square;
    double strain_per_stress;  // alpha = 0: s = strain_per_stress * A sqrt(r) on the curve
    double third_M, scale;     // M/3, c (M/3)^2

    CamClayCurve(const CamClayElasticity& elastic, double lambda, double slope)
        : elasticity(elastic),
          M(slope),
          theta(lambda - elastic.kappa),
          inverse_theta(1.0 / theta),
          w(elastic.inverse_kappa + inverse_theta),
          inverse_w(1.0 / w),
          half_delta(0.69314718055994530942 / w),
          flow_factor(6.0 / (slope * slope)),
          inverse_M_square(1.0 / (slope * slope)),
          strain_per_stress(elastic.alpha == 0.0 ? slope / (3.0 * elastic.mu0) : 0.0),
          third_M(slope / 3.0),
          scale(elastic.c * third_M * third_M) {}

    // A point of the curve f = 0, R there, and slopes in zeta = sqrt(delta) (steps 5 to 7).
    template <class Real>
    struct CurvePoint {
        Real zeta, A, r, s, h, residual, slope;
        Real s_slope, h_rate;  // h_rate: dh/d delta

        // A point nearby to second order: the exponentials by their series, s by the change of its slope.
        CurvePoint moved_to(const Real& target, const CamClayCurve& curve, const Real& s_curvature) const {
            CurvePoint x = *this;
            const Real step = target - zeta, delta_step = step * (zeta + target);
            const Real a = curve.elasticity.inverse_kappa * delta_step, b = curve.w * delta_step;
            x.zeta = target;
            x.A = A - A * (a - 0.5 * (a * a));
            x.r = r + (1.0 + r) * (b + 0.5 * (b * b));
            x.s = s + step * (s_slope + 0.5 * (step * s_curvature));
            return x;
        }
        void assign(const Mask<Real>& where, const CurvePoint& x) {
            if (!any(where)) return;
            zeta = select(where, x.zeta, zeta);
            A = select(where, x.A, A);
            r = select(where, x.r, r);
            s = select(where, x.s, s);
        }
    };

    // The solution of R = 0 in the `active` lanes: Newton's method from the point of the curve at the trial volume,
    // where A and r are those of the start; lanes in which it finds no admissible root get the bracketed solution.
    template <class Real>
    CurvePoint<Real> solve(const Real& v_max, const Real& over, const Real& s_trial, const Real& A_top,
                           const Real& r_top, const Mask<Real>& active, SolveCounter<Real> solves) const {
        if constexpr (is_differentiated<Real>) {
            const double zeta = solve<double>(value_of(v_max), value_of(over), value_of(s_trial), value_of(A_top),
                                              value_of(r_top), active, SolveCounter<double>(solves))
                                    .zeta;
            const CurvePoint<Real> at = curve_point(Real(zeta), v_max, over, s_trial);
            const Real implicit = Real(zeta) - (at.residual - value_of(at.residual)) / value_of(at.slope);
            return curve_point(implicit, v_max, over, s_trial);
        } else {
            const Real top = max(-over, Real(1e-16 * half_delta));
            const Real zeta_top = sqrt(top), zeta_half(sqrt(half_delta));
            CurvePoint<Real> at = curve_point<Real>(A_top, min(max(r_top, w * top), Real(largest_r)), zeta_top,
                                                    positive_part(over), s_trial);
            const Mask<Real> dilatant = at.h <= Real(0.0);
            const Real lower = select(dilatant, zeta_half, zeta_top);
            const Real far_end = elasticity.alpha > 0.0 ? Real(2.0) * (zeta_top + zeta_half) : zeta_half;
            const Real upper = select(dilatant, zeta_top, far_end);

            // Halley's method with the second derivative of the cubic through the last two points, which costs next to
            // nothing: of order 2.7. At the start it is what the change of h makes of it, most of the whole.
            // Large steps can have more than one root. So that the answer does not hang on rounding errors, the
            // iterates must halve the residual (but for the first one, which often overshoots).
            CurvePoint<Real> root = at;
            Mask<Real> found = !active, lost = Mask<Real>(false);
            Real before = Real(std::numeric_limits<double>::infinity()), last_change = before;
            Real curvature = -2.0 * (s_trial - at.s) * at.h_rate, s_curvature(0.0);
            int iteration = 1;
            for (; iteration <= most_newton_steps; ++iteration) {
                const Real R = abs(at.residual), square_slope = at.slope * at.slope;
                const Mask<Real> sound = at.slope > Real(0.0) && R <= 0.5 * before;
                lost = lost || !sound;
                const Real step =
                    at.residual * at.slope / max(square_slope - 0.5 * (at.residual * curvature), 0.5 * square_slope);
                const Real size = abs(step), target = at.zeta - step;
                // What this step leaves is a small part of its square times that of the last one, the series of the
                // exponentials leave its cube.
                const Real square_zeta = at.zeta * at.zeta;
                const Mask<Real> small = size <= 1e-8 * at.zeta || size * last_change <= 1e-7 * square_zeta;
                const Mask<Real> close = small && (w * at.zeta) * size <= Real(3e-6);
                const Mask<Real> now = close && !lost && !found;
                root.assign(now, at.moved_to(target, *this, s_curvature));
                found = found || now;
                if (all(found || lost)) break;
                if (iteration > 1) before = R;
                Real next = select(target > upper, 0.5 * (at.zeta + upper), target);
                next = select(target < lower, 0.5 * (at.zeta + lower), next);
                const Real change = next - at.zeta, inverse_change = 1.0 / change;
                const CurvePoint<Real> last = at;
                at = curve_point(next, v_max, over, s_trial);
                last_change = abs(change);
                const auto bend = [&inverse_change](const Real& rise, const Real& slope, const Real& slope_before) {
                    return inverse_change * (4.0 * slope + 2.0 * slope_before - 6.0 * (inverse_change * rise));
                };
                curvature = bend(at.residual - last.residual, at.slope, last.slope);
                s_curvature = bend(at.s - last.s, at.s_slope, last.s_slope);
            }
            solves.count(iteration);
            const Mask<Real> wrong = active && !(found && root.s <= (1.0 + 1e-13) * s_trial);
            if (any(wrong)) [[unlikely]] {
                const Real zeta = bracketed_lanes(v_max, over, s_trial, root.zeta, wrong, solves);
                root.assign(wrong, curve_point(zeta, v_max, over, s_trial));
            }
            return root;
        }
    }

  private:
    static constexpr int most_newton_steps = 10;
    static constexpr double largest_r = 1e60;

    // With a = M A/(3 mu) and j = c a^2 (the page's 1/k) the positive root of f = 0 for given v is z = j rg with
    // rg = 2r/(B + E), and s = a sqrt(rg): free of overflow, and alpha = 0 is j = 0, rg = r.
    template <class Real>
    CurvePoint<Real> curve_point(const Real& A, const Real& r, const Real& zeta, const Real& compaction,
                                 const Real& s_trial) const {
        const double inverse_kappa = elasticity.inverse_kappa, alpha = elasticity.alpha;
        const Real mu = elasticity.shear_modulus(A);
        const Real twice_zeta = 2.0 * zeta, pc_ratio = 1.0 + r;
        CurvePoint<Real> at;
        at.zeta = zeta;
        at.A = A;
        at.r = r;
        const Real A_slope = -inverse_kappa * (twice_zeta * A);
        if (alpha == 0.0) {
            at.s = strain_per_stress * A * sqrt(r);
            at.s_slope = at.s * (w * zeta * pc_ratio / r - inverse_kappa * twice_zeta);
            at.h = A * (1.0 - r);
            at.h_rate = -A * (2.0 * inverse_kappa + inverse_theta * pc_ratio);
        } else {
            const Real inverse_mu = 1.0 / mu, A_over_mu = A * inverse_mu;
            const Real j = A_over_mu * ((scale * A) * inverse_mu), four_rjj = 4.0 * r * j * j;
            const Real B = 1.0 + j * (1.0 - r);
            const Real E = sqrt(B * B + four_rjj);
            Real sum = B + E;
            const Mask<Real> cancels = B < Real(0.0);
            if (any(cancels)) sum = select(cancels, four_rjj / select(cancels, E - B, Real(1.0)), sum);
            const Real inverse_sum = 1.0 / sum, inverse_rE = 1.0 / (r * E);
            const Real z = j * (2.0 * r * inverse_sum);
            at.s = (third_M * A_over_mu) * (sqrt(2.0 * r * sum) * inverse_sum);  // the root runs beside the division
            at.h = A * (1.0 + 2.0 * z - r);
            // d ln z/d delta = d ln(s^2)/d delta
            const Real mu0_share = (4.0 * elasticity.mu0 * inverse_kappa) * inverse_mu;
            const Real rate = ((1.0 + z) * (w * pc_ratio) * sum - mu0_share * r) * (0.5 * inverse_rE);
            at.s_slope = at.s * rate * zeta;
            at.h_rate = A * (2.0 * z * rate - (2.0 * inverse_kappa) * (1.0 + z) - inverse_theta * pc_ratio);
        }
        const Real missing = s_trial - at.s;
        at.residual = flow_factor * mu * at.s * compaction - missing * at.h;
        at.slope = flow_factor * (compaction * (alpha * A_slope * at.s + mu * at.s_slope) + twice_zeta * mu * at.s) +
                   at.h * at.s_slope - twice_zeta * missing * at.h_rate;
        return at;
    }
    // Roots have r far below the limit; beyond it only the signs matter.
    template <class Real>
    CurvePoint<Real> curve_point(const Real& zeta, const Real& v_max, const Real& over, const Real& s_trial) const {
        const Real delta = zeta * zeta;
        return curve_point<Real>(elasticity.volumetric_pressure(Real(v_max - delta)),
                                 min(quick_expm1(Real(w * delta)), Real(largest_r)), zeta, over + delta, s_trial);
    }
    template <class Real>
    [[gnu::noinline]] Real bracketed_lanes(const Real& v_max, const Real& over, const Real& s_trial, const Real& zeta,
                                           const Mask<Real>& wrong, SolveCounter<Real> solves) const {
        int evaluations = 0;
        const Lanes<Real> v = to_lanes(v_max), o = to_lanes(over), s = to_lanes(s_trial);
        Lanes<Real> z = to_lanes(zeta);
        for (std::size_t lane = 0; lane < z.size(); ++lane)
            if (is_set<Real>(wrong, lane)) z[lane] = bracketed(v[lane], o[lane], s[lane], evaluations);
        solves.count(evaluations, evaluations);
        return from_lanes<Real>(z);
    }

    // Steps 6 and 7 with a bracket that is known to hold a root, and its repair (alpha > 0 only).
    double bracketed(double v_max, double over, double s_trial, int& evaluations) const {
        const auto at = [&](double delta) {
            ++evaluations;
            return curve_point(sqrt(delta), v_max, over, s_trial);
        };
        const auto admissible = [&](double delta) {
            const CurvePoint<double> x = at(delta);
            return x.h > 0.0 && x.s < s_trial;
        };
        const auto root = [&](double lower, double upper) {
            const auto residual = [&](double zeta) {
                ++evaluations;
                const CurvePoint<double> x = curve_point(zeta, v_max, over, s_trial);
                return Residual<double>{x.residual, x.slope};
            };
            double from = sqrt(lower), to = sqrt(upper);
            // Halved first: which of several roots is found shall not hang on rounding errors.
            for (int i = 0; i < 12; ++i) {
                const double middle = 0.5 * (from + to);
                (residual(middle).value < 0.0 ? from : to) = middle;
            }
            const double zeta = solve_bracketed<Slope::increasing>(residual, from, to, 0.5 * (from + to), 0.0).x;
            return zeta * zeta;
        };
        const double top = max(-over, 0.0);
        double good, bad, delta;
        if (top < half_delta || at(top).h > 0.0) {  // contractive
            good = top;
            bad = half_delta;
            if (elasticity.alpha > 0.0) {
                bad = top + half_delta;
                for (int doubling = 0; doubling < 60 && admissible(bad); ++doubling) {
                    good = bad;
                    bad = top + 2.0 * (bad - top);
                }
            }
            const auto halve = [&] {
                const double middle = 0.5 * (good + bad);
                (admissible(middle) ? good : bad) = middle;
            };
            for (int i = 0; i < 100 && at(bad).residual < 0.0; ++i) halve();
            delta = root(top, bad);
            if (at(delta).s > s_trial) {
                for (int i = 0; i < 100; ++i) halve();
                delta = root(top, bad);
            }
        } else {
            delta = at(half_delta).s > s_trial ? half_delta : root(half_delta, top);
            if (at(delta).s > s_trial) {
                good = half_delta;
                bad = top;
                for (int i = 0; i < 100; ++i) {
                    const double middle = 0.5 * (good + bad);
                    (at(middle).h > 0.0 ? good : bad) = middle;
                }
                delta = root(bad, top);
            }
        }
        return sqrt(delta);
    }
};

}  // namespace lode
