#include "guard.hpp"

#include <csetjmp>
#include <cstdio>
#include <cstdlib>

#ifdef LODE_HOST_HAS_UTILITY
#include "utility_host.h"
#endif

namespace lode::host {
namespace {

constexpr int printed_messages = 50;

// One analysis a thread: a library that exits does so on the thread that called it.
thread_local std::jmp_buf* landing = nullptr;
thread_local std::string last_error;
thread_local int mute_count = 0;

#ifdef LODE_HOST_HAS_UTILITY
void on_message(int severity, const char* text) {
    static int count = 0;
    if (severity <= -2) last_error = text;
    if (mute_count > 0) return;
    if (++count > printed_messages && severity > -3) {
        if (count == printed_messages + 1) std::fprintf(stderr, "library: further messages are not shown\n");
        return;
    }
    const char* const label = severity == 1 ? "note" : severity == -1 ? "warning" : "error";
    std::fprintf(stderr, "library: %s: %s\n", label, text);
}

void on_exit() {
    if (landing != nullptr) std::longjmp(*landing, 1);
    std::exit(4);
}
#endif

}  // namespace

Muted::Muted() { ++mute_count; }
Muted::~Muted() { --mute_count; }

void install_utility_handlers() {
#ifdef LODE_HOST_HAS_UTILITY
    lode_utility_on_message(&on_message);
    lode_utility_on_exit(&on_exit);
#endif
}

void set_job([[maybe_unused]] const std::string& name, [[maybe_unused]] const std::string& output_directory) {
#ifdef LODE_HOST_HAS_UTILITY
    lode_utility_set_job_name(name.c_str());
    lode_utility_set_output_directory(output_directory.c_str());
#endif
}

bool run_guarded(void (*call)(void*), void* data) {
    std::jmp_buf here;
    std::jmp_buf* const outer = landing;
    landing = &here;
    // No local changes between setjmp and longjmp, so none is indeterminate afterwards.
    if (setjmp(here) == 0) {
        call(data);
        landing = outer;
        return true;
    }
    landing = outer;
    return false;
}

const std::string& last_library_error() { return last_error; }

}  // namespace lode::host
