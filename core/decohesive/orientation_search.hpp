// The plane on which the decohesion function of the uncracked material is largest (page 80, 4 D).
#pragma once

#include <array>

#include "lode/decohesive/crack_frame.hpp"
#include "lode/decohesive/gradient.hpp"
#include "lode/numerics/root.hpp"
#include "lode/tensor/eigen.hpp"

namespace lode {

template <class Real>
struct CriticalPlane {
    Vector<Real, 3> n;
    Real F;
};

namespace orientation_detail {

inline constexpr int samples = 181;                      // of 2 theta, a degree apart
inline constexpr int padded = (samples + 15) / 16 * 16;  // whole batches

struct DoubleAngles {
    alignas(64) std::array<double, padded> cosine{}, sine{};
};
// Compile-time cos and sin by their series; the samples only choose an interval.
constexpr DoubleAngles make_double_angles() {
    DoubleAngles a;
    for (int i = 0; i < padded; ++i) {
        const double x = 0.017453292519943295769 * (i < samples ? i : samples - 1) - 1.5707963267948966192;
        double c = 1.0, s = x, term_c = 1.0, term_s = x;
        for (int k = 1; k < 16; ++k) {
            term_c *= -x * x / ((2 * k - 1) * (2 * k));
            term_s *= -x * x / ((2 * k) * (2 * k + 1));
            c += term_c;
            s += term_s;
        }
        a.cosine[static_cast<std::size_t>(i)] = -s;  // shifted by 90 degrees
        a.sine[static_cast<std::size_t>(i)] = c;
    }
    return a;
}
inline constexpr DoubleAngles double_angles = make_double_angles();

// F on a Mohr circle: tau_n = c + r cos 2 theta, tau_s = r sin 2 theta, theta from the larger principal stress. The
// stresses in the plane enter by sigma_tt + sigma_pp = I_1 - tau_n, sigma_tt sigma_pp - sigma_tp^2 = tau_s^2 + tau_n^2
// - I_1 tau_n + I_2.
template <class Real>
struct MohrCircle {
    const DecohesionConstants& k;
    Real c, r, I_1, I_2;

    // 1/m of the mean stress, which is that of all planes.
    Real inverse_m() const {
        const Real I = (k.inverse_tau_nf * (1.0 / 3.0)) * I_1;
        if (I > Real(1.0)) return 1.0 / (0.5 + 0.25 / (I - 0.5));
        return 1.0 / (2.0 - I);
    }
    // dF/dtheta.
    Real slope(const Real& theta) const {
        const Real cos2 = cos(2.0 * theta), sin2 = sin(2.0 * theta);
        const Real tau_n = c + r * cos2, tau_s = r * sin2;
        const Real sum = I_1 - tau_n;
        const Real product = tau_s * tau_s + tau_n * tau_n - I_1 * tau_n + I_2;
        const Real a = k.inverse_tau_nf * tau_n, m = inverse_m();
        const Real q = k.inverse_f_c_square * (sum * sum - (2.0 - k.chi) * product);
        const Real K = 1.0 + a * (m + k.C_n), B = a + q * K - 1.0, inverse_Z = 1.0 / (1.0 + k.C_s * q);
        const Real beta = B * inverse_Z, psi = -k.C * beta;
        Real H = Real(1.0);
        if (psi >= Real(0.0)) {
            const Real g = psi * (1.0 + k.C_psi * psi);
            if (g > Real(300.0)) {
                H = Real(0.0);
            } else {
                const Real e = exp(-2.0 * g), inverse = 1.0 / (1.0 + e);
                H = (1.0 + 2.0 * k.C_psi * psi) * (4.0 * e * inverse * inverse);
            }
        }
        const Real beta_n = inverse_Z * k.inverse_tau_nf * (1.0 + q * (m + k.C_n));
        const Real beta_q = inverse_Z * (K - k.C_s * beta);
        const Real q_n = k.inverse_f_c_square * (-2.0 * sum - (2.0 - k.chi) * (2.0 * tau_n - I_1));
        const double q_s = -(2.0 - k.chi) * k.inverse_f_c_square;  // by tau_s^2
        const Real F_n = H * (beta_n + beta_q * q_n);
        const Real F_s = k.inverse_tau_sf_square + H * (beta_q * q_s);
        // dtau_n = -2 r sin 2 theta, dtau_s^2 = 2 r^2 sin 4 theta
        return 2.0 * r * sin2 * (2.0 * r * cos2 * F_s - F_n);
    }
    // Index of the largest of the samples.
    int best_sample() const {
        const double centre = value_of(c), radius = value_of(r), first = value_of(I_1), second = value_of(I_2);
        const double m = value_of(inverse_m());
        Batch best(-HUGE_VAL), best_index(0.0);
        alignas(64) std::array<double, std::size_t{batch_lanes}> lane{};
        for (int i = 0; i < batch_lanes; ++i) lane[static_cast<std::size_t>(i)] = i;
        Batch index = Batch::load_aligned(lane.data());
        for (std::size_t i = 0; i < padded; i += batch_lanes) {
            const Batch tau_n = centre + radius * Batch::load_aligned(double_angles.cosine.data() + i);
            const Batch tau_s = radius * Batch::load_aligned(double_angles.sine.data() + i);
            const Batch tau_s2 = tau_s * tau_s, sum = first - tau_n;
            const Batch product = tau_s2 + tau_n * tau_n - first * tau_n + second;
            const Batch a = k.inverse_tau_nf * tau_n;
            const Batch q = k.inverse_f_c_square * (sum * sum - (2.0 - k.chi) * product);
            const Batch beta = (a + q * (1.0 + a * (m + k.C_n)) - 1.0) / (1.0 + k.C_s * q);
            const Batch psi = -k.C * beta, g = psi * (1.0 + k.C_psi * psi);
            const Batch e = exp(-2.0 * g);
            const Batch Phi = k.inverse_C * select(psi >= Batch(0.0), (1.0 - e) / (1.0 + e), psi);
            const Batch F = k.inverse_tau_sf_square * tau_s2 - Phi;
            const auto better = F > best;
            best = select(better, F, best);
            best_index = select(better, index, best_index);
            index = index + double(batch_lanes);
        }
        alignas(64) std::array<double, std::size_t{batch_lanes}> value{}, at{};
        best.store_aligned(value.data());
        best_index.store_aligned(at.data());
        std::size_t winner = 0;
        for (std::size_t i = 1; i < value.size(); ++i)
            if (value[i] > value[winner] || (value[i] == value[winner] && at[i] < at[winner])) winner = i;
        return std::min(static_cast<int>(at[winner]), samples - 1);
    }

    // The angle of the largest F in [0, 90] degrees, in radians.
    Real best_angle(const SolveCounter<Real>& solves) const {
        constexpr double right_angle = 1.5707963267948966192, spacing = right_angle / (samples - 1), inside = 1e-4;
        if (k.rankine || !(value_of(r) > 0.0)) return Real(0.0);
        const MohrCircle<double> plain{k, value_of(c), value_of(r), value_of(I_1), value_of(I_2)};
        const int best = best_sample();
        // theta = 0 and 90 degrees are always stationary: ask a little inside.
        const double lower = std::max((best - 1) * spacing, inside);
        const double upper = std::min((best + 1) * spacing, right_angle - inside);
        const double at_lower = plain.slope(lower), at_upper = plain.slope(upper);
        if (best <= 1 && !(at_lower > 0.0)) return Real(0.0);
        if (best >= samples - 2 && !(at_upper < 0.0)) return Real(right_angle);
        using Line = Gradient<1>;
        const MohrCircle<Line> line{k, value_of(c), value_of(r), value_of(I_1), value_of(I_2)};
        const auto slope_of = [&](double theta) {
            const Line at = line.slope(Line::variable(theta, 0));
            return Residual<double>{at.value, at.slope[0]};
        };
        const double tolerance = std::numeric_limits<double>::epsilon() * std::max(at_lower, -at_upper);
        const auto root = solve_bracketed<Slope::decreasing>(slope_of, lower, upper, best * spacing, tolerance);
        solves.count(root);
        if constexpr (is_differentiated<Real>) {
            const Real at = slope(Real(root.x));
            return root.x - (at - Real(value_of(at))) * (1.0 / root.last.slope);
        } else {
            return root.x;
        }
    }
};

// The first global axis with a component above 1e-6 orthogonal to v, that component normalised.
template <class Real>
inline Vector<Real, 3> axis_across(const Vector<Real, 3>& v) {
    for (int i = 0; i < 3; ++i) {
        Vector<Real, 3> a = axis<Real>(i);
        a = a - v[i] * v;
        const Real size = sqrt(dot(a, a));
        if (size > Real(1e-6)) return oriented<Real>((1.0 / size) * a);
    }
    return axis<Real>(0);
}

}  // namespace orientation_detail

// The largest F of a virgin plane and the normal of that plane; of equal ones the page's choice.
template <AnalysisKind kind, class Real>
inline CriticalPlane<Real> critical_plane(const DecohesionConstants& k, const Stress<kind, Real>& s,
                                          const SolveCounter<Real>& solves = {}) {
    using namespace orientation_detail;
    using std::atan2;
    CriticalPlane<Real> plane;
    const auto F_on = [&](const Vector<Real, 3>& n) {
        CrackFrame<kind, Real> frame;
        frame.set_axes(n);
        return decohesion(k, frame.stresses(s), Real(1.0));
    };
    if constexpr (kind == AnalysisKind::uniaxial) {
        plane.n = axis<Real>(0);
    } else if constexpr (kind == AnalysisKind::solid) {
        const Matrix3<Real> tensor = to_matrix<kind, Real>(s, 1.0);
        const SymmetricEigen<Real> eigen = symmetric_eigen(tensor);
        int order[3] = {0, 1, 2};
        const auto larger = [&](int i, int j) { return value_of(eigen.values[i]) > value_of(eigen.values[j]); };
        if (larger(order[1], order[0])) std::swap(order[0], order[1]);
        if (larger(order[2], order[1])) std::swap(order[1], order[2]);
        if (larger(order[1], order[0])) std::swap(order[0], order[1]);
        const Real s_1 = eigen.values[order[0]], s_2 = eigen.values[order[1]], s_3 = eigen.values[order[2]];
        const auto column = [&](int i) {
            Vector<Real, 3> v;
            for (int j = 0; j < 3; ++j) v[j] = eigen.vectors(j, order[i]);
            return oriented(v);
        };
        const double same = 1e-10 * std::max(std::abs(value_of(s_1)), std::abs(value_of(s_3)));
        const bool first_two = value_of(s_1) - value_of(s_2) <= same, last_two = value_of(s_2) - value_of(s_3) <= same;
        Vector<Real, 3> e_1, e_3;
        if (first_two && last_two) {
            e_1 = axis<Real>(0);
            e_3 = axis<Real>(1);
        } else {
            e_3 = first_two || !last_two ? column(2) : axis_across(column(0));
            e_1 = first_two ? axis_across(e_3) : column(0);
        }
        const MohrCircle<Real> circle{k, 0.5 * (s_1 + s_3), 0.5 * (s_1 - s_3), trace(s), second_invariant(tensor)};
        const Real theta = circle.best_angle(solves);
        plane.n = oriented<Real>(Real(cos(theta)) * e_1 + Real(sin(theta)) * e_3);
    } else {
        constexpr int shear = normal_components(kind);
        const Real difference = s[0] - s[1], twice_shear = 2.0 * s[shear];
        const Real diameter_square = difference * difference + twice_shear * twice_shear;
        Real out_of_plane = Real(0.0);
        if constexpr (kind == AnalysisKind::plane_strain) out_of_plane = s[2];
        const double same = 1e-10 * std::max(std::abs(value_of(s[0])), std::abs(value_of(s[1])));
        Real phi = Real(0.0), r = Real(0.0);
        if (value_of(diameter_square) > same * same) {
            r = 0.5 * sqrt(diameter_square);
            phi = 0.5 * atan2(twice_shear, difference);
        }
        const Real sum = s[0] + s[1], minor = s[0] * s[1] - s[shear] * s[shear];
        const MohrCircle<Real> circle{k, 0.5 * sum, r, sum + out_of_plane, minor + sum * out_of_plane};
        const Real angle = phi + circle.best_angle(solves);
        plane.n[0] = cos(angle);
        plane.n[1] = sin(angle);
        plane.n[2] = Real(0.0);
        plane.n = oriented(plane.n);
        if constexpr (kind == AnalysisKind::plane_strain) {
            const Real across = F_on(axis<Real>(2));
            plane.F = F_on(plane.n);
            if (across > plane.F) plane = {axis<Real>(2), across};
            return plane;
        }
    }
    plane.F = F_on(plane.n);
    return plane;
}

// True where F < 0 on every plane, whatever their directions: an upper bound of F from the mean stress p and J_2, with
// tau_s^2 <= J_2, |tau - p| <= t = 2 sqrt(J_2/3) for every normal stress, and tanh(g) >= g/(1 + g).
template <AnalysisKind kind, class Real>
LODE_INLINE Mask<Real> is_certainly_intact(const DecohesionConstants& k, const Stress<kind, Real>& s) {
    const Real p = (1.0 / 3.0) * trace(s), squares = double_contraction(s, s);
    const Real J_2 = max(0.5 * squares - 1.5 * (p * p), Real(0.0)) + 1e-15 * squares;  // and rounding
    const Real t = sqrt((4.0 / 3.0) * J_2);
    const Real largest = k.inverse_tau_nf * (p + t);
    if (k.rankine) return largest < Real(1.0);
    const Real a = max(largest, Real(0.0));
    const double mean_factor = k.inverse_f_c_square * (2.0 + k.chi);
    const double rest_factor = k.inverse_f_c_square * (2.0 + std::abs(k.chi));
    const Real q = mean_factor * (p * p + 2.0 * abs(p) * t) + rest_factor * (t * t);
    const Real psi = k.C * (1.0 - a - q * (1.0 + (1.0 + k.C_n) * a));  // times Z below
    const Real Z = 1.0 + k.C_s * q, g = psi * (Z + k.C_psi * psi);     // times Z^2
    return psi > Real(0.0) && (k.C * k.inverse_tau_sf_square) * J_2 * (Z * Z + g) < g;
}

}  // namespace lode
