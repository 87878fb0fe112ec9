// What a run came to, in a page of text.
#ifndef LODE_HOST_REPLAY_SUMMARY_HPP
#define LODE_HOST_REPLAY_SUMMARY_HPP

#include <string>
#include <vector>

#include "driver.hpp"

namespace lode::host {

class Summary {
  public:
    explicit Summary(const Scenario& scenario);
    void observe(const Record& record);
    std::string text(const Outcome& outcome, const Library& library) const;

  private:
    struct Extremes {
        double least = 0, most = 0, last = 0;
        double least_time = 0, most_time = 0;
    };
    static void widen(Extremes& extremes, double value, double time, bool first);

    const Scenario& scenario_;
    Layout layout_;
    std::vector<Extremes> strain_, stress_;
    PointState last_;
    double initial_energy_ = 0, largest_energy_ = 0;
    bool first_ = true;
};

}  // namespace lode::host

#endif
