// The history of a recorded point as a deck for `lode replay`.
#ifndef LODE_HOST_RERUN_DECK_WRITER_HPP
#define LODE_HOST_RERUN_DECK_WRITER_HPP

#include <string>
#include <vector>

#include "recording.hpp"

namespace lode::host {

// Which point: by element and integration point of UMAT calls.
struct PointChoice {
    int element = 0, point = 0;
};

// The accepted calls of the point in time order: of the iterations of an increment the last one, of an increment that
// was cut and repeated the repetitions. Only calls that returned.
std::vector<const RecordedCall*> history_of(const Recording& recording, const PointChoice& choice);

// A deck with one step for each increment, driven by DSTRAN or, where the host passed deformation gradients, by DFGRD1.
// `history` is not empty.
std::string deck_of(const std::vector<const RecordedCall*>& history);

}  // namespace lode::host

#endif
