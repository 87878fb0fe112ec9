#include "command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <vector>

#include "../library.hpp"
#include "../plot/gnuplot.hpp"
#include "../replay/analysis.hpp"
#include "deck_writer.hpp"
#include "recorded_run.hpp"
#include "recording.hpp"

namespace lode::host {
namespace {

using namespace record;

constexpr int shown_differences = 10, timed_repetitions = 21, slowest_shown = 5;

void write_file(const std::string& path, const std::string& text) {
    std::ofstream file(path);
    file << text;
    file.close();
    if (!file) throw Failure(Status::usage, fmt::format("{}: cannot be written", path));
}

void describe(const Recording& recording, const std::string& path, const Library& library) {
    fmt::print("recording   {}: {} calls of {} materials\n", path, recording.calls.size(), recording.materials.size());
    for (const RecordedSession& s : recording.sessions)
        fmt::print("session     process {}: {} {} {} on {}\n", s.process, s.library, s.version, s.instruction_set,
                   s.processor);
    fmt::print("library     {} {} {}\n", library.path(), library.version(), library.instruction_set());
    if (!recording.damage.empty()) fmt::print("damage      {}\n", recording.damage);
}

void print_numbers(const char* label, const std::vector<double>& values, const std::vector<double>* now) {
    fmt::print("  {:<14}", label);
    constexpr std::size_t in_a_row = 6;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (i > 0 && i % in_a_row == 0) fmt::print("\n  {:<14}", "");
        fmt::print(" {:>23}", values[i]);
    }
    fmt::print("\n");
    if (now != nullptr && *now != values) print_numbers("  now", *now, nullptr);
}

template <class Input>
void print_inputs(const RecordedCall& call) {
    for (int i = 0; i < static_cast<int>(Input::count); ++i)
        if (const auto& values = call.inputs[static_cast<std::size_t>(i)]; !values.empty())
            print_numbers(name_of(static_cast<Input>(i)), values, nullptr);
}

void show(const RecordedCall& call, std::size_t number, const Library& library) {
    fmt::print("{}\n", title_of(call, number));
    if (call.is_umat()) {
        const UmatHeader& h = call.umat();
        fmt::print("  NDI {}, NSHR {}, NTENS {}, NSTATV {}, NPROPS {}, LAYER {}, KSPT {}\n", h.ndi, h.nshr, h.ntens,
                   h.nstatv, call.material->constants.size(), h.layer, h.kspt);
    } else {
        const record::VumatHeader& h = call.vumat();
        fmt::print("  nblock {}, ndir {}, nshr {}, nstatev {}, nfieldv {}, stepTime {}, totalTime {}, dt {}\n",
                   h.nblock, h.ndir, h.nshr, h.nstatev, h.nfieldv, h.step_time, h.total_time, h.dt);
    }
    print_numbers("PROPS", call.material->constants, nullptr);
    fmt::print("in\n");
    if (call.is_umat()) print_inputs<UmatInput>(call);
    else print_inputs<VumatInput>(call);
    const RunAgain again = run_again(call, library);
    if (!call.returned()) {
        fmt::print("out: the call ended the analysis when it was recorded; now it {}\n",
                   again.returned ? "returns" : "does so again");
        return;
    }
    if (!again.returned) fmt::print("out (now the library ends the analysis)\n");
    else fmt::print("out\n");
    for (std::size_t o = 0; o < call.outputs.size(); ++o)
        print_numbers(output_name(call, o), call.outputs[o], again.returned ? &again.outputs[o] : nullptr);
}

struct Ranked {
    std::size_t call;
    Difference difference;
};

// Whether all calls gave the recorded outputs.
bool compare_all(const Recording& recording, const Library& library, bool quiet) {
    std::vector<Ranked> different;
    std::size_t ended_then = 0, changed_fate = 0;
    for (std::size_t i = 0; i < recording.calls.size(); ++i) {
        const RecordedCall& call = recording.calls[i];
        const RunAgain again = run_again(call, library);
        if (!call.returned()) ++ended_then;
        if (again.returned != call.returned()) {
            ++changed_fate;
            if (!quiet)
                fmt::print("{}: {}\n", title_of(call, i + 1),
                           again.returned ? "ended the analysis then, returns now" : "ends the analysis now");
            continue;
        }
        if (!call.returned()) continue;
        const Difference difference = compare(call, again);
        if (!difference.argument.empty()) different.push_back({i, difference});
    }
    const std::size_t same = recording.calls.size() - different.size() - changed_fate;
    if (!quiet) {
        fmt::print("result      {} of {} calls give the recorded numbers bit for bit", same, recording.calls.size());
        if (ended_then > 0) fmt::print("; {} ended the analysis when recorded", ended_then);
        fmt::print("\n");
    }
    std::sort(different.begin(), different.end(),
              [](const Ranked& a, const Ranked& b) { return a.difference.relative > b.difference.relative; });
    if (different.size() > shown_differences) different.resize(shown_differences);
    for (const auto& [i, d] : different)
        fmt::print("different   {}: {} was {}, is {} ({:.2g} of the largest entry)\n",
                   title_of(recording.calls[i], i + 1), d.argument, d.recorded, d.now, d.relative);
    return same == recording.calls.size();
}

void print_times(const Recording& recording, const Library& library) {
    struct Timed {
        std::size_t call;
        double nanoseconds;
    };
    std::vector<Timed> times;
    for (std::size_t i = 0; i < recording.calls.size(); ++i) {
        const RunAgain again = run_again(recording.calls[i], library, timed_repetitions);
        if (again.returned) times.push_back({i, again.nanoseconds});
    }
    if (times.empty()) return;
    std::sort(times.begin(), times.end(), [](const Timed& a, const Timed& b) { return a.nanoseconds < b.nanoseconds; });
    const auto quantile = [&](double q) {
        return times[static_cast<std::size_t>(q * static_cast<double>(times.size() - 1))].nanoseconds;
    };
    fmt::print(
        "time        ns a call, medians of {} repetitions: least {:.0f}, median {:.0f}, 99 % {:.0f}, most {:.0f}\n",
        timed_repetitions, quantile(0), quantile(0.5), quantile(0.99), quantile(1));
    for (std::size_t i = 0; i < std::min<std::size_t>(slowest_shown, times.size()); ++i) {
        const Timed& slow = times[times.size() - 1 - i];
        fmt::print("slowest     {:.0f} ns: {}\n", slow.nanoseconds,
                   title_of(recording.calls[slow.call], slow.call + 1));
    }
}

std::vector<const RecordedCall*> chosen_history(const Recording& recording, const RerunOptions& options) {
    PointChoice choice;
    for (const RecordedCall& call : recording.calls)
        if (call.is_umat() && (!options.element || call.umat().noel == *options.element) &&
            (!options.point || call.umat().npt == *options.point)) {
            choice = {call.umat().noel, call.umat().npt};
            break;
        }
    std::vector<const RecordedCall*> history = history_of(recording, choice);
    if (history.empty())
        throw Failure(Status::usage, "no UMAT call of that element and point in the recording returned");
    return history;
}

// All components over time and over strain, from the arguments alone.
void plot_history(const std::vector<const RecordedCall*>& history, const std::string& stem) {
    const UmatHeader& h = history.front()->umat();
    std::string csv = "time";
    for (int i = 1; i <= h.ntens; ++i) csv += fmt::format(",strain{}", i);
    for (int i = 1; i <= h.ntens; ++i) csv += fmt::format(",stress{}", i);
    csv += '\n';
    for (const RecordedCall* call : history) {
        csv += fmt::format("{}", call->input(UmatInput::time)[1] + call->input(UmatInput::dtime)[0]);
        const std::vector<double>&strain = call->input(UmatInput::stran), &change = call->input(UmatInput::dstran);
        for (std::size_t i = 0; i < strain.size(); ++i) csv += fmt::format(",{}", strain[i] + change[i]);
        for (const double s : call->output(UmatOutput::stress)) csv += fmt::format(",{}", s);
        csv += '\n';
    }
    write_file(stem + ".csv", csv);
    const std::string name = std::filesystem::path(stem).filename().string();
    std::string curves;
    for (int i = 1; i <= h.ntens; ++i)
        curves += fmt::format(
            "{}{} using {}:{} with linespoints pointtype 7 pointsize 0.4 linecolor rgb {} title 'component {}'",
            i == 1 ? "plot " : ", ", single_quoted(name + ".csv"), 1 + i, 1 + h.ntens + i,
            single_quoted(curve_colour(static_cast<std::size_t>(i - 1))), i);
    const std::string script = fmt::format(
        "{}set datafile separator ','\nset key autotitle columnhead\nset title {}\n"
        "set xlabel 'STRAN + DSTRAN'\nset ylabel 'STRESS'\n{}",
        figure_style(),
        single_quoted(fmt::format("{}, element {}, point {}", history.front()->material->name, h.noel, h.npt)),
        terminals(name, curves));
    const std::string trouble = draw_script(stem, script);
    if (!trouble.empty()) fmt::print("plot        {}\n", trouble);
    else fmt::print("plot        {0}.png {0}.svg {0}.csv\n", stem);
}

}  // namespace

Status rerun(const RerunOptions& options) {
    const Recording recording = read_recording(options.file, options.salvage);
    const Library library(options.library);
    if (!options.quiet) describe(recording, options.file, library);
    if (options.at) {
        if (*options.at < 1 || static_cast<std::size_t>(*options.at) > recording.calls.size())
            throw Failure(Status::usage, fmt::format("--at {}: the calls are numbered from 1 to {}", *options.at,
                                                     recording.calls.size()));
        const auto index = static_cast<std::size_t>(*options.at);
        show(recording.calls[index - 1], index, library);
        return Status::success;
    }
    if (!options.deck.empty()) {
        write_file(options.deck, deck_of(chosen_history(recording, options)));
        if (!options.quiet) fmt::print("deck        {}\n", options.deck);
    }
    if (!options.plot.empty()) plot_history(chosen_history(recording, options), options.plot);
    if (options.time) print_times(recording, library);
    return compare_all(recording, library, options.quiet) ? Status::success : Status::different;
}

}  // namespace lode::host
