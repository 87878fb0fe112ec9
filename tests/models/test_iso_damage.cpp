// ISO_DAMAGE against the verification cases of page 35, section 12.1 (to the digits printed there), every failure mode
// of section 6 with the documented answer, and the energy that a complete failure takes.
#include <Eigen/Geometry>
#include <random>

#include "damage_support.hpp"
#include "lode/damage/iso_damage.hpp"

namespace lode::test::test_iso_damage {
namespace {

using namespace damage_cases;
using namespace iso_damage;
using enum AnalysisKind;

// The base material of section 12.1, PROPS from METRIC on in `rest`.
Numbers base(int law, const Numbers& rest = {}) {
    Numbers props = {20000, 0.25, 4, double(law), 0.08};
    props.insert(props.end(), rest.begin(), rest.end());
    return props;
}
UmatPoint made(AnalysisKind kind, const Numbers& props, double celent = 5.0) {
    return UmatPoint("ISO_DAMAGE-TEST", kind, props).celent(celent);
}

TEST(IsoDamage, D1_UniaxialStrain) {
    const std::vector<Numbers> path = {{3e-4, 0, 0, 0, 0, 0},
                                       {5e-4, 0, 0, 0, 0, 0},
                                       {-6e-4, 0, 0, 0, 0, 0},
                                       {-5e-4, 0, 0, 0, 0, 0},
                                       {8e-3, 0, 0, 0, 0, 0}};
    UmatPoint point = made(solid, base(1));
    const std::vector<Answer> a = follow(point, path);
    const double rows[5][5] = {{4.30951842056, 1.43650614019, 0.401455774923, 1.3193183026e-4, 2.63863660519e-4},
                               {4.00182611286, 1.33394203762, 0.791571556622, 6.93698555906e-4, 1.38739711181e-3},
                               {1.00045652822, 0.333485509405, 0.791571556622, 6.93698555906e-4, 1.38739711181e-3},
                               {-1.50068479232, -0.500228264108, 0.791571556622, 6.93698555906e-4, 1.38739711181e-3},
                               {0, 0, 1, 8e-3, 0.016}};
    for (std::size_t i = 0; i < 5; ++i) {
        SCOPED_TRACE("step " + std::to_string(i + 1));
        expect_printed(a[i].stress, {rows[i][0], rows[i][1], rows[i][1], 0, 0, 0}, 20.0);
        expect_printed(entry(a[i], D), rows[i][2]);
        expect_printed(entry(a[i], DELTA_N), rows[i][3]);
        expect_printed(entry(a[i], W), rows[i][4]);
        EXPECT_NEAR(a[i].spd, entry(a[i], W), 1e-16);
        EXPECT_EQ(entry(a[i], STATE), i < 4 ? 1.0 : 2.0);
        EXPECT_EQ(entry(a[i], H), 5.0);
        EXPECT_EQ(entry(a[i], MODE), 1.0);
        EXPECT_EQ(entry(a[i], STATUS), 1.0);
    }
    // 1 - D times the energy of the effective stress.
    expect_printed(a[2].sse, 0.5 * 1.00045652822 * 2e-4);
    expect_same_in_vumat(made(solid, base(1)), path);
}

const std::vector<Numbers> path_d2 = {
    {2e-4, -2e-5, 3e-5, 6e-5, 2e-5, 4e-5}, {1.5e-4, 2e-5, 6e-5, 2.4e-4, -1.2e-4, 1e-4}, {-1e-4, 0, 0, 0, 0, 0}};

TEST(IsoDamage, D2_StrainEnergyExponential) {
    UmatPoint point = made(solid, base(2));
    const std::vector<Answer> a = follow(point, path_d2);
    expect_printed(a[0].stress,
                   {4.20927212079, 1.17307583694, 1.86312044691, 0.414026765979, 0.138008921993, 0.276017843986});
    expect_printed(a[1].stress,
                   {3.53608965651, 1.36480653409, 1.92313647986, 0.930549909608, -0.310183303203, 0.434256624484});
    expect_printed(a[2].stress,
                   {2.6055397469, 1.05462323089, 1.61295317665, 0.930549909608, -0.310183303203, 0.434256624484});
    const double damage[] = {0.137444237544, 0.612270870997, 0.612270870997},
                 released[] = {6.32356438912e-5, 5.86455383561e-4, 5.86455383561e-4};
    for (std::size_t i = 0; i < 3; ++i) {
        expect_printed(entry(a[i], D), damage[i]);
        expect_printed(entry(a[i], W), released[i]);
    }
    expect_same_in_vumat(made(solid, base(2)), path_d2);
}

TEST(IsoDamage, D3_TensileEnergySmoothStep) {
    UmatPoint point = made(solid, base(3, {1}));
    const std::vector<Answer> a = follow(point, path_d2);
    expect_printed(a[0].stress,
                   {4.24249716027, 1.18233527417, 1.87782661192, 0.41729480265, 0.13909826755, 0.2781965351});
    expect_printed(a[1].stress,
                   {3.7916257515, 1.46343450058, 2.06211225082, 0.997796250395, -0.332598750132, 0.465638250184});
    expect_printed(a[2].stress,
                   {2.79382950111, 1.13083575045, 1.72951350068, 0.997796250395, -0.332598750132, 0.465638250184});
    const double damage[] = {0.130635827813, 0.584251562335, 0.584251562335},
                 released[] = {6.01046843099e-5, 5.60764303299e-4, 5.60764303299e-4};
    for (std::size_t i = 0; i < 3; ++i) {
        expect_printed(entry(a[i], D), damage[i]);
        expect_printed(entry(a[i], W), released[i]);
    }
    expect_tangent(a[1], {2360.616241, 385.9591192, -816.7797644, -2004.564806, 668.1882687, -935.4635761});
    expect_tangent(a[1], {-2004.564806, -773.6916795, -1090.201912, 2798.470447, 175.8390181, -246.1746253}, 3);
    expect_same_in_vumat(made(solid, base(3, {1})), path_d2);
}

TEST(IsoDamage, D4_MixedMode) {
    const Numbers props = base(1, {2, 3, 2, 0.2});
    const std::vector<Numbers> path = {{1.2e-4, -1.4e-4, 3e-5, 6e-5, 2e-5, 4e-5},
                                       {2.5e-4, 2e-4, 6e-5, 2.4e-4, -1.2e-4, 1e-4},
                                       {2e-4, -6e-4, 0, 0, 0, 0}};
    UmatPoint point = made(solid, props);
    const std::vector<Answer> a = follow(point, path);
    expect_printed(a[0].stress, {2, -2.16, 0.56, 0.48, 0.16, 0.32});
    EXPECT_EQ(entry(a[0], STATE), 0.0);
    EXPECT_EQ(entry(a[0], D), 0.0);
    expect_printed(a[1].stress,
                   {3.47687837428, 1.76603345995, 1.93159909682, 0.827828184353, -0.275942728118, 0.386319819365});
    expect_printed(entry(a[1], D), 0.655071589853);
    expect_printed(entries(a[1], DELTA_N, 2), {3.62613983993e-4, 6.76927451597e-4});
    expect_printed(entry(a[1], W), 6.50588105294e-4);
    EXPECT_EQ(entry(a[1], MODE), 1.0);
    expect_printed(a[2].stress,
                   {3.06184290949, -2.33283269295, 0.729010216546, 0.729010216546, -0.243003405515, 0.340204767722});
    expect_printed(entry(a[2], D), 0.696245743106);
    expect_printed(entries(a[2], DELTA_N, 2), {4.3358131456e-4, 8.08951017174e-4});
    expect_printed(entry(a[2], W), 8.53196117343e-4);
    EXPECT_EQ(entry(a[2], MODE), 2.0);
    expect_same_in_vumat(made(solid, props), path);
}

TEST(IsoDamage, D5_PlaneStress) {
    const std::vector<Numbers> path = {{2e-4, -1e-4, 1e-4}, {3e-4, 1e-4, 2e-4}};
    UmatPoint point = made(plane_stress, base(1, {1}));
    const std::vector<Answer> a = follow(point, path);
    expect_printed(a[0].stress, {3.72385276733, -1.06395793352, 0.797968450141});
    expect_printed(entry(a[0], D), 2.53943732366e-3);
    expect_printed(entry(a[0], effective_strain::E33), -3.33333333333e-5);
    expect_printed(a[1].stress, {3.70364422242, 0.925911055604, 0.833319950044});
    expect_printed(entry(a[1], D), 0.652783354148);
    expect_printed(entry(a[1], W), 7.18423315854e-4);
    expect_same_in_vumat(made(plane_stress, base(1, {1})), path);
}

// An explicit host is told the whole thickness strain: that of the stress and the free one.
TEST(IsoDamage, ThicknessStrain) {
    VumatBlock block("ISO_DAMAGE-PS-TEST", plane_stress, base(1, {1, 0, 1, 0, 0, 0, 0, 0, 0.01, 0, 1e-5}));
    block.points.assign(5, block.fresh_point());
    for (VumatPoint& p : block.points)
        p.celent = 5.0, p.strain_increment = {4e-4, 1e-4, 2e-4}, p.temperature_old = 20.0, p.temperature_new = 30.0;
    ASSERT_EQ(block.run().stops, 0);
    for (const VumatPoint& p : block.points) {
        EXPECT_GT(p.state[D - 1], 0.0);
        EXPECT_NEAR(p.thickness_strain_increment, p.state[effective_strain::E33 - 1] + 1e-4, 1e-18);
        EXPECT_NEAR(p.state[effective_strain::E33 - 1], -(5e-4 - 2e-4) / 3, 1e-18);
    }
}

TEST(IsoDamage, D6_OliversBar) {
    const Numbers props = {1000, 0.3, 10, 1, 0.8};
    const std::vector<Numbers> path = {{0.02}, {-0.04}, {0.05}};
    UmatPoint point = made(uniaxial, props, 0.8);
    const std::vector<Answer> a = follow(point, path);
    const double stress[] = {9.47368421053, -9.47368421053, 8.94736842105},
                 damage[] = {0.526315789474, 0.526315789474, 0.701754385965}, strain[] = {0.02, 0.02, 0.03};
    for (std::size_t i = 0; i < 3; ++i) {
        expect_printed(a[i].stress, {stress[i]});
        expect_printed(entry(a[i], D), damage[i]);
        // D = (1 - eps_i/eps)/(1 + H), H = -eps_i/eps_max
        EXPECT_NEAR(entry(a[i], D), (1.0 - 0.01 / strain[i]) / (1.0 - 0.05), 1e-15);
        EXPECT_EQ(entry(a[i], 2), -0.3 * entry(a[i], 1));
        EXPECT_EQ(entry(a[i], 3), -0.3 * entry(a[i], 1));
    }
    expect_same_in_vumat(made(uniaxial, props, 0.8), path);
}

// --- The tangent -----------------------------------------------------------------------------------------------------

// Central differences of step 1e-9, as on the page: 2e-10 of the largest entry there, 1e-6 relative promised.
TEST(IsoDamage, TangentIsTheDifference) {
    const Numbers metrics[] = {base(1), base(2, {1}), base(3, {2, 3, 2, 0.2})};
    for (const Numbers& props : metrics)
        for (const AnalysisKind kind : {solid, plane_strain, plane_stress, uniaxial}) {
            SCOPED_TRACE("metric " + std::to_string(props.size() > 5 ? props[5] : 0.0) + ", kind " +
                         std::to_string(static_cast<int>(kind)));
            const Numbers full[] = {{4e-4, -1e-4, 5e-5, 2e-4, -1e-4, 6e-5}, {-1e-4, 2e-5, 0, -5e-5, 0, 1e-5}};
            UmatPoint point = made(kind, props);
            for (const Numbers& d : full) {
                const Load load{.dstran = in_kind(d, kind)};
                const Answer a = point.evaluate(load);
                const Eigen::MatrixXd difference = central_difference(point, load, 1e-9);
                EXPECT_LE((a.tangent - difference).cwiseAbs().maxCoeff(), 1e-6 * 24000.0) << a.tangent << "\n\n"
                                                                                          << difference;
                point.step(load);
            }
            EXPECT_GT(point.state(D), 0.0);
        }
}

// --- Energies --------------------------------------------------------------------------------------------------------

// A complete failure under proportional strain dissipates GC/h, less the tail of laws 2, 5, 6 beyond FMIN, for every
// law, metric, and any element up to the limit. What was dissipated is the work that was done.
TEST(IsoDamage, FailureTakesTheToughness) {
    const double E = 20000, sig = 4, G = 0.08, fmin = 1e-6;
    for (const LawCode& law : laws)
        for (int metric = 0; metric < 3; ++metric)
            for (const double part : {1e-3, 0.1, 0.9, 0.999}) {
                SCOPED_TRACE("law " + std::to_string(law.code) + ", metric " + std::to_string(metric) + ", h/h_max " +
                             std::to_string(part));
                const SofteningLaw shape(law.code, law.a1, law.a2, fmin);
                const double h = part * shape.eta() * G * E / (sig * sig), L = G / (h * sig), r = sig / (E * L);
                // Shear too strong to matter.
                const Numbers props = {
                    E, 0.25, sig, double(law.code), G, double(metric), 1e3 * sig, 1, 1e9, law.a1, law.a2, 0, 0, fmin};
                UmatPoint point = made(uniaxial, props, h);
                const double end = L * shape.end_strain(r), start = sig / E;
                double work = 0.0, before = 0.0, strain = 0.0;
                const int steps = 400;
                for (int i = 0; i <= steps; ++i) {
                    const double to = i == 0 ? start : start + (1.001 * end - start) * i / steps;
                    const Answer a = point.advance({.dstran = {to - strain}});
                    work += 0.5 * (before + a.stress[0]) * (to - strain);
                    before = a.stress[0], strain = to;
                }
                EXPECT_EQ(point.state(STATE), 2.0);
                const double released = point.state(W) * h, tail = 1.0 - shape.end_release(r);
                EXPECT_NEAR(released, G * (1.0 - tail), 1e-12 * G);
                EXPECT_LE(std::abs(tail), 30.0 * fmin);
                if (shape.has_end()) {
                    EXPECT_NEAR(released, G, 1e-12 * G);
                }
                EXPECT_NEAR(work * h, G, 2e-3 * G);  // trapezoid rule
                EXPECT_NEAR(point.spd(), point.state(W), 1e-13 * point.spd());
            }
}

// Failure in shear takes GIIC.
TEST(IsoDamage, FailureInShearTakesTheShearToughness) {
    for (const LawCode& law : laws) {
        SCOPED_TRACE("law " + std::to_string(law.code));
        // Too strong in tension to matter.
        const Numbers props = {20000, 0.25, 1e5, 1, 1e9, 2, 3, double(law.code), 0.2, 0, 0, law.a1, law.a2, 1e-6};
        const SofteningLaw shape(law.code, law.a1, law.a2, 1e-6);
        UmatPoint point = made(solid, props, 2.0);
        for (int i = 0; i < 100; ++i) point.advance({.dstran = {0, 0, 0, 2e-2 * i / 100.0, 0, 0}});
        EXPECT_EQ(point.state(STATE), 2.0);
        EXPECT_EQ(point.state(MODE), 2.0);
        const double L = 0.2 / (2.0 * 3.0);
        EXPECT_NEAR(point.state(W) * 2.0, 0.2 * shape.end_release(3.0 / (8000.0 * L)), 1e-12);
    }
}

// With a residual stiffness W ends where the stress stops to fall: work = SSE + SPD beyond failure as well.
TEST(IsoDamage, ResidualStiffness) {
    for (const LawCode& law : laws)
        for (const double kres : {1e-3, 0.05}) {
            SCOPED_TRACE("law " + std::to_string(law.code) + ", KRES " + std::to_string(kres));
            const Numbers props = {20000, 0.25, 4,   double(law.code), 0.08, 0, 0, 1, 0, law.a1, law.a2, 0,
                                   0,     1e-3, kres};
            UmatPoint point = made(uniaxial, props, 20.0);
            double work = 0.0, before = 0.0;
            const int steps = 20000;
            const double length = 0.02;
            for (int i = 0; i < steps; ++i) {
                const Answer a = point.advance({.dstran = {length / steps}});
                work += 0.5 * (before + a.stress[0]) * length / steps;
                before = a.stress[0];
            }
            EXPECT_EQ(point.state(STATE), 2.0);
            EXPECT_EQ(point.state(D), 1.0);
            EXPECT_NEAR(before, kres * 20000 * length, 1e-12 * before);
            // The trapezoid over the increment of failure misses half of a drop to FMIN.
            EXPECT_NEAR(point.sse() + point.spd(), work, 1e-5 * work);
            EXPECT_NEAR(point.evaluate({.dstran = {1e-5}}).tangent(0, 0), kres * 20000, 1e-9);
        }
}

// --- Failure modes (section 6) ---------------------------------------------------------------------------------------

std::string refusal(const Numbers& props) { return damage_cases::refusal("ISO_DAMAGE-X", props, uniaxial); }

// METH = 1 (section 4, alternatives): of first order towards the exact damage, stress and dissipation; with its own
// tangent; in VUMAT as in UMAT.
TEST(IsoDamage, DamageByItsRateIsOfFirstOrder) {
    const auto by_rate = [](double method) {
        Numbers props = base(2);
        props.resize(21, 0.0);
        props[7] = 1, props[13] = 0.01, props[20] = method;
        return props;
    };
    const Numbers legs[] = {{3e-4, -5e-5, 0, 2e-4, 0, 0}, {-1e-4, 3e-4, 1e-4, 6e-4, 3e-4, 0}};
    const auto after = [&](double method, int increments) {
        UmatPoint point = made(solid, by_rate(method));
        for (const Numbers& leg : legs)
            for (int i = 0; i < increments; ++i) {
                Numbers d = leg;
                for (double& x : d) x /= increments;
                point.advance({.dstran = d});
            }
        return point;
    };
    const UmatPoint exact = after(0, 1);
    double last = 0.0, last_work = 0.0;
    for (const int increments : {20, 80, 320}) {
        const UmatPoint point = after(1, increments);
        const double error = distance(point.stress(), exact.stress()) / largest(exact.stress());
        const double work = std::abs(point.spd() / exact.spd() - 1.0);
        EXPECT_LE(error, 2.0 / increments);
        EXPECT_GT(error, 1e-3 / increments);
        if (last > 0.0) {
            EXPECT_NEAR(error, 0.25 * last, 0.05 * last);
            EXPECT_NEAR(work, 0.25 * last_work, 0.05 * last_work);
        }
        last = error, last_work = work;
    }
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (const AnalysisKind kind : {solid, plane_strain, plane_stress, uniaxial})
        for (int trial = 0; trial < 10; ++trial) {
            UmatPoint point = made(kind, by_rate(1));
            std::vector<Numbers> path(4, Numbers(point.stress().size()));
            for (Numbers& d : path)
                for (double& x : d) x = 2e-4 * normal(random);
            for (int i = 0; i < 3; ++i) point.advance({.dstran = path[std::size_t(i)]});
            const Load load{.dstran = path.back()};
            const Eigen::MatrixXd difference = central_difference(point, load, 1e-9);
            EXPECT_LE((point.evaluate(load).tangent - difference).cwiseAbs().maxCoeff(), 1e-6 * 24000);
            expect_same_in_vumat(made(kind, by_rate(1)), path);
        }
    Numbers mixed = by_rate(1);
    mixed[5] = 1;
    expect_message(refusal(mixed), {"METH", "METRIC 1, 2"});
}

TEST(IsoDamage, RefusesConstants) {
    expect_message(refusal(base(7)), {"ISO_DAMAGE-X", "PROPS(4) = 7", "LAW", "1..6"});
    expect_message(refusal(base(1, {3})), {"PROPS(6) = 3", "METRIC", "0..2"});
    expect_message(refusal(base(1, {2, 0, 1, 0.1})), {"PROPS(7) = 0", "TAUC", "> 0 for METRIC 2"});
    expect_message(refusal(base(1, {2, 3, 1, 0})), {"PROPS(9) = 0", "GIIC", "> 0 for METRIC 2"});
    expect_message(refusal(base(1, {2, 3})), {"PROPS(9) = missing", "GIIC"});
    expect_message(refusal(base(4, {0, 0, 1, 0, -1})), {"PROPS(10) = -1", "A1_I", ">= 0"});
    expect_message(refusal(base(5, {0, 0, 1, 0, 1, 0.5})), {"PROPS(10) = 1", "> 1"});
    expect_message(refusal(base(5, {0, 0, 1, 0, 2, 1})), {"PROPS(11) = 1", "< 1"});
    expect_message(refusal(base(1, {2, 3, 6, 0.1, 0, 0, 0.5})), {"PROPS(12) = 0.5", "A1_II"});
    expect_message(refusal(base(1, {0, 0, 1, 0, 0, 0, 0, 0, 0.6})), {"PROPS(14) = 0.6", "FMIN"});
    expect_message(refusal(base(1, {0, 0, 1, 0, 0, 0, 0, 0, 0.01, 0.2})), {"PROPS(15) = 0.2", "KRES", "[0, 0.1]"});
    // Without METRIC 2 the shear law is not used.
    EXPECT_TRUE(made(solid, base(1, {1, 0, 5})).evaluate({}).done());
    expect_refused(UmatPoint("ISO_DAMAGE-X", cohesive_3d, base(1)).nstatv(16), {"ISO_DAMAGE does not serve", "(1,2)"});
}

// h_max = eta GC E/SIGC^2 = 2*0.08*20000/16 = 200; in shear eta GIIC G/TAUC^2 = 0.2*8000/9 = 177.8 for law 2.
TEST(IsoDamage, ElementSizeLimit) {
    for (const AnalysisKind kind : {solid, plane_strain, plane_stress, uniaxial}) {
        EXPECT_TRUE(made(kind, base(1), 199.9).evaluate({}).done());
        expect_refused(made(kind, base(1), 200.0), {"ISO_DAMAGE-TEST", "snap back", "= 200", "below 200"});
        const Numbers mixed = base(1, {2, 3, 2, 0.2});
        EXPECT_TRUE(made(kind, mixed, 177.7).evaluate({}).done());
        expect_refused(made(kind, mixed, 177.8), {"in shear", "below 177.7777"});
        expect_refused(made(kind, base(2), 100.0), {"below 100"});
    }
    // Relative strength and toughness count: 1.5/0.64 of the limit.
    Numbers state(iso_damage::count, 0.0);
    state[REL_S - 1] = 0.8, state[REL_G - 1] = 1.5;
    EXPECT_TRUE(made(solid, base(1), 468.0).state(state).evaluate({}).done());
    expect_refused(made(solid, base(1), 469.0).state(state), {"below 468.75"});
    state[REL_S - 1] = -1.0;
    expect_refused(made(solid, base(1)).state(state), {"REL_S", "> 0"});

    // HPOL = 1: SIGC becomes sqrt(0.98 * 2 * 0.08 * 20000/800) = 1.98, and the toughness stays.
    UmatPoint point = made(uniaxial, base(1, {0, 0, 1, 0, 0, 0, 0, 0, 0.01, 0, 0, 0, 0, 1}), 800.0);
    const double reduced = std::sqrt(0.98 * 2 * 0.08 * 20000 / 800);
    point.advance({.dstran = {0.999 * reduced / 20000}});
    EXPECT_EQ(point.state(STATE), 0.0);
    point.advance({.dstran = {0.002 * reduced / 20000}});
    EXPECT_EQ(point.state(STATE), 1.0);
    point.advance({.dstran = {0.1}});
    EXPECT_EQ(point.state(STATE), 2.0);
    EXPECT_NEAR(point.state(W) * 800.0, 0.08, 1e-15);
}

TEST(IsoDamage, RefusesAnUnknownLength) {
    for (const double h : {0.0, -1.0, std::nan("")}) expect_refused(made(solid, base(1), h), {"CELENT", "> 0"});
    // HFIX takes its place, and so does the frozen length of a damaged point.
    EXPECT_TRUE(made(solid, base(1, {0, 0, 1, 0, 0, 0, 0, 0, 0.01, 0, 0, 0, 5}), 0.0).evaluate({}).done());
    UmatPoint point = made(solid, base(1));
    point.advance({.dstran = {4e-4, 0, 0, 0, 0, 0}});
    ASSERT_EQ(point.state(STATE), 1.0);
    EXPECT_TRUE(point.celent(-1.0).evaluate({}).done());
}

// D = 1: no stiffness in any direction, in compression neither, returned as it is.
TEST(IsoDamage, NothingIsLeftOfAFailedPoint) {
    UmatPoint point = made(solid, base(1, {0, 0, 1, 0, 0, 0, 0, 0, 0.01, 0, 0, 0, 0, 0, 1}));
    follow(point, {{4e-4, 0, 0, 0, 0, 0}});
    EXPECT_EQ(point.state(STATUS), 1.0);
    follow(point, {{1e-2, 0, 0, 0, 0, 0}});
    EXPECT_EQ(point.state(STATUS), 0.0);  // DELFLAG
    const Answer a = point.advance({.dstran = {-3e-2, 0, 0, 1e-3, 0, 0}});
    EXPECT_EQ(largest(a.stress), 0.0);
    EXPECT_EQ(a.tangent.cwiseAbs().maxCoeff(), 0.0);
    EXPECT_EQ(a.sse, 0.0);
}

// METRIC 0 damages in compression as in tension; METRIC 1 and, in tension, METRIC 2 do not.
TEST(IsoDamage, CompressionDamagesByStrainEnergyOnly) {
    for (int metric = 0; metric < 3; ++metric) {
        UmatPoint point = made(uniaxial, base(1, {double(metric), 100, 1, 1e3}));
        point.advance({.dstran = {-4e-4}});
        EXPECT_EQ(point.state(D) > 0.0, metric == 0) << metric;
        point.advance({.dstran = {8e-4}});
        EXPECT_GT(point.state(D), 0.0) << metric;
    }
}

// METRIC 1, nu < 0: one small tension between large compressions makes the argument negative. It counts as zero.
TEST(IsoDamage, NegativeArgumentCountsAsZero) {
    Numbers props = base(1, {1});
    props[1] = -0.4;
    // s~ = (1, -100, -100): eps_1 = (1 + 0.4 (-200))/E < 0
    UmatPoint point = made(solid, props);
    const double E = 20000, nu = -0.4;
    const auto strain = [&](double a, double b, double c) {
        return Numbers{(a - nu * (b + c)) / E, (b - nu * (a + c)) / E, (c - nu * (a + b)) / E, 0, 0, 0};
    };
    const Answer a = point.advance({.dstran = strain(1, -100, -100)});
    expect_printed(a.stress, {1, -100, -100, 0, 0, 0}, 200.0);
    EXPECT_EQ(entry(a, D), 0.0);
    EXPECT_TRUE(a.tangent.allFinite());
}

// METRIC 2: where tension and shear take turns, and with equal principal stresses, the tangent is that of the active
// branch, finite, and of either side.
TEST(IsoDamage, KinksOfTheMixedMetric) {
    UmatPoint point = made(solid, base(1, {2, 3, 2, 0.2}));
    const Answer a = point.advance({.dstran = {2e-4, 2e-4, 2e-4, 0, 0, 0}});
    EXPECT_EQ(entry(a, MODE), 1.0);
    EXPECT_TRUE(a.tangent.allFinite());
    // Equal laws in tension and shear of a bar with G = E/2: both are reached at once, and tension counts.
    UmatPoint tie = made(uniaxial, {20000, 0.0, 4, 1, 0.08, 2, 2, 1, 0.04});
    const Answer b = tie.advance({.dstran = {5e-4}});
    EXPECT_EQ(entry(b, MODE), 1.0);
    expect_printed(entry(b, DELTA_S), entry(b, DELTA_N));
    EXPECT_NEAR(b.tangent(0, 0), -4 / 8e-3 / (1 - 2e-4 / 8e-3) * 1.0, 1e-6 * 500);
}

// A damaged stiffness that grows is not positive definite: the material loses ellipticity at the first damage.
TEST(IsoDamage, GrowingDamageIsUnstable) {
    UmatPoint point = made(solid, base(1));
    const double onset = 4.0 / std::sqrt(20000.0 * 24000.0);  // eps:C eps = E eps0^2
    point.advance({.dstran = {onset * (1 - 1e-6), 0, 0, 0, 0, 0}});
    EXPECT_GT(point.evaluate({.dstran = {1e-12, 0, 0, 0, 0, 0}}).tangent(0, 0), 0.0);
    EXPECT_LT(point.evaluate({.dstran = {2e-6 * onset, 0, 0, 0, 0, 0}}).tangent(0, 0), 0.0);  // acoustic, n = e1
}

// D within 1e-10 of 1 loses digits; KRES takes over.
TEST(IsoDamage, ResidualStiffnessNearFailure) {
    for (const double kres : {0.0, 1e-6}) {
        UmatPoint point = made(uniaxial, base(3, {0, 0, 1, 0, 0, 0, 0, 0, 0.01, kres}));
        const double end = 8e-3;  // 2 GC/(h SIGC)
        const Answer a = point.advance({.dstran = {end * (1 - 1e-6)}});
        EXPECT_EQ(entry(a, STATE), 1.0);
        EXPECT_LT(1.0 - entry(a, D), 1e-10);
        if (kres > 0.0) {
            EXPECT_NEAR(a.stress[0], kres * 20000 * end, 1e-5 * a.stress[0]);
        } else {
            EXPECT_LE(a.stress[0], 1e-10 * 20000 * end);
        }
    }
}

// An initial stress is that of the sound material.
TEST(IsoDamage, InitialStress) {
    for (const AnalysisKind kind : {solid, plane_strain, plane_stress, uniaxial}) {
        const Numbers stress = in_kind({1.0, -2.0, kind == plane_stress ? 0.0 : 0.5, 0.3, 0.2, -0.1}, kind);
        UmatPoint point = made(kind, base(1)).stress(stress);
        const Answer a = point.advance({});
        expect_printed(a.stress, stress);
        const Answer b = point.advance({.dstran = Numbers(stress.size(), 1e-5)});
        EXPECT_LE(distance(b.stress, stress), 1.0);
        EXPECT_GT(distance(b.stress, stress), 0.1);
    }
}

// Damage without a length is that of a host that starts with it: the law goes on from there.
TEST(IsoDamage, PreDamaged) {
    UmatPoint point = made(uniaxial, base(2));
    Numbers state(iso_damage::count, 0.0);
    state[STATE - 1] = 1, state[D - 1] = 0.5;
    point.state(state);
    const SofteningLaw law(2, 0, 0, 0.01);
    const double L = 0.08 / 20, r = 4 / (20000 * L), u = law.at_damage(0.5, r, 0.0, true).u,
                 e = L * law.at(u).strain(r);
    const Answer a = point.advance({.dstran = {0.999 * e}});
    EXPECT_NEAR(a.stress[0], 0.5 * 20000 * 0.999 * e, 1e-12);
    EXPECT_NEAR(entry(a, DELTA_N), L * u, 1e-15 * L);
    EXPECT_EQ(entry(a, H), 5.0);
    const Answer b = point.advance({.dstran = {0.002 * e}});
    EXPECT_GT(entry(b, D), 0.5);
    EXPECT_LT(entry(b, W), 1e-5);
}

// Residual strain: free expansion has no stress; a held one damages.
TEST(IsoDamage, ExpandsWithHeatAndMoisture) {
    const Numbers props = base(1, {1, 0, 1, 0, 0, 0, 0, 0, 0.01, 0, 1e-5, 2e-3});
    for (const AnalysisKind kind : {solid, plane_strain, plane_stress, uniaxial}) {
        const double free = 1e-5 * 20 + 2e-3 * 0.05;
        UmatPoint point = made(kind, props);
        Numbers dstran(std::size_t(point.size()), 0.0);
        std::fill_n(dstran.begin(), point.normals(), free);
        const Answer a = point.advance({.dstran = dstran, .dtemp = 20.0, .dpred = {0.05}});
        EXPECT_LE(largest(a.stress), 1e-12);
        const Answer b = point.advance({.dtemp = -40.0});
        EXPECT_GT(b.stress[0], 0.5);
        EXPECT_GT(entry(b, D), 0.0);
        EXPECT_NEAR(b.ddsddt[0], -1e-5 * b.tangent.row(0).head(point.normals()).sum(), 1e-12);
        EXPECT_TRUE(point.evaluate({.dpred = {std::nan("")}}).cut);
    }
}

}  // namespace
}  // namespace lode::test::test_iso_damage
