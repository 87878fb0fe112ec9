// The case study of the dissertation: all its tables and figures, next to numbers to compare with.
#pragma once

#include <filesystem>

namespace mpm {

struct StudyOptions {
    std::filesystem::path directory = "mpm_study";
    double finest = 0.0025;  // cells; leaves out runs on finer grids
    int at_a_time = 1;
};
// Writes tables.md, histories and points as CSV, and the figures. True if every comparison is inside its tolerance.
bool study(const StudyOptions& options);

}  // namespace mpm
