// Orthotropic linear elasticity in material axes: engineering constants, stiffness and compliance (page 10, sections 3
// and 4; Nairn, eqs. 1.1-1.3). Shared by all models that are elastically orthotropic or transversely isotropic; how
// the axes lie in the host's is material_axes.hpp and rotated_moduli.hpp.
#pragma once

#include "lode/material/properties.hpp"
#include "lode/tensor/eigen.hpp"
#include "lode/tensor/matrix3.hpp"
#include "lode/tensor/voigt_matrix.hpp"

namespace lode {

// Young's moduli, Poisson's ratios nu_ij = -eps_j/eps_i under sigma_i, shear moduli, in the order of all PROPS lists.
struct OrthotropicConstants {
    double E1, E2, E3, nu12, nu13, nu23, G12, G13, G23;
};

struct OrthotropicModuli {
    // sigma_i = stiffness(i, j) eps_j of the normal components, eps = compliance sigma; both symmetric.
    Matrix3<double> stiffness, compliance;
    std::array<double, 3> shear;  // G12, G13, G23: UMAT places 4, 5, 6

    // PROPS(first) ... PROPS(first + 8) in the order of OrthotropicConstants, refused unless positive definite. The
    // description's ranges see to E, G > 0.
    static OrthotropicModuli from_properties(const Properties& p, int first) {
        const auto at = [&](int i) { return p[first + i]; };
        const OrthotropicConstants c{at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7), at(8)};
        const double products[] = {product(c.nu12, c.E1, c.E2), product(c.nu13, c.E1, c.E3),
                                   product(c.nu23, c.E2, c.E3)};
        const double ratios[] = {c.E1 / c.E2, c.E1 / c.E3, c.E2 / c.E3};
        for (int i = 0; i < 3; ++i)
            if (!(products[i] < 1.0))
                p.refuse(first + 3 + i, "below " + format_number(std::sqrt(ratios[i])) +
                                            " in magnitude: nu_ij nu_ji = " + format_number(products[i]) + " < 1");
        const double D = discriminant(c);
        if (!(D > 0.0))
            p.refuse("PROPS(" + std::to_string(first + 3) + ".." + std::to_string(first + 5) +
                     "): the stiffness is not positive definite, 1 - nu12 nu21 - nu13 nu31 - nu23 nu32 - 2 nu12 nu23 "
                     "nu31 = " +
                     format_number(D) + " must be > 0");
        return from_constants(c);
    }

    static OrthotropicModuli from_constants(const OrthotropicConstants& c) {
        const double nu21 = c.nu12 * c.E2 / c.E1, nu31 = c.nu13 * c.E3 / c.E1, nu32 = c.nu23 * c.E3 / c.E2;
        const double inverse_D = 1.0 / discriminant(c);
        OrthotropicModuli m;
        set_symmetric(m.stiffness, c.E1 * (1.0 - c.nu23 * nu32) * inverse_D, c.E2 * (1.0 - c.nu13 * nu31) * inverse_D,
                      c.E3 * (1.0 - c.nu12 * nu21) * inverse_D, c.E2 * (c.nu12 + c.nu13 * nu32) * inverse_D,
                      c.E3 * (c.nu13 + c.nu12 * c.nu23) * inverse_D, c.E3 * (c.nu23 + nu21 * c.nu13) * inverse_D);
        set_symmetric(m.compliance, 1.0 / c.E1, 1.0 / c.E2, 1.0 / c.E3, -c.nu12 / c.E1, -c.nu13 / c.E1, -c.nu23 / c.E2);
        m.shear = {c.G12, c.G13, c.G23};
        return m;
    }

    // PROPS(first) ... PROPS(first + 4) = EA, ET, nuA, nuT, GA; `axis` 1, 2, 3 is the axial direction. Refused unless
    // the plane-strain bulk modulus KT is positive.
    static OrthotropicModuli transversely_isotropic(const Properties& p, int first, int axis) {
        const double EA = p[first], ET = p[first + 1], nuA = p[first + 2], nuT = p[first + 3], GA = p[first + 4];
        const double limit = (1.0 - nuT) * EA / (2.0 * ET);
        if (!(nuA * nuA < limit)) p.refuse(first + 2, "below " + format_number(std::sqrt(limit)) + " in magnitude");
        return transversely_isotropic(EA, ET, nuA, nuT, GA, axis);
    }
    static OrthotropicModuli transversely_isotropic(double EA, double ET, double nuA, double nuT, double GA, int axis) {
        const double GT = ET / (2.0 * (1.0 + nuT)), KT = 0.5 / ((1.0 - nuT) / ET - 2.0 * nuA * nuA / EA);
        const int a = axis - 1;
        OrthotropicModuli m;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                const bool axial_i = i == a, axial_j = j == a;
                if (axial_i && axial_j) m.stiffness(i, j) = EA + 4.0 * KT * nuA * nuA, m.compliance(i, j) = 1.0 / EA;
                else if (axial_i || axial_j) m.stiffness(i, j) = 2.0 * KT * nuA, m.compliance(i, j) = -nuA / EA;
                else if (i == j) m.stiffness(i, j) = KT + GT, m.compliance(i, j) = 1.0 / ET;
                else m.stiffness(i, j) = KT - GT, m.compliance(i, j) = -nuT / ET;
            }
        m.shear = {axis == 3 ? GT : GA, axis == 2 ? GT : GA, axis == 1 ? GT : GA};
        return m;
    }

    // C and S as 6x6 matrices; columns of C and rows of S are engineering strains.
    VoigtMatrix<AnalysisKind::solid, double> stiffness_matrix() const {
        return assemble(stiffness, shear[0], shear[1], shear[2]);
    }
    VoigtMatrix<AnalysisKind::solid, double> compliance_matrix() const {
        return assemble(compliance, 1.0 / shear[0], 1.0 / shear[1], 1.0 / shear[2]);
    }

    // Bound of rho c^2 over all directions and modes: the largest eigenvalue of the Mandel form diag(1, 1, 1, sqrt2,
    // ...) C diag(...), whose shear part is diagonal.
    double wave_modulus() const {
        double largest = 2.0 * std::max({shear[0], shear[1], shear[2]});
        const auto eigen = symmetric_eigen(stiffness);
        for (int i = 0; i < 3; ++i) largest = std::max(largest, eigen.values[i]);
        return largest;
    }

  private:
    // nu_ij nu_ji
    static double product(double nu, double Ei, double Ej) { return nu * nu * Ej / Ei; }
    static double discriminant(const OrthotropicConstants& c) {
        return 1.0 - product(c.nu12, c.E1, c.E2) - product(c.nu13, c.E1, c.E3) - product(c.nu23, c.E2, c.E3) -
               2.0 * c.nu12 * c.nu23 * c.nu13 * c.E3 / c.E1;
    }
    static void set_symmetric(Matrix3<double>& m, double m11, double m22, double m33, double m12, double m13,
                              double m23) {
        m.m = {m11, m12, m13, m12, m22, m23, m13, m23, m33};
    }
    static VoigtMatrix<AnalysisKind::solid, double> assemble(const Matrix3<double>& normal, double s12, double s13,
                                                             double s23) {
        VoigtMatrix<AnalysisKind::solid, double> c;
        c.m.fill(0.0);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) c(i, j) = normal(i, j);
        c(3, 3) = s12, c(4, 4) = s13, c(5, 5) = s23;
        return c;
    }
};

}  // namespace lode
