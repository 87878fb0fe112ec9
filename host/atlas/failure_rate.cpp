#include "failure_rate.hpp"

#include <fmt/format.h>

#include <memory>
#include <random>

#include "../status.hpp"
#include "../study/material_point.hpp"

namespace lode::host {
namespace {

constexpr int timed_calls = 20;
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
        AlgorithmRates rates{algorithm.name, {}};
        for (const double size : sizes) rates.rates.push_back({size, 0, 0, 0});
        try {
            auto point = std::make_unique<MaterialPoint>(algorithm.scenario, library);
            // Constants are validated by the first call.
            static_cast<void>(point->respond(Components::Zero(point->layout().size())));
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
                rate.nanoseconds += points[i]->nanoseconds(dstrain, timed_calls);
            }
        }
    }
    for (AlgorithmRates& algorithm : all)
        for (FailureRate& rate : algorithm.rates) rate.nanoseconds /= std::max(rate.tried, 1);
    return all;
}

Sheet failure_sheet(const std::vector<AlgorithmRates>& rates, const std::string& stem, const std::string& title) {
    Sheet sheet{stem, title + "\n", Table({"algorithm", "increment", "tried", "cut", "percent", "ns"}), "", ""};
    std::string blocks;
    for (std::size_t i = 0; i < rates.size(); ++i) {
        const AlgorithmRates& algorithm = rates[i];
        blocks += fmt::format("$data{} << EOD\n", i);
        std::string line;
        for (const FailureRate& r : algorithm.rates) {
            const double percent = r.tried > 0 ? 100.0 * r.cut / r.tried : 0;
            sheet.table.add({algorithm.name, r.size, r.tried, r.cut, percent, r.nanoseconds});
            blocks += fmt::format("{} {} {}\n", r.size, percent, r.nanoseconds);
            line += fmt::format("  {:.2g}: {:.3g} %, {:.0f} ns;", r.size, percent, r.nanoseconds);
        }
        blocks += "EOD\n";
        sheet.text += fmt::format("  {}: cut-backs asked for, and time of a call, over the increment\n  {}\n",
                                  algorithm.name, line);
        const auto curve = [&](int column, const char* axes, const char* style) {
            return fmt::format("{}$data{} using 1:{} axes {} with {} lc {} title '{}'",
                               sheet.plot.empty() ? "plot " : ", ", i, column, axes, style, i + 1,
                               column == 2 ? algorithm.name : "");
        };
        sheet.plot += curve(2, "x1y1", "linespoints lw 2 pt 7");
        sheet.plot += curve(3, "x1y2", "lines lw 1 dt 2");
    }
    sheet.setup = figure_setup(title, "norm of the increment", "increments that are refused (%)") + blocks + R"(
set logscale x
set yrange [0:*]
set ytics nomirror
set y2label 'time of a call (ns), dashed'
set y2tics
set logscale y2
set key top left
)";
    return sheet;
}

}  // namespace lode::host
