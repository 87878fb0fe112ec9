// COH_PRESSURE: the verification cases and failure modes of page 40.
#include "coh_support.hpp"

namespace lode::test::coh::test_coh_pressure {
namespace {

const char* const keyword = "COH_PRESSURE";

Answer traction(const Numbers& props, double un, double field = 0.0) {
    Interface face(keyword, flat, props);
    face.point.fields({0.0});
    Load load = face.load_to({un, 0.003});
    load.dpred = {field};
    return face.point.advance(load);
}

// --- 7.3 ---------------------------------------------------------------------------------------------------------

TEST(CohPressure, ActsOnTheOpenCrack) {
    expect_row(traction({-3}, 1e-3), {-3, 0}, {{UN, 1e-3}, {STATUS, 1}});
    expect_row(traction({-3}, -1e-3), {0, 0}, {});
    expect_row(traction({-3, 0.002}, 1e-3), {0, 0}, {});
    expect_row(traction({-3, 0.002}, 5e-3), {-3, 0}, {});
    expect_row(traction({0, 0, 1}, 1e-3, 2.0), {-2, 0}, {});
    expect_row(traction({-3, 0, 0, 100000}, -1e-3), {-100, 0}, {});
    expect_tangent(traction({-3, 0, 0, 100000}, 1e-3), {0, 0, 0, 0});
    expect_tangent(traction({-3, 0, 0, 100000, 0.1}, -1e-3), {10000, 0, 0, 0});
}

TEST(CohPressure, AlwaysOn) {
    expect_row(traction({-3, -1e30, 0, 100000}, -1e-3), {-3, 0}, {});
    expect_tangent(traction({-3, -1e30, 0, 100000}, -1e-3), {0, 0, 0, 0});
}

// Some hosts pass an empty PREDEF: without CHI the field must not be looked at.
TEST(CohPressure, FieldIsNotReadWithoutFactor) {
    const double nan = std::nan("");
    Interface face(keyword, flat, {-3});
    face.point.fields({nan});
    Load load = face.load_to({1e-3, 0});
    load.dpred = {nan};
    EXPECT_EQ(face.point.advance(load).stress[0], -3.0);
}

TEST(CohPressure, EnergyIsTheWorkOfTheTraction) {
    Interface face(keyword, flat, {-3, 0, 0, 0, 0.5}, 0.5);
    face.to({1e-3, 0});
    const double first = face.point.state(WORK);
    EXPECT_NEAR(first, -1.5 * 1e-3, 1e-17);  // the traction appears within the increment
    const Answer a = face.to({5e-3, 0.1});
    EXPECT_NEAR(entry(a, WORK) - first, -3 * 4e-3, 1e-16);
    EXPECT_NEAR(a.sse, entry(a, WORK) / 0.5, 1e-16);
    EXPECT_EQ(a.spd, 0.0);
    for (const int zero : {DN, DT, DAMN, DAMT, GI, GII, GDROP}) EXPECT_EQ(entry(a, zero), 0.0);
}

TEST(CohPressure, ExplicitIsImplicit) { check_explicit(keyword, {-3, 0.001, 0, 1e5, 0.3}, 0.01, 0.02); }

// --- 6: where it fails -------------------------------------------------------------------------------------------

TEST(CohPressure, RefusesByName) {
    expect_refused(keyword, {}, "needs at least 1 constants");
    expect_refused(keyword, {HUGE_VAL}, "SIGMA");
    expect_refused(keyword, {-3, std::nan("")}, "U_MIN");
    expect_refused(keyword, {-3, 0, HUGE_VAL}, "CHI");
    expect_refused(keyword, {-3, 0, 0, -1}, "K_C");
    expect_refused(keyword, {-3, 0, 0, 0, 0}, "T0");
}
TEST(CohPressure, NonsenseAsksForLess) {
    check_nonsense(keyword, {-3}, {0.01, 0.01});
    EXPECT_EQ(traction({0, 0, 1}, 1e-3).pnewdt, 1.0);
    Interface face(keyword, flat, {0, 0, 1});
    EXPECT_EQ(face.point.step({.dstran = {1e-3, 0}, .dpred = {HUGE_VAL}}).pnewdt, 0.25);
}
// The traction jumps at u_min and no stiffness is left on the open side.
TEST(CohPressure, JumpsWithoutStiffness) {
    Interface face(keyword, flat, {-3, 0.002, 0, 1e5});
    EXPECT_EQ(face.to({0.002, 0}).stress[0], 0.0);
    const Answer a = face.to({0.0020001, 0});
    EXPECT_EQ(a.stress[0], -3.0);
    EXPECT_EQ(a.tangent.cwiseAbs().maxCoeff(), 0.0);
    EXPECT_EQ(face.to({0, 0}).tangent(0, 0), 1e5);  // the closed crack is held
}

}  // namespace
}  // namespace lode::test::coh::test_coh_pressure
