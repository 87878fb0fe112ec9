// VISCOELASTIC: isotropic viscoelasticity by Prony series in shear and volume (page 60, section 2; Nairn, chapter 10).
//     s = 2 b (G0 e + sum Gk b_k),     -P = b (K0 V + sum Kk th_k),     V = tr eps - 3 eres
//     b_k' = e' - b_k/tauk,  th_k' = V' - th_k/tauKk in reduced time;  b = b_T(T) b_c(c), the vertical shift
// The stress changes by the difference of two total stresses, so that an initial stress of the host survives.
#pragma once

#include "lode/hyperelastic/plane_stress.hpp"
#include "lode/viscoelastic/isotropic_stiffness.hpp"
#include "lode/viscoelastic/piecewise_linear.hpp"
#include "lode/viscoelastic/pressure_law.hpp"
#include "lode/viscoelastic/viscoelastic_description.hpp"

namespace lode {

namespace viscoelastic {

// What the constants mean.
struct Constants {
    double K0, G0;
    PronySeries shear, bulk;
    double thermal_expansion, moisture_expansion;
    Recursion recursion;
    PressureLaw pressure;
    ReducedTime time;
    PiecewiseLinear temperature_factor, moisture_factor;
    bool has_vertical_shift = temperature_factor.is_not_one() || moisture_factor.is_not_one();

    bool expands() const { return thermal_expansion != 0.0 || moisture_expansion != 0.0; }
    int state_count() const { return FIRST_ELEMENT - 1 + 6 * shear.count + bulk.count; }
    static constexpr int most_state = FIRST_ELEMENT - 1 + 7 * most_prony_terms;
};

// Each has code of its own.
enum class Variant {
    plain,      // no shift, linear pressure, recursions 0, 1, 3
    nonlinear,  // the same with PLAW > 0
    uniform,    // the reduced time increment is DTIME
    shifted     // each point has its own
};

// A point's numbers without their derivatives.
template <class Real>
using Plain = std::conditional_t<is_batch<Real>, Batch, double>;

// Both series over one increment.
template <class X>
struct SeriesStep {
    X dtr;
    PronyStep<X> shear, bulk;

    LODE_INLINE SeriesStep(const Constants& c, const X& reduced_time)
        : dtr(reduced_time), shear(c.shear, c.recursion, reduced_time), bulk(c.bulk, c.recursion, reduced_time) {}
};

// The total strain and the strains b_k turned by DROT, the rest as it was.
template <AnalysisKind kind, class Real>
[[gnu::noinline]] void turn_state(const State<Real> state, int elements, int count, const Matrix3<Real> q,
                                  Real* turned) {
    for (int i = 0; i < count; ++i) turned[i] = state[i + 1];
    constexpr AnalysisKind full = with_thickness(kind);
    for (int k = 0; k <= elements; ++k) {
        Real* const first = turned + (k == 0 ? EPS - 1 : FIRST_ELEMENT - 1 + 6 * (k - 1));
        Strain<full, Real> strain;
        for (int i = 0; i < strain.size(); ++i) strain[i] = first[i];
        strain = rotate<full, Real>(strain, q);
        for (int i = 0; i < strain.size(); ++i) first[i] = strain[i];
    }
}

// The material over increments of one DTIME.
template <Variant variant>
class Update {
  public:
    LODE_INLINE Update(const Constants& constants, TimeIncrement dt) : c(constants), steps(make_steps(constants, dt)) {}

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        if constexpr (variant == Variant::shifted) {
            using X = Plain<Real>;
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
    using Shared = std::conditional_t<variant == Variant::shifted, None, SeriesStep<double>>;
    LODE_INLINE static Shared make_steps(const Constants& constants, TimeIncrement dt) {
        if constexpr (variant == Variant::shifted) return {};
        else return SeriesStep<double>(constants, max(dt.value, 0.0));
    }
    static constexpr bool is_plain = variant == Variant::plain;
    static constexpr bool has_options = variant == Variant::uniform || variant == Variant::shifted;
    LODE_INLINE bool has_linear_pressure() const { return is_plain || (has_options && c.pressure.is_linear()); }
    LODE_INLINE bool is_trapezoidal() const { return has_options && c.recursion == Recursion::trapezoidal; }

    const Constants& c;
    [[no_unique_address]] Shared steps;

    // Components that are computed: all normal ones and the shears that the kind has.
    template <AnalysisKind kind>
    static constexpr int size = 3 + shear_components(kind);
    template <AnalysisKind kind, class Real>
    using Tensor = Vector<Real, size<kind>>;

    // a : b of strains with engineering shears.
    template <class V>
    LODE_INLINE static auto contraction(const V& a, const V& b) {
        auto normal = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        if constexpr (V::size() > 3) {
            auto shear = a[3] * b[3];
            for (int i = 4; i < V::size(); ++i) shear = shear + a[i] * b[i];
            normal = normal + 0.5 * shear;
        }
        return normal;
    }
    template <class V>
    LODE_INLINE static V deviator(const V& strain) {
        const auto mean = (1.0 / 3.0) * (strain[0] + strain[1] + strain[2]);
        V d = strain;
        for (int i = 0; i < 3; ++i) d[i] = d[i] - mean;
        return d;
    }

    // The volume of PLAW > 0: J and Jres less one, before and after.
    template <class Real>
    struct Volume {
        Real j0, res0, j1, res1;
    };

    template <AnalysisKind kind, class Real, class T, class X>
    LODE_INLINE void advance(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent,
                             const SeriesStep<X>& step) const {
        constexpr int n = size<kind>;
        constexpr bool has_lateral = kind == AnalysisKind::plane_stress || kind == AnalysisKind::uniaxial;
        constexpr bool can_turn = !is_batch<Real> && kind != AnalysisKind::uniaxial;
        const int elements = c.shear.count, bulk_elements = c.bulk.count;
        const bool is_linear = has_linear_pressure();
        const bool trapezoidal = is_trapezoidal();

        // Free strain; the vertical shift at both ends.
        Real free_strain(0.0);
        if (c.expands()) {
            if (c.thermal_expansion != 0.0) free_strain = c.thermal_expansion * increment.temperature_increment();
            if (c.moisture_expansion != 0.0)
                free_strain = free_strain + c.moisture_expansion * increment.field_increment(1);
            const Mask<Real> finite = is_finite(free_strain);
            if (!all(finite)) [[unlikely]]
                return point.fail(!finite, "temperature or field 1 is not finite");
        }
        Plain<Real> b0(1.0), b1(1.0);
        const bool shifts_vertically = has_options && c.has_vertical_shift;
        if (shifts_vertically && !vertical_shift(increment, point, b0, b1)) [[unlikely]]
            return;

        // History, in the frame of the end.
        State<Real>& state = point.state;
        State<Real> old = state;
        [[maybe_unused]] std::conditional_t<can_turn, Real[Constants::most_state], None> turned;
        if constexpr (can_turn) {
            if (increment.turns()) [[unlikely]] {
                turn_state<kind, Real>(state, elements, c.state_count(), increment.rotation(), turned);
                old = State<Real>(turned, nullptr, 1, c.state_count());
            }
        }
        Tensor<kind, Real> eps;
        for (int i = 0; i < n; ++i) eps[i] = old[EPS + i];
        const Real res_old = old[ERES], tr_old = old[TR], diss_old = old[DISS];
        const Tensor<kind, Real> e0 = deviator(eps);
        const Real V0 = eps[0] + eps[1] + eps[2] - 3.0 * res_old;

        Tensor<kind, Real> d;  // DSTRAN, with the lateral strain
        for (int i = 0; i < 3; ++i)
            d[i] = i < normal_components(kind) ? increment.strain_increment[i % components(kind)] : Real(0.0);
        for (int i = 3; i < n; ++i) d[i] = increment.strain_increment[i - 3 + normal_components(kind)];

        const X G = c.G0 + step.shear.driven, K = c.K0 + step.bulk.driven;  // Geff/b, Keff/b of the linear law
        Volume<Real> volume{Real(0.0), Real(0.0), Real(0.0), Real(0.0)};
        if (!is_linear) {
            volume.j0 = old[JM1], volume.res0 = old[JRESM1];
            volume.res1 = expands_now(free_strain) ? grown(volume.res0, 3.0 * free_strain) : volume.res0;
        }
        if constexpr (has_lateral) {
            Mask<Real> solved(true);
            const Real lateral =
                lateral_strain<kind>(old, step, d, e0[2], V0, free_strain, volume, eps, solved, point.solves);
            if (!all(solved)) [[unlikely]]
                return point.fail(!solved, "no lateral strain makes the lateral stress vanish");
            d[2] = lateral;
            if constexpr (kind == AnalysisKind::uniaxial) d[1] = lateral;
        }
        const Real stretching = d[0] + d[1] + d[2], dV = stretching - 3.0 * free_strain;
        const Tensor<kind, Real> de = deviator(d);

        // -P/b before and after and its derivative by ln J, for PLAW > 0.
        Real pressure_old(0.0), pressure(0.0), pressure_slope(0.0), volume_energy(0.0);
        if (!is_linear) {
            volume.j1 = grown(volume.j0, stretching);
            const auto p = c.pressure.change(volume.j0, volume.res0, volume.j1, volume.res1, dV);
            pressure_old = p.before;
            pressure = p.after;
            pressure_slope = p.slope;
            volume_energy = p.stored;
            const Mask<Real> sound = p.positive && is_finite(pressure + pressure_slope + volume_energy);
            if (!all(sound)) [[unlikely]]
                return point.fail(!sound, "the volume ratio left the range of numbers");
            if (!all(p.stiff)) [[unlikely]]
                return point.fail(!p.stiff, "PLAW = 3 has no stiffness where J/Jres >= e", 0.5);
        }

        // Shear elements: the stress they lose by relaxation, what they dissipate, and (b != 1) what they carried.
        Tensor<kind, Real> relaxed, carried;
        for (int i = 0; i < n; ++i) relaxed[i] = Real(0.0);
        if (shifts_vertically) {
            for (int i = 0; i < n; ++i) carried[i] = c.G0 * e0[i];
            for (int k = 0; k < elements; ++k)
                for (int i = 0; i < n; ++i) carried[i] = carried[i] + c.shear.G(k) * old[FIRST_ELEMENT + 6 * k + i];
        }
        Real dissipated = step.shear.dissipated * contraction(de, de);
        Real stored = c.G0 * contraction(e0 + de, e0 + de);
        const auto advance_elements = [&](auto follows_total) LODE_INLINE_LAMBDA {
            for (int k = 0; k < elements; ++k) {
                const double Gk = c.shear.G(k);
                const X u = step.shear.u[k], A = step.shear.A[k], E = 1.0 - u, Gu = Gk * u;
                const int first = FIRST_ELEMENT + 6 * k;
                Tensor<kind, Real> b, b_new;
                for (int i = 0; i < n; ++i) b[i] = old[first + i];
                for (int i = 0; i < n; ++i) b_new[i] = E * b[i] + A * de[i];
                for (int i = 0; i < n; ++i) relaxed[i] = relaxed[i] + Gu * b[i];
                if constexpr (follows_total) {
                    const X B = step.shear.B[k], GB = Gk * B;
                    for (int i = 0; i < n; ++i) b_new[i] = b_new[i] + B * e0[i], relaxed[i] = relaxed[i] - GB * e0[i];
                }
                dissipated =
                    dissipated + (step.shear.a11[k] * contraction(b, b) + step.shear.twice_a12[k] * contraction(b, de));
                stored = stored + Gk * contraction(b_new, b_new);
                for (int i = 0; i < n; ++i) state.set(first + i, b_new[i]);
                for (int i = n; i < 6; ++i) state.keep(first + i);
            }
        };
        // Two loops: what the trapezoidal rule keeps at hand is in the way of the others.
        if (trapezoidal) advance_elements(std::true_type{});
        else advance_elements(std::false_type{});
        dissipated = 2.0 * dissipated;
        // Bulk elements.
        const Real V1 = V0 + dV;
        Real mean_relaxed(0.0), mean_carried = c.K0 * V0;
        if (bulk_elements > 0) {
            dissipated = dissipated + step.bulk.dissipated * (dV * dV);
            for (int k = 0; k < bulk_elements; ++k) {
                const double Kk = c.bulk.G(k);
                const X u = step.bulk.u[k], A = step.bulk.A[k];
                const int at = FIRST_ELEMENT + 6 * elements + k;
                const Real th = old[at];
                Real th_new = (1.0 - u) * th + A * dV;
                mean_relaxed = mean_relaxed + (Kk * u) * th;
                if (trapezoidal) {
                    const X B = step.bulk.B[k];
                    th_new = th_new + B * V0;
                    mean_relaxed = mean_relaxed - (Kk * B) * V0;
                }
                mean_carried = mean_carried + Kk * th;
                dissipated = dissipated + (step.bulk.a11[k] * (th * th) + step.bulk.twice_a12[k] * (th * dV));
                stored = stored + 0.5 * Kk * (th_new * th_new);
                state.set(at, th_new);
            }
        }

        // new - old = b1 (S1 - S0) + (b1 - b0) S0
        Real mean_change = is_linear ? b1 * (K * dV - mean_relaxed) : b1 * (pressure - pressure_old);
        if (shifts_vertically) mean_change = mean_change + (b1 - b0) * (is_linear ? mean_carried : pressure_old);
        const Plain<Real> twice_b1 = 2.0 * b1, twice_db = 2.0 * (b1 - b0);
        Tensor<kind, Real> change;
        for (int i = 0; i < n; ++i) change[i] = G * de[i] - relaxed[i];
        for (int i = 0; i < components(kind); ++i) {
            const bool normal = i < normal_components(kind);
            const int j = normal ? i : i - normal_components(kind) + 3;
            if (normal) {
                point.stress[i] = point.stress[i] + (twice_b1 * change[j] + mean_change);
                if (shifts_vertically) point.stress[i] = point.stress[i] + twice_db * carried[j];
            } else {
                point.stress[i] = point.stress[i] + b1 * change[j];
                if (shifts_vertically) point.stress[i] = point.stress[i] + (b1 - b0) * carried[j];
            }
        }
        if (has_options) dissipated = b1 * dissipated;
        const Real energy = (is_linear ? 0.5 * c.K0 * (V1 * V1) : volume_energy) + stored;
        point.elastic_energy = b1 * energy;
        point.viscous_dissipation = dissipated;
        if constexpr (kind == AnalysisKind::plane_stress) point.thickness_strain_increment = d[2];

        for (int i = 0; i < n; ++i) state.set(EPS + i, eps[i] + d[i]);
        for (int i = n; i < 6; ++i) state.keep(EPS + i);
        state.set(ERES, res_old + free_strain);
        state.set(TR, tr_old + step.dtr);
        state.set(DISS, diss_old + dissipated);
        if (is_linear) {
            state.keep(JM1);
            state.keep(JRESM1);
        } else {
            state.set(JM1, volume.j1);
            state.set(JRESM1, volume.res1);
        }

        if constexpr (wants_tangent<T>) {
            const double held_back = set_isotropic_stiffness(tangent, b1 * G, b1 * (is_linear ? K : pressure_slope));
            if (c.thermal_expansion != 0.0)
                for (int i = 0; i < normal_components(kind); ++i)
                    tangent.thermal_stress[i] = -c.thermal_expansion * held_back;
        }
    }

    // False where nothing expands, so that no exponential is needed. (A derivative can be there nevertheless.)
    template <class Real>
    LODE_INLINE bool expands_now(const Real& free_strain) const {
        return c.expands() && (is_differentiated<Real> || any(free_strain != Real(0.0)));
    }

    // b at both ends; false where temperature or field 1 is not finite, and the point has failed.
    template <AnalysisKind kind, class Real>
    LODE_INLINE bool vertical_shift(const Increment<kind, Real>& increment, Point<kind, Real>& point, Plain<Real>& b0,
                                    Plain<Real>& b1) const {
        using X = Plain<Real>;
        const auto constant = [](const PiecewiseLinear& f) { return f.is_constant() ? f.largest() : 1.0; };
        b0 = b1 = X(constant(c.temperature_factor) * constant(c.moisture_factor));
        const auto multiply = [&](const PiecewiseLinear& factor, const X& start, const X& change) {
            const Mask<X> finite = is_finite(start + change);
            if (!all(finite)) [[unlikely]] {
                point.fail(!finite, "temperature or field 1 is not finite");
                return false;
            }
            b0 = b0 * factor(start);
            b1 = b1 * factor(start + change);
            return true;
        };
        if (!c.temperature_factor.is_constant() &&
            !multiply(c.temperature_factor, value_of(increment.temperature_start()),
                      value_of(increment.temperature_increment())))
            return false;
        return c.moisture_factor.is_constant() ||
               multiply(c.moisture_factor, value_of(increment.field_start(1)), value_of(increment.field_increment(1)));
    }

    // The lateral strain increment that makes the lateral stress of the end vanish. Only component 33 matters: in 1D
    // 22 is like it.
    template <AnalysisKind kind, class Real, class X>
    LODE_INLINE Real lateral_strain(const State<Real>& old, const SeriesStep<X>& step, const Tensor<kind, Real>& d,
                                    const Real& e0, const Real& V0, const Real& free_strain, const Volume<Real>& volume,
                                    const Tensor<kind, Real>& eps, Mask<Real>& solved,
                                    const SolveCounter<Real>& solves) const {
        constexpr double lateral_components = kind == AnalysisKind::uniaxial ? 2.0 : 1.0;
        const bool trapezoidal = is_trapezoidal();
        const X G = c.G0 + step.shear.driven;
        const Real trace = d[0] + d[1] + d[2], de = d[2] - (1.0 / 3.0) * trace;
        Real half = c.G0 * e0 + G * de;
        for (int k = 0; k < c.shear.count; ++k) {
            const double Gk = c.shear.G(k);
            const Real b = old[FIRST_ELEMENT + 6 * k + 2];
            half = half + Gk * ((1.0 - step.shear.u[k]) * b);
            if (trapezoidal) half = half + (Gk * step.shear.B[k]) * e0;
        }
        const X deviatoric_slope = (2.0 - (2.0 / 3.0) * lateral_components) * G;
        if (has_linear_pressure()) {
            const X K = c.K0 + step.bulk.driven;
            Real mean = c.K0 * V0 + K * (trace - 3.0 * free_strain);
            for (int k = 0; k < c.bulk.count; ++k) {
                mean = mean + c.bulk.G(k) * ((1.0 - step.bulk.u[k]) * old[FIRST_ELEMENT + 6 * c.shear.count + k]);
                if (trapezoidal) mean = mean + (c.bulk.G(k) * step.bulk.B[k]) * V0;
            }
            const X compliance = 1.0 / (deviatoric_slope + lateral_components * K);
            return -compliance * (2.0 * half + mean);
        }
        const LateralStress<Real> equation{c.pressure, 2.0 * half,  Real(deviatoric_slope), trace,
                                           volume.j0,  volume.res1, lateral_components};
        Real scale = abs(free_strain) + abs(eps[2]);
        for (int i = 0; i < normal_components(kind); ++i) scale = scale + (abs(d[i]) + abs(eps[i]));
        const auto root = solve_thickness(equation, Real(0.0), scale, solves);
        solved = root.converged;
        return root.y;
    }
};

template <Variant variant>
struct Kernel {
    const Constants* constants;
    LODE_INLINE Update<variant> prepared(TimeIncrement dt) const { return Update<variant>(*constants, dt); }
};

}  // namespace viscoelastic

struct Viscoelastic {
    static constexpr lode_model description = viscoelastic::description;

    explicit Viscoelastic(const Properties& p) : constants(read(p)) {}

    int required_state(AnalysisKind) const { return constants.state_count(); }

    // The instantaneous moduli. The temperature is not known here: the largest vertical shift is on the safe side.
    template <AnalysisKind kind>
    void initial_stiffness(const Stress<kind, double>&, const State<double>& state, Tangent<kind>& tangent) const {
        const double b = constants.temperature_factor.largest() * constants.moisture_factor.largest();
        double K = constants.K0 + constants.bulk.sum;
        if (!constants.pressure.is_linear())
            K = constants.pressure.modulus(
                constants.pressure.ratio(state[viscoelastic::JM1], state[viscoelastic::JRESM1]));
        set_isotropic_stiffness(tangent, b * (constants.G0 + constants.shear.sum), b * K);
    }

    // Calls f with the kernel that the options ask for.
    template <class F>
    LODE_INLINE void specialise(const F& f) const {
        using viscoelastic::Kernel, viscoelastic::Variant;
        switch (variant) {
            case Variant::plain:
                return f(Kernel<Variant::plain>{&constants});
            case Variant::nonlinear:
                return f(Kernel<Variant::nonlinear>{&constants});
            case Variant::uniform:
                return f(Kernel<Variant::uniform>{&constants});
            default:
                return f(Kernel<Variant::shifted>{&constants});
        }
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        specialise([&](const auto& k) LODE_INLINE_LAMBDA {
            k.prepared(increment.time_increment).template update<kind, Real>(increment, point, tangent);
        });
    }

  private:
    static viscoelastic::Constants read(const Properties& p) {
        using namespace viscoelastic;
        const int shear_terms = p.code(NG), bulk_terms = p.code(NK);
        const int options = FIRST_TERM + 2 * shear_terms + 2 * bulk_terms;
        const int points = options + FIRST_POINT, temperatures = p.code(options + NBT);
        Constants c{.K0 = p[K0],
                    .G0 = p[G0],
                    .shear = PronySeries(p, shear_terms, FIRST_TERM),
                    .bulk = PronySeries(p, bulk_terms, FIRST_TERM + 2 * shear_terms),
                    .thermal_expansion = p[options + ALPHA],
                    .moisture_expansion = p[options + BETA],
                    .recursion = static_cast<Recursion>(p.code(options + METH)),
                    .pressure = PressureLaw(p.code(options + PLAW), p[K0]),
                    .time = ReducedTime(p, options + SHIFTS),
                    .temperature_factor = PiecewiseLinear(p, temperatures, points),
                    .moisture_factor = PiecewiseLinear(p, p.code(options + NBC), points + 2 * temperatures)};
        if (!(c.G0 + c.shear.sum > 0.0)) p.refuse(G0, "> 0 where the sum of Gk is 0");
        if (!c.pressure.is_linear() && bulk_terms > 0) p.refuse(NK, "0 where PLAW > 0");
        return c;
    }

    viscoelastic::Constants constants;
    viscoelastic::Variant variant = choose(constants);

    static viscoelastic::Variant choose(const viscoelastic::Constants& c) {
        using viscoelastic::Variant;
        if (c.time.is_shifted()) return Variant::shifted;
        if (c.recursion == Recursion::trapezoidal || c.has_vertical_shift) return Variant::uniform;
        return c.pressure.is_linear() ? Variant::plain : Variant::nonlinear;
    }
};

}  // namespace lode
