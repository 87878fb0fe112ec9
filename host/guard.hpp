// Calls into a library that may end the analysis: XIT and XPLB_EXIT come back here instead of ending the process.
#ifndef LODE_HOST_GUARD_HPP
#define LODE_HOST_GUARD_HPP

#include <string>

namespace lode::host {

// Takes over the utility routines' messages and exits. Call once, before the first library is loaded.
void install_utility_handlers();

// What GETJOBNAME and GETOUTDIR answer.
void set_job(const std::string& name, const std::string& output_directory);

// Runs `call`; false if the library asked for the end of the analysis meanwhile. The library's stack frames are
// then left without unwinding, as they would be in a host whose XIT does not return.
bool run_guarded(void (*call)(void*), void* data);

template <class Call>
bool guarded(Call&& call) {
    return run_guarded([](void* data) { (*static_cast<std::remove_reference_t<Call>*>(data))(); }, &call);
}

// While it lives, this thread's messages of the library are kept but not printed: for calls that are expected to be
// refused.
class Muted {
  public:
    Muted();
    ~Muted();
    Muted(const Muted&) = delete;
    Muted& operator=(const Muted&) = delete;
};

// The last message of severity error or worse since the start, for reports; empty if there was none.
const std::string& last_library_error();

}  // namespace lode::host

#endif
