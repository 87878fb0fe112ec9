// Checked reading of TOML: every refusal names file, line and key and says what is legal; keys that nobody asked for
// are refused too.
#ifndef LODE_HOST_REPLAY_TOML_READER_HPP
#define LODE_HOST_REPLAY_TOML_READER_HPP

#ifndef TOML_HEADER_ONLY
#define TOML_HEADER_ONLY 1
#endif
#include <fmt/format.h>
#include <toml++/toml.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis.hpp"
#include "scenario.hpp"

namespace lode::host {

toml::table parse_toml_file(const std::string& path);

struct Limits {
    double lower = -1e300, upper = 1e300;
    bool lower_open = false;
    const char* words = "a finite number";
};
inline constexpr Limits any_number{};
inline constexpr Limits positive{0, 1e300, true, "a positive number"};
inline constexpr Limits not_negative{0, 1e300, false, "a number that is not negative"};

// One table of the deck. Every accessor makes its key known; `finish` refuses the keys that are left over.
class TableReader {
  public:
    TableReader(const toml::table& table, std::string file, std::string path);

    bool has(std::string_view key) const { return table_.contains(key); }
    bool is_table(std::string_view key) const { return table_.get(key) != nullptr && table_.get(key)->is_table(); }
    bool is_flag(std::string_view key) const { return table_.get(key) != nullptr && table_.get(key)->is_boolean(); }
    std::optional<double> number(std::string_view key, const Limits& limits = any_number);
    std::optional<int> integer(std::string_view key, int least, int most = 1'000'000'000);
    std::optional<bool> flag(std::string_view key);
    std::optional<std::string> text(std::string_view key);
    std::optional<std::vector<double>> numbers(std::string_view key, const Limits& limits = any_number);
    // Constants of a material: NaN and infinity are for the material to judge.
    std::optional<std::vector<double>> raw_numbers(std::string_view key);
    // Rows of equal length.
    std::optional<std::vector<std::vector<double>>> rows(std::string_view key);
    std::optional<TableReader> table(std::string_view key);
    // One table, or an array of tables.
    std::vector<TableReader> tables(std::string_view key);
    // One word, or several.
    std::vector<Located> words(std::string_view key);
    // One of the words; its index.
    std::optional<std::size_t> choice(std::string_view key, std::span<const std::string_view> legal);

    // For tables whose keys are data, e.g. component names: each key with its number.
    struct NamedNumber {
        std::string name;
        double value;
    };
    std::vector<NamedNumber> named_numbers() const;

    void finish() const;

    std::string location(std::string_view key = {}) const;
    [[noreturn]] void refuse(std::string_view key, const std::string& message) const;

  private:
    const toml::node* find(std::string_view key);
    double number_of(const toml::node& node, std::string_view key, const Limits& limits) const;
    std::string path_of(std::string_view key) const;
    int line_of(std::string_view key) const;

    const toml::table& table_;
    std::string file_, path_;
    std::vector<std::string> known_;
};

}  // namespace lode::host

#endif
