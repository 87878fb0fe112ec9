// A project of somebody else: the catalogue through the C API, a model used directly from its header, and the same
// model through the entry point.
#include <cmath>
#include <cstdio>
#include <cstring>

#include "lode/entry_points.h"
#include "lode/lode.h"
#include "lode/plasticity/iso_plastic.hpp"

namespace {

// The stress of a bar of the material after the first increment.
double stress_by_umat(const double* props, int nprops, double strain) {
    double stress[1] = {}, statev[4] = {}, ddsdde[1], sse = 0, spd = 0, scd = 0, rpl = 0, ddsddt[1], drplde[1],
           drpldt = 0;
    double pnewdt = 1.0;
    const double zeros[9] = {}, one = 1.0, identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    const int ndi = 1, nshr = 0, ntens = 1, nstatv = 4, number = 1;
    char cmname[LODE_CMNAME_LENGTH];
    std::memset(cmname, ' ', sizeof cmname);
    std::memcpy(cmname, "ISO_PLASTIC-MINE", 16);
    umat_(stress, statev, ddsdde, &sse, &spd, &scd, &rpl, ddsddt, drplde, &drpldt, zeros, &strain, zeros, &one, zeros,
          zeros, zeros, zeros, cmname, &ndi, &nshr, &ntens, &nstatv, props, &nprops, zeros, identity, &pnewdt, &one,
          identity, identity, &number, &number, &number, &number, &number, &number, sizeof cmname);
    return stress[0];
}

}  // namespace

int main() {
    bool listed = false;
    for (int i = 0; i < lode_model_count(); ++i) listed |= std::strcmp(lode_model_at(i)->keyword, "ISO_PLASTIC") == 0;

    const double constants[] = {200000.0, 0.3, 400.0, 1.0, 2000.0};
    const lode::IsoPlastic steel(lode::Properties(lode::IsoPlastic::description, "MY_STEEL", constants, 5));
    constexpr auto kind = lode::AnalysisKind::uniaxial;
    const double no_change[] = {0.0, 0.0};
    double state[4] = {}, stiffness[1], thermal_stress[1] = {}, heat[1] = {};
    lode::Increment<kind, double> increment;
    increment.strain_increment[0] = 0.01;
    increment.time_increment = 1.0;
    increment.temperature_source[0] = increment.temperature_source[1] = no_change;
    lode::Point<kind, double> point;
    point.stress[0] = 0.0;
    point.state = lode::State<double>(state, state, 1, 4);
    lode::Tangent<kind> tangent{stiffness, thermal_stress, heat};
    steel.update(increment, point, tangent);

    const double by_umat = stress_by_umat(constants, 5, 0.01);
    std::printf("%d models; stress %.9f, through umat_ %.9f\n", lode_model_count(), point.stress[0], by_umat);
    return listed && std::fabs(point.stress[0] - 415.841584158) < 1e-8 && std::fabs(by_umat - 415.841584158) < 1e-8 ? 0
                                                                                                                    : 1;
}
