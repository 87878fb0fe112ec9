// ORTHO_ELASTIC: orthotropic linear elasticity (page 10, section 4; Nairn, chapters 1 and 3).
#pragma once

#include "lode/elastic/anisotropic_elastic.hpp"
#include "lode/material/description.hpp"

namespace lode {

struct OrthoElastic : anisotropic_elastic::Law {
    static constexpr lode_parameter parameters[] = {
        required("E1", "Young's modulus along axis 1", "stress", above(0.0)),
        required("E2", "Young's modulus along axis 2", "stress", above(0.0)),
        required("E3", "Young's modulus along axis 3", "stress", above(0.0)),
        required("NU12", "Poisson's ratio, -eps2/eps1 under stress along 1", "-", any_value(),
                 "NUij^2 < Ei/Ej and 1 - nu12 nu21 - nu13 nu31 - nu23 nu32 - 2 nu12 nu23 nu31 > 0 are needed"),
        required("NU13", "Poisson's ratio, -eps3/eps1 under stress along 1", "-", any_value()),
        required("NU23", "Poisson's ratio, -eps3/eps2 under stress along 2", "-", any_value()),
        required("G12", "shear modulus in the plane 12", "stress", above(0.0)),
        required("G13", "shear modulus in the plane 13", "stress", above(0.0)),
        required("G23", "shear modulus in the plane 23", "stress", above(0.0)),
        optional("ALPHA1", "thermal expansion along axis 1", "1/temp", any_value(), 0.0),
        optional("ALPHA2", "thermal expansion along axis 2", "1/temp", any_value(), 0.0),
        optional("ALPHA3", "thermal expansion along axis 3", "1/temp", any_value(), 0.0),
        optional("BETA1", "expansion along axis 1 per unit of field 1", "1/field", any_value(), 0.0),
        optional("BETA2", "expansion along axis 2 per unit of field 1", "1/field", any_value(), 0.0),
        optional("BETA3", "expansion along axis 3 per unit of field 1", "1/field", any_value(), 0.0),
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
    static constexpr double spruce[] = {12000.0, 900.0, 500.0, 0.4, 0.5, 0.6, 800.0, 700.0, 60.0};
    static constexpr double board[] = {12000.0, 900.0, 500.0, 0.4,  0.5,  0.6,  800.0, 700.0,
                                       60.0,    5e-6,  3e-5,  4e-5, 0.01, 0.17, 0.3,   30.0};
    static constexpr double block[] = {12000.0, 900.0, 500.0, 0.4,  0.5, 0.6,  800.0, 700.0, 60.0,
                                       5e-6,    3e-5,  4e-5,  0.01, 0.2, 0.35, 25.0,  -15.0, 40.0};
    static constexpr double weave[] = {60000.0, 60000.0, 9000.0, 0.05, 0.3,  0.3,  4500.0, 3500.0, 3500.0, 2e-6,
                                       2e-6,    5e-5,    0.0,    0.0,  0.01, 45.0, 0.0,    0.0,    1.0};
    static constexpr double fibre[] = {140.0, 9.0,  9.0, 0.3,  0.3,  0.4,  5.0,  5.0,   3.0, -1e-6,
                                       3e-5,  3e-5, 0.0, 1e-3, 1e-3, 20.0, 50.0, -70.0, 1.0};
    static constexpr lode_sample samples[] = {
        {"SPRUCE", "softwood in its own axes (L, R, T), MPa", spruce, count_of(spruce), 2e-3, continuum_kinds},
        {"BOARD", "a board cut at 30 degrees, heat and moisture, MPa, 1/K, 1/(kg/kg)", board, count_of(board), 2e-3,
         LODE_PLANE_STRESS | LODE_UNIAXIAL},
        {"BLOCK", "wood in general axes, heat and moisture, MPa, 1/K, 1/(kg/kg)", block, count_of(block), 2e-3,
         LODE_SOLID},
        {"WEAVE", "carbon fabric at 45 degrees, total law for large rotations, MPa, 1/K", weave, count_of(weave), 0.02,
         continuum_kinds},
        {"FIBRE", "unidirectional composite in general axes, total law for large rotations, GPa, 1/K", fibre,
         count_of(fibre), 0.02, LODE_SOLID},
    };
    static constexpr lode_algorithm algorithms[] = {
        {"incremental, exact for the given strain increment", 19, 0.0, HUGE_VAL},
        {"total law in the left stretch", 19, 1.0, HUGE_VAL},
        {"total law in the left stretch, turning basis", 19, 2.0, HUGE_VAL},
    };
    static constexpr lode_model description = {
        .keyword = "ORTHO_ELASTIC",
        .title = "Orthotropic linear elasticity",
        .family = "elastic",
        .purpose =
            "Wood, laminates and textiles: three moduli, with orthotropic thermal and moisture expansion, material "
            "axes at any angle, generalized plane stress and plane strain, and an optional total law for large "
            "rotations.",
        .source = "Nairn, chapter 1 (eqs. 1.1-1.30) and chapter 3 (eqs. 3.1-3.19)",
        .kinds = continuum_kinds,
        .traits = LODE_ELASTIC | LODE_ROTATES_STATE,
        .parameters = parameters,
        .parameter_count = count_of(parameters),
        .required_count = 9,
        .state = anisotropic_elastic::states,
        .state_count = anisotropic_elastic::state_count,
        .samples = samples,
        .sample_count = count_of(samples),
        .algorithms = algorithms,
        .algorithm_count = count_of(algorithms),
        .limits = anisotropic_elastic::limits,
    };

    explicit OrthoElastic(const Properties& p) : Law(constants(p)) {}

  private:
    static anisotropic_elastic::Constants constants(const Properties& p) {
        const auto moduli = OrthotropicModuli::from_properties(p, 1);
        return {.moduli = moduli,
                .axes = MaterialAxes::from_properties(p, 16),
                .thermal = Expansion::from(moduli, p[10], p[11], p[12]),
                .moisture = Expansion::from(moduli, p[13], p[14], p[15]),
                .kin = p.code(19),
                .out_of_plane = {p[20], p[21]}};
    }
};

}  // namespace lode
