// Stress control under large strain: Newton's method with the finite-strain tangent converges quadratically.
#include <cmath>
#include <cstdio>

#include "replay/kinematics.hpp"
#include "replay/material.hpp"
#include "support.hpp"

namespace lode::host::test {
namespace {

TEST(Kinematics, DerivativeOfTheExponential) {
    const Matrix3 E{{0.3, 0.1, -0.2}, {0.1, -0.4, 0.05}, {-0.2, 0.05, 0.2}}, d{{1, 2, 0}, {2, -1, 3}, {0, 3, 0.5}};
    const double h = 1e-5;
    EXPECT_LT((exponential_derivative(E, d) - (exponential(E + h * d) - exponential(E - h * d)) / (2 * h)).norm(),
              1e-8);
    EXPECT_LT((exponential_derivative(0.2 * Matrix3::Identity(), d) - std::exp(0.2) * d).norm(), 1e-14)
        << "equal values";
}

struct Case {
    const char *material, *constants;
};

// The residuals of the increment that goes from nothing to the stress in one.
std::vector<double> iterations_of(const Case& c, const char* stress, const char* kind) {
    Scenario scenario = scenario_of(std::string("[material]\nname = \"") + c.material +
                                    "-A\"\nconstants = " + c.constants + "\n[analysis]\ntolerance = 1e-12\nkind = \"" +
                                    kind + "\"\n[[step]]\nincrements = 1\nstress = " + stress + "\n");
    install_utility_handlers();
    const Library library(LODE_TEST_LIBRARY);
    resolve(scenario, library);
    std::vector<double> residuals;
    const Outcome outcome = drive(scenario, library, [&](const Record& record) {
        if (record.residuals != nullptr) residuals = *record.residuals;
    });
    EXPECT_EQ(outcome.status, Status::success) << outcome.message;
    EXPECT_EQ(outcome.statistics.cut_backs, 0);
    return residuals;
}

TEST(Convergence, StressControlIsQuadratic) {
    // Moduli around 1000; all six components of the stress are prescribed, some near the shear modulus of 400.
    const Case cases[] = {
        {"NEO_HOOKEAN", "[1000, 0.25]"},          {"NEO_HOOKEAN", "[1000, 0.25, 1]"},
        {"MOONEY_RIVLIN", "[200, 1000, 100]"},    {"COROT_NEO_HOOKEAN", "[1000, 0.25]"},
        {"COROT_NEO_HOOKEAN", "[1000, 0.25, 0]"}, {"TI_NEO_HOOKEAN", "[2000, 1000, 400, 0.3, 0.25, 0, 1, 1, 0]"}};
    for (const Case& c : cases)
        for (const auto& [kind, stress] :
             {std::pair("3d", "{ 11 = 240, 22 = -100, 33 = 50, 12 = 100, 13 = -80, 23 = 60 }"),
              std::pair("3d", "{ 11 = 300 }"), std::pair("axisymmetric", "{ 11 = 200, 33 = -150, 12 = 100 }")}) {
            if (std::string(c.material) == "TI_NEO_HOOKEAN" && std::string(kind) != "3d") continue;
            const std::vector<double> r = iterations_of(c, stress, kind);
            std::string table = std::string(c.material) + " " + c.constants + " " + kind + " " + stress + "\n";
            for (std::size_t i = 0; i < r.size(); ++i) {
                char line[80];
                std::snprintf(line, sizeof line, "%3zu  residual stress %.3e\n", i, r[i]);
                table += line;
            }
            SCOPED_TRACE(table);
            ASSERT_GE(r.size(), 3U);
            EXPECT_LE(r.size(), 10U);
            // r(i+1) <= c r(i)^2 from a residual of a hundredth of the stress on, until rounding ends it.
            const double scale = 300, rounding = 1e-11 * scale;
            int seen = 0;
            for (std::size_t i = 0; i + 1 < r.size(); ++i) {
                if (r[i] > 0.02 * scale || r[i] < rounding) continue;
                EXPECT_LE(r[i + 1] / scale, 10 * std::pow(r[i] / scale, 2) + rounding / scale) << "iteration " << i;
                ++seen;
            }
            EXPECT_GE(seen, 1);
        }
}

}  // namespace
}  // namespace lode::host::test
