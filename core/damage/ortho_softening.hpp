// ORTHO_SOFTENING: an orthotropic or transversely isotropic solid that softens on one crack plane (page 30; Nairn,
// chapter 5). Everything is done in material axes, where sigma = C (eps - eps_res - eps_c).
#pragma once

#include "lode/damage/ortho_softening_description.hpp"
#include "lode/damage/softening_tangent.hpp"
#include "lode/elastic/orthotropic_moduli.hpp"
#include "lode/tensor/rotation.hpp"

namespace lode {

namespace ortho_softening {

// C and S of a kind in material axes; in plane stress C is the inverse of the in-plane compliance.
struct Stiffness {
    Matrix3<double> normal, compliance;
    double shear[3][3];  // G_ij

    Stiffness(const OrthotropicModuli& m, bool plane_stress) : normal(m.stiffness), compliance(m.compliance) {
        shear[0][1] = shear[1][0] = m.shear[0];
        shear[0][2] = shear[2][0] = m.shear[1];
        shear[1][2] = shear[2][1] = m.shear[2];
        if (!plane_stress) return;
        for (int i = 0; i < 2; ++i)
            for (int j = 0; j < 2; ++j)
                normal(i, j) = m.stiffness(i, j) - m.stiffness(i, 2) * m.stiffness(j, 2) / m.stiffness(2, 2);
        for (int i = 0; i < 3; ++i) normal(i, 2) = normal(2, i) = 0.0;
    }

    template <AnalysisKind kind, class Real>
    LODE_INLINE Stress<kind, Real> stress(const Strain<kind, Real>& e) const {
        constexpr int normals = normal_components(kind);
        Stress<kind, Real> s;
        for (int i = 0; i < normals; ++i) {
            s[i] = normal(i, 0) * e[0];
            for (int j = 1; j < normals; ++j) s[i] = s[i] + normal(i, j) * e[j];
        }
        s[normals] = shear[0][1] * e[normals];
        if constexpr (kind == AnalysisKind::solid) {
            s[4] = shear[0][2] * e[4];
            s[5] = shear[1][2] * e[5];
        }
        return s;
    }
    template <AnalysisKind kind, class Real>
    LODE_INLINE Real energy(const Stress<kind, Real>& s) const {
        constexpr int normals = normal_components(kind);
        Real sum = square(s[normals]) * (1.0 / shear[0][1]);
        if constexpr (kind == AnalysisKind::solid)
            sum = sum + square(s[4]) * (1.0 / shear[0][2]) + square(s[5]) * (1.0 / shear[1][2]);
        for (int i = 0; i < normals; ++i)
            for (int j = 0; j < normals; ++j) sum = sum + compliance(i, j) * (s[i] * s[j]);
        return 0.5 * sum;
    }
    template <AnalysisKind kind>
    void set(Tangent<kind>& tangent) const {
        constexpr int n = components(kind), normals = normal_components(kind);
        for (int i = 0; i < n * n; ++i) tangent.stiffness[i] = 0.0;
        for (int i = 0; i < normals; ++i)
            for (int j = 0; j < normals; ++j) tangent(i, j) = normal(i, j);
        tangent(normals, normals) = shear[0][1];
        if constexpr (kind == AnalysisKind::solid) tangent(4, 4) = shear[0][2], tangent(5, 5) = shear[1][2];
    }
};

// Strengths and toughnesses of the planes normal to axis i: [i][i] across the plane, [i][j] in direction j.
struct Planes {
    double strength[3][3], toughness[3][3];

    explicit Planes(const Properties& p) {
        for (int i = 0; i < 3; ++i) {
            const int first = S1 + 6 * i, j = i == 0 ? 1 : 0, k = i == 2 ? 1 : 2;
            strength[i][i] = p[first], strength[i][j] = p[first + 1], strength[i][k] = p[first + 2];
            toughness[i][i] = p[first + 3], toughness[i][j] = p[first + 4], toughness[i][k] = p[first + 5];
        }
    }
};

}  // namespace ortho_softening

struct OrthoSoftening {
    static constexpr const lode_model& description = ortho_softening::description;

    explicit OrthoSoftening(const Properties& p)
        : OrthoSoftening(p, OrthotropicModuli::from_properties(p, ortho_softening::E1)) {}

    int required_state(AnalysisKind) const { return ortho_softening::count; }

    template <AnalysisKind kind>
    void initial_stiffness(const Stress<kind, double>&, const State<double>& state, Tangent<kind>& tangent) const {
        stiffness<kind>().template set<kind>(tangent);
        CrackAxes<double> material = CrackAxes<double>::read(state, ortho_softening::AXIS_1);
        if (!is_standard(material)) {
            material.normalise(true, kind != AnalysisKind::solid);
            material.set_third();
            to_host(matrix_of(material), tangent);
        }
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        using namespace softening_state;
        const State<Real>& state = point.state;
        if (kind == AnalysisKind::solid && incomplete_in_3d) [[unlikely]]
            return point.refuse(Mask<Real>(true), "with SURF 2, 3, 4 the smallest strength of a plane that may crack",
                                Real(0.0), "> 0");

        // Material axes, turned with the frame; most often they are its axes.
        Step<kind, Real> step;
        step.material = CrackAxes<Real>::read(state, ortho_softening::AXIS_1);
        const bool turns = frame_turns(increment);
        step.aligned = !turns && all(is_standard(step.material));
        step.trial_old = point.stress;
        step.strain = increment.strain_increment;
        if (step.aligned) {
            step.material = standard_axes<Real>();
        } else {
            step.material.normalise(Mask<Real>(true), kind != AnalysisKind::solid);
            if (turns) step.material.turn(increment.rotation());
        }
        step.material.set_third();
        if (!step.aligned) {
            const Matrix3<Real> inverse = transpose(matrix_of(step.material));
            step.trial_old = rotate(step.trial_old, inverse);
            step.strain = rotate(step.strain, inverse);
        }
        take_residual_strain(increment, step);
        step.trial = stiffness<kind>().template stress<kind, Real>(step.strain);
        step.trial += step.trial_old;

        const Real stage = state[STATE];
        const Mask<Real> intact = stage == Real(0.0);
        if (!step.size.read(increment, point, intact, fixed_length)) return;
        if (!reduces_strength && !all(step.size.frozen)) {
            const Limit& limit = limits[kind == AnalysisKind::solid ? 0 : kind == AnalysisKind::plane_strain ? 1 : 2];
            if (!step.size.fits(point, limit.length, limit.text)) return;
        }
        Onset<Real> onset;
        onset.cracks = Mask<Real>(false);
        if (any(intact)) {
            onset = find_onset(step);
            onset.cracks = onset.cracks && intact;
        }
        if (all(intact && !onset.cracks)) {
            finish(point, step, step.trial, Real(0.0));
            store_intact(point.state);
            if constexpr (wants_tangent<T>) {
                stiffness<kind>().template set<kind>(tangent);
                finish_tangent(step, tangent);
            }
            return;
        }
        update_cracked(increment, point, stage, intact, onset, step, tangent);
    }

  private:
    struct Limit {
        double length = HUGE_VAL;  // h_max
        const char* text = "";
    };

    SofteningCrack<false> crack;
    ortho_softening::Planes planes;
    ortho_softening::Stiffness full, plane_stress;
    double thermal[3], field[3];
    bool expands, swells;
    double fixed_length;
    bool reduces_strength, deletes;
    int axial;  // TIAXIS - 1, or -1
    bool incomplete_in_3d = false;
    Limit limits[3];  // 3D, plane strain, plane stress

    template <AnalysisKind kind, class Real>
    struct Step {
        CrackAxes<Real> material;            // N, T, Z: material axes 1, 2, 3 in the host's frame
        bool aligned;                        // with the host's
        Stress<kind, Real> trial_old, trial;  // in material axes from here on
        Strain<kind, Real> strain;           // mechanical
        Real residual_3 = Real(0.0);
        softening_state::PointSize<Real> size;
    };
    template <class Real>
    struct Onset {
        Mask<Real> cracks;
        Vector<Real, 3> N, T;  // in material axes
        Real mode;
        Real turning;  // 0 a plane of symmetry, 1 turns with the principal axes, 2 with the axial shear
    };

    OrthoSoftening(const Properties& p, const OrthotropicModuli& moduli)
        : crack(SofteningLaw(p, ortho_softening::LAW_I, ortho_softening::A1_I, ortho_softening::A2_I,
                             ortho_softening::FMIN),
                SofteningLaw(p, ortho_softening::LAW_II, ortho_softening::A1_II, ortho_softening::A2_II,
                             ortho_softening::FMIN),
                static_cast<TractionSurface>(p.code(ortho_softening::SURF)), p[ortho_softening::MIX_I],
                p[ortho_softening::MIX_II], p[ortho_softening::MU]),
          planes(p),
          full(moduli, false),
          plane_stress(moduli, true),
          fixed_length(p[ortho_softening::HFIX]),
          reduces_strength(p.code(ortho_softening::HPOL) == 1),
          deletes(p.code(ortho_softening::DELFLAG) == 1),
          axial(p.code(ortho_softening::TIAXIS) - 1) {
        expands = swells = false;
        for (int i = 0; i < 3; ++i) {
            thermal[i] = p[ortho_softening::ALPHA + i];
            field[i] = p[ortho_softening::BETA + i];
            expands = expands || thermal[i] != 0.0;
            swells = swells || field[i] != 0.0;
        }
        check(p);
        for (int k = 0; k < 3; ++k) limits[k] = find_limit(k);
    }

    // The axes of the isotropic plane, b1 < b2.
    int b1() const { return axial == 0 ? 1 : 0; }
    int b2() const { return axial == 2 ? 1 : 2; }

    void check(const Properties& p) const_cast_free;
};

}  // namespace lode
