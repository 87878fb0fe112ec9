// `lode check`: is this UMAT or VUMAT right, and if not, what is wrong with it?
#ifndef LODE_HOST_CHECK_COMMAND_HPP
#define LODE_HOST_CHECK_COMMAND_HPP

#include <optional>
#include <string>
#include <vector>

#include "../replay/analysis.hpp"
#include "../status.hpp"

namespace lode::host {

struct CheckOptions {
    std::string library;
    std::string model;  // KEYWORD or KEYWORD-LABEL of a library that describes its models
    bool all = false;   // all of them
    std::string card;   // Abaqus input file
    std::string name;   // CMNAME, or which material of the input file
    std::vector<double> constants, initial_state;
    std::vector<std::string> kinds;
    std::optional<int> state_variables;
    double element_length = 1, temperature = 0, scale = 0;
    bool elastic = false, unsymmetric = false;
    std::vector<std::string> only;
    std::optional<Entry> entry;
    double seconds = 10;
    std::string host;  // a recording: check the host instead
    bool salvage = false;
    std::string json, html;
    bool list = false, quiet = false;
};
// failed_check if a check failed. Errors are thrown as Failure.
Status check(const CheckOptions& options);

// The checks at exactly a recorded call, the last one if none is named.
struct RecordedCheckOptions {
    std::string recording, library;
    std::optional<int> at;
    double seconds = 10;
    bool salvage = false, quiet = false;
    std::string json, html;
};
Status check_recorded(const RecordedCheckOptions& options);

}  // namespace lode::host

#endif
