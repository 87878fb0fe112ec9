// The pressure-dependent hyperelastic law of CAM_CLAY (page 70, "Constitutive equations"), in the invariants
// v = -tr(eps^e) (compaction positive) and s = sqrt(2/3) |dev eps^e|:
//   W = p_ref kappa X + 3/2 mu s^2,   X = exp(v/kappa),   A = p_ref X,   mu = mu0 + alpha A
//   p = dW/dv = A (1 + c s^2),   q = dW/ds = 3 mu s,   c = 3 alpha/(2 kappa).
#pragma once

#include "lode/numerics/functions.hpp"

namespace lode {

struct CamClayElasticity {
    double p_ref, kappa, mu0, alpha;
    double inverse_kappa, c;

    CamClayElasticity(double reference_pressure, double compressibility, double constant_shear, double coupling)
        : p_ref(reference_pressure),
          kappa(compressibility),
          mu0(constant_shear),
          alpha(coupling),
          inverse_kappa(1.0 / compressibility),
          c(1.5 * coupling / compressibility) {}

    // A, the pressure without its shear-coupled part.
    template <class Real>
    Real volumetric_pressure(const Real& v) const {
        return p_ref * quick_exp(Real(v * inverse_kappa));
    }
    template <class Real>
    Real shear_modulus(const Real& A) const {
        return mu0 + alpha * A;
    }
    template <class Real>
    Real pressure(const Real& A, const Real& s) const {
        return A + c * A * s * s;
    }
    template <class Real>
    Real energy(const Real& A, const Real& s) const {
        return kappa * A + 1.5 * shear_modulus(A) * s * s;
    }
    // W_vs. The other second derivatives are W_vv = p/kappa and W_ss = 3 mu.
    template <class Real>
    Real coupling_modulus(const Real& A, const Real& s) const {
        return (3.0 * alpha * inverse_kappa) * A * s;
    }
    // D > 0 is the same as a positive definite Hessian of W.
    template <class Real>
    Real convexity(const Real& A, const Real& s) const {
        const Real z = c * s * s;
        return mu0 * (1.0 + z) + alpha * A * (1.0 - z);
    }

    // Finds (v, s) that carry the stress (p, q), p > 0; false if no elastic strain does ("Initial state", 3).
    bool invert(double p, double q, double& v, double& s) const {
        const double target = c * q * q / 9.0;
        double y = 1.0;  // beta = p/A, from psi(y) = (y - 1)(mu0 + alpha p/y)^2 - c q^2/9 = 0
        bool found = target == 0.0;
        // psi is concave, so Newton's iterates rise to the root, or past the maximum of psi where there is none.
        for (int iteration = 0; iteration < 100 && !found; ++iteration) {
            const double mu = mu0 + alpha * p / y;
            const double slope = mu * (mu - 2.0 * (y - 1.0) * alpha * p / (y * y));
            if (!(slope > 0.0)) return false;
            const double step = (target - (y - 1.0) * mu * mu) / slope;
            y += step;
            found = step <= 4.0 * std::numeric_limits<double>::epsilon() * y;
        }
        const double A = p / y;
        v = kappa * log(A / p_ref);
        s = q / (3.0 * shear_modulus(A));
        return found;
    }
};

}  // namespace lode
