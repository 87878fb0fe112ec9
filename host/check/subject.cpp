#include "subject.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string_view>

#include "../replay/kinematics.hpp"
#include "child.hpp"

namespace lode::host {
namespace {

constexpr int seeds = 3;
constexpr double smallest_scale = 1e-7, largest_scale = 0.05;  // of an element length, for cohesive materials

double norm(const Components& v) { return v.norm(); }

}  // namespace

// SplitMix64
double Random::uniform(double low, double high) {
    state_ += 0x9E3779B97F4A7C15u;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return low + (high - low) * (static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53);
}
Components Random::direction(int n) {
    Components d(n);
    do {
        for (int i = 0; i < n; ++i) d[i] = uniform(-1, 1);
    } while (norm(d) < 0.1 || norm(d) > 1.2);
    return d / norm(d);
}
Matrix3 Random::rotation(Kind kind, double angle) {
    if (is_cohesive(kind) || kind == Kind::uniaxial) return Matrix3::Identity();
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
    if (kind == Kind::solid) axis = direction(3);
    return rotation_about(axis, uniform(-angle, angle));
}

Bench::Bench(const Subject& subject) : subject_(subject), layout_(subject.kind), umat_(subject.library->umat()) {}

CheckedState Bench::start() {
    CheckedState state;
    if (subject_.recorded != nullptr) {
        const UmatCall call = call_of(*subject_.recorded);
        // The recorded stress has been turned already; the paths from here do not turn.
        state.stress = call.stress;
        state.stran = call.stran;
        state.statev = call.statev;
        state.sse = call.sse;
        state.spd = call.spd;
        state.scd = call.scd;
        state.F = call.dfgrd0;
        state.time = call.time[1];
        state.temperature = call.temp;
        state.fields = call.predef;
        state.kinc = call.kinc;
        return state;
    }
    const Components zero = Components::Zero(layout_.size());
    state.stress = subject_.initial_stress.value_or(zero);
    state.stran = zero;
    state.temperature = subject_.temperature;
    state.statev = subject_.initial_state;
    state.statev.resize(static_cast<std::size_t>(subject_.state_variables), 0.0);
    // Some materials set themselves up in the first call, which then needs no time. Others divide by it.
    if (subject_.model != nullptr) {
        const UmatCall call = call_for(state, {zero, Matrix3::Identity(), 0});
        const UmatAnswer answer = umat_(call);
        if (answer.done(call)) state = after(call, answer);
    }
    return state;
}

Matrix3 Bench::moved(const Matrix3& F, const PathStep& step) const {
    if (layout_.cohesive()) return F;
    Matrix3 d = layout_.strain_tensor(step.strain);
    // The host guesses what the kind does not have: constant volume.
    if (layout_.kind() == Kind::plane_stress) d(2, 2) = -(d(0, 0) + d(1, 1));
    if (layout_.kind() == Kind::uniaxial) d(1, 1) = d(2, 2) = -0.5 * d(0, 0);
    return exponential(d) * step.rotation * F;
}

Components Bench::turned_stress(const Components& stress, const Matrix3& rotation) const {
    if (!can_turn() || rotation.isIdentity(0)) return stress;
    return layout_.stress_components(rotation * layout_.stress_tensor(stress) * rotation.transpose());
}
Components Bench::turned_strain(const Components& strain, const Matrix3& rotation) const {
    if (!can_turn() || rotation.isIdentity(0)) return strain;
    return layout_.strain_components(rotation * layout_.strain_tensor(strain) * rotation.transpose());
}

UmatCall Bench::call_for(const CheckedState& state, const PathStep& step) const {
    UmatCall call;
    if (subject_.recorded != nullptr) call = call_of(*subject_.recorded);
    call.name = padded_material_name(subject_.name);
    call.props = subject_.constants;
    call.ndi = layout_.ndi();
    call.nshr = layout_.nshr();
    call.stress = turned_stress(state.stress, step.rotation);
    call.stran = turned_strain(state.stran, step.rotation);
    call.dstran = step.strain;
    call.statev = state.statev;
    call.sse = state.sse;
    call.spd = state.spd;
    call.scd = state.scd;
    call.pnewdt = 1;
    call.time = {state.time, state.time};
    call.dtime = step.dtime;
    call.temp = state.temperature;
    call.dtemp = 0;
    call.predef = state.fields;
    call.dpred.assign(state.fields.size(), 0.0);
    if (subject_.recorded == nullptr) call.celent = subject_.element_length;
    call.drot = step.rotation;
    call.dfgrd0 = state.F;
    call.dfgrd1 = moved(state.F, step);
    call.kinc = state.kinc;
    return call;
}

CheckedState Bench::after(const UmatCall& call, const UmatAnswer& answer) const {
    CheckedState state;
    state.stress = answer.stress;
    state.stran = call.stran + call.dstran;
    state.statev = answer.statev;
    state.sse = answer.sse;
    state.spd = answer.spd;
    state.scd = answer.scd;
    state.F = call.dfgrd1;
    state.time = call.time[1] + call.dtime;
    state.temperature = call.temp + call.dtemp;
    state.fields = call.predef;
    for (std::size_t i = 0; i < std::min(state.fields.size(), call.dpred.size()); ++i) state.fields[i] += call.dpred[i];
    state.kinc = call.kinc + 1;
    return state;
}

bool Bench::advance(CheckedState& state, const PathStep& step) {
    const UmatCall call = call_for(state, step);
    const UmatAnswer answer = umat_(call);
    if (!answer.done(call)) return false;
    state = after(call, answer);
    return true;
}

std::vector<PathStep> Bench::path(Random& random) const {
    const int n = layout_.size();
    std::vector<PathStep> steps;
    const auto leg = [&](const Components& direction, double length, int count) {
        for (int i = 0; i < count; ++i)
            steps.push_back({direction * (random.uniform(0.6, 1.4) * length / count), Matrix3::Identity(), 1});
    };
    Components first = random.direction(n);
    // What a cohesive law is for is opening; closing needs no damage.
    if (layout_.cohesive()) first[0] = std::abs(first[0]);
    const double amplitude = subject_.scale * random.uniform(0.8, 1.6);
    leg(first, amplitude, 6);
    leg(first, -0.2 * amplitude, 2);
    leg(first, 0.5 * amplitude, 3);
    leg(random.direction(n), 0.7 * amplitude, 3);
    leg(random.direction(n), 0.3 * amplitude, 2);
    for (PathStep& step : steps)
        if (random.chance(0.3)) step.rotation = random.rotation(layout_.kind(), 0.2);
    return steps;
}

std::vector<Situation> Bench::recorded_situations() {
    std::vector<Situation> all;
    const UmatCall recorded = call_of(*subject_.recorded);
    const auto add = [&](const char* label, double factor) {
        UmatCall call = recorded;
        call.pnewdt = 1;
        if (factor != 1) {
            call.dstran = factor * recorded.dstran;
            if (!layout_.cohesive()) {
                const Matrix3 change = recorded.dfgrd1 - recorded.dfgrd0;
                call.dfgrd1 = recorded.dfgrd0 + factor * change;
            }
            call.drot = Matrix3::Identity();
        }
        doing(std::string("the recorded state, ") + label);
        UmatAnswer answer = umat_(call);
        if (!answer.done(call)) return;
        const bool inelastic = answer.spd + answer.scd > call.spd + call.scd;
        all.push_back({std::string("the recorded state, ") + label, std::move(call), std::move(answer), inelastic});
    };
    add("recorded increment", 1);
    add("half of the increment", 0.5);
    add("a tenth of the increment, back", -0.1);
    return all;
}

std::vector<Situation> Bench::situations() {
    if (subject_.recorded != nullptr) return recorded_situations();
    std::vector<Situation> all;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        Random random(seed);
        CheckedState state = start();
        int number = 0;
        for (const PathStep& step : path(random)) {
            ++number;
            UmatCall call = call_for(state, step);
            std::string label = fmt::format("path {}, increment {}", seed, number);
            doing(label);
            UmatAnswer answer = umat_(call);
            if (!answer.done(call)) continue;
            state = after(call, answer);
            const double threshold = 1e-13 * std::abs(answer.sse);
            const bool inelastic = answer.spd + answer.scd > call.spd + call.scd + threshold;
            all.push_back({std::move(label), std::move(call), std::move(answer), inelastic});
        }
    }
    return all;
}

double Bench::jacobian(const Numbers& statev, const Matrix3& F) const {
    if (!subject_.reads_gradient || layout_.cohesive()) return 1;
    if (subject_.model != nullptr && !subject_.has_trait(LODE_FINITE_STRAIN)) return 1;
    if (layout_.kind() != Kind::plane_stress) return F.determinant();
    for (int i = 0; subject_.model != nullptr && i < subject_.model->state_count; ++i)
        if (std::string_view(subject_.model->state[i].name) == "F33M1")
            return F.topLeftCorner<2, 2>().determinant() * (1 + statev[static_cast<std::size_t>(i)]);
    return F.determinant();
}

std::string where(const Situation& situation) {
    return situation.label + (situation.inelastic ? " (inelastic)" : " (elastic)");
}

namespace {

// The largest strain that answers in proportion to a tiny one; the range beyond it is what the checks are about.
double found_scale(Subject subject) {
    double smallest = smallest_scale, largest = largest_scale;
    if (subject.cohesive()) {
        smallest *= subject.element_length;
        largest *= subject.element_length;
    }
    subject.scale = smallest;
    Bench bench(subject);
    const CheckedState start = bench.start();
    Components direction = Components::Zero(bench.layout().size());
    direction[0] = 1;
    if (bench.layout().nshr() > 0) direction[bench.layout().ndi()] = 1;
    const auto stress_at = [&](double strain) -> std::optional<Components> {
        doing(fmt::format("a strain of {:.3g} in search of the elastic limit", strain));
        const UmatCall call = bench.call_for(start, {strain * direction, Matrix3::Identity(), 1});
        const UmatAnswer answer = bench.call(call);
        if (!answer.done(call) || answer.spd + answer.scd > call.spd + call.scd) return std::nullopt;
        return answer.stress - start.stress;
    };
    const std::optional<Components> tiny = stress_at(smallest);
    if (!tiny) return 0.01 * (subject.cohesive() ? subject.element_length : 1);
    double scale = smallest;
    while (scale < largest) {
        const std::optional<Components> stress = stress_at(scale);
        constexpr double nonlinear = 0.01;
        if (!stress || (*stress - *tiny * (scale / smallest)).norm() > nonlinear * stress->norm()) break;
        scale *= 1.5;
    }
    constexpr double beyond = 4;
    return std::min(beyond * scale, largest);
}

bool depends_on_time(Bench& bench) {
    Components ends[2];
    for (const int k : {0, 1}) {
        Random random(5);
        CheckedState state = bench.start();
        for (PathStep step : bench.path(random)) {
            doing(fmt::format("a path, increment {}", state.kinc));
            step.dtime = k == 0 ? 1 : 1e-3;
            bench.advance(state, step);
        }
        ends[k] = state.stress;
    }
    return (ends[0] - ends[1]).norm() > 1e-12 * std::max(ends[0].norm(), bench.subject().stress_scale());
}

}  // namespace

FirstLook first_look(const Subject& given) {
    Subject subject = given;
    FirstLook look;
    {
        doing("the first call");
        if (subject.scale <= 0) subject.scale = 1e-7;
        Bench bench(subject);
        const CheckedState start = bench.start();
        const UmatCall call =
            subject.recorded != nullptr
                ? call_of(*subject.recorded)
                : bench.call_for(start, {Components::Zero(bench.layout().size()), Matrix3::Identity(), 1});
        const UmatAnswer answer = bench.call(call);
        if (!answer.returned) {
            look.refusal = answer.message.empty() ? "the library ended the analysis" : answer.message;
            return look;
        }
    }
    subject.scale = given.scale > 0 ? given.scale : found_scale(given);
    look.scale = subject.scale;
    {
        Bench bench(subject);
        const CheckedState start = bench.start();
        const int n = bench.layout().size();
        const double h = 1e-4 * subject.scale;
        const UmatCall zero = bench.call_for(start, {Components::Zero(n), Matrix3::Identity(), 1});
        doing("a zero increment");
        const UmatAnswer base = bench.call(zero);
        for (int k = 0; k < n; ++k) {
            doing(fmt::format("a strain of {:.3g} from the start", h));
            Components strain = Components::Zero(n);
            strain[k] = h;
            const UmatAnswer answer = bench.call(bench.call_for(start, {strain, Matrix3::Identity(), 1}));
            const double change = (answer.stress - base.stress).cwiseAbs().maxCoeff() / h;
            if (std::isfinite(change)) look.stiffness = std::max(look.stiffness, change);
        }
        // A material that answers NaN to a zero increment still has a stiffness.
        if (look.stiffness == 0)
            for (int k = 0; k < n; ++k) {
                Components strain = Components::Zero(n);
                strain[k] = h;
                const UmatAnswer answer = bench.call(bench.call_for(start, {strain, Matrix3::Identity(), 1}));
                const double change = (answer.stress - start.stress).cwiseAbs().maxCoeff() / h;
                if (std::isfinite(change)) look.stiffness = std::max(look.stiffness, change);
            }
        // Where nothing resists, a prescribed traction say, its size is the scale.
        if (look.stiffness == 0) look.stiffness = base.stress.cwiseAbs().maxCoeff() / subject.scale;
        if (!(look.stiffness > 0)) look.stiffness = 1;
        if (!bench.layout().cohesive()) {
            doing("a deformation gradient without a strain increment");
            UmatCall stretched = zero;
            stretched.dfgrd1 = bench.moved(stretched.dfgrd0, {Components::Constant(n, 0.25 * subject.scale)});
            const UmatAnswer answer = bench.call(stretched);
            look.reads_gradient = answer.returned && answer.stress.allFinite() && base.stress.allFinite() &&
                                  (answer.stress - base.stress).norm() > 0;
        }
    }
    subject.stiffness = look.stiffness;
    subject.reads_gradient = look.reads_gradient;
    Bench bench(subject);
    look.rate_dependent = depends_on_time(bench);
    for (const Situation& s : bench.situations()) ++(s.inelastic ? look.inelastic : look.elastic);
    return look;
}

}  // namespace lode::host
