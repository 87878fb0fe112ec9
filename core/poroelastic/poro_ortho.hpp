// PORO_ORTHO: orthotropic Biot poroelasticity (page 45; Nairn, chapter 8).
#pragma once

#include "lode/poroelastic/poro_anisotropic.hpp"

namespace lode {

struct PoroOrtho : poro_anisotropic::Law {
    static constexpr lode_parameter parameters[] = {
        required("E1", "drained Young's modulus along axis 1", "stress", above(0.0)),
        required("E2", "drained Young's modulus along axis 2", "stress", above(0.0)),
        required("E3", "drained Young's modulus along axis 3", "stress", above(0.0)),
        required("NU12", "drained Poisson's ratio, -eps2/eps1 under stress along 1", "-", any_value(),
                 "the compliance must be positive definite"),
        required("NU13", "drained Poisson's ratio, -eps3/eps1 under stress along 1", "-", any_value()),
        required("NU23", "drained Poisson's ratio, -eps3/eps2 under stress along 2", "-", any_value()),
        required("G12", "shear modulus in the plane 12", "stress", above(0.0)),
        required("G13", "shear modulus in the plane 13", "stress", above(0.0)),
        required("G23", "shear modulus in the plane 23", "stress", above(0.0)),
        required("ALPHA1", "Biot coefficient along axis 1", "-", between(0.0, 1.0), "not all 0"),
        required("ALPHA2", "Biot coefficient along axis 2", "-", between(0.0, 1.0)),
        required("ALPHA3", "Biot coefficient along axis 3", "-", between(0.0, 1.0)),
        required("KU", "undrained bulk modulus", "stress", above(0.0),
                 "above the drained bulk modulus K, below K ha/(ha - K hii^2)"),
        optional("ANGZ", "turn of the material axes about host axis 3", "degrees", any_value(), 0.0,
                 "R0 = Rz(ANGZ) Ry(ANGY) Rx(ANGX), right-hand rotations; the columns of R0 are the material axes"),
        optional("ANGY", "turn about host axis 2", "degrees", any_value(), 0.0, "2D kinds: a multiple of 90"),
        optional("ANGX", "turn about host axis 1", "degrees", any_value(), 0.0, "2D kinds: a multiple of 90"),
        optional("MODE", "how the pore pressure moves", "code", code(0, 2), 0.0, pore_pressure::mode_note),
        optional("CLIP", "ignore suction", "code", code(0, 1), 0.0, "1: only max(p, 0) acts on the stress"),
        optional("P0", "reference pore pressure", "stress", any_value(), 0.0),
        optional("AT1", "thermal expansion along axis 1", "1/temp", any_value(), 0.0),
        optional("AT2", "thermal expansion along axis 2", "1/temp", any_value(), 0.0),
        optional("AT3", "thermal expansion along axis 3", "1/temp", any_value(), 0.0),
        optional("K1", "Darcy permeability along axis 1", "length^2", at_least(0.0), 0.0),
        optional("K2", "Darcy permeability along axis 2", "length^2", at_least(0.0), 0.0),
        optional("K3", "Darcy permeability along axis 3", "length^2", at_least(0.0), 0.0),
        optional("ETA", "fluid viscosity", "stress time", above(0.0), 1.0),
    };
    static constexpr double bone[] = {12000.0, 13500.0, 20000.0, 0.3, 0.22, 0.23,   4500.0,
                                      5600.0,  6200.0,  0.2,     0.2, 0.1,  16500.0};
    static constexpr double rock[] = {18000.0, 11000.0, 7000.0, 0.25,    0.3,  0.28, 5000.0, 4200.0, 3600.0,
                                      0.55,    0.7,     0.85,   12000.0, 75.0, 0.0,  0.0,    1.0};
    static constexpr double seam[] = {18000.0, 11000.0, 7000.0, 0.25,    0.3,   0.28,  5000.0, 4200.0, 3600.0,
                                      0.55,    0.7,     0.85,   12000.0, 33.0,  44.0,  55.0,   2.0,    1.0,
                                      2.0,     1e-5,    2e-5,   3e-5,    1e-12, 2e-12, 5e-13,  1e-9};
    static constexpr double core[] = {18000.0, 11000.0, 7000.0, 0.25, 0.3, 0.28, 5000.0, 4200.0, 3600.0, 0.55, 0.7,
                                      0.85,    12000.0, 20.0,   0.0,  0.0, 1.0,  0.0,    0.5,    1e-5,   2e-5, 3e-5};
    static constexpr lode_sample samples[] = {
        {"BONE", "cortical bone, pore pressure from field variable 1, MPa", bone, count_of(bone), 1e-3,
         continuum_kinds},
        {"ROCK", "layered rock at 75 degrees, undrained, MPa", rock, count_of(rock), 1e-3,
         LODE_SOLID | LODE_PLANE_STRAIN | LODE_PLANE_STRESS},
        {"SEAM",
         "layered rock in general axes without suction, thermal expansion, transport by the host, MPa, mm, s, "
         "1/K",
         seam, count_of(seam), 1e-3, LODE_SOLID},
        {"CORE", "a core drilled at 20 degrees to the layers, MPa, mm, s, 1/K", core, count_of(core), 1e-3,
         LODE_UNIAXIAL},
    };
    static constexpr lode_algorithm algorithms[] = {{"exact for the given strain increment", 0, 0.0, HUGE_VAL}};
    static constexpr lode_model description = {
        .keyword = "PORO_ORTHO",
        .title = "Orthotropic Biot poroelasticity",
        .family = "poroelastic",
        .purpose =
            "Layered rock, bone or wood whose pores are filled with a fluid, its axes at any angle. STRESS is the "
            "total stress; the pore pressure comes from the host or is generated by the strain.",
        .source = "Nairn, chapter 8 (eqs. 8.1-8.60)",
        .kinds = continuum_kinds,
        .traits = LODE_ELASTIC | LODE_ROTATES_STATE,
        .parameters = parameters,
        .parameter_count = count_of(parameters),
        .required_count = 13,
        .state = pore_pressure::states,
        .state_count = pore_pressure::count,
        .samples = samples,
        .sample_count = count_of(samples),
        .algorithms = algorithms,
        .algorithm_count = count_of(algorithms),
        .limits = poro_anisotropic::limits,
    };

    explicit PoroOrtho(const Properties& p) : Law(constants(p)) {}

  private:
    static poro_anisotropic::Constants constants(const Properties& p) {
        const auto moduli = OrthotropicModuli::from_properties(p, 1);
        const poro_anisotropic::Biot biot(p, moduli, {p[10], p[11], p[12]}, 10, 13);
        return {.moduli = moduli,
                .axes = MaterialAxes::from_properties(p, 14),
                .biot = biot,
                .thermal = Expansion::from(moduli, p[20], p[21], p[22]),
                .pores = PorePressure(p, 17, 26, biot.Q, {p[23], p[24], p[25]})};
    }
};

}  // namespace lode
