// The Mie-Grueneisen reference curves of a solid (page 55, sections 2.3 and 2.4; Nairn, 9.10) in the compression
// eta = 1 - J: the Hugoniot pressure
//     P_h = K0 eta (1 - gamma eta/2)/D^2,     D = 1 - S1 eta - S2 eta^2 - S3 eta^3
// and on the isentrope through the reference state, where de/deta = P = P_h + gamma e,
//     e_s = integral of exp(gamma (eta - x)) P_h(x) from 0 to eta,     P_s = P_h + gamma e_s.
// e_s/eta^2 is tabulated as Taylor polynomials about the middles of panels that halve in width, octave by octave of
// w = 1 - eta/pole, towards the pole of P_h: the panel is read off the bits of w, and the relative error is 2e-15.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "lode/numerics/scalar.hpp"

namespace lode {

struct ShockCurve {
    double K0 = 0.0, gamma = 0.0, s1 = 0.0, s2 = 0.0, s3 = 0.0;
    double pole = 1.0;                                // smallest positive root of D, at most 1
    double limit = 1.0;                               // of eta: the pole, J = 0, or where K_h = (1 - eta) P_h' vanishes
    double stiff_from = HUGE_VAL, stiffness = 0.0;    // eta_m, from which on K_h is held at KMAX K0
    double stiff_pressure = 0.0, stiff_energy = 0.0;  // P_h, e_s at eta_m

    // `modulus_limit` is KMAX; <= 1 means none.
    ShockCurve(double modulus, double grueneisen, double S1, double S2, double S3, double modulus_limit)
        : K0(modulus), gamma(grueneisen), s1(S1), s2(S2), s3(S3) {
        const auto first_root = [](double from, double to, const auto& f, const std::vector<double>& also) {
            // The smallest root of f, positive at `from`; `to` where there is none.
            double before = from;
            const auto bisect = [&](double after) {
                for (int i = 0; i < 100; ++i) {
                    const double middle = 0.5 * (before + after);
                    (f(middle) > 0.0 ? before : after) = middle;
                }
                return after;
            };
            for (int i = 1; i <= 1000; ++i) {
                const double next = from + (to - from) * i / 1000;
                for (const double x : also)
                    if (x > before && x < next && !(f(x) > 0.0)) return bisect(x);
                if (!(f(next) > 0.0)) return bisect(next);
                before = next;
            }
            return to;
        };
        // Extrema of D, near which two roots may hide.
        std::vector<double> extrema;
        const double discriminant = s2 * s2 - 3.0 * s1 * s3;
        if (s3 != 0.0 && discriminant >= 0.0)
            for (const double sign : {-1.0, 1.0})
                extrema.push_back((-s2 + sign * std::sqrt(discriminant)) / (3.0 * s3));
        else if (s3 == 0.0 && s2 != 0.0) extrema.push_back(-0.5 * s1 / s2);
        pole = first_root(
            0.0, 1.0, [this](double x) { return denominator(x); }, extrema);
        limit = first_root(0.0, pole, [this](double x) { return (1.0 - x) * hugoniot_slope(x); }, {});
        if (modulus_limit > 1.0) {
            const auto below = [&](double x) { return modulus_limit * K0 - (1.0 - x) * hugoniot_slope(x); };
            const double from = first_root(0.0, limit, below, {});
            if (from < limit) {
                stiff_from = from;
                stiffness = modulus_limit * K0;
                stiff_pressure = hugoniot(from);
                limit = 1.0;
            }
        }
    }

    template <class Real>
    LODE_INLINE Real denominator(const Real& x) const {
        return 1.0 - x * (s1 + x * (s2 + x * s3));
    }
    // P_h below eta_m.
    template <class Real>
    LODE_INLINE Real hugoniot(const Real& x) const {
        return K0 * x * (1.0 - 0.5 * gamma * x) / square(denominator(x));
    }
    // dP_h/deta below eta_m.
    double hugoniot_slope(double x) const {
        const double d = denominator(x);
        return K0 * (1.0 - gamma * x * (1.0 + x * x * (s2 + 2.0 * s3 * x)) + x * (s1 + x * (3.0 * s2 + 5.0 * s3 * x))) /
               (d * d * d);
    }
    // P_h and dP_h/deta wherever eta < limit.
    double pressure_at(double x) const {
        return x <= stiff_from ? hugoniot(x) : stiff_pressure - stiffness * std::log((1.0 - x) / (1.0 - stiff_from));
    }
    double slope_at(double x) const { return x <= stiff_from ? hugoniot_slope(x) : stiffness / (1.0 - x); }
};

// ShockCurve with its table, which stays with the model; what an update gets is a view of it.
class Isentrope {
  public:
    explicit Isentrope(const ShockCurve& shock) : curve_(shock), inverse_pole_(1.0 / shock.pole) {
        end_ = min(curve_.stiff_from, curve_.pole * (1.0 - std::ldexp(1.0, -octaves)));
    }
    // Fills `table`, which must outlive this object.
    void tabulate(std::vector<double>& table) {
        for (int bits = 4; bits <= 9; ++bits) {
            shift_ = 52 - bits;
            if (fill(table)) break;
        }
        table_ = table.data();
        if (curve_.stiff_from < HUGE_VAL)
            curve_.stiff_energy = curve_.stiff_from <= end_ ? tabulated(curve_.stiff_from) : far(curve_.stiff_from);
    }

    const ShockCurve& curve() const { return curve_; }

    // e_s at 0 <= eta < limit.
    template <class Real>
    LODE_INLINE Real energy(const Real& eta) const {
        const Mask<Real> near = eta <= Real(end_);
        if (all(near)) [[likely]]
            return tabulated(eta);
        return select(near, tabulated(min(eta, Real(end_))), far_lanes(*this, eta));
    }
    // P_h at 0 <= eta < limit.
    template <class Real>
    LODE_INLINE Real hugoniot(const Real& eta) const {
        const Real p = curve_.hugoniot(min(eta, Real(curve_.stiff_from)));
        const Mask<Real> stiff = eta > Real(curve_.stiff_from);
        if (!any(stiff)) [[likely]]
            return p;
        const Real volume = (1.0 - eta) * (1.0 / (1.0 - curve_.stiff_from));
        return select(stiff, p - curve_.stiffness * log(select(stiff, volume, Real(1.0))), p);
    }

  private:
    static constexpr int degree = 9, octaves = 7;

    template <class Real>
    LODE_INLINE Real tabulated(const Real& eta) const {
        constexpr std::int64_t one = std::bit_cast<std::int64_t>(1.0);
        constexpr int stride = degree + 2;  // middle of the panel, coefficients
        const Real w = 1.0 - eta * inverse_pole_;
        Real t;
        if constexpr (is_batch<Real>) {
            using Integer = xsimd::batch<std::int64_t>;
            const Integer panel = ((Integer(one) - xsimd::bitwise_cast<Integer>(w)) >> shift_) * Integer(stride);
            const auto entry = [&](int i) { return Batch::gather(table_ + i, panel); };
            const Real d = eta - entry(0);
            t = entry(degree + 1);
            for (int i = degree; i >= 1; --i) t = t * d + entry(i);
        } else {
            const auto panel = (one - std::bit_cast<std::int64_t>(static_cast<double>(value_of(w)))) >> shift_;
            const double* entry = table_ + stride * panel;
            const Real d = eta - entry[0];
            const Real d2 = d * d, d4 = d2 * d2;
            const double* c = entry + 1;
            t = ((c[0] + d * c[1]) + d2 * (c[2] + d * c[3])) + d4 * ((c[4] + d * c[5]) + d2 * (c[6] + d * c[7])) +
                (d4 * d4) * (c[8] + d * c[9]);
        }
        return eta * eta * t;
    }

    // False where the panels are too wide for the degree.
    bool fill(std::vector<double>& table) const {
        using Long = long double;
        constexpr int terms = 26;
        const std::int64_t one = std::bit_cast<std::int64_t>(1.0);
        const int bits = 52 - shift_, panels = (octaves << bits) + 1;
        table.clear();
        table.reserve(static_cast<std::size_t>(panels * (degree + 2)));
        const Long G = curve_.gamma, K = curve_.K0, s1 = curve_.s1, s2 = curve_.s2, s3 = curve_.s3;
        // Taylor series of e_s about x from its value there.
        Long c[terms];
        const auto expand = [&](Long x, Long e) {
            const Long D[4] = {1 - x * (s1 + x * (s2 + x * s3)), -s1 - x * (2 * s2 + 3 * s3 * x), -s2 - 3 * s3 * x,
                               -s3};
            Long q[7] = {};
            for (int i = 0; i < 4; ++i)
                for (int j = 0; j < 4; ++j) q[i + j] += D[i] * D[j];
            const Long N[3] = {K * x * (1 - G * x / 2), K * (1 - G * x), -K * G / 2};
            Long p[terms];
            c[0] = e;
            for (int n = 0; n + 1 < terms; ++n) {
                Long sum = n < 3 ? N[n] : 0;
                for (int k = 1; k <= 6 && k <= n; ++k) sum -= q[k] * p[n - k];
                p[n] = sum / q[0];
                c[n + 1] = (p[n] + G * c[n]) / (n + 1);
            }
        };
        const auto at = [&](Long d) {
            Long sum = c[terms - 1];
            for (int n = terms - 2; n >= 0; --n) sum = sum * d + c[n];
            return sum;
        };
        expand(0, 0);
        Long last = 0;
        bool accurate = true;
        for (std::int64_t i = 0; i < panels; ++i) {
            const double upper = std::bit_cast<double>(one - (i << shift_));
            const double lower = std::bit_cast<double>(one - ((i + 1) << shift_));
            const double middle = curve_.pole * (1.0 - 0.5 * (upper + lower));
            const double half = 0.5 * curve_.pole * (upper - lower);
            const Long x = middle;
            expand(x, at(x - last));
            last = x;
            Long t[terms];
            for (int n = 0; n < terms; ++n)
                t[n] = (c[n] - (n > 0 ? 2 * x * t[n - 1] : 0) - (n > 1 ? t[n - 2] : 0)) / (x * x);
            const Long left = std::abs(t[degree + 1]) + std::abs(t[degree + 2]) * static_cast<Long>(half);
            if (middle - half < curve_.limit)
                accurate = accurate && left * std::pow(static_cast<Long>(half), degree + 1) <= 2e-15L * std::abs(t[0]);
            table.push_back(middle);
            for (int n = 0; n <= degree; ++n) table.push_back(static_cast<double>(t[n]));
        }
        return accurate;
    }

    // Beyond the table: Gauss-Legendre quadrature in the logarithm of what is left to the pole, or to J = 0 where the
    // modulus is held.
    [[gnu::noinline]] double far(double eta) const {
        static constexpr double node[8] = {0.0950125098376374402, 0.2816035507792589132, 0.4580167776572273863,
                                           0.6178762444026437484, 0.7554044083550030339, 0.8656312023878317439,
                                           0.9445750230732325761, 0.9894009349916499326};
        static constexpr double weight[8] = {0.1894506104550684963, 0.1826034150449235889, 0.1691565193950025382,
                                             0.1495959888165767321, 0.1246289712555338721, 0.0951585116824927848,
                                             0.0622535239386478929, 0.0271524594117540949};
        const double G = curve_.gamma;
        const bool stiff = eta > curve_.stiff_from;
        const double edge = stiff ? 1.0 : curve_.pole, start = stiff ? curve_.stiff_from : end_;
        const double start_energy = stiff ? curve_.stiff_energy : tabulated(end_);
        const double size = edge - start, length = -std::log((edge - eta) / size);
        const int panels = 1 + static_cast<int>(std::min(length, 700.0));
        const double half = 0.5 * length / panels;
        double sum = std::exp(G * (eta - start)) * start_energy;
        for (int panel = 0; panel < panels; ++panel)
            for (int i = 0; i < 16; ++i) {
                const double v = half * (2 * panel + 1 + (i < 8 ? node[i] : -node[i - 8])), left = size * std::exp(-v);
                const double x = edge - left;
                const double pressure = stiff ? curve_.stiff_pressure + curve_.stiffness * v : curve_.hugoniot(x);
                sum += half * weight[i % 8] * std::exp(G * (eta - x)) * pressure * left;
            }
        return sum;
    }
    template <class Real>
    [[gnu::noinline]] static Real far_lanes(const Isentrope isentrope, const Real eta) {
        const auto one = [&](double x) {
            return x > isentrope.end_ && x < isentrope.curve_.limit ? isentrope.far(x) : 0.0;
        };
        if constexpr (is_batch<Real>) {
            double x[batch_lanes], e[batch_lanes];
            eta.store_unaligned(x);
            for (int lane = 0; lane < batch_lanes; ++lane) e[lane] = one(x[lane]);
            return Batch::load_unaligned(e);
        } else if constexpr (is_differentiated<Real>) {
            const double x = value_of(eta), e = one(x);
            return Real(e) + (isentrope.curve_.pressure_at(x) + isentrope.curve_.gamma * e) * (eta - x);
        } else {
            return one(eta);
        }
    }

    ShockCurve curve_;
    double inverse_pole_, end_;
    const double* table_ = nullptr;
    int shift_ = 48;
};

}  // namespace lode
