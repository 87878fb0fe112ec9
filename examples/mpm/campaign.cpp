#include "campaign.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <mutex>
#include <thread>

namespace mpm {

namespace {

// Points times steps.
double cost(const Settings& s) { return s.steps() / (s.h * s.h); }

// One line on a terminal, rewritten; a line a run elsewhere.
class Progress {
  public:
    Progress(double total_cost, std::size_t runs) : total_(total_cost), runs_(runs), terminal_(isatty(2) == 1) {}

    void advance(double by) {
        const std::lock_guard lock(mutex_);
        done_ += by;
        const auto now = std::chrono::steady_clock::now();
        if (!terminal_ || now - shown_ < std::chrono::milliseconds(300)) return;
        shown_ = now;
        const double part = done_ / total_, elapsed = std::chrono::duration<double>(now - start_).count();
        std::fprintf(stderr, "\r\033[K%3.0f %%, %.0f s left", 100.0 * part, elapsed * (1.0 / part - 1.0));
    }
    void finished(const Result& r) {
        const std::lock_guard lock(mutex_);
        std::fprintf(stderr, "%s[%2zu/%zu] %-44s %6.1f s   W_f %.5f J\n", terminal_ ? "\r\033[K" : "", ++finished_,
                     runs_, r.settings.name().c_str(), r.seconds, r.end().work);
    }

  private:
    std::mutex mutex_;
    double total_, done_ = 0.0;
    std::size_t runs_, finished_ = 0;
    bool terminal_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now(), shown_ = start_;
};

}  // namespace

void Campaign::add(const Settings& settings) {
    const auto same = [&](const Settings& s) { return s.name() == settings.name(); };
    if (!has(settings) && std::none_of(waiting_.begin(), waiting_.end(), same)) waiting_.push_back(settings);
}

void Campaign::run(int at_a_time) {
    const auto start = std::chrono::steady_clock::now();
    // The longest first, so that no thread is left with one.
    std::stable_sort(waiting_.begin(), waiting_.end(),
                     [](const Settings& a, const Settings& b) { return cost(a) > cost(b); });
    double total = 0.0;
    for (const Settings& s : waiting_) total += cost(s);
    Progress progress(total, waiting_.size());
    std::vector<Result> results(waiting_.size());
    std::atomic<std::size_t> next = 0;
    const auto work = [&] {
        for (std::size_t i = next++; i < waiting_.size(); i = next++) {
            double before = 0.0;
            results[i] = simulate(waiting_[i], snapshots_at, [&](double part) {
                progress.advance((part - before) * cost(waiting_[i]));
                before = part;
            });
            progress.finished(results[i]);
        }
    };
    {
        std::vector<std::jthread> others;
        for (int i = 1; i < at_a_time; ++i) others.emplace_back(work);
        work();
    }
    for (Result& r : results) results_.emplace(r.settings.name(), std::move(r));
    waiting_.clear();
    seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace mpm
