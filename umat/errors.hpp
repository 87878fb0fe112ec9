// How the library talks to the user of a host: through the host's own routines where the process has them.
#pragma once

#include <string>

namespace lode {

enum class HostProgram { standard, explicit_ };  // which twin of the utility routines to call

// Exit status of a process whose host offers no way to end an analysis (EX_DATAERR).
inline constexpr int exit_status_bad_input = 65;

void report_warning(HostProgram host, const std::string& message);
// Prints the message and ends the analysis. Returns only in a host whose exit routine returns (a test); the caller then
// leaves every array as it is.
void report_error_and_stop(HostProgram host, const std::string& message);

}  // namespace lode
