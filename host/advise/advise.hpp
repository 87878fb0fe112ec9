// The cheapest setting of a scene that meets a tolerance. Every setting that is named has been run.
#ifndef LODE_HOST_ADVISE_ADVISE_HPP
#define LODE_HOST_ADVISE_ADVISE_HPP

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "../study/candidates.hpp"
#include "../study/cost.hpp"
#include "../study/meter.hpp"

namespace lode::host {

enum class StrainMeasure { as_the_deck_says, small };

// One setting, with what it gave.
struct Option {
    std::string material;   // CMNAME
    std::string algorithm;  // empty if the library does not say
    std::string origin;     // why it was tried: "the deck's material", "isotropic elasticity fitted to ...", ...
    Kind kind = Kind::solid;
    Entry entry = Entry::umat;
    Precision precision = Precision::double_;
    StrainMeasure strain = StrainMeasure::as_the_deck_says;
    int increments = 0;  // a step; 0: as the deck has them
    Scenario scenario;   // ready to run, not resolved
    double error = 0;    // relative, against the reference
    bool sufficient = false;
    std::optional<Cost> cost;
    std::string failure;  // why it could not be run

    std::string interface_name() const { return Interface{entry, precision, nullptr}.name(); }
};

struct Advice {
    double tolerance = 0;
    Reference reference;
    std::string reference_algorithm;
    bool tangent_needed = false;       // some component is found from its stress
    std::vector<Option> options;       // for each way to run the scene its cheapest sufficient, else its best setting
    std::optional<Option> best;        // none: nothing that was run suffices
    std::optional<Option> safest;      // fullest kind, double precision, UMAT with tangent, finest increments
    std::optional<Option> as_written;  // the deck as it is
    std::string verdict;               // if nothing suffices: why
};

struct AdviseSettings {
    double tolerance = 1e-3;
    int finest = 512;  // most increments a step
    // What a scene that is not resolved and has been run costs. Timed, unless somebody knows better.
    std::function<Cost(const Scenario&, const Library&)> cost = [](const Scenario& scene, const Library& library) {
        return measure(scene, library);
    };
};

// The scenario has not been resolved. Throws Refused if it cannot be run at all.
Advice advise(const Scenario& scenario, const Libraries& libraries, const AdviseSettings& settings, Meter* meter);

}  // namespace lode::host

#endif
