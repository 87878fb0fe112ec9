#include "vumat_call.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "../guard.hpp"
#include "../replay/kinematics.hpp"
#include "child.hpp"

namespace lode::host {
namespace {

using record::VumatHeader;
using record::VumatInput;
using record::VumatOutput;

constexpr int thickness = -1;
constexpr double density = 1;
constexpr std::array<std::pair<int, int>, 9> gradient_positions{
    {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}, {1, 0}, {2, 1}, {0, 2}}};

// 11, 22, 33, 12, 23, 31 against 11, 22, 33, 12, 13, 23.
std::vector<int> component_map(Kind kind) {
    switch (kind) {
        case Kind::solid:
            return {0, 1, 2, 3, 5, 4};
        case Kind::plane_stress:
            return {0, 1, thickness, 2};
        default: {
            std::vector<int> map;
            for (int i = 0; i < Layout(kind).size(); ++i) map.push_back(i);
            return map;
        }
    }
}

std::string explicit_name(const Subject& subject) {
    if (subject.kind != Kind::plane_stress || subject.recorded != nullptr) return subject.name;
    const auto dash = subject.name.find('-');
    const std::string label = dash == std::string::npos ? "" : subject.name.substr(dash);
    return subject.name.substr(0, dash) + "-PS" + label;
}

// Columns of one point.
std::size_t columns(const Numbers& values, int points) {
    return points > 0 ? values.size() / static_cast<std::size_t>(points) : 0;
}

}  // namespace

VumatCall call_of_vumat(const RecordedCall& recorded) {
    VumatCall call;
    call.name = padded_material_name(recorded.material->name);
    call.props = recorded.material->constants;
    call.header = recorded.vumat();
    for (std::size_t i = 0; i < call.in.size(); ++i) {
        call.in[i] = recorded.inputs[i];
        call.in[i].resize(record::length(call.header, static_cast<VumatInput>(i)), 0.0);
    }
    return call;
}

VumatCall selected(const VumatCall& call, const std::vector<int>& points) {
    VumatCall part = call;
    part.header.nblock = static_cast<int>(points.size());
    for (std::size_t i = 0; i < call.in.size(); ++i) {
        const std::size_t n = columns(call.in[i], call.points());
        part.in[i].clear();
        for (std::size_t c = 0; c < n; ++c)
            for (const int p : points)
                part.in[i].push_back(
                    call.in[i][c * static_cast<std::size_t>(call.points()) + static_cast<std::size_t>(p)]);
    }
    return part;
}

VumatCall joined(const std::vector<VumatCall>& calls) {
    VumatCall all = calls.front();
    all.header.nblock = static_cast<int>(calls.size());
    for (std::size_t i = 0; i < all.in.size(); ++i) {
        const std::size_t n = calls.front().in[i].size();
        all.in[i].clear();
        for (std::size_t c = 0; c < n; ++c)
            for (const VumatCall& call : calls) all.in[i].push_back(call.in[i][c]);
    }
    return all;
}

bool VumatAnswer::finite() const {
    for (const VumatOutput o : {VumatOutput::stress_new, VumatOutput::state_new})
        if (!std::all_of(output(o).begin(), output(o).end(), [](double x) { return std::isfinite(x); })) return false;
    return true;
}

VumatAnswer point_of(const VumatAnswer& answer, int point) {
    VumatAnswer one;
    one.returned = answer.returned;
    one.points = 1;
    for (std::size_t o = 0; o < one.out.size(); ++o)
        for (std::size_t c = 0; c < columns(answer.out[o], answer.points); ++c)
            one.out[o].push_back(
                answer.out[o][c * static_cast<std::size_t>(answer.points) + static_cast<std::size_t>(point)]);
    return one;
}

std::string first_difference(const VumatAnswer& a, const VumatAnswer& b) {
    if (a.returned != b.returned) return "the end of the analysis";
    for (std::size_t o = 0; a.returned && o < a.out.size(); ++o)
        if (a.out[o].size() != b.out[o].size() ||
            (!a.out[o].empty() && std::memcmp(a.out[o].data(), b.out[o].data(), a.out[o].size() * sizeof(double)) != 0))
            return name_of(static_cast<VumatOutput>(o));
    return {};
}

VumatAnswer VumatCaller::operator()(const VumatCall& call, const Surroundings& around) {
    const VumatHeader& h = call.header;
    std::size_t total = call.props.size() + 3 * static_cast<std::size_t>(h.nblock) + 8;
    for (const Numbers& values : call.in) total += values.size();
    for (std::size_t o = 0; o < static_cast<std::size_t>(VumatOutput::count); ++o)
        total += record::length(h, static_cast<VumatOutput>(o));
    numbers_.reset(total, 32);
    integers_.reset(16, 8);
    letters_.reset(material_name_length, 1);
    const auto input = [&](VumatInput i) {
        const char* const name = name_of(i);
        return numbers_.input(name, call.input(i).data(), call.input(i).size(), around.zone_of(name));
    };
    const auto output = [&](VumatOutput o) {
        const char* const name = name_of(o);
        return numbers_.output(name, record::length(h, o), around.outputs, around.zone_of(name));
    };
    const auto scalar = [&](const char* name, const double& value) {
        return numbers_.input(name, &value, 1, around.zone_of(name));
    };
    const auto integer = [&](const char* name, int value) { return integers_.input(name, &value, 1, 0x5A5A5A5A); };
    const int* const nblock = integer("nblock", h.nblock);
    const int* const ndir = integer("ndir", h.ndir);
    const int* const nshr = integer("nshr", h.nshr);
    const int* const nstatev = integer("nstatev", h.nstatev);
    const int* const nfieldv = integer("nfieldv", h.nfieldv);
    const int* const nprops = integer("nprops", static_cast<int>(call.props.size()));
    const int* const lanneal = integer("lanneal", h.lanneal);
    const double* const step_time = scalar("stepTime", h.step_time);
    const double* const total_time = scalar("totalTime", h.total_time);
    const double* const dt = scalar("dt", h.dt);
    const char* const cmname = letters_.input("cmname", call.name.data(), call.name.size(), ' ');
    const Numbers no_coordinates(3 * static_cast<std::size_t>(h.nblock));
    const double* const coordinates =
        numbers_.input("coordMp", no_coordinates.data(), no_coordinates.size(), around.zone_of("coordMp"));
    const double* const props = numbers_.input("props", call.props.data(), call.props.size(), around.zone_of("props"));
    const double* const length = input(VumatInput::char_length);
    const double* const rho = input(VumatInput::density);
    // The thickness strain of plane stress is an answer.
    double* const strain_inc = numbers_.inout("strainInc", call.input(VumatInput::strain_inc).data(),
                                              call.input(VumatInput::strain_inc).size(), around.zone_of("strainInc"));
    const double* const spin = input(VumatInput::rel_spin_inc);
    const double* const temp_old = input(VumatInput::temp_old);
    const double* const stretch_old = input(VumatInput::stretch_old);
    const double* const gradient_old = input(VumatInput::defgrad_old);
    const double* const field_old = input(VumatInput::field_old);
    const double* const stress_old = input(VumatInput::stress_old);
    const double* const state_old = input(VumatInput::state_old);
    const double* const intern_old = input(VumatInput::ener_intern_old);
    const double* const inelas_old = input(VumatInput::ener_inelas_old);
    const double* const temp_new = input(VumatInput::temp_new);
    const double* const stretch_new = input(VumatInput::stretch_new);
    const double* const gradient_new = input(VumatInput::defgrad_new);
    const double* const field_new = input(VumatInput::field_new);
    double* const stress_new = output(VumatOutput::stress_new);
    double* const state_new = output(VumatOutput::state_new);
    double* const intern_new = output(VumatOutput::ener_intern_new);
    double* const inelas_new = output(VumatOutput::ener_inelas_new);

    VumatAnswer answer;
    answer.points = h.nblock;
    answer.returned = guarded([&] {
        function_(nblock, ndir, nshr, nstatev, nfieldv, nprops, lanneal, step_time, total_time, dt, cmname, coordinates,
                  length, props, rho, strain_inc, spin, temp_old, stretch_old, gradient_old, field_old, stress_old,
                  state_old, intern_old, inelas_old, temp_new, stretch_new, gradient_new, field_new, stress_new,
                  state_new, intern_new, inelas_new, material_name_length);
    });
    if (!answer.returned) answer.message = last_library_error();
    const auto keep = [&](VumatOutput o, const double* values) {
        answer.out[static_cast<std::size_t>(o)].assign(values, values + record::length(h, o));
    };
    keep(VumatOutput::stress_new, stress_new);
    keep(VumatOutput::state_new, state_new);
    keep(VumatOutput::ener_intern_new, intern_new);
    keep(VumatOutput::ener_inelas_new, inelas_new);
    keep(VumatOutput::strain_inc, strain_inc);
    numbers_.collect_damage(answer.damage);
    integers_.collect_damage(answer.damage);
    letters_.collect_damage(answer.damage);
    return answer;
}

VumatBench::VumatBench(const Subject& subject)
    : subject_(subject), layout_(subject.kind), map_(component_map(subject.kind)), vumat_(subject.library->vumat()) {}

bool VumatBench::served() const { return layout_.kind() != Kind::plane_stress || subject_.model != nullptr; }

VumatCall VumatBench::start() const {
    VumatCall call;
    call.name = padded_material_name(explicit_name(subject_));
    call.props = subject_.constants;
    VumatHeader& h = call.header;
    h.nblock = 1;
    h.nshr = layout_.nshr();
    h.ndir = static_cast<int>(map_.size()) - h.nshr;
    h.nstatev = subject_.state_variables;
    h.nfieldv = 1;
    h.dt = 1;
    h.step_time = h.total_time = 1;
    for (std::size_t i = 0; i < call.in.size(); ++i)
        call.in[i].assign(record::length(h, static_cast<VumatInput>(i)), 0.0);
    call.input(VumatInput::char_length) = {subject_.element_length};
    call.input(VumatInput::density) = {density};
    call.input(VumatInput::temp_old) = call.input(VumatInput::temp_new) = {subject_.temperature};
    Numbers& state = call.input(VumatInput::state_old);
    std::copy_n(subject_.initial_state.begin(), std::min(subject_.initial_state.size(), state.size()), state.begin());
    if (subject_.initial_stress)
        for (std::size_t i = 0; i < map_.size(); ++i)
            if (map_[i] != thickness) call.input(VumatInput::stress_old)[i] = (*subject_.initial_stress)[map_[i]];
    for (const VumatInput i :
         {VumatInput::stretch_old, VumatInput::stretch_new, VumatInput::defgrad_old, VumatInput::defgrad_new})
        std::fill_n(call.input(i).begin(), h.ndir, 1.0);
    return call;
}

VumatCall VumatBench::with_strain(const VumatCall& state, const Components& strain, double dt) const {
    VumatCall call = state;
    VumatHeader& h = call.header;
    h.total_time += dt - h.dt;
    h.step_time += dt - h.dt;
    h.dt = dt;
    for (std::size_t i = 0; i < map_.size(); ++i) {
        const int k = map_[i];
        // Tensor shears.
        call.input(VumatInput::strain_inc)[i] = k == thickness ? 0 : (k < layout_.ndi() ? 1 : 0.5) * strain[k];
    }
    if (layout_.cohesive()) return call;
    Matrix3 U = Matrix3::Identity();
    const auto shears = static_cast<std::size_t>(h.nshr), normals = static_cast<std::size_t>(h.ndir);
    for (std::size_t i = 0; i < normals + shears; ++i) {
        const auto [row, column] = gradient_positions[i < normals ? i : 3 + i - normals];
        U(row, column) = U(column, row) = call.input(VumatInput::stretch_old)[i];
    }
    Matrix3 d = layout_.strain_tensor(strain);
    if (layout_.kind() == Kind::plane_stress) d(2, 2) = -(d(0, 0) + d(1, 1));
    if (layout_.kind() == Kind::uniaxial) d(1, 1) = d(2, 2) = -0.5 * d(0, 0);
    const Matrix3 stretch = polar(exponential(d) * U).right_stretch;
    for (std::size_t i = 0; i < normals; ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        call.input(VumatInput::stretch_new)[i] = call.input(VumatInput::defgrad_new)[i] = stretch(k, k);
    }
    for (std::size_t i = 0; i < shears; ++i) {
        const auto [row, column] = gradient_positions[3 + i];
        const double value = 0.5 * (stretch(row, column) + stretch(column, row));
        call.input(VumatInput::stretch_new)[normals + i] = call.input(VumatInput::defgrad_new)[normals + i] =
            call.input(VumatInput::defgrad_new)[normals + shears + i] = value;
    }
    const double J = subject_.reads_gradient ? stretch.determinant() : 1;
    call.input(VumatInput::density) = {density / J};
    return call;
}

VumatCall VumatBench::next(const VumatCall& call, const VumatAnswer& answer, const Components& strain,
                           double dt) const {
    VumatCall state = call;
    state.input(VumatInput::stress_old) = answer.output(VumatOutput::stress_new);
    state.input(VumatInput::state_old) = answer.output(VumatOutput::state_new);
    state.input(VumatInput::ener_intern_old) = answer.output(VumatOutput::ener_intern_new);
    state.input(VumatInput::ener_inelas_old) = answer.output(VumatOutput::ener_inelas_new);
    state.input(VumatInput::stretch_old) = call.input(VumatInput::stretch_new);
    state.input(VumatInput::defgrad_old) = call.input(VumatInput::defgrad_new);
    // `with_strain` takes the old increment of time off again.
    state.header.total_time += call.header.dt;
    state.header.step_time += call.header.dt;
    return with_strain(state, strain, dt);
}

std::vector<VumatCall> VumatBench::situations() {
    std::vector<VumatCall> all;
    if (subject_.recorded != nullptr) {
        const VumatCall block = call_of_vumat(*subject_.recorded);
        constexpr int most = 64;
        for (int p = 0; p < std::min(block.points(), most); ++p) all.push_back(selected(block, {p}));
        return all;
    }
    const Bench paths(subject_);
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        Random random(seed);
        VumatCall call = start();
        bool first = true;
        VumatAnswer answer;
        int number = 0;
        for (const PathStep& step : paths.path(random)) {
            VumatCall coming =
                first ? with_strain(call, step.strain, step.dtime) : next(call, answer, step.strain, step.dtime);
            doing(fmt::format("path {}, increment {} (VUMAT)", seed, ++number));
            VumatAnswer reply = vumat_(coming);
            if (!reply.returned || !reply.finite()) continue;
            // Joined to blocks, all have the same times.
            VumatCall kept = coming;
            kept.header.total_time = kept.header.step_time = 100;
            all.push_back(std::move(kept));
            call = std::move(coming);
            answer = std::move(reply);
            first = false;
        }
    }
    return all;
}

Components VumatBench::strain(const VumatCall& call) const {
    Components strain = Components::Zero(layout_.size());
    for (std::size_t i = 0; i < map_.size(); ++i)
        if (map_[i] != thickness)
            strain[map_[i]] = (map_[i] < layout_.ndi() ? 1 : 2) * call.input(VumatInput::strain_inc)[i];
    return strain;
}

Components VumatBench::stress(const Numbers& values) const {
    Components stress = Components::Zero(layout_.size());
    for (std::size_t i = 0; i < map_.size(); ++i)
        if (map_[i] != thickness) stress[map_[i]] = values[i];
    return stress;
}

UmatCall VumatBench::as_umat(const VumatCall& call) const {
    UmatCall umat;
    umat.name = padded_material_name(subject_.name);
    umat.props = call.props;
    umat.ndi = layout_.ndi();
    umat.nshr = layout_.nshr();
    umat.stress = stress(call.input(VumatInput::stress_old));
    umat.stran = Components::Zero(layout_.size());
    umat.dstran = strain(call);
    umat.statev = call.input(VumatInput::state_old);
    umat.dtime = call.header.dt;
    umat.time = {call.header.total_time - call.header.dt, call.header.total_time - call.header.dt};
    umat.temp = call.input(VumatInput::temp_old)[0];
    umat.dtemp = call.input(VumatInput::temp_new)[0] - umat.temp;
    umat.celent = call.input(VumatInput::char_length)[0];
    if (layout_.cohesive()) return umat;
    const auto shears = static_cast<std::size_t>(call.header.nshr),
               normals = static_cast<std::size_t>(call.header.ndir);
    const auto gradient = [&](VumatInput i, Matrix3& F) {
        for (std::size_t k = 0; k < normals + 2 * shears; ++k) {
            std::size_t place = k;
            if (k >= normals + shears) place = 6 + k - normals - shears;
            else if (k >= normals) place = 3 + k - normals;
            const auto [row, column] = gradient_positions[place];
            F(row, column) = call.input(i)[k];
        }
    };
    gradient(VumatInput::defgrad_old, umat.dfgrd0);
    gradient(VumatInput::defgrad_new, umat.dfgrd1);
    return umat;
}

FirstLook vumat_first_look(const Subject& given) {
    Subject subject = given;
    FirstLook look;
    const double unit = subject.cohesive() ? subject.element_length : 1;
    const double smallest = 1e-7 * unit, largest = 0.05 * unit;
    VumatBench bench(subject);
    const int n = bench.layout().size();
    const VumatCall start =
        subject.recorded != nullptr ? selected(call_of_vumat(*subject.recorded), {0}) : bench.start();
    const auto stress_at = [&](const Components& strain) {
        doing(fmt::format("a strain of {:.3g} from the start (VUMAT)", strain.cwiseAbs().maxCoeff()));
        return bench.call(bench.with_strain(start, strain, 1));
    };
    const VumatAnswer rest = stress_at(Components::Zero(n));
    if (!rest.returned) {
        look.refusal = rest.message.empty() ? "the library ended the analysis" : rest.message;
        return look;
    }
    const Components stress = bench.stress(rest.output(VumatOutput::stress_new));
    const auto change = [&](const Components& strain) -> Components {
        const VumatAnswer answer = stress_at(strain);
        if (!answer.returned) return Components::Constant(n, NAN);
        return bench.stress(answer.output(VumatOutput::stress_new)) - stress;
    };
    for (int k = 0; k < n; ++k) {
        Components strain = Components::Zero(n);
        strain[k] = smallest;
        const double slope = change(strain).cwiseAbs().maxCoeff() / smallest;
        if (std::isfinite(slope)) look.stiffness = std::max(look.stiffness, slope);
    }
    Components direction = Components::Zero(n);
    direction[0] = 1;
    if (bench.layout().nshr() > 0) direction[bench.layout().ndi()] = 1;
    const Components tiny = change(smallest * direction);
    double scale = smallest;
    for (; scale < largest; scale *= 1.5) {
        const Components there = change(scale * direction);
        constexpr double nonlinear = 0.01;
        if (!((there - tiny * (scale / smallest)).norm() <= nonlinear * there.norm())) break;
    }
    constexpr double beyond = 4;
    look.scale = given.scale > 0 ? given.scale : std::min(beyond * scale, largest);
    return look;
}

}  // namespace lode::host
