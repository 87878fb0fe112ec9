// The thermal block of ISO_PLASTIC: verification cases T1 to T6 of page 25 and what cannot be.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "iso_plastic_support.hpp"
#include "vumat_block.hpp"

namespace lode::test::test_iso_plastic_heat {
namespace {

using namespace iso_plastic_cases;

// PROPS indices.
enum { ALPHA = 15, BETA, TREF, TABS, RHOCV, CHI, TMODE, METHOD, NSUB };
// STATEV indices.
enum { EQPS = 1, TAD = 5, DTAD, ASTOR, PHI, HEATQ, ENTR };

const Numbers steel = {200000.0, 0.3, 400.0, 1, 2000.0};

// Some hosts leave the field variables uninitialised: a material that swells with one must not go on without it.
TEST(IsoPlasticHeat, SwellingByAFieldThatIsNotANumberIsRefused) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const AnalysisKind kind : {solid, AnalysisKind::plane_strain, AnalysisKind::plane_stress})
        for (const double method : {0.0, 2.0, 3.0}) {
            if (kind == AnalysisKind::plane_stress && method == 3.0) continue;
            const Numbers props = iso_plastic_props(steel, {{BETA, 1e-3}, {METHOD, method}});
            UmatPoint point("ISO_PLASTIC-SWELLS", kind, props);
            Numbers dstran(static_cast<std::size_t>(point.size()), 0.0);
            dstran[0] = 0.004;
            point.step({.dstran = dstran});
            const Answer answer = point.evaluate({.dstran = dstran, .dpred = {nan}});
            EXPECT_TRUE(answer.cut);
            EXPECT_TRUE(identical(answer.stress, point.stress()));
            EXPECT_TRUE(identical(answer.state, point.state()));

            VumatBlock block(point);
            block.points.assign(9, block.fresh_point());
            for (VumatPoint& p : block.points) p.strain_increment = dstran;
            block.points[8].fields_new = {nan};
            const HostMessages messages = block.run();
            EXPECT_EQ(messages.stops, 1);
            ASSERT_EQ(messages.errors.size(), 1u);
            EXPECT_NE(messages.errors[0].find("field 1"), std::string::npos) << messages.errors[0];
            EXPECT_NE(messages.errors[0].find("point 9 "), std::string::npos) << messages.errors[0];
        }
}

TEST(IsoPlasticHeat, T1AdiabaticElastic) {
    const Numbers props = iso_plastic_props(steel, {{ALPHA, 1.2e-5}, {RHOCV, 3.6}, {TMODE, 3}});
    const struct {
        int n;
        double tad, stress;
    } cases[] = {{1, -1.465, 500}, {10, -1.46170814116, 507.895196445}, {100, -1.46138004009, 508.680814281}};
    for (const auto& c : cases) {
        UmatPoint point("ISO_PLASTIC-T1", solid, props);
        ASSERT_EQ(point.state().size(), 6u);
        point.nstatv(10).temperature(293.0);
        for (int i = 0; i < c.n; ++i) {
            const double e = 0.001 / c.n;
            const Answer answer = point.advance({.dstran = {e, e, e, 0, 0, 0}});
            EXPECT_EQ(answer.rpl, 0.0);
            EXPECT_EQ(answer.drpldt, 0.0);
            EXPECT_EQ(largest(answer.drplde), 0.0);
        }
        expect_printed(point.state(TAD), c.tad);
        expect_printed(point.stress()[0], c.stress);
        EXPECT_EQ(point.state(HEATQ), 0.0);
        EXPECT_EQ(point.state(ENTR), 0.0);
    }
}

TEST(IsoPlasticHeat, T2ThermoelasticHeatForTheHost) {
    UmatPoint point("ISO_PLASTIC-T2", solid, iso_plastic_props(steel, {{ALPHA, 1.2e-5}, {RHOCV, 3.6}, {TMODE, 1}}));
    point.nstatv(10).temperature(293.0);
    const Answer answer = point.advance({.dstran = {0.001, 0.001, 0.001, 0, 0, 0}, .dtime = 0.1});
    expect_printed(point.stress(), {500, 500, 500, 0, 0, 0});
    expect_printed(answer.rpl, -52.74);
    expect_printed(answer.drplde, {-17580 * 0.1 / 0.1, -17580, -17580, 0, 0, 0});
    expect_printed(answer.drpldt, -0.18);
    expect_printed(answer.ddsddt, {-6, -6, -6, 0, 0, 0});
    expect_printed(point.state(HEATQ), 5.274);
    expect_printed(point.state(ENTR), 0.018);
}

TEST(IsoPlasticHeat, T3HeatRules) {
    const struct {
        double chi, tad[2], entropy[2], stored[2];
    } cases[] = {
        {0, {2.98900419984, 6.16894619802}, {0.0367249662779, 0.0754013732762}, {0.723665834640, 3.08252767272}},
        {0.9, {2.87102023852, 6.32268349640}, {0.0352753339886, 0.0772733225660}, {1.14840809541, 2.52907339856}},
        {-1, {0, 0}, {0, 0}, {11.4840809541, 25.2907339856}}};
    for (const auto& c : cases) {
        UmatPoint point("ISO_PLASTIC-T3", solid, iso_plastic_props(steel, {{RHOCV, 3.6}, {CHI, c.chi}, {TMODE, 2}}));
        point.nstatv(10).temperature(293.0);
        const double stress[] = {262.002750505, 295.049677141}, alpha[] = {0.0269010377986, 0.0555205157822};
        const double sse[] = {0.446195368269, 0.565853027875}, spd[] = {11.4840809541, 25.2907339856};
        for (std::size_t i = 0; i < 2; ++i) {
            point.advance({.dstran = {0, 0, 0, 0.05, 0, 0}, .dtime = 0.1});
            expect_printed(point.stress()[3], stress[i]);
            expect_printed(point.state(EQPS), alpha[i]);
            expect_printed(point.sse(), sse[i]);
            expect_printed(point.spd(), spd[i]);
            expect_printed(point.state(TAD), c.tad[i]);
            expect_printed(point.state(ENTR), c.entropy[i]);
            EXPECT_NEAR(point.state(ASTOR), c.stored[i], 2e-10 * spd[i]);
            EXPECT_NEAR(point.state(ASTOR) + point.state(PHI), point.spd(), 1e-13 * point.spd());
        }
    }
}

TEST(IsoPlasticHeat, T4AdiabaticJohnsonCook) {
    const Numbers props = iso_plastic_props({200000.0, 0.3, 792.0, 3, 510.0, 0.26, 0.0, 1.0, 1.0, 1793.0},
                                            {{TREF, 293.0}, {RHOCV, 3.6}, {CHI, 0.9}, {TMODE, 2}});
    const struct {
        int n;
        double alpha, temperature, stress;
    } cases[] = {{10, 0.572503973008, 448.685081736, 645.694708897},
                 {100, 0.572552934162, 447.969645934, 639.171385262},
                 {1000, 0.572557798580, 447.898322923, 638.523276096}};
    double previous = 0.0;
    for (const auto& c : cases) {
        UmatPoint point("ISO_PLASTIC-T4", solid, props);
        point.temperature(293.0);
        for (int i = 0; i < c.n; ++i) point.advance({.dstran = {0, 0, 0, 1.0 / c.n, 0, 0}});
        expect_printed(point.state(EQPS), c.alpha);
        expect_printed(293.0 + point.state(TAD), c.temperature);
        expect_printed(point.stress()[3], c.stress);
        // First order towards T = TMELT - (TMELT - T0) exp{-CHI [A alpha + B alpha^(n+1)/(n+1)]/(RHOCV (TMELT - T0))}.
        const double error = point.stress()[3] - 638.451315104;
        if (previous != 0.0) {
            EXPECT_NEAR(previous / error, 10.0, 0.2);
        }
        previous = error;
    }
    // The critical strain of section 5: the total slope dK/dalpha + K_theta CHI K/RHOCV changes sign.
    const auto slope = [](double alpha) {
        const double hard = 792 + 510 * std::pow(alpha, 0.26);
        return 510 * 0.26 * std::pow(alpha, -0.74) - 0.9 * hard * hard / (3.6 * 1500);
    };
    EXPECT_GT(slope(0.443664558207 * (1 - 1e-9)), 0.0);
    EXPECT_LT(slope(0.443664558207 * (1 + 1e-9)), 0.0);
}

TEST(IsoPlasticHeat, T5CoupledJohnsonCook) {
    const Numbers props = iso_plastic_props({200000.0, 0.3, 792.0, 3, 510.0, 0.26, 0.014, 1.0, 1.03, 1793.0},
                                            {{ALPHA, 1.2e-5}, {TREF, 293.0}, {RHOCV, 3.6}, {CHI, 0.9}, {TMODE, 1}});
    UmatPoint point("ISO_PLASTIC-T5", solid, props);
    point.nstatv(10).temperature(393.0);
    const Answer answer = point.advance({.dstran = {0.004, -0.002, -0.001, 0.01, 0, 0}, .dtime = 1e-4, .dtemp = 20.0});
    expect_printed(point.stress(), {359.422551419, -152.359805448, -67.0627459705, 426.485297389, 0, 0});
    expect_printed(point.state(EQPS), 0.00305827652917);
    expect_printed(point.sse(), 1.67749345900);
    expect_printed(point.spd(), 2.61644030380);
    expect_printed(answer.rpl, -1232.03726577);
    expect_printed(answer.drpldt, -56.3727743947);
    expect_printed(answer.drplde, {-22082528.4329, -26496572.8154, -25760898.7517, 3678370.31881, 0, 0});
    expect_printed(answer.ddsddt, {-6.20342392851, -5.87054840913, -5.92602766236, -0.277396266147, 0, 0});
    expect_printed(point.state(ASTOR), 0.261644030380);
    expect_printed(point.state(PHI), 2.35479627342);
    expect_printed(point.state(HEATQ), 72.1232037266);
    expect_printed(point.state(ENTR), 0.180334140436);
}

TEST(IsoPlasticHeat, T6Uniaxial) {
    UmatPoint point("ISO_PLASTIC-T6", uniaxial,
                    iso_plastic_props(steel, {{ALPHA, 1.2e-5}, {RHOCV, 3.6}, {CHI, 0.9}, {TMODE, 3}}));
    point.temperature(300.0);
    point.advance({.dstran = {0.001}});
    expect_printed(point.stress(), {200});
    expect_printed(point.state(TAD), -0.2);
    point.advance({.dstran = {0.01}});
    expect_printed(point.stress(), {417.826534653});
    expect_printed(point.state(TAD), 0.497104599319);
    expect_printed(point.state(DTAD), 0.697104599319);
    expect_printed(point.spd(), 3.64475326513);
    point.advance({.dstran = {0.0}});
    expect_printed(point.stress(), {416.153483615});
    expect_printed(point.state(TAD), 0.486211747807);
}

// RPL, DDSDDT, DRPLDE, DRPLDT of every law and kind from plastic prestressed states against extrapolated central
// differences, as page 25 states it.
TEST(IsoPlasticHeat, DerivativesOfAllLaws) {
    const Numbers laws[] = {
        {200000.0, 0.3, 400.0, 1, 2000.0},
        {200000.0, 0.3, 400.0, 2, 20.0, 0.4},
        {200000.0, 0.3, 500.0, 3, 500.0, 0.26, 0.014, 1.0, 1.03, 1793.0, 0.01, 1.5},
        {410000.0, 0.28, 2200.0, 4, 7.7, 0.13, 4000.0, 1e-5, -2.2e-4},
        {184920.0, 0.34, 375.0, 5, 1.0, 0.1, 1000.0, 1e-5, -2e-4, 1000.0, 3597.4, 710000.0, 0.012},
        {200000.0, 0.3, 400.0, 6, 3.0, 0.35},
        iso_plastic_props(
            {128000.0, 0.34, 10.0, 7, 1e7, 1e8, 2.56e-7, 1e6, 0.25, 3.06, 0.25, 0.06, 3.2, 50.0},
            {{25, 10.0}, {26, 10.0}, {27, 0.12}, {28, 0.006}, {29, 5.8}, {30, 1}, {31, 30000}, {32, 14900}}),
        {200000.0, 0.3, 400.0, 8, 300.0, 12.0, 500.0}};
    const struct {
        AnalysisKind kind;
        Numbers first, second;
    } cases[] = {{solid, {0.02, -0.01, 0.002, 0.015, 0.004, -0.006}, {0.003, 0.006, -0.004, 0.008, -0.01, 0.005}},
                 {plane_strain, {0.02, -0.01, 0.002, 0.015}, {0.003, 0.006, -0.004, 0.008}},
                 {plane_stress, {0.02, -0.01, 0.015}, {0.003, 0.016, 0.008}},
                 {uniaxial, {0.02}, {0.015}}};
    for (const Numbers& law : laws)
        for (const auto& c : cases)
            for (const double chi : {0.0, 0.9})
                for (const int method : {0, 1, 2}) {
                    const int hlaw = static_cast<int>(law[3]);
                    if (method == 1 && (c.first.size() < 4 || hlaw == 3 || hlaw == 4 || hlaw == 5 || hlaw == 7))
                        continue;
                    SCOPED_TRACE("HLAW " + std::to_string(hlaw) + ", " + kind_name(c.kind) + ", CHI " +
                                 std::to_string(chi) + ", METHOD " + std::to_string(method));
                    UmatPoint point("ISO_PLASTIC-SLOPES", c.kind,
                                    iso_plastic_props(law, {{ALPHA, 1.2e-5},
                                                            {TREF, 290.0},
                                                            {RHOCV, 3.6},
                                                            {CHI, chi},
                                                            {TMODE, 1},
                                                            {METHOD, double(method)},
                                                            {NSUB, 4}}));
                    point.temperature(330.0);
                    point.advance({.dstran = c.first, .dtime = 1e-3, .dtemp = 5.0});
                    const Load load{.dstran = c.second, .dtime = 1e-3, .dtemp = 7.0};
                    const Answer answer = point.evaluate(load);
                    ASSERT_GT(answer.state[0], point.state(1));
                    const auto n = static_cast<std::size_t>(point.size());
                    // Columns: strains, then temperature.
                    for (std::size_t k = 0; k <= n; ++k) {
                        const double h = k < n ? 4e-5 : 0.5;
                        const auto difference = [&](double step) {
                            Answer a[2];
                            for (const int side : {0, 1}) {
                                Load moved = load;
                                (k < n ? moved.dstran[k] : moved.dtemp) += side == 0 ? step : -step;
                                a[side] = point.evaluate(moved);
                            }
                            Numbers d;
                            for (std::size_t i = 0; i < n; ++i)
                                d.push_back((a[0].stress[i] - a[1].stress[i]) / (2 * step));
                            d.push_back((a[0].rpl - a[1].rpl) / (2 * step));
                            return d;
                        };
                        // Richardson's table of central differences.
                        const Numbers d1 = difference(h), d2 = difference(h / 2), d4 = difference(h / 4);
                        for (std::size_t i = 0; i <= n; ++i) {
                            const double a = (4 * d2[i] - d1[i]) / 3, b = (4 * d4[i] - d2[i]) / 3;
                            const double exact = (16 * b - a) / 15;
                            const bool stress = i < n;
                            const double given = k < n ? (stress ? answer.tangent(static_cast<Eigen::Index>(i),
                                                                                  static_cast<Eigen::Index>(k))
                                                                 : answer.drplde[k])
                                                       : (stress ? answer.ddsddt[i] : answer.drpldt);
                            const double size =
                                k < n ? (stress ? answer.tangent.cwiseAbs().maxCoeff() : largest(answer.drplde))
                                      : (stress ? largest(answer.ddsddt) : std::abs(answer.drpldt));
                            EXPECT_NEAR(given, exact, 2e-7 * size) << "row " << i << ", column " << k;
                        }
                    }
                }
}

// A block heats itself as a single point does, in every kind.
TEST(IsoPlasticHeat, ExplicitPointsHeatThemselves) {
    for (const auto kind : {solid, plane_strain, plane_stress, uniaxial}) {
        SCOPED_TRACE(kind_name(kind));
        const Numbers props = iso_plastic_props({200000.0, 0.3, 792.0, 3, 510.0, 0.26, 0.014, 1.0, 1.03, 1793.0},
                                                {{ALPHA, 1.2e-5}, {TREF, 293.0}, {RHOCV, 3.6}, {CHI, 0.9}, {TMODE, 3}});
        UmatPoint point("ISO_PLASTIC-HOT", kind, props);
        point.nstatv(16).temperature(300.0);
        VumatBlock block(point);
        for (int i = 0; i < 11; ++i) {
            VumatPoint p = block.fresh_point();
            p.temperature_old = p.temperature_new = 300.0;
            block.points.push_back(p);
        }
        block.dtime = 1e-4;
        Numbers strain(static_cast<std::size_t>(point.size()), -0.006);
        strain[0] = 0.012;
        for (int i = 0; i < 4; ++i) {
            for (VumatPoint& p : block.points) p.strain_increment = strain;
            ASSERT_EQ(block.run().stops, 0);
            point.advance({.dstran = strain, .dtime = 1e-4});
        }
        ASSERT_GT(point.state(TAD), 1.0);
        for (const VumatPoint& p : block.points) {
            EXPECT_LE(distance(p.stress, point.stress()), 1e-12 * 1e4);
            for (std::size_t k = 0; k < 16; ++k)
                EXPECT_NEAR(p.state[k], point.state()[k], 1e-12 * (1.0 + std::abs(point.state()[k])));
        }
    }
}

TEST(IsoPlasticHeat, WhatCannotBe) {
    const auto refuses = [](const Numbers& props, const char* what) {
        const std::string message = iso_plastic_refusal(props);
        EXPECT_NE(message.find(what), std::string::npos) << message;
    };
    refuses(iso_plastic_props(steel, {{TMODE, 2}}), "TMODE 2, 3 need RHOCV > 0");
    refuses(iso_plastic_props(steel, {{TMODE, 3}}), "TMODE 2, 3 need RHOCV > 0");
    refuses(iso_plastic_props(steel, {{TMODE, 4}}), "TMODE");
    refuses(iso_plastic_props(steel, {{CHI, -0.5}}), "CHI");
    refuses(iso_plastic_props(steel, {{CHI, 1.5}}), "CHI");
    // T <= 0 is refused where it is needed; elsewhere the entropy waits.
    UmatPoint thermoelastic("ISO_PLASTIC-ZERO", solid, iso_plastic_props(steel, {{ALPHA, 1e-5}, {TMODE, 1}}));
    EXPECT_NE(thermoelastic.evaluate({}).first_error().find("absolute temperature"), std::string::npos);
    UmatPoint plain("ISO_PLASTIC-ZERO", solid, iso_plastic_props(steel, {{RHOCV, 3.6}}));
    plain.nstatv(10).advance({.dstran = {0, 0, 0, 0.05, 0, 0}, .dtemp = -5.0});
    EXPECT_EQ(plain.state(ENTR), 0.0);
    EXPECT_LT(plain.state(HEATQ), 0.0);
    // DTIME = 0: no rate of heat.
    UmatPoint quick("ISO_PLASTIC-ZERO", solid, iso_plastic_props(steel, {{ALPHA, 1e-5}, {TMODE, 1}}));
    const Answer answer = quick.temperature(300.0).evaluate({.dstran = {0.001, 0, 0, 0.05, 0, 0}, .dtime = 0.0});
    EXPECT_EQ(answer.rpl, 0.0);
    EXPECT_EQ(answer.drpldt, 0.0);
    EXPECT_EQ(largest(answer.drplde), 0.0);
    // TMODE 2 needs STATEV 5 and 6.
    UmatPoint hot("ISO_PLASTIC-ZERO", solid, iso_plastic_props(steel, {{RHOCV, 3.6}, {TMODE, 2}}));
    EXPECT_NE(hot.nstatv(5).evaluate({}).first_error().find("NSTATV"), std::string::npos);
    // Slots beyond NSTATV are not stored, those within it are.
    UmatPoint some("ISO_PLASTIC-ZERO", solid, iso_plastic_props(steel, {{CHI, 0.9}}));
    some.nstatv(8).advance({.dstran = {0, 0, 0, 0.05, 0, 0}});
    EXPECT_NEAR(some.state(PHI), 0.9 * some.spd(), 1e-13 * some.spd());
    // A softening law stores nothing: CHI = 0 is read as 1.
    UmatPoint softening("ISO_PLASTIC-SOFT", solid,
                        iso_plastic_props({30000.0, 0.2, 30.0, 1, -1500.0, 3.0}, {{24, 50.0}}));
    softening.nstatv(8).celent(10.0);
    softening.advance({.dstran = {0.02, -0.01, -0.01, 0, 0, 0}});
    EXPECT_NEAR(softening.state(PHI), softening.spd(), 1e-14 * softening.spd());
}

}  // namespace
}  // namespace lode::test::test_iso_plastic_heat
