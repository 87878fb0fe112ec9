#include "constants.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "../plot/gnuplot.hpp"
#include "../status.hpp"
#include "../study/material_point.hpp"
#include "lode/material/property_places.hpp"

namespace lode::host {
namespace {

constexpr int decades = 6;
constexpr double resolution = 1e-9;
constexpr int increments = 20;

// A scenario whose constant `index` may be changed.
class Variation {
  public:
    Variation(const Scenario& scenario, const Library& library, std::size_t index, double strain_scale)
        : scenario_(scenario), library_(library), index_(index), strain_scale_(strain_scale) {}

    double given() const { return scenario_.material.constants[index_]; }
    // What the library has against a value, or nothing.
    std::optional<std::string> objection(double value) const {
        try {
            MaterialPoint point(with(value), library_);
            static_cast<void>(point.respond(Components::Zero(point.layout().size())));
            return std::nullopt;
        } catch (const Refused& refusal) {
            return refusal.what();
        }
    }
    bool works(double value) const {
        try {
            MaterialPoint point(with(value), library_);
            Components strain = Components::Zero(point.layout().size());
            strain[0] = strain_scale_ / increments;
            for (int i = 0; i < increments; ++i)
                if (!point.advance(strain)) return false;
            return true;
        } catch (const Refused&) {
            return false;
        }
    }
    ConstantLimit limit(int direction) const {
        ConstantLimit limit;
        double good = 0, bad = 0;  // powers of ten
        while (bad == good) {
            if (std::abs(good) >= decades) break;
            const double next = good + direction;
            if (auto message = objection(given() * std::pow(10.0, next))) {
                bad = next;
                limit.message = *message;
            } else {
                good = bad = next;
            }
        }
        limit.limited = bad != good;
        while (std::abs(bad - good) > resolution / std::log(10.0)) {
            const double middle = 0.5 * (good + bad);
            if (auto message = objection(given() * std::pow(10.0, middle))) {
                bad = middle;
                limit.message = *message;
            } else {
                good = middle;
            }
        }
        limit.value = given() * std::pow(10.0, good);
        limit.works = works(limit.value);
        return limit;
    }

  private:
    Scenario with(double value) const {
        Scenario changed = scenario_;
        changed.material.constants[index_] = value;
        return changed;
    }

    const Scenario& scenario_;
    const Library& library_;
    std::size_t index_;
    double strain_scale_;
};

}  // namespace

std::vector<ConstantRange> constant_ranges(const Scenario& scenario, const lode_model& model, const Library& library,
                                           double strain_scale, Meter* meter) {
    const std::vector<double>& constants = scenario.material.constants;
    const auto places = property_places(model, constants.data(), static_cast<int>(constants.size()));
    std::vector<ConstantRange> ranges;
    for (std::size_t i = 0; i < std::min(constants.size(), places.size()); ++i) {
        const lode_parameter& p = *places[i].parameter;
        if (meter != nullptr) meter->advance(p.symbol);
        if (constants[i] == 0 || (p.flags & LODE_INTEGER) != 0) continue;
        const Variation variation(scenario, library, i, strain_scale);
        ConstantRange range{p.symbol, static_cast<int>(i) + 1, constants[i], variation.limit(-1), variation.limit(+1)};
        if (places[i].repetition > 0) range.symbol += fmt::format(" {}", places[i].repetition);
        ranges.push_back(std::move(range));
    }
    return ranges;
}

Sheet constants_sheet(const std::vector<ConstantRange>& ranges, const std::string& stem, const std::string& title) {
    Sheet sheet{stem, title + ": accepted from, to\n",
                Table({"props", "symbol", "value", "limit", "at", "path_done", "message"}), "", ""};
    std::string bars = "$bars << EOD\n", limits = "$limits << EOD\n";
    for (std::size_t row = 0; row < ranges.size(); ++row) {
        const ConstantRange& r = ranges[row];
        bars += fmt::format("{:.9g} {} {:.9g} {}\n", r.lower.value / r.value, row, r.upper.value / r.value,
                            double_quoted(r.symbol));
        sheet.text += fmt::format("  {} = {:.6g}\n", r.symbol, r.value);
        for (const auto& [name, limit] : {std::pair("lower", &r.lower), std::pair("upper", &r.upper)}) {
            sheet.table.add({r.property, r.symbol, r.value, limit->limited ? name : "none", limit->value,
                             limit->works ? "yes" : "no", limit->message});
            if (!limit->limited) continue;
            limits += fmt::format("{:.9g} {}\n", limit->value / r.value, row);
            sheet.text += fmt::format("    {:.9g}{}: {}\n", limit->value,
                                      limit->works ? "" : " (where the path cannot be followed)", limit->message);
        }
    }
    sheet.setup = figure_setup(title, "value / value of the sample", "") + bars + "EOD\n" + limits + "EOD\n" +
                  fmt::format(
                      "set logscale x\nset xrange [1e-{0}:1e{0}]\nset format x '10^{{%T}}'\n"
                      "set yrange [{1}:-1]\nset ytics noenhanced\nunset key\n",
                      decades, ranges.size());
    sheet.plot =
        "plot $bars using 1:2:($3-$1):(0):ytic(4) with vectors nohead lw 6 lc rgb '#9dbfe0', "
        "$limits using 1:2 with points pt 7 ps 0.9 lc rgb '#c8501e'";
    return sheet;
}

}  // namespace lode::host
