// The increment of CAM_CLAY as equal backward Euler steps, a given number or as many as a tolerance wants, with the
// tangent carried along (page 70, "Update algorithm", "Consistent tangent").
#pragma once

#include <array>

#include "lode/material/point.hpp"
#include "lode/soil/cam_clay_return.hpp"

namespace lode {

// sqrt(2/3) |e| of a deviator e.
template <AnalysisKind kind, class Real>
inline Real shear_invariant(const Stress<kind, Real>& e) {
    return sqrt(Real((2.0 / 3.0) * double_contraction(e, e)));
}

// Elastic strain (v and deviator e) and history along the steps of one increment.
template <AnalysisKind kind, class Real>
struct CamClayPath {
    Real v, pc, log_pc;
    Stress<kind, Real> e;
    Real compaction = Real(0.0), plastic_shear = Real(0.0), dissipation = Real(0.0), zone = Real(0.0);
    Mask<Real> failed = Mask<Real>(false);
    CamClayStep<Real> last;
};

// d eps^e/d eps (a column a strain component, tensor by engineering shears) and d ln pc/d eps after several steps.
template <AnalysisKind kind, bool wanted>
struct CamClaySensitivity {};
template <AnalysisKind kind>
struct CamClaySensitivity<kind, true> {
    std::array<Stress<kind, double>, std::size_t{components(kind)}> elastic;
    std::array<double, std::size_t{components(kind)}> log_pc;
};

struct CamClaySubsteps {
    CamClayReturn plasticity;
    int count;         // nsub
    double tolerance;  // stol

    static constexpr int most_steps = 1024;

    bool is_single_step() const { return count == 1 && tolerance == 0.0; }
    // One backward Euler step over the strain (dv, de).
    template <AnalysisKind kind, class Real>
    LODE_INLINE void advance(CamClayPath<kind, Real>& path, const Real& dv, const Stress<kind, Real>& de,
                             const SolveCounter<Real>& solves) const {
        Real s_start(0.0);
        if (plasticity.method == cam_clay::NEWTON_FROM_START) s_start = shear_invariant(path.e);
        path.e += de;
        const CamClayStep<Real> step =
            plasticity.step<Real>(path.v + dv, shear_invariant(path.e), path.pc, path.log_pc, path.v, s_start, solves);
        path.last = step;
        path.failed = path.failed || step.failed;
        path.v = step.v;
        path.pc = step.pc;
        path.log_pc = step.log_pc;
        if (!any(step.plastic)) return;
        assign(path.e, step.shear_ratio * path.e);
        path.compaction = path.compaction + step.plastic_compaction;
        path.plastic_shear = path.plastic_shear + (2.0 * plasticity.inverse_M_square) * (step.dgamma * step.q);
        path.dissipation = path.dissipation + step.dgamma * step.p * step.pc;
        Real zone = select(step.h > Real(0.0), Real(1.0), Real(2.0));
        if (plasticity.elasticity.alpha > 0.0) {
            const Mask<Real> convex = plasticity.elasticity.convexity(step.A, step.s) > Real(0.0);
            zone = zone + select(convex, Real(0.0), Real(10.0));
        }
        path.zone = select(step.plastic, zone, path.zone);
    }

    template <AnalysisKind kind, class Real, bool wanted>
    CamClayPath<kind, Real> several_steps(const CamClayPath<kind, Real>& start, const Real& dv,
                                          const Stress<kind, Real>& de, CamClaySensitivity<kind, wanted>& sensitivity,
                                          SolveCounter<Real> solves) const {
        if (tolerance > 0.0) return to_tolerance(start, dv, de, sensitivity, solves);
        return in_steps(count, start, dv, de, sensitivity, solves);
    }

    // C of a single step, from the derivatives T of (p, q) by (v_tr, s_tr); m = sqrt(2/3) n.
    template <AnalysisKind kind>
    void set_tangent(const CamClayStep<double>& end, const CamClayLinearStep& l, const Stress<kind, double>& e,
                     Tangent<kind>& c) const {
        constexpr int n = components(kind);
        const CamClayElasticity& elasticity = plasticity.elasticity;
        const double W_vv = end.p * elasticity.inverse_kappa, W_vs = elasticity.coupling_modulus(end.A, end.s);
        const double T11 = W_vv * l.v_vtr + W_vs * l.s_vtr, T12 = W_vv * l.v_str + W_vs * l.s_str;
        const double T21 = W_vs * l.v_vtr + 3.0 * end.mu * l.s_vtr, T22 = W_vs * l.v_str + 3.0 * end.mu * l.s_str;
        const double G = l.shear;
        const Stress<kind, double> m = (end.s > 1e-15 ? 2.0 / (3.0 * end.s) : 0.0) * e;
        for (int j = 0; j < n; ++j) {
            const double along_m = (T22 - 3.0 * G) * m[j] - (j < 3 ? T21 : 0.0);
            const double along_unit = (j < 3 ? T11 - (2.0 / 3.0) * G : 0.0) - T12 * m[j];
            for (int i = 0; i < n; ++i) c(i, j) = along_m * m[i] + (i < 3 ? along_unit : 0.0);
            c(j, j) += j < 3 ? 2.0 * G : G;
        }
    }

    // C = C_el E of several steps.
    template <AnalysisKind kind>
    void set_tangent(const CamClayStep<double>& end, const CamClaySensitivity<kind, true>& sensitivity,
                     const Stress<kind, double>& e, Tangent<kind>& c) const {
        const CamClayElasticity& elasticity = plasticity.elasticity;
        const double W_vv = end.p * elasticity.inverse_kappa;
        const double coupling = 2.0 * elasticity.alpha * elasticity.inverse_kappa * end.A;
        for (int column = 0; column < components(kind); ++column) {
            const Stress<kind, double>& x = sensitivity.elastic[static_cast<std::size_t>(column)];
            const double dv = -trace(x);
            const double dp = W_vv * dv + coupling * double_contraction(e, x);
            const Stress<kind, double> dx = deviator(x);
            for (int i = 0; i < components(kind); ++i)
                c(i, column) = 2.0 * end.mu * dx[i] + coupling * dv * e[i] - (i < 3 ? dp : 0.0);
        }
    }

  private:
    template <AnalysisKind kind, class Real, bool wanted>
    CamClayPath<kind, Real> in_steps(int steps, const CamClayPath<kind, Real>& start, const Real& dv,
                                     const Stress<kind, Real>& de, CamClaySensitivity<kind, wanted>& sensitivity,
                                     SolveCounter<Real> solves) const {
        CamClayPath<kind, Real> path = start;
        solves.count_substeps(steps);
        const double part = 1.0 / steps;
        const Real dv_part = part * dv;
        const Stress<kind, Real> de_part = part * de;
        for (int k = 0; k < steps; ++k) {
            const Stress<kind, Real> trial = path.e + de_part;
            advance(path, dv_part, de_part, solves);
            if constexpr (wanted) carry(sensitivity, path.last, trial, part, k == 0);
        }
        return path;
    }

    // Doubles the steps until the stress settles, lane by lane; the answer is the finer one.
    template <AnalysisKind kind, class Real, bool wanted>
    CamClayPath<kind, Real> to_tolerance(const CamClayPath<kind, Real>& start, const Real& dv,
                                         const Stress<kind, Real>& de, CamClaySensitivity<kind, wanted>& sensitivity,
                                         SolveCounter<Real> solves) const {
        CamClaySensitivity<kind, false> none;
        CamClayPath<kind, Real> coarse = in_steps(count, start, dv, de, none, solves), accepted;
        Mask<Real> settled = Mask<Real>(false);
        for (int steps = 2 * count;; steps *= 2) {
            const CamClayPath<kind, Real> fine = in_steps(steps, start, dv, de, sensitivity, solves);
            accepted = any(settled) ? merge(settled, accepted, fine) : fine;
            settled = settled || stress_change(coarse, fine) <= tolerance * fine.pc;
            if (all(settled) || 2 * steps > most_steps) return accepted;
            coarse = fine;
        }
    }
    // |sigma_b - sigma_a|. (The page takes the largest component, which depends on the axes: the answer would not turn
    // with the material. The norm is never less.)
    template <AnalysisKind kind, class Real>
    static Real stress_change(const CamClayPath<kind, Real>& a, const CamClayPath<kind, Real>& b) {
        const Stress<kind, Real> ds = (2.0 * b.last.mu) * b.e - (2.0 * a.last.mu) * a.e;
        const Real dp = b.last.p - a.last.p;
        return sqrt(Real(double_contraction(ds, ds) + 3.0 * dp * dp));
    }
    template <AnalysisKind kind, class Real>
    static CamClayPath<kind, Real> merge(const Mask<Real>& keep, const CamClayPath<kind, Real>& kept,
                                         const CamClayPath<kind, Real>& other) {
        using Path = CamClayPath<kind, Real>;
        using Step = CamClayStep<Real>;
        Path r = other;
        for (const auto member : {&Path::v, &Path::pc, &Path::log_pc, &Path::compaction, &Path::plastic_shear,
                                  &Path::dissipation, &Path::zone})
            r.*member = select(keep, kept.*member, other.*member);
        for (const auto member : {&Step::s, &Step::A, &Step::mu, &Step::p, &Step::q})
            r.last.*member = select(keep, kept.last.*member, other.last.*member);
        r.failed = (keep && kept.failed) || (!keep && other.failed);
        for (int i = 0; i < components(kind); ++i) r.e[i] = select(keep, kept.e[i], other.e[i]);
        return r;
    }

    // The chain rule over one more step.
    template <AnalysisKind kind>
    void carry(CamClaySensitivity<kind, true>& s, const CamClayStep<double>& step, const Stress<kind, double>& trial,
               double part, bool first) const {
        if (first) s = {};
        const CamClayLinearStep l = plasticity.linearised(step);
        const double s_trial = shear_invariant(trial);
        const double shear_ratio = l.shear / step.mu;  // s/s_tr, also on the axis
        const Stress<kind, double> direction = (s_trial > 1e-15 ? 1.0 / s_trial : 0.0) * trial;  // sqrt(3/2) n
        for (int column = 0; column < components(kind); ++column) {
            const auto k = static_cast<std::size_t>(column);
            Stress<kind, double>& x = s.elastic[k];
            x[column] += column < 3 ? part : 0.5 * part;
            const double dv_trial = -trace(x), ds_trial = (2.0 / 3.0) * double_contraction(direction, x);
            const double dv = l.v_vtr * dv_trial + l.v_str * ds_trial + l.v_pc * s.log_pc[k];
            const double ds = l.s_vtr * dv_trial + l.s_str * ds_trial + l.s_pc * s.log_pc[k];
            x = shear_ratio * deviator(x) + (ds - shear_ratio * ds_trial) * direction;
            add_to_normals(x, 3, dv * (-1.0 / 3.0));
            if (step.plastic) s.log_pc[k] += (dv_trial - dv) * plasticity.inverse_theta;
        }
    }
};

}  // namespace lode
