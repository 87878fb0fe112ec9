// Files of a run: PVTU for ParaView, tables.
#pragma once

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/lac/trilinos_vector.h>

#include <string>
#include <vector>

#include "material_points.hpp"
#include "result.hpp"

namespace bar {

class Output {
  public:
    Output(const std::string& directory, std::vector<std::string> state_names, MPI_Comm communicator);

    // Displacement at the nodes; von Mises stress and all state variables as means of the elements, whose points lie
    // one element after the other in `points`, in the order of the locally owned elements.
    void write_fields(const dealii::DoFHandler<3>& dofs, const dealii::TrilinosWrappers::MPI::Vector& displacement,
                      const MaterialPoints& points, int increment, double time);
    // curve.csv, newton.csv, summary.toml.
    void write_tables(const Result& result) const;
    // mid_plane.dat: the mean of the watched state in the elements at z = 0; mid_plane.gp: a picture of it by gnuplot.
    void write_mid_plane(const dealii::DoFHandler<3>& dofs, const MaterialPoints& points, int watched) const;

  private:
    std::string directory_;
    std::vector<std::string> state_names_;
    MPI_Comm communicator_;
    std::vector<std::pair<double, std::string>> series_;
};

}  // namespace bar
