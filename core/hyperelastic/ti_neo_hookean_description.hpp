// What TI_NEO_HOOKEAN says about itself.
#pragma once

#include "lode/hyperelastic/dilatational_energy.hpp"

namespace lode {

struct TiNeoHookeanDescription {
    static constexpr lode_parameter parameters[] = {
        required("EA", "axial Young's modulus", "stress", above(0.0)),
        required("ET", "transverse Young's modulus", "stress", above(0.0)),
        required("GA", "axial shear modulus", "stress", above(0.0)),
        required("NUA", "axial Poisson's ratio", "-", any_value(),
                 "load along the axis; 2 (1 - NUT)/ET > 4 NUA^2/EA is needed"),
        required("NUT", "transverse Poisson's ratio", "-", inside(-1.0, 1.0)),
        dilatational_option(0.0),
        optional("A1", "axial direction in the reference basis", "-", any_value(), 1.0,
                 "A is normalised; in the plane kinds it lies in the plane or is (0, 0, 1)"),
        optional("A2", "axial direction, component 2", "-", any_value(), 0.0),
        optional("A3", "axial direction, component 3", "-", any_value(), 0.0),
        optional("ALPHAA", "axial thermal expansion", "1/temp", any_value(), 0.0),
        optional("ALPHAT", "transverse thermal expansion", "1/temp", any_value(), 0.0),
        optional("BETAA", "axial expansion per unit of field 1", "1/field", any_value(), 0.0),
        optional("BETAT", "transverse expansion per unit of field 1", "1/field", any_value(), 0.0),
        optional("ORI", "basis of F", "code", code(0, 1), 0.0,
                 "0 the second index of F refers to a fixed basis, 1 both refer to axes that turn with the material "
                 "(continuum elements with a local orientation in Abaqus/Standard)"),
    };
    static constexpr lode_state states[] = {
        {"EPSA", "axial residual strain, logarithm of the free stretch", 0.0},
        {"EPST", "transverse residual strain, logarithm of the free stretch", 0.0},
        {"F33M1", "total thickness stretch - 1, plane stress only", 0.0},
    };
    static constexpr double carbon[] = {140.0, 9.5, 5.8, 0.3, 0.45};
    static constexpr double tendon[] = {30.0, 10.0, 5.0, 0.25, 0.4, 1.0, 1.0, 2.0, 0.0, 1e-5, 8e-5};
    static constexpr double wood[] = {12.0, 0.8, 0.7, 0.4, 0.3, 2.0, 0.0, 0.0, 1.0, 4e-6, 4e-5, 1e-3, 2e-2};
    static constexpr double oblique[] = {30.0, 10.0, 5.0, 0.25, 0.4, 2.0, 1.0, 2.0, -0.5, 1e-5, 8e-5, 1e-3, 2e-3};
    static constexpr double sheet[] = {3.0, 1.0, 0.4, 0.3, 0.3, 2.0, 1.0, -1.0};
    static constexpr unsigned served = LODE_SOLID | LODE_PLANE_STRAIN | LODE_PLANE_STRESS;
    static constexpr lode_sample samples[] = {
        {"CARBON", "carbon fibre and epoxy, GPa", carbon, count_of(carbon), 0.02, served},
        {"TENDON", "fibres in the plane, U = lambda/2 (J - 1)^2, thermal expansion, MPa, 1/K", tendon, count_of(tendon),
         0.1, served},
        {"WOOD", "grain normal to the plane, U = lambda/2 (ln J)^2, heat and moisture, GPa, 1/K, 1/(kg/kg)", wood,
         count_of(wood), 0.05, served},
        {"OBLIQUE", "fibres in a general direction, every option, MPa, 1/K, 1/(kg/m3)", oblique, count_of(oblique), 0.1,
         LODE_SOLID},
        {"SHEET", "fibres at -45 degrees in the plane, U = lambda/2 (ln J)^2, MPa", sheet, count_of(sheet), 0.1,
         served},
    };
    static constexpr lode_algorithm algorithms[] = {
        {"total, exact for any increment", 0, 0.0, HUGE_VAL},
    };
    static constexpr lode_model description = {
        .keyword = "TI_NEO_HOOKEAN",
        .title = "Transversely isotropic neo-Hookean solid",
        .family = "hyperelastic",
        .purpose =
            "Fibre-reinforced solids, wood and tissue at finite strain and rotation: a neo-Hookean matrix with one "
            "stiff or soft direction that turns with the material; at small strain the linear transversely isotropic "
            "solid. Anisotropic thermal and moisture expansion.",
        .source = "Nairn, chapter 9, section 9.9 (eqs. 9.91-9.93)",
        .kinds = served,
        .traits = LODE_FINITE_STRAIN | LODE_ELASTIC | LODE_HISTORY_STRESS | LODE_ITERATES,
        .parameters = parameters,
        .parameter_count = count_of(parameters),
        .required_count = 5,
        .state = states,
        .state_count = count_of(states),
        .samples = samples,
        .sample_count = count_of(samples),
        .algorithms = algorithms,
        .algorithm_count = count_of(algorithms),
        .limits =
            "- Geometric non-linearity is required; without it the host passes F = I and the stress stays zero.\n"
            "- det F <= 0 or a deformation that is not finite asks for a smaller increment.\n"
            "- Plane kinds: A lies in the plane or is (0, 0, 1); any other direction ends the analysis with a "
            "message.\n"
            "- Axial compression: shear instability (fibre kinking) when GA + (4 ga - 2 al)(l^2 - 1) + 4 be ln l <= 0, "
            "to first order at the strain -GA/(8 ga - 4 al + 4 be): l = 0.95 for (140, 9.5, 5.8, 0.3, 0.45). "
            "DDSDDE is then not positive definite and results depend on the mesh. A warning is given once.\n"
            "- The energy is not polyconvex; with UJ = 1 axial convexity is lost in strong compression as well.\n"
            "- NUA too large for 1/KT > 0 is refused. Plane stress: where no thickness stretch makes the stress 33 "
            "vanish a smaller increment is asked for.\n"
            "- The residual strain accumulates from the first call: the state there is free of it.\n",
    };
};

}  // namespace lode
