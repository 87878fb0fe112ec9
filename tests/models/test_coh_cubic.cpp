// COH_CUBIC: the verification cases and failure modes of page 40.
#include "coh_support.hpp"
#include "lode/cohesive/coh_cubic.hpp"

namespace lode::test::coh::test_coh_cubic {
namespace {

const char* const keyword = "COH_CUBIC";

const Numbers set_a = {30, 0.3, 40, 0.9};
Numbers with(std::initializer_list<double> more) {
    Numbers props = set_a;
    props.insert(props.end(), more);
    return props;
}

// --- 7.1: the strength law ---------------------------------------------------------------------------------------

TEST(Needleman, TableOfStrengthLaws) {
    const double constants[] = {30, 0.3, 40, 0.9};
    const Properties p(CohCubic::description, "T", constants, int(std::size(constants)));
    check_law(Needleman(p, {0, 1, 2, 0, 0, "n"}), {0, 0.0177777777778, 29.16, 38.88, 0.64, 67.5, 0.05376});
}
TEST(Needleman, PeakIsTheGivenStressAtAThirdOfTheEnd) {
    Interface face(keyword, flat, set_a);
    const double u_c = 16 * 0.3 / (9 * 30);
    const Answer a = face.to({u_c / 3, 0});
    EXPECT_NEAR(a.stress[0], 30.0, 1e-13);
    EXPECT_NEAR(a.tangent(0, 0), 0.0, 1e-10);
    EXPECT_NEAR(Interface(keyword, flat, set_a).to({0, 0}).tangent(0, 0), 27 * 30 / (4 * u_c), 1e-10);
}

// --- 7.2: increments ---------------------------------------------------------------------------------------------

TEST(CohCubic, CU1) {
    Interface face(keyword, flat, {30, 0.3, 40, 0.9});
    expect_row(face.to({0.004, 0}), {27.3659765625, 0},
               {{DN, 0.004}, {DAMN, 0.399375}, {GI, 0.0113621484375}, {STATUS, 1}});
    expect_row(face.to({0.012, 0}), {14.4376171875, 0},
               {{DN, 0.012}, {DAMN, 0.894375}, {GI, 0.182221523437}, {STATUS, 1}});
    expect_row(face.to({0.006, 0}), {7.21880859375, 0},
               {{DN, 0.012}, {DAMN, 0.894375}, {GI, 0.182221523437}, {STATUS, 1}});
    expect_row(face.to({0.0178, 0}), {0, 0}, {{DN, 0.0177777777778}, {DAMN, 1}, {GI, 0.3}, {STATUS, 0}});
}

TEST(CohCubic, CU2) {
    Interface face(keyword, flat, {30, 0.3, 40, 0.9});
    expect_row(face.to({0, 0.01}), {0, 37.96875}, {{DT, 0.01}, {DAMT, 0.4375}, {GII, 0.045703125}});
    expect_row(face.to({0, -0.03}), {0, -12.65625}, {{DT, 0.03}, {DAMT, 0.9375}, {GII, 0.664453125}});
}

TEST(CohCubic, CU3) {
    Interface face(keyword, flat, {30, 0.3, 40, 0.9});
    expect_row(face.to({0.006, 0.02}), {29.9964990234, 33.75},
               {{DN, 0.006}, {DT, 0.02}, {GI, 0.0344548608398}, {GII, 0.28125}, {GDROP, 0}, {STATUS, 1}});
    expect_row(face.to({0.012, 0.03}), {0, 0},
               {{DN, 0.00997510643922},
                {DT, 0.0266251773987},
                {GI, 0.122775411124},
                {GII, 0.531673766629},
                {GDROP, 0.376659737298},
                {STATUS, 0}});
}

TEST(CohCubic, CU4) {
    Interface face(keyword, flat, {30, 0.3, 40, 0.9});
    expect_row(face.to({-0.001, 0.01}), {-11.390625, 37.96875}, {{DN, 0}, {DT, 0.01}, {GI, 0}, {GII, 0.045703125}});
    expect_row(face.to({0.005, 0.01}), {29.4220733643, 37.96875},
               {{DN, 0.005}, {DT, 0.01}, {GI, 0.0210654258728}, {GII, 0.045703125}});
}

// --- 7.3: further checks -----------------------------------------------------------------------------------------

TEST(CohCubic, FailureAt19ModeRatios) {
    for (const double power : {1.0, 2.0})
        check_failure_criterion("COH_CUBIC", {30, 0.3, 40, 0.9, power}, 0.3, 0.9, power);
}

TEST(CohCubic, FailureDoesNotDependOnTheIncrementSize) {
    for (const double exponent : {0.5, 1.0, 2.0, 3.7}) {
        const Numbers props = with({exponent});
        Interface once(keyword, flat, props), often(keyword, flat, props);
        const Answer one = once.to({0.03, 0.07200000000000001});
        Answer many;
        for (int i = 1; i <= 997; ++i) many = often.to({0.03 * i / 997, 0.07200000000000001 * i / 997});
        EXPECT_EQ(entry(one, STATUS), 0.0);
        for (const int index : {DN, DT, GI, GII, GDROP}) EXPECT_NEAR(entry(one, index), entry(many, index), 1e-14);
        const auto GIc = set_a[1], GIIc = set_a[3];
        EXPECT_NEAR(std::pow(entry(one, GI) / GIc, exponent) + std::pow(entry(one, GII) / GIIc, exponent), 1.0, 1e-14);
    }
}

TEST(CohCubic, ConstitutiveThicknessScalesStrainTangentAndEnergies) {
    Interface unit(keyword, spatial, set_a), thin(keyword, spatial, with({1, 1, 0, 0.1}), 0.1);
    for (const Numbers& u :
         {Numbers{1e-4, 2e-4, 0}, Numbers{0.005, 0.012, -0.009600000000000001}, Numbers{-0.001, -0.024, 0.004}}) {
        const Answer a = unit.to(u), b = thin.to(u);
        EXPECT_LT(distance(a.stress, b.stress), 1e-11);
        EXPECT_NEAR((a.tangent - 10 * b.tangent).cwiseAbs().maxCoeff(), 0.0, 1e-8);
        EXPECT_NEAR(a.sse, b.sse / 10, 1e-14);
        EXPECT_NEAR(a.spd, b.spd / 10, 1e-14);
    }
}

TEST(CohCubic, TangentAgainstCentralDifferences) {
    for (const double contact : {0.0, 1.0, 2.0})
        check_tangent(keyword, with({1, contact, 4e5, 0.5}), {0.005, 0.012, 0.012}, 12000, 20, 0.5);
}
TEST(CohCubic, EnergyIdentity) {
    for (const double contact : {0.0, 1.0, 2.0}) check_energy(keyword, with({0, contact, 3e5}), 0.003, 0.0072, 1e-4);
}
TEST(CohCubic, ExplicitIsImplicit) {
    check_explicit(keyword, with({1.6, 1, 0, 0.2}), 0.025, 0.06);
    check_explicit(keyword, with({1, 2, 0, 1}), 0.005, 0.012);
}

// --- 6: where it fails -------------------------------------------------------------------------------------------

TEST(CohCubic, RefusesByName) {
    expect_refused(keyword, {0, 0.3, 40, 0.9}, "SIG_N");
    expect_refused(keyword, {30, -0.3, 40, 0.9}, "GIC");
    expect_refused(keyword, {30, 0.3, 40, 0}, "GIIC");
    expect_refused(keyword, {30, 0.3, 40}, "needs at least 4 constants");
    expect_refused(keyword, {1e300, 1e-300, 40, 0.9}, "GIC");
    expect_refused(keyword, with({1, 1, 0, 0}), "T0");
}
// 0/0 at the virgin point: no traction, the initial stiffness.
TEST(CohCubic, VirginPoint) {
    Interface face(keyword, spatial, set_a);
    const Answer a = face.to({0, 0, 0});
    EXPECT_EQ(largest(a.stress), 0.0);
    EXPECT_TRUE(a.tangent.allFinite());
    EXPECT_EQ(entry(a, DAMN), 0.0);
    const Answer tiny = face.to({1e-200, 1e-200, 0});
    EXPECT_NEAR(tiny.stress[0] / 1e-200, 27 * 30 / (4 * 16 * 0.3 / 270), 1e-6);
}

TEST(CohCubic, NonsenseAsksForLess) { check_nonsense(keyword, set_a, {0.005, 0.012}); }
TEST(CohCubic, LargeJumpsAreFailureNotNoise) {
    for (const double size : {1.0, 1e6, 1e150, 1e200}) {
        const Answer a = Interface(keyword, spatial, set_a).to({size, -size, size});
        EXPECT_EQ(entry(a, STATUS), 0.0);
        EXPECT_EQ(largest(a.stress), 0.0);
    }
}
TEST(CohCubic, ContactAfterFailure) {
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
}  // namespace lode::test::coh::test_coh_cubic
