// The ways in which a scene can be run: algorithms of its model with their references, and interfaces.
#ifndef LODE_HOST_STUDY_CANDIDATES_HPP
#define LODE_HOST_STUDY_CANDIDATES_HPP

#include <optional>
#include <string>
#include <vector>

#include "libraries.hpp"
#include "reference.hpp"

namespace lode::host {

struct Interface {
    Entry entry;
    Precision precision;
    const Library* library;
    std::string name() const;  // "UMAT", "VUMAT", "VUMAT single"
};
// UMAT, VUMAT and VUMAT in single precision, as far as they are there.
std::vector<Interface> interfaces(const Libraries& libraries);

// An algorithm of the model with its own limit for small increments.
struct Candidate {
    const lode_algorithm* algorithm = nullptr;  // null: the library does not describe the model
    Scenario scenario;
    Reference reference;
    bool own_law = false;  // it tends to another solution than the algorithm that the constants select

    std::string name() const { return algorithm != nullptr ? algorithm->name : ""; }
    double order() const;
};

// Algorithms of the scenario's model; one null pointer if the library does not describe it.
std::vector<const lode_algorithm*> algorithms_of(const Scenario& scenario, const Library& library);

// Every algorithm that can run the scene; the first one is what the constants select. `increments` are those that
// errors will be asked for. Throws Refused if the scene cannot be run as it is.
std::vector<Candidate> candidates_for(const Scenario& scenario, const Library& library,
                                      const std::vector<int>& increments);
const Candidate& most_accurate(const std::vector<Candidate>& candidates);

// The scenario with so many increments a step, as an interface sees it: where stresses are prescribed, an explicit host
// would give its materials strains, here those of the reference. None if they are not known at all times.
std::optional<Scenario> scene_for(const Scenario& scenario, const Interface& interface, const Libraries& libraries,
                                  int increments, const Reference& reference);

}  // namespace lode::host

#endif
