// UMAT, called as Abaqus/Standard calls it.
#include <algorithm>
#include <array>

#include "kinematics.hpp"
#include "material.hpp"
#include "timing.hpp"

namespace lode::host {
namespace {

class Umat final : public Material {
  public:
    Umat(const Scenario& scenario, const Library& library)
        : layout_(scenario.analysis.kind),
          function_(library.umat()),
          observed_function_(library.observed_umat()),
          name_(padded_material_name(scenario.material.name)),
          constants_(scenario.material.constants),
          element_length_(scenario.analysis.element_length),
          nlgeom_(scenario.analysis.large_rotation.value_or(false) ? 1 : 0) {
        if (function_ == nullptr)
            throw NotLoaded(library.path() +
                            " has no symbol umat_; choose analysis.interface = \"vumat\" if it has a "
                            "vumat_");
    }

    bool has_tangent() const override { return true; }
    void observe() override { observes_ = observed_function_ != nullptr; }

    Response evaluate(const PointState& start, const Increment& increment) override {
        const int ntens = layout_.size(), nstatv = static_cast<int>(start.state.size());
        const int nprops = static_cast<int>(constants_.size());

        Response response;
        response.stress = turned(start.stress, increment.rotation);
        response.state = start.state;
        response.energies = start.energies;
        response.tangent = Tangent::Zero(ntens, ntens);

        Components stran = increment.strain, dstran = increment.dstrain;
        Components ddsddt = Components::Zero(ntens), drplde = Components::Zero(ntens);
        double drpldt = 0;
        const std::array<double, 2> time{increment.step_time, increment.total_time};
        const std::array<double, 3> coords{};
        const int noel = 1, npt = 1, layer = 1, kspt = 1;
        const std::array<int, 4> jstep{increment.step, 1, nlgeom_, 0};
        // An empty vector may have no address; the arguments always have one, as in a real host.
        std::array<double, 1> none{};
        const auto address = [&none](auto& values) { return values.empty() ? none.data() : values.data(); };

        // Repeated calls start from what the first one started from.
        const Response entry = repeats_ > 1 ? response : Response{};
        timed_call(calls_, 1, repeats_, [&] {
            if (repeats_ > 1) {
                response.stress = entry.stress;
                std::copy(entry.state.begin(), entry.state.end(), response.state.begin());
                response.energies = entry.energies;
                response.pnewdt = entry.pnewdt;
            }
            const auto call = [&](auto* function, auto... first) {
                function(first..., response.stress.data(), address(response.state), response.tangent.data(),
                         &response.energies.elastic, &response.energies.plastic, &response.energies.creep,
                         &response.heat, ddsddt.data(), drplde.data(), &drpldt, stran.data(), dstran.data(),
                         time.data(), &increment.dtime, &increment.temperature, &increment.dtemperature,
                         increment.fields.empty() ? none.data() : increment.fields.data(),
                         increment.dfields.empty() ? none.data() : increment.dfields.data(), name_.data(), &ndi_,
                         &nshr_, &ntens, &nstatv, constants_.empty() ? none.data() : constants_.data(), &nprops,
                         coords.data(), increment.rotation.data(), &response.pnewdt, &element_length_,
                         increment.F0.data(), increment.F1.data(), &noel, &npt, &layer, &kspt, jstep.data(),
                         &increment.number, material_name_length);
            };
            if (observes_ && repeats_ == 1) call(observed_function_, &response.observation.emplace());
            else call(function_);
        });
        return response;
    }

  private:
    Components turned(const Components& stress, const Matrix3& rotation) const {
        if (layout_.cohesive() || rotation.isIdentity(0)) return stress;
        return layout_.stress_components(rotation * layout_.stress_tensor(stress) * rotation.transpose());
    }

    Layout layout_;
    UmatFunction function_;
    lode_umat_observed_function* observed_function_;
    bool observes_ = false;
    std::string name_;
    std::vector<double> constants_;
    double element_length_;
    int nlgeom_;  // JSTEP(3)
    int ndi_ = layout_.ndi(), nshr_ = layout_.nshr();
};

}  // namespace

std::unique_ptr<Material> make_umat(const Scenario& scenario, const Library& library) {
    return std::make_unique<Umat>(scenario, library);
}

std::unique_ptr<Material> make_material(const Scenario& scenario, const Library& library) {
    return scenario.analysis.entry == Entry::umat ? make_umat(scenario, library) : make_vumat(scenario, library);
}

}  // namespace lode::host
