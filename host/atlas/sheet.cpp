#include "sheet.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "../plot/gnuplot.hpp"

namespace lode::host {

std::string write_sheet(const Sheet& sheet, const std::string& directory) {
    const std::string stem = (std::filesystem::path(directory) / sheet.stem).lexically_normal().string();
    sheet.table.write(stem + ".csv");
    if (sheet.setup.empty()) return {};
    return draw_script(stem, "# gnuplot script, written by `lode atlas`. The data are in it.\n" + sheet.setup +
                                 terminals(stem, sheet.plot));
}

std::string figure_setup(const std::string& title, const std::string& x_label, const std::string& y_label) {
    return figure_style() +
           fmt::format("set title {} font ',14' offset 0,-0.2 noenhanced\nset xlabel {}\nset ylabel {}\n",
                       single_quoted(title), single_quoted(x_label), single_quoted(y_label));
}

}  // namespace lode::host
