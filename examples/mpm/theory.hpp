// The bar in closed form: elastic, with one crack, and with the two columns of points in which a cell opens.
#pragma once

#include "scene.hpp"

namespace mpm {

inline constexpr double elastic_stiffness = bar::W * bar::D * bar::E_star / bar::L;  // load per elongation

// One crack of fracture energy G (5.2.19), its work (5.2.26).
double crack_load(double elongation, double G);
double crack_work(double elongation, double G);

// The discrete bar along the grid: one row of cells of size h, whose two columns of points, one weak, soften over L_c
// each. Uniaxial stress, no inertia.
double discrete_load(double elongation, double h, double L_c);
struct Peak {
    double elongation, load;
};
Peak discrete_peak(double h, double L_c);

}  // namespace mpm
