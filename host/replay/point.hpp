// The state of the material point between increments, and what happens to it in one.
#ifndef LODE_HOST_REPLAY_POINT_HPP
#define LODE_HOST_REPLAY_POINT_HPP

#include <optional>
#include <vector>

#include "analysis.hpp"
#include "lode/lode.h"

namespace lode::host {

struct Energies {
    double elastic = 0, plastic = 0, creep = 0;  // SSE, SPD, SCD: per current volume
    double sum() const { return elastic + plastic + creep; }
};

struct PointState {
    Components stress;  // Cauchy, global axes
    Components strain;  // total, thermal part included; turned with the material under large rotation
    std::vector<double> state;
    Energies energies;
    Matrix3 F = Matrix3::Identity();
    double temperature = 0;
    std::vector<double> fields;
    double step_time = 0, total_time = 0;
    double work = 0;              // stress power of the mechanical strain, integrated by the trapezoidal rule; per
                                  // reference volume
    double thickness_strain = 0;  // plane stress under VUMAT, where the material reports it
};

struct Increment {
    int step = 1, number = 1;
    double step_time = 0, total_time = 0, dtime = 0;  // times at the start
    double temperature = 0, dtemperature = 0;
    std::vector<double> fields, dfields;
    Components strain, dstrain;  // mechanical; `strain` from the start, turned with `rotation`
    Components total_dstrain;    // thermal part included
    Matrix3 F0 = Matrix3::Identity(), F1 = Matrix3::Identity();
    Matrix3 rotation = Matrix3::Identity();  // DROT
    Matrix3 spin = Matrix3::Zero();
};

// What the material answers.
struct Response {
    Components stress;
    std::vector<double> state;
    Energies energies;
    Tangent tangent;  // empty if the interface has none
    double heat = 0;  // RPL
    double pnewdt = 1;
    double thickness_increment = 0;
    std::optional<lode_observation> observation;  // if it was asked for and the library says it

    bool cut_wanted() const { return !(pnewdt >= 1); }
    bool finite() const { return stress.allFinite(); }
};

}  // namespace lode::host

#endif
