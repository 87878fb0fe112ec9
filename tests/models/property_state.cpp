// Properties of the update itself: zero increments, objectivity, energy, determinism.
#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstring>

#include "lode/material/property_places.hpp"
#include "property_suite.hpp"

namespace lode::test {
namespace {

// Small enough to stay on one branch, large enough to measure a slope.
constexpr double tiny = 1e-6;

class ZeroIncrement : public testing::TestWithParam<Case> {
  protected:
    // A material whose answer to a load path does not depend on time may be probed with DTIME > 0 as well.
    static bool is_rate_independent(const Case& c) {
        Numbers stress[2];
        for (const int k : {0, 1}) {
            Random random(c, 5);
            UmatPoint point = c.point();
            for (const Step& step : random_path(c, random)) {
                Load load = load_of(point, step);
                load.dtime = k == 0 ? 1.0 : 1e-3;
                point.step(load);
            }
            stress[k] = point.stress();
        }
        return identical(stress[0], stress[1]);
    }
};

// Several hosts probe with DSTRAN = 0: the stress stays (the yield tolerance is 1e-9), so does the state, and DDSDDE is
// that of an elastic increment, also on the yield surface.
TEST_P(ZeroIncrement, ChangesNothingAndReturnsTheElasticTangent) {
    const Case& c = GetParam();
    const bool rate_independent = is_rate_independent(c);
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(c, seed);
        UmatPoint point = c.point();
        for (const Step& step : random_path(c, random)) {
            if (!point.step(load_of(point, step)).done()) continue;
            // Viscous stress goes with the strain rate: only a second increment without strain changes nothing.
            if (c.has_trait(LODE_VISCOUS)) point.step({.dtime = 0.0});
            for (const double dtime : {0.0, 1.0}) {
                if (dtime > 0.0 && !rate_independent) continue;
                const Answer zero = point.evaluate({.dtime = dtime});
                ASSERT_TRUE(zero.done()) << zero.first_error();
                const double scale = std::max(c.stress_scale(), largest(point.stress()));
                EXPECT_LE(distance(zero.stress, point.stress()), 1e-9 * scale);
                // The history is the same if whatever comes next is. (Entries that report on the last increment, a rate
                // say, may differ.)
                Step next{scaled(random.direction(step.strain.size()), 0.3 * c.scale()), Matrix3d::Identity()};
                UmatPoint probed = point;
                probed.state(zero.state);
                const Answer after = point.evaluate(load_of(point, next));
                const Answer after_probe = probed.evaluate(load_of(point, next));
                ASSERT_EQ(after.done(), after_probe.done());
                EXPECT_LE(distance(after.stress, after_probe.stress), 1e-9 * scale);
                EXPECT_LE(std::abs(after.spd - after_probe.spd), 1e-9 * scale * c.scale());
                EXPECT_LE(std::abs(after.scd - after_probe.scd), 1e-9 * scale * c.scale());
                EXPECT_LE(std::abs(zero.spd - point.spd()), 1e-9 * scale * c.scale());
                EXPECT_LE(std::abs(zero.scd - point.scd()), 1e-9 * scale * c.scale());
                // The tangent of a small step back, which is elastic after a step ahead.
                Step back{scaled(step.strain, -tiny), Matrix3d::Identity()};
                Load load_back = load_of(point, back);
                load_back.dtime = dtime;
                Answer unloading = point.evaluate(load_back);
                // Where a rate-dependent law is above its yield stress at rest it may refuse to flow in no time.
                if (!rate_independent && dtime == 0.0 && !unloading.done()) continue;
                ASSERT_TRUE(unloading.done());
                // Tolerance: the elastic tangent varies by the relative size of the step; nonlinear laws by some tens
                // of it.
                const auto tangent_of_zero = [&] {
                    return (zero.tangent - unloading.tangent).cwiseAbs().maxCoeff() <=
                           100.0 * tiny * unloading.tangent.cwiseAbs().maxCoeff();
                };
                if (!c.is_cohesive() && (unloading.spd > point.spd() || !tangent_of_zero())) {
                    // At a vertex of the yield surface the way back may lead along another part of it (what so small a
                    // step dissipates may be lost to rounding): unload by compression.
                    Numbers compression(back.strain.size(), 0.0);
                    std::fill_n(compression.begin(), point.normals(), -tiny * largest(step.strain));
                    load_back.dstran = compression;
                    load_back.dfgrd1 = advanced(point.deformation_gradient(), {compression}, c.kind);
                    unloading = point.evaluate(load_back);
                    ASSERT_TRUE(unloading.done());
                }
                if (c.has_trait(LODE_VISCOUS)) continue;
                // A yield stress that falls with the rate is exceeded on the way back as well.
                if (!rate_independent && unloading.spd > point.spd()) continue;
                EXPECT_TRUE(tangent_of_zero()) << "zero increment\n"
                                               << zero.tangent << "\nsmall step back\n"
                                               << unloading.tangent;
            }
        }
    }
}

class Objectivity : public testing::TestWithParam<Case> {};

// The same path with a rotation put on top of each increment: stress turns with it, energies stay.
TEST_P(Objectivity, UnderSuperposedRotation) {
    const Case& c = GetParam();
    if (c.is_cohesive() || c.kind == AnalysisKind::uniaxial) return;  // their frame is that of the element
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    for (std::uint64_t seed = 1; seed <= 16; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(c, seed);
        UmatPoint plain = c.point(), turned = c.point(), nudged = c.point();
        Random noise(c, 100 + seed);
        Matrix3d q = Matrix3d::Identity();  // the rotation on top
        double strain = 0.0, stress = c.stress_scale(), count = 0.0, tolerance = 0.0, grown = 0.0;
        Numbers reached(turned.state().size(), 0.0);  // what an entry holds is rounded at the size it has had
        for (const Step& step : random_path(c, random)) {
            const Matrix3d drot = random.rotation(c.kind, 1.0);
            q = drot * q;
            Load load = load_of(plain, step);
            Load turned_load = load;
            turned_load.dstran = rotated_strain(load.dstran, c.kind, q);
            turned_load.drot = drot;
            turned_load.dfgrd1 = q * *load.dfgrd1;
            const bool virgin = plain.spd() == 0.0;
            Step nudged_step = step;
            for (double& e : nudged_step.strain) e += noise.uniform(-4.0, 4.0) * epsilon * largest(step.strain);
            nudged.step(load_of(nudged, nudged_step));
            const Answer a = plain.step(load), b = turned.step(turned_load);
            ASSERT_EQ(a.done(), b.done());
            // Of equivalent directions of damage each frame has chosen its own: go on with those of one.
            if (c.has_trait(LODE_FRAME_CHOICE) && virgin && plain.spd() > 0.0) {
                turned = nudged = plain;
                turned.step({.dfgrd1 = turned_load.dfgrd1, .drot = q});
            }
            for (std::size_t i = 0; i < reached.size(); ++i)
                reached[i] = std::max(reached[i], std::abs(turned.state()[i]));
            strain += largest(step.strain);
            stress = std::max(stress, largest(plain.stress()));
            ++count;
            // Rotating a tensor there costs about ten roundings of the elastic predictor and so does the update; what
            // an increment leaves is carried on by the following ones.
            // F itself is of order 1 and so are its rounding errors.
            const double size = c.reads_deformation ? 1.0 + strain : strain;
            // The directions of cracks can magnify them: by as much as they do a rounding of the strain.
            grown = std::max(grown, distance(plain.stress(), nudged.stress()));
            tolerance = std::max(40.0 * count * epsilon * std::max(stress, c.stiffness * size), 10.0 * grown);
            ASSERT_LE(distance(rotated_stress(plain.stress(), c.kind, q), turned.stress()), tolerance);
            const double energy_tolerance = tolerance * std::max(strain, c.scale());
            EXPECT_NEAR(plain.sse(), turned.sse(), energy_tolerance);
            EXPECT_NEAR(plain.spd(), turned.spd(), energy_tolerance);
            EXPECT_NEAR(plain.scd(), turned.scd(), energy_tolerance);
        }
        // Turned back, tensors kept in STATEV are what they would have been. Entries may have any unit: rounding
        // errors are compared with the neighbours, among which are the other components.
        plain.step({});
        nudged.step({});
        turned.step({.dfgrd1 = plain.deformation_gradient(), .drot = q.transpose()});
        // Normals of cracks and other directions magnify what the stress is off by.
        const double relative = 3.0 * tolerance / c.stress_scale();
        const Numbers &a = plain.state(), &b = turned.state(), &near = nudged.state();
        for (std::size_t i = 0; i < a.size(); ++i) {
            double size = c.scale(), difference = 0.0;
            for (std::size_t k = i > 8 ? i - 8 : 0; k < std::min(a.size(), i + 9); ++k) {
                size = std::max({size, std::abs(a[k]), reached[k]});
                difference = std::max(difference, std::abs(a[k] - near[k]));
            }
            EXPECT_NEAR(a[i], b[i], std::max(relative * size, 10.0 * difference)) << "STATEV(" << i + 1 << ")";
        }
    }
}

class HostProfile : public testing::TestWithParam<Case> {};

// A host that keeps stress and state in the unrotated frame (CalculiX, known by PNEWDT = -1 on entry): DROT means
// nothing, and F = R U is read as U. It has no field variables and knows no element length: a model that needs one is
// refused.
TEST_P(HostProfile, UnrotatedFrame) {
    const Case& c = GetParam();
    Random random(c, 13);
    UmatPoint point = c.point();
    point.celent(0.0);
    for (const Step& step : random_path(c, random)) {
        point.fields(Numbers(point.fields().size(), 0.0));
        const Load load = load_of(point, step);
        const Matrix3d q = random.rotation(c.kind, 3.0);
        Load plain{.dstran = load.dstran}, turned{.dstran = load.dstran, .drot = q, .pnewdt = -1.0};
        const Eigen::SelfAdjointEigenSolver<Matrix3d> stretch(load.dfgrd1->transpose() * *load.dfgrd1);
        plain.dfgrd1 = stretch.operatorSqrt();
        turned.dfgrd1 = q * *plain.dfgrd1;
        const Answer a = point.evaluate(plain), b = point.evaluate(turned);
        ASSERT_EQ(a.done(), b.done());
        ASSERT_EQ(a.messages.stops, b.messages.stops);
        if (a.messages.stops > 0) return;
        // The stretch is found again but for rounding.
        const double size = c.reads_deformation ? 64.0 * std::numeric_limits<double>::epsilon() * c.stiffness : 0.0;
        EXPECT_LE(distance(a.stress, b.stress), size);
        const double units =
            std::max({1.0, largest(a.state), largest(a.stress), c.reads_deformation ? c.temperature() : 0.0});
        EXPECT_LE(distance(a.state, b.state), size / c.stiffness * units);
        EXPECT_LE((a.tangent - b.tangent).cwiseAbs().maxCoeff(), 10.0 * size);
        EXPECT_EQ(b.pnewdt, a.done() ? -1.0 : a.pnewdt);
        point.step(load);
    }
}

class Energy : public testing::TestWithParam<Case> {
  protected:
    struct Balance {
        double error = 0.0, work = 0.0;  // work: sum of the magnitudes
        bool done = true;
    };
    // A smooth path of loading, turning and partial unloading in `steps` increments.
    static Balance balance(const Case& c, int steps, double amplitude, std::uint64_t seed) {
        Random random(c, seed);
        const auto n = static_cast<std::size_t>(components(c.kind));
        Numbers a = random.direction(n), b = random.direction(n);
        if (c.is_cohesive()) a[0] = std::abs(a[0]), b[0] = std::abs(b[0]);
        const auto strain = [&](double t) {
            Numbers e(n);
            for (std::size_t i = 0; i < n; ++i)
                e[i] = amplitude * (a[i] * std::sin(2.5 * t) + b[i] * (1.0 - std::cos(2.0 * t)));
            return e;
        };
        UmatPoint point = c.point();
        Balance result;
        double dissipated = 0.0, work = 0.0;
        const double stored_first = jacobian(c, point) * point.evaluate({.dtime = 0.0}).sse;
        for (int i = 1; i <= steps; ++i) {
            Step step{strain(static_cast<double>(i) / steps), Matrix3d::Identity()};
            const Numbers before = strain(static_cast<double>(i - 1) / steps);
            for (std::size_t k = 0; k < n; ++k) step.strain[k] -= before[k];
            const Numbers stress_old = point.stress();
            const double j_old = jacobian(c, point), spd_old = point.spd(), scd_old = point.scd();
            Load load = load_of(point, step);
            load.dtime = 1.0 / steps;
            if (!point.step(load).done()) return {0.0, 0.0, false};
            const double j = jacobian(c, point);
            dissipated += j * (point.spd() - spd_old + point.scd() - scd_old);
            double increment = 0.0;
            for (std::size_t k = 0; k < n; ++k)
                increment += 0.5 * (j_old * stress_old[k] + j * point.stress()[k]) * step.strain[k];
            work += increment;
            result.work += std::abs(increment);
        }
        result.error = std::abs(jacobian(c, point) * point.sse() - stored_first + dissipated - work);
        return result;
    }
    static double order(const Case& c) {
        for (int i = 0; i < c.model->algorithm_count; ++i) {
            const lode_algorithm& a = c.model->algorithms[i];
            const int index = property_index(*c.model, a.parameter, c.sample->constants, c.sample->constant_count);
            const bool chosen =
                index > 0 && index <= c.sample->constant_count && c.sample->constants[index - 1] == a.value;
            if (chosen) return std::min(2.0, a.order);
        }
        return c.model->algorithm_count > 0 ? std::min(2.0, c.model->algorithms[0].order) : 1.0;
    }
};

// SSE + SPD + SCD is the integral of the stress power. The trapezoid rule of this test is of second order, the
// algorithm of its own: a quarter of the increment divides the error by 4 to the smaller of the two, or there is none.
TEST_P(Energy, BalancesStressPower) {
    const Case& c = GetParam();
    if (c.has_trait(LODE_EQUATION_OF_STATE)) return;  // heat and the ambient pressure work as well
    if (c.has_trait(LODE_OPEN_ENERGY)) return;
    if (c.is_total_law() || c.has_trait(LODE_ENERGY_ESTIMATE)) {
        // Not derived from an energy (page 10, 1.7): what SSE misses is of the order of the strain.
        const Balance large = balance(c, 400, c.scale(), 1), small = balance(c, 400, 0.25 * c.scale(), 1);
        ASSERT_TRUE(large.done && small.done);
        const double strain = 10.0 * c.scale();
        EXPECT_LE(large.error, strain * large.work);
        EXPECT_LE(small.error, 0.25 * strain * small.work);
        return;
    }
    // Events (yield, reversal, opening) fall anywhere in an increment, so errors are those of the worst of several
    // sizes.
    const auto worst = [&c](std::uint64_t seed, int steps) {
        Balance most;
        for (const double part : {0.76, 0.85, 1.0, 1.11, 1.18}) {
            const Balance one = balance(c, static_cast<int>(part * steps), c.scale(), seed);
            most.done = most.done && one.done;
            most.error = std::max(most.error, one.error);
            most.work = std::max(most.work, one.work);
        }
        return most;
    };
    int measured = 0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        // Terms of first and second order may cancel in large increments: then smaller ones tell.
        bool converges = false;
        Balance coarse = worst(seed, 128), fine;
        if (!coarse.done) continue;
        ++measured;
        std::string history = std::to_string(coarse.error / coarse.work);
        for (int steps = 512; steps <= 8192 && !converges; steps *= 4) {
            fine = worst(seed, steps);
            ASSERT_TRUE(fine.done);
            const double rounding = 1e-14 * steps * fine.work;
            converges = fine.error <= coarse.error / std::pow(4.0, order(c)) * 1.6 + rounding;
            EXPECT_LE(fine.error, std::pow(16.0 / steps, order(c)) * fine.work + rounding);
            history += " " + std::to_string(fine.error / fine.work);
            coarse = fine;
        }
        EXPECT_TRUE(converges) << "relative errors, increments divided by four: " << history;
    }
    EXPECT_GE(measured, 3);
}

// No history: a closed path gives all the energy back.
TEST_P(Energy, IsRecoveredOnClosedPaths) {
    const Case& c = GetParam();
    if (!c.has_trait(LODE_ELASTIC)) return;
    Random random(c, 3);
    const Numbers direction = random.direction(static_cast<std::size_t>(components(c.kind)));
    UmatPoint point = c.point();
    const Numbers stress = point.evaluate({}).stress;
    const int steps = 16;
    for (int i = 0; i < 2 * steps; ++i) {
        const Answer answer = point.advance(
            load_of(point, {scaled(direction, (i < steps ? 1.0 : -1.0) * c.scale() / steps), Matrix3d::Identity()}));
        EXPECT_EQ(answer.spd, 0.0);
        EXPECT_EQ(answer.scd, 0.0);
    }
    // F itself is of order 1 and so are its rounding errors.
    const double size = c.reads_deformation ? 1.0 : c.scale();
    const double rounding = 8.0 * steps * std::numeric_limits<double>::epsilon() * c.stiffness * size;
    EXPECT_LE(distance(point.stress(), stress), rounding + 1e-14 * largest(stress));
    EXPECT_LE(std::abs(point.sse()), rounding * (c.scale() + largest(stress) / c.stiffness));
}

class Determinism : public testing::TestWithParam<Case> {};

TEST_P(Determinism, TheSameCallGivesTheSameBits) {
    const Case& c = GetParam();
    Random random(c, 31);
    UmatPoint point = c.point();
    for (const Step& step : random_path(c, random)) {
        const Load load = load_of(point, step);
        const Answer a = point.evaluate(load), b = point.evaluate(load);
        EXPECT_TRUE(identical(a.stress, b.stress));
        EXPECT_TRUE(identical(a.state, b.state));
        EXPECT_TRUE(identical(a.ddsddt, b.ddsddt));
        EXPECT_TRUE(identical({a.sse, a.spd, a.scd, a.rpl, a.drpldt, a.pnewdt},
                              {b.sse, b.spd, b.scd, b.rpl, b.drpldt, b.pnewdt}));
        EXPECT_EQ(std::memcmp(a.tangent.data(), b.tangent.data(),
                              sizeof(double) * static_cast<std::size_t>(a.tangent.size())),
                  0);
        point.step(load);
    }
}

LODE_FOR_ALL_CASES(ZeroIncrement);
LODE_FOR_ALL_CASES(Objectivity);
LODE_FOR_ALL_CASES(HostProfile);
LODE_FOR_ALL_CASES(Energy);
LODE_FOR_ALL_CASES(Determinism);

}  // namespace
}  // namespace lode::test
