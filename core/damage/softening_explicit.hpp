// The incremental update of the source (Nairn, 5.6.1 to 5.6.3, special theory) in place of the exact one: the strain
// beyond the surface, found by scaling the traction at the start, damages the crack at the rates of the start, (5.41)
// and (5.91), and the cracking strain is summed up, (5.9). First order; what is summed up may leave the surface. The
// next growth takes such a traction back, but never by more than the increment itself: a small one does not make it
// jump.
//
// With n the unit vector of T_j/F_j on the surface, x_j = T_j/F_j of the trial traction and e_j = F_j/(C_j (1 - d_j)),
//     dd = n.(x - n)/sum n_j^2 e_j (C_j + F_j')/Phi_j,   d delta_j = C_j e_j^2/Phi_j dd,
//     dEC_j = d_j dq_j + n_j e_j dd.
#pragma once

#include "lode/damage/softening_crack.hpp"

namespace lode {

template <bool isotropic>
template <int m, class Real>
ExplicitStep<m, Real> SofteningCrack<isotropic>::explicit_step(Vector<Real, m> q_old, Vector<Real, m> q_end,
                                                               CrackState<m, Real> crack, Mask<Real> active,
                                                               Vector<SofteningDirection<Real>, m> direction) const {
    const Real zero(0.0), one(1.0);
    ExplicitStep<m, Real> step;
    Growth<m, Real> g;
    Vector<Softened<Real>, m> s;
    Vector<Real, m> e, t, x, change = crack.strain;
    [[maybe_unused]] Vector<double, m> follows, weight;  // e dx/dq; e (C + F')/Phi
    for (int j = 0; j < m; ++j) {
        const SofteningDirection<Real>& dir = direction[j];
        g.start[j] = j == 0 ? positive_part(q_old[0]) : q_old[j];
        g.end[j] = j == 0 ? positive_part(q_end[0]) : q_end[j];
        g.enabled[j] = active && dir.enabled;
        g.grows[j] = g.fails[j] = Mask<Real>(false);
        s[j] = law(j).at(Real(crack.delta[j] / dir.length));
        e[j] = dir.length * s[j].strain(dir.brittleness);
        t[j] = (g.start[j] - crack.strain[j]) / (dir.length * dir.brittleness * s[j].f);
        x[j] = t[j] + (g.end[j] - g.start[j]) / e[j];
        // Where the crack closes the trial traction is zero but for rounding, whose sign says nothing.
        if (j == 0) t[0] = positive_part(t[0]), x[0] = select(g.end[0] > zero, positive_part(x[0]), zero);
        t[j] = select(g.enabled[j], t[j], zero);
        x[j] = select(g.enabled[j], x[j], zero);
        change[j] = crack.damage[j] * (g.end[j] - g.start[j]);
        if constexpr (std::is_same_v<Real, double>) {
            const bool counts = j > 0 || q_end[0] > 0.0;
            follows[j] = counts && x[j] != 0.0 ? 1.0 : 0.0;
            for (int k = 0; k < m; ++k) step.B[j][k] = j == k && counts ? crack.damage[j] : 0.0;
        }
    }

    const auto grow = [&](int first, int last) {
        Real start_square = zero, end_square = zero, change_square = zero, along_square = zero, along = zero;
        Vector<Real, m> n = t;
        // A crack that closes is damaged by its shears alone.
        if (first == 0) n[0] = select(x[0] > zero, t[0], zero);
        for (int j = first; j <= last; ++j) {
            start_square = start_square + square(t[j]);
            end_square = end_square + square(x[j]);
            change_square = change_square + square(x[j] - t[j]);
            along_square = along_square + square(n[j]);
            along = along + n[j] * x[j];
        }
        // A traction that stays beyond the surface damages no further.
        const Real reach = (1.0 + 2.0 * softening_growth_tolerance) * max(start_square, one);
        const Mask<Real> grows = g.enabled[first] && end_square > reach;
        if (!any(grows)) return;
        // Along the trial traction where there is none at the start, or another way.
        const Real size = sqrt(max(end_square, Real(1e-300))), start = sqrt(max(along_square, Real(1e-300)));
        const Mask<Real> from_start = along_square > Real(1e-12) && along > start;
        const Real beyond = select(from_start, along / start, size) - 1.0, limit = 2.0 * sqrt(change_square);
        const Real excess = min(beyond, limit);
        Real D = zero;
        for (int j = first; j <= last; ++j) {
            const Real r = direction[j].brittleness;
            n[j] = select(from_start, n[j] / start, x[j] / size);
            const Real kappa = s[j].strain(r) * (1.0 + r * s[j].slope) / (r * max(s[j].phi(), Real(1e-300)));
            D = D + square(n[j]) * kappa;
            if constexpr (std::is_same_v<Real, double>) weight[j] = kappa;
        }
        const Real growth = excess / select(grows, D, one);  // dd
        Mask<Real> fails = Mask<Real>(false);
        Vector<Real, m> u;
        for (int j = first; j <= last; ++j) {
            const Real r = direction[j].brittleness;
            u[j] = s[j].u + growth * square(s[j].strain(r)) / (r * max(s[j].phi(), Real(1e-300)));
            fails = fails || (grows && u[j] >= Real(law(j).end()));
        }
        for (int j = first; j <= last; ++j) {
            const SofteningDirection<Real>& dir = direction[j];
            u[j] = select(fails, Real(law(j).end()), select(grows, u[j], s[j].u));
            const Softened<Real> at = law(j).at(u[j]);
            const Real strain = at.strain(dir.brittleness),
                       rest = select(fails, 0.5 * law(j).end_value() * strain, zero);
            const Real work =
                square(n[j]) * dir.energy() * (positive_part(law(j).omega(u[j]) - law(j).omega(s[j].u)) + rest);
            crack.dissipated[j] = select(grows, crack.dissipated[j] + work, crack.dissipated[j]);
            crack.delta[j] = select(grows, u[j] * dir.length, crack.delta[j]);
            crack.damage[j] = select(grows, max(crack.damage[j], min(Real(u[j] / strain), one)), crack.damage[j]);
            change[j] = select(grows, change[j] + n[j] * e[j] * growth, change[j]);
            g.grows[j] = grows;
            g.fails[j] = fails;
        }
        if constexpr (std::is_same_v<Real, double>) {
            for (int k = first; k <= last; ++k) {
                const double turn = from_start ? 0.0 : growth / size, rate = follows[k] / e[k];
                const double slope = beyond <= limit ? n[k] : 4.0 * (x[k] - t[k]) / limit;
                const double by_size = (slope - 2.0 * turn * n[k] * (weight[k] - D)) / D;
                for (int j = first; j <= last; ++j)
                    step.B[j][k] += rate * e[j] * (n[j] * by_size + turn * ((j == k ? 1.0 : 0.0) - n[j] * n[k]));
            }
        }
    };
    if (m > 1 && surface_ == TractionSurface::ovoid) {
        grow(0, m - 1);
    } else {
        grow(0, 0);
        if (m == 3 && links_shears()) {
            grow(1, 2);
        } else {
            for (int j = 1; j < m; ++j) grow(j, j);
        }
    }

    Mask<Real> grows = g.grows[0];
    step.fails = g.fails[0];
    for (int j = 1; j < m; ++j) grows = grows || g.grows[j], step.fails = step.fails || g.fails[j];
    if (has_criterion_) step.fails = step.fails || (grows && criterion(direction, crack) >= one);
    if (any(step.fails)) fail(step.fails, direction, g, crack);

    for (int j = 0; j < m; ++j) crack.strain[j] = select(active, crack.strain[j] + change[j], crack.strain[j]);
    // The opening of a crack is neither negative nor more than the strain across it.
    if constexpr (std::is_same_v<Real, double>) {
        const bool low = !(crack.strain[0] > 0.0 && q_end[0] > 0.0);
        if (low || crack.strain[0] > q_end[0])
            for (int k = 0; k < m; ++k) step.B[0][k] = k == 0 && !low ? 1.0 : 0.0;
    }
    crack.strain[0] = select(active, max(min(crack.strain[0], g.end[0]), zero), crack.strain[0]);
    step.crack = crack;
    return step;
}

}  // namespace lode
