// The hardening laws 2 to 8 of ISO_PLASTIC: verification cases of page 20, sections 2 and 3, and where the laws fail.
#include <gtest/gtest.h>

#include <cmath>

#include "iso_plastic_support.hpp"

namespace lode::test::test_iso_plastic_laws {
namespace {

using namespace iso_plastic_cases;

const Numbers dislocations =
    iso_plastic_props({128000.0, 0.34, 10.0, 7, 1e7, 1e8, 2.56e-7, 1e6, 0.25, 3.06, 0.25, 0.06, 3.2, 50.0},
                      {{25, 10.0}, {26, 10.0}, {27, 0.12}, {28, 0.006}, {29, 5.8}});
const Numbers tantalum = iso_plastic_props(
    {184920.0, 0.34, 375.0, 5, 1.0, 0.1, 1000.0, 1e-5, -2e-4, 1000.0, 3597.4, 710000.0, 0.012}, {{17, 300.0}});
const Numbers tungsten =
    iso_plastic_props({410000.0, 0.28, 2200.0, 4, 7.7, 0.13, 4000.0, 1e-5, -2.2e-4}, {{17, 300.0}});
const Numbers steel =
    iso_plastic_props({200000.0, 0.3, 500.0, 3, 500.0, 0.26, 0.014, 1.0, 1.03, 1793.0}, {{17, 300.0}});

TEST(IsoPlasticLaws, V5ShearInOneIncrement) {
    const struct {
        Numbers law;
        double stress, alpha;
    } cases[] = {{{2, 20, 0.4}, 247.891502517, 0.00968644244959},
                 {{6, 3, 0.35}, 363.236187463, 0.00882071674585},
                 {{8, 300, 12, 500}, 252.666511578, 0.00965060336362}};
    for (const auto& c : cases) {
        Numbers props = {200000.0, 0.3, 400.0};
        props.insert(props.end(), c.law.begin(), c.law.end());
        UmatPoint point("ISO_PLASTIC-V5", solid, props);
        point.advance({.dstran = {0, 0, 0, 0.02, 0, 0}});
        expect_printed(point.stress(), {0, 0, 0, c.stress, 0, 0});
        expect_printed(point.state(1), c.alpha);
    }
}

TEST(IsoPlasticLaws, V6JohnsonCook) {
    UmatPoint point("ISO_PLASTIC-V6", solid, steel);
    point.temperature(400.0);
    point.advance({.dstran = {0, 0, 0, 0.02, 0, 0}, .dtime = 1e-5});
    expect_printed(point.stress(), {0, 0, 0, 382.789897816, 0, 0});
    expect_printed(point.state(1), 0.00867395532668);
    expect_printed(point.state(2), 0.00867395532668 / 1e-5);
    expect_printed(point.state(3), 663.011551642);
    expect_printed(point.spd(), 5.48342166720);
    const Answer answer = point.advance({.dstran = {0, 0, 0, 0.02, 0, 0}, .dtime = 1e-5, .dtemp = 100.0});
    expect_printed(point.stress()[3], 377.758126077);
    expect_printed(point.state(1), 0.0202587269425);
    expect_printed(point.spd(), 12.8842163604);
    expect_printed(answer.tangent(3, 3), 972.645820305);
}

TEST(IsoPlasticLaws, V7SteinbergGuinan) {
    UmatPoint point("ISO_PLASTIC-V7", solid, tungsten);
    point.temperature(300.0);
    point.advance({.dstran = {-0.02, -0.02, -0.02, 0, 0, 0}});
    expect_printed(point.stress(), {-18636.3636364, -18636.3636364, -18636.3636364, 0, 0, 0});
    point.advance({.dstran = {-0.01, 0.005, 0.005, 0.03, 0, 0}, .dtemp = 200.0});
    expect_printed(point.stress(), {-19486.3553376, -18211.3677858, -18211.3677858, 1274.98755179, 0, 0});
    expect_printed(point.state(1), 0.0153541367326);
    expect_printed(point.spd(), 38.8749149415);
}

TEST(IsoPlasticLaws, V8SteinbergLund) {
    UmatPoint point("ISO_PLASTIC-V8", solid, tantalum);
    point.temperature(300.0);
    point.advance({.dstran = {0, 0, 0, 0.02, 0, 0}, .dtime = 1e-6});
    expect_printed(point.stress()[3], 544.983089800);
    expect_printed(point.state(4), 568.677211590);
    expect_printed(point.state(1), 0.00698691649104);
    point.advance({.dstran = {0, 0, 0, 0.02, 0, 0}, .dtime = 1e-6});
    expect_printed(point.stress()[3], 562.275397426);
    expect_printed(point.state(4), 598.205600977);
    expect_printed(point.state(1), 0.0183892303029);
    point.advance({.dstran = {0.01, -0.005, -0.005, 0, 0, 0}, .dtime = 1e-3});
    expect_printed(point.stress(), {413.650627392, -206.825313696, -206.825313696, 168.540268777, 0, 0});
    expect_printed(point.state(4), 309.748571762);
    expect_printed(point.state(1), 0.0261280562391);
    // The ends of the range: YT = 1e-5 YP where nothing is in a hurry, YT = YP where the rate is beyond its law.
    for (const auto& [dtime, part] : {std::pair{0.0, 1e-5}, {1e12, 1e-5}, {1e-12, 1.0}}) {
        UmatPoint other("ISO_PLASTIC-V8", solid, tantalum);
        other.temperature(300.0);
        other.advance({.dstran = {0, 0, 0, 0.02, 0, 0}, .dtime = dtime});
        EXPECT_NEAR(other.state(4), 1000.0 * part, 1e-11 * other.state(3));
        EXPECT_NEAR(other.state(3), std::sqrt(3.0) * other.stress()[3], 1e-10 * other.state(3));
        ASSERT_GT(other.state(1), 0.0);
    }
}

TEST(IsoPlasticLaws, V9Dislocations) {
    UmatPoint point("ISO_PLASTIC-V9", solid, dislocations);
    ASSERT_EQ(point.state().size(), 20u);
    point.advance({.dstran = {0, 0, 0, 0.02, 0, 0}});
    expect_printed(point.stress()[3], 38.2766718720);
    expect_printed(point.state(1), 0.0110843065912);
    expect_printed(point.state(17), 57458268.6402);
    expect_printed(point.state(18), 52690838.3073);
    expect_printed(point.state(19), 0.00133294371081);
    point.advance({.dstran = {0, 0, 0, 0.2, 0, 0}});
    expect_printed(point.stress()[3], 58.5462632474);
    expect_printed(point.state(17), 87704752.8205);
    expect_printed(point.state(18), 71636870.3136);
    point.advance({.dstran = {0, 0, 0, 1.0, 0, 0}});
    expect_printed(point.stress()[3], 72.9453134049);
    expect_printed(point.state(1), 0.703485545676);
    expect_printed(point.state(17), 231300935.013);
    expect_printed(point.state(18), 347358608.151);
    expect_printed(point.state(19), 6.38692208549e-4);
    expect_printed(point.state(20), 0.119255555872);
    // An elastic increment keeps the dislocations.
    const Numbers before = point.state();
    point.advance({.dstran = {0, 0, 0, -0.0015, 0, 0}});
    for (const int i : {17, 18, 19, 20})
        EXPECT_NEAR(point.state(i), before[static_cast<std::size_t>(i - 1)], 1e-14 * point.state(i));
}

// Exact in theory: sub-increments of radial loading give the same stress for rate-independent laws.
TEST(IsoPlasticLaws, RadialLoadingIsExact) {
    for (const Numbers& law : {Numbers{0},
                               {1, 2000},
                               {2, 20, 0.4},
                               {6, 3, 0.35},
                               {6, 3, 2.0},
                               {2, 20, 3.0},
                               {8, 300, 12, 500},
                               {8, 300, 12, 500, 0.004}}) {
        Numbers props = {200000.0, 0.3, 400.0};
        props.insert(props.end(), law.begin(), law.end());
        UmatPoint one("ISO_PLASTIC-RADIAL", solid, props), many("ISO_PLASTIC-RADIAL", solid, props);
        const Numbers direction = {0.02, -0.01, -0.01, 0.015, 0.0, -0.02};
        one.advance({.dstran = direction});
        for (int i = 0; i < 50; ++i) {
            Numbers part = direction;
            for (double& x : part) x /= 50;
            many.advance({.dstran = part});
        }
        EXPECT_LE(distance(one.stress(), many.stress()), 1e-11 * largest(one.stress())) << "HLAW " << law[0];
        EXPECT_NEAR(one.spd(), many.spd(), 1e-10 * one.spd()) << "HLAW " << law[0];
    }
}

// 1e7 trial states: the root is found from the elastic limit to ten times it, from virgin to hardened.
TEST(IsoPlasticLaws, TheScalarReturnIsSolved) {
    const double G3 = 3 * 200000.0 / 2.6;
    for (const Numbers& law : {Numbers{1, 2000},
                               {2, 20, 0.4},
                               {2, 200, 3.0},
                               {6, 3, 0.05},
                               {6, 3, 0.35},
                               {6, 1000, 0.9},
                               {6, 3, 2.0},
                               {8, 300, 12, 500},
                               {8, 3000, 200},
                               {8, 1e5, 500},
                               {3, 500, 0.26, 0.014, 1},
                               {3, 500, 0.26, 0.5, 1},
                               {3, 500, 0.26, 0, 1},
                               {4, 7.7, 0.13, 1000},
                               {4, 7.7, 0.13, 0}}) {
        Numbers props = {200000.0, 0.3, 400.0};
        props.insert(props.end(), law.begin(), law.end());
        for (const double alpha : {0.0, 1e-12, 1e-6, 1e-3, 0.1, 0.5})
            for (const double ratio : {1e-8, 1e-4, 0.01, 0.3, 2.0, 9.0})
                for (const double dtime : {1e-9, 1.0, 1e9}) {
                    UmatPoint point("ISO_PLASTIC-ROOT", solid, props);
                    point.state({alpha, 0, 0, 0});
                    // The yield stress at rest.
                    const double k = point.evaluate({.dtime = 0.0}).state[2];
                    const double gamma = k * (1 + ratio) / (G3 / std::sqrt(3.0));
                    const Answer answer = point.evaluate({.dstran = {0, 0, 0, gamma, 0, 0}, .dtime = dtime});
                    ASSERT_TRUE(answer.done()) << "HLAW " << law[0];
                    const double q = std::sqrt(3.0) * answer.stress[3], q_trial = k * (1 + ratio);
                    const double dalpha = answer.state[0] - alpha;
                    EXPECT_NEAR(q, q_trial - G3 * dalpha, 1e-12 * q_trial + G3 * 3e-16 * alpha);
                    EXPECT_NEAR(q, answer.state[2], 2e-13 * q_trial) << "HLAW " << law[0] << " alpha " << alpha;
                    EXPECT_GE(dalpha, 0.0);
                }
    }
}

// V10 holds for every softening law: the energy per area is that of an element of size LREF.
TEST(IsoPlasticLaws, SofteningDissipatesTheSameEnergyPerArea) {
    const struct {
        Numbers law;
        double energy;  // to full softening, in units of LREF, for Y = 30: Y^2/(2 |Ep|)
    } cases[] = {{{1, -1500, 0}, 30.0 * 30.0 / 3000.0}, {{6, -50, 1, 0}, 30.0 / 100.0}, {{2, -50, 1, 0}, 30.0 / 100.0}};
    for (const auto& c : cases)
        for (const double h : {10.0, 25.0, 50.0}) {
            Numbers props = iso_plastic_props({30000.0, 0.2, 30.0}, {{24, 50.0}});
            std::copy(c.law.begin(), c.law.end(), props.begin() + 3);
            UmatPoint point("ISO_PLASTIC-AREA", solid, props);
            point.celent(h);
            for (int i = 0; i < 40; ++i) point.advance({.dstran = {0.02, -0.01, -0.01, 0, 0, 0}});
            EXPECT_NEAR(point.spd() * h, c.energy * 50.0, 1e-10 * c.energy * 50.0) << "HLAW " << c.law[0] << " h " << h;
            EXPECT_NEAR(point.state(3), 0.0, 1e-10);
        }
}
TEST(IsoPlasticLaws, SofteningStopsAtTheFloor) {
    for (const Numbers& law :
         {Numbers{2, 20, -2.0, 3.0}, {2, -10, 2.0, 3.0}, {6, -50, 1.5, 3.0}, {8, -25, 40, -10, 0, 3.0}}) {
        Numbers props = iso_plastic_props({30000.0, 0.2, 30.0}, {{24, 50.0}});
        std::copy(law.begin(), law.end(), props.begin() + 3);
        for (const auto kind : {solid, plane_strain, plane_stress, uniaxial}) {
            SCOPED_TRACE("HLAW " + std::to_string(law[0]) + " " + kind_name(kind));
            UmatPoint point("ISO_PLASTIC-FLOOR", kind, props);
            point.celent(2.0);
            Numbers strain(static_cast<std::size_t>(point.size()), 0.0);
            strain[0] = 0.004;
            if (kind == solid || kind == plane_strain) strain[1] = strain[2] = -0.002;
            double previous = HUGE_VAL;
            for (int i = 0; i < 400; ++i) {
                if (i == 300)
                    for (double& e : strain) e *= 100.0;
                point.advance({.dstran = strain});
                EXPECT_LE(point.state(3), previous * (1 + 1e-12));
                previous = point.state(3);
            }
            EXPECT_NEAR(point.state(3), 3.0, 1e-9);
        }
    }
}

TEST(IsoPlasticLaws, MoltenMetalKeepsItsPressureOnly) {
    for (const auto& [props, cold, hot] :
         {std::tuple{steel, 400.0, 2000.0}, {tungsten, 300.0, 6000.0}, {tantalum, 300.0, 6000.0}})
        for (const auto kind : {solid, plane_strain, plane_stress, uniaxial}) {
            SCOPED_TRACE(std::string("HLAW ") + std::to_string(props[3]) + " " + kind_name(kind));
            Numbers hot_props = props;
            hot_props.resize(24, 0.0);
            hot_props[14] = 1e-5;
            UmatPoint point("ISO_PLASTIC-MELT", kind, hot_props);
            point.nstatv(16).temperature(cold);
            Numbers strain(static_cast<std::size_t>(point.size()), 0.0);
            strain[0] = 0.003;
            point.advance({.dstran = strain, .dtime = 1e-3});
            const double spd = point.spd();
            const Numbers stress = point.stress();
            // Nothing of DTEMP but the melting: the thermal strain is taken off again.
            Numbers still(strain.size(), 0.0);
            for (int i = 0; i < point.normals(); ++i) still[static_cast<std::size_t>(i)] = 1e-5 * (hot - cold);
            const Answer answer = point.advance({.dstran = still, .dtime = 1e-3, .dtemp = hot - cold});
            EXPECT_EQ(point.state(3), 0.0);
            const double E = props[0], nu = props[1], K = E / (3 * (1 - 2 * nu)), G = E / (2 * (1 + nu));
            if (kind == solid || kind == plane_strain) {
                const double mean = (stress[0] + stress[1] + stress[2]) / 3;
                for (int i = 0; i < 3; ++i) EXPECT_NEAR(point.stress()[static_cast<std::size_t>(i)], mean, 1e-9);
                EXPECT_NEAR(answer.tangent(0, 1), K, 1e-9 * K);
                EXPECT_NEAR(answer.tangent(0, 0), K, 1e-9 * K);
                EXPECT_NEAR(answer.tangent(3, 3), 0.0, 1e-9 * K);
                EXPECT_NEAR(answer.ddsddt[0], -3 * K * 1e-5, 1e-9 * K * 1e-5);
                double squares = 0.0;
                for (int i = 0; i < 3; ++i) squares += std::pow(stress[static_cast<std::size_t>(i)] - mean, 2);
                EXPECT_NEAR(point.spd() - spd, squares / (4 * G), 1e-9 * point.spd());
                EXPECT_NEAR(point.state(1) - 0.0, answer.state[0], 0.0);
            } else {
                EXPECT_EQ(largest(point.stress()), 0.0);
                EXPECT_EQ(answer.tangent.cwiseAbs().maxCoeff(), 0.0);
                EXPECT_EQ(largest(answer.ddsddt), 0.0);
            }
            // Molten it stays: no shear stiffness, no error.
            EXPECT_TRUE(point.evaluate({.dstran = strain, .dtime = 1e-3}).done());
        }
}

TEST(IsoPlasticLaws, DislocationsNeedTime) {
    UmatPoint point("ISO_PLASTIC-TIME", solid, dislocations);
    const Answer refused = point.evaluate({.dstran = {0, 0, 0, 0.02, 0, 0}, .dtime = 0.0});
    EXPECT_EQ(refused.messages.stops, 1);
    EXPECT_NE(refused.first_error().find("DTIME"), std::string::npos) << refused.first_error();
    EXPECT_TRUE(point.evaluate({.dstran = {0, 0, 0, 1e-6, 0, 0}, .dtime = 0.0}).done());
}

TEST(IsoPlasticLaws, AbsoluteTemperatureIsNeeded) {
    UmatPoint point("ISO_PLASTIC-COLD", solid, tantalum);
    const Answer refused = point.temperature(-1.0).evaluate({.dstran = {0, 0, 0, 0.02, 0, 0}});
    EXPECT_EQ(refused.messages.stops, 1);
    EXPECT_NE(refused.first_error().find("absolute temperature"), std::string::npos) << refused.first_error();
    Numbers with_temperature = dislocations;
    with_temperature.resize(32);
    with_temperature[29] = 1, with_temperature[30] = 30000, with_temperature[31] = 14900;
    UmatPoint copper("ISO_PLASTIC-COLD", solid, with_temperature);
    EXPECT_NE(copper.temperature(0.0).evaluate({}).first_error().find("absolute temperature"), std::string::npos);
}

TEST(IsoPlasticLaws, RefusesWhatMakesNoSense) {
    const auto refuses = [](const Numbers& law, const char* what, const char* more = "") {
        Numbers props = {200000.0, 0.3, 400.0};
        props.insert(props.end(), law.begin(), law.end());
        const std::string message = iso_plastic_refusal(props);
        EXPECT_NE(message.find(what), std::string::npos) << message;
        EXPECT_NE(message.find(more), std::string::npos) << message;
    };
    refuses({2, 20}, "needs NPROPS >= 6");
    refuses({3, 500, 0.26, 0.014}, "needs NPROPS >= 8");
    refuses({4, 7.7, 0.13}, "needs NPROPS >= 7");
    refuses({5, 1, 0.1, 1000, 1e-5, -2e-4, 1000, 3597, 710000}, "needs NPROPS >= 13");
    refuses({6, 3}, "needs NPROPS >= 6");
    refuses({7, 1e7, 1e8}, "needs NPROPS >= 29");
    refuses({2, -20, 0.4}, "H2", "infinite");
    refuses({2, -20, -0.4}, "H2", "infinite");
    refuses({6, -3, 0.4}, "H2", "infinite");
    refuses({6, 3, 0.0}, "H2", "> 0");
    refuses({2, 20, -0.4}, "LREF");
    refuses({6, -3, 1.0}, "LREF");
    refuses({2, 20, -0.4, 500}, "H3", "floor");
    refuses({3, 500, 0.26, -0.01, 1}, "H3");
    refuses({3, 500, 0.26, 0.01, 0}, "H4");
    refuses({3, 500, 0.26, 0.05, 1, 1, 0, 0, 0, 1e-9}, "H9", "exp(-1/C)");
    refuses({3, 500, 0.26, 0.05, 1, 1, -5}, "H6", "TREF");
    refuses({4, 7.7, 0.13, 100}, "H3", "SIGY");
    refuses({5, 1, 0.1, 1000, 1e-5, -2e-4, 1000, 3597, 710000, 0}, "H9", "> 0");
}

}  // namespace
}  // namespace lode::test::test_iso_plastic_laws
