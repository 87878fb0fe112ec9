// A deck (TOML) becomes a scenario. docs/replay.md describes every key.
#ifndef LODE_HOST_REPLAY_DECK_HPP
#define LODE_HOST_REPLAY_DECK_HPP

#include <string>

#include "scenario.hpp"

namespace lode::host {

// Throws BadDeck: file:line: key: what is wrong and what is legal.
Scenario read_deck(const std::string& path);

}  // namespace lode::host

#endif
