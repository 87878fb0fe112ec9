// Directions of a crack that share one damage d: sum (q_j/e_j(d))^2 = 1 (page 30, section 5.2).
#pragma once

#include "lode/damage/softening_pressure.hpp"
#include "lode/tensor/voigt.hpp"

namespace lode {

// Growth below this relative size is rounding: a zero increment changes nothing.
inline constexpr double softening_growth_tolerance = 1e-10;

// The pressure P = P0 + K EC_N that the shear strength of an isotropic crack depends on.
template <class Real>
struct CrackPressure {
    const PressureDependence* dependence;
    Real relative_strength, P0;
    double K;
    Real largest_strength;

    LODE_INLINE ShearStrength<Real> strength(const Real& opening) const {
        return dependence->at(Real(P0 + K * opening), relative_strength, largest_strength);
    }
    // No kink of tau(P) is on the way from one strength to another.
    LODE_INLINE Mask<Real> is_smooth(const ShearStrength<Real>& from, const ShearStrength<Real>& to) const {
        return dependence->is_smooth(from, to, relative_strength, largest_strength);
    }
};
struct NoPressure {};
template <class Pressure>
inline constexpr bool has_pressure = !std::is_same_v<Pressure, NoPressure>;

// The laws of a crack and the equations that link them.
struct LinkedSoftening {
    SofteningLaw normal_law, shear_law;

    LinkedSoftening(const SofteningLaw& normal, const SofteningLaw& shear)
        : normal_law(normal), shear_law(shear), all_linear_(normal.is_linear() && shear.is_linear()) {}

    bool is_linear() const { return all_linear_; }
    LODE_INLINE const SofteningLaw& law(int j) const { return j == 0 ? normal_law : shear_law; }

    // K linked directions; on return `d`, `at`, `fails` and, of laws that are not linear, `f_start`: f at u.
    template <int K, class Real>
    struct Linked {
        Vector<Real, K> x, brittleness, u, f_start;  // x = strain/L
        Real d;
        Mask<Real> active, fails;
        Vector<Softened<Real>, K> at;
        [[no_unique_address]] SolveCounter<Real> solves;
    };

    // Linked directions of which the last one, of the shears, has a strength that depends on pressure.
    template <class Real>
    struct LinkedUnderPressure : Linked<2, Real> {
        CrackPressure<Real> pressure;
        Real opening, weakness, by_strength;  // strain of the normal direction; r/tau^2, x/tau of the shears
        ShearStrength<Real> tau;              // at the start
        BentSoftened<Real> shears;            // their law there
    };

    template <bool with_normal, int K, class Real>
    LODE_INLINE Linked<K, Real> solve(Linked<K, Real> l) const {
        if (!all_linear_) return solve_curved<with_normal>(l);
        solve_linear(l);
        return l;
    }

    // Linear laws, e = eps0/(1 - k d): a quadratic in d. Its discriminant B^2 - A D is written as in Lagrange's
    // identity, which does not cancel.
    template <int K, class Real>
    LODE_INLINE void solve_linear(Linked<K, Real>& l) const {
        Real A = Real(0.0), B = Real(0.0), D = Real(-1.0), last = Real(0.0);
        Vector<Real, K> k, ratio;
        for (int j = 0; j < K; ++j) {
            const Real& x = l.x[j];
            ratio[j] = x / l.brittleness[j];
            k[j] = 1.0 - 0.5 * l.brittleness[j];
            A = A + square(ratio[j] * k[j]);
            B = B + square(ratio[j]) * k[j];
            D = D + square(ratio[j]);
            last = last + square(0.5 * x);
        }
        Real discriminant = A;
        for (int i = 0; i < K; ++i)
            for (int j = 0; j < i; ++j) {
                const Real part = 0.5 * (l.brittleness[i] - l.brittleness[j]);  // k_j - k_i
                discriminant = discriminant - square(ratio[i] * ratio[j] * part);
            }
        l.fails = l.active && last >= Real(1.0);
        l.d = D / (B + sqrt(positive_part(discriminant)));
        l.d = select(l.fails, Real(1.0), l.d);
        for (int j = 0; j < K; ++j) {
            const Real u = min(Real(l.d * l.brittleness[j] / (1.0 - k[j] * l.d)), Real(2.0));
            l.at[j] = {u, 1.0 - 0.5 * u, Real(-0.5)};
        }
    }

    template <bool with_normal>
    LODE_INLINE const SofteningLaw& law_of(int k) const {
        return with_normal && k == 0 ? normal_law : shear_law;
    }

    // Laws of any shape: d and the points of the laws together, else one inside the other.
    template <bool with_normal, int K, class Real>
    LODE_INLINE Linked<K, Real> solve_curved(Linked<K, Real> l) const {
        Real d_end = Real(1.0), least = Real(0.0);
        for (int k = 0; k < K; ++k) {
            const SofteningLaw& softening = law_of<with_normal>(k);
            d_end = min(d_end, softening.end_damage(l.brittleness[k]));
            least = least + square(l.x[k] / softening.end_strain(l.brittleness[k]));
        }
        // Beyond the ends of all laws there is nothing to solve.
        Linked<K, Real> open = l;
        open.active = l.active && least < Real(1.0);
        const Together<K, Real> together = solve_together<with_normal, false, K, Real>(open);
        const Mask<Real> solved = together.solved && together.d < d_end;
        const Mask<Real> rest = l.active && !solved;
        l.fails = Mask<Real>(false);
        if (any(rest)) [[unlikely]] {
            Linked<K, Real> nested = l;
            nested.active = rest;
            l = solve_nested<with_normal>(nested, d_end);
            l.active = nested.active || solved;
        }
        l.d = select(solved, together.d, l.d);
        l.f_start = together.f_start;
        for (int k = 0; k < K; ++k) l.at[k] = any(rest) ? choose(solved, together.at[k], l.at[k]) : together.at[k];
        return l;
    }

    // Chebyshev's method is Newton's with a correction for the second derivatives along the step: of third order with
    // the divisions of the second. After a step and a correction of these relative sizes what is left is rounding,
    // their sequence being geometric. A differentiated number is iterated on: its derivatives are behind the value.
    static constexpr double small_step = 1e-5, small_correction = 1e-10;
    static constexpr int most = 12;
    // Where Newton's method does the rest in one step: within `newton_enough`, by the same sequence.
    static constexpr double newton_step_size = 0.1, newton_rest = 1e-7, newton_enough = 3e-7;
    template <class Real>
    struct Closeness {
        Mask<Real> done, newton;
        LODE_INLINE void of(const Real& step, const Real& correction, const Real& scale) {
            const Real size = abs(step), bend = abs(correction);
            done = and_without_branch(done, Mask<Real>(size <= small_step * scale));
            done = and_without_branch(done, Mask<Real>(bend <= small_correction * scale));
            newton = and_without_branch(newton, Mask<Real>(size <= newton_step_size * scale));
            newton = and_without_branch(newton, Mask<Real>(bend * bend <= newton_rest * (size * scale)));
        }
        LODE_INLINE Mask<Real> near() const {
            if constexpr (is_differentiated<Real>) return done;
            else return or_without_branch(done, newton);
        }
    };
    // True where an iteration is the last; `done` are the lanes for which it is.
    template <class Real>
    LODE_INLINE static bool ends(Mask<Real> done, int iteration, [[maybe_unused]] int& confirmed, Mask<Real>& solved,
                                 const SolveCounter<Real>& solves) {
        if constexpr (is_differentiated<Real>)
            if (done) done = ++confirmed > 2;
        solved = solved || done;
        const bool last = all(solved) || iteration == most;
        if (last) solves.count(iteration + 1);
        return last;
    }
    // A correction that is not small against its step says nothing.
    template <class Real>
    LODE_INLINE static Real within(const Real& correction, const Real& step) {
        const Real largest = 0.5 * abs(step);
        return max(min(correction, largest), Real(-largest));
    }
    // Lanes that are done stay as they are; a point that is leaves the loop.
    template <class T, class Real>
    LODE_INLINE static T hold(const Mask<Real>& done, const T& old, const T& now) {
        if constexpr (is_batch<Real>) return choose(done, old, now);
        else return now;
    }

    // The points of the laws satisfy (1 - d) u = d r f(u).
    template <int K, class Real>
    struct Together {
        Real d;
        Vector<Softened<Real>, K> at;
        Vector<Real, K> f_start;
        ShearStrength<Real> tau;
        Mask<Real> solved;
    };
    // These and S = sum (q/e)^2 = 1 linearised: Newton's step from the points of the laws at d, and what its correction
    // needs.
    template <int K, class Real>
    struct NewtonStep {
        Real dd, inverse_c, S, stretch, per_tau, rise;  // 1/tau, d ln(tau)/dd
        Vector<Real, K> du, r, B, A, F, inverse, follow, ratio, lead, lag;
    };
    template <bool under_pressure, int K, class Real>
    LODE_INLINE static NewtonStep<K, Real> newton_step(
        const std::conditional_t<under_pressure, LinkedUnderPressure<Real>, Linked<K, Real>>& l, const Real& d,
        [[maybe_unused]] const ShearStrength<Real>& tau, const Vector<BentSoftened<Real>, K>& point) {
        const Real zero(0.0), left = 1.0 - d;
        NewtonStep<K, Real> n;
        n.r = l.brittleness;
        Vector<Real, K> x = l.x;
        n.per_tau = n.rise = zero;
        if constexpr (under_pressure) {
            n.r[K - 1] = l.weakness * (tau.value * tau.value);
            x[K - 1] = l.by_strength * tau.value;
            n.per_tau = 1.0 / tau.value;
            n.rise = tau.slope * n.per_tau * (l.pressure.K * l.opening);
        }
        // F = (1 - d) u - d r f, A = du/dF. With u following d, e/q of a direction changes by the fraction z, to first
        // order lead dd - lag.
        Real c = zero, miss = zero, S = zero;
        for (int k = 0; k < K; ++k) {
            const BentSoftened<Real>& at = point[k];
            n.inverse[k] = 1.0 / at.strain(n.r[k]);
            n.A[k] = 1.0 / (left - d * n.r[k] * at.slope);
            const Real rf = n.r[k] * at.f, e_by_u = 1.0 + n.r[k] * at.slope;
            n.B[k] = at.u + rf;
            n.F[k] = at.u - d * n.B[k];
            n.follow[k] = e_by_u * n.inverse[k];
            n.ratio[k] = x[k] * n.inverse[k];
            const Real by_u = n.follow[k] * n.A[k];
            n.lag[k] = by_u * n.F[k];
            if (under_pressure && k == K - 1) {
                const Real by_tau = n.rise * (2.0 * rf * n.inverse[k] - 1.0);
                n.B[k] = n.B[k] + 2.0 * (d * rf) * n.rise;
                n.lead[k] = by_u * n.B[k] + by_tau;
            } else {
                n.lead[k] = e_by_u * n.A[k];
            }
            const Real w = square(n.ratio[k]);
            S = S + w;
            c = c + w * n.lead[k];
            miss = miss + w * n.lag[k];
        }
        // 1/sqrt(S) = 1, which is linear along rays.
        n.S = S;
        n.stretch = sqrt(S) - 1.0;
        n.inverse_c = 1.0 / c;
        n.dd = (miss + S * n.stretch) * n.inverse_c;
        for (int k = 0; k < K; ++k) n.du[k] = (n.B[k] * n.dd - n.F[k]) * n.A[k];
        return n;
    }

    // d and the points of the laws by Chebyshev's steps and, where these have come near, one of Newton's.
    template <bool with_normal, bool under_pressure, int K, class Real>
    LODE_INLINE Together<K, Real> solve_together(
        const std::conditional_t<under_pressure, LinkedUnderPressure<Real>, Linked<K, Real>>& l) const {
        Together<K, Real> s;
        s.solved = !l.active;
        s.d = l.d;
        Vector<Real, K> u = l.u;
        Vector<BentSoftened<Real>, K> point, last;
        for (int k = 0; k < K; ++k)
            if (!(under_pressure && k == K - 1)) point[k] = law_of<with_normal>(k).bent_at(u[k]);
        if constexpr (under_pressure) {
            s.tau = l.tau;
            point[K - 1] = l.shears;
        }
        for (int k = 0; k < K; ++k) s.f_start[k] = point[k].f;
        [[maybe_unused]] Real d_strength = s.d;  // at which tau has been found
        Mask<Real> ready = s.solved;             // for Newton
        int confirmed = 0;
        s.at = {};
        for (int iteration = 0; any(l.active); ++iteration) {
            const NewtonStep<K, Real> n = newton_step<under_pressure, K, Real>(l, s.d, s.tau, point);
            const Real scale = s.d * (1.0 - s.d);  // of steps that are nearly done
            [[maybe_unused]] Real bow(0.0);        // (d2 tau/dd2)/(2 tau)
            if constexpr (under_pressure) bow = 0.5 * s.tau.curvature * n.per_tau * square(l.pressure.K * l.opening);
            Vector<Real, K> bend;
            Real rest = -1.5 * n.S * square(n.stretch);
            for (int k = 0; k < K; ++k) {
                const BentSoftened<Real>& at = point[k];
                const Real &r = n.r[k], &du = n.du[k], &dd = n.dd;
                const Real f1 = at.slope * du, f2 = 0.5 * at.curvature * square(du);
                const Real z1 = n.lead[k] * dd - n.lag[k];
                Real z2;
                if (under_pressure && k == K - 1) {
                    const Real tau1 = n.rise * dd, tau2 = bow * square(dd);
                    const Real r1 = 2.0 * tau1, r2 = 2.0 * tau2 + square(tau1);
                    bend[k] = dd * du + r * (f1 * dd + s.d * f2 + r1 * (at.f * dd + s.d * f1) + r2 * (s.d * at.f));
                    z2 = r * (f2 + r1 * f1 + r2 * at.f) * n.inverse[k] - tau2 - tau1 * z1;
                } else {
                    bend[k] = dd * du + r * (f1 * dd + s.d * f2);
                    z2 = r * f2 * n.inverse[k];
                }
                z2 = z2 + n.follow[k] * n.A[k] * bend[k];
                rest = rest + square(n.ratio[k]) * (1.5 * square(z1) - z2);
            }
            const Real dd2 = rest * n.inverse_c, dd_limited = within(dd2, n.dd);
            Closeness<Real> close{l.active, l.active};
            close.of(n.dd, dd2, scale);
            const Real d_next = min(max(Real(s.d + (n.dd + dd_limited)), Real(0.5 * s.d)), Real(0.5 * (1.0 + s.d)));
            if constexpr (under_pressure) d_strength = hold<Real, Real>(ready, d_strength, s.d);
            s.d = hold<Real, Real>(ready, s.d, d_next);
            for (int k = 0; k < K; ++k) {
                const Real du2 = (n.B[k] * dd2 + bend[k]) * n.A[k], u_next = u[k] + (n.du[k] + within(du2, n.du[k]));
                close.of(n.du[k], du2, u[k]);
                const Real far(far_end(law_of<with_normal>(k)));
                u[k] = hold<Real, Real>(ready, u[k], min(max(u_next, Real(0.5 * u[k])), far));
                last[k] = iteration == 0 ? point[k] : hold<BentSoftened<Real>, Real>(ready, last[k], point[k]);
            }
            const Mask<Real> held = ready;
            const bool is_last = ends(close.near(), iteration, confirmed, ready, l.solves);
            s.solved =
                s.solved || (is_differentiated<Real> ? ready : and_without_branch(close.done, Mask<Real>(!held)));
            if (is_last) break;
            for (int k = 0; k < K; ++k) point[k] = law_of<with_normal>(k).bent_at(u[k]);
            if constexpr (under_pressure)
                s.tau = hold<ShearStrength<Real>, Real>(ready, s.tau, l.pressure.strength(s.d * l.opening));
        }
        if (!is_differentiated<Real> && !all(s.solved)) {
            l.solves.count(1);
            for (int k = 0; k < K; ++k) point[k] = law_of<with_normal>(k).bent_at(u[k]);
            if constexpr (under_pressure)
                s.tau = hold<ShearStrength<Real>, Real>(s.solved, s.tau, l.pressure.strength(s.d * l.opening));
            const NewtonStep<K, Real> n = newton_step<under_pressure, K, Real>(l, s.d, s.tau, point);
            Mask<Real> close = and_without_branch(ready, Mask<Real>(abs(n.dd) <= newton_enough * (s.d * (1.0 - s.d))));
            if constexpr (under_pressure) d_strength = hold<Real, Real>(s.solved, d_strength, s.d);
            s.d = hold<Real, Real>(s.solved, s.d, s.d + n.dd);
            for (int k = 0; k < K; ++k) {
                close = and_without_branch(close, Mask<Real>(abs(n.du[k]) <= newton_enough * u[k]));
                u[k] = hold<Real, Real>(s.solved, u[k], u[k] + n.du[k]);
                last[k] = hold<BentSoftened<Real>, Real>(s.solved, last[k], point[k]);
            }
            s.solved = s.solved || close;
        }
        for (int k = 0; k < K; ++k) s.at[k] = law_of<with_normal>(k).moved(last[k], u[k]);
        if constexpr (under_pressure) {
            // Where the last step has met a kink of tau(P) it was not the last.
            const Real change = l.pressure.K * l.opening * (s.d - d_strength);
            ShearStrength<Real> near_tau = s.tau;
            near_tau.value = s.tau.value + change * (s.tau.slope + 0.5 * change * s.tau.curvature);
            near_tau.slope = s.tau.slope + change * s.tau.curvature;
            const Mask<Real> smooth = l.pressure.is_smooth(s.tau, near_tau);
            if (is_differentiated<Real> || any(l.active && !smooth)) {
                s.tau = l.pressure.strength(s.d * l.opening);
                s.solved = s.solved && (smooth || abs(s.tau.value - near_tau.value) <= 1e-13 * near_tau.value);
            }
            // What follows need not wait for it.
            if constexpr (!is_differentiated<Real>) s.tau = near_tau;
        }
        s.solved = s.solved && l.active;
        return s;
    }

    // The largest of two q/e is 1. The direction that it belongs to leads: its law alone gives its u, and that t. The
    // other follows in ln t = ln(u/(r f)): where the leading law ends t moves far.
    template <class Real>
    struct Largest {
        Real d;
        Vector<Softened<Real>, 2> at;
        Vector<Real, 2> f_start;
        Mask<Real> first_leads, solved;
    };
    template <class Real>
    LODE_INLINE Largest<Real> solve_largest(const Linked<2, Real>& l) const {
        // Within rounding of each other either may lead. A step that moves t by more than `nearly` may be that of a law
        // close to its end, where f is as small as the step.
        constexpr double rounding = 1e-13, nearly = 1e-3;
        const Real zero(0.0), one(1.0);
        Largest<Real> s;
        s.solved = !l.active;
        Vector<Real, 2> u = l.u;
        Vector<BentSoftened<Real>, 2> point{{normal_law.bent_at(u[0]), shear_law.bent_at(u[1])}}, last = point;
        s.first_leads = l.x[0] * point[1].strain(l.brittleness[1]) >= l.x[1] * point[0].strain(l.brittleness[0]);
        s.f_start = {{point[0].f, point[1].f}};
        // Short of the end, where ln t is infinite.
        const Vector<Real, 2> far{
            {Real((1.0 - 1e-15) * far_end(normal_law)), Real((1.0 - 1e-15) * far_end(shear_law))}};
        const Vector<Real, 2> bent_from{{Real(double_root_from(normal_law)), Real(double_root_from(shear_law))}};
        const Vector<Real, 2> per_r{{1.0 / l.brittleness[0], 1.0 / l.brittleness[1]}};
        Real t = l.d / max(one - l.d, Real(1e-16));
        int confirmed = 0;
        for (int iteration = 0; any(l.active); ++iteration) {
            const Mask<Real> first = s.first_leads;
            const auto either = [&first](const auto& a, const auto& b)
                                    LODE_INLINE_LAMBDA { return choose(first, a, b); };
            const BentSoftened<Real> lead = either(point[0], point[1]), follow = either(point[1], point[0]);
            const Real r = either(l.brittleness[0], l.brittleness[1]), x = either(l.x[0], l.x[1]);
            const Real r_f = either(l.brittleness[1], l.brittleness[0]), x_f = either(l.x[1], l.x[0]);

            // e(u) = q
            const Real per_rise = 1.0 / (1.0 + r * lead.slope), per_f = 1.0 / follow.f, per_phi = 1.0 / follow.phi();
            const Real du = (x - lead.strain(r)) * per_rise;
            const Real du2 = -0.5 * (r * lead.curvature) * (du * du) * per_rise;
            const Real u_next =
                min(max(Real(lead.u + (du + within(du2, du))), Real(0.5 * lead.u)), either(far[0], far[1]));
            const Real t_next =
                (u_next * either(per_r[0], per_r[1])) *
                either(normal_law.inverse_near(point[0], u_next), shear_law.inverse_near(point[1], u_next));

            // p = d ln t/d ln u = phi/f, and w what ln t has to change by. Near a double root of f, where t is
            // infinite, 1/sqrt(t) takes the place of ln t.
            const Real gain = (r_f * follow.f / max(follow.u, Real(1e-100))) * t_next;
            const Real per_p = follow.f * per_phi, fall = follow.u * (follow.slope * per_f);
            Real w = logarithm(gain), bend = fall * fall - 1.0 - square(follow.u) * (follow.curvature * per_f);
            const Mask<Real> near_end = follow.u > either(bent_from[1], bent_from[0]);
            if (any(near_end)) {
                w = select(near_end, 2.0 - 2.0 / sqrt(gain), w);
                bend = select(near_end, bend - 0.5 * square(1.0 - fall), bend);
            }
            const Real step = w * per_p, step2 = -0.5 * bend * square(step) * per_p;
            Real v_next = follow.u * max(1.0 + (step + within(step2, step)), Real(0.5));
            const Mask<Real> fresh = !(follow.u > zero);
            if (any(fresh)) v_next = select(fresh, r_f * t_next / (1.0 + r_f * t_next), v_next);
            v_next = min(v_next, 0.1 * follow.u + 0.9 * either(far[1], far[0]));
            const Real dv = v_next - follow.u;
            const Real e_next = follow.strain(r_f) + dv * (1.0 + r_f * (follow.slope + 0.5 * dv * follow.curvature));
            const Mask<Real> overtaken = x_f > (1.0 + rounding) * e_next;

            Mask<Real> done = and_without_branch(l.active, Mask<Real>(abs(du) <= small_step * lead.u));
            done = and_without_branch(done, Mask<Real>(abs(du2) <= small_correction * lead.u));
            done = and_without_branch(done, Mask<Real>(max(abs(w), abs(step)) <= Real(small_step)));
            done = and_without_branch(done, Mask<Real>(abs(step2) <= Real(small_correction)));
            done = and_without_branch(done, Mask<Real>(abs(t_next - t) <= nearly * t_next));
            done = and_without_branch(done, Mask<Real>(x_f <= (1.0 + rounding) * e_next));
            t = hold<Real, Real>(s.solved, t, t_next);
            u[0] = hold<Real, Real>(s.solved, u[0], either(u_next, v_next));
            u[1] = hold<Real, Real>(s.solved, u[1], either(v_next, u_next));
            for (int k = 0; k < 2; ++k) last[k] = hold<BentSoftened<Real>, Real>(s.solved, last[k], point[k]);
            s.first_leads = select_mask(Mask<Real>(s.solved || !overtaken), first, Mask<Real>(!first));
            if (ends(done, iteration, confirmed, s.solved, l.solves)) break;
            point[0] = normal_law.bent_at(u[0]);
            point[1] = shear_law.bent_at(u[1]);
        }
        s.d = t / (1.0 + t);
        s.at = {{normal_law.moved(last[0], u[0]), shear_law.moved(last[1], u[1])}};
        s.solved = s.solved && l.active;
        return s;
    }

    // ln x, from a series where x is nearly 1.
    template <class Real>
    LODE_INLINE static Real logarithm(const Real& x) {
        const Real y = x - 1.0, series = y * (1.0 - y * (0.5 - y * (1.0 / 3.0 - y * (0.25 - y * 0.2))));
        const Mask<Real> near_one = abs(y) <= Real(0.2);
        if (all(near_one)) return series;
        return select(near_one, series, quick_log(x));
    }
    // From where on the double root of a law is felt.
    static double double_root_from(const SofteningLaw& softening) {
        return softening.has_end() && !softening.is_linear() ? 0.3 * softening.end() : HUGE_VAL;
    }
    // Where a law that has no end has fallen below rounding.
    static double far_end(const SofteningLaw& softening) {
        return softening.has_end() ? softening.end() : 40.0 * softening.end();
    }

    // sqrt(sum (q/e(d))^2) = 1, which is nearly linear in d, in a bracket, and the laws inside it.
    template <bool with_normal, int K, class Real>
    [[gnu::noinline]] Linked<K, Real> solve_nested(Linked<K, Real> l, Real d_end) const {
        struct Excess {
            Real value, slope;
            Vector<Softened<Real>, K> at;
        };
        const auto evaluate = [&](const Real& d, const Mask<Real>& lanes) {
            Excess x;
            Real sum = Real(0.0), slope = Real(0.0);
            for (int k = 0; k < K; ++k) {
                const Real& r = l.brittleness[k];
                const Softened<Real> s = law_of<with_normal>(k).at_damage(d, r, l.u[k], lanes);
                const Real strain = s.strain(r), w = square(l.x[k] / strain);
                sum = sum + w;
                slope = slope + w * strain * (1.0 + r * s.slope) / (r * max(s.phi(), Real(1e-300)));  // w e'/e
                x.at[k] = s;
            }
            const Real root = sqrt(sum);
            x.value = root - 1.0;
            x.slope = -slope / max(root, Real(1e-300));
            return x;
        };
        // The group ends where the first of its laws ends.
        Excess end;
        Real sum = Real(0.0);
        for (int k = 0; k < K; ++k) {
            const SofteningLaw& softening = law_of<with_normal>(k);
            const Real& r = l.brittleness[k];
            const Mask<Real> ends = softening.end_damage(r) <= d_end;
            Softened<Real> s{Real(softening.end()), Real(softening.end_value()), Real(0.0)};
            if (!all(ends)) {
                const Softened<Real> inside = softening.at_damage(d_end, r, l.u[k], l.active && !ends);
                s = {select(ends, s.u, inside.u), select(ends, s.f, inside.f), Real(0.0)};
            }
            end.at[k] = s;
            sum = sum + square(l.x[k] / s.strain(r));
        }
        l.fails = l.active && sum >= Real(1.0);

        const Mask<Real> inside = l.active && !l.fails;
        if (!any(inside)) {
            l.d = d_end;
            l.at = end.at;
            return l;
        }
        const auto root = solve_bracketed<Slope::decreasing>([&](const Real& d) { return evaluate(d, inside); }, l.d,
                                                             max(d_end, l.d), l.d, Real(2e-15), inside);
        l.solves.count(root.iterations, root.iterations);
        l.d = select(l.fails, d_end, root.x);
        for (int k = 0; k < K; ++k) {
            const Softened<Real>& s = root.last.at[k];
            const Real u_end = law_of<with_normal>(k).end() + Real(0.0);
            l.at[k] = {select(l.fails, end.at[k].u, min(s.u, u_end)), select(l.fails, end.at[k].f, s.f), s.slope};
        }
        return l;
    }

    template <class Real>
    struct UnderPressure {
        Real d, u_old, f_old,
            normal_f_old;  // at the old damage: u, f of the shears at the new strength, f of the other
        ShearStrength<Real> tau;
        Softened<Real> normal, shear;
        Mask<Real> grows, fails;
    };
    // `n`, `s`: the directions; q, shear: their effective strains; 1/e, u: of the normal one; `shear_old`: delta/L
    // of the other, whose L is that of another pressure.
    template <class Real>
    [[gnu::noinline]] UnderPressure<Real> solve_under_pressure(SofteningDirection<Real> n, SofteningDirection<Real> s,
                                                               CrackPressure<Real> pressure, Real q, Real shear,
                                                               Real d_old, Real per_e_old, Real u_old, Real shear_old,
                                                               Mask<Real> enabled, SolveCounter<Real> solves) const {
        const Real inverse_energy = s.inverse_energy;
        const Real weakness = inverse_energy * s.compliance;  // r = tau^2 weakness
        const Mask<Real> damaged = enabled && d_old > Real(0.0);
        const Real t_old = d_old / max(1.0 - d_old, Real(1e-16)), damaged_t = select(damaged, t_old, Real(1.0));
        // Of the shear law at the old damage, with the strength at the start and at the end.
        LinkedUnderPressure<Real> l;
        l.tau = pressure.strength(d_old * q);
        const Real per_tau = 1.0 / l.tau.value;
        const Real r_start = weakness * square(l.tau.value), per_length = l.tau.value * inverse_energy;
        const auto growth = [&](const Real& u) {
            // e = delta/d
            const Real per_strain = select(damaged, d_old, Real(1.0)) / select(damaged, u, r_start);
            return square(q * per_e_old) + square(shear * per_length * per_strain);
        };
        // delta is that of another pressure; what it gives is good enough to start from.
        Real start = select(damaged, shear_old * s.length * per_length, Real(0.0)), value;
        if (shear_law.is_exponential() && !is_differentiated<Real>) {
            l.shears = shear_law.bent_at(start);
            l.u[1] = start;
            const Real target = t_old * r_start;
            Real change;
            start = shear_law.exponential_step(l.shears, target, change);
            value = growth(start);
            // Exact where it may decide.
            const Mask<Real> open =
                damaged && !(change <= SofteningLaw::exact_step) && !(change <= 0.1 && abs(value - 1.0) > 0.01);
            if (any(open)) [[unlikely]] {
                start = shear_law.solve_exponential(target, start, open, solves);
                value = growth(start);
            }
            start = select(damaged, start, Real(0.0));
        } else {
            start = select(damaged, shear_law.at_damage(d_old, r_start, start, damaged, solves).u, Real(0.0));
            value = growth(start);
            l.shears = shear_law.bent_at(start);
            l.u[1] = start;
        }
        UnderPressure<Real> step;
        step.grows = enabled && value > Real(1.0 + 2.0 * softening_growth_tolerance);

        l.x[0] = q * n.inverse_length;
        l.brittleness[0] = n.brittleness;
        l.u[0] = u_old;
        l.pressure = pressure;
        l.opening = q;
        l.weakness = weakness;
        l.by_strength = shear * inverse_energy;
        l.d = d_old;
        l.active = step.grows;
        l.solves = solves;
        const Together<2, Real> together = solve_together<true, true, 2, Real>(l);
        // The end of the laws: that of the strongest shear is a lower bound.
        Real d_end = min(normal_law.end_damage(n.brittleness),
                         shear_law.end_damage(Real(square(pressure.largest_strength) * weakness)));
        if (any(step.grows && !(together.solved && together.d < d_end))) {
            const Real r_end = weakness * square(pressure.strength(q).value);
            d_end = min(normal_law.end_damage(n.brittleness), shear_law.end_damage(r_end));
        }
        const Mask<Real> solved = together.solved && together.d < d_end, rest = step.grows && !solved;
        step.fails = Mask<Real>(false);
        step.d = select(solved, together.d, d_old);
        step.tau = together.tau;
        step.normal = together.at[0];
        step.shear = together.at[1];
        if (any(rest)) [[unlikely]]
            search_under_pressure(n, s, pressure, q, shear, d_end, d_old, rest, step, solves);
        const Real r_now = weakness * square(step.tau.value);
        if (shear_law.is_exponential() && !is_differentiated<Real>) {
            const Real near = shear_law.exponential_moved(start, Real(square(step.tau.value * per_tau)));
            const Real target = t_old * r_now;
            Real change;
            step.u_old = shear_law.exponential_step(shear_law.bent_at(near), target, change);
            solves.count(1);
            const Mask<Real> open = damaged && !(change <= SofteningLaw::exact_step);
            if (any(open)) [[unlikely]]
                step.u_old = shear_law.solve_exponential(target, step.u_old, open, solves);
        } else {
            step.u_old = shear_law.at_damage(d_old, r_now, start, damaged, solves).u;
        }
        step.u_old = select(damaged, step.u_old, Real(0.0));
        step.f_old = select(damaged, step.u_old / (damaged_t * r_now), Real(1.0));
        step.normal_f_old = together.f_start[0];
        return step;
    }

    // The same in a bracket, in the lanes `where`.
    template <class Real>
    [[gnu::noinline]] void search_under_pressure(SofteningDirection<Real> n, SofteningDirection<Real> s,
                                                 CrackPressure<Real> pressure, Real q, Real shear, Real d_end,
                                                 Real d_old, Mask<Real> where, UnderPressure<Real>& step,
                                                 SolveCounter<Real> solves) const {
        struct Excess {
            Real value, slope;
            ShearStrength<Real> tau;
            Softened<Real> normal, shear;
        };
        const Real energy = s.energy();
        // G(d) of section 5.2 and its slope (section 6).
        const auto evaluate = [&](const Real& d, const Mask<Real>& lanes) {
            Excess x;
            x.tau = pressure.strength(d * q);
            SofteningDirection<Real> shears = s;
            shears.set_strength(x.tau.value, energy);
            const Real r_n = n.brittleness, r_s = shears.brittleness;
            x.normal = normal_law.at_damage(d, r_n, Real(0.0), lanes);
            x.shear = shear_law.at_damage(d, r_s, Real(0.0), lanes);
            const Real eps_n = x.normal.strain(r_n), eps_s = x.shear.strain(r_s);
            const Real w_n = square(q * n.inverse_length / eps_n), w_s = square(shear * shears.inverse_length / eps_s);
            const Real phi_n = max(x.normal.phi(), Real(1e-300)), phi_s = max(x.shear.phi(), Real(1e-300));
            const Real rise_n = eps_n * (1.0 + r_n * x.normal.slope) / (r_n * phi_n);
            const Real rise_s = eps_s * (1.0 + r_s * x.shear.slope) / (r_s * phi_s);
            const Real by_tau = (x.shear.f + x.shear.u * x.shear.slope) / (phi_s * x.tau.value);
            x.value = w_n + w_s - 1.0;
            x.slope = -2.0 * (w_n * rise_n + w_s * (rise_s + by_tau * x.tau.slope * pressure.K * q));
            return x;
        };
        const Excess end = evaluate(d_end, where);
        const Mask<Real> fails = where && end.value >= Real(0.0), inside = where && !fails;
        const auto root = solve_bracketed([&](const Real& d) { return evaluate(d, inside); }, d_old, max(d_end, d_old),
                                          d_old, Real(4e-15), inside);
        solves.count(root.iterations, root.iterations);
        const auto take = [&](const Mask<Real>& lanes, const Real& d, const Excess& x) {
            step.d = select(lanes, d, step.d);
            step.tau.value = select(lanes, x.tau.value, step.tau.value);
            step.tau.slope = select(lanes, x.tau.slope, step.tau.slope);
            step.normal = choose(lanes, x.normal, step.normal);
            step.shear = choose(lanes, x.shear, step.shear);
        };
        take(inside, root.x, root.last);
        take(fails, d_end, end);
        step.fails = fails;
    }
    template <class Real>
    LODE_INLINE static ShearStrength<Real> choose(const Mask<Real>& mask, const ShearStrength<Real>& a,
                                                  const ShearStrength<Real>& b) {
        return {select(mask, a.value, b.value), select(mask, a.slope, b.slope), select(mask, a.curvature, b.curvature)};
    }
    template <class M>
    LODE_INLINE static M select_mask(const M& condition, const M& yes, const M& no) {
        return (condition && yes) || (!condition && no);
    }
    template <class Real>
    LODE_INLINE static Real choose(const Mask<Real>& mask, const Real& a, const Real& b) {
        return select(mask, a, b);
    }
    LODE_INLINE static Mask<Batch> choose(const Mask<Batch>& mask, const Mask<Batch>& a, const Mask<Batch>& b) {
        return select_mask(mask, a, b);
    }
    template <class Real>
    LODE_INLINE static Softened<Real> choose(const Mask<Real>& mask, const Softened<Real>& a, const Softened<Real>& b) {
        return {select(mask, a.u, b.u), select(mask, a.f, b.f), select(mask, a.slope, b.slope)};
    }
    template <class Real>
    LODE_INLINE static BentSoftened<Real> choose(const Mask<Real>& mask, const BentSoftened<Real>& a,
                                                 const BentSoftened<Real>& b) {
        return {{select(mask, a.u, b.u), select(mask, a.f, b.f), select(mask, a.slope, b.slope)},
                select(mask, a.curvature, b.curvature)};
    }

  private:
    bool all_linear_;
};

}  // namespace lode
