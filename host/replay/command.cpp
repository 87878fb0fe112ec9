#include "command.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "../guard.hpp"
#include "../verify/verification.hpp"
#include "columns.hpp"
#include "deck.hpp"
#include "driver.hpp"
#include "output.hpp"
#include "progress.hpp"
#include "summary.hpp"

namespace lode::host {
namespace {

std::string output_stem(const ReplayOptions& options, const Scenario& scenario) {
    const std::filesystem::path directory = options.output_directory;
    std::error_code failed;
    std::filesystem::create_directories(directory, failed);
    if (!std::filesystem::is_directory(directory, failed))
        throw Failure(Status::usage, "cannot make the output directory " + options.output_directory);
    return (directory / scenario.stem).lexically_normal().string();
}

void write_text(const std::string& path, const std::string& text) {
    std::FILE* const file = std::fopen(path.c_str(), "w");
    if (file == nullptr) throw Failure(Status::usage, "cannot write " + path);
    std::fwrite(text.data(), 1, text.size(), file);
    std::fclose(file);
}

// Lists what to write: the columns of the CSV file, those of the plots included.
struct Plan {
    std::vector<Column> columns;
    std::vector<Figure> figures;
};

Plan plan_output(const Scenario& scenario, const Library& library, const std::string& stem) {
    const ColumnSet set(scenario, library);
    Plan plan;
    for (const Located& request : scenario.output.columns) ColumnSet::place(plan.columns, set.find(request));
    if (plan.columns.empty()) plan.columns = set.defaults();
    plan.figures = make_figures(scenario, set, stem, plan.columns);
    return plan;
}

}  // namespace

Status replay(const ReplayOptions& options) {
    Scenario scenario = read_deck(options.deck);
    if (options.entry) scenario.analysis.entry = *options.entry;
    const Library library(options.library.empty() ? scenario.material.library : options.library);
    resolve(scenario, library);
    if (options.verify) check_verifiable(scenario, options.deck);
    const std::string stem = output_stem(options, scenario);
    set_job(scenario.stem, std::filesystem::absolute(options.output_directory).lexically_normal().string());
    const Plan plan = plan_output(scenario, library, stem);

    CsvWriter csv(stem + ".csv", plan.columns);
    Summary summary(scenario);
    Outcome outcome;
    {
        Progress progress(scenario, options.quiet);
        long long count = 0;
        outcome = drive(scenario, library, [&](const Record& record) {
            summary.observe(record);
            progress.observe(record);
            if (count++ % scenario.output.every == 0) csv.write(record);
        });
    }
    csv.close();

    std::string text = summary.text(outcome, library);
    bool verified = true;
    if (options.verify && outcome.status == Status::success) {
        const Verification verification = verify(scenario, library, options.entry);
        text += "\n" + verification.text();
        verified = verification.passed();
    }
    write_text(stem + ".txt", text);
    if (!options.quiet) std::fputs(text.c_str(), stdout);
    std::vector<std::string> made{csv.path(), stem + ".txt"};
    for (const Figure& figure : plan.figures) {
        const std::string failure = draw(figure, csv.path());
        if (!failure.empty()) fmt::print(stderr, "lode: {}\n", failure);
        else
            for (const char* extension : {".png", ".svg", ".gp"}) made.push_back(figure.stem + extension);
    }
    if (!options.quiet) {
        std::string list;
        for (const auto& file : made) list.append(list.empty() ? "" : " ").append(file);
        fmt::print("files       {}\n", list);
    }
    for (const auto& remark : outcome.remarks) fmt::print(stderr, "lode: {}\n", remark);
    if (outcome.status != Status::success) fmt::print(stderr, "lode: {}\n", outcome.message);
    if (!verified) {
        fmt::print(stderr, "lode: {}: the material does not give the closed forms; see {}.txt\n", options.deck, stem);
        return Status::not_verified;
    }
    return outcome.status;
}

}  // namespace lode::host
