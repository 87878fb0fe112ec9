// The notched plate's plastic strain, drawn by gnuplot.
#pragma once

#include "ccx.hpp"

namespace ccx {

// Rows: element, integration point, value. Writes plastic_strain.dat, .gp and, where gnuplot is installed, .svg.
void draw_plastic_strain(const fs::path& directory, const Mesh& quarter, const std::vector<Numbers>& values);

}  // namespace ccx
