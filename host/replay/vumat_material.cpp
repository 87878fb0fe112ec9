// VUMAT, called as Abaqus/Explicit calls it: a block of points, here all equal, in the corotational frame.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "kinematics.hpp"
#include "material.hpp"
#include "timing.hpp"

namespace lode::host {
namespace {

// One contiguous run of points for each component.
template <class Real>
class Block {
  public:
    Block(int points, int components)
        : points_(static_cast<std::size_t>(points)),
          values_(points_ * static_cast<std::size_t>(std::max(components, 1))) {}

    void fill(int component, double value) {
        std::fill_n(values_.begin() + static_cast<std::ptrdiff_t>(offset(component)), points_,
                    static_cast<Real>(value));
    }
    double first(int component) const { return static_cast<double>(values_[offset(component)]); }
    Real* data() { return values_.data(); }

    // Largest difference of any point from the first one; NaN equals NaN.
    double disagreement() const {
        double largest = 0;
        for (std::size_t i = 0; i < values_.size(); ++i) {
            const Real value = values_[i], reference = values_[i - i % points_];
            if (value == reference || (std::isnan(value) && std::isnan(reference))) continue;
            const double difference = static_cast<double>(std::abs(value - reference));
            largest = std::max(largest, std::isnan(difference) ? HUGE_VAL : difference);
        }
        return largest;
    }

  private:
    std::size_t offset(int component) const { return static_cast<std::size_t>(component) * points_; }

    std::size_t points_;
    std::vector<Real> values_;
};

constexpr int thickness = -1;
constexpr std::array<std::pair<int, int>, 9> gradient_positions{
    {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}, {1, 0}, {2, 1}, {0, 2}}};

// For each VUMAT component the UMAT one: 11, 22, 33, 12, 23, 31 against 11, 22, 33, 12, 13, 23.
std::vector<int> component_map(Kind kind) {
    switch (kind) {
        case Kind::solid:
            return {0, 1, 2, 3, 5, 4};
        case Kind::plane_strain:
        case Kind::axisymmetric:
            return {0, 1, 2, 3};
        case Kind::plane_stress:
            return {0, 1, thickness, 2};
        case Kind::uniaxial:
            return {0};
        case Kind::cohesive_2d:
            return {0, 1};
        case Kind::cohesive_3d:
            return {0, 1, 2};
    }
    return {};
}

// Explicit hosts send plane stress with component 33; the label `PS` tells it from plane strain. Only libraries that
// know the label get it.
std::string explicit_name(const std::string& name, Kind kind, bool knows_label) {
    if (kind != Kind::plane_stress || !knows_label) return name;
    const auto dash = name.find('-');
    const std::string keyword = name.substr(0, dash);
    const std::string label = dash == std::string::npos ? "" : name.substr(dash + 1);
    if (label == "PS" || label.starts_with("PS-")) return name;
    return keyword + "-PS" + (label.empty() ? "" : "-" + label);
}

template <class Real>
class Vumat final : public Material {
  public:
    Vumat(const Scenario& scenario, const Library& library)
        : layout_(scenario.analysis.kind),
          map_(component_map(scenario.analysis.kind)),
          function_(reinterpret_cast<VumatOf<Real>>(library.vumat())),
          constants_(scenario.material.constants.begin(), scenario.material.constants.end()),
          name_(padded_material_name(
              explicit_name(scenario.material.name, scenario.analysis.kind, library.has_catalogue()))),
          density_(scenario.material.density),
          element_length_(scenario.analysis.element_length),
          points_(scenario.analysis.block) {
        if (function_ == nullptr)
            throw NotLoaded(library.path() +
                            " has no symbol vumat_; choose analysis.interface = \"umat\" if it has a "
                            "umat_");
    }

    bool has_tangent() const override { return false; }

    // Explicit hosts call once with both times zero and made-up strains before they begin; what comes back is dropped.
    void probe(const PointState& start, const Increment& increment) override {
        Increment made_up = increment;
        for (int i = 0; i < layout_.size(); ++i) made_up.dstrain[i] = 1e-6 * (i + 1);
        if (!layout_.cohesive() && (!increment.F0.isIdentity(0) || !increment.F1.isIdentity(0)))
            made_up.F1 = (Matrix3::Identity() + layout_.strain_tensor(made_up.dstrain)) * increment.F0;
        const Response response = call(start, made_up, 0, 0);
        if (response.state != start.state)
            remarks_.push_back(
                "the probe call (stepTime = totalTime = 0) changed STATE; it has to leave history alone");
        if (!response.finite())
            remarks_.push_back("the probe call (stepTime = totalTime = 0) gave a stress that is no number");
    }

    Response evaluate(const PointState& start, const Increment& increment) override {
        return call(start, increment, increment.step_time + increment.dtime, increment.total_time + increment.dtime);
    }

  private:
    Response call(const PointState& start, const Increment& increment, double step_time, double total_time) {
        const int ndir = layout_.kind() == Kind::plane_stress ? 3 : layout_.ndi(), nshr = layout_.nshr();
        const int components = ndir + nshr;
        const int nstatev = static_cast<int>(start.state.size()), nfieldv = static_cast<int>(increment.fields.size());
        const int nprops = static_cast<int>(constants_.size()), lanneal = 0;

        const Polar old_polar = polar(increment.F0), new_polar = polar(increment.F1);
        const Matrix3 middle = polar(0.5 * (increment.F0 + increment.F1)).rotation;

        Block<Real> strain_inc(points_, components), spin_inc(points_, nshr), stress_old(points_, components),
            stress_new(points_, components), state_old(points_, nstatev), state_new(points_, nstatev),
            field_old(points_, nfieldv), field_new(points_, nfieldv), stretch_old(points_, components),
            stretch_new(points_, components), gradient_old(points_, components + nshr),
            gradient_new(points_, components + nshr), coordinates(points_, 3), length(points_, 1), density(points_, 1),
            temp_old(points_, 1), temp_new(points_, 1), intern_old(points_, 1), intern_new(points_, 1),
            inelas_old(points_, 1), inelas_new(points_, 1);

        fill_mapped(strain_inc, corotational_strain(increment.dstrain, middle));
        fill_mapped(stress_old, turned(start.stress, old_polar.rotation.transpose()));
        fill_gradients(gradient_old, stretch_old, increment.F0, old_polar.right_stretch);
        fill_gradients(gradient_new, stretch_new, increment.F1, new_polar.right_stretch);
        fill_spin(spin_inc, increment, old_polar.rotation, new_polar.rotation, middle);
        for (int i = 0; i < nstatev; ++i) state_old.fill(i, start.state[static_cast<std::size_t>(i)]);
        for (int i = 0; i < nfieldv; ++i) {
            const double value = increment.fields[static_cast<std::size_t>(i)];
            field_old.fill(i, value);
            field_new.fill(i, value + increment.dfields[static_cast<std::size_t>(i)]);
        }
        length.fill(0, element_length_);
        density.fill(0, density_ / (0.5 * (increment.F0 + increment.F1)).determinant());
        temp_old.fill(0, increment.temperature);
        temp_new.fill(0, increment.temperature + increment.dtemperature);
        // Energies are per unit mass here, per current volume in the point.
        const double old_scale = increment.F0.determinant() / density_;
        intern_old.fill(0, start.energies.sum() * old_scale);
        inelas_old.fill(0, (start.energies.plastic + start.energies.creep) * old_scale);
        const Real no_constant = 0;
        const Real step_time_in = static_cast<Real>(step_time), total_time_in = static_cast<Real>(total_time);
        const Real dtime_in = static_cast<Real>(increment.dtime);

        timed_call(calls_, points_, repeats_, [&] {
            function_(&points_, &ndir, &nshr, &nstatev, &nfieldv, &nprops, &lanneal, &step_time_in, &total_time_in,
                      &dtime_in, name_.data(), coordinates.data(), length.data(),
                      constants_.empty() ? &no_constant : constants_.data(), density.data(), strain_inc.data(),
                      spin_inc.data(), temp_old.data(), stretch_old.data(), gradient_old.data(), field_old.data(),
                      stress_old.data(), state_old.data(), intern_old.data(), inelas_old.data(), temp_new.data(),
                      stretch_new.data(), gradient_new.data(), field_new.data(), stress_new.data(), state_new.data(),
                      intern_new.data(), inelas_new.data(), material_name_length);
        });

        const double disagreement = std::max({stress_new.disagreement(), state_new.disagreement(),
                                              intern_new.disagreement(), inelas_new.disagreement()});
        if (disagreement > 0 && !disagreement_reported_) {
            disagreement_reported_ = true;
            remarks_.push_back(fmt::format("equal points of one block came back different (by {:.3g}, increment {})",
                                           disagreement, increment.number));
        }

        Response response;
        Components corotational(layout_.size());
        for (int i = 0; i < components; ++i) {
            const int target = map_[static_cast<std::size_t>(i)];
            if (target != thickness) corotational[target] = stress_new.first(i);
            else response.thickness_increment = strain_inc.first(i);
        }
        response.stress = turned(corotational, new_polar.rotation);
        response.state.resize(start.state.size());
        for (int i = 0; i < nstatev; ++i) response.state[static_cast<std::size_t>(i)] = state_new.first(i);
        const double new_scale = density_ / increment.F1.determinant();
        response.energies.elastic = (intern_new.first(0) - inelas_new.first(0)) * new_scale;
        response.energies.plastic = inelas_new.first(0) * new_scale;
        return response;
    }

    Components turned(const Components& stress, const Matrix3& rotation) const {
        if (layout_.cohesive() || rotation.isIdentity(0)) return stress;
        return layout_.stress_components(rotation * layout_.stress_tensor(stress) * rotation.transpose());
    }

    // Tensor shears, in the axes that turn with the material.
    Components corotational_strain(const Components& dstrain, const Matrix3& rotation) const {
        Components strain = dstrain;
        if (!layout_.cohesive() && !rotation.isIdentity(0))
            strain = layout_.strain_components(rotation.transpose() * layout_.strain_tensor(dstrain) * rotation);
        strain.tail(layout_.nshr()) *= 0.5;
        return strain;
    }

    void fill_mapped(Block<Real>& block, const Components& values) const {
        for (std::size_t i = 0; i < map_.size(); ++i)
            block.fill(static_cast<int>(i), map_[i] == thickness ? 0 : values[map_[i]]);
    }

    // Direct components first, then as many shears as there are: 12, 23, 31 and, for the gradient, 21, 32, 13.
    void fill_gradients(Block<Real>& gradient, Block<Real>& stretch, const Matrix3& F, const Matrix3& U) const {
        const int ndir = static_cast<int>(map_.size()) - layout_.nshr();
        const auto value = [](const Matrix3& tensor, int k) {
            const auto [row, column] = gradient_positions[static_cast<std::size_t>(k)];
            return tensor(row, column);
        };
        for (int i = 0; i < ndir; ++i) {
            gradient.fill(i, value(F, i));
            stretch.fill(i, value(U, i));
        }
        for (int i = 0; i < layout_.nshr(); ++i) {
            gradient.fill(ndir + i, value(F, 3 + i));
            gradient.fill(ndir + layout_.nshr() + i, value(F, 6 + i));
            stretch.fill(ndir + i, value(U, 3 + i));
        }
    }

    // Spin of the motion less that of the axes R, in those axes.
    void fill_spin(Block<Real>& block, const Increment& increment, const Matrix3& old_rotation,
                   const Matrix3& new_rotation, const Matrix3& middle) const {
        if (increment.spin.isZero(0)) return;
        const Matrix3 axes = motion_increment(old_rotation, new_rotation).spin;
        const Matrix3 relative = middle.transpose() * (increment.spin - axes) * middle;
        for (int i = 0; i < layout_.nshr(); ++i) {
            const auto [row, column] = gradient_positions[std::size_t{3} + static_cast<std::size_t>(i)];
            block.fill(i, relative(row, column));
        }
    }

    Layout layout_;
    std::vector<int> map_;
    VumatOf<Real> function_;
    std::vector<Real> constants_;
    std::string name_;
    double density_, element_length_;
    int points_;
    bool disagreement_reported_ = false;
};

}  // namespace

std::unique_ptr<Material> make_vumat(const Scenario& scenario, const Library& library) {
    if (scenario.analysis.precision == Precision::single) return std::make_unique<Vumat<float>>(scenario, library);
    return std::make_unique<Vumat<double>>(scenario, library);
}

}  // namespace lode::host
