// What the tests of the host share: decks as text, runs with all their records.
#pragma once

#include <gtest/gtest.h>

#include <unistd.h>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "guard.hpp"
#include "library.hpp"
#include "replay/deck.hpp"
#include "replay/driver.hpp"

namespace lode::host::test {

// A directory of its own for the test that is running, gone afterwards.
class Directory {
  public:
    Directory() {
        const auto* info = testing::UnitTest::GetInstance()->current_test_info();
        std::string name = std::string(info->test_suite_name()) + "." + info->name() + "." + std::to_string(getpid());
        for (char& c : name)
            if (c == '/') c = '_';
        path_ = std::filesystem::temp_directory_path() / ("lode-" + name);
        std::filesystem::create_directories(path_);
    }
    ~Directory() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    Directory(const Directory&) = delete;
    Directory& operator=(const Directory&) = delete;

    std::string file(const std::string& name) const { return (path_ / name).string(); }
    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(file(name)) << text;
        return file(name);
    }
    std::string read(const std::string& name) const {
        std::ostringstream text;
        text << std::ifstream(file(name)).rdbuf();
        return text.str();
    }

  private:
    std::filesystem::path path_;
};

struct Snapshot {
    int step, increment, iterations;
    double dtime;
    PointState point;
};
struct History {
    Scenario scenario;
    Outcome outcome;
    std::vector<Snapshot> records;

    const PointState& end() const { return records.back().point; }
    double stress(int i) const { return end().stress[i]; }
    double strain(int i) const { return end().strain[i]; }
    double state(std::size_t i) const { return end().state[i]; }
};

inline Scenario scenario_of(const std::string& deck) {
    const Directory directory;
    return read_deck(directory.write("deck.toml", deck));
}

inline History run_scenario(Scenario scenario, const std::string& library_path = HOST_TEST_LIBRARY) {
    install_utility_handlers();
    const Library library(library_path);
    History run;
    resolve(scenario, library);
    run.outcome = drive(scenario, library, [&run](const Record& r) {
        run.records.push_back({r.step, r.increment, r.iterations, r.dtime, r.point});
    });
    run.scenario = std::move(scenario);
    return run;
}

inline History run_deck(const std::string& deck) { return run_scenario(scenario_of(deck)); }

// As above, and the run has to reach its end.
inline History finished_run(const std::string& deck) {
    History run = run_deck(deck);
    EXPECT_EQ(run.outcome.status, Status::success) << run.outcome.message;
    return run;
}

}  // namespace lode::host::test
