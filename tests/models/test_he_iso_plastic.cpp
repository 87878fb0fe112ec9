// HE_ISO_PLASTIC: the verification cases and failure modes of page 55, section 1.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "finite_strain.hpp"
#include "vumat_block.hpp"

namespace lode::test::test_he_iso_plastic {
namespace {

constexpr AnalysisKind solid = AnalysisKind::solid, plane_strain = AnalysisKind::plane_strain,
                       plane_stress = AnalysisKind::plane_stress;
constexpr double printed = 1e-12;  // thirteen to fourteen digits of the largest component
const std::string name = "HE_ISO_PLASTIC-TEST";
const Numbers steel = {2e5, 0.3, 1, 400, 1000};

enum State { CPI11, CPI22, CPI33, CPI12, CPI13, CPI23, ALPHA, EPSRES, F33M1, PDISS };

Matrix3d general() {
    Matrix3d x;
    x << 1.08, .06, -.02, .03, .95, .05, -.04, .02, .99;
    return x;
}
Answer at(const Numbers& props, const Matrix3d& f, AnalysisKind kind = solid, double dtemp = 0.0) {
    return UmatPoint(name, kind, props).advance({.dtemp = dtemp, .dfgrd1 = f});
}
// Props with the optional entries from `index` on.
Numbers with(Numbers props, std::size_t index, const Numbers& more) {
    props.resize(std::max(props.size(), index - 1 + more.size()), 0.0);
    if (props.size() >= 19 && index > 19) props[18] = 1.0;  // CHI
    std::copy(more.begin(), more.end(), props.begin() + static_cast<std::ptrdiff_t>(index - 1));
    return props;
}
double det_inverse_plastic(const Numbers& state) {
    Matrix3d c;
    c << 1 + state[CPI11], state[CPI12], state[CPI13], state[CPI12], 1 + state[CPI22], state[CPI23], state[CPI13],
        state[CPI23], 1 + state[CPI33];
    return c.determinant();
}

// --- 1.7, the printed table --------------------------------------------------------------------------------------

TEST(HeIsoPlastic, UniaxialStrain) {
    expect_close({269.02800331355, 115.36112321832, 115.36112321832, 0, 0, 0},
                 at(steel, diagonal_gradient(1.001, 1, 1)).stress, printed);

    UmatPoint point(name, solid, steel);
    const Answer a = point.advance({.dfgrd1 = diagonal_gradient(1.05, 1, 1)});
    expect_close({8408.6802918167, 7998.0408064726, 7998.0408064726, 0, 0, 0}, a.stress, printed);
    EXPECT_NEAR(a.state[CPI11], -0.059477986035153, 1e-13);
    EXPECT_NEAR(a.state[CPI22], 0.03113497384004, 1e-13);
    EXPECT_NEAR(a.state[ALPHA], 0.031171459611215, 1e-13);
    EXPECT_NEAR(a.state[PDISS], 13.44024373878, printed * 13);
    EXPECT_NEAR(a.tangent(0, 0), 175434.51201354, printed * 2e5);
    EXPECT_NEAR(a.tangent(0, 1), 174782.74399323, printed * 2e5);
    EXPECT_NEAR(a.tangent(1, 0), 174782.74399323, printed * 2e5);
    EXPECT_NEAR(a.tangent(1, 1), 179114.86688479, printed * 2e5);
    EXPECT_NEAR(a.tangent(1, 2), 171102.38912198, printed * 2e5);
    EXPECT_NEAR(a.tangent(3, 3), 4211.558624077, printed * 2e5);
    EXPECT_NEAR(a.tangent(5, 5), 4006.238881405, printed * 2e5);

    const Answer unloaded = point.evaluate({.dfgrd1 = diagonal_gradient(1.045, 1, 1)});
    expect_close({7144.9712936122, 7435.2894728111, 7435.2894728111, 0, 0, 0}, unloaded.stress, printed);
    EXPECT_EQ(unloaded.state[ALPHA], a.state[ALPHA]);
    const Answer back = point.evaluate({.dfgrd1 = diagonal_gradient(1, 1, 1)});
    expect_close({-306.23932740393, 153.11966370196, 153.11966370196, 0, 0, 0}, back.stress, 1e-11);
    EXPECT_NEAR(back.state[ALPHA], 0.059358991105888, 1e-13);
}

TEST(HeIsoPlastic, SimpleShear) {
    const Answer a = at(steel, simple_shear(0.1));
    expect_close({17.509627586634, -8.7548137933168, -8.7548137933168, 262.6444137995, 0, 0}, a.stress, 1e-12);
    EXPECT_NEAR(a.state[CPI11], 0.0095475490429749, 1e-13);
    EXPECT_NEAR(a.state[CPI22], -0.00010991407830272, 1e-13);
    EXPECT_NEAR(a.state[CPI12], -0.096574631212776, 1e-13);
    EXPECT_NEAR(a.state[ALPHA], 0.055671027366515, 1e-13);
    EXPECT_NEAR(a.state[PDISS], 25.367674234649, printed * 25);
    EXPECT_NEAR(a.tangent(3, 3), 334.17976748067, 1e-12 * 2e5);
    EXPECT_NEAR(a.tangent(3, 0), -142.41230757209, 1e-12 * 2e5);
    EXPECT_NEAR(a.tangent(0, 3), -66.144968147122, 1e-12 * 2e5);

    UmatPoint point(name, solid, steel);
    for (int i = 1; i <= 10; ++i) point.advance({.dfgrd1 = simple_shear(0.02 * i)});
    expect_close({5.4315231760385, -2.7157615880193, -2.7157615880193, 296.27982306831, 0, 0}, point.stress(), 1e-12);
    EXPECT_NEAR(point.state()[ALPHA], 0.11323637723878, 1e-12);
}

TEST(HeIsoPlastic, PowerLaws) {
    const Answer nonlinear = at({2e5, 0.3, 2, 300, 50, 0.2}, general());
    expect_close({2185.4700570949, 1835.6262643855, 1936.413020546, 116.92321843293, -81.740440035694, 89.015074666702},
                 nonlinear.stress, printed);
    EXPECT_NEAR(nonlinear.state[ALPHA], 0.10364501304181, 1e-13);
    EXPECT_NEAR(nonlinear.state[PDISS], 44.760918224329, printed * 44);
    const Answer power = at({2e5, 0.3, 6, 300, 1.5, 0.4}, general());
    expect_close({2208.4512151978, 1818.3345670232, 1930.7235598055, 130.38303099671, -91.150128004484, 99.26219441265},
                 power.stress, printed);
    EXPECT_NEAR(power.state[ALPHA], 0.10343200913736, 1e-13);
}

TEST(HeIsoPlastic, JohnsonCook) {
    const Numbers copper = {124000, .34, 3, 90, 292, .31, .025, 1, 1.09, 1356, 0, 0, 0, 298};
    UmatPoint fast(name, solid, copper);
    const Answer a = fast.temperature(400).advance({.dtime = 1e-4, .dtemp = 98, .dfgrd1 = simple_shear(0.1)});
    expect_close({7.8111273296906, -3.9055636648453, -3.9055636648453, 117.16690994536, 0, 0}, a.stress, 1e-12);
    EXPECT_NEAR(a.state[ALPHA], 0.056179438467513, 1e-13);
    EXPECT_NEAR(a.state[PDISS], 11.419987226577, printed * 11);
    // slower than the floor of the rate
    UmatPoint slow(name, solid, copper);
    const Answer b = slow.temperature(298).advance({.dtime = 1e12, .dfgrd1 = simple_shear(0.1)});
    expect_close({4.0360635097473, -2.0180317548737, -2.0180317548737, 60.54095264621, 0, 0}, b.stress, 1e-12);
    EXPECT_NEAR(b.state[ALPHA], 0.056884854649802, 1e-13);
    // no time: rate zero, which is the floor as well
    UmatPoint at_once(name, solid, copper);
    const Answer c =
        at_once.temperature(298).advance({.dstran = {0, 0, 0, 0.1, 0, 0}, .dtime = 0.0, .dfgrd1 = simple_shear(0.1)});
    expect_close(b.stress, c.stress, 1e-13);
    // molten: no deviator
    UmatPoint molten(name, solid, copper);
    const Answer d = molten.temperature(1400).advance({.dfgrd1 = general()});
    EXPECT_NEAR(d.stress[0], d.stress[1], 1e-10);
    EXPECT_NEAR(d.stress[3], 0.0, 1e-10);
    EXPECT_GT(d.state[ALPHA], 0.1);
    EXPECT_EQ(d.state[PDISS], 0.0);
    EXPECT_TRUE(d.tangent.allFinite());
    EXPECT_NEAR(d.tangent(3, 3), 0.0, 1e-10);
}

TEST(HeIsoPlastic, PlaneStress) {
    Matrix3d f = diagonal_gradient(1.02, 0.995, 7.7);  // F33 is not read
    f(0, 1) = .01;
    const Answer a = at(steel, f, plane_stress);
    expect_close({447.20199782698, 112.64756033129, 65.949809867897}, a.stress, printed);
    EXPECT_NEAR(a.state[CPI33], 0.02599087929536, 1e-13);
    EXPECT_NEAR(a.state[ALPHA], 0.019218485557958, 1e-13);
    EXPECT_NEAR(a.state[F33M1], -0.013577371190092, 1e-13);
}

TEST(HeIsoPlastic, YieldOnCauchyOrKirchhoffStress) {
    const Numbers props = with({2e4, .35, 1, 300, 100}, 15, {1, 0, 0, 0, 1});
    const Matrix3d f = diagonal_gradient(.8, .85, .8);
    Numbers on_cauchy = props;
    on_cauchy[17] = 1;
    const Answer a = at(on_cauchy, f), b = at(props, f);
    expect_close({-10234.459469266, -9931.0810614673, -10234.459469266, 0, 0, 0}, a.stress, printed);
    EXPECT_NEAR(a.state[ALPHA], 0.033784077991039, 1e-13);
    expect_close({-10318.847845756, -9762.3043084889, -10318.847845756, 0, 0, 0}, b.stress, printed);
    EXPECT_NEAR(b.state[ALPHA], 0.027596842730839, 1e-13);
}

TEST(HeIsoPlastic, Heated) {
    const Answer a = at(with(steel, 16, {1.2e-5}), diagonal_gradient(1.01, 1, 1), solid, 500);
    expect_close({-1074.3441114987, -1475.2669641877, -1475.2669641877, 0, 0, 0}, a.stress, printed);
    EXPECT_NEAR(a.state[ALPHA], 0.0049320812158582, 1e-14);
    EXPECT_NEAR(a.state[EPSRES], 6e-3, 1e-17);
    UmatPoint wet(name, solid, with(steel, 17, {6e-3}));
    expect_close(a.stress, wet.advance({.dpred = {1.0}, .dfgrd1 = diagonal_gradient(1.01, 1, 1)}).stress, 1e-13);
}

// --- 1.3, what the step must do ----------------------------------------------------------------------------------

// The stress is on the yield surface, and Cp^-1 stays isochoric to rounding over a thousand increments.
TEST(HeIsoPlastic, PlasticFlowIsIsochoric) {
    for (const int steps : {20, 100, 1000}) {
        UmatPoint point(name, solid, steel);
        for (int i = 1; i <= steps; ++i) point.advance({.dfgrd1 = simple_shear(2.0 * i / steps)});
        EXPECT_NEAR(det_inverse_plastic(point.state()), 1.0, 2e-14) << steps;
        const Matrix3d s = stress_tensor(point.stress(), solid);
        const double q = std::sqrt(1.5) * (s - s.trace() / 3 * Matrix3d::Identity()).norm();
        EXPECT_NEAR(q, 400 + 1000 * point.state()[ALPHA], 1e-9);
    }
    UmatPoint point(name, solid, steel);
    point.advance({.dfgrd1 = general()});
    EXPECT_NEAR(det_inverse_plastic(point.state()), 1.0, 5e-15);
}

// The errors of the page's table, against many increments.
TEST(HeIsoPlastic, IsOfFirstOrder) {
    const auto shear = [](int steps) {
        UmatPoint point(name, solid, steel);
        for (int i = 1; i <= steps; ++i) point.advance({.dfgrd1 = simple_shear(2.0 * i / steps)});
        return point.stress();
    };
    const Numbers exact = shear(20000);
    const double size = std::sqrt(2) * exact[3];
    double previous = 0.0;
    for (const auto& [steps, error] : {std::pair{1, 0.75}, {4, 0.27}, {16, 0.071}, {64, 0.018}}) {
        const Matrix3d d = stress_tensor(shear(steps), solid) - stress_tensor(exact, solid);
        const double found = (d - d.trace() / 3 * Matrix3d::Identity()).norm() / size;
        EXPECT_NEAR(found, error, 0.02 * error + 0.005) << steps;
        if (steps == 64) {
            EXPECT_NEAR(previous / found, 4.0, 0.3);
        }
        previous = found;
    }
}

TEST(HeIsoPlastic, WithoutYieldingItIsMooneyRivlin) {
    LODE_NEEDS("MOONEY_RIVLIN");
    for (const double uj : {0.0, 1.0, 2.0})
        for (const AnalysisKind kind : {solid, plane_strain, plane_stress}) {
            Matrix3d f = general();
            if (kind != solid) f(0, 2) = f(1, 2) = f(2, 0) = f(2, 1) = 0;
            const double E = 10, nu = 0.3;
            const Numbers props = with({E, nu, -1, 0}, 15, {uj, 1e-3, 0, 0, 1});
            const Answer a = UmatPoint(name, kind, props).advance({.dtemp = 30.0, .dfgrd1 = f});
            UmatPoint other("MOONEY_RIVLIN-TEST", kind, {E / (2 * (1 + nu)), E / (3 * (1 - 2 * nu)), 0, uj, 1e-3});
            const Answer b = other.evaluate({.dtemp = 30.0, .dfgrd1 = f});
            ASSERT_TRUE(b.done());
            expect_close(b.stress, a.stress, 1e-13);
            EXPECT_LE((a.tangent - b.tangent).cwiseAbs().maxCoeff(), 1e-13 * b.tangent.cwiseAbs().maxCoeff());
            EXPECT_LE(distance(a.ddsddt, b.ddsddt), 1e-13 * largest(b.ddsddt));
            EXPECT_NEAR(a.sse, b.sse, 1e-13 * b.sse);
        }
}

TEST(HeIsoPlastic, TinyStrainsKeepFullRelativeAccuracy) {
    for (const double g : {1e-6, 1e-9, 1e-12}) {
        const Answer a = at(steel, simple_shear(g));
        const double G = 2e5 / 2.6;
        EXPECT_NEAR(a.stress[3], G * g, 1e-15 * G * g);
        EXPECT_NEAR(a.sse, 0.5 * G * g * g, 1e-12 * G * g * g);
    }
}

// ORI = 1: F turned into the axes that turn with the material, R^T F R, gives the stress in those axes.
TEST(HeIsoPlastic, LocalBasis) {
    Numbers local = with(steel, 20, {1});
    const Matrix3d q = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    const Eigen::SelfAdjointEigenSolver<Matrix3d> u(general().transpose() * general());
    const Matrix3d stretch = u.operatorSqrt();
    const Answer fixed = at(steel, stretch), turned = at(local, stretch * q);
    expect_close(fixed.stress, turned.stress, 1e-12);
    expect_close(fixed.state, turned.state, 1e-12);
}

TEST(HeIsoPlastic, PlaneStrainIsTheSolid) {
    Matrix3d f = general();
    f(0, 2) = f(1, 2) = f(2, 0) = f(2, 1) = 0;
    const Answer a = at(steel, f, plane_strain), b = at(steel, f);
    expect_close({b.stress[0], b.stress[1], b.stress[2], b.stress[3]}, a.stress, 1e-14);
    expect_close(b.state, a.state, 1e-14);
}

// --- 1.4, 1.5 ----------------------------------------------------------------------------------------------------

// (J+ sigma+ - J- sigma-)/(2 h J), and the derivatives of stress and heat by strain and temperature.
TEST(HeIsoPlastic, TangentAgainstCentralDifferences) {
    constexpr double h = 1e-6;
    const Numbers laws[] = {steel,
                            {2e5, .3, 2, 300, 50, .2},
                            {2e5, .3, 6, 300, 1.5, .4},
                            {2e5, .3, 3, 300, 292, .31, .025, 1, 1.09, 1356, .01, 1.5, 0, 200}};
    for (const AnalysisKind kind : {solid, plane_strain, plane_stress})
        for (const Numbers& law : laws)
            for (const double cauchy : {0.0, 1.0})
                for (const double uj : {0.0, 2.0}) {
                    Numbers props = with(law, 15, {uj, 1.2e-5, 0, cauchy, 0.7});
                    UmatPoint point(name, kind, props);
                    Matrix3d first = simple_shear(0.02), f = general();
                    if (kind != solid) f(0, 2) = f(1, 2) = f(2, 0) = f(2, 1) = 0;
                    point.temperature(500).advance({.dtemp = 20, .dfgrd1 = first});
                    const Load load{.dtime = 0.01, .dtemp = 10, .dfgrd1 = f};
                    const Answer a = point.advance(load);
                    ASSERT_GT(a.spd, 1.0);
                    UmatPoint start(name, kind, props);
                    start.temperature(500).advance({.dtemp = 20, .dfgrd1 = first});
                    const auto volume = [&](const Matrix3d& g, const Answer& x) {
                        return kind == plane_stress ? g.topLeftCorner<2, 2>().determinant() * (1 + x.state[F33M1])
                                                    : g.determinant();
                    };
                    const double J = volume(f, a);
                    for (int k = 0; k < start.size(); ++k) {
                        Numbers unit(static_cast<std::size_t>(start.size()), 0.0);
                        unit[static_cast<std::size_t>(k)] = 1.0;
                        const Matrix3d d = strain_tensor(unit, kind);
                        Load ahead = load, back = load;
                        ahead.dfgrd1 = (Matrix3d::Identity() + h * d) * f;
                        back.dfgrd1 = (Matrix3d::Identity() - h * d) * f;
                        const Answer up = start.evaluate(ahead), down = start.evaluate(back);
                        for (int i = 0; i < start.size(); ++i) {
                            const auto row = static_cast<std::size_t>(i);
                            const double slope = (volume(*ahead.dfgrd1, up) * up.stress[row] -
                                                  volume(*back.dfgrd1, down) * down.stress[row]) /
                                                 (2 * h * J);
                            EXPECT_NEAR(a.tangent(i, k), slope, 1e-8 * a.tangent.cwiseAbs().maxCoeff());
                        }
                        EXPECT_NEAR(a.drplde[static_cast<std::size_t>(k)], (up.rpl - down.rpl) / (2 * h),
                                    1e-6 * largest(a.drplde));
                    }
                    Load hot = load, cold = load;
                    hot.dtemp += 0.1;
                    cold.dtemp -= 0.1;
                    const Answer up = start.evaluate(hot), down = start.evaluate(cold);
                    for (std::size_t i = 0; i < a.stress.size(); ++i)
                        EXPECT_NEAR(a.ddsddt[i], (up.stress[i] - down.stress[i]) / 0.2, 1e-6 * largest(a.ddsddt));
                    EXPECT_NEAR(a.drpldt, (up.rpl - down.rpl) / 0.2, 1e-6 * std::abs(a.drpldt) + 1e-6);
                    EXPECT_NEAR(a.rpl, 0.7 * (a.state[PDISS] - start.state()[PDISS]) / (J * 0.01), 1e-9 * a.rpl);
                }
}

// Work = stored + dissipated, of first order; the explicit host gets both in one.
TEST(HeIsoPlastic, EnergyBalance) {
    double errors[3];
    for (int k = 0; k < 3; ++k) {
        const int steps = 64 << (2 * k);
        VumatBlock block(name, solid, steel);
        block.points.push_back(block.fresh_point());
        double work = 0.0, old_stress = 0.0;
        for (int i = 1; i <= steps; ++i) {
            const double t = static_cast<double>(i) / steps, before = static_cast<double>(i - 1) / steps;
            const auto volume = [](double s) { return 1.0 + 0.05 * std::sin(4.0 * s); };
            VumatPoint& p = block.points.front();
            p.stretch = diagonal_gradient(volume(t), 1, 1);
            p.density = 2.0 / volume(t);
            ASSERT_EQ(block.run().stops, 0);
            work += 0.5 * (old_stress + p.stress[0]) * (volume(t) - volume(before));
            old_stress = p.stress[0];
        }
        const VumatPoint& end = block.points.front();
        // PDISS is the work of the flow rule, which takes elastic shear strains as small
        EXPECT_NEAR(2.0 * end.inelastic_energy, end.state[PDISS], 400.0 / 77000 * end.state[PDISS]);
        EXPECT_GT(end.state[PDISS], 10.0);
        errors[k] = std::abs(work - 2.0 * end.internal_energy) / end.state[PDISS];
    }
    EXPECT_GE(errors[0] / errors[1], 3.5);
    EXPECT_GE(errors[1] / errors[2], 3.5);
    EXPECT_LE(errors[2], 2e-4);
}

// --- 1.6 ---------------------------------------------------------------------------------------------------------

TEST(HeIsoPlastic, ImpossibleDeformationsAskForASmallerIncrement) {
    UmatPoint point(name, solid, steel);
    point.advance({.dfgrd1 = general()});
    for (const double x : {0.0, -0.5, std::numeric_limits<double>::infinity(), std::nan("")}) {
        const Answer a = point.evaluate({.dfgrd1 = diagonal_gradient(x, 1, 1)});
        EXPECT_TRUE(a.cut);
        EXPECT_EQ(a.pnewdt, 0.25);
        EXPECT_TRUE(identical(a.stress, point.stress()));
        EXPECT_TRUE(identical(a.state, point.state()));
    }
    UmatPoint sheet(name, plane_stress, steel);
    EXPECT_TRUE(sheet.evaluate({.dfgrd1 = diagonal_gradient(-1, 1, 1)}).cut);
    VumatBlock block(name, solid, steel);
    block.points.assign(9, block.fresh_point());
    block.points[8].stretch = diagonal_gradient(-1, 1, 1);
    EXPECT_EQ(block.run().stops, 1);
}

// Finite stresses are not enough: the tangent squares them.
TEST(HeIsoPlastic, ExtremeStretchesGiveAFiniteTangentOrAskForLess) {
    for (const auto kind : {solid, plane_strain, plane_stress})
        for (double strain = -600.0; strain <= 300.0; strain += 20.0) {
            UmatPoint point(name, kind, steel);
            const Answer a = point.evaluate({.dfgrd1 = diagonal_gradient(std::exp(strain), 1, 1)});
            if (a.cut) continue;
            EXPECT_TRUE(a.tangent.allFinite()) << kind_name(kind) << " ln F11 = " << strain;
        }
}

TEST(HeIsoPlastic, RefusesBadConstants) {
    expect_refused(name, {0, .3, 1, 400}, {name, "PROPS(1)"});
    expect_refused(name, {2e5, .5, 1, 400}, {"PROPS(2)"});
    for (const double law : {4.0, 5.0, 7.0, 8.0}) expect_refused(name, {2e5, .3, law, 400}, {"PROPS(3)", "HLAW"});
    expect_refused(name, {2e5, .3, 4, 400}, {"PROPS(3)", "-1, 0, 1, 2, 3, 6"});
    expect_refused(name, {2e5, .3, 0, 0}, {"PROPS(4)", "SY", "> 0"});
    EXPECT_EQ(refusal(name, {2e5, .3, -1, 0}), "");
    EXPECT_EQ(refusal(name, {2e5, .3, 1, 400}), "") << "H1 = 0 by default";
    expect_refused(name, {2e5, .3, 1, 400, -1}, {"PROPS(5)", "softening"});
    expect_refused(name, {2e5, .3, 2, 400, -1, .5}, {"PROPS(5)", "softening"});
    expect_refused(name, {2e5, .3, 2, 400, 1, -.5}, {"PROPS(6)", "softening"});
    expect_refused(name, {2e5, .3, 6, 400, -1, .5}, {"PROPS(5)", "softening"});
    expect_refused(name, {2e5, .3, 6, 400, 1, 0}, {"PROPS(6)", "> 0"});
    expect_refused(name, {2e5, .3, 3, 400, -1, .3}, {"PROPS(5)"});
    expect_refused(name, {2e5, .3, 3, 400, 1, 0}, {"PROPS(6)"});
    expect_refused(name, {2e5, .3, 3, 400, 1, .3, -1, 1}, {"PROPS(7)"});
    expect_refused(name, {2e5, .3, 3, 400, 1, .3, .1, 0}, {"PROPS(8)"});
    expect_refused(name, {2e5, .3, 3, 400, 1, .3, .1, 1, 1, 1000, 0, 0, 1e-6}, {"PROPS(13)", "exp(-1/C)"});
    EXPECT_EQ(refusal(name, {2e5, .3, 3, 400, 1, .3}), "") << "nothing depends on the rate";
    expect_refused(name, with(steel, 15, {3}), {"PROPS(15)", "UJ"});
    expect_refused(name, with(steel, 18, {2}), {"PROPS(18)", "YCAU"});
    expect_refused(name, with(steel, 19, {1.5}), {"PROPS(19)", "CHI"});
    expect_refused(name, with(steel, 20, {2}), {"PROPS(20)", "ORI"});
    for (const AnalysisKind kind : {AnalysisKind::uniaxial, AnalysisKind::cohesive_3d})
        expect_refused(name, steel, {name, "not served"}, kind);
}

// Increments of any size return to the surface, with infinite slopes at alpha = 0 too.
TEST(HeIsoPlastic, LargeIncrements) {
    for (const Numbers& props : {steel, Numbers{2e5, .3, 6, 300, 1.5, .2}, Numbers{2e5, .3, 2, 300, 50, .2},
                                 Numbers{2e5, .3, 3, 300, 292, .31, .025, 1, 1.09}})
        for (const double g : {1e-5, 0.004, 0.5, 5.0, 50.0}) {
            const Answer a = at(props, simple_shear(g));
            EXPECT_TRUE(a.tangent.allFinite());
            EXPECT_NEAR(det_inverse_plastic(a.state), 1.0, 1e-13 * std::max(1.0, g * g * g * g));
        }
}

}  // namespace
}  // namespace lode::test::test_he_iso_plastic
