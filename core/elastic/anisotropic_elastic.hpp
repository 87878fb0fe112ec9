// The law of TRANSISO_ELASTIC and ORTHO_ELASTIC (page 10, section 1): linear elasticity in material axes that turn with
// the host's rotation, residual strains, generalized plane stress and strain, and the total law for large rotations.
#pragma once

#include <variant>

#include "lode/elastic/known_field.hpp"
#include "lode/elastic/material_axes.hpp"
#include "lode/elastic/out_of_plane.hpp"
#include "lode/elastic/rotated_moduli.hpp"
#include "lode/elastic/total_rotation.hpp"

namespace lode {

namespace anisotropic_elastic {

// Each has code of its own.
enum class Variant {
    plain,    // KIN = 0, material axes along the host's, no expansion, nothing out of plane
    general,  // KIN = 0
    total     // KIN = 1, 2
};

struct Constants {
    OrthotropicModuli moduli;
    MaterialAxes axes;
    Expansion thermal, moisture;
    int kin;
    OutOfPlane out_of_plane;

    Variant variant() const {
        if (kin != 0) return Variant::total;
        const bool plain = axes.along_host() && !thermal.present && !moisture.present && !out_of_plane.present();
        return plain ? Variant::plain : Variant::general;
    }
};

inline constexpr int EZZ = 1, OOP = 2, DT = 3, DC = 4, Q = 5;  // STATEV
inline constexpr int state_count = 13;
inline constexpr lode_state states[state_count] = {
    {"EZZ", "out-of-plane strain, plane stress only", 0.0},
    {"OOP", "out-of-plane stress or strain applied so far", 0.0},
    {"DT", "sum of DTEMP", 0.0},
    {"DC", "sum of DPRED(1), where it expands", 0.0},
    {"Q11M1", "host rotation Q - I, or Rp - I with KIN = 1; 0 with KIN = 2 and in a VUMAT", 0.0},
    {"Q12", "", 0.0},
    {"Q13", "", 0.0},
    {"Q21", "", 0.0},
    {"Q22M1", "", 0.0},
    {"Q23", "", 0.0},
    {"Q31", "", 0.0},
    {"Q32", "", 0.0},
    {"Q33M1", "", 0.0},
};
inline constexpr char limits[] =
    "- 2D elements whose material axes are tilted out of the plane (no axis normal to it) end the analysis with a "
    "message.\n"
    "- KIN = 0 with large rotation in an increment: the stiffness turns with the material, so the host's first-order "
    "strain increments cost far more accuracy than in an isotropic material (17 % with 4 increments over 57 degrees, "
    "0.3 % with 256). Keep below 1 degree an increment for 1 %, or use KIN = 1.\n"
    "- KIN = 0 under large strain is not hyperelastic: closed strain cycles leave stress.\n"
    "- KIN = 1, 2: nothing resists element inversion; det F <= 0 asks for a smaller increment. An initial stress of "
    "the host is lost. KIN = 1 needs a host basis that does not turn with the material, KIN = 2 one that does.\n"
    "- An explicit host turns its frame with the material: KIN = 1 and 2 are the same there, and Q stays I.\n";

template <Variant variant>
class Kernel {
  public:
    static constexpr bool reads_stretch = variant == Variant::total;

    explicit Kernel(const Constants& constants)
        : c(constants),
          energy(c.moduli),
          moduli_3d(c.moduli, c.axes.r, c.thermal, c.moisture),
          moduli_plane_strain(c.moduli, c.axes.r, c.thermal, c.moisture),
          moduli_plane_stress(c.moduli, c.axes.r, c.thermal, c.moisture),
          moduli_1d(c.moduli, c.axes.r, c.thermal, c.moisture) {}

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        if constexpr (variant != Variant::plain)
            if (!c.axes.serve(point)) return;
        // A bar has no rotation to take out.
        if constexpr (variant == Variant::total && kind != AnalysisKind::uniaxial)
            update_total(increment, point, tangent);
        else update_incremental(increment, point, tangent);
    }

    // In axes that have not turned.
    template <AnalysisKind kind>
    LODE_INLINE const RotatedModuli<kind, double>& moduli() const {
        if constexpr (kind == AnalysisKind::solid) return moduli_3d;
        else if constexpr (kind == AnalysisKind::plane_strain) return moduli_plane_strain;
        else if constexpr (kind == AnalysisKind::plane_stress) return moduli_plane_stress;
        else return moduli_1d;
    }

  private:
    static constexpr bool is_plain = variant == Variant::plain;

    Constants c;
    ElasticEnergy energy;
    RotatedModuli<AnalysisKind::solid, double> moduli_3d;
    RotatedModuli<AnalysisKind::plane_strain, double> moduli_plane_strain;
    RotatedModuli<AnalysisKind::plane_stress, double> moduli_plane_stress;
    RotatedModuli<AnalysisKind::uniaxial, double> moduli_1d;

    // The axes of all lanes of a batch are those of the host's frame, which turns.
    template <class Real>
    using Number = std::conditional_t<is_batch<Real>, double, Real>;

    // KIN = 0: sigma += C (DSTRAN - residual increment), axes R = Q R0 of the end of the increment (section 1.6).
    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update_incremental(const Increment<kind, Real>& increment, Point<kind, Real>& point,
                                        T& tangent) const {
        using Moduli = RotatedModuli<kind, Number<Real>>;
        using Frame = HostRotation<kind, Real>;
        Frame frame;
        Moduli own;
        const Moduli* current = nullptr;
        const bool turned = !Frame::is_identity(increment, point.state, Q);
        if constexpr (Frame::turns && !is_batch<Real>)
            if (turned) {
                frame = Frame::advanced(increment, point.state, Q);
                own = Moduli(c.moduli, frame.times(c.axes), c.thermal, c.moisture);
                current = &own;
            }
        if (current == nullptr) {
            if constexpr (std::is_same_v<Number<Real>, double>) current = &moduli<kind>();
            else own = Moduli(moduli<kind>()), current = &own;
        }
        if (!update_in(*current, increment, point, tangent)) return;
        if (turned) frame.store(point.state, Q);
        else keep_rotation(point.state);
    }

    // False where the increment cannot be done.
    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE bool update_in(const RotatedModuli<kind, Number<Real>>& m, const Increment<kind, Real>& increment,
                               Point<kind, Real>& point, T& tangent) const {
        auto& state = point.state;
        Strain<kind, Real> strain = increment.strain_increment;
        const Real temperature_increment = increment.temperature_increment();
        const Real temperature_sum = state[DT] + temperature_increment;
        Real field_sum = Real(0.0), field_increment = Real(0.0), imposed = Real(0.0), imposed_change = Real(0.0);
        if constexpr (!is_plain) {
            field_sum = state[DC];
            if (c.moisture.present) {
                field_increment = increment.field_increment(1);
                if (!is_known(field_increment, point)) return false;
            }
            field_sum = field_sum + field_increment;
            imposed = c.out_of_plane.at_end(increment);
            imposed_change = imposed - state[OOP];
            add_out_of_plane(strain, imposed_change);
        }
        // Axes that have turned are no longer along the host's; those of a batch do not turn.
        Stress<kind, Real> change = m.template stress < is_plain && is_batch < Real >> (strain);
        if constexpr (!is_plain) subtract_residual(m, change, temperature_increment, field_increment, imposed_change);
        point.stress += change;
        if constexpr (kind == AnalysisKind::plane_stress) {
            Real thickness = m.lateral[0] * strain[0] + m.lateral[1] * strain[1] + m.lateral[2] * strain[2];
            if constexpr (!is_plain)
                thickness = thickness + lateral_residual(m, temperature_increment, field_increment, imposed_change);
            point.thickness_strain_increment = thickness;
            state.set(EZZ, state[EZZ] + thickness);
        } else {
            state.keep(EZZ);
        }
        set_energy(m, point, imposed);
        if constexpr (wants_tangent<T>) {
            m.store(tangent);
            set_thermal_stress(m, tangent);
        }
        state.set(DT, temperature_sum);
        if constexpr (is_plain) {
            state.keep(OOP);
            state.keep(DC);
        } else {
            state.set(OOP, imposed);
            state.set(DC, field_sum);
        }
        return true;
    }

    // KIN = 1, 2: sigma = C (V - I - residual strain), section 1.7; axes R = Rp R0 or R0.
    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update_total(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        using Moduli = RotatedModuli<kind, Number<Real>>;
        auto& state = point.state;
        TotalRotation<kind, Real> deformation;
        if (!deformation.from(increment, point)) return;
        HostRotation<kind, Real> frame;
        Moduli own;
        const Moduli* current = &own;
        const bool turns = !is_batch<Real> && c.kin == 1;
        if constexpr (std::is_same_v<Number<Real>, double>)
            if (!turns) current = &moduli<kind>();
        if constexpr (!is_batch<Real>) {
            if (turns) {
                frame = deformation.rotation();
                own = Moduli(c.moduli, frame.times(c.axes), c.thermal, c.moisture);
            } else if constexpr (is_differentiated<Real>) {
                own = Moduli(moduli<kind>());
            }
        }
        const Moduli& m = *current;

        const Real temperature_sum = state[DT] + increment.temperature_increment();
        Real field_sum = state[DC];
        if (c.moisture.present) {
            field_sum = field_sum + increment.field_increment(1);
            if (!is_known(field_sum, point)) return;
        }
        const Real imposed = c.out_of_plane.at_end(increment);
        Strain<kind, Real> strain = deformation.strain;
        add_out_of_plane(strain, imposed);
        point.stress = m.stress(strain);
        subtract_residual(m, point.stress, temperature_sum, field_sum, imposed);
        Real out_of_plane_strain = state[EZZ];
        if constexpr (kind == AnalysisKind::plane_stress) {
            const Real before = out_of_plane_strain;
            out_of_plane_strain = m.lateral[0] * strain[0] + m.lateral[1] * strain[1] + m.lateral[2] * strain[2] +
                                  lateral_residual(m, temperature_sum, field_sum, imposed);
            point.thickness_strain_increment = out_of_plane_strain - before;
        }
        set_energy(m, point, imposed);
        if constexpr (wants_tangent<T>) {
            deformation.set_tangent(m, point.stress, tangent);
            set_thermal_stress(m, tangent);
        }
        state.set(EZZ, out_of_plane_strain);
        state.set(OOP, imposed);
        state.set(DT, temperature_sum);
        state.set(DC, field_sum);
        if (turns) frame.store(state, Q);
        else
            for (int i = 0; i < 9; ++i) state.set(Q + i, Real(0.0));
    }

    // Residual strains and sigma33 of plane stress: - C alpha T - C beta c - Q S_a3 sigma33.
    template <AnalysisKind kind, class Real>
    LODE_INLINE void subtract_residual(const RotatedModuli<kind, Number<Real>>& m, Stress<kind, Real>& stress,
                                       const Real& temperature, const Real& field, const Real& imposed) const {
        for (int i = 0; i < components(kind); ++i) {
            if (c.thermal.present) stress[i] = stress[i] - m.thermal[i] * temperature;
            if (c.moisture.present) stress[i] = stress[i] - m.moisture[i] * field;
            if constexpr (kind == AnalysisKind::plane_stress)
                if (c.out_of_plane.present()) stress[i] = stress[i] - m.lateral[i] * imposed;
        }
    }
    // eps33 of plane stress at fixed in-plane strain.
    template <AnalysisKind kind, class Real>
    LODE_INLINE Real lateral_residual(const RotatedModuli<kind, Number<Real>>& m, const Real& temperature,
                                      const Real& field, const Real& imposed) const {
        Real sum = m.thickness_compliance * imposed;
        if (c.thermal.present) sum = sum + m.lateral_thermal * temperature;
        if (c.moisture.present) sum = sum + m.lateral_moisture * field;
        return sum;
    }
    template <AnalysisKind kind>
    LODE_INLINE void set_thermal_stress(const RotatedModuli<kind, double>& m, Tangent<kind>& tangent) const {
        if constexpr (!is_plain)
            if (c.thermal.present)
                for (int i = 0; i < components(kind); ++i) tangent.thermal_stress[i] = -m.thermal[i];
    }
    template <AnalysisKind kind, class Real>
    LODE_INLINE void set_energy(const RotatedModuli<kind, Number<Real>>& m, Point<kind, Real>& point,
                                const Real& imposed) const {
        if constexpr (is_batch<Real>) return;  // an explicit host asks for the stress work
        else if constexpr (kind == AnalysisKind::uniaxial)
            point.elastic_energy = 0.5 * point.stress[0] * point.stress[0] / m(0, 0);
        else point.elastic_energy = energy(m.axes, point.stress, imposed);
    }
    template <class Real>
    LODE_INLINE static void keep_rotation(State<Real>& state) {
        for (int i = 0; i < 9; ++i) state.keep(Q + i);
    }
};

// A model with these constants: what TRANSISO_ELASTIC and ORTHO_ELASTIC are made of.
class Law {
  public:
    explicit Law(const Constants& c) : kernel(make_kernel(c)) {}

    int required_state(AnalysisKind) const { return state_count; }

    template <AnalysisKind kind>
    void initial_stiffness(const Stress<kind, double>&, const State<double>&, Tangent<kind>& tangent) const {
        specialise([&](const auto& k) { k.template moduli<kind>().store(tangent); });
    }

    // Calls f with the kernel at hand.
    template <class F>
    LODE_INLINE void specialise(const F& f) const {
        if (const auto* plain = std::get_if<0>(&kernel)) return f(*plain);
        if (const auto* general = std::get_if<1>(&kernel)) return f(*general);
        f(*std::get_if<2>(&kernel));
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        specialise([&](const auto& k) LODE_INLINE_LAMBDA { k.update(increment, point, tangent); });
    }

  private:
    using AnyKernel = std::variant<Kernel<Variant::plain>, Kernel<Variant::general>, Kernel<Variant::total>>;

    static AnyKernel make_kernel(const Constants& c) {
        switch (c.variant()) {
            case Variant::plain:
                return Kernel<Variant::plain>(c);
            case Variant::general:
                return Kernel<Variant::general>(c);
            default:
                return Kernel<Variant::total>(c);
        }
    }

    AnyKernel kernel;
};

}  // namespace anisotropic_elastic

}  // namespace lode
