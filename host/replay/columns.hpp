// Named quantities of a record: what CSV files, plots and summaries are made of.
#ifndef LODE_HOST_REPLAY_COLUMNS_HPP
#define LODE_HOST_REPLAY_COLUMNS_HPP

#include <functional>
#include <string>
#include <vector>

#include "driver.hpp"

namespace lode::host {

struct Column {
    std::string name;
    std::string quantity;  // "stress": what an axis with several such columns is called; may be empty
    std::string label;     // "σ_{11}": gnuplot's enhanced text
    std::string unit;      // may be empty
    std::function<double(const Record&)> value;
    bool is_reference = false;  // what another column is held against: drawn as circles
};

class ColumnSet {
  public:
    // `library` names the state variables; the scenario has been resolved.
    ColumnSet(const Scenario& scenario, const Library& library);

    // Throws BadDeck with the request's location.
    Column find(const Located& request) const;
    std::vector<Column> defaults() const;
    // Number of the column in `columns`, which gets it if it is not there yet.
    static std::size_t place(std::vector<Column>& columns, const Column& column);

  private:
    void add(std::string name, std::string quantity, std::string label, std::string unit,
             std::function<double(const Record&)> value, bool is_default = false);

    void add_closed_forms(const Scenario& scenario, const Layout& layout);

    std::vector<Column> columns_;
    std::vector<std::string> default_names_;
};

}  // namespace lode::host

#endif
