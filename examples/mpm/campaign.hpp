// Many runs, several at a time, each on one thread.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "measures.hpp"

namespace mpm {

class Campaign {
  public:
    // Elongations at which all runs keep their points, besides the end.
    std::vector<double> snapshots_at;

    // A run asked for twice is done once.
    void add(const Settings& settings);
    // Does what has been added; progress goes to stderr.
    void run(int at_a_time);
    bool has(const Settings& settings) const { return results_.count(settings.name()) > 0; }
    const Result& operator[](const Settings& settings) const { return results_.at(settings.name()); }
    double seconds() const { return seconds_; }

  private:
    std::vector<Settings> waiting_;
    std::map<std::string, Result> results_;
    double seconds_ = 0.0;
};

}  // namespace mpm
