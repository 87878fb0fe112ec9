// Material points of one group, given to `vumat_` as explicit hosts do it: in blocks, one contiguous run of points a
// component.
#pragma once

#include <string>
#include <vector>

#include "scene.hpp"

namespace mpm {

inline constexpr int components = 4;  // plane strain: 11, 22, 33, 12

struct Material {
    std::string name;  // CMNAME: 80 characters, blank padded
    std::vector<double> props;
    int nstatv;
    double L_c;
};
// ELASTIC_DECOHESIVE for a group of the scene.
Material material_of(const Settings& settings, Group group);

class MaterialBlock {
  public:
    static constexpr int largest = 128;

    MaterialBlock(const Material& material, int first_point, int count);

    // The explicit host's first call, with made-up strains at time 0: its stress is the elastic one, nothing is kept.
    // The largest deviation from Hooke's law, relative.
    double probe();

    // Velocity gradient of point i (0 ... count - 1), times the time step.
    void set_increment(int i, double xx, double xy, double yx, double yy);
    // vumat_ for the increments set: stresses and states become new ones.
    void update(double time, double time_step);

    int first_point() const { return first_; }
    int count() const { return n_; }
    double stress(int i, int component) const { return stress_old_[at(i, component)]; }
    double state(int i, int k) const { return state_old_[at(i, k - 1)]; }  // STATEV(k), from 1
    int nstatv() const { return nstatv_; }
    // Per unit mass: stress power, dissipation.
    double internal_energy(int i) const { return internal_old_[at(i, 0)]; }
    double inelastic_energy(int i) const { return inelastic_old_[at(i, 0)]; }

  private:
    std::size_t at(int i, int component) const { return static_cast<std::size_t>(component * n_ + i); }
    void call(double time, double time_step);

    const Material* material_;
    int first_, n_, nstatv_;
    std::vector<double> strain_increment_, stress_old_, stress_new_, state_old_, state_new_;
    std::vector<double> gradient_old_, gradient_new_, stretch_old_, stretch_new_;  // F: 11, 22, 33, 12, 21; U
    std::vector<double> internal_old_, internal_new_, inelastic_old_, inelastic_new_;
    std::vector<double> spin_, temperature_, density_, length_, coordinates_;
};

}  // namespace mpm
