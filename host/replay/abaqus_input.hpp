// Material cards of an Abaqus input file: *MATERIAL, *USER MATERIAL, *DEPVAR, *DENSITY, *EXPANSION.
#ifndef LODE_HOST_REPLAY_ABAQUS_INPUT_HPP
#define LODE_HOST_REPLAY_ABAQUS_INPUT_HPP

#include <optional>
#include <string>
#include <vector>

namespace lode::host {

struct MaterialCards {
    std::string name;  // upper case
    std::vector<double> constants;
    bool unsymmetric = false;
    std::optional<int> state_variables;
    std::optional<double> density;
    std::vector<double> expansion;  // none, one or three coefficients
};

// The materials of the file (and of the files it includes) that have a *USER MATERIAL card; all other cards are
// skipped. Throws BadDeck: file:line: card: message.
std::vector<MaterialCards> read_material_cards(const std::string& path);

}  // namespace lode::host

#endif
