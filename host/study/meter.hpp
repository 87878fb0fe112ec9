// A line on standard error that says how far a long run has come.
#ifndef LODE_HOST_STUDY_METER_HPP
#define LODE_HOST_STUDY_METER_HPP

#include <chrono>
#include <string>

namespace lode::host {

class Meter {
  public:
    Meter(std::string what, int total, bool quiet);
    ~Meter();
    Meter(const Meter&) = delete;
    Meter& operator=(const Meter&) = delete;
    // One more done; `now` is what comes next.
    void advance(const std::string& now);

  private:
    using Clock = std::chrono::steady_clock;
    std::string what_;
    int total_, done_ = 0;
    bool quiet_, terminal_, shown_ = false;
    Clock::time_point begin_, next_;
};

}  // namespace lode::host

#endif
