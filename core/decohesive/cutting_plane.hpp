// One crack by the cutting plane of the source (page 80, 4, INTEG = 1; Sanchez, 4.5, with the page's corrections).
#pragma once

#include "lode/decohesive/crack_return.hpp"

namespace lode {

// The jump of a crack of opening u from the stress `start`, all quantities at the current iterate; false where the
// plane through it does not lead back to the surface.
template <class Real>
bool cutting_plane(const CrackLaw& law, const PlaneStresses<Real>& start, const Real& u, bool has_failed,
                   CrackJump<Real>& d, const SolveCounter<Real>& solves) {
    d = CrackJump<Real>::none();
    const DecohesionConstants& k = law.strength;
    const Real x_f = law.u_0 - u;
    if (!has_failed && x_f > Real(0.0)) {
        PlaneStresses<Real> s = start;
        for (int iteration = 0;; ++iteration) {
            const Real f = law.softening(Real(u + d.n));
            if (!(decohesion(k, s, f) > Real(decohesion_tolerance))) return true;
            if (iteration == 100) return false;
            solves.count(1);
            d.response = CrackResponse::softening;
            Real N(k.inverse_tau_nf), F = decohesion(k, s, f), F_f(-1.0), along = law.A_n * N, shear = Real(0.0);
            double sliding = 0.0;
            if (!k.rankine) {
                const auto e = evaluate_decohesion<1>(k, s, f);
                N = e.N;
                F_f = e.F_f;
                along = law.A_n * N + law.A_t * e.F_tt + law.A_p * e.F_pp;
                sliding = 2.0 * k.inverse_tau_sf_square;
                shear = (sliding * sliding * law.A_s) * (s.t * s.t + s.p * s.p);
            }
            const Real F_omega = F_f * law.slope(f) * N - N * along - shear;
            if (!(F_omega < Real(0.0))) return false;
            const Real omega = -F / F_omega;
            const Real x = omega * N, t = omega * sliding * s.t, p = omega * sliding * s.p;
            d.n = d.n + x;
            d.t = d.t + t;
            d.p = d.p + p;
            d.omega = d.omega + omega;
            if (!(d.n < x_f)) break;
            s = law.opened(s, x);
            s.t = s.t - law.A_s * t;
            s.p = s.p - law.A_s * p;
        }
    }
    d = crack_return_detail::failed(law, start, x_f);
    return true;
}

}  // namespace lode
