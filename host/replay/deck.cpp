#include "deck.hpp"

#include <algorithm>
#include <filesystem>

#include "../library.hpp"
#include "../status.hpp"
#include "../text.hpp"
#include "abaqus_input.hpp"
#include "deck_steps.hpp"
#include "toml_reader.hpp"

namespace lode::host {
namespace {

constexpr std::array<std::string_view, 2> entry_names{"umat", "vumat"};
constexpr std::array<std::string_view, 2> precision_names{"double", "single"};
constexpr std::array<std::string_view, 2> solid_controls{"strain", "stress"};
constexpr std::array<std::string_view, 2> cohesive_controls{"separation", "traction"};

std::string beside_deck(const std::string& deck, const std::string& file) {
    const std::filesystem::path path(file);
    if (path.is_absolute()) return file;
    return (std::filesystem::path(deck).parent_path() / path).string();
}

void take_cards(TableReader& reader, const std::string& deck, const std::string& input_file, MaterialSpec& material) {
    const std::string path = beside_deck(deck, input_file);
    const std::vector<MaterialCards> all = read_material_cards(path);
    std::vector<std::string> names;
    for (const auto& cards : all) names.push_back(cards.name);
    const MaterialCards* chosen = nullptr;
    for (const auto& cards : all)
        if (material.name.empty() ? all.size() == 1 : cards.name == material.name) chosen = &cards;
    if (chosen == nullptr && material.name.empty())
        reader.refuse("name", fmt::format("{} holds {} materials with *USER MATERIAL; name one of {}", path, all.size(),
                                          joined(names)));
    if (chosen == nullptr)
        reader.refuse("name", fmt::format("{} has no *MATERIAL, NAME={} with a *USER MATERIAL card; it has {}{}", path,
                                          material.name, joined(names), did_you_mean(material.name, names)));
    material.name = chosen->name;
    material.constants = chosen->constants;
    material.state_variables = chosen->state_variables;
    material.density = chosen->density.value_or(1);
    material.expansion = chosen->expansion;
}

void read_initial_state(TableReader& reader, MaterialSpec& material) {
    if (!reader.has("initial_state")) return;
    // A list from the first entry on, or a table by index or name.
    if (!reader.is_table("initial_state")) {
        material.initial_state = reader.numbers("initial_state").value_or(std::vector<double>{});
        if (material.state_variables &&
            material.initial_state.size() > static_cast<std::size_t>(*material.state_variables))
            reader.refuse("initial_state", fmt::format("{} values for {} state variables",
                                                       material.initial_state.size(), *material.state_variables));
        return;
    }
    const auto table = *reader.table("initial_state");
    for (const auto& [name, value] : table.named_numbers()) {
        if (name.empty() || !std::all_of(name.begin(), name.end(), [](char c) { return c >= '0' && c <= '9'; })) {
            material.initial_named_state.push_back({{name, table.location(name)}, value});
            continue;
        }
        const auto index = name.size() <= 6 ? static_cast<std::size_t>(std::stoi(name)) : 0;
        if (index < 1 || (material.state_variables && index > static_cast<std::size_t>(*material.state_variables)))
            table.refuse(name, "indices of state variables count from 1 to state_variables");
        if (material.initial_state.size() < index) material.initial_state.resize(index, 0.0);
        material.initial_state[index - 1] = value;
    }
}

void read_initial_stress(TableReader& reader, const Layout& layout, MaterialSpec& material) {
    if (!reader.has("initial_stress")) return;
    const auto table = *reader.table("initial_stress");
    Components stress = Components::Zero(layout.size());
    for (const auto& [name, value] : table.named_numbers()) {
        const auto component = layout.find(name);
        if (!component)
            table.refuse(name, fmt::format("{} has no such component; legal are {}", name_of(layout.kind()),
                                           joined(layout.names())));
        stress[*component] = value;
    }
    material.initial_stress = stress;
}

void read_material(TableReader& reader, const std::string& deck, const Layout& layout, MaterialSpec& material) {
    material.name = upper(reader.text("name").value_or(""));
    const auto constants = reader.raw_numbers("constants");
    const auto input_file = reader.text("input_file");
    if (constants && input_file) reader.refuse("input_file", "give either constants or input_file");
    if (input_file) take_cards(reader, deck, *input_file, material);
    else if (!constants) reader.refuse("", "constants are missing: constants = [...], or input_file = \"job.inp\"");
    if (constants) material.constants = *constants;
    if (material.name.empty())
        reader.refuse("name", "the material's name is missing, e.g. name = \"ISO_PLASTIC-STEEL\"");
    if (material.name.size() > material_name_length) reader.refuse("name", "a material name has at most 80 characters");

    if (const auto count = reader.integer("state_variables", 0, 100000)) material.state_variables = count;
    read_initial_state(reader, material);
    read_initial_stress(reader, layout, material);
    if (const auto density = reader.number("density", positive)) material.density = *density;
    if (const auto expansion = reader.numbers("expansion")) {
        if (expansion->size() != 1 && expansion->size() != 3)
            reader.refuse("expansion", "expected one coefficient, or three for the directions 11, 22, 33");
        material.expansion = *expansion;
    }
    if (const auto library = reader.text("library")) material.library = beside_deck(deck, *library);
    reader.finish();
}

void read_analysis(TableReader& reader, AnalysisSpec& analysis) {
    std::vector<std::string_view> kinds;
    for (const auto& entry : kind_names) kinds.push_back(entry.name);
    if (const auto kind = reader.choice("kind", kinds)) analysis.kind = kind_names[*kind].kind;
    if (const auto entry = reader.choice("interface", entry_names))
        analysis.entry = *entry == 0 ? Entry::umat : Entry::vumat;
    if (const auto precision = reader.choice("precision", precision_names))
        analysis.precision = *precision == 0 ? Precision::double_ : Precision::single;
    analysis.large_rotation = reader.flag("large_rotation");
    if (analysis.large_rotation) analysis.large_rotation_location = reader.location("large_rotation");
    analysis.element_length = reader.number("element_length", positive).value_or(analysis.element_length);
    analysis.block = reader.integer("block", 1, 1'000'000).value_or(analysis.block);
    analysis.temperature = reader.number("temperature").value_or(0);
    analysis.fields = reader.numbers("field").value_or(std::vector<double>{});
    const bool cohesive = is_cohesive(analysis.kind);
    analysis.unnamed = cohesive ? Control::strain : Control::stress;
    if (const auto control = reader.choice("unnamed", cohesive ? cohesive_controls : solid_controls))
        analysis.unnamed = *control == 0 ? Control::strain : Control::stress;
    analysis.tolerance =
        reader.number("tolerance", {0, 0.1, true, "a number above 0 and not above 0.1"}).value_or(analysis.tolerance);
    analysis.maximum_iterations = reader.integer("maximum_iterations", 1, 10000).value_or(analysis.maximum_iterations);
    reader.finish();
}

void read_plots(TableReader& reader, OutputSpec& output) {
    if (reader.is_flag("plot")) {
        output.plot = *reader.flag("plot");
        return;
    }
    for (TableReader& entry : reader.tables("plot")) {
        Plot plot;
        const auto x = entry.words("x");
        if (x.size() != 1) entry.refuse("x", "expected one column, e.g. x = \"strain11\"");
        plot.x = x.front();
        plot.y = entry.words("y");
        if (plot.y.empty()) entry.refuse("y", "expected one or several columns, e.g. y = \"stress11\"");
        plot.name = entry.text("name").value_or("");
        plot.title = entry.text("title").value_or("");
        plot.x_label = entry.text("x_label").value_or("");
        plot.y_label = entry.text("y_label").value_or("");
        if (plot.name.find('/') != std::string::npos)
            entry.refuse("name", "a file name without directories is expected");
        entry.finish();
        output.plots.push_back(std::move(plot));
    }
}

void read_output(TableReader& reader, OutputSpec& output) {
    output.columns = reader.words("columns");
    read_plots(reader, output);
    output.every = reader.integer("every", 1).value_or(1);
    if (auto units = reader.table("units")) {
        output.stress_unit = units->text("stress").value_or("");
        output.length_unit = units->text("length").value_or("");
        output.time_unit = units->text("time").value_or("");
        units->finish();
    }
    reader.finish();
}

MaterialSpec read_alternative(TableReader& reader) {
    MaterialSpec material;
    material.name = upper(reader.text("name").value_or(""));
    if (material.name.empty()) reader.refuse("name", "the material's name is missing");
    const auto constants = reader.raw_numbers("constants");
    if (!constants) reader.refuse("", "constants are missing: constants = [...]");
    material.constants = *constants;
    reader.finish();
    return material;
}

}  // namespace

Scenario read_deck(const std::string& path) {
    const toml::table root = parse_toml_file(path);
    TableReader reader(root, path, "");
    Scenario scenario;
    scenario.stem = std::filesystem::path(path).stem().string();
    scenario.title = reader.text("title").value_or("");
    if (auto analysis = reader.table("analysis")) read_analysis(*analysis, scenario.analysis);
    auto material = reader.table("material");
    if (!material) reader.refuse("", "the table [material] is missing");
    const Layout layout(scenario.analysis.kind);
    read_material(*material, path, layout, scenario.material);
    scenario.steps = read_steps(reader, layout, scenario.analysis);
    if (auto output = reader.table("output")) read_output(*output, scenario.output);
    if (reader.has("alternative"))
        for (TableReader& entry : reader.tables("alternative"))
            scenario.alternatives.push_back(read_alternative(entry));
    reader.finish();
    return scenario;
}

bool is_deck(const std::string& argument) {
    std::error_code ignored;
    return argument.ends_with(".toml") || std::filesystem::is_regular_file(argument, ignored);
}

std::vector<Scenario> decks_among(const std::vector<std::string>& arguments, std::string& library) {
    std::vector<Scenario> decks;
    for (const std::string& argument : arguments) {
        if (!is_deck(argument)) continue;
        Scenario& deck = decks.emplace_back(read_deck(argument));
        if (deck.stem == "deck") deck.stem = std::filesystem::absolute(argument).parent_path().filename().string();
        if (library.empty()) library = deck.material.library;
    }
    return decks;
}

}  // namespace lode::host
