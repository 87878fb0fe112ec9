#include "failure_rate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <random>

#include "../status.hpp"
#include "../study/material_point.hpp"

namespace lode::host {
namespace {

constexpr int timed_repeats = 20;
constexpr int longest_walk = 20;

class Walk {
  public:
    explicit Walk(const Layout& layout) : layout_(layout) {}

    // A direction that is uniform on the sphere of that norm, so to say: components are normally distributed.
    Components increment(double norm) {
        Components e = Components::Zero(layout_.size());
        for (int i = 0; i < layout_.size(); ++i) e[i] = normal_(generator_);
        return (norm / strain_norm(layout_, e)) * e;
    }
    int steps() { return 1 + static_cast<int>(generator_() % longest_walk); }
    double part() { return uniform_(generator_); }

  private:
    Layout layout_;
    std::mt19937_64 generator_{20};
    std::normal_distribution<double> normal_;
    std::uniform_real_distribution<double> uniform_{0, 1};
};

}  // namespace

std::vector<AlgorithmRates> failure_rates(const Scenario& walker, const std::vector<Algorithm>& algorithms,
                                          const Library& library, double strain_scale, const std::vector<double>& sizes,
                                          int states, Meter* meter) {
    std::vector<AlgorithmRates> all;
    std::vector<std::unique_ptr<MaterialPoint>> points;
    for (const Algorithm& algorithm : algorithms) {
        AlgorithmRates rates{algorithm.name, {}, false};
        for (const double size : sizes) rates.rates.push_back({size});
        try {
            auto point = std::make_unique<MaterialPoint>(algorithm.scenario, library);
            // Constants are validated by the first call.
            point->observe();
            rates.observed = point->respond(Components::Zero(point->layout().size())).observation.has_value();
            points.push_back(std::move(point));
            all.push_back(rates);
        } catch (const Refused&) {
            continue;
        }
    }
    MaterialPoint leader(walker, library);
    const PointState virgin = leader.state();
    Walk walk(leader.layout());
    for (int state = 0; state < states; ++state) {
        if (meter != nullptr) meter->advance(fmt::format("state {}", state + 1));
        leader.set_state(virgin);
        for (int step = walk.steps(); step > 0; --step) leader.advance(walk.increment(walk.part() * strain_scale));
        for (std::size_t k = 0; k < sizes.size(); ++k) {
            const Components dstrain = walk.increment(sizes[k]);
            for (std::size_t i = 0; i < points.size(); ++i) {
                points[i]->set_state(leader.state());
                const Response response = points[i]->respond(dstrain);
                FailureRate& rate = all[i].rates[k];
                ++rate.tried;
                if (response.cut_wanted() || !response.finite()) ++rate.cut;
                if (const auto& observed = response.observation) {
                    rate.iterations += observed->iterations;
                    rate.most_iterations = std::max(rate.most_iterations, observed->iterations);
                    if (observed->safeguards > 0) ++rate.safeguarded;
                }
                rate.nanoseconds += points[i]->nanoseconds(dstrain, timed_repeats);
            }
        }
    }
    for (AlgorithmRates& algorithm : all)
        for (FailureRate& rate : algorithm.rates) {
            rate.nanoseconds /= std::max(rate.tried, 1);
            rate.iterations /= std::max(rate.tried, 1);
        }
    return all;
}

bool AlgorithmRates::is_ever_safeguarded() const {
    return std::any_of(rates.begin(), rates.end(), [](const FailureRate& r) { return r.safeguarded > 0; });
}

namespace {

double percent(int part, int whole) { return whole > 0 ? 100.0 * part / whole : 0; }

Table table_of(const std::vector<AlgorithmRates>& rates) {
    const bool observed = std::any_of(rates.begin(), rates.end(), [](const AlgorithmRates& a) { return a.observed; });
    std::vector<std::string> columns{"algorithm", "increment", "tried", "cut", "percent", "ns"};
    if (observed) columns.insert(columns.end(), {"iterations", "most_iterations", "safeguarded_percent"});
    Table table(columns);
    for (const AlgorithmRates& algorithm : rates)
        for (const FailureRate& r : algorithm.rates) {
            std::vector<Cell> row{algorithm.name, r.size, r.tried, r.cut, percent(r.cut, r.tried), r.nanoseconds};
            if (observed) row.insert(row.end(), {r.iterations, r.most_iterations, percent(r.safeguarded, r.tried)});
            table.add(row);
        }
    return table;
}

// Two curves an algorithm over the size of the increment: a share in percent, and another measure, dashed.
struct Curves {
    const char *what, *share_label, *other_label, *other_unit;
    int FailureRate::*share;
    double FailureRate::*other;
    bool logarithmic;  // the other one
};

Sheet curve_sheet(const std::vector<AlgorithmRates>& rates, const Curves& curves, const std::string& stem,
                  const std::string& title) {
    Sheet sheet{stem, title + "\n", table_of(rates), "", ""};
    std::string blocks;
    for (std::size_t i = 0; i < rates.size(); ++i) {
        const AlgorithmRates& algorithm = rates[i];
        blocks += fmt::format("$data{} << EOD\n", i);
        std::string line;
        for (const FailureRate& r : algorithm.rates) {
            const double share = percent(r.*curves.share, r.tried);
            blocks += fmt::format("{} {} {}\n", r.size, share, r.*curves.other);
            line += fmt::format("  {:.2g}: {:.3g} %, {:.3g}{};", r.size, share, r.*curves.other, curves.other_unit);
        }
        blocks += "EOD\n";
        sheet.text += fmt::format("  {}: {}, over the increment\n  {}\n", algorithm.name, curves.what, line);
        const auto curve = [&](int column, const char* axes, const char* style) {
            return fmt::format("{}$data{} using 1:{} axes {} with {} lc {} title '{}'",
                               sheet.plot.empty() ? "plot " : ", ", i, column, axes, style, i + 1,
                               column == 2 ? algorithm.name : "");
        };
        sheet.plot += curve(2, "x1y1", "linespoints lw 2 pt 7");
        sheet.plot += curve(3, "x1y2", "lines lw 1 dt 2");
    }
    sheet.setup = figure_setup(title, "norm of the increment", curves.share_label) + blocks +
                  fmt::format(
                      "\nset logscale x\nset yrange [0:*]\nset ytics nomirror\nset y2label '{}'\nset y2tics\n{}"
                      "set key top left\n",
                      curves.other_label, curves.logarithmic ? "set logscale y2\n" : "set y2range [0:*]\n");
    return sheet;
}

}  // namespace

Sheet failure_sheet(const std::vector<AlgorithmRates>& rates, const std::string& stem, const std::string& title) {
    return curve_sheet(rates,
                       {"cut-backs asked for, and time of a call", "increments that are refused (%)",
                        "time of a call (ns), dashed", " ns", &FailureRate::cut, &FailureRate::nanoseconds, true},
                       stem, title);
}

Sheet safeguard_sheet(const std::vector<AlgorithmRates>& rates, const std::string& stem, const std::string& title) {
    return curve_sheet(rates,
                       {"safeguards used, and mean iterations", "increments in which a safeguard took steps (%)",
                        "mean iterations, dashed", "", &FailureRate::safeguarded, &FailureRate::iterations, false},
                       stem, title);
}

}  // namespace lode::host
