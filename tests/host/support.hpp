// What the tests of the host share: decks as text, runs with all their records.
#pragma once

#include <gtest/gtest.h>

#include <unistd.h>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "directory.hpp"
#include "guard.hpp"
#include "library.hpp"
#include "replay/deck.hpp"
#include "replay/driver.hpp"

namespace lode::host::test {

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
