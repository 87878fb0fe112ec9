// PORO_TRANSISO: the verification cases of page 45, section 7.
#include "poro_support.hpp"

namespace lode::test::test_poro_transiso {
namespace {

Numbers set_t(Numbers more = {}) {
    Numbers props = {20000.0, 9000.0, 0.18, 0.30, 5200.0, 0.60, 0.80, 14000.0};
    props.insert(props.end(), more.begin(), more.end());
    return props;
}
UmatPoint point_t(AnalysisKind kind, Numbers more = {}) {
    return poro_point("PORO_TRANSISO", kind, set_t(std::move(more)));
}
constexpr auto solid = AnalysisKind::solid;

TEST(PoroTransiso, PT1) {
    UmatPoint point = point_t(solid);
    point.advance({.dstran = general_strain, .dpred = {2.0}});
    expect_stress(point.stress(), {7.42928819436, -2.95532719025, 4.18131298074, 3.46153846154, 0, 2.6});
    expect_close(point.state(THETA), 6.59908275639e-4);
    expect_close(point.state(DP_UD), -7.43344162631);
    expect_close(1.0 / point.state(STORAGE), 14295.0800505984, 1e-13);
}

TEST(PoroTransiso, PT2) {
    UmatPoint point = point_t(solid, {3, 0, 0, 0, 1});
    const Answer a = point.advance({.dstran = general_strain});
    const Numbers expected = {14.9760414954, 4.5914261108, 9.84137795653, 3.46153846154, 0, 2.6};
    expect_stress(point.stress(), expected);
    expect_close(point.state(PE), -7.43344162631);
    // The bulk modulus of C_u is the constant Ku (section 1).
    expect_close(1.0 / a.tangent.inverse().topLeftCorner<3, 3>().sum(), 14000.0, 1e-12);
    expect_stress(explicit_answer(point_t(solid, {3, 0, 0, 0, 1}), {.dstran = general_strain}).stress, expected);
}

TEST(PoroTransiso, PT3) {
    UmatPoint point = point_t(solid, {1, 30, 0, 0, 1});
    point.advance({.dstran = general_strain});
    const Numbers expected = {22.12957301, 3.58796588787, 6.76161047098, 7.74750649575, 0.376387963952, 1.94807692308};
    expect_stress(point.stress(), expected);
    expect_close(point.state(PE), -4.98036957472);
    expect_stress(explicit_answer(point_t(solid, {1, 30, 0, 0, 1}), {.dstran = general_strain}).stress, expected);
}

TEST(PoroTransiso, PT4) {
    UmatPoint point = point_t(AnalysisKind::plane_stress, {1, 30, 0, 0, 1});
    point.advance({.dstran = plane_strain});
    expect_stress(point.stress(), {18.6098064411, -0.477604402608, 8.2201863841});
    expect_close(point.state(PE), -0.977645740914);
    expect_close(point.state(EZZ), -1.50008868404e-4);
}

TEST(PoroTransiso, PT5) {
    UmatPoint point = point_t(AnalysisKind::plane_strain, {1, 30, 0, 0, 2});
    point.advance({.dstran = {1e-3, -5e-4, 0, 1e-3}, .dpred = {1.0}});
    expect_stress(point.stress(), {19.4683287893, 0.51484172875, 2.09793095805, 8.1042049857});
    expect_close(point.state(PE), -1.69315676662);
    expect_close(point.state(THETA), 6.99541378195e-5);
}

// The axis may be any of the three: the same solid in other words.
TEST(PoroTransiso, AxisAndAnglesAreEquivalent) {
    UmatPoint axis = point_t(solid, {1, 0, 0, 0, 1}), turned = point_t(solid, {3, 0, 90, 0, 1});
    axis.advance({.dstran = general_strain});
    turned.advance({.dstran = general_strain});
    expect_stress(turned.stress(), axis.stress(), 1e-13);
    expect_close(turned.state(PE), axis.state(PE), 1e-13);
}

TEST(PoroTransiso, BadConstants) {
    Numbers props = set_t();
    props[7] = 5897.0;
    expect_refused("PORO_TRANSISO-A", props, {"PORO_TRANSISO-A", "PROPS(8)", "5897.7719528"});
    props[7] = 336325.0;
    expect_refused("PORO_TRANSISO-A", props, {"PROPS(8)", "336324.6079"});
    props[7] = 336324.0;
    EXPECT_EQ(lode_required_state("PORO_TRANSISO-A", props.data(), 8, 3, 3, nullptr, 0), 18);
    props = set_t();
    props[5] = props[6] = 0.0;
    expect_refused("PORO_TRANSISO-A", props, {"PROPS(6)", "0"});
    props = set_t();
    props[2] = 1.0;
    expect_refused("PORO_TRANSISO-A", props, {"PROPS(3)"});
    props = set_t();
    props[5] = 1.01;
    expect_refused("PORO_TRANSISO-A", props, {"PROPS(6)", "[0, 1]"});
}

// No upper bound of Ku where all Biot coefficients are equal.
TEST(PoroTransiso, EqualCoefficientsHaveNoUpperBound) {
    UmatPoint point =
        poro_point("PORO_TRANSISO", solid, {20000.0, 9000.0, 0.18, 0.30, 5200.0, 0.7, 0.7, 1e9, 3, 0, 0, 0, 1});
    const Answer a = point.advance({});
    expect_close(1.0 / a.tangent.inverse().topLeftCorner<3, 3>().sum(), 1e9, 1e-6);
}

TEST(PoroTransiso, TiltedAxesInThePlane) {
    UmatPoint point = point_t(AnalysisKind::plane_strain, {1, 30, 20, 0, 1});
    const Answer a = point.evaluate({.dstran = {1e-3, 0, 0, 0}});
    EXPECT_EQ(a.messages.stops, 1);
    EXPECT_NE(a.first_error().find("normal to the plane"), std::string::npos) << a.first_error();
}

}  // namespace
}  // namespace lode::test::test_poro_transiso
