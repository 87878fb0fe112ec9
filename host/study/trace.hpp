// What a run gave, in a form that runs of different kinds, increments and interfaces can be compared in.
#ifndef LODE_HOST_STUDY_TRACE_HPP
#define LODE_HOST_STUDY_TRACE_HPP

#include <array>
#include <string>
#include <vector>

#include "../library.hpp"
#include "../replay/driver.hpp"

namespace lode::host {

// Components by their place in the fullest kind (11, 22, 33, 12, 13, 23 or n, s1, s2). A stress that a kind does not
// have is zero there; a strain that it does not have is NaN.
struct TracePoint {
    double time = 0;
    std::array<double, 6> stress{}, strain{};
    Energies energies;
};

struct Trace {
    Outcome outcome;
    std::vector<TracePoint> points;  // one an increment, the initial state first

    bool complete() const { return outcome.status == Status::success; }
};

// Resolves and drives the scenario. Refusals of the library are in the outcome.
Trace follow(Scenario scenario, const Library& library);

// The difference of two traces at the times that they have in common, relative to the largest stress and strain of the
// second one. Strains count where they are not prescribed.
struct Difference {
    double stress = 0, strain = 0;
    double dissipation = 0;  // SPD + SCD, relative to the largest energy
    int common = 0;          // times
    double worst() const { return stress > strain ? stress : strain; }
};
Difference difference(const Trace& trace, const Trace& reference, bool compare_strain);

// Stress scale of a trace: its largest norm.
double largest_stress(const Trace& trace);

}  // namespace lode::host

#endif
