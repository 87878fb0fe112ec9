// DDSDDE of a solid with one crack (page 30, section 6).
#pragma once

#include "lode/damage/softening_axes.hpp"

namespace lode {

// What the tangent needs to know of a crack: d(EC_a) = B_ab dq_b + pressure_a d(tr eps), and the stiffness vectors
// C_a m_a, with q_a = m_a . eps.
template <AnalysisKind kind>
struct CrackLinearisation {
    static constexpr int m = crack_directions(kind), n = components(kind);
    Stress<kind, double> stiffness[m];
    double compliance[m];  // 1/C_a
    double B[m][m];
    double pressure[m] = {};

    // d(EC)/dq from the damage and its rates; dP0 = -K d(tr eps).
    void set_damaged(const Vector<double, m>& q, const Vector<double, m>& damage, const DamageRates<m>& rates,
                     double K) {
        for (int a = 0; a < m; ++a) {
            const double strain = a == 0 ? positive_part(q[0]) : q[a];
            for (int b = 0; b < m; ++b) B[a][b] = strain * rates.by_strain[a][b];
            B[a][a] += a == 0 && !(q[0] > 0.0) ? 0.0 : damage[a];
            pressure[a] = -K * strain * rates.by_pressure[a];
        }
    }

    // C - M Cd B M^T; `tangent` holds C on entry.
    LODE_INLINE void apply(Tangent<kind>& tangent) const {
        double scaled[m][m];
        for (int a = 0; a < m; ++a)
            for (int b = 0; b < m; ++b) scaled[a][b] = B[a][b] * compliance[b];
        for (int j = 0; j < n; ++j) {
            double change[m];
            for (int a = 0; a < m; ++a) {
                change[a] = j < normal_components(kind) ? pressure[a] : 0.0;
                for (int b = 0; b < m; ++b) change[a] += scaled[a][b] * stiffness[b][j];
            }
            for (int i = 0; i < n; ++i)
                for (int a = 0; a < m; ++a) tangent(i, j) -= stiffness[a][i] * change[a];
        }
    }

    // The same in the increment in which the crack forms, while its axes turn with the strain (T.9): for a unit strain
    // j dN = a T + b Z, dT = -a N + c Z with (a, b, c) = spin[j], W = R^T dR,
    //     dT_crack = R^T dsigma R + T_crack W - W T_crack,
    //     dsigma = C deps - C : R (W E - E W + dE) R^T,
    // T_crack the trial stress and E the cracking strain in crack axes.
    [[gnu::noinline]] void apply_turning(const CrackAxes<double>& axes, const double (&trial)[3][3],
                                         const Vector<double, m>& strain, const double (&spin)[n][3],
                                         Tangent<kind>& tangent) const {
        double C[n][n];
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) C[i][j] = tangent(i, j);
        const double e = strain[0], f = m > 1 ? 0.5 * strain[m > 1] : 0.0, g = m > 2 ? 0.5 * strain[m - 1] : 0.0;
        const auto& S = trial;
        for (int j = 0; j < n; ++j) {
            const double a = spin[j][0], b = spin[j][1], c = spin[j][2];
            const double turned[3] = {2.0 * (S[0][1] * a + S[0][2] * b),
                                      (S[1][1] - S[0][0]) * a + S[1][2] * b + S[0][2] * c,
                                      (S[2][2] - S[0][0]) * b + S[1][2] * a - S[0][1] * c};
            double dq[m];
            for (int k = 0; k < m; ++k) dq[k] = (stiffness[k][j] + turned[k]) * compliance[k];

            Matrix3<double> V;  // W E - E W
            V(0, 0) = -2.0 * (f * a + g * b);
            V(1, 1) = 2.0 * f * a;
            V(2, 2) = 2.0 * g * b;
            V(0, 1) = V(1, 0) = e * a - g * c;
            V(0, 2) = V(2, 0) = e * b + f * c;
            V(1, 2) = V(2, 1) = f * b + g * a;
            Matrix3<double> R;
            for (int i = 0; i < 3; ++i)
                for (int k = 0; k < 3; ++k) R(i, k) = axes[k][i];
            const auto v = from_matrix<Strain<kind, double>, kind>(R * V * transpose(R), 2.0);

            for (int i = 0; i < n; ++i) {
                double change = 0.0;
                for (int k = 0; k < n; ++k) change += C[i][k] * v[k];
                for (int k = 0; k < m; ++k) {
                    double opening = j < normal_components(kind) ? pressure[k] : 0.0;
                    for (int l = 0; l < m; ++l) opening += B[k][l] * dq[l];
                    change += stiffness[k][i] * opening;
                }
                tangent(i, j) = C[i][j] - change;
            }
        }
    }
};

}  // namespace lode
