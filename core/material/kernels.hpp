// Puts a model behind a ModelEntry: loads the point from the host's arrays, updates it, stores it.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <new>
#include <utility>

#include "lode/material/model_entry.hpp"
#include "lode/material/point.hpp"

namespace lode {

// A model is a struct with
//   static constexpr lode_model description;
//   explicit Model(const Properties&);                            validates, computes what is constant
//   int required_state(AnalysisKind) const;                       STATEV entries it needs
//   template <kind, Real, T> void update(const Increment<kind, Real>&, Point<kind, Real>&, T& tangent_or_none) const;
//   template <kind> void initial_stiffness(const Stress<kind, double>&, const State<double>&, Tangent<kind>&) const;
// and, if it has something to say at creation, `std::string warnings() const`. A model with variants (a hardening law,
// an option) may also have `specialise(f)`, which calls f with the one `update`-able kernel that its constants ask for:
// then each variant gets code of its own, free of the others. What a kernel can compute from DTIME alone it does in
// `prepared(TimeIncrement)`, which returns what has `update` then and is called once for a whole block. A kernel that
// reads the deformation without the trait LODE_FINITE_STRAIN says so by `static constexpr bool reads_stretch = true`.
template <class Model>
concept MaterialModel = std::constructible_from<Model, const Properties&> &&
    requires(const Model& model, AnalysisKind kind) {
    { Model::description } -> std::convertible_to<lode_model>;
    { model.required_state(kind) } -> std::same_as<int>;
};

namespace detail {

template <class Model, class F>
LODE_INLINE void specialise(const Model& model, const F& f) {
    if constexpr (requires { model.specialise(f); }) model.specialise(f);
    else f(model);
}

template <class Kernel>
LODE_INLINE auto prepared(const Kernel& kernel, TimeIncrement dt) {
    if constexpr (requires { kernel.prepared(dt); }) return kernel.prepared(dt);
    else return kernel;
}

template <class V>
LODE_INLINE auto finiteness(const V& a) {
    auto finite = is_finite(a[0]);
    for (int i = 1; i < V::size(); ++i) finite = finite && is_finite(a[i]);
    return finite;
}
// Lanes in which every component of stress and strain is finite. Their product, which the callers need anyway, tells
// unless it overflows.
template <AnalysisKind kind, class Real>
LODE_INLINE Mask<Real> are_finite(const Stress<kind, Real>& stress, const Strain<kind, Real>& strain,
                                  const Real& product) {
    const Mask<Real> finite = is_finite(product);
    if (all(finite)) [[likely]]
        return finite;
    return finiteness(stress) && finiteness(strain);
}

// A model's update is inlined here, so that the point lives in registers and what no caller reads is never computed.
template <AnalysisKind kind, class Kernel>
LODE_INLINE void umat_point(const Kernel& kernel, const UmatArguments& a, CallStatus& status) {
    constexpr int n = components(kind);

    Increment<kind, double> increment;
    Point<kind, double> point;
    for (int i = 0; i < n; ++i) increment.strain_increment[i] = a.dstran[i];
    for (int i = 0; i < n; ++i) point.stress[i] = a.stress[i];
    const double times = *a.dtime + *a.temp + *a.dtemp;
    double sum[2] = {times, point.stress[0] * increment.strain_increment[0]};
    for (int i = 1; i < n; ++i) sum[(i + 1) % 2] += point.stress[i] * increment.strain_increment[i];
    if (!is_finite(sum[0] + sum[1])) [[unlikely]] {  // something is not finite, unless that overflowed
        if (!is_finite(times) || !finiteness(point.stress) || !finiteness(increment.strain_increment)) {
            status.failure = "DSTRAN, STRESS, DTIME, TEMP or DTEMP on entry is not finite";
            status.time_step_ratio = 0.25;
            return;
        }
    }
    increment.time_increment = *a.dtime;
    increment.time_end = a.time[1] + *a.dtime;
    increment.temperature_source[0] = a.temp;
    increment.temperature_source[1] = a.dtemp;
    increment.field_source[0] = a.predef;
    increment.field_source[1] = a.dpred;
    increment.deformation_source = a.dfgrd1;
    increment.element_length_source = a.celent;
    increment.rotation_source = a.drot;
    point.state = State<double>(a.statev, a.statev, 1, a.nstatv);
    point.solves = SolveCounter<double>(status.solves);

    std::memset(a.ddsddt, 0, n * sizeof(double));
    std::memset(a.drplde, 0, n * sizeof(double));
    Tangent<kind> tangent{a.ddsdde, a.ddsddt, a.drplde};
    if constexpr (requires { kernel.prepared(increment.time_increment); })
        kernel.prepared(increment.time_increment).template update<kind, double>(increment, point, tangent);
    else kernel.template update<kind, double>(increment, point, tangent);

    status.warning = point.warning;
    if (point.failure != nullptr) [[unlikely]] {
        status.failure = point.failure;
        status.time_step_ratio = point.time_step_ratio;
        status.refusal = point.refusal;
        status.refused_value = point.refused_value;
        status.refused_limit = point.refused_limit;
        return;
    }
    for (int i = 0; i < n; ++i) a.stress[i] = point.stress[i];
    *a.sse = point.elastic_energy;
    *a.spd += point.plastic_dissipation;
    *a.scd += point.viscous_dissipation;
    *a.rpl = tangent.heat_rate;
    *a.drpldt = tangent.heat_rate_temperature;
}

template <class Model, AnalysisKind kind>
void umat_call(const void* material, const UmatArguments& a, CallStatus& status) {
    specialise(*static_cast<const Model*>(material),
               [&](const auto& kernel) LODE_INLINE_LAMBDA { umat_point<kind>(kernel, a, status); });
}

// Column of the VUMAT arrays that holds component i of the UMAT order. The arrays of an explicit plane-stress call have
// the (3,1) layout.
template <AnalysisKind kind>
constexpr int vumat_column(int i) {
    if constexpr (kind == AnalysisKind::solid) return i == 4 ? 5 : i == 5 ? 4 : i;
    else if constexpr (kind == AnalysisKind::plane_stress) return i == 2 ? 3 : i;
    else return i;
}
template <AnalysisKind kind>
constexpr int vumat_columns = kind == AnalysisKind::plane_stress ? 4 : components(kind);

// As many points as the batch has lanes, starting at `first`; false if that failed.
template <AnalysisKind kind, bool finite_strain, class Kernel>
LODE_INLINE bool vumat_lanes(const Kernel& kernel, const VumatArguments& a, TimeIncrement dt, int first,
                             CallStatus& status) {
    constexpr int n = components(kind), normals = normal_components(kind);
    const std::ptrdiff_t stride = a.stride;

    Increment<kind, Batch> increment;
    Point<kind, Batch> point;
    for (int i = 0; i < n; ++i) {
        const Batch e = Batch::load_unaligned(a.strain_increment + vumat_column<kind>(i) * stride + first);
        increment.strain_increment[i] = i < normals ? e : e + e;
        point.stress[i] = Batch::load_unaligned(a.stress_old + vumat_column<kind>(i) * stride + first);
    }
    const Batch twice_work_start = double_contraction(point.stress, increment.strain_increment);
    const auto sane = are_finite(point.stress, increment.strain_increment, twice_work_start);
    if (!all(sane)) [[unlikely]] {
        point.fail(!sane, "strainInc or stressOld is not finite");
    } else {
        increment.time_increment = dt;
        increment.time_end = a.time_end;
        increment.temperature_source[0] = a.temp_old + first;
        increment.temperature_source[1] = a.temp_new + first;
        increment.field_source[0] = a.field_old + first;
        increment.field_source[1] = a.field_new + first;
        increment.field_count = a.nfieldv;
        increment.deformation_source = a.stretch_new + first;
        increment.element_length_source = a.char_length + first;
        increment.stride = stride;
        point.state = State<Batch>(a.state_old + first, a.state_new + first, stride, a.nstatev);
        point.wants_thickness_strain = kind == AnalysisKind::plane_stress;
        NoTangent none;
        kernel.template update<kind, Batch>(increment, point, none);
        if (point.warning != nullptr) status.warning = point.warning;
        if (point.failure == nullptr) [[likely]] {
            const Batch inverse_density = 1.0 / Batch::load_unaligned(a.density + first);
            const Batch dissipation = (point.plastic_dissipation + point.viscous_dissipation) * inverse_density;
            Batch stored;
            if constexpr (finite_strain) stored = point.elastic_energy * inverse_density;
            else
                stored = 0.5 * (twice_work_start + double_contraction(point.stress, increment.strain_increment)) *
                         inverse_density;
            // What a model has read beyond strain and stress shows here where it is not a number.
            const auto finite = is_finite(Batch(stored + dissipation));
            if (all(finite)) [[likely]] {
                const Batch dissipated = Batch::load_unaligned(a.inelastic_energy_old + first) + dissipation;
                const Batch energy =
                    stored + (finite_strain ? dissipated : Batch::load_unaligned(a.internal_energy_old + first));
                for (int i = 0; i < n; ++i)
                    point.stress[i].store_unaligned(a.stress_new + vumat_column<kind>(i) * stride + first);
                energy.store_unaligned(a.internal_energy_new + first);
                dissipated.store_unaligned(a.inelastic_energy_new + first);
                if constexpr (kind == AnalysisKind::plane_stress) {
                    Batch(0.0).store_unaligned(a.stress_new + 2 * stride + first);
                    point.thickness_strain_increment.store_unaligned(a.strain_increment + 2 * stride + first);
                }
                return true;
            }
            point.fail(!finite, "the answer is not finite: look at tempOld, tempNew, the fields, density and stateOld");
        }
    }
    status.failure = point.failure;
    status.time_step_ratio = point.time_step_ratio;
    for (int lane = 0; lane < batch_lanes; ++lane)
        if (point.failed.get(static_cast<std::size_t>(lane))) {
            status.failed_point = first + lane + 1;
            status.refusal = point.refusal;
            status.refused_value = point.refused_value.get(static_cast<std::size_t>(lane));
            status.refused_limit = point.refused_limit.get(static_cast<std::size_t>(lane));
            break;
        }
    return false;
}

// Room for the points that do not fill a batch: copied to lanes of their own, the last one repeated.
class Remainder {
  public:
    static constexpr int columns_available = 512;
    static int columns_needed(const VumatArguments& a, int columns) {
        return 4 * columns + 2 * a.nstatev + 2 * a.nfieldv + 8;
    }

    // Nothing is set until it is needed.
    void pack_from(const VumatArguments& a, int columns, int first, bool stretch) {
        host_ = &a;
        first_ = first;
        next_ = memory_.data();
        packed_ = a;
        packed_.nblock = batch_lanes;
        packed_.stride = batch_lanes;
        packed_.density = pack(a.density, 1);
        packed_.temp_old = pack(a.temp_old, 1);
        packed_.temp_new = pack(a.temp_new, 1);
        packed_.field_old = pack(a.field_old, a.nfieldv);
        packed_.field_new = pack(a.field_new, a.nfieldv);
        if (stretch) packed_.stretch_new = pack(a.stretch_new, columns);
        packed_.char_length = pack(a.char_length, 1);
        packed_.strain_increment = pack(a.strain_increment, columns);
        packed_.stress_old = pack(a.stress_old, columns);
        packed_.state_old = pack(a.state_old, a.nstatev);
        packed_.internal_energy_old = pack(a.internal_energy_old, 1);
        packed_.inelastic_energy_old = pack(a.inelastic_energy_old, 1);
        packed_.stress_new = reserve(columns);
        packed_.state_new = pack(a.state_old, a.nstatev);
        packed_.internal_energy_new = reserve(1);
        packed_.inelastic_energy_new = reserve(1);
    }
    const VumatArguments& packed() const { return packed_; }

    void unpack(int columns, bool thickness) const {
        give(packed_.stress_new, host_->stress_new, columns);
        give(packed_.state_new, host_->state_new, host_->nstatev);
        give(packed_.internal_energy_new, host_->internal_energy_new, 1);
        give(packed_.inelastic_energy_new, host_->inelastic_energy_new, 1);
        if (thickness) give(packed_.strain_increment + 2 * batch_lanes, host_->strain_increment + 2 * host_->stride, 1);
    }

  private:
    double* reserve(int number) { return std::exchange(next_, next_ + number * batch_lanes); }
    double* pack(const double* source, int number) {
        double* target = reserve(number);
        const int last = host_->nblock - first_ - 1;
        for (int c = 0; c < number; ++c)
            for (int lane = 0; lane < batch_lanes; ++lane)
                target[c * batch_lanes + lane] = source[c * host_->stride + first_ + std::min(lane, last)];
        return target;
    }
    void give(const double* source, double* target, int number) const {
        for (int c = 0; c < number; ++c)
            for (int lane = 0; lane < host_->nblock - first_; ++lane)
                target[c * host_->stride + first_ + lane] = source[c * batch_lanes + lane];
    }

    const VumatArguments* host_;
    VumatArguments packed_;
    int first_;
    double* next_;
    std::array<double, std::size_t{columns_available} * batch_lanes> memory_;
};

inline void copy_state(const VumatArguments& a, int from_column) {
    if (a.state_new == a.state_old) return;
    for (int c = from_column; c < a.nstatev; ++c)
        std::copy_n(a.state_old + c * a.stride, a.nblock, a.state_new + c * a.stride);
}

// The points of a block that fill batches.
template <AnalysisKind kind, bool finite_strain, class Kernel>
[[gnu::noinline]] void vumat_batches(const Kernel& shared_kernel, const VumatArguments& shared_block,
                                     CallStatus& status) {
    // Copies whose address goes nowhere: what a store of results cannot change is loaded once a block.
    const VumatArguments block = shared_block;
    const TimeIncrement dt = block.time_increment;
    const auto kernel = prepared(shared_kernel, dt);
    for (int first = 0; first + batch_lanes <= block.nblock; first += batch_lanes)
        if (!vumat_lanes<kind, finite_strain>(kernel, block, dt, first, status)) [[unlikely]]
            return;
}

// The points left over, with the loop that serves the others.
[[gnu::noinline]] inline void vumat_rest(const VumatArguments& a, int columns, bool stretch, bool thickness,
                                         const void* kernel, CallStatus& status,
                                         void (*run)(const void* kernel, const VumatArguments&, CallStatus&)) {
    const int first = a.nblock - a.nblock % batch_lanes;
    if (Remainder::columns_needed(a, columns) > Remainder::columns_available) {
        status.failure = "too many state and field variables for a block that does not fill the registers";
        status.failed_point = first + 1;
        return;
    }
    Remainder remainder;
    remainder.pack_from(a, columns, first, stretch);
    run(kernel, remainder.packed(), status);
    if (status.failure != nullptr) status.failed_point += first;
    else remainder.unpack(columns, thickness);
}

template <class Kernel>
constexpr bool reads_stretch() {
    if constexpr (requires { Kernel::reads_stretch; }) return Kernel::reads_stretch;
    else return false;
}

template <AnalysisKind kind, bool finite_strain, class Kernel>
LODE_INLINE void vumat_block(const Kernel& kernel, const VumatArguments& a, CallStatus& status) {
    vumat_batches<kind, finite_strain>(kernel, a, status);
    if (a.nblock % batch_lanes == 0 || status.failure != nullptr) return;
    vumat_rest(a, vumat_columns<kind>, finite_strain || reads_stretch<Kernel>(), kind == AnalysisKind::plane_stress,
               &kernel, status, [](const void* k, const VumatArguments& rest, CallStatus& s) {
                   vumat_batches<kind, finite_strain>(*static_cast<const Kernel*>(k), rest, s);
               });
}

template <class Model, AnalysisKind kind>
void vumat_call(const void* material, const VumatArguments& a, CallStatus& status) {
    const Model& model = *static_cast<const Model*>(material);
    copy_state(a, model.required_state(kind));
    constexpr bool finite_strain = (Model::description.traits & LODE_FINITE_STRAIN) != 0;
    specialise(model,
               [&](const auto& kernel) LODE_INLINE_LAMBDA { vumat_block<kind, finite_strain>(kernel, a, status); });
}

// stepTime = totalTime = 0: the host probes with made-up strains. Elastic answer, no history (conventions page).
template <class Model, AnalysisKind kind>
void vumat_probe(const void* material, const VumatArguments& a, CallStatus&) {
    constexpr int n = components(kind), normals = normal_components(kind);
    const Model& model = *static_cast<const Model*>(material);
    copy_state(a, 0);
    for (int p = 0; p < a.nblock; ++p) {
        Stress<kind, double> stress_old, stress;
        Strain<kind, double> de;
        for (int i = 0; i < n; ++i) {
            const double e = a.strain_increment[vumat_column<kind>(i) * a.stride + p];
            de[i] = i < normals ? e : 2.0 * e;
            stress_old[i] = a.stress_old[vumat_column<kind>(i) * a.stride + p];
        }
        std::array<double, n * n> c{};
        Tangent<kind> stiffness{c.data(), nullptr, nullptr};
        model.template initial_stiffness<kind>(stress_old, State<double>(a.state_old + p, nullptr, a.stride, a.nstatev),
                                               stiffness);
        for (int i = 0; i < n; ++i) {
            stress[i] = stress_old[i];
            for (int j = 0; j < n; ++j) stress[i] += stiffness(i, j) * de[j];
            a.stress_new[vumat_column<kind>(i) * a.stride + p] = stress[i];
        }
        if constexpr (kind == AnalysisKind::plane_stress) a.stress_new[2 * a.stride + p] = 0.0;
        a.internal_energy_new[p] =
            a.internal_energy_old[p] + 0.5 * double_contraction(stress_old + stress, de) / a.density[p];
        a.inelastic_energy_new[p] = a.inelastic_energy_old[p];
    }
}

template <class Model, int k>
constexpr void fill_umat(std::array<ModelEntry::UmatFunction, kind_count>& functions) {
    constexpr auto kind = static_cast<AnalysisKind>(k);
    if constexpr (serves(Model::description, kind)) functions[k] = &umat_call<Model, kind>;
}
template <class Model, int k>
constexpr void fill_vumat(ModelEntry& entry) {
    constexpr auto kind = static_cast<AnalysisKind>(k);
    if constexpr (serves(Model::description, kind)) {
        entry.vumat[k] = &vumat_call<Model, kind>;
        entry.probe[k] = &vumat_probe<Model, kind>;
    }
}

}  // namespace detail

// The UMAT side of a model. The two sides want different compiler options, so each has a translation unit of its own.
template <MaterialModel Model>
constexpr std::array<ModelEntry::UmatFunction, kind_count> make_umat_functions() {
    std::array<ModelEntry::UmatFunction, kind_count> functions{};
    detail::fill_umat<Model, 0>(functions);
    detail::fill_umat<Model, 1>(functions);
    detail::fill_umat<Model, 2>(functions);
    detail::fill_umat<Model, 3>(functions);
    detail::fill_umat<Model, 4>(functions);
    detail::fill_umat<Model, 5>(functions);
    return functions;
}

// All the rest.
template <MaterialModel Model>
constexpr ModelEntry make_entry(const ModelEntry::UmatFunction* umat_functions) {
    ModelEntry entry{};
    entry.umat = umat_functions;
    entry.description = &Model::description;
    entry.size = sizeof(Model);
    entry.alignment = alignof(Model);
    entry.construct = [](void* storage, const Properties& properties, std::string& message, std::string& warnings) {
        try {
            [[maybe_unused]] const Model* model = ::new (storage) Model(properties);
            if constexpr (requires { model->warnings(); }) warnings += model->warnings();
            return true;
        } catch (const std::exception& error) {
            message = error.what();
            return false;
        }
    };
    entry.destroy = [](void* storage) { static_cast<Model*>(storage)->~Model(); };
    entry.required_state = [](const void* material, AnalysisKind kind) {
        return static_cast<const Model*>(material)->required_state(kind);
    };
    detail::fill_vumat<Model, 0>(entry);
    detail::fill_vumat<Model, 1>(entry);
    detail::fill_vumat<Model, 2>(entry);
    detail::fill_vumat<Model, 3>(entry);
    detail::fill_vumat<Model, 4>(entry);
    detail::fill_vumat<Model, 5>(entry);
    return entry;
}

}  // namespace lode
