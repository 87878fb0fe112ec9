// A deck (TOML) becomes a scenario. docs/replay.md describes every key.
#ifndef LODE_HOST_REPLAY_DECK_HPP
#define LODE_HOST_REPLAY_DECK_HPP

#include <string>
#include <vector>

#include "scenario.hpp"

namespace lode::host {

// Throws BadDeck: file:line: key: what is wrong and what is legal.
Scenario read_deck(const std::string& path);

// Commands that take decks or materials: whether an argument is a deck, and the decks among the arguments, each under a
// name that tells it from others. Decks are mostly called deck.toml; then it is that of the directory. `library`, if
// empty, becomes the first library that a deck names.
bool is_deck(const std::string& argument);
std::vector<Scenario> decks_among(const std::vector<std::string>& arguments, std::string& library);

}  // namespace lode::host

#endif
