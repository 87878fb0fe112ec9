// The bar, its material points and its grid. SI units.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace mpm {

struct Vec {
    double x = 0.0, y = 0.0;
    friend Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y}; }
    friend Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y}; }
    friend Vec operator*(double s, Vec a) { return {s * a.x, s * a.y}; }
    friend double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y; }
};

// Table 5.1 of the dissertation.
namespace bar {
inline constexpr double L = 0.20, W = 0.06, D = 0.06;  // length, width, depth
inline constexpr double rho = 2350.0, E = 24.9e9, nu = 0.18;
inline constexpr double tau_nf = 2.7e6, tau_sf = 14.9e6, tau_sm = 90e6, f_c = 42.7e6, G_f = 61.35;
inline constexpr double C_n = 0.2, C_s = 0.1, C_psi = 5.0;
inline constexpr double weakness = 0.9;            // of the weak points' strength
inline constexpr double decohesive_half = 0.05;    // cracks are possible in |x'| up to this
inline constexpr double weak_square_half = 0.010;  // the square pattern of weak points
inline constexpr double E_star = E / (1.0 - nu * nu);
inline constexpr double E_1 = E * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
}  // namespace bar

enum class Filling { rotated, uniform };         // how points lie in the cells
enum class WeakPattern { line, square, point };  // where cracks shall start
enum Group { elastic, bulk, weak, group_count };

struct Settings {
    double h = 0.010;         // cell size
    double angle = 0.0;       // of the bar to the grid, degrees
    double L_c_over_h = 0.5;  // smearing length
    double v_L = 0.01;        // speed of the right end
    double end = 1.05e-4;     // elongation at the end
    double courant = 0.4;
    int criterion = 0, integration = 0;  // PROPS 12 and 22
    bool cracks = true;                  // else all points are elastic
    bool prescribed_normal = true;       // else the model searches it
    Filling filling = Filling::rotated;
    WeakPattern pattern = WeakPattern::line;
    int threads = 1;

    double radians() const;
    Vec n() const;  // the bar's axis and its transverse
    Vec t() const;
    int steps() const;
    double time_step() const { return end / v_L / steps(); }
    // What distinguishes this run from the baseline: for people, for file names.
    std::string name() const;
    std::string file_name() const;
};
// The usual ones with another grid, angle (degrees) or filling.
inline Settings setting(double h_mm, double angle, Filling filling = Filling::rotated) {
    Settings s;
    s.h = 1e-3 * h_mm;
    s.angle = angle;
    s.filling = filling;
    return s;
}

struct PlacedPoint {
    Vec local, position, velocity;  // local: x', y' along and across the bar
    Group group = elastic;
};
struct RigidPoint {
    Vec position, velocity;
};

// Square cells of size h with bilinear shape functions. Nodes and cells are numbered along x first.
struct Grid {
    double h;
    Vec origin;
    int columns, rows;  // of cells

    int cells() const { return columns * rows; }
    int nodes() const { return (columns + 1) * (rows + 1); }
    Vec node(int i) const { return origin + Vec{h * (i % (columns + 1)), h * (i / (columns + 1))}; }
    // The cell's lower left node; the others are + 1, + columns + 1, + columns + 2.
    int first_node(int cell) const { return cell / columns * (columns + 1) + cell % columns; }
    // The cell that holds x, and the place a, b in [0, 1] of x in it.
    int locate(Vec x, Vec& place) const;
    // Column of the grid line next to a place.
    int line_near(double x) const;
};

struct Scene {
    Settings settings;
    Grid grid;
    std::vector<PlacedPoint> points;  // by group: elastic, bulk, weak
    std::array<int, group_count + 1> group_first{};
    std::vector<RigidPoint> rigid;
    double point_volume;

    explicit Scene(const Settings& settings);
};

}  // namespace mpm
