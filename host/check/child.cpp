#include "child.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <exception>

#include "../status.hpp"
#include "../text.hpp"

namespace lode::host {
namespace {

constexpr std::size_t activity_size = 1024, shown_output = 300;
// Marks at the end of an answer tell it from the exit of a library that closes nothing.
constexpr std::string_view whole_mark = "\nwhole", thrown_mark = "\nthrown";

// Shared with the parent, so that it outlives a crash.
char* activity_page() {
    static char* const page = [] {
        void* const memory = mmap(nullptr, activity_size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
        return memory == MAP_FAILED ? nullptr : static_cast<char*>(memory);
    }();
    return page;
}

void write_all(int file, const std::string& bytes) {
    for (std::size_t done = 0; done < bytes.size();) {
        const ssize_t n = write(file, bytes.data() + done, bytes.size() - done);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return;
        done += static_cast<std::size_t>(n);
    }
}

[[noreturn]] void be_the_child(const std::function<std::string()>& run, int answer, int output) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    // No core files and no core handlers: crashes are expected here.
    const rlimit no_core{};
    setrlimit(RLIMIT_CORE, &no_core);
    for (const int s : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) signal(s, SIG_DFL);
    if (output >= 0) {
        dup2(output, STDOUT_FILENO);
        dup2(output, STDERR_FILENO);
    }
    std::string bytes;
    try {
        bytes = run();
    } catch (const std::exception& error) {
        write_all(answer, error.what() + std::string(thrown_mark));
        _exit(0);
    }
    write_all(answer, bytes + std::string(whole_mark));
    _exit(0);
}

std::string tail_of(int file) {
    if (file < 0) return {};
    const off_t size = lseek(file, 0, SEEK_END);
    const off_t start = std::max<off_t>(0, size - static_cast<off_t>(shown_output));
    std::string text(static_cast<std::size_t>(std::max<off_t>(0, size - start)), '\0');
    const ssize_t n = pread(file, text.data(), text.size(), start);
    text.resize(static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
    for (char& c : text)
        if (c == '\n' || c == '\r' || c == '\t') c = ' ';
    return trimmed(text);
}

// Reads until the child closes the pipe; false if the time is up before.
bool read_answer(int file, double seconds, std::string& bytes) {
    using Clock = std::chrono::steady_clock;
    const auto deadline =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    char buffer[65536];
    while (true) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
        if (left <= 0) return false;
        pollfd waiting{file, POLLIN, 0};
        const int ready = poll(&waiting, 1, static_cast<int>(std::min<long>(left, 1000)));
        if (ready < 0 && errno != EINTR) return false;
        if (ready <= 0) continue;
        const ssize_t n = read(file, buffer, sizeof buffer);
        if (n == 0) return true;
        if (n > 0) bytes.append(buffer, static_cast<std::size_t>(n));
        else if (errno != EINTR) return true;
    }
}

}  // namespace

void doing(const std::string& what) {
    char* const page = activity_page();
    if (page == nullptr) return;
    const std::size_t size = std::min(what.size(), activity_size - 1);
    std::memcpy(page, what.data(), size);
    page[size] = '\0';
}

ChildEnd in_child(const std::function<std::string()>& run, double seconds) {
    doing("");
    // What is buffered here would be printed twice.
    std::fflush(nullptr);
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw Failure(Status::usage, "no pipe for a child process");
    const int output = memfd_create("output", MFD_CLOEXEC);
    const pid_t child = fork();
    if (child < 0) throw Failure(Status::usage, fmt::format("no child process: {}", std::strerror(errno)));
    if (child == 0) {
        close(ends[0]);
        be_the_child(run, ends[1], output);
    }
    close(ends[1]);
    ChildEnd end;
    const bool in_time = read_answer(ends[0], seconds, end.answer);
    close(ends[0]);
    if (!in_time) kill(child, SIGKILL);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    const char* const page = activity_page();
    if (page != nullptr) end.activity = page;
    end.output = tail_of(output);
    if (output >= 0) close(output);
    if (end.answer.ends_with(thrown_mark))
        throw Failure(Status::usage, end.answer.substr(0, end.answer.size() - thrown_mark.size()));
    const bool whole = end.answer.ends_with(whole_mark);
    if (!in_time) {
        end.how = ChildEnd::How::timed_out;
    } else if (WIFSIGNALED(status)) {
        end.how = ChildEnd::How::crashed;
        end.code = WTERMSIG(status);
    } else if (!whole) {
        end.how = ChildEnd::How::exited;
        end.code = WEXITSTATUS(status);
    }
    if (whole) end.answer.resize(end.answer.size() - whole_mark.size());
    return end;
}

std::string description(const ChildEnd& end, double seconds) {
    std::string text;
    switch (end.how) {
        case ChildEnd::How::answered:
            return "answered";
        case ChildEnd::How::crashed:
            text = fmt::format("ended by signal {} ({})", end.code, strsignal(end.code));
            break;
        case ChildEnd::How::exited:
            text = fmt::format("the process ended with status {}", end.code);
            break;
        case ChildEnd::How::timed_out:
            text = fmt::format("no answer within {} s", seconds);
            break;
    }
    if (!end.activity.empty()) text += " at: " + end.activity;
    if (!end.output.empty()) text += "; printed last: \"" + end.output + "\"";
    return text;
}

}  // namespace lode::host
