// One crack in a given stress: how far it opens and slides (page 80, 4 C), and how that answers to the stress (5).
#pragma once

#include "lode/decohesive/crack_law.hpp"
#include "lode/numerics/root.hpp"

namespace lode {

enum class CrackResponse { elastic, softening, open, stick, slip };

// The increment of the displacement jump, in the frame of the crack.
template <class Real>
struct CrackJump {
    Real n, t, p;
    Real omega, eta;  // multiplier; ratio by which the shear traction shrinks
    CrackResponse response;

    static CrackJump none(CrackResponse r = CrackResponse::elastic) {
        return {Real(0.0), Real(0.0), Real(0.0), Real(0.0), Real(1.0), r};
    }
    // Answers to the stress. (A crack that sticks may have been closed by the increment, and yet does not.)
    bool is_active() const { return response != CrackResponse::elastic && response != CrackResponse::stick; }
    // Beyond u_0.
    bool has_failed() const {
        return response == CrackResponse::open || response == CrackResponse::stick || response == CrackResponse::slip;
    }
};

namespace crack_return_detail {

// (C3) Unilateral contact at the opening u_0 with Coulomb friction; x_f: the opening that is left to u_0.
template <class Real>
CrackJump<Real> failed(const CrackLaw& law, const PlaneStresses<Real>& s, const Real& x_f) {
    CrackJump<Real> jump = CrackJump<Real>::none(CrackResponse::open);
    const Real contact = s.n - law.A_n * x_f;
    if (contact >= Real(0.0)) {
        jump.n = s.n * (1.0 / law.A_n);
        jump.t = s.t * (1.0 / law.A_s);
        jump.p = s.p * (1.0 / law.A_s);
        return jump;
    }
    jump.n = x_f;
    jump.response = CrackResponse::stick;
    if (law.mu == 0.0) {
        jump.response = CrackResponse::slip;
        jump.t = s.t * (1.0 / law.A_s);
        jump.p = s.p * (1.0 / law.A_s);
        return jump;
    }
    const Real limit = -law.mu * contact, tau_s_square = s.t * s.t + s.p * s.p;
    // With the tolerance of F, so that a zero increment after slip sticks.
    if (tau_s_square > limit * limit * square(1.0 + decohesion_tolerance)) {
        jump.response = CrackResponse::slip;
        const Real share = (1.0 - limit / sqrt(tau_s_square)) * (1.0 / law.A_s);
        jump.t = share * s.t;
        jump.p = share * s.p;
    }
    return jump;
}

// The two equations of a softening crack in x and omega, x = omega N and F = 0 at the end state, with their matrix.
template <class Real>
struct SofteningEquations {
    Real flow, surface;
    double flow_x, flow_omega, surface_x, surface_omega;
    Decohesion<double> end;  // at the values, order 2
    double slope;            // df/du

    SofteningEquations(const CrackLaw& law, const PlaneStresses<Real>& s, const Real& u, const Real& x,
                       const Real& omega) {
        const Real eta = 1.0 / (1.0 + law.kappa * omega);
        const Real tau_s_square = (eta * eta) * (s.t * s.t + s.p * s.p);
        const double squared = law.strength.inverse_tau_sf_square;
        end = evaluate_decohesion<2>(law.strength, law.opened(values(s), value_of(x)),
                                     law.softening(value_of(u) + value_of(x)));
        if constexpr (is_differentiated<Real>) {
            const auto at = evaluate_decohesion<1>(law.strength, law.opened(s, x), law.softening(Real(u + x)));
            flow = x - omega * at.N;
            surface = squared * tau_s_square - at.Phi;
        } else {
            flow = x - omega * end.N;
            surface = squared * tau_s_square - end.Phi;
        }
        slope = law.slope(law.softening(value_of(u) + value_of(x)));
        const double N_along = law.A_n * end.N_n + law.A_t * end.N_tt + law.A_p * end.N_pp;
        const double F_along = law.A_n * end.N + law.A_t * end.F_tt + law.A_p * end.F_pp;
        flow_x = 1.0 + value_of(omega) * (N_along - end.N_f * slope);
        flow_omega = -end.N;
        surface_x = -F_along + end.F_f * slope;
        surface_omega = -2.0 * law.kappa * squared * value_of(eta) * value_of(tau_s_square);
    }
    double determinant() const { return flow_x * surface_omega - flow_omega * surface_x; }

  private:
    static PlaneStresses<double> values(const PlaneStresses<Real>& s) {
        return {value_of(s.n), value_of(s.t), value_of(s.p), value_of(s.tt), value_of(s.pp), value_of(s.tp)};
    }
};

// B at the end state as the crack opens by x.
inline Residual<double> mode_one(const CrackLaw& law, const PlaneStresses<double>& s, double u, double x) {
    const double f = law.softening(u + x);
    const auto d = evaluate_decohesion<1>(law.strength, law.opened(s, x), f);
    return {d.B, -(law.A_n * d.B_n + law.A_t * d.B_tt + law.A_p * d.B_pp) + d.B_f * law.slope(f)};
}

// r(x) = x sqrt(Phi) - (N/kappa)(tau_s,trial/tau_sf - sqrt(Phi)): omega eliminated from the two equations, well scaled
// also where N has all but vanished (deep compression).
inline Residual<double> mixed_mode(const CrackLaw& law, const PlaneStresses<double>& s, double u, double tau_s,
                                   double x) {
    const double f = law.softening(u + x), slope = law.slope(f), inverse_kappa = 1.0 / law.kappa;
    const auto d = evaluate_decohesion<2>(law.strength, law.opened(s, x), f);
    const double root = std::sqrt(std::max(d.Phi, 0.0));
    const double over = tau_s - root;
    const double Phi_x = law.A_n * d.N + law.A_t * d.F_tt + law.A_p * d.F_pp - d.F_f * slope;
    const double N_x = -(law.A_n * d.N_n + law.A_t * d.N_tt + law.A_p * d.N_pp) + d.N_f * slope;
    const double nearer = d.N * inverse_kappa;
    return {x * root - nearer * over, root + (x + nearer) * Phi_x / (2.0 * root) - N_x * inverse_kappa * over};
}

inline constexpr double first_step = 1.0 / 1024.0;  // of the search, in the opening that is left to failure

// The first change of sign of `value` (non-positive at `lower`, or non-negative if `falls`) on steps that double;
// false if there is none up to `end`.
template <class F>
bool first_sign_change(const F& value, bool falls, double end, double& lower, double& upper) {
    double step = (end - lower) * first_step;
    for (;;) {
        upper = std::min(lower + step, end);
        const double v = value(upper);
        if (falls ? v < 0.0 : v > 0.0) return true;
        if (!(upper < end)) return false;
        lower = upper;
        step *= 2.0;
    }
}

// (C2) Opening and multiplier of a crack above its surface, to about `accuracy`; false if it fails.
inline bool soften(const CrackLaw& law, const PlaneStresses<double>& s, double u, double x_f, double accuracy,
                   CrackJump<double>& jump, const SolveCounter<double>& solves) {
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    const double tau_s = std::sqrt((s.t * s.t + s.p * s.p) * law.strength.inverse_tau_sf_square);
    double x_l = 0.0;
    const double B_start = evaluate_decohesion<0>(law.strength, s, law.softening(u)).B;
    if (B_start >= 0.0) {
        const auto B = [&](double x) { return mode_one(law, s, u, x); };
        double lower = 0.0, upper = 0.0;
        if (!first_sign_change([&](double x) { return B(x).value; }, true, x_f, lower, upper)) return false;
        const double size = 1.0 + std::abs(law.strength.inverse_tau_nf * s.n);
        const double tolerance = std::max(2.0 * epsilon, 1e-7 * accuracy) * size;
        const auto root = solve_bracketed<Slope::decreasing>(B, lower, upper, upper, tolerance);
        solves.count(root);
        x_l = root.x;
    }
    jump.n = x_l;
    if (tau_s > 1e-7) {
        const auto r = [&](double x) { return mixed_mode(law, s, u, tau_s, x); };
        double lower = x_l, upper = x_l;
        if (!first_sign_change([&](double x) { return r(x).value; }, false, x_f, lower, upper)) return false;
        const double start_N = evaluate_decohesion<1>(law.strength, law.opened(s, lower), law.softening(u + lower)).N;
        const double tolerance = accuracy * start_N * tau_s / law.kappa;
        if (lower == x_l && B_start >= 0.0) {
            // Phi grows from 0 like x - x_l: its root is smooth in z = sqrt(x - x_l).
            const auto along_z = [&](double z) {
                const Residual<double> at = r(x_l + z * z);
                return Residual<double>{at.value, 2.0 * z * at.slope};
            };
            const double end = std::sqrt(upper - x_l);
            const auto root = solve_bracketed<Slope::increasing>(along_z, 0.0, end, end, tolerance);
            solves.count(root);
            jump.n = x_l + root.x * root.x;
        } else {
            const auto root = solve_bracketed<Slope::increasing>(r, lower, upper, lower, tolerance);
            solves.count(root);
            jump.n = root.x;
        }
    }
    const auto end = evaluate_decohesion<1>(law.strength, law.opened(s, jump.n), law.softening(u + jump.n));
    if (end.N * law.strength.tau_nf < 1e-6 && tau_s > 1e-7)
        jump.omega = (tau_s / std::sqrt(std::max(end.Phi, 0.0)) - 1.0) / law.kappa;
    else jump.omega = jump.n / end.N;
    return true;
}

}  // namespace crack_return_detail

// The solution with its derivatives, from the solution for the values: one step of Newton's method on numbers that
// carry derivatives. For plain numbers it takes off what rounding the root-finder left.
template <class Real>
CrackJump<Real> refined(const CrackLaw& law, const PlaneStresses<Real>& s, const Real& u, const CrackJump<double>& at) {
    using namespace crack_return_detail;
    if (at.response == CrackResponse::elastic) return CrackJump<Real>::none();
    if (at.response != CrackResponse::softening) return failed(law, s, Real(law.u_0 - u));
    CrackJump<Real> jump = CrackJump<Real>::none(at.response);
    if (law.strength.rankine) {
        const double tau_nf = law.strength.tau_nf;
        if (law.exponential) {
            const Real f = law.softening(Real(u + at.n));
            const double rate = law.A_n + tau_nf * law.slope(value_of(f));
            jump.n = at.n + (s.n - law.A_n * at.n - tau_nf * f) * (1.0 / rate);
        } else {
            jump.n = (s.n - tau_nf * law.softening(u)) * (1.0 / (law.A_n - tau_nf * law.inverse_u));
        }
        jump.omega = tau_nf * jump.n;
        return jump;
    }
    const Real x(at.n), omega(at.omega);
    const SofteningEquations<Real> e(law, s, u, x, omega);
    const double inverse = 1.0 / e.determinant();
    jump.n = x - (e.flow * e.surface_omega - e.surface * e.flow_omega) * inverse;
    jump.omega = omega - (e.surface * e.flow_x - e.flow * e.surface_x) * inverse;
    jump.eta = 1.0 / (1.0 + law.kappa * jump.omega);
    const Real sliding = 2.0 * law.strength.inverse_tau_sf_square * (jump.omega * jump.eta);
    jump.t = sliding * s.t;
    jump.p = sliding * s.p;
    return jump;
}

// Newton's method from near the solution, whose opening lies in [lower, upper]; false, and the jump as it was, where it
// does not converge or leaves that.
inline bool polish(const CrackLaw& law, const PlaneStresses<double>& s, double u, double lower, double upper,
                   CrackJump<double>& jump, const SolveCounter<double>& solves) {
    CrackJump<double> better = jump;
    for (int iteration = 0; iteration < 6; ++iteration) {
        const CrackJump<double> next = refined(law, s, u, better);
        solves.count(1);
        if (!(next.n >= lower && next.n <= upper && next.omega >= 0.0)) return false;
        const double change = std::abs(next.n - better.n), omega_change = std::abs(next.omega - better.omega);
        better = next;
        // Of second order: what this step left is rounding.
        if (change <= 1e-9 * next.n && omega_change <= 1e-9 * next.omega) {
            jump = better;
            return true;
        }
    }
    return false;
}

// The jump of a crack of opening u in the stress s that it would bear unopened. `failed`: it had failed before. `near`:
// the jump in a stress close to s, or none.
inline CrackJump<double> crack_jump(const CrackLaw& law, const PlaneStresses<double>& s, double u, bool has_failed,
                                    const SolveCounter<double>& solves,
                                    const CrackJump<double>& near = CrackJump<double>::none()) {
    using namespace crack_return_detail;
    const double x_f = law.u_0 - u;
    CrackJump<double> jump = CrackJump<double>::none();
    if (!has_failed && x_f > 0.0) {
        const DecohesionConstants& k = law.strength;
        const double f = law.softening(u);
        if (decohesion(k, s, f) <= decohesion_tolerance) return jump;
        jump.response = CrackResponse::softening;
        if (!k.rankine) {
            // Newton's method from there. Not farther than the first step of the search, so that it is the root that
            // the search would find.
            const double reach = first_step * x_f;
            if (near.response == CrackResponse::softening) jump = near;
            if (polish(law, s, u, std::max(jump.n - reach, 0.0), std::min(jump.n + reach, x_f), jump, solves))
                return jump;
            // The root to a few digits, then Newton's method on the two equations, which are regular in mode I as well.
            if (!soften(law, s, u, x_f, 1e-5, jump, solves)) return failed(law, s, x_f);
            if (polish(law, s, u, 0.0, x_f, jump, solves)) return jump;
            solves.count(0, 1);
            soften(law, s, u, x_f, std::numeric_limits<double>::epsilon(), jump, solves);
            jump.eta = 1.0 / (1.0 + law.kappa * jump.omega);
            const double sliding = 2.0 * k.inverse_tau_sf_square * jump.omega * jump.eta;
            jump.t = sliding * s.t;
            jump.p = sliding * s.p;
            return jump;
        } else if (law.exponential) {
            const auto r = [&](double x) {
                const double fx = law.softening(u + x);
                return Residual<double>{s.n - law.A_n * x - k.tau_nf * fx, -law.A_n - k.tau_nf * law.slope(fx)};
            };
            if (r(x_f).value < 0.0) {
                const double tolerance = std::numeric_limits<double>::epsilon() * s.n;
                const auto root = solve_bracketed<Slope::decreasing>(r, 0.0, x_f, 0.0, tolerance);
                solves.count(root);
                jump.n = root.x;
                return refined(law, s, u, jump);
            }
        } else {
            jump = refined(law, s, u, jump);
            if (jump.n < x_f) return jump;
        }
    }
    return failed(law, s, x_f);
}

// d(n, t, p of the jump)/d(n, t, p, tt, pp, tp of the stress), from the solution.
struct JumpRate {
    double m[3][6] = {};
};
inline JumpRate jump_rate(const CrackLaw& law, const PlaneStresses<double>& s, double u,
                          const CrackJump<double>& jump) {
    using namespace crack_return_detail;
    JumpRate rate;
    auto& m = rate.m;
    const double compliance = 1.0 / law.A_s;
    switch (jump.response) {
        case CrackResponse::elastic:
        case CrackResponse::stick:
            break;
        case CrackResponse::open:
            m[0][0] = 1.0 / law.A_n;
            m[1][1] = m[2][2] = compliance;
            break;
        case CrackResponse::slip: {
            if (law.mu == 0.0) {
                m[1][1] = m[2][2] = compliance;
                break;
            }
            // Du_s = (tau - limit e)/A_s, e the direction of tau, d limit = -mu d tau_n
            const double tau_s = std::sqrt(s.t * s.t + s.p * s.p), e_t = s.t / tau_s, e_p = s.p / tau_s;
            const double share = -law.mu * (s.n - law.A_n * jump.n) / tau_s;
            m[1][0] = law.mu * e_t * compliance;
            m[2][0] = law.mu * e_p * compliance;
            m[1][1] = (1.0 - share * e_p * e_p) * compliance;
            m[2][2] = (1.0 - share * e_t * e_t) * compliance;
            m[1][2] = m[2][1] = share * e_t * e_p * compliance;
            break;
        }
        case CrackResponse::softening: {
            if (law.strength.rankine) {
                const double tau_nf = law.strength.tau_nf;
                m[0][0] = 1.0 / (law.A_n + tau_nf * law.slope(law.softening(u + jump.n)));
                break;
            }
            const SofteningEquations<double> e(law, s, u, jump.n, jump.omega);
            const double inverse = 1.0 / e.determinant(), omega = jump.omega, eta = jump.eta;
            const double shear = 2.0 * law.strength.inverse_tau_sf_square * eta * eta;
            const Decohesion<double>& d = e.end;
            // Right-hand sides of flow and surface for each of the stresses.
            const double flow[6] = {omega * d.N_n, 0.0, 0.0, omega * d.N_tt, omega * d.N_pp, omega * d.N_tp};
            const double surface[6] = {-d.N, -shear * s.t, -shear * s.p, -d.F_tt, -d.F_pp, -d.F_tp};
            const double sliding = 2.0 * law.strength.inverse_tau_sf_square;
            for (int i = 0; i < 6; ++i) {
                m[0][i] = (flow[i] * e.surface_omega - surface[i] * e.flow_omega) * inverse;
                const double omega_rate = (surface[i] * e.flow_x - flow[i] * e.surface_x) * inverse;
                // Du_s = (2/tau_sf^2) omega eta tau_trial, d(omega eta) = eta^2 d omega
                m[1][i] = sliding * eta * eta * omega_rate * s.t;
                m[2][i] = sliding * eta * eta * omega_rate * s.p;
            }
            m[1][1] += sliding * omega * eta;
            m[2][2] += sliding * omega * eta;
            break;
        }
    }
    return rate;
}

}  // namespace lode
