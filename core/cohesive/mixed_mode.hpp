// Methods 1 to 3 of page 40: the two modes are damaged together and stay on the surface
//     F(u; dn, dt) = (<u_n>/dn)^2 + (u_t/dt)^2 = 1                                                     (7.18)
// coupled by equal damage (methods 1 and 2) or by a return normal to the evolved surface (method 3). For methods 1 and
// 3 the integrated form is exact (section 4.1): the damage at the end of a straight path is the root of F at its end.
#pragma once

#include <array>

#include "lode/cohesive/interface.hpp"
#include "lode/cohesive/strength_law.hpp"
#include "lode/numerics/root.hpp"

namespace lode {

enum class MixedMode { equal_damage = 1, explicit_rate = 2, normal_return = 3 };

// Gauss-Legendre points and weights on [0, 1]; `count` = 0 stands for the trapezoid rule of 7.15.
struct GaussPoints {
    int count = 0;
    std::array<double, 8> x{}, w{};

    explicit GaussPoints(int n) : count(n) {
        for (int i = 0; i < n; ++i) {
            // Newton's method on the Legendre polynomial
            double z = std::cos(3.14159265358979323846 * (i + 0.75) / (n + 0.5)), derivative = 1.0;
            for (int iteration = 0; iteration < 20; ++iteration) {
                double p = 1.0, before = 0.0;
                for (int j = 0; j < n; ++j) {
                    const double older = before;
                    before = p;
                    p = ((2.0 * j + 1.0) * z * before - j * older) / (j + 1.0);
                }
                derivative = n * (z * p - before) / (z * z - 1.0);
                z -= p / derivative;
            }
            const auto k = static_cast<std::size_t>(i);
            x[k] = 0.5 * (1.0 - z);
            w[k] = 1.0 / ((1.0 - z * z) * derivative * derivative);
        }
    }
};

template <class NormalLaw, class ShearLaw>
struct CoupledInterface {
    NormalLaw normal;
    ShearLaw shear;
    MixedMode method;
    bool compression_couples;  // shear damage in compression damages mode I too
    int substeps;              // of method 2
    GaussPoints gauss;
    Contact contact;
    double thickness, inverse_thickness;
    double end_n = 0.0, end_t = 0.0;  // dn, dt where the zone fails, from a virgin interface

    void set_end() {
        const auto [dn, dt] = ends(0.0, 0.0, 0.0);
        end_n = dn;
        end_t = dt;
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        namespace index = interface_state;
        using Path = SeparationPath<kind, Real>;
        const Real zero(0.0), one(1.0);
        const State<Real>& state = point.state;
        const Path path(increment, state, thickness);
        Surface<Real> old{max(state[index::dn], Real(normal.elastic_limit)),
                          max(state[index::dt], Real(shear.elastic_limit))};
        const Mask<Real> failed_before = state[index::Dn] >= one && state[index::Dt] >= one;
        const Real un = Path::opening(path.end), ut = Path::sliding(path.end);

        InterfaceResult<kind, Real> result;
        result.dn = old.dn;
        result.dt = old.dt;
        result.GI = state[index::GI];
        result.GII = state[index::GII];
        result.Gdrop = state[index::Gdrop];
        result.failed = failed_before;

        // 2. inside the surface nothing happens
        const Mask<Real> loads = old.value(un, ut) > Real(1.0 + surface_tolerance) && !failed_before;
        Mask<Real> by_shear_alone(false);
        if (any(loads)) {
            // 3. under pressure mode I may stay as it is
            if (!compression_couples) by_shear_alone = loads && path.end[0] <= zero;
            if (any(by_shear_alone)) shear_alone(ut, by_shear_alone, result);
            const Mask<Real> together = loads && !by_shear_alone;
            if (any(together)) {
                if (method == MixedMode::explicit_rate) explicit_update(path, old, together, result, point.solves);
                else exact_update(path, old, un, ut, together, result, point.solves);
            }
        }

        const Real largest_damage(1.0 - 0.5 * std::numeric_limits<double>::epsilon());
        Real intact_n = normal.integrity(result.dn), intact_t = shear.integrity(result.dt);
        if (endless()) {
            intact_n = select(intact_n > Real(2.0 * smallest_integrity), intact_n, zero);
            intact_t = select(intact_t > Real(2.0 * smallest_integrity), intact_t, zero);
        }
        result.normal_damage = select(result.failed, one, min(1.0 - intact_n, largest_damage));
        result.shear_damage = select(result.failed, one, min(1.0 - intact_t, largest_damage));
        result.normal_stiffness = select(result.failed, zero, normal.stiffness * intact_n);
        result.shear_stiffness = select(result.failed, zero, shear.stiffness * intact_t);
        if (!result.finish(path, contact, inverse_thickness, point)) return;

        if constexpr (wants_tangent<T>) {
            constexpr int n = components(kind);
            const auto& u = path.end;
            for (int i = 0; i < n * n; ++i) tangent.stiffness[i] = 0.0;
            tangent(0, 0) = thickness * result.secant(u[0], contact);
            for (int i = 1; i < n; ++i) tangent(i, i) = thickness * result.shear_stiffness;
            if (loads && !result.failed) set_loading_tangent<kind>(u, un, ut, by_shear_alone, result, tangent);
        }
    }

  private:
    static constexpr double smallest_integrity = 1e-200;
    static constexpr double surface_tolerance = 1e-12;  // of F: rounding on the surface is not loading
    bool endless() const { return !std::isfinite(normal.end); }

    // dn and dt; numbers of any size, also 0 for a law without elastic range: 0/0 = 0 there.
    template <class Real>
    struct Surface {
        Real dn, dt;

        static Real relative(const Real& u, const Real& delta) {
            return min(u / max(delta, Real(1e-150)), Real(1e100));
        }
        Real value(const Real& un, const Real& ut) const { return square(relative(un, dn)) + square(relative(ut, dt)); }
    };

    // The quantity that grows (or falls) in both modes alike: 1 - D, or Psi for the normal return.
    template <class Law, class Real>
    Real coordinate(const Law& law, const Real& delta) const {
        return method == MixedMode::normal_return ? law.psi(delta) : law.integrity(delta);
    }
    template <class Law, class Real>
    Real at_coordinate(const Law& law, const Real& c) const {
        if (method == MixedMode::normal_return) {
            const Real most = law.psi(Real(law.end));
            return select(c >= most, Real(law.end), law.opening_at(min(max(c, Real(0.0)), most)));
        }
        // A law without end is followed as far as numbers go.
        const double least = std::isfinite(law.end) ? law.end_integrity : smallest_integrity;
        const Real delta = law.opening(min(max(c, Real(max(least, smallest_integrity))), Real(1.0)));
        return std::isfinite(law.end) ? select(c <= Real(least), Real(law.end), delta) : delta;
    }
    // c = d(delta)/dz
    template <class Law, class Real>
    Real rate(const Law& law, const Real& delta) const {
        const Real R = damage_rate(law, delta);
        if (method != MixedMode::normal_return) return 1.0 / R;
        // S phi/delta = k^2 q delta^2 R
        const Real strength = law.stiffness * delta;
        return 1.0 / max(law.integrity(delta) * square(strength) * R, Real(1e-300));
    }

    // z_t - z_n: 0 but for what shear under pressure has done alone, or for damage that the host has set.
    template <class Real>
    Real offset_of(const Surface<Real>& old) const {
        const Real cn = coordinate(normal, old.dn), ct = coordinate(shear, old.dt);
        const Real noise = 1e-12 * max(max(abs(cn), abs(ct)), noise_scale(old));
        return select(abs(ct - cn) > noise, ct - cn, Real(0.0));
    }
    template <class Real>
    Real noise_scale(const Surface<Real>& old) const {
        if (method == MixedMode::normal_return) return min(normal.psi(Real(normal.end)), shear.psi(Real(shear.end)));
        return max(damage_rate(normal, old.dn) * old.dn, damage_rate(shear, old.dt) * old.dt);
    }
    template <class Real>
    Real partner_of_normal(const Real& dn, const Real& offset) const {
        return at_coordinate(shear, coordinate(normal, dn) + offset);
    }
    template <class Real>
    Real partner_of_shear(const Real& dt, const Real& offset) const {
        return at_coordinate(normal, coordinate(shear, dt) - offset);
    }

    // 4. where the zone ends: the first of the laws to end; never before dn, dt.
    template <class Real>
    Surface<Real> ends(const Real& offset, const Real& dn, const Real& dt) const {
        if (method == MixedMode::normal_return) {
            const Real most_n = normal.psi(Real(normal.end)), most_t = shear.psi(Real(shear.end));
            const Real psi_n = min(most_n, most_t - offset);
            return {max(at_coordinate(normal, psi_n), dn), max(at_coordinate(shear, min(psi_n + offset, most_t)), dt)};
        }
        const Real q = max(Real(normal.end_integrity), shear.end_integrity - offset);
        return {max(at_coordinate(normal, q), dn), max(at_coordinate(shear, q + offset), dt)};
    }

    // Where the path leaves the ellipse (dn, dt) that it starts in, 0 <= s <= 1.
    template <class Path, class Real>
    static Real leaves(const Path& path, const Surface<Real>& surface) {
        const Real zero(0.0), one(1.0), smallest(1e-300);
        const Real in = 1.0 / max(surface.dn, Real(1e-150)), it = 1.0 / max(surface.dt, Real(1e-150));
        const Real dn = path.change[0] * in, un = path.start[0] * in;
        Real size = max(one, abs(dn));
        for (int i = 1; i < Path::n; ++i) size = max(size, abs(path.change[i]) * it);
        const Real unit = 1.0 / size;
        Real a(0.0), b(0.0), c(-1.0);
        for (int i = 1; i < Path::n; ++i) {
            const Real d = path.change[i] * it * unit, u = path.start[i] * it;
            a = a + d * d;
            b = b + u * d;
            c = c + u * u;
        }
        const auto exit = [&](const Real& A, const Real& B, const Real& C) {
            const Real root = sqrt(max(B * B - A * C, zero));
            const Real s = select(B > zero, -C / max(B + root, smallest), (root - B) / max(A, smallest));
            return min(max(s * unit, zero), one);
        };
        const Real with_opening = exit(a + square(dn * unit), b + un * dn * unit, c + un * un);
        const Mask<Real> closed = path.start[0] < zero || path.end[0] < zero;
        if (!any(closed)) return with_opening;
        const Real sliding = exit(a, b, c);
        const Mask<Real> accept = closed && a > zero && path.start[0] + sliding * path.change[0] <= zero;
        return select(accept, sliding, with_opening);
    }

    // <u_n>/dn and u_t/dt, squared, at s of the path.
    template <class Path, class Real>
    static void shares(const Path& path, const Real& s, const Surface<Real>& surface, Real& share_n, Real& share_t) {
        const auto u = path.at(s);
        share_n = square(Surface<Real>::relative(Path::opening(u), surface.dn));
        share_t = square(Surface<Real>::relative(Path::sliding(u), surface.dt));
    }

    template <AnalysisKind kind, class Real>
    void shear_alone(const Real& ut, const Mask<Real>& where, InterfaceResult<kind, Real>& result) const {
        const Real end(shear.end), dt = min(ut, end);
        const Mask<Real> fails = where && ut >= end;
        result.GII =
            result.GII + select(where, shear.released_energy(dt) - shear.released_energy(result.dt), Real(0.0));
        result.dt = select(where, dt, result.dt);
        result.failed = result.failed || fails;
        if (any(fails)) {
            const Real stored = shear.end_integrity * shear.stiffness * square(dt);
            result.Gdrop = result.Gdrop + select(fails, 0.5 * stored, Real(0.0));
        }
    }

    template <AnalysisKind kind, class Real>
    void exact_update(const SeparationPath<kind, Real>& path, const Surface<Real>& old, const Real& un, const Real& ut,
                      const Mask<Real>& loads, InterfaceResult<kind, Real>& result,
                      const SolveCounter<Real>& solves) const {
        const Real one(1.0);
        const Real offset = offset_of(old);
        Surface<Real> end{Real(end_n), Real(end_t)};
        if (any(offset != Real(0.0))) end = ends(offset, old.dn, old.dt);
        const Mask<Real> at_end = loads && end.value(un, ut) >= one, fails = at_end && Mask<Real>(!endless());
        const Mask<Real> inside = loads && !at_end;
        Surface<Real> now{select(loads, end.dn, old.dn), select(loads, end.dt, old.dt)};
        if (any(inside)) {
            const Surface<Real> root = on_surface(un, ut, old, end, offset, inside, solves);
            now.dn = select(inside, max(root.dn, old.dn), now.dn);
            now.dt = select(inside, max(root.dt, old.dt), now.dt);
        }
        add_released(path, old, now, offset, loads, fails, result);
        result.dn = select(loads, now.dn, result.dn);
        result.dt = select(loads, now.dt, result.dt);
        result.failed = result.failed || fails;
    }

    // 5. the dn, dt of the curve from `old` to `end` on whose ellipse (un, ut) is
    template <class Real>
    Surface<Real> on_surface(const Real& un, const Real& ut, const Surface<Real>& old, const Surface<Real>& end,
                             const Real& offset, const Mask<Real>& active, const SolveCounter<Real>& solves) const {
        if constexpr (std::is_same_v<NormalLaw, Sawtooth> && std::is_same_v<ShearLaw, Sawtooth>) {
            if (method == MixedMode::equal_damage) {
                // 1/delta = c + e q makes F = 1 a quadratic in q
                const Real an = un * normal.inverse_end, bn = un * normal.inverse_fall();
                const Real bt = ut * shear.inverse_fall(), at = ut * shear.inverse_end + bt * offset;
                const Real ab = an * bn + at * bt, bb = bn * bn + bt * bt, rest = 1.0 - an * an - at * at;
                const Real root = sqrt(max(ab * ab + bb * rest, Real(0.0)));
                const Real q = select(ab > Real(0.0), rest / (ab + root), (root - ab) / bb);
                const Real sound = select(active, q, Real(1.0));
                return {normal.opening(sound), shear.opening(sound + offset)};
            }
        }
        if constexpr (std::is_same_v<NormalLaw, StrengthLaw>) {
            const bool needleman = normal.code() == 3 && shear.code() == 3 && method == MixedMode::equal_damage;
            if (needleman && all(offset == Real(0.0))) {
                const Real y = sqrt(square(un * normal.inverse_end) + square(ut * shear.inverse_end));
                return {normal.end * y, shear.end * y};
            }
            // Near the virgin state only Needleman's law knows its damage precisely.
            if (shear.code() == 3 && normal.code() != 3) {
                const Surface<Real> swapped =
                    follow(shear, normal, ut, un, {old.dt, old.dn}, {end.dt, end.dn}, -offset, active, solves);
                return {swapped.dt, swapped.dn};
            }
        }
        return follow(normal, shear, un, ut, old, end, offset, active, solves);
    }

    // Newton's method on sqrt(F) - 1 with the delta of one mode (`first`, the dn of the surfaces here) as unknown.
    template <class First, class Second, class Real>
    Surface<Real> follow(const First& first, const Second& second, const Real& u1, const Real& u2,
                         const Surface<Real>& old, const Surface<Real>& end, const Real& offset,
                         const Mask<Real>& active, const SolveCounter<Real>& solves) const {
        const auto partner = [&](const Real& d1) {
            return max(at_coordinate(second, coordinate(first, d1) + offset), old.dt);
        };
        const auto reversed = [&](const Real& d2) {
            return at_coordinate(first, coordinate(second, min(max(d2, old.dt), Real(second.end))) - offset);
        };
        const auto residual = [&](const Real& d1) {
            const Real d2 = partner(d1), safe1 = max(d1, Real(1e-150)), safe2 = max(d2, Real(1e-150));
            const Real part1 = square(u1 / safe1), part2 = square(u2 / safe2), root = sqrt(part1 + part2);
            const Real ratio = rate(second, d2) / rate(first, d1);
            return Residual<Real>{root - 1.0, -(part1 / safe1 + part2 / safe2 * ratio) / root};
        };
        // In each mode alone the surface would be here: F >= 1.
        const Real start = max(max(old.dn, u1), reversed(u2));
        const Real most = max(end.dn, old.dn);
        const auto root =
            solve_bracketed<Slope::decreasing>(residual, old.dn, most, min(start, most), Real(1e-14), active);
        solves.count(root);
        const Real x = root.x;
        const Real d2 = partner(x);
        if (method == MixedMode::equal_damage) return {x, d2};
        // Near failure the partner may move far while this mode hardly does: then the ellipse knows it better.
        const Real part1 = square(u1 / max(x, Real(1e-150))), part2 = square(u2 / max(d2, Real(1e-150)));
        const Mask<Real> fast =
            active && part1 < Real(1.0) && part2 * x * rate(second, d2) > part1 * d2 * rate(first, x);
        return {x, select(fast, max(u2 / sqrt(max(1.0 - part1, Real(1e-150))), old.dt), d2)};
    }

    // 6. the energies of the way from `old` to `now`, and what drops at failure (4.4)
    template <AnalysisKind kind, class Real>
    void add_released(const SeparationPath<kind, Real>& path, const Surface<Real>& old, const Surface<Real>& now,
                      const Real& offset, const Mask<Real>& loads, const Mask<Real>& fails,
                      InterfaceResult<kind, Real>& result) const {
        const Real zero(0.0), one(1.0);
        Real GI(0.0), GII(0.0), share_n, share_t;
        if (gauss.count == 0) {
            const Real s_end = select(fails, leaves(path, now), one);
            trapezoid(path, leaves(path, old), s_end, old, now, GI, GII);
        } else {
            const double break_n = break_point(normal), break_t = break_point(shear);
            const auto integrate = [&](Real from, const Real& to, const Real& first_break, const Real& second_break,
                                       const auto& integrand) {
                Real sum(0.0);
                const Real breaks[3] = {min(first_break, second_break), max(first_break, second_break), to};
                for (int piece = 0; piece < 3; ++piece) {
                    if ((piece == 0 && (break_n == 0.0 || break_t == 0.0)) ||
                        (piece == 1 && break_n == 0.0 && break_t == 0.0))
                        continue;
                    const Real until = min(max(breaks[piece], from), to), length = until - from;
                    for (int g = 0; g < gauss.count; ++g) {
                        const auto k = static_cast<std::size_t>(g);
                        sum = sum + gauss.w[k] * length * integrand(from + gauss.x[k] * length);
                    }
                    from = until;
                }
                return sum;
            };
            const Real bn(break_n), bt(break_t);
            const Real mapped_n = break_t > 0.0 ? partner_of_shear(bt, offset) : zero;
            const Real mapped_t = break_n > 0.0 ? partner_of_normal(bn, offset) : zero;
            GI = integrate(old.dn, now.dn, bn, mapped_n, [&](const Real& dn) {
                const Surface<Real> at{dn, partner_of_normal(dn, offset)};
                shares(path, leaves(path, at), at, share_n, share_t);
                return share_n * normal.release_rate(dn);
            });
            GII = integrate(old.dt, now.dt, mapped_t, bt, [&](const Real& dt) {
                const Surface<Real> at{partner_of_shear(dt, offset), dt};
                shares(path, leaves(path, at), at, share_n, share_t);
                return share_t * shear.release_rate(dt);
            });
        }
        result.GI = result.GI + select(loads, GI, zero);
        result.GII = result.GII + select(loads, GII, zero);
        if (any(fails)) add_drop(path, now, fails, result);
    }

    // The trapezoid rule of 7.15 step 7 between two points of the path.
    template <class Path, class Real>
    void trapezoid(const Path& path, const Real& s0, const Real& s1, const Surface<Real>& old, const Surface<Real>& now,
                   Real& GI, Real& GII) const {
        const Real zero(0.0);
        Real n0, t0, n1, t1;
        shares(path, s0, old, n0, t0);
        shares(path, s1, now, n1, t1);
        const Real first_n = select(old.dn > zero, n0 * normal.release_rate(old.dn), zero);
        const Real first_t = select(old.dt > zero, t0 * shear.release_rate(old.dt), zero);
        GI = 0.5 * (first_n + n1 * normal.release_rate(now.dn)) * (now.dn - old.dn);
        GII = 0.5 * (first_t + t1 * shear.release_rate(now.dt)) * (now.dt - old.dt);
    }

    // The elastic energy that is left where the zone fails.
    template <AnalysisKind kind, class Real>
    void add_drop(const SeparationPath<kind, Real>& path, const Surface<Real>& now, const Mask<Real>& fails,
                  InterfaceResult<kind, Real>& result) const {
        using Path = SeparationPath<kind, Real>;
        const auto u = path.at(leaves(path, now));
        const Real stored = normal.stiffness * max(normal.integrity(now.dn), Real(0.0)) * square(Path::opening(u)) +
                            shear.stiffness * max(shear.integrity(now.dt), Real(0.0)) * square(Path::sliding(u));
        result.Gdrop = result.Gdrop + select(fails, 0.5 * stored, Real(0.0));
    }

    // Method 2, section 4.3: the rate form with what is known at the start of each substep.
    template <AnalysisKind kind, class Real>
    void explicit_update(const SeparationPath<kind, Real>& path, const Surface<Real>& old, const Mask<Real>& loads,
                         InterfaceResult<kind, Real>& result, const SolveCounter<Real>& solves) const {
        using Path = SeparationPath<kind, Real>;
        const Real zero(0.0), one(1.0);
        const Real offset = offset_of(old);
        const Mask<Real> outside = old.value(Path::opening(path.start), Path::sliding(path.start)) >= one;
        const Real s0 = select(outside, zero, leaves(path, old)), step = (one - s0) * (1.0 / substeps);
        const Surface<Real> end = ends(offset, old.dn, old.dt);
        Surface<Real> now = old;
        Mask<Real> failed(false);
        solves.count_substeps(substeps);
        for (int i = 0; i < substeps; ++i) {
            const Real s = s0 + double(i) * step;
            const auto u = path.at(s);
            const Real un = Path::opening(u), ut = Path::sliding(u);
            const Real in = 1.0 / now.dn, it = 1.0 / now.dt;
            Real along(0.0);
            for (int j = 1; j < Path::n; ++j) along = along + u[j] * path.change[j];
            const Real N = step * (un * path.change[0] * in * in + along * it * it);
            const Real Rn = damage_rate(normal, now.dn), Rt = damage_rate(shear, now.dt);
            const Real H = un * un * in * in * in / Rn + ut * ut * it * it * it / Rt;
            const Mask<Real> grows = loads && !failed && N > zero;
            if (!any(grows)) continue;

            // the variable whose step is the safer one
            const Real dD = N / H, an = Rn * reach(normal), at = Rt * reach(shear);
            const Real q_n = normal.integrity(min(now.dn + dD / Rn, end.dn));
            const Real q_t = shear.integrity(min(now.dt + dD / Rt, end.dt)) - offset;
            const Real q = select(max(an, at) < one, normal.integrity(now.dn) - dD, select(an > at, q_n, q_t));
            const Surface<Real> next{max(at_coordinate(normal, q), now.dn),
                                     max(at_coordinate(shear, q + offset), now.dt)};
            const Mask<Real> at_end = grows && (next.dn >= end.dn || next.dt >= end.dt);
            const Mask<Real> fails = at_end && Mask<Real>(!endless());
            const Surface<Real> reached{select(at_end, end.dn, select(grows, next.dn, now.dn)),
                                        select(at_end, end.dt, select(grows, next.dt, now.dt))};
            Real GI, GII;
            trapezoid(path, s, select(fails, max(leaves(path, reached), s), s + step), now, reached, GI, GII);
            result.GI = result.GI + select(grows, GI, zero);
            result.GII = result.GII + select(grows, GII, zero);
            if (any(fails)) add_drop(path, reached, fails, result);
            failed = failed || fails;
            now = reached;
        }
        result.dn = select(loads, now.dn, result.dn);
        result.dt = select(loads, now.dt, result.dt);
        result.failed = result.failed || failed;
    }
    // u_c, or the scale of a law that has none.
    template <class Law>
    static double reach(const Law& law) {
        return std::isfinite(law.end) ? law.end
                                      : law.toughness / (law.stiffness * law.elastic_limit) + 0.5 * law.elastic_limit;
    }

    // Section 5, with the values at the end.
    template <AnalysisKind kind>
    void set_loading_tangent(const Vector<double, components(kind)>& u, double un, double ut, bool by_shear_alone,
                             const InterfaceResult<kind, double>& result, Tangent<kind>& tangent) const {
        constexpr int n = components(kind);
        if (by_shear_alone) {
            const double change = thickness * (shear.slope(result.dt) - result.shear_stiffness) / (ut * ut);
            for (int j = 1; j < n; ++j)
                for (int i = 1; i < n; ++i) tangent(i, j) += change * u[i] * u[j];
            return;
        }
        const double in = 1.0 / result.dn, it = 1.0 / result.dt;
        const double cn = rate(normal, result.dn), ct = rate(shear, result.dt);
        const double H = un * un * cn * in * in * in + ut * ut * ct * it * it * it;
        const double fn = normal.stiffness * damage_rate(normal, result.dn) * cn;
        const double ft = shear.stiffness * damage_rate(shear, result.dt) * ct;
        double dz[n];
        dz[0] = un * in * in / H;
        for (int i = 1; i < n; ++i) dz[i] = u[i] * it * it / H;
        const bool normal_row = u[0] >= 0.0 || contact.option == 2;
        for (int j = 0; j < n; ++j) {
            if (normal_row) tangent(0, j) -= thickness * fn * u[0] * dz[j];
            for (int i = 1; i < n; ++i) tangent(i, j) -= thickness * ft * u[i] * dz[j];
        }
    }
};

}  // namespace lode
