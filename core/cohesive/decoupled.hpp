// Method 0 of page 40 (section 4.5): each mode damages by its own strength law, and both fail together, by the end of
// one law or by the energy criterion (GI/GIc)^p + (GII/GIIc)^q = 1. The decoupled keywords derive from this.
#pragma once

#include "lode/cohesive/interface.hpp"
#include "lode/numerics/root.hpp"

namespace lode {

template <class NormalLaw, class ShearLaw>
struct DecoupledInterface {
    NormalLaw normal;
    ShearLaw shear;
    double exponent_I, exponent_II;  // p, q of the criterion; p <= 0: none
    Contact contact;
    double thickness, inverse_thickness;

    int required_state(AnalysisKind) const { return interface_state::count; }

    template <AnalysisKind kind>
    void initial_stiffness(const Stress<kind, double>&, const State<double>&, Tangent<kind>& tangent) const {
        constexpr int n = components(kind);
        for (int i = 0; i < n * n; ++i) tangent.stiffness[i] = 0.0;
        for (int i = 0; i < n; ++i) tangent(i, i) = thickness * (i == 0 ? normal.stiffness : shear.stiffness);
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        namespace index = interface_state;
        using Path = SeparationPath<kind, Real>;
        const Real zero(0.0), one(1.0);
        const State<Real>& state = point.state;
        const Path path(increment, state, thickness);
        const Real dn_old = max(state[index::dn], Real(normal.elastic_limit));
        const Real dt_old = max(state[index::dt], Real(shear.elastic_limit));
        const Mask<Real> failed_before = state[index::Dn] >= one && state[index::Dt] >= one;

        // Which of the modes grow is as good as random: no branch hangs on it.
        // 1. largest opening and sliding so far
        const auto& u = path.end;
        InterfaceResult<kind, Real> result;
        result.dn = max(dn_old, Path::opening(u));
        result.dt = max(dt_old, Path::sliding(u));
        if (any(failed_before)) [[unlikely]] {
            result.dn = select(failed_before, dn_old, result.dn);
            result.dt = select(failed_before, dt_old, result.dt);
        }
        result.GI = released(normal, result.dn);
        result.GII = released(shear, result.dt);
        result.Gdrop = state[index::Gdrop];

        // 2. failure, at the point of the path where it happens
        result.failed = failed_before;
        Mask<Real> fails = or_without_branch<Mask<Real>>(result.dn >= Real(normal.end), result.dt >= Real(shear.end));
        if (exponent_I > 0.0) {
            const auto grows = or_without_branch<Mask<Real>>(result.dn > dn_old, result.dt > dt_old);
            const Mask<Real> meets = released_fraction(result.GI, result.GII) >= one;
            fails = or_without_branch<Mask<Real>>(fails, and_without_branch<Mask<Real>>(grows, meets));
        }
        if (any(fails)) [[unlikely]] {
            fails = fails && !failed_before;
            // The path made once more: that of the other points stays in registers.
            if (any(fails))
                result = at_failure<kind, Real>(*this, Path(increment, state, thickness), dn_old, dt_old, fails, result,
                                                point.solves);
            result.failed = failed_before || fails;
        }

        // Damage below 1 marks an interface that has not failed, however small u_e/u_c is.
        const Real largest_damage(1.0 - 0.5 * std::numeric_limits<double>::epsilon());
        const Real intact_n = normal.integrity(result.dn), intact_t = shear.integrity(result.dt);
        result.normal_damage = min(1.0 - intact_n, largest_damage);
        result.shear_damage = min(1.0 - intact_t, largest_damage);
        result.normal_stiffness = normal.stiffness * intact_n;
        result.shear_stiffness = shear.stiffness * intact_t;
        // 3. the slope is S' where damage grew, S/delta elsewhere
        [[maybe_unused]] Real slope_n, slope_t;
        if constexpr (wants_tangent<T>) {
            slope_n = select(result.dn > dn_old, normal.slope(result.dn), result.normal_stiffness);
            slope_t = select(result.dt > dt_old, shear.slope(result.dt), result.shear_stiffness);
        }
        if (any(result.failed)) [[unlikely]] {
            result.normal_damage = select(result.failed, one, result.normal_damage);
            result.shear_damage = select(result.failed, one, result.shear_damage);
            result.normal_stiffness = select(result.failed, zero, result.normal_stiffness);
            result.shear_stiffness = select(result.failed, zero, result.shear_stiffness);
            if constexpr (wants_tangent<T>) slope_n = slope_t = zero;
        }
        if (!result.finish(path, contact, inverse_thickness, point)) return;

        if constexpr (wants_tangent<T>) {
            constexpr int n = components(kind);
            tangent(0, 0) = thickness * (u[0] < 0.0 ? contact.stiffness(result.normal_stiffness) : slope_n);
            for (int i = 1; i < n; ++i) tangent(i, 0) = tangent(0, i) = 0.0;
            if constexpr (n == 2) {
                tangent(1, 1) = thickness * slope_t;
            } else {
                // in shear along and across the direction of sliding
                const double across = thickness * result.shear_stiffness;
                const double change = thickness * (slope_t - result.shear_stiffness) /
                                      max(u[1] * u[1] + u[2] * u[2], std::numeric_limits<double>::min());
                tangent(1, 1) = across + change * u[1] * u[1];
                tangent(2, 2) = across + change * u[2] * u[2];
                tangent(2, 1) = tangent(1, 2) = change * u[1] * u[2];
            }
        }
    }

  private:
    template <class Law, class Real>
    static Real released(const Law& law, const Real& delta) {
        return law.released_energy(min(delta, Real(law.end)));
    }
    template <class Real>
    LODE_INLINE static Real power(const Real& x, double exponent) {
        if (exponent == 1.0) [[likely]]
            return x;
        if (exponent == 2.0) return x * x;
        return general_power<Real>(x, exponent);
    }
    // By value and out of the way, so that the point stays in registers.
    template <class Real>
    [[gnu::noinline]] static Real general_power(const Real x, double exponent) {
        if (exponent == 0.0) return Real(1.0);
        const Mask<Real> positive = x > Real(0.0);
        if (!any(positive)) return Real(0.0);
        return select(positive, pow(max(x, Real(1e-300)), Real(exponent)), Real(0.0));
    }

    // (GI/GIc)^p + (GII/GIIc)^q
    template <class Real>
    LODE_INLINE Real released_fraction(const Real& GI, const Real& GII) const {
        return power(GI * normal.inverse_toughness, exponent_I) + power(GII * shear.inverse_toughness, exponent_II);
    }

    // The state at the first s of the path at which one of the conditions of failure holds; they grow with s, since u_n
    // and u_t are convex in s. It is frozen there, so that the criterion is met exactly whatever the size of the
    // increment. All arguments by value: nothing of the caller has to live in memory.
    template <AnalysisKind kind, class Real>
    [[gnu::noinline]] static InterfaceResult<kind, Real> at_failure(
        const DecoupledInterface laws, const SeparationPath<kind, Real> path, const Real dn_old, const Real dt_old,
        const Mask<Real> fails, InterfaceResult<kind, Real> result, SolveCounter<Real> solves) {
        laws.locate_failure(path, dn_old, dt_old, fails, result, solves);
        return result;
    }
    template <AnalysisKind kind, class Real>
    LODE_INLINE void locate_failure(const SeparationPath<kind, Real>& path, const Real& dn_old, const Real& dt_old,
                                    const Mask<Real>& fails, InterfaceResult<kind, Real>& result,
                                    const SolveCounter<Real>& solves) const {
        using Path = SeparationPath<kind, Real>;
        const Real zero(0.0);
        const auto residual = [&](const Real& s) {
            const auto u = path.at(s);
            const Real opening = Path::opening(u), sliding = Path::sliding(u);
            const Real dn = max(dn_old, opening), dt = max(dt_old, sliding);
            // d(delta)/ds where it grows
            Real along = u[1] * path.change[1];
            for (int i = 2; i < Path::n; ++i) along = along + u[i] * path.change[i];
            const Real dn_rate = select(opening > dn_old, path.change[0], zero);
            const Real dt_rate = select(sliding > dt_old, along / max(sliding, dt_old), zero);

            const Real end_n = dn * normal.inverse_end - 1.0, end_t = dt * shear.inverse_end - 1.0;
            Residual<Real> r;
            r.value = max(end_n, end_t);
            r.slope = select(end_n > end_t, dn_rate * normal.inverse_end, dt_rate * shear.inverse_end);
            if (exponent_I > 0.0) {
                const Real GI = released(normal, dn), GII = released(shear, dt);
                const Real criterion = released_fraction(GI, GII) - 1.0;
                const auto rate = [](const auto& law, const Real& delta, const Real& G, double exponent) {
                    return exponent * law.inverse_toughness * power(G * law.inverse_toughness, exponent - 1.0) *
                           law.release_rate(min(delta, Real(law.end)));
                };
                r.slope = select(
                    criterion > r.value,
                    rate(normal, dn, GI, exponent_I) * dn_rate + rate(shear, dt, GII, exponent_II) * dt_rate, r.slope);
                r.value = max(r.value, criterion);
            }
            return r;
        };
        // A state that the host has set beyond failure fails at s = 0.
        const Mask<Real> inside = fails && residual(zero).value < zero;
        const Root<Real> root = solve_bracketed<Slope::increasing>(
            residual, zero, Real(1.0), select(inside, Real(1.0), zero), Real(4e-16), inside);
        solves.count(root);

        const auto u = path.at(root.x);
        const Real opening = Path::opening(u), sliding = Path::sliding(u);
        const Real dn = min(max(dn_old, opening), Real(normal.end)), dt = min(max(dt_old, sliding), Real(shear.end));
        const Real stored = normal.stiffness * normal.integrity(dn) * square(opening) +
                            shear.stiffness * shear.integrity(dt) * square(sliding);
        result.dn = select(fails, dn, result.dn);
        result.dt = select(fails, dt, result.dt);
        result.GI = select(fails, released(normal, dn), result.GI);
        result.GII = select(fails, released(shear, dt), result.GII);
        result.Gdrop = select(fails, result.Gdrop + 0.5 * stored, result.Gdrop);
    }
};

}  // namespace lode
