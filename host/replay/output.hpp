// Files of a run: CSV, gnuplot script, PNG and SVG.
#ifndef LODE_HOST_REPLAY_OUTPUT_HPP
#define LODE_HOST_REPLAY_OUTPUT_HPP

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "columns.hpp"

namespace lode::host {

class CsvWriter {
  public:
    // Throws Failure (usage) if the file cannot be written.
    CsvWriter(std::string path, std::vector<Column> columns);
    void write(const Record& record);
    void close();
    const std::string& path() const { return path_; }

  private:
    std::string path_;
    std::vector<Column> columns_;
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
    std::string line_;
};

// A plot whose columns have been found.
struct Figure {
    std::string stem;  // path without extension
    std::string title, x_label, y_label;
    Column x;
    std::vector<Column> y;
    std::vector<std::size_t> y_index;  // places in the CSV file
    std::size_t x_index = 0;
};

// The plots asked for or, if there are none, the first driven component: its stress over its strain. Adds to `columns`
// what they need.
std::vector<Figure> make_figures(const Scenario& scenario, const ColumnSet& set, const std::string& stem,
                                 std::vector<Column>& columns);

// Writes stem.gp and runs gnuplot on it; stem.png and stem.svg appear. Returns what went wrong, or nothing.
std::string draw(const Figure& figure, const std::string& csv);

}  // namespace lode::host

#endif
