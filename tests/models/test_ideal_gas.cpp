// IDEAL_GAS: the verification cases and failure modes of page 55, section 3.
#include <gtest/gtest.h>

#include <limits>

#include "gas_support.hpp"

namespace lode::test::test_ideal_gas {
namespace {

constexpr AnalysisKind solid = AnalysisKind::solid, plane_strain = AnalysisKind::plane_strain;
constexpr double P0 = 0.101325, T0 = 300.0;
constexpr double printed = 1e-13;  // fourteen digits
const std::string name = "IDEAL_GAS-TEST";

Answer at(const Numbers& props, const Matrix3d& f, double temperature = T0, double dtemp = 0.0) {
    return gas_at(name, props, f, temperature, dtemp);
}
const Matrix3d halved = diagonal_gradient(0.5, 1, 1), doubled = diagonal_gradient(2, 1, 1), kept = Matrix3d::Identity();

// --- 3.6 ---------------------------------------------------------------------------------------------------------

TEST(IdealGas, IsothermalTable) {
    const Answer compressed = at({P0, T0}, halved);
    expect_hydrostatic(-0.101325, compressed.stress, printed);
    EXPECT_NEAR(compressed.state[2], 0.070233138070236, printed * 0.07);
    EXPECT_NEAR(compressed.state[3], -0.070233138070236, printed * 0.07);
    EXPECT_NEAR(compressed.state[4], -0.00023411046023412, printed * 2.3e-4);
    EXPECT_EQ(compressed.state[0], 0.0);
    EXPECT_EQ(compressed.state[1], -0.5);
    expect_hydrostatic(0.0506625, at({P0, T0}, doubled).stress, printed);
}

TEST(IdealGas, AdiabaticTable) {
    const Answer monatomic = at({P0, T0, 5.0 / 3.0, 1, 1}, halved);
    expect_hydrostatic(-0.22036182318136, monatomic.stress, printed);
    expect_close({176.22031559046, -0.5, 0.089277617386017}, monatomic.state, printed);
    EXPECT_NEAR(monatomic.state[2], 0.089277617386017, printed * 0.09);
    EXPECT_NEAR(monatomic.state[3], 0.0, 1e-16);
    EXPECT_EQ(monatomic.state[4], 0.0);

    const Answer diatomic = at({P0, T0, 1.4, 0, 1}, halved);
    expect_hydrostatic(-0.26739827811813, diatomic.stress, printed);
    EXPECT_NEAR(diatomic.state[0], 95.852373231868, printed * 96);
    EXPECT_NEAR(diatomic.state[2], 0.080935347647659, printed * 0.08);
}

TEST(IdealGas, HeatedAtConstantVolume) {
    const Answer a = at({P0, T0}, kept, T0, 100.0);
    expect_hydrostatic(-0.033775, a.stress, printed);
    EXPECT_NEAR(a.state[3], 0.0506625, printed * 0.05);
    EXPECT_NEAR(a.state[4], 0.00014574692995588, printed * 1.5e-4);
    EXPECT_EQ(a.state[2], 0.0);
}

TEST(IdealGas, GasAmongOtherMass) {
    const Answer a = at({P0, 373.15, 4.0 / 3.0, 0, 0, 373.15, 0.25, 5.9e-4}, kept, 373.15);
    expect_hydrostatic(-42.934322033898, a.stress, printed);
}

// --- 3.3, closed solutions ---------------------------------------------------------------------------------------

// (9.149)-(9.152)
TEST(IdealGas, AdiabatIsExactInAnyNumberOfIncrements) {
    for (const double gamma : {5.0 / 3.0, 1.4, 1.1})
        for (const int steps : {1, 7, 100}) {
            const Numbers props = {P0, T0, gamma, 0, 1};
            UmatPoint point(name, solid, props);
            point.temperature(T0);
            double J = 1.0;
            for (int i = 1; i <= steps; ++i) {
                J = 1.0 - 0.8 * i / steps;
                point.advance({.dfgrd1 = diagonal_gradient(J, 1, 1)});
            }
            EXPECT_NEAR(point.stress()[0], -P0 * std::pow(J, -gamma), 1e-13 * steps * P0 * std::pow(J, -gamma));
            const double heated = T0 * (std::pow(J, 1.0 - gamma) - 1.0);
            EXPECT_NEAR(point.state(1), heated, 1e-13 * steps * T0);
            EXPECT_NEAR(point.state(3), P0 / ((gamma - 1) * T0) * heated, 1e-13 * steps * P0 / (gamma - 1));
            EXPECT_EQ(point.state(5), 0.0);
            EXPECT_NEAR(J * point.sse(), point.state(3) + point.state(4), 1e-15);
        }
}

TEST(IdealGas, TinyStrainsKeepFullRelativeAccuracy) {
    for (const double wanted : {1e-6, 1e-9, 1e-12}) {
        const double h = (1.0 + wanted) - 1.0;
        EXPECT_NEAR(at({P0, T0}, diagonal_gradient(1 + h, 1, 1)).stress[0], P0 * h / (1 + h), 4e-16 * P0 * h);
        EXPECT_NEAR(at({P0, T0, 1.4, 1, 1}, diagonal_gradient(1 + h, 1, 1)).stress[0],
                    -P0 * std::expm1(-1.4 * std::log1p(h)), 2e-15 * P0 * h);
    }
}

TEST(IdealGas, PlaneStrainIsTheSolid) {
    const Numbers props = {P0, T0, 1.4, 1, 1, 320.0, 0.7, 1.1};
    Matrix3d f = diagonal_gradient(0.8, 1.1, 0.9);
    f(0, 1) = 0.2;
    UmatPoint plane(name, plane_strain, props), full(name, solid, props);
    const Answer a = plane.temperature(T0).advance({.dfgrd1 = f}), b = full.temperature(T0).advance({.dfgrd1 = f});
    expect_close({b.stress[0], b.stress[1], b.stress[2], 0}, a.stress, 1e-15);
    EXPECT_TRUE(identical(a.state, b.state));
}

TEST(IdealGas, InitialTemperatureIsAnInitialPressure) {
    const Answer a = at({P0, T0, 1.4, 1, 1, 330.0}, kept);
    expect_hydrostatic(-P0 * (330.0 / T0 - 1.0), a.stress, 1e-14);
    // in mode 0 the host's temperature decides; TREL counts from TINIT
    const Answer b = at({P0, T0, 1.4, 1, 0, 330.0}, kept, 315.0);
    expect_hydrostatic(-P0 * (315.0 / T0 - 1.0), b.stress, 1e-14);
    EXPECT_NEAR(b.state[0], -15.0, 1e-12);
}

TEST(IdealGas, GaugeAndAbsolutePressureDifferByTheReference) {
    const double gauge = at({P0, T0, 1.4, 1, 1}, halved).stress[0],
                 absolute = at({P0, T0, 1.4, 0, 1}, halved).stress[0];
    EXPECT_NEAR(gauge - absolute, P0, 1e-16);
    EXPECT_NEAR(at({P0, T0, 1.4, 0}, kept).stress[0], -P0, 1e-17);
}

// --- 3.4 ---------------------------------------------------------------------------------------------------------

TEST(IdealGas, Tangent) {
    const Matrix3d f = diagonal_gradient(0.7, 1.1, 0.9);
    for (const AnalysisKind kind : {solid, plane_strain})
        for (const double gauge : {0.0, 1.0})
            for (const double thermal : {0.0, 1.0}) {
                UmatPoint point(name, kind, {P0, T0, 1.4, gauge, thermal, 310.0, 0.8, 1.3});
                point.temperature(T0).advance({.dfgrd1 = diagonal_gradient(1.1, 1, 1)});
                expect_gas_tangent(point, f);
            }
}

// 3.5: K = P of the isothermal gas, so absolute pressure leaves nothing and gauge pressure P0 1 (x) 1.
TEST(IdealGas, IsothermalStiffness) {
    EXPECT_LE(at({P0, T0, 1.4, 0}, halved).tangent.cwiseAbs().maxCoeff(), 1e-16);
    const Answer a = at({P0, T0}, halved);
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j) EXPECT_NEAR(a.tangent(i, j), i < 3 && j < 3 ? P0 : 0.0, 1e-16);
}

TEST(IdealGas, HeatLeavesACompressedIsothermalGas) {
    UmatPoint point(name, solid, {P0, T0});
    const Answer a = point.temperature(T0).advance({.dtime = 0.25, .dfgrd1 = halved});
    EXPECT_NEAR(a.rpl, -a.state[3] / (0.5 * 0.25), 1e-15);  // per current volume and time
    EXPECT_GT(a.rpl, 0.0);
    EXPECT_EQ(at({P0, T0, 1.4, 1, 1}, halved).rpl, 0.0);
    UmatPoint at_once(name, solid, {P0, T0});
    EXPECT_EQ(at_once.temperature(T0).advance({.dtime = 0.0, .dfgrd1 = halved}).rpl, 0.0);
}

TEST(IdealGas, ProbeOfAnExplicitHostIsAdiabatic) {
    VumatBlock block(name, solid, {P0, T0, 1.4});
    block.points.push_back(block.fresh_point());
    block.points[0].strain_increment = {1e-3, 2e-3, 0, 5e-3, 0, 0};
    block.step_time = block.total_time = 0.0;
    ASSERT_EQ(block.run().stops, 0);
    expect_hydrostatic(1.4 * P0 * 3e-3, block.points[0].stress, 1e-15);
}

// --- energy balance through VUMAT --------------------------------------------------------------------------------

// The trapezoid rule over the stresses is of second order; W, which is exact, is what it converges to. With gauge
// pressure the ambience works too.
TEST(IdealGas, WorkOfAShockAndRarefaction) {
    const auto constant = [](double) { return T0; };
    for (const double thermal : {0.0, 1.0})
        for (const double gauge : {0.0, 1.0}) {
            const Numbers props = {P0, T0, 1.4, gauge, thermal};
            double errors[3];
            for (int k = 0; k < 3; ++k) {
                const GasPath path = follow(name, props, 50 << (2 * k), shock_and_rarefaction, constant);
                const double ambient = gauge * P0 * (shock_and_rarefaction(1.0) - 1.0);
                errors[k] = std::abs(path.stress_work - (path.end.state[2] + ambient));
                // internal energy per mass: work and heat
                EXPECT_NEAR(2.0 * path.end.internal_energy, path.end.state[2] + path.end.state[3], 1e-15);
            }
            EXPECT_NEAR(std::log2(errors[0] / errors[1]), 4.0, 0.1) << "order 2, steps by 4";
            EXPECT_NEAR(std::log2(errors[1] / errors[2]), 4.0, 0.1);
            EXPECT_LT(errors[2], 1e-5 * P0);
        }
}

TEST(IdealGas, ClosedCycleGivesEverythingBack) {
    const auto constant = [](double) { return T0; };
    for (const double thermal : {0.0, 1.0}) {
        const GasPath path = follow(name, {P0, T0, 1.4, 1, thermal}, 64, closed_cycle, constant);
        for (const double x : path.end.stress) EXPECT_NEAR(x, 0.0, 1e-13 * P0);
        EXPECT_NEAR(path.end.state[0], 0.0, 1e-12 * T0);
        for (const std::size_t i : {2u, 3u}) EXPECT_NEAR(path.end.state[i], 0.0, 1e-13 * P0);
        EXPECT_NEAR(path.end.state[4], 0.0, 1e-13 * P0 / T0);
        EXPECT_NEAR(path.end.internal_energy, 0.0, 1e-13 * P0);
        EXPECT_NEAR(path.stress_work, 0.0, 1e-13 * P0);  // the way back is that of the way there
    }
}

// Stirling's cycle with the temperature of the host: the heat that becomes work is the area in the p-V diagram, and the
// work of an increment at varying temperature is of second order.
TEST(IdealGas, CycleWithChangingTemperature) {
    const auto volume = [](double t) { return 1.0 + 0.4 * std::cos(2 * M_PI * t) - 0.4; };
    const auto temperature = [](double t) { return T0 + 80.0 * std::sin(2 * M_PI * t); };
    double work[5];
    for (int k = 0; k < 5; ++k) {
        const GasPath path = follow(name, {P0, T0}, 20 << k, volume, temperature);
        work[k] = path.end.state[2];
        EXPECT_NEAR(path.end.state[2] + path.end.state[3], 0.0, 1e-13 * P0);
        EXPECT_NEAR(path.end.state[4], 0.0, 1e-13 * P0 / T0) << "entropy is a state function";
    }
    EXPECT_GT(std::abs(work[4]), 1e-3 * P0);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(std::log2((work[k] - work[k + 1]) / (work[k + 1] - work[k + 2])), 2.0, 0.1);
}

// --- 3.5, where it fails -----------------------------------------------------------------------------------------

TEST(IdealGas, NegativeVolumesAskForASmallerIncrement) {
    UmatPoint point(name, solid, {P0, T0, 1.4, 1, 1});
    point.temperature(T0).advance({.dfgrd1 = halved});
    for (const Matrix3d& f : {diagonal_gradient(-0.5, 1, 1), diagonal_gradient(0, 1, 1),
                              diagonal_gradient(std::numeric_limits<double>::infinity(), 1, 1)}) {
        const Answer a = point.evaluate({.dfgrd1 = f});
        EXPECT_TRUE(a.cut);
        EXPECT_EQ(a.pnewdt, 0.25);
        EXPECT_TRUE(identical(a.stress, point.stress()));
        EXPECT_TRUE(identical(a.state, point.state()));
    }
}

TEST(IdealGas, TemperaturesAreAbsolute) {
    UmatPoint point(name, solid, {P0, T0});
    const Answer a = point.temperature(20.0).evaluate({.dtemp = -20.0});
    EXPECT_EQ(a.messages.stops, 1);
    EXPECT_NE(a.first_error().find("absolute temperature"), std::string::npos) << a.first_error();
    EXPECT_NE(a.first_error().find("> 0"), std::string::npos) << a.first_error();
    UmatPoint adiabatic(name, solid, {P0, T0, 1.4, 1, 1});
    EXPECT_EQ(adiabatic.temperature(T0).evaluate({.dtemp = -301.0}).messages.stops, 1);
    // an adiabatic gas does not look at TEMP
    EXPECT_TRUE(adiabatic.temperature(0.0).evaluate({.dfgrd1 = halved}).done());

    VumatBlock block(name, solid, {P0, T0});
    block.points.assign(5, block.fresh_point());
    for (VumatPoint& p : block.points) p.temperature_old = p.temperature_new = T0;
    block.points[3].temperature_new = -1.0;
    const HostMessages messages = block.run();
    EXPECT_EQ(messages.stops, 1);
    ASSERT_FALSE(messages.errors.empty());
    EXPECT_NE(messages.errors[0].find("point 4"), std::string::npos) << messages.errors[0];
}

TEST(IdealGas, RefusesBadConstants) {
    expect_refused(name, {0.0, T0}, {name, "PROPS(1)", "P0"});
    expect_refused(name, {P0, 0.0}, {"PROPS(2)", "T0"});
    expect_refused(name, {P0, T0, 1.0}, {"PROPS(3)", "GAMMA"});
    expect_refused(name, {P0, T0, 1.4, 2}, {"PROPS(4)", "GAUGE"});
    expect_refused(name, {P0, T0, 1.4, 1, 0.5}, {"PROPS(5)", "THERM"});
    expect_refused(name, {P0, T0, 1.4, 1, 1, -3.0}, {"PROPS(6)", "TINIT"});
    expect_refused(name, {P0, T0, 1.4, 1, 1, 0, 1.5}, {"PROPS(7)", "PHI"});
    expect_refused(name, {P0, T0, 1.4, 1, 1, 0, 1, 0}, {"PROPS(8)", "JP"});
    for (const AnalysisKind kind : {AnalysisKind::plane_stress, AnalysisKind::uniaxial, AnalysisKind::cohesive_3d})
        expect_refused(name, {P0, T0}, {name, "not served"}, kind);
}

}  // namespace
}  // namespace lode::test::test_ideal_gas
