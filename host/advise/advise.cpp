#include "advise.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "../guard.hpp"
#include "../study/variants.hpp"
#include "simpler.hpp"

namespace lode::host {
namespace {

constexpr double as_cheap = 1.03;  // costs closer than this are equal, and the smaller error counts
// A coarse run sees few moments and may be right at them by chance: so many finer ones have to be right too.
constexpr int confirmations = 2;

// 1, 2, 3, 4, 6, 8, 12, ...
std::vector<int> increments_up_to(int finest) {
    std::vector<int> counts{1};
    for (int n = 2; n <= finest; n *= 2) {
        counts.push_back(n);
        if (n + n / 2 <= finest && n < finest) counts.push_back(n + n / 2);
    }
    return counts;
}

class Adviser {
  public:
    Adviser(const Scenario& scenario, const Libraries& libraries, const AdviseSettings& settings, Meter* meter)
        : deck_(scenario), libraries_(libraries), settings_(settings), meter_(meter) {
        counts_ = increments_up_to(settings.finest);
        advice_.tolerance = settings.tolerance;
        advice_.tangent_needed = stress_controlled(scenario);
    }

    Advice run() {
        const Muted muted;  // settings that the library refuses are among those tried
        find_reference();
        run_as_written();
        run_safest();
        for (const Candidate& candidate : candidates_)
            if (!candidate.own_law) try_scene(candidate.scenario, candidate.name(), "the deck's material", false);
        for (const SimplerScene& simpler : simpler_scenes(fullest_, libraries_.main()))
            try_scene(simpler.scenario, own_algorithm(simpler.scenario), simpler.origin, simpler.small_strain);
        choose();
        return std::move(advice_);
    }

  private:
    // The scene in its fullest kind.
    void find_reference() {
        fullest_ = deck_;
        fullest_.analysis.entry = libraries_.main().umat() != nullptr ? Entry::umat : Entry::vumat;
        fullest_.analysis.precision = Precision::double_;
        for (const Kind kind : possible_kinds(fullest_)) {
            Scenario scene = *in_kind(fullest_, kind);
            if (kind != deck_.analysis.kind && !follow(with_increments(scene, 1), libraries_.main()).complete())
                continue;
            fullest_ = std::move(scene);
            break;
        }
        candidates_ = candidates_for(fullest_, libraries_.main(), counts_);
        const Candidate& candidate = most_accurate(candidates_);
        advice_.reference = candidate.reference;
        advice_.reference_algorithm = candidate.name();
        most_accurate_ = candidate.scenario;
    }

    Option option(const Scenario& scenario, const std::string& algorithm, const std::string& origin, bool small) const {
        Option result;
        result.material = scenario.material.name;
        result.algorithm = algorithm;
        result.origin = origin;
        result.kind = scenario.analysis.kind;
        result.entry = scenario.analysis.entry;
        result.precision = scenario.analysis.precision;
        result.strain = small ? StrainMeasure::small : StrainMeasure::as_the_deck_says;
        result.scenario = scenario;
        return result;
    }

    void judge(Option& result, const Library& library) const {
        const Trace trace = follow(result.scenario, library);
        if (!trace.complete()) {
            result.failure = trace.outcome.message;
            return;
        }
        const Difference error = advice_.reference.error_of(trace);
        result.error = std::isfinite(error.worst()) && error.common > 1 ? error.worst() : HUGE_VAL;
        result.sufficient = result.error + advice_.reference.estimate <= settings_.tolerance;
    }

    void run_as_written() {
        Option result = option(deck_, own_algorithm(deck_), "the deck as it is", false);
        const Interface* interface = interface_of(deck_.analysis);
        if (interface == nullptr) return;
        judge(result, *interface->library);
        if (result.failure.empty()) result.cost = settings_.cost(result.scenario, *interface->library);
        advice_.as_written = std::move(result);
    }

    void run_safest() {
        Option result = option(with_increments(most_accurate_, settings_.finest), advice_.reference_algorithm,
                               "the safest setting", false);
        result.increments = settings_.finest;
        judge(result, libraries_.main());
        if (!result.failure.empty()) return;
        result.cost = settings_.cost(result.scenario, libraries_.main());
        advice_.safest = std::move(result);
    }

    const Interface* interface_of(const AnalysisSpec& analysis) const {
        for (const Interface& interface : interfaces_)
            if (interface.entry == analysis.entry && interface.precision == analysis.precision) return &interface;
        return nullptr;
    }

    std::string own_algorithm(const Scenario& scenario) const {
        const lode_model* model = libraries_.main().model_of(scenario.material.name);
        const lode_algorithm* algorithm =
            model != nullptr ? algorithm_of(*model, scenario.material.constants) : nullptr;
        return algorithm != nullptr ? algorithm->name : "";
    }

    // All kinds and interfaces of a scene.
    void try_scene(const Scenario& scenario, const std::string& algorithm, const std::string& origin, bool small) {
        for (const Kind kind : possible_kinds(scenario))
            for (const Interface& interface : interfaces_) {
                // Without strains that are prescribed the host needs DDSDDE to find them.
                if (interface.entry == Entry::vumat && advice_.tangent_needed) continue;
                Scenario scene = *in_kind(scenario, kind);
                scene.analysis.entry = interface.entry;
                scene.analysis.precision = interface.precision;
                search(option(scene, algorithm, origin, small), interface);
            }
    }

    // The fewest increments that suffice, confirmed by finer ones; else those with the least error.
    void search(const Option& prototype, const Interface& interface) {
        if (meter_ != nullptr)
            meter_->advance(fmt::format("{}, {}, {}, {}", prototype.origin, prototype.algorithm,
                                        name_of(prototype.kind), prototype.interface_name()));
        std::optional<Option> found, nearest;
        int confirmed = 0;
        std::string failure;
        for (const int n : counts_) {
            Option next = prototype;
            next.increments = n;
            next.scenario = with_increments(prototype.scenario, n);
            judge(next, *interface.library);
            if (!next.failure.empty()) {
                failure = next.failure;
                if (n == 1 && !serves(next.scenario, *interface.library)) return;  // not this kind
                found.reset();
                continue;
            }
            if (!nearest || next.error < nearest->error) nearest = next;
            if (!next.sufficient) {
                found.reset();
                confirmed = 0;
            } else if (!found) {
                found = next;
                confirmed = 0;
            } else if (++confirmed == confirmations) {
                break;
            }
        }
        if (!found && !nearest) {
            Option failed = prototype;
            failed.failure = failure;
            failed.error = HUGE_VAL;
            advice_.options.push_back(std::move(failed));
            return;
        }
        Option result = found ? *found : *nearest;
        result.sufficient = found.has_value();
        if (found) result.cost = settings_.cost(result.scenario, *interface.library);
        advice_.options.push_back(std::move(result));
    }

    // Whether the library takes the material in the kind at all.
    static bool serves(Scenario scenario, const Library& library) {
        try {
            resolve(scenario, library);
            return true;
        } catch (const Failure&) {
            return false;
        }
    }

    void choose() {
        auto& options = advice_.options;
        const auto cost = [](const Option& o) { return o.cost ? o.cost->median : HUGE_VAL; };
        std::stable_sort(options.begin(), options.end(), [&](const Option& a, const Option& b) {
            if (a.sufficient != b.sufficient) return a.sufficient;
            return a.sufficient ? cost(a) < cost(b) : a.error < b.error;
        });
        if (!options.empty() && options.front().sufficient) {
            const Option* best = &options.front();
            for (const Option& o : options)
                if (o.sufficient && cost(o) <= as_cheap * cost(options.front()) && o.error < best->error) best = &o;
            advice_.best = *best;
            return;
        }
        if (advice_.reference.estimate > settings_.tolerance)
            advice_.verdict =
                fmt::format("the reference itself is known to {:.1e} only, which is coarser than the tolerance",
                            advice_.reference.estimate);
        else if (!options.empty() && std::isfinite(options.front().error))
            advice_.verdict = fmt::format("the least error of all runs is {:.2e}, with up to {} increments a step",
                                          options.front().error, settings_.finest);
        else advice_.verdict = "no run came to its end";
    }

    const Scenario& deck_;
    const Libraries& libraries_;
    const AdviseSettings& settings_;
    Meter* meter_;
    std::vector<int> counts_;
    std::vector<Interface> interfaces_ = interfaces(libraries_);
    Scenario fullest_, most_accurate_;
    std::vector<Candidate> candidates_;
    Advice advice_;
};

}  // namespace

Advice advise(const Scenario& scenario, const Libraries& libraries, const AdviseSettings& settings, Meter* meter) {
    return Adviser(scenario, libraries, settings, meter).run();
}

}  // namespace lode::host
