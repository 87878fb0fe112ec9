// What a crack obeys at one point: decohesion function, softening curve and the stiffness that an opening meets, for a
// given smearing length and analysis kind (page 80, 3.1, 3.4).
#pragma once

#include "lode/decohesive/decohesion_function.hpp"
#include "lode/elastic/isotropic_moduli.hpp"

namespace lode {

// C of a kind: C:e = E_2 (1:e) 1 + (E_1 - E_2) e. A bar has no lateral stress.
template <AnalysisKind kind>
struct KindStiffness {
    double E_1, E_2, twice_shear;
    explicit KindStiffness(const IsotropicModuli& m)
        : E_1(m.normal_stiffness<kind>()),
          E_2(kind == AnalysisKind::uniaxial ? 0.0 : m.coupling_stiffness<kind>()),
          twice_shear(E_1 - E_2) {}
};

struct CrackLaw {
    DecohesionConstants strength;
    bool exponential;
    double length;              // L_c
    double u_0;                 // opening at failure
    double inverse_u;           // 1/u_0 (linear), 1/u_c (exponential)
    double A_n, A_t, A_p, A_s;  // stress taken off by a unit opening (n) or sliding (s)
    double kappa;               // 2G/(tau_sf^2 L_c)
    double mu;

    static constexpr double exponential_end = 6.907755278982137;  // ln 1000: u_0 in units of u_c

    // `strength` is that of this point (a large element may have lowered tau_nf).
    template <AnalysisKind kind>
    CrackLaw(const DecohesionConstants& strength_, bool exponential_, double G_f, double friction,
             double element_length, const IsotropicModuli& m, const KindStiffness<kind>& c)
        : strength(strength_), exponential(exponential_), length(element_length), mu(friction) {
        const double inverse_length = 1.0 / length;
        const double u_c = G_f * strength.inverse_tau_nf;
        u_0 = exponential ? u_c * exponential_end : 2.0 * u_c;
        inverse_u = 1.0 / (exponential ? u_c : u_0);
        A_n = c.E_1 * inverse_length;
        A_t = c.E_2 * inverse_length;
        A_p = kind == AnalysisKind::plane_stress ? 0.0 : A_t;
        A_s = m.shear * inverse_length;
        kappa = 2.0 * A_s * strength.inverse_tau_sf_square;
    }

    // f of an opening up to u_0, without the drop of the exponential law at its end.
    template <class Real>
    Real softening(const Real& u) const {
        if (exponential) return exp(-inverse_u * u);
        return 1.0 - inverse_u * u;
    }
    // df/du, from f.
    template <class Real>
    Real slope(const Real& f) const {
        if (exponential) return -inverse_u * f;
        return Real(-inverse_u);
    }
    // Integral of f over the opening from u to u + x.
    template <class Real>
    Real area(const Real& u, const Real& x) const {
        if (exponential) return (softening(u) - softening(Real(u + x))) * (1.0 / inverse_u);
        return x * (1.0 - inverse_u * (u + 0.5 * x));
    }

    // Stresses after the opening has grown by x.
    template <class Real>
    PlaneStresses<Real> opened(const PlaneStresses<Real>& s, const Real& x) const {
        return {s.n - A_n * x, s.t, s.p, s.tt - A_t * x, s.pp - A_p * x, s.tp};
    }
};

}  // namespace lode
