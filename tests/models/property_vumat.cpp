// The explicit entry point computes what the implicit one does, whatever the block looks like.
#include <dlfcn.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <thread>

#include "property_suite.hpp"
#include "vumat_block.hpp"

namespace lode::test {
namespace {

Matrix3d stretch_of(const Matrix3d& f) {
    const Matrix3d u = Eigen::SelfAdjointEigenSolver<Matrix3d>(f.transpose() * f).operatorSqrt();
    return 0.5 * (u + u.transpose());  // exactly symmetric: a VUMAT is given one half of it
}

// A material point somewhere on its path, and the increment that comes next, without rotation.
struct Situation {
    UmatPoint point;
    Load load;
};

// As many situations as asked for, all different: virgin points, loading, unloading, small and large increments, so
// that neighbours in a block take different branches.
std::vector<Situation> situations(const Case& c, std::size_t count, std::uint64_t first_seed = 1) {
    std::vector<Situation> all;
    for (std::uint64_t seed = first_seed; all.size() < count; ++seed) {
        Random random(c, seed);
        UmatPoint point = c.point();
        for (Step& step : random_path(c, random)) {
            UmatPoint start = point;
            start.deformation_gradient(stretch_of(point.deformation_gradient()));
            Step next = step;
            if (random.chance(0.3)) next.strain = scaled(step.strain, random.log_uniform(1e-6, 1.0));
            Load load = load_of(start, next);
            load.dfgrd1 = stretch_of(*load.dfgrd1);
            load.dtemp = static_cast<double>(all.size() % 5) - 2.0;
            const Answer answer = start.evaluate(load);
            if (answer.done() && all.size() < count && random.chance(0.5)) all.push_back({start, load});
            point.step(load_of(point, step));
        }
    }
    return all;
}

VumatPoint block_point(const UmatPoint& p, const Load& load) {
    VumatPoint v;
    v.stress = p.stress();
    v.state = p.state();
    v.strain_increment = load.dstran;
    v.stretch = *load.dfgrd1;
    v.temperature_old = p.temperature();
    v.temperature_new = p.temperature() + load.dtemp;
    v.fields_old = v.fields_new = p.fields();
    v.celent = p.celent();
    v.density = 2.0;
    v.internal_energy = 0.5;
    v.inelastic_energy = 0.25;
    return v;
}

VumatBlock block_of(const Case& c, const std::vector<Situation>& all, std::size_t count) {
    VumatBlock block(c.point());
    for (std::size_t i = 0; i < count; ++i) block.points.push_back(block_point(all[i].point, all[i].load));
    block.total_time = all.front().point.total_time() + all.front().load.dtime;
    return block;
}

bool identical_points(const VumatPoint& a, const VumatPoint& b) {
    return identical(a.stress, b.stress) && identical(a.state, b.state) &&
           identical({a.internal_energy, a.inelastic_energy, a.thickness_strain_increment},
                     {b.internal_energy, b.inelastic_energy, b.thickness_strain_increment});
}

class Vumat : public testing::TestWithParam<Case> {};

TEST_P(Vumat, AgreesWithUmat) {
    const Case& c = GetParam();
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    const std::vector<Situation> all = situations(c, 144);
    VumatBlock block = block_of(c, all, all.size());
    ASSERT_EQ(block.run().stops, 0);
    for (std::size_t i = 0; i < all.size(); ++i) {
        SCOPED_TRACE("point " + std::to_string(i + 1));
        const Situation& s = all[i];
        const Answer umat = s.point.evaluate(s.load);
        const VumatPoint& vumat = block.points[i];
        // The two are compiled with different vector units: sums may be fused and functions differ in the last place.
        // What counts is the elastic predictor of the increment, from which the stress comes by cancellation.
        const double scale = std::max(
            {c.stress_scale(), largest(s.point.stress()), largest(umat.stress), c.stiffness * largest(s.load.dstran)});
        EXPECT_LE(distance(vumat.stress, umat.stress), 16.0 * epsilon * scale);
        // STATEV holds strains, stresses and energies, each with the rounding errors of its kind.
        // What rounding of the stress, the strain and the increment does to an entry counts as well (damage at its
        // onset, eigenvectors).
        const double strain = scale / c.stiffness, grown = 1.0 + 64.0 * epsilon;
        Load rounded = s.load;
        rounded.dstran = scaled(s.load.dstran, grown);
        // Some laws keep the strain instead of the stress.
        for (std::size_t k = 0; k < rounded.dstran.size(); ++k)
            rounded.dstran[k] += (grown - 1.0) * s.point.strain()[k];
        // A host of VUMAT gives temperatures, not their difference.
        rounded.dtemp += (grown - 1.0) * s.point.temperature();
        const Answer neighbour = UmatPoint(s.point).stress(scaled(s.point.stress(), grown)).evaluate(rounded);
        for (std::size_t k = 0; k < umat.state.size(); ++k) {
            const double size = std::max(std::abs(umat.state[k]), strain * std::max(1.0, largest(umat.stress)));
            const double conditioning = std::abs(neighbour.state[k] - umat.state[k]);
            EXPECT_NEAR(vumat.state[k], umat.state[k], 64.0 * epsilon * size + conditioning)
                << "STATEV(" << k + 1 << ")";
        }
        // Trapezoid rule, or the stored energy itself where there is one.
        double stored = 2.0 * 0.5;
        for (std::size_t k = 0; k < umat.stress.size(); ++k)
            stored += 0.5 * (s.point.stress()[k] + umat.stress[k]) * s.load.dstran[k];
        const double dissipated = umat.spd - s.point.spd() + umat.scd - s.point.scd();
        if (c.has_trait(LODE_FINITE_STRAIN)) stored = umat.sse + dissipated + 0.25 * vumat.density;
        // An explicit host wants the internal energy, in which an equation of state counts the heat.
        if (!c.has_trait(LODE_EQUATION_OF_STATE)) {
            EXPECT_NEAR(vumat.internal_energy * vumat.density, stored,
                        64.0 * epsilon * (scale * std::max(c.scale(), largest(s.load.dstran)) + 1.0));
        }
        EXPECT_NEAR((vumat.inelastic_energy - 0.25) * vumat.density, dissipated,
                    64.0 * epsilon * (scale * c.scale() + vumat.density));
    }
}

// A point's answer does not depend on how many others there are or where it stands among them: bit for bit.
TEST_P(Vumat, AnswersDoNotDependOnTheBlock) {
    const Case& c = GetParam();
    for (const std::uint64_t seed : {1u, 1001u, 2001u}) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const std::vector<Situation> all = situations(c, 144, seed);
        VumatBlock reference = block_of(c, all, all.size());
        ASSERT_EQ(reference.run().stops, 0);
        for (const std::size_t size : {std::size_t{1}, std::size_t{7}, std::size_t{8}, std::size_t{128}}) {
            SCOPED_TRACE("block of " + std::to_string(size));
            VumatBlock block = block_of(c, all, size);
            ASSERT_EQ(block.run().stops, 0);
            for (std::size_t i = 0; i < size; ++i)
                EXPECT_TRUE(identical_points(block.points[i], reference.points[i])) << i + 1;
        }
        VumatBlock reversed = block_of(c, all, all.size());
        std::reverse(reversed.points.begin(), reversed.points.end());
        ASSERT_EQ(reversed.run().stops, 0);
        std::reverse(reversed.points.begin(), reversed.points.end());
        for (std::size_t i = 0; i < all.size(); ++i)
            EXPECT_TRUE(identical_points(reversed.points[i], reference.points[i])) << i + 1;
    }
}

// stepTime = totalTime = 0 is a probe with made-up strains: an elastic answer, no history.
TEST_P(Vumat, ProbeIsElastic) {
    const Case& c = GetParam();
    const UmatPoint point = c.point();
    VumatBlock block(point);
    Random random(c, 11);
    const Answer virgin = point.evaluate({.dtime = 0.0});
    for (int i = 0; i < 9; ++i) {
        VumatPoint p = block.fresh_point();
        p.stress = virgin.stress;
        p.strain_increment = scaled(random.direction(p.stress.size()), 100.0 * c.scale());
        block.points.push_back(p);
    }
    const std::vector<VumatPoint> before = block.points;
    block.step_time = block.total_time = 0.0;
    ASSERT_EQ(block.run().stops, 0);
    for (std::size_t i = 0; i < before.size(); ++i) {
        const Eigen::Map<const Eigen::VectorXd> e(before[i].strain_increment.data(), point.size());
        if (c.has_trait(LODE_EQUATION_OF_STATE)) {
            // The adiabatic stiffness, which bounds that of the mode.
            double work = 0.0;
            for (std::size_t k = 0; k < before[i].stress.size(); ++k)
                work += (block.points[i].stress[k] - before[i].stress[k]) * before[i].strain_increment[k];
            EXPECT_GE(work, e.dot(virgin.tangent * e) * (1.0 - 1e-12));
            EXPECT_TRUE(identical(block.points[i].state, before[i].state));
            continue;
        }
        const Eigen::VectorXd expected =
            virgin.tangent * e + Eigen::Map<const Eigen::VectorXd>(virgin.stress.data(), point.size());
        for (int k = 0; k < point.size(); ++k)
            EXPECT_NEAR(block.points[i].stress[static_cast<std::size_t>(k)], expected(k),
                        100.0 * c.stress_scale() * 1e-14);
        EXPECT_TRUE(identical(block.points[i].state, before[i].state));
        EXPECT_EQ(block.points[i].inelastic_energy, before[i].inelastic_energy);
    }
}

// The thickness strain that a plane-stress host gets leaves a point of three dimensions without stress across it, and
// with the same stress in the plane.
TEST_P(Vumat, ThicknessStrainFreesTheSolid) {
    const Case& c = GetParam();
    const Case* const solid = find_case(c, AnalysisKind::solid);
    if (c.kind != AnalysisKind::plane_stress || solid == nullptr) return;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(c, seed);
        const UmatPoint point = c.point();
        const Step step{scaled(random.direction(3), c.scale() * random.log_uniform(1e-3, 1.0))};
        Load load = load_of(point, step);
        load.dfgrd1 = stretch_of(*load.dfgrd1);
        VumatBlock block(point);
        block.points.push_back(block_point(point, load));
        if (block.run().stops > 0) continue;
        const VumatPoint& p = block.points[0];
        const double e33 = p.thickness_strain_increment;
        Matrix3d f = *load.dfgrd1;
        // The total laws are in V - I.
        f(2, 2) = c.is_total_law() ? 1.0 + e33 : std::exp(e33);
        const Answer free = solid->point().evaluate(
            {.dstran = {load.dstran[0], load.dstran[1], e33, load.dstran[2], 0.0, 0.0}, .dfgrd1 = f});
        if (!free.done()) continue;
        const double size = std::max(largest(p.stress), c.stiffness * largest(load.dstran));
        EXPECT_NEAR(free.stress[2], 0.0, 1e-9 * size);
        for (const auto& [plane, whole] : {std::pair{0, 0}, {1, 1}, {2, 3}})
            EXPECT_NEAR(p.stress[static_cast<std::size_t>(plane)], free.stress[static_cast<std::size_t>(whole)],
                        1e-9 * size);
    }
}

// The first increment of a later step is none.
TEST_P(Vumat, StepTimeZeroAloneIsNoProbe) {
    const Case& c = GetParam();
    const std::vector<Situation> all = situations(c, 9);
    VumatBlock usual = block_of(c, all, all.size()), first = usual;
    first.step_time = 0.0;
    ASSERT_EQ(usual.run().stops, 0);
    ASSERT_EQ(first.run().stops, 0);
    for (std::size_t i = 0; i < all.size(); ++i) EXPECT_TRUE(identical_points(first.points[i], usual.points[i]));
}

TEST_P(Vumat, StopsAtNonFiniteInput) {
    const Case& c = GetParam();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const std::vector<Situation> all = situations(c, 21);
    const VumatBlock healthy = block_of(c, all, all.size());
    const std::size_t n = healthy.points.front().stress.size(), places[] = {0, 9, 20};
    const auto expect_stop = [&](VumatBlock block, std::size_t point) {
        const HostMessages messages = block.run();
        EXPECT_EQ(messages.stops, 1);
        ASSERT_EQ(messages.errors.size(), 1u);
        EXPECT_EQ(messages.explicit_calls, 2);
        EXPECT_NE(messages.errors.front().find(c.model->keyword), std::string::npos);
        EXPECT_NE(messages.errors.front().find("point " + std::to_string(point + 1) + " "), std::string::npos)
            << messages.errors.front();
    };
    std::size_t turn = 0;
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity})
        for (std::size_t i = 0; i < n; ++i) {
            const std::size_t point = places[turn++ % 3];
            SCOPED_TRACE("component " + std::to_string(i + 1) + " = " + std::to_string(bad));
            VumatBlock strained = healthy, stressed = healthy;
            strained.points[point].strain_increment[i] = bad;
            expect_stop(strained, point);
            stressed.points[point].stress[i] = bad;
            expect_stop(stressed, point);
        }
    VumatBlock massless = healthy;
    massless.points[9].density = std::numeric_limits<double>::quiet_NaN();
    expect_stop(massless, 9);
}

// What a material does not read it need not mind.
TEST_P(Vumat, NonFiniteTemperatureStopsOrIsNotRead) {
    const Case& c = GetParam();
    const std::vector<Situation> all = situations(c, 9);
    for (double VumatPoint::*const which : {&VumatPoint::temperature_old, &VumatPoint::temperature_new})
        for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
            VumatBlock block = block_of(c, all, all.size());
            block.points[4].*which = bad;
            if (block.run().stops > 0) continue;
            const VumatPoint& p = block.points[4];
            EXPECT_TRUE(std::isfinite(distance(p.stress, p.stress)));
            EXPECT_TRUE(std::isfinite(p.internal_energy) && std::isfinite(p.inelastic_energy));
        }
}

// Not inlined: GCC 12 vectorizes neighbouring conversions to float and back wrongly and forgets one of them.
[[gnu::noinline]] double as_float(double x) { return static_cast<double>(static_cast<float>(x)); }
void round_all(Numbers& v) {
    for (double& x : v) x = as_float(x);
}
VumatPoint in_single_precision(VumatPoint p) {
    round_all(p.stress);
    round_all(p.state);
    round_all(p.strain_increment);
    p.stretch = p.stretch.unaryExpr(&as_float);
    p.celent = as_float(p.celent);
    p.temperature_old = as_float(p.temperature_old);
    p.temperature_new = as_float(p.temperature_new);
    return p;
}

VumatFunctionOf<float> single_precision_vumat() {
    static void* const library = dlopen(LODE_SINGLE_PRECISION_LIBRARY, RTLD_NOW | RTLD_LOCAL);
    return library == nullptr ? nullptr : reinterpret_cast<VumatFunctionOf<float>>(dlsym(library, "vumat_"));
}

// Single precision is double precision between rounded arrays: with inputs that floats can hold, the answer is the
// rounded one of the double library, exactly.
TEST_P(Vumat, SinglePrecisionIsTheRoundedResult) {
    const Case& c = GetParam();
    ASSERT_NE(single_precision_vumat(), nullptr) << dlerror();
    const std::vector<Situation> all = situations(c, 144);
    Numbers props = c.props();
    round_all(props);
    const UmatPoint prototype = UmatPoint(c.material(), c.kind, props).state(c.point().state());
    for (const std::size_t size : {std::size_t{7}, std::size_t{144}}) {
        VumatBlock single(prototype);
        for (std::size_t i = 0; i < size; ++i) {
            single.points.push_back(in_single_precision(block_point(all[i].point, all[i].load)));
        }
        VumatBlock twice = single;
        const HostMessages a = single.run_with(single_precision_vumat()), b = twice.run();
        ASSERT_EQ(a.stops, b.stops);
        if (b.stops > 0) continue;  // rounding may push a point where the model cannot go; both say so
        for (std::size_t i = 0; i < size; ++i) {
            VumatPoint& expected = twice.points[i];
            const VumatPoint& actual = single.points[i];
            round_all(expected.stress);
            round_all(expected.state);
            EXPECT_EQ(actual.stress, expected.stress) << i + 1;
            EXPECT_EQ(actual.state, expected.state) << i + 1;
            EXPECT_EQ(actual.internal_energy, as_float(expected.internal_energy));
            EXPECT_EQ(actual.inelastic_energy, as_float(expected.inelastic_energy));
            EXPECT_EQ(actual.thickness_strain_increment, as_float(expected.thickness_strain_increment));
        }
    }
}

// Blocks of all materials in both precisions by several threads at once: bit for bit the serial results.
TEST(VumatThreads, GiveTheSerialResults) {
    ASSERT_NE(single_precision_vumat(), nullptr) << dlerror();
    std::vector<VumatBlock> blocks, serial, serial_single;
    for (const Case& c : all_cases()) blocks.push_back(block_of(c, situations(c, 70), 70));
    const auto in_single = [](VumatBlock block) {
        for (VumatPoint& p : block.points) p = in_single_precision(p);
        block.run_with(single_precision_vumat());
        return block;
    };
    const auto in_double = [](VumatBlock block) {
        block.run();
        return block;
    };
    for (const VumatBlock& block : blocks) {
        serial.push_back(in_double(block));
        serial_single.push_back(in_single(block));
    }
    const auto same = [](const VumatBlock& a, const VumatBlock& b) {
        return std::equal(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(), identical_points);
    };
    std::array<std::vector<std::size_t>, 4> different;
    {
        std::vector<std::jthread> running;
        for (std::size_t t = 0; t < different.size(); ++t)
            running.emplace_back([&, t] {
                for (std::size_t i = 0; i < blocks.size(); ++i) {
                    const std::size_t k = t % 2 == 0 ? i : blocks.size() - 1 - i;
                    if (!same(in_double(blocks[k]), serial[k]) || !same(in_single(blocks[k]), serial_single[k]))
                        different[t].push_back(k);
                }
            });
    }
    for (const std::vector<std::size_t>& some : different)
        for (const std::size_t k : some) ADD_FAILURE() << all_cases()[k].name();
}

LODE_FOR_ALL_CASES(Vumat);

}  // namespace
}  // namespace lode::test
