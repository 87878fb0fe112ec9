#include "toml_reader.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "../status.hpp"
#include "../text.hpp"

namespace lode::host {

toml::table parse_toml_file(const std::string& path) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) throw BadDeck(path + ": there is no such file");
    try {
        return toml::parse_file(path);
    } catch (const toml::parse_error& error) {
        throw BadDeck(fmt::format("{}:{}: this is not TOML: {}", path, error.source().begin.line, error.description()));
    }
}

TableReader::TableReader(const toml::table& table, std::string file, std::string path)
    : table_(table), file_(std::move(file)), path_(std::move(path)) {}

std::string TableReader::path_of(std::string_view key) const {
    if (path_.empty() || key.empty()) return path_ + std::string(key);
    return path_ + "." + std::string(key);
}

int TableReader::line_of(std::string_view key) const {
    for (const auto& [name, node] : table_)
        if (name.str() == key) {
            // Implicitly made tables ([a.b]) have no place of their own.
            const auto line = name.source().begin.line;
            return static_cast<int>(line != 0 ? line : node.source().begin.line);
        }
    return static_cast<int>(table_.source().begin.line);
}

std::string TableReader::location(std::string_view key) const {
    return fmt::format("{}:{}: {}", file_, std::max(line_of(key), 1), path_of(key));
}

void TableReader::refuse(std::string_view key, const std::string& message) const {
    throw BadDeck(location(key) + (path_of(key).empty() ? "" : ": ") + message);
}

const toml::node* TableReader::find(std::string_view key) {
    if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.emplace_back(key);
    return table_.get(key);
}

double TableReader::number_of(const toml::node& node, std::string_view key, const Limits& limits) const {
    if (!node.is_number()) refuse(key, fmt::format("expected {}", limits.words));
    const double value = *node.value<double>();
    if (!(value >= limits.lower && value <= limits.upper) || (limits.lower_open && value == limits.lower))
        refuse(key, fmt::format("{} is not legal here; expected {}", value, limits.words));
    return value;
}

std::optional<double> TableReader::number(std::string_view key, const Limits& limits) {
    const toml::node* const node = find(key);
    if (node == nullptr) return std::nullopt;
    return number_of(*node, key, limits);
}

std::optional<int> TableReader::integer(std::string_view key, int least, int most) {
    const toml::node* const node = find(key);
    if (node == nullptr) return std::nullopt;
    const auto value = node->value_exact<std::int64_t>();
    if (!value || *value < least || *value > most)
        refuse(key, fmt::format("expected a whole number from {} to {}", least, most));
    return static_cast<int>(*value);
}

std::optional<bool> TableReader::flag(std::string_view key) {
    const toml::node* const node = find(key);
    if (node == nullptr) return std::nullopt;
    if (!node->is_boolean()) refuse(key, "expected true or false");
    return node->value<bool>();
}

std::optional<std::string> TableReader::text(std::string_view key) {
    const toml::node* const node = find(key);
    if (node == nullptr) return std::nullopt;
    if (!node->is_string()) refuse(key, "expected a text in quotes");
    return node->value<std::string>();
}

std::optional<std::vector<double>> TableReader::numbers(std::string_view key, const Limits& limits) {
    const toml::node* const node = find(key);
    if (node == nullptr) return std::nullopt;
    std::vector<double> values;
    if (const auto* array = node->as_array())
        for (const auto& entry : *array) values.push_back(number_of(entry, key, limits));
    else values.push_back(number_of(*node, key, limits));
    return values;
}

std::optional<std::vector<double>> TableReader::raw_numbers(std::string_view key) {
    const toml::node* const node = find(key);
    if (node == nullptr) return std::nullopt;
    std::vector<double> values;
    const auto* array = node->as_array();
    if (array == nullptr) refuse(key, "expected a list of numbers, e.g. [210000, 0.3]");
    for (const auto& entry : *array) {
        if (!entry.is_number()) refuse(key, fmt::format("entry {} is not a number", values.size() + 1));
        values.push_back(*entry.value<double>());
    }
    return values;
}

std::optional<std::vector<std::vector<double>>> TableReader::rows(std::string_view key) {
    const toml::node* const node = find(key);
    if (node == nullptr) return std::nullopt;
    const auto* array = node->as_array();
    if (array == nullptr) refuse(key, "expected a list of rows, e.g. [[0, 0], [1, 1]]");
    std::vector<std::vector<double>> rows;
    for (const auto& entry : *array) {
        const auto* row = entry.as_array();
        if (row == nullptr) refuse(key, "expected a list of rows, e.g. [[0, 0], [1, 1]]");
        rows.emplace_back();
        for (const auto& value : *row) rows.back().push_back(number_of(value, key, any_number));
        if (rows.back().size() != rows.front().size()) refuse(key, "the rows are not equally long");
    }
    return rows;
}

std::optional<TableReader> TableReader::table(std::string_view key) {
    const toml::node* const node = find(key);
    if (node == nullptr) return std::nullopt;
    const auto* table = node->as_table();
    if (table == nullptr) refuse(key, "expected a table: { key = value, ... }");
    return TableReader(*table, file_, path_of(key));
}

std::vector<TableReader> TableReader::tables(std::string_view key) {
    std::vector<TableReader> result;
    const toml::node* const node = find(key);
    if (node == nullptr) return result;
    if (const auto* table = node->as_table()) {
        result.emplace_back(*table, file_, path_of(key));
    } else if (const auto* array = node->as_array()) {
        for (const auto& entry : *array) {
            const auto* element = entry.as_table();
            if (element == nullptr) refuse(key, "expected tables: { key = value, ... }");
            result.emplace_back(*element, file_, fmt::format("{}[{}]", path_of(key), result.size() + 1));
        }
    } else {
        refuse(key, "expected a table: { key = value, ... }");
    }
    return result;
}

std::vector<Located> TableReader::words(std::string_view key) {
    std::vector<Located> result;
    const toml::node* const node = find(key);
    if (node == nullptr) return result;
    const auto add = [&](const toml::node& entry) {
        if (!entry.is_string()) refuse(key, "expected names in quotes");
        const auto line = entry.source().begin.line;
        result.push_back({*entry.value<std::string>(), fmt::format("{}:{}: {}", file_, line, path_of(key))});
    };
    if (const auto* array = node->as_array())
        for (const auto& entry : *array) add(entry);
    else add(*node);
    return result;
}

std::optional<std::size_t> TableReader::choice(std::string_view key, std::span<const std::string_view> legal) {
    const auto word = text(key);
    if (!word) return std::nullopt;
    const auto found = std::find(legal.begin(), legal.end(), *word);
    if (found == legal.end())
        refuse(key,
               fmt::format("\"{}\" is not known; legal are {}{}", *word, joined(legal), did_you_mean(*word, legal)));
    return static_cast<std::size_t>(found - legal.begin());
}

std::vector<TableReader::NamedNumber> TableReader::named_numbers() const {
    std::vector<NamedNumber> result;
    for (const auto& [name, node] : table_)
        result.push_back({std::string(name.str()), number_of(node, name.str(), any_number)});
    return result;
}

void TableReader::finish() const {
    for (const auto& [name, node] : table_) {
        const auto key = name.str();
        if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
        refuse(key, fmt::format("there is no such key; legal are {}{}", joined(known_), did_you_mean(key, known_)));
    }
}

}  // namespace lode::host
