// TRANSISO_ELASTIC: transversely isotropic linear elasticity (page 10, section 3; Nairn, chapters 1 and 3).
#pragma once

#include "lode/elastic/anisotropic_elastic.hpp"
#include "lode/material/description.hpp"

namespace lode {

struct TransisoElastic : anisotropic_elastic::Law {
    static constexpr lode_parameter parameters[] = {
        required("EA", "axial Young's modulus", "stress", above(0.0)),
        required("ET", "transverse Young's modulus", "stress", above(0.0)),
        required("NUA", "axial Poisson's ratio, -eps_T/eps_A under axial stress", "-", any_value(),
                 "NUA^2 < (1 - NUT) EA/(2 ET) is needed"),
        required("NUT", "Poisson's ratio in the isotropic plane", "-", inside(-1.0, 1.0)),
        required("GA", "axial shear modulus", "stress", above(0.0)),
        optional("ALPHAA", "axial thermal expansion", "1/temp", any_value(), 0.0),
        optional("ALPHAT", "transverse thermal expansion", "1/temp", any_value(), 0.0),
        optional("BETAA", "axial expansion per unit of field 1", "1/field", any_value(), 0.0),
        optional("BETAT", "transverse expansion per unit of field 1", "1/field", any_value(), 0.0),
        optional("AXIS", "material axis that is axial", "code", code(1, 3), 3.0),
        optional("ANGZ", "turn of the material axes about host axis 3", "degrees", any_value(), 0.0,
                 "R0 = Rz(ANGZ) Ry(ANGY) Rx(ANGX), right-hand rotations; the columns of R0 are the material axes"),
        optional("ANGY", "turn about host axis 2", "degrees", any_value(), 0.0, "2D kinds: a multiple of 90"),
        optional("ANGX", "turn about host axis 1", "degrees", any_value(), 0.0, "2D kinds: a multiple of 90"),
        optional("KIN", "strain measure", "code", code(0, 2), 0.0,
                 "0 hypoelastic in DSTRAN; 1 total law in the left stretch of DFGRD1, host basis fixed; 2 the same in "
                 "a host basis that turns with the material"),
        optional("OOP", "out-of-plane stress (plane stress) or strain (3,1)", "stress or strain", any_value(), 0.0),
        optional("TOOP", "ramp time of OOP", "time", at_least(0.0), 0.0),
    };
    static constexpr double carbon[] = {140000.0, 9000.0, 0.3, 0.4, 5000.0};
    static constexpr double ply[] = {140000.0, 9000.0, 0.3, 0.4, 5000.0, -1e-6, 3e-5, 0.0, 2e-3, 1.0, 30.0};
    static constexpr double layer[] = {140000.0, 9000.0, 0.3,  0.4,  5000.0, -1e-6, 3e-5, 0.0,
                                       2e-3,     1.0,    30.0, 20.0, 10.0,   0.0,   1e-3, 2.0};
    static constexpr double rod[] = {140000.0, 9000.0, 0.3, 0.4, 5000.0, -1e-6, 3e-5, 0.0, 2e-3, 1.0, 10.0};
    static constexpr double sheet[] = {140.0, 9.0, 0.3, 0.4, 5.0, -1e-6, 3e-5, 1e-3, 2e-3, 1.0, -40.0, 0.0, 0.0, 1.0};
    static constexpr double rope[] = {14.0, 9.0, 0.3, 0.4, 5.0, -1e-6, 3e-5, 1e-3, 2e-3, 2.0, 25.0, 35.0, -60.0, 1.0};
    static constexpr lode_sample samples[] = {
        {"CARBON", "carbon fibre and epoxy, fibres along 3, MPa", carbon, count_of(carbon), 2e-3, continuum_kinds},
        {"PLY", "fibres at 30 degrees in the plane, heat and moisture, MPa, 1/K", ply, count_of(ply), 2e-3,
         LODE_SOLID | LODE_PLANE_STRAIN | LODE_PLANE_STRESS},
        {"LAYER", "fibres in a general direction, heat and moisture, MPa, 1/K", layer, count_of(layer), 2e-3,
         LODE_SOLID},
        {"ROD", "fibres at 10 degrees to the bar, heat and moisture, MPa, 1/K", rod, count_of(rod), 2e-3,
         LODE_UNIAXIAL},
        {"SHEET", "fibres at -40 degrees in the plane, total law for large rotations, GPa, 1/K", sheet, count_of(sheet),
         0.02, continuum_kinds},
        {"ROPE", "general direction, total law for large rotations, GPa, 1/K", rope, count_of(rope), 0.02, LODE_SOLID},
    };
    static constexpr lode_algorithm algorithms[] = {
        {"incremental, exact for the given strain increment", 14, 0.0, HUGE_VAL},
        {"total law in the left stretch", 14, 1.0, HUGE_VAL},
        {"total law in the left stretch, turning basis", 14, 2.0, HUGE_VAL},
    };
    static constexpr lode_model description = {
        .keyword = "TRANSISO_ELASTIC",
        .title = "Transversely isotropic linear elasticity",
        .family = "elastic",
        .purpose =
            "Unidirectional composites and wood in its simplest form: one stiff or soft axis at any angle, with "
            "thermal and moisture expansion, generalized plane stress and plane strain, and an optional total law for "
            "large rotations.",
        .source = "Nairn, chapter 1 (eqs. 1.1-1.26) and chapter 3 (eqs. 3.1-3.19)",
        .kinds = continuum_kinds,
        .traits = LODE_ELASTIC | LODE_ROTATES_STATE,
        .parameters = parameters,
        .parameter_count = count_of(parameters),
        .required_count = 5,
        .state = anisotropic_elastic::states,
        .state_count = anisotropic_elastic::state_count,
        .samples = samples,
        .sample_count = count_of(samples),
        .algorithms = algorithms,
        .algorithm_count = count_of(algorithms),
        .limits = anisotropic_elastic::limits,
    };

    explicit TransisoElastic(const Properties& p) : Law(constants(p)) {}

  private:
    static anisotropic_elastic::Constants constants(const Properties& p) {
        const int axis = p.code(10);
        const auto moduli = OrthotropicModuli::transversely_isotropic(p, 1, axis);
        const auto expansion = [&](double axial, double across) {
            return Expansion::from(moduli, axis == 1 ? axial : across, axis == 2 ? axial : across,
                                   axis == 3 ? axial : across);
        };
        return {.moduli = moduli,
                .axes = MaterialAxes::from_properties(p, 11),
                .thermal = expansion(p[6], p[7]),
                .moisture = expansion(p[8], p[9]),
                .kin = p.code(14),
                .out_of_plane = {p[15], p[16]}};
    }
};

}  // namespace lode
