// The derivative of POROUS_<KEYWORD>: the kernels of its pores run on numbers that carry derivatives, the solid gives
// its own.
#include "lode/poroelastic/pore_space.hpp"
#include "property_differentiate.hpp"

namespace lode::test {
namespace {

template <AnalysisKind kind>
Differentiated differentiate_porous(const UmatPoint& at, const Load& load) {
    constexpr int n = components(kind), own = PoreSpace::state_count, before = PoreSpace::constant_count;
    using Real = Dual<n + 1>;
    const std::string solid_name = at.name().substr(std::string_view("POROUS_").size());
    const std::string keyword = solid_name.substr(0, solid_name.find('-'));
    const lode_model& solid = *find_model(solid_name);
    const Properties properties(*find_model(at.name()), at.name(), at.props().data(),
                                static_cast<int>(at.props().size()));
    const PoreSpace space(properties, solid);
    bool done = true;
    Differentiated result =
        differentiate_update<kind>(at, load, [&](const Increment<kind, Real>& increment, Point<kind, Real>& point) {
            std::vector<Real> state;
            for (std::size_t i = own; i < at.state().size(); ++i) state.push_back(Real(at.state()[i]));
            State<Real> solid_state(state.data(), state.data(), 1, static_cast<int>(state.size()));
            PoreStep<kind, Real> step;
            done = space.begin(increment, point, solid_state, step);
            if (!done) return;
            Numbers stress;
            for (int i = 0; i < n; ++i) stress.push_back(value_of(point.stress[i]));
            UmatPoint skeleton(solid_name, kind, {at.props().begin() + before, at.props().end()});
            skeleton.state({at.state().begin() + own, at.state().end()})
                .stress(rotated_stress(stress, kind, load.drot.transpose()))
                .temperature(at.temperature())
                .celent(at.celent())
                .deformation_gradient(at.deformation_gradient())
                .time(at.total_time(), at.total_time());
            Load inner = load;
            inner.dpred.clear();
            const Differentiated d = differentiated_kernel(keyword, kind)(skeleton, inner);
            done = d.done;
            for (int i = 0; i < n; ++i) {
                point.stress[i] = Real(d.stress[static_cast<std::size_t>(i)]);
                for (int j = 0; j < n; ++j)
                    point.stress[i].derivative[static_cast<std::size_t>(j)] = d.stress_by_strain(i, j);
                point.stress[i].derivative[n] = d.stress_by_temperature(i);
            }
            for (std::size_t i = 0; i < state.size(); ++i) {
                const auto row = static_cast<Eigen::Index>(i);
                state[i] = Real(d.state[i]);
                for (int j = 0; j < n; ++j)
                    state[i].derivative[static_cast<std::size_t>(j)] = d.state_by_strain(row, j);
                state[i].derivative[n] = d.state_by_temperature(row);
            }
            space.finish(increment, point, solid_state, step);
        });
    result.done = result.done && done;
    return result;
}

}  // namespace

DifferentiateFunction differentiated_porous_kernel(AnalysisKind kind) {
    switch (kind) {
        case AnalysisKind::solid:
            return &differentiate_porous<AnalysisKind::solid>;
        case AnalysisKind::plane_strain:
            return &differentiate_porous<AnalysisKind::plane_strain>;
        default:
            return nullptr;
    }
}

}  // namespace lode::test
