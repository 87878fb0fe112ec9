#include "errors.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <cstdlib>

#include "record/recorder.hpp"

// The host's utility routines; present only inside a host (90-real-hosts), hence weak.
extern "C" {
[[gnu::weak]] void xit_();
[[gnu::weak]] void xplb_exit_();
[[gnu::weak]] void stdb_abqerr_(const int* severity, const char* text, const int* integers, const double* reals,
                                const char* strings, std::size_t text_length, std::size_t string_length);
[[gnu::weak]] void xplb_abqerr_(const int* severity, const char* text, const int* integers, const double* reals,
                                const char* strings, std::size_t text_length, std::size_t string_length);
}

namespace lode {
namespace {

constexpr int severity_warning = -1, severity_error = -2;
constexpr std::size_t longest_message = 500;  // what the hosts' message routines take

void print(HostProgram host, int severity, const std::string& message) {
    const bool is_explicit = host == HostProgram::explicit_;
    const auto routine =
        is_explicit ? (xplb_abqerr_ ? xplb_abqerr_ : stdb_abqerr_) : (stdb_abqerr_ ? stdb_abqerr_ : xplb_abqerr_);
    std::string text = "Lode: " + message;
    if (routine == nullptr) {
        std::fprintf(stderr, "%s%s\n", severity == severity_warning ? "WARNING: " : "ERROR: ", text.c_str());
        return;
    }
    std::replace(text.begin(), text.end(), '%', '/');  // these routines read %I, %R and %S as formats
    if (text.size() > longest_message) text.resize(longest_message);
    const int no_integer = 0;
    const double no_real = 0.0;
    const char no_string[9] = "        ";
    routine(&severity, text.c_str(), &no_integer, &no_real, no_string, text.size(), 8);
}

}  // namespace

void report_warning(HostProgram host, const std::string& message) { print(host, severity_warning, message); }

void report_error_and_stop(HostProgram host, const std::string& message) {
    if (record::active) record::ending();
    print(host, severity_error, message);
    const bool is_explicit = host == HostProgram::explicit_;
    const auto stop = is_explicit ? (xplb_exit_ ? xplb_exit_ : xit_) : (xit_ ? xit_ : xplb_exit_);
    if (stop != nullptr) {
        stop();
        return;
    }
    // Other threads may still be inside the library: end without running destructors.
    std::fflush(nullptr);
    std::_Exit(exit_status_bad_input);
}

}  // namespace lode
