// Rows for CSV files, and columns of text for the terminal.
#ifndef LODE_HOST_STUDY_TABLE_HPP
#define LODE_HOST_STUDY_TABLE_HPP

#include <string>
#include <string_view>
#include <vector>

namespace lode::host {

// A cell: text, or a number written with the fewest digits that read back as the same one.
class Cell {
  public:
    Cell(double number);
    Cell(int number);
    Cell(const char* text);
    Cell(std::string_view text);
    Cell(const std::string& text);
    const std::string& text() const { return text_; }

  private:
    std::string text_;
};

class Table {
  public:
    explicit Table(const std::vector<std::string>& columns);
    void add(const std::vector<Cell>& row);
    int rows() const { return rows_; }
    // Throws Failure (usage) if the file cannot be written.
    void write(const std::string& path) const;
    const std::string& text() const { return text_; }

  private:
    std::string text_;
    int rows_ = 0;
};

// Columns wide enough for their longest cell, two blanks apart, each line begun with `indent`.
std::string aligned(const std::vector<std::vector<std::string>>& rows, const std::string& indent);

// The directory, made if it is not there. Throws Failure (usage).
std::string output_directory(const std::string& path);

}  // namespace lode::host

#endif
