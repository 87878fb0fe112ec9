// The [[step]] tables of a deck.
#ifndef LODE_HOST_REPLAY_DECK_STEPS_HPP
#define LODE_HOST_REPLAY_DECK_STEPS_HPP

#include <vector>

#include "scenario.hpp"
#include "toml_reader.hpp"

namespace lode::host {

// Groups are written out: the result is one flat list. Field variables that only steps mention are added to `analysis`.
std::vector<Step> read_steps(TableReader& deck, const Layout& layout, AnalysisSpec& analysis);

}  // namespace lode::host

#endif
