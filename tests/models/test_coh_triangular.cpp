// COH_TRIANGULAR and what all traction-separation laws share: the verification cases and failure modes of page 40.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "coh_support.hpp"
#include "lode/cohesive/coh_triangular.hpp"
#include "umat_point.hpp"
#include "vumat_block.hpp"

namespace lode::test::test_coh_triangular {
namespace {

constexpr AnalysisKind flat = AnalysisKind::cohesive_2d, spatial = AnalysisKind::cohesive_3d;
const Numbers set_a = {100000, 30, 0.3, 50000, 40, 0.9};
constexpr double kn = 1e5, uen = 3e-4, ucn = 0.02, wn = ucn - uen, kt = 5e4, uet = 8e-4, uct = 0.045, wt = uct - uet;
constexpr double printed = 2e-11;  // twelve digits
enum Entry { UN = 1, US1, US2, DN, DT, DAMN, DAMT, GI, GII, WORK, GDROP, STATUS };

// An interface that is led along a path of separations.
class Interface {
  public:
    explicit Interface(AnalysisKind kind, Numbers props = set_a, double thickness = 1.0)
        : point("COH_TRIANGULAR-TEST", kind, std::move(props)), thickness_(thickness) {}

    Answer to(const Numbers& separation) {
        Load load;
        for (std::size_t i = 0; i < separation.size(); ++i)
            load.dstran.push_back((separation[i] - point.state(int(i) + 1)) / thickness_);
        return point.advance(load);
    }
    UmatPoint point;

  private:
    double thickness_;
};

// What a row of the page's tables prints.
void expect_row(const Answer& a, const Numbers& tractions, std::initializer_list<std::pair<int, double>> entries) {
    for (std::size_t i = 0; i < tractions.size(); ++i)
        EXPECT_NEAR(a.stress[i], tractions[i], printed * largest(tractions) + 1e-15) << "traction " << i;
    for (const auto& [index, value] : entries)
        EXPECT_NEAR(a.state[std::size_t(index) - 1], value, printed * std::abs(value) + 1e-15) << "STATEV " << index;
}

// --- 7.1: the strength law ---------------------------------------------------------------------------------------

TEST(Sawtooth, TableOfStrengthLaws) {
    const double constants[] = {100000, 30, 0.3, 50000, 40, 0.9};
    const Properties p(CohTriangular::description, "T", constants, 6);
    const Sawtooth law(p, {1, 2, 3, 0, 0, "n"});
    EXPECT_NEAR(law.elastic_limit, 0.0003, 1e-18);
    EXPECT_NEAR(law.end, 0.02, 1e-17);
    const double delta = law.elastic_limit + 0.4 * (law.end - law.elastic_limit), q = law.integrity(delta);
    EXPECT_NEAR(delta, 0.00818, 1e-17);
    EXPECT_NEAR(law.stiffness * q * delta, 18.0, 1e-13);
    const double phi = law.stiffness * q * delta - delta * law.slope(delta);
    EXPECT_NEAR(phi, 30.4568527919, printed * phi);
    EXPECT_NEAR(2 * law.release_rate(delta), phi, 1e-13 * phi);
    EXPECT_NEAR(1 - q, 0.977995110024, printed);
    EXPECT_NEAR(phi / (law.stiffness * delta * delta), 4.55175016766, printed * 5);
    EXPECT_NEAR(law.released_energy(delta), 0.12, 1e-16);
    EXPECT_EQ(law.integrity(law.elastic_limit), 1.0);
    EXPECT_EQ(law.integrity(law.end), 0.0);
    EXPECT_EQ(law.released_energy(law.elastic_limit), 0.0);
    EXPECT_NEAR(law.released_energy(law.end), 0.3, 1e-16);
}

// --- 7.2: increments ---------------------------------------------------------------------------------------------

TEST(CohTriangular, TR1) {
    Interface face(flat);
    expect_row(face.to({0.0001, 0}), {10, 0}, {{DN, 0.0003}, {DAMN, 0}, {GI, 0}, {STATUS, 1}});
    Answer a = face.to({0.005, 0});
    expect_row(a, {22.8426395939, 0}, {{DN, 0.005}, {DAMN, 0.954314720812}, {GI, 0.0715736040609}, {STATUS, 1}});
    EXPECT_NEAR(a.tangent(0, 0), -30 / 0.0197, 1e-12 * 1523);
    EXPECT_NEAR(a.tangent(0, 0), -1522.84263959391, 1e-10);
    a = face.to({0.002, 0});
    expect_row(a, {9.13705583756, 0}, {{DN, 0.005}, {DAMN, 0.954314720812}, {GI, 0.0715736040609}, {STATUS, 1}});
    EXPECT_NEAR(a.tangent(0, 0), 4568.52791878173, 1e-10);
    a = face.to({0.0201, 0});
    expect_row(a, {0, 0}, {{DN, 0.02}, {DAMN, 1}, {DAMT, 1}, {GI, 0.3}, {GDROP, 0}, {STATUS, 0}});
    EXPECT_EQ(a.tangent.cwiseAbs().maxCoeff(), 0.0);
    EXPECT_EQ(Interface(flat).to({0.0001, 0}).tangent(0, 0), 100000.0);
}

TEST(CohTriangular, TR2) {
    Interface face(flat);
    expect_row(face.to({0, 0.0006}), {0, 30}, {{DT, 0.0008}, {DAMT, 0}, {GII, 0}});
    expect_row(face.to({0, 0.01}), {0, 31.6742081448}, {{DT, 0.01}, {DAMT, 0.93665158371}, {GII, 0.187330316742}});
    expect_row(face.to({0, -0.02}), {0, -22.6244343891}, {{DT, 0.02}, {DAMT, 0.977375565611}, {GII, 0.390950226244}});
    expect_row(face.to({0, 0.005}), {0, 5.65610859729}, {{DT, 0.02}, {DAMT, 0.977375565611}, {GII, 0.390950226244}});
}

TEST(CohTriangular, TR3) {
    Interface face(flat);
    expect_row(face.to({0.005, 0.015}), {22.8426395939, 27.149321267},
               {{DN, 0.005}, {DT, 0.015}, {GI, 0.0715736040609}, {GII, 0.289140271493}, {GDROP, 0}, {STATUS, 1}});
    const Answer a = face.to({0.01, 0.03});
    expect_row(a, {0, 0},
               {{DN, 0.00871016456922},
                {DT, 0.0261304937076},
                {DAMN, 1},
                {DAMT, 1},
                {GI, 0.12807357212},
                {GII, 0.51577928364},
                {GDROP, 0.297983752058},
                {STATUS, 0}});
    // closed form (7.3): the path parameter at which (GI/GIc) + (GII/GIIc) = 1
    const double s = (1 + uen / wn + uet / wt) / (0.01 / wn + 0.03 / wt);
    EXPECT_NEAR(s, 0.871016456921588, 1e-15);
    EXPECT_NEAR(a.state[DN - 1], 0.01 * s, 1e-16);
    EXPECT_NEAR(a.state[GI - 1] / 0.3 + a.state[GII - 1] / 0.9, 1.0, 1e-15);
    EXPECT_NEAR(face.point.spd(), a.state[GI - 1] + a.state[GII - 1] + a.state[GDROP - 1], 1e-15);
    EXPECT_EQ(face.point.sse(), 0.0);
}

TEST(CohTriangular, TR4) {
    Interface face(flat);
    Answer a = face.to({-0.0001, 0.01});
    expect_row(a, {-10, 31.6742081448},
               {{DN, 0.0003}, {DT, 0.01}, {GI, 0}, {GII, 0.187330316742}, {WORK, 0.158871040724}});
    EXPECT_EQ(a.tangent(0, 0), kn);
    a = face.to({0.004, 0.005});
    expect_row(a, {24.3654822335, 15.8371040724},
               {{DN, 0.004}, {DT, 0.01}, {GI, 0.056345177665}, {GII, 0.187330316742}, {WORK, 0.0695419987597}});
}

TEST(CohTriangular, TR5) {
    Interface face(spatial);
    expect_row(face.to({0.002, 0.01, -0.008}), {27.4111675127, 22.7503135067, -18.2002508054},
               {{DN, 0.002}, {DT, 0.0128062484749}, {GI, 0.0258883248731}, {GII, 0.244471122791}});
    expect_row(face.to({0.001, -0.02, 0.004}), {13.7055837563, -21.8336021775, 4.36672043549},
               {{DN, 0.002}, {DT, 0.0203960780544}, {GI, 0.0258883248731}, {GII, 0.399015164003}});
}

// --- 7.3: further checks -----------------------------------------------------------------------------------------

TEST(CohTriangular, FailureAt19ModeRatios) {
    for (const double power : {1.0, 2.0})
        coh::check_failure_criterion("COH_TRIANGULAR", {100000, 30, 0.3, 50000, 40, 0.9, power}, 0.3, 0.9, power);
}

TEST(CohTriangular, FailureDoesNotDependOnTheIncrementSize) {
    for (const double exponent : {0.5, 1.0, 2.0, 3.7}) {
        Numbers props = set_a;
        props.push_back(exponent);
        Interface once(flat, props), often(flat, props);
        const Answer one = once.to({0.019, 0.042});
        Answer many;
        for (int i = 1; i <= 997; ++i) many = often.to({0.019 * i / 997, 0.042 * i / 997});
        EXPECT_EQ(one.state[STATUS - 1], 0.0);
        for (const int entry : {DN, DT, GI, GII, GDROP})
            EXPECT_NEAR(one.state[std::size_t(entry) - 1], many.state[std::size_t(entry) - 1], 4e-15) << entry;
        EXPECT_NEAR(std::pow(one.state[GI - 1] / 0.3, exponent) + std::pow(one.state[GII - 1] / 0.9, exponent), 1.0,
                    1e-14);
    }
}

TEST(CohTriangular, WithoutCriterionEachModeRunsToTheEndOfItsLaw) {
    Numbers props = set_a;
    props.push_back(0);
    Interface face(flat, props);
    Answer a = face.to({0.018, 0.04});
    EXPECT_EQ(a.state[STATUS - 1], 1.0);
    EXPECT_NEAR(a.state[GI - 1], 0.3 * (0.018 - uen) / wn, 1e-15);
    a = face.to({0.018, 0.046});
    EXPECT_EQ(a.state[STATUS - 1], 0.0);
    EXPECT_NEAR(a.state[DT - 1], uct, 1e-16);
    EXPECT_NEAR(a.state[GDROP - 1], 0.5 * 30 * (ucn - 0.018) / wn * 0.018, 1e-15);  // mode I still carried traction
}

TEST(CohTriangular, ShearsAreInterchangeable) {
    Interface first(spatial), second(spatial);
    for (const Numbers& u : {Numbers{0.002, 0.01, -0.008}, Numbers{0.001, -0.02, 0.004}, Numbers{0.012, -0.04, 0.01}}) {
        const Answer a = first.to(u), b = second.to({u[0], -u[2], u[1]});
        EXPECT_EQ(a.stress[0], b.stress[0]);
        EXPECT_EQ(a.stress[1], b.stress[2]);
        EXPECT_EQ(a.stress[2], -b.stress[1]);
        for (const int entry : {DN, DT, DAMN, DAMT, GI, GII, GDROP, STATUS})
            EXPECT_DOUBLE_EQ(a.state[std::size_t(entry) - 1], b.state[std::size_t(entry) - 1]);
    }
}

TEST(CohTriangular, ConstitutiveThicknessScalesStrainTangentAndEnergies) {
    Numbers thin_props = set_a;
    thin_props.insert(thin_props.end(), {1, 1, 0, 0.1});
    Interface unit(spatial), thin(spatial, thin_props, 0.1);
    for (const Numbers& u : {Numbers{1e-4, 2e-4, 0}, Numbers{0.002, 0.01, -0.008}, Numbers{-0.001, -0.02, 0.004},
                             Numbers{0.012, -0.04, 0.01}}) {
        const Answer a = unit.to(u), b = thin.to(u);
        for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(a.stress[i], b.stress[i], 1e-12);
        EXPECT_NEAR((a.tangent - 10 * b.tangent).cwiseAbs().maxCoeff(), 0.0, 1e-9);
        EXPECT_NEAR(a.sse, b.sse / 10, 1e-15);
        EXPECT_NEAR(a.spd, b.spd / 10, 1e-15);
        EXPECT_NEAR(a.state[WORK - 1], b.state[WORK - 1], 1e-15);
    }
}

TEST(CohTriangular, UniaxialToughnessForAnyStiffnessRatio) {
    for (const double ratio : {1e-12, 1e-6, 0.3, 0.999}) {  // u_e/u_c
        const double sig = 30, Gc = 0.3, uc = 2 * Gc / sig, k = sig / (ratio * uc);
        Interface face(flat, {k, sig, Gc, k, sig, Gc});
        const double half = uc * (1 + ratio) / 2;
        const Answer a = face.to({half, 0});
        EXPECT_NEAR(a.stress[0], sig * (uc - half) / (uc - ratio * uc), 1e-12 * sig);
        EXPECT_EQ(a.state[STATUS - 1], 1.0);
        const Answer near_end = face.to({uc * (1 - 1e-9), 0});  // 1 - D is far below the rounding of D here
        EXPECT_NEAR(near_end.stress[0], sig * 1e-9 / (1 - ratio), 1e-15 * sig / (1 - ratio) * 10);
        EXPECT_LT(near_end.state[DAMN - 1], 1.0);
        const Answer unloaded = face.to({uc / 2, 0});
        EXPECT_NEAR(unloaded.stress[0], near_end.stress[0] / 2 / (1 - 1e-9), 1e-15 * sig);
        EXPECT_NEAR(face.to({1.1 * uc, 0}).state[GI - 1], Gc, 1e-15);
    }
}

TEST(CohTriangular, TangentAgainstCentralDifferences) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (const int contact : {0, 1, 2})
        for (int path = 0; path < 40; ++path) {
            Numbers props = set_a;
            props.insert(props.end(), {1, double(contact), 4e5, 0.5});
            Interface face(spatial, props, 0.5);
            for (int step = 0; step < 4; ++step) {
                Load load;
                const auto separation = [&](double size) { return 2 * size * uniform(random); };
                load.dstran = {separation(0.004), separation(0.008), separation(0.008)};
                const Answer a = face.point.evaluate(load);
                const double h = 1e-9;
                for (std::size_t j = 0; j < 3 && a.state[STATUS - 1] == 1.0; ++j) {
                    Load plus = load, minus = load;
                    plus.dstran[j] += h;
                    minus.dstran[j] -= h;
                    const Answer up = face.point.evaluate(plus), down = face.point.evaluate(minus);
                    for (std::size_t i = 0; i < 3; ++i)
                        EXPECT_NEAR(a.tangent(int(i), int(j)), (up.stress[i] - down.stress[i]) / (2 * h), 1e-6 * kn);
                }
                face.point.advance(load);
            }
        }
}

// Work of the tractions = stored + released, exactly; W by the trapezoid rule only in the limit (1.4).
TEST(CohTriangular, EnergyIdentity) {
    for (const int contact : {0, 1, 2}) {
        double error[2];
        for (const int refinement : {0, 1}) {
            Numbers props = set_a;
            props.insert(props.end(), {2, double(contact), 3e5, 0.25});
            Interface face(spatial, props, 0.25);
            const Numbers path[] = {{0, 0, 0},     {0.004, 0.003, 0.001}, {-1e-4, 0.012, -0.01},
                                    {0.006, 0, 0}, {-2e-4, -0.02, 0.01},  {0.001, 0.03, 0.01}};
            const int steps = refinement == 0 ? 2000 : 4000;
            Answer a;
            for (std::size_t leg = 1; leg < std::size(path); ++leg)
                for (int i = 1; i <= steps; ++i) {
                    Numbers u(3);
                    for (std::size_t c = 0; c < 3; ++c)
                        u[c] = path[leg - 1][c] + (path[leg][c] - path[leg - 1][c]) * i / steps;
                    a = face.to(u);
                }
            EXPECT_EQ(a.state[STATUS - 1], 1.0);
            EXPECT_NEAR(a.spd * 0.25, a.state[GI - 1] + a.state[GII - 1] + a.state[GDROP - 1], 1e-13);
            error[refinement] = std::abs(a.state[WORK - 1] - 0.25 * (a.sse + a.spd));
        }
        EXPECT_LT(error[1], 1e-6);
        EXPECT_LT(error[1], 0.5 * error[0] + 1e-12);
    }
}

// --- 1.3: contact ------------------------------------------------------------------------------------------------

TEST(CohTriangular, ContactOptions) {
    const auto with = [](double contact, double penalty) {
        Numbers props = set_a;
        props.insert(props.end(), {1, contact, penalty});
        return props;
    };
    struct Case {
        double contact, penalty, virgin, damaged, failed;
    };
    const double integrity = uen * (ucn - 0.005) / (wn * 0.005);
    for (const Case& c : {Case{0, 0, 0, 0, 0}, Case{1, 0, kn, kn, kn}, Case{1, 4e5, 4e5, 4e5, 4e5},
                          Case{2, 4e5, kn, kn * integrity, 0}}) {
        Interface face(flat, with(c.contact, c.penalty));
        Answer a = face.to({-1e-4, 0});
        EXPECT_NEAR(a.stress[0], -1e-4 * c.virgin, 1e-12);
        EXPECT_NEAR(a.tangent(0, 0), c.virgin, 1e-9);
        face.to({0.005, 0});
        a = face.to({-1e-4, 0.002});
        EXPECT_NEAR(a.stress[0], -1e-4 * c.damaged, 1e-12);
        EXPECT_NEAR(a.tangent(0, 0), c.damaged, 1e-9);
        EXPECT_NEAR(a.state[DN - 1], 0.005, 1e-18);  // compression does not damage mode I
        face.to({0.03, 0});
        a = face.to({-1e-4, 0.002});
        EXPECT_NEAR(a.stress[0], -1e-4 * c.failed, 1e-12);
        EXPECT_NEAR(a.tangent(0, 0), c.failed, 1e-9);
        EXPECT_EQ(a.stress[1], 0.0);
        EXPECT_EQ(a.state[STATUS - 1], 0.0);
        EXPECT_EQ(face.to({0.001, 0}).stress[0], 0.0);
    }
}

TEST(CohTriangular, ZeroIncrementReturnsTractionAndSecantAlsoOnTheSofteningBranch) {
    Interface face(spatial);
    const Answer loaded = face.to({0.005, 0.01, 0.004}), again = face.point.advance({});
    EXPECT_TRUE(identical(loaded.stress, again.stress));
    EXPECT_TRUE(identical(loaded.state, again.state));
    EXPECT_NEAR(again.tangent(0, 0), loaded.stress[0] / 0.005, 1e-9);
    EXPECT_NEAR(again.tangent(1, 1), loaded.stress[1] / 0.01, 1e-9);
    EXPECT_EQ(again.tangent(1, 2), 0.0);
    EXPECT_LT(loaded.tangent(0, 0), 0.0);
}

// --- the explicit interface --------------------------------------------------------------------------------------

TEST(CohTriangular, ExplicitIsImplicit) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (const AnalysisKind kind : {flat, spatial}) {
        Numbers props = set_a;
        props.insert(props.end(), {1.6, 1, 0, 0.2});
        constexpr std::size_t count = 37;
        VumatBlock block("COH_TRIANGULAR", kind, props);
        block.points.assign(count, block.fresh_point());
        std::vector<UmatPoint> points(count, UmatPoint("COH_TRIANGULAR", kind, props));
        bool someone_failed = false;
        for (int step = 0; step < 12; ++step) {
            for (std::size_t p = 0; p < count; ++p) {
                Numbers de = {0.02 * uniform(random) + 0.01, 0.05 * uniform(random)};
                if (kind == spatial) de.push_back(0.05 * uniform(random));
                block.points[p].strain_increment = de;
                block.points[p].density = 2.0;
                points[p].advance({.dstran = de});
            }
            EXPECT_EQ(block.run().stops, 0);
            for (std::size_t p = 0; p < count; ++p) {
                EXPECT_LT(distance(points[p].stress(), block.points[p].stress), 1e-11);
                EXPECT_LT(distance(points[p].state(), block.points[p].state), 1e-13);
                EXPECT_NEAR(block.points[p].internal_energy, points[p].state(WORK) / (0.2 * 2.0), 1e-12);
                EXPECT_NEAR(block.points[p].inelastic_energy, points[p].spd() / 2.0, 1e-12);
                someone_failed |= points[p].state(STATUS) == 0.0;
            }
        }
        EXPECT_TRUE(someone_failed);
    }
}

TEST(CohTriangular, ExplicitProbeIsElasticAndLeavesNoTrace) {
    Numbers props = set_a;
    props.insert(props.end(), {1, 1, 0, 0.2});
    VumatBlock block("COH_TRIANGULAR", spatial, props);
    block.points.assign(3, block.fresh_point());
    for (VumatPoint& p : block.points) p.strain_increment = {1.0, -2.0, 3.0};
    block.step_time = block.total_time = 0.0;
    EXPECT_EQ(block.run().stops, 0);
    for (const VumatPoint& p : block.points) {
        EXPECT_DOUBLE_EQ(p.stress[0], 0.2 * kn);
        EXPECT_DOUBLE_EQ(p.stress[1], -0.4 * kt);
        EXPECT_DOUBLE_EQ(p.stress[2], 0.6 * kt);
        EXPECT_EQ(largest(p.state), 0.0);
    }
}

// --- 6: where it fails -------------------------------------------------------------------------------------------

TEST(CohTriangular, ToughnessBelowTheElasticEnergyIsRefused) {
    const auto message = [](const Numbers& props) {
        char text[512] = "";
        EXPECT_EQ(lode_required_state("COH_TRIANGULAR-BAD", props.data(), int(props.size()), 1, 1, text, sizeof text),
                  -1);
        return std::string(text);
    };
    EXPECT_NE(message({100000, 30, 0.0045, 50000, 40, 0.9}).find("must be greater than sig_n^2/(2 k_n) = 0.0045"),
              std::string::npos);
    EXPECT_NE(message({100000, 30, 0.3, 50000, 40, 0.01}).find("must be greater than sig_t^2/(2 k_t) = 0.016"),
              std::string::npos);
    EXPECT_NE(message({100000, 30, 0.3, 50000, 40}).find("needs at least 6 constants"), std::string::npos);
    EXPECT_NE(message({0, 30, 0.3, 50000, 40, 0.9}).find("K_N"), std::string::npos);
    EXPECT_NE(message({1e308, 1e-30, 0.3, 50000, 40, 0.9}).find("K_N"), std::string::npos);
    EXPECT_NE(message({100000, 30, 0.3, 50000, 40, 0.9, 1, 3}).find("CONTACT"), std::string::npos);
    EXPECT_NE(message({100000, 30, 0.3, 50000, 40, 0.9, 1, 1, -1}).find("K_COMP"), std::string::npos);
    EXPECT_NE(message({100000, 30, 0.3, 50000, 40, 0.9, 1, 1, 0, 0}).find("T0"), std::string::npos);
    EXPECT_NE(message({100000, 30, 0.3, 50000, 40, 0.9, HUGE_VAL}).find("NMIX"), std::string::npos);
    char text[512];
    EXPECT_EQ(lode_required_state("COH_TRIANGULAR", set_a.data(), 6, 1, 2, text, sizeof text), 12);
    EXPECT_EQ(lode_required_state("COH_TRIANGULAR", set_a.data(), 6, 3, 3, text, sizeof text), -1);
}

// The smallest toughness that is not refused: brittle, but not a division by zero.
TEST(CohTriangular, BrittleLimit) {
    Interface face(flat, {100000, 30, std::nextafter(0.0045, 1), 50000, 40, 0.9});
    Answer a = face.to({0.0003, 0});
    EXPECT_DOUBLE_EQ(a.stress[0], 30.0);
    EXPECT_EQ(a.state[STATUS - 1], 1.0);
    a = face.to({0.00031, 0});
    EXPECT_EQ(a.stress[0], 0.0);
    EXPECT_EQ(a.state[STATUS - 1], 0.0);
    EXPECT_NEAR(a.spd, 0.0045, 1e-15);
}

TEST(CohTriangular, NonFiniteSeparationAsksForLess) {
    Interface face(flat);
    face.to({0.005, 0.01});
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), HUGE_VAL, -HUGE_VAL}) {
        EXPECT_EQ(face.point.step({.dstran = {bad, 0}}).pnewdt, 0.25);
        EXPECT_EQ(face.point.step({.dstran = {0, bad}}).pnewdt, 0.25);
    }
}

TEST(CohTriangular, LargeJumpsAreFailureNotNoise) {
    for (const double size : {1.0, 1e6, 1e150, 1e200}) {
        Interface face(spatial);
        const Answer a = face.to({size, -size, size});
        EXPECT_EQ(a.state[STATUS - 1], 0.0);
        EXPECT_NEAR(a.state[GI - 1] / 0.3 + a.state[GII - 1] / 0.9, 1.0, 1e-14);
        EXPECT_EQ(largest(a.stress), 0.0);
    }
}

TEST(CohTriangular, ClosureBeyondTheRangeOfNumbersAsksForLess) {
    EXPECT_EQ(Interface(flat).point.step({.dstran = {-1e200, 0}}).pnewdt, 0.25);
}

TEST(CohTriangular, DropAtFailureByTheCriterionIsAccountedFor) {
    Interface face(flat);
    const Answer before = face.to({0.0087, 0.0261}), after = face.to({0.0088, 0.0264});
    EXPECT_EQ(before.state[STATUS - 1], 1.0);
    EXPECT_EQ(after.state[STATUS - 1], 0.0);
    EXPECT_NEAR(after.state[GDROP - 1], before.sse, 1e-3);
    EXPECT_GT(after.state[GDROP - 1], 0.46 * (after.state[GI - 1] + after.state[GII - 1]));
}

// The tangent is the one-sided one of the increment.
TEST(CohTriangular, TangentJumpsAtReversalAndAtContact) {
    Interface face(flat);
    EXPECT_LT(face.to({0.005, 0}).tangent(0, 0), 0.0);
    EXPECT_GT(face.to({0.0049, 0}).tangent(0, 0), 0.0);
    EXPECT_NEAR(face.to({0, 0}).tangent(0, 0), 4568.52791878173, 1e-9);
    EXPECT_EQ(face.to({-1e-9, 0}).tangent(0, 0), kn);
}

}  // namespace
}  // namespace lode::test::test_coh_triangular
