#include "deck_writer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>

#include "../replay/analysis.hpp"
#include "../status.hpp"

namespace lode::host {
namespace {

using namespace record;

Kind kind_of(const UmatHeader& h) {
    for (const KindName& candidate : kind_names) {
        const Layout layout(candidate.kind);
        if (layout.ndi() == h.ndi && layout.nshr() == h.nshr) return candidate.kind;
    }
    throw Failure(Status::bad_deck, fmt::format("no deck for a kind with NDI = {}, NSHR = {}", h.ndi, h.nshr));
}

bool is_identity(const std::vector<double>& f) {
    for (std::size_t i = 0; i < f.size(); ++i)
        if (f[i] != (i % 4 == 0 ? 1.0 : 0.0)) return false;
    return true;
}

std::string list(const std::vector<double>& values) { return fmt::format("[{}]", fmt::join(values, ", ")); }

std::string by_component(const Layout& layout, const std::vector<double>& values) {
    std::string text = "{";
    for (int i = 0; i < layout.size(); ++i)
        text += fmt::format("{} {} = {}", i == 0 ? "" : ",", layout.name(i), values[static_cast<std::size_t>(i)]);
    return text + " }";
}

std::string rows(const std::vector<double>& f) {
    const auto row = [&](std::size_t i) { return fmt::format("[{}, {}, {}]", f[i], f[i + 3], f[i + 6]); };
    return fmt::format("[{}, {}, {}]", row(0), row(1), row(2));
}

double end_time(const RecordedCall& call) { return call.input(UmatInput::time)[1] + call.input(UmatInput::dtime)[0]; }

}  // namespace

std::vector<const RecordedCall*> history_of(const Recording& recording, const PointChoice& choice) {
    std::vector<const RecordedCall*> calls;
    for (const RecordedCall& call : recording.calls)
        if (call.is_umat() && call.returned() && call.umat().noel == choice.element && call.umat().npt == choice.point)
            calls.push_back(&call);
    // A later call that begins at or before the start of an earlier one repeats it.
    std::vector<const RecordedCall*> history;
    for (const RecordedCall* call : calls) {
        const double start = call->input(UmatInput::time)[1];
        while (!history.empty() && start <= history.back()->input(UmatInput::time)[1]) history.pop_back();
        history.push_back(call);
    }
    return history;
}

std::string deck_of(const std::vector<const RecordedCall*>& history) {
    const RecordedCall& first = *history.front();
    const UmatHeader& h = first.umat();
    const Layout layout(kind_of(h));
    const bool finite = std::any_of(history.begin(), history.end(), [](const RecordedCall* call) {
        return !is_identity(call->input(UmatInput::dfgrd1));
    });
    const double start_temperature = first.input(UmatInput::temp)[0];
    const std::vector<double>& start_fields = first.input(UmatInput::predef);

    std::string deck =
        fmt::format("title = \"{}, element {}, point {}\"\n\n[material]\nname = \"{}\"\nconstants = {}\n",
                    first.material->name, h.noel, h.npt, first.material->name, list(first.material->constants));
    deck += fmt::format("state_variables = {}\n", h.nstatv);
    if (h.nstatv > 0) deck += fmt::format("initial_state = {}\n", list(first.input(UmatInput::statev)));
    deck += fmt::format("initial_stress = {}\n", by_component(layout, first.input(UmatInput::stress)));
    deck += fmt::format("\n[analysis]\nkind = \"{}\"\nelement_length = {}\ntemperature = {}\n", name_of(layout.kind()),
                        first.input(UmatInput::celent)[0], start_temperature);
    if (!start_fields.empty()) deck += fmt::format("field = {}\n", list(start_fields));
    deck += fmt::format("large_rotation = {}\nunnamed = \"{}\"\n", finite, layout.cohesive() ? "separation" : "strain");

    // Strains of a deck count from its beginning.
    std::vector<double> strain(static_cast<std::size_t>(layout.size()), 0.0);
    for (const RecordedCall* call : history) {
        const std::vector<double>& increment = call->input(UmatInput::dstran);
        for (std::size_t i = 0; i < strain.size(); ++i) strain[i] += increment[i];
        const double duration = end_time(*call) - call->input(UmatInput::time)[1];
        deck += fmt::format("\n[[step]] # step {}, increment {}\n", call->umat().kstep, call->umat().kinc);
        if (duration > 0) deck += fmt::format("time = {}\n", duration);
        deck += "increments = 1\n";
        if (finite && !layout.cohesive())
            deck += fmt::format("deformation_gradient = {}\n", rows(call->input(UmatInput::dfgrd1)));
        else
            deck += fmt::format("{} = {}\n", layout.cohesive() ? "separation" : "strain", by_component(layout, strain));
        const double temperature = call->input(UmatInput::temp)[0] + call->input(UmatInput::dtemp)[0];
        if (temperature != start_temperature) deck += fmt::format("temperature = {}\n", temperature);
        const std::vector<double>& change = call->input(UmatInput::dpred);
        if (!change.empty()) {
            std::vector<double> field = call->input(UmatInput::predef);
            for (std::size_t i = 0; i < field.size(); ++i) field[i] += change[i];
            deck += fmt::format("field = {}\n", list(field));
        }
    }
    return deck;
}

}  // namespace lode::host
