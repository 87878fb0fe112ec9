// Time spent in calls that are about as short as reading the clock.
#ifndef LODE_HOST_REPLAY_TIMING_HPP
#define LODE_HOST_REPLAY_TIMING_HPP

#include <algorithm>
#include <chrono>
#include <limits>

#include "../guard.hpp"
#include "../library.hpp"
#include "../status.hpp"

namespace lode::host {

inline double clock_overhead_ns() {
    using Clock = std::chrono::steady_clock;
    static const double overhead = [] {
        double least = std::numeric_limits<double>::max();
        for (int i = 0; i < 1000; ++i) {
            const auto begin = Clock::now();
            const auto end = Clock::now();
            least = std::min(least, std::chrono::duration<double, std::nano>(end - begin).count());
        }
        return least;
    }();
    return overhead;
}

// Runs the call guarded against XIT and adds it to the count.
template <class Call>
void timed_call(CallCount& count, int points, Call&& call) {
    using Clock = std::chrono::steady_clock;
    const double overhead = clock_overhead_ns();
    Clock::time_point begin, end;
    const bool returned = guarded([&] {
        begin = Clock::now();
        call();
        end = Clock::now();
    });
    ++count.calls;
    count.points += points;
    if (!returned)
        throw Refused(last_library_error().empty() ? "the library ended the analysis (XIT) without a message"
                                                   : "the library ended the analysis: " + last_library_error());
    const double spent = std::max(0.0, std::chrono::duration<double, std::nano>(end - begin).count() - overhead);
    (count.calls == 1 ? count.first_nanoseconds : count.nanoseconds) += spent;
}

}  // namespace lode::host

#endif
