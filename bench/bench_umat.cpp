// Times every model of the library in every kind it serves, through umat_ and vumat_, next to hand-written Fortran.
//   bench_umat [--report=FILE] [Google Benchmark's options]
#include <benchmark/benchmark.h>

#include <cstring>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "abi.hpp"
#include "lode/lode.h"
#include "points.hpp"
#include "report.hpp"

namespace {

using namespace lode::bench;

struct Kind {
    unsigned bit;
    const char* name;
    Layout umat, vumat;
    const char* vumat_label;  // what the label must begin with
};
constexpr Kind kinds[] = {
    {LODE_SOLID, "3D", {3, 3}, {3, 3}, ""},
    {LODE_PLANE_STRAIN, "plane strain", {3, 1}, {3, 1}, ""},
    {LODE_PLANE_STRESS, "plane stress", {2, 1}, {3, 1}, "PS-"},
    {LODE_UNIAXIAL, "1D", {1, 0}, {1, 0}, ""},
    {LODE_COHESIVE_2D, "cohesive 2D", {1, 1}, {1, 1}, ""},
    {LODE_COHESIVE_3D, "cohesive 3D", {1, 2}, {1, 2}, ""},
};

// Targets in U (UMAT) and V (VUMAT), for the samples that are this case of the model.
struct Target {
    std::string_view keyword;
    unsigned kinds;
    bool (*applies)(const lode_sample&);
    double u, v;
};
bool every_sample(const lode_sample&) { return true; }
double constant(const lode_sample& s, int index) { return index <= s.constant_count ? s.constants[index - 1] : 0.0; }
template <int law>  // one backward Euler step, no softening
bool hardening_law(const lode_sample& s) {
    return constant(s, 4) == law && constant(s, 5) >= 0.0 && constant(s, 22) == 0.0;
}
bool incremental_law(const lode_sample& s) { return constant(s, 5) == 0.0; }
constexpr Target targets[] = {
    {"ISO_ELASTIC", LODE_SOLID, incremental_law, 0.6, 0.6},
    {"ISO_PLASTIC", LODE_SOLID, hardening_law<1>, 0.7, 0.7},
    {"ISO_PLASTIC", LODE_SOLID, hardening_law<8>, 1.0, 2.0},
    {"ISO_PLASTIC", LODE_SOLID, hardening_law<3>, 2.0, 4.0},
    {"HILL_PLASTIC", LODE_SOLID, every_sample, 5.0, 10.0},
    {"DRUCKER_PRAGER", LODE_SOLID, every_sample, 1.0, 1.2},
    {"CAM_CLAY", LODE_SOLID, every_sample, 4.0, 8.0},
    {"NEO_HOOKEAN", LODE_SOLID, every_sample, 0.7, 1.0},
    {"MOONEY_RIVLIN", LODE_SOLID, every_sample, 0.9, 1.2},
    {"HE_ISO_PLASTIC", LODE_SOLID, every_sample, 5.0, 8.0},
    {"MIE_GRUNEISEN", LODE_SOLID, every_sample, 4.0, 6.0},
    {"ISO_SOFTENING", LODE_SOLID, every_sample, 6.0, 10.0},
    {"VISCOELASTIC", LODE_SOLID, every_sample, 1.2, 1.5},
    {"COH_TRIANGULAR", LODE_COHESIVE_2D | LODE_COHESIVE_3D, every_sample, 0.5, 0.5},
};

double target_for(const lode_model& model, const lode_sample& sample, unsigned kind, Interface interface) {
    for (const Target& t : targets) {
        if (model.keyword != t.keyword || (kind & t.kinds) == 0) continue;
        if (!t.applies(sample)) continue;
        return interface == Interface::umat ? t.u : t.v;
    }
    return 0;
}

constexpr int pool = 256, distinct_points = 1000;

benchmark::Counter per_point(int points) {
    return {1e-9 * points, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert};
}

void run_umat(benchmark::State& state, lode_umat_function* umat, const Material& material, Layout layout) {
    try {
        UmatPoints points(umat, material, layout, pool);
        for (auto _ : state) {
            points.run();
            benchmark::ClobberMemory();
        }
        state.counters["ns"] = per_point(pool);
        state.counters["active"] = points.active_share();
        if (const std::string error = take_error(); !error.empty()) state.SkipWithError(error.c_str());
    } catch (const std::runtime_error& problem) {
        state.SkipWithError(problem.what());
    }
}

// A block stops at the first point that a model cannot follow, so a refused block is driven less far.
VumatBlock prepared_block(lode_vumat_function* vumat, Material material, Layout layout, int count) {
    for (int attempt = 0;; ++attempt) {
        try {
            return {vumat, material, layout, count, distinct_points};
        } catch (const std::runtime_error&) {
            if (attempt == 3) throw;
            material.strain_scale *= 0.5;
        }
    }
}

void run_vumat(benchmark::State& state, lode_vumat_function* vumat, const Material& material, Layout layout, int count,
               bool copy) {
    try {
        VumatBlock block = prepared_block(vumat, material, layout, count);
        for (auto _ : state) {
            if (copy) block.copy();
            else block.run();
            benchmark::ClobberMemory();
        }
        state.counters["ns"] = per_point(count);
        state.counters["active"] = block.active_share();
        if (const std::string error = take_error(); !error.empty()) state.SkipWithError(error.c_str());
    } catch (const std::runtime_error& problem) {
        state.SkipWithError(problem.what());
    }
}

class Registry {
  public:
    std::vector<Case> cases;

    void umat(Case c, lode_umat_function* function, const Material& material, Layout layout, std::string name = {}) {
        c.interface = Interface::umat;
        c.benchmark = name.empty() ? "umat/" + c.group + "/" + c.material + "/" + c.kind : name;
        benchmark::RegisterBenchmark(c.benchmark.c_str(),
                                     [=](benchmark::State& state) { run_umat(state, function, material, layout); });
        cases.push_back(std::move(c));
    }

    void vumat(Case c, lode_vumat_function* function, const Material& material, Layout layout, int count) {
        c.interface = Interface::vumat;
        c.points = count;
        c.benchmark = "vumat" + std::to_string(count) + "/" + c.group + "/" + c.material + "/" + c.kind;
        benchmark::RegisterBenchmark(c.benchmark.c_str(), [=](benchmark::State& state) {
            run_vumat(state, function, material, layout, count, false);
        });
        if (count == large_block)
            benchmark::RegisterBenchmark((copy_run + ("/" + c.benchmark)).c_str(), [=](benchmark::State& state) {
                run_vumat(state, function, material, layout, count, true);
            });
        cases.push_back(std::move(c));
    }
};

Material hand_written(std::vector<double> constants, double strain_scale, bool finite_strain = false,
                      int state_count = 1) {
    Material m;
    m.name = "BASELINE";
    m.constants = std::move(constants);
    m.state_count = state_count;
    m.initial_state.assign(static_cast<std::size_t>(state_count), 0.0);
    m.strain_scale = strain_scale;
    m.finite_strain = finite_strain;
    return m;
}

void register_baselines(Registry& registry) {
    const Layout solid{3, 3};
    const Material elastic = hand_written({200000, 0.3}, 1e-3);
    const Material j2 = hand_written({200000, 0.3, 400, 2000}, 0.02);
    const Material elastic_with_state = hand_written(elastic.constants, elastic.strain_scale, false, 4);
    const Material j2_with_state = hand_written(j2.constants, j2.strain_scale, false, 4);
    const Material voce = hand_written({200000, 0.3, 400, 150, 20, 500}, 0.02);
    const Material rubber = hand_written({1, 10}, 0.3, true);
    const auto named = [](const char* material) {
        Case c;
        c.group = "baseline";
        c.material = material;
        c.kind = "3D";
        return c;
    };
    registry.umat(named("J2, Fortran"), baseline_umat_j2_, j2, solid);
    registry.umat(named("J2, Fortran usual form"), baseline_umat_j2_usual_, j2, solid);
    registry.umat(named("J2 with Voce hardening, Fortran"), baseline_umat_j2_voce_, voce, solid);
    registry.umat(named("elastic, Fortran"), baseline_umat_elastic_, elastic, solid);
    registry.umat(named("neo-Hooke, Fortran"), baseline_umat_neo_hooke_, rubber, solid);
    registry.umat(named("empty: the driver itself"), empty_umat_, j2, solid);
    for (const int count : {small_block, odd_block, large_block}) {
        registry.vumat(named("J2, Fortran vectorised"), baseline_vumat_j2_simd_, j2, solid, count);
        registry.vumat(named("J2, Fortran usual form"), baseline_vumat_j2_, j2, solid, count);
        registry.vumat(named("elastic, Fortran"), baseline_vumat_elastic_, elastic, solid, count);
        registry.vumat(named("J2, Fortran vectorised, state of ISO_PLASTIC"), baseline_vumat_j2_simd_, j2_with_state,
                       solid, count);
        registry.vumat(named("elastic, Fortran, state of ISO_ELASTIC"), baseline_vumat_elastic_, elastic_with_state,
                       solid, count);
    }
}

Loading loading_of(const lode_model& model) {
    const std::string_view family = model.family;
    if (family == "soil") return Loading::compression;
    if (family == "damage") return Loading::tension;
    return Loading::any;
}

// Empty if the library does not know the sample in this kind.
std::optional<Material> material_of(const lode_model& model, const lode_sample& sample, const std::string& label,
                                    Layout layout) {
    Material m;
    m.name = std::string(model.keyword) + "-" + label;
    m.constants.assign(sample.constants, sample.constants + sample.constant_count);
    char error[300];
    m.state_count = lode_required_state(m.name.c_str(), m.constants.data(), sample.constant_count, layout.ndi,
                                        layout.nshr, error, sizeof error);
    if (m.state_count < 0) {
        std::cerr << m.name << ": " << error << '\n';
        return std::nullopt;
    }
    for (int i = 0; i < std::min(m.state_count, model.state_count); ++i)
        m.initial_state.push_back(model.state[i].initial);
    m.strain_scale = sample.strain_scale;
    m.cohesive = layout.ndi == 1 && layout.nshr > 0;
    m.finite_strain = (model.traits & LODE_FINITE_STRAIN) != 0;
    m.loading = loading_of(model);
    return m;
}

void register_models(Registry& registry) {
    for (int i = 0; i < lode_model_count(); ++i) {
        const lode_model& model = *lode_model_at(i);
        for (int s = 0; s < model.sample_count; ++s) {
            const lode_sample& sample = model.samples[s];
            for (const Kind& kind : kinds) {
                if ((model.kinds & sample.kinds & kind.bit) == 0) continue;
                Case c;
                c.group = model.family;
                c.kind = kind.name;
                c.material = std::string(model.keyword) + "-" + sample.label;
                if (const auto m = material_of(model, sample, sample.label, kind.umat)) {
                    c.target = target_for(model, sample, kind.bit, Interface::umat);
                    registry.umat(c, umat_, *m, kind.umat);
                }
                const auto m = material_of(model, sample, std::string(kind.vumat_label) + sample.label, kind.umat);
                if (!m) continue;
                c.target = target_for(model, sample, kind.bit, Interface::vumat);
                registry.vumat(c, vumat_, *m, kind.vumat, small_block);
                if (kind.bit != LODE_SOLID) continue;
                c.target = 0;
                registry.vumat(c, vumat_, *m, kind.vumat, odd_block);
                if (s == 0) registry.vumat(c, vumat_, *m, kind.vumat, large_block);
            }
        }
    }
}

void register_overhead(Registry& registry) {
    const Layout bar{1, 0};
    const auto constants = [](std::vector<double> first, std::size_t count) {
        first.resize(count, 0.0);
        return first;
    };
    const auto add = [&](const char* description, const std::string& name, lode_umat_function* umat,
                         const char* material_name, std::vector<double> props, double scale) {
        Material m = hand_written(std::move(props), scale);
        m.name = material_name;
        m.state_count = 4;
        m.initial_state.clear();
        Case c;
        c.group = "overhead";
        c.material = description;
        c.kind = "1D";
        registry.umat(c, umat, m, bar, name);
    };
    add("empty UMAT: the driver itself", "overhead/empty", empty_umat_, "NONE", {1, 1}, 1e-3);
    add("ISO_ELASTIC, 2 PROPS", "overhead/elastic-2", umat_, "ISO_ELASTIC-BAR", {200000, 0.3}, 1e-3);
    add("ISO_PLASTIC, 5 PROPS, elastic point", "overhead/plastic-5", umat_, "ISO_PLASTIC-BAR",
        {200000, 0.3, 400, 1, 2000}, 1e-4);
    add("ISO_PLASTIC, 20 PROPS, elastic point", "overhead/plastic-20", umat_, "ISO_PLASTIC-BAR",
        constants({200000, 0.3, 400, 1, 2000}, 20), 1e-4);
    add("ISO_PLASTIC, 20 PROPS, name of 80 characters", "overhead/plastic-20-long-name", umat_,
        "ISO_PLASTIC-A-LABEL-THAT-FILLS-THE-WHOLE-NAME-OF-EIGHTY-CHARACTERS-FROM-END-TO-E",
        constants({200000, 0.3, 400, 1, 2000}, 20), 1e-4);
}

}  // namespace

int main(int argc, char** argv) {
    std::string report;
    // Several short repetitions in random order: a disturbance of the machine does not hit one case alone.
    std::vector<std::string> arguments = {argv[0], "--benchmark_min_time=0.01", "--benchmark_repetitions=5",
                                          "--benchmark_enable_random_interleaving=true",
                                          "--benchmark_display_aggregates_only=true"};
    for (int i = 1; i < argc; ++i) {
        const std::string_view argument = argv[i];
        if (argument.starts_with("--report=")) report = argument.substr(std::strlen("--report="));
        else arguments.emplace_back(argument);
    }
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    int count = static_cast<int>(pointers.size());
    benchmark::Initialize(&count, pointers.data());
    if (benchmark::ReportUnrecognizedArguments(count, pointers.data())) return 1;

    Registry registry;
    register_baselines(registry);
    register_overhead(registry);
    register_models(registry);
    Collector collector;
    benchmark::RunSpecifiedBenchmarks(&collector);
    if (!report.empty()) {
        std::ofstream out(report);
        write_report(out, registry.cases, collector);
        if (!out.flush()) {
            std::cerr << "cannot write " << report << '\n';
            return 1;
        }
    }
    return 0;
}
