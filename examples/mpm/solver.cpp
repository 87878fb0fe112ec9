#include "solver.hpp"

#include <algorithm>
#include <atomic>
#include <barrier>
#include <cmath>
#include <thread>

namespace mpm {

namespace {

auto& at(auto& v, int i) { return v[static_cast<std::size_t>(i)]; }

constexpr double no_mass = 1e-14;  // kg

// Bilinear shape functions of a cell's four nodes, in the order lower left, lower right, upper left, upper right.
struct Shape {
    double N[4];
    Vec gradient[4];
};
Shape shape(Vec place, double h) {
    const double a = place.x, b = place.y, d = 1.0 / h;
    return {{(1 - a) * (1 - b), a * (1 - b), (1 - a) * b, a * b},
            {{-(1 - b) * d, -(1 - a) * d}, {(1 - b) * d, -a * d}, {-b * d, (1 - a) * d}, {b * d, a * d}}};
}

// The four cells around a node: those to the right first. `corner` is the node's number in the cell.
struct Around {
    int cell, corner;
};
std::array<Around, 4> cells_around(const Grid& grid, int node) {
    const int column = node % (grid.columns + 1), row = node / (grid.columns + 1);
    const int upper_right = row * grid.columns + column;
    return {
        {{upper_right - grid.columns, 2}, {upper_right, 0}, {upper_right - grid.columns - 1, 3}, {upper_right - 1, 1}}};
}

}  // namespace

// Threads that meet after every phase of a step.
class Solver::Team {
  public:
    explicit Team(int size) : size_(size), barrier_(size) {}
    int size() const { return size_; }
    void meet() {
        if (size_ > 1) barrier_.arrive_and_wait();
    }
    // The part of `count` things that is a member's.
    std::array<std::size_t, 2> share(std::size_t count, int member) const {
        const auto cut = [&](int m) { return count * static_cast<std::size_t>(m) / static_cast<std::size_t>(size_); };
        return {cut(member), cut(member + 1)};
    }
    std::atomic<bool> crossed = false, sampling = false;

  private:
    int size_;
    std::barrier<> barrier_;
};

Solver::Solver(const Scene& scene) : scene_(scene), time_step_(scene.settings.time_step()) {
    for (const PlacedPoint& p : scene.points) {
        Particle particle{p.position, p.velocity, {}, 0.0, 0.0, 0.0, {}, 0};
        particle.cell = scene.grid.locate(p.position, particle.place);
        particles_.push_back(particle);
    }
    for (int group = 0; group < group_count; ++group) {
        Material& material = at(materials_, group);
        material = material_of(scene.settings, static_cast<Group>(group));
        const int first = at(scene.group_first, group), last = at(scene.group_first, group + 1);
        for (int i = first; i < last; i += MaterialBlock::largest)
            blocks_.emplace_back(material, i, std::min(MaterialBlock::largest, last - i));
    }
    for (MaterialBlock& block : blocks_) probe_error_ = std::max(probe_error_, block.probe());
    nodes_.resize(static_cast<std::size_t>(scene.grid.nodes()));
    sort_into_cells();
}

void Solver::sort_into_cells() {
    const Grid& grid = scene_.grid;
    cell_first_.assign(static_cast<std::size_t>(grid.cells() + 1), 0);
    cell_points_.resize(particles_.size());
    for (const Particle& p : particles_) ++at(cell_first_, p.cell + 1);
    for (int c = 0; c < grid.cells(); ++c) at(cell_first_, c + 1) += at(cell_first_, c);
    std::vector<int> next(cell_first_);
    for (int i = 0; i < static_cast<int>(particles_.size()); ++i)
        at(cell_points_, at(next, at(particles_, i).cell)++) = i;

    std::fill(nodes_.begin(), nodes_.end(), Node{});
    active_.clear();
    std::vector<signed char> used(nodes_.size(), 0);
    for (int c = 0; c < grid.cells(); ++c) {
        if (at(cell_first_, c) == at(cell_first_, c + 1)) continue;
        const int node = grid.first_node(c), above = node + grid.columns + 1;
        for (const int i : {node, node + 1, above, above + 1}) at(used, i) = 1;
    }
    for (int i = 0; i < grid.nodes(); ++i)
        if (at(used, i) != 0) active_.push_back(i);
}

// The nodes of the cells in which rigid points are.
void Solver::hold_nodes(double time) {
    const Grid& grid = scene_.grid;
    std::vector<int> cells;
    for (const RigidPoint& r : scene_.rigid) {
        Vec place;
        cells.push_back(grid.locate(r.position + time * r.velocity, place));
    }
    if (cells == rigid_cell_) return;
    rigid_cell_ = cells;
    held_.assign(nodes_.size(), free_node);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const int node = grid.first_node(cells[i]), above = node + grid.columns + 1;
        for (const int j : {node, node + 1, above, above + 1})
            at(held_, j) = i < cells.size() / 2 ? left_end : right_end;
    }
}

// Mass, momentum and internal force (4.2.17, 4.3.4, 4.2.12); momentum after the step (4.2.20).
void Solver::gather_forces(std::size_t first, std::size_t last) {
    const double M = particle_mass(), V = scene_.point_volume, h = scene_.grid.h;
    const Vec end_velocity = scene_.settings.v_L * scene_.settings.n();
    for (std::size_t k = first; k < last; ++k) {
        const int i = active_[k];
        double mass = 0.0;
        Vec momentum, force, force_right;
        int cells = 0;
        for (const auto [cell, corner] : cells_around(scene_.grid, i)) {
            for (int j = at(cell_first_, cell); j < at(cell_first_, cell + 1); ++j) {
                const Particle& p = at(particles_, at(cell_points_, j));
                const Shape s = shape(p.place, h);
                const Vec g = s.gradient[corner];
                mass += M * s.N[corner];
                momentum = momentum + M * s.N[corner] * p.velocity;
                force = force - V * Vec{p.s_xx * g.x + p.s_xy * g.y, p.s_xy * g.x + p.s_yy * g.y};
            }
            if (++cells == 2) force_right = force;
        }
        Node& node = at(nodes_, i);
        node.mass = mass;
        node.force = force;
        node.force_right = force_right;
        node.velocity_change = node.velocity_star = {};
        if (mass <= no_mass) continue;
        const Vec before = (1.0 / mass) * momentum;
        Vec after = (1.0 / mass) * (momentum + time_step_ * force);
        if (at(held_, i) != free_node) after = at(held_, i) == right_end ? end_velocity : Vec{};
        node.velocity_change = after - before;
        node.velocity_star = after;
    }
}

// (4.3.6), and the velocity that will move the points.
void Solver::move_velocities(const MaterialBlock& block) {
    const Grid& grid = scene_.grid;
    for (int i = block.first_point(); i < block.first_point() + block.count(); ++i) {
        Particle& p = at(particles_, i);
        const Shape s = shape(p.place, grid.h);
        const int node = grid.first_node(p.cell), above = node + grid.columns + 1;
        const int corners[] = {node, node + 1, above, above + 1};
        Vec star;
        for (int c = 0; c < 4; ++c) {
            const Node& at_corner = at(nodes_, corners[c]);
            p.velocity = p.velocity + s.N[c] * at_corner.velocity_change;
            star = star + s.N[c] * at_corner.velocity_star;
        }
        p.grid_velocity = star;
    }
}

// Velocities of the grid from those of the updated points (4.3.7).
void Solver::gather_velocities(std::size_t first, std::size_t last) {
    const double M = particle_mass(), h = scene_.grid.h;
    const Vec end_velocity = scene_.settings.v_L * scene_.settings.n();
    for (std::size_t k = first; k < last; ++k) {
        const int i = active_[k];
        Node& node = at(nodes_, i);
        if (at(held_, i) != free_node) {
            node.velocity = at(held_, i) == right_end ? end_velocity : Vec{};
            continue;
        }
        Vec momentum;
        for (const auto [cell, corner] : cells_around(scene_.grid, i))
            for (int j = at(cell_first_, cell); j < at(cell_first_, cell + 1); ++j) {
                const Particle& p = at(particles_, at(cell_points_, j));
                momentum = momentum + M * shape(p.place, h).N[corner] * p.velocity;
            }
        node.velocity = node.mass > no_mass ? (1.0 / node.mass) * momentum : Vec{};
    }
}

// Strain increments (4.3.8), stresses, positions (4.3.5).
bool Solver::update_points(MaterialBlock& block, double time) {
    const Grid& grid = scene_.grid;
    for (int i = 0; i < block.count(); ++i) {
        const Particle& p = at(particles_, block.first_point() + i);
        const Shape s = shape(p.place, grid.h);
        const int node = grid.first_node(p.cell), above = node + grid.columns + 1;
        const int corners[] = {node, node + 1, above, above + 1};
        Vec dx, dy;  // of the velocity
        for (int c = 0; c < 4; ++c) {
            const Vec v = at(nodes_, corners[c]).velocity;
            dx = dx + s.gradient[c].x * v;
            dy = dy + s.gradient[c].y * v;
        }
        block.set_increment(i, time_step_ * dx.x, time_step_ * dy.x, time_step_ * dx.y, time_step_ * dy.y);
    }
    block.update(time + time_step_, time_step_);
    bool crossed = false;
    for (int i = 0; i < block.count(); ++i) {
        Particle& p = at(particles_, block.first_point() + i);
        p.s_xx = block.stress(i, 0);
        p.s_yy = block.stress(i, 1);
        p.s_xy = block.stress(i, 3);
        p.position = p.position + time_step_ * p.grid_velocity;
        const int cell = grid.locate(p.position, p.place);
        crossed = crossed || cell != p.cell;
        p.cell = cell;
    }
    return crossed;
}

// Forces across grid lines x = const from the points to the right of them (5.2.31, 5.2.32).
Loads Solver::loads(double time) const {
    const Settings& s = scene_.settings;
    const Grid& grid = scene_.grid;
    const Vec n = s.n();
    Loads result{s.v_L * time, {}, 0.0, 0.0};
    for (std::size_t station = 0; station < 3; ++station) {
        const double x = 0.25 * bar::L * n.x * (static_cast<double>(station) - 1.0);
        Vec force;
        for (int row = 0; row <= grid.rows; ++row)
            force = force + at(nodes_, row * (grid.columns + 1) + grid.line_near(x)).force_right;
        result.stations[station] = dot(force, n);
        result.mean += result.stations[station] / 3.0;
    }
    for (const int i : active_)
        if (at(held_, i) == right_end) result.end -= dot(at(nodes_, i).force, n);
    return result;
}

void Solver::work(int member, Team& team) {
    const auto [first_block, last_block] = team.share(blocks_.size(), member);
    const int steps = scene_.settings.steps();
    for (int step = 0;; ++step) {
        const double time = step * time_step_;
        const auto [first_node, last_node] = team.share(active_.size(), member);
        gather_forces(first_node, last_node);
        team.meet();
        if (member == 0) team.sampling = at_step && at_step(step, loads(time));
        team.meet();
        if (team.sampling) {
            if (member == 0) sampled();
            team.meet();
        }
        if (step == steps) return;

        for (std::size_t b = first_block; b < last_block; ++b) move_velocities(blocks_[b]);
        team.meet();
        gather_velocities(first_node, last_node);
        team.meet();
        bool crossed = false;
        for (std::size_t b = first_block; b < last_block; ++b) crossed = update_points(blocks_[b], time) || crossed;
        if (crossed) team.crossed = true;
        team.meet();
        if (member == 0) {
            hold_nodes(time + time_step_);
            if (team.crossed) sort_into_cells();
            team.crossed = false;
        }
        team.meet();
    }
}

void Solver::run() {
    hold_nodes(0.0);
    Team team(std::max(1, scene_.settings.threads));
    std::vector<std::jthread> others;
    for (int member = 1; member < team.size(); ++member)
        others.emplace_back([this, member, &team] { work(member, team); });
    work(0, team);
}

}  // namespace mpm
