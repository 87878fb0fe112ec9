// A deck (TOML) becomes a scenario. docs/replay.md describes every key.
#ifndef LODE_HOST_REPLAY_DECK_HPP
#define LODE_HOST_REPLAY_DECK_HPP

#include <string>

#include "scenario.hpp"

namespace lode::host {

// Throws BadDeck: file:line: key: what is wrong and what is legal.
Scenario read_deck(const std::string& path);

// Commands that take decks or materials: whether an argument is a deck, and the deck under a name that tells it from
// others. Decks are mostly called deck.toml; then it is that of the directory.
bool is_deck(const std::string& argument);
Scenario read_named_deck(const std::string& path);

}  // namespace lode::host

#endif
