// lode_umat_observed: the very answers of umat_, and what their solutions took. That a model reports its iterations is
// checked from two sides: against what its description says, and against the calls of solvers in its headers.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>

#include "lode/material/property_places.hpp"
#include "property_suite.hpp"

namespace lode::test {
namespace {

class Observed : public testing::TestWithParam<Case> {};

TEST_P(Observed, AnswersAsUmatDoes) {
    const Case& c = GetParam();
    Random random(c, 7);
    UmatPoint plain = c.point(), watched = c.point();
    for (const Step& step : random_path(c, random)) {
        Load load = load_of(plain, step);
        const Answer a = plain.step(load);
        load.observe = true;
        const Answer b = watched.step(load);
        ASSERT_EQ(a.pnewdt, b.pnewdt);
        ASSERT_TRUE(identical(a.stress, b.stress) && identical(a.state, b.state) && a.tangent == b.tangent);
        ASSERT_TRUE(identical({a.sse, a.spd, a.scd, a.rpl, a.drpldt}, {b.sse, b.spd, b.scd, b.rpl, b.drpldt}));
        ASSERT_GE(b.observation.iterations, b.observation.safeguards);
        ASSERT_GE(b.observation.substeps, 0);
        ASSERT_GE(b.observation.safeguards, 0);
    }
}
LODE_FOR_ALL_CASES(Observed);

// The sample under each of the algorithms that its constants reach.
std::vector<Numbers> constants_of(const Case& c) {
    std::vector<Numbers> all{c.props()};
    for (int i = 0; i < c.model->algorithm_count; ++i) {
        const lode_algorithm& a = c.model->algorithms[i];
        const int index = property_index(*c.model, a.parameter, c.sample->constants, c.sample->constant_count);
        if (index <= 0) continue;
        Numbers constants = c.props();
        if (index > static_cast<int>(constants.size())) continue;
        constants[static_cast<std::size_t>(index) - 1] = a.value;
        all.push_back(constants);
    }
    return all;
}

// Far beyond the scale, where what softens has failed.
std::vector<Step> straight_path(const Case& c, Random& random) {
    Numbers direction = random.direction(static_cast<std::size_t>(components(c.kind)));
    direction[0] = std::abs(direction[0]);
    std::vector<Step> path;
    for (int i = -3; i <= 6; ++i) path.push_back({scaled(direction, std::ldexp(c.scale(), i))});
    return path;
}

lode_observation most_of(const Case& c) {
    lode_observation most{};
    for (const Numbers& constants : constants_of(c)) {
        if (lode_required_state(c.material().c_str(), constants.data(), static_cast<int>(constants.size()),
                                normal_components(c.kind), shear_components(c.kind), nullptr, 0) < 0)
            continue;  // the algorithm does not go with these constants
        for (std::uint64_t seed = 1; seed <= 3; ++seed) {
            Random random(c, seed);
            const auto follow = [&](const std::vector<Step>& path) {
                UmatPoint point(c.material(), c.kind, constants);
                point.temperature(c.temperature());
                point.evaluate({.dtime = 0.0});
                for (const Step& step : path) {
                    Load load = load_of(point, step);
                    load.observe = true;
                    const lode_observation o = point.step(load).observation;
                    for (const auto what :
                         {&lode_observation::iterations, &lode_observation::safeguards, &lode_observation::substeps})
                        most.*what = std::max(most.*what, o.*what);
                }
            };
            follow(random_path(c, random));
            follow(straight_path(c, random));
        }
    }
    return most;
}

// LODE_ITERATES is what a description promises: without it nothing is ever counted, with it something is.
TEST(ObservedRegistry, IterationsAreThoseOfTheDescription) {
    std::map<std::string, lode_observation> most;
    for (const Case& c : all_cases()) {
        const lode_observation o = most_of(c);
        lode_observation& m = most[c.model->keyword];
        m = {std::max(m.iterations, o.iterations), std::max(m.safeguards, o.safeguards),
             std::max(m.substeps, o.substeps)};
        if (!c.has_trait(LODE_ITERATES)) {
            EXPECT_EQ(o.iterations, 0) << c.name();
            EXPECT_EQ(o.safeguards, 0) << c.name();
        }
    }
    for (const auto& [keyword, m] : most) {
        // A porous version repeats the traits of its solid, of which it may lack the kinds that iterate.
        if ((find_model(keyword)->traits & LODE_ITERATES) != 0 && !keyword.starts_with("POROUS_")) {
            EXPECT_GT(m.iterations, 0) << keyword;
        }
        RecordProperty(keyword, std::to_string(m.iterations) + " " + std::to_string(m.safeguards) + " " +
                                    std::to_string(m.substeps));
    }
}

// Solves that are not reported: those inside the residual of another one, and those of material constants.
const std::map<std::string, int> silent_solves{
    {"cohesive/cubic_laws.hpp", 1},  {"cohesive/exponential_laws.hpp", 2},          {"cohesive/strength_laws.hpp", 2},
    {"damage/softening_law.hpp", 1}, {"plasticity/hardening_law_steinberg.hpp", 1},
};

int matches(const std::string& text, const char* pattern) {
    const std::regex expression(pattern);
    return static_cast<int>(
        std::distance(std::sregex_iterator(text.begin(), text.end(), expression), std::sregex_iterator()));
}

TEST(ObservedRegistry, HeadersReportTheirSolves) {
    namespace fs = std::filesystem;
    const fs::path core = LODE_CORE_DIRECTORY;
    int solves = 0;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(core)) {
        const std::string name = fs::relative(entry.path(), core).generic_string();
        if (entry.path().extension() != ".hpp" || name.starts_with("numerics/")) continue;
        std::ifstream file(entry.path());
        const std::string text =
            std::regex_replace(std::string(std::istreambuf_iterator<char>(file), {}), std::regex("//[^\n]*"), "");
        const int calls =
            matches(text, R"(\b(solve_bracketed|solve_dense_newton|modified_euler|double_substeps)\b\s*[<(])");
        const int reports = matches(text, R"(\bsolves_?\.count(_substeps)?\()");
        const auto silent = silent_solves.find(name);
        EXPECT_GE(reports + (silent != silent_solves.end() ? silent->second : 0), calls) << name;
        solves += calls;
    }
    EXPECT_GT(solves, 30);
}

}  // namespace
}  // namespace lode::test
