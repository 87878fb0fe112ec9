// One backward Euler step of CAM_CLAY in the elastic invariants (page 70, "Update algorithm"). The three unknowns v, s
// and dgamma are reduced exactly to one equation R = 0 along the curve f = 0, whose parameter delta = v_max - v >= 0
// is measured from the isotropic tip of the hardened surface.
#pragma once

#include "lode/numerics/root.hpp"
#include "lode/soil/cam_clay_elasticity.hpp"
#include "lode/soil/lanes.hpp"

namespace lode {

// State at the end of a step, and what the step did.
template <class Real>
struct CamClayStep {
    Real v, s, A, mu, p, q, pc;
    Real log_pc;              // ln(pc/p_ref)
    Real plastic_compaction;  // dv^p = dgamma h
    Real dgamma, h;           // h = df/dp = 2p - pc
    Real shear_ratio;         // dev eps^e = shear_ratio * its trial value
    Mask<Real> plastic;
};

// The linearised step: d(v, s) for changes of (v_tr, s_tr, ln pc_n), and G = mu/(1 + 6 dgamma mu/M^2).
struct CamClayLinearStep {
    double v_vtr, v_str, v_pc, s_vtr, s_str, s_pc;
    double shear;
};

struct CamClayReturn {
    CamClayElasticity elasticity;
    double M, theta;  // theta = lambda - kappa
    double inverse_theta, w, inverse_w;
    double half_delta;   // w delta = ln 2: critical state for alpha = 0; h > 0 wherever delta is less
    double flow_factor;  // 6/M^2
    double inverse_M_square;
    double strain_per_stress;  // alpha = 0: s = strain_per_stress * A sqrt(r) on the curve

    CamClayReturn(const CamClayElasticity& elastic, double lambda, double slope)
        : elasticity(elastic),
          M(slope),
          theta(lambda - elastic.kappa),
          inverse_theta(1.0 / theta),
          w(elastic.inverse_kappa + inverse_theta),
          inverse_w(1.0 / w),
          half_delta(0.69314718055994530942 / w),
          flow_factor(6.0 / (slope * slope)),
          inverse_M_square(1.0 / (slope * slope)),
          strain_per_stress(slope / (3.0 * elastic.mu0)) {}

    // `over` = v_tr - v_max in a form without cancellation (step 2).
    template <class Real>
    Real overshoot(const Real& v_trial, const Real& log_pc) const {
        return (v_trial * elasticity.inverse_kappa - log_pc) * inverse_w;
    }

    // Steps 2 to 8. `log_pc` = ln(pc/p_ref) at the start.
    template <class Real>
    LODE_INLINE CamClayStep<Real> step(const Real& v_trial, const Real& s_trial, const Real& pc,
                                       const Real& log_pc) const {
        const Real zero(0.0);
        const Real over = overshoot(v_trial, log_pc);
        const Real v_max = (v_trial * inverse_theta + log_pc) * inverse_w;
        const Real v_top = min(v_trial, v_max);
        const Real A_top = elasticity.volumetric_pressure(v_top);

        // Where over > 0 the state is plastic but for the tolerance, within which the exponential is linear.
        CamClayStep<Real> end;
        end.v = v_trial;
        end.s = s_trial;
        end.A = A_top + positive_part(over) * elasticity.inverse_kappa * A_top;
        end.mu = elasticity.shear_modulus(end.A);
        end.p = elasticity.pressure(end.A, end.s);
        end.q = 3.0 * end.mu * end.s;
        end.pc = pc;
        end.log_pc = log_pc;
        end.plastic_compaction = zero;
        end.dgamma = zero;
        end.shear_ratio = Real(1.0);
        end.h = zero;
        const Real inverse_pc = 1.0 / pc;
        const Real p_relative = end.p * inverse_pc, q_relative = end.q * inverse_pc;
        end.plastic = !(q_relative * q_relative * inverse_M_square + p_relative * (p_relative - 1.0) <= Real(1e-10));
        if (!any(end.plastic)) return end;

        // Step 4, the isotropic axis: v = v_max is exact for any step.
        const Mask<Real> isotropic = s_trial <= Real(1e-15);
        const Mask<Real> sheared = end.plastic && !isotropic;
        Real delta = zero, s = zero, A = A_top, r = zero;
        if (any(sheared)) {
            const Real r_top = select(over < zero, pc / A_top - 1.0, zero);
            const CurvePoint<Real> at =
                solve(v_max, over, select(isotropic, Real(1.0), s_trial), A_top, r_top, sheared);
            delta = select(sheared, at.zeta * at.zeta, zero);
            s = select(sheared, at.s, zero);
            A = select(sheared, at.A, A);
            r = select(sheared, at.r, zero);
        }
        const Real mu = elasticity.shear_modulus(A);
        const Real p = elasticity.pressure(A, s), pc_new = A * (1.0 + r), h = 2.0 * p - pc_new;
        const Real compaction = over + delta;
        // Step 8: at the critical state compaction/h is 0/0.
        const Mask<Real> by_volume = isotropic || abs(h) > 0.5 * pc_new;
        const Real dgamma =
            positive_part(select(by_volume, compaction, s_trial - s) / select(by_volume, h, flow_factor * mu * s));

        end.v = select(end.plastic, v_max - delta, end.v);
        end.s = select(end.plastic, s, end.s);
        end.A = select(end.plastic, A, end.A);
        end.mu = select(end.plastic, mu, end.mu);
        end.p = select(end.plastic, p, end.p);
        end.q = select(end.plastic, 3.0 * mu * s, end.q);
        end.pc = select(end.plastic, pc_new, end.pc);
        end.log_pc = select(end.plastic, log_pc + compaction * inverse_theta, end.log_pc);
        end.plastic_compaction = select(end.plastic, compaction, zero);
        end.dgamma = select(end.plastic, dgamma, zero);
        end.h = select(end.plastic, h, zero);
        // s/s_tr, on the axis its limit
        const Real ratio =
            select(isotropic, Real(1.0), s) / select(isotropic, 1.0 + flow_factor * mu * dgamma, s_trial);
        end.shear_ratio = select(end.plastic, ratio, end.shear_ratio);
        return end;
    }

    // "Consistent tangent": the linearised system of three equations, the third one divided by pc.
    LODE_INLINE CamClayLinearStep linearised(const CamClayStep<double>& e) const {
        if (!e.plastic) return {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, e.mu};
        const double W_vv = e.p * elasticity.inverse_kappa, W_vs = elasticity.coupling_modulus(e.A, e.s);
        const double inverse_pc = 1.0 / e.pc;
        const double a11 = 1.0 + e.dgamma * (2.0 * W_vv + e.pc * inverse_theta), a12 = 2.0 * e.dgamma * W_vs;
        const double a21 = a12 * inverse_M_square, a22 = 1.0 + flow_factor * e.dgamma * e.mu;
        const double b1 = e.h * inverse_pc, b2 = 2.0 * e.q * inverse_M_square * inverse_pc;
        const double hardening = e.p * inverse_theta;
        const double c1 = b1 * W_vv + b2 * W_vs + hardening, c2 = b1 * W_vs + 3.0 * b2 * e.mu;
        // (dv, ds) = A^-1 (rhs - b x), x from the third equation.
        const double determinant = a11 * a22 - a12 * a21;
        const double by1 = a22 * b1 - a12 * b2, by2 = a11 * b2 - a21 * b1;  // det A^-1 b
        const double cy1 = c1 * a22 - c2 * a21, cy2 = c2 * a11 - c1 * a12;  // det c A^-1
        const double inverse_det = 1.0 / determinant;
        const double inverse_pivot = 1.0 / (cy1 * b1 + cy2 * b2);
        const double d = e.dgamma * e.pc;
        const auto solve_for = [&](double r1, double r2, double r3, double& dv, double& ds) {
            const double x = (cy1 * r1 + cy2 * r2 - determinant * r3) * inverse_pivot;
            dv = (a22 * r1 - a12 * r2 - by1 * x) * inverse_det;
            ds = (a11 * r2 - a21 * r1 - by2 * x) * inverse_det;
        };
        CamClayLinearStep l;
        solve_for(1.0 + d * inverse_theta, 0.0, hardening, l.v_vtr, l.s_vtr);
        solve_for(0.0, 1.0, 0.0, l.v_str, l.s_str);
        solve_for(d, 0.0, e.p, l.v_pc, l.s_pc);
        l.shear = e.mu / a22;
        return l;
    }

  private:
    static constexpr int most_newton_steps = 10;
    static constexpr double largest_r = 1e60;

    // A point of the curve f = 0, R there, and their slopes in zeta = sqrt(delta) (steps 5 to 7).
    template <class Real>
    struct CurvePoint {
        Real zeta, A, r, s, h, residual, slope;
        Real A_slope, r_slope, s_slope;

        // A point nearby, to first order.
        CurvePoint moved_to(const Real& target) const {
            CurvePoint x = *this;
            const Real step = target - zeta;
            x.zeta = target;
            x.A = A + A_slope * step;
            x.r = r + r_slope * step;
            x.s = s + s_slope * step;
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
        at.A_slope = -inverse_kappa * (twice_zeta * A);
        at.r_slope = w * (twice_zeta * pc_ratio);
        Real h_rate;  // dh/d delta
        if (alpha == 0.0) {
            at.s = strain_per_stress * A * sqrt(r);
            at.s_slope = at.s * (0.5 * at.r_slope / r - inverse_kappa * twice_zeta);
            at.h = A * (1.0 - r);
            h_rate = -A * (2.0 * inverse_kappa + inverse_theta * pc_ratio);
        } else {
            const Real inverse_mu = 1.0 / mu;
            const Real a = (M / 3.0) * A * inverse_mu;
            const Real j = elasticity.c * a * a, four_rjj = 4.0 * r * j * j;
            const Real B = 1.0 + j * (1.0 - r);
            const Real E = sqrt(B * B + four_rjj);
            Real sum = B + E;
            const Mask<Real> cancels = B < Real(0.0);
            if (any(cancels)) sum = select(cancels, four_rjj / select(cancels, E - B, Real(1.0)), sum);
            const Real inverse = 1.0 / (r * (E * sum));
            const Real rg = 2.0 * r * r * E * inverse, z = j * rg;
            at.s = a * sqrt(rg);
            at.h = A * (1.0 + 2.0 * z - r);
            // d ln z/d delta = d ln(s^2)/d delta
            const Real mu0_share = (4.0 * elasticity.mu0 * inverse_kappa) * inverse_mu;
            const Real rate = ((1.0 + z) * (w * pc_ratio) * sum - mu0_share * r) * (0.5 * sum * inverse);
            at.s_slope = at.s * rate * zeta;
            h_rate = A * (2.0 * z * rate - (2.0 * inverse_kappa) * (1.0 + z) - inverse_theta * pc_ratio);
        }
        const Real missing = s_trial - at.s;
        at.residual = flow_factor * mu * at.s * compaction - missing * at.h;
        at.slope = flow_factor * (compaction * (alpha * at.A_slope * at.s + mu * at.s_slope) + twice_zeta * mu * at.s) +
                   at.h * at.s_slope - twice_zeta * missing * h_rate;
        return at;
    }
    // Roots have r far below the limit; beyond it only the signs matter.
    template <class Real>
    CurvePoint<Real> curve_point(const Real& zeta, const Real& v_max, const Real& over, const Real& s_trial) const {
        const Real delta = zeta * zeta;
        // r = expm1(x); away from the tip the quicker difference has the same digits.
        const Real x = w * delta;
        const Real r = all(x > Real(0.1)) ? exp(x) - 1.0 : expm1(x);
        return curve_point<Real>(elasticity.volumetric_pressure(Real(v_max - delta)), min(r, Real(largest_r)), zeta,
                                 over + delta, s_trial);
    }

    // The solution of R = 0 in the `active` lanes: Newton's method from the point of the curve at the trial volume,
    // where A and r are those of the start; lanes in which it finds no admissible root get the bracketed solution.
    template <class Real>
    CurvePoint<Real> solve(const Real& v_max, const Real& over, const Real& s_trial, const Real& A_top,
                           const Real& r_top, const Mask<Real>& active) const {
        if constexpr (is_differentiated<Real>) {
            const double zeta = solve<double>(value_of(v_max), value_of(over), value_of(s_trial), value_of(A_top),
                                              value_of(r_top), active)
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

            CurvePoint<Real> root = at;
            Mask<Real> found = !active;
            for (int iteration = 1; iteration <= most_newton_steps; ++iteration) {
                // R rises through the root; where it falls, its sign still tells on which side the root is.
                const Real side = select(at.residual < Real(0.0), Real(-1e3), Real(1e3));
                const Real step = select(at.slope > Real(0.0), at.residual / at.slope, side);
                const Real newton = at.zeta - step, size = abs(step);
                // What this step leaves, and what first order leaves of the exponentials, is of the order of its
                // square.
                const Mask<Real> close = size <= 1e-8 * at.zeta && (w * at.zeta) * size <= Real(1e-8);
                root.assign(close && !found, at.moved_to(newton));
                found = found || close;
                if (all(found)) break;
                Real next = select(newton > upper, 0.5 * (at.zeta + upper), newton);
                next = select(newton < lower, 0.5 * (at.zeta + lower), next);
                at = curve_point(next, v_max, over, s_trial);
            }
            const Mask<Real> wrong = active && !(found && root.s <= (1.0 + 1e-13) * s_trial);
            if (any(wrong)) [[unlikely]] {
                const Real zeta = bracketed_lanes(v_max, over, s_trial, root.zeta, wrong);
                root.assign(wrong, curve_point(zeta, v_max, over, s_trial));
            }
            return root;
        }
    }

    template <class Real>
    [[gnu::noinline]] Real bracketed_lanes(const Real& v_max, const Real& over, const Real& s_trial, const Real& zeta,
                                           const Mask<Real>& wrong) const {
        const Lanes<Real> v = to_lanes(v_max), o = to_lanes(over), s = to_lanes(s_trial);
        Lanes<Real> z = to_lanes(zeta);
        for (std::size_t lane = 0; lane < z.size(); ++lane)
            if (is_set<Real>(wrong, lane)) z[lane] = bracketed(v[lane], o[lane], s[lane]);
        return from_lanes<Real>(z);
    }

    // Steps 6 and 7 with a bracket that is known to hold a root, and its repair (alpha > 0 only).
    double bracketed(double v_max, double over, double s_trial) const {
        const auto at = [&](double delta) { return curve_point(sqrt(delta), v_max, over, s_trial); };
        const auto admissible = [&](double delta) {
            const CurvePoint<double> x = at(delta);
            return x.h > 0.0 && x.s < s_trial;
        };
        const auto root = [&](double lower, double upper) {
            const auto residual = [&](double zeta) {
                const CurvePoint<double> x = curve_point(zeta, v_max, over, s_trial);
                return Residual<double>{x.residual, x.slope};
            };
            const double from = sqrt(lower), to = sqrt(upper);
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
