// The pores of a POROUS_<KEYWORD> material: what its own 14 constants and 18 state variables say, around the update of
// another solid (page 45, section 4; Nairn, eqs. 8.41-8.51).
#pragma once

#include <string_view>

#include "lode/elastic/material_axes.hpp"
#include "lode/poroelastic/pore_pressure.hpp"

namespace lode {

// Volume that opens in cracks is not pore volume: where a solid keeps its cracking strain in STATEV.
class CrackVolume {
  public:
    CrackVolume() = default;
    explicit CrackVolume(const lode_model& solid) {
        const auto find = [&](std::string_view name) {
            for (int i = 0; i < solid.state_count; ++i)
                if (name == solid.state[i].name) return i + 1;
            return 0;
        };
        strains_ = find("EC_N");
        jumps_ = find("U1X");
        normal_ = find(strains_ > 0 ? "N1" : "N1X");
        tangent_ = find("T1");
        axes_ = find("A11");
        length_ = find("LC");
    }
    bool present() const { return strains_ > 0 || jumps_ > 0; }

    // alpha : eps_c with alpha in host axes; `state` is that of the solid.
    template <class Real, class Number>
    LODE_INLINE Real operator()(const State<Real>& state, const Matrix3<Number>& alpha) const {
        const auto vector = [&](int first) {
            return Vector<Real, 3>{{state[first], state[first + 1], state[first + 2]}};
        };
        const auto product = [&](const Vector<Real, 3>& a, const Vector<Real, 3>& b) {
            Real sum(0.0);
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) sum = sum + alpha(i, j) * a[i] * b[j];
            return sum;
        };
        Real volume(0.0);
        if (strains_ > 0) {
            // eps_c = EC n n + (GC_Y (n t + t n) + GC_Z (n z + z n))/2
            const Vector<Real, 3> n = vector(normal_), t = vector(tangent_);
            const Vector<Real, 3> z{{n[1] * t[2] - n[2] * t[1], n[2] * t[0] - n[0] * t[2], n[0] * t[1] - n[1] * t[0]}};
            volume = state[strains_] * product(n, n) + state[strains_ + 1] * product(n, t) +
                     state[strains_ + 2] * product(n, z);
        } else if (jumps_ > 0) {
            // eps_c = sum of (u n + n u)/(2 L_c)
            const int size = 8;
            for (int first = 0; first + normal_ + size - 1 <= state.count(); first += size)
                volume = volume + product(vector(first + normal_), vector(first + jumps_));
            const Real length = state[length_];
            volume =
                select(length > Real(0.0), Real(volume / select(length > Real(0.0), length, Real(1.0))), Real(0.0));
        }
        return volume;
    }

    // Axes of the solid's elasticity: those it keeps in STATEV, or the host's.
    bool has_axes(const State<double>& state) const {
        return axes_ > 0 && (state[axes_] != 0.0 || state[axes_ + 1] != 0.0 || state[axes_ + 2] != 0.0);
    }
    Matrix3<double> axes(const State<double>& state) const {
        Matrix3<double> r;
        for (int i = 0; i < 3; ++i) r(i, 0) = state[axes_ + i], r(i, 1) = state[axes_ + 3 + i];
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            r(i, 2) = r(j, 0) * r(k, 1) - r(k, 0) * r(j, 1);
        }
        return r;
    }

  private:
    int strains_ = 0, jumps_ = 0, normal_ = 0, tangent_ = 0, axes_ = 0, length_ = 0;
};

// An increment between the two halves of a porous update.
template <AnalysisKind kind, class Real>
struct PoreStep {
    PoreLoad<Real> load;
    Matrix3<Real> alpha;  // in host axes
    HostRotation<kind, Real> frame;
    bool turned;
    Real crack_volume;  // before
};

class PoreSpace {
  public:
    // 1-based PROPS indices.
    enum Property { ALPHA = 1, Q = 4, ANGZ, MODE = 8, K = 11, ETA = 14, constant_count = ETA };
    static constexpr int state_count = pore_pressure::count;

    PoreSpace(const Properties& p, const lode_model& solid)
        : pores(p, MODE, ETA, p[Q], {p[K], p[K + 1], p[K + 2]}),
          cracks(solid),
          coefficients_{p[ALPHA], p[ALPHA + 1], p[ALPHA + 2]},
          axes_(MaterialAxes::from_properties(p, ANGZ)) {}

    // Turns the total stress of `point`, whose state begins with that of the pores, into that of the solid, sigma +
    // alpha (eff(p) - eff(p0)). `solid` is the state of the solid. False, with the point marked, if that fails.
    template <AnalysisKind kind, class Real>
    LODE_INLINE bool begin(const Increment<kind, Real>& increment, Point<kind, Real>& point, const State<Real>& solid,
                           PoreStep<kind, Real>& step) const {
        using Frame = HostRotation<kind, Real>;
        if (!axes_.serve(point) || !pores.read(increment, point, step.load)) return false;
        step.crack_volume = Real(0.0);
        const bool generated = pores.is_generated() && cracks.present();
        // What the pressure and the jumps of the last increment are told in the axes of its end.
        for (Real& x : step.frame.minus_identity.m) x = Real(0.0);
        step.turned = !Frame::is_identity(increment, point.state, pore_pressure::ROTATION);
        if constexpr (Frame::turns && !is_batch<Real>)
            if (step.turned) {
                if (generated) {
                    Frame before;
                    for (int i = 0; i < 9; ++i)
                        before.minus_identity.m[static_cast<std::size_t>(i)] = point.state[pore_pressure::ROTATION + i];
                    step.crack_volume = cracks(solid, in_host_axes(before.times(axes_)));
                }
                step.frame = Frame::advanced(increment, point.state, pore_pressure::ROTATION);
            }
        step.alpha = in_host_axes(step.frame.times(axes_));
        if (generated && !step.turned) step.crack_volume = cracks(solid, step.alpha);
        add(point.stress, step.alpha, pores.carried(step.load.start));
        return true;
    }

    // The way back: `point.stress` is that of the solid at the end. Returns the pressure.
    template <AnalysisKind kind, class Real>
    LODE_INLINE Real finish(const Increment<kind, Real>& increment, Point<kind, Real>& point, const State<Real>& solid,
                            const PoreStep<kind, Real>& step) const {
        Real A = product(step.alpha, increment.strain_increment);
        if (pores.is_generated() && cracks.present()) A = A - (cracks(solid, step.alpha) - step.crack_volume);
        const Real p = pores.at_end(step.load, A, PoreCoupling<double>());
        add(point.stress, step.alpha, Real(-pores.carried(p)));
        pores.store(increment, point.state, step.load, p, A);
        point.state.keep(pore_pressure::EZZ);
        if (step.turned) step.frame.store(point.state, pore_pressure::ROTATION);
        else
            for (int i = 0; i < 9; ++i) point.state.keep(pore_pressure::ROTATION + i);
        return p;
    }

    // alpha : eps.
    template <AnalysisKind kind, class Real>
    LODE_INLINE static Real product(const Matrix3<Real>& alpha, const Strain<kind, Real>& strain) {
        Real sum = alpha(0, 0) * strain[0];
        for (int i = 1; i < components(kind); ++i) sum = sum + component<kind>(alpha, i) * strain[i];
        return sum;
    }
    // Component i of a kind.
    template <AnalysisKind kind, class Real>
    LODE_INLINE static const Real& component(const Matrix3<Real>& tensor, int i) {
        constexpr int n = normal_components(kind);
        return i < n ? tensor(i, i) : i < n + 2 ? tensor(0, i - n + 1) : tensor(1, 2);
    }

    PorePressure pores;
    CrackVolume cracks;

  private:
    // R diag(alpha) R^T.
    template <class Real>
    LODE_INLINE Matrix3<Real> in_host_axes(const Matrix3<Real>& r) const {
        Matrix3<Real> a;
        for (int i = 0; i < 3; ++i)
            for (int j = i; j < 3; ++j)
                a(i, j) = a(j, i) = coefficients_[0] * r(i, 0) * r(j, 0) + coefficients_[1] * r(i, 1) * r(j, 1) +
                                    coefficients_[2] * r(i, 2) * r(j, 2);
        return a;
    }
    template <AnalysisKind kind, class Real>
    LODE_INLINE static void add(Stress<kind, Real>& stress, const Matrix3<Real>& alpha, const Real& factor) {
        for (int i = 0; i < components(kind); ++i) stress[i] = stress[i] + component<kind>(alpha, i) * factor;
    }

    std::array<double, 3> coefficients_;
    MaterialAxes axes_;
};

}  // namespace lode
