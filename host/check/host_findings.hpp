// Mistakes of a host, seen in a recording of its calls.
#ifndef LODE_HOST_CHECK_HOST_FINDINGS_HPP
#define LODE_HOST_CHECK_HOST_FINDINGS_HPP

#include "../rerun/recording.hpp"
#include "run.hpp"

namespace lode::host {

// One result for each kind of mistake, with the numbers of the calls.
SubjectReport check_host(const Recording& recording, const std::string& path);

}  // namespace lode::host

#endif
