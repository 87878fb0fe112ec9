// Newton's method on all three unknowns of a backward Euler step of CAM_CLAY at once, as the source does it (Banerjee,
// section 3.2; page 70, "Where methods fail", 6). It converges to the root of the scalar method where it converges to
// an admissible one. It is there to be compared with, not to be relied on: p is exponential in v, so that a start too
// far from the root leads anywhere.
#pragma once

#include "lode/numerics/scalar.hpp"
#include "lode/soil/cam_clay_curve.hpp"

namespace lode {

template <class Real>
struct CamClayNewtonResult {
    Real v, s;
    Mask<Real> found;
};

// v - v_tr + dgamma h = 0,   s - s_tr + dgamma 2 q/M^2 = 0,   (q^2/M^2 + p (p - pc))/pc_n^2 = 0
// from (v, s, 0) in the `active` lanes. `pc` is that of the start of the step.
template <class Real>
[[gnu::noinline]] CamClayNewtonResult<Real> solve_by_full_newton(const CamClayCurve& curve, Real v_trial, Real s_trial,
                                                                 Real pc, Real v, Real s, Mask<Real> active,
                                                                 SolveCounter<Real> solves) {
    constexpr int most_iterations = 50;
    constexpr double tolerance = 1e-13;
    const CamClayElasticity& elastic = curve.elasticity;
    const double per_M2 = curve.inverse_M_square, per_theta = curve.inverse_theta;
    const Real per_pc2 = 1.0 / (pc * pc);
    Real dgamma(0.0);
    Mask<Real> converged(false), lost = !active;
    int iteration = 0;
    for (; iteration < most_iterations; ++iteration) {
        const Mask<Real> last = converged || lost;
        const Real A = elastic.volumetric_pressure(v), mu = elastic.shear_modulus(A), p = elastic.pressure(A, s);
        const Real q = 3.0 * mu * s, pc_end = pc * exp((v_trial - v) * per_theta), h = 2.0 * p - pc_end;
        const Real W_vv = p * elastic.inverse_kappa, W_vs = elastic.coupling_modulus(A, s);
        const Real r1 = v - v_trial + dgamma * h, r2 = s - s_trial + (2.0 * per_M2) * dgamma * q;
        const Real r3 = (per_M2 * q * q + p * (p - pc_end)) * per_pc2;

        const Real a11 = 1.0 + dgamma * (2.0 * W_vv + pc_end * per_theta), a12 = 2.0 * dgamma * W_vs;
        const Real a21 = per_M2 * a12, a22 = 1.0 + curve.flow_factor * dgamma * mu, a23 = (2.0 * per_M2) * q;
        const Real a31 = (a23 * W_vs + h * W_vv + p * pc_end * per_theta) * per_pc2;
        const Real a32 = (3.0 * a23 * mu + h * W_vs) * per_pc2;
        // The 2 x 2 block of the strains is eliminated, as the source does.
        const Real det = a11 * a22 - a12 * a21;
        const Real v_r = (a22 * r1 - a12 * r2) / det, s_r = (a11 * r2 - a21 * r1) / det;
        const Real v_g = (a22 * h - a12 * a23) / det, s_g = (a11 * a23 - a21 * h) / det;
        const Real step = (r3 - a31 * v_r - a32 * s_r) / (a31 * v_g + a32 * s_g);
        const Real dv = v_r + v_g * step, ds = s_r + s_g * step;
        const Real change = abs(dv) + abs(ds), scale = abs(v) + abs(s) + abs(v_trial) + s_trial;

        lost = lost || (!converged && !is_finite(change + r3));
        Mask<Real> go_on = !lost;
        if (!is_differentiated<Real>) go_on = go_on && !converged;
        v = select(go_on, v - dv, v);
        s = select(go_on, s - ds, s);
        dgamma = select(go_on, dgamma + step, dgamma);
        // Derivatives lag one step behind the value: a differentiated number takes one more.
        if (all(last)) break;
        converged = converged || (go_on && change <= tolerance * scale && abs(r3) <= Real(1e-10));
        if (!is_differentiated<Real> && all(converged || lost)) break;
    }
    solves.count(std::min(iteration + 1, most_iterations));
    return {v, s, converged && dgamma >= Real(0.0) && s >= Real(0.0)};
}

}  // namespace lode
