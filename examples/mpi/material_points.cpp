#include "material_points.hpp"

#include <algorithm>

#include "lode/entry_points.h"

namespace bar {

MaterialPoints::MaterialPoints(const Material& material, int state_variables, std::size_t count)
    : count_(count), nstatv_(static_cast<std::size_t>(state_variables)), constants_(material.constants) {
    name_.fill(' ');
    std::copy_n(material.name.begin(), std::min(material.name.size(), name_.size()), name_.begin());
    stress_old_.resize(6 * count_);
    state_old_.resize(nstatv_ * count_);
    for (std::size_t i = 0; i < count_; ++i) {
        std::copy(material.initial_stress.begin(), material.initial_stress.end(), &stress_old_[6 * i]);
        std::copy(material.initial_state.begin(), material.initial_state.end(), state_old_.data() + nstatv_ * i);
    }
    stress_new_ = stress_old_;
    state_new_ = state_old_;
    strain_old_.resize(6 * count_);
    strain_new_.resize(6 * count_);
    energy_old_.resize(3 * count_);
    energy_new_.resize(3 * count_);
    places_.resize(count_);
}

void MaterialPoints::place(std::size_t point, int element, int number, const double (&coordinates)[3],
                           double element_length) {
    Place& p = places_[point];
    std::copy_n(coordinates, 3, p.coordinates);
    p.element_length = element_length;
    p.element = element;
    p.number = number;
}

double MaterialPoints::update(std::size_t point, const Increment& increment, const double (&strain_increment)[6],
                              double (&tangent)[36]) {
    const Place& p = places_[point];
    double* const stress = &stress_new_[6 * point];
    double* const state = state_new_.data() + nstatv_ * point;
    double* const energy = &energy_new_[3 * point];
    const double* const strain = &strain_old_[6 * point];
    std::copy_n(&stress_old_[6 * point], 6, stress);
    std::copy_n(state_old_.data() + nstatv_ * point, nstatv_, state);
    std::copy_n(&energy_old_[3 * point], 3, energy);
    for (int i = 0; i < 6; ++i) strain_new_[6 * point + static_cast<std::size_t>(i)] = strain[i] + strain_increment[i];

    // Small strain: the deformation gradient is not passed on. No temperature, no fields.
    const double unit[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, zero = 0, time[2] = {increment.time, increment.time};
    double heat = 0, stress_by_temperature[6], heat_by_strain[6], heat_by_temperature = 0, pnewdt = 1;
    const int ndi = 3, nshr = 3, ntens = 6, nstatv = static_cast<int>(nstatv_),
              nprops = static_cast<int>(constants_.size()), one = 1;
    umat_(stress, state, tangent, &energy[0], &energy[1], &energy[2], &heat, stress_by_temperature, heat_by_strain,
          &heat_by_temperature, strain, strain_increment, time, &increment.size, &zero, &zero, &zero, &zero,
          name_.data(), &ndi, &nshr, &ntens, &nstatv, constants_.data(), &nprops, p.coordinates, unit, &pnewdt,
          &p.element_length, unit, unit, &p.element, &p.number, &one, &one, &one, &increment.number,
          LODE_CMNAME_LENGTH);
    return pnewdt;
}

void MaterialPoints::accept() {
    stress_old_ = stress_new_;
    state_old_ = state_new_;
    strain_old_ = strain_new_;
    energy_old_ = energy_new_;
}

void MaterialPoints::restore() {
    stress_new_ = stress_old_;
    state_new_ = state_old_;
    strain_new_ = strain_old_;
    energy_new_ = energy_old_;
}

}  // namespace bar
