// The quadrature points of one rank and the calls of `umat_` at them.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "settings.hpp"

namespace bar {

struct Increment {
    double time, size;  // start, DTIME
    int number;         // KINC
};

// One contiguous array a quantity. The values at the start of the increment are never written by the material: every
// call works on a fresh copy, so that another iteration or a smaller increment begins where this one did.
class MaterialPoints {
  public:
    MaterialPoints(const Material& material, int state_variables, std::size_t count);

    // Where the point is: element and point number from 1, size of the element.
    void place(std::size_t point, int element, int number, const double (&coordinates)[3], double element_length);

    // umat_ from the start of the increment to `strain_increment` (engineering shears) further on. Returns PNEWDT: less
    // than 1 if the material wants a smaller increment; stress and tangent are then of no use.
    double update(std::size_t point, const Increment& increment, const double (&strain_increment)[6],
                  double (&tangent)[36]);
    // What the last calls gave becomes the start of the next increment.
    void accept();
    // Or is forgotten.
    void restore();

    std::size_t size() const { return count_; }
    const double* stress(std::size_t point) const { return &stress_new_[6 * point]; }
    double state(std::size_t point, std::size_t variable) const { return state_new_[nstatv_ * point + variable]; }

  private:
    struct Place {
        double coordinates[3], element_length;
        int element, number;
    };
    std::size_t count_, nstatv_;
    std::array<char, 80> name_;
    std::vector<double> constants_;
    std::vector<double> stress_old_, stress_new_, strain_old_, strain_new_, state_old_, state_new_;
    std::vector<double> energy_old_, energy_new_;  // SSE, SPD, SCD
    std::vector<Place> places_;
};

}  // namespace bar
