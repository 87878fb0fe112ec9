// ISO_PLASTIC against page 20, section 3: verification cases of one step of backward Euler, and the
// failure modes. Laws, methods and heat have files of their own.
#include <gtest/gtest.h>

#include <cmath>

#include "iso_plastic_support.hpp"

namespace lode::test::test_iso_plastic {
namespace {

using namespace iso_plastic_cases;

const Numbers steel = {200000.0, 0.3, 400.0, 1, 2000.0};

TEST(IsoPlastic, V1BiaxialPlaneStrain) {
    UmatPoint point("ISO_PLASTIC-V1", plane_strain, steel);
    point.advance({.dstran = {0.001, 0.001, 0, 0}});
    expect_printed(point.stress(), {384.615384615, 384.615384615, 230.769230769, 0});
    EXPECT_EQ(point.state(1), 0.0);
    point.advance({.dstran = {0.009, 0.009, 0, 0}});
    expect_printed(point.stress(), {3469.92729676, 3469.92729676, 3060.14540648, 0});
    expect_printed(point.state(1), 0.00489094514210);
    expect_printed(point.sse(), 33.6971625948);
    expect_printed(point.spd(), 1.98029940122);
}

TEST(IsoPlastic, V2BiaxialPlaneStress) {
    UmatPoint point("ISO_PLASTIC-V2", plane_stress, steel);
    point.advance({.dstran = {0.01, 0.01, 0}});
    expect_printed(point.stress(), {433.925049310, 433.925049310, 0});
    expect_printed(point.state(1), 0.0169625246548);
    expect_printed(point.sse(), 0.659018319464);
    expect_printed(point.spd(), 7.07273710460);
    point.advance({.dstran = {-0.002, -0.002, 0}});
    expect_printed(point.stress(), {-137.503522119, -137.503522119, 0});
}

TEST(IsoPlastic, V3Uniaxial) {
    UmatPoint point("ISO_PLASTIC-V3", uniaxial, steel);
    point.advance({.dstran = {0.01}});
    expect_printed(point.stress(), {415.841584158});
    expect_printed(point.state(1), 0.00792079207921);
    point.advance({.dstran = {-0.02}});
    expect_printed(point.stress(), {-447.211057739});
    expect_printed(point.state(1), 0.0236055288697);
    expect_printed(point.spd(), 9.99943254111);
}

TEST(IsoPlastic, V4UniaxialStrain) {
    UmatPoint point("ISO_PLASTIC-V4", solid, steel);
    // Yield at sigma11 = SIGY (1 - nu)/(1 - 2 nu) = 700, from both sides.
    const double at_yield = 700.0 / (point.props()[0] * 0.7 / (1.3 * 0.4));
    EXPECT_EQ(point.evaluate({.dstran = {at_yield * (1 - 1e-9), 0, 0, 0, 0, 0}}).state[0], 0.0);
    EXPECT_GT(point.evaluate({.dstran = {at_yield * (1 + 1e-9), 0, 0, 0, 0, 0}}).state[0], 0.0);
    point.advance({.dstran = {0.02, 0, 0, 0, 0, 0}});
    expect_printed(point.stress(), {3615.33377396, 3192.33311302, 3192.33311302, 0, 0, 0});
    expect_printed(point.state(1), 0.0115003304693);
}

// Laws 1 with a floor, regularised by CELENT/LREF.
TEST(IsoPlastic, V10Softening) {
    Numbers props(24, 0.0);
    const Numbers given = {30000.0, 0.2, 30.0, 1, -1500.0, 3.0};
    std::copy(given.begin(), given.end(), props.begin());
    props[23] = 50.0;
    UmatPoint point("ISO_PLASTIC-V10", solid, props);
    point.celent(25.0);
    point.advance({.dstran = {0.002, -0.001, -0.001, 0, 0, 0}});
    expect_printed(point.stress(), {19.3877551020, -9.69387755102, -9.69387755102, 0, 0, 0});
    expect_printed(point.state(1), 0.00122448979592);
    point.advance({.dstran = {0.02, -0.01, -0.01, 0, 0, 0}});
    expect_printed(point.stress()[0], 9.18367346939);
    expect_printed(point.state(1), 0.0216326530612);
    point.advance({.dstran = {0.03, -0.015, -0.015, 0, 0, 0}});
    expect_printed(point.stress(), {2, -1, -1, 0, 0, 0});
    expect_printed(point.state(1), 0.05192);
    expect_printed(point.spd(), 0.64176);
}

TEST(IsoPlastic, V12PlaneStressGeneral) {
    UmatPoint point("ISO_PLASTIC-V12", plane_stress, {70000.0, 0.33, 200.0, 8, 150.0, 25.0});
    point.nstatv(16);
    point.advance({.dstran = {0.004, -0.001, 0.003}});
    expect_printed(point.stress(), {198.841170396, 30.0019337768, 50.6517709856});
    expect_printed(point.state(1), 0.00145306087520);
    const Answer answer = point.advance({.dstran = {-0.002, 0.006, -0.004}});
    expect_printed(point.stress(), {125.806101574, 244.193025327, -25.6341424652});
    expect_printed(point.state(1), 0.00454759425348);
    expect_printed(point.state(13), -0.00345857978537);
    expect_printed(answer.tangent(0, 0), 35494.3950673);
    expect_printed(answer.tangent(0, 1), 1919.64249603);
    expect_printed(answer.tangent(0, 2), 1920.58954766);
    expect_printed(answer.tangent(1, 1), 6087.10880888);
    expect_printed(answer.tangent(1, 2), 4446.92589717);
    expect_printed(answer.tangent(2, 2), 11805.3945174);
}

TEST(IsoPlastic, ZeroIncrementOnTheYieldSurfaceIsElastic) {
    for (const auto kind : {solid, plane_strain, plane_stress, uniaxial}) {
        SCOPED_TRACE(kind_name(kind));
        UmatPoint point("ISO_PLASTIC-ZERO", kind, steel);
        Numbers strain(static_cast<std::size_t>(point.size()), 0.0);
        strain[0] = 0.01;
        point.advance({.dstran = strain});
        ASSERT_GT(point.state(1), 0.0);
        const Answer answer = point.evaluate({});
        UmatPoint virgin("ISO_PLASTIC-ZERO", kind, steel);
        const Answer elastic = virgin.evaluate({});
        EXPECT_LE(distance(answer.stress, point.stress()), 1e-13 * largest(point.stress()));
        EXPECT_EQ(answer.state[0], point.state(1));
        EXPECT_TRUE(answer.tangent == elastic.tangent);
    }
}

TEST(IsoPlastic, SofteningRefusesElementsThatAreTooLarge) {
    Numbers props(24, 0.0);
    const Numbers given = {30000.0, 0.2, 30.0, 1, -1500.0, 3.0};
    std::copy(given.begin(), given.end(), props.begin());
    props[23] = 50.0;
    const double G = 30000.0 / 2.4;
    const struct {
        AnalysisKind kind;
        double unloading;
    } cases[] = {{solid, 3 * G}, {plane_strain, 3 * G}, {plane_stress, 30000.0 / 1.6}, {uniaxial, 30000.0}};
    for (const auto& [kind, unloading] : cases) {
        SCOPED_TRACE(kind_name(kind));
        const double h_max = unloading * 50.0 / 1500.0;
        UmatPoint point("ISO_PLASTIC-SNAP", kind, props);
        EXPECT_TRUE(point.celent(h_max * (1 - 1e-12)).evaluate({}).done());
        const Answer refused = point.celent(h_max * (1 + 1e-12)).evaluate({});
        EXPECT_EQ(refused.messages.stops, 1);
        EXPECT_NE(refused.first_error().find("h_max"), std::string::npos) << refused.first_error();
        for (const double unknown : {0.0, -1.0, std::nan("")}) {
            const Answer no_size = point.celent(unknown).evaluate({});
            EXPECT_NE(no_size.first_error().find("CELENT"), std::string::npos) << no_size.first_error();
        }
    }
}

// A floor of zero: the deviator vanishes without a division by zero.
TEST(IsoPlastic, YieldStressCanFallToZero) {
    Numbers props(24, 0.0);
    const Numbers given = {30000.0, 0.2, 30.0, 1, -1500.0, 0.0};
    std::copy(given.begin(), given.end(), props.begin());
    props[23] = 50.0;
    for (const auto kind : {solid, plane_stress, uniaxial}) {
        SCOPED_TRACE(kind_name(kind));
        UmatPoint point("ISO_PLASTIC-FLOOR", kind, props);
        point.celent(5.0);
        Numbers strain(static_cast<std::size_t>(point.size()), 0.0);
        strain[0] = 1.0;
        const Answer answer = point.advance({.dstran = strain});
        const double scale = kind == solid ? 30000.0 / (3 * 0.6) : 1e-12;
        EXPECT_NEAR(answer.stress[0], kind == solid ? scale : 0.0, 1e-10 * scale + 1e-9);
        EXPECT_TRUE(answer.tangent.allFinite());
    }
}

TEST(IsoPlastic, HeatBySourceRuleAndFraction) {
    // RPL = SIGY dalpha/DTIME by the source rule, CHI times the plastic work otherwise (page 25, section 3).
    for (const double chi : {0.0, 0.9, -1.0}) {
        Numbers props(20, 0.0);
        std::copy(steel.begin(), steel.end(), props.begin());
        props[18] = 3.6;
        props[19] = chi;
        UmatPoint point("ISO_PLASTIC-HEAT", solid, props);
        point.nstatv(16);
        point.temperature(293.0);
        const Answer answer = point.advance({.dstran = {0, 0, 0, 0.05, 0, 0}, .dtime = 0.1});
        const double alpha = point.state(1), work = point.spd();
        const double heat = chi == 0.0 ? 400.0 * alpha : chi > 0.0 ? chi * work : 0.0;
        EXPECT_NEAR(answer.rpl, heat / 0.1, 1e-12 * work / 0.1);
        EXPECT_NEAR(point.state(7), work - heat, 1e-13 * work);
        EXPECT_NEAR(point.state(8), heat, 1e-13 * work);
        EXPECT_NEAR(point.state(9), -heat, 1e-13 * work);
        EXPECT_NEAR(point.state(10), 0.0, 1e-15 * work);  // (dq + dPhi)/T with no temperature change
    }
}

TEST(IsoPlastic, RefusesWhatMakesNoSense) {
    const auto names = [](const std::string& message, const char* what) {
        EXPECT_NE(message.find(what), std::string::npos) << message;
    };
    names(iso_plastic_refusal({200000.0, 0.3, 400.0, 1}), "needs NPROPS >= 5");
    names(iso_plastic_refusal({200000.0, 0.3, 400.0, 8, 100.0}), "needs NPROPS >= 6");
    names(iso_plastic_refusal({200000.0, 0.3, 400.0, 1, -100.0}), "LREF");
    names(iso_plastic_refusal({200000.0, 0.3, 400.0, 1, -100.0, 500.0}), "H2");      // floor above SIGY
    names(iso_plastic_refusal({200000.0, 0.3, 400.0, 8, -100.0, 5.0, 10.0}), "H3");  // Q < 0 with H3 > 0
    Numbers bad_heat(20, 0.0);
    std::copy(steel.begin(), steel.end(), bad_heat.begin());
    bad_heat[19] = -0.5;
    names(iso_plastic_refusal(bad_heat), "CHI");
    EXPECT_EQ(iso_plastic_refusal(steel), "accepted");
}

}  // namespace
}  // namespace lode::test::test_iso_plastic
