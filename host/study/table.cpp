#include "table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "../status.hpp"

namespace lode::host {
namespace {

std::string escaped(std::string_view text) {
    if (text.find_first_of(",\"\n") == std::string_view::npos) return std::string(text);
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"') result += '"';
        result += c == '\n' ? ' ' : c;
    }
    return result + "\"";
}

}  // namespace

Cell::Cell(double number) : text_(fmt::format("{}", number)) {}
Cell::Cell(int number) : text_(fmt::format("{}", number)) {}
Cell::Cell(const char* text) : text_(escaped(text)) {}
Cell::Cell(std::string_view text) : text_(escaped(text)) {}
Cell::Cell(const std::string& text) : text_(escaped(text)) {}

Table::Table(const std::vector<std::string>& columns) {
    add({columns.begin(), columns.end()});
    rows_ = 0;
}

void Table::add(const std::vector<Cell>& row) {
    for (std::size_t i = 0; i < row.size(); ++i) text_.append(i == 0 ? "" : ",").append(row[i].text());
    text_ += '\n';
    ++rows_;
}

void Table::write(const std::string& path) const {
    std::FILE* const file = std::fopen(path.c_str(), "w");
    if (file == nullptr) throw Failure(Status::usage, "cannot write " + path);
    const bool whole = std::fwrite(text_.data(), 1, text_.size(), file) == text_.size();
    if (std::fclose(file) != 0 || !whole) throw Failure(Status::usage, "cannot write " + path);
}

std::string aligned(const std::vector<std::vector<std::string>>& rows, const std::string& indent) {
    std::vector<std::size_t> widths;
    for (const auto& row : rows) {
        widths.resize(std::max(widths.size(), row.size()), 0);
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    }
    std::string text;
    for (const auto& row : rows) {
        std::string line = indent;
        for (std::size_t i = 0; i < row.size(); ++i) {
            line += row[i];
            if (i + 1 < row.size()) line.append(widths[i] - row[i].size() + 2, ' ');
        }
        text += line + "\n";
    }
    return text;
}

std::string output_directory(const std::string& path) {
    std::error_code failed;
    std::filesystem::create_directories(path, failed);
    if (!std::filesystem::is_directory(path, failed))
        throw Failure(Status::usage, "cannot make the output directory " + path);
    return path;
}

}  // namespace lode::host
