// The Drucker-Prager cone, and its fits to Mohr-Coulomb's friction and dilation angles (page 20, section 4).
#pragma once

#include "lode/material/properties.hpp"
#include "lode/tensor/rotation.hpp"

namespace lode::drucker_prager {

// Phi = q - eta p - xi c(alpha), Psi = q - eta_bar p, dalpha = xi lambda; q = sqrt(J2).
struct Cone {
    double eta, eta_bar, xi;

    // PROPS(fit) ... PROPS(fit + 2) = FIT, FRIC, DILA; PROPS(factor) = XI. Throws BadProperty.
    static Cone from_properties(const Properties& p, int fit, int factor) {
        const int friction = fit + 1, dilation = fit + 2;
        if (p.code(fit) != 0 && p[friction] >= 90.0) p.refuse(friction, "in [0, 90) degrees");
        if (p[dilation] > p[friction])
            p.refuse(dilation, "in [0, " + format_number(p[friction]) +
                                   "]: the plastic power is negative where dilation exceeds friction");
        if (p.code(fit) == 0) return {p[friction], p[dilation], p[factor]};
        Cone cone;
        double unused;
        set_fit(p.code(fit), p[friction], cone.eta, cone.xi);
        set_fit(p.code(fit), p[dilation], cone.eta_bar, unused);
        return cone;
    }

  private:
    // 1 outer cone, through the compression corners of Mohr-Coulomb; 2 inner, the extension corners; 3 plane strain.
    static void set_fit(int fit, double degrees, double& eta, double& xi) {
        double cosine, sine;
        cosine_and_sine(degrees, cosine, sine);
        const double denominator = fit == 3 ? std::sqrt(9.0 * cosine * cosine + 12.0 * sine * sine)
                                            : 0.5 * std::sqrt(3.0) * (fit == 1 ? 3.0 - sine : 3.0 + sine);
        eta = 3.0 * sine / denominator;
        xi = 3.0 * cosine / denominator;
    }
};

}  // namespace lode::drucker_prager
