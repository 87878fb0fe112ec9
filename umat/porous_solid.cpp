// The calls of POROUS_<KEYWORD> (core/poroelastic/porous_solid.hpp), compiled for each instruction set.
#include "lode/poroelastic/porous_solid.hpp"

#include <Eigen/LU>
#include <vector>

namespace lode {
namespace {

constexpr int own = PoreSpace::state_count;
constexpr std::array<double, PorousSolid::most_points> no_field{};

}  // namespace

PorousSolid::PorousSolid(const Properties& p, const ModelEntry& solid, std::string& warnings)
    : solid_(&solid), space_(p, *solid.description) {
    const Properties inner = p.inner(*solid.description, PoreSpace::constant_count);
    object_ = ::operator new (solid.size, std::align_val_t{solid.alignment});
    std::string message;
    if (!solid.construct(object_, inner, message, warnings)) {
        ::operator delete (object_, std::align_val_t{solid.alignment});
        throw BadProperty(message);
    }
    if (space_.cracks.present() && space_.pores.is_generated()) find_compliance(p);
}

PorousSolid::~PorousSolid() {
    solid_->destroy(object_);
    ::operator delete (object_, std::align_val_t{solid_->alignment});
}

// From the answer of the virgin solid to an increment of nothing.
void PorousSolid::find_compliance(const Properties& p) {
    constexpr int n = 6;
    double stress[n] = {}, stiffness[n * n] = {}, thermal[n] = {}, heat[n] = {}, energy[6] = {};
    const double zeros[n] = {}, identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, element = 1e-9;
    const int count = std::max(solid_->required_state(object_, AnalysisKind::solid), solid_->description->state_count);
    std::vector<double> state(static_cast<std::size_t>(count));
    for (int i = 0; i < solid_->description->state_count; ++i)
        state[static_cast<std::size_t>(i)] = solid_->description->state[i].initial;
    CallStatus status;
    solid_->umat[static_cast<int>(AnalysisKind::solid)](
        object_, {stress,  state.data(), stiffness,  energy,   energy + 1, energy + 2, energy + 3,
                  thermal, heat,         energy + 4, zeros,    zeros,      zeros,      zeros,
                  zeros,   zeros,        zeros,      identity, &element,   identity,   count},
        status);
    const Eigen::Map<const Eigen::Matrix<double, n, n>> C(stiffness);
    const Eigen::Matrix<double, n, n> S = C.inverse();
    if (status.failure != nullptr || !S.allFinite()) p.refuse("the virgin solid has no elastic compliance");
    for (int i = 0; i < n; ++i) {
        expansion_[i] = 0.0;
        for (int j = 0; j < n; ++j) {
            compliance_(i, j) = S(i, j);
            expansion_[i] -= S(i, j) * thermal[j];
        }
    }
}

// DDSDDE += Q alpha (x) (alpha - d(alpha.eps_c)/d(eps)), section 5. As d(sigma_s) = C (d(eps) - a dT - d(eps_c)), what
// the cracks leave of alpha is h . D_s with h = S alpha.
template <AnalysisKind kind>
void PorousSolid::stiffen(const State<double>& solid_state, const PoreStep<kind, double>& step,
                          const UmatArguments& a) const {
    constexpr int n = components(kind);
    const double Q = space_.pores.modulus();
    double rate[n], alpha[n], thermal = 0.0;
    for (int i = 0; i < n; ++i) rate[i] = alpha[i] = PoreSpace::component<kind>(step.alpha, i);
    if (space_.cracks.present()) {
        constexpr AnalysisKind full = AnalysisKind::solid;
        const bool turned = space_.cracks.has_axes(solid_state);
        const Matrix3<double> r = turned ? space_.cracks.axes(solid_state) : Matrix3<double>::identity();
        const Matrix3<double> own_alpha = turned ? transpose(r) * step.alpha * r : step.alpha;
        double h[6], free = 0.0;
        for (int i = 0; i < 6; ++i) {
            h[i] = 0.0;
            for (int j = 0; j < 6; ++j) h[i] += compliance_(i, j) * PoreSpace::component<full>(own_alpha, j);
            free += PoreSpace::component<full>(own_alpha, i) * expansion_[i];
        }
        Matrix3<double> strain;
        for (int i = 0; i < 3; ++i) strain(i, i) = h[i];
        strain(0, 1) = strain(1, 0) = 0.5 * h[3];
        strain(0, 2) = strain(2, 0) = 0.5 * h[4];
        strain(1, 2) = strain(2, 1) = 0.5 * h[5];
        if (turned) strain = r * strain * transpose(r);
        thermal = free;
        for (int j = 0; j < n; ++j) rate[j] = 0.0;
        for (int i = 0; i < n; ++i) {
            const double h_i = (i < normal_components(kind) ? 1.0 : 2.0) * PoreSpace::component<kind>(strain, i);
            for (int j = 0; j < n; ++j) rate[j] += h_i * a.ddsdde[i + n * j];
            thermal += h_i * a.ddsddt[i];
        }
    }
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) a.ddsdde[i + n * j] += Q * alpha[i] * rate[j];
    for (int i = 0; i < n; ++i) a.ddsddt[i] += Q * alpha[i] * thermal;
}

template <AnalysisKind kind>
void PorousSolid::umat(const void* material, const UmatArguments& a, CallStatus& status) {
    const PorousSolid& m = *static_cast<const PorousSolid*>(material);
    constexpr int n = components(kind);
    Increment<kind, double> increment;
    Point<kind, double> point;
    for (int i = 0; i < n; ++i) {
        increment.strain_increment[i] = a.dstran[i];
        point.stress[i] = a.stress[i];
    }
    increment.field_source[0] = a.predef;
    increment.field_source[1] = a.dpred;
    increment.element_length_source = a.celent;
    increment.rotation_source = a.drot;
    point.state = State<double>(a.statev, a.statev, 1, own);
    const int entries = m.solid_->required_state(m.object_, kind);
    const State<double> solid_state(a.statev + own, a.statev + own, 1, entries);

    PoreStep<kind, double> step;
    if (!m.space_.begin(increment, point, solid_state, step)) {
        status.failure = point.failure;
        status.time_step_ratio = point.time_step_ratio;
        status.refusal = point.refusal;
        status.refused_value = point.refused_value;
        status.refused_limit = point.refused_limit;
        return;
    }
    double stress[n];
    for (int i = 0; i < n; ++i) stress[i] = point.stress[i];
    UmatArguments inner = a;
    inner.stress = stress;
    inner.statev = a.statev + own;
    inner.nstatv = a.nstatv - own;
    inner.predef = inner.dpred = no_field.data();
    m.solid_->umat[static_cast<int>(kind)](m.object_, inner, status);
    if (status.failure != nullptr) return;

    for (int i = 0; i < n; ++i) point.stress[i] = stress[i];
    const double p = m.space_.finish(increment, point, solid_state, step);
    for (int i = 0; i < n; ++i) a.stress[i] = point.stress[i];
    *a.sse += m.space_.pores.energy(p);
    if (m.space_.pores.stiffens(p)) m.stiffen<kind>(solid_state, step, a);
}

VumatArguments PorousSolid::solid_part(const VumatArguments& a, int first, int count) {
    VumatArguments inner = a;
    inner.nblock = count;
    inner.nstatev = a.nstatev - own;
    inner.nfieldv = 1;
    inner.density += first;
    inner.temp_old += first;
    inner.temp_new += first;
    inner.field_old = inner.field_new = no_field.data();
    inner.stretch_new += first;
    inner.char_length += first;
    inner.strain_increment += first;
    inner.stress_old = inner.stress_new = a.stress_new + first;
    inner.state_old += own * a.stride + first;
    inner.state_new += own * a.stride + first;
    inner.internal_energy_old += first;
    inner.internal_energy_new += first;
    inner.inelastic_energy_old += first;
    inner.inelastic_energy_new += first;
    return inner;
}

// A block that fills batches: the stress of the solid goes to the solid in the columns of the result.
template <AnalysisKind kind>
void PorousSolid::run_batches(const VumatArguments& a, CallStatus& status) const {
    constexpr int n = components(kind), normals = normal_components(kind);
    const std::ptrdiff_t stride = a.stride;
    const int entries = solid_->required_state(object_, kind);
    const auto read_increment = [&](int p) {
        Increment<kind, Batch> increment;
        for (int i = 0; i < n; ++i) {
            const Batch e = Batch::load_unaligned(a.strain_increment + detail::vumat_column<kind>(i) * stride + p);
            increment.strain_increment[i] = i < normals ? e : e + e;
        }
        increment.field_source[0] = a.field_old + p;
        increment.field_source[1] = a.field_new + p;
        increment.field_count = a.nfieldv;
        increment.element_length_source = a.char_length + p;
        increment.stride = stride;
        return increment;
    };
    const auto solid_state = [&](const double* state, int p) {
        return State<Batch>(state + own * stride + p, nullptr, stride, entries);
    };
    PoreStep<kind, Batch> steps[most_points / batch_lanes];
    for (int first = 0; first < a.nblock; first += most_points) {
        const int count = std::min(most_points, a.nblock - first);
        for (int k = 0; k < count; k += batch_lanes) {
            const int p = first + k;
            const Increment<kind, Batch> increment = read_increment(p);
            Point<kind, Batch> point;
            for (int i = 0; i < n; ++i)
                point.stress[i] = Batch::load_unaligned(a.stress_old + detail::vumat_column<kind>(i) * stride + p);
            point.state = State<Batch>(a.state_old + p, a.state_new + p, stride, own);
            if (!space_.begin(increment, point, solid_state(a.state_old, p), steps[k / batch_lanes])) {
                status.failure = point.failure;
                status.refusal = point.refusal;
                for (std::size_t lane = batch_lanes; lane-- > 0;)
                    if (point.failed.get(lane)) {
                        status.failed_point = p + static_cast<int>(lane) + 1;
                        status.refused_value = point.refused_value.get(lane);
                        status.refused_limit = point.refused_limit.get(lane);
                    }
                return;
            }
            for (int i = 0; i < n; ++i)
                point.stress[i].store_unaligned(a.stress_new + detail::vumat_column<kind>(i) * stride + p);
        }
        solid_->vumat[static_cast<int>(kind)](object_, solid_part(a, first, count), status);
        if (status.failure != nullptr) {
            status.failed_point += first;
            return;
        }
        for (int k = 0; k < count; k += batch_lanes) {
            const int p = first + k;
            const PoreStep<kind, Batch>& step = steps[k / batch_lanes];
            const Increment<kind, Batch> increment = read_increment(p);
            Point<kind, Batch> point;
            for (int i = 0; i < n; ++i)
                point.stress[i] = Batch::load_unaligned(a.stress_new + detail::vumat_column<kind>(i) * stride + p);
            point.state = State<Batch>(a.state_old + p, a.state_new + p, stride, own);
            const Batch p_new = space_.finish(increment, point, solid_state(a.state_new, p), step);
            for (int i = 0; i < n; ++i)
                point.stress[i].store_unaligned(a.stress_new + detail::vumat_column<kind>(i) * stride + p);
            // The solid has counted the work of its own stress.
            const Batch carried = space_.pores.carried(step.load.start) + space_.pores.carried(p_new);
            const Batch work = 0.5 * carried * PoreSpace::product(step.alpha, increment.strain_increment);
            const Batch energy =
                Batch::load_unaligned(a.internal_energy_new + p) - work / Batch::load_unaligned(a.density + p);
            energy.store_unaligned(a.internal_energy_new + p);
        }
    }
}

template <AnalysisKind kind>
void PorousSolid::vumat(const void* material, const VumatArguments& a, CallStatus& status) {
    const PorousSolid& m = *static_cast<const PorousSolid*>(material);
    VumatArguments filled = a;
    filled.nblock = a.nblock - a.nblock % batch_lanes;
    if (filled.nblock > 0) m.run_batches<kind>(filled, status);
    if (filled.nblock == a.nblock || status.failure != nullptr) return;
    detail::vumat_rest(a, detail::vumat_columns<kind>, true, false, material, status,
                       [](const void* k, const VumatArguments& rest, CallStatus& s) {
                           static_cast<const PorousSolid*>(k)->run_batches<kind>(rest, s);
                       });
}

template <AnalysisKind kind>
void PorousSolid::probe(const void* material, const VumatArguments& a, CallStatus& status) {
    const PorousSolid& m = *static_cast<const PorousSolid*>(material);
    constexpr int n = components(kind), normals = normal_components(kind);
    const auto at = [&](int i, int p) { return detail::vumat_column<kind>(i) * a.stride + p; };
    VumatArguments head = a;
    head.nstatev = own;
    detail::copy_state(head, 0);
    const double Q = m.space_.pores.is_generated() ? m.space_.pores.modulus() : 0.0;
    const auto for_all = [&](const auto& change) {
        for (int p = 0; p < a.nblock; ++p) {
            Increment<kind, double> increment;
            Point<kind, double> point;
            for (int i = 0; i < n; ++i) {
                increment.strain_increment[i] = (i < normals ? 1.0 : 2.0) * a.strain_increment[at(i, p)];
                point.stress[i] = 0.0;
            }
            increment.field_source[0] = a.field_old + p;
            increment.field_source[1] = a.field_new + p;
            increment.stride = a.stride;
            increment.field_count = a.nfieldv;
            point.state = State<double>(a.state_old + p, nullptr, a.stride, own);
            PoreStep<kind, double> step;
            const State<double> none(a.state_old + own * a.stride + p, nullptr, a.stride, 0);
            if (!m.space_.begin(increment, point, none, step)) {
                status.failure = point.failure;
                status.refusal = point.refusal;
                status.refused_value = point.refused_value;
                status.failed_point = p + 1;
                return;
            }
            change(p, increment.strain_increment, point.stress, step.alpha);
        }
    };
    for_all([&](int p, const auto&, const auto& carried, const auto&) {
        for (int i = 0; i < n; ++i) a.stress_new[at(i, p)] = a.stress_old[at(i, p)] + carried[i];
    });
    if (status.failure != nullptr) return;
    m.solid_->probe[static_cast<int>(kind)](m.object_, solid_part(a, 0, a.nblock), status);
    for_all([&](int p, const auto& strain, const auto& carried, const auto& alpha) {
        const double volume = PoreSpace::product(alpha, strain);
        for (int i = 0; i < n; ++i)
            a.stress_new[at(i, p)] += Q * volume * PoreSpace::component<kind>(alpha, i) - carried[i];
        a.internal_energy_new[p] += (0.5 * Q * volume * volume - double_contraction(carried, strain)) / a.density[p];
    });
}

template void PorousSolid::vumat<AnalysisKind::solid>(const void*, const VumatArguments&, CallStatus&);
template void PorousSolid::vumat<AnalysisKind::plane_strain>(const void*, const VumatArguments&, CallStatus&);
template void PorousSolid::probe<AnalysisKind::solid>(const void*, const VumatArguments&, CallStatus&);
template void PorousSolid::probe<AnalysisKind::plane_strain>(const void*, const VumatArguments&, CallStatus&);

constinit const std::array<ModelEntry::UmatFunction, kind_count> porous_umat_functions = {
    &PorousSolid::umat<AnalysisKind::solid>, &PorousSolid::umat<AnalysisKind::plane_strain>};

}  // namespace lode
