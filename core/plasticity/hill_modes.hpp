// Elasticity and Hill's matrix of a material in the modes that diagonalise both (page 20, section 5, step 2): C = B B^T
// and A = W^T d W with W = B^-1. Made once per material and kind. With y = W sigma_trial the backward Euler stress for
// a multiplier mu is sigma = B [y_i/(1 + mu d_i)]. The shears are modes of their own: y = tau, d = G A.
#pragma once

#include "lode/elastic/orthotropic_moduli.hpp"
#include "lode/plasticity/hill_criterion.hpp"
#include "lode/tensor/eigen.hpp"
#include "lode/tensor/voigt_matrix.hpp"

namespace lode {

template <AnalysisKind kind>
struct HillModes {
    static constexpr int n = components(kind), normals = normal_components(kind);
    // Two normal modes can yield; the third of three components, in place 2, cannot.
    static constexpr int yielding = 2 + shear_components(kind);
    // Place of the k-th mode that can yield among the components.
    static constexpr int place(int k) { return k < 2 ? k : normals + k - 2; }

    double C[normals][normals], A[normals][normals];  // plane stress: C the inverse of the reduced compliance
    double B[normals][normals], W[normals][normals];
    double shear_C[n - normals], shear_A[n - normals];
    double largest_d = 0.0;
    double ratio[yielding];   // d/largest d; 1 for a mode that never yields
    double active[yielding];  // 1, or 0 for a mode that never yields
    double smallest_ratio = 1.0;
    double weight[yielding];  // h^2 = sum weight y^2/(1 + mu d)^2: d, or A of a shear
    // sqrt(2/3) |dep| = mu sqrt(sum rate_ij z_i z_j), z = y/(1 + mu d): (2/3) B^T AZA B and, of the shears, A^2/3
    double rate_00, rate_01, rate_11, shear_rate[n - normals];
    double thickness_A[2], thickness_S[2];  // plane stress: rows 33 of A and of the compliance

    HillModes(const OrthotropicModuli& elastic, const HillCriterion& hill) {
        set_stiffness(elastic);
        for (int i = 0; i < normals; ++i)
            for (int j = 0; j < normals; ++j) A[i][j] = hill.normal(i, j);
        for (int s = 0; s < n - normals; ++s) {
            const auto at = static_cast<std::size_t>(s);
            shear_C[s] = elastic.shear[at];
            shear_A[s] = hill.shear[at];
            shear_rate[s] = shear_A[s] * shear_A[s] / 3.0;
        }
        for (int j = 0; j < 2; ++j) thickness_A[j] = hill.normal(2, j), thickness_S[j] = elastic.compliance(2, j);
        set_modes(hill);
    }

    // C eps.
    template <class Real>
    LODE_INLINE Stress<kind, Real> stress(const Strain<kind, Real>& e) const {
        Stress<kind, Real> s;
        for (int i = 0; i < normals; ++i) {
            s[i] = C[i][0] * e[0];
            for (int j = 1; j < normals; ++j) s[i] = s[i] + C[i][j] * e[j];
        }
        for (int i = normals; i < n; ++i) s[i] = shear_C[i - normals] * e[i];
        return s;
    }
    // W sigma, and B z; shears stay.
    template <class Real>
    LODE_INLINE Stress<kind, Real> to_modes(const Stress<kind, Real>& s) const {
        return multiply(W, s);
    }
    template <class Real>
    LODE_INLINE Stress<kind, Real> from_modes(const Stress<kind, Real>& z) const {
        return multiply(B, z);
    }
    // A sigma: engineering shears.
    template <class Real>
    LODE_INLINE Strain<kind, Real> flow(const Stress<kind, Real>& s) const {
        Strain<kind, Real> f;
        for (int i = 0; i < normals; ++i) {
            f[i] = A[i][0] * s[0];
            for (int j = 1; j < normals; ++j) f[i] = f[i] + A[i][j] * s[j];
        }
        for (int i = normals; i < n; ++i) f[i] = shear_A[i - normals] * s[i];
        return f;
    }
    // sigma : S sigma/2 of z = W sigma.
    template <class Real>
    LODE_INLINE Real energy(const Stress<kind, Real>& z) const {
        Real sum = z[0] * z[0];
        for (int i = 1; i < normals; ++i) sum = sum + z[i] * z[i];
        for (int i = normals; i < n; ++i) sum = sum + (1.0 / shear_C[i - normals]) * (z[i] * z[i]);
        return 0.5 * sum;
    }

    void set_stiffness(VoigtMatrix<kind, double>& c) const {
        c.m.fill(0.0);
        for (int i = 0; i < normals; ++i)
            for (int j = 0; j < normals; ++j) c(i, j) = C[i][j];
        for (int i = normals; i < n; ++i) c(i, i) = shear_C[i - normals];
    }

  private:
    template <class Real>
    LODE_INLINE static Stress<kind, Real> multiply(const double (&m)[normals][normals], const Stress<kind, Real>& s) {
        Stress<kind, Real> r = s;
        for (int i = 0; i < normals; ++i) {
            r[i] = m[i][0] * s[0];
            for (int j = 1; j < normals; ++j) r[i] = r[i] + m[i][j] * s[j];
        }
        return r;
    }

    void set_stiffness(const OrthotropicModuli& elastic) {
        if constexpr (kind == AnalysisKind::plane_stress) {
            const auto& S = elastic.compliance;
            const double inverse = 1.0 / (S(0, 0) * S(1, 1) - S(0, 1) * S(1, 0));
            C[0][0] = inverse * S(1, 1);
            C[1][1] = inverse * S(0, 0);
            C[0][1] = C[1][0] = -inverse * S(0, 1);
        } else {
            for (int i = 0; i < normals; ++i)
                for (int j = 0; j < normals; ++j) C[i][j] = elastic.stiffness(i, j);
        }
    }

    // C = L L^T; L^T A L V = V d; B = L V, W = V^T L^-1.
    void set_modes(const HillCriterion& hill) {
        double L[normals][normals] = {}, inverse[normals][normals] = {};
        for (int j = 0; j < normals; ++j)
            for (int i = j; i < normals; ++i) {
                double sum = C[i][j];
                for (int k = 0; k < j; ++k) sum -= L[i][k] * L[j][k];
                L[i][j] = i == j ? std::sqrt(sum) : sum / L[j][j];
            }
        for (int j = 0; j < normals; ++j)
            for (int i = j; i < normals; ++i) {
                double sum = i == j ? 1.0 : 0.0;
                for (int k = j; k < i; ++k) sum -= L[i][k] * inverse[k][j];
                inverse[i][j] = sum / L[i][i];
            }
        Matrix3<double> product{};
        for (int i = 0; i < normals; ++i)
            for (int j = 0; j < normals; ++j)
                for (int k = 0; k < normals; ++k)
                    for (int l = 0; l < normals; ++l) product(i, j) += L[k][i] * A[k][l] * L[l][j];
        const auto eigen = symmetric_eigen(product);
        // The mode that cannot yield comes last.
        int order[3] = {0, 1, 2};
        if constexpr (normals == 3)
            std::sort(order, order + 3, [&](int a, int b) { return eigen.values[a] > eigen.values[b]; });

        double d[yielding];
        for (int k = 0; k < normals; ++k) {
            for (int i = 0; i < normals; ++i) {
                B[i][k] = W[k][i] = 0.0;
                for (int j = 0; j < normals; ++j) {
                    B[i][k] += L[i][j] * eigen.vectors(j, order[k]);
                    W[k][i] += eigen.vectors(j, order[k]) * inverse[j][i];
                }
            }
            if (k < 2) d[k] = eigen.values[order[k]];
        }
        for (int s = 0; s < n - normals; ++s) d[2 + s] = shear_C[s] * shear_A[s];
        for (const double x : d) largest_d = std::max(largest_d, x);
        for (int k = 0; k < yielding; ++k) {
            const bool yields = largest_d > 0.0 && d[k] >= 1e-12 * largest_d;
            active[k] = yields ? 1.0 : 0.0;
            ratio[k] = yields ? d[k] / largest_d : 1.0;
            smallest_ratio = std::min(smallest_ratio, ratio[k]);
            weight[k] = !yields ? 0.0 : k < 2 ? d[k] : shear_A[k - 2];
        }
        if (largest_d == 0.0) largest_d = 1.0;

        // A Z A of the whole matrix A: in plane stress the thickness strain counts as well.
        double AB[3][2] = {};
        for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 2; ++k)
                for (int j = 0; j < normals; ++j) AB[i][k] += hill.normal(i, j) * B[j][k];
        const auto rate = [&](int k, int l) {
            return 2.0 / 3.0 * (AB[0][k] * AB[0][l] + AB[1][k] * AB[1][l] + AB[2][k] * AB[2][l]);
        };
        rate_00 = active[0] * rate(0, 0);
        rate_01 = active[0] * active[1] * rate(0, 1);
        rate_11 = active[1] * rate(1, 1);
    }
};

}  // namespace lode
