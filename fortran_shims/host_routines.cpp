// Messages, the end of an analysis, names, processes, threads and mutexes: XIT, STDB_ABQERR, GETJOBNAME, GETRANK,
// get_thread_id, MutexInit and their Explicit twins.
#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <string>
#include <string_view>
#include <system_error>

#include "utility_host.h"
#include "utility_state.hpp"

namespace {

std::atomic<void (*)(int, const char*)> message_handler{nullptr};
std::atomic<void (*)()> exit_handler{nullptr};
std::atomic<int> process_rank{0}, process_count{1}, thread_count{1};
std::atomic<std::size_t> real_bytes{sizeof(double)};

// Fixed storage: the names can be asked for from any thread and until the very end of the process.
struct Name {
    std::array<char, 256> text = {};
    void set(const char* value) {
        const std::size_t n = std::min(std::strlen(value), text.size() - 1);
        std::copy_n(value, n, text.begin());
        text[n] = '\0';
    }
    std::string_view view() const { return text.data(); }
};
Name job_name{{"lode"}};
Name output_directory;

constexpr int information = 1, warning = -1, error = -2, fatal = -3;

void report(int severity, const std::string& text) {
    if (auto* const handler = message_handler.load()) {
        handler(severity, text.c_str());
        return;
    }
    const char* const label = severity == information ? "note" : severity == warning ? "warning" : "error";
    std::fprintf(stderr, "%s: %s\n", label, text.c_str());
}

// An exception thrown by the handler must reach the host, so neither this nor its callers are noexcept.
[[noreturn]] void end_analysis() {
    if (auto* const handler = exit_handler.load()) handler();
    std::fflush(nullptr);
    std::exit(4);
}

std::string_view trimmed(std::string_view text) {
    text = text.substr(0, text.find('\0'));
    const auto last = text.find_last_not_of(' ');
    return last == std::string_view::npos ? std::string_view{} : text.substr(0, last + 1);
}

constexpr std::size_t character_entry = 8;  // CHARV is an array of CHARACTER*8

// %I, %R and %S take the next entry of INTV, REALV and CHARV; any other text is copied.
template <class Real>
std::string expand(std::string_view pattern, const int* intv, const Real* realv, const char* charv) {
    std::string text;
    for (std::size_t i = 0; i < pattern.size(); ++i) {
        const char code = pattern[i] == '%' && i + 1 < pattern.size() ? pattern[i + 1] : '\0';
        if (code == 'I' || code == 'i') {
            text += std::to_string(*intv++);
        } else if (code == 'R' || code == 'r') {
            char buffer[40];
            std::snprintf(buffer, sizeof buffer, "%.9g", static_cast<double>(*realv++));
            text += buffer;
        } else if (code == 'S' || code == 's') {
            text += trimmed({charv, character_entry});
            charv += character_entry;
        } else {
            text += pattern[i];
            continue;
        }
        ++i;
    }
    return text;
}

template <class Real>
void message(int lop, std::string_view pattern, const int* intv, const Real* realv, const char* charv) {
    const int severity = lop == information || lop == warning || lop == error ? lop : fatal;
    report(severity, expand(trimmed(pattern), intv, realv, charv));
    if (severity == fatal) end_analysis();
}

// Blank padded, as a Fortran CHARACTER variable is.
void answer(std::string_view value, char* text, int* length, std::size_t capacity) {
    const std::size_t n = std::min(value.size(), capacity);
    std::copy_n(value.begin(), n, text);
    std::fill(text + n, text + capacity, ' ');
    *length = static_cast<int>(n);
}

std::string_view directory() {
    static const Name working_directory = [] {
        std::error_code failed;
        const auto path = std::filesystem::current_path(failed);
        Name name;
        name.set(failed ? "." : path.c_str());
        return name;
    }();
    return output_directory.view().empty() ? working_directory.view() : output_directory.view();
}

// In order of first use: the first thread that asks is 0.
int thread_id() {
    static std::atomic<int> next{0};
    thread_local const int id = next.fetch_add(1);
    return id;
}

constexpr int mutex_count = 100;

std::mutex& user_mutex(const char* routine, int id) {
    static std::array<std::mutex, mutex_count> mutexes;
    if (id < 1 || id > mutex_count) {
        report(fatal,
               std::string(routine) + ": mutex " + std::to_string(id) + " is not in 1.." + std::to_string(mutex_count));
        end_analysis();
    }
    return mutexes[static_cast<std::size_t>(id - 1)];
}

}  // namespace

namespace lode::utility {

std::size_t explicit_real_bytes() { return real_bytes.load(std::memory_order_relaxed); }

}  // namespace lode::utility

extern "C" {

void lode_utility_on_message(void (*handler)(int severity, const char* text)) { message_handler = handler; }
void lode_utility_on_exit(void (*handler)(void)) { exit_handler = handler; }
void lode_utility_set_job_name(const char* name) { job_name.set(name); }
void lode_utility_set_output_directory(const char* path) { output_directory.set(path); }
void lode_utility_set_processes(int rank, int count) {
    process_rank = rank;
    process_count = count;
}
void lode_utility_set_threads(int count) { thread_count = count; }
void lode_utility_set_explicit_real(int bytes) { real_bytes = bytes == 4 ? sizeof(float) : sizeof(double); }

void xit_() { end_analysis(); }
void xplb_exit_() { end_analysis(); }

void stdb_abqerr_(const int* lop, const char* string, const int* intv, const double* realv, const char* charv,
                  std::size_t string_length, std::size_t) {
    message(*lop, {string, string_length}, intv, realv, charv);
}

void xplb_abqerr_(const int* lop, const char* string, const int* intv, const void* realv, const char* charv,
                  std::size_t string_length, std::size_t) {
    if (lode::utility::explicit_real_bytes() == sizeof(float))
        message(*lop, {string, string_length}, intv, static_cast<const float*>(realv), charv);
    else message(*lop, {string, string_length}, intv, static_cast<const double*>(realv), charv);
}

void getjobname_(char* text, int* length, std::size_t capacity) { answer(job_name.view(), text, length, capacity); }
void vgetjobname_(char* text, int* length, std::size_t capacity) { answer(job_name.view(), text, length, capacity); }
void getoutdir_(char* text, int* length, std::size_t capacity) { answer(directory(), text, length, capacity); }
void vgetoutdir_(char* text, int* length, std::size_t capacity) { answer(directory(), text, length, capacity); }

void getrank_(int* rank) { *rank = process_rank; }
void vgetrank_(int* rank) { *rank = process_rank; }
void getnumcpus_(int* count) { *count = process_count; }
void vgetnumcpus_(int* count) { *count = process_count; }
int getnumthreads_() { return thread_count; }
int get_thread_id_() { return thread_id(); }

void mutexinit_(const int* id) { user_mutex("MutexInit", *id); }
void mutexlock_(const int* id) { user_mutex("MutexLock", *id).lock(); }
void mutexunlock_(const int* id) { user_mutex("MutexUnlock", *id).unlock(); }

}  // extern "C"
