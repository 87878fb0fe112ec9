// The cracks of one point and the increment that they share: coupled solution, initiation, energies, tangent (page 80,
// 4 A and B, 5, 6).
#pragma once

#include <array>

#include "lode/decohesive/crack.hpp"
#include "lode/decohesive/cutting_plane.hpp"
#include "lode/decohesive/elimination.hpp"
#include "lode/decohesive/orientation_search.hpp"

namespace lode {

template <AnalysisKind kind, class Real>
class CrackSet {
  public:
    int count = 0;  // J
    bool initiated = false, active = false, unconverged = false;
    Stress<kind, Real> stress;
    Real dissipated = Real(0.0);  // per volume
    SolveCounter<Real> solves;    // of this set: one made from it in another kind of number does not count
    std::array<Crack<Real>, most_cracks> cracks;

    CrackSet(const CrackLaw& law, const CrackControl& control, const KindStiffness<kind>& stiffness)
        : law_(law), control_(control), stiffness_(stiffness) {}
    // The same point in another kind of number, without derivatives.
    template <class Other>
    explicit CrackSet(const CrackSet<kind, Other>& other)
        : count(other.count), law_(other.law_), control_(other.control_), stiffness_(other.stiffness_) {
        for (int i = 0; i < components(kind); ++i) stress[i] = Real(value_of(other.stress[i]));
        const int known = control_.prescribed ? 1 : count;
        for (int j = 0; j < known; ++j) at(j) = Crack<Real>(other.cracks[static_cast<std::size_t>(j)]);
    }

    // Integrates the increment; the stress on entry is that of its start.
    CrackStatus advance(const Strain<kind, Real>& strain) {
        const int steps = control_.substeps();
        Stress<kind, Real> change = elastic(strain);
        if (steps > 1) change = Real(1.0 / steps) * change;
        if (steps > 1) solves.count_substeps(steps);
        for (int j = 0; j < count; ++j) frame(j).set(at(j).n, stiffness_);
        for (int i = 0; i < steps; ++i) {
            const CrackStatus status = step(change);
            if (status != CrackStatus::done) return status;
        }
        return CrackStatus::done;
    }

    // max 1 - f over the cracks.
    Real damage() const {
        Real D = Real(0.0);
        for (int j = 0; j < count; ++j) {
            if (at(j).phase >= 2) return Real(1.0);
            D = max(D, Real(1.0 - law_.softening(opening(j))));
        }
        return D;
    }

    // d stress/d strain of an increment without initiation in one backward Euler step.
    void set_tangent(Tangent<kind>& tangent) const requires std::is_same_v<Real, double> {
        constexpr int n = components(kind);
        const int unknowns = 3 * count;
        std::array<double, 9 * most_cracks * most_cracks> matrix;
        std::array<double, 3 * most_cracks * 6> rates;
        for (int j = 0; j < count; ++j) {
            const JumpRate rate = jump_rate(law_, trial(j), start_opening(j), jump(j));
            const CrackFrame<kind, double>& f = frame(j);
            const Stress<kind, double> lateral[3] = {f.lateral_rate(0, stiffness_), f.lateral_rate(1, stiffness_),
                                                     f.lateral_rate(2, stiffness_)};
            for (int a = 0; a < 3; ++a)
                for (int k = 0; k < n; ++k) {
                    double sum = 0.0;
                    for (int b = 0; b < 3; ++b) sum += rate.m[a][b] * f.Q[b][k] + rate.m[a][3 + b] * lateral[b][k];
                    rates[index((3 * j + a) * n + k)] = sum;
                }
            if (count > 1) couple(j, rate, matrix.data(), unknowns);
        }
        if (count > 1) solve_in_place(matrix.data(), unknowns, rates.data(), n);
        const double inverse_length = 1.0 / law_.length;
        for (int j = 0; j < count; ++j)
            for (int a = 0; a < 3; ++a)
                for (int k = 0; k < n; ++k) {
                    const double r = inverse_length * rates[index((3 * j + a) * n + k)];
                    if (r == 0.0) continue;
                    for (int i = 0; i < n; ++i) tangent(i, k) -= r * frame(j).Q[a][i];
                }
    }

  private:
    template <AnalysisKind, class>
    friend class CrackSet;

    const CrackLaw& law_;
    const CrackControl& control_;
    const KindStiffness<kind>& stiffness_;
    Stress<kind, Real> trial_;  // stress without any jump in the increment
    std::array<CrackFrame<kind, Real>, most_cracks> frames_;
    std::array<CrackJump<Real>, most_cracks> jumps_;
    std::array<Real, most_cracks> start_openings_;

    static constexpr std::size_t index(int i) { return static_cast<std::size_t>(i); }
    Crack<Real>& at(int j) { return cracks[index(j)]; }
    const Crack<Real>& at(int j) const { return cracks[index(j)]; }
    CrackFrame<kind, Real>& frame(int j) { return frames_[index(j)]; }
    const CrackFrame<kind, Real>& frame(int j) const { return frames_[index(j)]; }
    CrackJump<Real>& jump(int j) { return jumps_[index(j)]; }
    const CrackJump<Real>& jump(int j) const { return jumps_[index(j)]; }
    Real start_opening(int j) const { return start_openings_[index(j)]; }
    Real opening(int j) const { return dot(at(j).u, at(j).n); }

    Stress<kind, Real> elastic(const Strain<kind, Real>& e) const {
        Stress<kind, Real> s;
        const Real volumetric = stiffness_.E_2 * trace(e);
        for (int i = 0; i < components(kind); ++i) {
            if (i < normal_components(kind)) s[i] = volumetric + stiffness_.twice_shear * e[i];
            else s[i] = (0.5 * stiffness_.twice_shear) * e[i];
        }
        return s;
    }

    // C:sym(Du n)/L_c of crack j.
    Stress<kind, Real> released(int j, const CrackJump<Real>& d) const {
        const double inverse_length = 1.0 / law_.length;
        const CrackFrame<kind, Real>& f = frame(j);
        Stress<kind, Real> s;
        for (int i = 0; i < components(kind); ++i)
            s[i] = inverse_length * (d.n * f.Q[0][i] + d.t * f.Q[1][i] + d.p * f.Q[2][i]);
        return s;
    }
    void sum_up() {
        stress = trial_;
        for (int j = 0; j < count; ++j)
            if (jump(j).response != CrackResponse::elastic) stress = stress - released(j, jump(j));
    }
    // Stresses on crack j without its own jump.
    PlaneStresses<Real> trial(int j) const {
        Stress<kind, Real> s = trial_;
        for (int i = 0; i < count; ++i)
            if (i != j && jump(i).response != CrackResponse::elastic) s = s - released(i, jump(i));
        return frame(j).stresses(s);
    }

    // One step (page 80, 4 A).
    CrackStatus step(const Stress<kind, Real>& change) {
        const Stress<kind, Real> start = stress;
        for (int j = 0; j < count; ++j) start_openings_[index(j)] = opening(j);
        for (;;) {
            trial_ = start + change;
            const CrackStatus status = solve();
            if (status != CrackStatus::done) return status;
            if (count == control_.most) break;
            Crack<Real> next;
            if (!finds_next(start, change, next)) break;
            // The coupled solution was made for other cracks: all again.
            next.u[0] = next.u[1] = next.u[2] = next.G = Real(0.0);
            next.phase = 1;
            at(count) = next;
            frame(count).set(next.n, stiffness_);
            start_openings_[index(count)] = Real(0.0);
            ++count;
            initiated = true;
        }
        accept();
        return CrackStatus::done;
    }

    // Where a crack starts in this step, if one does. `stress` is the solution without it.
    bool finds_next(const Stress<kind, Real>& start, const Stress<kind, Real>& change, Crack<Real>& next) {
        const DecohesionConstants& k = law_.strength;
        if (control_.prescribed) {
            next = at(0);
            CrackFrame<kind, Real> f;
            f.set_axes(next.n);
            return value_of(decohesion(k, f.stresses(stress), Real(1.0))) > decohesion_tolerance;
        }
        if (is_certainly_intact<kind, Real>(k, stress)) return false;
        const CriticalPlane<Real> last = critical_plane<kind, Real>(k, stress, solves);
        if (!(value_of(last.F) > decohesion_tolerance)) return false;
        next.n = last.n;
        if constexpr (kind != AnalysisKind::uniaxial) {
            const double F_start = value_of(critical_plane<kind, Real>(k, start).F);
            if (F_start < 0.0) next.n = normal_at_event(start, change, value_of(last.F) - F_start);
        }
        if (is_too_close(next.n)) next.n = last.n;
        return !is_too_close(next.n);
    }
    bool is_too_close(const Vector<Real, 3>& n) const {
        for (int j = 0; j < count; ++j)
            if (std::abs(value_of(dot(n, at(j).n))) > control_.closest) return true;
        return false;
    }
    // The critical plane at the first instant of the step at which its F, which rises by `rise` in all, is zero.
    [[gnu::noinline]] Vector<Real, 3> normal_at_event(const Stress<kind, Real>& start, const Stress<kind, Real>& change,
                                                      double rise) const {
        constexpr double rounding = 4e-15;  // of F
        using Line = Gradient<1>;
        CrackSet<kind, Line> line(*this);
        for (int j = 0; j < count; ++j) {
            line.start_openings_[index(j)] = Line(value_of(start_opening(j)));
            line.frame(j).set(line.at(j).n, stiffness_);
        }
        const auto largest_F = [&](double part) {
            const Line s = Line::variable(part, 0);
            for (int i = 0; i < components(kind); ++i) line.trial_[i] = value_of(start[i]) + s * value_of(change[i]);
            line.solve();
            const Line F = critical_plane<kind, Line>(law_.strength, line.stress).F;
            return Residual<double>{F.value, F.slope[0]};
        };
        const auto root = solve_bracketed<Slope::increasing>(largest_F, 0.0, 1.0, 1.0, 1e-14 * rise + rounding);
        solves.count(root);
        CrackSet at_event(*this);
        const auto plane = [&](const Real& part) {
            at_event.trial_ = start + part * change;
            at_event.solve();
            return critical_plane<kind, Real>(law_.strength, at_event.stress);
        };
        CriticalPlane<Real> critical = plane(Real(root.x));
        if constexpr (is_differentiated<Real>) {
            const Real shift = critical.F - Real(value_of(critical.F));
            critical = plane(Real(root.x) - shift * (1.0 / root.last.slope));
        }
        return critical.n;
    }

    // The jumps for `trial_` by the integration chosen, and the stress.
    CrackStatus solve() {
        if (control_.cutting_plane()) return cut();
        if constexpr (is_differentiated<Real>) {
            CrackSet<kind, double> plain(*this);
            for (int i = 0; i < components(kind); ++i) plain.trial_[i] = value_of(trial_[i]);
            for (int j = 0; j < count; ++j) {
                plain.start_openings_[index(j)] = value_of(start_opening(j));
                plain.at(j) = Crack<double>(at(j));
                plain.frame(j).set(plain.at(j).n, stiffness_);
            }
            const CrackStatus status = plain.solve();
            unconverged = plain.unconverged;
            if (status != CrackStatus::done) return status;
            differentiate(plain);
            return CrackStatus::done;
        } else {
            if (count <= 1) {
                if (count == 1)
                    jump(0) = crack_jump(law_, frame(0).stresses(trial_), start_opening(0), at(0).phase >= 2, solves);
                sum_up();
                return CrackStatus::done;
            }
            const bool converged = iterate();
            sum_up();
            unconverged = !converged;
            if (!converged) solves.count(0, 1);
            return converged || control_.accepts_unconverged ? CrackStatus::done : CrackStatus::unconverged;
        }
    }

    // The derivatives of the coupled jumps follow from those of each crack: two Newton steps with the exact matrix on
    // numbers that carry derivatives.
    void differentiate(const CrackSet<kind, double>& plain) {
        for (int j = 0; j < count; ++j) {
            const CrackJump<double>& known = plain.jump(j);
            jump(j) = {known.n, known.t, known.p, known.omega, known.eta, known.response};
        }
        std::array<double, 9 * most_cracks * most_cracks> matrix;
        std::array<Real, 3 * most_cracks> residual;
        for (int pass = 0; pass < (count > 1 ? 2 : 1); ++pass) {
            std::array<CrackJump<Real>, most_cracks> next;
            for (int j = 0; j < count; ++j) next[index(j)] = refined(law_, trial(j), start_opening(j), plain.jump(j));
            if (count > 1) {
                for (int j = 0; j < count; ++j) {
                    residual[index(3 * j)] = jump(j).n - next[index(j)].n;
                    residual[index(3 * j + 1)] = jump(j).t - next[index(j)].t;
                    residual[index(3 * j + 2)] = jump(j).p - next[index(j)].p;
                    const JumpRate rate = jump_rate(plain.law_, plain.trial(j), plain.start_opening(j), plain.jump(j));
                    plain.couple(j, rate, matrix.data(), 3 * count);
                }
                solve_in_place(matrix.data(), 3 * count, residual.data(), 1);
            }
            for (int j = 0; j < count; ++j) {
                if (count > 1) {
                    next[index(j)].n = jump(j).n - residual[index(3 * j)];
                    next[index(j)].t = jump(j).t - residual[index(3 * j + 1)];
                    next[index(j)].p = jump(j).p - residual[index(3 * j + 2)];
                }
                jump(j) = next[index(j)];
            }
        }
        sum_up();
    }

    // Rows 3j.. of the matrix of the coupled jumps: Du_j + M_j P_j sum_i K_i Du_i = M_j P_j sigma_trial.
    void couple(int j, const JumpRate& rate, double* matrix, int unknowns) const {
        const double inverse_length = 1.0 / law_.length;
        for (int i = 0; i < count; ++i)
            for (int b = 0; b < 3; ++b) {
                const int column = 3 * i + b;
                PlaneStresses<double> s{};
                if (i != j) s = frame(j).stresses(inverse_length * frame(i).Q[b]);
                const double v[6] = {s.n, s.t, s.p, s.tt, s.pp, s.tp};
                for (int a = 0; a < 3; ++a) {
                    double sum = i == j && a == b ? 1.0 : 0.0;
                    for (int c = 0; c < 6; ++c) sum += rate.m[a][c] * v[c];
                    matrix[(3 * j + a) * unknowns + column] = sum;
                }
            }
    }

    // (4 B) Block Gauss-Seidel with attempts at Newton's method on the coupled jumps.
    bool iterate() {
        constexpr int sweeps = 5000, latching = 51;
        const double tolerance = 1e-13 * law_.u_0;
        std::array<bool, most_cracks> latched{};
        for (int j = 0; j < count; ++j) jump(j) = CrackJump<Real>::none();
        int next_attempt = 2;
        for (int sweep = 1; sweep <= sweeps; ++sweep) {
            double change = 0.0;
            bool same = true;
            for (int j = 0; j < count; ++j) {
                const CrackJump<double> old = jump(j);
                jump(j) =
                    crack_jump(law_, trial(j), start_opening(j), at(j).phase >= 2 || latched[index(j)], solves, old);
                latched[index(j)] = latched[index(j)] || (sweep >= latching && jump(j).has_failed());
                change = std::max(change, difference(old, jump(j)));
                same = same && old.response == jump(j).response;
            }
            if (change == 0.0 || (change <= tolerance && (same || sweep > 1))) {
                if (change > 0.0) newton(latched);
                return true;
            }
            if (sweep >= next_attempt && same) {
                if (newton(latched)) return true;
                next_attempt = 4 * sweep;
            }
        }
        return false;
    }
    static double difference(const CrackJump<double>& a, const CrackJump<double>& b) {
        return std::max({std::abs(a.n - b.n), std::abs(a.t - b.t), std::abs(a.p - b.p)});
    }

    // Newton's method on Du_j = jump of crack j in the stress that the others leave; true if it converges with the
    // responses it started from, else the jumps stay as they were.
    bool newton(const std::array<bool, most_cracks>& latched) {
        const std::array<CrackJump<Real>, most_cracks> saved = jumps_;
        std::array<double, 9 * most_cracks * most_cracks> matrix;
        std::array<double, 3 * most_cracks> residual;
        const int unknowns = 3 * count;
        for (int iteration = 0; iteration < 8; ++iteration) {
            std::array<CrackJump<Real>, most_cracks> next;
            for (int j = 0; j < count; ++j) {
                const PlaneStresses<double> s = trial(j);
                const double u = start_opening(j);
                next[index(j)] = crack_jump(law_, s, u, at(j).phase >= 2 || latched[index(j)], solves, jump(j));
                if (next[index(j)].response != saved[index(j)].response) {
                    jumps_ = saved;
                    return false;
                }
                residual[index(3 * j)] = jump(j).n - next[index(j)].n;
                residual[index(3 * j + 1)] = jump(j).t - next[index(j)].t;
                residual[index(3 * j + 2)] = jump(j).p - next[index(j)].p;
                couple(j, jump_rate(law_, s, u, next[index(j)]), matrix.data(), unknowns);
            }
            if (!solve_in_place(matrix.data(), unknowns, residual.data(), 1)) break;
            double correction = 0.0;
            for (int j = 0; j < count; ++j) {
                CrackJump<Real>& d = next[index(j)];
                d.n = jump(j).n - residual[index(3 * j)];
                d.t = jump(j).t - residual[index(3 * j + 1)];
                d.p = jump(j).p - residual[index(3 * j + 2)];
                for (int a = 0; a < 3; ++a) correction = std::max(correction, std::abs(residual[index(3 * j + a)]));
            }
            if (!(correction <= law_.u_0)) break;
            jumps_ = next;
            if (correction <= 1e-14 * law_.u_0) return true;
        }
        jumps_ = saved;
        return false;
    }

    // Cutting plane of the source (4.5): the cracks once in sequence, all quantities at the current iterate.
    CrackStatus cut() {
        stress = trial_;
        for (int j = 0; j < count; ++j) {
            if (!cutting_plane(law_, frame(j).stresses(stress), start_opening(j), at(j).phase >= 2, jump(j), solves))
                return CrackStatus::no_cutting_plane;
            if (jump(j).response != CrackResponse::elastic) stress = stress - released(j, jump(j));
        }
        return CrackStatus::done;
    }

    // Jumps, energies and phases at the end of a step (page 80, 6).
    void accept() {
        const double inverse_length = 1.0 / law_.length, tau_nf = law_.strength.tau_nf;
        for (int j = 0; j < count; ++j) {
            const CrackJump<Real>& d = jump(j);
            if (d.response == CrackResponse::elastic) continue;
            const CrackFrame<kind, Real>& f = frame(j);
            const PlaneStresses<Real> s = f.stresses(stress);
            const Real u = start_opening(j);
            Real G = s.t * d.t + s.p * d.p;
            if (d.response == CrackResponse::softening) {
                G = G + s.n * d.n + tau_nf * (law_.area(u, d.n) - law_.softening(Real(u + d.n)) * d.n);
                at(j).phase = 1;
            } else {
                if (at(j).phase < 2) G = G + tau_nf * law_.area(u, Real(law_.u_0 - u));
                at(j).phase = d.response == CrackResponse::open ? 2 : 3;
            }
            active = active || d.is_active();
            at(j).G = at(j).G + G;
            dissipated = dissipated + inverse_length * G;
            for (int i = 0; i < 3; ++i) at(j).u[i] = at(j).u[i] + d.n * f.n[i] + d.t * f.t[i] + d.p * f.p[i];
        }
    }
};

}  // namespace lode
