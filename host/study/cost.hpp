// What the calls of a run cost, measured in this process.
#ifndef LODE_HOST_STUDY_COST_HPP
#define LODE_HOST_STUDY_COST_HPP

#include <sched.h>

#include "../replay/driver.hpp"

namespace lode::host {

// Keeps this thread on the processor that it is on, as long as the object lives.
class Pinned {
  public:
    Pinned();
    ~Pinned();
    Pinned(const Pinned&) = delete;
    Pinned& operator=(const Pinned&) = delete;
    bool pinned() const { return pinned_; }

  private:
    cpu_set_t before_;
    bool pinned_ = false;
};

// Nanoseconds for one point to follow the whole path. UMAT: all calls, the host's iterations and cut-backs included.
// VUMAT: one call an increment in blocks of 128 points, without the calls that stress control would cost this host.
struct Cost {
    double median = 0, low = 0, high = 0;  // low and high: quartiles of the repetitions
    double per_call = 0;                   // VUMAT: per point
    int calls = 0, increments = 0;
};

inline constexpr int usual_repetitions = 5;
// The scenario has not been resolved, and has been run before.
Cost measure(Scenario scenario, const Library& library, int repetitions = usual_repetitions);

}  // namespace lode::host

#endif
