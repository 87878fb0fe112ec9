// What the returns of ISO_PLASTIC take: a closed form nothing, the others the iterations that they are known for.
#include <algorithm>

#include "iso_plastic_support.hpp"
#include "lode/plasticity/iso_plastic_description.hpp"

namespace lode::test::test_iso_plastic_iterations {
namespace {

using namespace iso_plastic_cases;
using iso_plastic::METHOD, iso_plastic::NSUB;

const Numbers linear = {200000.0, 0.3, 400.0, 1, 2000.0}, perfect = {200000.0, 0.3, 400.0, 0};
const Numbers saturating = {200000.0, 0.3, 400.0, 8, 300.0, 12.0, 500.0};
const Numbers power = {200000.0, 0.3, 400.0, 6, 3.0, 0.35};

// Of four increments, of which the last three are plastic.
lode_observation most_of(const Numbers& props, AnalysisKind kind = solid) {
    UmatPoint point("ISO_PLASTIC-OBSERVED", kind, props);
    const int n = point.size();
    Numbers dstran(static_cast<std::size_t>(n), -0.5e-3);
    dstran[0] = 1.6e-3;
    for (int i = point.normals(); i < n; ++i) dstran[static_cast<std::size_t>(i)] = 0.6e-3;
    lode_observation most{};
    for (int i = 0; i < 4; ++i) {
        const Answer answer = point.advance({.dstran = dstran, .observe = true});
        if (i == 0) {
            EXPECT_EQ(answer.spd, 0.0);
            EXPECT_EQ(answer.observation.iterations, 0) << "an elastic increment solves nothing";
        } else {
            EXPECT_GT(answer.spd, 0.0);
        }
        for (const auto what :
             {&lode_observation::iterations, &lode_observation::safeguards, &lode_observation::substeps})
            most.*what = std::max(most.*what, answer.observation.*what);
    }
    return most;
}

TEST(IsoPlasticIterations, AClosedFormTakesNone) {
    for (const Numbers& props : {linear, perfect})
        for (const AnalysisKind kind : {solid, plane_strain, uniaxial}) {
            const lode_observation o = most_of(props, kind);
            EXPECT_EQ(o.iterations, 0);
            EXPECT_EQ(o.safeguards, 0);
            EXPECT_EQ(o.substeps, 0);
        }
}

// Halley's from a good start: few, and no bracket.
TEST(IsoPlasticIterations, AScalarEquationTakesAFew) {
    for (const Numbers& props : {saturating, power})
        for (const AnalysisKind kind : {solid, plane_strain, plane_stress, uniaxial}) {
            const lode_observation o = most_of(props, kind);
            EXPECT_GE(o.iterations, 1);
            EXPECT_LE(o.iterations, 6);
            EXPECT_EQ(o.safeguards, 0);
        }
    // In plane stress linear hardening is one as well.
    EXPECT_GE(most_of(linear, plane_stress).iterations, 1);
}

TEST(IsoPlasticIterations, MethodsCountTheirSubsteps) {
    const auto by = [](Numbers props, int method, int substeps) {
        return iso_plastic_props(std::move(props), {{METHOD, double(method)}, {NSUB, double(substeps)}});
    };
    const lode_observation seven = most_of(by(linear, 2, 7));
    EXPECT_EQ(seven.substeps, 7);
    EXPECT_EQ(seven.iterations, 0);
    EXPECT_EQ(most_of(by(linear, 6, 9)).substeps, 9);
    // A plane through a straight surface is the surface.
    const lode_observation cutting = most_of(by(linear, 3, 1));
    EXPECT_EQ(cutting.iterations, 1);
    EXPECT_EQ(cutting.safeguards, 0);
    // On a proportional path the error control of modified Euler is content with one.
    EXPECT_EQ(most_of(by(linear, 4, 1)).substeps, 1);
    for (const int closed : {1, 5}) {
        const lode_observation o = most_of(by(perfect, closed, 1));
        EXPECT_EQ(o.iterations + o.safeguards + o.substeps, 0) << "METHOD " << closed;
    }
}

// Johnson-Cook: one evaluation from a start that is good at once, in the increments of explicit hosts, where all but
// the logarithm of the rate is small, and in those of implicit ones; a second in between, at most.
TEST(IsoPlasticIterations, JohnsonCookTakesOneOrTwoAtAnyStepAndRate) {
    const Numbers steel = {200000.0, 0.29, 792.0, 3, 510.0, 0.26, 0.014, 1.0, 1.03, 1520.0};
    const auto stretch = [](double size) { return Numbers{size, -0.5 * size, -0.5 * size, 0, 0, 0}; };
    const Numbers copper = {124000.0, 0.34, 90.0, 3, 292.0, 0.31, 0.025, 1.0, 1.09, 1083.0, 0.01, 1.5};
    for (const Numbers& metal : {steel, copper})
        for (const double rate : {0.01, 1.0, 100.0, 1e4})
            for (const double size : {1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 5e-3}) {
                UmatPoint point("ISO_PLASTIC-METAL", solid, metal);
                for (int i = 0; i < 10; ++i) point.advance({.dstran = stretch(2e-3), .dtime = 2e-3 / rate});
                for (int i = 0; i < 5; ++i) {
                    const Answer answer =
                        point.advance({.dstran = stretch(size), .dtime = size / rate, .observe = true});
                    EXPECT_GT(answer.spd, 0.0);
                    EXPECT_GE(answer.observation.iterations, 1);
                    EXPECT_LE(answer.observation.iterations, size < 2e-6 ? 1 : 2) << size << " at " << rate << " /s";
                    EXPECT_EQ(answer.observation.safeguards, 0);
                }
            }
}

// Steinberg and Lund's thermal part grows with the rate by an exponential of its square: from the start that a slow
// rate suggests Newton leaves the bracket, and the bracket finds the answer.
TEST(IsoPlasticIterations, TheBracketIsSeenAtWork) {
    const Numbers tantalum =
        iso_plastic_props({184920.0, 0.34, 375.0, 5, 1.0, 0.1, 1000.0, 0.0, -2e-4, 1000.0, 3597.4, 710000.0, 0.012},
                          {{17, 300.0}, {18, 273.15}});
    int safeguards = 0;
    for (double dtime = 1e-9; dtime < 1e9; dtime *= 10.0) {
        UmatPoint point("ISO_PLASTIC-TANTALUM", solid, tantalum);
        point.temperature(300.0);
        const Answer answer =
            point.advance({.dstran = {0.03, -0.015, -0.015, 0, 0, 0}, .dtime = dtime, .observe = true});
        EXPECT_LE(answer.observation.safeguards, answer.observation.iterations);
        EXPECT_LE(answer.observation.iterations, 100) << "the limit of the scalar solve";
        safeguards += answer.observation.safeguards;
    }
    EXPECT_GT(safeguards, 0);
}

}  // namespace
}  // namespace lode::test::test_iso_plastic_iterations
