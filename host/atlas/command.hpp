// `lode atlas`: where methods fail, as maps.
#ifndef LODE_HOST_ATLAS_COMMAND_HPP
#define LODE_HOST_ATLAS_COMMAND_HPP

#include <string>
#include <vector>

#include "../status.hpp"

namespace lode::host {

struct AtlasOptions {
    std::vector<std::string> targets;  // decks; KEYWORD or KEYWORD-LABEL
    bool all = false;                  // every material of the library
    bool first = false;                // only the first sample of each model
    std::vector<std::string> maps;     // empty: all that make sense for the material
    std::string library, output_directory = ".";
    std::vector<std::string> kinds;  // empty: that of a deck, the fullest of a material
    bool quiet = false;
};

std::vector<std::string> atlas_maps();
Status atlas(const AtlasOptions& options);

}  // namespace lode::host

#endif
