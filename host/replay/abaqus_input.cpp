#include "abaqus_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>

#include "../status.hpp"
#include "../text.hpp"

namespace lode::host {
namespace {

constexpr int deepest_include = 10;
constexpr std::size_t values_per_line = 8;

struct Line {
    std::string text;
    std::string file;
    int number = 0;
};

// A keyword line with its parameters, and the data lines below it.
struct Card {
    std::string keyword;                            // without the star, one blank between words
    std::map<std::string, std::string> parameters;  // upper-case names, values as written
    std::vector<Line> data;
    std::string file;
    int number = 0;

    [[noreturn]] void refuse(const std::string& message, int line = 0) const {
        throw BadDeck(fmt::format("{}:{}: *{}: {}", file, line != 0 ? line : number, keyword, message));
    }
};

std::vector<std::string> split(const std::string& text) {
    std::vector<std::string> fields;
    std::size_t begin = 0;
    while (true) {
        const auto comma = text.find(',', begin);
        fields.push_back(
            trimmed(std::string_view(text).substr(begin, comma == std::string::npos ? comma : comma - begin)));
        if (comma == std::string::npos) return fields;
        begin = comma + 1;
    }
}

std::string single_spaced(const std::string& text) {
    std::string result;
    for (const char c : text)
        if (c != ' ' && c != '\t') result += c;
        else if (!result.empty() && result.back() != ' ') result += ' ';
    return result;
}

std::string unquoted(std::string text) {
    if (text.size() >= 2 && text.front() == '"' && text.back() == '"') return text.substr(1, text.size() - 2);
    return text;
}

Card parse_keyword_line(const Line& line) {
    Card card;
    card.file = line.file;
    card.number = line.number;
    auto fields = split(line.text.substr(1));
    card.keyword = single_spaced(upper(fields.front()));
    for (auto field = fields.begin() + 1; field != fields.end(); ++field) {
        if (field->empty()) continue;
        const auto equals = field->find('=');
        const std::string name = single_spaced(upper(trimmed(field->substr(0, equals))));
        card.parameters[name] = equals == std::string::npos ? "" : unquoted(trimmed(field->substr(equals + 1)));
    }
    return card;
}

void read_cards(const std::string& path, int depth, std::vector<Card>& cards) {
    std::ifstream stream(path);
    std::error_code ignored;
    if (!stream || std::filesystem::is_directory(path, ignored)) throw BadDeck(path + ": cannot read this input file");
    std::string text;
    for (int number = 1; std::getline(stream, text); ++number) {
        text = trimmed(text);
        if (text.empty() || text.starts_with("**")) continue;
        if (!text.starts_with('*')) {
            if (!cards.empty()) cards.back().data.push_back({text, path, number});
            continue;
        }
        const int first = number;
        // A keyword line that ends with a comma goes on below.
        for (std::string more; text.ends_with(',') && std::getline(stream, more);) {
            ++number;
            text += trimmed(more);
        }
        Card card = parse_keyword_line({text, path, first});
        if (card.keyword == "INCLUDE") {
            if (depth == deepest_include) card.refuse("files are included too deeply");
            const std::filesystem::path file = card.parameters["INPUT"];
            read_cards((file.is_absolute() ? file : std::filesystem::path(path).parent_path() / file).string(),
                       depth + 1, cards);
            continue;
        }
        cards.push_back(std::move(card));
    }
}

// Fortran exponents are understood; an empty field is zero, as Abaqus has it.
double number_of(const Card& card, const std::string& field, int line) {
    if (field.empty()) return 0;
    std::string text = field;
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == 'd' || c == 'D'; }, 'e');
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (*end != '\0') card.refuse(fmt::format("\"{}\" is not a number", field), line);
    return value;
}

std::vector<double> numbers_of(const Card& card, const Line& line) {
    auto fields = split(line.text);
    if (fields.size() > 1 && fields.back().empty()) fields.pop_back();
    std::vector<double> values;
    for (const auto& field : fields) values.push_back(number_of(card, field, line.number));
    return values;
}

int integer_of(const Card& card, const std::string& text, const std::string& what) {
    char* end = nullptr;
    const long value = std::strtol(text.c_str(), &end, 10);
    if (text.empty() || *end != '\0' || value < 0 || value > 1000000)
        card.refuse(fmt::format("{} has to be a whole number, not \"{}\"", what, text));
    return static_cast<int>(value);
}

void take_constants(const Card& card, MaterialCards& material) {
    const auto given = card.parameters.find("CONSTANTS");
    if (given == card.parameters.end()) card.refuse("CONSTANTS=n is missing");
    const auto count = static_cast<std::size_t>(integer_of(card, given->second, "CONSTANTS"));
    material.unsymmetric = card.parameters.contains("UNSYMM");
    for (const Line& line : card.data) {
        if (material.constants.size() >= count) break;
        const std::size_t missing = count - material.constants.size();
        const auto values = numbers_of(card, line);
        // Abaqus reads eight a line and takes what is missing for zero, which is hardly ever meant.
        if (values.size() < std::min(values_per_line, missing))
            card.refuse(fmt::format("this line has {} values where {} are expected (eight a line)", values.size(),
                                    std::min(values_per_line, missing)),
                        line.number);
        if (values.size() > values_per_line && missing > values_per_line)
            card.refuse(fmt::format("this line has {} values; Abaqus reads eight", values.size()), line.number);
        material.constants.insert(material.constants.end(), values.begin(),
                                  values.begin() + static_cast<std::ptrdiff_t>(std::min(values.size(), missing)));
    }
    if (material.constants.size() < count)
        card.refuse(fmt::format("CONSTANTS={}, but the data lines hold {}", count, material.constants.size()));
}

// The only data line there may be: values that depend on temperature are beyond a single number.
const Line& only_line(const Card& card) {
    if (card.data.empty()) card.refuse("the data line is missing");
    if (card.data.size() > 1) card.refuse("only one data line is understood (no dependence on temperature)");
    return card.data.front();
}

void take_expansion(const Card& card, MaterialCards& material) {
    const auto type = card.parameters.find("TYPE");
    const std::string kind = type == card.parameters.end() ? "ISO" : upper(type->second);
    if (kind != "ISO" && kind != "ORTHO") card.refuse("TYPE=" + kind + " is not understood; legal are ISO and ORTHO");
    const std::size_t count = kind == "ISO" ? 1 : 3;
    auto values = numbers_of(card, only_line(card));
    if (values.size() < count) card.refuse(fmt::format("TYPE={} needs {} coefficients", kind, count));
    values.resize(count);
    material.expansion = values;
}

}  // namespace

std::vector<MaterialCards> read_material_cards(const std::string& path) {
    std::vector<Card> cards;
    read_cards(path, 0, cards);
    std::vector<MaterialCards> materials;
    std::optional<MaterialCards> current;
    bool has_constants = false;
    const auto close = [&] {
        if (current && has_constants) materials.push_back(std::move(*current));
        has_constants = false;
    };
    for (const Card& card : cards) {
        if (card.keyword == "MATERIAL") {
            close();
            const auto name = card.parameters.find("NAME");
            if (name == card.parameters.end() || name->second.empty()) card.refuse("NAME=... is missing");
            current = MaterialCards{};
            current->name = upper(name->second);
        } else if (!current) {
            continue;
        } else if (card.keyword == "USER MATERIAL") {
            const auto type = card.parameters.find("TYPE");
            if (type != card.parameters.end() && upper(type->second) != "MECHANICAL") continue;
            take_constants(card, *current);
            has_constants = true;
        } else if (card.keyword == "DEPVAR") {
            if (card.data.empty()) card.refuse("the number of state variables is missing");
            current->state_variables =
                integer_of(card, split(card.data.front().text).front(), "the number of state variables");
        } else if (card.keyword == "DENSITY") {
            current->density = numbers_of(card, only_line(card)).front();
        } else if (card.keyword == "EXPANSION") {
            take_expansion(card, *current);
        }
    }
    close();
    if (materials.empty()) throw BadDeck(path + ": no *MATERIAL with a *USER MATERIAL card in this file");
    return materials;
}

}  // namespace lode::host
