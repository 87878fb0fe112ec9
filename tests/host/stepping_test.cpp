// Increments: cut-backs, regrowth, grids, corners; and what a UMAT is told about time.
#include <cmath>

#include "support.hpp"

namespace lode::host::test {
namespace {

// Asks for half the increment where a strain grows by more than 0.004; STATEV(1) counts the calls it accepted.
const std::string picky = "[material]\nname = \"PICKY\"\nconstants = [1000, 0.3, 0.004]\nstate_variables = 1\n";

TEST(Stepping, FixedIncrementsAreCutAndReturnToTheirGrid) {
    const History run = finished_run(picky + "[[step]]\nstrain = { 11 = 0.02 }\nincrements = 2\n");
    EXPECT_GE(run.outcome.statistics.cut_backs, 2) << "0.01, 0.005: both are too large";
    bool at_half = false;
    for (const auto& record : run.records) {
        at_half |= record.point.total_time == 0.5;
        EXPECT_LE(record.dtime * 0.02, 0.004 * (1 + 1e-12));
    }
    EXPECT_TRUE(at_half);
    EXPECT_EQ(run.end().total_time, 1.0);
    EXPECT_EQ(run.state(0), run.outcome.statistics.increments) << "STATEV of rejected attempts has to be dropped";
    EXPECT_NEAR(run.stress(0), 20, 1e-7);
}

TEST(Stepping, TheFactorIsPnewdt) {
    const History run = finished_run(picky + "[[step]]\nstrain = { 11 = 0.006 }\nincrements = 1\n");
    EXPECT_EQ(run.outcome.statistics.cut_backs, 1);
    EXPECT_DOUBLE_EQ(run.records[1].dtime, 0.5);
}

TEST(Stepping, AutomaticIncrementsGrowToTheMaximum) {
    const History run = finished_run(
        "[material]\nname = \"ELASTIC\"\nconstants = [1000, 0.3]\n[[step]]\ntime = 2\nstrain = { 11 = 0.02 }\n"
        "automatic = { initial = 0.01, minimum = 1e-6, maximum = 0.3 }\n");
    EXPECT_DOUBLE_EQ(run.records[1].dtime, 0.01);
    double largest = 0;
    for (std::size_t i = 2; i < run.records.size(); ++i) {
        EXPECT_LE(run.records[i].dtime, 1.5 * run.records[i - 1].dtime * (1 + 1e-12));
        largest = std::max(largest, run.records[i].dtime);
    }
    EXPECT_DOUBLE_EQ(largest, 0.3);
    EXPECT_EQ(run.end().total_time, 2.0);
    EXPECT_EQ(run.outcome.statistics.cut_backs, 0);
}

TEST(Stepping, AutomaticIncrementsRecoverFromCuts) {
    const History run = finished_run(picky + "[[step]]\nstrain = { 11 = 0.1 }\nautomatic = { initial = 0.1 }\n");
    EXPECT_GT(run.outcome.statistics.cut_backs, 1);
    EXPECT_LT(run.outcome.statistics.increments, 60) << "at best 25 increments of 0.004";
}

TEST(Stepping, GivesUpAtTheMinimumAndSaysWhy) {
    const History run = run_deck(
        "[material]\nname = \"PICKY\"\nconstants = [1000, 0.3, 1e-9]\nstate_variables = 1\n"
        "[[step]]\nname = \"pull\"\nstrain = { 11 = 0.1 }\nautomatic = { initial = 0.1, minimum = 1e-3 }\n");
    EXPECT_EQ(run.outcome.status, Status::not_converged);
    for (const char* word : {"pull", "PNEWDT = 0.5", "0.001", "increment 1"})
        EXPECT_NE(run.outcome.message.find(word), std::string::npos) << run.outcome.message;
}

TEST(Stepping, NotANumberIsNoConvergence) {
    const History run =
        run_deck("[material]\nname = \"NAN\"\nconstants = [1]\n[[step]]\nstrain = { 11 = 0.1 }\nincrements = 1\n");
    EXPECT_EQ(run.outcome.status, Status::not_converged);
    EXPECT_NE(run.outcome.message.find("not a number"), std::string::npos) << run.outcome.message;
}

TEST(Stepping, IncrementsEndAtTheCornersOfAnAmplitude) {
    for (const char* increments : {"increments = 7", "automatic = { initial = 0.07, maximum = 0.19 }"}) {
        const History run =
            finished_run(std::string("[material]\nname = \"ELASTIC\"\nconstants = [1000, 0.3]\n[[step]]\ntime = 4\n") +
                         "strain = { 11 = 0.02 }\namplitude = [[0, 0], [0.3, 1], [0.9, -1], [1, 0.5]]\n" + increments);
        double most = 0, least = 0;
        for (const auto& record : run.records) {
            most = std::max(most, record.point.strain[0]);
            least = std::min(least, record.point.strain[0]);
        }
        EXPECT_DOUBLE_EQ(most, 0.02);
        EXPECT_DOUBLE_EQ(least, -0.02);
        EXPECT_DOUBLE_EQ(run.strain(0), 0.01);
    }
}

TEST(Stepping, GroupsRepeat) {
    const Scenario scenario = scenario_of(
        "[material]\nname = \"ELASTIC\"\nconstants = [1000, 0.3]\n"
        "[[step]]\nname = \"settle\"\n[[step]]\nrepeat = 3\n[[step.step]]\nname = \"up\"\nstrain = { 11 = 1e-3 }\n"
        "[[step.step]]\nname = \"down\"\nstrain = { 11 = 0 }\nrepeat = 2\n");
    std::string names;
    for (const Step& step : scenario.steps) names += step.name + " ";
    EXPECT_EQ(names, "settle up down down up down down up down down ");
}

TEST(Stepping, WhatAUmatIsToldAboutTheIncrement) {
    const History run = finished_run(
        "[material]\nname = \"ECHO\"\nconstants = [1000, 0.3]\nstate_variables = 70\n"
        "[analysis]\nelement_length = 2.5\ntemperature = 20\nfield = [0.5]\n"
        "[[step]]\ntime = 2\nincrements = 1\n"
        "[[step]]\ntime = 4\nincrements = 4\nstrain = { 11 = 0.004 }\ntemperature = 60\nfield = [1.5]\n");
    // TIME(1) and TIME(2) at the start of the last increment, DTIME, TEMP, DTEMP, PREDEF, DPRED, CELENT.
    const double expected[] = {3, 5, 1, 50, 10, 1.25, 0.25, 2.5, 3, 3, 1, 1, 2, 4, 1};
    for (std::size_t i = 0; i < std::size(expected); ++i) EXPECT_DOUBLE_EQ(run.state(i), expected[i]) << "value " << i;
    EXPECT_DOUBLE_EQ(run.state(50), 0.003) << "STRAN at the start";
    EXPECT_NEAR(run.state(60), 0.001, 1e-16) << "DSTRAN";
    for (std::size_t i = 0; i < 9; ++i) {
        const double one = i % 4 == 0 ? 1 : 0;
        for (const std::size_t matrix : {20U, 30U, 40U})
            EXPECT_EQ(run.state(matrix + i), one) << "DFGRD0, DFGRD1, DROT";
    }
}

#ifdef HOST_TEST_HAS_UTILITY
TEST(Stepping, ExitOfTheLibraryEndsTheRunOnly) {
    const History run =
        run_deck("[material]\nname = \"QUIT\"\nconstants = [1000, 0.3]\n[[step]]\nstrain = { 11 = 0.01 }\n");
    EXPECT_EQ(run.outcome.status, Status::refused);
    EXPECT_NE(run.outcome.message.find("QUIT: that is enough"), std::string::npos) << run.outcome.message;
    EXPECT_EQ(run.records.size(), 3U) << "the initial state and two increments came before";
    EXPECT_GT(run.outcome.statistics.calls.calls, 0);
}
#endif

}  // namespace
}  // namespace lode::host::test
