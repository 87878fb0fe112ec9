#include "settings.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#define TOML_HEADER_ONLY 1
#include <toml++/toml.h>

#include <cstring>
#include <set>
#include <sstream>

#include "lode/lode.h"

namespace bar {
namespace {

constexpr int bad_card = 2, refused = 65;

// A table of the card; keys that nobody asked for are refused, they are misspelt.
class Table {
  public:
    Table(const toml::table& root, const char* name) : name_(name) {
        if (const toml::node* node = root.get(name)) {
            table_ = node->as_table();
            if (table_ == nullptr) fail("must be a table");
        }
    }
    template <class T>
    void read(const char* key, T& value) {
        known_.insert(key);
        const toml::node* node = table_ != nullptr ? table_->get(key) : nullptr;
        if (node == nullptr) return;
        if constexpr (std::is_same_v<T, std::vector<double>>) {
            const toml::array* list = node->as_array();
            if (list == nullptr) fail(std::string(key) + " must be a list of numbers");
            value.clear();
            for (const toml::node& entry : *list) {
                const auto number = entry.value<double>();
                if (!number) fail(std::string(key) + " must be a list of numbers");
                value.push_back(*number);
            }
        } else {
            const auto read = node->value<T>();
            if (!read) fail(std::string(key) + " has the wrong type");
            value = *read;
        }
    }
    void finish() const {
        if (table_ == nullptr) return;
        for (const auto& [key, value] : *table_)
            if (known_.count(std::string(key.str())) == 0) fail("unknown key " + std::string(key.str()));
    }

  private:
    [[noreturn]] void fail(const std::string& what) const {
        throw BadSettings("[" + std::string(name_) + "] " + what, bad_card);
    }
    const char* name_;
    const toml::table* table_ = nullptr;
    std::set<std::string> known_;
};

void read_card(const std::string& file, Settings& s) {
    toml::table card;
    try {
        card = toml::parse_file(file);
    } catch (const toml::parse_error& error) {
        std::ostringstream text;
        text << file << ": " << error;
        throw BadSettings(text.str(), bad_card);
    }
    Table material(card, "material"), geometry(card, "bar"), loading(card, "loading"), solver(card, "solver");
    std::vector<double> stress(s.material.initial_stress.begin(), s.material.initial_stress.end());
    material.read("name", s.material.name);
    material.read("constants", s.material.constants);
    material.read("state_variables", s.material.state_variables);
    material.read("initial_state", s.material.initial_state);
    material.read("initial_stress", stress);
    material.read("watch", s.material.watch);
    geometry.read("width", s.geometry.width);
    geometry.read("length", s.geometry.length);
    geometry.read("thickness", s.geometry.thickness);
    geometry.read("notch_radius", s.geometry.notch_radius);
    geometry.read("plane_strain", s.geometry.plane_strain);
    geometry.read("divisions", s.geometry.divisions);
    geometry.read("layers", s.geometry.layers);
    geometry.read("refine", s.geometry.refine);
    geometry.read("refine_notch", s.geometry.refine_notch);
    loading.read("elongation", s.loading.elongation);
    loading.read("time", s.loading.time);
    loading.read("first", s.loading.first);
    loading.read("largest", s.loading.largest);
    loading.read("smallest", s.loading.smallest);
    loading.read("increments", s.loading.increments);
    solver.read("tolerance", s.solver.tolerance);
    solver.read("maximum_iterations", s.solver.maximum_iterations);
    solver.read("linear", s.solver.linear);
    for (const Table* table : {&material, &geometry, &loading, &solver}) table->finish();
    if (stress.size() != 6) throw BadSettings("[material] initial_stress needs 6 numbers", bad_card);
    std::copy(stress.begin(), stress.end(), s.material.initial_stress.begin());
    for (const auto& [key, value] : card)
        if (key != "material" && key != "bar" && key != "loading" && key != "solver")
            throw BadSettings("unknown table [" + std::string(key.str()) + "]", bad_card);
}

void require(bool holds, const std::string& text) {
    if (!holds) throw BadSettings(text, bad_card);
}

void validate(const Settings& s) {
    const Geometry& g = s.geometry;
    require(g.width > 0 && g.length > 0 && g.thickness > 0, "width, length and thickness must be positive");
    require(g.notch_radius >= 0 && 2 * g.notch_radius < g.width, "notch_radius must be less than half the width");
    require(g.notch_radius == 0 || g.length > g.width, "a notched bar must be longer than wide");
    require(g.divisions > 0 && g.layers > 0, "divisions and layers must be at least 1");
    require(g.refine >= 0 && g.refine <= 8 && g.refine_notch >= 0 && g.refine_notch <= 8,
            "refine and refine_notch must be from 0 to 8");
    const Loading& l = s.loading;
    require(l.time > 0, "time must be positive");
    require(0 < l.smallest && l.smallest <= l.first && l.first <= 1, "0 < smallest <= first <= 1 is needed");
    require(l.smallest <= l.largest && l.largest <= 1, "smallest <= largest <= 1 is needed");
    for (const double part : l.increments) require(part > 0, "increments must be positive");
    require(s.solver.tolerance > 0 && s.solver.maximum_iterations > 0,
            "tolerance and maximum_iterations must be positive");
    require(s.solver.linear == "auto" || s.solver.linear == "cg" || s.solver.linear == "gmres",
            "linear must be auto, cg or gmres");
    require(s.write_every >= 0, "--write-every must not be negative");
}

}  // namespace

Settings read_settings(int count, char** words) {
    Settings s, given;
    CLI::App app("A notched bar under MPI with a material behind umat_");
    std::string card;
    app.add_option("card", card, "TOML file with [material], [bar], [loading], [solver]")->check(CLI::ExistingFile);
    // Options are applied after the card, by whoever was given.
    std::vector<std::pair<CLI::Option*, void (*)(Settings&, const Settings&)>> options;
    const auto option = [&](const char* name, auto& value, void (*apply)(Settings&, const Settings&),
                            const char* help) {
        options.push_back({app.add_option(name, value, help), apply});
    };
    option(
        "-m,--material", given.material.name,
        [](Settings& to, const Settings& from) { to.material.name = from.material.name; }, "CMNAME");
    option(
        "-c,--constants", given.material.constants,
        [](Settings& to, const Settings& from) { to.material.constants = from.material.constants; }, "PROPS");
    option(
        "--state-variables", given.material.state_variables,
        [](Settings& to, const Settings& from) { to.material.state_variables = from.material.state_variables; },
        "NSTATV; default: what the library asks for");
    option(
        "--elongation", given.loading.elongation,
        [](Settings& to, const Settings& from) { to.loading.elongation = from.loading.elongation; },
        "of the whole bar");
    option(
        "--first", given.loading.first,
        [](Settings& to, const Settings& from) { to.loading.first = from.loading.first; },
        "first increment, as a part of the whole");
    option(
        "--notch-radius", given.geometry.notch_radius,
        [](Settings& to, const Settings& from) { to.geometry.notch_radius = from.geometry.notch_radius; },
        "0: no notch");
    option(
        "-r,--refine", given.geometry.refine,
        [](Settings& to, const Settings& from) { to.geometry.refine = from.geometry.refine; },
        "uniform refinements of the mesh");
    option(
        "--refine-notch", given.geometry.refine_notch,
        [](Settings& to, const Settings& from) { to.geometry.refine_notch = from.geometry.refine_notch; },
        "further refinements at the notch");
    option(
        "-o,--output", given.output, [](Settings& to, const Settings& from) { to.output = from.output; },
        "directory of the results");
    option(
        "--write-every", given.write_every,
        [](Settings& to, const Settings& from) { to.write_every = from.write_every; },
        "PVTU files after every n-th increment; 0: at the end");
    try {
        app.parse(count, words);
    } catch (const CLI::ParseError& error) {
        std::ostringstream text;
        const int status = app.exit(error, text, text);
        throw BadSettings(text.str(), status);
    }
    if (!card.empty()) read_card(card, s);
    for (const auto& [given_option, apply] : options)
        if (given_option->count() > 0) apply(s, given);
    validate(s);
    return s;
}

MaterialFacts examine(const Material& material) {
    std::string keyword = material.name.substr(0, material.name.find('-'));
    std::transform(keyword.begin(), keyword.end(), keyword.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    char error[1000] = "";
    const int needed = lode_required_state(material.name.c_str(), material.constants.data(),
                                           static_cast<int>(material.constants.size()), 3, 3, error, sizeof error);
    if (needed < 0) throw BadSettings(error, refused);

    MaterialFacts facts;
    facts.state_variables = material.state_variables >= 0 ? material.state_variables : needed;
    const auto size = static_cast<std::size_t>(facts.state_variables);
    const lode_model* model = nullptr;
    for (int i = 0; i < lode_model_count(); ++i)
        if (keyword == lode_model_at(i)->keyword) model = lode_model_at(i);
    if (model == nullptr) throw BadSettings("no description of " + keyword + " in the library", refused);
    if ((model->traits & LODE_FINITE_STRAIN) != 0)
        throw BadSettings(keyword + " reads the deformation gradient; this program is for small strain", refused);
    for (std::size_t i = 0; i < size; ++i) {
        const bool described = i < static_cast<std::size_t>(model->state_count);
        facts.state_names.push_back(described ? model->state[i].name : "STATEV" + std::to_string(i + 1));
    }
    if (material.initial_state.size() > size) throw BadSettings("initial_state is longer than STATEV", bad_card);

    const auto found =
        std::find(facts.state_names.begin(), facts.state_names.end(), material.watch.empty() ? "EQPS" : material.watch);
    if (found != facts.state_names.end()) facts.watched = static_cast<int>(found - facts.state_names.begin());
    else if (!material.watch.empty()) throw BadSettings("watch: no state variable " + material.watch, bad_card);
    else facts.watched = size > 0 ? 0 : -1;
    return facts;
}

}  // namespace bar
