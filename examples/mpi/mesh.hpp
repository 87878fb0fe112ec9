// An eighth of the bar, distributed over the ranks.
#pragma once

#include <deal.II/distributed/tria.h>

#include "settings.hpp"

namespace bar {

// Parts of the boundary; the planes of symmetry are x = 0, y = 0 and z = 0.
enum Boundary : dealii::types::boundary_id { free_surface, plane_x, plane_y, plane_z, face_z, end, notch };

void make_mesh(dealii::parallel::distributed::Triangulation<3>& mesh, const Geometry& geometry);

}  // namespace bar
