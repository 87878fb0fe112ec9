#include "recorder.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <string_view>
#include <utility>

#include "writer.hpp"

namespace lode::record {
namespace {

constexpr std::size_t cmname_length = 80;

// Made at the first call; null if the recording is refused, which has then been said.
Writer* writer() {
    static const std::unique_ptr<Writer> instance = []() -> std::unique_ptr<Writer> {
        try {
            const char* const value = std::getenv("LODE_RECORD");
            const Recorded library = recorded_library();
            return std::make_unique<Writer>(parse_request(value != nullptr ? value : ""), library.library,
                                            library.version, library.instruction_set);
        } catch (const std::exception& problem) {
            std::fprintf(stderr, "Lode: WARNING: %s; nothing is recorded\n", problem.what());
            return nullptr;
        }
    }();
    return instance.get();
}

int value_of(const int* argument) { return argument != nullptr ? *argument : 0; }
template <class Real>
double value_of(const Real* argument) {
    return argument != nullptr ? static_cast<double>(*argument) : 0.0;
}

std::string_view trimmed(const char* cmname) {
    std::string_view name(cmname, strnlen(cmname, cmname_length));
    while (!name.empty() && name.back() == ' ') name.remove_suffix(1);
    return name;
}

const double* input(const UmatCall& c, UmatInput argument) {
    const double* const all[] = {c.stress, c.statev, c.sse,    c.spd,    c.scd,   c.pnewdt, c.stran,
                                 c.dstran, c.time,   c.dtime,  c.temp,   c.dtemp, c.predef, c.dpred,
                                 c.coords, c.drot,   c.celent, c.dfgrd0, c.dfgrd1};
    return all[static_cast<int>(argument)];
}
const double* output(const UmatCall& c, UmatOutput argument) {
    const double* const all[] = {c.stress, c.statev, c.ddsdde, c.sse,    c.spd,   c.scd,
                                 c.rpl,    c.ddsddt, c.drplde, c.drpldt, c.pnewdt};
    return all[static_cast<int>(argument)];
}
template <class Real>
const Real* input(const VumatCall<Real>& c, VumatInput argument) {
    const Real* const all[] = {c.char_length, c.density,     c.strain_inc,      c.rel_spin_inc,
                               c.temp_old,    c.stretch_old, c.defgrad_old,     c.field_old,
                               c.stress_old,  c.state_old,   c.ener_intern_old, c.ener_inelas_old,
                               c.temp_new,    c.stretch_new, c.defgrad_new,     c.field_new};
    return all[static_cast<int>(argument)];
}
template <class Real>
const Real* output(const VumatCall<Real>& c, VumatOutput argument) {
    const Real* const all[] = {c.stress_new, c.state_new, c.ener_intern_new, c.ener_inelas_new, c.strain_inc};
    return all[static_cast<int>(argument)];
}

UmatHeader header_of(const UmatCall& c, int fields) {
    UmatHeader h;
    h.ndi = value_of(c.ndi);
    h.nshr = value_of(c.nshr);
    h.ntens = value_of(c.ntens);
    h.nstatv = value_of(c.nstatv);
    h.fields = fields;
    h.noel = value_of(c.noel);
    h.npt = value_of(c.npt);
    h.layer = value_of(c.layer);
    h.kspt = value_of(c.kspt);
    h.kstep = value_of(c.kstep);
    h.kinc = value_of(c.kinc);
    return h;
}
template <class Real>
VumatHeader header_of(const VumatCall<Real>& c, int increment) {
    VumatHeader h;
    h.nblock = value_of(c.nblock);
    h.ndir = value_of(c.ndir);
    h.nshr = value_of(c.nshr);
    h.nstatev = value_of(c.nstatev);
    h.nfieldv = value_of(c.nfieldv);
    h.lanneal = value_of(c.lanneal);
    h.real_size = static_cast<std::int32_t>(sizeof(Real));
    h.increment = increment;
    h.step_time = value_of(c.step_time);
    h.total_time = value_of(c.total_time);
    h.dt = value_of(c.dt);
    return h;
}

// The call that the thread is in.
struct InFlight {
    Writer* writer = nullptr;
    FrameKind kind{};
    std::uint64_t sequence = 0;
    Bytes frame;
};
thread_local InFlight* in_flight = nullptr;

constexpr std::size_t outcome_offset = sizeof(FrameHeader) + offsetof(UmatHeader, outcome);
static_assert(offsetof(UmatHeader, outcome) == offsetof(VumatHeader, outcome));

template <class Header, class Input, class Call>
void append_inputs(Bytes& frame, Header header, const Call& call) {
    for (int i = 0; i < static_cast<int>(Input::count); ++i)
        if (input(call, static_cast<Input>(i)) != nullptr) header.present |= 1u << i;
    frame.append(FrameHeader{});
    frame.append(header);
    for (int i = 0; i < static_cast<int>(Input::count); ++i) {
        const auto* const argument = input(call, static_cast<Input>(i));
        if (argument != nullptr) frame.append(argument, length(header, static_cast<Input>(i)) * sizeof *argument);
    }
}
template <class Output, class Header, class Call>
void append_outputs(Bytes& frame, const Header& header, const Call& call) {
    for (int i = 0; i < static_cast<int>(Output::count); ++i) {
        const auto* const argument = output(call, static_cast<Output>(i));
        frame.append(argument, length(header, static_cast<Output>(i)) * sizeof *argument);
    }
}

// False if the call was stored meanwhile as one that does not return, though it did: the host's XIT came back.
template <class Run>
bool run_in_flight(InFlight& flight, const Run& run) {
    InFlight* const outer = in_flight;
    in_flight = &flight;
    run();
    return std::exchange(in_flight, outer) == &flight;
}

template <class Real>
void record_vumat(const VumatCall<Real>& call, void (*run)(const VumatCall<Real>&)) {
    Writer* const w = writer();
    if (w == nullptr || !selects_material(w->selection(), trimmed(call.cmname))) return run(call);
    const int increment = w->explicit_increment(value_of(call.total_time));
    // An explicit host does not say which elements a block holds, nor number its steps.
    if (!selects(w->selection().increments, increment)) return run(call);
    VumatHeader header = header_of(call, increment);
    header.thread = gettid();
    header.material = w->material(trimmed(call.cmname), call.props,
                                  static_cast<std::size_t>(std::max(value_of(call.nprops), 0)), sizeof(Real));
    InFlight flight{w, FrameKind::vumat, w->next_call(), {}};
    append_inputs<VumatHeader, VumatInput>(flight.frame, header, call);
    if (!run_in_flight(flight, [&] { run(call); }) || w->selection().only_cut) return;
    append_outputs<VumatOutput>(flight.frame, header, call);
    w->write_call(FrameKind::vumat, flight.sequence, flight.frame);
}

}  // namespace

const bool active = std::getenv("LODE_RECORD") != nullptr;

void record(const UmatCall& call, void (*run)(const UmatCall&)) {
    Writer* const w = writer();
    if (w == nullptr) return run(call);
    const Selection& wanted = w->selection();
    if (!selects_material(wanted, trimmed(call.cmname)) || !selects(wanted.elements, value_of(call.noel)) ||
        !selects(wanted.points, value_of(call.npt)) || !selects(wanted.steps, value_of(call.kstep)) ||
        !selects(wanted.increments, value_of(call.kinc)))
        return run(call);
    UmatHeader header = header_of(call, wanted.fields);
    header.thread = gettid();
    header.material = w->material(trimmed(call.cmname), call.props,
                                  static_cast<std::size_t>(std::max(value_of(call.nprops), 0)), sizeof(double));
    InFlight flight{w, FrameKind::umat, w->next_call(), {}};
    append_inputs<UmatHeader, UmatInput>(flight.frame, header, call);
    const double ratio_on_entry = *call.pnewdt;
    if (!run_in_flight(flight, [&] { run(call); })) return;
    const bool is_cut = *call.pnewdt < 1.0 && *call.pnewdt != ratio_on_entry;
    if (wanted.only_cut && !is_cut) return;
    append_outputs<UmatOutput>(flight.frame, header, call);
    w->write_call(FrameKind::umat, flight.sequence, flight.frame);
    if (is_cut) w->flush();
}
void record(const VumatCall<double>& call, void (*run)(const VumatCall<double>&)) { record_vumat(call, run); }
void record(const VumatCall<float>& call, void (*run)(const VumatCall<float>&)) { record_vumat(call, run); }

void ending() {
    InFlight* const flight = std::exchange(in_flight, nullptr);
    if (flight == nullptr) return;
    const Outcome outcome = Outcome::did_not_return;
    std::memcpy(flight->frame.data() + outcome_offset, &outcome, sizeof outcome);
    flight->writer->write_call(flight->kind, flight->sequence, flight->frame);
    flight->writer->flush();
}

}  // namespace lode::record
