// PORO_ISO: the verification cases of page 45, section 7, and the failures of section 6.
#include <limits>

#include "poro_support.hpp"

namespace lode::test::test_poro_iso {
namespace {

constexpr auto solid = AnalysisKind::solid;

// Data set I with more constants behind it.
Numbers set_i(Numbers more = {}) {
    Numbers props = {10000.0, 0.25, 0.8, 9000.0};
    props.insert(props.end(), more.begin(), more.end());
    return props;
}
UmatPoint point_i(AnalysisKind kind, Numbers more = {}) { return poro_point("PORO_ISO", kind, set_i(std::move(more))); }

TEST(PoroIso, DataSet) {
    UmatPoint point = point_i(solid);
    const Answer a = point.advance({});
    expect_close(a.tangent(0, 0), 12000.0);
    expect_close(point.state(STORAGE), 2.74285714285714e-4, 1e-14);
    expect_close(1.0 / point.state(STORAGE), 3645.83333333333, 1e-14);
    EXPECT_EQ(point.state(DT_P), 0.0);
    const Answer undrained = point_i(solid, {1}).advance({});
    expect_close(undrained.tangent(0, 0), 14333.3333333333, 1e-14);
    // The bulk modulus of C_u is the constant Ku (section 1).
    const Eigen::MatrixXd compliance = undrained.tangent.inverse();
    expect_close(1.0 / compliance.topLeftCorner<3, 3>().sum(), 9000.0, 1e-13);
}

TEST(PoroIso, PI1DrainedOedometerThenPressure) { expect_drained_oedometer(point_i(solid), 1e-14); }
TEST(PoroIso, PI2UndrainedOedometer) { expect_undrained_oedometer(point_i(solid, {1}), 1e-14); }
TEST(PoroIso, PI3Consolidation) { expect_consolidation(point_i(solid, {2}), 1e-14); }

TEST(PoroIso, PI4PlaneStrainUndrained) {
    UmatPoint point = point_i(AnalysisKind::plane_strain, {1});
    point.advance({.dstran = {1e-3, -2e-3, 0, 1e-3}});
    expect_stress(point.stress(), {1.66666666666667, -22.3333333333333, -6.33333333333333, 4}, 1e-14);
    expect_close(point.state(PE), 2.91666666666667, 1e-14);
}

TEST(PoroIso, PI5PlaneStressUndrained) {
    UmatPoint point = point_i(AnalysisKind::plane_stress, {1});
    const Load load{.dstran = {1e-3, -2e-3, 1e-3}};
    const Answer a = point.advance(load);
    expect_stress(point.stress(), {4.46511627906977, -19.5348837209302, 4}, 1e-14);
    expect_close(point.state(PE), 1.62790697674419, 1e-14);
    expect_close(point.state(EZZ), 4.41860465116279e-4, 1e-14);
    expect_close(a.tangent(0, 0), 11534.8837209302, 1e-14);
    expect_close(a.tangent(0, 1), 3534.88372093023, 1e-14);
    // The thickness strain that the explicit entry point returns.
    UmatPoint labelled = poro_point("PORO_ISO-PS", AnalysisKind::plane_stress, set_i({1}));
    expect_close(explicit_answer(labelled, load).thickness_strain_increment, 4.41860465116279e-4, 1e-14);
}

TEST(PoroIso, PI6Clip) {
    UmatPoint point = point_i(solid, {1, 1});
    const Numbers loaded = {-14.3333333333333, -6.33333333333333, -6.33333333333333, 0, 0, 0};
    point.advance({.dstran = {-1e-3, 0, 0, 0, 0, 0}});
    expect_stress(point.stress(), loaded, 1e-14);
    expect_close(point.state(PE), 2.91666666666667, 1e-14);
    const Answer suction = point.advance({.dstran = {3e-3, 0, 0, 0, 0, 0}});
    expect_stress(point.stress(), {24, 8, 8, 0, 0, 0}, 1e-14);
    expect_close(point.state(PE), -5.83333333333333, 1e-14);
    expect_close(suction.tangent(0, 0), 12000.0, 1e-14);
    point.advance({.dstran = {-3e-3, 0, 0, 0, 0, 0}});
    expect_stress(point.stress(), loaded, 1e-13);
}

TEST(PoroIso, PI7ThermalAndDarcy) {
    UmatPoint point = point_i(solid, {0, 0, 0, 1e-5, 1e-12, 1e-9});
    point.celent(2.0).advance({.dstran = {1e-3, 0, 0, 0, 0, 0}, .dtemp = 10.0, .dpred = {1.5}});
    expect_stress(point.stress(), {8.8, 0.8, 0.8, 0, 0, 0}, 1e-14);
    expect_close(point.state(THETA), 1.21142857142857e-3, 1e-13);
    for (const int i : {MOB1, MOB2, MOB3}) expect_close(point.state(i), 1e-3, 1e-14);
    expect_close(point.state(DT_P), 0.548571428571429, 1e-14);
}

TEST(PoroIso, PI8UndrainedHydrostaticStress) {
    UmatPoint point = point_i(solid, {1});
    point.advance({.dstran = {-1e-4, -1e-4, -1e-4, 0, 0, 0}});
    expect_stress(point.stress(), {-2.7, -2.7, -2.7, 0, 0, 0}, 1e-14);
    expect_close(point.state(PE), 0.875, 1e-14);
}

// Section 8.2.2 of the source: a load on a laterally confined layer, at once and after drainage.
TEST(PoroIso, UniaxialCompression) {
    const double load = -10.0;
    UmatPoint instant = point_i(solid, {1}), drained = point_i(solid);
    const double eps_u = load / instant.evaluate({}).tangent(2, 2), eps_d = load / drained.evaluate({}).tangent(2, 2);
    instant.advance({.dstran = {0, 0, eps_u, 0, 0, 0}});
    drained.advance({.dstran = {0, 0, eps_d, 0, 0, 0}});
    expect_close(instant.stress()[2], load, 1e-14);
    expect_close(drained.stress()[2], load, 1e-14);
    expect_close(instant.state(PE), -0.203488372093023 * load, 1e-14);
    expect_close(eps_d, 8.33333333333333e-5 * load, 1e-14);
    expect_close(eps_u / eps_d, 0.837209302325581, 1e-14);
}

// Section 6: QB of plane stress above 1, where a staggered update diverges.
TEST(PoroIso, StiffFluidInPlaneStress) {
    UmatPoint point = poro_point("PORO_ISO", AnalysisKind::plane_stress, {10000.0, 0.25, 0.8, 1e9, 1});
    for (int i = 0; i < 20; ++i) point.advance({.dstran = {1e-4, 2e-4, 0}});
    // Nearly incompressible: the thickness strain makes up for the area.
    expect_close(point.state(EZZ), -6e-3, 1e-5);
    expect_close(point.sse(), 0.5 * (point.stress()[0] * 2e-3 + point.stress()[1] * 4e-3), 1e-12);
}

// SSE = solid + fluid, with the fluid that the host lets in (section 5).
TEST(PoroIso, EnergyOfSolidAndFluid) {
    UmatPoint point = point_i(solid, {0, 0, 0.5});
    point.fields({0.5}).advance({.dstran = {1e-3, -2e-3, 5e-4, 1e-3, 0, 0}, .dpred = {2.0}});
    const Numbers& s = point.stress();
    const double carried = 0.8 * 2.0, squares = std::pow(s[0] + carried, 2) + std::pow(s[1] + carried, 2) +
                                                std::pow(s[2] + carried, 2) + 2.0 * s[3] * s[3];
    const double sum = s[0] + s[1] + s[2] + 3.0 * carried;
    const double expected = (1.25 * squares - 0.25 * sum * sum) / 20000.0 + 0.5 * 4.0 / 3645.8333333333333;
    expect_close(point.sse(), expected, 1e-13);
    // The trapezoid rule of the page.
    const Numbers e = {1e-3, -2e-3, 5e-4, 1e-3, 0, 0};
    double work = 0.0;
    for (std::size_t i = 0; i < 6; ++i) work += 0.5 * s[i] * e[i];
    expect_close(point.sse(), work + 0.5 * 2.0 * (0.8 * -5e-4 + 2.0 / 3645.8333333333333), 1e-12);
}

// Reference pressure: what counts are changes.
TEST(PoroIso, ReferencePressure) {
    UmatPoint point = point_i(solid, {1, 0, 100.0});
    point.advance({.dstran = {0, 0, -1e-3, 0, 0, 0}});
    expect_close(point.state(PE), 2.91666666666667, 1e-13);
    expect_close(point.stress()[2], -14.3333333333333, 1e-13);
}

TEST(PoroIso, NoFieldVariableMeansNoPressure) {
    UmatPoint point = point_i(solid);
    VumatBlock block(point);
    VumatPoint p = block.fresh_point();
    p.strain_increment = {0, 0, -1e-3, 0, 0, 0};
    p.fields_old = p.fields_new = {};
    block.points.assign(11, p);
    ASSERT_EQ(block.run().stops, 0);
    expect_stress(block.points[9].stress, {-4, -4, -12, 0, 0, 0}, 1e-14);
    EXPECT_EQ(block.points[9].state[PE - 1], 0.0);
}

TEST(PoroIso, UndrainedReadsNoField) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    UmatPoint point = point_i(solid, {1});
    point.fields({nan}).advance({.dstran = {0, 0, -1e-3, 0, 0, 0}, .dpred = {nan}});
    expect_close(point.state(PE), 2.91666666666667, 1e-14);
    for (const double mode : {0.0, 2.0}) {
        UmatPoint reader = point_i(solid, {mode});
        EXPECT_TRUE(reader.evaluate({.dpred = {nan}}).cut);
    }
}

TEST(PoroIso, UnknownElementLengthHasNoTimeStep) {
    for (const double celent : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
        UmatPoint point = point_i(solid, {0, 0, 0, 0, 1e-12, 1e-9});
        point.celent(celent).advance({});
        EXPECT_EQ(point.state(DT_P), 0.0);
    }
}

TEST(PoroIso, BadConstants) {
    expect_refused("PORO_ISO-A", {10000, 0.25, 0.8, 6600}, {"PORO_ISO-A", "PROPS(4)", "6666.66666667"});
    expect_refused("PORO_ISO-A", {10000, 0.25, 0.8, 20000.0 / 3.0}, {"PROPS(4)"});
    expect_refused("PORO_ISO-A", {10000, 0.5, 0.8, 9000}, {"PROPS(2)", "(-1, 0.5)"});
    expect_refused("PORO_ISO-A", {10000, 0.25, 0.0, 9000}, {"PROPS(3)", "(0, 1]"});
    expect_refused("PORO_ISO-A", {10000, 0.25, 1.1, 9000}, {"PROPS(3)"});
    expect_refused("PORO_ISO-A", set_i({3}), {"PROPS(5)"});
    expect_refused("PORO_ISO-A", set_i({0, 0, 0, 0, -1e-12}), {"PROPS(9)"});
    expect_refused("PORO_ISO-A", set_i({0, 0, 0, 0, 1e-12, 0}), {"PROPS(10)"});
}

}  // namespace
}  // namespace lode::test::test_poro_iso
