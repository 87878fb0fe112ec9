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
    const PressureDependence& dependence;
    Real relative_strength, P0;
    double K;
    Real largest_strength;

    LODE_INLINE ShearStrength<Real> strength(const Real& opening) const {
        return dependence.at(Real(P0 + K * opening), relative_strength, largest_strength);
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

    LODE_INLINE const SofteningLaw& law(int j) const { return j == 0 ? normal_law : shear_law; }

    // K linked directions; on return `d`, `at` and `fails`.
    template <int K, class Real>
    struct Linked {
        Vector<Real, K> strain, length, brittleness, u;
        Real modulus = Real(0.0);  // of the shears, where their strength depends on pressure
        Real d;
        Mask<Real> active, fails;
        Vector<Softened<Real>, K> at;
        [[no_unique_address]] SolveCounter<Real> solves;
    };

    template <bool with_normal, int K, class Real>
    LODE_INLINE Linked<K, Real> solve(Linked<K, Real> l) const {
        if (!all_linear_) return solve_curved<with_normal>(l);
        solve_linear(l);
        return l;
    }

    // Linear laws, e = eps0/(1 - k d): a quadratic in d.
    template <int K, class Real>
    LODE_INLINE void solve_linear(Linked<K, Real>& l) const {
        Real A = Real(0.0), B = Real(0.0), D = Real(-1.0), last = Real(0.0);
        Vector<Real, K> k;
        for (int j = 0; j < K; ++j) {
            const Real x = l.strain[j] / l.length[j], ratio = x / l.brittleness[j];
            k[j] = 1.0 - 0.5 * l.brittleness[j];
            A = A + square(ratio * k[j]);
            B = B + square(ratio) * k[j];
            D = D + square(ratio);
            last = last + square(0.5 * x);
        }
        l.fails = l.active && last >= Real(1.0);
        l.d = D / (B + sqrt(positive_part(Real(B * B - A * D))));
        l.d = select(l.fails, Real(1.0), l.d);
        for (int j = 0; j < K; ++j) {
            const Real u = l.d * l.brittleness[j] / (1.0 - k[j] * l.d);
            l.at[j] = {u, 1.0 - 0.5 * u, Real(-0.5)};
        }
    }

    template <bool with_normal>
    LODE_INLINE const SofteningLaw& law_of(int k) const {
        return with_normal && k == 0 ? normal_law : shear_law;
    }

    // Laws of any shape: d and the points of the laws together by Newton's method, else one inside the other.
    template <bool with_normal, int K, class Real>
    [[gnu::noinline]] Linked<K, Real> solve_curved(Linked<K, Real> l) const {
        Real d_end = Real(1.0), least = Real(0.0);
        for (int k = 0; k < K; ++k) {
            const SofteningLaw& softening = law_of<with_normal>(k);
            d_end = min(d_end, softening.end_damage(l.brittleness[k]));
            least = least + square(l.strain[k] / (l.length[k] * softening.end_strain(l.brittleness[k])));
        }
        // Beyond the ends of all laws there is nothing to solve.
        Linked<K, Real> open = l;
        open.active = l.active && least < Real(1.0);
        const Together<K, Real> together = solve_together<with_normal>(open, NoPressure{}, Real(0.0));
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
        for (int k = 0; k < K; ++k) l.at[k] = any(rest) ? choose(solved, together.at[k], l.at[k]) : together.at[k];
        return l;
    }

    // With t = d/(1 - d) the points of the laws satisfy u = t r f(u), and the surface is 1/sqrt(S) = 1 with
    // S = sum (q/e)^2: all nearly linear.
    template <int K, class Real>
    struct Together {
        Real d;
        Vector<Softened<Real>, K> at;
        ShearStrength<Real> tau;
        Mask<Real> solved;
    };
    template <bool with_normal, int K, class Real, class Pressure>
    LODE_INLINE Together<K, Real> solve_together(const Linked<K, Real>& l, [[maybe_unused]] const Pressure& pressure,
                                                 [[maybe_unused]] const Real& energy) const {
        constexpr int most = 12;
        // From a residual of the first, Newton's step leads below the second, rounding. A differentiated number is
        // iterated to the end: its derivatives are one step behind the value.
        constexpr double near = 2e-8, tolerance = 4e-15;
        const Real one(1.0);
        Together<K, Real> s;
        s.solved = !l.active;
        s.d = l.d;
        Vector<Real, K> u = l.u, u_solved = l.u;
        Real t = l.d / max(one - l.d, Real(1e-16));
        [[maybe_unused]] bool confirmed = false;
        for (int iteration = 0;; ++iteration) {
            const Real inverse = 1.0 / (1.0 + t), d = t * inverse;
            Vector<Real, K> r = l.brittleness, length = l.length;
            Real rise = Real(0.0);  // d ln(tau)/dt
            if constexpr (has_pressure<Pressure>) {
                const ShearStrength<Real> tau = pressure.strength(d * l.strain[0]);
                rise = tau.slope / tau.value * (pressure.K * l.strain[0]) * (inverse * inverse);
                length[K - 1] = energy / tau.value;
                r[K - 1] = tau.value / (l.modulus * length[K - 1]);
            }
            Vector<Softened<Real>, K> point;
            Vector<Real, K> F, B, A;
            Real S = Real(0.0), c = Real(0.0), b = Real(0.0), miss = Real(0.0);
            for (int k = 0; k < K; ++k) {
                point[k] = law_of<with_normal>(k).at(u[k]);
                const Softened<Real>& at = point[k];
                const Real strain = at.strain(r[k]), inverse_strain = 1.0 / strain, stretch = 1.0 + r[k] * at.slope;
                const Real w = square(l.strain[k] / length[k] * inverse_strain), drop = w * stretch * inverse_strain;
                F[k] = u[k] - t * r[k] * at.f;
                B[k] = r[k] * at.f;
                A[k] = 1.0 / (1.0 - t * r[k] * at.slope);
                S = S + w;
                if (has_pressure<Pressure> && k == K - 1) {
                    c = c + w * rise * (2.0 * B[k] * inverse_strain - 1.0);
                    B[k] = B[k] * (1.0 + 2.0 * t * rise);
                }
                c = c + drop * B[k] * A[k];
                b = b + drop * F[k] * A[k];
                miss = max(miss, Real(abs(F[k]) - (is_differentiated<Real> ? tolerance : near) * u[k]));
            }
            const Real root = sqrt(S);
            Mask<Real> done =
                l.active && miss <= Real(0.0) && abs(root - 1.0) <= Real(is_differentiated<Real> ? tolerance : near);
            if constexpr (is_differentiated<Real>)
                if (done && !confirmed) {
                    confirmed = true;
                    done = false;
                }
            const Real change = (b + S * (root - 1.0)) / c;
            const Real t_next = t + change;
            t = max(t_next, Real(0.5 * t));
            for (int k = 0; k < K; ++k)
                u[k] = min(max(Real(u[k] + (B[k] * change - F[k]) * A[k]), Real(0.5 * u[k])),
                           Real(far_end(law_of<with_normal>(k))));
            const Mask<Real> fresh = done && !s.solved;
            s.d = select(fresh, t / (1.0 + t), s.d);
            for (int k = 0; k < K; ++k) {
                u_solved[k] = select(fresh, u[k], u_solved[k]);
                s.at[k] = iteration == 0 ? point[k] : choose(fresh, point[k], s.at[k]);
            }
            s.solved = s.solved || done;
            if (all(s.solved) || iteration == most) {
                l.solves.count(iteration + 1);
                break;
            }
        }
        for (int k = 0; k < K; ++k)
            s.at[k] = is_differentiated<Real> ? law_of<with_normal>(k).at(u_solved[k])
                                              : law_of<with_normal>(k).moved(s.at[k], u_solved[k]);
        if constexpr (has_pressure<Pressure>) s.tau = pressure.strength(s.d * l.strain[0]);
        s.solved = s.solved && l.active;
        return s;
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
                const Real strain = s.strain(r), w = square(l.strain[k] / (l.length[k] * strain));
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
            sum = sum + square(l.strain[k] / (l.length[k] * s.strain(r)));
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
        Real d, u_old;
        ShearStrength<Real> tau;
        Softened<Real> normal, shear;
        Mask<Real> grows, fails;
    };
    // `n`, `s`: the directions; q, shear: their effective strains; e_old, u_old: of the normal one; `shear_old`: u of
    // the other under another pressure.
    template <class Real>
    [[gnu::noinline]] UnderPressure<Real> solve_under_pressure(SofteningDirection<Real> n, SofteningDirection<Real> s,
                                                               CrackPressure<Real> pressure, Real q, Real shear,
                                                               Real d_old, Real e_old, Real u_old, Real shear_old,
                                                               Mask<Real> enabled, SolveCounter<Real> solves) const {
        const Real energy = s.energy();
        const Mask<Real> damaged = enabled && d_old > Real(0.0);
        // Of the shear law at the old damage, with another strength.
        const auto old_point = [&](const Real& tau, const Real& guess) {
            s.set_strength(tau, energy);
            return select(damaged, shear_law.delta_at_damage(d_old, s.brittleness, guess, damaged, solves), Real(0.0));
        };
        UnderPressure<Real> step;
        const Real start = old_point(pressure.strength(d_old * q).value, shear_old);
        const Real r_start = s.brittleness;
        // e = delta/d
        const Real strain = s.length * select(damaged, start / select(damaged, d_old, Real(1.0)), r_start);
        step.grows =
            enabled && square(q / e_old) + square(shear / strain) > Real(1.0 + 2.0 * softening_growth_tolerance);

        Linked<2, Real> l;
        l.strain = {q, shear};
        l.length = {n.length, s.length};
        l.brittleness = {n.brittleness, s.brittleness};
        l.u = {u_old, start};
        l.modulus = s.modulus;
        l.d = d_old;
        l.active = step.grows;
        l.solves = solves;
        const Together<2, Real> together = solve_together<true>(l, pressure, energy);
        // The end of the laws: that of the strongest shear is a lower bound.
        Real d_end = min(normal_law.end_damage(n.brittleness),
                         shear_law.end_damage(Real(square(pressure.largest_strength) / (s.modulus * energy))));
        if (any(step.grows && !(together.solved && together.d < d_end))) {
            s.set_strength(pressure.strength(q).value, energy);
            d_end = min(normal_law.end_damage(n.brittleness), shear_law.end_damage(s.brittleness));
        }
        const Mask<Real> solved = together.solved && together.d < d_end, rest = step.grows && !solved;
        step.fails = Mask<Real>(false);
        step.d = select(solved, together.d, d_old);
        step.tau = together.tau;
        step.normal = together.at[0];
        step.shear = together.at[1];
        if (any(rest)) [[unlikely]]
            search_under_pressure(n, s, pressure, q, shear, d_end, d_old, rest, step, solves);
        // Near the answer: Newton's step of the exponential law, whose value at the start is known.
        s.set_strength(step.tau.value, energy);
        const Real ratio = s.brittleness / r_start;
        step.u_old = old_point(step.tau.value, start * ratio * (1.0 + start) / (1.0 + start * ratio));
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
            const Real w_n = square(q / (n.length * eps_n)), w_s = square(shear / (shears.length * eps_s));
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
    LODE_INLINE static Softened<Real> choose(const Mask<Real>& mask, const Softened<Real>& a, const Softened<Real>& b) {
        return {select(mask, a.u, b.u), select(mask, a.f, b.f), select(mask, a.slope, b.slope)};
    }

  private:
    bool all_linear_;
};

}  // namespace lode
