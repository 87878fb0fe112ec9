// The largest stable time step of a one-element oscillator that is integrated explicitly, its stress from vumat_.
#ifndef LODE_HOST_ATLAS_TIME_STEP_HPP
#define LODE_HOST_ATLAS_TIME_STEP_HPP

#include <string>
#include <vector>

#include "../replay/scenario.hpp"
#include "../study/material_point.hpp"
#include "sheet.hpp"

namespace lode::host {

// Two nodes with half the mass of an element each, joined by the element: the strain in one component is their
// distance over the element length. Central differences; the exact limit is length / sqrt(modulus / density).
// True if the amplitude stays bounded over `steps` steps.
bool oscillator_is_stable(MaterialPoint& point, int component, double density, double length, double amplitude,
                          double time_step, int steps);

struct TimeStepLimit {
    std::string component;
    double prestrain = 0;
    double found = 0;             // by bisection
    double estimate = 0;          // element length over the wave speed of the virgin state, its stiffer side
    double softer = 0;            // the same of its softer side: contact, say, makes them differ
    bool rate_dependent = false;  // the stiffness depends on the step; damping makes the stable one smaller
};

// Per component in the virgin state.
std::vector<TimeStepLimit> time_step_limits(const Scenario& scenario, const Library& library, double strain_scale);
// For component 1 along a stretch; for materials without history.
std::vector<TimeStepLimit> time_step_along(const Scenario& scenario, const Library& library, double strain_scale,
                                           int points);

Sheet time_step_sheet(const std::vector<TimeStepLimit>& limits, const std::vector<TimeStepLimit>& along,
                      const std::string& stem, const std::string& title);

}  // namespace lode::host

#endif
