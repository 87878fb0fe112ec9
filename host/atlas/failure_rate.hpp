// How often an increment cannot be done or needs a safeguard, and what it costs, over its size: random increments from
// random states.
#ifndef LODE_HOST_ATLAS_FAILURE_RATE_HPP
#define LODE_HOST_ATLAS_FAILURE_RATE_HPP

#include <string>
#include <vector>

#include "../library.hpp"
#include "../replay/scenario.hpp"
#include "../study/meter.hpp"
#include "sheet.hpp"

namespace lode::host {

struct FailureRate {
    double size = 0;         // norm of the increment
    int tried = 0, cut = 0;  // increments, and those for which a smaller one was asked for
    double nanoseconds = 0;  // mean of the calls
    // Where the library says it: mean and largest number of iterations, and increments in which a safeguard took steps.
    double iterations = 0;
    int most_iterations = 0, safeguarded = 0;
};

struct Algorithm {
    std::string name;
    Scenario scenario;
};
struct AlgorithmRates {
    std::string name;
    std::vector<FailureRate> rates;  // over the sizes
    bool observed = false;           // the library says what solutions take

    bool is_ever_safeguarded() const;
};

// The states are on random walks of `walker`, the same for all algorithms, with steps up to `strain_scale`; the
// increments are the same as well. Algorithms that the constants refuse are left out.
std::vector<AlgorithmRates> failure_rates(const Scenario& walker, const std::vector<Algorithm>& algorithms,
                                          const Library& library, double strain_scale, const std::vector<double>& sizes,
                                          int states, Meter* meter);

Sheet failure_sheet(const std::vector<AlgorithmRates>& rates, const std::string& stem, const std::string& title);
// How often a safeguard is used, and the iterations.
Sheet safeguard_sheet(const std::vector<AlgorithmRates>& rates, const std::string& stem, const std::string& title);

}  // namespace lode::host

#endif
