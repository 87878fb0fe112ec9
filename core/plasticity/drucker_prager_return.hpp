// The return of DRUCKER_PRAGER to its cone or its apex in the invariants q = sqrt(J2) and p (page 20, section 4;
// Nairn, eqs. 2.82-2.96), and its linearisation.
#pragma once

#include "lode/plasticity/drucker_prager_cone.hpp"
#include "lode/plasticity/hardening_law.hpp"

namespace lode::drucker_prager {

// End of a step. The deviator is s = (1 - loss) s_trial.
template <class Real>
struct ConeStep {
    Mask<Real> yields, at_apex;
    Real q_trial, inverse_q;  // 1/q_trial where it yields
    Real loss;                // G lambda/q_trial on the cone, 1 at the apex
    Real lambda;              // multiplier of the cone, 0 at the apex
    Real volume;              // plastic volume strain: eta_bar lambda; at the apex its own unknown
    Real dalpha;
    FlowStress<Real> cohesion;  // c and dc/dalpha
    Real q, p;

    // sigma : dep
    LODE_INLINE Real work() const { return lambda * q - p * volume; }
    // What becomes heat by the source rule (page 25): sigma:dep - (c - c0) dalpha, not below 0.
    LODE_INLINE Real heat(double initial_cohesion) const {
        return positive_part(work() - (cohesion.value - initial_cohesion) * dalpha);
    }
};

// How the end of a step answers to the trial state: s_end = (1 - loss) s_trial + shape s_trial/q_trial, and the rest by
// name; `heat` is that of the source rule.
struct ConeSlopes {
    double shape, p, work, heat;
};

template <class Law>
class ConeReturn {
  public:
    ConeReturn(const Law& law, const Cone& cone, double G, double K, double initial_cohesion)
        : law_(law),
          cone_(cone),
          G_(G),
          K_(K),
          inverse_K_(1.0 / K),
          inverse_xi_(1.0 / cone.xi),
          eta_over_xi_(cone.eta / cone.xi),
          xi_over_eta_(cone.eta > 0.0 ? cone.xi / cone.eta : 0.0),
          initial_cohesion_(initial_cohesion),
          unloading_((G + cone.eta * cone.eta_bar * K) / (cone.xi * cone.xi)),
          inverse_unloading_(1.0 / unloading_),
          axis_unloading_(cone.eta * cone.eta_bar * K / (cone.xi * cone.xi)),
          on_cone_(law, unloading_),
          on_axis_(law, axis_unloading_) {}

    // Elastic unloading in units of c over alpha: softening must be less steep.
    double unloading() const { return unloading_; }

    // `c` at the start.
    template <class Real>
    LODE_INLINE ConeStep<Real> operator()(const Real& q_trial, const Real& p_trial, const Real& alpha,
                                          const Real& scale, const FlowStress<Real>& c,
                                          const SolveCounter<Real>& solves = {}) const {
        const Real zero(0.0);
        // The yield condition over xi: driving <= c.
        const Real shear = inverse_xi_ * q_trial, pressure = eta_over_xi_ * p_trial, driving = shear - pressure;
        const Real excess = driving - c.value;
        ConeStep<Real> end;
        end.yields = excess > yield_tolerance * max(max(shear, abs(pressure)), c.value);
        end.at_apex = Mask<Real>(false);
        end.q_trial = q_trial;
        end.inverse_q = zero;
        end.loss = end.lambda = end.volume = end.dalpha = zero;
        end.cohesion = c;
        end.q = q_trial;
        end.p = p_trial;
        if (!any(end.yields)) return end;

        auto cone = on_cone_(driving, alpha, scale, c, end.yields, solves);
        finish(cone.dalpha, cone.flow, driving, unloading_);
        end.dalpha = select(end.yields, cone.dalpha, zero);
        end.cohesion.value = select(end.yields, cone.flow.value, c.value);
        end.cohesion.slope = select(end.yields, cone.flow.slope, c.slope);
        end.lambda = inverse_xi_ * end.dalpha;
        end.inverse_q = 1.0 / select(end.yields && q_trial > zero, q_trial, Real(1.0));
        const Real fall = G_ * end.lambda;
        end.loss = fall * end.inverse_q;
        if (cone_.eta == 0.0) end.loss = min(end.loss, Real(1.0));  // no apex: the cylinder may shrink to its axis
        else end.at_apex = end.yields && q_trial < fall;
        end.volume = cone_.eta_bar * end.lambda;
        if (any(end.at_apex)) [[unlikely]]
            return_to_apex(p_trial, alpha, scale, c, driving, end, solves);
        end.q = q_trial - end.loss * q_trial;
        end.p = p_trial + K_ * end.volume;
        if (any(end.at_apex)) end.p = select(end.at_apex, -xi_over_eta_ * end.cohesion.value, end.p);
        return end;
    }

    // For changes dq and dp of the trial invariants.
    LODE_INLINE ConeSlopes slopes(const ConeStep<double>& e, double dq, double dp) const {
        if (!e.yields) return {0.0, dp, 0.0, 0.0};
        const double slope = e.cohesion.slope;
        double dlambda = 0.0, dq_end = 0.0, dvolume, hardening, p;
        if (e.at_apex) {
            dvolume = -apex_share(slope) * inverse_K_ * dp;
            hardening = cone_.eta_bar > 0.0 ? cone_.xi / cone_.eta_bar * dvolume : 0.0;
            p = -xi_over_eta_ * slope * hardening;
        } else {
            hardening = on_cone_.plastic_share(slope) * inverse_unloading_ * (inverse_xi_ * dq - eta_over_xi_ * dp);
            dlambda = inverse_xi_ * hardening;
            dvolume = cone_.eta_bar * dlambda;
            dq_end = dq - G_ * dlambda;
            p = dp + K_ * dvolume;
        }
        const double work = dlambda * e.q + e.lambda * dq_end - dvolume * e.p - e.volume * p;
        const double stored = e.cohesion.value - initial_cohesion_ + e.dalpha * slope;
        const bool heats = e.heat(initial_cohesion_) > 0.0;
        // s_trial d(1 - loss) = (loss dq - G dlambda) s_trial/q_trial
        return {e.at_apex ? 0.0 : e.loss * dq - G_ * dlambda, p, work, heats ? work - stored * hardening : 0.0};
    }

  private:
    // What the iteration has left of driving = unloading dalpha + c, so that the answer does not depend on where it
    // stopped.
    template <class Real>
    LODE_INLINE static void finish(Real& dalpha, FlowStress<Real>& c, const Real& driving, double unloading) {
        if constexpr (!std::is_same_v<Law, LinearHardening> && !std::is_same_v<Law, LinearSoftening>) {
            const Real stiffness = unloading + c.slope, left = driving - unloading * dalpha - c.value;
            const Real more = left / select(stiffness > Real(0.0), stiffness, Real(unloading));
            dalpha = dalpha + more;
            c.value = c.value + c.slope * more;
        }
    }

    // Step 4: s = 0 and the plastic volume strain x brings p to -(xi/eta) c(alpha + r x), r = xi/eta_bar. Without
    // dilatancy nothing hardens there. `end` holds what the cone says.
    template <class Real>
    LODE_INLINE void return_to_apex(const Real& p_trial, const Real& alpha, const Real& scale,
                                    const FlowStress<Real>& c, const Real& driving, ConeStep<Real>& end,
                                    const SolveCounter<Real>& solves) const {
        const Mask<Real> apex = end.at_apex;
        const Real zero(0.0), tension = -eta_over_xi_ * p_trial;
        Real dalpha = zero, volume;
        FlowStress<Real> cohesion = c;
        if (cone_.eta_bar > 0.0) {
            if constexpr (Law::softens) {
                soften_at_apex(tension, alpha, scale, c, driving, end, apex, dalpha, cohesion, solves);
            } else {
                const auto axis = on_axis_(tension, alpha, scale, c, apex, solves);
                dalpha = axis.dalpha;
                cohesion = axis.flow;
            }
            finish(dalpha, cohesion, tension, axis_unloading_);
            volume = (cone_.eta_bar * inverse_xi_) * dalpha;
        } else {
            volume = (inverse_K_ * xi_over_eta_) * (tension - c.value);
        }
        end.volume = select(apex, volume, end.volume);
        end.dalpha = select(apex, dalpha, end.dalpha);
        end.lambda = select(apex, zero, end.lambda);
        end.loss = select(apex, Real(1.0), end.loss);
        end.cohesion.value = select(apex, cohesion.value, end.cohesion.value);
        end.cohesion.slope = select(apex, cohesion.slope, end.cohesion.slope);
    }

    // Softening may be steeper than unloading along the axis: the smallest root. The floor of c keeps it finite. Where
    // the trial state is not beyond the apex of the start, the cone's solution is the lower end.
    template <class Real>
    LODE_INLINE void soften_at_apex(const Real& tension, const Real& alpha, const Real& scale,
                                    const FlowStress<Real>& c, const Real& driving, const ConeStep<Real>& end,
                                    const Mask<Real>& apex, Real& dalpha, FlowStress<Real>& cohesion,
                                    const SolveCounter<Real>& solves) const {
        const auto residual = [tension, alpha, scale, law = law_, stiffness = axis_unloading_](const Real& x) {
            const FlowStress<Real> k = ReturnToYield<Law>::at(law, alpha + x, scale);
            return Residual<Real>{tension - stiffness * x - k.value, -stiffness - k.slope};
        };
        const Real excess = tension - c.value, zero(0.0);
        const Real lower = select(excess > zero, zero, end.dalpha);
        const Real upper = max(select(apex, tension, Real(1.0)) * (1.0 / axis_unloading_), lower);
        const Real stiffness = axis_unloading_ + c.slope;
        const Mask<Real> forward = stiffness > zero && excess > zero;
        const Real start = select(forward, excess / select(forward, stiffness, Real(1.0)), lower);
        const auto root = solve_bracketed<Slope::decreasing>(residual, lower, upper, start,
                                                             return_tolerance * max(abs(driving), abs(tension)), apex);
        solves.count(root);
        dalpha = root.x;
        cohesion = ReturnToYield<Law>::at(law_, alpha + root.x, scale);
    }

    // How much of a change of pressure plastic volume strain takes.
    LODE_INLINE double apex_share(double slope) const {
        if (cone_.eta_bar == 0.0) return 1.0;
        const double stiffness = axis_unloading_ + slope;
        return stiffness > 0.0 ? axis_unloading_ / stiffness : 1.0;
    }

    Law law_;
    Cone cone_;
    double G_, K_, inverse_K_, inverse_xi_, eta_over_xi_, xi_over_eta_, initial_cohesion_;
    double unloading_, inverse_unloading_, axis_unloading_;  // (G + eta eta_bar K)/xi^2, eta eta_bar K/xi^2
    ReturnToYield<Law> on_cone_, on_axis_;
};

}  // namespace lode::drucker_prager
