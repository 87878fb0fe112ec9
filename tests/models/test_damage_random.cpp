// The damage models on random non-proportional paths with unloading and closure of cracks: dissipation never decreases,
// damage stays within 0 and 1 and never heals, nothing is NaN, and no increment is refused. 10^4 increments a model;
// LODE_TEST_INCREMENTS asks for more.
#include <cmath>
#include <cstdlib>
#include <random>

#include "damage_support.hpp"

namespace lode::test::test_damage_random {
namespace {

using damage_cases::LawCode, damage_cases::laws, damage_cases::in_kind;
using enum AnalysisKind;

struct Material {
    Numbers props;
    AnalysisKind kind;
    double scale, celent;
};
// The STATEV entries of a model, 1-based.
struct Watched {
    std::vector<int> damage;      // in [0, 1], never falls
    std::vector<int> dissipated;  // never falls
};

std::vector<Material> samples_of(const lode_model& model) {
    std::vector<Material> all;
    for (int s = 0; s < model.sample_count; ++s)
        for (int k = 0; k < kind_count; ++k) {
            const auto kind = static_cast<AnalysisKind>(k);
            const lode_sample& sample = model.samples[s];
            if (serves(model, kind) && (sample.kinds & kind_bit(kind)) != 0)
                all.push_back(
                    {{sample.constants, sample.constants + sample.constant_count}, kind, sample.strain_scale, 1.0});
        }
    return all;
}

bool finite(const Numbers& v) {
    double sum = 0.0;
    for (const double x : v) sum += x * 0.0;
    return sum == 0.0;
}

class Walk {
  public:
    Walk(std::string name, Material material, Watched watched, bool phase_of_host, std::uint32_t seed)
        : name_(std::move(name)),
          material_(std::move(material)),
          watched_(std::move(watched)),
          phase_of_host_(phase_of_host),
          random_(seed),
          point_(fresh()) {}

    void run(int increments) {
        const auto n = static_cast<std::size_t>(components(material_.kind));
        Numbers way = direction(n), total(n, 0.0);
        for (int i = 0; i < increments; ++i) {
            if (uniform(0, 1) < 0.25) way = direction(n);
            else if (uniform(0, 1) < 0.25) {
                for (double& x : way) x = -x;
            } else if (uniform(0, 1) < 0.1) {
                way.assign(n, 0.0);  // squeeze
                std::fill_n(way.begin(), normal_components(material_.kind), -0.5);
            }
            Load load{.dstran = way};
            const double size = material_.scale * std::exp(uniform(std::log(1e-6), std::log(0.5)));
            for (double& x : load.dstran) x *= size;
            if (phase_of_host_) load.dpred = {uniform(0, 1) < 0.3 ? uniform(0, 0.1) : 0.0};
            ASSERT_NO_FATAL_FAILURE(step(load)) << "increment " << i;
            for (std::size_t k = 0; k < n; ++k) total[k] += load.dstran[k];
            if (uniform(0, 1) < 3e-3 || largest(total) > 3.0 * material_.scale) {
                point_ = fresh();
                total.assign(n, 0.0);
            }
        }
    }
    double released() const { return released_; }

  private:
    UmatPoint fresh() const { return UmatPoint(name_, material_.kind, material_.props).celent(material_.celent); }
    double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
    Numbers direction(std::size_t n) {
        std::normal_distribution<double> normal;
        Numbers d(n);
        double sum = 0.0;
        for (double& x : d) x = normal(random_), sum += x * x;
        for (double& x : d) x /= std::sqrt(sum);
        return d;
    }

    void step(const Load& load) {
        const Numbers before = point_.state();
        const double spd = point_.spd();
        const Answer a = point_.step(load);
        ASSERT_TRUE(a.done()) << a.first_error();
        ASSERT_TRUE(finite(a.stress) && finite(a.state) && finite({a.sse, a.spd}) && a.tangent.allFinite());
        // Rounding of the stress power.
        const double rounding = 1e-14 * (a.sse + a.spd) + 1e-13 * largest(a.stress) * material_.scale;
        ASSERT_GE(a.spd, spd - rounding);
        const auto at = [](const Numbers& state, int entry) { return state[std::size_t(entry) - 1]; };
        for (const int entry : watched_.damage) {
            ASSERT_GE(at(a.state, entry), 0.0);
            ASSERT_LE(at(a.state, entry), 1.0);
            ASSERT_GE(at(a.state, entry), at(before, entry));
        }
        for (const int entry : watched_.dissipated) ASSERT_GE(at(a.state, entry), at(before, entry) - rounding);
        released_ += a.spd - spd;
    }

    std::string name_;
    Material material_;
    Watched watched_;
    bool phase_of_host_;
    std::mt19937 random_;
    UmatPoint point_;
    double released_ = 0.0;
};

// All materials of a model share the increments.
void walk(const std::string& keyword, std::vector<Material> materials, const Watched& watched,
          int source_property = 0) {
    LODE_NEEDS(keyword);
    const lode_model* model = find_model(keyword);
    for (const Material& m : samples_of(*model)) materials.push_back(m);
    const char* wanted = std::getenv("LODE_TEST_INCREMENTS");
    const int total = wanted != nullptr ? std::atoi(wanted) : 10000;
    const int each = total / static_cast<int>(materials.size()) + 1;
    std::uint32_t seed = 35;
    int damaged = 0, walks = 0;
    for (const Material& m : materials) {
        std::string constants;
        for (const double x : m.props) constants += " " + std::to_string(x);
        SCOPED_TRACE(keyword + ", kind " + std::to_string(static_cast<int>(m.kind)) + ", constants" + constants);
        const auto source = static_cast<std::size_t>(source_property);
        const double phase = source == 0 ? 1.0 : m.props.size() < source ? 0.0 : m.props[source - 1];
        if (phase == 2.0) continue;  // the temperature stays
        Walk one(keyword + "-TEST", m, watched, phase == 0.0, seed++);
        ASSERT_NO_FATAL_FAILURE(one.run(each));
        damaged += one.released() > 0.0;
        ++walks;
    }
    EXPECT_GE(2 * damaged, walks) << "most walks should get beyond the elastic range";
}

TEST(DamageRandom, IsoSoftening) {
    std::vector<Material> materials;
    for (const LawCode& law : laws)
        for (int surface = 0; surface < 5; ++surface)
            materials.push_back({{20000, 0.25, 5, 6, double(law.code), 0.1, double(law.code), 0.3, double(surface), 1.5,
                                  1, law.a1, law.a2, law.a1, law.a2, 0.01, 0.3},
                                 solid,
                                 2e-3,
                                 4.0});
    for (int surface = 0; surface < 3; ++surface) {
        Numbers by_steps = {20000, 0.25, 5, 6, 3, 0.1, 6, 0.3, double(surface), 1.5, 1, 0, 0, 1.5, 0, 0.01, 0.3};
        by_steps.resize(27, 0.0);
        by_steps[26] = 1;
        for (const AnalysisKind kind : {solid, plane_stress}) materials.push_back({by_steps, kind, 2e-3, 4.0});
    }
    walk("ISO_SOFTENING", materials, {{11, 12, 13}, {17, 18, 19, 22}});
}

TEST(DamageRandom, OrthoSoftening) { walk("ORTHO_SOFTENING", {}, {{11, 12, 13}, {17, 18, 19, 22}}); }

TEST(DamageRandom, IsoDamage) {
    std::vector<Material> materials;
    for (const LawCode& law : laws)
        for (int metric = 0; metric < 3; ++metric)
            for (const AnalysisKind kind : {solid, plane_stress})
                materials.push_back({{20000, 0.25, 4, double(law.code), 0.08, double(metric), 3, double(law.code), 0.2,
                                      law.a1, law.a2, law.a1, law.a2},
                                     kind,
                                     2e-3,
                                     5.0});
    walk("ISO_DAMAGE", materials, {{7}, {11}});
}

TEST(DamageRandom, PhaseField) {
    std::vector<Material> materials;
    const double degradations[][2] = {{1, 1}, {1, 0}, {1, 0.3}, {2, 3}, {3, 0}, {3, 0.9}, {4, 4}, {4, 0.5}};
    for (const auto& [law, argument] : degradations)
        for (const double part : {1.0, 2.0})
            for (const double source : {0.0, 1.0})
                for (const double k : {0.0, 1e-4})
                    for (const AnalysisKind kind : {solid, plane_strain, plane_stress})
                        if (source == 0.0 || kind != plane_stress)
                            materials.push_back(
                                {{30000, 0.2, 0.08, 5, law, argument, part, k, source}, kind, 1e-3, 1.0});
    for (const double part : {1.0, 2.0})
        for (const double method : {1.0, 2.0})
            materials.push_back({{30000, 0.2, 0.08, 5, 1, 1, part, 1e-4, 1, 0, 0, -1, method}, solid, 1e-3, 1.0});
    // PHI grows as the host lets it; HIST never falls.
    walk("PHASE_FIELD", materials, {{8, 16}, {7, 13}}, 9);
}

}  // namespace
}  // namespace lode::test::test_damage_random
