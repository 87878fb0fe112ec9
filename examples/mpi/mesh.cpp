#include "mesh.hpp"

#include <deal.II/grid/manifold_lib.h>

#include <cmath>
#include <numbers>

namespace bar {
namespace {

using dealii::CellData;
using dealii::Point;

// A sheet of quadrilaterals in the plane of the bar, later repeated through the thickness.
struct Sheet {
    std::vector<std::array<double, 2>> points;
    std::vector<std::array<unsigned, 4>> cells;  // lexicographic: 00, 10, 01, 11

    // A grid of (columns + 1) x (rows + 1) points `at(i, j)`; the first row may exist already, as `below`. Returns the
    // points of its last row.
    template <class F>
    std::vector<unsigned> add_grid(unsigned columns, unsigned rows, F at, std::vector<unsigned> below = {}) {
        for (unsigned j = below.empty() ? 0 : 1; j <= rows; ++j) {
            std::vector<unsigned> row;
            for (unsigned i = 0; i <= columns; ++i) {
                row.push_back(static_cast<unsigned>(points.size()));
                points.push_back(at(i, j));
            }
            for (unsigned i = 0; i < columns && !below.empty(); ++i)
                cells.push_back({below[i], below[i + 1], row[i], row[i + 1]});
            below = row;
        }
        return below;
    }
};

// Rays from the notch to the left side and to the line y = W of the square [0, W] x [0, W], then rows up to the end.
Sheet notched_sheet(double W, double H, double R, unsigned n) {
    Sheet sheet;
    // Cells of one shape all along a ray.
    const double growth = std::log(1.1 * W / R);
    const auto along = static_cast<unsigned>(std::max(1.0, std::round(n * growth / (std::numbers::pi / 4))));
    const auto ray = [&](unsigned i, unsigned j) -> std::array<double, 2> {
        const double angle = std::numbers::pi / 4 * i / n;
        const double x0 = W - R * std::cos(angle), y0 = R * std::sin(angle);
        const double x1 = i <= n ? 0 : W * (i - n) / n, y1 = i <= n ? W * i / n : W;
        const double s = std::expm1(growth * j / along) / std::expm1(growth);
        return {x0 + s * (x1 - x0), y0 + s * (y1 - y0)};
    };
    const auto outer = sheet.add_grid(2 * n, along, ray);
    const auto rows = static_cast<unsigned>(std::max(1.0, std::round((H - W) / (2 * W / n))));
    sheet.add_grid(n, rows,
                   [&](unsigned i, unsigned j) -> std::array<double, 2> {
                       return {W * i / n, W + (H - W) * j / rows};
                   },
                   {outer.begin() + n, outer.end()});
    return sheet;
}

Sheet plain_sheet(double W, double H, unsigned n) {
    Sheet sheet;
    const auto rows = static_cast<unsigned>(std::max(1.0, std::round(H / (2 * W / n))));
    sheet.add_grid(n, rows, [&](unsigned i, unsigned j) -> std::array<double, 2> { return {W * i / n, H * j / rows}; });
    return sheet;
}

double area(const Sheet& sheet, const std::array<unsigned, 4>& cell) {
    const auto &a = sheet.points[cell[0]], &b = sheet.points[cell[1]], &c = sheet.points[cell[2]];
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

}  // namespace

void make_mesh(dealii::parallel::distributed::Triangulation<3>& mesh, const Geometry& geometry) {
    const double W = geometry.width / 2, H = geometry.length / 2, T = geometry.thickness / 2, R = geometry.notch_radius;
    const auto n = static_cast<unsigned>(geometry.divisions), layers = static_cast<unsigned>(geometry.layers);
    const Sheet sheet = R > 0 ? notched_sheet(W, H, R, n) : plain_sheet(W, H, n);

    std::vector<Point<3>> points;
    std::vector<CellData<3>> cells;
    const auto in_sheet = static_cast<unsigned>(sheet.points.size());
    for (unsigned k = 0; k <= layers; ++k)
        for (const auto& p : sheet.points) points.emplace_back(p[0], p[1], T * k / layers);
    for (unsigned k = 0; k < layers; ++k)
        for (std::array<unsigned, 4> cell : sheet.cells) {
            if (area(sheet, cell) < 0) std::swap(cell[1], cell[2]);
            CellData<3> data;
            for (unsigned v = 0; v < 4; ++v) {
                data.vertices[v] = cell[v] + k * in_sheet;
                data.vertices[v + 4] = cell[v] + (k + 1) * in_sheet;
            }
            cells.push_back(data);
        }
    mesh.create_triangulation(points, cells, {});

    const Point<3> center(W, 0, 0);
    const double tolerance = 1e-8 * W;
    for (const auto& cell : mesh.active_cell_iterators())
        for (const auto& face : cell->face_iterators()) {
            if (!face->at_boundary()) continue;
            const auto all = [&](auto holds) {
                for (unsigned v = 0; v < 4; ++v)
                    if (!holds(face->vertex(v))) return false;
                return true;
            };
            const auto at = [&](unsigned axis, double value) {
                return all([&](const Point<3>& p) { return std::abs(p[axis] - value) < tolerance; });
            };
            if (at(0, 0)) face->set_boundary_id(plane_x);
            else if (at(1, 0)) face->set_boundary_id(plane_y);
            else if (at(2, 0)) face->set_boundary_id(plane_z);
            else if (at(2, T)) face->set_boundary_id(face_z);
            else if (at(1, H)) face->set_boundary_id(end);
            else if (R > 0 &&
                     all([&](const Point<3>& p) { return std::abs(std::hypot(p[0] - W, p[1]) - R) < tolerance; })) {
                face->set_boundary_id(notch);
                face->set_all_manifold_ids(notch);
            }
        }
    if (R > 0) mesh.set_manifold(notch, dealii::CylindricalManifold<3>(dealii::Tensor<1, 3>({0, 0, 1}), center));
    mesh.refine_global(static_cast<unsigned>(geometry.refine));
    for (int i = 0; R > 0 && i < geometry.refine_notch; ++i) {
        for (const auto& cell : mesh.active_cell_iterators())
            if (cell->is_locally_owned() && std::hypot(cell->center()[0] - W, cell->center()[1]) < 1.3 * R)
                cell->set_refine_flag();
        mesh.execute_coarsening_and_refinement();
    }
}

}  // namespace bar
