#include "progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace lode::host {
namespace {

using namespace std::chrono_literals;
constexpr auto first_after = 2s;
constexpr auto on_terminal = 200ms;
constexpr auto in_log = 10s;
constexpr int records_between_looks = 64;  // reading the clock costs as much as a cheap material

}  // namespace

Progress::Progress(const Scenario& scenario, bool quiet)
    : steps_(scenario.steps.size()),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0),
      next_(Clock::now() + first_after) {
    for (const Step& step : scenario.steps) whole_time_ += step.time;
}

Progress::~Progress() {
    if (shown_ && terminal_) std::fputs("\r\033[K", stderr);
}

void Progress::observe(const Record& record) {
    if (quiet_ || --until_look_ > 0) return;
    until_look_ = records_between_looks;
    const auto now = Clock::now();
    if (now < next_) return;
    next_ = now + (terminal_ ? Clock::duration(on_terminal) : Clock::duration(in_log));
    const std::string text =
        fmt::format("{:5.1f} %  step {} of {}, increment {}, time {:.6g}", 100 * record.point.total_time / whole_time_,
                    record.step, steps_, record.increment, record.point.total_time);
    std::fputs((terminal_ ? "\r" + text + "\033[K" : text + "\n").c_str(), stderr);
    std::fflush(stderr);
    shown_ = true;
}

}  // namespace lode::host
