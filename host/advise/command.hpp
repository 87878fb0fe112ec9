// `lode advise`: the cheapest setting of the user's own scene that meets a tolerance.
#ifndef LODE_HOST_ADVISE_COMMAND_HPP
#define LODE_HOST_ADVISE_COMMAND_HPP

#include <string>

#include "../status.hpp"

namespace lode::host {

struct AdviseOptions {
    std::string deck, library, single_library;
    std::string output_directory;  // empty: no files
    double tolerance = 1e-3;
    bool quiet = false;
};

// not_converged if nothing that was run meets the tolerance.
Status advise(const AdviseOptions& options);

}  // namespace lode::host

#endif
