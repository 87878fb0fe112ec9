// ISO_ELASTIC: isotropic linear elasticity with residual strain (page 10; Nairn, chapters 1 and 3).
#pragma once

#include <variant>

#include "lode/elastic/isotropic_moduli.hpp"
#include "lode/elastic/known_field.hpp"
#include "lode/elastic/out_of_plane.hpp"
#include "lode/elastic/total_rotation.hpp"
#include "lode/material/description.hpp"
#include "lode/material/properties.hpp"

namespace lode {

namespace iso_elastic {

// Each has code of its own.
enum class Variant {
    plain,    // KIN = 0 without options
    options,  // KIN = 0 with expansion or an out-of-plane option
    total     // KIN = 1, 2
};

template <Variant variant>
class Kernel {
  public:
    static constexpr bool reads_stretch = variant == Variant::total;

    explicit Kernel(const Properties& p)
        : moduli(IsotropicModuli::from_young_poisson(p[1], p[2])),
          thermal_expansion(p[3]),
          field_expansion(p[4]),
          out_of_plane{p[6], p[7]} {}

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        // A bar has no rotation to take out.
        if constexpr (variant == Variant::total && kind != AnalysisKind::uniaxial)
            update_total(increment, point, tangent);
        else update_incremental(increment, point, tangent);
    }

    IsotropicModuli moduli;

  private:
    static constexpr int EZZ = 1, OOP = 2, DT = 3, DC = 4;  // STATEV
    static constexpr bool has_options = variant != Variant::plain;
    double thermal_expansion, field_expansion;
    OutOfPlane out_of_plane;

    // KIN = 0: sigma += C (DSTRAN - residual increment), page 10, section 1.6.
    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update_incremental(const Increment<kind, Real>& increment, Point<kind, Real>& point,
                                        T& tangent) const {
        auto& state = point.state;
        Strain<kind, Real> strain = increment.strain_increment;
        Real residual = Real(0.0), imposed_change = Real(0.0);
        const Real temperature_increment = increment.temperature_increment();
        const Real temperature_sum = state[DT] + temperature_increment;
        Real imposed = Real(0.0), field_sum = Real(0.0);
        if constexpr (has_options) {
            imposed = state[OOP], field_sum = state[DC];
            residual = thermal_expansion * temperature_increment;
            if (field_expansion != 0.0) {
                const Real field_increment = increment.field_increment(1);
                if (!is_known(field_increment, point)) return;
                residual = residual + field_expansion * field_increment;
                field_sum = field_sum + field_increment;
            }
            add_to_normals(strain, normal_components(kind), -residual);
            const Real imposed_before = imposed;
            imposed = out_of_plane.at_end(increment);
            imposed_change = imposed - imposed_before;
            add_out_of_plane(strain, imposed_change);
        }
        Stress<kind, Real> change = moduli.template stress<kind>(strain);
        if constexpr (has_options) add_imposed_stress(change, imposed_change);
        point.stress += change;
        if constexpr (kind == AnalysisKind::plane_stress) {
            point.thickness_strain_increment = lateral_strain(change, imposed_change) + residual;
            state.set(EZZ, state[EZZ] + point.thickness_strain_increment);
        } else {
            state.keep(EZZ);
        }
        if constexpr (wants_tangent<T>) {
            moduli.template set_stiffness<kind>(tangent);
            if constexpr (has_options) set_thermal_stress(tangent);
        }
        set_energy(point, imposed);
        state.set(DT, temperature_sum);
        if constexpr (has_options) {
            state.set(OOP, imposed);
            state.set(DC, field_sum);
        } else {
            state.keep(OOP);
            state.keep(DC);
        }
    }

    // KIN = 1, 2: sigma = C (V - I - residual strain), section 1.7.
    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update_total(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        auto& state = point.state;
        TotalRotation<kind, Real> rotation;
        if (!rotation.from(increment, point)) return;
        const Real temperature_sum = state[DT] + increment.temperature_increment();
        Real field_sum = state[DC];
        if (field_expansion != 0.0) {
            field_sum = field_sum + increment.field_increment(1);
            if (!is_known(field_sum, point)) return;
        }
        const Real residual = thermal_expansion * temperature_sum + field_expansion * field_sum;
        const Real imposed = out_of_plane.at_end(increment);
        Strain<kind, Real> strain = rotation.strain;
        add_to_normals(strain, normal_components(kind), -residual);
        add_out_of_plane(strain, imposed);
        point.stress = moduli.template stress<kind>(strain);
        add_imposed_stress(point.stress, imposed);
        Real out_of_plane_strain = state[EZZ];
        if constexpr (kind == AnalysisKind::plane_stress) {
            const Real before = out_of_plane_strain;
            out_of_plane_strain = lateral_strain(point.stress, imposed) + residual;
            point.thickness_strain_increment = out_of_plane_strain - before;
        }
        if constexpr (wants_tangent<T>) {
            rotation.set_tangent(moduli.coupling_stiffness<kind>(), moduli.shear, point.stress, tangent);
            set_thermal_stress(tangent);
        }
        set_energy(point, imposed);
        state.set(EZZ, out_of_plane_strain);
        state.set(OOP, imposed);
        state.set(DT, temperature_sum);
        state.set(DC, field_sum);
    }

    // Plane stress: -Q S_a3 sigma33 = nu/(1 - nu) sigma33 in both directions.
    template <AnalysisKind kind, class Real>
    LODE_INLINE void add_imposed_stress(Stress<kind, Real>& stress, const Real& imposed) const {
        if constexpr (kind == AnalysisKind::plane_stress)
            add_to_normals(stress, 2, moduli.poisson / (1.0 - moduli.poisson) * imposed);
    }
    // eps33 of plane stress without its residual part.
    template <class Real>
    LODE_INLINE Real lateral_strain(const Stress<AnalysisKind::plane_stress, Real>& s, const Real& imposed) const {
        return (imposed - moduli.poisson * (s[0] + s[1])) * (1.0 / moduli.young);
    }
    template <AnalysisKind kind>
    LODE_INLINE void set_thermal_stress(Tangent<kind>& tangent) const {
        for (int i = 0; i < normal_components(kind); ++i)
            tangent.thermal_stress[i] = -thermal_expansion * moduli.template thermal_stiffness<kind>();
    }
    template <AnalysisKind kind, class Real>
    LODE_INLINE void set_energy(Point<kind, Real>& point, const Real& imposed) const {
        point.elastic_energy = moduli.template energy<kind>(point.stress);
        if constexpr (kind == AnalysisKind::plane_stress)
            if (variant != Variant::plain && out_of_plane.present())
                point.elastic_energy =
                    point.elastic_energy +
                    (0.5 / moduli.young) * imposed * (imposed - 2.0 * moduli.poisson * trace(point.stress));
    }
};

}  // namespace iso_elastic

struct IsoElastic {
    static constexpr lode_parameter parameters[] = {
        required("E", "Young's modulus", "stress", above(0.0)),
        required("NU", "Poisson's ratio", "-", inside(-1.0, 0.5)),
        optional("ALPHA", "thermal expansion", "1/temp", any_value(), 0.0),
        optional("BETA", "expansion per unit of field 1", "1/field", any_value(), 0.0),
        optional("KIN", "strain measure", "code", code(0, 2), 0.0,
                 "0 hypoelastic in DSTRAN; 1, 2 total law in the left stretch of DFGRD1"),
        optional("OOP", "out-of-plane stress (plane stress) or strain (3,1)", "stress or strain", any_value(), 0.0),
        optional("TOOP", "ramp time of OOP", "time", at_least(0.0), 0.0),
    };
    static constexpr lode_state states[] = {
        {"EZZ", "out-of-plane strain, plane stress only", 0.0},
        {"OOP", "out-of-plane stress or strain applied so far", 0.0},
        {"DT", "sum of DTEMP", 0.0},
        {"DC", "sum of DPRED(1), with BETA", 0.0},
    };
    static constexpr double steel[] = {210000.0, 0.3};
    static constexpr double aluminium[] = {70000.0, 0.33, 2.3e-5};
    static constexpr double epoxy[] = {3000.0, 0.35, 6e-5, 3e-3};
    static constexpr double large_rotation[] = {1000.0, 0.25, 0.0, 0.0, 1.0};
    static constexpr lode_sample samples[] = {
        {"STEEL", "mild steel, MPa", steel, count_of(steel), 1e-3, continuum_kinds},
        {"ALUMINIUM", "aluminium alloy with thermal expansion, MPa, 1/K", aluminium, count_of(aluminium), 1e-3,
         continuum_kinds},
        {"EPOXY", "epoxy resin, heat and moisture, MPa, 1/K, 1/(kg/kg)", epoxy, count_of(epoxy), 5e-3, continuum_kinds},
        {"TOTAL", "soft solid, total law in the left stretch", large_rotation, count_of(large_rotation), 0.02,
         continuum_kinds},
    };
    static constexpr lode_algorithm algorithms[] = {
        {"incremental, exact for the given strain increment", 5, 0.0, HUGE_VAL},
        {"total law in the left stretch", 5, 1.0, HUGE_VAL},
    };
    static constexpr lode_model description = {
        .keyword = "ISO_ELASTIC",
        .title = "Isotropic linear elasticity",
        .family = "elastic",
        .purpose =
            "The default elastic law, with thermal and moisture expansion, generalized plane stress and plane strain, "
            "and an optional total law for large rotations.",
        .source = "Nairn, chapter 1 (eqs. 1.1-1.15) and chapter 3 (eqs. 3.1-3.19)",
        .kinds = continuum_kinds,
        .traits = LODE_ELASTIC,
        .parameters = parameters,
        .parameter_count = count_of(parameters),
        .required_count = 2,
        .state = states,
        .state_count = count_of(states),
        .samples = samples,
        .sample_count = count_of(samples),
        .algorithms = algorithms,
        .algorithm_count = count_of(algorithms),
        .limits =
            "- NU towards 0.5: the host locks long before rounding matters (relative error about 1e-16/(1 - 2 NU)).\n"
            "- KIN = 0 under large strain is not hyperelastic: closed strain cycles leave stress; beyond about 20 % "
            "strain use a hyperelastic model.\n"
            "- KIN = 1, 2: nothing resists element inversion; det F <= 0 asks for a smaller increment. An initial "
            "stress of the host is lost.\n",
    };

    explicit IsoElastic(const Properties& p) : kernel(make_kernel(p)) {}

    int required_state(AnalysisKind) const { return 4; }

    template <AnalysisKind kind>
    void initial_stiffness(const Stress<kind, double>&, const State<double>&, Tangent<kind>& c) const {
        specialise([&](const auto& k) { k.moduli.template set_stiffness<kind>(c); });
    }

    // Calls f with the kernel at hand.
    template <class F>
    LODE_INLINE void specialise(const F& f) const {
        if (const auto* plain = std::get_if<0>(&kernel)) return f(*plain);
        if (const auto* options = std::get_if<1>(&kernel)) return f(*options);
        f(*std::get_if<2>(&kernel));
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        specialise([&](const auto& k) LODE_INLINE_LAMBDA { k.update(increment, point, tangent); });
    }

  private:
    template <iso_elastic::Variant... variants>
    using AnyKernel = std::variant<iso_elastic::Kernel<variants>...>;
    using Variant = iso_elastic::Variant;
    using Kernel = AnyKernel<Variant::plain, Variant::options, Variant::total>;

    static Kernel make_kernel(const Properties& p) {
        if (p.code(5) != 0) return iso_elastic::Kernel<Variant::total>(p);
        if (p[3] != 0.0 || p[4] != 0.0 || p[6] != 0.0) return iso_elastic::Kernel<Variant::options>(p);
        return iso_elastic::Kernel<Variant::plain>(p);
    }

    Kernel kernel;
};

}  // namespace lode
