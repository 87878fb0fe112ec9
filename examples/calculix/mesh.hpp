// Structured meshes of hexahedra: one block of cells, bent into shape by a function.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace ccx {

using Position = std::array<double, 3>;
using Index = std::array<int, 3>;

struct Mesh {
    std::string type;  // C3D8 or C3D20R
    Index cells;
    std::vector<Position> nodes;             // node n is nodes[n - 1]
    std::vector<std::vector<int>> elements;  // numbers of nodes; the first index of the cell runs fastest
    std::vector<int> number;                 // of the grid with half steps; 0 where there is no node

    bool is_quadratic() const { return type == "C3D20R"; }
    // At half steps: cell corners have even indices.
    int node(int i, int j, int k) const {
        return number[static_cast<std::size_t>(i + (2 * cells[0] + 1) * (j + (2 * cells[1] + 1) * k))];
    }
    const Position& position(int node) const { return nodes[static_cast<std::size_t>(node) - 1]; }
    int element(int i, int j, int k) const { return 1 + i + cells[0] * (j + cells[1] * k); }
    std::vector<int> nodes_where(const std::function<bool(const Position&)>& wanted) const {
        std::vector<int> found;
        for (std::size_t n = 0; n < nodes.size(); ++n)
            if (wanted(nodes[n])) found.push_back(static_cast<int>(n) + 1);
        return found;
    }
};

// `shape` maps the unit cube onto the body, right-handed.
inline Mesh make_mesh(const std::string& type, Index cells, const std::function<Position(const Position&)>& shape) {
    Mesh mesh{type, cells, {}, {}, {}};
    const Index half{2 * cells[0] + 1, 2 * cells[1] + 1, 2 * cells[2] + 1};
    for (int k = 0; k < half[2]; ++k)
        for (int j = 0; j < half[1]; ++j)
            for (int i = 0; i < half[0]; ++i) {
                const int odd = i % 2 + j % 2 + k % 2;
                if (odd > (mesh.is_quadratic() ? 1 : 0)) {
                    mesh.number.push_back(0);
                    continue;
                }
                mesh.nodes.push_back(shape({0.5 * i / cells[0], 0.5 * j / cells[1], 0.5 * k / cells[2]}));
                mesh.number.push_back(static_cast<int>(mesh.nodes.size()));
            }
    // Corners, then the edges of the bottom, of the top and in between, in half steps.
    static constexpr Index order[20] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 2}, {2, 0, 2}, {2, 2, 2},
                                        {0, 2, 2}, {1, 0, 0}, {2, 1, 0}, {1, 2, 0}, {0, 1, 0}, {1, 0, 2}, {2, 1, 2},
                                        {1, 2, 2}, {0, 1, 2}, {0, 0, 1}, {2, 0, 1}, {2, 2, 1}, {0, 2, 1}};
    for (int k = 0; k < cells[2]; ++k)
        for (int j = 0; j < cells[1]; ++j)
            for (int i = 0; i < cells[0]; ++i) {
                std::vector<int> element;
                for (int n = 0; n < (mesh.is_quadratic() ? 20 : 8); ++n)
                    element.push_back(mesh.node(2 * i + order[n][0], 2 * j + order[n][1], 2 * k + order[n][2]));
                mesh.elements.push_back(element);
            }
    return mesh;
}

inline Mesh make_box(const std::string& type, Index cells, const Position& size) {
    return make_mesh(type, cells, [size](const Position& at) {
        return Position{at[0] * size[0], at[1] * size[1], at[2] * size[2]};
    });
}

// A quarter of a plate with half-circular notches of `radius` in both edges, centre of the plate in the origin. The
// first index runs along the notch, the second away from it.
inline Mesh make_notched_plate(Index cells, double width, double height, double radius, double thickness) {
    return make_mesh("C3D20R", cells, [=](const Position& at) {
        const double angle = 0.5 * std::acos(-1.0) * at[0];
        const Position notch{width - radius * std::cos(angle), radius * std::sin(angle)};
        const Position edge =
            at[0] < 0.5 ? Position{0.0, 2.0 * at[0] * height, 0.0} : Position{(2.0 * at[0] - 1.0) * width, height, 0.0};
        const double away = at[1] * (0.6 + 0.4 * at[1]);  // smaller elements at the notch
        return Position{notch[0] + away * (edge[0] - notch[0]), notch[1] + away * (edge[1] - notch[1]),
                        thickness * at[2]};
    });
}

// A pyramid cut out of a thick sphere; the third index runs outwards.
inline Mesh make_sphere_column(int cells, double inner, double outer, double opening) {
    return make_mesh("C3D20R", {1, 1, cells}, [=](const Position& at) {
        const double r = inner + (outer - inner) * at[2], longitude = (at[0] - 0.5) * opening,
                     latitude = (at[1] - 0.5) * opening;
        return Position{r * std::cos(latitude) * std::cos(longitude), r * std::cos(latitude) * std::sin(longitude),
                        r * std::sin(latitude)};
    });
}

}  // namespace ccx
