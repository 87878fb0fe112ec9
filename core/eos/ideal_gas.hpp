// IDEAL_GAS: P V = n R T at the host's temperature or adiabatic (page 55, section 3; Nairn, 9.12.1).
#pragma once

#include "lode/eos/gas.hpp"

namespace lode {

struct IdealGas : gas::Gas<false> {
    static constexpr lode_parameter parameters[] = {
        required("P0", "reference pressure", "stress", above(0.0)),
        required("T0", "reference absolute temperature", "temp", above(0.0)),
        gas::adiabatic_exponent,
        gas::gauge,
        gas::thermal_mode,
        gas::initial_temperature,
        gas::gas_fraction,
        gas::point_volume,
    };
    static constexpr double air[] = {0.101325, 300.0, 1.4, 1, 1};
    static constexpr double helium[] = {0.101325, 300.0};
    static constexpr double steam[] = {0.2, 393.15, 1.33, 0, 1, 400.0, 0.8, 1.2};
    static constexpr lode_sample samples[] = {
        {"AIR", "air, adiabatic, gauge pressure, MPa, K", air, count_of(air), 0.3, gas::served},
        {"HELIUM", "helium at the host's temperature, gauge pressure, MPa, K", helium, count_of(helium), 0.3,
         gas::served},
        {"STEAM", "hot steam among 20 % of other mass, adiabatic, absolute pressure, MPa, K", steam, count_of(steam),
         0.2, gas::served},
    };
    static constexpr lode_model description = {
        .keyword = "IDEAL_GAS",
        .title = "Ideal gas",
        .family = "eos",
        .purpose =
            "Gas in chambers, pores and blast problems: isothermal, at a temperature that the host computes, or "
            "adiabatic; pressure, work, heat and entropy are exact for any size of the increment.",
        .source = "Nairn, chapter 9, section 9.12 (eqs. 9.132-9.155)",
        .kinds = gas::served,
        .traits = gas::traits,
        .parameters = parameters,
        .parameter_count = count_of(parameters),
        .required_count = 2,
        .state = gas::states,
        .state_count = count_of(gas::states),
        .samples = samples,
        .sample_count = count_of(samples),
        .algorithms = gas::algorithms,
        .algorithm_count = count_of(gas::algorithms),
        .limits =
            "- A volume that is not positive or not finite asks for a smaller increment; TEMP <= 0 is refused: "
            "temperatures are absolute.\n"
            "- THERM = 0 with GAUGE = 0 has DDSDDE = 0 exactly (K = P), and no mode has shear stiffness: an implicit "
            "system may be singular. GAUGE = 1 gives P0 1 (x) 1 at the reference state.\n"
            "- GAUGE = 0 puts an initial stress -P0 into the model, which boundary loads must balance. TINIT other "
            "than "
            "T0 is an initial pressure P0 (TINIT/T0 - 1).\n"
            "- SSE is the change of internal energy, which is work and heat; with GAUGE = 1 the work of the ambient "
            "pressure is part of it. RPL is the heat that leaves an isothermal gas.\n"
            "- THERM = 0: the work of an increment is exact at constant temperature, of second order else.\n"
            "- PHI is constant in time; free expansion and mixing entropy are not modelled.\n"
            "- The density of the host is M P0/(R T0)/JP.\n",
    };

    explicit IdealGas(const Properties& p) : Gas(p, 3, 0.0, 0.0) {}
};

}  // namespace lode
