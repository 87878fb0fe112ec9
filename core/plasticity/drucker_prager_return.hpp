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
    Real compliance;            // d(dalpha) by the driving force, on the cone or at the apex
    Real q, p;

    // sigma : dep
    LODE_INLINE Real work() const { return lambda * q - p * volume; }
    // What becomes heat by the source rule (page 25): sigma:dep - (c - c0) dalpha, not below 0.
    LODE_INLINE Real heat(double initial_cohesion) const {
        return positive_part(work() - (cohesion.value - initial_cohesion) * dalpha);
    }
};

// How the end of a step answers to a change of the trial state: s_end = (1 - loss) s_trial + shape s_trial/q_trial, and
// the rest by name; `heat` is that of the source rule, `alpha` that of the end.
struct ConeSlopes {
    double shape, p, alpha, work, heat;
};
// By the strain: q_trial answers by G s_trial/q_trial, p_trial by -K 1. So the change by s_trial, and that by less
// volume. And by alpha at the start.
struct ConeLinearisation {
    ConeSlopes by_q, by_p, by_alpha;
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
          xi_over_G_(cone.xi / G),
          initial_cohesion_(initial_cohesion),
          unloading_((G + cone.eta * cone.eta_bar * K) / (cone.xi * cone.xi)),
          axis_unloading_(cone.eta * cone.eta_bar * K / (cone.xi * cone.xi)),
          on_cone_(law, unloading_),
          on_axis_(law, axis_unloading_ > 0.0 ? axis_unloading_ : unloading_) {}

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
        end.compliance = zero;
        end.q = q_trial;
        end.p = p_trial;
        if (!any(end.yields)) return end;

        // On the cone dalpha = xi q_trial/G uses the deviator up: what the excess still asks for then lies beyond the
        // apex.
        if (cone_.eta > 0.0) {
            const Real apex = xi_over_G_ * q_trial;
            end.at_apex = end.yields && exceeds(excess - unloading_ * apex, alpha, scale, c, apex, end.yields);
        }
        const Real tension = -pressure;
        const Mask<Real> flows = cone_.eta_bar > 0.0 ? end.yields : Mask<Real>(end.yields && !end.at_apex);
        const ReturnResult<Real> flow =
            solve(driving, tension, alpha, scale, c, end.at_apex, flows, end.compliance, solves);
        end.dalpha = select(flows, flow.dalpha, zero);
        end.cohesion.value = select(flows, flow.flow.value, c.value);
        end.cohesion.slope = select(flows, flow.flow.slope, c.slope);
        end.cohesion.curvature = select(flows, flow.flow.curvature, c.curvature);
        end.lambda = inverse_xi_ * select(end.at_apex, zero, end.dalpha);
        end.inverse_q = 1.0 / select(end.yields && q_trial > zero, q_trial, Real(1.0));
        end.loss = select(end.at_apex, Real(1.0), min(G_ * end.lambda * end.inverse_q, Real(1.0)));
        end.volume = (cone_.eta_bar * inverse_xi_) * end.dalpha;
        if (cone_.eta_bar == 0.0)
            end.volume = select(end.at_apex, (inverse_K_ * xi_over_eta_) * (tension - c.value), end.volume);
        end.q = q_trial - end.loss * q_trial;
        end.p = select(end.at_apex, -xi_over_eta_ * end.cohesion.value, p_trial + K_ * end.volume);
        return end;
    }

    // Of a step that yields.
    LODE_INLINE ConeLinearisation linearise(const ConeStep<double>& e) const {
        const double slope = e.cohesion.slope, compliance = e.compliance;
        // At the apex without dilatancy nothing hardens, and plastic volume strain takes all.
        const bool is_free = e.at_apex && cone_.eta_bar == 0.0;
        const double dq = e.at_apex ? 0.0 : G_ * e.inverse_q;
        const double dalpha_q = compliance * inverse_xi_ * dq;
        const double dalpha_p = is_free ? 0.0 : -compliance * eta_over_xi_ * K_;
        const double dalpha_a = is_free ? 0.0 : -compliance * slope, dcohesion_a = slope + slope * dalpha_a;
        const double dvolume_p = is_free ? -1.0 : cone_.eta_bar * inverse_xi_ * dalpha_p;
        const double dlambda_q = inverse_xi_ * dalpha_q, dlambda_p = e.at_apex ? 0.0 : inverse_xi_ * dalpha_p;
        const double dlambda_a = e.at_apex ? 0.0 : inverse_xi_ * dalpha_a;
        const double dvolume_q = cone_.eta_bar * dlambda_q;
        const double p_q = K_ * dvolume_q;
        const double p_p = e.at_apex ? -xi_over_eta_ * slope * dalpha_p : K_ + K_ * dvolume_p;
        const double p_a = e.at_apex ? -xi_over_eta_ * dcohesion_a : K_ * (cone_.eta_bar * dlambda_a);
        const double q_q = dq - G_ * dlambda_q, q_p = -G_ * dlambda_p, q_a = -G_ * dlambda_a;
        const double work_q = dlambda_q * e.q + e.lambda * q_q - dvolume_q * e.p - e.volume * p_q;
        const double work_p = dlambda_p * e.q + e.lambda * q_p - dvolume_p * e.p - e.volume * p_p;
        const double work_a = dlambda_a * e.q + e.lambda * q_a - inverse_K_ * p_a * e.p - e.volume * p_a;
        const double rise = e.cohesion.value - initial_cohesion_, stored = rise + e.dalpha * slope;
        const bool heats = e.heat(initial_cohesion_) > 0.0;
        // s_trial d(1 - loss) = (loss dq - G dlambda) s_trial/q_trial
        return {{e.loss * dq - G_ * dlambda_q, p_q, dalpha_q, work_q, heats ? work_q - stored * dalpha_q : 0.0},
                {q_p, p_p, dalpha_p, work_p, heats ? work_p - stored * dalpha_p : 0.0},
                {q_a, p_a, 1.0 + dalpha_a, work_a, heats ? work_a - rise * dalpha_a - e.dalpha * dcohesion_a : 0.0}};
    }

  private:
    static constexpr bool is_straight = std::is_same_v<Law, LinearHardening>;
    using Line = ReturnToYield<Law>;
    static constexpr bool may_meet_twice = Law::softens && !std::is_same_v<Law, LinearSoftening>;

    // c(alpha + x) - c < left, in the lanes that yield.
    template <class Real>
    LODE_INLINE Mask<Real> exceeds(const Real& left, const Real& alpha, const Real& scale, const FlowStress<Real>& c,
                                   const Real& x, const Mask<Real>& yields) const {
        if constexpr (is_straight) {
            return left > c.slope * x;
        } else if constexpr (Law::softens) {
            return left > ReturnToYield<Law>::at(law_, alpha + x, scale).value - c.value;
        } else {
            // Mostly two terms of the law at the start tell: it rises, and a concave one lies between its tangent and
            // its parabola there.
            const Real rise = c.slope * x, parabola = rise + 0.5 * c.curvature * (x * x);
            const Mask<Real> positive = left > Real(0.0), above = left > rise, concave = c.curvature <= Real(0.0);
            const Mask<Real> undecided = yields && positive && !(concave && (above || left <= parabola));
            const Mask<Real> beyond = positive && above;
            if (!any(undecided)) [[likely]]
                return beyond;
            const Mask<Real> beyond_curve = left > rise_of(alpha, x, c.value);
            return (!undecided && beyond) || (undecided && beyond_curve);
        }
    }
    template <class Real>
    [[gnu::noinline]] Real rise_of(Real alpha, Real x, Real c) const {
        return law_.flow_stress(alpha + x).value - c;
    }

    // dalpha and c at the end: on the cone from driving - (G + eta eta_bar K)/xi^2 dalpha = c; at the apex (step 4),
    // where s = 0, from tension - eta eta_bar K/xi^2 dalpha = c, which is p_trial + K x = -(xi/eta) c of the plastic
    // volume strain x = (eta_bar/xi) dalpha. Without dilatancy nothing hardens there.
    template <class Real>
    LODE_INLINE ReturnResult<Real> solve(const Real& driving, const Real& tension, const Real& alpha, const Real& scale,
                                         const FlowStress<Real>& c, const Mask<Real>& at_apex, const Mask<Real>& flows,
                                         Real& compliance, const SolveCounter<Real>& solves) const {
        if constexpr (may_meet_twice) {
            auto result = on_cone_(driving, alpha, scale, c, Mask<Real>(flows && !at_apex), solves);
            on_cone_.finish(driving, result);
            const Mask<Real> apex = flows && at_apex;
            if (any(apex)) [[unlikely]] {
                auto axis = soften_at_apex(driving, tension, alpha, scale, c, apex, solves);
                on_axis_.finish(tension, axis);
                result = either(apex, axis, result);
            }
            compliance = 1.0 / (select(apex, Real(axis_unloading_), Real(unloading_)) + result.flow.slope);
            return result;
        } else {
            const auto line = Line::template one_of<Real>(at_apex, on_axis_, on_cone_, c, scale);
            const Real target = select(at_apex, tension, driving);
            auto result = line(target, alpha, scale, c, flows, solves);
            if constexpr (Line::template stops_early<Real>) line.finish(target, result);
            compliance = line.compliance(result.flow.slope);
            return result;
        }
    }

    // Softening may be steeper than unloading along the axis: the smallest root. The floor of c keeps it finite. Where
    // the trial state is not beyond the apex of the start, the lower end is where the cone's deviator is used up: c is
    // too small there.
    template <class Real>
    LODE_INLINE ReturnResult<Real> soften_at_apex(const Real& driving, const Real& tension, const Real& alpha,
                                                  const Real& scale, const FlowStress<Real>& c, const Mask<Real>& apex,
                                                  const SolveCounter<Real>& solves) const {
        const auto residual = [tension, alpha, scale, law = law_, stiffness = axis_unloading_](const Real& x) {
            const FlowStress<Real> k = ReturnToYield<Law>::at(law, alpha + x, scale);
            return Residual<Real>{tension - stiffness * x - k.value, -stiffness - k.slope};
        };
        const Real excess = tension - c.value, zero(0.0);
        const Real lower = select(excess > zero, zero, xi_over_G_ * (cone_.xi * (driving - tension)));
        const Real upper = max(select(apex, tension, Real(1.0)) * (1.0 / axis_unloading_), lower);
        const Real stiffness = axis_unloading_ + c.slope;
        const Mask<Real> forward = stiffness > zero && excess > zero;
        const Real start = select(forward, excess / select(forward, stiffness, Real(1.0)), lower);
        const auto root = solve_bracketed<Slope::decreasing>(residual, lower, upper, start,
                                                             return_tolerance * max(abs(driving), abs(tension)), apex);
        solves.count(root);
        return {root.x, ReturnToYield<Law>::at(law_, alpha + root.x, scale)};
    }

    Law law_;
    Cone cone_;
    double G_, K_, inverse_K_, inverse_xi_, eta_over_xi_, xi_over_eta_, xi_over_G_, initial_cohesion_;
    double unloading_, axis_unloading_;  // (G + eta eta_bar K)/xi^2, eta eta_bar K/xi^2
    Line on_cone_, on_axis_;
};

}  // namespace lode::drucker_prager
