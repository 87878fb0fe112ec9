// COH_LINEAR: the verification cases and failure modes of page 40.
#include "coh_support.hpp"

namespace lode::test::coh::test_coh_linear {
namespace {

const char* const keyword = "COH_LINEAR";

// --- 7.3 ---------------------------------------------------------------------------------------------------------

TEST(CohLinear, TractionsInEachContactOption) {
    const auto traction = [](Numbers more, const Numbers& u) {
        Numbers props = {100000, 40000};
        props.insert(props.end(), more.begin(), more.end());
        return Interface(keyword, flat, props).to(u);
    };
    expect_row(traction({}, {1e-3, 2e-3}), {100, 80}, {{UN, 1e-3}, {US1, 2e-3}, {STATUS, 1}});
    expect_row(traction({}, {-1e-3, 1e-3}), {-100, 40}, {});
    expect_row(traction({0}, {-1e-3, 1e-3}), {0, 40}, {});
    expect_row(traction({1, 900000}, {-1e-3, 1e-3}), {-900, 40}, {});
    expect_row(traction({2, 900000}, {-1e-3, 1e-3}), {-100, 40}, {});
    expect_tangent(traction({}, {1e-3, 2e-3}), {100000, 0, 0, 40000});
    expect_tangent(traction({0}, {-1e-3, 1e-3}), {0, 0, 0, 40000});
    expect_tangent(traction({1, 900000}, {-1e-3, 1e-3}), {900000, 0, 0, 40000});
    expect_tangent(traction({2, 900000}, {-1e-3, 1e-3}), {100000, 0, 0, 40000});
}

TEST(CohLinear, NeverFailsAndKeepsNoHistory) {
    Interface face(keyword, spatial, {100000, 40000, 1, 0, 0.5}, 0.5);
    const Answer far = face.to({10, -20, 30});
    for (const int zero : {DN, DT, DAMN, DAMT, GI, GII, GDROP}) EXPECT_EQ(entry(far, zero), 0.0);
    EXPECT_EQ(entry(far, STATUS), 1.0);
    EXPECT_NEAR(entry(far, WORK), far.sse * 0.5, 1e-9);
    EXPECT_NEAR(far.sse, 0.5 * (1e5 * 100 + 4e4 * 1300) / 0.5, 1e-6);
    EXPECT_EQ(far.spd, 0.0);
    EXPECT_NEAR(far.tangent(0, 0), 0.5 * 100000, 1e-9);
    const Answer back = face.to({0, 0, 0});
    EXPECT_NEAR(largest(back.stress), 0.0, 1e-9);
    EXPECT_NEAR(entry(back, WORK), 0.0, 1e-6);
}

TEST(CohLinear, ExplicitIsImplicit) { check_explicit(keyword, {100000, 40000, 1, 9e5, 0.3}, 0.01, 0.02); }

TEST(CohLinear, ExplicitProbe) {
    VumatBlock block(keyword, spatial, {100000, 40000, 1, 9e5, 0.2});
    block.points.assign(3, block.fresh_point());
    for (VumatPoint& p : block.points) p.strain_increment = {-1.0, -2.0, 3.0};
    block.step_time = block.total_time = 0.0;
    EXPECT_EQ(block.run().stops, 0);
    for (const VumatPoint& p : block.points) {
        EXPECT_DOUBLE_EQ(p.stress[0], -0.2 * 100000);
        EXPECT_DOUBLE_EQ(p.stress[2], 0.6 * 40000);
        EXPECT_EQ(largest(p.state), 0.0);
    }
}

// --- 6: where it fails -------------------------------------------------------------------------------------------

TEST(CohLinear, RefusesByName) {
    expect_refused(keyword, {100000}, "needs at least 2 constants");
    expect_refused(keyword, {-1, 40000}, "K_N");
    expect_refused(keyword, {100000, -1}, "K_T");
    expect_refused(keyword, {100000, 40000, 3}, "CONTACT");
    expect_refused(keyword, {100000, 40000, 1, -1}, "K_COMP");
    expect_refused(keyword, {100000, 40000, 1, 0, 0}, "T0");
    expect_refused(keyword, {std::nan(""), 40000}, "K_N");
    char text[512];
    EXPECT_EQ(lode_required_state(keyword, Numbers{1, 1}.data(), 2, 1, 2, text, sizeof text), 12);
    EXPECT_EQ(lode_required_state(keyword, Numbers{1, 1}.data(), 2, 3, 3, text, sizeof text), -1);
}
TEST(CohLinear, NonsenseAsksForLess) {
    check_nonsense(keyword, {100000, 40000}, {0.01, 0.01});
    EXPECT_EQ(Interface(keyword, flat, {100000, 40000}).point.step({.dstran = {1e200, 0}}).pnewdt, 0.25);
}
// No stiffness at all is allowed: a free face.
TEST(CohLinear, FreeFace) {
    const Answer a = Interface(keyword, flat, {0, 0}).to({1, 1});
    EXPECT_EQ(largest(a.stress), 0.0);
    EXPECT_EQ(a.tangent.cwiseAbs().maxCoeff(), 0.0);
}

}  // namespace
}  // namespace lode::test::coh::test_coh_linear
