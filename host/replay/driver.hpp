// Drives a material point through the steps of a scenario. No files, no printing: observers see every increment.
#ifndef LODE_HOST_REPLAY_DRIVER_HPP
#define LODE_HOST_REPLAY_DRIVER_HPP

#include <functional>
#include <string>
#include <vector>

#include "../library.hpp"
#include "../status.hpp"
#include "point.hpp"
#include "scenario.hpp"

namespace lode::host {

// An increment that was accepted. The first record, with `increment` 0, is the initial state and has no response.
struct Record {
    int step = 0, increment = 0;
    const std::string& step_name;
    double dtime = 0;
    int iterations = 0;
    const PointState& point;
    const Response* response = nullptr;
    const std::vector<double>* residuals = nullptr;  // largest residual stress before every correction and at the end
};
class Material;
using Observer = std::function<void(const Record&)>;

struct Statistics {
    int increments = 0, cut_backs = 0;
    int iterations = 0, most_iterations = 0;  // Newton corrections of accepted increments
    CallCount calls;
};

struct Outcome {
    Status status = Status::success;
    std::string message;  // if not success
    std::vector<std::string> remarks;
    Statistics statistics;
};

// Fills in what the deck left to the library: STATEV, large rotation, named initial state. Throws Refused or BadDeck.
void resolve(Scenario& scenario, const Library& library);

// The closed forms of manufactured steps, part of `resolve`; once more where the interface has changed. Throws BadDeck.
void find_solutions(Scenario& scenario);

// The scenario has been resolved. Throws NotLoaded if the library lacks the entry point; all else is in the outcome.
Outcome drive(const Scenario& scenario, const Library& library, const Observer& observer);
// The same with a material made before (make_material).
Outcome drive(const Scenario& scenario, Material& material, const Observer& observer);

}  // namespace lode::host

#endif
