#include "recorded_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>

#include "../guard.hpp"
#include "../status.hpp"

namespace lode::host {
namespace {

using namespace record;

// Calls `run` with fresh inputs again and again; the clock's own time is below what is worth subtracting here.
template <class Prepare, class Run>
bool repeat(int repetitions, double& median, const Prepare& prepare, Run&& run) {
    std::vector<double> times;
    times.reserve(static_cast<std::size_t>(repetitions));
    for (int i = 0; i < repetitions; ++i) {
        prepare();
        const auto start = std::chrono::steady_clock::now();
        if (!guarded(run)) return false;
        times.push_back(std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count());
    }
    std::nth_element(times.begin(), times.begin() + repetitions / 2, times.end());
    median = times[static_cast<std::size_t>(repetitions / 2)];
    return true;
}

// Arrays that were null pointers stay null.
template <class Real>
Real* address(std::vector<Real>& values, bool present) {
    static Real none{};
    return !present ? nullptr : values.empty() ? &none : values.data();
}

RunAgain run_umat(const RecordedCall& call, UmatFunction umat, int repetitions) {
    const UmatHeader& h = call.umat();
    std::vector<std::vector<double>> in = call.inputs;
    RunAgain again;
    for (std::size_t i = 0; i < static_cast<std::size_t>(UmatOutput::count); ++i)
        again.outputs.emplace_back(length(h, static_cast<UmatOutput>(i)));
    const auto input = [&](UmatInput i) {
        return address(in[static_cast<std::size_t>(i)], (call.present >> static_cast<int>(i) & 1u) != 0);
    };
    const auto output = [&](UmatOutput i) -> std::vector<double>& {
        return again.outputs[static_cast<std::size_t>(i)];
    };
    // What is input and output.
    constexpr std::pair<UmatInput, UmatOutput> both[] = {
        {UmatInput::stress, UmatOutput::stress}, {UmatInput::statev, UmatOutput::statev},
        {UmatInput::sse, UmatOutput::sse},       {UmatInput::spd, UmatOutput::spd},
        {UmatInput::scd, UmatOutput::scd},       {UmatInput::pnewdt, UmatOutput::pnewdt}};
    const std::string name = padded_material_name(call.material->name);
    std::vector<double> constants = call.material->constants;
    const int nprops = static_cast<int>(constants.size());
    const std::array<int, 4> jstep{h.kstep, 1, 0, 0};
    again.returned = repeat(
        repetitions, again.nanoseconds,
        [&] {
            for (const auto& [from, to] : both) output(to) = in[static_cast<std::size_t>(from)];
        },
        [&] {
            const auto out = [&](UmatOutput i) { return address(output(i), true); };
            umat(out(UmatOutput::stress), out(UmatOutput::statev), out(UmatOutput::ddsdde), out(UmatOutput::sse),
                 out(UmatOutput::spd), out(UmatOutput::scd), out(UmatOutput::rpl), out(UmatOutput::ddsddt),
                 out(UmatOutput::drplde), out(UmatOutput::drpldt), input(UmatInput::stran), input(UmatInput::dstran),
                 input(UmatInput::time), input(UmatInput::dtime), input(UmatInput::temp), input(UmatInput::dtemp),
                 input(UmatInput::predef), input(UmatInput::dpred), name.data(), &h.ndi, &h.nshr, &h.ntens, &h.nstatv,
                 address(constants, true), &nprops, input(UmatInput::coords), input(UmatInput::drot),
                 out(UmatOutput::pnewdt), input(UmatInput::celent), input(UmatInput::dfgrd0), input(UmatInput::dfgrd1),
                 &h.noel, &h.npt, &h.layer, &h.kspt, jstep.data(), &h.kinc, material_name_length);
        });
    return again;
}

template <class Real>
RunAgain run_vumat(const RecordedCall& call, VumatOf<Real> vumat, int repetitions) {
    const VumatHeader& h = call.vumat();
    const auto as_real = [](const std::vector<double>& values) {
        std::vector<Real> result(values.size());
        std::transform(values.begin(), values.end(), result.begin(), [](double x) { return static_cast<Real>(x); });
        return result;
    };
    std::vector<std::vector<Real>> in, out;
    for (const std::vector<double>& values : call.inputs) in.push_back(as_real(values));
    for (std::size_t i = 0; i < static_cast<std::size_t>(VumatOutput::count); ++i)
        out.emplace_back(length(h, static_cast<VumatOutput>(i)));
    const auto input = [&](VumatInput i) {
        return address(in[static_cast<std::size_t>(i)], (call.present >> static_cast<int>(i) & 1u) != 0);
    };
    const auto output = [&](VumatOutput i) { return address(out[static_cast<std::size_t>(i)], true); };
    const std::string name = padded_material_name(call.material->name);
    std::vector<Real> constants = as_real(call.material->constants);
    const int nprops = static_cast<int>(constants.size());
    const Real step_time = static_cast<Real>(h.step_time), total_time = static_cast<Real>(h.total_time);
    const Real dt = static_cast<Real>(h.dt);
    std::vector<Real> coordinates(static_cast<std::size_t>(h.nblock) * 3);
    RunAgain again;
    again.returned = repeat(
        repetitions, again.nanoseconds,
        [&] {
            out[static_cast<std::size_t>(VumatOutput::strain_inc)] =
                in[static_cast<std::size_t>(VumatInput::strain_inc)];
        },
        [&] {
            vumat(&h.nblock, &h.ndir, &h.nshr, &h.nstatev, &h.nfieldv, &nprops, &h.lanneal, &step_time, &total_time,
                  &dt, name.data(), coordinates.data(), input(VumatInput::char_length), address(constants, true),
                  input(VumatInput::density), output(VumatOutput::strain_inc), input(VumatInput::rel_spin_inc),
                  input(VumatInput::temp_old), input(VumatInput::stretch_old), input(VumatInput::defgrad_old),
                  input(VumatInput::field_old), input(VumatInput::stress_old), input(VumatInput::state_old),
                  input(VumatInput::ener_intern_old), input(VumatInput::ener_inelas_old), input(VumatInput::temp_new),
                  input(VumatInput::stretch_new), input(VumatInput::defgrad_new), input(VumatInput::field_new),
                  output(VumatOutput::stress_new), output(VumatOutput::state_new), output(VumatOutput::ener_intern_new),
                  output(VumatOutput::ener_inelas_new), material_name_length);
        });
    for (const std::vector<Real>& values : out) again.outputs.emplace_back(values.begin(), values.end());
    return again;
}

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

}  // namespace

RunAgain run_again(const RecordedCall& call, const Library& library, int repetitions) {
    const bool exists = call.is_umat() ? library.umat() != nullptr : library.vumat() != nullptr;
    if (!exists)
        throw NotLoaded(
            fmt::format("{} has no {}, which was recorded", library.path(), call.is_umat() ? "umat_" : "vumat_"));
    if (call.is_umat()) return run_umat(call, library.umat(), repetitions);
    if (call.vumat().real_size == static_cast<int>(sizeof(float)))
        return run_vumat<float>(call, reinterpret_cast<VumatOf<float>>(library.vumat()), repetitions);
    return run_vumat<double>(call, library.vumat(), repetitions);
}

Difference compare(const RecordedCall& call, const RunAgain& again) {
    Difference worst;
    for (std::size_t o = 0; o < call.outputs.size(); ++o) {
        const std::vector<double>&before = call.outputs[o], &now = again.outputs[o];
        double scale = std::numeric_limits<double>::min();
        for (const double x : before)
            if (std::isfinite(x)) scale = std::max(scale, std::abs(x));
        for (std::size_t i = 0; i < before.size(); ++i) {
            if (same_bits(before[i], now[i])) continue;
            const double change = std::abs(now[i] - before[i]) / scale;
            const double relative = std::isnan(change) ? std::numeric_limits<double>::infinity() : change;
            if (!worst.argument.empty() && relative <= worst.relative) continue;
            worst = {fmt::format("{}({})", output_name(call, o), i + 1), before[i], now[i], relative};
        }
    }
    return worst;
}

}  // namespace lode::host
