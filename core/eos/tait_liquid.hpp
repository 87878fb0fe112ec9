// TAIT_LIQUID: liquid with the Tait equation of state and viscosity (page 55, section 4; Nairn, 9.13).
#pragma once

#include "lode/eos/liquid.hpp"

namespace lode {

// p = C K0 [exp(-m/C) - 1] (9.185), K = K0 J* exp(-m/C) (9.191), U = C K0 [C exp(-m/C) + m - C], m = J* - 1.
struct TaitPressure {
    double bulk, form;  // K0, C

    double lowest_pressure() const { return -form * bulk; }
    double volume_at(double pressure) const { return -form * std::log1p(pressure / (form * bulk)); }

    template <class Real>
    LODE_INLINE liquid::PressureState<Real> at(const Real& m, const Real& J) const {
        const Real x = (-1.0 / form) * m, growth = expm1(x);
        return {form * bulk * growth, bulk * J * (1.0 + growth), form * form * bulk * liquid::exp_remainder(x, growth)};
    }
};

struct TaitLiquid : liquid::Liquid<TaitPressure> {
    static constexpr auto parameters = liquid::make_parameters(optional("C", "Tait constant", "-", above(0.0), 0.0894));
    static constexpr double water[] = {2200.0, 1e-9, 0.0894, 7e-5};
    static constexpr double melt[] = {1500.0, 2e-3, 0.0894, 2e-4, 1e-3, 3.0};
    static constexpr double thinning[] = {1500.0, 0.0, 0.09, 2e-4, 0.0,  0.0, 4,   -2.0,
                                          2e-3,   0.0, 1e-3, 1.0,  4e-4, 3.0, 1e-4};
    static constexpr lode_sample samples[] = {
        {"WATER", "water, MPa, s, K", water, count_of(water), 0.05, liquid::served},
        {"MELT", "polymer melt under pressure, heat and moisture, MPa, s, K", melt, count_of(melt), 0.05,
         liquid::served},
        {"THINNING", "shear-thinning melt with a table of viscosities, MPa, s, K", thinning, count_of(thinning), 0.05,
         liquid::served},
    };
    static constexpr lode_model description = {
        .keyword = "TAIT_LIQUID",
        .title = "Viscous liquid with the Tait equation of state",
        .family = "eos",
        .purpose =
            "Water and other liquids up to high pressures, and polymer melts, with constant or rate-dependent "
            "viscosity, thermal expansion and an initial pressure.",
        .source = "Nairn, chapter 9, section 9.13 (eqs. 9.174-9.191)",
        .kinds = liquid::served,
        .traits = liquid::traits,
        .parameters = parameters.data(),
        .parameter_count = count_of(parameters),
        .required_count = 2,
        .state = liquid::states,
        .state_count = count_of(liquid::states),
        .samples = samples,
        .sample_count = count_of(samples),
        .algorithms = liquid::algorithms,
        .algorithm_count = count_of(liquid::algorithms),
        .limits =
            "- Tension: the pressure tends to -C K0 and the bulk modulus to zero; there is no cavitation cut-off.\n"
            "- J < 0.7: the Tait and SPH equations differ by 7 % at 0.7 and by a factor of 2.4 at 0.5.\n"
            "- Without viscosity the implicit system has no shear stiffness. With it the tangent holds 2 ETA/DTIME, "
            "which grows without limit as DTIME vanishes; DTIME = 0 leaves the viscous stress out.\n"
            "- A table in which the viscous stress falls from one pair to the next is refused; where it falls on the "
            "way between them, a warning is given: ellipticity is lost there.\n"
            "- The strain rate is the mean of the increment: first order in time.\n"
            "- Axisymmetry needs DSTRAN(3). Explicit time steps: rho c^2 = K and dt <= 3 L^2 rho/(8 ETA).\n"
            "- The density of the host is rho0/J_init, rho0 that at zero pressure.\n",
    };

    explicit TaitLiquid(const Properties& p) : Liquid(p, {p[liquid::K0], p[liquid::FORM]}) {}
};

}  // namespace lode
