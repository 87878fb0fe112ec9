// The decohesion function F_n(sigma, [[u]]) of the plane with normal n, with first and second derivatives (page
// 80, 3.2; Sanchez, 3.5.49-3.5.57), extended linearly where the source's turns back (8.1).
#pragma once

#include "lode/numerics/scalar.hpp"

namespace lode {

// F within this of zero, or below, is elastic.
inline constexpr double decohesion_tolerance = 1e-10;

// Stress in the frame {n, t, p} of a plane: traction tau_n, tau_t, tau_p; stresses in the plane tt, pp, tp.
template <class Real>
struct PlaneStresses {
    Real n, t, p, tt, pp, tp;
};

struct DecohesionConstants {
    double tau_nf, tau_sf, f_c;  // strengths in tension, shear and uniaxial compression
    double chi, C;               // (f_c/f_b)^2 - 2, (tau_sf/tau_sm)^2
    double C_n, C_s, C_psi;      // couplings
    bool rankine;                // F = tau_n/tau_nf - f
    double inverse_tau_nf, inverse_tau_sf_square, inverse_f_c_square, inverse_C;

    void set_inverses() {
        inverse_tau_nf = 1.0 / tau_nf;
        inverse_tau_sf_square = 1.0 / (tau_sf * tau_sf);
        inverse_f_c_square = 1.0 / (f_c * f_c);
        inverse_C = 1.0 / C;
    }
};

// F and, up to the order asked for, its derivatives by stresses and softening function f, and those of N = dF/dtau_n.
// With respect to the shears only tau_s^2/tau_sf^2 counts: F = tau_s^2/tau_sf^2 - Phi.
template <class Real>
struct Decohesion {
    Real B, Phi;
    Real B_n, B_tt, B_pp, B_f;        // order 1, of B
    Real N, F_tt, F_pp, F_tp, F_f;    // order 1
    Real N_n, N_tt, N_pp, N_tp, N_f;  // order 2
};

template <int order, class Real>
LODE_INLINE Decohesion<Real> evaluate_decohesion(const DecohesionConstants& k, const PlaneStresses<Real>& s,
                                                 const Real& f) {
    Decohesion<Real> d;
    const Real a = k.inverse_tau_nf * s.n;
    const Real I = (k.inverse_tau_nf * (1.0 / 3.0)) * (s.n + s.tt + s.pp);
    // m(2 - I), bounded below by 1/2
    Real m = 2.0 - I, m1 = Real(1.0), m2 = Real(0.0);
    if (I > Real(1.0)) {
        const Real inverse = 1.0 / (I - 0.5);
        m = 0.5 + 0.25 * inverse;
        m1 = 0.25 * inverse * inverse;
        m2 = 2.0 * m1 * inverse;
    }
    const Real inverse_m = 1.0 / m;
    const Real sum = s.tt + s.pp;
    const Real q = k.inverse_f_c_square * (sum * sum - (2.0 - k.chi) * (s.tt * s.pp - s.tp * s.tp));
    const Real S = f * q;
    const Real K = 1.0 + a * (inverse_m + k.C_n);
    d.B = a + S * K - f;
    const Real inverse_Z = 1.0 / (1.0 + k.C_s * S);
    const Real beta = d.B * inverse_Z;
    const Real psi = -k.C * beta;

    // Phi = tanh(psi (1 + C_psi psi))/C, linear for psi < 0; H = -dPhi/dbeta
    Real H = Real(1.0), H_b = Real(0.0), slope = Real(0.0), tanh_g = Real(0.0), sech2 = Real(0.0);
    if (psi < Real(0.0)) {
        d.Phi = k.inverse_C * psi;
    } else {
        const Real g = psi * (1.0 + k.C_psi * psi);
        Real e = Real(0.0), e_less_1 = Real(-1.0);  // exp(-2g), beyond 300 nothing is left of it
        if (g < Real(0.25)) {
            e_less_1 = expm1(-2.0 * g);
            e = 1.0 + e_less_1;
        } else if (g <= Real(300.0)) {
            e = exp(-2.0 * g);
            e_less_1 = e - 1.0;
        }
        const Real inverse = 1.0 / (1.0 + e);
        tanh_g = -e_less_1 * inverse;
        sech2 = 4.0 * e * inverse * inverse;
        d.Phi = k.inverse_C * tanh_g;
        slope = 1.0 + 2.0 * k.C_psi * psi;
        H = slope * sech2;
    }
    if constexpr (order >= 1) {
        const Real a_m = a * m1 * inverse_m * inverse_m * (1.0 / 3.0);  // m1 a/(3 m^2)
        const Real e = k.inverse_tau_nf * S * a_m;
        const Real L = inverse_m + k.C_n + a_m;
        const Real D_s = K - k.C_s * beta;
        const Real q_tt = k.inverse_f_c_square * (2.0 * s.tt + k.chi * s.pp);
        const Real q_pp = k.inverse_f_c_square * (2.0 * s.pp + k.chi * s.tt);
        const Real q_tp = (2.0 * (2.0 - k.chi) * k.inverse_f_c_square) * s.tp;
        d.B_n = k.inverse_tau_nf * (1.0 + S * L);
        d.B_tt = f * K * q_tt + e;
        d.B_pp = f * K * q_pp + e;
        d.B_f = q * K - 1.0;
        const Real beta_n = inverse_Z * d.B_n;
        const Real beta_tt = inverse_Z * (f * D_s * q_tt + e);
        const Real beta_pp = inverse_Z * (f * D_s * q_pp + e);
        const Real beta_tp = inverse_Z * (f * D_s * q_tp);
        const Real beta_f = inverse_Z * (q * D_s - 1.0);
        d.N = H * beta_n;
        d.F_tt = H * beta_tt;
        d.F_pp = H * beta_pp;
        d.F_tp = H * beta_tp;
        d.F_f = H * beta_f;
        if constexpr (order >= 2) {
            if (psi >= Real(0.0)) H_b = (-k.C) * (2.0 * k.C_psi - 2.0 * slope * slope * tanh_g) * sech2;
            const Real curvature = inverse_m * inverse_m * (m1 - a * (1.0 / 3.0) * (m2 - 2.0 * m1 * m1 * inverse_m));
            const Real L_mean = (k.inverse_tau_nf * (1.0 / 3.0)) * curvature;
            const Real L_n = (k.inverse_tau_nf * (1.0 / 3.0)) * m1 * inverse_m * inverse_m + L_mean;
            const auto second = [&](const Real& beta_y, const Real& S_y, const Real& L_y) {
                const Real beta_ny = inverse_Z * (k.inverse_tau_nf * (S_y * L + S * L_y) - k.C_s * (beta_n * S_y));
                return Real(H * beta_ny + H_b * (beta_n * beta_y));
            };
            d.N_n = second(beta_n, Real(0.0), L_n);
            d.N_tt = second(beta_tt, f * q_tt, L_mean);
            d.N_pp = second(beta_pp, f * q_pp, L_mean);
            d.N_tp = second(beta_tp, f * q_tp, Real(0.0));
            d.N_f = second(beta_f, q, Real(0.0));
        }
    }
    return d;
}

// F itself; f = 1: of a virgin plane.
template <class Real>
inline Real decohesion(const DecohesionConstants& k, const PlaneStresses<Real>& s, const Real& f) {
    if (k.rankine) return k.inverse_tau_nf * s.n - f;
    return k.inverse_tau_sf_square * (s.t * s.t + s.p * s.p) - evaluate_decohesion<0>(k, s, f).Phi;
}

}  // namespace lode
