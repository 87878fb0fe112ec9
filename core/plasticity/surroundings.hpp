// What a hardening law of ISO_PLASTIC may depend on besides alpha, and what the update asks of it.
//
// A law is a struct with the flags below and, for a number type Real,
//   At<Real> at(surroundings)                             the law in this increment
//   FlowStress start(at, alpha)                           K_n = K(alpha_n) at rate 0
//   FlowStress flow(at, alpha, x)                         K after dalpha = x, derivatives by x at constant time
//   ReturnResult solve<line>(at, q_trial, alpha, K_n, yields)
//   double plastic_share<line>(at, H)                     S/(S + H), S the stiffness of the line
//   PlasticWork work(at, alpha, dalpha, K_n, K)           of the increment
//   HeatSlopes slopes(at, alpha, dalpha, K_n, K)          of laws that feel temperature
// softens: needs h/LREF. feels_rate, feels_temperature. changes_shear: `at.shear_ratio` is G/G0. melts: `at.melted`.
// remembers: has a state of its own, `memory`.
#pragma once

#include "lode/material/point.hpp"
#include "lode/plasticity/hardening_curves.hpp"

namespace lode {

// The line on which the equivalent stress falls with dalpha: by 3G (three dimensions) or by E (one).
enum Line { radial, axial };

// Dislocation densities of HLAW 7 in cell interiors and walls.
template <class Real>
struct Densities {
    Real interior, wall;
};

template <class Real>
struct Surroundings {
    Real temperature = Real(0.0);  // theta
    Real pressure = Real(0.0);     // at the start of the increment
    Real scale = Real(1.0);        // h/LREF of a softening law
    TimeIncrement time;            // of the step: DTIME, or its part
    Densities<Real> densities{Real(0.0), Real(0.0)};
};

// Plastic work per volume, friction dalpha + stored: `friction` is K - psi, the part of K that the source rule turns
// into heat, `stored` the increment of A.
template <class Real>
struct PlasticWork {
    Real friction, stored;
};

// How K, the heat of the source rule (friction dalpha) and the plastic work answer to dalpha and to temperature.
struct HeatSlopes {
    double flow_temperature = 0.0;
    double source_strain = 0.0, source_temperature = 0.0;
    double work_strain = 0.0, work_temperature = 0.0;
};

}  // namespace lode
