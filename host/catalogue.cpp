#include "catalogue.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "cards.hpp"
#include "lode/material/property_places.hpp"
#include "text.hpp"

namespace lode::host {
namespace {

using Row = std::vector<std::string>;

// Width on the terminal: bytes that go on with a UTF-8 character take no room.
std::size_t width(const std::string& text) {
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string markdown_table(const Row& head, const std::vector<Row>& rows) {
    std::vector<std::size_t> widths;
    for (const auto& cell : head) widths.push_back(std::max<std::size_t>(width(cell), 3));
    for (const Row& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width(row[i]));
    std::string text;
    const auto line = [&](const Row& row) {
        for (std::size_t i = 0; i < row.size(); ++i)
            text.append("| ").append(row[i]).append(widths[i] - width(row[i]) + 1, ' ');
        text += "|\n";
    };
    line(head);
    for (const std::size_t w : widths) text.append("|").append(w + 2, '-');
    text += "|\n";
    for (const Row& row : rows) line(row);
    return text;
}

std::string range_of(const lode_parameter& p) {
    const bool lower = std::isfinite(p.lower), upper = std::isfinite(p.upper);
    const bool open_below = (p.flags & LODE_LOWER_OPEN) != 0, open_above = (p.flags & LODE_UPPER_OPEN) != 0;
    const bool whole = (p.flags & LODE_INTEGER) != 0;
    std::string range = "any";
    if (lower && upper && whole) return fmt::format("{}..{}", p.lower, p.upper);
    if (lower && upper)
        range = fmt::format("{} {} x {} {}", p.lower, open_below ? "<" : "<=", open_above ? "<" : "<=", p.upper);
    else if (lower) range = fmt::format("{} {}", open_below ? ">" : ">=", p.lower);
    else if (upper) range = fmt::format("{} {}", open_above ? "<" : "<=", p.upper);
    if (whole) range += ", whole";
    return range;
}

std::string default_of(const lode_parameter& p) {
    if ((p.flags & LODE_OPTIONAL) == 0) return "required";
    return fmt::format("{}{}", p.default_value, (p.flags & LODE_ZERO_IS_DEFAULT) != 0 ? " (or 0)" : "");
}

// Repeated entries move those behind them on.
bool has_repeated_entries(const lode_model& model) {
    return std::any_of(model.parameters, model.parameters + model.parameter_count,
                       [](const lode_parameter& p) { return repeated_by(p) != 0; });
}
bool has_fixed_place(const lode_model& model, int index) {
    return std::none_of(model.parameters, model.parameters + index + 1,
                        [](const lode_parameter& p) { return repeated_by(p) != 0; });
}
std::string place_of(const lode_model& model, int index) {
    if (const int count = repeated_by(model.parameters[index]); count != 0)
        return fmt::format("x {}", model.parameters[count - 1].symbol);
    return has_fixed_place(model, index) ? fmt::format("{}", index + 1) : "...";
}
std::string entry_name(const lode_model& model, int number) {
    return has_fixed_place(model, number - 1) ? fmt::format("PROPS({})", number) : model.parameters[number - 1].symbol;
}

std::string kinds_text(const lode_model& model) {
    std::string text;
    for (const Kind kind : kinds_of(model.kinds)) {
        const auto [ndi, nshr] = layout_of(kind);
        text += fmt::format("{}{} ({},{})", text.empty() ? "" : ", ",
                            kind == Kind::plane_strain ? "plane_strain and axisymmetric" : name_of(kind), ndi, nshr);
    }
    return text;
}

std::string short_kinds(const lode_model& model) {
    std::string text;
    for (const Kind kind : kinds_of(model.kinds))
        text += fmt::format("{}{}", text.empty() ? "" : " ",
                            kind == Kind::plane_strain ? "plane_strain/axisymmetric" : name_of(kind));
    return text;
}

std::string fenced(const std::string& language, const std::string& text) {
    return "```" + language + "\n" + text + "```\n";
}

std::string traits_text(const lode_model& model) {
    std::string text;
    const auto add = [&](unsigned bit, const char* sentence) {
        if ((model.traits & bit) != 0) text += fmt::format("- {}\n", sentence);
    };
    add(LODE_FINITE_STRAIN, (model.traits & LODE_VISCOUS) != 0
                                ? "Finite strain: the pressure follows from DFGRD1. Needs NLGEOM."
                                : "Finite strain: the stress follows from DFGRD1; DSTRAN is not read. Needs NLGEOM.");
    add(LODE_UNSYMMETRIC, "DDSDDE is not symmetric: ask the host for its unsymmetric solver (UNSYMM).");
    add(LODE_ROTATES_STATE, "Tensor-valued state is rotated with DROT.");
    add(LODE_USES_CELENT, "Softening is regularised by the element length CELENT.");
    add(LODE_ELASTIC, "No history: energy is recovered on closed paths.");
    add(LODE_HISTORY_STRESS, "STRESS on entry is not read: an initial stress of the host is lost.");
    add(LODE_EQUATION_OF_STATE,
        "Temperatures are absolute; SSE is the internal energy, which heat changes as well as work.");
    add(LODE_VISCOUS, "Viscous stress, proportional to DSTRAN/DTIME, vanishes with the strain increment.");
    add(LODE_ENERGY_ESTIMATE, "SSE and SCD are estimates: they balance the stress work at small strain only.");
    add(LODE_ITERATES,
        "Some kinds or constants need iterations inside the update; `lode atlas` shows how many and where.");
    add(LODE_OPEN_ENERGY, "The work of phase changes is not tracked: SSE + SPD + SCD is not the stress work.");
    return text;
}

}  // namespace

std::string model_table(const Library& library) {
    std::vector<Row> rows;
    for (const lode_model* model : library.models())
        rows.push_back({model->keyword, model->title, short_kinds(*model),
                        fmt::format("{}/{}{}", model->required_count, model->parameter_count,
                                    has_repeated_entries(*model) ? "+" : ""),
                        fmt::format("{}", model->state_count)});
    return markdown_table({"Keyword", "Model", "Kinds", "PROPS required/all", "STATEV"}, rows);
}

std::string reference_page(const lode_model& model, const Library& library) {
    std::string page = fmt::format("# {}: {}\n\n{}\n\n", model.keyword, model.title, model.purpose);
    page += fmt::format("Family `{}`. Kinds (NDI,NSHR): {}.\nSource: {}.\n\n", model.family, kinds_text(model),
                        model.source);
    if (const auto traits = traits_text(model); !traits.empty()) page += traits + "\n";

    page += fmt::format("## PROPS\n\n{} required, {} in all.\n\n", model.required_count, model.parameter_count);
    std::vector<Row> rows;
    std::string notes;  // below the table, which they would make too wide
    for (int i = 0; i < model.parameter_count; ++i) {
        const lode_parameter& p = model.parameters[i];
        rows.push_back({place_of(model, i), p.symbol, p.name, p.unit, range_of(p), default_of(p)});
        if (p.note != nullptr && *p.note != '\0') notes += fmt::format("- {}: {}\n", p.symbol, p.note);
    }
    page += markdown_table({"#", "Symbol", "Name", "Unit", "Range", "Default"}, rows);
    if (!notes.empty()) page += "\n" + notes;

    if (has_repeated_entries(model))
        page += "\nAn entry `x N` stands there N times; neighbours with the same N alternate. What follows moves on.\n";

    page += "\n## STATEV\n\n";
    if (model.state_count == 0) {
        page += "None.\n";
    } else {
        rows.clear();
        for (int i = 0; i < model.state_count; ++i)
            rows.push_back({fmt::format("{}", i + 1), model.state[i].name, model.state[i].meaning,
                            fmt::format("{}", model.state[i].initial)});
        page += markdown_table({"#", "Name", "Meaning", "Initial"}, rows);
    }

    if (model.algorithm_count > 0) {
        page += "\n## Algorithms\n\n";
        rows.clear();
        for (int i = 0; i < model.algorithm_count; ++i) {
            const lode_algorithm& a = model.algorithms[i];
            rows.push_back(
                {a.name,
                 a.parameter > 0 ? fmt::format("{} = {}", entry_name(model, a.parameter), a.value) : "the only one",
                 std::isfinite(a.order) ? fmt::format("{}", a.order) : "exact"});
        }
        page += markdown_table({"Algorithm", "Selected by", "Order"}, rows);
    }

    if (model.limits != nullptr && *model.limits != '\0') page += "\n## Limits\n\n" + trimmed(model.limits) + "\n";

    for (int i = 0; i < model.sample_count; ++i) {
        const lode_sample& sample = model.samples[i];
        page += fmt::format("\n## Cards: {} ({})\n\nAbaqus\n\n", sample.label, sample.meaning);
        page += fenced("", abaqus_cards(model, sample, library));
        if (const auto cards = calculix_cards(model, sample, library); !cards.empty())
            page += "\nCalculiX\n\n" + fenced("", cards);
        page += "\n`lode replay`\n\n" + fenced("toml", replay_deck(model, sample));
    }
    return page;
}

Status list_models(const CatalogueOptions& options) {
    const Library library(options.library);
    if (!library.has_catalogue())
        throw Refused(library.path() + " does not describe its models (it has no lode_model_count)");
    std::vector<const lode_model*> chosen = library.models();
    if (!options.keyword.empty()) {
        const lode_model* const model = library.model_of(options.keyword);
        if (model == nullptr) {
            std::vector<std::string> keywords;
            for (const lode_model* known : chosen) keywords.emplace_back(known->keyword);
            throw Failure(Status::usage, fmt::format("there is no model {}{}; `lode models` lists all", options.keyword,
                                                     did_you_mean(upper(options.keyword), keywords)));
        }
        chosen = {model};
    }
    if (options.markdown_directory.empty()) {
        const std::string text =
            options.keyword.empty() ? model_table(library) : reference_page(*chosen.front(), library);
        std::fputs(text.c_str(), stdout);
        return Status::success;
    }
    std::error_code failed;
    std::filesystem::create_directories(options.markdown_directory, failed);
    for (const lode_model* model : chosen) {
        const std::string path =
            (std::filesystem::path(options.markdown_directory) / (std::string(model->keyword) + ".md")).string();
        const std::string page = reference_page(*model, library);
        std::FILE* const file = std::fopen(path.c_str(), "w");
        if (file == nullptr) throw Failure(Status::usage, "cannot write " + path);
        std::fwrite(page.data(), 1, page.size(), file);
        std::fclose(file);
    }
    return Status::success;
}

}  // namespace lode::host
