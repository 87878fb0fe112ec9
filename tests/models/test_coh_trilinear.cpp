// COH_TRILINEAR: the verification cases and failure modes of page 40.
#include "coh_support.hpp"
#include "lode/cohesive/coh_trilinear.hpp"

namespace lode::test::coh::test_coh_trilinear {
namespace {

const char* const keyword = "COH_TRILINEAR";

const Numbers set_a = {100000, 30, 12, 0.006, 0.3, 50000, 40, 10, 0.02, 0.9};
Numbers with(std::initializer_list<double> more) {
    Numbers props = set_a;
    props.insert(props.end(), more);
    return props;
}

// --- 7.1: the strength law ---------------------------------------------------------------------------------------

TEST(Bilinear, TableOfStrengthLaws) {
    const double constants[] = {100000, 30, 12, 0.006, 0.3, 50000, 40, 10, 0.02, 0.9};
    const Properties p(CohTrilinear::description, "T", constants, int(std::size(constants)));
    check_law(Bilinear(p, {1, 2, 5, 3, 4, "n"}),
              {0.0003, 0.0353, 8.60068259386, 14.457337884, 0.993985536648, 0.7069948596, 0.148197952218});
}
TEST(Bilinear, BothBranchesAndTheBreakBelongTogether) {
    const double constants[] = {100000, 30, 12, 0.006, 0.3, 50000, 40, 10, 0.02, 0.9};
    const Properties p(CohTrilinear::description, "T", constants, 10);
    const Bilinear law(p, {1, 2, 5, 3, 4, "n"});
    const double below = 0.006, above = std::nextafter(0.006, 1.0);
    EXPECT_NEAR(law.integrity(below), law.integrity(above), 1e-15);
    EXPECT_NEAR(law.released_energy(below), law.released_energy(above), 1e-15);
    EXPECT_NEAR(law.psi(below), law.psi(above), 1e-12);
    EXPECT_GT(law.slope(above), law.slope(below));
}

// --- 7.2: increments ---------------------------------------------------------------------------------------------

TEST(CohTrilinear, TL1) {
    Interface face(keyword, flat, {100000, 30, 12, 0.006, 0.3, 50000, 40, 10, 0.02, 0.9});
    expect_row(face.to({0.003, 0}), {21.4736842105, 0},
               {{DN, 0.003}, {DAMN, 0.928421052632}, {GI, 0.0417789473684}, {STATUS, 1}});
    expect_row(face.to({0.006, 0}), {12.0, 0}, {{DN, 0.006}, {DAMN, 0.98}, {GI, 0.0882}, {STATUS, 1}});
    expect_row(face.to({0.02, 0}), {6.2662116041, 0},
               {{DN, 0.02}, {DAMN, 0.996866894198}, {GI, 0.189401365188}, {STATUS, 1}});
    expect_row(face.to({0.01, 0}), {3.13310580205, 0},
               {{DN, 0.02}, {DAMN, 0.996866894198}, {GI, 0.189401365188}, {STATUS, 1}});
    expect_row(face.to({0.036, 0}), {0, 0}, {{DN, 0.0353}, {DAMN, 1}, {GI, 0.3}, {STATUS, 0}});
}

TEST(CohTrilinear, TL2) {
    Interface face(keyword, flat, {100000, 30, 12, 0.006, 0.3, 50000, 40, 10, 0.02, 0.9});
    expect_row(face.to({0, 0.01}), {0, 25.625}, {{DT, 0.01}, {DAMT, 0.94875}, {GII, 0.18975}});
    expect_row(face.to({0, -0.05}), {0, -6.28712871287}, {{DT, 0.05}, {DAMT, 0.997485148515}, {GII, 0.583128712871}});
}

TEST(CohTrilinear, TL3) {
    Interface face(keyword, flat, {100000, 30, 12, 0.006, 0.3, 50000, 40, 10, 0.02, 0.9});
    expect_row(face.to({0.01, 0.03}), {10.361774744, 8.76237623762},
               {{DN, 0.01}, {DT, 0.03}, {GI, 0.117114675768}, {GII, 0.458376237624}, {GDROP, 0}, {STATUS, 1}});
    expect_row(face.to({0.02, 0.06}), {0, 0},
               {{DN, 0.0122347089644},
                {DT, 0.0367041268933},
                {GI, 0.133268647054},
                {GII, 0.500194058839},
                {GDROP, 0.203368441649},
                {STATUS, 0}});
}

// sudden drop, u_2 = u_e
TEST(CohTrilinear, TL4) {
    Interface face(keyword, flat, {100000, 30, 12, 0.0003, 0.1, 50000, 40, 10, 0.02, 0.9});
    expect_row(face.to({0.0003, 0}), {30.0, 0}, {{DN, 0.0003}, {DAMN, 0}, {GI, 0}});
    expect_row(face.to({0.0004, 0}), {11.9246073298, 0},
               {{DN, 0.0004}, {DAMN, 0.701884816754}, {GI, 0.00331130890052}});
    expect_row(face.to({0.005, 0}), {8.45654450262, 0}, {{DN, 0.005}, {DAMN, 0.983086910995}, {GI, 0.0314315183246}});
}

// --- 7.3: further checks -----------------------------------------------------------------------------------------

TEST(CohTrilinear, FailureAt19ModeRatios) {
    for (const double power : {1.0, 2.0})
        check_failure_criterion("COH_TRILINEAR", {100000, 30, 12, 0.006, 0.3, 50000, 40, 10, 0.02, 0.9, power}, 0.3,
                                0.9, power);
}

TEST(CohTrilinear, FailureDoesNotDependOnTheIncrementSize) {
    for (const double exponent : {0.5, 1.0, 2.0, 3.7}) {
        const Numbers props = with({exponent});
        Interface once(keyword, flat, props), often(keyword, flat, props);
        const Answer one = once.to({0.03, 0.09});
        Answer many;
        for (int i = 1; i <= 997; ++i) many = often.to({0.03 * i / 997, 0.09 * i / 997});
        EXPECT_EQ(entry(one, STATUS), 0.0);
        for (const int index : {DN, DT, GI, GII, GDROP}) EXPECT_NEAR(entry(one, index), entry(many, index), 1e-14);
        const auto GIc = set_a[4], GIIc = set_a[9];
        EXPECT_NEAR(std::pow(entry(one, GI) / GIc, exponent) + std::pow(entry(one, GII) / GIIc, exponent), 1.0, 1e-14);
    }
}

TEST(CohTrilinear, ConstitutiveThicknessScalesStrainTangentAndEnergies) {
    Interface unit(keyword, spatial, set_a), thin(keyword, spatial, with({1, 1, 0, 0.1}), 0.1);
    for (const Numbers& u : {Numbers{1e-4, 2e-4, 0}, Numbers{0.005, 0.015, -0.012}, Numbers{-0.001, -0.03, 0.004}}) {
        const Answer a = unit.to(u), b = thin.to(u);
        EXPECT_LT(distance(a.stress, b.stress), 1e-11);
        EXPECT_NEAR((a.tangent - 10 * b.tangent).cwiseAbs().maxCoeff(), 0.0, 1e-8);
        EXPECT_NEAR(a.sse, b.sse / 10, 1e-14);
        EXPECT_NEAR(a.spd, b.spd / 10, 1e-14);
    }
}

TEST(CohTrilinear, TangentAgainstCentralDifferences) {
    for (const double contact : {0.0, 1.0, 2.0})
        check_tangent(keyword, with({1, contact, 4e5, 0.5}), {0.005, 0.015, 0.015}, 1e5, 20, 0.5);
}
TEST(CohTrilinear, EnergyIdentity) {
    for (const double contact : {0.0, 1.0, 2.0}) check_energy(keyword, with({0, contact, 3e5}), 0.003, 0.009, 1e-4);
}
TEST(CohTrilinear, ExplicitIsImplicit) {
    check_explicit(keyword, with({1.6, 1, 0, 0.2}), 0.025, 0.075);
    check_explicit(keyword, with({1, 2, 0, 1}), 0.005, 0.015);
}

// --- 6: where it fails -------------------------------------------------------------------------------------------

TEST(CohTrilinear, RefusesByName) {
    const auto normal = [](double sig2, double u2, double G) {
        return Numbers{100000, 30, sig2, u2, G, 50000, 40, 10, 0.02, 0.9};
    };
    expect_refused(keyword, normal(12, 0.0002, 0.3),
                   "U2_N, separation at the break, mode I) must be at least sig/k = 0.0003");
    expect_refused(keyword, normal(31, 0.0003, 0.3), "SIG2_N, stress at the break, mode I) must be at most k u2 = 30");
    expect_refused(keyword, normal(12, 0.006, 0.1242), "must be greater than (sig u2 + sig2 (u2 - u_e))/2 = 0.1242");
    expect_refused(keyword, normal(0, 0.006, 0.3), "SIG2_N");
    expect_refused(keyword, {100000, 30, 12, 0.006, 0.3, 50000, 40, 10, 0.02}, "needs at least 10 constants");
    expect_refused(keyword, with({1, -1}), "CONTACT");
}
// A plateau and even hardening between u_e and u2 are laws like any other.
TEST(CohTrilinear, Hardening) {
    Interface face(keyword, flat, {20000, 15, 30, 0.02, 1.0, 50000, 40, 10, 0.02, 0.9});
    const Answer middle = face.to({0.01, 0}), top = face.to({0.02, 0});
    EXPECT_GT(middle.stress[0], 15.0);
    EXPECT_NEAR(top.stress[0], 30.0, 1e-12);
    EXPECT_GT(entry(top, DAMN), entry(middle, DAMN));
    EXPECT_NEAR(entry(face.to({1.0, 0}), GI), 1.0, 1e-14);
}
// The sudden drop of u2 = u_e, passed over in one increment or reached exactly.
TEST(CohTrilinear, SuddenDropReleasesItsEnergy) {
    Interface face(keyword, flat, {100000, 30, 12, 0.0003, 0.1, 50000, 40, 10, 0.02, 0.9});
    EXPECT_EQ(entry(face.to({0.0003, 0}), GI), 0.0);
    const Answer a = face.to({std::nextafter(0.0003, 1.0), 0});
    EXPECT_NEAR(a.stress[0], 12.0, 1e-12);
    EXPECT_NEAR(entry(a, GI), 0.5 * (30 - 12) * 0.0003, 1e-15);
    EXPECT_NEAR(entry(face.to({1, 0}), GI), 0.1, 1e-15);
}

TEST(CohTrilinear, NonsenseAsksForLess) { check_nonsense(keyword, set_a, {0.005, 0.015}); }
TEST(CohTrilinear, LargeJumpsAreFailureNotNoise) {
    for (const double size : {1.0, 1e6, 1e150, 1e200}) {
        const Answer a = Interface(keyword, spatial, set_a).to({size, -size, size});
        EXPECT_EQ(entry(a, STATUS), 0.0);
        EXPECT_EQ(largest(a.stress), 0.0);
    }
}
TEST(CohTrilinear, ContactAfterFailure) {
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
}  // namespace lode::test::coh::test_coh_trilinear
