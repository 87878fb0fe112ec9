// VISCO_HYPER: Mooney-Rivlin solid whose isochoric stress relaxes (page 60, section 3; Nairn, 10.1.10 and 10.1.11).
// With Fb = J^(-1/3) F, Cb = Fb^T Fb, Z = G1 I + G2 (tr(Cb) I - Cb) and T = Z - (Z:Cb)/3 Cb^-1 in the reference frame:
//     H_k' + H_k/tau_k = T',     J sigma = J U' I + dev[Fb (g0 T + sum g_k H_k) Fb^T]
// at the mechanical deformation F* = F exp(-e). The stars of the page are dropped below. As dev[Fb T Fb^T] = dev z with
// z = G1 bb + G2 (tr(bb) bb - bb^2), bb = Fb Fb^T, one increment with the recursion H_k <- E_k H_k + A_k (T - T_n) has
//     J sigma = J U' I + dev y,  y = g* z + Fb X Fb^T,  g* = g0 + sum g_k A_k,  X = sum g_k (E_k H_k - A_k T_n)
#pragma once

#include "lode/hyperelastic/mooney_rivlin.hpp"
#include "lode/viscoelastic/isotropic_stiffness.hpp"
#include "lode/viscoelastic/visco_hyper_description.hpp"

namespace lode {

namespace visco_hyper {

struct Constants {
    double G1, G2;
    PronySeries series;  // of the shares g_k
    double long_time_share;
    DilatationalEnergy dilatation;
    ResidualStrain residual;
    Recursion recursion;
    ReducedTime time;

    int state_count() const { return FIRST_ELEMENT - 1 + 6 * series.count; }
};

template <class X>
struct SeriesStep {
    X dtr;
    PronyStep<X> terms;
    LODE_INLINE SeriesStep(const Constants& c, const X& reduced_time)
        : dtr(reduced_time), terms(c.series, c.recursion, reduced_time) {}
};

// F S F^T of a symmetric S; in the plane kinds F has no components 13, 23, 31, 32.
template <AnalysisKind full, class Real>
LODE_INLINE Stress<full, Real> pushed_forward(const Stress<full, Real>& s, const Matrix3<Real>& f) {
    if constexpr (full == AnalysisKind::solid) {
        return rotate<full, Real>(s, f);
    } else {
        Stress<full, Real> r;
        const Real a = f(0, 0) * s[0] + f(0, 1) * s[3], b = f(0, 0) * s[3] + f(0, 1) * s[1];
        const Real c = f(1, 0) * s[0] + f(1, 1) * s[3], d = f(1, 0) * s[3] + f(1, 1) * s[1];
        r[0] = a * f(0, 0) + b * f(0, 1);
        r[1] = c * f(1, 0) + d * f(1, 1);
        r[2] = f(2, 2) * f(2, 2) * s[2];
        r[3] = a * f(1, 0) + b * f(1, 1);
        return r;
    }
}
// Transposed cofactors of a symmetric tensor.
template <AnalysisKind full, class Real>
LODE_INLINE Stress<full, Real> adjugate_of(const Stress<full, Real>& a) {
    Stress<full, Real> r;
    r[0] = a[1] * a[2], r[1] = a[0] * a[2], r[2] = a[0] * a[1] - a[3] * a[3], r[3] = -a[3] * a[2];
    if constexpr (full == AnalysisKind::solid) {
        r[0] = r[0] - a[5] * a[5], r[1] = r[1] - a[4] * a[4], r[3] = r[3] + a[4] * a[5];
        r[4] = a[3] * a[5] - a[1] * a[4];
        r[5] = a[3] * a[4] - a[0] * a[5];
    }
    return r;
}

// The material over increments of one DTIME.
template <bool shifted>
class Update {
  public:
    LODE_INLINE Update(const Constants& constants, TimeIncrement dt) : c(constants), steps(make_steps(constants, dt)) {}

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        if constexpr (shifted) {
            using X = std::conditional_t<is_batch<Real>, Batch, double>;
            X dtr;
            if (!c.time.increment(increment, point, dtr)) [[unlikely]]
                return;
            const SeriesStep<X> own(c, dtr);
            advance(increment, point, tangent, own);
        } else {
            advance(increment, point, tangent, steps);
        }
    }

  private:
    struct None {};
    using Shared = std::conditional_t<shifted, None, SeriesStep<double>>;
    LODE_INLINE static Shared make_steps(const Constants& constants, TimeIncrement dt) {
        if constexpr (shifted) return {};
        else return SeriesStep<double>(constants, max(dt.value, 0.0));
    }

    const Constants& c;
    [[no_unique_address]] Shared steps;

    // tau33 of plane stress by y = ln F33: that of a Mooney-Rivlin solid with g* G1, g* G2 and of the pushed-forward X.
    template <class Real, class X>
    struct ThicknessEquation {
        MooneyRivlin::ThicknessEquation<Real, X> elastic;
        Real in_plane, X33;  // trace of the in-plane part of F X F^T

        LODE_INLINE Residual<Real> operator()(const Real& y) const {
            const Residual<Real> r = elastic(y);
            const Real stretch = 1.0 + expm1(y);
            const Real inverse2 = square(reciprocal_cbrt(elastic.area * stretch));
            const Real w33 = square(stretch) * X33, w = 2.0 * w33 - in_plane;
            return {r.value + (1.0 / 3.0) * inverse2 * w,
                    r.slope + (1.0 / 3.0) * inverse2 * (4.0 * w33 - (2.0 / 3.0) * w)};
        }
    };

    template <AnalysisKind kind, class Real, class T, class X>
    LODE_INLINE void advance(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent,
                             const SeriesStep<X>& step) const {
        constexpr bool is_plane_stress = kind == AnalysisKind::plane_stress;
        constexpr AnalysisKind full = with_thickness(kind);
        constexpr int n = components(full);
        State<Real>& state = point.state;
        const int terms = c.series.count;
        const Real e = c.residual.end(increment, state[ERES]);
        const Real f33m1_old = state[F33M1], tr = state[TR], dissipated_before = state[DISS];
        auto k = c.residual.mechanical(increment, e);

        Stress<full, Real> T_old, history;  // history: X
        for (int i = 0; i < n; ++i) T_old[i] = state[ELASTIC + i];
        for (int i = 0; i < n; ++i) history[i] = -step.terms.driven * T_old[i];
        for (int t = 0; t < terms; ++t) {
            const X carried = c.series.G(t) * (1.0 - step.terms.u[t]);
            for (int i = 0; i < n; ++i) history[i] = history[i] + carried * state[FIRST_ELEMENT + 6 * t + i];
        }
        const X g_star = c.long_time_share + step.terms.driven;

        if constexpr (is_plane_stress) {
            const Mask<Real> possible = k.jacobian > Real(0.0) && is_finite(trace(k.b));
            if (all(possible)) {
                const Stress<full, Real> flat = pushed_forward<full>(history, deformation(k));
                const Real in_plane = flat[0] + flat[1];
                const ThicknessEquation<Real, X> equation{
                    MooneyRivlin::ThicknessEquation<Real, X>(g_star * c.G1, g_star * c.G2, c.dilatation, k), in_plane,
                    history[2]};
                const Real scale = equation.elastic.scale() + (1.0 / (c.G1 + c.G2)) * (abs(in_plane) + abs(history[2]));
                const auto root = solve_thickness(equation, thickness_of_state(f33m1_old, e), scale, point.solves);
                if (!all(root.converged))
                    return point.fail(!root.converged, "no thickness stretch makes the stress 33 vanish");
                set_thickness(k, 1.0 + root.d, root.d);
            }
        }

        const VolumeRatio<Real> v = c.dilatation.volume_ratio(k.j, k.jacobian);
        const Real inverse2 = square(reciprocal_cbrt(v.J)), cube_root = v.J * inverse2;  // J^(-2/3), J^(1/3)
        const Matrix3<Real> f = deformation(k);
        const Stress<full, Real> w = inverse2 * pushed_forward<full>(history, f);
        const Real g1 = (c.G1 * g_star) * inverse2, g2 = (c.G2 * g_star) * inverse2 * inverse2;
        auto stress = g1 * k.b + w;
        if (c.G2 != 0.0) stress = g2 * ((1.0 + trace(k.b)) * k.b - square_of(k.b)) + stress;
        stress = v.inverse * deviator(stress);
        add_to_normals(stress, 3, c.dilatation.derivative(v));

        // T and H_k of the end and, in the frame of the end, the energies: per current volume. What an element
        // dissipates is that of h = dev(Fb H Fb^T) driven at a constant rate, which stays below what it has stored.
        const Stress<full, Real> T_new = instantaneous_stress<full>(k.h, k.j, cube_root, inverse2);
        const double inverse_modulus = 1.0 / (c.G1 + c.G2);
        Real energy =
            c.dilatation.energy(v) + c.long_time_share * MooneyRivlin::shape_energy(c.G1, c.G2, k, cube_root, inverse2);
        const auto dh = deviator(inverse2 * pushed_forward<full>(T_new - T_old, f));
        Real dissipated = step.terms.dissipated * double_contraction(dh, dh);
        for (int t = 0; t < terms; ++t) {
            const Stress<full, Real> H = term<full>(state, t), H_new = relaxed(step, t, H, T_old, T_new);
            const auto h0 = deviator(inverse2 * pushed_forward<full>(H, f));
            const auto h1 = deviator(inverse2 * pushed_forward<full>(H_new, f));
            energy = energy + (0.25 * c.series.G(t) * inverse_modulus) * double_contraction(h1, h1);
            dissipated = dissipated + (step.terms.a11[t] * double_contraction(h0, h0) +
                                       step.terms.twice_a12[t] * double_contraction(h0, dh));
        }
        dissipated = (0.5 * inverse_modulus) * dissipated;
        energy = v.inverse * energy;
        dissipated = v.inverse * dissipated;

        const Mask<Real> sound = v.J > Real(0.0) && is_finite(trace(stress) + energy + dissipated);
        if (!all(sound)) [[unlikely]]
            return point.fail(!sound, "det F <= 0, or the deformation is not finite");
        point.stress = without_thickness<kind>(stress);
        point.elastic_energy = energy;
        point.viscous_dissipation = dissipated;

        if constexpr (wants_tangent<T>) {
            set_tangent_of_kind<kind>(
                tangent, point.stress, c.residual.thermal_expansion != 0.0,
                [&](auto& t) LODE_INLINE_LAMBDA { set_tangent(k, v, inverse2, w, g_star, t); },
                [&](const auto& t) { return isotropic_thermal_stress(c.residual.thermal_expansion, t, stress); });
        }

        Real f33m1 = f33m1_old;
        if constexpr (is_plane_stress) {
            f33m1 = c.residual.total_thickness_change(k.h(2, 2), e);
            if (point.wants_thickness_strain)
                point.thickness_strain_increment = thickness_strain_change(f33m1_old, f33m1);
        }
        for (int t = 0; t < terms; ++t) {
            const Stress<full, Real> H_new = relaxed(step, t, term<full>(state, t), T_old, T_new);
            for (int i = 0; i < n; ++i) state.set(FIRST_ELEMENT + 6 * t + i, H_new[i]);
            for (int i = n; i < 6; ++i) state.keep(FIRST_ELEMENT + 6 * t + i);
        }
        for (int i = 0; i < n; ++i) state.set(ELASTIC + i, T_new[i]);
        for (int i = n; i < 6; ++i) state.keep(ELASTIC + i);
        state.set(ERES, e);
        state.set(TR, tr + step.dtr);
        state.set(DISS, dissipated_before + dissipated);
        state.set(F33M1, f33m1);
    }

    // I + H.
    template <AnalysisKind kind, class Real>
    LODE_INLINE static Matrix3<Real> deformation(const Kinematics<kind, Real>& k) {
        Matrix3<Real> f = k.h;
        for (int i = 0; i < 3; ++i) f(i, i) = 1.0 + f(i, i);
        return f;
    }

    // H_k of STATEV, and what becomes of it.
    template <AnalysisKind full, class Real>
    LODE_INLINE static Stress<full, Real> term(const State<Real>& state, int t) {
        Stress<full, Real> H;
        for (int i = 0; i < H.size(); ++i) H[i] = state[FIRST_ELEMENT + 6 * t + i];
        return H;
    }
    template <AnalysisKind full, class Real, class X>
    LODE_INLINE static Stress<full, Real> relaxed(const SeriesStep<X>& step, int t, const Stress<full, Real>& H,
                                                  const Stress<full, Real>& T_old, const Stress<full, Real>& T_new) {
        const X E = 1.0 - step.terms.u[t], A = step.terms.A[t];
        Stress<full, Real> r;
        for (int i = 0; i < r.size(); ++i) r[i] = E * H[i] + A * (T_new[i] - T_old[i]);
        return r;
    }

    // T = Z - (Z:Cb)/3 adj(Cb) in terms of a = Cb - I, so that nothing of order 1 cancels: with D = tr(a) I - a and
    // q = G1 + 2 G2, Z = q I + G2 D, adj(Cb) = I + D + adj(a) and (Z:Cb)/3 = q + m.
    template <AnalysisKind full, class Real>
    LODE_INLINE Stress<full, Real> instantaneous_stress(const Matrix3<Real>& h, const Real& j, const Real& cube_root,
                                                        const Real& inverse2) const {
        auto a = inverse2 * left_cauchy_green_minus_identity<full>(transpose(h));  // of C - I
        // J^(-2/3) - 1
        add_to_normals(a, 3, -inverse2 * j * (1.0 + cube_root) / (1.0 + cube_root + cube_root * cube_root));
        const Real t = trace(a);
        const double q = c.G1 + 2.0 * c.G2;
        const Real m = (1.0 / 3.0) * ((q + 2.0 * c.G2) * t + c.G2 * (t * t - double_contraction(a, a)));
        auto D = Real(-1.0) * a;
        add_to_normals(D, 3, t);
        const auto adjugate = adjugate_of(a);
        auto stress = (c.G2 - q - m) * D - (q + m) * adjugate;
        add_to_normals(stress, 3, -m);
        return stress;
    }

    // As in a Mooney-Rivlin solid with g* G1, g* G2, in which G1 Bbar (whose referential tensor is fixed as well) is
    // joined by w = Fb X Fb^T.
    template <AnalysisKind kind, AnalysisKind full>
    LODE_INLINE void set_tangent(const Kinematics<kind, double>& k, const VolumeRatio<double>& v, double inverse2,
                                 const Stress<full, double>& w, double g_star, Tangent<full>& tangent) const {
        auto b = k.b;
        add_to_normals(b, 3, 1.0);
        b = inverse2 * b;
        const double g1 = c.G1 * g_star * v.inverse, g2 = c.G2 * g_star * v.inverse;
        const auto stretching = g1 * b + v.inverse * w;
        const auto coupling = (-2.0 / 3.0) * stretching;
        const double volumetric = 2.0 / 9.0 * trace(stretching) + c.dilatation.stiffness(v);
        if (c.G2 != 0.0) {
            const auto m = trace(b) * b - square_of(b);
            auto cofactors = (-2.0 * g2) * m;  // cof Bbar = I2bar I - m, tr m = 2 I2bar
            add_to_normals(cofactors, 3, g2 * trace(m));
            set_coupled_tangent(tangent, stretching + g2 * m, volumetric + 4.0 / 9.0 * g2 * trace(m),
                                coupling - (4.0 / 3.0 * g2) * m, cofactors);
            return;
        }
        set_coupled_tangent(tangent, stretching, volumetric, coupling, 0.0);
    }
};

template <bool shifted>
struct Kernel {
    const Constants* constants;
    LODE_INLINE Update<shifted> prepared(TimeIncrement dt) const { return Update<shifted>(*constants, dt); }
};

}  // namespace visco_hyper

struct ViscoHyper {
    static constexpr lode_model description = visco_hyper::description;

    explicit ViscoHyper(const Properties& p) : constants(read(p)) {}

    int required_state(AnalysisKind) const { return constants.state_count(); }

    template <AnalysisKind kind>
    void initial_stiffness(const Stress<kind, double>&, const State<double>&, Tangent<kind>& tangent) const {
        set_isotropic_stiffness(tangent, constants.G1 + constants.G2, constants.dilatation.modulus);
    }

    template <class F>
    LODE_INLINE void specialise(const F& f) const {
        if (constants.time.is_shifted()) f(visco_hyper::Kernel<true>{&constants});
        else f(visco_hyper::Kernel<false>{&constants});
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        specialise([&](const auto& k) LODE_INLINE_LAMBDA {
            k.prepared(increment.time_increment).template update<kind, Real>(increment, point, tangent);
        });
    }

  private:
    static visco_hyper::Constants read(const Properties& p) {
        using namespace visco_hyper;
        const int terms = p.code(NG), options = FIRST_TERM + 2 * terms;
        Constants c{.G1 = p[G1],
                    .G2 = p[G2],
                    .series = PronySeries(p, terms, FIRST_TERM),
                    .long_time_share = 0.0,
                    .dilatation = {p.code(options + UJ), p[K]},
                    .residual = {p[options + ALPHA], p[options + BETA]},
                    .recursion = static_cast<Recursion>(p.code(options + METH)),
                    .time = ReducedTime(p, options + SHIFTS)};
        if (!(c.G1 + c.G2 > 0.0)) p.refuse(G1, "> 0 where G2 = 0");
        c.long_time_share = 1.0 - c.series.sum;
        if (!(c.long_time_share > 0.0))
            p.refuse(FIRST_TERM, "so that the sum of all shares, " + format_number(c.series.sum) + ", is < 1");
        return c;
    }

    visco_hyper::Constants constants;
};

}  // namespace lode
