#include "candidates.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "../guard.hpp"
#include "../status.hpp"
#include "variants.hpp"

namespace lode::host {
namespace {

constexpr double same_solution = 1e-8;  // of two references of different algorithms, beyond their estimates
constexpr long long most_common = 4096;

Scenario with(const Scenario& scenario, const Library& library, const lode_algorithm* algorithm) {
    if (algorithm == nullptr) return scenario;
    return with_algorithm(scenario, *library.model_of(scenario.material.name), *algorithm);
}

// Increments that contain all those asked for; not beyond all bounds, for which errors at fewer times have to do.
int common_multiple(const std::vector<int>& increments) {
    long long multiple = 1;
    for (const int n : increments)
        if (const long long next = std::lcm<long long>(multiple, n); next <= most_common) multiple = next;
    return static_cast<int>(multiple);
}

}  // namespace

std::string Interface::name() const {
    if (entry == Entry::umat) return "UMAT";
    return precision == Precision::single ? "VUMAT single" : "VUMAT";
}

double Candidate::order() const { return algorithm != nullptr ? algorithm->order : HUGE_VAL; }

std::vector<Interface> interfaces(const Libraries& libraries) {
    std::vector<Interface> all;
    if (libraries.main().umat() != nullptr) all.push_back({Entry::umat, Precision::double_, &libraries.main()});
    if (libraries.main().vumat() != nullptr) all.push_back({Entry::vumat, Precision::double_, &libraries.main()});
    if (libraries.single() != nullptr && libraries.single()->vumat() != nullptr)
        all.push_back({Entry::vumat, Precision::single, libraries.single()});
    return all;
}

std::vector<const lode_algorithm*> algorithms_of(const Scenario& scenario, const Library& library) {
    std::vector<const lode_algorithm*> algorithms;
    if (const lode_model* model = library.model_of(scenario.material.name))
        for (int i = 0; i < model->algorithm_count; ++i) algorithms.push_back(&model->algorithms[i]);
    if (algorithms.empty()) algorithms.push_back(nullptr);
    return algorithms;
}

std::vector<Candidate> candidates_for(const Scenario& scenario, const Library& library,
                                      const std::vector<int>& increments) {
    const lode_model* const model = library.model_of(scenario.material.name);
    const lode_algorithm* const own = model != nullptr ? algorithm_of(*model, scenario.material.constants) : nullptr;
    const int multiple_of = common_multiple(increments);
    std::vector<Candidate> candidates;
    for (const lode_algorithm* algorithm : algorithms_of(scenario, library)) {
        const Muted muted;  // an algorithm that does not go with the constants refuses
        Candidate candidate;
        candidate.algorithm = algorithm;
        candidate.scenario = with(scenario, library, algorithm);
        candidate.reference = make_reference(candidate.scenario, library, candidate.order(), multiple_of);
        if (!candidate.reference.valid()) {
            if (algorithm == own) throw Refused(candidate.reference.trace.outcome.message);
            continue;
        }
        if (algorithm == own) candidates.insert(candidates.begin(), std::move(candidate));
        else candidates.push_back(std::move(candidate));
    }
    if (candidates.empty()) throw Refused("no algorithm can follow the path");
    const Reference& first = candidates.front().reference;
    for (Candidate& c : candidates)
        c.own_law =
            first.error_of(c.reference.trace).worst() > same_solution + 5 * (first.estimate + c.reference.estimate);
    return candidates;
}

const Candidate& most_accurate(const std::vector<Candidate>& candidates) {
    const Candidate* best = &candidates.front();
    for (const Candidate& c : candidates)
        if (!c.own_law && c.reference.estimate < best->reference.estimate) best = &c;
    return *best;
}

std::optional<Scenario> scene_for(const Scenario& scenario, const Interface& interface, const Libraries& libraries,
                                  int increments, const Reference& reference) {
    Scenario run = with_increments(scenario, increments);
    run.analysis.entry = interface.entry;
    run.analysis.precision = interface.precision;
    if (interface.entry == Entry::umat || !stress_controlled(run)) return run;
    if (libraries.main().umat() == nullptr) return std::nullopt;
    Scenario times = run;
    times.analysis.entry = Entry::umat;
    times.analysis.precision = Precision::double_;
    return strain_driven(run, follow(times, libraries.main()), reference.trace);
}

}  // namespace lode::host
