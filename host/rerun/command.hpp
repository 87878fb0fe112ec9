// `lode rerun`: the calls that a real host made, once more.
#ifndef LODE_HOST_RERUN_COMMAND_HPP
#define LODE_HOST_RERUN_COMMAND_HPP

#include <optional>
#include <string>

#include "../status.hpp"

namespace lode::host {

struct RerunOptions {
    std::string file, library;
    std::optional<int> at;              // show this call (from 1) in full
    std::string deck;                   // write the history of the point as this deck
    std::string plot;                   // draw it: stem of the files
    std::optional<int> element, point;  // which point; default: that of the first call
    bool time = false;
    bool salvage = false;
    bool quiet = false;
};

// success if every call gives the recorded outputs bit for bit, else different. Errors are thrown as Failure.
Status rerun(const RerunOptions& options);

}  // namespace lode::host

#endif
