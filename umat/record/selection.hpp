// Which calls LODE_RECORD=file[:selection] stores.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lode::record {

struct Range {
    int first = 0, last = 0;
};

// An empty list selects everything. Calls of VUMAT have no element and integration point.
struct Selection {
    std::vector<std::string> materials;  // names as the host gives them, or their part before the first '-'
    std::vector<Range> elements, points, steps, increments;
    int ring = 0;           // > 0: keep the last calls in memory, written when the analysis fails or the process ends
    bool only_cut = false;  // only calls that ask for a smaller increment or do not return
    int fields = 1;         // field variables of a UMAT call: the interface does not say how many there are
};

// The file and the selection of the variable's value; throws std::invalid_argument naming what is wrong with it. "%p"
// in the file name becomes the number of the process.
struct Request {
    std::string file;
    Selection selection;
};
Request parse_request(std::string_view value);

bool selects(const std::vector<Range>& ranges, int number);
bool selects_material(const Selection& selection, std::string_view name);

}  // namespace lode::record
