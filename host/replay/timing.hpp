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

// Runs the call guarded against XIT, so many times in a row, and adds the mean time to the count. The first call may
// read in the material; when calls are repeated it is made once more before the clock starts.
template <class Call>
void timed_call(CallCount& count, int points, int repeats, Call&& call) {
    using Clock = std::chrono::steady_clock;
    const double overhead = clock_overhead_ns();
    Clock::time_point begin, end;
    const bool returned = guarded([&] {
        if (repeats > 1) call();
        begin = Clock::now();
        for (int i = 0; i < repeats; ++i) call();
        end = Clock::now();
    });
    ++count.calls;
    count.points += points;
    if (!returned)
        throw Refused(last_library_error().empty() ? "the library ended the analysis (XIT) without a message"
                                                   : "the library ended the analysis: " + last_library_error());
    const double spent =
        std::max(0.0, std::chrono::duration<double, std::nano>(end - begin).count() - overhead) / repeats;
    (count.calls == 1 && repeats == 1 ? count.first_nanoseconds : count.nanoseconds) += spent;
}

}  // namespace lode::host

#endif
