// The conventions of the entry points, by the simplest material there is.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cfloat>
#include <cmath>
#include <numbers>

#include "guarded_memory.hpp"
#include "vumat_block.hpp"

namespace lode::test {
namespace {

using enum AnalysisKind;

const Numbers steel = {200000.0, 0.3};

// Component 11 of the stress of a bar under a unit strain of 1e-3; 0 where the name was refused.
double bar_stress(const std::string& cmname) {
    UmatPoint point("ISO_ELASTIC", uniaxial, steel);
    const Answer answer = point.raw_name(cmname).evaluate({.dstran = {1e-3}});
    return answer.done() ? answer.stress[0] : 0.0;
}
std::string padded(std::string name, char with = ' ') {
    name.resize(80, with);
    return name;
}

TEST(MaterialName, BlankPaddedOrTerminated) {
    EXPECT_EQ(bar_stress(padded("ISO_ELASTIC-STEEL")), 200.0);
    EXPECT_EQ(bar_stress(padded("ISO_ELASTIC")), 200.0);
    EXPECT_EQ(bar_stress(padded("  ISO_ELASTIC")), 200.0);
    EXPECT_EQ(bar_stress(padded("ISO_ELASTIC-STEEL", '\0')), 200.0);
    // A C host passes a string of its own length: no byte behind the terminator may be read.
    EXPECT_EQ(bar_stress(std::string("ISO_ELASTIC", 12)), 200.0);
    EXPECT_EQ(bar_stress(std::string("ISO_ELASTIC-X ", 15)), 200.0);
    // All 80 characters in use.
    std::string full = "ISO_ELASTIC-";
    full.resize(80, 'L');
    EXPECT_EQ(bar_stress(full), 200.0);
}

TEST(MaterialName, CaseIsFolded) {
    EXPECT_EQ(bar_stress(padded("iso_elastic-steel")), 200.0);
    EXPECT_EQ(bar_stress(padded("Iso_Elastic")), 200.0);
}

TEST(MaterialName, CalculixPrefix) {
    EXPECT_EQ(bar_stress(padded("@ABAQUS_LODE_UMAT@ISO_ELASTIC-STEEL")), 200.0);
    EXPECT_EQ(bar_stress(padded("@ABAQUSNL_LODE_UMAT@ISO_ELASTIC")), 200.0);
    EXPECT_EQ(bar_stress(padded("@ISO_ELASTIC")), 200.0);
    EXPECT_EQ(bar_stress(padded("ISO_ELASTIC@X")), 0.0) << "only a name that begins with @";
}

TEST(MaterialName, KeywordEndsAtTheFirstDash) {
    EXPECT_EQ(bar_stress(padded("ISO_ELASTIC-A-B")), 200.0);
    EXPECT_EQ(bar_stress(padded("ISO_ELASTICS")), 0.0);
    EXPECT_EQ(bar_stress(padded("ISO_ELAST")), 0.0);
    EXPECT_EQ(bar_stress(padded("ISO_ELASTIC STEEL")), 0.0);
    EXPECT_EQ(bar_stress(padded("")), 0.0);
    EXPECT_EQ(bar_stress(padded("-")), 0.0);
    EXPECT_EQ(bar_stress(padded("@")), 0.0);
}

TEST(MaterialName, RefusalNamesTheMaterialAndTheModels) {
    UmatPoint point("STEEL", uniaxial, steel);
    const Answer answer = point.nstatv(4).evaluate({.dstran = {1e-3}});
    EXPECT_EQ(answer.messages.stops, 1);
    EXPECT_NE(answer.first_error().find("'STEEL'"), std::string::npos) << answer.first_error();
    EXPECT_NE(answer.first_error().find("ISO_ELASTIC"), std::string::npos) << answer.first_error();
}

// The hosts' message routines read %I, %R and %S as formats and take 500 characters.
TEST(Messages, FitTheRoutinesOfTheHosts) {
    UmatPoint known("ISO_ELASTIC-50%I", uniaxial, {-1.0, 0.3});
    const std::string refusal = known.nstatv(4).evaluate({.dstran = {1e-3}}).first_error();
    EXPECT_NE(refusal.find("ISO_ELASTIC-50/I"), std::string::npos) << refusal;
    UmatPoint unknown("STEEL", uniaxial, steel);
    EXPECT_EQ(unknown.nstatv(4).evaluate({.dstran = {1e-3}}).first_error().size(), 500u);
}

TEST(EntryPoints, UpperCaseNamesAnswerTheSame) {
    const UmatPoint point("ISO_ELASTIC", solid, steel);
    UmatPoint upper = point;
    const Load load{.dstran = {1e-3, 2e-4, 0, 3e-4, 0, 1e-4}};
    EXPECT_TRUE(identical(upper.entry_point(&UMAT).evaluate(load).stress, point.evaluate(load).stress));
    VumatBlock a("ISO_ELASTIC", solid, steel);
    VumatPoint p = a.fresh_point();
    p.strain_increment = load.dstran;
    a.points.assign(9, p);
    VumatBlock b = a;
    EXPECT_EQ(a.run().stops + b.run_with(&VUMAT).stops, 0);
    EXPECT_TRUE(identical(a.points[8].stress, b.points[8].stress));
}

// A host may vary the constants from point to point without end.
TEST(MaterialCache, ManyMoreMaterialsThanItKeeps) {
    for (const int round : {0, 1})
        for (int i = 1; i <= 5000; ++i) {
            UmatPoint point("ISO_ELASTIC-FIELD", uniaxial, {1000.0 * i, 0.3});
            ASSERT_EQ(point.evaluate({.dstran = {0.5}}).stress[0], 500.0 * i) << "round " << round;
        }
}

// The name, the number of constants and each constant tell materials apart.
TEST(MaterialCache, MaterialsAreToldApart) {
    const auto stress = [](const std::string& name, Numbers props) {
        UmatPoint point(name, plane_strain, std::move(props));
        return point.evaluate({.dstran = {1e-3, 0, 0, 0}, .dtemp = 10.0}).stress[0];
    };
    const double plain = stress("ISO_ELASTIC-A", {1000.0, 0.0, 0.0, 0.0});
    EXPECT_DOUBLE_EQ(plain, 1.0);
    EXPECT_EQ(stress("ISO_ELASTIC-A", {1000.0, 0.0}), plain);
    // The second of four constants is not hashed first, middle or last.
    EXPECT_DOUBLE_EQ(stress("ISO_ELASTIC-A", {1000.0, 0.25, 0.0, 0.0}), 1.2);
    EXPECT_DOUBLE_EQ(stress("ISO_ELASTIC-A", {1000.0, 0.0, 1e-5, 0.0}), 0.9);
    EXPECT_EQ(stress("ISO_ELASTIC-B", {1000.0, 0.0, 0.0, 0.0}), plain);
}

TEST(MaterialCache, ARefusedMaterialIsRefusedAgain) {
    for (const int repeat : {0, 1, 2}) {
        UmatPoint point("ISO_ELASTIC-BAD", uniaxial, {-1.0, 0.3});
        EXPECT_EQ(point.nstatv(4).evaluate({}).messages.errors.size(), 1u) << repeat;
    }
}

TEST(TimeStep, IsLeftAloneWhenAllIsWell) {
    const UmatPoint point("ISO_ELASTIC", solid, steel);
    for (const double entry : {1.0, DBL_MAX, 0.5, -1.0}) {
        const Answer answer = point.evaluate({.dstran = {1e-3, 0, 0, 0, 0, 0}, .pnewdt = entry});
        EXPECT_EQ(answer.pnewdt, entry);
        EXPECT_NE(answer.stress[0], 0.0);
    }
}

TEST(TimeStep, RequestFollowsTheConvention) {
    const UmatPoint point("ISO_ELASTIC", solid, steel);
    const auto request = [&](double entry) {
        return point.evaluate({.dstran = {std::nan(""), 0, 0, 0, 0, 0}, .pnewdt = entry}).pnewdt;
    };
    EXPECT_EQ(request(1.0), 0.25);
    EXPECT_EQ(request(DBL_MAX), 0.25);
    EXPECT_EQ(request(-1.0), 0.25);
    EXPECT_EQ(request(0.1), 0.1) << "somebody else wants a smaller one";
}

// PNEWDT = -1 gives CalculiX away: stress and state stay in the unrotated frame, DROT means nothing and F is replaced
// by its right stretch (page 90: a stretch of 10 % followed by a quarter turn).
TEST(HostProfile, CalculixWorksInTheUnrotatedFrame) {
    const Matrix3d turn = Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    UmatPoint rate("ISO_ELASTIC", solid, steel);
    rate.stress({100.0, 0, 0, 0, 0, 0});
    EXPECT_EQ(rate.evaluate({.drot = turn, .pnewdt = -1.0}).stress[0], 100.0);
    EXPECT_NEAR(rate.evaluate({.drot = turn}).stress[1], 100.0, 1e-12) << "turned by the host";

    const UmatPoint total("ISO_ELASTIC", solid, {1000.0, 0.25, 0.0, 0.0, 1.0});
    Matrix3d stretch = Matrix3d::Identity();
    stretch(0, 0) = 1.1;
    const Numbers in_place = total.evaluate({.dfgrd1 = stretch}).stress;
    EXPECT_LE(distance(total.evaluate({.dfgrd1 = turn * stretch, .drot = turn, .pnewdt = -1.0}).stress, in_place),
              1e-12);
    EXPECT_NEAR(total.evaluate({.dfgrd1 = turn * stretch, .drot = turn}).stress[1], in_place[0], 1e-12);
}

// It leaves PREDEF, DPRED and CELENT uninitialised: nothing that stands there by chance counts, and a softening model
// is refused that has no length of its own.
TEST(HostProfile, CalculixHasNoFieldsAndNoElementLength) {
    LODE_NEEDS("ISO_PLASTIC");
    UmatPoint swelling("ISO_ELASTIC", solid, {1000.0, 0.25, 0.0, 0.01});
    swelling.fields({3.0});
    const Load load{.dstran = {1e-3, 0, 0, 0, 0, 0}, .dpred = {1.0}, .pnewdt = -1.0};
    EXPECT_NEAR(swelling.evaluate(load).stress[0], 1.2, 1e-12);
    swelling.fields({std::nan("")});
    EXPECT_NEAR(swelling.evaluate({.dstran = load.dstran, .pnewdt = -1.0}).stress[0], 1.2, 1e-12);

    // E, NU, SIGY, linear law, slope, floor; LREF is the 24th.
    Numbers softening{210000.0, 0.3, 250.0, 1.0, -500.0, 50.0};
    softening.resize(24, 0.0);
    softening[23] = 1.0;
    const UmatPoint bar("ISO_PLASTIC-SOFT", solid, softening);
    const Load yielding{.dstran = {1e-2, 0, 0, 0, 0, 0}, .pnewdt = -1.0};
    const Answer refused = bar.evaluate(yielding);  // CELENT is 1 by chance
    EXPECT_EQ(refused.messages.stops, 1);
    EXPECT_NE(refused.first_error().find("CELENT, which = 0"), std::string::npos) << refused.first_error();
    EXPECT_EQ(bar.evaluate({.dstran = yielding.dstran}).messages.stops, 0) << "any other host means it";
}

// The (3,1) layout of an explicit host is plane strain, unless the label says PS.
TEST(Vumat, LabelChoosesPlaneStress) {
    const auto stress = [](const std::string& name, AnalysisKind kind) {
        VumatBlock block(name, kind, steel);
        VumatPoint p = block.fresh_point();
        p.strain_increment = kind == plane_stress ? Numbers{1e-3, 0, 0} : Numbers{1e-3, 0, 0, 0};
        block.points = {p};
        EXPECT_EQ(block.run().stops, 0);
        return block.points.front();
    };
    const double e = 1e-3, plane = 200000.0 / (1.0 - 0.09) * e;
    const double constrained = 200000.0 * 0.7 / (1.3 * 0.4) * e;
    // VumatBlock asks for plane stress by the labels PS and PS-STEEL.
    for (const char* name : {"ISO_ELASTIC", "ISO_ELASTIC-STEEL", "iso_elastic-lower"}) {
        const VumatPoint p = stress(name, plane_stress);
        EXPECT_NEAR(p.stress[0], plane, 1e-11) << name;
        EXPECT_NEAR(p.thickness_strain_increment, -0.3 / 0.7 * e, 1e-17) << name;
    }
    for (const char* name : {"ISO_ELASTIC", "ISO_ELASTIC-PSX", "ISO_ELASTIC-STEEL-PS", "ISO_ELASTIC-PLATE"})
        EXPECT_NEAR(stress(name, plane_strain).stress[0], constrained, 1e-11) << name;
}

// In an implicit host the layout decides.
TEST(Umat, LabelPlaysNoPart) {
    const UmatPoint a("ISO_ELASTIC-PS", plane_strain, steel), b("ISO_ELASTIC", plane_strain, steel);
    EXPECT_TRUE(
        identical(a.evaluate({.dstran = {1e-3, 0, 0, 0}}).stress, b.evaluate({.dstran = {1e-3, 0, 0, 0}}).stress));
}

// VUMAT order is 11, 22, 33, 12, 23, 31 with tensor shears; written out without the help of VumatBlock.
TEST(Vumat, ComponentOrderAndShearFactor) {
    VumatBlock block("ISO_ELASTIC", solid, steel);
    VumatPoint p = block.fresh_point();
    p.strain_increment = {0, 0, 0, 0, 2e-3, 0};  // gamma13
    block.points = {p};
    ASSERT_EQ(block.run().stops, 0);
    EXPECT_TRUE(identical(block.points.front().stress, {0, 0, 0, 0, 2e-3 * 200000.0 / 2.6, 0}));
}

// A plane-stress block with two direct components is not what explicit hosts pass: refused, or served in its own
// layout, but never a column too many.
TEST(Vumat, TwoDirectComponents) {
    GuardedMemory<double> reals(1024);
    constexpr std::size_t points = 9;
    Numbers strain(3 * points, 0.0), ones(points, 1.0), zeros(4 * points, 0.0), stretch(3 * points, 0.0);
    std::fill_n(strain.begin(), points, 1e-3);
    double* const strain_inc = reals.output("strainInc", strain);
    double* const stress_new = reals.output("stressNew", 3 * points);
    double* const state_new = reals.output("stateNew", 4 * points);
    double* const intern = reals.output("enerInternNew", points);
    double* const inelas = reals.output("enerInelasNew", points);
    const double* const in = reals.input("zeros", zeros);
    const double* const stress_old = reals.input("stressOld", stretch);
    const double* const one = reals.input("ones", ones);
    const double* const props = reals.input("props", steel);
    const int nblock = points, ndir = 2, nshr = 1, nstatev = 4, nfield = 0, nprops = 2, lanneal = 0;
    const double time = 1.0;
    const std::string cmname = padded("ISO_ELASTIC");
    clear_captured_messages();
    vumat_(&nblock, &ndir, &nshr, &nstatev, &nfield, &nprops, &lanneal, &time, &time, &time, cmname.data(), in, one,
           props, one, strain_inc, in, in, in, in, in, stress_old, in, in, in, in, in, in, in, stress_new, state_new,
           intern, inelas, LODE_CMNAME_LENGTH);
    EXPECT_EQ(reals.damage(), "");
    if (captured_messages().stops > 0) {
        // Not by chance, because the guard zone is not a number.
        EXPECT_NE(captured_messages().errors.front().find("(2,1)"), std::string::npos)
            << captured_messages().errors.front();
        return;
    }
    for (std::size_t i = 0; i < points; ++i) EXPECT_NEAR(stress_new[i], 200000.0 / 0.91 * 1e-3, 1e-11);
}

TEST(Vumat, EmptyBlock) {
    VumatBlock block("ISO_ELASTIC", solid, steel);
    EXPECT_EQ(block.run().stops, 0);
}

TEST(Catalogue, ModelsAreDescribed) {
    ASSERT_GT(lode_model_count(), 0);
    EXPECT_EQ(lode_model_at(-1), nullptr);
    EXPECT_EQ(lode_model_at(lode_model_count()), nullptr);
    for (int i = 0; i < lode_model_count(); ++i) {
        const lode_model& m = *lode_model_at(i);
        SCOPED_TRACE(m.keyword);
        EXPECT_GT(m.sample_count, 0);
        EXPECT_GT(m.algorithm_count, 0);
        EXPECT_GE(m.parameter_count, m.required_count);
        EXPECT_NE(std::string(m.limits), "") << "where it fails";
        for (int p = 0; p < m.parameter_count; ++p) {
            EXPECT_LE(m.parameters[p].lower, m.parameters[p].upper) << m.parameters[p].symbol;
            if (m.parameters[p].flags >> LODE_REPEATED_SHIFT != 0) continue;
            EXPECT_EQ((m.parameters[p].flags & LODE_OPTIONAL) != 0, p >= m.required_count) << m.parameters[p].symbol;
        }
        for (int s = 0; s < m.sample_count; ++s) {
            EXPECT_GT(m.samples[s].strain_scale, 0.0);
            EXPECT_NE(m.samples[s].kinds & m.kinds, 0u);
            EXPECT_GE(m.samples[s].constant_count, m.required_count);
        }
    }
    EXPECT_NE(std::string(lode_version()), "");
    EXPECT_NE(std::string(lode_instruction_set()), "");
}

}  // namespace
}  // namespace lode::test
