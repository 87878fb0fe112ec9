// Damage of one crack with a fixed normal (page 30, sections 1, 4, 5; Nairn, chapter 5): traction surfaces, dissipated
// energies, failure, friction of the failed crack. Directions n (normal), y, z (shears) of the crack axes; a crack has
// one of them in 1D, n and y in 2D, all in 3D.
//
// Everything is holonomic in the effective strains q: a direction alone is damaged where |q| > e(d), linked ones where
// sum (q_j/e_j(d))^2 > 1. Damage at the end of an increment is the root of one equation in the strain at its end.
#pragma once

#include "lode/damage/softening_pressure.hpp"
#include "lode/tensor/voigt.hpp"

namespace lode {

enum class TractionSurface { cuboid, cylinder, ovoid, coupled_cuboid, coupled_cylinder };

// Growth below this relative size is rounding: a zero increment changes nothing.
inline constexpr double softening_growth_tolerance = 1e-10;

template <int m, class Real>
struct CrackState {
    Vector<Real, m> delta, damage, strain, dissipated;
};

// d(damage)/d(effective strain) and d(damage)/dP0 of a UMAT point, P0 the pressure of C eps without cracking strain.
template <int m>
struct DamageRates {
    double by_strain[m][m] = {};
    double by_pressure[m] = {};
};
struct NoRates {};

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

// `isotropic`: both shears have the same law and constants.
template <bool isotropic>
class SofteningCrack {
  public:
    SofteningCrack(const SofteningLaw& normal, const SofteningLaw& shear, TractionSurface surface, double mix_I,
                   double mix_II, double friction)
        : normal_law(normal),
          shear_law(shear),
          surface_(surface),
          exponent_I_(mix_I),
          exponent_II_(mix_II),
          has_criterion_(mix_I > 0.0 && mix_II > 0.0 &&
                         (surface == TractionSurface::cuboid || surface == TractionSurface::cylinder)),
          all_linear_(normal.is_linear() && shear.is_linear()),
          friction_(friction) {}

    LODE_INLINE const SofteningLaw& law(int j) const { return j == 0 ? normal_law : shear_law; }
    TractionSurface surface() const { return surface_; }

    SofteningLaw normal_law, shear_law;

    // Damage, delta and dissipated energies at the end, from those at the start, in the lanes `active`. Returns the
    // lanes that fail. The laws of shear are left as they are at the end (pressure).
    template <int m, class Real, class Pressure, class Rates>
    LODE_INLINE Mask<Real> damage(const Vector<Real, m>& q_old, const Vector<Real, m>& q_end, const Mask<Real>& active,
                                  Vector<SofteningDirection<Real>, m>& direction, const Pressure& pressure,
                                  CrackState<m, Real>& crack, Rates& rates) const {
        Growth<m, Real> g;
        for (int j = 0; j < m; ++j) {
            g.start[j] = j == 0 ? positive_part(q_old[0]) : q_old[j];
            g.end[j] = j == 0 ? positive_part(q_end[0]) : q_end[j];
            g.enabled[j] = active && direction[j].enabled;
            g.d_old[j] = g.d[j] = crack.damage[j];
            set_threshold(direction[j], crack.delta[j], j, g);
        }
        [[maybe_unused]] ShearStrength<Real> tau{};

        const bool single_group = m > 1 && surface_ == TractionSurface::ovoid;
        if (single_group) {
            if constexpr (has_pressure<Pressure> && m > 1) tau = grow_under_pressure(direction, pressure, g);
            else if constexpr (m > 1) grow_group<0, m>(direction, g);
        } else {
            grow_alone(0, direction, g);
            if constexpr (has_pressure<Pressure> && m > 1) {
                tau = pressure.strength(g.d[0] * g.end[0]);
                set_shear_strength(tau.value, direction, g);
            }
            if constexpr (m == 2) grow_alone(1, direction, g);
            if constexpr (m == 3) {
                if (links_shears()) {
                    grow_group<1, 2>(direction, g);
                } else if (isotropic && is_coupled()) {
                    grow_larger(direction, g);
                } else {
                    grow_alone(1, direction, g);
                    grow_alone(2, direction, g);
                }
            }
            if (is_coupled()) couple(direction, g);
        }
        Mask<Real> grows = g.grows[0], fails = g.fails[0];
        for (int j = 1; j < m; ++j) grows = grows || g.grows[j], fails = fails || g.fails[j];
        if (!any(grows)) return fails;

        dissipate(direction, g, crack);
        for (int j = 0; j < m; ++j) {
            crack.damage[j] = g.d[j];
            crack.delta[j] = select(g.grows[j], g.at[j].u * direction[j].length, crack.delta[j]);
        }
        if (has_criterion_) fails = fails || (grows && criterion(direction, crack) >= Real(1.0));
        if (any(fails)) [[unlikely]]
            fail(fails, direction, g, crack);
        if constexpr (!std::is_same_v<Rates, NoRates>)
            if (!fails) set_rates(direction, pressure, tau, g, rates);
        return fails;
    }

    // Cracking strains of a failed crack (section 5.4): open, or closed and sticking or sliding. `B` = d(strain)/dq.
    template <int m, class Real>
    LODE_INLINE Vector<Real, m> failed_strain(const Vector<Real, m>& q, const Vector<Real, m>& strain_old,
                                              const Vector<SofteningDirection<Real>, m>& direction, Real& friction_work,
                                              double (*B)[m] = nullptr) const {
        const Real zero(0.0);
        const Mask<Real> open = q[0] > zero;
        Vector<Real, m> strain = q;
        strain[0] = positive_part(q[0]);
        friction_work = zero;
        Mask<Real> slips = !open;
        Real ratio = zero;  // MU N/|t|
        Vector<Real, m> t = q;
        if (m > 1 && friction_ > 0.0 && any(!open)) {
            Real square = zero;
            for (int j = 1; j < m; ++j) {
                t[j] = direction[j].modulus * (q[j] - strain_old[j]);
                square = square + t[j] * t[j];
            }
            const Real size = sqrt(square), limit = -friction_ * direction[0].modulus * q[0];
            slips = !open && size > (1.0 + softening_growth_tolerance) * limit;
            ratio = select(slips, limit / select(slips, size, Real(1.0)), zero);
            for (int j = 1; j < m; ++j) {
                const Real sliding = q[j] - ratio * t[j] / direction[j].modulus;
                strain[j] = select(open, q[j], select(slips, sliding, strain_old[j]));
                const Real work = ratio * t[j] * (strain[j] - strain_old[j]);
                friction_work = friction_work + select(slips, work, zero);
            }
            if constexpr (std::is_same_v<Real, double>)
                for (int j = 1; j < m; ++j) t[j] = size > 0.0 ? t[j] / size : 0.0;
        }
        if constexpr (std::is_same_v<Real, double>) {
            if (B == nullptr) return strain;
            for (int i = 0; i < m; ++i)
                for (int j = 0; j < m; ++j) B[i][j] = i == j && (open || (i > 0 && slips)) ? 1.0 : 0.0;
            if (slips && friction_ > 0.0)
                for (int i = 1; i < m; ++i) {
                    const double inverse = 1.0 / direction[i].modulus;
                    B[i][0] = friction_ * direction[0].modulus * t[i] * inverse;
                    for (int j = 1; j < m; ++j)
                        B[i][j] -= ratio * ((i == j ? 1.0 : 0.0) - t[i] * t[j]) * direction[j].modulus * inverse;
                }
        }
        return strain;
    }

    // The host has set damage, or failure, before the start (section 2.3): delta follows.
    template <int m, class Real>
    [[gnu::noinline]] void set_predamaged(const Mask<Real>& where, const Real& stage,
                                          const Vector<SofteningDirection<Real>, m>& direction,
                                          CrackState<m, Real>& crack) const {
        const Real zero(0.0), one(1.0);
        const Mask<Real> failed = where && stage > Real(1.5), damaged = where && !failed;
        for (int j = 0; j < m; ++j) {
            const Mask<Real>& enabled = direction[j].enabled;
            const Real d = max(min(crack.damage[j], one), zero);
            const Real u = law(j).at_damage(d, direction[j].brittleness, zero, damaged && enabled && d > zero).u;
            crack.damage[j] = select(failed, one, select(damaged, d, crack.damage[j]));
            crack.delta[j] = select(damaged && d > zero, u * direction[j].length, crack.delta[j]);
            crack.delta[j] = select(failed, law(j).end() * direction[j].length, crack.delta[j]);
            crack.delta[j] = select(where && !(enabled && (failed || d > zero)), zero, crack.delta[j]);
        }
    }

  private:
    template <class Pressure>
    static constexpr bool has_pressure = !std::is_same_v<Pressure, NoPressure>;

    TractionSurface surface_;
    double exponent_I_, exponent_II_;
    bool has_criterion_, all_linear_;
    double friction_;

    bool is_coupled() const {
        return surface_ == TractionSurface::coupled_cuboid || surface_ == TractionSurface::coupled_cylinder;
    }
    bool links_all_shears() const { return links_shears() || surface_ == TractionSurface::ovoid; }
    bool links_shears() const {
        return surface_ == TractionSurface::cylinder || surface_ == TractionSurface::coupled_cylinder;
    }

    // The increment of damage in the making.
    template <int m, class Real>
    struct Growth {
        Vector<Real, m> start, end;           // effective strains, the normal one without its negative part
        Vector<Real, m> d_old, u_old, e_old;  // on the surface at the start
        Vector<Real, m> d;
        Vector<Softened<Real>, m> at;                 // of the laws at the end, or at d_f if they fail
        Vector<Mask<Real>, m> enabled, grows, fails;  // `grows` includes `fails`
        Vector<Mask<Real>, m> sets;                   // SURF 3, 4: whose group sets the common damage

        // e at the end.
        LODE_INLINE Real e(int j, const SofteningDirection<Real>& direction) const {
            return direction.length * at[j].strain(direction.brittleness);
        }
    };

    // u and e of the surface reached so far: e = delta/d, and eps0 without damage.
    template <int m, class Real>
    LODE_INLINE static void set_threshold(const SofteningDirection<Real>& direction, const Real& delta, int j,
                                          Growth<m, Real>& g) {
        const Real zero(0.0);
        const Mask<Real> damaged = g.d_old[j] > zero && delta > zero;
        g.u_old[j] = delta / direction.length;
        g.e_old[j] = select(damaged, delta / select(damaged, g.d_old[j], Real(1.0)), direction.onset_strain());
        g.grows[j] = g.fails[j] = g.sets[j] = Mask<Real>(false);
        g.at[j] = {g.u_old[j], zero, zero};
    }

    // The shear laws at another pressure: d stays, delta follows.
    template <int m, class Real>
    LODE_INLINE void set_shear_strength(const Real& tau, Vector<SofteningDirection<Real>, m>& direction,
                                        Growth<m, Real>& g) const {
        for (int j = 1; j < m; ++j) {
            auto& dir = direction[j];
            dir.set_strength(tau, dir.energy());
            if (isotropic && j == 2 && links_shears()) g.u_old[2] = g.u_old[1];
            else
                g.u_old[j] =
                    shear_law.at_damage(g.d_old[j], dir.brittleness, g.u_old[j], g.enabled[j] && g.d_old[j] > Real(0.0))
                        .u;
            const Real u = select(g.d_old[j] > Real(0.0), g.u_old[j], Real(0.0));
            g.u_old[j] = u;
            set_threshold(dir, u * dir.length, j, g);
        }
    }

    // Section 5.1 for a direction with strain `eps`.
    template <int m, class Real>
    LODE_INLINE void grow_direction(int j, const Real& eps, const SofteningDirection<Real>& direction,
                                    Growth<m, Real>& g) const {
        const SofteningLaw& softening = law(j);
        const Mask<Real> grows = g.enabled[j] && eps > (1.0 + softening_growth_tolerance) * g.e_old[j];
        g.grows[j] = grows;
        if (!any(grows)) return;
        const Real x = eps / direction.length, r = direction.brittleness;
        const Mask<Real> fails = grows && x >= softening.end_strain(r);
        g.fails[j] = fails;
        Softened<Real> s = softening.at_strain(x, r, g.u_old[j], grows && !fails);
        s.u = select(fails, Real(softening.end()), s.u);
        s.f = select(fails, Real(softening.end_value()), s.f);
        g.at[j] = s;
        g.d[j] = select(grows && !fails, max(min(Real(s.u / x), Real(1.0)), g.d_old[j]), g.d[j]);
    }
    template <int m, class Real>
    LODE_INLINE void grow_alone(int j, const Vector<SofteningDirection<Real>, m>& direction, Growth<m, Real>& g) const {
        grow_direction(j, Real(abs(g.end[j])), direction[j], g);
    }

    // SURF 3 of an isotropic crack: the larger of the shears is the one that may set the common damage.
    template <int m, class Real>
    LODE_INLINE void grow_larger(const Vector<SofteningDirection<Real>, m>& direction, Growth<m, Real>& g) const {
        const Real y = abs(g.end[1]), z = abs(g.end[2]);
        const Mask<Real> first = y >= z;
        grow_direction(1, Real(max(y, z)), direction[1], g);
        const Real end = direction[1].length * shear_law.end_strain(direction[1].brittleness), d = g.d[1];
        g.grows[2] = g.grows[1];
        g.fails[1] = g.grows[1] && y >= end;
        g.fails[2] = g.grows[1] && z >= end;
        g.at[2] = g.at[1];
        g.d[1] = select(first, d, g.d_old[1]);
        g.d[2] = select(first, g.d_old[2], d);
    }

    // Section 5.2: the directions first .. first + count - 1. The shears of an isotropic crack act as one.
    template <int first, int count, int m, class Real>
    LODE_INLINE void grow_group(const Vector<SofteningDirection<Real>, m>& direction, Growth<m, Real>& g) const {
        constexpr bool merges = isotropic && first + count == 3;
        constexpr int K = merges ? count - 1 : count;
        if constexpr (K == 1) {
            grow_direction(first, Real(sqrt(g.end[1] * g.end[1] + g.end[2] * g.end[2])), direction[1], g);
        } else {
            Linked<K, Real> linked;
            Real sum = Real(0.0);
            for (int k = 0; k < K; ++k) {
                const int j = first + k;
                linked.strain[k] = abs(g.end[j]);
                if (merges && k == K - 1) linked.strain[k] = sqrt(g.end[1] * g.end[1] + g.end[2] * g.end[2]);
                linked.length[k] = direction[j].length;
                linked.brittleness[k] = direction[j].brittleness;
                linked.u[k] = g.u_old[j];
                sum = sum + square(linked.strain[k] / g.e_old[j]);
            }
            linked.active = g.enabled[first] && sum > Real(1.0 + 2.0 * softening_growth_tolerance);
            g.grows[first] = linked.active;
            if (any(linked.active)) {
                linked.d = g.d_old[first];
                if (all_linear_) solve_linear(linked);
                else linked = solve_curved<first == 0>(linked);
                for (int k = 0; k < K; ++k) {
                    const int j = first + k;
                    g.at[j] = linked.at[k];
                    g.grows[j] = linked.active;
                    g.fails[j] = linked.fails;
                    g.d[j] = select(linked.active && !linked.fails, max(min(linked.d, Real(1.0)), g.d_old[j]), g.d[j]);
                }
            }
        }
        if constexpr (merges) {
            g.grows[2] = g.grows[1];
            g.fails[2] = g.fails[1];
            g.at[2] = g.at[1];
            g.d[2] = g.d[1];
        }
    }

    // Linked directions; on return `d`, `at` and `fails`.
    template <int K, class Real>
    struct Linked {
        Vector<Real, K> strain, length, brittleness, u;
        Real modulus = Real(0.0);  // of the shears, where their strength depends on pressure
        Real d;
        Mask<Real> active, fails;
        Vector<Softened<Real>, K> at;
    };

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
        Real d_end = Real(1.0);
        for (int k = 0; k < K; ++k) d_end = min(d_end, law_of<with_normal>(k).end_damage(l.brittleness[k]));
        const Together<K, Real> together = solve_together<with_normal>(l, NoPressure{}, Real(0.0));
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
        constexpr double tolerance = 4e-15;
        const Real one(1.0);
        Together<K, Real> s;
        s.solved = !l.active;
        Vector<Real, K> u = l.u;
        Real t = l.d / max(one - l.d, Real(1e-16));
        [[maybe_unused]] bool confirmed = !is_differentiated<Real>;
        for (int iteration = 0;; ++iteration) {
            const Real inverse = 1.0 / (1.0 + t), d = t * inverse;
            Vector<Real, K> r = l.brittleness, length = l.length;
            Real rise = Real(0.0);  // d ln(tau)/dt
            ShearStrength<Real> tau{};
            if constexpr (has_pressure<Pressure>) {
                tau = pressure.strength(d * l.strain[0]);
                rise = tau.slope / tau.value * (pressure.K * l.strain[0]) * (inverse * inverse);
                length[K - 1] = energy / tau.value;
                r[K - 1] = tau.value / (l.modulus * length[K - 1]);
            }
            Vector<Softened<Real>, K> at;
            Vector<Real, K> F, B, A;
            Real S = Real(0.0), c = Real(0.0), b = Real(0.0);
            Mask<Real> fits = Mask<Real>(true);
            for (int k = 0; k < K; ++k) {
                at[k] = law_of<with_normal>(k).at(u[k]);
                const Real strain = at[k].strain(r[k]), inverse_strain = 1.0 / strain,
                           stretch = 1.0 + r[k] * at[k].slope;
                const Real w = square(l.strain[k] / length[k] * inverse_strain), drop = w * stretch * inverse_strain;
                F[k] = u[k] - t * r[k] * at[k].f;
                B[k] = r[k] * at[k].f;
                A[k] = 1.0 / (1.0 - t * r[k] * at[k].slope);
                S = S + w;
                if (has_pressure<Pressure> && k == K - 1) {
                    c = c + w * rise * (2.0 * B[k] * inverse_strain - 1.0);
                    B[k] = B[k] * (1.0 + 2.0 * t * rise);
                }
                c = c + drop * B[k] * A[k];
                b = b + drop * F[k] * A[k];
                fits = fits && abs(F[k]) <= Real(tolerance * u[k]);
            }
            const Real root = sqrt(S);
            Mask<Real> done = l.active && fits && abs(root - 1.0) <= Real(tolerance);
            if constexpr (is_differentiated<Real>)
                if (done && !confirmed) {
                    confirmed = true;  // derivatives are one step behind the value
                    done = false;
                }
            const Mask<Real> fresh = done && !s.solved;
            const bool first = iteration == 0;
            for (int k = 0; k < K; ++k) s.at[k] = first ? at[k] : choose(fresh, at[k], s.at[k]);
            s.d = first ? d : select(fresh, d, s.d);
            s.tau.value = first ? tau.value : select(fresh, tau.value, s.tau.value);
            s.tau.slope = first ? tau.slope : select(fresh, tau.slope, s.tau.slope);
            s.solved = s.solved || done;
            if (all(s.solved) || iteration == most) {
                s.solved = s.solved && l.active;
                return s;
            }
            const Real change = (b + S * (root - 1.0)) / c;
            const Real t_next = t + change;
            t = max(t_next, Real(0.5 * t));
            for (int k = 0; k < K; ++k)
                u[k] = min(max(Real(u[k] + (B[k] * change - F[k]) * A[k]), Real(0.5 * u[k])),
                           Real(far_end(law_of<with_normal>(k))));
        }
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
        const auto root = solve_bracketed<Slope::decreasing>([&](const Real& d) { return evaluate(d, inside); }, l.d,
                                                             max(d_end, l.d), l.d, Real(2e-15), inside);
        l.d = select(l.fails, d_end, root.x);
        for (int k = 0; k < K; ++k) {
            const Softened<Real>& s = root.last.at[k];
            const Real u_end = law_of<with_normal>(k).end() + Real(0.0);
            l.at[k] = {select(l.fails, end.at[k].u, min(s.u, u_end)), select(l.fails, end.at[k].f, s.f), s.slope};
        }
        return l;
    }

    // SURF 2 with a shear strength that depends on pressure, which the crack itself relieves: P = P0 + K d <q_n>.
    template <int m, class Real>
    LODE_INLINE ShearStrength<Real> grow_under_pressure(Vector<SofteningDirection<Real>, m>& direction,
                                                        const CrackPressure<Real>& pressure, Growth<m, Real>& g) const {
        Real shear = abs(g.end[1]);
        if constexpr (m == 3) shear = sqrt(g.end[1] * g.end[1] + g.end[2] * g.end[2]);
        const UnderPressure<Real> step =
            solve_under_pressure(direction[0], direction[1], pressure, g.end[0], shear, g.d_old[0], g.e_old[0],
                                 g.u_old[0], g.u_old[1], g.enabled[0]);
        for (int j = 0; j < m; ++j) {
            if (j > 0) {
                direction[j].set_strength(step.tau.value, direction[j].energy());
                g.u_old[j] = step.u_old;
                set_threshold(direction[j], step.u_old * direction[j].length, j, g);
            }
            g.grows[j] = step.grows;
            g.fails[j] = step.fails;
            g.at[j] = j == 0 ? step.normal : step.shear;
            g.d[j] = select(step.grows && !step.fails, max(min(step.d, Real(1.0)), g.d_old[j]), g.d[j]);
        }
        return step.tau;
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
                                                               Mask<Real> enabled) const {
        const Real energy = s.energy();
        const Mask<Real> damaged = enabled && d_old > Real(0.0);
        // Of the shear law at the old damage, with another strength.
        const auto old_point = [&](const Real& tau, const Real& guess) {
            s.set_strength(tau, energy);
            const Softened<Real> point = shear_law.at_damage(d_old, s.brittleness, guess, damaged);
            return select(damaged, point.u, Real(0.0));
        };
        UnderPressure<Real> step;
        const Real start = old_point(pressure.strength(d_old * q).value, shear_old);
        const Real strain = s.length * shear_law.at(start).strain(s.brittleness);
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
        const Together<2, Real> together = solve_together<true>(l, pressure, energy);
        s.set_strength(pressure.strength(q).value, energy);
        const Real d_end = min(normal_law.end_damage(n.brittleness), shear_law.end_damage(s.brittleness));
        const Mask<Real> solved = together.solved && together.d < d_end, rest = step.grows && !solved;
        step.fails = Mask<Real>(false);
        step.d = select(solved, together.d, d_old);
        step.tau = together.tau;
        step.normal = together.at[0];
        step.shear = together.at[1];
        if (any(rest)) [[unlikely]]
            search_under_pressure(n, s, pressure, q, shear, d_end, d_old, rest, step);
        step.u_old = old_point(step.tau.value, start);
        return step;
    }

    // The same in a bracket, in the lanes `where`.
    template <class Real>
    [[gnu::noinline]] void search_under_pressure(SofteningDirection<Real> n, SofteningDirection<Real> s,
                                                 CrackPressure<Real> pressure, Real q, Real shear, Real d_end,
                                                 Real d_old, Mask<Real> where, UnderPressure<Real>& step) const {
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

    // SURF 3, 4: the largest of the provisional damages holds in all directions; the first failure is that of the
    // point. Damage that another direction sets may lie on the tail of a law beyond FMIN.
    template <int m, class Real>
    LODE_INLINE void couple(const Vector<SofteningDirection<Real>, m>& direction, Growth<m, Real>& g) const {
        Mask<Real> fails = g.fails[0], grows = g.grows[0];
        Real d = g.d[0];
        for (int j = 1; j < m; ++j) {
            fails = fails || g.fails[j];
            grows = grows || g.grows[j];
            d = max(d, g.d[j]);
        }
        if (!any(grows)) return;
        Mask<Real> taken = Mask<Real>(false);
        for (int j = 0; j < m; ++j) {
            const Mask<Real> first = select_mask(fails, g.fails[j], g.grows[j] && g.d[j] >= d) && !taken;
            g.sets[j] = first;
            if (j == 2 && links_shears()) g.sets[2] = g.sets[1];
            taken = taken || first;
        }
        Softened<Real> shears{};
        for (int j = 0; j < m; ++j) {
            const Mask<Real> follows = grows && !fails && !g.sets[j];
            g.fails[j] = fails && g.sets[j];
            g.grows[j] = g.fails[j] || (grows && !fails);
            g.d[j] = select(grows && !fails, d, g.d_old[j]);
            if (isotropic && j == 2) {
                g.at[2] = choose(follows, shears, g.at[2]);
                continue;
            }
            Mask<Real> needed = follows;
            if (isotropic && j == 1 && m == 3) needed = grows && !fails && !(g.sets[1] && g.sets[m - 1]);
            if (!any(needed)) continue;
            const Softened<Real> s = law(j).at_damage(d, direction[j].brittleness, g.u_old[j], needed);
            if (j == 1) shears = s;
            g.at[j] = choose(follows, s, g.at[j]);
        }
    }
    template <class M>
    LODE_INLINE static M select_mask(const M& condition, const M& yes, const M& no) {
        return (condition && yes) || (!condition && no);
    }

    // Section 5.3: dW_j = (w_old + w)/2 [Gbar(new) - Gbar(old)], and what is left at a failure.
    template <int m, class Real>
    LODE_INLINE void dissipate(const Vector<SofteningDirection<Real>, m>& direction, const Growth<m, Real>& g,
                               CrackState<m, Real>& crack) const {
        Vector<Real, m> w_old, w;
        for (int j = 0; j < m; ++j) w_old[j] = w[j] = Real(1.0);
        if (is_coupled()) {
            for (int j = 0; j < m; ++j) {
                const Mask<Real>& sets = g.sets[j];
                w_old[j] = select(sets, Real(1.0), min(square(Real(g.start[j] / g.e_old[j])), Real(1.0)));
                w[j] = select(sets, Real(1.0), square(Real(g.end[j] / g.e(j, direction[j]))));
            }
            if constexpr (m == 3)
                if (links_shears()) {
                    Vector<Real, m> group_old, group;
                    weights<1, 2>(direction, g, group_old, group);
                    for (int j = 1; j < 3; ++j) {
                        w_old[j] = select(g.sets[1], group_old[j], w_old[j]);
                        w[j] = select(g.sets[1], group[j], w[j]);
                    }
                }
        } else if (m > 1 && surface_ == TractionSurface::ovoid) {
            weights<0, m>(direction, g, w_old, w);
        } else if constexpr (m == 3) {
            if (links_shears()) weights<1, 2>(direction, g, w_old, w);
        }
        Real released = Real(0.0);
        for (int j = 0; j < m; ++j) {
            const Mask<Real>& grows = g.grows[j];
            if (!any(grows)) continue;
            const SofteningDirection<Real>& dir = direction[j];
            const Softened<Real>& s = g.at[j];
            const bool same = isotropic && j == 2 && links_all_shears();
            if (!same) released = dir.energy() * (law(j).omega(s.u) - law(j).omega(g.u_old[j]));
            const Real rest = select(g.fails[j], (0.5 * w[j] * s.f) * s.strain(dir.brittleness), Real(0.0));
            const Real change = 0.5 * (w_old[j] + w[j]) * positive_part(released) + dir.energy() * rest;
            crack.dissipated[j] = select(grows, crack.dissipated[j] + change, crack.dissipated[j]);
        }
    }

    // Shares of linked directions: w_j = (q_j/e_j)^2 at the end, and where the straight path of q crosses the old
    // surface.
    template <int first, int count, int m, class Real>
    LODE_INLINE static void weights(const Vector<SofteningDirection<Real>, m>& direction, const Growth<m, Real>& g,
                                    Vector<Real, m>& w_old, Vector<Real, m>& w) {
        Vector<Real, m> a, b;
        Real aa = Real(0.0), ab = Real(0.0), bb = Real(0.0), sum = Real(0.0);
        for (int j = first; j < first + count; ++j) {
            const Real inverse = 1.0 / g.e_old[j];
            a[j] = g.start[j] * inverse;
            b[j] = g.end[j] * inverse - a[j];
            aa = aa + a[j] * a[j];
            ab = ab + a[j] * b[j];
            bb = bb + b[j] * b[j];
            w[j] = square(Real(g.end[j] / g.e(j, direction[j])));
            sum = sum + w[j];
        }
        const Real tiny(1e-300);
        Real s = (sqrt(positive_part(Real(ab * ab + bb * (1.0 - aa)))) - ab) / max(bb, tiny);
        s = max(min(s, Real(1.0)), Real(0.0));
        Real sum_old = Real(0.0);
        for (int j = first; j < first + count; ++j) {
            w_old[j] = square(Real(a[j] + s * b[j]));
            sum_old = sum_old + w_old[j];
        }
        const Real scale = 1.0 / max(sum, tiny), scale_old = 1.0 / max(sum_old, tiny);
        for (int j = first; j < first + count; ++j) {
            w[j] = scale * w[j];
            w_old[j] = scale_old * w_old[j];
        }
    }

    // Released fractions of the toughnesses, (5.42).
    template <int m, class Real>
    LODE_INLINE Real criterion(const Vector<SofteningDirection<Real>, m>& direction,
                               const CrackState<m, Real>& crack) const {
        const auto fraction = [&](int j) {
            const SofteningDirection<Real>& dir = direction[j];
            return select(dir.enabled, Real(crack.dissipated[j] / dir.energy()), Real(0.0));
        };
        Real sum = power(fraction(0), exponent_I_);
        if constexpr (m == 2) sum = sum + power(fraction(1), exponent_II_);
        if constexpr (m == 3) {
            if (links_shears()) sum = sum + power(Real(fraction(1) + fraction(2)), exponent_II_);
            else sum = sum + power(fraction(1), exponent_II_) + power(fraction(2), exponent_II_);
        }
        return sum;
    }
    template <class Real>
    LODE_INLINE static Real power(const Real& x, double exponent) {
        if (exponent == 1.0) return x;
        if (exponent == 2.0) return x * x;
        const Mask<Real> positive = x > Real(0.0);
        return select(positive, pow(max(x, Real(1e-300)), Real(exponent)), Real(0.0));
    }

    // Directions that do not fail by themselves give up their elastic energy.
    template <int m, class Real>
    LODE_INLINE void fail(const Mask<Real>& fails, const Vector<SofteningDirection<Real>, m>& direction,
                          const Growth<m, Real>& g, CrackState<m, Real>& crack) const {
        for (int j = 0; j < m; ++j) {
            const SofteningDirection<Real>& dir = direction[j];
            const Real lost = 0.5 * dir.modulus * square(g.end[j]) * (1.0 - crack.damage[j]);
            const Mask<Real> drops = fails && !g.fails[j];
            crack.dissipated[j] = select(drops, crack.dissipated[j] + lost, crack.dissipated[j]);
            crack.damage[j] = select(fails, Real(1.0), crack.damage[j]);
            crack.delta[j] = select(fails && dir.enabled, law(j).end() * dir.length, crack.delta[j]);
        }
    }

    // Section 6.
    template <int m, class Pressure>
    LODE_INLINE void set_rates(const Vector<SofteningDirection<double>, m>& direction,
                               [[maybe_unused]] const Pressure& pressure,
                               [[maybe_unused]] const ShearStrength<double>& tau, const Growth<m, double>& g,
                               DamageRates<m>& rates) const {
        // dd/dq_k = (q_k/e_k^2)/D, D = sum q^2 (C + F')/(e Phi), of the directions first .. last
        const auto group = [&](int first, int last, int to_first, int to_last) {
            double D = 0.0;
            for (int j = first; j <= last; ++j) {
                const Softened<double>& s = g.at[j];
                const double r = direction[j].brittleness, phi = s.phi();
                const double w = square(g.end[j] / g.e(j, direction[j]));
                if (w == 0.0) continue;
                if (!(phi > 0.0)) return;
                D += w * s.strain(r) * (1.0 + r * s.slope) / (r * phi);
            }
            if constexpr (has_pressure<Pressure>)
                if (first == 0 && last > 0) {
                    // the shear strength follows the opening of the crack
                    const Softened<double>& s = g.at[1];
                    double w = 0.0;
                    for (int j = 1; j <= last; ++j) w += square(g.end[j] / g.e(j, direction[j]));
                    const double by_tau = (s.f + s.u * s.slope) / (s.phi() * tau.value);
                    const double by_pressure = -w * by_tau * tau.slope;  // dG/dP/2
                    D -= by_pressure * pressure.K * g.end[0];
                    for (int i = to_first; i <= to_last; ++i) {
                        rates.by_pressure[i] = by_pressure / D;
                        rates.by_strain[i][0] = by_pressure / D * pressure.K * g.d[0] * (g.end[0] > 0.0 ? 1.0 : 0.0);
                    }
                }
            for (int k = first; k <= last; ++k) {
                const double rate = g.end[k] / (square(g.e(k, direction[k])) * D);
                for (int i = to_first; i <= to_last; ++i) rates.by_strain[i][k] += rate;
            }
        };
        if (m > 1 && surface_ == TractionSurface::ovoid) {
            if (g.grows[0]) group(0, m - 1, 0, m - 1);
            return;
        }
        if (is_coupled()) {
            for (int j = 0; j < m; ++j) {
                if (!g.sets[j]) continue;
                const bool pair = j == 1 && m == 3 && links_shears();
                return group(j, pair ? 2 : j, 0, m - 1);
            }
            return;
        }
        if (g.grows[0]) group(0, 0, 0, 0);
        for (int j = 1; j < m; ++j) {
            if (!g.grows[j]) continue;
            const bool pair = m == 3 && links_shears();
            const int last = pair ? 2 : j;
            group(j, last, j, last);
            if constexpr (has_pressure<Pressure>) {
                const Softened<double>& s = g.at[j];
                const double r = direction[j].brittleness;
                const double by_pressure =
                    -tau.slope * r * (s.f + s.u * s.slope) / (tau.value * s.strain(r) * (1.0 + r * s.slope));
                const double opening =
                    (g.end[0] > 0.0 ? g.d[0] : 0.0) + g.end[0] * rates.by_strain[0][0];  // dEC_N/dq_n
                for (int i = j; i <= last; ++i) {
                    rates.by_pressure[i] = by_pressure;
                    rates.by_strain[i][0] = by_pressure * pressure.K * opening;
                }
            }
            if (pair) return;
        }
    }
};

}  // namespace lode
