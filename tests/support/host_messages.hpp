// The test process plays a host: it has XIT, STDB_ABQERR and their explicit twins, which record and return. Refusals of
// the library can thus be looked at without ending the process.
#pragma once

#include <string>
#include <vector>

namespace lode::test {

// What this thread has been told since the last clear.
struct HostMessages {
    std::vector<std::string> errors, warnings;
    int stops = 0;           // calls of XIT or XPLB_EXIT
    int explicit_calls = 0;  // of XPLB_ABQERR and XPLB_EXIT among all
};
HostMessages& captured_messages();
void clear_captured_messages();

}  // namespace lode::test
