// BISTABLE_ISO against the verification cases of page 10, section 5, its failure modes and its refusals.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "large_rotation.hpp"
#include "vumat_block.hpp"

namespace lode::test::test_bistable_iso {
namespace {

using enum AnalysisKind;

const Numbers B = {1000.0, 600.0, 700.0, 300.0, 1.0, 0.02, 0.015};
const Numbers B4 = {1000.0, 600.0, 1000.0, 150.0, 2.0, 0.01, 0.0, 1.0};

Numbers with(Numbers props, const Numbers& more) {
    props.insert(props.end(), more.begin(), more.end());
    return props;
}
UmatPoint material(AnalysisKind kind, const Numbers& props) { return UmatPoint("BISTABLE_ISO-TEST", kind, props); }
int state(const UmatPoint& point) { return static_cast<int>(point.state(1)); }
int transitions(const UmatPoint& point) { return static_cast<int>(point.state(10)); }
Numbers shear(double gamma) { return {0, 0, 0, gamma, 0, 0}; }
// Short decimal numbers: exact but for rounding.
void expect_exact(const Numbers& actual, const Numbers& page) { expect_digits(actual, page, 2e-14); }

TEST(BistableIso, B1_DilationInTheSolid) {
    UmatPoint point = material(solid, B);
    expect_exact(point.advance({.dstran = {.01, .005, 0, .004, 0, 0}}).stress, {21, 15, 9, 2.4, 0, 0});
    EXPECT_EQ(state(point), 0);
    expect_exact(point.advance({.dstran = {.006, 0, 0, 0, 0, 0}}).stress, {9.6, 3, 0, 1.2, 0, 0});
    EXPECT_EQ(state(point), 1);
    expect_exact(point.advance({.dstran = {-.012, 0, 0, 0, 0, 0}}).stress, {-3.6, -3, -6, 1.2, 0, 0});
    EXPECT_EQ(state(point), 1);
    EXPECT_EQ(transitions(point), 1);
    expect_exact({point.state().begin() + 1, point.state().begin() + 7}, {.004, .005, 0, .004, 0, 0});
}

TEST(BistableIso, B2_ReversibleWithHeat) {
    UmatPoint point = material(plane_strain, with(B, {1, 1e-4, 5e-5}));
    expect_exact(point.advance({.dstran = {.01, .005, 0, .004}, .dtemp = 10.0}).stress, {18, 12, 6, 2.4});
    EXPECT_EQ(state(point), 0);
    expect_exact(point.advance({.dstran = {.006, 0, 0, 0}}).stress, {8.55, 1.95, -1.05, 1.2});
    EXPECT_EQ(state(point), 1);
    expect_exact(point.advance({.dstran = {-.012, 0, 0, 0}}).stress, {7.2, 8.4, 2.4, 2.4});
    EXPECT_EQ(state(point), 0);
    EXPECT_EQ(transitions(point), 2);
    EXPECT_EQ(point.state(8), 10.0);
}

TEST(BistableIso, B3_HysteresisInPlaneStress) {
    UmatPoint point = material(plane_stress, with(B, {1}));
    const auto stretch = [&](double e) { return point.advance({.dstran = {e, e, 0}}).stress; };
    expect_digits(stretch(.02), {17.1818181818, 17.1818181818, 0});
    EXPECT_EQ(state(point), 1);
    EXPECT_NEAR(point.state(4), -0.00863636363636, 5e-15);
    expect_digits(stretch(.01), {28.6363636364, 28.6363636364, 0});
    EXPECT_EQ(state(point), 1);
    EXPECT_NEAR(point.state(4), -0.0177272727273, 5e-14);
    expect_digits(stretch(-.015), {11.4545454545, 11.4545454545, 0});
    EXPECT_EQ(state(point), 1);
    EXPECT_NEAR(point.state(4), -0.00409090909091, 5e-15);
    expect_digits(stretch(-.01), {10, 10, 0});
    EXPECT_EQ(state(point), 0);
    EXPECT_NEAR(point.state(4), -0.00333333333333, 5e-15);
}

TEST(BistableIso, B4_DistortionExactly) {
    UmatPoint point = material(solid, B4);
    const Answer first = point.advance({.dstran = shear(.03)});
    expect_exact(first.stress, shear(13.5));
    EXPECT_EQ(state(point), 1);
    // One event at xi = 2/3: sqrt(e : e/2) = gamma/2 = 0.01.
    EXPECT_NEAR(first.tangent(3, 3), 150.0, 1e-11);
    EXPECT_NEAR(first.tangent(4, 4), 450.0, 1e-11);
    EXPECT_NEAR(first.tangent(0, 0), 1600.0, 1e-11);
    EXPECT_NEAR(first.tangent(0, 1), 700.0, 1e-11);
    expect_exact(point.advance({.dstran = shear(.02)}).stress, shear(16.5));
    EXPECT_EQ(state(point), 1);
    expect_exact(point.advance({.dstran = shear(-.1)}).stress, shear(-16.5));
    EXPECT_EQ(state(point), 1);
    EXPECT_EQ(transitions(point), 3);
}

TEST(BistableIso, B5_DistortionInOneStep) {
    UmatPoint point = material(solid, with(B4, {0, 0, 0, 0, 0}));
    const Answer first = point.advance({.dstran = shear(.03)});
    expect_exact(first.stress, shear(18));
    EXPECT_EQ(state(point), 1);
    // The whole increment was made in the old slope.
    EXPECT_NEAR(first.tangent(3, 3), 600.0, 1e-11);
    expect_exact(point.advance({.dstran = shear(.02)}).stress, shear(21));
    expect_exact(point.advance({.dstran = shear(-.1)}).stress, shear(6));
    EXPECT_EQ(state(point), 1);
    EXPECT_EQ(transitions(point), 1);
}

TEST(BistableIso, B6_VonMisesInOneDimension) {
    UmatPoint point = material(uniaxial, {1000, 600, 500, 300, 3, 20, 0, 0});
    expect_exact(point.advance({.dstran = {.01}}).stress, {15});
    EXPECT_EQ(state(point), 0);
    expect_exact(point.advance({.dstran = {.01}}).stress, {25});
    EXPECT_EQ(state(point), 1);
    expect_exact(point.advance({.dstran = {-.02}}).stress, {10});
    EXPECT_EQ(state(point), 1);
}

// One step is of first order: the error of an increment with a transition is at most |C0 - C1| |de|.
TEST(BistableIso, OneStepIsOfFirstOrder) {
    for (const int increments : {1, 10, 100}) {
        UmatPoint point = material(solid, with(B4, {0, 0, 0, 0, 0}));
        for (int i = 0; i < increments; ++i) point.advance({.dstran = shear(.03 / increments)});
        const double bound = (600.0 - 150.0) * .03 / increments;
        EXPECT_LE(std::abs(point.stress()[3] - 13.5), bound * (1.0 + 1e-9));
        EXPECT_GT(std::abs(point.stress()[3] - 13.5), 0.0);
    }
}

// The jump of rule 1 at the critical dilation: KD (crit - dV) - K0 crit in the mean stress.
TEST(BistableIso, MeanStressJumps) {
    UmatPoint point = material(solid, B);
    const double third = 0.02 / 3.0;
    const Numbers below = point.advance({.dstran = Numbers{third, third, third * (1.0 - 1e-9), 0, 0, 0}}).stress;
    EXPECT_EQ(state(point), 0);
    const Answer after = point.advance({.dstran = {0, 0, third * 2e-9, 0, 0, 0}});
    EXPECT_EQ(state(point), 1);
    EXPECT_FALSE(after.cut);
    EXPECT_NEAR(after.stress[0] - below[0], 700.0 * (0.02 - 0.015) - 1000.0 * 0.02, 1e-6);
}

// Plane stress with dV < 0: state 0 has too much volume and state 1 too little. It goes to state 1 and stays.
TEST(BistableIso, NoAdmissibleStateIsTheDeformedOne) {
    Numbers props = with(B, {1});
    props[6] = -0.015;
    UmatPoint point = material(plane_stress, props);
    point.advance({.dstran = {.016, .016, 0}});
    // The volumes that the two laws give: above and below the critical one.
    const double lambda_0 = 1000.0 - 400.0, lambda_1 = 700.0 - 200.0;
    EXPECT_GT(.032 - lambda_0 / (lambda_0 + 1200.0) * .032, 0.02);
    const double f = -0.005;
    EXPECT_LT(.032 + f - lambda_1 / (lambda_1 + 600.0) * (.032 - 2.0 * f), 0.02);
    EXPECT_EQ(state(point), 1);
    for (int i = 0; i < 5; ++i) point.advance({});
    EXPECT_EQ(state(point), 1);
    EXPECT_EQ(transitions(point), 1);
}

// Rules 2 and 3 are not elastic: a closed strain loop leaves stress.
TEST(BistableIso, ClosedLoopLeavesStress) {
    for (const int increments : {1, 7}) {
        UmatPoint point = material(solid, B4);
        const auto go = [&](Numbers total) {
            for (double& x : total) x /= increments;
            for (int i = 0; i < increments; ++i) point.advance({.dstran = total});
        };
        go(shear(.03));
        go({.02, -.02, 0, 0, 0, 0});
        go(shear(-.03));
        go({-.02, .02, 0, 0, 0, 0});
        expect_digits(point.stress(), {-9, 9, 0, 9, 0, 0}, 1e-12);
        EXPECT_EQ(state(point), 0);
    }
}

// Exact transitions: the same ramp in one or in many increments.
TEST(BistableIso, RampsDoNotDependOnTheIncrements) {
    const Numbers ramps[] = {{.03, -.01, .005, .02, -.01, .015}, {-.08, .03, .0, -.05, .02, -.04}};
    const Numbers tables[] = {
        B4, {1000, 600, 700, 300, 2, .01, 0, 1}, {1000, 600, 500, 150, 3, 15, 0, 1}, {500, 300, 1000, 600, 3, 6, 0, 1}};
    for (const Numbers& props : tables) {
        UmatPoint one = material(solid, props), many = material(solid, props);
        for (const Numbers& ramp : ramps) {
            one.advance({.dstran = ramp});
            Numbers part = ramp;
            for (double& x : part) x /= 64;
            for (int i = 0; i < 64; ++i) many.advance({.dstran = part});
            EXPECT_LE(distance(one.stress(), many.stress()), 1e-12 * largest(one.stress()));
            EXPECT_EQ(state(one), state(many));
            EXPECT_EQ(transitions(one), transitions(many));
        }
        EXPECT_GE(transitions(one), 3);
    }
}

// The tangent of increments with one, two and more transitions against central differences.
TEST(BistableIso, TangentOfIncrementsWithTransitions) {
    const double heat = 1e-3;  // strong expansion, so that temperature moves the transitions
    int most = 0;
    for (const double rule : {2.0, 3.0}) {
        for (const AnalysisKind kind : {solid, plane_strain, plane_stress, uniaxial}) {
            const Numbers props = {1000, 600, 700, 200, rule, rule == 2.0 ? 0.01 : 12.0, 0, 1, heat, 2 * heat};
            const auto n = static_cast<std::size_t>(components(kind));
            const auto normals = static_cast<std::size_t>(normal_components(kind));
            for (const double size : {0.03, -0.09, 0.05, -0.05}) {
                UmatPoint point = material(kind, props);
                Numbers start(n, 0.0), ramp(n, 0.0);
                for (std::size_t i = 0; i < n; ++i) {
                    start[i] = i < normals ? 0.012 - 0.009 * double(i) : 0.02 - 0.03 * double(i - normals);
                    ramp[i] = size * (i < normals ? 0.7 - 0.6 * double(i) : 0.6 - 0.4 * double(i - normals));
                }
                point.advance({.dstran = start});
                const Answer answer = point.evaluate({.dstran = ramp, .dtemp = 2.0});
                const int events = static_cast<int>(answer.state[9] - point.state(10));
                most = std::max(most, events);
                const double h = 1e-6;
                const double scale = answer.tangent.cwiseAbs().maxCoeff();
                for (std::size_t k = 0; k <= n; ++k) {
                    Load ahead{.dstran = ramp, .dtemp = 2.0}, back = ahead;
                    const double step = k < n ? h : 1e-3;
                    if (k < n) ahead.dstran[k] += step, back.dstran[k] -= step;
                    else ahead.dtemp += step, back.dtemp -= step;
                    const Numbers a = point.evaluate(ahead).stress, b = point.evaluate(back).stress;
                    for (std::size_t i = 0; i < n; ++i) {
                        const double given =
                            k < n ? answer.tangent(static_cast<int>(i), static_cast<int>(k)) : answer.ddsddt[i];
                        EXPECT_NEAR((a[i] - b[i]) / (2.0 * step), given, 1e-6 * (k < n ? scale : scale * heat))
                            << "rule " << rule << ", kind " << int(kind) << ", size " << size << ", " << events
                            << " events, column " << k;
                    }
                }
            }
        }
    }
    EXPECT_GE(most, 2);
}

// Plane stress, rule 3, Poisson's ratios that differ: where the rate of the criterion for the same strain increment has
// another sign in each state, they chatter at the surface, and state 1 ends it.
TEST(BistableIso, ChatterEndsInTheDeformedState) {
    // nu = 0.25 and 0. With S, D the sum and difference of the principal stresses q^2 = (S^2 + 3 D^2)/4, and the rates
    // of S and D are 2000 and 1200 in state 0, 1200 and 1200 in state 1 times sum x and difference y of the strains.
    // At S = 24, D = 18.5 the rate of q^2 for x = 3.6e-3, y = -2e-3 is positive in state 0 and negative in state 1.
    UmatPoint point = material(plane_stress, {1000, 600, 400, 600, 3, 20, 0, 1});
    const auto principal = [](double sum, double difference) {
        return Numbers{0.5 * (sum + difference), 0.5 * (sum - difference), 0};
    };
    point.advance({.dstran = principal(20.4 / 2000.0, 19.7 / 1200.0)});
    EXPECT_EQ(state(point), 0);
    const Answer answer = point.advance({.dstran = principal(3.6e-3, -2e-3)});
    EXPECT_EQ(state(point), 1);
    EXPECT_GE(transitions(point), 8);
    EXPECT_TRUE(answer.tangent.allFinite());
    // All that is left after the surface was reached is done with the stiffness of state 1.
    const double S = answer.stress[0] + answer.stress[1];
    EXPECT_GT(S, 20.4 + 1200.0 * 3.6e-3);
    EXPECT_LT(S, 20.4 + 2000.0 * 3.6e-3);
}

// The strain of STATEV turns with the host.
TEST(BistableIso, StrainTurnsWithTheHost) {
    UmatPoint point = material(solid, B4);
    point.advance({.dstran = {.004, -.002, .001, .006, -.003, .002}});
    const Numbers strain(point.state().begin() + 1, point.state().begin() + 7), stress = point.stress();
    const Matrix3d q = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
    point.advance({.drot = q});
    EXPECT_LE(distance({point.state().begin() + 1, point.state().begin() + 7}, rotated_strain(strain, solid, q)),
              1e-17);
    EXPECT_LE(distance(point.stress(), rotated_stress(stress, solid, q)), 1e-14);
}

// Expansions of state 1 that are left out are those of state 0.
TEST(BistableIso, ExpansionsDefaultToTheInitialOnes) {
    UmatPoint left_out = material(plane_strain, with(B, {0, 1e-4})),
              given = material(plane_strain, with(B, {0, 1e-4, 1e-4}));
    UmatPoint none = material(plane_strain, with(B, {0, 1e-4, 0}));
    for (UmatPoint* point : {&left_out, &given, &none}) {
        point->advance({.dstran = {.02, .01, 0, 0}});
        ASSERT_EQ(state(*point), 1);
        point->advance({.dtemp = 10.0});
    }
    EXPECT_TRUE(identical(left_out.stress(), given.stress()));
    EXPECT_GT(none.stress()[0], given.stress()[0] + 1.0);
    UmatPoint wet = material(plane_strain, with(B, {0, 0, 0, 0.1})),
              moist = material(plane_strain, with(B, {0, 0, 0, 0.1, 0.1}));
    for (UmatPoint* point : {&wet, &moist}) {
        point->advance({.dstran = {.02, .01, 0, 0}});
        point->advance({.dpred = {0.01}});
        EXPECT_EQ(point->state(9), 0.01);
    }
    EXPECT_TRUE(identical(wet.stress(), moist.stress()));
}

// An explicit host drives neighbours through different transitions.
TEST(BistableIso, BlockOfDifferentTransitions) {
    for (const Numbers& props : {with(B, {1}), B4, Numbers{1000, 600, 500, 300, 3, 12, 0, 1}}) {
        VumatBlock block("BISTABLE_ISO-TEST", solid, props);
        std::vector<UmatPoint> single;
        for (int i = 0; i < 19; ++i) {
            block.points.push_back(block.fresh_point());
            single.push_back(material(solid, props));
        }
        for (int step = 0; step < 6; ++step) {
            for (std::size_t i = 0; i < single.size(); ++i) {
                const double size = (step % 2 == 0 ? 1.0 : -1.7) * 0.004 * double(i);
                block.points[i].strain_increment = {size, 0.3 * size, 0, size, 0, -0.5 * size};
                single[i].advance({.dstran = block.points[i].strain_increment});
            }
            ASSERT_EQ(block.run().stops, 0);
            for (std::size_t i = 0; i < single.size(); ++i) {
                EXPECT_LE(distance(block.points[i].stress, single[i].stress()), 1e-12 * 100.0);
                EXPECT_EQ(block.points[i].state[0], single[i].state(1));
                EXPECT_EQ(block.points[i].state[9], single[i].state(10));
            }
        }
    }
}

TEST(BistableIso, RefusesWhatCannotBe) {
    const auto refusal = [](const Numbers& props) {
        char text[512] = "";
        EXPECT_EQ(lode_required_state("BISTABLE_ISO-BAD", props.data(), static_cast<int>(props.size()), 3, 3, text,
                                      sizeof text),
                  -1);
        return std::string(text);
    };
    const char* names[] = {"(K0,", "(G0,", "(KD,", "(GD,", "(RULE,", "(CRIT,"};
    for (std::size_t i = 0; i < 6; ++i) {
        Numbers bad = B;
        bad[i] = 0.0;  // a vanishing modulus in either state
        EXPECT_NE(refusal(bad).find(names[i]), std::string::npos);
    }
    Numbers bad = B;
    bad[4] = 4.0;
    EXPECT_NE(refusal(bad).find("RULE"), std::string::npos);
    EXPECT_NE(refusal(with(B, {2})).find("(REV,"), std::string::npos);
    EXPECT_NE(refusal(with(B, {0, 0, 0, 0, 0, 2})).find("(SPLIT,"), std::string::npos);
    EXPECT_NE(refusal({1000, 600, 700, 300, 1}).find("CRIT"), std::string::npos);
    EXPECT_EQ(lode_required_state("BISTABLE_ISO", B.data(), 7, 2, 1, nullptr, 0), 10);
}

}  // namespace
}  // namespace lode::test::test_bistable_iso
