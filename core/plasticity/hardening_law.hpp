// The hardening law that PROPS ask for, and the return to the yield surface that it governs (page 20, sections 2 and
// 2.6). Shared by all plasticity models.
#pragma once

#include <cmath>
#include <variant>

#include "lode/material/properties.hpp"
#include "lode/numerics/root.hpp"
#include "lode/plasticity/hardening_curves.hpp"

namespace lode {

class HardeningLaw {
  public:
    // `law` and `first_constant` are the 1-based PROPS indices of HLAW and H1. Throws BadProperty.
    HardeningLaw(const Properties& p, double initial_yield, int law, int first_constant) : yield_(initial_yield) {
        const double Y = initial_yield;
        const auto h = [&](int i) { return p[first_constant + i - 1]; };
        const auto refuse = [&](int i, const std::string& allowed) { p.refuse(first_constant + i - 1, allowed); };
        const auto need_constants = [&](int number) { require_constants(p, law, first_constant, number); };
        const auto floor = [&](int i) {
            if (h(i) < 0.0 || h(i) > Y) refuse(i, "the floor of the yield stress, in [0, " + format_number(Y) + "]");
            return h(i);
        };
        const auto set = [&](const auto& curve, bool softens, int floor_index) {
            if (!softens) curve_ = curve;
            else
                curve_ = Floored<std::decay_t<decltype(curve)>>{curve, floor(floor_index),
                                                                curve.falls_to(floor(floor_index))};
        };
        switch (p.code(law)) {
            case 0:
                curve_ = LinearHardening{Y, 0.0};
                break;
            case 1:
                need_constants(1);
                if (h(1) < 0.0) curve_ = LinearSoftening{Y, h(1), floor(2), (floor(2) - Y) / h(1)};
                else curve_ = LinearHardening{Y, h(1)};
                break;
            case 2:
                need_constants(2);
                if (h(1) < 0.0 && h(2) < 1.0) refuse(2, ">= 1 where H1 < 0: the slope would be infinite");
                set(NonlinearHardening{Y, h(1), h(2)}, h(1) * h(2) < 0.0, 3);
                break;
            case 6:
                need_constants(2);
                if (h(2) <= 0.0) refuse(2, "> 0");
                if (h(1) < 0.0 && h(2) < 1.0) refuse(2, ">= 1 where H1 < 0: the slope would be infinite");
                set(PowerHardening{Y, Y * h(1), h(2)}, h(1) < 0.0, 3);
                break;
            case 8:
                need_constants(2);
                if (h(2) <= 0.0) refuse(2, "> 0");
                if (h(1) < 0.0 && h(3) > 0.0) refuse(3, "<= 0 where the saturation range is negative");
                set(SaturationHardening(Y, h(1), h(2), h(3), h(4) > 0.0 ? h(4) : HUGE_VAL), h(1) < 0.0 || h(3) < 0.0,
                    5);
                break;
            default:
                p.refuse(law, "one of the laws 0, 1, 2, 6, 8");
        }
    }

    // Refuses a law of which less than `number` constants are given.
    static void require_constants(const Properties& p, int law, int first_constant, int number) {
        const int needed = first_constant + number - 1;
        if (p.count() < needed)
            p.refuse("HLAW = " + std::to_string(p.code(law)) + " needs NPROPS >= " + std::to_string(needed) +
                     ", NPROPS = " + std::to_string(p.count()));
    }

    bool is_softening() const {
        return std::visit([](const auto& curve) { return curve.softens; }, curve_);
    }
    double initial_yield() const { return yield_; }

    // f(curve).
    template <class Result, class F>
    Result visit(const F& f) const {
        return std::visit([&](const auto& curve) -> Result { return f(curve); }, curve_);
    }

  private:
    double yield_;
    std::variant<LinearHardening, LinearSoftening, NonlinearHardening, Floored<NonlinearHardening>, PowerHardening,
                 Floored<PowerHardening>, SaturationHardening, Floored<SaturationHardening>>
        curve_;
};

// Residual of the scalar solution, relative to the trial stress (section 1).
inline constexpr double return_tolerance = 1e-13;
// Of the yield test, relative. Wider, so that a point just returned to the surface answers a zero increment
// elastically.
inline constexpr double yield_tolerance = 1e-11;

// What the return to the yield surface finds, and what its residual is made of.
template <class Real>
struct ReturnResult {
    Real dalpha;
    FlowStress<Real> flow;  // at the end
};
template <class Real>
struct ReturnTrial {
    Real value, slope, curvature;  // of the residual
    Real dalpha;
    FlowStress<Real> flow;
};
// Lane by lane the one or the other.
template <class Real>
LODE_INLINE ReturnResult<Real> either(const Mask<Real>& first, const ReturnResult<Real>& a,
                                      const ReturnResult<Real>& b) {
    return {select(first, a.dalpha, b.dalpha),
            {select(first, a.flow.value, b.flow.value), select(first, a.flow.slope, b.flow.slope),
             select(first, a.flow.curvature, b.flow.curvature)}};
}

// Solves residual(x) = 0, decreasing in x > 0, for ln x: regular where the slope at x = 0 is infinite, and nearly
// straight where the logarithm of x rules. The start should lie right of the root.
template <class Real, class F>
LODE_INLINE auto solve_in_logarithm(const F& residual, const Real& lower, const Real& upper, const Real& start,
                                    const Real& tolerance, const Mask<Real>& active) {
    const auto in_logarithm = [residual](const Real& y) {
        const Real x = quick_exp(y);
        auto r = residual(x);
        r.curvature = x * (x * r.curvature + r.slope);
        r.slope = x * r.slope;
        return r;
    };
    const auto ln = [&](const Real& x) { return quick_log(select(active, x, Real(1.0))); };
    return solve_bracketed<Slope::decreasing>(in_logarithm, ln(lower), ln(upper), ln(start), tolerance, active);
}

// The scalar return of section 2.6 along a line on which q falls with `stiffness` (3G in 3D, E in 1D):
// dalpha from q_trial - stiffness dalpha = k(scale (alpha + dalpha)); `scale` is 1 unless the law softens. A stiffness
// that differs from point to point (finite strain) makes `Number` that of the point. `Kept` is Law, or const Law& of a
// line that was chosen from two for one call: there a law that saturates may do a good part of it in an increment.
template <class Law, class Number = double, class Kept = Law>
class ReturnToYield {
    static constexpr bool is_straight = std::is_same_v<Law, LinearHardening>;
    static constexpr bool saturates = std::is_same_v<Law, SaturationHardening>;
    static constexpr bool falls_straight = std::is_same_v<Law, LinearSoftening>;
    static constexpr bool is_one_of_two = !std::is_same_v<Law, Kept>;

  public:
    template <class Real>
    using Result = ReturnResult<Real>;

    LODE_INLINE ReturnToYield(const Law& law, const Number& stiffness)
        : law_(law), stiffness_(stiffness), inverse_stiffness_(1.0 / stiffness) {
        if constexpr (is_straight) compliance_ = 1.0 / (stiffness + law.modulus);
        else if constexpr (saturates) compliance_ = 1.0 / (stiffness + law.modulus);
    }
    // Lane by lane the line `a` or `b` of one law, for one call; `flow` is that of the start.
    template <class Real>
    using OneOf = ReturnToYield<Law, Real, const Law&>;
    template <class Real>
    LODE_INLINE static OneOf<Real> one_of(const Mask<Real>& first, const ReturnToYield& a, const ReturnToYield& b,
                                          const FlowStress<Real>& flow, const Real& scale) {
        const auto pick = [&first](double x, double y) LODE_INLINE_LAMBDA { return select(first, Real(x), Real(y)); };
        OneOf<Real> line(a.law_, pick(a.stiffness_, b.stiffness_), pick(a.inverse_stiffness_, b.inverse_stiffness_));
        if constexpr (is_straight) {
            line.compliance_ = pick(a.compliance_, b.compliance_);
        } else if constexpr (falls_straight) {
            line.compliance_ = 1.0 / (line.stiffness_ + scale * a.law_.modulus);
        } else if constexpr (saturates) {
            // Both with one division, which need not wait for the choice.
            const Real of_a = a.stiffness_ + flow.slope, of_b = b.stiffness_ + flow.slope;
            const Real inverse = 1.0 / (of_a * of_b);
            line.compliance_ = select(first, inverse * of_b, inverse * of_a);
        }
        return line;
    }

    // The lanes of `yields`; `flow` is that of the start. The other lanes hold numbers without meaning.
    template <class Real>
    LODE_INLINE Result<Real> operator()(const Real& q_trial, const Real& alpha, const Real& scale,
                                        const FlowStress<Real>& flow, const Mask<Real>& yields,
                                        const SolveCounter<Real>& solves = {}) const {
        const Real excess = q_trial - flow.value;
        if constexpr (is_differentiated<Real> && !is_straight && !falls_straight) {
            return with_derivatives(q_trial, alpha, scale, flow, yields, solves);
        } else if constexpr (is_straight) {
            const Real dalpha = compliance_ * excess;
            return {dalpha, {flow.value + law_.modulus * dalpha, flow.slope, flow.curvature}};
        } else if constexpr (falls_straight) {
            Real sloped;
            if constexpr (is_one_of_two) sloped = compliance_ * excess;
            else sloped = excess / (stiffness_ + scale * law_.modulus);
            const Real flat = inverse_stiffness_ * (q_trial - law_.floor);
            auto on_slope = scale * alpha < Real(law_.floor_at) && scale * (alpha + sloped) < Real(law_.floor_at);
            // Along one of two lines softening may be steeper than unloading: both meet on the floor alone.
            if constexpr (is_one_of_two) on_slope = on_slope && compliance_ > Real(0.0);
            const Real dalpha = select(on_slope, sloped, flat);
            return {dalpha, at(law_, alpha + dalpha, scale)};
        } else if constexpr (saturates && is_one_of_two) {
            return by_long_decay(q_trial, alpha, flow, excess, yields, solves);
        } else if constexpr (saturates) {
            return by_decay(q_trial, alpha, flow, excess, yields, solves);
        } else if constexpr (std::is_same_v<Law, PowerHardening>) {
            return near_infinite_slope(q_trial, alpha, flow, excess, yields, solves);
        } else {
            return in_bracket(q_trial, alpha, scale, flow, excess, yields, solves);
        }
    }

    // stiffness/(stiffness + H), H = dk/dalpha: how much of a change of q_trial the elastic strain does not take.
    LODE_INLINE double plastic_share(double H) const {
        if constexpr (is_straight) return stiffness_ * compliance_;
        else return stiffness_ / (stiffness_ + H);
    }

    // d(dalpha)/d(q_trial) = 1/(stiffness + H), H the slope at the end.
    template <class Real>
    LODE_INLINE Real compliance(const Real& H) const {
        if constexpr (is_straight) return Real(compliance_);
        else if constexpr (falls_straight && is_one_of_two)
            return select(H < Real(0.0), Real(compliance_), Real(inverse_stiffness_));
        else return 1.0 / (stiffness_ + H);
    }

    // Whether the return ends where its iteration stopped. What that has left, `finish` takes away, so that the answer
    // does not depend on it.
    template <class Real>
    static constexpr bool stops_early = !is_straight && !falls_straight && (!saturates || is_differentiated<Real>);
    template <class Real>
    LODE_INLINE void finish(const Real& q_trial, Result<Real>& r) const {
        const Real stiffness = stiffness_ + r.flow.slope, left = q_trial - stiffness_ * r.dalpha - r.flow.value;
        const Real more = left / select(stiffness > Real(0.0), stiffness, Real(stiffness_));
        r.dalpha = r.dalpha + more;
        r.flow.value = r.flow.value + r.flow.slope * more;
    }

    // k and dk/dalpha.
    template <class Real>
    LODE_INLINE static FlowStress<Real> at(const Law& law, const Real& alpha, const Real& scale) {
        if constexpr (!Law::softens) {
            return law.flow_stress(alpha);
        } else {
            const FlowStress<Real> k = law.flow_stress(scale * alpha);
            return {k.value, scale * k.slope, scale * scale * k.curvature};
        }
    }

  private:
    template <class, class, class>
    friend class ReturnToYield;

    LODE_INLINE ReturnToYield(const Law& law, const Number& stiffness, const Number& inverse)
        : law_(law), stiffness_(stiffness), inverse_stiffness_(inverse) {}

    // Numbers that carry derivatives: solved for the value, then by the implicit function theorem.
    template <class Real>
    LODE_INLINE Result<Real> with_derivatives(const Real& q_trial, const Real& alpha, const Real& scale,
                                              const FlowStress<Real>& flow, bool yields,
                                              const SolveCounter<Real>& solves) const {
        ReturnToYield<Law, double, Kept> line(law_, value_of(stiffness_), value_of(inverse_stiffness_));
        line.compliance_ = value_of(compliance_);
        const FlowStress<double> start{value_of(flow.value), value_of(flow.slope), value_of(flow.curvature)};
        const Result<double> end =
            line(value_of(q_trial), value_of(alpha), value_of(scale), start, yields, SolveCounter<double>(solves));
        const FlowStress<Real> k = at(law_, alpha + end.dalpha, scale);
        const Real left = q_trial - stiffness_ * end.dalpha - k.value;
        const Real change = (1.0 / (value_of(stiffness_) + value_of(k.slope))) * (left - value_of(left));
        return {end.dalpha + change, {k.value + k.slope * change, k.slope + k.curvature * change, k.curvature}};
    }

    // Everything by value: a reference would keep the point in memory.
    template <class Real>
    LODE_INLINE auto residual(const Real& q_trial, const Real& alpha, const Real& scale) const {
        return [q_trial, alpha, scale, law = law_, stiffness = stiffness_](const Real& x) {
            const FlowStress<Real> k = at(law, alpha + x, scale);
            return ReturnTrial<Real>{q_trial - stiffness * x - k.value, -stiffness - k.slope, -k.curvature, x, k};
        };
    }

    template <class Real>
    LODE_INLINE Result<Real> in_bracket(const Real& q_trial, const Real& alpha, const Real& scale,
                                        const FlowStress<Real>& flow, const Real& excess, const Mask<Real>& active,
                                        const SolveCounter<Real>& solves) const {
        const Real upper = inverse_stiffness_ * max(Law::softens ? q_trial : excess, Real(0.0));
        const Real compliance = 1.0 / (stiffness_ + flow.slope);
        Real start = excess * compliance;
        start = start - 0.5 * flow.curvature * (start * start) * compliance;
        const auto root = solve_bracketed<Slope::decreasing>(residual(q_trial, alpha, scale), Real(0.0), upper, start,
                                                             return_tolerance * q_trial, active);
        solves.count(root);
        return {root.x, root.last.flow};
    }

    // k = k_n + u (1 - exp(-z)) + H x with z = b x and u = Q exp(-b alpha): no other exponential is needed than that of
    // the start. With c = stiffness + H, w = u b/c, m = w/(1 + w) and phi(z) = z - 1 + exp(-z) the return is
    // F(z) = z - m phi(z) - L = 0. Its inverse series in L gives a start z0 of fourth order and, by its derivative, the
    // 1/F' of Newton's step d from there. What that leaves is of the order 7 in L: rounding, for m < 1/4 and L < 1/24.
    template <class Real>
    LODE_INLINE Result<Real> by_decay(const Real& q_trial, const Real& alpha, const FlowStress<Real>& flow,
                                      const Real& excess, const Mask<Real>& yields,
                                      const SolveCounter<Real>& solves) const {
        const Real bend = flow.slope - law_.modulus;
        const Real share = 1.0 / (1.0 + compliance_ * bend);
        const Real m = compliance_ * bend * share;
        const Real L = (law_.rate * compliance_) * share * excess;
        // DecaySeries, written out: GCC keeps more of it in registers.
        const Real L2 = L * L;
        const Real a3 = m * (0.5 * m - 1.0 / 6.0), a4 = m * (1.0 / 24.0 - m * (5.0 / 12.0 - 0.625 * m));
        const Real z0 = L + L2 * (0.5 * m + L * (a3 + a4 * L));
        const Real inverse_slope = (1.0 + m * L) + L2 * (3.0 * a3 + (4.0 * a4) * L);
        const Real phi = hardening_detail::DecayRemainder::short_series(z0);
        const Real d = inverse_slope * (m * phi - (z0 - L)), x = law_.inverse_rate * (z0 + d);
        const Real bend_end = bend * (((1.0 - z0) + phi) * (1.0 - d));
        const FlowStress<Real> k{q_trial - stiffness_ * x, bend_end + law_.modulus, -law_.rate * bend_end};
        const auto solved = L < Real(1.0 / 24) && m < Real(0.25) && alpha + x < Real(law_.straight_from);
        if (all(solved || !yields)) [[likely]] {
            solves.count(1);
            return {x, k};
        }
        const Result<Real> other = by_exponentials(*this, q_trial, alpha, flow, Mask<Real>(yields && !solved), solves);
        return either(solved, Result<Real>{x, k}, other);
    }
    // z(L) of F(z) = 0 as a power series, to the fourth order.
    template <class Real>
    struct DecaySeries {
        Real a3, a4, L2;
        LODE_INLINE DecaySeries(const Real& m, const Real& L)
            : a3(m * (0.5 * m - 1.0 / 6.0)), a4(m * (1.0 / 24.0 - m * (5.0 / 12.0 - 0.625 * m))), L2(L * L) {}
        LODE_INLINE Real sum(const Real& m, const Real& L) const { return L + L2 * (0.5 * m + L * (a3 + a4 * L)); }
        // dz/dL
        LODE_INLINE Real slope(const Real& m, const Real& L) const {
            return (1.0 + m * L) + L2 * (3.0 * a3 + (4.0 * a4) * L);
        }
    };

    // Steps up to L = 0.45, for m < 0.4. From z0 the rest d of the root solves the same equation, with r = m E/F'(z0)
    // for m and n = -F/F'(z0) for L, E = exp(-z0). |n| < 7e-5: d = n + r n^2/2 leaves 3e-15 of z.
    template <class Real>
    LODE_INLINE Result<Real> by_long_decay(const Real& q_trial, const Real& alpha, const FlowStress<Real>& flow,
                                           const Real& excess, const Mask<Real>& yields,
                                           const SolveCounter<Real>& solves) const {
        const Real bend = flow.slope - law_.modulus, m = compliance_ * bend, L = (law_.rate * compliance_) * excess;
        const DecaySeries<Real> series(m, L);
        const Real z0 = series.sum(m, L), slope = series.slope(m, L), m_slope = m * slope;  // slope 1/F', nearly
        const Real phi = hardening_detail::DecayRemainder::series(z0), E = (1.0 - z0) + phi;
        const Real h = ((1.0 - slope) + m_slope * z0) - m_slope * phi;  // 1 - slope F'(z0)
        const Real w = (1.0 + h) * (1.0 + h * h);                       // 1/(1 - h)
        const Real n = (m_slope * phi - slope * (z0 - L)) * w;
        const Real d = n + (0.5 * m_slope * E) * (w * (n * n)), x = law_.inverse_rate * (z0 + d);
        const Real bend_end = bend * (E * (1.0 - d * (1.0 - 0.5 * d)));
        const FlowStress<Real> k{q_trial - stiffness_ * x, bend_end + law_.modulus, -law_.rate * bend_end};
        const auto solved = L < Real(0.45) && m < Real(0.4) && alpha + x < Real(law_.straight_from);
        if (all(solved || !yields)) [[likely]] {
            solves.count(1);
            return {x, k};
        }
        const Result<Real> other = by_exponentials(*this, q_trial, alpha, flow, Mask<Real>(yields && !solved), solves);
        return either(solved, Result<Real>{x, k}, other);
    }

    // Any step: the same again until n is small, with the exponential itself: what |n| < 5e-4 leaves is below a fifth
    // of n^5. The root lies in [L, L/(1 - m)]. Out of line and everything by value.
    template <class Real>
    [[gnu::noinline]] static Result<Real> by_exponentials(ReturnToYield self, Real q_trial, Real alpha,
                                                          FlowStress<Real> flow, Mask<Real> active,
                                                          SolveCounter<Real> solves) {
        const SaturationHardening& law = self.law_;
        const Real bend = select(active, flow.slope - law.modulus, Real(0.0));
        const Real straight = self.stiffness_ + law.modulus, compliance = 1.0 / (straight + bend);
        const Real share = compliance * straight, m = compliance * bend;
        const Real lower = (law.rate * compliance) * select(active, q_trial - flow.value, Real(0.0));
        const Real upper = lower / share;
        Real z = max(min(DecaySeries<Real>(m, lower).sum(m, lower), upper), lower);
        Real end, bend_end;
        Mask<Real> near;
        int iteration = 0;
        do {
            const Real decayed = quick_expm1(-z), m_E = m + m * decayed;
            const Real inverse_slope = 1.0 / (share + m_E);
            const Real n = inverse_slope * ((lower - share * z) + m * decayed), r = inverse_slope * m_E;
            const Real d = DecaySeries<Real>(r, n).sum(r, n);
            end = z + d;
            bend_end = bend * ((1.0 + decayed) * (1.0 - d * (1.0 - d * (1.0 / 2 - d * (1.0 / 6)))));
            near = abs(n) < Real(5e-4);
            z = select(near, z, max(min(end, upper), lower));
        } while (!all(near) && ++iteration < 8);
        solves.count(iteration + 1);
        const Real x = law.inverse_rate * end;
        const auto solved = near && alpha + x < Real(law.straight_from);
        const Result<Real> result{x, {q_trial - self.stiffness_ * x, bend_end + law.modulus, -law.rate * bend_end}};
        const Mask<Real> others = active && !solved;
        if (!any(others)) [[likely]]
            return result;
        Result<Real> other = self.in_bracket(q_trial, alpha, Real(1.0), flow, q_trial - flow.value, others, solves);
        self.finish(q_trial, other);
        return either(solved, result, other);
    }

    // For n < 1 the slope at alpha = 0 is infinite and a step from there long: such lanes are solved for the logarithm
    // of dalpha, from the nearer of the elastic and the plastic limit.
    template <class Real>
    LODE_INLINE Result<Real> near_infinite_slope(const Real& q_trial, const Real& alpha, const FlowStress<Real>& flow,
                                                 const Real& excess, const Mask<Real>& yields,
                                                 const SolveCounter<Real>& solves) const {
        const Real upper = inverse_stiffness_ * max(excess, Real(0.0));
        const auto steep = yields && alpha < 0.1 * upper && Mask<Real>(law_.exponent < 1.0 && law_.factor > 0.0);
        const auto others = yields && !steep;
        Result<Real> result{Real(0.0), flow};
        if (any(others)) result = in_bracket(q_trial, alpha, Real(1.0), flow, excess, others, solves);
        if (!any(steep)) return result;
        const Real rise = select(steep, (q_trial - law_.yield) * (1.0 / law_.factor), Real(1.0));
        const Real plastic_limit = quick_pow(rise, 1.0 / law_.exponent) - alpha;
        const auto virgin = alpha < Real(Law::smallest);
        const Real lower = select(steep, select(virgin, Real(1e-290), excess / (stiffness_ + flow.slope)), Real(1.0));
        const Real start = max(min(upper, plastic_limit), lower);
        const auto root = solve_in_logarithm(residual(q_trial, alpha, Real(1.0)), lower, upper, start,
                                             return_tolerance * q_trial, steep);
        solves.count(root);
        return either(steep, Result<Real>{root.last.dalpha, root.last.flow}, result);
    }

    Kept law_;
    Number stiffness_, inverse_stiffness_;
    // 1/(stiffness + H): H of a straight law, that of a law that saturates in the end or, in one of two lines, at the
    // start; of a falling one in one of two lines that above the floor.
    Number compliance_ = Number(0.0);
};

}  // namespace lode
