// VDW_GAS: the verification cases and failure modes of page 55, section 3.
#include <gtest/gtest.h>

#include "gas_support.hpp"
#include "lode/eos/vdw_gas.hpp"

namespace lode::test::test_vdw_gas {
namespace {

constexpr AnalysisKind solid = AnalysisKind::solid;
constexpr double P0 = 0.101325, T0 = 300.0, Rgas = 8314.462618;
constexpr double printed = 1e-13;  // fourteen digits
const std::string name = "VDW_GAS-TEST";

Numbers carbon_dioxide(const Numbers& more = {}) {
    Numbers props = {P0, T0, 3.64e11, 42670.0, Rgas};
    props.insert(props.end(), more.begin(), more.end());
    return props;
}
Numbers nitrogen(const Numbers& more = {}) {
    Numbers props = {10.0, T0, 1.37e11, 38700.0, Rgas};
    props.insert(props.end(), more.begin(), more.end());
    return props;
}
VdwGas model(const Numbers& props) {
    return VdwGas(Properties(VdwGas::description, name, props.data(), static_cast<int>(props.size())));
}
Answer at(const Numbers& props, const Matrix3d& f, double dtemp = 0.0) { return gas_at(name, props, f, T0, dtemp); }

// --- 3.6 ---------------------------------------------------------------------------------------------------------

TEST(VdwGas, ReferenceState) {
    const VdwGas co2 = model(carbon_dioxide()), n2 = model(nitrogen());
    EXPECT_NEAR(co2.molar_volume_ratio, 0.99579065882155, printed);
    EXPECT_NEAR(co2.a, 0.00060574192441224, printed * 6e-4);
    EXPECT_NEAR(co2.b, 0.0017406672868827, printed * 2e-3);
    EXPECT_NEAR(co2.R * T0, 0.10175331441642, printed * 0.1);
    EXPECT_NEAR(n2.molar_volume_ratio, 0.9633984242359, printed);
    EXPECT_NEAR(n2.a, 2.3724541299243, printed * 3);
    EXPECT_NEAR(n2.b, 0.16104587064384, printed * 0.2);
    EXPECT_NEAR(n2.R * T0, 10.37992148257, printed * 10);
    // critical temperatures from the page's constants
    EXPECT_NEAR(8 * 3.64e11 / (27 * 42670.0 * Rgas), 303.998036517, 1e-8);
    EXPECT_NEAR(8 * 1.37e11 / (27 * 38700.0 * Rgas), 126.15417851398, 1e-10);
}

TEST(VdwGas, CarbonDioxideTable) {
    const Matrix3d f = diagonal_gradient(0.05, 1, 1);
    const Answer isothermal = at(carbon_dioxide(), f);
    expect_hydrostatic(-1.7648473841975, isothermal.stress, printed);
    EXPECT_NEAR(isothermal.state[2], 0.29674482214514, printed);
    EXPECT_NEAR(isothermal.state[3], -0.30825391870897, printed);
    EXPECT_NEAR(isothermal.state[4], -0.0010275130623632, printed * 1e-3);
    const Answer adiabatic = at(carbon_dioxide({1.4, 1, 1}), f);
    expect_hydrostatic(-6.7396202085276, adiabatic.stress, printed);
    EXPECT_NEAR(adiabatic.state[0], 707.82721411615, printed * 707);
    EXPECT_NEAR(adiabatic.state[2], 0.58868894568997, printed);
    EXPECT_NEAR(adiabatic.state[3], 0.0, 1e-15);
    EXPECT_EQ(adiabatic.state[4], 0.0);
}

TEST(VdwGas, NitrogenTable) {
    const Matrix3d f = diagonal_gradient(0.3, 1, 1);
    const Answer isothermal = at(nitrogen({1.4, 0}), f);
    expect_hydrostatic(-48.339744135652, isothermal.stress, printed);
    EXPECT_NEAR(isothermal.state[2], 13.127498720978, printed * 13);
    EXPECT_NEAR(isothermal.state[3], -18.663225024134, printed * 18);
    const Answer adiabatic = at(nitrogen({1.4, 0, 1}), f);
    expect_hydrostatic(-126.98429070211, adiabatic.stress, printed);
    EXPECT_NEAR(adiabatic.state[0], 315.84009132736, printed * 315);
    EXPECT_NEAR(adiabatic.state[2], 21.784234938724, printed * 21);

    const Answer here = at(nitrogen({1.4, 0}), Matrix3d::Identity());
    expect_hydrostatic(-10.0, here.stress, 1e-15);
    EXPECT_NEAR(here.tangent(0, 0), 0.0025656448562279, 10 * printed);  // a difference of numbers near 10
    EXPECT_NEAR(at(nitrogen({1.4, 0, 1}), Matrix3d::Identity()).tangent(0, 0), 5.9015552067382, printed * 6);
}

// --- 3.3 ---------------------------------------------------------------------------------------------------------

TEST(VdwGas, IsAnIdealGasWithoutAttractionAndCovolume) {
    Matrix3d f = diagonal_gradient(0.6, 1.1, 0.9);
    for (const double thermal : {0.0, 1.0}) {
        const Answer a = at({P0, T0, 0, 0, Rgas, 1.3, 1, thermal, 310.0, 0.8, 1.2}, f);
        const Answer b = gas_at("IDEAL_GAS-TEST", {P0, T0, 1.3, 1, thermal, 310.0, 0.8, 1.2}, f, T0);
        expect_close(b.stress, a.stress, 1e-15);
        for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(a.state[i], b.state[i], 1e-14 * std::abs(b.state[i]) + 1e-17);
    }
}

// (9.171): P' (g - b)^gamma stays.
TEST(VdwGas, AdiabatIsExactInAnyNumberOfIncrements) {
    const Numbers props = nitrogen({1.4, 0, 1});
    const VdwGas gas = model(props);
    for (const int steps : {1, 10, 100}) {
        UmatPoint point(name, solid, props);
        point.temperature(T0);
        double J = 1.0;
        for (int i = 1; i <= steps; ++i) {
            J = 1.0 + 0.9 * i / steps;
            point.advance({.dfgrd1 = diagonal_gradient(1, J, 1)});
        }
        const double expected = gas.R * T0 * std::pow(1 - gas.b, 0.4) / std::pow(J - gas.b, 1.4) - gas.a / (J * J);
        EXPECT_NEAR(point.stress()[0], -expected, 1e-14 * steps * 10.0);
        EXPECT_NEAR(J * point.sse(), point.state(3), 1e-14 * steps * 10.0);
    }
}

TEST(VdwGas, Tangent) {
    for (const AnalysisKind kind : {solid, AnalysisKind::plane_strain})
        for (const double gauge : {0.0, 1.0})
            for (const double thermal : {0.0, 1.0}) {
                UmatPoint point(name, kind, nitrogen({1.4, gauge, thermal, 310.0, 0.9, 1.2}));
                point.temperature(T0).advance({.dfgrd1 = diagonal_gradient(1.1, 1, 1)});
                expect_gas_tangent(point, diagonal_gradient(0.7, 1.1, 0.9));
            }
}

TEST(VdwGas, HeatLeavesACompressedIsothermalGas) {
    UmatPoint point(name, solid, nitrogen());
    const Answer a = point.temperature(T0).advance({.dtime = 0.25, .dfgrd1 = diagonal_gradient(0.5, 1, 1)});
    EXPECT_NEAR(a.rpl, -a.state[3] / (0.5 * 0.25), 1e-12);
    EXPECT_GT(a.rpl, 0.0);
}

// --- energy balance through VUMAT --------------------------------------------------------------------------------

TEST(VdwGas, WorkOfAShockAndRarefaction) {
    const auto constant = [](double) { return T0; };
    for (const double thermal : {0.0, 1.0})
        for (const double gauge : {0.0, 1.0}) {
            double errors[3];
            for (int k = 0; k < 3; ++k) {
                const GasPath path =
                    follow(name, nitrogen({1.4, gauge, thermal}), 50 << (2 * k), shock_and_rarefaction, constant);
                const double ambient = gauge * 10.0 * (shock_and_rarefaction(1.0) - 1.0);
                errors[k] = std::abs(path.stress_work - (path.end.state[2] + ambient));
                EXPECT_NEAR(2.0 * path.end.internal_energy, path.end.state[2] + path.end.state[3], 1e-13);
            }
            EXPECT_NEAR(std::log2(errors[0] / errors[1]), 4.0, 0.1) << "order 2, steps by 4";
            EXPECT_NEAR(std::log2(errors[1] / errors[2]), 4.0, 0.1);
        }
}

TEST(VdwGas, ClosedCycleGivesEverythingBack) {
    const auto constant = [](double) { return T0; };
    for (const double thermal : {0.0, 1.0}) {
        const GasPath path = follow(name, nitrogen({1.4, 1, thermal}), 64, closed_cycle, constant);
        for (const double x : path.end.stress) EXPECT_NEAR(x, 0.0, 1e-11);
        EXPECT_NEAR(path.end.state[0], 0.0, 1e-12 * T0);
        for (const std::size_t i : {2u, 3u}) EXPECT_NEAR(path.end.state[i], 0.0, 1e-12);
        EXPECT_NEAR(path.end.internal_energy, 0.0, 1e-12);
    }
}

// --- 3.5 ---------------------------------------------------------------------------------------------------------

TEST(VdwGas, VolumesBelowTheMoleculesAskForASmallerIncrement) {
    const double b = model(nitrogen()).b;
    UmatPoint point(name, solid, nitrogen());
    point.temperature(T0);
    EXPECT_TRUE(point.evaluate({.dfgrd1 = diagonal_gradient(1.001 * b, 1, 1)}).done());
    for (const double J : {b, 0.99 * b, 1e-6}) {
        const Answer a = point.evaluate({.dfgrd1 = diagonal_gradient(J, 1, 1)});
        EXPECT_TRUE(a.cut) << J;
        EXPECT_EQ(a.pnewdt, 0.25);
    }
    VumatBlock block(name, solid, nitrogen());
    block.points.push_back(block.fresh_point());
    block.points[0].temperature_old = block.points[0].temperature_new = T0;
    block.points[0].stretch = diagonal_gradient(0.1, 1, 1);
    EXPECT_EQ(block.run().stops, 1);
}

// Carbon dioxide at 280 K, below its critical 304 K: between the spinodals the bulk modulus is negative.
TEST(VdwGas, WarnsOnceInsideTheSpinodal) {
    const Numbers props = carbon_dioxide({1.4, 0, 0, 280.0});
    const VdwGas gas = model(props);
    UmatPoint point("VDW_GAS-CONDENSING", solid, props);
    point.temperature(280.0);
    const double critical = 3 * gas.b;
    EXPECT_TRUE(point.evaluate({.dfgrd1 = diagonal_gradient(0.1, 1, 1)}).messages.warnings.empty());
    const Answer a = point.evaluate({.dfgrd1 = diagonal_gradient(critical, 1, 1)});
    ASSERT_TRUE(a.done());
    EXPECT_LT(a.tangent(0, 0), -a.stress[0] * -1.0);  // K_T < 0
    ASSERT_EQ(a.messages.warnings.size(), 1u);
    EXPECT_NE(a.messages.warnings[0].find("isothermal bulk modulus"), std::string::npos);
    EXPECT_TRUE(point.evaluate({.dfgrd1 = diagonal_gradient(critical, 1, 1)}).messages.warnings.empty());
}

TEST(VdwGas, RefusesBadConstants) {
    expect_refused(name, {40.0, 280.0, 3.64e11, 42670.0, Rgas}, {name, "liquid side"});
    expect_refused(name, {P0, T0, -1.0, 42670.0, Rgas}, {"PROPS(3)", "(A,"});
    expect_refused(name, {P0, T0, 3.64e11, -1.0, Rgas}, {"PROPS(4)", "(B,"});
    expect_refused(name, {P0, T0, 3.64e11, 42670.0, 0.0}, {"PROPS(5)", "RGAS"});
    expect_refused(name, carbon_dioxide({1.4, 1, 0, 300, 1.0, 1e-3}), {"PROPS(11)", "JP", "volume of the molecules"});
    expect_refused(name, carbon_dioxide(), {name, "not served"}, AnalysisKind::plane_stress);
}

}  // namespace
}  // namespace lode::test::test_vdw_gas
