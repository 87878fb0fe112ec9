// The advice, run again by other means than those that found it.
#include <gtest/gtest.h>

#include <cmath>

#include "advise/advise.hpp"
#include "advise/report.hpp"
#include "study.hpp"
#include "study/variants.hpp"
#include "support.hpp"

namespace lode::host::test {
namespace {

// The work of a scene, counted instead of timed: what is advised must not depend on what else the machine does. A call
// fills stresses and, in UMAT, the tangent; single precision moves half the bytes.
Cost counted(const Scenario& scene, const Library& library) {
    Cost cost = measure(scene, library, 1);
    const int n = Layout(scene.analysis.kind).size();
    const bool umat = scene.analysis.entry == Entry::umat;
    cost.per_call = umat ? n + n * n : scene.analysis.precision == Precision::single ? 0.5 * n : n;
    cost.median = cost.low = cost.high = cost.per_call * (umat ? cost.calls : cost.increments);
    return cost;
}

Advice advice_for(const std::string& deck, double tolerance) {
    AdviseSettings settings;
    settings.tolerance = tolerance;
    settings.cost = counted;
    return advise(scenario_of(deck), libraries(), settings, nullptr);
}

// The error of a setting at the ends of the steps against 6000 increments a step of the deck's own material.
double error_run_again(const Scenario& deck, const Option& option) {
    Scenario fine = with_increments(deck, 6000);
    fine.analysis.tolerance = 1e-12;
    fine.analysis.entry = Entry::umat;
    const Trace reference = follow(fine, library());
    EXPECT_TRUE(reference.complete()) << reference.outcome.message;
    const Library& own = option.precision == Precision::single ? *libraries().single() : library();
    const Trace trace = follow(option.scenario, own);
    EXPECT_TRUE(trace.complete()) << trace.outcome.message;
    const bool strains = stress_controlled(deck) && !gradient_controlled(deck);
    return difference(trace, reference, strains).worst();
}

// The advice meets the tolerance, and nothing else that was run is cheaper.
void expect_advice(const Advice& advice, const std::string& deck, double tolerance) {
    ASSERT_TRUE(advice.best) << text(advice);
    EXPECT_LE(advice.best->error, tolerance);
    EXPECT_LE(error_run_again(scenario_of(deck), *advice.best), tolerance) << text(advice);
    ASSERT_TRUE(advice.best->cost && advice.safest && advice.safest->cost);
    EXPECT_LT(advice.best->cost->median, advice.safest->cost->median);
    for (const Option& option : advice.options)
        if (option.sufficient && option.cost) {
            EXPECT_GE(1.05 * option.cost->median, advice.best->cost->median);
        }
    // What it says to paste runs as it is.
    EXPECT_NE(cards(*advice.best, library()).find("*USER MATERIAL"), std::string::npos);
}

Advice checked(const std::string& deck, double tolerance) {
    Advice advice = advice_for(deck, tolerance);
    expect_advice(advice, deck, tolerance);
    return advice;
}

const std::string steel = "[material]\nname = \"ISO_PLASTIC-STEEL\"\nconstants = [200000, 0.3, 400, 1, 2000]\n";

// A path along which everything is radial needs one increment a step, and one dimension.
TEST(Advise, UniaxialCyclesNeedOneDimension) {
    LODE_NEEDS("ISO_PLASTIC");
    const Advice advice =
        checked(steel + "[[step]]\nstrain = { 11 = 0.01 }\n[[step]]\nstrain = { 11 = -0.01 }\n", 1e-3);
    ASSERT_TRUE(advice.best);
    EXPECT_EQ(advice.best->kind, Kind::uniaxial);
    EXPECT_EQ(advice.best->entry, Entry::umat) << "strains follow from stresses, so the tangent is needed";
    EXPECT_EQ(advice.best->increments, 1);
    EXPECT_TRUE(advice.tangent_needed);
}

// A corner: the exact solution needs few increments, backward Euler many.
TEST(Advise, CornerOfTheStrainPath) {
    LODE_NEEDS("ISO_PLASTIC");
    const Advice advice =
        checked(steel +
                    "[[step]]\nstrain = { 11 = 0.004, 22 = -0.002, 33 = -0.002, 12 = 0, 13 = 0, 23 = 0 }\n"
                    "[[step]]\nstrain = { 12 = 0.01 }\n",
                1e-3);
    ASSERT_TRUE(advice.best);
    EXPECT_FALSE(advice.tangent_needed);
    EXPECT_EQ(advice.best->entry, Entry::vumat);
    EXPECT_GT(advice.best->scenario.material.constants.size(), 5U) << "another algorithm than the deck's";
}

TEST(Advise, PlaneStressSheet) {
    LODE_NEEDS("ISO_PLASTIC");
    checked(steel +
                "[analysis]\nkind = \"plane_stress\"\n[[step]]\nstrain = { 11 = 0.006, 22 = 0.001, 12 = 0 }\n"
                "[[step]]\nstrain = { 22 = 0.006, 12 = 0.004 }\n",
            5e-3);
}

TEST(Advise, ClayThatTurnsACorner) {
    LODE_NEEDS("CAM_CLAY");
    checked(
        "[material]\nname = \"CAM_CLAY-CLAY\"\nconstants = [100, 0.02, 0.1, 1.2, 3000, 0, 120]\n"
        "[[step]]\nstrain = { 11 = -0.02, 22 = -0.005, 33 = -0.005, 12 = 0, 13 = 0, 23 = 0 }\n"
        "[[step]]\nstrain = { 12 = 0.03 }\n",
        5e-3);
}

const std::string rubber = "[material]\nname = \"NEO_HOOKEAN-RUBBER\"\nconstants = [3, 0.45]\n";

// Large stretch needs the finite-strain law.
TEST(Advise, LargeStretchNeedsFiniteStrain) {
    LODE_NEEDS("NEO_HOOKEAN");
    const Advice advice =
        checked(rubber + "[[step]]\ndeformation_gradient = [[1.5, 0.3, 0], [0, 0.9, 0], [0, 0, 0.9]]\n", 1e-3);
    ASSERT_TRUE(advice.best);
    EXPECT_EQ(advice.best->material, "NEO_HOOKEAN-RUBBER");
}

// The same at a thousandth of a percent is linear elasticity.
TEST(Advise, TinyStretchIsLinearElasticity) {
    LODE_NEEDS("NEO_HOOKEAN");
    LODE_NEEDS("ISO_ELASTIC");
    const Advice advice = checked(
        rubber + "[[step]]\ndeformation_gradient = [[1.00001, 0.00002, 0], [0, 0.99999, 0], [0, 0, 1]]\n", 1e-3);
    // Which of the two is cheaper is a matter of nanoseconds; that both do is not.
    for (const char* const enough : {"ISO_ELASTIC-FITTED", "NEO_HOOKEAN-RUBBER"})
        EXPECT_TRUE(std::any_of(advice.options.begin(), advice.options.end(),
                                [&](const Option& o) { return o.sufficient && o.material == enough; }))
            << enough << "\n"
            << text(advice);
}

TEST(Advise, InterfaceThatTears) {
    LODE_NEEDS("COH_TRIANGULAR");
    const Advice advice = checked(
        "[material]\nname = \"COH_TRIANGULAR-EPOXY\"\nconstants = [100000, 30, 0.3, 50000, 40, 0.9]\n"
        "[analysis]\nkind = \"cohesive_3d\"\n[[step]]\nseparation = { n = 0.004, s1 = 0 }\n"
        "[[step]]\nseparation = { n = 0.014, s1 = 0.03 }\n",
        1e-3);
    ASSERT_TRUE(advice.best);
    EXPECT_EQ(advice.best->kind, Kind::cohesive_2d) << "nothing slides in direction 2";
}

// A material that the deck names may replace the own one where the scene does not tell them apart.
TEST(Advise, AlternativeOfTheDeck) {
    LODE_NEEDS("ISO_PLASTIC");
    const std::string deck =
        "[material]\nname = \"ISO_PLASTIC-VOCE\"\nconstants = [200000, 0.3, 400, 8, 0.001, 12]\n"
        "[[step]]\nstrain = { 11 = 0.006, 22 = -0.003, 33 = -0.003, 12 = 0, 13 = 0, 23 = 0 }\n"
        "[[alternative]]\nname = \"ISO_PLASTIC-PERFECT\"\nconstants = [200000, 0.3, 400, 0]\n";
    const Advice advice = checked(deck, 1e-3);
    const auto tried = std::find_if(advice.options.begin(), advice.options.end(),
                                    [](const Option& o) { return o.material == "ISO_PLASTIC-PERFECT"; });
    ASSERT_NE(tried, advice.options.end());
    EXPECT_TRUE(tried->sufficient);
    EXPECT_LT(tried->error, 1e-4);
}

// First order only gets so far.
TEST(Advise, SaysThatNothingSuffices) {
    LODE_NEEDS("CAM_CLAY");
    const Advice advice = advice_for(
        "[material]\nname = \"CAM_CLAY-CLAY\"\nconstants = [100, 0.02, 0.1, 1.2, 3000, 0, 120]\n"
        "[[step]]\nstrain = { 11 = -0.02, 22 = -0.005, 33 = -0.005, 12 = 0, 13 = 0, 23 = 0 }\n"
        "[[step]]\nstrain = { 12 = 0.03 }\n",
        1e-7);
    EXPECT_FALSE(advice.best);
    EXPECT_FALSE(advice.options.empty());
    for (const Option& option : advice.options) EXPECT_FALSE(option.sufficient);
    EXPECT_NE(text(advice).find("nothing that was run meets the tolerance"), std::string::npos);
}

}  // namespace
}  // namespace lode::host::test
