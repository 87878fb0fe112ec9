// `lode replay`: a deck in; a CSV file, plots and a summary out.
#ifndef LODE_HOST_REPLAY_COMMAND_HPP
#define LODE_HOST_REPLAY_COMMAND_HPP

#include <optional>
#include <string>

#include "../status.hpp"
#include "analysis.hpp"

namespace lode::host {

struct ReplayOptions {
    std::string deck, library, output_directory = ".";
    std::optional<Entry> entry;  // instead of the deck's
    bool quiet = false;
    bool verify = false;  // compare manufactured steps with their closed forms
};

// Errors of deck and library are thrown as Failure.
Status replay(const ReplayOptions& options);

}  // namespace lode::host

#endif
