// The explicit interface: order and shear convention, frames, blocks, the probe call.
#include <cmath>

#include "support.hpp"

namespace lode::host::test {
namespace {

std::string vumat(const std::string& name, int states, const std::string& more = "") {
    return "[material]\nname = \"" + name +
           "\"\nconstants = [1000, 0.25]\nstate_variables = " + std::to_string(states) +
           "\ndensity = 2\n[analysis]\ninterface = \"vumat\"\n" + more;
}

bool mentions(const History& run, const std::string& word) {
    for (const auto& remark : run.outcome.remarks)
        if (remark.find(word) != std::string::npos) return true;
    return false;
}

TEST(Vumat, OrderAndTensorShears) {
    const History run =
        finished_run(vumat("ECHO", 60, "element_length = 3\nfield = [7]\ntemperature = 5\n") +
                     "[[step]]\ntime = 2\nincrements = 1\nstrain = { 11 = 0.01, 22 = 0.02, 33 = 0.03, 12 = "
                     "0.04, 13 = 0.05, 23 = 0.06 }\n");
    const double expected[] = {2, 2, 2, 5, 7, 3, 2, 3, 3};  // times at the end, dt, temperature, field, length, density
    for (std::size_t i = 0; i < std::size(expected); ++i) EXPECT_DOUBLE_EQ(run.state(i), expected[i]) << i;
    const double strain[] = {0.01, 0.02, 0.03, 0.02, 0.03, 0.025};  // 11, 22, 33, 12, 23, 31, tensor components
    for (std::size_t i = 0; i < 6; ++i) EXPECT_DOUBLE_EQ(run.state(10 + i), strain[i]) << i;
    const double shear_modulus = 1000 / (2 * 1.25);
    EXPECT_NEAR(run.stress(4), shear_modulus * 0.05, 1e-12) << "13 is third of the shears there, second here";
    EXPECT_NEAR(run.stress(5), shear_modulus * 0.06, 1e-12);
}

TEST(Vumat, GradientComponents) {
    const History run = finished_run(vumat("ECHO", 60) +
                                     "[[step]]\nincrements = 1\n"
                                     "deformation_gradient = [[1, 0.1, 0.2], [0.3, 1, 0.05], [0.06, 0.07, 1]]\n");
    const double gradient[] = {1, 1, 1, 0.1, 0.05, 0.06, 0.3, 0.07, 0.2};  // 11, 22, 33, 12, 23, 31, 21, 32, 13
    for (std::size_t i = 0; i < 9; ++i) EXPECT_DOUBLE_EQ(run.state(30 + i), gradient[i]) << i;
    const History plane = finished_run(vumat("ECHO", 60, "kind = \"plane_strain\"\n") +
                                       "[[step]]\nincrements = 1\ndeformation_gradient = [[1, 0.1], [0.3, 1]]\n");
    const double in_plane[] = {1, 1, 1, 0.1, 0.3};
    for (std::size_t i = 0; i < 5; ++i) EXPECT_DOUBLE_EQ(plane.state(30 + i), in_plane[i]) << i;
}

TEST(Vumat, StressControlWithoutATangent) {
    const std::string step = "[[step]]\nstrain = { 11 = 0.01 }\nstress = { 22 = -3, 23 = 1 }\nincrements = 5\n";
    const History explicit_run = finished_run(vumat("ELASTIC", 0, "block = 5\n") + step);
    const History implicit_run = finished_run("[material]\nname = \"ELASTIC\"\nconstants = [1000, 0.25]\n" + step);
    for (int i = 0; i < 6; ++i) {
        EXPECT_NEAR(explicit_run.stress(i), implicit_run.stress(i), 1e-7);
        EXPECT_NEAR(explicit_run.strain(i), implicit_run.strain(i), 1e-10);
    }
    EXPECT_TRUE(explicit_run.outcome.remarks.empty());
    EXPECT_EQ(explicit_run.outcome.statistics.calls.points, 5 * explicit_run.outcome.statistics.calls.calls);
}

TEST(Vumat, EnergiesArePerMass) {
    const History run = finished_run(vumat("ELASTIC", 0) + "[[step]]\nstrain = { 11 = 0.01 }\nincrements = 3\n");
    EXPECT_NEAR(run.end().energies.elastic, 0.5 * 1000 * 0.01 * 0.01, 1e-10);
    EXPECT_NEAR(run.end().work, run.end().energies.elastic, 1e-12);
}

TEST(Vumat, PlaneStressReportsTheThickness) {
    const History run = finished_run(vumat("ELASTIC-PS", 0, "kind = \"plane_stress\"\n") +
                                     "[[step]]\nstrain = { 11 = 0.01 }\nincrements = 4\n");
    EXPECT_NEAR(run.stress(0), 10, 1e-7);
    EXPECT_NEAR(run.end().thickness_strain, -0.25 * 0.01, 1e-10);
}

TEST(Vumat, CohesiveShearsAreHalved) {
    const History run = finished_run(vumat("COHESIVE", 0, "kind = \"cohesive_3d\"\n") +
                                     "[[step]]\nseparation = { n = 0.01, s1 = 0.02 }\ntraction = { s2 = 3 }\n");
    EXPECT_NEAR(run.stress(1), 250 * 0.02, 1e-12);
    EXPECT_NEAR(run.strain(2), 3 / 250.0, 1e-9);
}

TEST(Vumat, StressIsTurnedBackToGlobalAxes) {
    const History run = finished_run(vumat("ECHO", 60, "unnamed = \"strain\"\nlarge_rotation = true\n") +
                                     "[[step]]\nstrain = { 11 = 0.01 }\nincrements = 1\n"
                                     "[[step]]\nrotation = { axis = [0, 0, 1], angle_degrees = 90 }\nincrements = 3\n");
    EXPECT_NEAR(run.stress(1), run.records[1].point.stress[0], 1e-12);
    EXPECT_NEAR(run.state(20), std::exp(0.01), 1e-14) << "U keeps its axes";
    for (std::size_t i = 10; i < 16; ++i) EXPECT_NEAR(run.state(i), 0, 1e-15) << "and a rotation strains nothing";
    for (std::size_t i = 40; i < 43; ++i) EXPECT_NEAR(run.state(i), 0, 1e-14) << "nor spins against its axes";
}

TEST(Vumat, UnequalPointsOfABlockAreReported) {
    EXPECT_TRUE(mentions(
        finished_run(vumat("UNEQUAL", 0, "block = 3\n") + "[[step]]\nstrain = { 11 = 0.01, 22 = 0, 33 = 0 }\n"),
        "different"));
}

TEST(Vumat, HistoryOfTheProbeCallIsDroppedAndReported) {
    const History run = finished_run(vumat("HISTORY", 1) + "[[step]]\nstrain = { 11 = 0.01 }\n");
    EXPECT_TRUE(mentions(run, "probe"));
    EXPECT_EQ(run.state(0), 0);
}

}  // namespace
}  // namespace lode::host::test
