// ISO_PLASTIC with another METHOD than one step of backward Euler. Tangents are the derivatives of the very algorithm:
// an implicit call runs it on numbers that carry them along.
#pragma once

#include "lode/numerics/sensitive.hpp"
#include "lode/plasticity/iso_plastic_kernel.hpp"
#include "lode/plasticity/iso_plastic_paths.hpp"

namespace lode::iso_plastic {

class SteppedKernel {
  public:
    SteppedKernel(const Constants& c, const LawVariant& law, Method method, int substeps, double tolerance)
        : kernel_(c, AnyLaw(law)), method_(method), substeps_(substeps), tolerance_(tolerance) {}

    template <AnalysisKind kind, class Real, class T>
    void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        if constexpr (wants_tangent<T>) update_with_tangent(increment, point, tangent);
        else integrate(increment, point);
    }
    template <AnalysisKind kind>
    void set_initial_stiffness(Tangent<kind>& tangent) const {
        kernel_.set_initial_stiffness(tangent);
    }

  private:
    template <AnalysisKind kind, class Real>
    using AnyStep = Step<kind, Real, AnyLaw>;

    // Returns the heat that a host gets, per volume.
    template <AnalysisKind kind, class Real>
    [[gnu::noinline]] Real integrate(const Increment<kind, Real>& increment, Point<kind, Real>& point) const {
        constexpr bool has_deviator = normal_components(kind) == 3;
        NoTangent none;
        if (method_ != Method::substeps && !has_deviator) {
            point.refuse(Mask<Real>(true), "METHOD needs a 3D or (3,1) layout; METHOD", Real(double(method_)),
                         "0 or 2 in this one");
            return Real(0.0);
        }
        AnyStep<kind, Real> step;
        if (!kernel_.begin(increment, point, step)) return Real(0.0);
        const Real trace_start = trace(point.stress);
        Real dalpha(0.0);
        Balance<Real> balance{Real(0.0), Real(0.0)};
        if (method_ == Method::substeps) {
            if (!in_substeps(increment, point, step, dalpha, balance)) return Real(0.0);
        } else if constexpr (has_deviator) {
            if (!along_path(increment, point, step)) return Real(0.0);
            dalpha = step.dalpha;
            balance = kernel_.balance_of(step);
        }
        return kernel_.finish(increment, point, step, dalpha, balance, trace_start, none);
    }

    // NSUB equal steps of backward Euler.
    template <AnalysisKind kind, class Real>
    bool in_substeps(const Increment<kind, Real>& increment, Point<kind, Real>& point, AnyStep<kind, Real>& step,
                     Real& dalpha, Balance<Real>& balance) const {
        constexpr int n = plastic_components<kind>;
        NoTangent none;
        const double part = 1.0 / substeps_;
        point.solves.count_substeps(substeps_);
        const Stress<kind, Real> stress = point.stress;
        for (int i = 0; i < components(kind); ++i) step.strain[i] = part * step.strain[i];
        step.surroundings.time = increment.time_increment.value * part;
        step.at = kernel_.law.at(step.surroundings);
        Vector<Real, n> plastic_strain;
        for (int i = 0; i < n; ++i) plastic_strain[i] = Real(0.0);
        Real thickness(0.0);
        const DislocationHardening* memory = kernel_.law.dislocations();
        for (int i = 0; i < substeps_; ++i) {
            if (i > 0) {
                if (memory != nullptr)
                    step.surroundings.densities =
                        memory->evolved(memory->at(step.surroundings), step.alpha, step.dalpha);
                step.alpha = step.alpha + step.dalpha;
                step.at = kernel_.law.at(step.surroundings);
            }
            if (!kernel_.correct(increment, point, step, none)) {
                point.stress = stress;
                return false;
            }
            dalpha = dalpha + step.dalpha;
            const Balance<Real> b = kernel_.balance_of(step);
            balance.source_heat = balance.source_heat + b.source_heat;
            balance.work = balance.work + b.work;
            if (step.keeps_plastic_strain)
                for (int k = 0; k < n; ++k) plastic_strain[k] = plastic_strain[k] + step.plastic_strain[k];
            thickness = thickness + point.thickness_strain_increment;
        }
        step.plastic_strain = plastic_strain;
        if constexpr (kind == AnalysisKind::plane_stress) point.thickness_strain_increment = thickness;
        return true;
    }

    // A path under a constant strain rate, lane by lane.
    template <AnalysisKind kind, class Real>
    bool along_path(const Increment<kind, Real>&, Point<kind, Real>& point, AnyStep<kind, Real>& step) const {
        constexpr int n = components(kind);
        const double G = kernel_.c.elastic.shear, K = kernel_.c.elastic.bulk;
        const Real mean = (1.0 / 3.0) * trace(point.stress) + K * trace(step.strain);
        const Deviator<Real> start = in_3d(deviator(point.stress));
        const Deviator<Real> d = in_3d(Real(2.0 * G) * deviator(step.strain));
        DeviatoricState<Real> end;
        if constexpr (is_batch<Real>) end = follow_lanes(start, step.alpha, d, step.surroundings.scale);
        else
            end = ConstantRatePath<Real>(kernel_.law, step.surroundings.scale, G, point.solves)
                      .follow(method_, {start, step.alpha}, d, substeps_, tolerance_);
        step.start = kernel_.law.start(step.at, step.alpha);
        step.dalpha = end.alpha - step.alpha;
        step.end = kernel_.law.start(step.at, end.alpha);
        step.yields = step.dalpha > Real(0.0);
        // The plastic strain is what of the strain the stress does not show.
        for (int i = 0; i < n; ++i) {
            const Real plastic = (0.5 / G) * (d[i] - (end.s[i] - start[i]));
            step.plastic_strain[i] = select(step.yields, i < 3 ? plastic : 2.0 * plastic, Real(0.0));
            point.stress[i] = i < 3 ? end.s[i] + mean : end.s[i];
        }
        point.elastic_energy = double_contraction(end.s, end.s) * (0.25 / G) + mean * mean * (0.5 / K);
        return true;
    }
    [[gnu::noinline]] DeviatoricState<Batch> follow_lanes(const Deviator<Batch>& start, const Batch& alpha,
                                                          const Deviator<Batch>& d, const Batch& scale) const {
        constexpr int n = 6;
        Lanes<Batch> s[n], increments[n], end[n], alphas = to_lanes(alpha), scales = to_lanes(scale);
        for (int i = 0; i < n; ++i) s[i] = to_lanes(start[i]), increments[i] = to_lanes(d[i]);
        for (std::size_t lane = 0; lane < alphas.size(); ++lane) {
            DeviatoricState<double> at{{}, alphas[lane]};
            Deviator<double> d_lane;
            for (int i = 0; i < n; ++i) at.s[i] = s[i][lane], d_lane[i] = increments[i][lane];
            const ConstantRatePath<double> path(kernel_.law, scales[lane], kernel_.c.elastic.shear);
            const auto there = path.follow(method_, at, d_lane, substeps_, tolerance_);
            for (int i = 0; i < n; ++i) end[i][lane] = there.s[i];
            alphas[lane] = there.alpha;
        }
        DeviatoricState<Batch> result;
        for (int i = 0; i < n; ++i) result.s[i] = from_lanes<Batch>(end[i]);
        result.alpha = from_lanes<Batch>(alphas);
        return result;
    }
    template <AnalysisKind kind, class Real>
    static Deviator<Real> in_3d(const Stress<kind, Real>& s) {
        Deviator<Real> all;
        for (int i = 0; i < 6; ++i) all[i] = i < components(kind) ? s[i] : Real(0.0);
        return all;
    }

    // The same on numbers with derivatives: by the strains, and by temperature in direction 6.
    template <AnalysisKind kind>
    [[gnu::noinline]] void update_with_tangent(const Increment<kind, double>& from, Point<kind, double>& point,
                                               Tangent<kind>& tangent) const {
        constexpr int n = components(kind), by_temperature = 6, most = EP + 9;
        Increment<kind, Sensitive> increment;
        Point<kind, Sensitive> moving;
        for (int i = 0; i < n; ++i) {
            increment.strain_increment[i] = Sensitive::variable(from.strain_increment[i], i);
            moving.stress[i] = Sensitive(point.stress[i]);
        }
        increment.time_increment = from.time_increment;
        increment.time_end = from.time_end;
        const Sensitive temperature(*from.temperature_source[0]);
        const Sensitive warmer = Sensitive::variable(*from.temperature_source[1], by_temperature);
        increment.temperature_source[0] = &temperature;
        increment.temperature_source[1] = &warmer;
        Sensitive field, field_change, length;
        if (kernel_.c.moisture_expansion != 0.0) {
            field = Sensitive(from.field_source[0][0]);
            field_change = Sensitive(from.field_source[1][0]);
        }
        increment.field_source[0] = &field;
        increment.field_source[1] = &field_change;
        if (kernel_.law.is_softening()) length = Sensitive(*from.element_length_source);
        increment.element_length_source = &length;
        increment.rotation_source = from.rotation_source;
        Sensitive state[most];
        const int count = std::min(most, point.state.count());
        for (int i = 0; i < count; ++i) state[i] = Sensitive(point.state[i + 1]);
        moving.state = State<Sensitive>(state, state, 1, count);
        moving.solves = point.solves;

        const Sensitive heat = integrate(increment, moving);
        if (moving.failure != nullptr) {
            point.fail(true, moving.failure, moving.time_step_ratio);
            point.refusal = moving.refusal;
            point.refused_value = moving.refused_value.value;
            point.refused_limit = moving.refused_limit.value;
            return;
        }
        for (int i = 0; i < n; ++i) {
            point.stress[i] = moving.stress[i].value;
            for (int j = 0; j < n; ++j) tangent(i, j) = moving.stress[i](j);
            tangent.thermal_stress[i] = moving.stress[i](by_temperature);
            tangent.heat_rate_strain[i] = heat(i) * from.time_increment.inverse;
        }
        tangent.heat_rate = heat.value * from.time_increment.inverse;
        tangent.heat_rate_temperature = heat(by_temperature) * from.time_increment.inverse;
        for (int i = 0; i < count; ++i) point.state.set(i + 1, state[i].value);
        point.elastic_energy = moving.elastic_energy.value;
        point.plastic_dissipation = moving.plastic_dissipation.value;
        point.thickness_strain_increment = moving.thickness_strain_increment.value;
    }

    Kernel<AnyLaw> kernel_;
    Method method_;
    int substeps_;
    double tolerance_;
};

}  // namespace lode::iso_plastic
