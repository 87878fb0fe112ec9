// Steinberg-Cochran-Guinan (HLAW 4) and Steinberg-Lund (HLAW 5) hardening (page 20, sections 2.2 and 2.3):
// K = [min(Y (1 + b alpha)^n, YMAX) + YT] gr and G = G0 gr, with gr = 1 + GP p_n + GT (theta - TREF) and a thermal part
// YT(rate, T) that law 4 lacks. The pressure is that of the start of the increment.
#pragma once

#include "lode/elastic/isotropic_moduli.hpp"
#include "lode/plasticity/hardening_law.hpp"
#include "lode/plasticity/surroundings.hpp"

namespace lode {

// k = min(Y (1 + b x)^n, cap).
struct CappedHardening {
    NonlinearHardening law;
    double cap, cap_at;

    template <class Real>
    LODE_INLINE FlowStress<Real> flow_stress(const Real& x) const {
        const FlowStress<Real> k = law.flow_stress(min(x, Real(cap_at)));
        const auto below = x < Real(cap_at);
        return {select(below, k.value, Real(cap)), select(below, k.slope, Real(0.0)),
                select(below, k.curvature, Real(0.0))};
    }
    template <class Real>
    LODE_INLINE Real stored_energy(const Real& x, const Real& dx) const {
        const Real from = min(x, Real(cap_at)), to = min(x + dx, Real(cap_at)), capped = dx - (to - from);
        const Real stored = law.stored_energy(from, to - from, law.flow_stress(from), law.flow_stress(to));
        return stored + select(capped > Real(0.0), (cap - law.yield) * capped, Real(0.0));
    }
};

template <bool with_thermal_part>
class Steinberg {
  public:
    static constexpr bool softens = false, feels_rate = with_thermal_part, feels_temperature = true;
    static constexpr bool changes_shear = true, melts = true, remembers = false;

    template <class Real>
    struct At {
        Real shear_ratio;     // gr; 1 where molten
        Real strength_ratio;  // gr; 0 where molten
        Mask<Real> melted;
        Real temperature = Real(1.0);  // T, absolute
        TimeIncrement time = {};
    };

    // `h` is the index of H1, then b, n, YMAX, GP, GT [, YP, UK, C1, C2].
    Steinberg(const Properties& p, int h, double yield, double reference_temperature, double absolute_zero_offset,
              const IsotropicModuli& elastic)
        : curve_{{yield, p[h], p[h + 1]}, HUGE_VAL, HUGE_VAL},
          pressure_factor_(p[h + 3]),
          thermal_factor_(p[h + 4]),
          reference_temperature_(reference_temperature),
          absolute_zero_offset_(absolute_zero_offset),
          elastic_(elastic) {
        if (p[h] < 0.0) p.refuse(h, ">= 0");
        if (p[h + 1] < 0.0) p.refuse(h + 1, ">= 0");
        const double cap = p[h + 2];
        if (cap != 0.0) {
            if (cap < yield) p.refuse(h + 2, "0 (no cap) or >= SIGY = " + format_number(yield));
            curve_.cap = cap;
            if (p[h] * p[h + 1] > 0.0) curve_.cap_at = curve_.law.falls_to(cap);
        }
        if constexpr (with_thermal_part) {
            highest_ = p[h + 5], barrier_ = p[h + 6], rate_factor_ = p[h + 7], drag_ = p[h + 8];
            for (int i = 5; i <= 8; ++i)
                if (p[h + i] <= 0.0) p.refuse(h + i, "> 0");
            lowest_ = 1e-5 * highest_;
        }
    }

    template <class Real>
    LODE_INLINE At<Real> at(const Surroundings<Real>& s) const {
        const Real gr =
            1.0 + pressure_factor_ * s.pressure + thermal_factor_ * (s.temperature - reference_temperature_);
        const Mask<Real> melted = gr <= Real(1e-6);
        At<Real> at{select(melted, Real(1.0), gr), select(melted, Real(0.0), gr), melted};
        if constexpr (with_thermal_part) {
            at.temperature = s.temperature + absolute_zero_offset_;
            at.time = s.time;
        }
        return at;
    }

    // K at rate 0.
    template <class Real>
    LODE_INLINE FlowStress<Real> start(const At<Real>& at, const Real& alpha) const {
        return flow_with(at, alpha, Real(lowest_), Real(0.0));
    }
    template <class Real>
    LODE_INLINE FlowStress<Real> flow(const At<Real>& at, const Real& alpha, const Real& x) const {
        if constexpr (!with_thermal_part) {
            return flow_with(at, alpha + x, Real(0.0), Real(0.0));
        } else {
            const Real part = thermal_part_at(at, x);
            return flow_with(at, alpha + x, part, thermal_slope(at, part));
        }
    }

    template <class Real>
    ReturnResult<Real> solve_on(Line line, const At<Real>& at, const Real& q_trial, const Real& alpha,
                                const FlowStress<Real>&, const Mask<Real>& yields,
                                const SolveCounter<Real>& solves) const {
        return solve_along(line == radial ? stiffness<radial>(at) : stiffness<axial>(at), at, q_trial, alpha, yields,
                           solves);
    }
    template <Line line>
    double plastic_share(const At<double>& at, double H) const {
        const double S = stiffness<line>(at);
        return S / (S + H);
    }

    template <class Real>
    LODE_INLINE PlasticWork<Real> work(const At<Real>& at, const Real& alpha, const Real& dalpha,
                                       const FlowStress<Real>&, const FlowStress<Real>& k_end) const {
        Real friction = curve_.law.yield * at.strength_ratio;
        if constexpr (with_thermal_part)
            friction = friction + thermal_part(at, alpha + dalpha, k_end.value) * at.strength_ratio;
        return {friction, at.strength_ratio * curve_.stored_energy(alpha, dalpha)};
    }

    // YT from K.
    template <class Real>
    LODE_INLINE Real thermal_part(const At<Real>& at, const Real& alpha, const Real& k) const {
        if constexpr (!with_thermal_part) {
            return Real(0.0);
        } else {
            const auto solid = at.strength_ratio > Real(0.0);
            const Real part = k / select(solid, at.strength_ratio, Real(1.0)) - curve_.flow_stress(alpha).value;
            return select(solid, max(min(part, Real(highest_)), Real(lowest_)), Real(0.0));
        }
    }

    HeatSlopes slopes(const At<double>& at, double alpha, double dalpha, const FlowStress<double>&,
                      const FlowStress<double>& k_end) const {
        HeatSlopes s;
        if (at.melted) return s;
        const double gr = at.strength_ratio, Y = curve_.law.yield;
        double part = 0.0, part_strain = 0.0, part_temperature = 0.0;  // YT, dYT/d(dalpha), dYT/dT
        if constexpr (with_thermal_part) {
            part = thermal_part(at, alpha + dalpha, k_end.value);
            part_strain = thermal_slope(at, part);
            if (part > lowest_ && part < highest_) {
                const RateOf<double> r = rate_of(at, part);
                part_temperature = -r.temperature_slope / r.slope;
            }
        }
        const double stored = curve_.stored_energy(alpha, dalpha), k = k_end.value / gr;  // over gr
        s.flow_temperature = k * thermal_factor_ + gr * part_temperature;
        s.source_strain = gr * (Y + part + dalpha * part_strain);
        s.source_temperature = dalpha * ((Y + part) * thermal_factor_ + gr * part_temperature);
        s.work_strain = s.source_strain + gr * (k - Y - part);
        s.work_temperature = s.source_temperature + stored * thermal_factor_;
        return s;
    }
    // d(gr)/d(theta).
    double shear_temperature_factor(const At<double>& at) const { return at.melted ? 0.0 : thermal_factor_; }

  private:
    template <Line line, class Real>
    LODE_INLINE Real stiffness(const At<Real>& at) const {
        const Real G = elastic_.shear * at.shear_ratio;
        if constexpr (line == radial) return 3.0 * G;
        else return 9.0 * elastic_.bulk * G / (3.0 * elastic_.bulk + G);
    }

    template <class Real>
    LODE_INLINE FlowStress<Real> flow_with(const At<Real>& at, const Real& alpha, const Real& part,
                                           const Real& part_slope) const {
        const FlowStress<Real> k = curve_.flow_stress(alpha);
        const Real& gr = at.strength_ratio;
        return {gr * (k.value + part), gr * (k.slope + part_slope), gr * k.curvature};
    }

    // With a constant thermal part the return is that of the curve.
    template <class Real>
    LODE_INLINE ReturnResult<Real> solve_with(const At<Real>& at, const Real& S, const Real& q_trial, const Real& alpha,
                                              const Real& part, const Mask<Real>& active,
                                              const SolveCounter<Real>& solves) const {
        const auto residual = [self = *this, at, S, q_trial, alpha, part](const Real& x) {
            const FlowStress<Real> k = self.flow_with(at, alpha + x, part, Real(0.0));
            return ReturnTrial<Real>{q_trial - S * x - k.value, -S - k.slope, -k.curvature, x, k};
        };
        const FlowStress<Real> k = flow_with(at, alpha, part, Real(0.0));
        const Real excess = positive_part(q_trial - k.value), compliance = 1.0 / (S + k.slope);
        Real start = excess * compliance;
        start = start - 0.5 * k.curvature * (start * start) * compliance;
        const auto root = solve_bracketed<Slope::decreasing>(residual, Real(0.0), excess / S, start,
                                                             return_tolerance * q_trial, active);
        solves.count(root);
        return {root.last.dalpha, root.last.flow};
    }

    // The unknown of law 5 is YT, of which dalpha = DTIME rate(YT) is explicit.
    template <class Real>
    ReturnResult<Real> solve_along(const Real& S, const At<Real>& at, const Real& q_trial, const Real& alpha,
                                   const Mask<Real>& yields, const SolveCounter<Real>& solves) const {
        if constexpr (!with_thermal_part) {
            return solve_with(at, S, q_trial, alpha, Real(0.0), yields, solves);
        } else {
            const double dt = at.time.value;
            const auto residual = [self = *this, at, S, q_trial, alpha, dt](const Real& part) {
                const RateOf<Real> r = self.rate_of(at, part);
                const Real x = dt * r.value, x1 = dt * r.slope;
                const FlowStress<Real> k = self.flow_with(at, alpha + x, part, self.bounded_inverse(x1));
                return PartTrial<Real>{
                    q_trial - S * x - k.value,
                    -S * x1 - at.strength_ratio + x1 * (at.strength_ratio * self.bounded_inverse(x1) - k.slope),
                    {x, k}};
            };
            const Real low(lowest_), high(highest_);
            Mask<Real> at_low = yields, at_high = Mask<Real>(false);
            if (dt > 0.0) {
                at_low = yields && residual(low).value <= Real(0.0);
                at_high = yields && !at_low && residual(high).value >= Real(0.0);
            }
            const Mask<Real> between = yields && !at_low && !at_high;
            ReturnResult<Real> result{Real(0.0), start(at, alpha)};
            if (any(between)) {
                const Real safe = select(between, at.strength_ratio, Real(1.0));
                const Real start = max(min(q_trial / safe - curve_.flow_stress(alpha).value, high), low);
                const auto root =
                    solve_bracketed<Slope::decreasing>(residual, low, high, start, return_tolerance * q_trial, between);
                solves.count(root);
                result = root.last.result;
            }
            if (any(at_low)) result = either(at_low, solve_with(at, S, q_trial, alpha, low, at_low, solves), result);
            if (any(at_high))
                result = either(at_high, solve_with(at, S, q_trial, alpha, high, at_high, solves), result);
            return result;
        }
    }
    template <class Real>
    struct PartTrial {
        Real value, slope;
        ReturnResult<Real> result;
    };
    template <class Real>
    LODE_INLINE static Real bounded_inverse(const Real& x) {
        return 1.0 / max(x, Real(1e-300));
    }

    // The plastic strain rate that YT drives, 1/(exp(w a^2)/C1 + C2/YT), a = 1 - YT/YP, w = 2 UK/T, with its
    // derivatives by YT and T.
    template <class Real>
    struct RateOf {
        Real value, slope, temperature_slope;
    };
    template <class Real>
    LODE_INLINE RateOf<Real> rate_of(const At<Real>& at, const Real& part) const {
        const Real a = 1.0 - part * (1.0 / highest_), w = 2.0 * barrier_ / at.temperature;
        const Real wait = quick_exp(min(w * (a * a), Real(600.0))) * (1.0 / rate_factor_);
        const Real drag = drag_ / part, rate = 1.0 / (wait + drag), square = rate * rate;
        return {rate, square * (2.0 * (1.0 / highest_) * w * a * wait + drag / part),
                square * wait * (a * a) * w / at.temperature};
    }
    // dYT/d(dalpha) at constant DTIME.
    template <class Real>
    LODE_INLINE Real thermal_slope(const At<Real>& at, const Real& part) const {
        const auto inside = part > Real(lowest_) && part < Real(highest_);
        return select(inside, at.time.inverse * bounded_inverse(rate_of(at, part).slope), Real(0.0));
    }
    // YT after dalpha = x: the rate inverted, for its logarithm.
    template <class Real>
    LODE_INLINE Real thermal_part_at(const At<Real>& at, const Real& x) const {
        const Real low(lowest_), high(highest_);
        const Real rate = at.time.inverse * x;
        const auto slow = rate <= rate_of(at, low).value, fast = rate >= rate_of(at, high).value;
        const auto between = !slow && !fast;
        Real part = select(fast, high, low);
        if (any(between)) {
            const Real wanted = log(select(between, rate, Real(1.0)));
            const auto residual = [self = *this, at, wanted](const Real& y) {
                const RateOf<Real> r = self.rate_of(at, y);
                return Residual<Real>{log(max(r.value, Real(1e-300))) - wanted, r.slope / max(r.value, Real(1e-300))};
            };
            const auto root =
                solve_bracketed<Slope::increasing>(residual, low, high, Real(0.5 * highest_), Real(1e-15), between);
            part = select(between, root.x, part);
        }
        return part;
    }

    CappedHardening curve_;
    double pressure_factor_, thermal_factor_, reference_temperature_, absolute_zero_offset_;
    IsotropicModuli elastic_;
    double highest_ = 0.0, lowest_ = 0.0, barrier_ = 0.0, rate_factor_ = 1.0, drag_ = 0.0;  // YP, UK, C1, C2
};

}  // namespace lode
