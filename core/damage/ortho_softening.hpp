// ORTHO_SOFTENING: an orthotropic or transversely isotropic solid that softens on one crack plane (page 30; Nairn,
// chapter 5). Everything is done in material axes, where sigma = C (eps - eps_res - eps_c).
#pragma once

#include "lode/damage/ortho_softening_description.hpp"
#include "lode/damage/ortho_softening_planes.hpp"
#include "lode/damage/softening_update.hpp"
#include "lode/tensor/rotation.hpp"

namespace lode {

struct OrthoSoftening {
    static constexpr const lode_model& description = ortho_softening::description;

    explicit OrthoSoftening(const Properties& p)
        : crack(SofteningLaw(p, ortho_softening::LAW_I, ortho_softening::A1_I, ortho_softening::A2_I,
                             ortho_softening::FMIN),
                SofteningLaw(p, ortho_softening::LAW_II, ortho_softening::A1_II, ortho_softening::A2_II,
                             ortho_softening::FMIN),
                static_cast<TractionSurface>(p.code(ortho_softening::SURF)), p[ortho_softening::MIX_I],
                p[ortho_softening::MIX_II], p[ortho_softening::MU]),
          solid(p, crack.normal_law, crack.shear_law, crack.surface(), false),
          plane_stress(p, crack.normal_law, crack.shear_law, crack.surface(), true),
          fixed_length(p[ortho_softening::HFIX]),
          reduces_strength(p.code(ortho_softening::HPOL) == 1),
          deletes(p.code(ortho_softening::DELFLAG) == 1) {
        for (int i = 0; i < 3; ++i) {
            thermal[i] = p[ortho_softening::ALPHA + i];
            field[i] = p[ortho_softening::BETA + i];
            expands = expands || thermal[i] != 0.0;
            swells = swells || field[i] != 0.0;
        }
    }

    int required_state(AnalysisKind) const { return ortho_softening::count; }

    template <AnalysisKind kind>
    void initial_stiffness(const Stress<kind, double>&, const State<double>& state, Tangent<kind>& tangent) const {
        planes<kind>().template set<kind>(tangent);
        auto material = CrackAxes<double>::read(state, ortho_softening::AXIS_1);
        if (is_standard(material)) return;
        material.normalise(true, kind != AnalysisKind::solid);
        material.set_third();
        to_host(matrix_of(material), tangent);
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        const State<Real>& state = point.state;
        if (kind == AnalysisKind::solid && solid.incomplete()) [[unlikely]]
            return point.refuse(Mask<Real>(true), "with SURF 2, 3, 4 the smallest strength of a plane that may crack",
                                Real(0.0), "> 0");
        Step<kind, Real> step;
        enter_material_axes(increment, point, step);
        take_residual_strain(increment, step);
        step.trial = planes<kind>().template stress<kind, Real>(step.strain);
        step.trial += step.stress_old;

        const Real stage = state[softening_state::STATE];
        const Mask<Real> intact = stage == Real(0.0);
        if (!step.size.read(increment, point, intact, fixed_length)) return;
        if (!reduces_strength && !all(step.size.frozen)) {
            const auto& limit = planes<kind>().template limit<kind>();
            if (!step.size.fits(point, limit.length, limit.text)) return;
        }
        OrthotropicOnset<Real> onset;
        onset.cracks = Mask<Real>(false);
        if (any(intact)) {
            onset =
                planes<kind>().template onset<kind, Real>(step.trial, step.size.strength, strength_limit(step.size));
            onset.cracks = onset.cracks && intact;
        }
        if (all(intact && !onset.cracks)) {
            set_thickness(point, step, step.trial);
            point.elastic_energy = planes<kind>().template energy<kind, Real>(step.trial);
            set_stress(point, step, step.trial);
            softening_state::store_intact(point.state);
            store_material_axes(point.state, step);
            if constexpr (wants_tangent<T>) {
                planes<kind>().template set<kind>(tangent);
                finish_tangent(step, tangent);
            }
            return;
        }
        update_cracked(increment, point, stage, intact, onset, step, tangent);
    }

  private:
    SofteningCrack<false> crack;
    OrthotropicPlanes solid, plane_stress;
    double thermal[3], field[3];
    bool expands = false, swells = false;
    double fixed_length;
    bool reduces_strength, deletes;

    template <AnalysisKind kind, class Real>
    struct Step {
        CrackAxes<Real> material;  // N, T, Z: material axes 1, 2, 3 in the host's frame
        bool aligned;              // with the host's
        // In material axes:
        Stress<kind, Real> stress_old, trial;
        Strain<kind, Real> strain;  // mechanical
        Real residual_3 = Real(0.0);
        softening_state::PointSize<Real> size;
    };

    template <AnalysisKind kind>
    LODE_INLINE const OrthotropicPlanes& planes() const {
        return kind == AnalysisKind::plane_stress ? plane_stress : solid;
    }

    template <class Real>
    LODE_INLINE static Mask<Real> is_standard(const CrackAxes<Real>& a) {
        const Real zero(0.0);
        const Mask<Real> rest = a.N[1] == zero && a.N[2] == zero && a.T[0] == zero && a.T[2] == zero;
        const Mask<Real> unset = a.N[0] == zero && a.T[1] == zero, set = a.N[0] == Real(1.0) && a.T[1] == Real(1.0);
        return rest && (unset || set);
    }
    // Columns are the axes.
    template <class Real>
    LODE_INLINE static Matrix3<Real> matrix_of(const CrackAxes<Real>& a) {
        Matrix3<Real> r;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) r(i, j) = a[j][i];
        return r;
    }

    // Material axes turned with the frame, and stress and strain in them. Most often they are the axes of the frame.
    template <AnalysisKind kind, class Real>
    LODE_INLINE static void enter_material_axes(const Increment<kind, Real>& increment, const Point<kind, Real>& point,
                                                Step<kind, Real>& step) {
        step.material = CrackAxes<Real>::read(point.state, ortho_softening::AXIS_1);
        step.stress_old = point.stress;
        step.strain = increment.strain_increment;
        const bool turns = frame_turns(increment);
        step.aligned = !turns && all(is_standard(step.material));
        if (step.aligned) {
            for (int i = 0; i < 3; ++i) {
                step.material.N[i] = Real(i == 0 ? 1.0 : 0.0);
                step.material.T[i] = Real(i == 1 ? 1.0 : 0.0);
            }
            step.material.set_third();
            return;
        }
        step.material.normalise(Mask<Real>(true), kind != AnalysisKind::solid);
        if (turns) step.material.turn(increment.rotation());
        step.material.set_third();
        const Matrix3<Real> inverse = transpose(matrix_of(step.material));
        step.stress_old = rotate(step.stress_old, inverse);
        step.strain = rotate(step.strain, inverse);
    }

    template <AnalysisKind kind, class Real>
    LODE_INLINE void take_residual_strain(const Increment<kind, Real>& increment, Step<kind, Real>& step) const {
        if (!expands && !swells) return;
        Real hotter = Real(0.0), wetter = Real(0.0);
        if (expands) hotter = increment.temperature_increment();
        if (swells) wetter = increment.field_increment(1);
        for (int i = 0; i < normal_components(kind); ++i)
            step.strain[i] = step.strain[i] - (thermal[i] * hotter + field[i] * wetter);
        step.residual_3 = thermal[2] * hotter + field[2] * wetter;
    }

    // HPOL = 1: strengths stay below this times sqrt(eta G C).
    template <class Real>
    LODE_INLINE Real strength_limit(const softening_state::PointSize<Real>& size) const {
        if (!reduces_strength) return Real(HUGE_VAL);
        return sqrt(0.98 * size.toughness / size.length);
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update_cracked(const Increment<kind, Real>& increment, Point<kind, Real>& point, const Real& stage,
                                    const Mask<Real>& intact, const OrthotropicOnset<Real>& onset,
                                    const Step<kind, Real>& step, T& tangent) const {
        using Update = CrackUpdate<kind, Real>;
        const State<Real>& state = point.state;
        Update crack_update;
        auto host_axes = CrackAxes<Real>::read(state, softening_state::AXIS_N);
        if (frame_turns(increment)) host_axes.turn(increment.rotation());
        crack_update.old = softening_state::read<Update::m>(state);
        const Mask<Real> preset = !intact && !step.size.frozen;
        if (any(preset)) [[unlikely]]
            host_axes.normalise(preset, kind != AnalysisKind::solid);
        auto& axes = crack_update.axes = host_axes;
        const Matrix3<Real> material = matrix_of(step.material);
        if (!step.aligned) {
            axes.N = transpose(material) * host_axes.N;
            axes.T = transpose(material) * host_axes.T;
        }
        if (any(onset.cracks)) {
            axes.choose(onset.cracks, onset.N, onset.T);
            Vector<Real, 3> N = onset.N, tangential = onset.T;
            if (!step.aligned) N = material * N, tangential = material * tangential;
            host_axes.choose(onset.cracks, N, tangential);
        }
        axes.set_third();
        planes<kind>().template set_crack<kind, Real>(axes, step.size, crack_update.law, crack_update.stiffness);
        if (reduces_strength)
            for (int j = 0; j < Update::m; ++j) crack_update.law[j].limit_strength(crack.law(j));
        if (any(preset)) [[unlikely]]
            crack.set_predamaged(preset, stage, crack_update.law, crack_update.old, point.solves);

        const Mask<Real> damaging = onset.cracks || (!intact && stage < Real(1.5));
        std::conditional_t<wants_tangent<T>, DamageRates<Update::m>, NoRates> rates;
        const auto damage = [&](const auto& q_old, const auto& q) LODE_INLINE_LAMBDA {
            return crack.damage(q_old, q, damaging, crack_update.law, NoPressure{}, crack_update.now, rates,
                                point.solves);
        };
        CrackLinearisation<kind> linear;
        crack_update.run(crack, step.stress_old, step.trial, stage, damaging, Mask<Real>(false), damage, &linear,
                         tangent);

        set_thickness(point, step, crack_update.stress);
        point.elastic_energy = planes<kind>().template energy<kind, Real>(crack_update.stress) + crack_update.stored;
        point.plastic_dissipation = crack_update.dissipated;
        set_stress(point, step, crack_update.stress);

        if constexpr (wants_tangent<T>) {
            crack_update.linearise(rates, 0.0, linear);
            planes<kind>().template set<kind>(tangent);
            if (onset.cracks && onset.turning != 0.0)
                set_turning_tangent(axes, onset, step, crack_update.now.strain, linear, tangent);
            else linear.apply(tangent);
            finish_tangent(step, tangent);
        }
        const Real mode = select(onset.cracks, onset.mode, state[softening_state::MODE]);
        softening_state::store(point.state, host_axes, crack_update.now, onset.cracks || !intact, crack_update.failed,
                               step.size.length, mode, crack_update.friction_work, deletes);
        store_material_axes(point.state, step);
    }

    template <AnalysisKind kind, class Real>
    LODE_INLINE static void set_stress(Point<kind, Real>& point, const Step<kind, Real>& step,
                                       const Stress<kind, Real>& stress) {
        point.stress = stress;
        if (!step.aligned) point.stress = rotate(stress, matrix_of(step.material));
    }
    template <AnalysisKind kind, class Real>
    LODE_INLINE static void store_material_axes(State<Real>& state, const Step<kind, Real>& step) {
        for (int i = 0; i < 3; ++i) {
            state.set(ortho_softening::AXIS_1 + i, step.material.N[i]);
            state.set(ortho_softening::AXIS_2 + i, step.material.T[i]);
        }
    }

    // Out-of-plane strain of plane stress: that of the stress, and the residual one.
    template <AnalysisKind kind, class Real>
    LODE_INLINE void set_thickness(Point<kind, Real>& point, const Step<kind, Real>& step,
                                   const Stress<kind, Real>& stress) const {
        using softening_state::EZZ;
        if constexpr (kind == AnalysisKind::plane_stress) {
            const auto& S = plane_stress.compliance;
            point.thickness_strain_increment = S(2, 0) * (stress[0] - step.stress_old[0]) +
                                               S(2, 1) * (stress[1] - step.stress_old[1]) + step.residual_3;
            point.state.set(EZZ, point.state[EZZ] + point.thickness_strain_increment);
        } else {
            point.state.keep(EZZ);
        }
    }

    // The isotropic plane of TIAXIS: the normal of a new crack turns with the stress, dN = dw T (T.9).
    template <AnalysisKind kind>
    [[gnu::noinline]] void set_turning_tangent(const CrackAxes<double>& axes, const OrthotropicOnset<double>& onset,
                                               const Step<kind, double>& step,
                                               const Vector<double, crack_directions(kind)>& strain,
                                               const CrackLinearisation<kind>& linear, Tangent<kind>& tangent) const {
        constexpr int n = components(kind);
        const Matrix3<double> s = to_matrix<kind, double>(step.trial, 1.0);
        double spin[n][3] = {};
        for (int j = 0; j < n; ++j) {
            Stress<kind, double> column;
            for (int i = 0; i < n; ++i) column[i] = tangent(i, j);
            spin[j][0] = planes<kind>().turn(onset.turning, s, to_matrix<kind, double>(column, 1.0));
        }
        double trial[3][3];
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) trial[i][j] = dot(axes[i], s * axes[j]);
        linear.apply_turning(axes, trial, strain, spin, tangent);
    }

    // DDSDDT = -DDSDDE alpha, and both to the host's frame.
    template <AnalysisKind kind>
    LODE_INLINE void finish_tangent(const Step<kind, double>& step, Tangent<kind>& tangent) const {
        if (expands) {
            Stress<kind, double> heating;
            for (int i = 0; i < components(kind); ++i) {
                heating[i] = 0.0;
                for (int j = 0; j < normal_components(kind); ++j) heating[i] -= tangent(i, j) * thermal[j];
            }
            if (!step.aligned) heating = rotate(heating, matrix_of(step.material));
            for (int i = 0; i < components(kind); ++i) tangent.thermal_stress[i] = heating[i];
        }
        if (!step.aligned) to_host(matrix_of(step.material), tangent);
    }
    template <AnalysisKind kind>
    [[gnu::noinline]] static void to_host(const Matrix3<double>& r, Tangent<kind>& tangent) {
        VoigtMatrix<kind, double> c;
        for (int i = 0; i < c.size(); ++i)
            for (int j = 0; j < c.size(); ++j) c(i, j) = tangent(i, j);
        c = rotate_stiffness(c, r);
        for (int i = 0; i < c.size(); ++i)
            for (int j = 0; j < c.size(); ++j) tangent(i, j) = c(i, j);
    }
};

}  // namespace lode
