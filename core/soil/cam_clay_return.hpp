// One backward Euler step of CAM_CLAY in the elastic invariants, and its linearisation (page 70, "Update algorithm",
// "Consistent tangent"). The three unknowns v, s and dgamma are reduced exactly to one equation along the curve f = 0.
#pragma once

#include "lode/soil/cam_clay_curve.hpp"
#include "lode/soil/cam_clay_description.hpp"
#include "lode/soil/cam_clay_newton.hpp"

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
    Mask<Real> failed;  // the textbook Newton has found no solution
};

// The linearised step: d(v, s) for changes of (v_tr, s_tr, ln pc_n), and G = mu/(1 + 6 dgamma mu/M^2).
struct CamClayLinearStep {
    double v_vtr, v_str, v_pc, s_vtr, s_str, s_pc;
    double shear;
};

struct CamClayReturn : CamClayCurve {
    int method = cam_clay::SCALAR_EQUATION;

    CamClayReturn(const CamClayElasticity& elastic, double lambda, double slope,
                  int solution = cam_clay::SCALAR_EQUATION)
        : CamClayCurve(elastic, lambda, slope), method(solution) {}

    // `over` = v_tr - v_max in a form without cancellation (step 2).
    template <class Real>
    Real overshoot(const Real& v_trial, const Real& log_pc) const {
        return (v_trial * elasticity.inverse_kappa - log_pc) * inverse_w;
    }

    // Steps 2 to 8. `log_pc` = ln(pc/p_ref) at the start, `v_start` and `s_start` the elastic invariants there (only
    // Newton from the old state asks for them).
    template <class Real>
    LODE_INLINE CamClayStep<Real> step(const Real& v_trial, const Real& s_trial, const Real& pc, const Real& log_pc,
                                       const Real& v_start = Real(0.0), const Real& s_start = Real(0.0),
                                       const SolveCounter<Real>& solves = {}) const {
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
        end.failed = Mask<Real>(false);
        const Real inverse_pc = 1.0 / pc;
        const Real p_relative = end.p * inverse_pc, q_relative = end.q * inverse_pc;
        end.plastic = !(q_relative * q_relative * inverse_M_square + p_relative * (p_relative - 1.0) <= Real(1e-10));
        if (!any(end.plastic)) return end;

        // Step 4, the isotropic axis: v = v_max is exact for any step.
        const Mask<Real> isotropic = s_trial <= Real(1e-15);
        const Mask<Real> sheared = end.plastic && !isotropic;
        Real delta = zero, s = zero, A = A_top, r = zero;
        if (any(sheared) && method != cam_clay::SCALAR_EQUATION) [[unlikely]] {
            const bool from_trial = method == cam_clay::NEWTON_FROM_TRIAL;
            const CamClayNewtonResult<Real> root =
                solve_by_full_newton<Real>(*this, v_trial, s_trial, pc, from_trial ? v_trial : v_start,
                                           from_trial ? s_trial : s_start, sheared, solves);
            end.failed = sheared && !root.found;
            const Mask<Real> found = sheared && root.found;
            delta = select(found, v_max - root.v, zero);
            s = select(found, root.s, zero);
            A = select(found, elasticity.volumetric_pressure(select(found, root.v, v_top)), A);
            r = select(found, expm1(w * delta), zero);
        } else if (any(sheared)) {
            const Real r_top = select(over < zero, pc / A_top - 1.0, zero);
            const CurvePoint<Real> at =
                solve(v_max, over, select(isotropic, Real(1.0), s_trial), A_top, r_top, sheared, solves);
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
        // s/s_tr: zero on the axis (step 4), where its limit still is the derivative.
        Real ratio = s / select(isotropic, Real(1.0), s_trial);
        if constexpr (is_differentiated<Real>)
            if (isotropic) ratio = 1.0 / (1.0 + flow_factor * mu * dgamma);
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
};

}  // namespace lode
