// Long random walks of every material, and many materials at once in several threads.
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <thread>

#include "property_suite.hpp"

namespace lode::test {
namespace {

// Shared over the cases of a model. LODE_TEST_INCREMENTS asks for more.
int increments_of(const Case& c) {
    const char* wanted = std::getenv("LODE_TEST_INCREMENTS");
    const int total = wanted != nullptr ? std::atoi(wanted) : 100000;
    int cases = 0;
    for (const Case& other : all_cases()) cases += other.model == c.model ? 1 : 0;
    return total / cases + 1;
}

bool all_finite(const Numbers& v) {
    double sum = 0.0;
    for (const double x : v) sum += x * 0.0;
    return sum == 0.0;
}

class RandomIncrements : public testing::TestWithParam<Case> {};

// Sizes over eleven decades, rotations, unloading: never NaN, never a failure other than a request for a smaller
// increment, dissipation never decreases, the tangent stays finite.
TEST_P(RandomIncrements, NeverFail) {
    const Case& c = GetParam();
    const std::uint64_t seed = 2024;
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(c, seed);
    const int increments = increments_of(c);
    const auto n = static_cast<std::size_t>(components(c.kind));
    UmatPoint point = c.point();
    Numbers direction = random.direction(n);
    Numbers total(n, 0.0);
    int done = 0;
    for (int i = 0; i < increments; ++i) {
        if (random.chance(0.3)) direction = random.direction(n);
        else if (random.chance(0.2)) direction = scaled(direction, -1.0);
        Step step{scaled(direction, random.log_uniform(1e-12, 0.3) * c.scale()), Matrix3d::Identity()};
        if (random.chance(0.1)) step.rotation = random.rotation(c.kind, random.log_uniform(1e-6, std::numbers::pi));
        const double spd = point.spd(), scd = point.scd();
        const Answer answer = point.step(load_of(point, step));
        ASSERT_EQ(answer.messages.stops, 0) << answer.first_error();
        if (answer.done()) {
            ++done;
            ASSERT_TRUE(all_finite(answer.stress) && all_finite(answer.state)) << "increment " << i;
            ASSERT_TRUE(answer.tangent.allFinite() && all_finite(answer.ddsddt) && all_finite(answer.drplde)) << i;
            ASSERT_TRUE(all_finite({answer.sse, answer.spd, answer.scd, answer.rpl, answer.drpldt})) << i;
            // Rounding of the stress power.
            const double rounding =
                1e-14 * (c.stress_scale() + largest(answer.stress)) * c.scale() + 1e-15 * (spd + scd);
            ASSERT_GE(answer.spd, spd - rounding) << "increment " << i;
            ASSERT_GE(answer.scd, scd - rounding) << "increment " << i;
        } else {
            ASSERT_GT(answer.pnewdt, 0.0);
            ASSERT_LT(answer.pnewdt, 1.0);
        }
        for (std::size_t k = 0; k < n; ++k) total[k] += step.strain[k];
        // A fresh point now and then, and before the walk has left the strains that the material is for.
        if (random.chance(1e-3) || largest(total) > 3.0 * c.scale()) {
            point = random.chance(0.5) ? c.point() : c.frugal_point();
            total.assign(n, 0.0);
        }
    }
    EXPECT_GE(done, increments * 9 / 10) << "most increments are small and can be done";
}

// Stress and state at the end of a path.
struct Outcome {
    Numbers stress, state;
    bool operator==(const Outcome& other) const {
        return identical(stress, other.stress) && identical(state, other.state);
    }
};
Outcome walk(const Case& c, std::uint64_t seed) {
    Random random(c, seed);
    UmatPoint point = c.point();
    for (const Step& step : random_path(c, random)) point.step(load_of(point, step));
    return {point.stress(), point.state()};
}

// Several threads run the same and different materials at once, made by them for the first time: bit for bit the
// serial results. A build with -fsanitize=thread shows races.
TEST(Threads, GiveTheSerialResults) {
    const std::vector<Case>& cases = all_cases();
    std::vector<Outcome> serial;
    for (const Case& c : cases) serial.push_back(walk(c, 1));
    const std::size_t threads = 4;
    std::vector<std::vector<int>> different(threads);
    {
        std::vector<std::jthread> running;
        for (std::size_t t = 0; t < threads; ++t)
            running.emplace_back([&, t] {
                for (std::size_t i = 0; i < cases.size(); ++i) {
                    const std::size_t k = t % 2 == 0 ? i : cases.size() - 1 - i;
                    if (!(walk(cases[k], 1) == serial[k])) different[t].push_back(static_cast<int>(k));
                }
            });
    }
    for (const std::vector<int>& some : different)
        for (const int k : some) ADD_FAILURE() << cases[static_cast<std::size_t>(k)].name();
}

// Materials that nobody has made before, by all threads at the same time.
TEST(Threads, MakeNewMaterialsTogether) {
    const Case c = all_cases().front();
    const std::size_t threads = 4, materials = 200;
    std::vector<std::vector<Numbers>> stresses(threads);
    {
        std::vector<std::jthread> running;
        for (std::size_t t = 0; t < threads; ++t)
            running.emplace_back([&, t] {
                for (std::size_t m = 0; m < materials; ++m) {
                    UmatPoint point(c.material() + "-" + std::to_string(m), c.kind, c.props());
                    Random random(c, m);
                    const Numbers direction = random.direction(static_cast<std::size_t>(point.size()));
                    stresses[t].push_back(point.step({.dstran = scaled(direction, c.scale())}).stress);
                }
            });
    }
    for (std::size_t t = 1; t < threads; ++t)
        for (std::size_t m = 0; m < materials; ++m) EXPECT_TRUE(identical(stresses[t][m], stresses[0][m])) << m;
}

LODE_FOR_ALL_CASES(RandomIncrements);

}  // namespace
}  // namespace lode::test
