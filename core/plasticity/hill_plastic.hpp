// HILL_PLASTIC: orthotropic elasticity and Hill's quadratic criterion in material axes (page 20, section 5; Nairn, eqs.
// 2.104-2.139). h = sqrt(sigma.A sigma) <= g(alpha), dep = mu A sigma; the two styles differ in the rule for alpha.
// Backward Euler, in one step or in NSUB substeps.
#pragma once

#include <variant>

#include "lode/elastic/known_field.hpp"
#include "lode/material/thermal_block.hpp"
#include "lode/plasticity/hill_frame.hpp"
#include "lode/plasticity/hill_plastic_description.hpp"
#include "lode/plasticity/hill_return.hpp"
#include "lode/plasticity/plastic_strain.hpp"
#include "lode/plasticity/substep_chain.hpp"

namespace lode {

namespace hill_plastic {

// What the constants mean, whatever the hardening law.
struct Constants {
    OrthotropicModuli elastic;
    HillCriterion hill;
    int style;
    std::array<double, 3> thermal_expansion, moisture_expansion;  // material axes
    std::array<double, 3> thermal_stiffness;                      // C a of the solid
    bool expands_with_heat, expands_with_moisture;
    ThermalBlock thermal;
    bool has_axes;  // ROTMODE 1
    TurnedAxes axes;
    bool tilted;  // out of the plane of a 2D element
    double tilt;
    int substeps;
};

// The model with one hardening law, so that each law gets code of its own.
template <class Law>
class Kernel {
  public:
    Kernel(const Constants& constants, const Law& hardening)
        : c(constants),
          hill_return(hardening, c.style, c.hill.reference),
          modes_3d(c.elastic, c.hill),
          modes_plane_strain(c.elastic, c.hill),
          modes_plane_stress(c.elastic, c.hill) {}

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        auto& state = point.state;
        if (kind != AnalysisKind::solid && c.tilted) [[unlikely]]
            return point.refuse(Mask<Real>(true), "the material axes of a 2D element may turn by ANGZ only: ANGY, ANGX",
                                Real(c.tilt), "0");
        MaterialFrame<kind, Real> frame;
        if (c.has_axes) frame.set(increment, state, hill_plastic::Q, c.axes);

        Course<kind, Real> course;
        const Strain<kind, Real> total = frame.to_material(increment.strain_increment);
        course.strain = total;
        const Real free_thickness = remove_free_strain(increment, state, course.strain);
        if (c.expands_with_heat || c.expands_with_moisture)
            if (!is_known(Real(trace(course.strain) + free_thickness), point,
                          "temperature or field 1 on entry is not finite"))
                return;
        course.alpha = state[EQPS];
        course.g = hill_return.at(course.alpha);
        const bool thermoelastic = c.thermal.is_thermoelastic();
        if (thermoelastic)
            if (!c.thermal.is_absolute(point, c.thermal.temperature(increment, state))) return;

        const Stress<kind, Real> stress = frame.to_material(point.stress);
        if (c.substeps > 1) [[unlikely]] {
            // Copies, so that the point itself stays in registers on the other way.
            const Course<kind, Real> done = in_substeps(stress, course, tangent, point.solves);
            course = done;
        } else {
            course.stress = stress;
            integrate(course, tangent, point.solves);
        }
        point.stress = frame.to_host(course.stress);
        point.elastic_energy = course.energy;
        point.plastic_dissipation = course.work;
        const Real heat = c.thermal.plastic_heat(course.heat, course.work);
        Real thermal_work = Real(0.0), volume_heat = Real(0.0);
        if constexpr (kind == AnalysisKind::plane_stress)
            point.thickness_strain_increment = course.thickness + free_thickness;
        if (thermoelastic) {
            // M : d eps_total, M = -C a
            for (int i = 0; i < normal_components(kind); ++i)
                thermal_work = thermal_work - thermal_stiffness(i) * total[i];
            if constexpr (kind == AnalysisKind::plane_stress)
                thermal_work = thermal_work - thermal_stiffness(2) * point.thickness_strain_increment;
            volume_heat = c.thermal.thermoelastic_heat(c.thermal.temperature(increment, state), thermal_work);
        }
        if constexpr (wants_tangent<T>) {
            set_heat_tangent(increment, state, course, heat + volume_heat, thermal_work, tangent);
            frame.turn(tangent);
        }

        if (c.has_axes) {
            for (int i = ThermalBlock::TAD; i < hill_plastic::Q; ++i) state.keep(i);
            frame.store(state, hill_plastic::Q);
        }
        c.thermal.store(increment, state, course.work, heat, volume_heat);
        if (keeps_plastic_strain(point)) store_plastic_strain(increment, point, frame.to_host(plastic_strain(course)));
        const Real total_equivalent = state[EQPE] + course.equivalent;
        state.set(EQPS, course.alpha);
        state.set(GREL, course.g.value);
        state.set(EQPE, total_equivalent);
        state.set(MU, course.mu);
    }

    template <AnalysisKind kind>
    void set_initial_stiffness(Tangent<kind>& tangent) const {
        VoigtMatrix<kind, double> stiffness;
        modes<kind>().set_stiffness(stiffness);
        if (c.has_axes) stiffness = rotate_stiffness<kind>(stiffness, c.axes.r);
        std::copy(stiffness.m.begin(), stiffness.m.end(), tangent.stiffness);
    }

  private:
    Constants c;
    HillReturn<Law> hill_return;
    HillModes<AnalysisKind::solid> modes_3d;
    HillModes<AnalysisKind::plane_strain> modes_plane_strain;
    HillModes<AnalysisKind::plane_stress> modes_plane_stress;

    template <AnalysisKind kind>
    LODE_INLINE const HillModes<kind>& modes() const {
        if constexpr (kind == AnalysisKind::solid) return modes_3d;
        else if constexpr (kind == AnalysisKind::plane_strain) return modes_plane_strain;
        else return modes_plane_stress;
    }

    // What an increment is and what it does, in material axes.
    template <AnalysisKind kind, class Real>
    struct Course {
        Strain<kind, Real> strain;  // mechanical part of DSTRAN
        Stress<kind, Real> stress;
        Real alpha;
        FlowStress<Real> g;
        Real work = Real(0.0), heat = Real(0.0);  // sigma:dep, and the heat of the source rule
        Real mu = Real(0.0), equivalent = Real(0.0), energy = Real(0.0);
        Strain<kind, Real> plastic_strain{};
        Real plastic_thickness = Real(0.0), thickness = Real(0.0);  // strains 33 of plane stress; mechanical
        // Of a tangent: how heat by the constants' rule and the thickness answer to the strain.
        Vector<double, components(kind)> heat_by_strain{}, thickness_by_strain{};
    };

    LODE_INLINE double thermal_stiffness(int i) const { return c.thermal_stiffness[static_cast<std::size_t>(i)]; }

    // Takes the thermal and the moisture strain off; returns their component 33.
    template <AnalysisKind kind, class Real>
    LODE_INLINE Real remove_free_strain(const Increment<kind, Real>& increment, const State<Real>& state,
                                        Strain<kind, Real>& strain) const {
        Real thickness(0.0);
        const auto remove = [&](const std::array<double, 3>& expansion, const Real& change) {
            for (int i = 0; i < normal_components(kind); ++i)
                strain[i] = strain[i] - expansion[static_cast<std::size_t>(i)] * change;
            thickness = thickness + expansion[2] * change;
        };
        if (c.expands_with_heat) remove(c.thermal_expansion, c.thermal.temperature_increment(increment, state));
        if (c.expands_with_moisture) remove(c.moisture_expansion, increment.field_increment(1));
        return thickness;
    }

    // One backward Euler step, page steps 1 to 4 in material axes.
    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void integrate(Course<kind, Real>& course, T& tangent, const SolveCounter<Real>& solves) const {
        constexpr int n = components(kind);
        const HillModes<kind>& m = modes<kind>();
        const Stress<kind, Real> before = course.stress;
        Stress<kind, Real> trial = m.stress(course.strain);
        trial += before;
        const HillStep<kind, Real> end = hill_return(m, m.to_modes(trial), course.alpha, course.g, solves);
        const Stress<kind, Real> after = m.from_modes(end.z);
        for (int i = 0; i < n; ++i) course.stress[i] = select(end.yields, after[i], trial[i]);
        course.energy = m.energy(end.z);

        const Strain<kind, Real> flow = m.flow(course.stress);
        for (int i = 0; i < n; ++i) course.plastic_strain[i] = course.plastic_strain[i] + end.mu * flow[i];
        if constexpr (kind == AnalysisKind::plane_stress) {
            const Real plastic = end.mu * (m.thickness_A[0] * course.stress[0] + m.thickness_A[1] * course.stress[1]);
            course.plastic_thickness = course.plastic_thickness + plastic;
            course.thickness = course.thickness + plastic + m.thickness_S[0] * (course.stress[0] - before[0]) +
                               m.thickness_S[1] * (course.stress[1] - before[1]);
        }
        if constexpr (wants_tangent<T>) set_tangent(m, end, course, tangent);
        course.alpha = course.alpha + end.dalpha;
        course.mu = course.mu + end.mu;
        course.equivalent = course.equivalent + end.mu * end.equivalent;
        course.g = end.g;
        course.work = course.work + end.work;
        course.heat = course.heat + end.heat;
    }

    // DDSDDE, and the rows of heat and thickness. `course` holds alpha and g of the start and the stress of the end.
    template <AnalysisKind kind>
    LODE_INLINE void set_tangent(const HillModes<kind>& m, const HillStep<kind, double>& end,
                                 Course<kind, double>& course, Tangent<kind>& tangent) const {
        constexpr int n = components(kind);
        HillSlopes<kind> d;
        if (end.yields) {
            hill_return.linearise(m, end, d);
        } else {
            m.set_stiffness(d.stiffness);
            for (int i = 0; i < n; ++i) d.mu[i] = d.alpha[i] = 0.0;
        }
        std::copy(d.stiffness.m.begin(), d.stiffness.m.end(), tangent.stiffness);
        if (end.yields && c.thermal.makes_plastic_heat()) {
            const HeatSlopes heat = heat_slopes(end, course);
            for (int i = 0; i < n; ++i) course.heat_by_strain[i] = heat.by_mu * d.mu[i] + heat.by_dalpha * d.alpha[i];
        }
        if constexpr (kind == AnalysisKind::plane_stress) {
            const double flow = m.thickness_A[0] * course.stress[0] + m.thickness_A[1] * course.stress[1];
            for (int j = 0; j < n; ++j)
                course.thickness_by_strain[j] = flow * d.mu[j] +
                                                (m.thickness_S[0] + end.mu * m.thickness_A[0]) * d.stiffness(0, j) +
                                                (m.thickness_S[1] + end.mu * m.thickness_A[1]) * d.stiffness(1, j);
        }
    }

    // Of dPhi, by mu, dalpha and alpha at the start.
    struct HeatSlopes {
        double by_mu, by_dalpha, by_alpha;
    };
    template <AnalysisKind kind>
    LODE_INLINE HeatSlopes heat_slopes(const HillStep<kind, double>& end, const Course<kind, double>& course) const {
        // heat mu g; work mu g (1 + R), where R dalpha is the integral of g - 1 from alpha to alpha + dalpha.
        const double g = end.g.value, R = hill_return.stored_ratio(course.alpha, end.dalpha, course.g, end.g);
        const double heat = end.mu * end.g.slope, work = heat * (1.0 + R), per_dalpha = end.mu * g / end.dalpha;
        return {c.thermal.plastic_heat(g, g * (1.0 + R)),
                c.thermal.plastic_heat(heat, work + per_dalpha * (g - 1.0 - R)),
                c.thermal.plastic_heat(heat, work + per_dalpha * (g - course.g.value))};
    }

    // The same after other substeps; the stress of the chain is that of the modes.
    template <AnalysisKind kind>
    LODE_INLINE void set_tangent(const HillModes<kind>& m, const HillStep<kind, double>& end,
                                 const Course<kind, double>& course, SubstepChain<kind>& chain) const {
        using Row = typename SubstepChain<kind>::Row;
        chain.add_strain();
        if (!end.yields) return;
        const HillResponse<kind> r = hill_return.respond(m, end);
        Row yield = -r.slope * chain.alpha, dalpha{};
        for (int k = 0; k < m.yielding; ++k) {
            yield += r.yield[k] * chain.stress[m.place(k)];
            dalpha += r.hardening[k] * chain.stress[m.place(k)];
        }
        const Row dmu = r.inverse_den * yield;
        dalpha += r.by_mu * dmu;
        for (int k = 0; k < m.yielding; ++k) {
            Row& z = chain.stress[m.place(k)];
            z = end.factor[k] * z - r.flow[k] * dmu;
        }
        if (c.thermal.makes_plastic_heat()) {
            const HeatSlopes heat = heat_slopes(end, course);
            chain.heat += heat.by_mu * dmu + heat.by_dalpha * dalpha + heat.by_alpha * chain.alpha;
        }
        if constexpr (kind == AnalysisKind::plane_stress)
            chain.thickness += (m.thickness_A[0] * course.stress[0] + m.thickness_A[1] * course.stress[1]) * dmu +
                               end.mu * (m.thickness_A[0] * normal_stress(m, chain, 0) +
                                         m.thickness_A[1] * normal_stress(m, chain, 1));
        chain.alpha += dalpha;
    }
    // Row i of B times the chain's stress.
    template <AnalysisKind kind>
    LODE_INLINE static auto normal_stress(const HillModes<kind>& m, const SubstepChain<kind>& chain, int i) {
        auto row = m.B[i][0] * chain.stress[0];
        for (int k = 1; k < m.normals; ++k) row += m.B[i][k] * chain.stress[k];
        return row;
    }
    template <AnalysisKind kind>
    LODE_INLINE void begin(const HillModes<kind>& m, SubstepChain<kind>& chain) const {
        const double share = 1.0 / c.substeps;
        for (int k = 0; k < m.normals; ++k)
            for (int j = 0; j < m.normals; ++j) chain.elastic[k][j] = share * m.B[j][k];
        for (int i = m.normals; i < m.n; ++i) chain.elastic[i][i] = share * m.shear_C[i - m.normals];
    }
    template <AnalysisKind kind>
    LODE_INLINE void finish(const HillModes<kind>& m, SubstepChain<kind>& chain, Course<kind, double>& course,
                            Tangent<kind>& tangent) const {
        typename SubstepChain<kind>::Row normal[m.normals];
        for (int i = 0; i < m.normals; ++i) normal[i] = normal_stress(m, chain, i);
        for (int i = 0; i < m.normals; ++i) chain.stress[i] = normal[i];
        if constexpr (kind == AnalysisKind::plane_stress)
            chain.thickness += m.thickness_S[0] * normal[0] + m.thickness_S[1] * normal[1];
        chain.store(tangent);
        for (int j = 0; j < m.n; ++j) {
            course.heat_by_strain[j] = chain.heat[j];
            course.thickness_by_strain[j] = chain.thickness[j];
        }
    }

    // METHOD 2.
    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void take_substeps(Course<kind, Real>& course, T& tangent, const SolveCounter<Real>& solves) const {
        const Strain<kind, Real> whole = course.strain;
        course.strain = Real(1.0 / c.substeps) * course.strain;
        solves.count_substeps(c.substeps);
        for (int k = 0; k < c.substeps; ++k) integrate(course, tangent, solves);
        course.strain = whole;
    }
    template <AnalysisKind kind, class Real, class T>
    [[gnu::noinline]] Course<kind, Real> in_substeps(Stress<kind, Real> stress, Course<kind, Real> course, T& tangent,
                                                     SolveCounter<Real> solves) const {
        course.stress = stress;
        if constexpr (wants_tangent<T>) {
            SubstepChain<kind> chain;
            begin(modes<kind>(), chain);
            take_substeps(course, chain, solves);
            finish(modes<kind>(), chain, course, tangent);
        } else {
            take_substeps(course, tangent, solves);
        }
        return course;
    }

    // In the layout of STATEV.
    template <AnalysisKind kind, class Real>
    LODE_INLINE static Strain<plastic_strain_layout(kind), Real> plastic_strain(const Course<kind, Real>& course) {
        if constexpr (kind == AnalysisKind::plane_stress) {
            const auto& e = course.plastic_strain;
            return {{e[0], e[1], course.plastic_thickness, e[2]}};
        } else {
            return course.plastic_strain;
        }
    }

    // Page 25, section 4, in material axes. Temperature acts through the thermal strain alone; `heat` is dPhi + H_is,
    // `thermal_work` M : d eps_total.
    template <AnalysisKind kind>
    LODE_INLINE void set_heat_tangent(const Increment<kind, double>& increment, const State<double>& state,
                                      const Course<kind, double>& course, double heat, double thermal_work,
                                      Tangent<kind>& tangent) const {
        const double rate = increment.time_increment.inverse;
        const bool feeds_host = !c.thermal.heats_itself();
        c.thermal.set_heat_rate(tangent, increment, heat);
        if (feeds_host)
            for (int j = 0; j < components(kind); ++j) tangent.heat_rate_strain[j] = rate * course.heat_by_strain[j];
        if (!c.expands_with_heat) return;
        const auto expansion = [this](int i) { return c.thermal_expansion[static_cast<std::size_t>(i)]; };
        set_thermal_strain_tangent(tangent, expansion);
        if (!(feeds_host && c.thermal.is_thermoelastic())) return;
        const double T = c.thermal.absolute(c.thermal.temperature(increment, state));
        const bool is_plane_stress = kind == AnalysisKind::plane_stress;
        const double by_thickness = is_plane_stress ? thermal_stiffness(2) : 0.0;
        double thickness_by_temperature = is_plane_stress ? expansion(2) : 0.0;
        for (int j = 0; j < components(kind); ++j) {
            const bool is_normal = j < normal_components(kind);
            const double direct = is_normal ? thermal_stiffness(j) : 0.0;
            tangent.heat_rate_strain[j] -= T * rate * (direct + by_thickness * course.thickness_by_strain[j]);
            if (is_normal) thickness_by_temperature -= expansion(j) * course.thickness_by_strain[j];
        }
        tangent.heat_rate_temperature += rate * (thermal_work - T * by_thickness * thickness_by_temperature);
    }
};

}  // namespace hill_plastic

struct HillPlastic {
    static constexpr const lode_model& description = hill_plastic::description;

    explicit HillPlastic(const Properties& p) : kernel(make_kernel(p)) {
        using namespace hill_plastic;
        const int thermal = ThermalBlock(p, TABS, false).required_state();
        state_count = p.code(ROTMODE) == 1 ? Q + 8 : std::max(4, thermal);
    }

    int required_state(AnalysisKind) const { return state_count; }

    template <AnalysisKind kind>
    void initial_stiffness(const Stress<kind, double>&, const State<double>&, Tangent<kind>& tangent) const {
        specialise([&](const auto& k) { k.set_initial_stiffness(tangent); });
    }

    // Calls f with the kernel of the hardening law at hand.
    template <class F>
    LODE_INLINE void specialise(const F& f) const {
        if (const auto* linear = std::get_if<0>(&kernel)) return f(*linear);
        if (const auto* saturation = std::get_if<1>(&kernel)) return f(*saturation);
        f(*std::get_if<2>(&kernel));
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        specialise([&](const auto& k) LODE_INLINE_LAMBDA { k.update(increment, point, tangent); });
    }

  private:
    template <class... Laws>
    using AnyKernel = std::variant<hill_plastic::Kernel<Laws>...>;
    using Kernel = AnyKernel<LinearHardening, SaturationHardening, PowerLaw>;

    static Kernel make_kernel(const Properties& p) {
        using namespace hill_plastic;
        const auto elastic = OrthotropicModuli::from_properties(p, E1);
        const auto hill = HillCriterion::from_properties(p, Y11);
        const HardeningLaw hardening(p, 1.0, HLAW, H1);
        if (hardening.is_softening())
            p.refuse("HILL_PLASTIC accepts hardening laws only: HLAW = " + std::to_string(p.code(HLAW)) +
                     " softens with these constants");
        if (p.code(METHOD) == 1) p.refuse(METHOD, "0 or 2: the exact integration of METHOD 1 is ISO_PLASTIC's");
        const std::array<double, 3> heat{p[A1], p[A1 + 1], p[A1 + 2]}, moisture{p[B1], p[B1 + 1], p[B1 + 2]};
        std::array<double, 3> thermal_stiffness;
        for (int i = 0; i < 3; ++i)
            thermal_stiffness[static_cast<std::size_t>(i)] = elastic.stiffness(i, 0) * heat[0] +
                                                             elastic.stiffness(i, 1) * heat[1] +
                                                             elastic.stiffness(i, 2) * heat[2];
        const auto present = [](const std::array<double, 3>& e) { return e[0] != 0.0 || e[1] != 0.0 || e[2] != 0.0; };
        const bool has_axes = p.code(ROTMODE) == 1;
        const bool tilted = has_axes && (p[ANGY] != 0.0 || p[ANGX] != 0.0);
        const Constants c{.elastic = elastic,
                          .hill = hill,
                          .style = p.code(STYLE),
                          .thermal_expansion = heat,
                          .moisture_expansion = moisture,
                          .thermal_stiffness = thermal_stiffness,
                          .expands_with_heat = present(heat),
                          .expands_with_moisture = present(moisture),
                          .thermal = ThermalBlock(p, TABS, false),
                          .has_axes = has_axes,
                          .axes = TurnedAxes(MaterialAxes::from_properties(p, ANGZ)),
                          .tilted = tilted,
                          .tilt = p[ANGY] != 0.0 ? p[ANGY] : p[ANGX],
                          .substeps = p.code(METHOD) == 2 ? p.code(NSUB) : 1};
        return hardening.visit<HillPlastic::Kernel>([&](const auto& law) -> HillPlastic::Kernel {
            using Law = std::decay_t<decltype(law)>;
            if constexpr (Law::softens) p.refuse(HLAW, "a law that hardens");
            else if constexpr (std::is_constructible_v<Kernel, hill_plastic::Kernel<Law>>)
                return hill_plastic::Kernel<Law>(c, law);
            else return hill_plastic::Kernel<PowerLaw>(c, PowerLaw(law));
        });
    }

    Kernel kernel;
    int state_count;
};

}  // namespace lode
