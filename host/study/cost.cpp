#include "cost.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "../replay/material.hpp"

namespace lode::host {
namespace {

constexpr double wanted_nanoseconds = 4e5;  // timed in a repetition
constexpr int fewest_repeats = 3, most_repeats = 200;
constexpr int block = 128;

double percentile(const std::vector<double>& sorted, double share) {
    const double place = share * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace

Pinned::Pinned() {
    if (sched_getaffinity(0, sizeof before_, &before_) != 0) return;
    cpu_set_t here;
    CPU_ZERO(&here);
    const int processor = sched_getcpu();
    if (processor < 0) return;
    CPU_SET(static_cast<std::size_t>(processor), &here);
    pinned_ = sched_setaffinity(0, sizeof here, &here) == 0;
}

Pinned::~Pinned() {
    if (pinned_) sched_setaffinity(0, sizeof before_, &before_);
}

Cost measure(Scenario scenario, const Library& library, int repetitions) {
    const bool blocks = scenario.analysis.entry == Entry::vumat;
    if (blocks) scenario.analysis.block = block;
    resolve(scenario, library);
    Cost cost;
    const auto run = [&](int repeats) {
        const auto material = make_material(scenario, library);
        material->repeat_calls(repeats);
        const Outcome outcome = drive(scenario, *material, [](const Record&) {});
        const CallCount& calls = outcome.statistics.calls;
        cost.calls = static_cast<int>(calls.calls);
        cost.increments = outcome.statistics.increments;
        // Blocks: the calls of the probe and of stress control cost the same as the others but are not of the path.
        if (blocks) return calls.nanoseconds / static_cast<double>(calls.points) * cost.increments;
        return calls.nanoseconds;
    };
    const double guess = run(2);
    const double block_time = blocks ? guess * block : guess;
    const int repeats = static_cast<int>(
        std::clamp(wanted_nanoseconds / std::max(block_time, 1.0), double{fewest_repeats}, double{most_repeats}));
    const Pinned pinned;
    std::vector<double> times;
    for (int i = 0; i < repetitions; ++i) times.push_back(run(repeats));
    std::sort(times.begin(), times.end());
    cost.median = percentile(times, 0.5);
    cost.low = percentile(times, 0.25);
    cost.high = percentile(times, 0.75);
    cost.per_call = cost.median / std::max(blocks ? cost.increments : cost.calls, 1);
    return cost;
}

}  // namespace lode::host
