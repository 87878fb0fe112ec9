// VISCOELASTIC: the verification cases and failure modes of page 60, sections 1 and 2.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "lode/viscoelastic/viscoelastic.hpp"
#include "umat_point.hpp"
#include "vumat_block.hpp"

namespace lode::test::test_viscoelastic {
namespace {

constexpr AnalysisKind solid = AnalysisKind::solid, plane_strain = AnalysisKind::plane_strain,
                       plane_stress = AnalysisKind::plane_stress, uniaxial = AnalysisKind::uniaxial;
constexpr double printed = 6e-12;  // twelve digits
constexpr int EPS33 = 3, TR = 8, DISS = 9;

Numbers operator+(Numbers a, const Numbers& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}
const Numbers S = {1000, 300, 2, 0, 200, 0.5, 100, 5};
const Numbers SK = {1000, 300, 2, 1, 200, 0.5, 100, 5, 400, 2};
// The constants behind the terms, up to C5, without shifts.
const Numbers no_shift = {0, 0, 17.44, 51.6, 0, 0, 10, 0.0625, 0, 0};
Numbers with_method(int meth, int plaw = 0) { return {0, 0, double(meth), double(plaw)}; }

UmatPoint material(AnalysisKind kind, Numbers props) { return UmatPoint("VISCOELASTIC-TEST", kind, std::move(props)); }

// Components that are not given are zero.
void expect_stress(const Numbers& expected, const Numbers& actual, double relative = printed) {
    for (std::size_t i = 0; i < actual.size(); ++i) {
        const double x = i < expected.size() ? expected[i] : 0.0;
        EXPECT_NEAR(actual[i], x, relative * std::abs(x) + 1e-14 * largest(actual)) << "component " << i + 1;
    }
}
void expect_close(double expected, double actual, double relative = printed) {
    EXPECT_NEAR(actual, expected, relative * std::abs(expected));
}

// --- Verification table -------------------------------------------------------------------------------------------

TEST(Viscoelastic, V1_RelaxationOfShearAndVolume) {
    UmatPoint p = material(solid, SK);
    p.advance({.dstran = {0.01, 0, 0, 0.02, 0, 0}, .dtime = 1e-12});
    expect_stress({22, 10, 10, 12}, p.stress(), 1e-11);  // but for the relaxation in 1e-12
    p.advance({.dtime = 1.0});
    expect_stress({17.8786577316, 9.69985509248, 9.69985509248, 8.1788026391}, p.stress());
    expect_close(0.0737903758749, p.state(DISS));
    expect_close(0.0737903758749, p.scd());
    p.advance({.dtime = 9.0});
    expect_stress({14.2073988378, 7.93672826309, 7.93672826309, 6.27067057472}, p.stress());
    expect_close(0.0995106749643, p.state(DISS));
}

TEST(Viscoelastic, V2_GeneralPath) {
    const Numbers d = {0.01, -0.002, 0.001, 0.02, 0.004, -0.006};
    UmatPoint p = material(solid, SK);
    const Answer first = p.advance({.dstran = d});
    expect_stress({18.512394582, 7.0619682987, 9.92457486952, 9.54202190275, 1.90840438055, -2.86260657082},
                  p.stress());
    expect_close(0.0304224010893, p.state(DISS));
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j) {
            const double expected =
                i != j ? (i < 3 && j < 3 ? 996.708075472 : 0.0) : (i < 3 ? 1950.91026575 : 477.101095137);
            EXPECT_NEAR(first.tangent(i, j), expected, printed * expected) << i << j;
        }
    p.advance({.dstran = d});
    expect_stress({34.6333858069, 13.9211838926, 19.0992343712, 17.2601682619, 3.45203365237, -5.17805047856},
                  p.stress());
    expect_close(0.12317604383, p.state(DISS));
    Numbers back = d;
    for (double& x : back) x *= -2;
    p.advance({.dstran = back, .dtime = 0.5});
    expect_stress({-6.43668837115, -0.246947758017, -1.7943829113, -5.15811717761, -1.03162343552, 1.54743515328},
                  p.stress());
    expect_close(0.17739620745, p.state(DISS));
}

TEST(Viscoelastic, V3_Recursions) {
    const double table[4][2] = {
        {11.257327582, 21.3508930395}, {11.2353203589, 21.3140959705}, {11.16, 21.1706247712}, {12, 22.32}};
    for (int meth = 0; meth < 4; ++meth) {
        UmatPoint p = material(solid, S + with_method(meth));
        for (const double s12 : table[meth]) {
            p.advance({.dstran = {0, 0, 0, 0.02, 0, 0}, .dtime = 0.2});
            expect_stress({0, 0, 0, s12}, p.stress());
        }
    }
}

TEST(Viscoelastic, V4_TemperatureShift) {
    const double table[4][2] = {{6.03951377139, 20.0463277548},
                                {6.00019226731, 46.6739173029},
                                {6.2491942442, 10.8384106573},
                                {6.03027665798, 21.3776887644}};
    for (int dtrm = 0; dtrm < 4; ++dtrm) {
        UmatPoint p =
            material(solid, S + Numbers{6e-5, 0, 0, 0, 1, 373, 17.44, 51.6, 0, 0, 10, 0.0625, 0, 0, double(dtrm)});
        p.temperature(370);
        p.advance({.dstran = {0, 0, 0, 0.02, 0, 0}, .dtime = 10});
        expect_stress({0, 0, 0, 9.78077186743}, p.stress());
        expect_close(0.838410657292, p.state(TR));
        p.advance({.dtime = 10, .dtemp = 6});
        expect_stress({-1.08, -1.08, -1.08, table[dtrm][0]}, p.stress());
        expect_close(table[dtrm][1], p.state(TR));
    }
}

TEST(Viscoelastic, V5_MoistureAndMechanosorption) {
    UmatPoint p = material(solid, S + Numbers{0, 0.1, 0, 0, 0, 0, 17.44, 51.6, 1, 0.12, 2, 0.06, 3, -2});
    p.advance({.dstran = {0.01, 0, 0, 0, 0, 0}, .dpred = {0.05}});
    expect_stress({2.53374367376, -8.76687183688, -8.76687183688}, p.stress());
    expect_close(0.186877214123, p.state(TR));
    p.advance({.dpred = {0.05}});
    expect_stress({-13.7453656557, -23.1273171722, -23.1273171722}, p.stress());
    expect_close(0.566395109577, p.state(TR));
    p.advance({.dpred = {-0.05}});
    expect_stress({0.61197293585, -7.80598646792, -7.80598646792}, p.stress());
    expect_close(0.945913005031, p.state(TR));
}

TEST(Viscoelastic, V6_PlaneStress) {
    UmatPoint p = material(plane_stress, SK);
    p.advance({.dstran = {0.01, 0.002, 0.02}, .dtime = 0.1});
    expect_stress({18.0628378041, 8.77842371789, 11.6055176078}, p.stress());
    expect_close(-5.56400878839e-3, p.state(EPS33));
    const double table[4][3] = {{14.8932998424, 7.5929776688, 9.12540271707},
                                {13.4418980145, 6.95242760731, 8.11183800904},
                                {12.6993261291, 6.58139361026, 7.64741564859},
                                {12.2608403166, 6.34586122588, 7.39372386342}};
    for (const auto& row : table) {
        p.advance({.dtime = 0.5});
        expect_stress({row[0], row[1], row[2]}, p.stress());
    }
    expect_close(-6.53827823916e-3, p.state(EPS33));
}

TEST(Viscoelastic, V7_Uniaxial) {
    UmatPoint p = material(uniaxial, {1000, 300, 1, 0, 500, 2});
    p.advance({.dstran = {0.01}, .dtime = 1e-12});
    expect_stress({18.9473684211}, p.stress());
    for (const double s : {16.3907454828, 14.4412741256, 12.9547668602, 11.8212781111, 10.956972383, 10.2979235903,
                           9.7953869334, 9.41219361852}) {
        p.advance({.dtime = 0.625});
        expect_stress({s}, p.stress());
    }
    expect_close(p.state(2), p.state(3), 0.0);
}

TEST(Viscoelastic, V8_VerticalShift) {
    UmatPoint p = material(solid, S + Numbers{0, 0, 0, 0} + no_shift + Numbers{0, 3, 0, 300, 1, 320, 0.8, 360, 0.3});
    p.temperature(300);
    p.advance({.dstran = {0.01, 0, 0, 0.02, 0, 0}, .dtime = 0.2});
    expect_stress({17.5048850547, 6.24755747266, 6.24755747266, 11.257327582}, p.stress());
    p.advance({.dtime = 0.2, .dtemp = 10});
    expect_stress({15.0561392745, 5.97193036276, 5.97193036276, 9.08420891172}, p.stress());
    p.advance({.dtime = 0.2, .dtemp = 25});
    expect_stress({9.91888339392, 4.22805830304, 4.22805830304, 5.69082509088}, p.stress());
}

TEST(Viscoelastic, V9_PressureLaws) {
    struct Row {
        Numbers first, second;
        double eps33_first, eps33_second;  // 0: not printed
    };
    const Row table[3] = {{{310.336481215, 146.099911616, 54.7455231995},
                           {411.346271535, 104.925911084, 47.3945969506},
                           -0.0834354875776,
                           -0.113747565435},
                          {{317.003008756, 152.766439157, 54.7455231995},
                           {419.210620258, 112.790259808, 47.3945969506},
                           -0.0895241384402,
                           0.0},
                          {{293.769312577, 129.532742978, 54.7455231995},
                           {390.87732959, 84.4569691394, 47.3945969506},
                           -0.0683044159667,
                           0.0}};
    for (int plaw = 1; plaw <= 3; ++plaw) {
        const Row& row = table[plaw - 1];
        UmatPoint p = material(plane_stress, S + Numbers{1e-4, 0, 0, double(plaw)});
        p.advance({.dstran = {0.2, 0.05, 0.1}, .dtime = 0.3, .dtemp = 50});
        expect_stress(row.first, p.stress());
        expect_close(row.eps33_first, p.state(EPS33));
        p.advance({.dstran = {0.1, -0.05, 0}, .dtime = 0.3});
        expect_stress(row.second, p.stress());
        if (row.eps33_second != 0.0) expect_close(row.eps33_second, p.state(EPS33));
    }
}

// --- 1.1 to 1.3 ---------------------------------------------------------------------------------------------------

// One Maxwell element of unit modulus and time in shear: the stress 12 is b.
Numbers element(int meth) { return Numbers{1, 0, 1, 0, 1, 1} + with_method(meth); }

TEST(Viscoelastic, RecursionsConvergeAsPrinted) {
    // Largest error for e = sin 2t, 0 <= t <= 3; x = 1/2, 1/4, 1/8, 1/16.
    const double table[4][4] = {{4.4e-2, 1.16e-2, 2.9e-3, 7.2e-4},
                                {4.7e-2, 1.17e-2, 3.0e-3, 7.4e-4},
                                {5.0e-2, 1.34e-2, 3.4e-3, 8.4e-4},
                                {0.24, 0.105, 5.1e-2, 2.5e-2}};
    for (int meth = 0; meth < 4; ++meth)
        for (int level = 0; level < 4; ++level) {
            const double x = std::ldexp(0.5, -level);
            UmatPoint p = material(solid, element(meth));
            double error = 0.0;
            for (double t = x; t <= 3.0; t += x) {
                p.advance({.dstran = {0, 0, 0, std::sin(2 * t) - std::sin(2 * (t - x)), 0, 0}, .dtime = x});
                const double exact = 0.4 * std::cos(2 * t) + 0.8 * std::sin(2 * t) - 0.4 * std::exp(-t);
                error = std::max(error, std::abs(p.stress()[3] - exact));
            }
            EXPECT_NEAR(error, table[meth][level], 0.02 * table[meth][level]) << "METH " << meth << ", x " << x;
        }
}

TEST(Viscoelastic, SteadyLimitsOfTheRecursions) {
    for (const double x : {0.1, 1.0}) {
        // Constant strain: code 2 relaxes to 1 - (x/2) coth(x/2) of the strain, the others to nothing.
        for (int meth = 0; meth < 4; ++meth) {
            UmatPoint p = material(solid, element(meth));
            p.advance({.dstran = {0, 0, 0, 1e-3, 0, 0}, .dtime = 1e-12});
            for (int i = 0; i < 600; ++i) p.advance({.dtime = x});
            const double expected = meth == 2 ? 1e-3 * (1 - 0.5 * x / std::tanh(0.5 * x)) : 0.0;
            EXPECT_NEAR(p.stress()[3], expected, 1e-14) << "METH " << meth;
        }
        // Constant rate: code 1 is off by x/(2 sinh(x/2)) - 1, code 0 exact.
        for (const int meth : {0, 1}) {
            UmatPoint p = material(solid, element(meth));
            for (int i = 0; i < 600; ++i) p.advance({.dstran = {0, 0, 0, 1e-3 * x, 0, 0}, .dtime = x});
            const double expected = meth == 1 ? 0.5 * x / std::sinh(0.5 * x) : 1.0;
            EXPECT_NEAR(p.stress()[3], 1e-3 * expected, 1e-12) << "METH " << meth;
        }
    }
}

TEST(Viscoelastic, LongIncrementsFallBack) {
    const Load load{.dstran = {0.01, 0, 0, 0.02, 0, 0}, .dtime = 0.6};  // longer than tau1, shorter than tau2
    const Numbers first_only = {1000, 300, 1, 0, 200, 0.5};
    UmatPoint a = material(solid, first_only), b = material(solid, first_only + with_method(2)),
              c = material(solid, first_only + with_method(3));
    for (int i = 0; i < 5; ++i) {
        a.advance(load), b.advance(load), c.advance(load);
        expect_stress(a.stress(), b.stress(), 1e-14);
        expect_stress(a.stress(), c.stress(), 1e-14);
    }
    // Each element for itself.
    UmatPoint both = material(solid, S + with_method(2));
    const Answer answer = both.advance(load);
    const double A1 = -std::expm1(-1.2) / 1.2, A2 = 1 - 0.06;
    expect_close(300 + 200 * A1 + 100 * A2, answer.tangent(3, 3), 1e-13);
}

TEST(Viscoelastic, DissipationIsExact) {
    for (const auto& [x, d] : {std::pair{0.1, 0.0906346234610}, {1.0, 0.432332358382}}) {
        UmatPoint p = material(solid, element(0));
        p.advance({.dstran = {0, 0, 0, 1e-3, 0, 0}, .dtime = 1e-12});
        const double before = p.scd();
        p.advance({.dtime = x});
        // 2 G b:b D with the tensor shear: G gamma^2 D
        expect_close(1e-6 * d, p.scd() - before, 1e-11);
    }
    // A constant rate from rest: tau rate^2 int (1 - exp(-y))^2 dy, in any number of increments, whether the series of
    // a22 serves or not.
    for (const int n : {1, 7, 60, 1000}) {
        UmatPoint p = material(solid, element(0));
        for (int i = 0; i < n; ++i) p.advance({.dstran = {0, 0, 0, 1e-3 / n, 0, 0}, .dtime = 1.0 / n});
        expect_close(1e-6 * (1 - 2 * (1 - std::exp(-1.0)) + 0.5 * (1 - std::exp(-2.0))), p.scd(), 1e-12);
    }
}

// Exact integral of 1/a_T of WLF over a linear temperature, and the errors printed for each rule.
TEST(Viscoelastic, RulesOfTheReducedTime) {
    const double C1 = 17.44 * std::log(10.0), C2 = 51.6, b = C1 * C2;
    const auto primitive = [&](double y) {
        return std::exp(C1) * (y * std::exp(-b / y) + b * std::expint(-b / y));  // E1(x) = -Ei(-x)
    };
    const double exact = (primitive(C2 + 5) - primitive(C2)) / 5;
    const double table[4][2] = {{-4.4e-2, -1.2e-2}, {0.80, 0.22}, {-0.36, -0.11}, {-2.6e-4, -4.6e-6}};
    for (int rule = 0; rule < 4; ++rule)
        for (const int increments : {1, 2}) {
            Numbers props = S + Numbers{0, 0, 0, 0} + no_shift + Numbers{double(rule)};
            props[12] = 1, props[13] = 300;
            UmatPoint p = material(solid, props);
            p.temperature(300);
            for (int i = 0; i < increments; ++i) p.advance({.dtime = 1.0 / increments, .dtemp = 5.0 / increments});
            const double expected = table[rule][increments - 1];
            EXPECT_NEAR(p.state(TR) / exact - 1, expected, 0.05 * std::abs(expected)) << "DTRM " << rule;
        }
}

TEST(Viscoelastic, ArrheniusShift) {
    UmatPoint p = material(solid, S + Numbers{0, 0, 0, 0, 2, 300, 8000});
    p.temperature(320);
    p.advance({.dtime = 2});
    expect_close(2 * std::exp(-8000 * (1 / 320.0 - 1 / 300.0)), p.state(TR), 1e-13);
}

TEST(Viscoelastic, TimeStandsStillBelowThePole) {
    UmatPoint p = material(solid, S + Numbers{0, 0, 0, 0, 1, 373});
    for (const double T : {373 - 51.6, 200.0, -10.0}) {
        p.temperature(T);
        p.advance({.dstran = {0, 0, 0, 0.01, 0, 0}, .dtime = 1e6});
    }
    EXPECT_EQ(p.state(TR), 0.0);
    expect_stress({0, 0, 0, 18}, p.stress(), 1e-14);  // G0 + G1 + G2
    // also where it touches the pole within the increment
    p.temperature(373);
    p.advance({.dtime = 1, .dtemp = -60});
    EXPECT_EQ(p.state(TR), 0.0);
}

// --- Structure ----------------------------------------------------------------------------------------------------

// Uniaxial stress and relaxation moduli of 10.1.7, corrected.
TEST(Viscoelastic, RelaxationModuli) {
    const Numbers elastic_volume = {1000, 300, 1, 0, 500, 2}, relaxing_volume = {1000, 300, 1, 1, 500, 2, 700, 0.8};
    const double times[3] = {0.3, 1, 5};
    const double uni[2][3] = {{1763.25113065, 1515.54818246, 940.970985481},
                              {1881.95235206, 1550.08388629, 930.729091990}};
    const double plane[2][3] = {{1841.55287142, 1615.60426763, 1079.22184483},
                                {2052.54995674, 1686.88783017, 1063.10466268}};
    constexpr int n = 512;
    for (int k = 0; k < 2; ++k)
        for (int j = 0; j < 3; ++j) {
            const Numbers& props = k == 0 ? elastic_volume : relaxing_volume;
            const double dt = times[j] / n;
            UmatPoint bar = material(uniaxial, props);
            bar.advance({.dstran = {1e-3}, .dtime = 1e-12});
            for (int i = 0; i < n; ++i) bar.advance({.dtime = dt});
            // second order: 1.6e-5 in 32 increments over 2.5 relaxation times
            expect_close(uni[k][j], bar.stress()[0] / 1e-3, 1e-6);
            // stress 22 vanishes
            UmatPoint sheet = material(plane_strain, props);
            for (int i = 0; i <= n; ++i) {
                Load load{.dstran = {i == 0 ? 1e-3 : 0.0, 0, 0, 0}, .dtime = i == 0 ? 1e-12 : dt};
                const Answer trial = sheet.evaluate(load);
                load.dstran[1] = -trial.stress[1] / trial.tangent(1, 1);
                sheet.advance(load);
            }
            EXPECT_NEAR(sheet.stress()[1], 0.0, 1e-12);
            expect_close(plane[k][j], sheet.stress()[0] / 1e-3, 1e-6);
        }
}

TEST(Viscoelastic, LateralStrainMakesItSecondOrder) {
    const double table[2][6] = {{1.9e-2, 4.3e-3, 1.1e-3, 2.6e-4, 6.6e-5, 1.6e-5},
                                {7.1e-3, 1.8e-3, 4.5e-4, 1.1e-4, 2.8e-5, 7.0e-6}};
    for (const int meth : {0, 1})
        for (int level = 0; level < 6; ++level) {
            const int n = 1 << level;
            UmatPoint p = material(uniaxial, Numbers{1000, 300, 1, 0, 500, 2} + with_method(meth));
            p.advance({.dstran = {0.01}, .dtime = 1e-12});
            for (int i = 0; i < n; ++i) p.advance({.dtime = 5.0 / n});
            const double error = std::abs(p.stress()[0] / 9.40970985481 - 1);
            EXPECT_NEAR(error, table[meth][level], 0.05 * table[meth][level]) << "METH " << meth << ", N " << n;
        }
}

TEST(Viscoelastic, InitialStressSurvives) {
    UmatPoint p = material(solid, S), q = material(solid, S);
    q.stress({5, -3, 2, 1, 0, 4});
    const Load load{.dstran = {0.01, 0, 0, 0.02, 0, 0}};
    p.advance(load), q.advance(load);
    const Numbers initial = {5, -3, 2, 1, 0, 4};
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(q.stress()[i], p.stress()[i] + initial[i], 1e-14);
}

TEST(Viscoelastic, ExplicitEntryPointGivesTheTable) {
    VumatBlock block("VISCOELASTIC-TEST", solid, SK);
    VumatPoint p = block.fresh_point();
    p.strain_increment = {0.01, -0.002, 0.001, 0.02, 0.004, -0.006};
    block.points.assign(11, p);
    ASSERT_EQ(block.run().stops, 0);
    for (const VumatPoint& q : block.points) {
        expect_stress({18.512394582, 7.0619682987, 9.92457486952, 9.54202190275, 1.90840438055, -2.86260657082},
                      q.stress);
        expect_close(0.0304224010893, q.inelastic_energy);
    }
}

TEST(Viscoelastic, FluidLosesItsShearStiffness) {
    UmatPoint p = material(solid, {1000, 0, 1, 0, 200, 0.5});
    const Answer a = p.advance({.dstran = {0.01, 0, 0, 0.02, 0, 0}, .dtime = 1e9});
    expect_close(200 * 0.5 / 1e9, a.tangent(3, 3), 1e-12);
    EXPECT_NEAR(a.tangent(0, 0), 1000, 1e-6);
    expect_stress({10, 10, 10}, {a.stress[0], a.stress[1], a.stress[2]}, 1e-9);
}

// At constant strain the total form answers to the vertical shift at once (V8), also where nothing else happens.
TEST(Viscoelastic, VerticalShiftActsOnTheTotalStress) {
    UmatPoint p = material(solid, S + Numbers{0, 0, 0, 0} + no_shift + Numbers{0, 1, 2, 20, 0.5, 0, 1, 0.1, 0.6});
    p.advance({.dstran = {0.01, 0, 0, 0.02, 0, 0}, .dtime = 0});
    const Numbers before = p.stress();
    expect_stress({8.5 + 0.5, 4 - 1, 4 - 1, 6}, {9, 3, 3, before[3]}, 1e-13);  // half of 18, 6, 6, 12
    p.advance({.dtime = 0, .dpred = {0.05}});
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(p.stress()[i], 0.8 * before[i], 1e-13);
    p.advance({.dtime = 0, .dpred = {7}});
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(p.stress()[i], 0.6 * before[i], 1e-13);
}

// --- Failure modes ------------------------------------------------------------------------------------------------

void expect_end(const UmatPoint& p, const Load& load, const std::vector<std::string>& words) {
    const Answer a = p.evaluate(load);
    EXPECT_EQ(a.messages.stops, 1);
    for (const std::string& word : words) EXPECT_NE(a.first_error().find(word), std::string::npos) << a.first_error();
}

TEST(Viscoelastic, ImpossibleShiftsEndTheAnalysis) {
    UmatPoint cold = material(solid, S + Numbers{0, 0, 0, 0, 2, 300, 8000});
    cold.temperature(10);
    expect_end(cold, {.dtemp = -20}, {"VISCOELASTIC-TEST", "temperature", "-10", "> 0"});
    UmatPoint dry = material(solid, S + Numbers{0, 0, 0, 0, 0, 0, 17.44, 51.6, 1, 0.12, 2, 0.06});
    expect_end(dry, {.dpred = {-0.08}}, {"CC2 + c", "-0.02", "> 0"});
    UmatPoint stuck = material(solid, S + Numbers{0, 0, 0, 0, 0, 0, 17.44, 51.6, 0, 0.1, 2, 0.06, 3, -4});
    expect_end(stuck, {.dpred = {0.4}}, {"1/a_mu", "-0.2", "> 0"});

    VumatBlock block("VISCOELASTIC-TEST", solid, cold.props());
    for (int i = 0; i < 10; ++i) {
        VumatPoint p = block.fresh_point();
        p.temperature_old = p.temperature_new = i == 8 ? -1.0 : 300.0;
        block.points.push_back(p);
    }
    const HostMessages messages = block.run();
    EXPECT_EQ(messages.stops, 1);
    EXPECT_NE(messages.errors.front().find("point 9"), std::string::npos) << messages.errors.front();
}

TEST(Viscoelastic, LogarithmicPressureLawEndsAtE) {
    const Numbers props = S + with_method(0, 3);
    UmatPoint p = material(solid, props);
    EXPECT_TRUE(p.evaluate({.dstran = {0.33, 0.33, 0.33, 0, 0, 0}}).done());
    const Answer far = p.evaluate({.dstran = {0.34, 0.33, 0.33, 0, 0, 0}});
    EXPECT_TRUE(far.cut);
    EXPECT_EQ(far.pnewdt, 0.5);
    VumatBlock block("VISCOELASTIC-TEST", solid, props);
    VumatPoint v = block.fresh_point();
    v.strain_increment = {0.34, 0.33, 0.33, 0, 0, 0};
    block.points = {v};
    const HostMessages messages = block.run();
    EXPECT_EQ(messages.stops, 1);
    EXPECT_NE(messages.errors.front().find("PLAW = 3"), std::string::npos);
    // PLAW = 2 is crushed at a finite pressure.
    UmatPoint soft = material(solid, S + with_method(0, 2));
    const Answer crushed = soft.evaluate({.dstran = {-3, -3, -3, 0, 0, 0}});
    expect_stress({1000 * std::expm1(-9.0), 1000 * std::expm1(-9.0), 1000 * std::expm1(-9.0)}, crushed.stress, 1e-13);
}

std::string refusal(const Numbers& props, int ndi = 3, int nshr = 3) {
    char error[400] = "";
    EXPECT_EQ(lode_required_state("VISCOELASTIC-TEST", props.data(), static_cast<int>(props.size()), ndi, nshr, error,
                                  sizeof error),
              -1);
    return error;
}
void expect_refusal(const Numbers& props, const std::vector<std::string>& words) {
    const std::string message = refusal(props);
    for (const std::string& word : words) EXPECT_NE(message.find(word), std::string::npos) << message;
}

TEST(Viscoelastic, RefusesBadConstants) {
    char error[200] = "";
    EXPECT_EQ(lode_required_state("VISCOELASTIC", SK.data(), 10, 3, 3, error, sizeof error), 11 + 12 + 1);
    EXPECT_EQ(lode_required_state("VISCOELASTIC", SK.data(), 10, 1, 0, error, sizeof error), 11 + 12 + 1);
    expect_refusal({1000, 300, 2, 0, 200, 0.5, 100}, {"at least 8", "NPROPS = 7", "tauk", "number 2"});
    expect_refusal({1000, 300, 2, 0, 200, 0.5, 100, 0}, {"PROPS(8) = 0", "tauk", "> 0"});
    expect_refusal({1000, 300, 1, 1, 200, 0.5, -1, 1}, {"PROPS(7) = -1", "Kk"});
    expect_refusal({1000, 300, 31, 0}, {"PROPS(3) = 31", "0..30"});
    expect_refusal({1000, 0, 1, 0, 0, 1}, {"PROPS(2) = 0", "> 0 where the sum of Gk is 0"});
    expect_refusal(SK + with_method(0, 1), {"PROPS(4) = 1", "0 where PLAW > 0"});
    expect_refusal(S + with_method(4), {"PROPS(11) = 4", "METH"});
    expect_refusal(S + Numbers{0, 0, 0, 0, 2, 0}, {"PROPS(14) = 0", "Arrhenius"});
    const Numbers before_points = S + Numbers{0, 0, 0, 0} + no_shift + Numbers{0};
    expect_refusal(before_points + Numbers{2, 0, 10, 1, 20}, {"at least 29", "NPROPS = 28", "bT"});
    expect_refusal(before_points + Numbers{2, 0, 10, 1, 10, 0.5}, {"PROPS(28) = 10", "> 10"});
    expect_refusal(before_points + Numbers{0, 1, 0, -1}, {"PROPS(27) = -1", "bc"});
    EXPECT_NE(refusal(S, 1, 1).find("not served"), std::string::npos);
}

}  // namespace
}  // namespace lode::test::test_viscoelastic
