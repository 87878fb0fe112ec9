// A project of somebody else: the catalogue through the C API, and a model used directly from its header.
#include <cmath>
#include <cstdio>
#include <cstring>

#include "lode/lode.h"
#include "lode/plasticity/iso_plastic.hpp"

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

    std::printf("%d models; stress %.9f\n", lode_model_count(), point.stress[0]);
    return listed && std::fabs(point.stress[0] - 415.841584158) < 1e-8 ? 0 : 1;
}
