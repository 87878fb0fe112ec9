// The same call gives the same answer, whatever was called before, and whoever calls at the same time.
#include <dlfcn.h>
#include <fmt/format.h>
#include <link.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <mutex>
#include <thread>

#include "checks.hpp"
#include "child.hpp"

namespace lode::host {
namespace {

// The writable memory of a loaded library: variables that are SAVE, COMMON, static or global.
class StaticMemory {
  public:
    explicit StaticMemory(const std::string& library) : library_(library) {
        dl_iterate_phdr(
            [](dl_phdr_info* info, std::size_t, void* self) {
                static_cast<StaticMemory*>(self)->add(*info);
                return 0;
            },
            this);
    }
    // Byte by byte, what an address sanitizer has put between the variables included.
    [[gnu::no_sanitize_address]] void keep() {
        std::size_t size = 0;
        for (const Part& p : parts_) size += p.size;
        copy_.resize(size);
        char* to = copy_.data();
        for (const Part& p : parts_)
            for (std::size_t i = 0; i < p.size; ++i) *to++ = p.start[i];
    }
    // Where the first byte has changed since: the symbol if it has a public one, else its place. Empty if none has.
    [[gnu::no_sanitize_address]] std::string change() const {
        std::size_t copied = 0;
        for (const Part& p : parts_) {
            for (std::size_t i = 0; i < p.size; ++i) {
                if (p.start[i] == copy_[copied + i]) continue;
                Dl_info info{};
                if (dladdr(const_cast<const char*>(p.start + i), &info) != 0 && info.dli_sname != nullptr)
                    return info.dli_sname;
                return fmt::format("address {:#x} of the library",
                                   reinterpret_cast<std::uintptr_t>(p.start + i) - p.base);
            }
            copied += p.size;
        }
        return {};
    }

  private:
    struct Part {
        const volatile char* start;
        std::size_t size;
        std::uintptr_t base;
    };
    void add(const dl_phdr_info& info) {
        if (info.dlpi_name == nullptr || library_ != info.dlpi_name) return;
        for (int i = 0; i < info.dlpi_phnum; ++i) {
            const auto& header = info.dlpi_phdr[i];
            if (header.p_type != PT_LOAD || (header.p_flags & PF_W) == 0) continue;
            // The loader gives addresses as numbers. NOLINTNEXTLINE(performance-no-int-to-ptr)
            const auto* const start = reinterpret_cast<const volatile char*>(info.dlpi_addr + header.p_vaddr);
            parts_.push_back({start, header.p_memsz, info.dlpi_addr});
        }
    }

    std::string library_;
    std::vector<Part> parts_;
    std::vector<char> copy_;
};

// What a call leaves behind although the library has seen everything before; empty if nothing.
std::string static_change(const Subject& subject, const std::vector<Situation>& situations) {
    Bench bench(subject);
    StaticMemory memory(subject.library->path());
    for (const Situation& s : situations) bench.call(s.call);
    for (const Situation& s : situations) {
        memory.keep();
        bench.call(s.call);
        std::string change = memory.change();
        if (!change.empty()) return change;
    }
    return {};
}

}  // namespace

void check_determinism(const Subject& subject, CheckResult& result) {
    Bench bench(subject);
    const std::vector<Situation> situations = bench.situations();
    if (situations.empty()) return result.skip("no increment of the path could be done");
    int calls = 0;
    std::string repeated, order;
    std::vector<UmatAnswer> forward;
    for (const Situation& s : situations) {
        doing("the same call twice at " + where(s));
        UmatAnswer a = bench.call(s.call);
        const UmatAnswer b = bench.call(s.call);
        calls += 2;
        if (repeated.empty() && !identical(a, b))
            repeated =
                fmt::format("{} differs in the second of two equal calls at {}", first_difference(a, b), where(s));
        forward.push_back(std::move(a));
    }
    // Other points in between, and the other way round.
    for (std::size_t k = situations.size(); k-- > 0;) {
        doing("the calls in another order at " + where(situations[k]));
        const UmatAnswer again = bench.call(situations[k].call);
        ++calls;
        if (order.empty() && !identical(forward[k], again))
            order = fmt::format("{} depends on the calls before, at {}", first_difference(forward[k], again),
                                where(situations[k]));
    }
    result.figures = fmt::format("{} calls repeated, also in another order", calls);
    if (!repeated.empty() || !order.empty()) result.fail("hidden-state", repeated.empty() ? order : repeated);
}

void check_constants(const Subject& subject, CheckResult& result) {
    // A library that keeps the constants of its first call gives them to the second material as well. What is right
    // is what a fresh process answers.
    Bench bench(subject);
    if (subject.constants.empty()) return result.skip("there are no constants");
    const CheckedState start = bench.start();
    Random random(5);
    const UmatCall first = bench.call_for(
        start, {random.direction(bench.layout().size()) * (0.1 * subject.scale), Matrix3::Identity(), 1});
    UmatCall second = first;
    second.props[0] *= 1.01;
    const auto answer_text = [](const UmatAnswer& a) {
        std::string text(a.returned ? "1" : "0");
        text.append(reinterpret_cast<const char*>(a.stress.data()),
                    static_cast<std::size_t>(a.stress.size()) * sizeof(double));
        return text;
    };
    // Bench::start has called the library already where the library describes its models; there the second process
    // differs in nothing from the first.
    const std::string fresh = [&] {
        const ChildEnd end = in_child(
            [&] {
                doing("the first constant changed by 1 %");
                return answer_text(bench.call(second));
            },
            5);
        return end.how == ChildEnd::How::answered ? end.answer : std::string();
    }();
    if (fresh.empty() || fresh[0] == '0') return result.skip("the library refuses the constants that differ by 1 %");
    doing("two materials in turn");
    const UmatAnswer before = bench.call(first), other = bench.call(second), after = bench.call(first);
    result.figures = "two materials of the same name whose first constants differ by 1 %, in turn";
    if (answer_text(other) != fresh)
        result.fail("stale-constants", "the second material answers with what the first one left behind");
    else if (!identical(before, after))
        result.fail("hidden-state", "the second material changes the first one's answer");
}

void check_threads(const Subject& subject, CheckResult& result) {
    std::vector<Situation> situations;
    {
        Bench bench(subject);
        situations = bench.situations();
        // Answers at rest, in case those of the path carry a memory of it.
        for (Situation& s : situations) s.answer = bench.call(s.call);
    }
    if (situations.size() < 2) return result.skip("no two increments of the path could be done");
    constexpr int threads = 2;
    constexpr double seconds = 0.25;
    std::atomic<long> calls{0};
    std::atomic<bool> go{false}, stop{false};
    std::mutex mutex;
    std::string difference;
    doing("two threads at the same time");
    const auto work = [&](int thread) {
        Bench bench(subject);
        long own = 0;
        while (!go.load()) {
        }
        while (!stop.load(std::memory_order_relaxed)) {
            const std::size_t k =
                (static_cast<std::size_t>(own) + static_cast<std::size_t>(thread) * situations.size() / threads) %
                situations.size();
            const UmatAnswer answer = bench.call(situations[k].call);
            ++own;
            if (identical(answer, situations[k].answer)) continue;
            const std::lock_guard lock(mutex);
            if (difference.empty())
                difference = fmt::format("{} differs at {}", first_difference(answer, situations[k].answer),
                                         where(situations[k]));
            stop = true;
        }
        calls += own;
    };
    std::vector<std::thread> running;
    for (int t = 0; t < threads; ++t) running.emplace_back(work, t);
    go = true;
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (!stop && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    stop = true;
    for (std::thread& t : running) t.join();
    result.figures = fmt::format("{} calls in two threads", calls.load());
    if (!difference.empty()) return result.fail("thread-race", difference);
    const std::string change = static_change(subject, situations);
    if (!change.empty()) result.warn("writes-static-memory", "changed by an ordinary call: " + change);
}

}  // namespace lode::host
