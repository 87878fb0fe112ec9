// What BISTABLE_ISO says about itself.
#pragma once

#include "lode/material/description.hpp"
#include "lode/material/kind.hpp"

namespace lode {

struct BistableIsoDescription {
    static constexpr lode_parameter parameters[] = {
        required("K0", "bulk modulus of state 0", "stress", above(0.0)),
        required("G0", "shear modulus of state 0", "stress", above(0.0)),
        required("KD", "bulk modulus of state 1", "stress", above(0.0)),
        required("GD", "shear modulus of state 1", "stress", above(0.0)),
        required("RULE", "what decides on the state", "code", code(1, 3),
                 "1 dilation, tr(eps); 2 distortion, sqrt(e:e/2); 3 von Mises stress"),
        required("CRIT", "critical value, absolute (not in percent)", "strain; RULE 3: stress", above(0.0)),
        optional("DV", "offset volumetric strain of state 1, RULE 1 only", "-", any_value(), 0.0),
        optional("REV", "reversible", "code", code(0, 1), 0.0),
        optional("ALPHA0", "thermal expansion of state 0", "1/temp", any_value(), 0.0),
        optional("ALPHAD", "thermal expansion of state 1", "1/temp", any_value(), 0.0, "if left out: ALPHA0"),
        optional("BETA0", "expansion of state 0 per unit of field 1", "1/field", any_value(), 0.0),
        optional("BETAD", "expansion of state 1 per unit of field 1", "1/field", any_value(), 0.0,
                 "if left out: BETA0"),
        optional("SPLIT", "RULE 2, 3: find transitions within an increment", "code", code(0, 1), 1.0,
                 "1 exactly; 0 one step in the old slope"),
    };
    static constexpr lode_state states[] = {
        {"STATE", "0 initial, 1 deformed", 0.0},
        {"E11", "total strain, lateral strains of plane stress and 1D included", 0.0},
        {"E22", "", 0.0},
        {"E33", "", 0.0},
        {"G12", "engineering shear", 0.0},
        {"G13", "", 0.0},
        {"G23", "", 0.0},
        {"DT", "sum of DTEMP", 0.0},
        {"DC", "sum of DPRED(1), where it expands", 0.0},
        {"NTRANS", "number of transitions", 0.0},
    };
    static constexpr unsigned with_thickness = LODE_SOLID | LODE_PLANE_STRAIN;
    static constexpr unsigned free_laterally = LODE_PLANE_STRESS | LODE_UNIAXIAL;
    static constexpr double memory[] = {1000.0, 600.0, 700.0, 300.0, 1.0, 0.02, 0.015, 1.0, 1e-4, 5e-5};
    static constexpr double foam[] = {1000.0, 600.0, 700.0, 300.0, 1.0, 0.02, 0.015};
    static constexpr double layer[] = {1000.0, 600.0, 500.0, 300.0, 1.0, 0.008, 0.002, 1.0, 1e-4, 5e-5, 0.01, 0.02};
    static constexpr double gel[] = {1000.0, 600.0, 1000.0, 150.0, 2.0, 0.01, 0.0, 1.0, 1e-4, 5e-5};
    static constexpr double strand[] = {1000.0, 600.0, 700.0, 300.0, 2.0, 0.01, 0.0, 0.0, 1e-4, 5e-5, 0.01, 0.03};
    static constexpr double polymer[] = {1000.0, 600.0, 500.0, 300.0, 3.0, 12.0, 0.0, 0.0, 1e-4, 1e-4, 0.01, 0.01};
    static constexpr double stiffening[] = {500.0, 300.0, 1000.0, 600.0, 3.0, 6.0, 0.0, 1.0};
    static constexpr double stepwise[] = {1000.0, 600.0, 1000.0, 150.0, 2.0, 0.01, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    static constexpr lode_sample samples[] = {
        {"MEMORY", "dilation switches it back and forth, thermal expansion, MPa, 1/K", memory, count_of(memory), 0.02,
         with_thickness},
        {"FOAM", "collapses once by dilation, MPa", foam, count_of(foam), 0.02, with_thickness},
        {"LAYER", "dilation, heat and moisture, laterally free, MPa, 1/K", layer, count_of(layer), 0.02,
         free_laterally},
        {"GEL", "softens reversibly by distortion, MPa", gel, count_of(gel), 0.02, with_thickness},
        {"STRAND", "softens for good by distortion, heat and moisture, laterally free, MPa, 1/K", strand,
         count_of(strand), 0.02, free_laterally},
        {"POLYMER", "softens for good by von Mises stress, MPa, 1/K", polymer, count_of(polymer), 0.02,
         continuum_kinds},
        {"STIFFENING", "stiffens reversibly by von Mises stress, MPa", stiffening, count_of(stiffening), 0.02,
         continuum_kinds},
        {"STEPWISE", "distortion, one step an increment, MPa", stepwise, count_of(stepwise), 0.02, with_thickness},
    };
    static constexpr lode_algorithm algorithms[] = {
        {"exact transitions along a strain ramp", 13, 1.0, HUGE_VAL},
        {"one step in the old slope (RULE 2, 3)", 13, 0.0, 1.0},
    };
    static constexpr lode_model description = {
        .keyword = "BISTABLE_ISO",
        .title = "Isotropic elasticity with two states",
        .family = "elastic",
        .purpose =
            "A solid that switches between two isotropic elastic states, for good or back and forth: by dilation, with "
            "an offset volume (phase change, collapse of a foam), by distortion or by von Mises stress.",
        .source = "Nairn, chapter 1, section 1.5 (eqs. 1.31-1.35)",
        .kinds = continuum_kinds,
        .traits = LODE_UNSYMMETRIC | LODE_ROTATES_STATE | LODE_OPEN_ENERGY,
        .parameters = parameters,
        .parameter_count = count_of(parameters),
        .required_count = 6,
        .state = states,
        .state_count = count_of(states),
        .samples = samples,
        .sample_count = count_of(samples),
        .algorithms = algorithms,
        .algorithm_count = count_of(algorithms),
        .limits =
            "- RULE 1: the stress jumps at constant strain, the mean stress by KD (CRIT - DV) - K0 CRIT. A load inside "
            "that gap has no static equilibrium: Newton's method of the host alternates between the states and smaller "
            "increments do not help (none is asked for); use a dynamic step. Explicit hosts see a stress pulse.\n"
            "- RULE 1 in plane stress and 1D: the thickness strain depends on the state. Where both states are "
            "admissible the present one stays (hysteresis); where none is (DV < 0, a stiffer state 1) it is state 1.\n"
            "- RULE 2, 3 with REV = 1 are not elastic: a closed strain loop leaves stress.\n"
            "- RULE 3 in plane stress with Poisson's ratios that differ: the states may chatter at the surface; after "
            "8 transitions the increment ends in state 1.\n"
            "- SPLIT = 0: an increment errs by up to |C0 - C1| |de| in each transition.\n"
            "- SSE is sigma : S : sigma/2 of the present state; the work of the transformation is not tracked.\n",
    };
};

}  // namespace lode
