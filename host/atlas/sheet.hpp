// What a map of the atlas comes to: a table, a figure and some lines of text.
#ifndef LODE_HOST_ATLAS_SHEET_HPP
#define LODE_HOST_ATLAS_SHEET_HPP

#include <string>

#include "../study/table.hpp"

namespace lode::host {

struct Sheet {
    std::string stem;   // of its files
    std::string text;   // for the terminal
    Table table;        // CSV
    std::string setup;  // gnuplot commands and data blocks; empty: no figure
    std::string plot;   // the plot command
};

// stem.csv, and stem.gp, stem.png, stem.svg. Returns what went wrong with the figure, or nothing.
std::string write_sheet(const Sheet& sheet, const std::string& directory);

// The commands that every figure of the atlas begins with.
std::string figure_setup(const std::string& title, const std::string& x_label, const std::string& y_label);

}  // namespace lode::host

#endif
