#include "output.hpp"

#include <deal.II/base/mpi.h>
#include <deal.II/numerics/data_out.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "mesh.hpp"

namespace bar {
namespace {

struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
std::unique_ptr<std::FILE, Close> open(const std::string& name) {
    std::unique_ptr<std::FILE, Close> file(std::fopen(name.c_str(), "w"));
    if (!file) throw std::runtime_error("cannot write " + name);
    return file;
}

double von_mises(const double* s) {
    const double d1 = s[0] - s[1], d2 = s[1] - s[2], d3 = s[2] - s[0];
    return std::sqrt(0.5 * (d1 * d1 + d2 * d2 + d3 * d3) + 3 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

// Calls f(cell, first of its points, number of its points).
template <class F>
void for_owned_cells(const dealii::DoFHandler<3>& dofs, const MaterialPoints& points, F f) {
    const auto& mesh = dynamic_cast<const dealii::parallel::distributed::Triangulation<3>&>(dofs.get_triangulation());
    const std::size_t cells = mesh.n_locally_owned_active_cells(), n = cells > 0 ? points.size() / cells : 0;
    std::size_t first = 0;
    for (const auto& cell : dofs.active_cell_iterators()) {
        if (!cell->is_locally_owned()) continue;
        f(cell, first, n);
        first += n;
    }
}

}  // namespace

Output::Output(const std::string& directory, std::vector<std::string> state_names, MPI_Comm communicator)
    : directory_(directory + "/"), state_names_(std::move(state_names)), communicator_(communicator) {
    if (dealii::Utilities::MPI::this_mpi_process(communicator_) == 0) std::filesystem::create_directories(directory);
    MPI_Barrier(communicator_);
}

void Output::write_fields(const dealii::DoFHandler<3>& dofs, const dealii::TrilinosWrappers::MPI::Vector& displacement,
                          const MaterialPoints& points, int increment, double time) {
    using dealii::DataComponentInterpretation::component_is_part_of_vector;
    const unsigned cells = dofs.get_triangulation().n_active_cells();
    dealii::Vector<float> mises(cells), rank(cells);
    std::vector<dealii::Vector<float>> states(state_names_.size(), dealii::Vector<float>(cells));
    for_owned_cells(dofs, points, [&](const auto& cell, std::size_t first, std::size_t n) {
        const unsigned c = cell->active_cell_index();
        rank[c] = static_cast<float>(cell->subdomain_id());
        double sum = 0;
        for (std::size_t i = first; i < first + n; ++i) sum += von_mises(points.stress(i));
        mises[c] = static_cast<float>(sum / static_cast<double>(n));
        for (std::size_t k = 0; k < states.size(); ++k) {
            sum = 0;
            for (std::size_t i = first; i < first + n; ++i) sum += points.state(i, k);
            states[k][c] = static_cast<float>(sum / static_cast<double>(n));
        }
    });
    dealii::DataOut<3> out;
    out.attach_dof_handler(dofs);
    out.add_data_vector(
        displacement, std::vector<std::string>(3, "displacement"), dealii::DataOut<3>::type_dof_data,
        std::vector<dealii::DataComponentInterpretation::DataComponentInterpretation>(3, component_is_part_of_vector));
    out.add_data_vector(mises, "von_Mises_stress", dealii::DataOut<3>::type_cell_data);
    out.add_data_vector(rank, "rank", dealii::DataOut<3>::type_cell_data);
    for (std::size_t k = 0; k < states.size(); ++k)
        out.add_data_vector(states[k], state_names_[k], dealii::DataOut<3>::type_cell_data);
    out.build_patches();
    const std::string file =
        out.write_vtu_with_pvtu_record(directory_, "bar", static_cast<unsigned>(increment), communicator_, 4);
    series_.emplace_back(time, file);
    if (dealii::Utilities::MPI::this_mpi_process(communicator_) == 0) {
        std::ofstream list(directory_ + "bar.pvd");
        dealii::DataOutBase::write_pvd_record(list, series_);
    }
}

void Output::write_tables(const Result& r) const {
    if (dealii::Utilities::MPI::this_mpi_process(communicator_) != 0) return;
    const auto curve = open(directory_ + "curve.csv"), newton = open(directory_ + "newton.csv"),
               summary = open(directory_ + "summary.toml");
    std::fprintf(curve.get(), "increment,time,size,elongation,force,watched,newton_iterations,linear_iterations\n");
    std::fprintf(newton.get(), "increment,iteration,residual\n");
    int newton_iterations = 0, linear_iterations = 0;
    for (std::size_t i = 0; i < r.increments.size(); ++i) {
        const AcceptedIncrement& a = r.increments[i];
        const auto iterations = static_cast<int>(a.residuals.size());
        std::fprintf(curve.get(), "%zu,%.17g,%.17g,%.15e,%.15e,%.15e,%d,%d\n", i + 1, a.time, a.size, a.elongation,
                     a.force, a.watched, iterations, a.linear_iterations);
        for (std::size_t k = 0; k < a.residuals.size(); ++k)
            std::fprintf(newton.get(), "%zu,%zu,%.6e\n", i + 1, k, a.residuals[k]);
        newton_iterations += iterations;
        linear_iterations += a.linear_iterations;
    }
    std::fprintf(summary.get(),
                 "finished = %s\nranks = %d\nelements = %llu\nunknowns = %llu\npoints = %llu\nincrements = %zu\n"
                 "newton_iterations = %d\nlinear_iterations = %d\nrefused_by_material = %d\nrefused_by_newton = %d\n"
                 "ranks_asking = %d\nlinear_solver = \"%s\"\n[seconds]\nassembly = %.4f\numat = %.4f\nsolve = "
                 "%.4f\ntotal = %.4f\nprocessor = %.4f\n",
                 r.finished ? "true" : "false", r.ranks, r.elements, r.unknowns, r.points, r.increments.size(),
                 newton_iterations, linear_iterations, r.refused_by_material, r.refused_by_newton, r.ranks_asking,
                 r.linear_solver.c_str(), r.seconds.assembly, r.seconds.umat, r.seconds.solve, r.seconds.total,
                 r.seconds.processor);
}

void Output::write_mid_plane(const dealii::DoFHandler<3>& dofs, const MaterialPoints& points, int watched) const {
    std::vector<std::array<double, 9>> patches;
    for_owned_cells(dofs, points, [&](const auto& cell, std::size_t first, std::size_t n) {
        for (const auto& face : cell->face_iterators()) {
            if (!face->at_boundary() || face->boundary_id() != plane_z) continue;
            std::array<double, 9> patch{};
            for (unsigned v = 0; v < 4; ++v) {
                patch[2 * v] = face->vertex(v)[0];
                patch[2 * v + 1] = face->vertex(v)[1];
            }
            for (std::size_t i = first; i < first + n; ++i)
                patch[8] += points.state(i, static_cast<std::size_t>(watched)) / static_cast<double>(n);
            patches.push_back(patch);
        }
    });
    const auto all = dealii::Utilities::MPI::gather(communicator_, patches, 0);
    if (all.empty()) return;
    // Each element as a grid of two by two points, as gnuplot has surfaces.
    const auto data = open(directory_ + "mid_plane.dat"), script = open(directory_ + "mid_plane.gp");
    for (const auto& of_rank : all)
        for (const auto& p : of_rank)
            std::fprintf(data.get(), "%.6g %.6g %.6g\n%.6g %.6g %.6g\n\n%.6g %.6g %.6g\n%.6g %.6g %.6g\n\n\n", p[0],
                         p[1], p[8], p[2], p[3], p[8], p[4], p[5], p[8], p[6], p[7], p[8]);
    std::fprintf(script.get(),
                 "set terminal pngcairo size 400,780 background 'white'\n"
                 "set output 'mid_plane.png'\n"
                 "set title '%s'\n"
                 "set lmargin 0\nset rmargin 3\nset tmargin 2\nset bmargin 0\n"
                 "set view map\nset size ratio -1\nunset key\nset border 0\nunset xtics\nunset ytics\n"
                 "set pm3d corners2color c1\n"
                 "set palette defined (0 '#f4f1ea', 0.15 '#f7d88c', 0.45 '#ee7f3b', 0.75 '#b3263c', 1 '#3b0f4d')\n"
                 "set cbrange [0:*]\n"
                 "splot 'mid_plane.dat' using 1:2:3 with pm3d, '' using (-$1):2:3 with pm3d, \\\n"
                 "      '' using 1:(-$2):3 with pm3d, '' using (-$1):(-$2):3 with pm3d\n",
                 state_names_[static_cast<std::size_t>(watched)].c_str());
}

}  // namespace bar
