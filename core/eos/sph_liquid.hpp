// SPH_LIQUID: liquid with a power law for the pressure, as used in smoothed particle hydrodynamics, and viscosity
// (page 55, section 4; Nairn, 9.13.1).
#pragma once

#include "lode/eos/liquid.hpp"
#include "lode/hyperelastic/dilatational_energy.hpp"

namespace lode {

// p = (K0/GAM) (J*^-GAM - 1), K = K0 J*^-GAM, U = (K0/GAM) [(J*^(1 - GAM) - 1)/(GAM - 1) + m], m = J* - 1.
struct PowerPressure {
    double bulk, exponent;  // K0, GAM

    double lowest_pressure() const { return -bulk / exponent; }
    double volume_at(double pressure) const { return std::expm1(-std::log1p(exponent * pressure / bulk) / exponent); }

    template <class Real>
    LODE_INLINE liquid::PressureState<Real> at(const Real& m, const Real& J) const {
        const VolumeRatio<Real> v(m, J);
        const Real ln = v.logarithm(), growth = expm1(-exponent * ln);
        Real energy = v.excess_over_log();  // m - ln J*
        if (exponent != 1.0) {
            const Real x = (1.0 - exponent) * ln;
            energy = energy + (1.0 / (exponent - 1.0)) * liquid::exp_remainder(x, expm1(x));
        }
        return {(bulk / exponent) * growth, bulk * (1.0 + growth), (bulk / exponent) * energy};
    }
};

struct SphLiquid : liquid::Liquid<PowerPressure> {
    static constexpr auto parameters =
        liquid::make_parameters(optional("GAM", "exponent of the pressure", "-", above(0.0), 7.0));
    static constexpr double water[] = {2200.0, 1e-9};
    static constexpr double oil[] = {1600.0, 1e-3, 9.0, 2.5e-4, 1e-3, 5.0};
    static constexpr double mud[] = {1800.0, 0.0, 7.0, 0.0, 0.0, 0.0, 3, -2.0, 1e-2, 0.0, 3e-3, 2.0, 2e-3};
    static constexpr lode_sample samples[] = {
        {"WATER", "water, MPa, s", water, count_of(water), 0.05, liquid::served},
        {"OIL", "heavy oil under pressure, heat and moisture, MPa, s, K", oil, count_of(oil), 0.05, liquid::served},
        {"MUD", "mud with a table of viscosities, MPa, s", mud, count_of(mud), 0.05, liquid::served},
    };
    static constexpr lode_model description = {
        .keyword = "SPH_LIQUID",
        .title = "Viscous liquid with a power law for the pressure",
        .family = "eos",
        .purpose =
            "Weakly compressible liquids in explicit and particle methods, with constant or rate-dependent viscosity, "
            "thermal expansion and an initial pressure.",
        .source = "Nairn, chapter 9, section 9.13.1 (eqs. 9.192-9.197)",
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
            "- Tension: the pressure tends to -K0/GAM and the bulk modulus to zero; there is no cavitation cut-off.\n"
            "- J < 0.7: the Tait and SPH equations differ by 7 % at 0.7 and by a factor of 2.4 at 0.5.\n"
            "- Without viscosity the implicit system has no shear stiffness. With it the tangent holds 2 ETA/DTIME, "
            "which grows without limit as DTIME vanishes; DTIME = 0 leaves the viscous stress out.\n"
            "- A table in which the viscous stress falls from one pair to the next is refused; where it falls on the "
            "way between them, a warning is given: ellipticity is lost there.\n"
            "- The strain rate is the mean of the increment: first order in time.\n"
            "- Axisymmetry needs DSTRAN(3). Explicit time steps: rho c^2 = K and dt <= 3 L^2 rho/(8 ETA).\n"
            "- The density of the host is rho0/J_init, rho0 that at zero pressure.\n",
    };

    explicit SphLiquid(const Properties& p) : Liquid(p, {p[liquid::K0], p[liquid::FORM]}) {}
};

}  // namespace lode
