// VDW_GAS: van der Waals gas, (P + a/V^2)(V - b) = R T per mole (page 55, section 3; Nairn, 9.12.2).
#pragma once

#include "lode/eos/gas.hpp"

namespace lode {

struct VdwGas : gas::Gas<true> {
    static constexpr lode_parameter parameters[] = {
        required("P0", "reference pressure", "stress", above(0.0)),
        required("T0", "reference absolute temperature", "temp", above(0.0)),
        required("A", "van der Waals attraction a", "stress volume^2/mol^2", at_least(0.0)),
        required("B", "van der Waals covolume b", "volume/mol", at_least(0.0)),
        required("RGAS", "gas constant", "energy/(mol temp)", above(0.0),
                 "8.314462618 J/(mol K), 8314.462618 in mm3 MPa/(mol K)"),
        gas::adiabatic_exponent,
        gas::gauge,
        gas::thermal_mode,
        gas::initial_temperature,
        gas::gas_fraction,
        gas::point_volume,
    };
    static constexpr double carbon_dioxide[] = {0.101325, 300.0, 3.64e11, 42670.0, 8314.462618, 1.3, 1, 1};
    static constexpr double nitrogen[] = {10.0, 300.0, 1.37e11, 38700.0, 8314.462618, 1.4};
    static constexpr double propane[] = {2.0, 400.0, 9.39e11, 90490.0, 8314.462618, 1.13, 1, 1, 405.0, 0.9, 0.8};
    static constexpr lode_sample samples[] = {
        {"CARBON_DIOXIDE", "carbon dioxide, adiabatic, gauge pressure, MPa, mm, K", carbon_dioxide,
         count_of(carbon_dioxide), 0.3, gas::served},
        {"NITROGEN", "nitrogen at 10 MPa and the host's temperature, MPa, mm, K", nitrogen, count_of(nitrogen), 0.25,
         gas::served},
        {"PROPANE", "dense propane among 10 % of other mass, adiabatic, gauge pressure, MPa, mm, K", propane,
         count_of(propane), 0.2, gas::served},
    };
    static constexpr lode_model description = {
        .keyword = "VDW_GAS",
        .title = "Van der Waals gas",
        .family = "eos",
        .purpose =
            "Dense gases, with the volume of the molecules and their attraction: isothermal, at a temperature that the "
            "host computes, or adiabatic; exact for any size of the increment.",
        .source = "Nairn, chapter 9, section 9.12.2 (eqs. 9.156-9.173)",
        .kinds = gas::served,
        .traits = gas::traits,
        .parameters = parameters,
        .parameter_count = count_of(parameters),
        .required_count = 5,
        .state = gas::states,
        .state_count = count_of(gas::states),
        .samples = samples,
        .sample_count = count_of(samples),
        .algorithms = gas::algorithms,
        .algorithm_count = count_of(gas::algorithms),
        .limits =
            "- A volume below that of the molecules asks for a smaller increment; TEMP <= 0 is refused: temperatures "
            "are absolute.\n"
            "- A reference state on the liquid side of the isotherm is refused.\n"
            "- Below the critical temperature 8A/(27 B RGAS) isotherms fall between the spinodals: DDSDDE is not "
            "positive there and nothing is done about it (no Maxwell construction); a warning is given once.\n"
            "- No mode has shear stiffness: prefer explicit hosts, or gas enclosed by stiff solids.\n"
            "- GAUGE = 0 puts an initial stress -P0 into the model, which boundary loads must balance. TINIT other "
            "than "
            "T0 is an initial pressure (P0 + a')(TINIT/T0 - 1).\n"
            "- SSE is the change of internal energy, which is work and heat; with GAUGE = 1 the work of the ambient "
            "pressure is part of it. RPL is the heat that leaves an isothermal gas.\n"
            "- THERM = 0: the work of an increment is exact at constant temperature, of second order else.\n"
            "- PHI is constant in time; free expansion and mixing entropy are not modelled.\n"
            "- The density of the host is M P0'/(R T0)/JP, P0' = (P0 + a')(1 - b').\n",
    };

    explicit VdwGas(const Properties& p) : VdwGas(p, molar_volume(p)) {}

    double molar_volume_ratio;  // of the reference state to that of an ideal gas

  private:
    VdwGas(const Properties& p, double x)
        : Gas(p, 6, p[3] / square(x * ideal_volume(p)), p[4] / (x * ideal_volume(p))), molar_volume_ratio(x) {}

    static double ideal_volume(const Properties& p) { return p[5] * p[2] / p[1]; }

    // Molar volume at P0, T0 relative to that of an ideal gas: the largest root of
    //     f(x) = (P0 + a/x^2)(x - b) - P0,
    // to which Newton's method descends from x = 1 + b.
    static double molar_volume(const Properties& p) {
        const double P0 = p[1], a = p[3] / square(ideal_volume(p)), b = p[4] / ideal_volume(p);
        double x = 1.0 + b;
        for (int i = 0; i < 200; ++i) {
            const double inverse = 1.0 / x, f = (P0 + a * inverse * inverse) * (x - b) - P0;
            const double slope = P0 - a * inverse * inverse * (1.0 - 2.0 * b * inverse);
            const double next = x - f / slope;
            if (!(slope > 0.0) || !(next > b)) p.refuse("T0 and P0 lie on the liquid side of the isotherm");
            if (next >= x) return x;  // rounding stops the descent
            x = next;
        }
        return x;
    }
};

}  // namespace lode
