// BISTABLE_ISO: an isotropic solid with two states (page 10, section 5; Nairn, section 1.5, eqs. 1.31-1.35). With
// f = dV/3 + alpha T + beta c the free strain of the present state
//     rule 1:     sigma jumps between sigma = C_0 (eps - f_0 1) and C_1 (eps - f_1 1) with tr eps
//     rules 2, 3: dsigma = C (deps - df 1) with the C of the state; the stress is continuous
#pragma once

#include <variant>

#include "lode/elastic/bistable_iso_description.hpp"
#include "lode/elastic/isotropic_moduli.hpp"
#include "lode/elastic/known_field.hpp"
#include "lode/material/properties.hpp"
#include "lode/tensor/matrix3.hpp"

namespace lode {

namespace bistable_iso {

inline constexpr int STATE = 1, STRAIN = 2, DT = 8, DC = 9, TRANSITIONS = 10;  // STATEV
inline constexpr int most_events = 8;                                          // in one increment

enum class Rule { dilation = 1, distortion = 2, von_mises = 3 };

// The tensors of the page have all three normal components: eps33 (1D: eps22 as well) is found with the law.
constexpr AnalysisKind with_normals(AnalysisKind kind) {
    return kind == AnalysisKind::solid ? kind : AnalysisKind::plane_strain;
}

// One of the two states.
struct Phase {
    IsotropicModuli elastic;
    double offset;  // dV/3
    double thermal_expansion, field_expansion;

    template <class Real>
    LODE_INLINE Real expansion(const Real& temperature, const Real& field) const {
        return thermal_expansion * temperature + field_expansion * field;
    }
    // Lateral strain by which a kind leaves its stress zero: eps33 = f - ratio (eps11 + eps22 - 2 f) in plane stress,
    // eps22 = eps33 = f - nu (eps11 - f) in 1D.
    template <AnalysisKind kind>
    LODE_INLINE double lateral_ratio() const {
        return kind == AnalysisKind::uniaxial ? elastic.poisson : elastic.lame / (elastic.lame + 2.0 * elastic.shear);
    }
    template <AnalysisKind kind, class Real>
    LODE_INLINE Real lateral_strain(const Strain<kind, Real>& strain, const Real& f) const {
        return f - lateral_ratio<kind>() * (trace(strain) - (1.0 * normal_components(kind)) * f);
    }
    // C (eps - f 1).
    template <AnalysisKind kind, class Real>
    LODE_INLINE Stress<kind, Real> stress(Strain<kind, Real> strain, const Real& f) const {
        add_to_normals(strain, normal_components(kind), -f);
        return elastic.stress<kind>(strain);
    }
};

struct Constants {
    Phase phase[2];
    double critical;
    bool reversible, split;
};

// Strain of STATEV in the axes of the end of the increment; the components of the kind.
template <AnalysisKind kind, class Real>
LODE_INLINE Strain<kind, Real> stored_strain(const Increment<kind, Real>& increment, const State<Real>& state) {
    constexpr int normals = normal_components(kind);
    Strain<kind, Real> e;
    for (int i = 0; i < components(kind); ++i) e[i] = state[STRAIN + (i < normals ? i : 3 + i - normals)];
    if constexpr (kind != AnalysisKind::uniaxial && !is_batch<Real>) {
        if (increment.has_rotation()) {
            bool turned = false;
            for (int i = 0; i < 9; ++i) turned |= increment.rotation_source[i] != (i % 4 == 0 ? 1.0 : 0.0);
            if (turned) e = rotate(e, increment.rotation());
        }
    }
    return e;
}

// With the lateral strain of the kinds that have one.
template <AnalysisKind kind, class Real>
LODE_INLINE Strain<with_normals(kind), Real> completed(const Strain<kind, Real>& e, const Real& lateral) {
    Strain<with_normals(kind), Real> full;
    if constexpr (kind == AnalysisKind::plane_stress) full = {{{e[0], e[1], lateral, e[2]}}};
    else if constexpr (kind == AnalysisKind::uniaxial) full = {{{e[0], lateral, lateral, Real(0.0)}}};
    else
        for (int i = 0; i < components(kind); ++i) full[i] = e[i];
    return full;
}

template <AnalysisKind kind, class Real>
LODE_INLINE void store_state(Point<kind, Real>& point, const Mask<Real>& deformed,
                             const Strain<with_normals(kind), Real>& strain, const Real& temperature, const Real& field,
                             const Real& transitions) {
    auto& state = point.state;
    const Real thickness_before = state[STRAIN + 2];
    state.set(STATE, select(deformed, Real(1.0), Real(0.0)));
    for (int i = 0; i < 6; ++i) {
        if (i < strain.size()) state.set(STRAIN + i, strain[i]);
        else state.keep(STRAIN + i);
    }
    state.set(DT, temperature);
    state.set(DC, field);
    state.set(TRANSITIONS, transitions);
    if constexpr (kind == AnalysisKind::plane_stress) point.thickness_strain_increment = strain[2] - thickness_before;
}

template <Rule rule>
class Kernel;

// Rule 1: the two total laws.
template <>
class Kernel<Rule::dilation> {
  public:
    explicit Kernel(const Constants& constants) : c(constants) {}

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        const Phase &initial = c.phase[0], &other = c.phase[1];
        const auto& state = point.state;
        const Strain<kind, Real> strain_old = stored_strain(increment, state);
        const Strain<kind, Real> strain = strain_old + increment.strain_increment;
        const Real temperature_old = state[DT], field_old = state[DC], transitions_old = state[TRANSITIONS];
        const Real temperature = temperature_old + increment.temperature_increment();
        Real field = field_old;
        if (initial.field_expansion != 0.0 || other.field_expansion != 0.0) {
            field = field + increment.field_increment(1);
            if (!is_known(field, point)) return;
        }

        // tr eps by the law of each state: in plane stress and 1D they differ.
        const Real f_0 = initial.expansion(temperature, field),
                   f_1 = other.offset + other.expansion(temperature, field);
        const Real lateral_0 = initial.lateral_strain<kind>(strain, f_0);
        const Real lateral_1 = other.lateral_strain<kind>(strain, f_1);
        const Mask<Real> reached_0 = trace(completed<kind>(strain, lateral_0)) >= Real(c.critical);
        const Mask<Real> reached_1 = trace(completed<kind>(strain, lateral_1)) >= Real(c.critical);
        const Mask<Real> was_deformed = state[STATE] > Real(0.5);
        const Mask<Real> deformed = reached_0 || (was_deformed && (Mask<Real>(!c.reversible) || reached_1));

        const Real f_old_0 = initial.expansion(temperature_old, field_old);
        const Real f_old_1 = other.offset + other.expansion(temperature_old, field_old);
        point.stress += total_stress<kind>(deformed, strain, f_0, f_1);
        point.stress = point.stress - total_stress<kind>(was_deformed, strain_old, f_old_0, f_old_1);
        point.elastic_energy =
            select(deformed, other.elastic.energy<kind>(point.stress), initial.elastic.energy<kind>(point.stress));
        if constexpr (wants_tangent<T>) {
            const Phase& now = deformed ? other : initial;
            now.elastic.set_stiffness<kind>(tangent);
            for (int i = 0; i < normal_components(kind); ++i)
                tangent.thermal_stress[i] = -now.thermal_expansion * now.elastic.thermal_stiffness<kind>();
        }
        const Mask<Real> flips = (deformed && !was_deformed) || (was_deformed && !deformed);
        store_state(point, deformed, completed<kind>(strain, Real(select(deformed, lateral_1, lateral_0))), temperature,
                    field, Real(transitions_old + select(flips, Real(1.0), Real(0.0))));
    }

  private:
    Constants c;

    template <AnalysisKind kind, class Real>
    LODE_INLINE Stress<kind, Real> total_stress(const Mask<Real>& deformed, const Strain<kind, Real>& strain,
                                                const Real& f_0, const Real& f_1) const {
        const auto a = c.phase[0].stress<kind>(strain, f_0), b = c.phase[1].stress<kind>(strain, f_1);
        Stress<kind, Real> s;
        for (int i = 0; i < components(kind); ++i) s[i] = select(deformed, b[i], a[i]);
        return s;
    }
};

// Rules 2 and 3: a change of slope where the distortion or the von Mises stress reaches the critical value. Along a
// strain ramp the criterion is quadratic, so that transitions within the increment are found exactly.
template <Rule rule>
class Kernel {
  public:
    explicit Kernel(const Constants& constants) : c(constants) {}

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        const auto& state = point.state;
        const Real temperature_increment = increment.temperature_increment();
        const Real temperature = state[DT] + temperature_increment, transitions_old = state[TRANSITIONS];
        Real field = state[DC], field_increment = Real(0.0);
        if (c.phase[0].field_expansion != 0.0 || c.phase[1].field_expansion != 0.0) {
            field_increment = increment.field_increment(1);
            field = field + field_increment;
            if (!is_known(field, point)) return;
        }
        const Strain<kind, Real> strain_old = stored_strain(increment, state);
        const Real lateral_old = state[kind == AnalysisKind::uniaxial ? STRAIN + 1 : STRAIN + 2];

        // What the whole increment would be in each state.
        Rate<kind, Real> rate[2];
        for (int q = 0; q < 2; ++q) {
            const Real df = c.phase[q].expansion(temperature_increment, field_increment);
            rate[q].lateral = c.phase[q].template lateral_strain<kind>(increment.strain_increment, df);
            rate[q].stress = c.phase[q].template stress<kind>(increment.strain_increment, df);
            rate[q].measure = measure<kind>(increment.strain_increment, rate[q].lateral, rate[q].stress);
        }
        const auto start = measure<kind>(strain_old, lateral_old, point.stress);
        const Mask<Real> was_deformed = state[STATE] > Real(0.5);
        Course<Real> course = follow<kind>(start, rate, was_deformed);

        const Strain<kind, Real> strain = strain_old + increment.strain_increment;
        const Real lateral = lateral_old + course.time[0] * rate[0].lateral + course.time[1] * rate[1].lateral;
        for (int i = 0; i < components(kind); ++i)
            point.stress[i] = point.stress[i] + course.time[0] * rate[0].stress[i] + course.time[1] * rate[1].stress[i];
        if (!c.split) {
            const auto end = measure<kind>(strain, lateral, point.stress);
            const Mask<Real> reached = criterion(end, end) >= Real(0.0);
            course.deformed = reached || (was_deformed && Mask<Real>(!c.reversible));
            const Mask<Real> flips = (course.deformed && !was_deformed) || (was_deformed && !course.deformed);
            course.events = select(flips, Real(1.0), Real(0.0));
        }
        point.elastic_energy = select(course.deformed, c.phase[1].elastic.template energy<kind>(point.stress),
                                      c.phase[0].elastic.template energy<kind>(point.stress));
        if constexpr (wants_tangent<T>) set_tangent<kind>(start, rate, was_deformed, course, tangent);
        store_state(point, course.deformed, completed<kind>(strain, lateral), temperature, field,
                    Real(transitions_old + course.events));
    }

  private:
    Constants c;
    static constexpr double factor = rule == Rule::distortion ? 0.5 : 1.5;

    // The deviator whose norm decides.
    template <AnalysisKind kind, class Real>
    using Measure = Stress<with_normals(kind), Real>;

    template <AnalysisKind kind, class Real>
    struct Rate {
        Real lateral;
        Stress<kind, Real> stress;
        Measure<kind, Real> measure;
    };

    // Parts of the increment spent in each state, and how it ends.
    template <class Real>
    struct Course {
        Real time[2] = {Real(0.0), Real(0.0)};
        Mask<Real> deformed;
        Real events = Real(0.0);
        // For the tangent: the transitions on the surface.
        struct Event {
            int phase;
            double time[2];
        };
        Event event[most_events];
        int count = 0;
    };

    template <AnalysisKind kind, class Real>
    LODE_INLINE static Measure<kind, Real> measure(const Strain<kind, Real>& strain, const Real& lateral,
                                                   const Stress<kind, Real>& stress) {
        if constexpr (rule == Rule::distortion) return deviator(completed<kind>(strain, lateral));
        else if constexpr (kind == AnalysisKind::plane_stress)
            return deviator(Measure<kind, Real>{{{stress[0], stress[1], Real(0.0), stress[2]}}});
        else if constexpr (kind == AnalysisKind::uniaxial)
            return deviator(Measure<kind, Real>{{{stress[0], Real(0.0), Real(0.0), Real(0.0)}}});
        else return deviator(stress);
    }
    // factor x : x - crit^2.
    template <class Tensor>
    LODE_INLINE auto criterion(const Tensor& x, const Tensor& y) const {
        return factor * double_contraction(x, y) - c.critical * c.critical;
    }

    // q(xi) = a xi^2 + b xi + c along the rate of the present state, from event to event. The measure is start +
    // time_0 rate_0 + time_1 rate_1 throughout, so that scalar products are enough.
    template <AnalysisKind kind, class Real>
    LODE_INLINE Course<Real> follow(const Measure<kind, Real>& start, const Rate<kind, Real> (&rate)[2],
                                    const Mask<Real>& was_deformed) const {
        Course<Real> course;
        course.deformed = was_deformed;
        if (!c.split) {
            course.time[0] = select(was_deformed, Real(0.0), Real(1.0));
            course.time[1] = select(was_deformed, Real(1.0), Real(0.0));
            return course;
        }
        const double tolerance = 1e-12 * c.critical * c.critical;
        const Real slope_0 = 2.0 * factor * double_contraction(start, rate[0].measure);
        const Real slope_1 = 2.0 * factor * double_contraction(start, rate[1].measure);
        const Real a_00 = factor * double_contraction(rate[0].measure, rate[0].measure);
        const Real a_01 = factor * double_contraction(rate[0].measure, rate[1].measure);
        const Real a_11 = factor * double_contraction(rate[1].measure, rate[1].measure);
        Real value = criterion(start, start), left = Real(1.0);
        Mask<Real> active(true), &deformed = course.deformed;
        for (int event = 0; event < most_events; ++event) {
            const Real a = select(deformed, a_11, a_00);
            const Real b = select(deformed, slope_1 + 2.0 * (a_01 * course.time[0] + a_11 * course.time[1]),
                                  slope_0 + 2.0 * (a_00 * course.time[0] + a_01 * course.time[1]));
            const Real discriminant = b * b - 4.0 * a * value;
            const Mask<Real> crosses = discriminant > Real(0.0);
            const Real root = sqrt(select(crosses, discriminant, Real(1.0)));
            const Mask<Real> outward = b > Real(0.0), inward = b < Real(0.0);
            // From state 0 the larger root, from state 1 the smaller one. A vanishing denominator means no rate.
            const Real up = select(outward, -2.0 * value, root - b) /
                            select(outward, b + root, select(a > Real(0.0), 2.0 * a, Real(1.0)));
            const Real down = 2.0 * value / select(inward, root - b, Real(1.0));
            const Mask<Real> up_now = value > Real(tolerance) || (value >= Real(-tolerance) && outward);
            const Mask<Real> down_now = value < Real(-tolerance) || (value <= Real(tolerance) && inward);
            const Mask<Real> at_once = (deformed && down_now) || (!deformed && up_now);
            const Real xi = select(at_once, Real(0.0), select(deformed, down, up));
            const Mask<Real> later =
                crosses && xi >= Real(0.0) && xi <= left && (!deformed || inward) && (deformed || a > Real(0.0));
            const Mask<Real> flips = active && (at_once || later) && (!deformed || Mask<Real>(c.reversible));

            const Real advance = select(active, select(flips, xi, left), Real(0.0));
            course.time[0] = course.time[0] + select(deformed, Real(0.0), advance);
            course.time[1] = course.time[1] + select(deformed, advance, Real(0.0));
            left = left - advance;
            active = flips;
            if (!any(active)) return course;
            // On the surface now, and exactly so.
            value = select(flips && !at_once, Real(0.0), value);
            if constexpr (std::is_same_v<Real, double>)
                if (!at_once) course.event[course.count++] = {deformed ? 1 : 0, {course.time[0], course.time[1]}};
            deformed = (flips && !deformed) || (!flips && deformed);
            course.events = course.events + select(flips, Real(1.0), Real(0.0));
        }
        // Chattering at the surface: the rest is done in state 1.
        course.time[1] = course.time[1] + select(active, left, Real(0.0));
        course.events = course.events + select(active && !deformed, Real(1.0), Real(0.0));
        deformed = deformed || active;
        return course;
    }

    // sigma = sigma_n + time_0 rate_0 + time_1 rate_1. With X the measure at an event in state s and r the other state,
    //     d time_s = -X : (time_0 dX_0 + time_1 dX_1 + X_r d time_r)/(X : X_s)
    // and after the last event the times change by opposite amounts.
    template <AnalysisKind kind>
    LODE_INLINE void set_tangent(const Measure<kind, double>& start, const Rate<kind, double> (&rate)[2],
                                 bool was_deformed, const Course<double>& course, Tangent<kind>& tangent) const {
        constexpr int n = components(kind), normals = normal_components(kind);
        if (course.count == 0) {
            // No transition on the way. In one step all of the increment has the slope of its start.
            const Phase& now = c.phase[c.split ? course.deformed : was_deformed];
            now.elastic.set_stiffness<kind>(tangent);
            for (int i = 0; i < normals; ++i)
                tangent.thermal_stress[i] = -now.thermal_expansion * now.elastic.thermal_stiffness<kind>();
            return;
        }
        Stress<kind, double> change[2] = {};  // d time by strain
        double heat[2] = {0.0, 0.0};          // d time by temperature
        for (int k = 0; k < course.count; ++k) {
            const auto& event = course.event[k];
            const int s = event.phase, r = 1 - s;
            Measure<kind, double> x = start;
            for (int i = 0; i < x.size(); ++i)
                x[i] += event.time[0] * rate[0].measure[i] + event.time[1] * rate[1].measure[i];
            const double inverse = -1.0 / double_contraction(x, rate[s].measure);
            const double crossed = double_contraction(x, rate[r].measure);
            Stress<kind, double> gradient[2];
            double by_temperature[2];
            for (int q = 0; q < 2; ++q) set_gradient<kind>(x, c.phase[q], gradient[q], by_temperature[q]);
            for (int i = 0; i < n; ++i)
                change[s][i] = inverse * (event.time[0] * gradient[0][i] + event.time[1] * gradient[1][i] +
                                          crossed * change[r][i]);
            heat[s] =
                inverse * (event.time[0] * by_temperature[0] + event.time[1] * by_temperature[1] + crossed * heat[r]);
        }
        const int last = course.deformed ? 1 : 0;
        for (int i = 0; i < n; ++i) change[last][i] = -change[1 - last][i];
        heat[last] = -heat[1 - last];

        std::array<double, static_cast<std::size_t>(n * n)> memory[2];
        for (int q = 0; q < 2; ++q) {
            Tangent<kind> stiffness{memory[q].data()};
            c.phase[q].elastic.template set_stiffness<kind>(stiffness);
        }
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                const auto k = static_cast<std::size_t>(i + n * j);
                tangent(i, j) = course.time[0] * memory[0][k] + course.time[1] * memory[1][k] +
                                rate[0].stress[i] * change[0][j] + rate[1].stress[i] * change[1][j];
            }
        for (int i = 0; i < n; ++i)
            tangent.thermal_stress[i] = rate[0].stress[i] * heat[0] + rate[1].stress[i] * heat[1];
        for (int q = 0; q < 2; ++q)
            for (int i = 0; i < normals; ++i)
                tangent.thermal_stress[i] -= course.time[q] * c.phase[q].thermal_expansion *
                                             c.phase[q].elastic.template thermal_stiffness<kind>();
    }

    // X : dX_q by strain increment and temperature increment, X being a deviator.
    template <AnalysisKind kind>
    LODE_INLINE static void set_gradient(const Measure<kind, double>& x, const Phase& phase,
                                         Stress<kind, double>& by_strain, double& by_temperature) {
        constexpr int n = components(kind), normals = normal_components(kind);
        const Strain<kind, double> in_kind = [&] {
            Strain<kind, double> e;
            for (int i = 0; i < n; ++i) e[i] = i < normals ? x[i] : 2.0 * x[3 + i - normals];
            return e;
        }();
        if constexpr (rule == Rule::von_mises) {
            by_strain = phase.elastic.template stress<kind>(in_kind);
            by_temperature =
                -phase.thermal_expansion * phase.elastic.template thermal_stiffness<kind>() * trace(in_kind);
        } else {
            for (int i = 0; i < n; ++i) by_strain[i] = i < normals ? in_kind[i] : 0.5 * in_kind[i];
            by_temperature = 0.0;
            if constexpr (normals < 3) {
                const double out = kind == AnalysisKind::uniaxial ? x[1] + x[2] : x[2];
                const double ratio = phase.lateral_ratio<kind>();
                for (int i = 0; i < normals; ++i) by_strain[i] -= ratio * out;
                by_temperature = phase.thermal_expansion * (1.0 + normals * ratio) * out;
            }
        }
    }
};

}  // namespace bistable_iso

struct BistableIso : BistableIsoDescription {
    explicit BistableIso(const Properties& p) : kernel(make_kernel(p)), phase{phases(p)} {}

    int required_state(AnalysisKind) const { return count_of(states); }

    template <AnalysisKind kind>
    void initial_stiffness(const Stress<kind, double>&, const State<double>& state, Tangent<kind>& tangent) const {
        phase[state[bistable_iso::STATE] > 0.5 ? 1 : 0].elastic.set_stiffness<kind>(tangent);
    }

    // Calls f with the kernel at hand.
    template <class F>
    LODE_INLINE void specialise(const F& f) const {
        if (const auto* dilation = std::get_if<0>(&kernel)) return f(*dilation);
        if (const auto* distortion = std::get_if<1>(&kernel)) return f(*distortion);
        f(*std::get_if<2>(&kernel));
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        specialise([&](const auto& k) LODE_INLINE_LAMBDA { k.update(increment, point, tangent); });
    }

  private:
    using Rule = bistable_iso::Rule;
    using Kernel = std::variant<bistable_iso::Kernel<Rule::dilation>, bistable_iso::Kernel<Rule::distortion>,
                                bistable_iso::Kernel<Rule::von_mises>>;

    static std::array<bistable_iso::Phase, 2> phases(const Properties& p) {
        const double alpha_0 = p[9], beta_0 = p[11];
        return {{{IsotropicModuli::from_bulk_shear(p[1], p[2]), 0.0, alpha_0, beta_0},
                 {IsotropicModuli::from_bulk_shear(p[3], p[4]), p[7] / 3.0, p.count() < 10 ? alpha_0 : p[10],
                  p.count() < 12 ? beta_0 : p[12]}}};
    }
    static Kernel make_kernel(const Properties& p) {
        const auto two = phases(p);
        const bistable_iso::Constants c{{two[0], two[1]}, p[6], p.code(8) == 1, p.code(13) == 1};
        switch (static_cast<Rule>(p.code(5))) {
            case Rule::dilation:
                return bistable_iso::Kernel<Rule::dilation>(c);
            case Rule::distortion:
                return bistable_iso::Kernel<Rule::distortion>(c);
            default:
                return bistable_iso::Kernel<Rule::von_mises>(c);
        }
    }

    Kernel kernel;
    std::array<bistable_iso::Phase, 2> phase;
};

}  // namespace lode
