// Every order that a description claims shows on the built-in paths; nothing here knows a model by name but the last
// tests, which hold one of them to its page.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "cards.hpp"
#include "chart/chart.hpp"
#include "chart/output.hpp"
#include "study.hpp"
#include "study/order.hpp"
#include "study/variants.hpp"
#include "support.hpp"

namespace lode::host::test {
namespace {

constexpr double order_tolerance = 0.25;  // of a slope that is fitted to increments which are not infinitely small

ChartSettings errors_only(const std::vector<int>& increments) {
    ChartSettings settings;
    settings.increments = increments;
    settings.cost = false;
    settings.vumat = false;
    return settings;
}

class ClaimedOrders : public testing::TestWithParam<const lode_model*> {};

// What the paths of a model have shown of one of its algorithms.
struct Shown {
    bool ran = false, measured = false;
    double best = 0;  // of the fitted orders
};

// Error-controlled algorithms show an order only where increments are smaller than their substeps, and energies of
// linked damages only where the shares of the directions hardly change in one: `finest` is false for a first look,
// after which failures call for a closer one. True if a closer look is wanted.
bool examine(const Chart& chart, std::map<std::string, Shown>& shown, bool at_corner, bool finest) {
    bool closer = false;
    for (const Series& series : chart.series) {
        Shown& algorithm = shown[series.algorithm];
        algorithm.ran = true;
        SCOPED_TRACE(chart.title + ", " + series.algorithm + ": " + order_text(series));
        if (std::isinf(series.claimed_order)) {
            EXPECT_LE(series.largest_error(), series.exact_enough());
            continue;
        }
        if (!chart.reference.smooth) continue;
        // Which of the two shows the order is the algorithm's affair: some have exact stresses and inexact energies.
        if (series.largest_error() > series.exact_enough() && series.order) {
            closer = closer || *series.order < series.claimed_order - order_tolerance;
            // Singular laws (an infinite initial slope, say) may cost an order above one, but none may cost
            // convergence.
            if (finest && at_corner) {
                EXPECT_GE(*series.order, std::min(series.claimed_order, 1.0) - order_tolerance);
            }
            algorithm.measured = true;
            algorithm.best = std::max(algorithm.best, *series.order);
        } else if (series.largest_dissipation_error() > series.exact_enough() && series.dissipation_order) {
            closer = closer || *series.dissipation_order < series.claimed_order - order_tolerance;
            algorithm.measured = true;
            algorithm.best = std::max(algorithm.best, *series.dissipation_order);
        }
    }
    return closer;
}

TEST_P(ClaimedOrders, ShowOnBuiltInPaths) {
    const lode_model& model = *GetParam();
    std::map<std::string, Shown> shown;
    for (int s = 0; s < model.sample_count; ++s) {
        const lode_sample& sample = model.samples[s];
        const std::vector<Kind> kinds = kinds_of(model.kinds & sample.kinds);
        for (const Kind kind : kinds) {
            // Every kind and path of the first sample; the corner, in the fullest kind, of the others.
            if (s > 0 && kind != kinds.front()) continue;
            for (const Scenario& path : built_in_paths(model, sample, kind)) {
                const bool at_corner = path_name(path) == corner_path;
                if (s > 0 && !at_corner) continue;
                ChartSettings usual = errors_only({32, 64, 128, 256}), fine = errors_only({512, 1024, 2048});
                usual.kinds = fine.kinds = {kind};
                try {
                    if (examine(make_chart(path, libraries(), usual, nullptr), shown, at_corner, false))
                        examine(make_chart(path, libraries(), fine, nullptr), shown, at_corner, true);
                } catch (const Refused&) {
                    // A path that the material cannot follow, which the property suite looks into.
                }
            }
        }
    }
    for (int i = 0; i < model.algorithm_count; ++i) {
        const lode_algorithm& algorithm = model.algorithms[i];
        EXPECT_TRUE(shown[algorithm.name].ran) << algorithm.name << ": no sample of " << model.keyword << " can use it";
        // What is exact on all paths does better than it claims.
        if (std::isfinite(algorithm.order) && shown[algorithm.name].measured) {
            EXPECT_GE(shown[algorithm.name].best, algorithm.order - order_tolerance)
                << algorithm.name << ": no built-in path shows the claimed order " << algorithm.order;
        }
    }
}

std::vector<const lode_model*> models_that_claim() {
    std::vector<const lode_model*> models;
    for (const lode_model* model : library().models())
        if (model->algorithm_count > 0) models.push_back(model);
    return models;
}
INSTANTIATE_TEST_SUITE_P(Registry, ClaimedOrders, testing::ValuesIn(models_that_claim()),
                         [](const auto& test_case) { return std::string(test_case.param->keyword); });

Scenario steel_corner() {
    for (const auto& [model, sample] : samples_named(library(), "ISO_PLASTIC-STEEL"))
        return built_in_path(*model, *sample, Kind::solid, corner_path);
    return {};
}

// Page 20, section 6: radial return is of first order, the exact rotation has no error.
TEST(Chart, ShowsTheAlgorithmsOfJ2) {
    LODE_NEEDS("ISO_PLASTIC");
    ChartSettings settings;
    settings.increments = {16, 32, 64};
    settings.repetitions = 3;
    const Chart chart = make_chart(steel_corner(), libraries(), settings, nullptr);
    std::map<std::string, int> interfaces;
    std::map<std::string, bool> algorithms;
    for (const Series& series : chart.series) {
        ++interfaces[series.interface_name()];
        algorithms[series.algorithm] = true;
        for (const ChartPoint& p : series.points) {
            EXPECT_GT(p.cost.median, 0) << series.algorithm;
            EXPECT_LE(p.cost.low, p.cost.high);
        }
        if (series.precision == Precision::single) continue;
        if (std::isinf(series.claimed_order)) {
            EXPECT_LE(series.largest_error(), 1e-12) << series.algorithm;
        }
        if (series.algorithm.starts_with("backward Euler (")) {
            EXPECT_NEAR(series.order.value_or(0), 1.0, 0.1) << series.interface_name();
        }
    }
    EXPECT_GE(algorithms.size(), 4U);
    EXPECT_GT(interfaces["UMAT"], 0);
    EXPECT_EQ(interfaces["UMAT"], interfaces["VUMAT"]);
    EXPECT_EQ(interfaces["UMAT"], interfaces["VUMAT single"]);
    EXPECT_LE(chart.reference.estimate, 1e-12) << "the exact solution is the best reference";
}

// Extrapolation of backward Euler tells what its reference is worth: against the exact solution.
TEST(Reference, KnowsItsOwnError) {
    LODE_NEEDS("ISO_PLASTIC");
    const Scenario scene = steel_corner();
    const Reference extrapolated = make_reference(scene, library(), 1, 1);
    ASSERT_TRUE(extrapolated.valid());
    Scenario exact = scene;
    exact.material.constants.resize(22, 0.0);
    exact.material.constants[21] = 1;
    const Trace solution = follow(with_increments(exact, extrapolated.increments), library());
    ASSERT_TRUE(solution.complete()) << solution.outcome.message;
    const double error = extrapolated.error_of(solution).worst();
    EXPECT_GT(extrapolated.estimate, 0);
    EXPECT_LE(error, 10 * extrapolated.estimate);
}

TEST(Order, IsTheSlopeOfTheErrors) {
    std::vector<ErrorAt> errors;
    for (const int n : {1, 2, 4, 8, 16}) errors.push_back({n, 3.0 / n / n});
    EXPECT_NEAR(fitted_order(errors, 1e-12).value_or(0), 2, 1e-12);
    EXPECT_FALSE(fitted_order(errors, 1.0)) << "nothing stands clear of the floor";
}

TEST(Pareto, HoldsNothingThatSomethingElseBeats) {
    LODE_NEEDS("CAM_CLAY");
    const auto [model, sample] = samples_named(library(), "CAM_CLAY-CLAY").front();
    ChartSettings settings;
    settings.increments = {1, 4, 16};
    settings.repetitions = 3;
    const Chart chart =
        make_chart(built_in_path(*model, *sample, Kind::solid, corner_path), libraries(), settings, nullptr);
    int best = 0;
    for (const Series& s : chart.series)
        for (const ChartPoint& p : s.points) {
            if (!p.best) continue;
            ++best;
            for (const Series& other : chart.series)
                for (const ChartPoint& q : other.points)
                    EXPECT_FALSE(q.cost.median < p.cost.median && q.error < 0.9 * p.error && q.error > 0);
        }
    EXPECT_GT(best, 1);
}

TEST(Chart, WritesTableAndFigure) {
    LODE_NEEDS("ISO_PLASTIC");
    const Directory directory;
    ChartSettings settings;
    settings.increments = {1, 4};
    settings.repetitions = 2;
    const Chart chart = make_chart(steel_corner(), libraries(), settings, nullptr);
    write_csv(chart, directory.file("chart.csv"));
    EXPECT_NE(directory.read("chart.csv").find("VUMAT single"), std::string::npos);
    if (const std::string failure = draw(chart, directory.file("chart")); failure.empty()) {
        EXPECT_GT(std::filesystem::file_size(directory.file("chart.svg")), 1000U);
        EXPECT_GT(std::filesystem::file_size(directory.file("chart.png")), 1000U);
    } else {
        EXPECT_NE(failure.find("gnuplot is not installed"), std::string::npos) << failure;
    }
    EXPECT_NE(text(chart).find("Pareto"), std::string::npos);
}

// A kind stands for a path only if the path has nothing that the kind leaves out.
TEST(Kinds, FollowFromThePath) {
    Scenario tension = material("ISO_PLASTIC-X", {200000, 0.3, 400, 1, 2000});
    Step pull;
    pull.components[0] = Prescribed{Control::strain, 0.01};
    tension.steps = {pull};
    using Kinds = std::vector<Kind>;
    EXPECT_EQ(possible_kinds(tension), (Kinds{Kind::solid, Kind::axisymmetric, Kind::plane_stress, Kind::uniaxial}));
    Scenario sheared = tension;
    sheared.steps[0].components[3] = Prescribed{Control::strain, 0.01};
    EXPECT_EQ(possible_kinds(sheared), (Kinds{Kind::solid, Kind::axisymmetric, Kind::plane_stress}));
    Scenario across = tension;
    across.steps[0].components[5] = Prescribed{Control::strain, 0.01};
    EXPECT_EQ(possible_kinds(across), Kinds{Kind::solid});
    Scenario held = tension;
    held.steps[0].components[2] = Prescribed{Control::strain, 0};
    EXPECT_EQ(possible_kinds(held), (Kinds{Kind::solid, Kind::axisymmetric}));
    Scenario confined = tension;
    confined.steps[0].components[2] = Prescribed{Control::stress, -10};
    EXPECT_EQ(possible_kinds(confined), (Kinds{Kind::solid, Kind::axisymmetric}));
}

}  // namespace
}  // namespace lode::host::test
