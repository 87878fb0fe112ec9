#include "meter.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace lode::host {
namespace {

using namespace std::chrono_literals;
constexpr auto first_after = 2s;
constexpr auto on_terminal = 200ms;
constexpr auto in_log = 10s;

}  // namespace

Meter::Meter(std::string what, int total, bool quiet)
    : what_(std::move(what)),
      total_(total),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0),
      begin_(Clock::now()),
      next_(begin_ + first_after) {}

Meter::~Meter() {
    if (shown_ && terminal_) std::fputs("\r\033[K", stderr);
}

void Meter::advance(const std::string& now) {
    const int before = done_++;
    const auto time = Clock::now();
    if (quiet_ || time < next_ || total_ <= 0) return;
    next_ = time + (terminal_ ? Clock::duration(on_terminal) : Clock::duration(in_log));
    const double spent = std::chrono::duration<double>(time - begin_).count();
    const double left = before > 0 ? spent * (total_ - before) / before : 0;
    const std::string text = fmt::format("{} {:3.0f} %  {} of {}  {}  ({:.0f} s left)", what_, 100.0 * before / total_,
                                         done_, total_, now, left);
    std::fputs((terminal_ ? "\r" + text + "\033[K" : text + "\n").c_str(), stderr);
    std::fflush(stderr);
    shown_ = true;
}

}  // namespace lode::host
