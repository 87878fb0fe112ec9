// POROUS_<KEYWORD>: the verification cases of page 45 that concern the wrapper, and what it refuses.
#include <limits>

#include "poro_support.hpp"

namespace lode::test::test_porous {
namespace {

constexpr auto solid = AnalysisKind::solid;

// Data set I around another solid; `options` are mode, clip, p0.
Numbers pores(double mode, double clip, double p0, const Numbers& constants, double alpha = 0.8) {
    Numbers props = {alpha, alpha, alpha, 3645.83333333333, 0, 0, 0, mode, clip, p0, 0, 0, 0, 1};
    props.insert(props.end(), constants.begin(), constants.end());
    return props;
}
UmatPoint porous_elastic(double mode, double clip = 0.0) {
    return poro_point("POROUS_ISO_ELASTIC", solid, pores(mode, clip, 0.0, {10000.0, 0.25}));
}

TEST(Porous, PW1DrainedIsPI1) {
    LODE_NEEDS("ISO_ELASTIC");
    expect_drained_oedometer(porous_elastic(0), 1e-13);
}
TEST(Porous, PW1UndrainedIsPI2) {
    LODE_NEEDS("ISO_ELASTIC");
    expect_undrained_oedometer(porous_elastic(1), 1e-13);
}
TEST(Porous, PW1TransportIsPI3) {
    LODE_NEEDS("ISO_ELASTIC");
    expect_consolidation(porous_elastic(2), 1e-13);
}

TEST(Porous, PW1ClipIsPI6) {
    LODE_NEEDS("ISO_ELASTIC");
    UmatPoint point = porous_elastic(1, 1);
    const Numbers loaded = {-14.3333333333333, -6.33333333333333, -6.33333333333333, 0, 0, 0};
    point.advance({.dstran = {-1e-3, 0, 0, 0, 0, 0}});
    expect_stress(point.stress(), loaded, 1e-13);
    const Answer suction = point.advance({.dstran = {3e-3, 0, 0, 0, 0, 0}});
    expect_stress(point.stress(), {24, 8, 8, 0, 0, 0}, 1e-13);
    expect_close(point.state(PE), -5.83333333333333, 1e-13);
    expect_close(suction.tangent(0, 0), 12000.0, 1e-13);
    point.advance({.dstran = {-3e-3, 0, 0, 0, 0, 0}});
    expect_stress(point.stress(), loaded, 1e-13);
}

// The first sample of every solid that has a porous version.
struct Wrapped {
    const lode_model* model;
    std::string name;
    Numbers constants;
    double strain;
    AnalysisKind kind;
};
std::vector<Wrapped> wrapped_solids() {
    std::vector<Wrapped> all;
    for (int i = 0; i < lode_model_count(); ++i) {
        const lode_model* porous = lode_model_at(i);
        const std::string keyword = porous->keyword;
        if (keyword.rfind("POROUS_", 0) != 0) continue;
        const lode_sample& s = porous->samples[0];
        all.push_back({find_model(keyword.substr(7)),
                       keyword.substr(7),
                       {s.constants + 14, s.constants + s.constant_count},
                       s.strain_scale,
                       (s.kinds & LODE_SOLID) != 0 ? solid : AnalysisKind::plane_strain});
    }
    return all;
}
// Loading well into the inelastic range, unloading, shear.
std::vector<Numbers> path(const Wrapped& w) {
    std::vector<Numbers> steps;
    const auto n = static_cast<std::size_t>(components(w.kind));
    for (int i = 0; i < 24; ++i) {
        Numbers e(n, 0.0);
        const double h = 0.1 * w.strain * (i < 12 ? 1.0 : i < 16 ? -1.0 : 1.5);
        e[0] = h, e[1] = -0.4 * h, e[2] = 0.1 * h;
        e[3] = i % 3 == 0 ? 0.7 * h : 0.0;
        steps.push_back(e);
    }
    return steps;
}

TEST(Porous, PW2WithoutBiotCoefficientsTheSolidIsBare) {
    for (const Wrapped& w : wrapped_solids()) {
        SCOPED_TRACE(w.name);
        UmatPoint bare = poro_point(w.name.c_str(), w.kind, w.constants);
        UmatPoint porous = poro_point(("POROUS_" + w.name).c_str(), w.kind, pores(1, 0, 3.0, w.constants, 0.0));
        for (const Numbers& e : path(w)) {
            bare.step({.dstran = e});
            porous.step({.dstran = e});
            for (std::size_t i = 0; i < e.size(); ++i) EXPECT_EQ(porous.stress()[i], bare.stress()[i]);
            const Numbers solid_state(porous.state().begin() + 18, porous.state().end());
            EXPECT_TRUE(identical(solid_state, bare.state()));
        }
        EXPECT_EQ(porous.spd(), bare.spd());
    }
}

TEST(Porous, PW3OnlyThePressureAboveTheReferenceCounts) {
    for (const Wrapped& w : wrapped_solids()) {
        SCOPED_TRACE(w.name);
        const std::string name = "POROUS_" + w.name;
        UmatPoint a = poro_point(name.c_str(), w.kind, pores(0, 0, 0.0, w.constants));
        UmatPoint b = poro_point(name.c_str(), w.kind, pores(0, 0, 8.0, w.constants));
        a.fields({2.0}), b.fields({10.0});
        for (const Numbers& e : path(w)) {
            a.step({.dstran = e, .dpred = {0.25}});
            b.step({.dstran = e, .dpred = {0.25}});
            EXPECT_TRUE(identical(a.stress(), b.stress()));
        }
    }
}

TEST(Porous, PW4ConstantPressureShiftsTheStress) {
    for (const Wrapped& w : wrapped_solids()) {
        SCOPED_TRACE(w.name);
        const double p = w.name == "CAM_CLAY" ? 10.0 : 0.5, alpha = 0.8;
        UmatPoint bare = poro_point(w.name.c_str(), w.kind, w.constants);
        UmatPoint porous = poro_point(("POROUS_" + w.name).c_str(), w.kind, pores(0, 0, 0.0, w.constants));
        const auto normals = static_cast<std::size_t>(normal_components(w.kind));
        Numbers start(static_cast<std::size_t>(components(w.kind)), 0.0), shifted = start;
        if (w.name == "CAM_CLAY")
            for (std::size_t i = 0; i < normals; ++i) start[i] = -100.0;
        for (std::size_t i = 0; i < start.size(); ++i) shifted[i] = start[i] - (i < normals ? alpha * p : 0.0);
        bare.stress(start);
        porous.stress(shifted).fields({p});
        double scale = 0.0;
        for (const Numbers& e : path(w)) {
            const Answer a = bare.step({.dstran = e}), b = porous.step({.dstran = e});
            ASSERT_EQ(a.done(), b.done());
            scale = std::max({scale, largest(bare.stress()), p});
            // Adding and taking off alpha p rounds; softening laws amplify what the strength is compared with.
            for (std::size_t i = 0; i < start.size(); ++i)
                EXPECT_NEAR(porous.stress()[i] + (i < normals ? alpha * p : 0.0), bare.stress()[i], 1e-10 * scale);
        }
    }
}

// Section 4, step 3: the opening of a crack is not pore volume.
TEST(Porous, CracksTakeNoPoreVolume) {
    for (const Wrapped& w : wrapped_solids()) {
        if (w.name.find("SOFTENING") == std::string::npos && w.name != "ELASTIC_DECOHESIVE") continue;
        SCOPED_TRACE(w.name);
        UmatPoint point = poro_point(("POROUS_" + w.name).c_str(), w.kind, pores(1, 0, 0.0, w.constants));
        UmatPoint bare = poro_point(w.name.c_str(), w.kind, w.constants);
        const Eigen::MatrixXd compliance = bare.evaluate({}).tangent.inverse();
        Numbers e(static_cast<std::size_t>(components(w.kind)), 0.0);
        e[0] = 0.05 * w.strain;
        double total = 0.0;
        for (int i = 0; i < 60; ++i)
            if (point.step({.dstran = e}).done()) total += e[0];
        ASSERT_GT(point.spd(), 0.0);
        // What is left of the volume is that of the solid stress, h . sigma_s with h = S alpha.
        double elastic = 0.0;
        for (Eigen::Index i = 0; i < point.size(); ++i)
            for (Eigen::Index j = 0; j < point.normals(); ++j)
                elastic +=
                    0.8 * compliance(i, j) *
                    (point.stress()[static_cast<std::size_t>(i)] + (i < point.normals() ? 0.8 * point.state(PE) : 0.0));
        EXPECT_NEAR(-point.state(PE) / 3645.83333333333, elastic, 1e-10 * total);
        EXPECT_LT(elastic, 0.7 * total);
    }
}

TEST(Porous, Refusals) {
    LODE_NEEDS("ISO_ELASTIC");
    const Numbers good = pores(0, 0, 0.0, {10000.0, 0.25});
    expect_refused("POROUS_NO_SUCH_MODEL", good, {"POROUS_NO_SUCH_MODEL"});
    expect_refused("POROUS_PORO_ISO", good, {"POROUS_PORO_ISO"});
    expect_refused("POROUS_POROUS_ISO_ELASTIC", good, {"POROUS_POROUS_ISO_ELASTIC"});
    expect_refused("POROUS_COH_LINEAR", good, {"POROUS_COH_LINEAR"});
    expect_refused("POROUS_NEO_HOOKEAN", good, {"POROUS_NEO_HOOKEAN"});
    Numbers props = good;
    props[0] = 1.5;
    expect_refused("POROUS_ISO_ELASTIC-A", props, {"POROUS_ISO_ELASTIC-A", "PROPS(1)", "[0, 1]"});
    props = good;
    props[3] = 0.0;
    expect_refused("POROUS_ISO_ELASTIC-A", props, {"PROPS(4)", "> 0"});
    props = good;
    props[10] = -1.0;
    expect_refused("POROUS_ISO_ELASTIC-A", props, {"PROPS(11)"});
    props = good;
    props[13] = 0.0;
    expect_refused("POROUS_ISO_ELASTIC-A", props, {"PROPS(14)"});
    props = good;
    props[15] = 0.6;
    expect_refused("POROUS_ISO_ELASTIC-A", props, {"PROPS(16)", "NU"});
    // A law of the deformation gradient alone.
    expect_refused("POROUS_ISO_ELASTIC-A", pores(0, 0, 0.0, {10000.0, 0.25, 0, 0, 1}), {"PROPS(19)", "KIN"});
    char error[512] = "";
    for (const auto& [ndi, nshr] : {std::pair{2, 1}, std::pair{1, 0}})
        EXPECT_EQ(lode_required_state("POROUS_ISO_ELASTIC", good.data(), 16, ndi, nshr, error, sizeof error), -1);
    EXPECT_EQ(lode_required_state("POROUS_ISO_ELASTIC", good.data(), 16, 3, 1, error, sizeof error), 22);
}

// Relations between constants of the solid are refused with their place in the whole list.
TEST(Porous, RefusalsOfTheSolidCountAllConstants) {
    LODE_NEEDS("ORTHO_ELASTIC");
    expect_refused("POROUS_ORTHO_ELASTIC-A",
                   pores(0, 0, 0.0, {12000.0, 900.0, 500.0, 5.0, 0.5, 0.6, 800.0, 700.0, 60.0}),
                   {"POROUS_ORTHO_ELASTIC-A", "PROPS(18)"});
    expect_refused("POROUS_ORTHO_ELASTIC-A",
                   pores(0, 0, 0.0, {1000.0, 1000.0, 1000.0, 0.7, 0.7, 0.7, 800.0, 700.0, 60.0}),
                   {"counting PROPS from PROPS(15)", "positive definite"});
}

TEST(Porous, WhatTheSolidCannotDoIsLeftAlone) {
    LODE_NEEDS("CAM_CLAY");
    // Beyond the largest strain increment of the clay: a smaller one is asked for, nothing has changed.
    UmatPoint point =
        poro_point("POROUS_CAM_CLAY", solid, pores(1, 0, 0.0, {100.0, 0.02, 0.1, 1.2, 3000.0, 0.0, 120.0}));
    point.advance({.dstran = {-1e-3, 0, 0, 0, 0, 0}});
    const Answer a = point.evaluate({.dstran = {-0.9, 0, 0, 0, 0, 0}});
    EXPECT_TRUE(a.cut);
    EXPECT_TRUE(identical(a.stress, point.stress()));
    EXPECT_TRUE(identical(a.state, point.state()));
}

TEST(Porous, ThePressureMustBeANumber) {
    LODE_NEEDS("ISO_ELASTIC");
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(porous_elastic(0).evaluate({.dpred = {nan}}).cut);
    EXPECT_TRUE(porous_elastic(1).evaluate({.dpred = {nan}}).done());
}

// Undrained triaxial compression of clay: the pressure follows from constant volume, the effective path is the solid's.
TEST(Porous, UndrainedClay) {
    LODE_NEEDS("CAM_CLAY");
    const Numbers clay = {100.0, 0.02, 0.1, 1.2, 3000.0, 0.0, 100.0};
    Numbers props = {1, 1, 1, 1e9, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1};
    props.insert(props.end(), clay.begin(), clay.end());
    UmatPoint porous = poro_point("POROUS_CAM_CLAY", solid, props), bare = poro_point("CAM_CLAY", solid, clay);
    const Numbers start = {-100, -100, -100, 0, 0, 0};
    porous.stress(start), bare.stress(start);
    for (int i = 0; i < 50; ++i) {
        const Load load{.dstran = {-1e-3, 5e-4, 5e-4, 0, 0, 0}};
        porous.advance(load);
        bare.advance(load);
    }
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(porous.stress()[i] + porous.state(PE), bare.stress()[i], 1e-9 * 100.0);
}

}  // namespace
}  // namespace lode::test::test_porous
