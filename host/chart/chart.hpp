// Accuracy against cost of one scene: every algorithm, interface, precision and kind over the number of increments.
#ifndef LODE_HOST_CHART_CHART_HPP
#define LODE_HOST_CHART_CHART_HPP

#include <optional>
#include <string>
#include <vector>

#include "../study/cost.hpp"
#include "../study/libraries.hpp"
#include "../study/meter.hpp"
#include "../study/reference.hpp"

namespace lode::host {

// One run of the scene.
struct ChartPoint {
    int increments = 0;  // in a step
    Trace trace;
    double error = 0;        // against the reference of the series
    double dissipation = 0;  // error of SPD + SCD
    Cost cost;
    bool best = false;  // on the Pareto front: nothing else is both cheaper and more accurate

    bool usable() const { return trace.complete(); }
};

// Runs that differ in the number of increments only.
struct Series {
    Kind kind = Kind::solid;
    Entry entry = Entry::umat;
    Precision precision = Precision::double_;
    std::string algorithm;  // empty if the library does not say
    double claimed_order = 0;
    bool own_law =
        false;         // the algorithm tends to another solution than the reference; errors are against its own limit
    double floor = 0;  // of its errors: what the reference has, and the host's tolerance of prescribed stresses
    std::vector<ChartPoint> points;
    std::optional<double> order;              // fitted; none where the errors are at the floor
    std::optional<double> dissipation_order;  // of SPD + SCD
    std::string failure;                      // why there are no points

    double largest_error() const;
    double largest_dissipation_error() const;
    // Errors up to this one are those of rounding, of the host's tolerance or of the reference.
    double exact_enough() const;
    std::string interface_name() const;  // "UMAT", "VUMAT", "VUMAT single"
};

struct Chart {
    std::string title, stem;
    Reference reference;
    std::string reference_algorithm;
    std::vector<Series> series;
};

struct ChartSettings {
    std::vector<int> increments{1, 2, 4, 8, 16, 32, 64, 128};  // in a step
    std::optional<std::vector<Kind>> kinds;                    // none: all that the path allows
    bool cost = true;
    bool vumat = true;
    int repetitions = usual_repetitions;
};

// The scenario has not been resolved. Throws Refused if its own setting cannot be run.
Chart make_chart(const Scenario& scenario, const Libraries& libraries, const ChartSettings& settings, Meter* meter);
// Runs that make_chart announces to the meter, at most.
int chart_runs(const Scenario& scenario, const Libraries& libraries, const ChartSettings& settings);

// "order 0.98, claimed 1", or "exact: at most 3e-16".
std::string order_text(const Series& series);

}  // namespace lode::host

#endif
