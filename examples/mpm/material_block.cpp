#include "material_block.hpp"

#include <algorithm>
#include <cmath>

#include "lode/entry_points.h"

namespace mpm {

Material material_of(const Settings& s, Group group) {
    const char* const label[group_count] = {"ELASTIC", "BULK", "WEAK"};
    const Vec n = s.prescribed_normal ? s.n() : Vec{};
    const double strength = group == weak ? bar::weakness * bar::tau_nf : bar::tau_nf;
    const double cracks = group == elastic ? 0.0 : 1.0, closest_angle = 30.0;
    Material m;
    m.name = std::string("ELASTIC_DECOHESIVE-") + label[group];
    m.name.resize(LODE_CMNAME_LENGTH, ' ');
    // E, NU, TAU_NF, TAU_SF, TAU_SM, F_C, G_F, F_B, C_N, C_S, C_PSI, CRIT, SOFT, N_C, ALPHA_TH, MU, N_X, N_Y, N_Z,
    // L_C, SNAP, INTEG
    m.props = {bar::E,        bar::nu,
               strength,      bar::tau_sf,
               bar::tau_sm,   bar::f_c,
               bar::G_f,      0.0,
               bar::C_n,      bar::C_s,
               bar::C_psi,    static_cast<double>(s.criterion),
               0.0,           cracks,
               closest_angle, 0.0,
               n.x,           n.y,
               0.0,           0.0,
               0.0,           static_cast<double>(s.integration)};
    m.nstatv = group == elastic ? 4 : 12;
    m.L_c = s.L_c_over_h * s.h;
    return m;
}

MaterialBlock::MaterialBlock(const Material& material, int first_point, int count)
    : material_(&material), first_(first_point), n_(count), nstatv_(material.nstatv) {
    const auto run = [&](int columns, double value) {
        return std::vector<double>(static_cast<std::size_t>(columns * n_), value);
    };
    strain_increment_ = stress_old_ = stress_new_ = run(components, 0.0);
    state_old_ = state_new_ = run(nstatv_, 0.0);
    gradient_old_ = run(components + 1, 0.0);
    stretch_old_ = run(components, 0.0);
    for (int c = 0; c < 3; ++c)
        for (int i = 0; i < n_; ++i) gradient_old_[at(i, c)] = stretch_old_[at(i, c)] = 1.0;
    gradient_new_ = gradient_old_;
    stretch_new_ = stretch_old_;
    internal_old_ = internal_new_ = inelastic_old_ = inelastic_new_ = temperature_ = run(1, 0.0);
    spin_ = run(1, 0.0);
    coordinates_ = run(3, 0.0);
    density_ = run(1, bar::rho);
    length_ = run(1, material.L_c);
}

void MaterialBlock::set_increment(int i, double xx, double xy, double yx, double yy) {
    const double shear = 0.5 * (xy + yx);  // the explicit convention's shears are tensor components
    strain_increment_[at(i, 0)] = xx;
    strain_increment_[at(i, 1)] = yy;
    strain_increment_[at(i, 2)] = 0.0;
    strain_increment_[at(i, 3)] = shear;
    // Displacement gradients are of the order of 1e-3: F and U of the linear theory.
    const double gradient[] = {xx, yy, 0.0, xy, yx}, strain[] = {xx, yy, 0.0, shear};
    for (int c = 0; c <= components; ++c) gradient_new_[at(i, c)] = gradient_old_[at(i, c)] + gradient[c];
    for (int c = 0; c < components; ++c) stretch_new_[at(i, c)] = stretch_old_[at(i, c)] + strain[c];
}

void MaterialBlock::call(double time, double time_step) {
    const int ndir = 3, nshr = 1, nfieldv = 0, lanneal = 0, nprops = static_cast<int>(material_->props.size());
    const double no_field = 0.0;
    vumat_(&n_, &ndir, &nshr, &nstatv_, &nfieldv, &nprops, &lanneal, &time, &time, &time_step, material_->name.data(),
           coordinates_.data(), length_.data(), material_->props.data(), density_.data(), strain_increment_.data(),
           spin_.data(), temperature_.data(), stretch_old_.data(), gradient_old_.data(), &no_field, stress_old_.data(),
           state_old_.data(), internal_old_.data(), inelastic_old_.data(), temperature_.data(), stretch_new_.data(),
           gradient_new_.data(), &no_field, stress_new_.data(), state_new_.data(), internal_new_.data(),
           inelastic_new_.data(), LODE_CMNAME_LENGTH);
}

double MaterialBlock::probe() {
    const double e = 1e-6, lambda = bar::E * bar::nu / ((1.0 + bar::nu) * (1.0 - 2.0 * bar::nu)),
                 mu = 0.5 * bar::E / (1.0 + bar::nu);
    for (int i = 0; i < n_; ++i) set_increment(i, e, e, e, e);
    call(0.0, 1.0);
    const double expected[components] = {2.0 * (lambda + mu) * e, 2.0 * (lambda + mu) * e, 2.0 * lambda * e,
                                         2.0 * mu * e};
    double worst = 0.0;
    for (int i = 0; i < n_; ++i)
        for (int c = 0; c < components; ++c)
            worst = std::max(worst, std::abs(stress_new_[at(i, c)] / expected[c] - 1.0));
    return worst;
}

void MaterialBlock::update(double time, double time_step) {
    call(time, time_step);
    stress_old_.swap(stress_new_);
    state_old_.swap(state_new_);
    gradient_old_.swap(gradient_new_);
    stretch_old_.swap(stretch_new_);
    internal_old_.swap(internal_new_);
    inelastic_old_.swap(inelastic_new_);
}

}  // namespace mpm
