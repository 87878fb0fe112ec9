// The figures of the study, drawn by gnuplot from CSV files.
#pragma once

#include <filesystem>

#include "campaign.hpp"

namespace mpm {

// False if gnuplot did not draw them all; its scripts are there in any case.
bool draw_figures(const Campaign& campaign, const std::filesystem::path& directory);

// Response, cracks and stress of one run.
bool draw_run(const Result& result, const std::filesystem::path& directory);

}  // namespace mpm
