// Alternatives to backward Euler for the deviator and alpha under a constant strain rate (page 20, sections 3 and 6),
// for hardening curves in kinds with three normal components. The trial increment is d = 2G dev(de); the yield surface
// has the radius R = sqrt(2/3) k(alpha).
#pragma once

#include "lode/numerics/lanes.hpp"
#include "lode/numerics/substepping.hpp"
#include "lode/plasticity/iso_plastic_laws.hpp"

namespace lode::iso_plastic {

// PROPS entry METHOD.
enum class Method {
    backward_euler = 0,
    exact = 1,           // for a constant strain rate
    substeps = 2,        // of backward Euler
    cutting_plane = 3,   //
    modified_euler = 4,  // with error control
    trapezoidal = 5,     // perfect plasticity
    forward_euler = 6,   // NSUB substeps, pulled back to the surface
};

template <class Real>
using Deviator = Stress<AnalysisKind::solid, Real>;
template <class Real>
struct DeviatoricState {
    Deviator<Real> s;
    Real alpha;
};

// The turning of the deviator (section 3, METHOD 1): with V = 3G alpha + k(alpha), t = a/R from 0 on and R that of the
// start, dV/dt = sqrt(3/2) R cos(psi), du/dt = -k/k(alpha(V)). With the derivatives by u at the start.
class Turning {
  public:
    struct State {
        double V, u, V_u0, u_u0;
        friend State moved(const State& y, double h, const State& rate) {
            return {y.V + h * rate.V, y.u + h * rate.u, y.V_u0 + h * rate.V_u0, y.u_u0 + h * rate.u_u0};
        }
    };
    State at;
    int panels = 0;  // integrated, or tried

    Turning(const AnyLaw& law, const Surroundings<double>& s, double G, double alpha, bool is_radial)
        : law_(law),
          law_at_(law.at(s)),
          G3_(3.0 * G),
          alpha_(alpha),
          start_(law.start(law_at_, alpha)),
          is_radial_(is_radial),
          is_straight_(start_.curvature == 0.0 && !law.is_softening()) {}

    // Gragg's midpoint rule, extrapolated in the square of its step, in panels that follow the error.
    bool integrate(double u0, double length) {
        constexpr int columns = 8;
        at = {G3_ * alpha_ + start_.value, u0, 0.0, 1.0};
        double left = length, H = std::min(length, 0.5);
        for (panels = 1; panels <= 10000; ++panels) {
            H = std::min(H, left);
            State table[columns];
            double change = HUGE_VAL;
            int c = 0;
            for (; c < columns; ++c) {
                const int n = 2 * (c + 1);
                const double h = H / n;
                State before = at, now = moved(at, h, rate(at));
                for (int i = 1; i < n; ++i) {
                    const State next = moved(before, 2.0 * h, rate(now));
                    before = now;
                    now = next;
                }
                State end = mean(now, moved(before, h, rate(now)));
                for (int j = 0; j < c; ++j) {
                    const double ratio = double(c + 1) / double(c - j), factor = 1.0 / (ratio * ratio - 1.0);
                    const State better = moved(end, factor, difference(end, table[j]));
                    table[j] = end;
                    end = better;
                }
                table[c] = end;
                // Two neighbours of this row.
                if (c > 0) change = size(difference(end, table[c - 1]));
                if (c > 2 && change < 2e-15) break;
            }
            const State end = table[std::min(c, columns - 1)];
            if (!(change < 1e-13) && H > 1e-6 * length) {
                H *= 0.5;
                continue;
            }
            if (!(change < 1e-6)) return false;
            at = end;
            left -= H;
            if (left <= 1e-15 * length) return true;
            if (c < 6) H *= 2.0;
        }
        return false;
    }
    // d(V, u)/dt at the end.
    State speed() const { return rate(at); }

  private:
    State rate(const State& y) const {
        FlowStress<double> k = start_;
        if (is_straight_) {
            k.value = start_.value + start_.slope * (y.V - G3_ * alpha_ - start_.value) / (G3_ + start_.slope);
        } else {
            const double q = std::max(y.V - G3_ * alpha_, start_.value);
            const auto end = law_.template solve<radial>(law_at_, q, alpha_, start_, true);
            k = {q - G3_ * end.dalpha, end.flow.slope, 0.0};
        }
        const double pull = start_.value / k.value, k_V = k.slope / (G3_ + k.slope);
        // cos(psi) = -tanh(u)
        const double e = quick_expm1(-2.0 * std::abs(y.u)), tanh = -e / (2.0 + e);
        const double cosine = is_radial_ ? 1.0 : y.u > 0.0 ? -tanh : tanh;
        const double bend = is_radial_ ? 0.0 : (1.0 - cosine) * (1.0 + cosine);
        return {start_.value * cosine, -pull, -start_.value * bend * y.u_u0, pull / k.value * k_V * y.V_u0};
    }
    static State mean(const State& a, const State& b) { return moved(a, 0.5, difference(b, a)); }
    static State difference(const State& a, const State& b) { return moved(a, -1.0, b); }
    double size(const State& y) const {
        return std::max({std::abs(y.V) / (start_.value + G3_ * alpha_), std::abs(y.u), std::abs(y.V_u0) / start_.value,
                         std::abs(y.u_u0)});
    }

    const AnyLaw& law_;
    AnyLaw::At<double> law_at_;
    double G3_, alpha_;
    FlowStress<double> start_;
    bool is_radial_, is_straight_;
};

template <class Real>
class ConstantRatePath {
  public:
    using S = Deviator<Real>;
    using State = DeviatoricState<Real>;

    ConstantRatePath(const AnyLaw& law, const Real& scale, double G, const SolveCounter<Real>& solves = {})
        : law_(law), G_(G), solves_(solves) {
        Surroundings<Real> s;
        s.scale = scale;
        at_ = law.at(s);
    }

    // The end of the increment.
    State follow(Method method, const State& start, const S& d, int substeps, double tolerance) const {
        if (method == Method::cutting_plane) return cutting_plane({start.s + d, start.alpha});
        const FlowStress<Real> k = law_.start(at_, start.alpha);
        const Real R = root23 * k.value, length2 = double_contraction(d, d);
        const Real size = norm(start.s);
        if (norm(start.s + d) <= R * (1.0 + yield_tolerance) || !(length2 > Real(0.0)))
            return {start.s + d, start.alpha};
        if (!(k.value > Real(0.0)) || size > R * (1.0 + 1e-6)) return backward_euler({start.s + d, start.alpha});

        // The part r of the increment that is elastic, and where it ends.
        const Real b = double_contraction(start.s, d), inside = R * R - size * size;
        Real r(0.0);
        State c = start;
        if (inside <= 1e-12 * (R * R) && b >= Real(0.0)) {
            c.s = (R / size) * start.s;
        } else {
            const Real root = sqrt(b * b + length2 * max(inside, Real(0.0)));
            r = b > Real(0.0) ? inside / (b + root) : (root - b) / length2;
            c.s = start.s + r * d;
        }
        const S rest = (1.0 - r) * d;
        switch (method) {
            case Method::exact:
                return exact(c, rest, k, R);
            case Method::modified_euler:
                return modified(c, rest, tolerance);
            case Method::trapezoidal:
                return trapezoid(c, rest, R);
            default:
                return forward(c, rest, substeps);
        }
    }

  private:
    static constexpr double root23 = 0.81649658092772603273;  // sqrt(2/3)

    AnyLaw law_;
    double G_;
    SolveCounter<Real> solves_;
    AnyLaw::At<Real> at_;

    static Real norm(const S& s) { return sqrt(double_contraction(s, s)); }

    State backward_euler(const State& trial) const {
        const Real q = sqrt(1.5) * norm(trial.s);
        const FlowStress<Real> k = law_.start(at_, trial.alpha);
        const Real dalpha = law_.template solve<radial>(at_, q, trial.alpha, k, true, solves_).dalpha;
        return {(1.0 - 3.0 * G_ * dalpha / q) * trial.s, trial.alpha + dalpha};
    }

    // Newton's linear updates towards the surface. One more after the last that was needed, for the derivatives.
    State cutting_plane(State at) const {
        Real q = sqrt(1.5) * norm(at.s);
        FlowStress<Real> k = law_.start(at_, at.alpha);
        if (!(q - k.value > yield_tolerance * max(q, k.value))) return at;
        const Real q_trial = q;
        bool last = false;
        for (int i = 0; i < 100; ++i) {
            const Real dalpha = (q - k.value) / (3.0 * G_ + k.slope);
            q = q - 3.0 * G_ * dalpha;
            at.alpha = at.alpha + dalpha;
            k = law_.start(at_, at.alpha);
            if (last) {
                solves_.count(i);
                at.s = (q / q_trial) * at.s;
                return at;
            }
            last = abs(q - k.value) <= return_tolerance * q_trial;
        }
        solves_.count(100, 1);
        return backward_euler({at.s, at.alpha - (q_trial - q) / (3.0 * G_)});
    }

    // Section 3, METHOD 1. The deviator turns towards d in the plane of both: with the angle psi between them and
    // u = ln tan(psi/2), du/dt = -|d|/R whatever the hardening.
    State exact(const State& c, const S& d, const FlowStress<Real>& k, const Real& R) const {
        const Real a = norm(d);
        const S dh = (1.0 / a) * d;
        const Real along = double_contraction(c.s, dh);
        const S w = c.s - along * dh;
        const Real across = norm(w);
        if (k.slope == Real(0.0) && k.curvature == Real(0.0)) {
            const Real C = along / R, e = quick_exp(Real(0.0) - a / R), e2 = e * e;
            const Real den = (1.0 + C) + e2 * (1.0 - C), rho = 2.0 * e / den;
            const Real turned = ((1.0 + C) - e2 * (1.0 - C)) / den - C * rho;
            // R (turned dh + rho s_c/R), gamma = (R/2G)(-ln rho)
            return {R * turned * dh + rho * c.s, c.alpha - root23 * (R / (2.0 * G_)) * quick_log(rho)};
        }
        // On a radial path, where tan(psi/2) vanishes, u is counted from 0: what is across shrinks by exp(u). (Backward
        // Euler has the stress, but not the tangent.)
        const bool is_radial = across < 1e-7 * R;
        Real u0(0.0);
        if (!is_radial) u0 = quick_log(along > Real(0.0) ? across / (R + along) : (R - along) / across);
        const Real length = a / R;
        Turning turning(law_, value_of_surroundings(), G_, value_of(c.alpha), is_radial);
        const bool turned_to_end = turning.integrate(value_of(u0), value_of(length));
        solves_.count(0, turned_to_end ? 0 : 1);
        solves_.count_substeps(turning.panels);
        if (!turned_to_end) return backward_euler({c.s + d, c.alpha});
        // Value and derivatives.
        const Real late = length - Real(value_of(length)), turned = u0 - Real(value_of(u0));
        const Real V = turning.at.V + turning.speed().V * late + turning.at.V_u0 * turned;
        const Real u = turning.at.u + turning.speed().u * late + turning.at.u_u0 * turned;
        const Real K = strength_of(V, c.alpha, k), alpha = (V - K) / (3.0 * G_);
        if (is_radial) return {root23 * K * dh + (K / k.value) * quick_exp(u) * w, alpha};
        const Real tail = quick_exp(Real(0.0) - abs(u)), tail2 = tail * tail;
        const Real sine = 2.0 * tail / (1.0 + tail2), size = (1.0 - tail2) / (1.0 + tail2);
        const Real cosine = u > Real(0.0) ? Real(0.0) - size : size;
        return {root23 * K * cosine * dh + (root23 * K * sine / across) * w, alpha};
    }
    // k of V = 3G alpha + k(alpha): the scalar return.
    Real strength_of(const Real& V, const Real& alpha, const FlowStress<Real>& k) const {
        const Real q = max(V - 3.0 * G_ * alpha, k.value);
        return q - 3.0 * G_ * law_.template solve<radial>(at_, q, alpha, k, true).dalpha;
    }
    Surroundings<double> value_of_surroundings() const {
        Surroundings<double> s;
        s.scale = value_of(at_.surroundings.scale);
        return s;
    }

    // The rate equations over pseudo-time 0..1: flow along s, with gamma' = (n:d)/(2G (1 + k'/3G)).
    struct Flow {
        S s;
        Real alpha;
        friend Flow operator+(const Flow& a, const Flow& b) { return {a.s + b.s, a.alpha + b.alpha}; }
        friend Flow operator-(const Flow& a, const Flow& b) { return {a.s - b.s, a.alpha - b.alpha}; }
        friend Flow operator*(const Real& f, const Flow& a) { return {f * a.s, f * a.alpha}; }
    };
    Flow rate_of(const Flow& at, const S& d) const {
        const Real size = norm(at.s), slope = law_.start(at_, at.alpha).slope;
        const Real along = max(double_contraction(at.s, d) / size, Real(0.0));
        const Real gamma = along / (2.0 * G_ + (2.0 / 3.0) * slope);
        return {d - (2.0 * G_ * gamma / size) * at.s, root23 * gamma};
    }
    void pull_back(Flow& at) const {
        const Real R = root23 * law_.start(at_, at.alpha).value;
        at.s = (R / norm(at.s)) * at.s;
    }
    State modified(const State& c, const S& d, double tolerance) const {
        const auto rate = [&](const Flow& at) { return rate_of(at, d); };
        const auto error = [](const Flow& e, const Flow& at) { return norm(e.s) / norm(at.s); };
        const auto accept = [this](Flow& at) { pull_back(at); };
        const SubstepControl control{.tolerance = tolerance, .first = 1.0, .smallest = 1e-9, .max_substeps = 100000};
        const auto end = modified_euler(Flow{c.s, c.alpha}, rate, error, accept, control);
        solves_.count_substeps(end.accepted + end.rejected);
        solves_.count(0, end.completed ? 0 : 1);
        if (!end.completed) return backward_euler({c.s + d, c.alpha});
        return {end.state.s, end.state.alpha};
    }
    State forward(const State& c, const S& d, int substeps) const {
        Flow at{c.s, c.alpha};
        solves_.count_substeps(substeps);
        for (int i = 0; i < substeps; ++i) {
            at = at + Real(1.0 / substeps) * rate_of(at, d);
            pull_back(at);
        }
        return {at.s, at.alpha};
    }
    // Perfect plasticity: the multiplier times the mean of both flow directions.
    State trapezoid(const State& c, const S& d, const Real& R) const {
        const Real along = double_contraction(c.s, d);
        const Real l = (2.0 * along + double_contraction(d, d)) / (2.0 * (R * R) + along);
        const S s = (1.0 / (1.0 + 0.5 * l)) * ((1.0 - 0.5 * l) * c.s + d);
        return {s, c.alpha + root23 * norm(d - (s - c.s)) / (2.0 * G_)};
    }
};

}  // namespace lode::iso_plastic
