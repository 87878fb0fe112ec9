// A line on standard error while a run takes long.
#ifndef LODE_HOST_REPLAY_PROGRESS_HPP
#define LODE_HOST_REPLAY_PROGRESS_HPP

#include <chrono>

#include "driver.hpp"

namespace lode::host {

class Progress {
  public:
    Progress(const Scenario& scenario, bool quiet);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    void observe(const Record& record);

  private:
    using Clock = std::chrono::steady_clock;
    double whole_time_ = 0;
    std::size_t steps_;
    bool quiet_, terminal_, shown_ = false;
    int until_look_ = 0;
    Clock::time_point next_;
};

}  // namespace lode::host

#endif
