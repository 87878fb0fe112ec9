// COH_EXPONENTIAL: the verification cases and failure modes of page 40.
#include "coh_support.hpp"
#include "lode/cohesive/coh_exponential.hpp"

namespace lode::test::coh::test_coh_exponential {
namespace {

const char* const keyword = "COH_EXPONENTIAL";

const Numbers set_a = {100000, 30, 0.3, 3, 50000, 40, 0.9, 5};
Numbers with(std::initializer_list<double> more) {
    Numbers props = set_a;
    props.insert(props.end(), more);
    return props;
}

// --- 7.1: the strength law ---------------------------------------------------------------------------------------

TEST(AbaqusExponential, TableOfStrengthLaws) {
    const double constants[] = {100000, 30, 0.3, 3, 50000, 40, 0.9, 5};
    const Properties p(CohExponential::description, "T", constants, int(std::size(constants)));
    check_law(AbaqusExponential(p, {1, 2, 3, 4, 0, "n"}),
              {0.0003, 0.0353611620099, 7.937393878, 19.5926089998, 0.994458854843, 0.954850681115, 0.183452761542});
}

// Near alpha = 0 the law is the sawtooth; nothing may cancel on the way there.
TEST(AbaqusExponential, TendsToTheSawtooth) {
    const double u_e = 3e-4, u_c = 0.02;
    for (const double alpha : {1e-300, 1e-12, 1e-8, 1e-5}) {
        const double constants[] = {100000, 30, 0.3, alpha, 50000, 40, 0.9, 5};
        const Properties p(CohExponential::description, "T", constants, 8);
        const AbaqusExponential law(p, {1, 2, 3, 4, 0, "n"});
        EXPECT_NEAR(law.end, u_c, u_c * (1e-15 + alpha));
        for (const double delta : {u_e, 0.005, 0.019}) {
            EXPECT_NEAR(law.integrity(delta), u_e * (u_c - delta) / ((u_c - u_e) * delta), 1e-15 + alpha);
            EXPECT_NEAR(law.released_energy(delta), 0.3 * (delta - u_e) / (u_c - u_e), 1e-15 + alpha);
            EXPECT_NEAR(law.slope(delta), -30 / (u_c - u_e), 1e-12 * 1500 + 1500 * alpha);
        }
    }
}
TEST(AbaqusExponential, AnyExponentReleasesTheToughness) {
    for (const double alpha : {1e-6, 0.05, 0.29, 0.31, 1.0, 10.0, 100.0, 800.0}) {
        Interface face(keyword, flat, {100000, 30, 0.3, alpha, 50000, 40, 0.9, 5});
        const Answer a = face.to({100.0, 0});
        EXPECT_EQ(entry(a, STATUS), 0.0);
        EXPECT_NEAR(entry(a, GI), 0.3, 3e-15);
    }
}

// --- 7.2: increments ---------------------------------------------------------------------------------------------

TEST(CohExponential, EX1) {
    Interface face(keyword, flat, {100000, 30, 0.3, 3, 50000, 40, 0.9, 5});
    expect_row(face.to({0.005, 0}), {19.5458423568, 0},
               {{DN, 0.005}, {DAMN, 0.960908315286}, {GI, 0.0704259058376}, {STATUS, 1}});
    expect_row(face.to({0.01, 0}), {12.1953210512, 0},
               {{DN, 0.01}, {DAMN, 0.987804678949}, {GI, 0.136360491451}, {STATUS, 1}});
    expect_row(face.to({0.003, 0}), {3.65859631537, 0},
               {{DN, 0.01}, {DAMN, 0.987804678949}, {GI, 0.136360491451}, {STATUS, 1}});
    expect_row(face.to({0.036, 0}), {0, 0}, {{DN, 0.0353611620099}, {DAMN, 1}, {GI, 0.3}, {STATUS, 0}});
}

TEST(CohExponential, EX2) {
    Interface face(keyword, flat, {100000, 30, 0.3, 3, 50000, 40, 0.9, 5});
    expect_row(face.to({0, 0.02}), {0, 17.1262036565}, {{DT, 0.02}, {DAMT, 0.982873796343}, {GII, 0.36278705602}});
    expect_row(face.to({0, -0.04}), {0, -6.98623989152}, {{DT, 0.04}, {DAMT, 0.996506880054}, {GII, 0.620858283969}});
}

TEST(CohExponential, EX3) {
    Interface face(keyword, flat, {100000, 30, 0.3, 3, 50000, 40, 0.9, 5});
    expect_row(face.to({0.01, 0.02}), {12.1953210512, 17.1262036565},
               {{DN, 0.01}, {DT, 0.02}, {GI, 0.136360491451}, {GII, 0.36278705602}, {GDROP, 0}, {STATUS, 1}});
    expect_row(face.to({0.02, 0.06}), {0, 0},
               {{DN, 0.0113339533078},
                {DT, 0.0253358132312},
                {GI, 0.151900736144},
                {GII, 0.444297791569},
                {GDROP, 0.231797109641},
                {STATUS, 0}});
}

// no mixed criterion
TEST(CohExponential, EX4) {
    Interface face(keyword, flat, {100000, 30, 0.3, 3, 50000, 40, 0.9, 5, 0});
    expect_row(face.to({0.01, 0.02}), {12.1953210512, 17.1262036565},
               {{DN, 0.01}, {DT, 0.02}, {GI, 0.136360491451}, {GII, 0.36278705602}, {GDROP, 0}, {STATUS, 1}});
    expect_row(face.to({0.02, 0.06}), {4.279293841, 2.75623850775},
               {{DN, 0.02}, {DT, 0.06}, {GI, 0.231340486847}, {GII, 0.769234139707}, {GDROP, 0}, {STATUS, 1}});
}

// --- 7.3: further checks -----------------------------------------------------------------------------------------

TEST(CohExponential, FailureAt19ModeRatios) {
    for (const double power : {1.0, 2.0})
        check_failure_criterion("COH_EXPONENTIAL", {100000, 30, 0.3, 3, 50000, 40, 0.9, 5, power}, 0.3, 0.9, power);
}

TEST(CohExponential, FailureDoesNotDependOnTheIncrementSize) {
    for (const double exponent : {0.5, 1.0, 2.0, 3.7}) {
        const Numbers props = with({exponent});
        Interface once(keyword, flat, props), often(keyword, flat, props);
        const Answer one = once.to({0.03, 0.06});
        Answer many;
        for (int i = 1; i <= 997; ++i) many = often.to({0.03 * i / 997, 0.06 * i / 997});
        EXPECT_EQ(entry(one, STATUS), 0.0);
        for (const int index : {DN, DT, GI, GII, GDROP}) EXPECT_NEAR(entry(one, index), entry(many, index), 1e-14);
        const auto GIc = set_a[2], GIIc = set_a[6];
        EXPECT_NEAR(std::pow(entry(one, GI) / GIc, exponent) + std::pow(entry(one, GII) / GIIc, exponent), 1.0, 1e-14);
    }
}

TEST(CohExponential, ConstitutiveThicknessScalesStrainTangentAndEnergies) {
    Interface unit(keyword, spatial, set_a), thin(keyword, spatial, with({1, 1, 0, 0.1}), 0.1);
    for (const Numbers& u : {Numbers{1e-4, 2e-4, 0}, Numbers{0.005, 0.01, -0.008}, Numbers{-0.001, -0.02, 0.004}}) {
        const Answer a = unit.to(u), b = thin.to(u);
        EXPECT_LT(distance(a.stress, b.stress), 1e-11);
        EXPECT_NEAR((a.tangent - 10 * b.tangent).cwiseAbs().maxCoeff(), 0.0, 1e-8);
        EXPECT_NEAR(a.sse, b.sse / 10, 1e-14);
        EXPECT_NEAR(a.spd, b.spd / 10, 1e-14);
    }
}

TEST(CohExponential, TangentAgainstCentralDifferences) {
    for (const double contact : {0.0, 1.0, 2.0})
        check_tangent(keyword, with({1, contact, 4e5, 0.5}), {0.005, 0.01, 0.01}, 1e5, 20, 0.5);
}
TEST(CohExponential, EnergyIdentity) {
    for (const double contact : {0.0, 1.0, 2.0}) check_energy(keyword, with({0, contact, 3e5}), 0.003, 0.006, 1e-4);
}
TEST(CohExponential, ExplicitIsImplicit) {
    check_explicit(keyword, with({1.6, 1, 0, 0.2}), 0.025, 0.05);
    check_explicit(keyword, with({1, 2, 0, 1}), 0.005, 0.01);
}

// --- 6: where it fails -------------------------------------------------------------------------------------------

TEST(CohExponential, RefusesByName) {
    expect_refused(keyword, {100000, 30, 0.0045, 3, 50000, 40, 0.9, 5},
                   "must be greater than sig_n^2/(2 k_n) = 0.0045");
    expect_refused(keyword, {100000, 30, 0.3, 3, 50000, 40, 0.01, 5}, "must be greater than sig_t^2/(2 k_t) = 0.016");
    expect_refused(keyword, {100000, 30, 0.3, 0, 50000, 40, 0.9, 5}, "ALPHA_N");
    expect_refused(keyword, {100000, 30, 0.3, 3, 50000, 40, 0.9, -1}, "ALPHA_T");
    expect_refused(keyword, {100000, 30, 0.3, 3, 50000, 40, 0.9}, "needs at least 8 constants");
    expect_refused(keyword, {1e308, 1e-30, 0.3, 3, 50000, 40, 0.9, 5}, "K_N");
    expect_refused(keyword, with({HUGE_VAL}), "NMIX");
    expect_refused(keyword, with({1, 3}), "CONTACT");
}

TEST(CohExponential, NonsenseAsksForLess) { check_nonsense(keyword, set_a, {0.005, 0.01}); }
TEST(CohExponential, LargeJumpsAreFailureNotNoise) {
    for (const double size : {1.0, 1e6, 1e150, 1e200}) {
        const Answer a = Interface(keyword, spatial, set_a).to({size, -size, size});
        EXPECT_EQ(entry(a, STATUS), 0.0);
        EXPECT_EQ(largest(a.stress), 0.0);
    }
}
TEST(CohExponential, ContactAfterFailure) {
    for (const auto& [contact, stiffness] : {std::pair{0.0, 0.0}, std::pair{1.0, 4e5}, std::pair{2.0, 0.0}}) {
        Interface face(keyword, flat, with({1, contact, 4e5}));
        face.to({1.0, 1.0});
        const Answer a = face.to({-1e-4, 0.002});
        EXPECT_NEAR(a.stress[0], -1e-4 * stiffness, 2.3e-16 * 4e5);  // the way back from 1 is rounded
        EXPECT_NEAR(a.tangent(0, 0), stiffness, 1e-9);
        EXPECT_EQ(a.stress[1], 0.0);
        EXPECT_EQ(entry(a, STATUS), 0.0);
    }
}

}  // namespace
}  // namespace lode::test::coh::test_coh_exponential
