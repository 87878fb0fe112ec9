// Damage of one crack with a fixed normal (page 30, sections 1, 4, 5; Nairn, chapter 5): traction surfaces, dissipated
// energies, failure, friction of the failed crack. Directions n (normal), y, z (shears) of the crack axes; a crack has
// one of them in 1D, n and y in 2D, all in 3D.
//
// Everything is holonomic in the effective strains q: a direction alone is damaged where |q| > e(d), linked ones where
// sum (q_j/e_j(d))^2 > 1. Damage at the end of an increment is the root of one equation in the strain at its end.
#pragma once

#include "lode/damage/softening_linked.hpp"

namespace lode {

enum class TractionSurface { cuboid, cylinder, ovoid, coupled_cuboid, coupled_cylinder };

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

// What an explicit step (softening_explicit.hpp) leaves: the state with its cracking strains, and, at a UMAT point,
// B = d(strain)/dq.
template <int m, class Real>
struct ExplicitStep {
    CrackState<m, Real> crack;
    Mask<Real> fails;
    double B[m][m];
};

// `isotropic`: both shears have the same law and constants.
template <bool isotropic>
class SofteningCrack : public LinkedSoftening {
  public:
    // `steps`: by explicit steps, with SURF 0, 1, 2 of an isotropic crack.
    SofteningCrack(const SofteningLaw& normal, const SofteningLaw& shear, TractionSurface surface, double mix_I,
                   double mix_II, double friction, bool steps = false)
        : LinkedSoftening(normal, shear),
          surface_(surface),
          exponent_I_(mix_I),
          exponent_II_(mix_II),
          has_criterion_(mix_I > 0.0 && mix_II > 0.0 &&
                         (surface == TractionSurface::cuboid || surface == TractionSurface::cylinder)),
          friction_(friction),
          steps_(steps) {}

    TractionSurface surface() const { return surface_; }
    bool steps() const { return isotropic && steps_; }

    // Damage, delta and dissipated energies at the end, from those at the start, in the lanes `active`. Returns the
    // lanes that fail. The laws of shear are left as they are at the end (pressure).
    template <int m, class Real, class Pressure, class Rates>
    LODE_INLINE Mask<Real> damage(const Vector<Real, m>& q_old, const Vector<Real, m>& q_end, const Mask<Real>& active,
                                  Vector<SofteningDirection<Real>, m>& direction, const Pressure& pressure,
                                  CrackState<m, Real>& crack, Rates& rates, const SolveCounter<Real>& solves) const {
        Growth<m, Real> g;
        g.solves = solves;
        for (int j = 0; j < m; ++j) {
            g.start[j] = j == 0 ? positive_part(q_old[0]) : q_old[j];
            g.end[j] = j == 0 ? positive_part(q_end[0]) : q_end[j];
            g.enabled[j] = active && direction[j].enabled;
            g.d_old[j] = g.d[j] = crack.damage[j];
            if (isotropic && j == 2 && shares_shears()) copy_threshold(g);
            else set_threshold(direction[j], Real(crack.delta[j] * direction[j].inverse_length), j, g);
        }
        [[maybe_unused]] ShearStrength<Real> tau{};

        const bool single_group = m > 1 && surface_ == TractionSurface::ovoid;
        if (single_group) {
            if constexpr (has_pressure<Pressure> && m > 1) tau = grow_under_pressure(direction, pressure, g);
            else if constexpr (m > 1) grow_group<0, m>(direction, g);
        } else if (isotropic && m > 1 && is_coupled() && !is_linear()) {
            if constexpr (isotropic && m > 1 && !has_pressure<Pressure>) grow_coupled(direction, g);
        } else {
            grow_alone(0, direction, g);
            if constexpr (has_pressure<Pressure> && m > 1) {
                tau = pressure.strength(g.d[0] * g.end[0]);
                set_shear_strength(tau.value, direction, g);
            }
            grow_shears(direction, g);
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

    // The source's explicit step in the lanes `active`. By value, so that the crack of the caller stays in registers.
    template <int m, class Real>
    [[gnu::noinline, gnu::cold]] ExplicitStep<m, Real> explicit_step(
        Vector<Real, m> q_old, Vector<Real, m> q_end, CrackState<m, Real> crack, Mask<Real> active,
        Vector<SofteningDirection<Real>, m> direction) const;

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
                                          CrackState<m, Real>& crack, SolveCounter<Real> solves) const {
        const Real zero(0.0), one(1.0);
        const Mask<Real> failed = where && stage > Real(1.5), damaged = where && !failed;
        for (int j = 0; j < m; ++j) {
            const Mask<Real>& enabled = direction[j].enabled;
            const Real d = max(min(crack.damage[j], one), zero);
            const Mask<Real> solved = damaged && enabled && d > zero;
            const Real u = law(j).at_damage(d, direction[j].brittleness, zero, solved, solves).u;
            crack.damage[j] = select(failed, one, select(damaged, d, crack.damage[j]));
            crack.delta[j] = select(damaged && d > zero, u * direction[j].length, crack.delta[j]);
            crack.delta[j] = select(failed, law(j).end() * direction[j].length, crack.delta[j]);
            crack.delta[j] = select(where && !(enabled && (failed || d > zero)), zero, crack.delta[j]);
        }
    }

  private:
    TractionSurface surface_;
    double exponent_I_, exponent_II_;
    bool has_criterion_;
    double friction_;
    bool steps_;

    bool is_coupled() const {
        return surface_ == TractionSurface::coupled_cuboid || surface_ == TractionSurface::coupled_cylinder;
    }
    bool links_shears() const {
        return surface_ == TractionSurface::cylinder || surface_ == TractionSurface::coupled_cylinder;
    }
    bool shares_shears() const { return surface_ != TractionSurface::cuboid; }

    // The increment of damage in the making.
    template <int m, class Real>
    struct Growth {
        Vector<Real, m> start, end;               // effective strains, the normal one without its negative part
        Vector<Real, m> d_old, u_old, per_e_old;  // on the surface at the start; 1/e
        Vector<Real, m> f_old;                    // there, if `knows_f_old`
        bool knows_f_old = false;
        Vector<Real, m> d;
        Vector<Softened<Real>, m> at;                 // of the laws at the end, or at d_f if they fail
        Vector<Mask<Real>, m> enabled, grows, fails;  // `grows` includes `fails`
        Vector<Mask<Real>, m> sets;                   // SURF 3, 4: whose group sets the common damage
        [[no_unique_address]] SolveCounter<Real> solves;

        // 1/e at the end.
        LODE_INLINE Real per_e(int j, const SofteningDirection<Real>& direction) const {
            return direction.inverse_length / at[j].strain(direction.brittleness);
        }
    };

    // u and 1/e of the surface reached so far: e = delta/d, and eps0 without damage.
    template <int m, class Real>
    LODE_INLINE static void set_threshold(const SofteningDirection<Real>& direction, const Real& u, int j,
                                          Growth<m, Real>& g) {
        const Real zero(0.0), one(1.0);
        const Mask<Real> damaged = g.d_old[j] > zero && u > zero;
        g.u_old[j] = u;
        g.per_e_old[j] =
            direction.inverse_length * (select(damaged, g.d_old[j], one) / select(damaged, u, direction.brittleness));
        g.grows[j] = g.fails[j] = g.sets[j] = Mask<Real>(false);
        g.at[j] = {u, zero, zero};
    }
    // Both shears of an isotropic crack have one law at the same damage.
    template <int m, class Real>
    LODE_INLINE static void copy_threshold(Growth<m, Real>& g) {
        g.u_old[2] = g.u_old[1];
        g.f_old[2] = g.f_old[1];
        g.per_e_old[2] = g.per_e_old[1];
        g.grows[2] = g.fails[2] = g.sets[2] = g.grows[1];
        g.at[2] = g.at[1];
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
                g.u_old[j] = shear_law
                                 .at_damage(g.d_old[j], dir.brittleness, g.u_old[j],
                                            g.enabled[j] && g.d_old[j] > Real(0.0), g.solves)
                                 .u;
            const Real u = select(g.d_old[j] > Real(0.0), g.u_old[j], Real(0.0));
            g.u_old[j] = u;
            set_threshold(dir, u, j, g);
        }
    }

    // Section 5.1 for a direction with strain `eps`.
    template <int m, class Real>
    LODE_INLINE void grow_direction(int j, const Real& eps, const SofteningDirection<Real>& direction,
                                    Growth<m, Real>& g) const {
        const SofteningLaw& softening = law(j);
        const Mask<Real> grows = g.enabled[j] && eps * g.per_e_old[j] > Real(1.0 + softening_growth_tolerance);
        g.grows[j] = grows;
        if (!any(grows)) return;
        const Real x = eps * direction.inverse_length, r = direction.brittleness;
        const Mask<Real> fails = grows && x >= softening.end_strain(r);
        g.fails[j] = fails;
        Softened<Real> s = softening.at_strain(x, r, g.u_old[j], grows && !fails, g.solves);
        s.u = select(fails, Real(softening.end()), s.u);
        s.f = select(fails, Real(softening.end_value()), s.f);
        g.at[j] = s;
        g.d[j] = select(grows && !fails, max(min(Real(s.u / x), Real(1.0)), g.d_old[j]), g.d[j]);
    }
    template <int m, class Real>
    LODE_INLINE void grow_alone(int j, const Vector<SofteningDirection<Real>, m>& direction, Growth<m, Real>& g) const {
        grow_direction(j, Real(abs(g.end[j])), direction[j], g);
    }

    template <int m, class Real>
    LODE_INLINE void grow_shears(const Vector<SofteningDirection<Real>, m>& direction, Growth<m, Real>& g) const {
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
    }

    // SURF 3, 4 of an isotropic crack: the largest q/e of the normal direction and the shears is 1.
    template <int m, class Real>
    LODE_INLINE void grow_coupled(const Vector<SofteningDirection<Real>, m>& direction, Growth<m, Real>& g) const {
        const Real limit(1.0 + softening_growth_tolerance), y = abs(g.end[1]);
        Real z = Real(0.0), shear = y;
        if constexpr (m == 3) {
            z = abs(g.end[2]);
            shear = links_shears() ? sqrt(y * y + z * z) : max(y, z);
        }
        const Mask<Real> opens = g.enabled[0] && g.end[0] * g.per_e_old[0] > limit;
        const Mask<Real> slides = g.enabled[0] && shear * g.per_e_old[1] > limit;
        const Mask<Real> grows = opens || slides;
        if (!any(grows)) return;

        Linked<2, Real> l;
        l.x = {g.end[0] * direction[0].inverse_length, shear * direction[1].inverse_length};
        l.brittleness = {direction[0].brittleness, direction[1].brittleness};
        l.u = {g.u_old[0], g.u_old[1]};
        l.d = g.d_old[0];
        l.solves = g.solves;
        const Mask<Real> opens_fully = opens && l.x[0] >= normal_law.end_strain(l.brittleness[0]);
        const Real shear_end = shear_law.end_strain(l.brittleness[1]);
        const Mask<Real> fails = opens_fully || (slides && l.x[1] >= shear_end);
        l.active = grows && !fails;
        const Largest<Real> together = solve_largest(l);
        g.knows_f_old = true;
        const Mask<Real> solved = together.solved && together.d >= max(g.d_old[0], g.d_old[1]);
        // The first direction that fails, or the one that sets the damage.
        const Mask<Real> first = y >= z, y_fails = y * direction[1].inverse_length >= shear_end;
        g.sets[0] = select_mask(fails, opens_fully, together.first_leads);
        const Mask<Real> shears_set = !g.sets[0];
        if (m == 2 || links_shears()) {
            for (int j = 1; j < m; ++j) g.sets[j] = shears_set;
        } else {
            const Mask<Real> y_sets = select_mask(fails, y_fails, first);
            g.sets[1] = shears_set && y_sets;
            g.sets[m - 1] = shears_set && !y_sets;
        }
        for (int j = 0; j < m; ++j) {
            g.f_old[j] = together.f_start[j > 0 ? 1 : 0];
            g.fails[j] = fails && g.sets[j];
            g.grows[j] = g.fails[j] || l.active;
            g.d[j] = select(l.active, max(min(together.d, Real(1.0)), g.d_old[j]), g.d_old[j]);
            const Softened<Real>& at = together.at[j > 0 ? 1 : 0];
            g.at[j] = {select(fails, Real(law(j).end()), at.u), select(fails, Real(law(j).end_value()), at.f),
                       at.slope};
        }
        const Mask<Real> rest = l.active && !solved;
        if (any(rest)) [[unlikely]] {
            const Growth<m, Real> apart = grow_apart(direction, g, rest);
            for (int j = 0; j < m; ++j) {
                g.sets[j] = select_mask(rest, apart.sets[j], g.sets[j]);
                g.fails[j] = select_mask(rest, apart.fails[j], g.fails[j]);
                g.grows[j] = select_mask(rest, apart.grows[j], g.grows[j]);
                g.d[j] = select(rest, apart.d[j], g.d[j]);
                g.at[j] = choose(rest, apart.at[j], g.at[j]);
            }
        }
    }
    // The same direction by direction, in the lanes `where`.
    template <int m, class Real>
    [[gnu::noinline, gnu::cold]] Growth<m, Real> grow_apart(Vector<SofteningDirection<Real>, m> direction,
                                                            Growth<m, Real> g, Mask<Real> where) const {
        for (int j = 0; j < m; ++j) {
            g.enabled[j] = g.enabled[j] && where;
            g.grows[j] = g.fails[j] = g.sets[j] = Mask<Real>(false);
            g.d[j] = g.d_old[j];
        }
        grow_alone(0, direction, g);
        grow_shears(direction, g);
        couple(direction, g);
        return g;
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
                Real strain = abs(g.end[j]);
                if (merges && k == K - 1) strain = sqrt(g.end[1] * g.end[1] + g.end[2] * g.end[2]);
                linked.x[k] = strain * direction[j].inverse_length;
                linked.brittleness[k] = direction[j].brittleness;
                linked.u[k] = g.u_old[j];
                sum = sum + square(strain * g.per_e_old[j]);
            }
            linked.active = g.enabled[first] && sum > Real(1.0 + 2.0 * softening_growth_tolerance);
            g.grows[first] = linked.active;
            if (any(linked.active)) {
                linked.d = g.d_old[first];
                linked.solves = g.solves;
                linked = solve<first == 0>(linked);
                g.knows_f_old = !is_linear() && count == m;
                for (int k = 0; k < K; ++k) {
                    const int j = first + k;
                    g.f_old[j] = linked.f_start[k];
                    g.at[j] = linked.at[k];
                    g.grows[j] = linked.active;
                    g.fails[j] = linked.fails;
                    g.d[j] = select(linked.active && !linked.fails, max(min(linked.d, Real(1.0)), g.d_old[j]), g.d[j]);
                }
            }
        }
        if constexpr (merges) {
            g.f_old[2] = g.f_old[1];
            g.grows[2] = g.grows[1];
            g.fails[2] = g.fails[1];
            g.at[2] = g.at[1];
            g.d[2] = g.d[1];
        }
    }

    // SURF 2 with a shear strength that depends on pressure, which the crack itself relieves: P = P0 + K d <q_n>.
    template <int m, class Real>
    LODE_INLINE ShearStrength<Real> grow_under_pressure(Vector<SofteningDirection<Real>, m>& direction,
                                                        const CrackPressure<Real>& pressure, Growth<m, Real>& g) const {
        Real shear = abs(g.end[1]);
        if constexpr (m == 3) shear = sqrt(g.end[1] * g.end[1] + g.end[2] * g.end[2]);
        const UnderPressure<Real> step =
            solve_under_pressure(direction[0], direction[1], pressure, g.end[0], shear, g.d_old[0], g.per_e_old[0],
                                 g.u_old[0], g.u_old[1], g.enabled[0], g.solves);
        for (int j = 0; j < m; ++j) {
            g.f_old[j] = j == 0 ? step.normal_f_old : step.f_old;
            if (j > 0) {
                direction[j].set_strength(step.tau.value, direction[j].energy());
                if (j == 1) set_threshold(direction[j], step.u_old, j, g);
                else copy_threshold(g);
            }
            g.grows[j] = step.grows;
            g.fails[j] = step.fails;
            g.at[j] = j == 0 ? step.normal : step.shear;
            g.d[j] = select(step.grows && !step.fails, max(min(step.d, Real(1.0)), g.d_old[j]), g.d[j]);
        }
        g.knows_f_old = true;
        return step.tau;
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
            const Softened<Real> s = law(j).at_damage(d, direction[j].brittleness, g.u_old[j], needed, g.solves);
            if (j == 1) shears = s;
            g.at[j] = choose(follows, s, g.at[j]);
        }
    }

    // Section 5.3: dW_j = (w_old + w)/2 [Gbar(new) - Gbar(old)], and what is left at a failure.
    template <int m, class Real>
    LODE_INLINE void dissipate(const Vector<SofteningDirection<Real>, m>& direction, const Growth<m, Real>& g,
                               CrackState<m, Real>& crack) const {
        Vector<Real, m> w_old, w;
        for (int j = 0; j < m; ++j) w_old[j] = w[j] = Real(1.0);
        if (is_coupled()) {
            Real per_e = Real(0.0);
            for (int j = 0; j < m; ++j) {
                const Mask<Real>& sets = g.sets[j];
                if (!(isotropic && j == 2)) per_e = g.per_e(j, direction[j]);
                w_old[j] = select(sets, Real(1.0), min(square(Real(g.start[j] * g.per_e_old[j])), Real(1.0)));
                w[j] = select(sets, Real(1.0), square(Real(g.end[j] * per_e)));
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
        const bool shared = isotropic && m == 3 && shares_shears();
        Real released = Real(0.0);
        for (int j = 0; j < m; ++j) {
            const Mask<Real>& grows = g.grows[j];
            if (!any(shared && j == 1 ? grows || g.grows[m - 1] : grows)) continue;
            const SofteningDirection<Real>& dir = direction[j];
            const Softened<Real>& s = g.at[j];
            if (!(shared && j == 2)) {
                const Softened<Real> start{g.u_old[j], g.f_old[j], Real(0.0)};
                const Real omega_old = g.knows_f_old ? law(j).omega(start) : law(j).omega(start.u);
                released = dir.energy() * (law(j).omega(s) - omega_old);
            }
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
        Real aa = Real(0.0), ab = Real(0.0), bb = Real(0.0), sum = Real(0.0), per_e = Real(0.0);
        for (int j = first; j < first + count; ++j) {
            const Real& inverse = g.per_e_old[isotropic && j == 2 ? 1 : j];
            if (j == first || !(isotropic && j == 2)) per_e = g.per_e(j, direction[j]);
            a[j] = g.start[j] * inverse;
            b[j] = g.end[j] * inverse - a[j];
            aa = aa + a[j] * a[j];
            ab = ab + a[j] * b[j];
            bb = bb + b[j] * b[j];
            w[j] = square(Real(g.end[j] * per_e));
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
            double per_e[m] = {}, w[m] = {}, D = 0.0, rise = 0.0;  // 1/e, (q/e)^2; e (C + F')/Phi
            for (int j = first; j <= last; ++j) {
                const Softened<double>& s = g.at[j];
                const double r = direction[j].brittleness;
                const bool again = isotropic && m == 3 && j == 2 && j > first && shares_shears();
                per_e[j] = again ? per_e[j - 1] : g.per_e(j, direction[j]);
                if (!again) rise = s.strain(r) * (1.0 + r * s.slope) / (r * s.phi());
                w[j] = square(g.end[j] * per_e[j]);
                if (w[j] == 0.0) continue;
                if (!(s.phi() > 0.0)) return;
                D += w[j] * rise;
            }
            if constexpr (has_pressure<Pressure>)
                if (first == 0 && last > 0) {
                    // the shear strength follows the opening of the crack
                    const Softened<double>& s = g.at[1];
                    double shears = 0.0;
                    for (int j = 1; j <= last; ++j) shears += w[j];
                    const double by_tau = (s.f + s.u * s.slope) / (s.phi() * tau.value);
                    const double by_pressure = -shears * by_tau * tau.slope;  // dG/dP/2
                    D -= by_pressure * pressure.K * g.end[0];
                    for (int i = to_first; i <= to_last; ++i) {
                        rates.by_pressure[i] = by_pressure / D;
                        rates.by_strain[i][0] = by_pressure / D * pressure.K * g.d[0] * (g.end[0] > 0.0 ? 1.0 : 0.0);
                    }
                }
            const double inverse_D = 1.0 / D;
            for (int k = first; k <= last; ++k) {
                const double rate = g.end[k] * square(per_e[k]) * inverse_D;
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
                return group(j, pair ? m - 1 : j, 0, m - 1);
            }
            return;
        }
        if (g.grows[0]) group(0, 0, 0, 0);
        for (int j = 1; j < m; ++j) {
            if (!g.grows[j]) continue;
            const bool pair = m == 3 && links_shears();
            const int last = pair ? m - 1 : j;
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
