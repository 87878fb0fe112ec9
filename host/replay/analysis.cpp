#include "analysis.hpp"

namespace lode::host {
namespace {

using Position = std::pair<int, int>;

constexpr std::array<std::string_view, 6> solid_names{"11", "22", "33", "12", "13", "23"};
constexpr std::array<Position, 6> solid_positions{
    {Position{0, 0}, Position{1, 1}, Position{2, 2}, Position{0, 1}, Position{0, 2}, Position{1, 2}}};
constexpr std::array<std::string_view, 3> plane_stress_names{"11", "22", "12"};
constexpr std::array<Position, 3> plane_stress_positions{{Position{0, 0}, Position{1, 1}, Position{0, 1}}};
constexpr std::array<std::string_view, 3> cohesive_names{"n", "s1", "s2"};

}  // namespace

std::string_view name_of(Kind kind) {
    for (const auto& entry : kind_names)
        if (entry.kind == kind) return entry.name;
    return "?";
}

Layout::Layout(Kind kind) : kind_(kind), ndi_(3), nshr_(3), names_(solid_names), positions_(solid_positions) {
    switch (kind) {
        case Kind::solid:
            break;
        case Kind::plane_strain:
        case Kind::axisymmetric:
            nshr_ = 1;
            break;
        case Kind::plane_stress:
            ndi_ = 2;
            nshr_ = 1;
            names_ = plane_stress_names;
            positions_ = plane_stress_positions;
            break;
        case Kind::uniaxial:
            ndi_ = 1;
            nshr_ = 0;
            break;
        case Kind::cohesive_2d:
        case Kind::cohesive_3d:
            ndi_ = 1;
            nshr_ = kind == Kind::cohesive_2d ? 1 : 2;
            names_ = cohesive_names;
            positions_ = {};
            break;
    }
}

std::optional<int> Layout::find(std::string_view name) const {
    const auto matches = [&](std::string_view known) {
        return name == known || (!cohesive() && name.size() == 2 && name[0] == known[1] && name[1] == known[0]);
    };
    for (int i = 0; i < size(); ++i)
        if (matches(this->name(i))) return i;
    return std::nullopt;
}

Matrix3 Layout::strain_tensor(const Components& strain) const {
    Matrix3 tensor = Matrix3::Zero();
    for (int i = 0; i < size(); ++i) {
        const auto [row, column] = position(i);
        tensor(row, column) = tensor(column, row) = i < ndi_ ? strain[i] : 0.5 * strain[i];
    }
    return tensor;
}

Components Layout::strain_components(const Matrix3& tensor) const {
    Components strain(size());
    for (int i = 0; i < size(); ++i) {
        const auto [row, column] = position(i);
        strain[i] = i < ndi_ ? tensor(row, column) : tensor(row, column) + tensor(column, row);
    }
    return strain;
}

Matrix3 Layout::stress_tensor(const Components& stress) const {
    Matrix3 tensor = Matrix3::Zero();
    for (int i = 0; i < size(); ++i) {
        const auto [row, column] = position(i);
        tensor(row, column) = tensor(column, row) = stress[i];
    }
    return tensor;
}

Components Layout::stress_components(const Matrix3& tensor) const {
    Components stress(size());
    for (int i = 0; i < size(); ++i) {
        const auto [row, column] = position(i);
        stress[i] = 0.5 * (tensor(row, column) + tensor(column, row));
    }
    return stress;
}

}  // namespace lode::host
