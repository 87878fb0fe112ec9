// COH_COUPLED: the verification cases and failure modes of page 40.
#include "coh_support.hpp"
#include "lode/cohesive/coh_coupled.hpp"

namespace lode::test::coh::test_coh_coupled {
namespace {

const char* const keyword = "COH_COUPLED";

const Numbers set_a = {100000, 30, 0.3, 50000, 40, 0.9}, alike = {100000, 30, 0.3, 100000, 60, 1.2};
Numbers with(Numbers props, std::initializer_list<double> more) {
    props.insert(props.end(), more);
    return props;
}

// --- 7.2: increments ---------------------------------------------------------------------------------------------

TEST(CohCoupled, HO1) {
    Interface face(keyword, flat, {100000, 30, 0.3, 50000, 40, 0.9});
    expect_row(face.to({0.0001, 0.0001}), {9.75951161741, 5.7834142918},
               {{DN, 0}, {DT, 0.0153696215426}, {DAMN, 0.0240488382593}, {GI, 0}, {GII, 0}, {STATUS, 1}});
    const Answer row2 = face.to({0.005, 0.01});
    expect_row(row2, {15.165773014, 17.9742494981},
               {{DN, 0.3344887383},
                {DT, 0.0160554594384},
                {DAMN, 0.969668453972},
                {GI, 0.0542358061396},
                {GII, 0.128558947886},
                {STATUS, 1}});
    expect_tangent(row2, {483.1400269984, -1003.808096117, -3022.239497243, 607.7264655191});
    expect_row(face.to({0.002, 0.004}), {6.0663092056, 7.18969979922},
               {{DN, 0.3344887383},
                {DT, 0.0160554594384},
                {DAMN, 0.969668453972},
                {GI, 0.0542358061396},
                {GII, 0.128558947886},
                {STATUS, 1}});
    expect_row(face.to({0.02, 0.01}), {0, 0},
               {{DN, 1}, {DT, 0.0151027230388}, {DAMN, 1}, {GI, 0.247411206107}, {GII, 0.157177525659}, {STATUS, 0}});
}

TEST(CohCoupled, HO2) {
    Interface face(keyword, flat, {100000, 30, 0.3, 50000, 40, 0.9});
    expect_row(face.to({0.004, 0}), {24.3654822335, 0},
               {{DN, 0.2}, {DT, 0.015}, {GI, 0.056345177665}, {GII, 0}, {STATUS, 1}});
    expect_row(face.to({0, 0.02}), {0, 22.6244343891},
               {{DN, 0.444444444444}, {DT, 0.0177777777778}, {GI, 0.056345177665}, {GII, 0.223981900452}, {STATUS, 1}});
    expect_row(face.to({0, 0.046}), {0, 0},
               {{DN, 1}, {DT, 0.0177777777778}, {GI, 0.056345177665}, {GII, 0.733031674208}, {STATUS, 0}});
}

TEST(CohCoupled, HO3) {
    Interface face(keyword, flat, {100000, 30, 0.3, 50000, 40, 0.9, 3});
    expect_row(face.to({0.005, 0.01}), {12.4933384644, 14.8250813363},
               {{DN, 0.189286701673},
                {DT, 0.00908576168032},
                {DAMN, 0.975013323071},
                {GI, 0.052390678299},
                {GII, 0.124337633093}});
    expect_row(face.to({0.004, 0.02}), {5.1338425626, 15.2300431497},
               {{DN, 0.275934687297},
                {DT, 0.00973887131637},
                {DAMN, 0.987165393593},
                {GI, 0.0590362764966},
                {GII, 0.222911699273}});
}

TEST(CohCoupled, HO4) {
    Interface face(keyword, spatial, {100000, 30, 0.3, 50000, 40, 0.9});
    expect_row(face.to({0.003, 0.006, -0.008}), {12.4934340426, 14.8070329394, -19.7427105859},
               {{DN, 0.268109522489}, {DT, 0.0167486690901}, {GI, 0.024005590519}, {GII, 0.15806150136}});
    expect_row(face.to({-0.0001, 0.01, 0.02}), {-10.0, 9.16254461312, 18.3250892262},
               {{DN, 0.496903995}, {DT, 0.0177777777778}, {GI, 0.024005590519}, {GII, 0.367703495403}});
}

// --- 6 and 7.3: further checks -----------------------------------------------------------------------------------

// Constant mixity: a straight line, GI/GIc + GII/GIIc = 1, at 19 mode ratios, in one increment and in 100.
TEST(CohCoupled, FailureAtConstantMixity) {
    // Exponential softening stays on the line only if u_e/u_c is the same in both modes.
    for (const Numbers& props : {set_a, alike, with(alike, {3})})
        for (int i = 0; i <= 18; ++i)
            for (const int steps : {1, 100}) {
                const double angle = i * std::acos(0.0) / 18, un = 0.2 * std::sin(angle), ut = 0.2 * std::cos(angle);
                Interface face(keyword, flat, props);
                Answer a;
                for (int k = 1; k <= steps; ++k) a = face.to({un * k / steps, ut * k / steps});
                EXPECT_EQ(entry(a, STATUS), 0.0);
                EXPECT_NEAR(entry(a, GI) / props[2] + entry(a, GII) / props[5], 1.0, 1e-13) << angle << ", " << steps;
                EXPECT_NEAR(a.spd, entry(a, GI) + entry(a, GII), 1e-15);
            }
}

TEST(CohCoupled, FailureAt19ModeRatios) {
    for (const Numbers& props : {set_a, alike, with(alike, {3})})
        check_failure_criterion(keyword, props, props[2], props[5], 1.0);
}

// HO-1 turns in its last increment and therefore misses the line.
TEST(CohCoupled, TurningMixityIsOfFirstOrder) {
    Interface face(keyword, flat, set_a);
    face.to({0.0001, 0.0001});
    face.to({0.005, 0.01});
    const Answer a = face.to({0.02, 0.01});
    EXPECT_NEAR(entry(a, GI) / 0.3, 0.824704, 1e-6);
    EXPECT_NEAR(entry(a, GII) / 0.9, 0.174642, 1e-6);
}

// Preload in mode I up to GI, unload, fail in mode II.
TEST(CohCoupled, PreloadInTheOtherMode) {
    Interface face(keyword, flat, set_a);
    const Answer loaded = face.to({0.004, 0});
    face.to({0, 0});
    const Answer a = face.to({0, 0.046});
    const double pn = 3e-4 / 0.02, pt = 8e-4 / 0.045;
    EXPECT_NEAR(entry(a, GII) / 0.9, (1 - pn) / (1 - pt) * (1 - entry(loaded, GI) / 0.3), 1e-14);
}

TEST(CohCoupled, TangentAgainstCentralDifferences) {
    for (const double contact : {0.0, 1.0, 2.0})
        for (const double alpha : {0.0, 3.0})
            check_tangent(keyword, with(set_a, {alpha, contact, 4e5, 0.5}), {0.004, 0.01, 0.01}, 1e5, 20, 0.5);
}
TEST(CohCoupled, EnergyIdentityForEqualRatios) {
    for (const double alpha : {0.0, 3.0}) check_energy(keyword, with(alike, {alpha, 1, 3e5}), 0.004, 0.004, 4e-3);
}
TEST(CohCoupled, ExplicitIsImplicit) {
    check_explicit(keyword, with(set_a, {0, 1, 0, 0.2}), 0.02, 0.05);
    check_explicit(keyword, with(set_a, {3, 2, 0, 1}), 0.004, 0.01);
}
TEST(CohCoupled, SmallExponentsAreTheLinearLaw) {
    for (const double alpha : {1e-12, 1e-8}) {
        const Answer a = Interface(keyword, flat, with(set_a, {alpha})).to({0.005, 0.01});
        const Answer b = Interface(keyword, flat, set_a).to({0.005, 0.01});
        EXPECT_LT(distance(a.stress, b.stress), 1e-6);
        EXPECT_NEAR(entry(a, GI), entry(b, GI), 2 * alpha + 1e-15);
    }
}

// --- 6: where it fails -------------------------------------------------------------------------------------------

TEST(CohCoupled, RefusesByName) {
    expect_refused(keyword, {100000, 30, 0.0045, 50000, 40, 0.9}, "must be greater than sig_n^2/(2 k_n) = 0.0045");
    expect_refused(keyword, {100000, 30, 0.3, 50000, 40, 0.01, 2}, "must be greater than sig_t^2/(2 k_t) = 0.016");
    expect_refused(keyword, with(set_a, {-1}), "ALPHA");
    expect_refused(keyword, with(set_a, {0, 4}), "CONTACT");
    expect_refused(keyword, {100000, 30, 0.3, 50000, 40}, "needs at least 6 constants");
}
TEST(CohCoupled, NothingSeparated) {
    Interface face(keyword, spatial, set_a);
    Answer a = face.to({0, 0, 0});
    EXPECT_EQ(largest(a.stress), 0.0);
    EXPECT_EQ(a.tangent(0, 0), 100000.0);
    EXPECT_EQ(a.tangent(1, 1), 50000.0);
    EXPECT_EQ(entry(a, DN), 0.0);
    face.to({0.005, 0.01, 0});
    const Answer before = face.to({0.004, 0, 0});
    a = face.to({0, 0, 0});
    EXPECT_EQ(largest(a.stress), 0.0);
    EXPECT_EQ(entry(a, DN), entry(before, DN));
    EXPECT_EQ(entry(a, DAMN), entry(before, DAMN));
    a = face.to({-0.001, 0, 0});
    EXPECT_NEAR(a.stress[0], -100.0, 1e-12);
    face.to({1, 0, 0});
    a = face.to({0, 0, 0});
    EXPECT_EQ(a.tangent.cwiseAbs().maxCoeff(), 0.0);
    EXPECT_EQ(entry(a, STATUS), 0.0);
}
TEST(CohCoupled, UnequalRatiosAreWarnedOfOnce) {
    const auto warning = [](const Numbers& props) {
        return CohCoupled(Properties(CohCoupled::description, "T", props.data(), int(props.size()))).warnings();
    };
    EXPECT_NE(warning(set_a).find("valid only at constant mixity"), std::string::npos);
    EXPECT_EQ(warning(alike), "");
}
// With unequal ratios the interface is stiffer than k in one mode, but never than the virgin secant of the mixity.
TEST(CohCoupled, SecantIsCapped) {
    Interface face(keyword, flat, set_a);
    face.to({0.0004, 0});
    const Answer a = face.to({0, 0.0002});
    EXPECT_LE(a.stress[1], 50000 * 0.0002 * (1 + 1e-14));
    EXPECT_LT(entry(Interface(keyword, flat, set_a).to({1e-5, 4e-4}), DAMT), 0.0 + 1e-14);
}
TEST(CohCoupled, NonsenseAsksForLess) { check_nonsense(keyword, set_a, {0.005, 0.01}); }
TEST(CohCoupled, LargeJumpsAreFailureNotNoise) {
    for (const double size : {1.0, 1e6, 1e150, 1e200}) {
        const Answer a = Interface(keyword, spatial, set_a).to({size, -size, size});
        EXPECT_EQ(entry(a, STATUS), 0.0);
        EXPECT_EQ(largest(a.stress), 0.0);
        EXPECT_NEAR(entry(a, GI) / 0.3 + entry(a, GII) / 0.9, 1.0, 1e-13);
    }
}

}  // namespace
}  // namespace lode::test::coh::test_coh_coupled
