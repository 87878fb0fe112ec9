// gnuplot, run as a program on a script.
#ifndef LODE_HOST_PLOT_GNUPLOT_HPP
#define LODE_HOST_PLOT_GNUPLOT_HPP

#include <string>

namespace lode::host {

// Inside gnuplot's single quotes.
std::string single_quoted(const std::string& text);
// Inside gnuplot's double quotes, where a doubled backslash escapes a character of enhanced text.
std::string double_quoted(const std::string& text);

// Border, tics, grid and colours that all figures have in common.
std::string figure_style();
// Draws what `plot` says as stem.png and stem.svg; `plot` is one plot or splot command. The files are named without
// directories, so that the script can be run again wherever they are.
// A wide figure has room for a long key beside it.
enum class Width { usual, wide };
std::string terminals(const std::string& stem, const std::string& plot, Width width = Width::usual);
// The colours of curves, used in turn.
std::string curve_colour(std::size_t index);

// Writes stem.gp and runs gnuplot on it. Returns what went wrong, or nothing.
std::string draw_script(const std::string& stem, const std::string& script);

}  // namespace lode::host

#endif
