// The README's deck against page 20, case V3: uniaxial tension and compression of ISO_PLASTIC, through both interfaces.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace {

using Columns = std::map<std::string, std::vector<double>>;

Columns replay(const std::string& interface) {
    const std::string directory = std::string(OUTPUT_DIRECTORY) + "-" + interface;
    const std::string command = std::string(LODE_EXECUTABLE) + " replay " + STEEL_DECK + " --quiet --interface " +
                                interface + " --output " + directory;
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
    std::ifstream file(directory + "/deck.csv");
    EXPECT_TRUE(file) << directory << "/deck.csv";
    std::vector<std::string> names;
    Columns columns;
    for (std::string line; std::getline(file, line);) {
        if (line.empty() || line.front() == '#') continue;
        std::istringstream cells(line);
        std::vector<std::string> row;
        for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
        if (names.empty()) names = row;
        else
            for (std::size_t i = 0; i < names.size() && i < row.size(); ++i)
                columns[names[i]].push_back(std::strtod(row[i].c_str(), nullptr));
    }
    return columns;
}

double stress_at_time(const Columns& columns, double time) {
    const auto& times = columns.at("time");
    for (std::size_t i = 0; i < times.size(); ++i)
        if (std::fabs(times[i] - time) < 1e-9) return columns.at("stress11")[i];
    ADD_FAILURE() << "no row at time " << time;
    return 0.0;
}

// Printed to 12 digits on the page; the lateral stresses are zero to the host's tolerance, 1e-9 of the yield stress.
constexpr double tolerance = 1e-6;

TEST(SteelCyclic, UmatGivesThePagesNumbers) {
    const Columns columns = replay("umat");
    EXPECT_NEAR(stress_at_time(columns, 1.0), 415.841584158, tolerance);
    EXPECT_NEAR(stress_at_time(columns, 2.0), -447.211057739, tolerance);
}

TEST(SteelCyclic, VumatFollowsTheSamePath) {
    const Columns umat = replay("umat"), vumat = replay("vumat");
    ASSERT_EQ(umat.at("time").size(), vumat.at("time").size());
    // The path is radial and the hardening linear, so the step adds no error of its own.
    for (std::size_t i = 0; i < umat.at("time").size(); ++i)
        EXPECT_NEAR(vumat.at("stress11")[i], umat.at("stress11")[i], tolerance) << "row " << i;
}

}  // namespace
