// PORO_ORTHO: the verification cases of page 45, section 7.
#include "poro_support.hpp"

namespace lode::test::test_poro_ortho {
namespace {

Numbers set_o(Numbers more = {}) {
    Numbers props = {18000.0, 11000.0, 7000.0, 0.25, 0.30, 0.28, 5000.0, 4200.0, 3600.0, 0.55, 0.70, 0.85, 12000.0};
    props.insert(props.end(), more.begin(), more.end());
    return props;
}
UmatPoint point_o(AnalysisKind kind, Numbers more = {}) {
    return poro_point("PORO_ORTHO", kind, set_o(std::move(more)));
}
constexpr auto solid = AnalysisKind::solid;

TEST(PoroOrtho, PO1) {
    UmatPoint point = point_o(solid);
    point.advance({.dstran = {0, 0, -1e-3, 0, 0, 0}, .dpred = {2.0}});
    expect_stress(point.stress(), {-4.10959358573, -4.05034029734, -9.52336170465, 0, 0, 0});
    expect_close(point.state(THETA), -6.75381990533e-4);
    expect_close(point.state(DP_UD), 9.73553647293);
    expect_close(1.0 / point.state(STORAGE), 11453.5723211);
    // 1/a of (8.35), the drained constrained modulus along axis 3.
    expect_close(1.0 / point.evaluate({}).tangent(2, 2), 1.27822288902433e-4, 1e-13);
}

TEST(PoroOrtho, PO2) {
    UmatPoint point = point_o(solid, {0, 0, 0, 1});
    const Answer a = point.advance({.dstran = general_strain});
    const Numbers expected = {20.8659053829, 1.20797395971, 6.85124427297, 5, 0, 1.8};
    expect_stress(point.stress(), expected);
    expect_close(point.state(PE), -4.2378217588);
    expect_close(1.0 / a.tangent.inverse().topLeftCorner<3, 3>().sum(), 12000.0, 1e-12);
    expect_stress(explicit_answer(point_o(solid, {0, 0, 0, 1}), {.dstran = general_strain}).stress, expected);
}

TEST(PoroOrtho, PO3) {
    UmatPoint point = point_o(AnalysisKind::plane_stress, {75, 0, 0, 1});
    point.advance({.dstran = plane_strain});
    expect_stress(point.stress(), {11.0297869399, -4.14182937743, 4.9504586365});
    expect_close(point.state(PE), -1.3040455649);
    expect_close(point.state(EZZ), -3.04203455915e-4);
}

TEST(PoroOrtho, PO4) {
    UmatPoint point = point_o(solid, {33, 44, 55, 1});
    point.advance({.dstran = general_strain});
    const Numbers expected = {15.3032924528, 2.9297563006, 8.71143378615, 4.56319318633, -1.65838920632, 1.24829471132};
    expect_stress(point.stress(), expected);
    expect_close(point.state(PE), -4.89887806364);
    expect_stress(explicit_answer(point_o(solid, {33, 44, 55, 1}), {.dstran = general_strain}).stress, expected);
}

TEST(PoroOrtho, MobilityOfEachAxis) {
    UmatPoint point = point_o(solid, {0, 0, 0, 0, 0, 0, 0, 0, 0, 1e-12, 4e-12, 2e-12, 1e-9});
    point.celent(3.0).advance({});
    expect_close(point.state(MOB1), 1e-3, 1e-14);
    expect_close(point.state(MOB2), 4e-3, 1e-14);
    expect_close(point.state(MOB3), 2e-3, 1e-14);
    expect_close(point.state(DT_P), 9.0 * point.state(STORAGE) / (2.0 * 4e-3), 1e-14);
}

TEST(PoroOrtho, BadConstants) {
    Numbers props = set_o();
    props[12] = 5000.0;
    expect_refused("PORO_ORTHO-A", props, {"PORO_ORTHO-A", "PROPS(13)", "5640.1074306"});
    // Ku_max = K ha/(ha - K hii^2).
    const double K = 5640.10743061773, hii = 1.35471500721501e-4, ha = 1.07996608946609e-4;
    const double most = K * ha / (ha - K * hii * hii);
    props[12] = most * (1.0 + 1e-9);
    expect_refused("PORO_ORTHO-A", props, {"PROPS(13)", "below " + std::to_string(static_cast<int>(most))});
    props[12] = most * (1.0 - 1e-9);
    EXPECT_EQ(lode_required_state("PORO_ORTHO-A", props.data(), 13, 3, 3, nullptr, 0), 18);
    props = set_o();
    props[9] = props[10] = props[11] = 0.0;
    expect_refused("PORO_ORTHO-A", props, {"PROPS(10)"});
    props = set_o();
    props[3] = 1.5;
    expect_refused("PORO_ORTHO-A", props, {"PROPS(4)"});
    props = set_o();
    props[3] = props[4] = props[5] = 0.7;
    expect_refused("PORO_ORTHO-A", props, {"positive definite"});
    expect_refused("PORO_ORTHO-A", set_o({0, 0, 0, 0, 0, 0, 0, 0, 0, -1.0}), {"PROPS(23)"});
}

}  // namespace
}  // namespace lode::test::test_poro_ortho
