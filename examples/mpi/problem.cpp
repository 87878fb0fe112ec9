#include "problem.hpp"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/sparsity_tools.h>
#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_solver.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>

#include "material_points.hpp"
#include "mesh.hpp"
#include "output.hpp"

namespace bar {
namespace {

using dealii::IndexSet;
using dealii::SolverControl;
using Vector = dealii::TrilinosWrappers::MPI::Vector;

constexpr unsigned nodes = 8, unknowns_of_cell = 3 * nodes, points_of_cell = 8;
using StrainMatrix = double[6][unknowns_of_cell];

// Adds the seconds of its life to a sum.
class Stopwatch {
  public:
    explicit Stopwatch(double& sum) : sum_(sum), start_(MPI_Wtime()) {}
    ~Stopwatch() { sum_ += MPI_Wtime() - start_; }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

  private:
    double& sum_;
    double start_;
};

// Strain of a trilinear element, 11, 22, 33, 12, 13, 23 with engineering shears. The volume strain is the element's
// mean (B-bar), for with its own at every point the element would lock where the material flows without change of
// volume. `gradient` is that of the nodes' shape functions.
template <class Gradient>
void fill_strain_matrix(const Gradient& gradient, const double (&mean)[nodes][3], StrainMatrix& B) {
    for (unsigned a = 0; a < nodes; ++a) {
        const auto& g = gradient(a);
        for (unsigned c = 0; c < 3; ++c) {
            const unsigned column = 3 * a + c;
            const double volume = (mean[a][c] - g[c]) / 3;
            for (unsigned row = 0; row < 3; ++row) B[row][column] = volume + (row == c ? g[c] : 0);
            B[3][column] = c == 0 ? g[1] : c == 1 ? g[0] : 0;
            B[4][column] = c == 0 ? g[2] : c == 2 ? g[0] : 0;
            B[5][column] = c == 1 ? g[2] : c == 2 ? g[1] : 0;
        }
    }
}

bool is_symmetric(const double (&tangent)[36]) {
    double largest = 0, difference = 0;
    for (unsigned i = 0; i < 6; ++i)
        for (unsigned j = 0; j <= i; ++j) {
            largest = std::max(largest, std::abs(tangent[6 * i + j]));
            difference = std::max(difference, std::abs(tangent[6 * i + j] - tangent[6 * j + i]));
        }
    return difference <= 1e-12 * largest;
}

}  // namespace

struct Problem::Implementation {
    Implementation(const Settings& s, const MaterialFacts& f, MPI_Comm c);
    Result run();

  private:
    enum class Outcome { converged, refused_by_material, refused_by_newton };
    struct Trial {
        Outcome outcome = Outcome::converged;
        double factor = 0.25;  // of the next attempt, if refused
        int linear_iterations = 0;
        std::vector<double> residuals;
    };
    struct Forces {
        double pnewdt;   // smallest of all points of all ranks
        double at_end;   // of the modelled part
        bool symmetric;  // all tangents are
    };

    void set_constraints(double end_displacement);
    // Internal forces, tangent stiffness, right-hand side for the displacement increment `relevant_`.
    Forces assemble(const Increment& increment);
    // Solves for `correction_`; false if the iteration does not end.
    bool solve(bool symmetric, double reduction, int& iterations);
    Trial try_increment(const Increment& increment);
    void put_in_balance();
    double largest_watched() const;

    const Settings settings_;
    const MaterialFacts facts_;
    const MPI_Comm communicator_;
    const bool speaks_;  // rank 0
    const double end_displacement_;
    dealii::parallel::distributed::Triangulation<3> mesh_;
    const dealii::FESystem<3> element_;
    const dealii::QGauss<3> quadrature_;
    dealii::DoFHandler<3> dofs_;
    IndexSet owned_, relevant_set_;
    std::vector<bool> at_end_;  // relevant unknowns: displacement along the bar at its end
    dealii::AffineConstraints<double> constraints_;
    dealii::TrilinosWrappers::SparseMatrix stiffness_;
    Vector external_, right_hand_side_, correction_, increment_, displacement_, relevant_;
    std::vector<std::vector<bool>> translations_;
    std::unique_ptr<MaterialPoints> points_;
    Vector accepted_increment_;
    double accepted_size_ = 0;
    double last_force_ = 0;  // on the end of the modelled part
    int ranks_asking_ = 0;
    bool used_gmres_ = false;
    Result::Seconds seconds_;
};

Problem::Implementation::Implementation(const Settings& s, const MaterialFacts& f, MPI_Comm c)
    : settings_(s),
      facts_(f),
      communicator_(c),
      speaks_(dealii::Utilities::MPI::this_mpi_process(c) == 0),
      end_displacement_(s.loading.elongation / 2),
      mesh_(c),
      element_(dealii::FE_Q<3>(1), 3),
      quadrature_(2),
      dofs_(mesh_) {
    make_mesh(mesh_, settings_.geometry);
    dofs_.distribute_dofs(element_);
    owned_ = dofs_.locally_owned_dofs();
    dealii::DoFTools::extract_locally_relevant_dofs(dofs_, relevant_set_);
    const IndexSet end_set = dealii::DoFTools::extract_boundary_dofs(
        dofs_, element_.component_mask(dealii::FEValuesExtractors::Scalar(1)), {end});
    at_end_.resize(relevant_set_.n_elements());
    for (const auto dof : end_set)
        if (relevant_set_.is_element(dof)) at_end_[relevant_set_.index_within_set(dof)] = true;

    set_constraints(0);
    dealii::DynamicSparsityPattern pattern(relevant_set_);
    dealii::DoFTools::make_sparsity_pattern(dofs_, pattern, constraints_, false);
    dealii::SparsityTools::distribute_sparsity_pattern(pattern, owned_, communicator_, relevant_set_);
    stiffness_.reinit(owned_, owned_, pattern, communicator_);
    for (Vector* v : {&external_, &right_hand_side_, &correction_, &increment_, &displacement_, &accepted_increment_})
        v->reinit(owned_, communicator_);
    relevant_.reinit(owned_, relevant_set_, communicator_);
    dealii::DoFTools::extract_constant_modes(dofs_, dealii::ComponentMask(3, true), translations_);

    points_ = std::make_unique<MaterialPoints>(settings_.material, facts_.state_variables,
                                               points_of_cell * mesh_.n_locally_owned_active_cells());
    dealii::FEValues<3> values(element_, quadrature_, dealii::update_quadrature_points);
    std::size_t point = 0;
    for (const auto& cell : dofs_.active_cell_iterators()) {
        if (!cell->is_locally_owned()) continue;
        values.reinit(cell);
        const double size = std::cbrt(cell->measure());
        for (unsigned q = 0; q < points_of_cell; ++q, ++point) {
            const auto& x = values.quadrature_point(q);
            points_->place(point, static_cast<int>(cell->global_active_cell_index()) + 1, static_cast<int>(q) + 1,
                           {x[0], x[1], x[2]}, size);
        }
    }
}

void Problem::Implementation::set_constraints(double end_displacement) {
    constraints_.clear();
    constraints_.reinit(relevant_set_);
    dealii::DoFTools::make_hanging_node_constraints(dofs_, constraints_);
    const auto fix = [&](dealii::types::boundary_id where, unsigned component, double value) {
        const IndexSet set = dealii::DoFTools::extract_boundary_dofs(
            dofs_, element_.component_mask(dealii::FEValuesExtractors::Scalar(component)), {where});
        for (const auto dof : set) {
            if (!relevant_set_.is_element(dof) || constraints_.is_constrained(dof)) continue;
            constraints_.add_line(dof);
            constraints_.set_inhomogeneity(dof, value);
        }
    };
    fix(plane_x, 0, 0);
    fix(plane_y, 1, 0);
    fix(plane_z, 2, 0);
    if (settings_.geometry.plane_strain) fix(face_z, 2, 0);
    fix(end, 1, end_displacement);
    constraints_.close();
}

Problem::Implementation::Forces Problem::Implementation::assemble(const Increment& increment) {
    double in_umat = 0, all = 0, smallest_pnewdt = 1, at_end = 0;
    bool symmetric = true;
    {
        const Stopwatch watch(all);
        stiffness_ = 0;
        right_hand_side_ = external_;
        dealii::FEValues<3> values(element_, quadrature_, dealii::update_gradients | dealii::update_JxW_values);
        dealii::FullMatrix<double> cell_stiffness(unknowns_of_cell, unknowns_of_cell);
        dealii::Vector<double> cell_force(unknowns_of_cell);
        std::vector<dealii::types::global_dof_index> numbers(unknowns_of_cell);
        StrainMatrix B[points_of_cell];
        double strain[points_of_cell][6], tangent[points_of_cell][36];
        std::size_t first = 0;
        for (const auto& cell : dofs_.active_cell_iterators()) {
            if (!cell->is_locally_owned()) continue;
            values.reinit(cell);
            cell->get_dof_indices(numbers);
            double moved[unknowns_of_cell], mean[nodes][3] = {}, volume = 0;
            for (unsigned i = 0; i < unknowns_of_cell; ++i) moved[i] = relevant_[numbers[i]];
            for (unsigned q = 0; q < points_of_cell; ++q) {
                volume += values.JxW(q);
                for (unsigned a = 0; a < nodes; ++a)
                    for (unsigned c = 0; c < 3; ++c) mean[a][c] += values.shape_grad(3 * a, q)[c] * values.JxW(q);
            }
            for (auto& of_node : mean)
                for (double& component : of_node) component /= volume;
            for (unsigned q = 0; q < points_of_cell; ++q) {
                fill_strain_matrix([&](unsigned a) { return values.shape_grad(3 * a, q); }, mean, B[q]);
                for (unsigned k = 0; k < 6; ++k) {
                    strain[q][k] = 0;
                    for (unsigned i = 0; i < unknowns_of_cell; ++i) strain[q][k] += B[q][k][i] * moved[i];
                }
            }
            {
                const Stopwatch material(in_umat);
                for (unsigned q = 0; q < points_of_cell; ++q)
                    smallest_pnewdt =
                        std::min(smallest_pnewdt, points_->update(first + q, increment, strain[q], tangent[q]));
            }
            // Where a material wants a smaller increment the sums are not used, but the matrix must get the entries of
            // all cells: which ones are sent between ranks is settled the first time.
            cell_stiffness = 0;
            cell_force = 0;
            for (unsigned q = 0; q < points_of_cell && smallest_pnewdt >= 1; ++q) {
                symmetric = symmetric && is_symmetric(tangent[q]);
                const double weight = values.JxW(q), *const stress = points_->stress(first + q);
                for (unsigned i = 0; i < unknowns_of_cell; ++i)
                    for (unsigned k = 0; k < 6; ++k) cell_force[i] -= B[q][k][i] * stress[k] * weight;
                double DB[6][unknowns_of_cell];  // DDSDDE is stored by columns
                for (unsigned k = 0; k < 6; ++k)
                    for (unsigned i = 0; i < unknowns_of_cell; ++i) {
                        double sum = 0;
                        for (unsigned l = 0; l < 6; ++l) sum += tangent[q][6 * l + k] * B[q][l][i];
                        DB[k][i] = sum * weight;
                    }
                for (unsigned i = 0; i < unknowns_of_cell; ++i)
                    for (unsigned k = 0; k < 6; ++k) {
                        const double b = B[q][k][i];
                        double* const row = &cell_stiffness(i, 0);
                        for (unsigned j = 0; j < unknowns_of_cell; ++j) row[j] += b * DB[k][j];
                    }
            }
            constraints_.distribute_local_to_global(cell_stiffness, cell_force, numbers, stiffness_, right_hand_side_);
            for (unsigned i = 0; i < unknowns_of_cell; ++i)
                if (at_end_[relevant_set_.index_within_set(numbers[i])]) at_end -= cell_force[i];
            first += points_of_cell;
        }
        stiffness_.compress(dealii::VectorOperation::add);
        right_hand_side_.compress(dealii::VectorOperation::add);
    }
    seconds_.umat += in_umat;
    seconds_.assembly += all - in_umat;
    const double pnewdt = dealii::Utilities::MPI::min(smallest_pnewdt, communicator_);
    if (pnewdt < 1)
        ranks_asking_ =
            std::max(ranks_asking_, dealii::Utilities::MPI::sum(smallest_pnewdt < 1 ? 1 : 0, communicator_));
    return {pnewdt, dealii::Utilities::MPI::sum(at_end, communicator_),
            dealii::Utilities::MPI::min(symmetric ? 1 : 0, communicator_) == 1};
}

bool Problem::Implementation::solve(bool symmetric, double reduction, int& iterations) {
    namespace trilinos = dealii::TrilinosWrappers;
    const Stopwatch watch(seconds_.solve);
    SolverControl control(2000, reduction * right_hand_side_.l2_norm());
    correction_ = 0;
    try {
        trilinos::PreconditionAMG multigrid;
        trilinos::PreconditionAMG::AdditionalData options;
        options.constant_modes = translations_;
        options.elliptic = true;
        options.aggregation_threshold = 0.02;
        options.smoother_sweeps = 2;
        multigrid.initialize(stiffness_, options);
        if (symmetric) trilinos::SolverCG(control).solve(stiffness_, correction_, right_hand_side_, multigrid);
        else
            trilinos::SolverGMRES(control, trilinos::SolverGMRES::AdditionalData(false, 100))
                .solve(stiffness_, correction_, right_hand_side_, multigrid);
    } catch (const SolverControl::NoConvergence&) {
        return false;
    }
    iterations += static_cast<int>(control.last_step());
    constraints_.distribute(correction_);
    return true;
}

Problem::Implementation::Trial Problem::Implementation::try_increment(const Increment& increment) {
    const std::string& linear = settings_.solver.linear;
    const double part = increment.size / settings_.loading.time;
    const auto maximum = static_cast<std::size_t>(settings_.solver.maximum_iterations);
    // The start of the iteration: the last increment once more, or, where there is none, the elastic answer to the
    // displacement of the end, by a first correction from rest.
    const bool extrapolated = accepted_size_ > 0;
    increment_ = accepted_increment_;
    if (extrapolated) increment_ *= increment.size / accepted_size_;
    Trial trial;
    for (bool at_rest = !extrapolated;; at_rest = false) {
        set_constraints(at_rest ? end_displacement_ * part : 0);
        relevant_ = increment_;
        const Forces forces = assemble(increment);
        if (forces.pnewdt < 1) {
            trial.outcome = Outcome::refused_by_material;
            trial.factor = std::max(forces.pnewdt, 0.1);
            return trial;
        }
        double reduction = 1e-3;
        if (!at_rest) {
            last_force_ = forces.at_end;
            const double residual = right_hand_side_.l2_norm() / std::abs(forces.at_end);
            trial.residuals.push_back(residual);
            if (residual <= settings_.solver.tolerance) return trial;
            trial.outcome = Outcome::refused_by_newton;
            if (!std::isfinite(residual) || trial.residuals.size() > maximum) return trial;
            // A solution as inexact as the residual is large keeps Newton's quadratic convergence (Dembo, Eisenstat
            // and Steihaug 1982).
            reduction = std::clamp(0.1 * residual, 1e-8, 1e-3);
        }
        const bool symmetric = linear == "cg" || (linear == "auto" && forces.symmetric);
        used_gmres_ = used_gmres_ || !symmetric;
        if (!solve(symmetric, reduction, trial.linear_iterations)) {
            trial.outcome = Outcome::refused_by_newton;
            return trial;
        }
        trial.outcome = Outcome::converged;
        increment_ += correction_;
    }
}

// Loads that balance the initial stress: tractions on the free surfaces, which stay.
void Problem::Implementation::put_in_balance() {
    const auto& stress = settings_.material.initial_stress;
    if (std::all_of(stress.begin(), stress.end(), [](double s) { return s == 0; })) return;
    set_constraints(0);
    dealii::FEValues<3> values(element_, quadrature_, dealii::update_gradients | dealii::update_JxW_values);
    dealii::Vector<double> cell_force(unknowns_of_cell);
    std::vector<dealii::types::global_dof_index> numbers(unknowns_of_cell);
    const unsigned voigt[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
    for (const auto& cell : dofs_.active_cell_iterators()) {
        if (!cell->is_locally_owned()) continue;
        values.reinit(cell);
        cell->get_dof_indices(numbers);
        cell_force = 0;
        for (unsigned q = 0; q < points_of_cell; ++q)
            for (unsigned i = 0; i < unknowns_of_cell; ++i)
                for (unsigned d = 0; d < 3; ++d)
                    cell_force[i] += stress[voigt[i % 3][d]] * values.shape_grad(i, q)[d] * values.JxW(q);
        constraints_.distribute_local_to_global(cell_force, numbers, external_);
    }
    external_.compress(dealii::VectorOperation::add);
}

double Problem::Implementation::largest_watched() const {
    double largest = -1e300;
    for (std::size_t i = 0; facts_.watched >= 0 && i < points_->size(); ++i)
        largest = std::max(largest, points_->state(i, static_cast<std::size_t>(facts_.watched)));
    largest = dealii::Utilities::MPI::max(largest, communicator_);
    return facts_.watched >= 0 ? largest : 0;
}

Result Problem::Implementation::run() {
    const double start = MPI_Wtime();
    const std::clock_t processor_start = std::clock();
    const Loading& loading = settings_.loading;
    Output output(settings_.output, facts_.state_names, communicator_);
    Result result;
    result.ranks = static_cast<int>(dealii::Utilities::MPI::n_mpi_processes(communicator_));
    result.elements = mesh_.n_global_active_cells();
    result.unknowns = dofs_.n_dofs();
    result.points = points_of_cell * result.elements;
    const std::string watched = facts_.watched >= 0 ? facts_.state_names[static_cast<std::size_t>(facts_.watched)] : "";
    if (speaks_) {
        std::printf("%s, %llu elements, %llu unknowns, ranks: %d\n", settings_.material.name.c_str(), result.elements,
                    result.unknowns, result.ranks);
        std::printf("%9s %8s %12s %14s %12s %7s %7s %8s\n", "increment", "of all", "elongation", "force",
                    watched.empty() ? "" : ("max " + watched).c_str(), "Newton", "linear", "seconds");
        std::fflush(stdout);
    }
    put_in_balance();

    double time = 0, size = loading.first;  // as parts of the whole
    int attempts = 0, easy = 0;
    const double nearly_all = 1 - 1e-12;
    while (time < nearly_all) {
        const std::size_t done = result.increments.size();
        if (!loading.increments.empty()) {
            if (done >= loading.increments.size()) break;
            size = loading.increments[done];
        } else if (time + 1.001 * size > 1) size = 1 - time;
        const Increment increment{time * loading.time, size * loading.time, ++attempts};
        Trial trial = try_increment(increment);
        if (trial.outcome != Outcome::converged) {
            points_->restore();
            const bool by_material = trial.outcome == Outcome::refused_by_material;
            ++(by_material ? result.refused_by_material : result.refused_by_newton);
            if (speaks_) {
                std::printf("          %8.5f  %s; again with %.3g of it\n", time + size,
                            by_material ? "the material wants a smaller increment (PNEWDT)" : "no equilibrium found",
                            trial.factor);
                std::fflush(stdout);
            }
            size *= trial.factor;
            easy = 0;
            if (!loading.increments.empty() || size < loading.smallest) break;
            continue;
        }
        points_->accept();
        displacement_ += increment_;
        accepted_increment_ = increment_;
        accepted_size_ = increment.size;
        time += size;
        // The forces of the accepted state are those of the last assembly.
        AcceptedIncrement accepted{time,
                                   size,
                                   loading.elongation * time,
                                   0,
                                   largest_watched(),
                                   trial.linear_iterations,
                                   std::move(trial.residuals)};
        accepted.force = 4 * last_force_;
        if (speaks_) {
            std::printf("%9zu %8.5f %12.5g %14.7g %12.5g %7zu %7d %8.1f\n", done + 1, time, accepted.elongation,
                        accepted.force, accepted.watched, accepted.residuals.size(), accepted.linear_iterations,
                        MPI_Wtime() - start);
            std::fflush(stdout);
        }
        const bool was_easy =
            2 * accepted.residuals.size() <= static_cast<std::size_t>(settings_.solver.maximum_iterations);
        result.increments.push_back(std::move(accepted));
        easy = was_easy ? easy + 1 : 0;
        if (easy >= 2) size = std::min(1.5 * size, std::max(loading.largest, size));
        if (settings_.write_every > 0 && (done + 1) % static_cast<std::size_t>(settings_.write_every) == 0 &&
            time < nearly_all) {
            relevant_ = displacement_;
            output.write_fields(dofs_, relevant_, *points_, static_cast<int>(done) + 1, time * loading.time);
        }
    }
    result.finished = time >= nearly_all;
    seconds_.total = MPI_Wtime() - start;
    seconds_.processor = static_cast<double>(std::clock() - processor_start) / CLOCKS_PER_SEC;
    result.ranks_asking = ranks_asking_;
    result.linear_solver = used_gmres_ ? "GMRES" : "CG";
    for (auto part : {&Result::Seconds::assembly, &Result::Seconds::umat, &Result::Seconds::solve,
                      &Result::Seconds::total, &Result::Seconds::processor})
        result.seconds.*part = dealii::Utilities::MPI::max(seconds_.*part, communicator_);
    relevant_ = displacement_;
    output.write_fields(dofs_, relevant_, *points_, static_cast<int>(result.increments.size()), time * loading.time);
    if (facts_.watched >= 0) output.write_mid_plane(dofs_, *points_, facts_.watched);
    output.write_tables(result);
    if (speaks_) std::printf("%s\n", result.finished ? "finished" : "given up");
    return result;
}

Problem::Problem(const Settings& settings, const MaterialFacts& facts, MPI_Comm communicator)
    : implementation_(std::make_unique<Implementation>(settings, facts, communicator)) {}
Problem::~Problem() = default;
Result Problem::run() { return implementation_->run(); }

}  // namespace bar
