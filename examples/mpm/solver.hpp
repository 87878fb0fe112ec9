// The explicit material-point method on a regular grid, with stresses from `vumat_`.
//
// Nodes gather from the cells around them, in the order of the cells and of the points in them: the result is the
// same, to the last bit, for any number of threads.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "material_block.hpp"
#include "scene.hpp"

namespace mpm {

struct Particle {
    Vec position, velocity;
    Vec grid_velocity;        // v*: of the grid at this point, before the velocities are mapped back
    double s_xx, s_yy, s_xy;  // Cauchy stress
    Vec place;                // in its cell, [0, 1]
    int cell;
};

enum Held : signed char { free_node, left_end, right_end };

struct Node {
    double mass = 0.0;
    Vec force, force_right;  // internal; of the points in the cells to the right
    Vec velocity_change, velocity_star;
    Vec velocity;  // v^L, from updated points
};

// What is known of the bar at the start of a step, at time k Dt.
struct Loads {
    double elongation;
    std::array<double, 3> stations;  // at -L/4, 0, L/4
    double mean, end;                // of the stations; reaction at the right end
};

class Solver {
  public:
    explicit Solver(const Scene& scene);

    // Called at every step, with the loads; if it returns true, `sampled` is called before the bar moves on.
    std::function<bool(int step, const Loads&)> at_step;
    std::function<void()> sampled;
    void run();

    const Scene& scene() const { return scene_; }
    const std::vector<Particle>& particles() const { return particles_; }
    const std::vector<Node>& nodes() const { return nodes_; }
    const std::vector<MaterialBlock>& blocks() const { return blocks_; }
    double particle_mass() const { return scene_.point_volume * bar::rho; }
    // Of the probe call, relative to Hooke's law.
    double probe_error() const { return probe_error_; }

  private:
    class Team;
    void work(int member, Team& team);
    void sort_into_cells();
    void hold_nodes(double time);
    void gather_forces(std::size_t first, std::size_t last);
    void move_velocities(const MaterialBlock& block);
    void gather_velocities(std::size_t first, std::size_t last);
    // True if a point has left its cell.
    bool update_points(MaterialBlock& block, double time);
    Loads loads(double time) const;

    const Scene& scene_;
    double time_step_;
    std::vector<Particle> particles_;
    std::array<Material, group_count> materials_;
    std::vector<MaterialBlock> blocks_;
    std::vector<int> cell_first_, cell_points_;  // points by cell
    std::vector<int> active_;                    // nodes with points around them
    std::vector<Node> nodes_;
    std::vector<signed char> held_;
    std::vector<int> rigid_cell_;
    double probe_error_ = 0.0;
};

}  // namespace mpm
