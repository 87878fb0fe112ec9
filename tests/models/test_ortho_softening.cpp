// ORTHO_SOFTENING against the verification cases of page 30, section 9.3 (to the digits printed there), its refusals,
// the energy that a complete failure takes in each direction, and its reduction to ISO_SOFTENING.
#include <Eigen/Geometry>

#include "lode/damage/ortho_softening.hpp"
#include "softening_support.hpp"

namespace lode::test::test_ortho_softening {
namespace {

using namespace softening;
using enum AnalysisKind;

Numbers laminate(int law_I, int law_II, const Numbers& rest = {}) {
    Numbers props = {
        30000, 8000, 8000, 0.3, 0.3, 0.4, 3500, 3500, 2500,          500,           60, 60, 30, 2, 2, 40, 50, 45, 0.3,
        0.8,   0.9,  40,   50,  45,  0.3, 0.8,  0.9,  double(law_I), double(law_II)};
    props.insert(props.end(), rest.begin(), rest.end());
    return props;
}
UmatPoint made(AnalysisKind kind, const Numbers& props, double celent = 0.1) {
    return UmatPoint("ORTHO_SOFTENING-TEST", kind, props).celent(celent);
}
const std::vector<Numbers> path = {
    {2e-4, 4.5e-3, -1e-3, 1e-3, 5e-4, 1e-3}, {1e-4, 8e-3, 0, 1.5e-2, 1e-2, 1.2e-2}, {0, 2e-2, 0, -2e-2, 0, 2e-2}};

TEST(OrthoSoftening, O1_Cuboid) {
    UmatPoint point = made(solid, laminate(1, 1));
    const std::vector<Answer> a = follow(point, path);
    EXPECT_EQ(entries(a[0], AXIS_N, 6), (Numbers{0, 1, 0, 1, 0, 0}));
    expect_printed(a[0].stress, {20.8789358478, 39.9472413987, 9.64921142729, 3.5, 1.75, 2.5});
    expect_printed(a[1].stress, {23.0047145984, 37.744289162, 8.93809283269, 49.7196261682, 36.75, 32.5});
    expect_printed(a[2].stress, {20.6474153898, 32.2663748106, 6.55834315541, -12.4299065421, 36.75, 43.2329842932},
                   200.0);
    expect_printed(entries(a[2], D, 3), {0.90080415611, 0.11214953271, 0.475963826749});
    expect_printed(entries(a[2], DELTA, 3), {0.0290010944603, 1.79439252336e-3, 0.0157068062827});
    expect_printed(entries(a[2], W, 3), {0.580021889207, 0.0448598130841, 0.353403141361});
    EXPECT_EQ(entries(a[2], A1, 6), (Numbers{1, 0, 0, 0, 1, 0}));
    expect_same_in_vumat(made(solid, laminate(1, 1)), path);
}

TEST(OrthoSoftening, O2_Cylinder) {
    UmatPoint point = made(solid, laminate(1, 2, {1}));
    const std::vector<Answer> a = follow(point, path);
    expect_printed(a[1].stress, {23.0047145984, 37.744289162, 8.93809283269, 40.6712553793, 36.75, 23.6038535683});
    expect_printed(a[2].stress, {20.6474153898, 32.2663748106, 6.55834315541, -6.93950167314, 36.75, 40.8934920024},
                   200.0);
    expect_printed(entries(a[2], D, 3), {0.90080415611, 0.504321309062, 0.504321309062});
    expect_printed(entries(a[2], DELTA, 3), {0.0290010944603, 0.0133696275229, 0.0168353473931});
    expect_printed(entries(a[2], W, 3), {0.580021889207, 0.105760952979, 0.258473753064});
    expect_same_in_vumat(made(solid, laminate(1, 2, {1})), path);
}

TEST(OrthoSoftening, O3_Ovoid) {
    UmatPoint point = made(solid, laminate(1, 1, {2}));
    const std::vector<Answer> a = follow(point, path);
    expect_printed(a[0].stress, {20.8149577572, 39.7985685023, 9.58462402151, 3.32080355643, 1.75, 2.37200254031});
    expect_printed(a[1].stress, {21.4350214564, 34.096621289, 7.35345023213, 15.49731831, 36.75, 8.99397937632}, 100.0);
    expect_printed(a[2].stress, {20.0772207226, 30.9413510125, 5.98271806282, -1.33171291163, 36.75, 7.84759394356},
                   200.0);
    expect_printed(entries(a[1], D, 3), {0.723262173036, 0.723262173036, 0.723262173036});
    expect_printed(entries(a[1], DELTA, 3), {9.67932206816e-3, 0.0334350707202, 0.0420930045429});
    expect_printed(entries(a[1], W, 3), {0.176809244071, 0.0508090186038, 0.0244362732874});
    expect_printed(entries(a[2], D, 3), {0.904877649169, 0.904877649169, 0.904877649169});
    expect_printed(entries(a[2], DELTA, 3), {0.0301031033442, 0.0953877656462, 0.119902653559});
    expect_printed(entries(a[2], W, 3), {0.537666952612, 0.144691829681, 0.122404440763});
    expect_same_in_vumat(made(solid, laminate(1, 1, {2})), path);
}

Numbers ply(const Numbers& rest) {
    Numbers props = laminate(1, 1, rest);
    props[8] = 8000 / 2.8;
    return props;
}
TEST(OrthoSoftening, O4_TransverselyIsotropic) {
    std::vector<Numbers> turned = path;
    turned[0][5] = 4e-3;
    UmatPoint point = made(solid, ply({0, 1}));
    const std::vector<Answer> a = follow(point, {turned[0], turned[1]});
    expect_printed(a[0].stress, {19.2363168197, 36.4446805842, 7.67637548154, 3.5, 1.75, 10.4612018555});
    expect_printed(entries(a[0], AXIS_N, 6), {0, 0.950982671846, 0.309244171891, 0, -0.309244171891, 0.950982671846});
    expect_printed(entry(a[0], D), 0.127370489025);
    expect_printed(a[1].stress,
                   {14.3811866885, 23.4112539128, -5.47396495097, 41.447189235, 32.017661497, 28.1660536128}, 100.0);
    expect_printed(entries(a[1], D, 3), {0.739241351689, 0, 0.236814878877});
    expect_printed(entry(a[1], DELTA + 2), 4.37226256161e-3);
    expect_same_in_vumat(made(solid, ply({0, 1})), {turned[0], turned[1]});
}

TEST(OrthoSoftening, O5_PlaneStress) {
    const std::vector<Numbers> flat = {{1e-4, 4.9e-3, 1e-3}, {1e-4, 8e-3, 1.5e-2}};
    UmatPoint point = made(plane_stress, laminate(3, 3));
    const std::vector<Answer> a = follow(point, flat);
    expect_printed(a[0].stress, {14.9999960006, 39.9999866688, 3.5});
    expect_printed(entry(a[0], EZZ), -2.14999929344e-3);
    expect_printed(a[1].stress, {17.8982785658, 39.6609285526, 49.9957043944});
    expect_printed(entries(a[1], D, 2), {0.626648666403, 0.107219564386});
    expect_printed(entry(a[1], EZZ), -2.16202921329e-3);
    expect_same_in_vumat(made(plane_stress, laminate(3, 3)), flat);
}

// Isotropic constants: on a path whose first principal direction is a material axis the two models agree.
TEST(OrthoSoftening, IsIsotropicWithIsotropicConstants) {
    const std::vector<Numbers> steps = {
        {3e-4, 0, -1e-5, 0, 0, 0},       {1e-4, 2e-5, 0, 9e-4, 6e-4, 5e-5}, {5e-4, -4e-5, 3e-5, -1.5e-3, 3e-4, 0},
        {-2e-3, 0, 0, 1e-3, 1e-3, 1e-4}, {2e-2, 0, 0, 1e-2, 1e-2, 1e-4},    {-4e-2, 1e-4, 0, 1e-2, -1e-2, 1e-4}};
    for (const int law : {1, 2, 3})
        for (const int surface : {0, 1, 2, 3, 4}) {
            SCOPED_TRACE("law " + std::to_string(law) + ", surface " + std::to_string(surface));
            const double G = 8000;
            const Numbers isotropic = {20000, 0.25, 5, 6, double(law), 0.1, double(law), 0.3, double(surface),
                                       1.2,   0.9,  0, 0, 0,           0,   0.01,        0.4};
            Numbers ortho = {20000, 20000, 20000, 0.25, 0.25, 0.25, G, G, G};
            for (int i = 0; i < 3; ++i) ortho.insert(ortho.end(), {5, 6, 6, 0.1, 0.3, 0.3});
            ortho.insert(ortho.end(), {double(law), double(law), double(surface), 0, 1.2, 0.9, 0, 0, 0, 0, 0.01, 0.4});
            UmatPoint a = UmatPoint("ISO_SOFTENING-TEST", solid, isotropic).celent(4.0), b = made(solid, ortho, 4.0);
            for (const Numbers& d : steps) {
                const Answer x = a.advance({.dstran = d}), y = b.advance({.dstran = d});
                const double scale = 24000 * 0.04;
                EXPECT_LE(distance(x.stress, y.stress), 1e-13 * scale);
                EXPECT_NEAR(x.spd, y.spd, 1e-12);
                EXPECT_NEAR(x.sse, y.sse, 1e-12);
                EXPECT_NEAR(entry(x, D), entry(y, D), 1e-12);
                // A crack of ISO_SOFTENING turns while it forms.
                if (entry(x, STATE) > 0.0 && &d != &steps[0]) {
                    EXPECT_LE((x.tangent - y.tangent).cwiseAbs().maxCoeff(), 1e-8 * 24000);
                }
            }
        }
}

// A complete failure of each direction of each family dissipates its toughness times area.
TEST(OrthoSoftening, FailureTakesTheToughness) {
    const Numbers constants = laminate(1, 1);
    for (const int surface : {0, 1, 2, 3, 4})
        for (const int law : {1, 3, 4})
            for (int family = 0; family < 3; ++family)
                for (int direction = 0; direction < 3; ++direction) {
                    SCOPED_TRACE("surface " + std::to_string(surface) + ", law " + std::to_string(law) + ", family " +
                                 std::to_string(family + 1) + ", direction " + std::to_string(direction));
                    UmatPoint point = made(solid, laminate(law, law, {double(surface), 0, 0, 0}), 0.05);
                    Numbers state(32, 0.0);
                    state[STATE - 1] = 1, state[H - 1] = 0.05;
                    const int other = family == 0 ? 1 : 0, last = 3 - family - other;
                    state[std::size_t(AXIS_N - 1 + family)] = 1, state[std::size_t(AXIS_T - 1 + other)] = 1;
                    point.state(state);
                    const int j = direction == 1 ? other : last;
                    const std::size_t component = direction == 0 ? std::size_t(family) : std::size_t(family + j + 2);
                    double work = 0.0;
                    for (int i = 0; i < 1500 && point.state(STATE) < 2.0; ++i) {
                        Numbers d(6, 0.0);
                        d[component] = 2e-3;
                        const double before = point.stress()[component];
                        point.advance({.dstran = d});
                        work += 0.5 * (before + point.stress()[component]) * 2e-3;
                    }
                    EXPECT_EQ(point.state(STATE), 2.0);
                    const double G = constants[std::size_t(12 + 6 * family + direction)];
                    EXPECT_NEAR(point.state(W + direction) * 0.05, G, 1e-12 * G);
                    EXPECT_NEAR(point.spd() * 0.05, G, 1e-12 * G);
                    EXPECT_NEAR(work * 0.05, G, 0.02 * G);
                }
}

// Material axes other than the frame's: everything turns with them.
TEST(OrthoSoftening, TurnedMaterialAxes) {
    const Matrix3d q = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
    for (const bool transverse : {false, true}) {
        UmatPoint plain = made(solid, transverse ? ply({1, 1}) : laminate(1, 2, {2})), turned = plain;
        Numbers state(32, 0.0);
        for (int i = 0; i < 3; ++i) state[std::size_t(A1 - 1 + i)] = q(i, 0), state[std::size_t(A2 - 1 + i)] = q(i, 1);
        turned.state(state);
        for (const Numbers& d : path) {
            const Answer a = plain.advance({.dstran = d});
            const Answer b = turned.advance({.dstran = rotated_strain(d, solid, q)});
            EXPECT_LE(distance(rotated_stress(a.stress, solid, q), b.stress), 1e-11);
            EXPECT_NEAR(a.spd, b.spd, 1e-13);
            const Eigen::Vector3d n(a.state[1], a.state[2], a.state[3]), m(b.state[1], b.state[2], b.state[3]);
            EXPECT_LE((q * n - m).norm(), 1e-14);
        }
    }
}

void expect_refused(const UmatPoint& point, const std::vector<std::string>& words) {
    const Answer a = point.evaluate({});
    EXPECT_EQ(a.messages.stops, 1);
    for (const std::string& word : words)
        EXPECT_NE(a.first_error().find(word), std::string::npos) << "no '" << word << "' in: " << a.first_error();
}
void expect_refused(const Numbers& props, const std::vector<std::string>& words) {
    char error[512] = "";
    EXPECT_EQ(lode_required_state("ORTHO_SOFTENING-X", props.data(), int(props.size()), 3, 3, error, sizeof error), -1);
    for (const std::string& word : words)
        EXPECT_NE(std::string(error).find(word), std::string::npos) << "no '" << word << "' in: " << error;
}
Numbers with(Numbers props, int index, double value) {
    props[std::size_t(index) - 1] = value;
    return props;
}

TEST(OrthoSoftening, RefusesConstants) {
    expect_refused(with(laminate(1, 1), 4, 2.0), {"PROPS(4) = 2", "NU12"});
    expect_refused(with(laminate(1, 1), 6, 0.99), {"positive definite"});
    expect_refused(laminate(4, 1, {0, 0, 1, 1, -1}), {"PROPS(34) = -1", "A1_I"});
    expect_refused(laminate(1, 1, {0, 1}), {"G23", "TIAXIS = 1"});
    expect_refused(with(ply({0, 1}), 3, 8001.0), {"E3", "TIAXIS = 1"});
    expect_refused(with(ply({0, 1}), 5, 0.301), {"NU13", "TIAXIS = 1"});
    expect_refused(with(ply({0, 1}), 8, 3501.0), {"G13", "TIAXIS = 1"});
    for (const double surface : {2.0, 3.0, 4.0}) {
        expect_refused(with(laminate(1, 1, {surface}), 10, 0.0), {"PROPS(10) = 0", "S1", "SURF 2, 3, 4"});
        expect_refused(with(laminate(1, 1, {surface}), 17, 0.0), {"PROPS(17) = 0", "T21"});
        // What the plane kinds do not use is asked for in 3D.
        const Numbers flat = with(laminate(1, 1, {surface}), 22, 0.0);
        EXPECT_TRUE(made(plane_strain, flat).evaluate({}).done());
        expect_refused(made(solid, flat), {"SURF 2, 3, 4", "> 0"});
    }
    // Family b2 is not read.
    EXPECT_TRUE(made(solid, with(ply({2, 1}), 22, 0.0)).evaluate({}).done());
}

TEST(OrthoSoftening, ElementSizeLimit) {
    // Normal to 2: 2 * 0.3 C22/40^2.
    const OrthotropicModuli m = OrthotropicModuli::from_constants({30000, 8000, 8000, 0.3, 0.3, 0.4, 3500, 3500, 2500});
    const double limit = std::min({2 * 0.3 * m.stiffness(1, 1) / 1600, 2 * 30 * m.stiffness(0, 0) / 250000,
                                   2 * 0.8 * 3500.0 / 2500, 2 * 0.9 * 2500.0 / 2025, 2 * 2 * 3500.0 / 3600});
    EXPECT_TRUE(made(solid, laminate(1, 1), 0.9999 * limit).evaluate({}).done());
    expect_refused(made(solid, laminate(1, 1), 1.0001 * limit), {"would snap back", "below"});
    EXPECT_TRUE(made(solid, laminate(1, 1, {0, 0, 1, 1, 0, 0, 0, 0, 0.01, 0, 0, 0, 0, 0, 0, 0, 0, 1}), 10 * limit)
                    .advance({.dstran = {0, 1e-2, 0, 0, 0, 0}})
                    .done());
    for (const double h : {0.0, -1.0, std::nan("")}) expect_refused(made(solid, laminate(1, 1), h), {"CELENT", "> 0"});
}

TEST(OrthoSoftening, ThermalCracking) {
    // Clamped and cooled: the stress of C alpha dT, until the plane normal to axis 2 cracks.
    UmatPoint point = made(solid, laminate(1, 1, {0, 0, 1, 1, 0, 0, 0, 0, 0.01, 0, 1e-6, 3e-5, 2e-5}));
    const Answer a = point.advance({.dtemp = -50.0});
    const OrthotropicModuli m = OrthotropicModuli::from_constants({30000, 8000, 8000, 0.3, 0.3, 0.4, 3500, 3500, 2500});
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(a.stress[std::size_t(i)],
                    50.0 * (m.stiffness(i, 0) * 1e-6 + m.stiffness(i, 1) * 3e-5 + m.stiffness(i, 2) * 2e-5), 1e-12);
    const Answer b = point.advance({.dtemp = -150.0});
    EXPECT_EQ(entry(b, STATE), 1.0);
    EXPECT_EQ(entries(b, AXIS_N, 3), (Numbers{0, 1, 0}));
    EXPECT_LT(b.stress[1], 40.0);
}

}  // namespace
}  // namespace lode::test::test_ortho_softening
