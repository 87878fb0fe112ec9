#include "command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <set>

#include "../cards.hpp"
#include "../replay/abaqus_input.hpp"
#include "../rerun/recording.hpp"
#include "../study/libraries.hpp"
#include "../text.hpp"
#include "host_findings.hpp"
#include "report.hpp"
#include "run.hpp"

namespace lode::host {
namespace {

constexpr double room_temperature = 300;  // absolute, for equations of state

Kind kind_named(const std::string& name) {
    std::vector<std::string_view> names;
    for (const KindName& entry : kind_names) {
        if (entry.name == name) return entry.kind;
        names.push_back(entry.name);
    }
    throw Failure(Status::usage, fmt::format("there is no kind \"{}\"{}; there are {}", name, did_you_mean(name, names),
                                             joined(names)));
}

void require_known_checks(const std::vector<std::string>& names) {
    std::vector<std::string> known;
    for (const Check& check : all_checks()) known.emplace_back(check.name);
    for (const std::string& name : names)
        if (std::find(known.begin(), known.end(), name) == known.end())
            throw Failure(Status::usage, fmt::format("there is no check \"{}\"{}; `lode check --list` shows all", name,
                                                     did_you_mean(name, known)));
}

// What all subjects of a command have in common.
Subject subject_from(const CheckOptions& options, const Library& library) {
    Subject subject;
    subject.library = &library;
    subject.element_length = options.element_length;
    subject.temperature = options.temperature;
    subject.scale = options.scale;
    subject.elastic = options.elastic;
    subject.unsymmetric = options.unsymmetric;
    subject.initial_state = options.initial_state;
    return subject;
}

void complete(Subject& subject, const std::optional<int>& state_variables) {
    subject.model = subject.library->model_of(subject.name);
    const Layout layout(subject.kind);
    if (subject.has_trait(LODE_EQUATION_OF_STATE) && subject.temperature == 0) subject.temperature = room_temperature;
    subject.state_variables =
        state_variables ? *state_variables
                        : subject.library->required_state(subject.name, subject.constants, layout.ndi(), layout.nshr())
                              .value_or(static_cast<int>(subject.initial_state.size()));
}

std::vector<Subject> sample_subjects(const CheckOptions& options, const Library& library) {
    std::vector<Subject> subjects;
    const auto samples = options.all ? all_samples(library) : samples_named(library, options.model);
    for (const auto& [model, sample] : samples) {
        std::vector<Kind> kinds = kinds_of(model->kinds & sample->kinds);
        if (!options.kinds.empty()) {
            std::vector<Kind> wanted;
            for (const std::string& name : options.kinds)
                if (std::find(kinds.begin(), kinds.end(), kind_named(name)) != kinds.end())
                    wanted.push_back(kind_named(name));
            kinds = wanted;
        }
        for (const Kind kind : kinds) {
            Subject subject = subject_from(options, library);
            subject.name = material_name(*model, *sample);
            subject.constants.assign(sample->constants, sample->constants + sample->constant_count);
            subject.kind = kind;
            if (subject.scale <= 0) subject.scale = sample->strain_scale;
            complete(subject, options.state_variables);
            subjects.push_back(std::move(subject));
        }
    }
    if (subjects.empty()) throw Failure(Status::usage, "no sample of that model serves the kind");
    return subjects;
}

std::vector<Subject> given_subjects(const CheckOptions& options, const Library& library) {
    Subject common = subject_from(options, library);
    common.constants = options.constants;
    common.name = upper(options.name.empty() ? "MATERIAL" : options.name);
    std::optional<int> state_variables = options.state_variables;
    if (!options.card.empty()) {
        const std::vector<MaterialCards> materials = read_material_cards(options.card);
        std::vector<std::string> names;
        const MaterialCards* chosen = nullptr;
        for (const MaterialCards& m : materials) {
            names.push_back(m.name);
            if (options.name.empty() ? materials.size() == 1 : m.name == upper(options.name)) chosen = &m;
        }
        if (chosen == nullptr)
            throw Failure(Status::usage, fmt::format("--name chooses one of the user materials of {}: {}", options.card,
                                                     joined(names)));
        common.name = chosen->name;
        common.constants = chosen->constants;
        common.unsymmetric = common.unsymmetric || chosen->unsymmetric;
        if (!state_variables) state_variables = chosen->state_variables;
    }
    std::vector<std::string> kinds = options.kinds;
    if (kinds.empty()) kinds.emplace_back("3d");
    std::vector<Subject> subjects;
    for (const std::string& kind : kinds) {
        Subject subject = common;
        subject.kind = kind_named(kind);
        complete(subject, state_variables);
        subjects.push_back(std::move(subject));
    }
    return subjects;
}

void print_list() {
    for (const Check& check : all_checks()) fmt::print("{:<22} {}\n", check.name, check.what);
}

Status finished(const std::vector<SubjectReport>& reports, const std::string& json, const std::string& html,
                bool quiet) {
    if (!json.empty()) write_json(reports, json);
    if (!html.empty()) write_html(reports, html);
    if (!quiet) fmt::print("{}\n", summary(reports));
    return count(reports, Verdict::fail) > 0 ? Status::failed_check : Status::success;
}

SubjectReport run_and_print(const Subject& subject, const RunSettings& settings, bool quiet) {
    if (!quiet) fmt::print("{}, {}, {}\n", subject.name, name_of(subject.kind), subject.library->path());
    bool named = !quiet;
    SubjectReport report = run_checks(subject, settings, [&](const CheckResult& result) {
        if (quiet && result.verdict() != Verdict::fail) return;
        if (!named) fmt::print("{}, {}\n", subject.name, name_of(subject.kind));
        named = true;
        fmt::print("{}", text_line(result));
        std::fflush(stdout);
    });
    return report;
}

}  // namespace

Status check(const CheckOptions& options) {
    require_known_checks(options.only);
    if (options.list) {
        print_list();
        return Status::success;
    }
    if (!options.host.empty()) {
        const SubjectReport report = check_host(read_recording(options.host, options.salvage), options.host);
        if (!options.quiet) fmt::print("{}, {}\n", report.material, report.library);
        for (const CheckResult& result : report.results)
            if (!options.quiet || result.verdict() == Verdict::fail) fmt::print("{}", text_line(result));
        return finished({report}, options.json, options.html, options.quiet);
    }
    const bool samples = options.all || !options.model.empty();
    if (samples && (!options.constants.empty() || !options.card.empty()))
        throw Failure(Status::usage, "--model takes the constants of the sample: leave --props and --card out");
    if (!samples && options.constants.empty() && options.card.empty() && options.name.empty())
        throw Failure(Status::usage, "what is to be checked? --props, --card, --model or --host says it");
    const Library library(options.library);
    if (library.umat() == nullptr && library.vumat() == nullptr)
        throw NotLoaded(library.path() + " has neither umat_ nor vumat_");
    RunSettings settings;
    settings.seconds = options.seconds;
    settings.only = options.only;
    settings.entry = options.entry;
    std::vector<SubjectReport> reports;
    for (const Subject& subject : samples ? sample_subjects(options, library) : given_subjects(options, library))
        reports.push_back(run_and_print(subject, settings, options.quiet));
    return finished(reports, options.json, options.html, options.quiet);
}

Status check_recorded(const RecordedCheckOptions& options) {
    const Recording recording = read_recording(options.recording, options.salvage);
    if (recording.calls.empty()) throw Failure(Status::usage, options.recording + " has no calls");
    const std::size_t number = options.at ? static_cast<std::size_t>(std::max(*options.at, 0)) : recording.calls.size();
    if (number < 1 || number > recording.calls.size())
        throw Failure(Status::usage,
                      fmt::format("--at {}: the calls are numbered from 1 to {}", *options.at, recording.calls.size()));
    const RecordedCall& call = recording.calls[number - 1];
    const Library library(options.library);
    Subject subject;
    subject.library = &library;
    subject.recorded = &call;
    subject.name = call.material->name;
    subject.constants = call.material->constants;
    subject.model = library.model_of(subject.name);
    int ndi = 0, nshr = 0;
    double step = 0, total = 0;
    const auto largest = [](const Numbers& values) {
        double size = 0;
        for (const double x : values) size = std::max(size, std::abs(x));
        return size;
    };
    if (call.is_umat()) {
        ndi = call.umat().ndi;
        nshr = call.umat().nshr;
        subject.state_variables = call.umat().nstatv;
        step = largest(call.input(record::UmatInput::dstran));
        total = largest(call.input(record::UmatInput::stran));
        if (!call.input(record::UmatInput::celent).empty())
            subject.element_length = call.input(record::UmatInput::celent)[0];
    } else {
        if (call.vumat().real_size != static_cast<int>(sizeof(double)))
            throw Failure(Status::usage, "calls of a single-precision host are not checked");
        ndi = call.vumat().ndir;
        nshr = call.vumat().nshr;
        subject.state_variables = call.vumat().nstatev;
        step = largest(call.input(record::VumatInput::strain_inc));
    }
    const bool thin = !call.is_umat() && upper(subject.name).find("-PS") != std::string::npos;
    bool known = false;
    for (const KindName& entry : kind_names) {
        const Layout layout(entry.kind);
        const int direct = thin && layout.kind() == Kind::plane_stress ? 3 : layout.ndi();
        if (known || direct != ndi || layout.nshr() != nshr || (thin && entry.kind != Kind::plane_stress)) continue;
        subject.kind = entry.kind;
        known = true;
    }
    if (!known) throw Failure(Status::usage, fmt::format("there is no kind with NDI = {} and NSHR = {}", ndi, nshr));
    // Steps and tolerances of the checks are relative to it.
    constexpr double least = 1e-6, part_of_total = 0.1;
    subject.scale = std::max({step, part_of_total * total, least * (subject.cohesive() ? subject.element_length : 1)});
    if (!options.quiet) fmt::print("{}\n", title_of(call, number));
    RunSettings settings;
    settings.seconds = options.seconds;
    return finished({run_and_print(subject, settings, options.quiet)}, options.json, options.html, options.quiet);
}

}  // namespace lode::host
