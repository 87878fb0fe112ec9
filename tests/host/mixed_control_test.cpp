// Strain and stress control in every kind, against closed forms of linear elasticity and J2 plasticity.
#include <cmath>

#include "support.hpp"

namespace lode::host::test {
namespace {

constexpr double young = 210000, poisson = 0.3, yield = 250, hardening = 2000;
const std::string elastic = "[material]\nname = \"elastic-test\"\nconstants = [210000, 0.3]\n";
const std::string j2 = "[material]\nname = \"J2-STEEL\"\nconstants = [210000, 0.3, 250, 2000]\nstate_variables = 1\n";
// The solver is asked for 1e-9 of the largest stress.
constexpr double stress_tolerance = 1e-9;

TEST(MixedControl, UnnamedComponentsAreStressFree) {
    const History run = finished_run(elastic + "[[step]]\nstrain = { 11 = 0.002 }\nincrements = 4\n");
    EXPECT_NEAR(run.stress(0), young * 0.002, 420 * stress_tolerance);
    for (int i = 1; i < 6; ++i) EXPECT_NEAR(run.stress(i), 0, 420 * stress_tolerance);
    EXPECT_NEAR(run.strain(1), -poisson * 0.002, 1e-12);
    EXPECT_EQ(run.strain(0), 0.002);
    EXPECT_EQ(run.outcome.statistics.iterations, 0) << "the tangent of a linear material predicts exactly";
    EXPECT_EQ(run.outcome.statistics.increments, 4);
}

TEST(MixedControl, AllStressesPrescribed) {
    const History run = finished_run(
        elastic + "[[step]]\nstress = { 11 = 100, 22 = -50, 33 = 20, 21 = 30, 13 = -7, 23 = 11 }\nincrements = 3\n");
    const double expected[] = {100, -50, 20, 30, -7, 11};
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(run.stress(i), expected[i], 100 * stress_tolerance);
    EXPECT_NEAR(run.strain(0), (100 - poisson * (-50 + 20)) / young, 1e-13);
    EXPECT_NEAR(run.strain(3), 30 * 2 * (1 + poisson) / young, 1e-13);
    EXPECT_NEAR(run.strain(5), 11 * 2 * (1 + poisson) / young, 1e-13);
}

TEST(MixedControl, StrainStressAndUnnamedTogether) {
    const History run = finished_run(
        elastic + "[[step]]\nstrain = { 11 = 0.001, 12 = 0.002 }\nstress = { 22 = -80 }\nincrements = 2\n");
    EXPECT_NEAR(run.stress(0), young * 0.001 + poisson * -80, 300 * stress_tolerance);
    EXPECT_NEAR(run.stress(3), young / (2 * (1 + poisson)) * 0.002, 300 * stress_tolerance);
    EXPECT_NEAR(run.strain(1), (-80 - poisson * run.stress(0)) / young, 1e-13);
}

TEST(MixedControl, PlaneStrainHoldsComponent33) {
    const History run =
        finished_run(elastic + "[analysis]\nkind = \"plane_strain\"\n[[step]]\nstrain = { 11 = 0.001 }\n");
    EXPECT_EQ(run.strain(2), 0);
    EXPECT_NEAR(run.stress(0), young / (1 - poisson * poisson) * 0.001, 240 * stress_tolerance);
    EXPECT_NEAR(run.stress(2), poisson * run.stress(0), 240 * stress_tolerance);
}

TEST(MixedControl, AxisymmetricLeavesHoopFree) {
    const History run =
        finished_run(elastic + "[analysis]\nkind = \"axisymmetric\"\n[[step]]\nstrain = { 22 = 0.001 }\n");
    EXPECT_NEAR(run.stress(1), young * 0.001, 210 * stress_tolerance);
    EXPECT_NEAR(run.strain(2), -poisson * 0.001, 1e-12);
}

TEST(MixedControl, PlaneStressAndUniaxial) {
    const History plane =
        finished_run(elastic + "[analysis]\nkind = \"plane_stress\"\n[[step]]\nstrain = { 11 = 0.001, 22 = 0 }\n");
    EXPECT_NEAR(plane.stress(0), young / (1 - poisson * poisson) * 0.001, 240 * stress_tolerance);
    const History line = finished_run(elastic + "[analysis]\nkind = \"1d\"\n[[step]]\nstress = { 11 = 105 }\n");
    EXPECT_NEAR(line.strain(0), 0.0005, 1e-13);
}

TEST(MixedControl, CohesiveSeparationAndTraction) {
    // Normal stiffness 1000, shear stiffness 250.
    const std::string law = "[material]\nname = \"COHESIVE\"\nconstants = [1000, 0.25]\n[analysis]\nkind = ";
    const History run =
        finished_run(law + "\"cohesive_3d\"\n[[step]]\nseparation = { n = 0.01 }\ntraction = { s2 = 2 }\n");
    EXPECT_NEAR(run.stress(0), 10, 1e-12);
    EXPECT_EQ(run.strain(1), 0) << "separations that no step names are held";
    EXPECT_NEAR(run.strain(2), 2 / 250.0, 1e-11);
    const History released =
        finished_run(law + "\"cohesive_2d\"\nunnamed = \"traction\"\n[[step]]\nseparation = { n = 0.01 }\n");
    EXPECT_EQ(released.stress(1), 0);
}

TEST(MixedControl, PlasticTensionFollowsTheClosedForm) {
    // Radial return is exact in tension: sigma = yield + H p, eps = sigma / E + p, whatever the increments are.
    for (const char* increments : {"increments = 1", "increments = 37"}) {
        const History run = finished_run(j2 + "[[step]]\nstrain = { 11 = 0.02 }\n" + increments);
        const double stress = (yield + hardening * 0.02) / (1 + hardening / young);
        EXPECT_NEAR(run.stress(0), stress, 2 * stress * stress_tolerance);
        const double plastic = 0.02 - stress / young;
        EXPECT_NEAR(run.state(0), plastic, 1e-11);
        EXPECT_NEAR(run.strain(1), -poisson * stress / young - 0.5 * plastic, 1e-11);
    }
}

TEST(MixedControl, PlasticStressControlMeetsStrainControl) {
    const History run = finished_run(j2 + "[[step]]\nstress = { 11 = 280 }\nincrements = 5\n");
    // Plastic flow magnifies the tolerated error in stress by E/H.
    EXPECT_NEAR(run.strain(0), 280 / young + (280 - yield) / hardening, 280 * stress_tolerance / hardening * 2);
}

TEST(MixedControl, CyclesOfAnAmplitude) {
    const History run = finished_run(j2 +
                                     "[[step]]\nstrain = { 11 = 0.02 }\nincrements = 40\nrepeat = 3\n"
                                     "amplitude = [[0, 0], [0.25, 1], [0.75, -1], [1, 0]]\n");
    double stress = 0, plastic = 0, strain = 0;
    for (int cycle = 0; cycle < 3; ++cycle)
        for (const double target : {0.02, -0.02, 0.0}) {
            const double trial = stress + young * (target - strain), limit = yield + hardening * plastic;
            strain = target;
            const double flow = std::max(0.0, (std::abs(trial) - limit) / (young + hardening));
            plastic += flow;
            stress = trial - std::copysign(young * flow, trial);
        }
    EXPECT_NEAR(run.stress(0), stress, 1000 * stress_tolerance);
    EXPECT_NEAR(run.state(0), plastic, 1e-9);
    EXPECT_EQ(run.strain(0), 0);
    EXPECT_EQ(run.outcome.statistics.increments, 120);
}

TEST(MixedControl, NewtonWithAnUnsymmetricTangent) {
    // Stress 11 also feels 5e6 strain22^2: E e + 5e6 nu^2 e^2 = 300 in uniaxial stress.
    const History run = finished_run(
        "[material]\nname = \"SKEW\"\nconstants = [1000, 0.3, 5e6]\n[[step]]\nstress = { 11 = 300 }\nincrements = 1\n");
    const double a = 5e6 * poisson * poisson, strain = (-1000 + std::sqrt(1e6 + 4 * a * 300)) / (2 * a);
    EXPECT_NEAR(run.strain(0), strain, strain * 1e-8);
    EXPECT_NEAR(run.stress(0), 300, 300 * stress_tolerance);
    EXPECT_LE(run.records.back().iterations, 10);
}

TEST(MixedControl, AWrongTangentOnlyCostsIterations) {
    // A tangent a quarter too stiff leaves a fifth of the residual each time: 1e-9 takes 13.
    const History run = finished_run(
        "[material]\nname = \"BADTANGENT\"\nconstants = [210000, 0.3]\n[[step]]\nstress = { 11 = 210 }\nincrements = "
        "1\n");
    EXPECT_NEAR(run.strain(0), 0.001, 0.001 * 2 * stress_tolerance);
    EXPECT_NEAR(run.outcome.statistics.iterations, 13, 1);
    EXPECT_EQ(run.outcome.statistics.cut_backs, 0);
}

TEST(MixedControl, WhatAStepDoesNotNameGoesOn) {
    const History run = finished_run(elastic +
                                     "[[step]]\nstress = { 11 = -100, 22 = -100, 33 = -100 }\nincrements = 2\n"
                                     "[[step]]\nstrain = { 11 = 0.001 }\nrelative = true\nincrements = 3\n");
    EXPECT_NEAR(run.stress(0), -100 + young * 0.001, 210 * stress_tolerance);
    EXPECT_NEAR(run.stress(1), -100, 210 * stress_tolerance);
    const History held =
        finished_run(elastic + "[analysis]\nunnamed = \"strain\"\n[[step]]\nstrain = { 11 = 0.001 }\n");
    EXPECT_EQ(held.strain(1), 0);
    const double direct = young * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson));
    EXPECT_NEAR(held.stress(0), direct * 0.001, 1e-10);
}

TEST(MixedControl, UnloadingToAStress) {
    const History run = finished_run(j2 + "[[step]]\nstrain = { 11 = 0.01 }\n[[step]]\nstress = { 11 = 0 }\n");
    const double peak = (yield + hardening * 0.01) / (1 + hardening / young);
    EXPECT_NEAR(run.stress(0), 0, peak * stress_tolerance);
    EXPECT_NEAR(run.strain(0), 0.01 - peak / young, 1e-11);
}

TEST(MixedControl, ThermalExpansionIsTakenOffBeforeTheCall) {
    const std::string hot =
        "[material]\nname = \"ELASTIC\"\nconstants = [210000, 0.3]\nexpansion = 1.2e-5\n[analysis]\ntemperature = 20\n";
    const History free = finished_run(hot + "[[step]]\ntemperature = 120\nincrements = 4\n");
    EXPECT_NEAR(free.strain(2), 1.2e-3, 1e-14);
    EXPECT_NEAR(free.stress(2), 0, 1e-8);
    const History held = finished_run(hot + "unnamed = \"strain\"\n[[step]]\ntemperature = 120\nincrements = 4\n");
    EXPECT_NEAR(held.stress(0), -young * 1.2e-3 / (1 - 2 * poisson), 1e-9);
}

TEST(MixedControl, InitialStressAndStateAreWhereTheRunBegins) {
    const History run = finished_run(j2 +
                                     "initial_stress = { 11 = -30, 12 = 4 }\ninitial_state = [0.01]\n"
                                     "[[step]]\nstrain = { 11 = 0 }\nstress = { 12 = 0 }\nincrements = 2\n");
    EXPECT_EQ(run.records.front().point.stress[0], -30);
    EXPECT_NEAR(run.stress(0), -30, 30 * stress_tolerance);
    EXPECT_NEAR(run.strain(3), -4 * 2 * (1 + poisson) / young, 1e-13);
    EXPECT_EQ(run.state(0), 0.01);
}

TEST(MixedControl, EnergiesBalanceTheWork) {
    const History run = finished_run(j2 + "[[step]]\nstrain = { 11 = 0.02 }\nincrements = 400\n");
    const PointState& end = run.end();
    // The trapezoidal rule misses at the one increment where the curve bends.
    EXPECT_NEAR(end.energies.sum(), end.work, 1e-4 * end.work);
    EXPECT_GT(end.energies.plastic, 10 * end.energies.elastic);
}

}  // namespace
}  // namespace lode::host::test
