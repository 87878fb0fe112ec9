#include "host_messages.hpp"

#include <cstddef>

namespace lode::test {

HostMessages& captured_messages() {
    thread_local HostMessages messages;
    return messages;
}
void clear_captured_messages() { captured_messages() = {}; }

}  // namespace lode::test

// Exported from the executable, so that the library's weak references find them.
extern "C" {

[[gnu::visibility("default")]] void xit_();
[[gnu::visibility("default")]] void xplb_exit_();
[[gnu::visibility("default")]] void stdb_abqerr_(const int*, const char*, const int*, const double*, const char*,
                                                 std::size_t, std::size_t);
[[gnu::visibility("default")]] void xplb_abqerr_(const int*, const char*, const int*, const double*, const char*,
                                                 std::size_t, std::size_t);

void xit_() { ++lode::test::captured_messages().stops; }
void xplb_exit_() {
    ++lode::test::captured_messages().explicit_calls;
    xit_();
}
void stdb_abqerr_(const int* severity, const char* text, const int*, const double*, const char*, std::size_t length,
                  std::size_t) {
    auto& messages = lode::test::captured_messages();
    (*severity == -1 ? messages.warnings : messages.errors).emplace_back(text, length);
}
void xplb_abqerr_(const int* severity, const char* text, const int* integers, const double* reals, const char* strings,
                  std::size_t length, std::size_t string_length) {
    ++lode::test::captured_messages().explicit_calls;
    stdb_abqerr_(severity, text, integers, reals, strings, length, string_length);
}
}
