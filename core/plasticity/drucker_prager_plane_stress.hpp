// The return of DRUCKER_PRAGER in plane stress (page 20, section 4), by t = 1/(1 + a mu), mu = lambda/q, which lies in
// [0, 1]: with S~ = S_end/t and q~ = q_end/t the equations of the page read
//   S~ = S - B q~,  B = 4 eta_bar (1 - t),  12 q~^2 = S~^2 + 12 W,  W = (D^2/4 + tau^2)/b^2,  b = t + (G/a)(1 - t).
// The first two give q~ = (sqrt(12 S^2 + C 12 W) - B S)/C, C = 12 - B^2, or, where S > 0, the same fraction turned
// over, which stays regular as C goes through 0: dilatancy beyond eta_bar = sqrt3/2 needs no other form. Where S < 0
// the root lies above the t of C = 0.
#pragma once

#include "lode/elastic/isotropic_moduli.hpp"
#include "lode/plasticity/drucker_prager_return.hpp"

namespace lode::drucker_prager {

// End of a step: S_end = t S~, and D and tau shrink by t/b.
template <class Real>
struct PlaneStep {
    Mask<Real> yields;
    Real t, b, q, S;  // q~ and S~
    Real dalpha;
    FlowStress<Real> cohesion;
};
// How it answers; `share` is t/b, `alpha` that of the end, `thickness` the plastic strain.
struct PlaneSlopes {
    double sum, share, alpha, work, heat, thickness;
};
// By S and T of the trial state, and by alpha at the start.
struct PlaneLinearisation {
    PlaneSlopes by_S, by_T, by_alpha;
};

template <class Law>
class PlaneReturn {
  public:
    PlaneReturn(const Law& law, const Cone& cone, const IsotropicModuli& e, double initial_cohesion)
        : law_(law),
          cone_(cone),
          a_(e.young / (6.0 * (1.0 - e.poisson))),
          rho_(e.shear / a_),
          inverse_a_(1.0 / a_),
          inverse_xi_(1.0 / cone.xi),
          smallest_t_(std::max(0.0, 1.0 - 0.5 * std::sqrt(3.0) / std::max(cone.eta_bar, 1e-300))),
          initial_cohesion_(initial_cohesion) {
        // The stiffness against lambda is a concave function of z = S/(6 q) on the yield surface: the smaller value of
        // the ends z = 1/sqrt3 and -1/sqrt3, or -1/(2 eta) where the surface is open.
        const auto stiffness = [&](double z) {
            return e.shear * (1.0 - 3.0 * z * z) +
                   3.0 * a_ * (z + 2.0 / 3.0 * cone.eta) * (z + 2.0 / 3.0 * cone.eta_bar);
        };
        const double z = 1.0 / std::sqrt(3.0);
        unloading_ =
            std::min(stiffness(z), stiffness(-std::min(z, 0.5 / std::max(cone.eta, 1e-300)))) / (cone.xi * cone.xi);
    }

    // Elastic unloading in units of c over alpha, at the softest stress state of the yield surface.
    double unloading() const { return unloading_; }

    // S = s11 + s22 and T = D^2/4 + tau^2 of the trial stress, `c` at the start.
    template <class Real>
    LODE_INLINE PlaneStep<Real> operator()(const Real& S, const Real& T, const Real& alpha, const Real& scale,
                                           const FlowStress<Real>& c, const SolveCounter<Real>& solves = {}) const {
        const Real one(1.0), zero(0.0);
        const Real q_trial = sqrt((1.0 / 12.0) * (S * S) + T), pressure = (cone_.eta / 3.0) * S;
        const Real driving = inverse_xi_ * (q_trial + pressure), excess = driving - c.value;
        const Real size = max(inverse_xi_ * max(q_trial, abs(pressure)), c.value);
        PlaneStep<Real> end{excess > yield_tolerance * size, one, one, q_trial, S, zero, c};
        if (!any(end.yields)) return end;

        const auto residual = [S, T, alpha, scale, *this](const Real& t) { return at(t, S, T, alpha, scale); };
        const Real lower = select(S < zero, Real(smallest_t_), zero);
        // Newton's first step from t = 1, where the trial state satisfies all but the yield condition.
        const Trial<Real> first = residual(one);
        const Real start = select(end.yields, 1.0 - excess / select(end.yields, first.slope, one), one);
        const auto root =
            solve_bracketed<Slope::increasing>(residual, lower, one, start, return_tolerance * size, end.yields);
        solves.count(root);
        // With what the iteration has left, so that the answer does not depend on where it stopped.
        const Trial<Real>& last = root.last;
        const Real left = -last.value / last.slope, dalpha = multiplied(root.x, last.q, last.q_slope) * left;
        end.t = select(end.yields, root.x + left, one);
        end.b = end.t + rho_ * (1.0 - end.t);
        end.q = select(end.yields, last.q + last.q_slope * left, q_trial);
        end.S = select(end.yields, last.S + last.S_slope * left, S);
        end.dalpha = select(end.yields, last.dalpha + dalpha, zero);
        end.cohesion.value = select(end.yields, last.c.value + last.c.slope * dalpha, c.value);
        end.cohesion.slope = select(end.yields, last.c.slope, c.slope);
        return end;
    }

    // lambda = (1 - t) q~/a.
    template <class Real>
    LODE_INLINE Real multiplier(const PlaneStep<Real>& e) const {
        return inverse_xi_ * e.dalpha;
    }
    // lambda/q sigma_end = (1 - t)/a times these: what multiplies S~, D/b, tau/b in the plastic strain.
    template <class Real>
    LODE_INLINE Real flow(const PlaneStep<Real>& e) const {
        return inverse_a_ * (1.0 - e.t);
    }
    // dep33 = lambda (eta_bar/3 - S_end/(6 q_end)).
    template <class Real>
    LODE_INLINE Real thickness(const PlaneStep<Real>& e) const {
        return (cone_.eta_bar / 3.0) * multiplier(e) - (1.0 / 6.0) * (flow(e) * e.S);
    }
    // sigma : dep
    template <class Real>
    LODE_INLINE Real work(const PlaneStep<Real>& e) const {
        return multiplier(e) * (e.t * (e.q + (cone_.eta_bar / 3.0) * e.S));
    }
    template <class Real>
    LODE_INLINE Real heat(const PlaneStep<Real>& e) const {
        return positive_part(work(e) - (e.cohesion.value - initial_cohesion_) * e.dalpha);
    }

    // Of a step that yields.
    LODE_INLINE PlaneLinearisation linearise(const PlaneStep<double>& e, double S, double T, double alpha,
                                             double scale) const {
        const double t = e.t, rest = 1.0 - t, eta = cone_.eta, eta_bar = cone_.eta_bar, slope = e.cohesion.slope;
        const Trial<double> r = at(t, S, T, alpha, scale);
        const double inverse_slope = 1.0 / r.slope, inverse_b2 = 1.0 / (e.b * e.b);
        const double lambda = multiplier(e), rise = e.cohesion.value - initial_cohesion_;
        const bool heats = heat(e) > 0.0;
        // Given how q~, S~ and alpha at the end answer at fixed t.
        const auto with_t = [&](double q, double S_end, double at_start) LODE_INLINE_LAMBDA {
            const double change =
                inverse_xi_ * t * (q + eta / 3.0 * S_end) - slope * (cone_.xi * inverse_a_ * rest * q + at_start);
            const double dt = -change * inverse_slope;
            const double dq = q + r.q_slope * dt, dS_end = S_end + r.S_slope * dt;
            const double dlambda = inverse_a_ * (rest * dq - e.q * dt), hardening = cone_.xi * dlambda;
            const double sum = t * dS_end + e.S * dt, dalpha_end = at_start + hardening;
            const double work =
                dlambda * t * (e.q + eta_bar / 3.0 * e.S) + lambda * (t * dq + e.q * dt + eta_bar / 3.0 * sum);
            return PlaneSlopes{sum,
                               rho_ * inverse_b2 * dt,
                               dalpha_end,
                               work,
                               heats ? work - rise * hardening - e.dalpha * slope * dalpha_end : 0.0,
                               eta_bar / 3.0 * dlambda - inverse_a_ / 6.0 * (rest * dS_end - e.S * dt)};
        };
        const double B = 4.0 * eta_bar * rest, q_S = e.S * r.inverse_root, q_T = 6.0 * inverse_b2 * r.inverse_root;
        return {with_t(q_S, 1.0 - B * q_S, 0.0), with_t(q_T, -B * q_T, 0.0), with_t(0.0, 0.0, 1.0)};
    }

  private:
    template <class Real>
    struct Trial {
        Real value, slope;  // of the yield condition over xi
        Real b, q, S, q_slope, S_slope, inverse_root, dalpha;
        FlowStress<Real> c;
    };

    template <class Real>
    LODE_INLINE Trial<Real> at(const Real& t, const Real& S, const Real& T, const Real& alpha,
                               const Real& scale) const {
        const double eta_third = cone_.eta / 3.0, four_eta_bar = 4.0 * cone_.eta_bar;
        const Real rest = 1.0 - t, b = t + rho_ * rest, B = four_eta_bar * rest, C = 12.0 - B * B;
        const Real inverse_b = 1.0 / b, T_over_b2 = T * (inverse_b * inverse_b), S2 = S * S;
        const Real twelve_W = 12.0 * T_over_b2;
        // Beyond the double root S^2 + C W = 0 there is no stress; the sign of what is returned there is right.
        const Real root = sqrt(max(12.0 * S2 + C * twelve_W, Real(1e-300)));
        const Real BS = B * S;
        const Mask<Real> tension = S > Real(0.0);
        const Real q = select(tension, S2 + twelve_W, root - BS) / select(tension, root + BS, C);
        const Real S_end = S - B * q, inverse_root = 1.0 / root;
        const Real q_slope =
            inverse_root * (four_eta_bar * (S_end * q) - (12.0 * (1.0 - rho_)) * (T_over_b2 * inverse_b));
        const Real S_slope = four_eta_bar * q - B * q_slope;
        const Real dalpha = (cone_.xi * inverse_a_) * (rest * q);
        const FlowStress<Real> c = ReturnToYield<Law>::at(law_, alpha + dalpha, scale);
        const Real driving = q + eta_third * S_end;
        const Real value = inverse_xi_ * (t * driving) - c.value;
        const Real slope =
            inverse_xi_ * (driving + t * (q_slope + eta_third * S_slope)) - c.slope * multiplied(t, q, q_slope);
        return {value, slope, b, q, S_end, q_slope, S_slope, inverse_root, dalpha, c};
    }

    // d(dalpha)/dt of dalpha = (xi/a) (1 - t) q~.
    template <class Real>
    LODE_INLINE Real multiplied(const Real& t, const Real& q, const Real& q_slope) const {
        return (cone_.xi * inverse_a_) * ((1.0 - t) * q_slope - q);
    }

    Law law_;
    Cone cone_;
    double a_, rho_, inverse_a_, inverse_xi_;
    double smallest_t_;  // C = 0
    double initial_cohesion_, unloading_;
};

}  // namespace lode::drucker_prager
