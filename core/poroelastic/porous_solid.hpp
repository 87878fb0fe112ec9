// POROUS_<KEYWORD>: pore pressure around another solid of the library (page 45, section 4). The solid is the compiled
// model itself, called through its entry with the stress of the skeleton; nothing of it is compiled again.
#pragma once

#include <memory>
#include <new>

#include "lode/material/kernels.hpp"
#include "lode/poroelastic/pore_space.hpp"
#include "lode/tensor/voigt_matrix.hpp"

namespace lode {

// A porous material. What it calls is compiled once for all solids (umat/porous_solid.cpp).
class PorousSolid {
  public:
    PorousSolid(const Properties& p, const ModelEntry& solid, std::string& warnings);
    ~PorousSolid();
    PorousSolid(const PorousSolid&) = delete;
    PorousSolid& operator=(const PorousSolid&) = delete;

    int required_state(AnalysisKind kind) const {
        return PoreSpace::state_count + solid_->required_state(object_, kind);
    }

    template <AnalysisKind kind>
    static void umat(const void* material, const UmatArguments& arguments, CallStatus& status);
    template <AnalysisKind kind>
    static void vumat(const void* material, const VumatArguments& arguments, CallStatus& status);
    template <AnalysisKind kind>
    static void probe(const void* material, const VumatArguments& arguments, CallStatus& status);

    static constexpr int most_points = 128;  // of a block that are worked on together

  private:
    static VumatArguments solid_part(const VumatArguments& a, int first, int count);
    template <AnalysisKind kind>
    void run_batches(const VumatArguments& a, CallStatus& status) const;
    template <AnalysisKind kind>
    void stiffen(const State<double>& solid_state, const PoreStep<kind, double>& step, const UmatArguments& a) const;
    void find_compliance(const Properties& p);

    const ModelEntry* solid_;
    void* object_ = nullptr;
    PoreSpace space_;
    // Of a solid that cracks, in its own axes: compliance and thermal expansion.
    VoigtMatrix<AnalysisKind::solid, double> compliance_{};
    Stress<AnalysisKind::solid, double> expansion_{};
};

extern const std::array<ModelEntry::UmatFunction, kind_count> porous_umat_functions;

namespace porous_solid {

inline constexpr lode_parameter parameters[] = {
    required("ALPHA1", "Biot coefficient along pore axis 1", "-", between(0.0, 1.0)),
    required("ALPHA2", "Biot coefficient along pore axis 2", "-", between(0.0, 1.0)),
    required("ALPHA3", "Biot coefficient along pore axis 3", "-", between(0.0, 1.0)),
    required("Q", "Biot modulus", "stress", above(0.0), "(KU - K)/ALPHA^2 of an isotropic solid"),
    required("PANGZ", "turn of the pore axes about host axis 3", "degrees", any_value(),
             "axes of ALPHA and K: R0 = Rz(PANGZ) Ry(PANGY) Rx(PANGX)"),
    required("PANGY", "turn about host axis 2", "degrees", any_value(), "2D kinds: a multiple of 90"),
    required("PANGX", "turn about host axis 1", "degrees", any_value(), "2D kinds: a multiple of 90"),
    required("MODE", "how the pore pressure moves", "code", code(0, 2), pore_pressure::mode_note),
    required("CLIP", "ignore suction", "code", code(0, 1), "1: only max(p, 0) acts on the stress"),
    required("P0", "reference pore pressure", "stress", any_value()),
    required("K1", "Darcy permeability along pore axis 1", "length^2", at_least(0.0)),
    required("K2", "Darcy permeability along pore axis 2", "length^2", at_least(0.0)),
    required("K3", "Darcy permeability along pore axis 3", "length^2", at_least(0.0)),
    required("ETA", "fluid viscosity", "stress time", above(0.0)),
};
static_assert(count_of(parameters) == PoreSpace::constant_count);
inline constexpr int before = PoreSpace::constant_count;

inline constexpr char own_limits[] =
    "- STRESS is the total stress, yield and damage see that of the solid, sigma + alpha (p - P0); field variable 1 is "
    "the pore pressure, the solid is given 0 for it.\n"
    "- Plane stress and one-dimensional kinds are refused: zero total stress across the plane is not zero solid "
    "stress. So are solids that work from the deformation gradient alone (KIN = 1, 2 of the elastic ones).\n"
    "- Volume that opens in the cracks of a softening solid is not pore volume; what the pressure does there is in "
    "none of the energies.\n";

constexpr std::size_t length(const char* text) {
    std::size_t n = 0;
    while (text[n] != '\0') ++n;
    return n;
}
template <std::size_t n>
constexpr std::array<char, n + 1> concatenated(std::initializer_list<const char*> parts) {
    std::array<char, n + 1> text{};
    std::size_t at = 0;
    for (const char* part : parts)
        for (const char* c = part; *c != '\0'; ++c) text[at++] = *c;
    return text;
}

// The description of the porous version of a solid: its own entries, then those of the solid.
template <class Solid>
struct Description {
    static constexpr const lode_model& solid = Solid::description;
    static_assert((solid.traits & LODE_FINITE_STRAIN) == 0 && (solid.kinds & cohesive_kinds) == 0,
                  "only small-strain solids have a porous version");
    static constexpr unsigned kinds = solid.kinds & (LODE_SOLID | LODE_PLANE_STRAIN);
    static_assert(kinds != 0);

    static constexpr auto parameters = [] {
        std::array<lode_parameter, std::size_t(before + solid.parameter_count)> all{};
        for (int i = 0; i < before; ++i) all[std::size_t(i)] = porous_solid::parameters[i];
        for (int i = 0; i < solid.parameter_count; ++i) {
            lode_parameter p = solid.parameters[i];
            if (repeated_by(p) != 0) p.flags += unsigned(before) << LODE_REPEATED_SHIFT;
            all[std::size_t(before + i)] = p;
        }
        return all;
    }();
    static constexpr auto states = [] {
        constexpr int own = PoreSpace::state_count;
        std::array<lode_state, std::size_t(own + solid.state_count)> all{};
        for (int i = 0; i < own; ++i) all[std::size_t(i)] = pore_pressure::states[i];
        all[pore_pressure::EZZ - 1] = {"PORE9", "not used", 0.0};
        for (int i = 0; i < solid.state_count; ++i) all[std::size_t(own + i)] = solid.state[i];
        return all;
    }();
    // Number of KIN in the solid's table, 0 if it has none.
    static constexpr int kinematics = [] {
        for (int i = 0; i < solid.parameter_count; ++i)
            if (std::string_view(solid.parameters[i].symbol) == "KIN") return i + 1;
        return 0;
    }();
    // Those that KIN selects are not for porous solids.
    static constexpr bool serves(const lode_algorithm& a) {
        return kinematics == 0 || a.parameter != kinematics || a.value == 0.0;
    }
    static constexpr int algorithm_count = [] {
        int count = 0;
        for (int i = 0; i < solid.algorithm_count; ++i) count += serves(solid.algorithms[i]);
        return count;
    }();
    static constexpr auto algorithms = [] {
        std::array<lode_algorithm, std::size_t(algorithm_count) + 1> all{};
        std::size_t at = 0;
        for (int i = 0; i < solid.algorithm_count; ++i) {
            if (!serves(solid.algorithms[i])) continue;
            all[at] = solid.algorithms[i];
            if (all[at].parameter > 0) all[at].parameter += before;
            ++at;
        }
        return all;
    }();
    static constexpr bool cracks = [] {
        for (int i = 0; i < solid.state_count; ++i)
            for (const std::string_view name : {"EC_N", "U1X"})
                if (name == solid.state[i].name) return true;
        return false;
    }();

    // Samples: the first and the last of the solid that can be wrapped, undrained.
    static constexpr bool fits(const lode_sample& s) {
        const bool total = kinematics > 0 && s.constant_count >= kinematics && s.constants[kinematics - 1] != 0.0;
        return (s.kinds & kinds) != 0 && !total;
    }
    static constexpr int first_sample = [] {
        int i = 0;
        while (!fits(solid.samples[i])) ++i;
        return i;
    }();
    static constexpr int last_sample = [] {
        int i = solid.sample_count - 1;
        while (!fits(solid.samples[i])) --i;
        return i;
    }();
    // A fluid less than half as stiff as the stiffest modulus of the solid.
    static constexpr double sample_modulus(const lode_sample& s) {
        double largest = 0.0;
        for (int i = 0; i < solid.required_count && i < s.constant_count; ++i)
            if (std::string_view(solid.parameters[i].unit) == "stress") largest = std::max(largest, s.constants[i]);
        return 0.4 * largest;
    }
    template <int number, bool general>
    static constexpr auto sample_constants = [] {
        constexpr const lode_sample& s = solid.samples[number];
        constexpr double Q = sample_modulus(s);
        std::array<double, std::size_t(before + s.constant_count)> c{};
        const double plain[before] = {0.8, 0.8, 0.8, Q, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1};
        const double options[before] = {0.5, 0.7, 0.9, Q, 30, 0, 0, 2, 1, 1e-4 * Q, 1e-12, 2e-12, 5e-13, 1e-9};
        for (int i = 0; i < before; ++i) c[std::size_t(i)] = general ? options[i] : plain[i];
        for (int i = 0; i < s.constant_count; ++i) c[std::size_t(before + i)] = s.constants[i];
        return c;
    }();
    template <int number, bool general>
    static constexpr lode_sample sample(const char* meaning) {
        constexpr const lode_sample& s = solid.samples[number];
        return {s.label,        meaning,        sample_constants<number, general>.data(), before + s.constant_count,
                s.strain_scale, s.kinds & kinds};
    }
    static constexpr int sample_count = first_sample == last_sample ? 1 : 2;
    static constexpr lode_sample samples[] = {
        sample<first_sample, false>(solid.samples[first_sample].meaning),
        sample<last_sample, true>(solid.samples[last_sample].meaning),
    };

    static constexpr auto keyword = concatenated<7 + length(solid.keyword)>({"POROUS_", solid.keyword});
    static constexpr auto title = concatenated<19 + length(solid.keyword)>({solid.keyword, " with pore pressure"});
    static constexpr auto limits =
        concatenated<length(own_limits) + length(pore_pressure::limits) + length(solid.limits)>(
            {own_limits, pore_pressure::limits, solid.limits});

    static constexpr lode_model description = {
        .keyword = keyword.data(),
        .title = title.data(),
        .family = "poroelastic",
        .purpose =
            "Pore pressure around another solid of the library, by the partition of the stress: yield, damage and "
            "creep are those of the skeleton. The first 14 constants and 18 state variables are those of the pores, "
            "then come those of the solid.",
        .source = "Nairn, chapter 8, section 8.3.1 (eqs. 8.41-8.51)",
        .kinds = kinds,
        .traits = solid.traits | LODE_ROTATES_STATE | (cracks ? LODE_UNSYMMETRIC | LODE_OPEN_ENERGY : 0u),
        .parameters = parameters.data(),
        .parameter_count = before + solid.parameter_count,
        .required_count = before + solid.required_count,
        .state = states.data(),
        .state_count = PoreSpace::state_count + solid.state_count,
        .samples = samples,
        .sample_count = sample_count,
        .algorithms = algorithms.data(),
        .algorithm_count = algorithm_count,
        .limits = limits.data(),
    };
};

}  // namespace porous_solid

// The entry of the porous version of a solid whose own entry is `solid`.
template <class Solid, const ModelEntry& solid>
constexpr ModelEntry make_porous_entry() {
    using Description = porous_solid::Description<Solid>;
    ModelEntry entry{};
    entry.umat = porous_umat_functions.data();
    entry.description = &Description::description;
    entry.size = sizeof(PorousSolid);
    entry.alignment = alignof(PorousSolid);
    entry.construct = [](void* storage, const Properties& p, std::string& message, std::string& warnings) {
        try {
            if (Description::kinematics > 0) {
                const int index = porous_solid::before + Description::kinematics;
                if (p.code(index) != 0) p.refuse(index, "0: a law of the deformation gradient alone has no pores");
            }
            ::new (storage) PorousSolid(p, solid, warnings);
            return true;
        } catch (const std::exception& error) {
            message = error.what();
            return false;
        }
    };
    entry.destroy = [](void* storage) { static_cast<PorousSolid*>(storage)->~PorousSolid(); };
    entry.required_state = [](const void* material, AnalysisKind kind) {
        return static_cast<const PorousSolid*>(material)->required_state(kind);
    };
    constexpr auto three = static_cast<std::size_t>(AnalysisKind::solid),
                   plane = static_cast<std::size_t>(AnalysisKind::plane_strain);
    entry.vumat[three] = &PorousSolid::vumat<AnalysisKind::solid>;
    entry.probe[three] = &PorousSolid::probe<AnalysisKind::solid>;
    entry.vumat[plane] = &PorousSolid::vumat<AnalysisKind::plane_strain>;
    entry.probe[plane] = &PorousSolid::probe<AnalysisKind::plane_strain>;
    return entry;
}

}  // namespace lode
