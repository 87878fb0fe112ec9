// Manufactured motions: the closed forms against tabulated numbers, the models against both through umat_ and vumat_,
// and what `lode replay --verify` says.
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <numbers>

#include "support.hpp"
#include "verify/elastic_laws.hpp"
#include "verify/verification.hpp"

namespace lode::host::test {
namespace {

constexpr double printed = 6e-12;  // twelve significant digits
constexpr double pi = std::numbers::pi;
using Constants = std::vector<double>;

ManufacturedMotion tension(double stretch, double residual = 1) {
    ManufacturedMotion m;
    m.stretch = stretch;
    m.residual_stretch = residual;
    m.location = "deck";
    return m;
}
ManufacturedMotion shear(double amount, double residual = 1) {
    ManufacturedMotion m = tension(1, residual);
    m.motion = Motion::linear_shear;
    m.shear = amount;
    return m;
}
ManufacturedMotion as(Motion motion, ManufacturedMotion m) {
    m.motion = motion;
    return m;
}
ManufacturedMotion by_strain(ManufacturedMotion m) {
    m.drive = Drive::strain;
    return m;
}
ManufacturedMotion oscillating(Motion motion, ManufacturedMotion m) {
    m = as(motion, m);
    m.angular_frequency = 2 * pi;
    return m;
}

std::shared_ptr<const ManufacturedSolution> solution(const std::string& material, const Constants& constants,
                                                     const ManufacturedMotion& motion, Entry entry = Entry::umat) {
    return manufactured_solution(material, constants, motion, Kind::solid, entry);
}

// Components 11, 22, 33, 12 of the model under test at the given times, reached with a whole number of increments.
std::vector<Components> driven(const std::string& material, const Constants& constants,
                               const ManufacturedMotion& motion, int increments, Entry entry, Kind kind = Kind::solid) {
    Scenario scenario;
    scenario.material.name = material;
    scenario.material.constants = constants;
    scenario.analysis.entry = entry;
    scenario.analysis.kind = kind;
    Step step;
    step.time = motion.duration;
    step.increments = FixedIncrements{increments};
    step.manufactured = motion;
    if (motion.cause == ResidualCause::field) scenario.analysis.fields = {0.0};
    scenario.steps.push_back(step);
    const History history = run_scenario(scenario, LODE_TEST_LIBRARY);
    EXPECT_EQ(history.outcome.status, Status::success) << history.outcome.message;
    std::vector<Components> stress;
    for (const Snapshot& s : history.records)
        if (s.increment > 0) stress.push_back(s.point.stress);
    return stress;
}

struct Row {
    std::string material;
    Constants constants;
    // At the times of the table: components 11, 22, 33, 12.
    std::vector<std::array<double, 4>> stress;
};
Row normal(const std::string& material, const Constants& constants, const std::vector<std::array<double, 2>>& values) {
    Row row{material, constants, {}};
    for (const auto& [s11, s22] : values) row.stress.push_back({s11, s22, s22, 0});
    return row;
}

// Closed form and model at `increments[i]` of `count` equal increments.
void expect_table(const std::vector<Row>& rows, const ManufacturedMotion& motion, const std::vector<int>& at,
                  int count) {
    for (const Row& row : rows) {
        SCOPED_TRACE(row.material + " " + std::string(motion.name()));
        const auto exact = solution(row.material, row.constants, motion);
        ASSERT_EQ(row.stress.size(), at.size());
        const auto check = [&](std::size_t i, double s11, double s22, double s33, double s12) {
            const auto& wanted = row.stress[i];
            double scale = 0;
            for (const double w : wanted) scale = std::max(scale, std::abs(w));
            EXPECT_NEAR(s11, wanted[0], printed * scale) << at[i];
            EXPECT_NEAR(s22, wanted[1], printed * scale) << at[i];
            EXPECT_NEAR(s33, wanted[2], printed * scale) << at[i];
            EXPECT_NEAR(s12, wanted[3], printed * scale) << at[i];
        };
        for (std::size_t i = 0; i < at.size(); ++i) {
            const Matrix3 s = exact->stress(motion.duration * at[i] / count);
            check(i, s(0, 0), s(1, 1), s(2, 2), s(0, 1));
        }
        if (exact->order() > 0) continue;
        for (const Entry entry : {Entry::umat, Entry::vumat}) {
            const auto stress = driven(row.material, row.constants, motion, count, entry);
            ASSERT_EQ(stress.size(), static_cast<std::size_t>(count));
            for (std::size_t i = 0; i < at.size(); ++i) {
                const Components& s = stress[static_cast<std::size_t>(at[i]) - 1];
                check(i, s[0], s[1], s[2], s[3]);
            }
        }
    }
}

const Constants low_strain{1000, 0.25, 1e-3, 0, 1}, logarithmic{1000, 0.25, 1e-3}, neo{1000, 0.25, 0, 1e-3},
    corotated{1000, 0.25, 1, 1e-3}, snow{1000, 0.25, 0.6, 1.5, 10, 0, 1, 1e-3};
const Constants rubber1{200, 1000, 0, 0, 1e-3}, rubber2{200, 1000, 100, 0, 1e-3},
    visco_rubber2{200, 1000, 100, 0, 1e-3};

// --- the tables --------------------------------------------------------------------------------------------------

TEST(Manufactured, TemperatureOfALinearFreeExpansion) {
    const auto s = solution("NEO_HOOKEAN-A", neo, tension(1.5, 1.05));
    const double wanted[] = {12.4225199986, 24.6926125904, 36.8139731227, 48.7901641694};
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(s->residual_change(0.25 * (i + 1)), wanted[i], printed * wanted[i]);
}

TEST(Manufactured, ConstrainedTension) {
    expect_table(
        {normal("ISO_ELASTIC-A", low_strain, {{150, 50}, {300, 100}, {450, 150}, {600, 200}}),
         normal("ISO_ELASTIC-A", logarithmic,
                {{141.339642788, 47.1132142626},
                 {267.772261577, 89.2574205257},
                 {382.144477342, 127.381492447},
                 {486.55812973, 162.186043243}}),
         normal("MOONEY_RIVLIN-A", rubber1,
                {{147.159609047, 103.50352881},
                 {276.706432561, 199.14678372},
                 {393.707639208, 288.941634941},
                 {501.460314263, 374.269842868}}),
         normal("NEO_HOOKEAN-A", neo,
                {{141.666666667, 47.2222222222}, {270, 90}, {388.636363636, 129.545454545}, {500, 166.666666667}}),
         normal("COROT_NEO_HOOKEAN-A", corotated, {{150, 50}, {300, 100}, {450, 150}, {600, 200}}),
         normal("DISNEY_SNOW-A", snow, {{150, 50}, {300, 100}, {450, 150}, {600, 200}})},
        tension(1.5), {1, 2, 3, 4}, 4);
}

TEST(Manufactured, ConstrainedTensionHeated) {
    const std::vector<std::array<double, 2>> corotated_table{{124.663247896, 24.5382478958},
                                                             {248.79970546, 47.8997054599},
                                                             {372.616084967, 69.8547213306},
                                                             {496.302559119, 90.3025591189}};
    const std::vector<std::array<double, 2>> rubber_table{{124.775557646, 58.5159672317},
                                                          {229.293275102, 109.780935186},
                                                          {319.054922013, 154.74524092},
                                                          {397.617207623, 194.196194536}};
    const std::vector<Row> rows{normal("ISO_ELASTIC-A", low_strain,
                                       {{125.154960003, 25.1549600029},
                                        {250.614774819, 50.6147748193},
                                        {376.372053755, 76.3720537546},
                                        {502.419671661, 102.419671661}}),
                                normal("MOONEY_RIVLIN-A", rubber1,
                                       {{110.811652236, 65.4979199367},
                                        {205.300554302, 121.777295586},
                                        {287.514925349, 170.515239252},
                                        {360.162445198, 212.923575749}}),
                                normal("MOONEY_RIVLIN-A", rubber2, rubber_table),
                                normal("VISCO_HYPER-A", visco_rubber2, rubber_table),
                                normal("NEO_HOOKEAN-A", neo,
                                       {{118.809748948, 23.1847489479},
                                        {227.74235273, 43.2423527299},
                                        {329.552076574, 60.7452583926},
                                        {426.101279559, 76.1012795594}}),
                                normal("COROT_NEO_HOOKEAN-A", corotated, corotated_table),
                                normal("DISNEY_SNOW-A", snow, corotated_table)};
    expect_table(rows, tension(1.5, 1.05), {1, 2, 3, 4}, 4);
}

// Moisture that expands as much as the heat gives the same numbers.
TEST(Manufactured, ConstrainedTensionWetted) {
    ManufacturedMotion wet = tension(1.5, 1.05);
    wet.cause = ResidualCause::field;
    EXPECT_NEAR(solution("NEO_HOOKEAN-A", {1000, 0.25, 0, 0, 2e-2}, wet)->residual_change(1), std::log(1.05) / 2e-2,
                1e-15);
    expect_table({normal("NEO_HOOKEAN-A", {1000, 0.25, 0, 0, 2e-2},
                         {{118.809748948, 23.1847489479},
                          {227.74235273, 43.2423527299},
                          {329.552076574, 60.7452583926},
                          {426.101279559, 76.1012795594}})},
                 wet, {1, 2, 3, 4}, 4);
}

TEST(Manufactured, LinearShear) {
    const std::vector<std::array<double, 4>> rubber{{41.6666666667, -33.3333333333, -8.33333333333, 150},
                                                    {166.666666667, -133.333333333, -33.3333333333, 300}};
    const std::vector<std::array<double, 4>> corotated_table{{126.871749869, 23.8859998837, 0, 205.971499971},
                                                             {526.6873708, 84.4582472001, 0, 442.2291236}};
    expect_table({{"ISO_ELASTIC-A",
                   low_strain,
                   {{97.7493752543, 0.735125239798, 24.6211251235, 194.028500029},
                    {367.7398202, 9.96894379985, 94.4271909999, 357.7708764}}},
                  {"MOONEY_RIVLIN-A", rubber2, rubber},
                  {"VISCO_HYPER-A", visco_rubber2, rubber},
                  {"NEO_HOOKEAN-A", neo, {{100, 0, 0, 200}, {400, 0, 0, 400}}},
                  {"COROT_NEO_HOOKEAN-A", corotated, corotated_table},
                  {"DISNEY_SNOW-A", snow, corotated_table}},
                 shear(1), {1, 2}, 2);
}

TEST(Manufactured, LinearShearHeated) {
    expect_table({{"MOONEY_RIVLIN-A",
                   rubber2,
                   {{-29.2751643318, -110.041961207, -83.1196955818, 161.53359375},
                    {46.0437992657, -301.243700734, -185.481200734, 347.2875}}},
                  {"NEO_HOOKEAN-A",
                   neo,
                   {{52.0855071839, -50.4144928161, -50.4144928161, 205},
                    {318.192519706, -101.807480294, -101.807480294, 420}}}},
                 shear(1, 1.05), {1, 2}, 2);
}

TEST(Manufactured, LinearAcceleration) {
    const ManufacturedMotion motion = as(Motion::linear_acceleration, tension(1.5));
    expect_table({normal("ISO_ELASTIC-A", low_strain, {{37.5, 12.5}, {150, 50}, {337.5, 112.5}, {600, 200}}),
                  normal("NEO_HOOKEAN-A", neo,
                         {{36.9318181818, 12.3106060606},
                          {141.666666667, 47.2222222222},
                          {300.457317073, 100.152439024},
                          {500, 166.666666667}}),
                  normal("MOONEY_RIVLIN-A", rubber2,
                         {{42.7555166257, 24.7870144144},
                          {160.612691458, 96.7769876041},
                          {330.970726611, 210.086283036},
                          {533.81514629, 358.092426855}})},
                 motion, {1, 2, 3, 4}, 4);
    const auto s = solution("NEO_HOOKEAN-A", neo, motion);
    const double stretches[] = {1.03125, 1.125, 1.28125, 1.5};
    for (int i = 0; i < 4; ++i) {
        EXPECT_EQ(s->gradient(0.25 * (i + 1))(0, 0), stretches[i]);
        EXPECT_EQ(s->body_force(0.25 * (i + 1))[0], 1);
    }
}

TEST(Manufactured, Sinusoidal) {
    const ManufacturedMotion motion = oscillating(Motion::sinusoidal_tension, tension(1.5));
    const std::vector<std::array<double, 2>> linear{{300, 100}, {600, 200}, {-300, -100}, {-600, -200}};
    expect_table({normal("ISO_ELASTIC-A", low_strain, linear), normal("COROT_NEO_HOOKEAN-A", corotated, linear),
                  normal("NEO_HOOKEAN-A", neo, {{270, 90}, {500, 166.666666667}, {-350, -116.666666667}, {-900, -300}}),
                  normal("MOONEY_RIVLIN-A", rubber2,
                         {{298.986058962, 188.006970519},
                          {533.81514629, 358.092426855},
                          {-442.958081955, -216.020959023},
                          {-1319.46442037, -465.267789814}})},
                 motion, {1, 3, 7, 9}, 12);
    EXPECT_NEAR(solution("NEO_HOOKEAN-A", neo, motion)->body_force(0.25)[0], -0.5 * 4 * pi * pi, 1e-13);
}

TEST(Manufactured, FreeTension) {
    const ManufacturedMotion motion = as(Motion::free_tension, tension(2));
    const auto table = [](const std::vector<std::array<double, 2>>& values) {
        std::vector<std::array<double, 4>> rows;
        for (const auto& [s11, s33] : values) rows.push_back({s11, 0, s33, 0});
        return rows;
    };
    const auto corotated_table = table({{275.371120108, 56.1403508772},
                                        {579.831932773, 94.1176470588},
                                        {928.518518519, 118.518518519},
                                        {1333.33333333, 133.333333333}});
    expect_table({{"NEO_HOOKEAN-A", neo,
                   table({{251.210228588, 55.0597761289},
                          {490.09802941, 93.3520056019},
                          {733.372306221, 120.96862783},
                          {989.949493661, 141.421356237}})},
                  {"COROT_NEO_HOOKEAN-A", corotated, corotated_table},
                  {"DISNEY_SNOW-A", snow, corotated_table}},
                 motion, {1, 2, 3, 4}, 4);

    const auto s = solution("NEO_HOOKEAN-A", neo, motion), c = solution("COROT_NEO_HOOKEAN-A", corotated, motion);
    const double width[] = {0.917662935482, 0.840168050417, 0.76980035892, 0.707106781187},
                 slope[] = {-0.321986994906, -0.296529900147, -0.266103827775, -0.235702260396},
                 curvature[] = {0.0813440829236, 0.116286235352, 0.123900194943, 0.117851130198},
                 secant[] = {-0.329348258071, -0.319663899166, -0.306932854774, -0.292893218813},
                 corotated_width[] = {0.912280701754, 0.823529411765, 0.740740740741, 0.666666666667};
    for (int i = 0; i < 4; ++i) {
        const double t = 0.25 * (i + 1);
        EXPECT_NEAR(s->lateral(t).value, width[i], printed);
        EXPECT_NEAR((s->lateral(t).value - 1) / t, secant[i], 4 * printed);
        EXPECT_NEAR(s->lateral(t).first, slope[i], printed);
        EXPECT_NEAR(s->body_force(t)[1], curvature[i], printed);
        EXPECT_NEAR(c->lateral(t).value, corotated_width[i], printed);
    }
    // ISO_ELASTIC, KIN = 1: F22 = 1 - nu/(1 - nu) (a - 1), plane strain stiffness, no acceleration.
    const auto e = solution("ISO_ELASTIC-A", low_strain, motion);
    EXPECT_NEAR(e->stress(0.5)(0, 0), 1000 / (1 - 0.0625) * 0.5, 1e-12);
    EXPECT_NEAR(e->stress(0.5)(2, 2), 0.25 * 1000 / (1 - 0.0625) * 0.5, 1e-12);
    EXPECT_NEAR(e->lateral(0.5).value, 1 - 0.5 / 3, 1e-15);
    EXPECT_EQ(e->body_force(0.5)[1], 0);
}

const Constants relaxing{1000, 300, 2, 1, 200, 0.5, 100, 5, 400, 2};

TEST(Manufactured, ViscoelasticRamps) {
    // Rate 0.01 at t = 1/4, 1/2, 1.
    expect_table(
        {normal("VISCOELASTIC-A", relaxing,
                {{5.28978773637, 2.5151433008}, {10.2468383603, 5.030971423}, {19.5091026575, 9.96708075472}})},
        by_strain(tension(1.01)), {1, 2, 4}, 4);
    expect_table(
        {{"VISCOELASTIC-A", relaxing, {{0, 0, 0, 1.38732221778}, {0, 0, 0, 2.60793346865}, {0, 0, 0, 4.77101095137}}}},
        by_strain(shear(0.01)), {1, 2, 4}, 4);
}

TEST(Manufactured, ViscoelasticSineIsMetWithSecondOrder) {
    const ManufacturedMotion motion = oscillating(Motion::sinusoidal_shear, by_strain(shear(0.01)));
    const double wanted[] = {5.43413491878, -0.851275516639, -5.97133853604, 0.505584412488};
    const auto exact = solution("VISCOELASTIC-A", relaxing, motion);
    EXPECT_EQ(exact->order(), 2);
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(exact->stress(0.25 * (i + 1))(0, 1), wanted[i], printed * 6);
    for (const Entry entry : {Entry::umat, Entry::vumat}) {
        double errors[2];
        for (int k = 0; k < 2; ++k) {
            const int n = 64 << k;
            const auto stress = driven("VISCOELASTIC-A", relaxing, motion, n, entry);
            errors[k] = 0;
            for (int i = 0; i < 4; ++i)
                errors[k] = std::max(errors[k], std::abs(stress[std::size_t(n / 4 * (i + 1) - 1)][3] - wanted[i]));
        }
        EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2, 0.02);
    }
}

TEST(Manufactured, HeldShearRelaxesItsDeviator) {
    const Constants constants{200, 1000, 100, 2, 0.5, 0.3, 0.2, 2};
    const ManufacturedMotion motion = as(Motion::held_shear, shear(1));
    const auto exact = solution("VISCO_HYPER-A", constants, motion);
    const double share = 0.3 + 0.5 * std::exp(-0.5 / 0.3) + 0.2 * std::exp(-0.25);
    EXPECT_NEAR(exact->stress(0.5)(0, 1), 300 * share, 1e-12);
    EXPECT_NEAR(exact->stress(0.5)(0, 0), 500.0 / 3 * share, 1e-12);
    EXPECT_EQ(exact->stress(0), Matrix3::Zero());
    for (const Entry entry : {Entry::umat, Entry::vumat}) {
        const auto stress = driven("VISCO_HYPER-A", constants, motion, 10, entry);
        ASSERT_EQ(stress.size(), 11U) << "the jump, then ten increments";
        EXPECT_NEAR(stress[5][3], 300 * share, 1e-10 * 300);
    }
}

// --- closed forms among themselves -------------------------------------------------------------------------------

TEST(Manufactured, LateralStretchesAndTheirDerivatives) {
    const LameConstants lame = LameConstants::from_young_poisson(1000, 0.25);
    EXPECT_NEAR(lame.lambda, 400, 1e-12);
    std::vector<std::unique_ptr<ElasticLaw>> laws;
    laws.push_back(std::make_unique<LowStrain>(lame));
    laws.push_back(std::make_unique<LogarithmicIncrements>(lame, false));
    for (const int option : {0, 1, 2}) {
        laws.push_back(std::make_unique<NeoHookeanLaw>(lame, option));
        laws.push_back(std::make_unique<CorotatedLaw>(lame, option));
        laws.push_back(std::make_unique<MooneyRivlinLaw>(200, 100, Dilatation{option, 1000}));
    }
    for (const auto& law : laws)
        for (const double end : {0.6, 1.0, 2.0})
            for (const double residual : {1.0, 1.05}) {
                const ManufacturedMotion m = as(Motion::free_tension, tension(end, residual));
                const auto width = [&](double t) { return lateral_stretch(*law, m.amount(t), m.residual(t)); };
                const double t = 0.7, h = 1e-4;
                const Taylor found = width(t), solved = solved_lateral_stretch(*law, m.amount(t), m.residual(t));
                // The formula is the root, and both know their derivatives.
                EXPECT_NEAR(found.value, solved.value, 1e-14);
                EXPECT_NEAR(found.first, solved.first, 1e-13);
                EXPECT_NEAR(found.second, solved.second, 1e-12);
                EXPECT_NEAR(law->stress({m.amount(t), found, 1}, m.residual(t))[1].value, 0, 1e-11);
                EXPECT_NEAR(found.first, (width(t + h).value - width(t - h).value) / (2 * h), 1e-7);
                EXPECT_NEAR(found.second, (width(t + h).first - width(t - h).first) / (2 * h), 1e-7);
            }
}

TEST(Manufactured, AnAuxeticSheetMayHaveNoFreeWidth) {
    // U'(J) of the logarithmic energy cannot balance a negative Lame constant.
    EXPECT_THROW(solution("NEO_HOOKEAN-A", {1000, -0.6, 2}, as(Motion::free_tension, tension(0.05))), BadDeck);
}

// Cauchy: T = sigma n with the normal of the deformed face.
TEST(Manufactured, TractionsOfTheShearedFace) {
    const auto s = solution("NEO_HOOKEAN-A", neo, shear(1));
    const double g = 0.5, length = std::sqrt(1 + g * g);
    const Matrix3 sigma = s->stress(g), faces = s->tractions(g);
    EXPECT_NEAR(faces(0, 0), (sigma(0, 0) - g * sigma(0, 1)) / length, 1e-12);
    EXPECT_NEAR(faces(1, 0), (sigma(0, 1) - g * sigma(1, 1)) / length, 1e-12);
    const Eigen::Vector3d normal = Eigen::Vector3d(1, -g, 0) / length, along = Eigen::Vector3d(g, 1, 0) / length;
    EXPECT_NEAR(faces.col(0).dot(normal), (sigma(0, 0) - 2 * g * sigma(0, 1) + g * g * sigma(1, 1)) / (1 + g * g),
                1e-12);
    EXPECT_NEAR(faces.col(0).dot(along), (g * (sigma(0, 0) - sigma(1, 1)) + (1 - g * g) * sigma(0, 1)) / (1 + g * g),
                1e-12);
    EXPECT_EQ(faces.col(1), sigma.col(1));
    EXPECT_EQ(faces.col(2), sigma.col(2));
}

TEST(Manufactured, StressPowerIsTheRateOfTheStoredEnergy) {
    // NEO_HOOKEAN, UJ = 0: W = G/2 (tr B - 3 - 2 ln J) + lambda/2 ((J^2 - 1)/2 - ln J).
    const auto energy = [](const Matrix3& F) {
        const double J = F.determinant();
        return 200 * (F.squaredNorm() - 3 - 2 * std::log(J)) + 200 * ((J * J - 1) / 2 - std::log(J));
    };
    for (const ManufacturedMotion& m :
         {tension(1.5), shear(1), as(Motion::linear_acceleration, tension(0.6)), as(Motion::free_tension, tension(2)),
          oscillating(Motion::sinusoidal_tension, tension(1.5)), oscillating(Motion::sinusoidal_shear, shear(0.5))}) {
        const auto s = solution("NEO_HOOKEAN-A", neo, m);
        const double h = 1e-5;
        EXPECT_NEAR(s->stress_power(0.4), (energy(s->gradient(0.4 + h)) - energy(s->gradient(0.4 - h))) / (2 * h),
                    1e-5);
        EXPECT_TRUE(s->has_energy());
    }
}

// --- where the method fails --------------------------------------------------------------------------------------

// KIN = 0 under shear is the law of the host's stress rate, not that of the left stretch.
TEST(Manufactured, IncrementsOfStrainFollowTheRateOfTheHost) {
    for (const auto& [entry, order] : {std::pair(Entry::umat, 1), std::pair(Entry::vumat, 2)}) {
        const auto rate = solution("ISO_ELASTIC-A", logarithmic, shear(1), entry);
        EXPECT_EQ(rate->order(), order);
        double errors[2];
        for (int k = 0; k < 2; ++k)
            errors[k] = std::abs(driven("ISO_ELASTIC-A", logarithmic, shear(1), 100 << k, entry).back()[3] -
                                 rate->stress(1)(0, 1));
        EXPECT_NEAR(std::log2(errors[0] / errors[1]), order, 0.05);
        EXPECT_LT(errors[1], 2);
        EXPECT_GT(std::abs(rate->stress(1)(0, 1) - 357.7708764), 9) << "(11.13) with KIN = 1";
    }
    EXPECT_NEAR(solution("ISO_ELASTIC-A", logarithmic, shear(1))->stress(1)(0, 1), 400 * std::sin(1.0), 1e-12);
    EXPECT_THROW(solution("ISO_ELASTIC-A", logarithmic, as(Motion::held_shear, shear(1))), BadDeck);
}

// A linear ramp of the temperature does not expand linearly: the deck has to follow ln(1 + rate t)/alpha.
TEST(Manufactured, LinearHeatIsNotLinearExpansion) {
    Scenario scenario = scenario_of(
        "[material]\nname = \"NEO_HOOKEAN-A\"\nconstants = [1000, 0.25, 0, 1e-3]\n[[step]]\nincrements = 4\n"
        "deformation_gradient = [[1.5, 0, 0], [0, 1, 0], [0, 0, 1]]\ntemperature = 48.790164169432\n");
    const History history = run_scenario(scenario, LODE_TEST_LIBRARY);
    const auto exact = solution("NEO_HOOKEAN-A", neo, tension(1.5, 1.05));
    EXPECT_NEAR(history.records[4].point.stress[0], exact->stress(1)(0, 0), 1e-9);
    EXPECT_GT(std::abs(history.records[2].point.stress[0] - exact->stress(0.5)(0, 0)), 0.3);
}

TEST(Manufactured, PairsWithoutAClosedFormAreRefusedByName) {
    const auto message = [](const std::string& material, const Constants& constants, const ManufacturedMotion& motion,
                            Kind kind = Kind::solid) -> std::string {
        try {
            manufactured_solution(material, constants, motion, kind, Entry::umat);
        } catch (const BadDeck& refusal) {
            return refusal.what();
        }
        return "";
    };
    const auto expect_words = [](const std::string& text, std::initializer_list<const char*> words) {
        for (const char* word : words) EXPECT_NE(text.find(word), std::string::npos) << word << " in: " << text;
    };
    expect_words(message("ISO_PLASTIC-A", {1, 0.3, 1}, tension(1.5)),
                 {"deck: ", "ISO_PLASTIC", "ISO_ELASTIC", "MOONEY_RIVLIN", "VISCO_HYPER"});
    expect_words(message("NEO_HOOKEAN-A", neo, tension(1.5), Kind::plane_stress),
                 {"plane_stress", "3d, plane_strain, axisymmetric"});
    expect_words(message("NEO_HOOKEAN-A", neo, by_strain(tension(1.5))), {"NEO_HOOKEAN", "strain", "gradient"});
    expect_words(message("NEO_HOOKEAN-A", {1000, 0.25}, tension(1.5, 1.05)), {"residual_stretch", "PROPS(4) is 0"});
    expect_words(message("VISCOELASTIC-A", relaxing, tension(1.5)),
                 {"VISCOELASTIC", "constrained_tension", "linear_shear"});
    expect_words(message("VISCOELASTIC-A", relaxing, by_strain(as(Motion::linear_acceleration, tension(1.5)))),
                 {"VISCOELASTIC", "linear_acceleration"});
    Constants shifted = relaxing;
    shifted.insert(shifted.end(), {0, 0, 0, 0, 1});
    expect_words(message("VISCOELASTIC-A", shifted, by_strain(tension(1.5))), {"VISCOELASTIC", "shift"});
    expect_words(message("VISCO_HYPER-A", {200, 1000, 0, 1, 0.5, 1}, shear(1)),
                 {"VISCO_HYPER", "held_shear", "NG = 0"});
    expect_words(message("VISCO_HYPER-A", {200, 1000, 0, 1e9}, shear(1)), {"PROPS(4)", "0..30"});
    expect_words(message("DISNEY_SNOW-A", {1000, 0.25}, tension(1.5)), {"elastic range", "0.975", "1.0075"});
    expect_words(message("ISO_ELASTIC-A", {1000, 0.25, 0, 0, 0, 5}, tension(1.5)), {"OOP"});
    expect_words(message("ISO_ELASTIC-A", low_strain, by_strain(tension(1.5))), {"KIN"});
    expect_words(message("NEO_HOOKEAN-A", {1000, std::nan("")}, tension(1.5)), {"not a number"});
    // The same law for a library that has other names.
    ManufacturedMotion other = tension(1.5);
    other.law = "NEO_HOOKEAN";
    other.law_constants = neo;
    EXPECT_EQ(message("USER_RUBBER", {1, 2, 3}, other), "");
}

// --- decks and the command ---------------------------------------------------------------------------------------

const std::string block = "[material]\nname = \"NEO_HOOKEAN-A\"\nconstants = [1000, 0.25, 0, 1e-3]\n";

TEST(ManufacturedDeck, StepsStartFromTheUndeformedBody) {
    const std::string step =
        "[[step]]\nincrements = 2\nmanufactured = { motion = \"linear_shear\", shear = 1, "
        "residual_stretch = 1.05 }\n";
    const History history = run_scenario(scenario_of(block + step + step), LODE_TEST_LIBRARY);
    ASSERT_EQ(history.records.size(), 5U);
    EXPECT_EQ(history.records[1].point.stress, history.records[3].point.stress);
    EXPECT_EQ(history.records[2].point.stress, history.records[4].point.stress);
    EXPECT_EQ(history.end().total_time, 2);
    EXPECT_NEAR(history.end().temperature, 48.7901641694, 1e-9);
}

TEST(ManufacturedDeck, PlaneStrainAndAxisymmetricBodies) {
    const auto full = driven("MOONEY_RIVLIN-A", rubber2, tension(1.5, 1.05), 4, Entry::umat);
    for (const Kind kind : {Kind::plane_strain, Kind::axisymmetric})
        for (const Entry entry : {Entry::umat, Entry::vumat}) {
            const auto plane = driven("MOONEY_RIVLIN-A", rubber2, tension(1.5, 1.05), 4, entry, kind);
            for (int i = 0; i < 4; ++i) EXPECT_NEAR(plane.back()[i], full.back()[i], 1e-12 * 400);
        }
}

TEST(ManufacturedDeck, BadKeysAreRefused) {
    const auto refusal = [](const std::string& step) -> std::string {
        try {
            run_scenario(scenario_of(block + ("[[step]]\n" + step)), LODE_TEST_LIBRARY);
        } catch (const BadDeck& bad) {
            return bad.what();
        }
        return "";
    };
    const std::pair<const char*, const char*> cases[] = {
        {"manufactured = { stretch = 2 }", "motion"},
        {"manufactured = { motion = \"linear\", stretch = 2 }", "linear_shear"},
        {"manufactured = { motion = \"constrained_tension\" }", "needs stretch"},
        {"manufactured = { motion = \"constrained_tension\", stretch = -1 }", "stretch"},
        {"manufactured = { motion = \"constrained_tension\", stretch = 2, shear = 1 }", "has no shear"},
        {"manufactured = { motion = \"linear_shear\", shear = 1, angular_frequency = 1 }", "has no angular_frequency"},
        {"manufactured = { motion = \"sinusoidal_tension\", stretch = 2, angular_frequency = 1 }", "below 2"},
        {"manufactured = { motion = \"linear_shear\", shear = 1, residual_stretch = 0 }", "residual_stretch"},
        {"manufactured = { motion = \"linear_shear\", shear = 1, law = \"NEO_HOOKEAN\" }", "law_constants"},
        {"manufactured = { motion = \"linear_shear\", shear = 1, sheer = 1 }", "did you mean"},
        {"strain = { 11 = 1 }\nmanufactured = { motion = \"linear_shear\", shear = 1 }", "no other loading"},
        {"temperature = 3\nmanufactured = { motion = \"linear_shear\", shear = 1 }", "no other loading"}};
    for (const auto& [step, word] : cases)
        EXPECT_NE(refusal(step).find(word), std::string::npos) << step << "\n" << refusal(step);
    const std::string fine = "[[step]]\nmanufactured = { motion = \"linear_shear\", shear = 1 }\n";
    EXPECT_THROW(
        run_scenario(scenario_of(std::string(block) + "initial_stress = { 11 = 1 }\n" + fine), LODE_TEST_LIBRARY),
        BadDeck);
    EXPECT_THROW(run_scenario(scenario_of(block + ("[analysis]\nlarge_rotation = false\n" + fine)), LODE_TEST_LIBRARY),
                 BadDeck);
}

struct Result {
    int status;
    std::string out, err;
};
Result verify_deck(const Directory& directory, const std::string& deck, const std::string& options = "") {
    directory.write("deck.toml", deck);
    const std::string command = "cd '" + directory.file("") + "' && '" LODE_EXECUTABLE "' replay --verify deck.toml " +
                                options + " --library '" LODE_TEST_LIBRARY "' >out.log 2>err.log";
    const int raw = std::system(command.c_str());
    return {WIFEXITED(raw) ? WEXITSTATUS(raw) : -1, directory.read("out.log"), directory.read("err.log")};
}
const std::string no_plot = "[output]\nplot = false\n";

TEST(Verify, PrintsATableAndSucceeds) {
    const Directory directory;
    const std::string deck = block + ("[[step]]\nname = \"pull\"\nincrements = 3\nmanufactured = { motion = "
                                      "\"constrained_tension\", stretch = 1.5 }\n[output]\nplot = false\ncolumns = "
                                      "[\"exact11\", \"body_force1\", \"traction_x1\"]\n");
    const Result result = verify_deck(directory, deck);
    EXPECT_EQ(result.status, 0) << result.err;
    for (const char* word : {"closed forms", "1 pull", "umat_", "vumat_", "exact", "ok"})
        EXPECT_NE(result.out.find(word), std::string::npos) << word << "\n" << result.out;
    EXPECT_NE(directory.read("deck.txt").find("closed forms"), std::string::npos);
    EXPECT_EQ(directory.read("deck.csv").find("exact11,body_force1,traction_x1\n0,0,0\n"), 0U)
        << directory.read("deck.csv");
    const Result quiet = verify_deck(directory, deck, "--quiet");
    EXPECT_EQ(quiet.status, 0);
    EXPECT_EQ(quiet.out + quiet.err, "");
    const Result one = verify_deck(directory, deck, "--interface vumat");
    EXPECT_EQ(one.out.find(" umat_"), std::string::npos) << one.out;
}

TEST(Verify, AnotherLawIsFoundOut) {
    const Directory directory;
    const std::string wrong =
        "[[step]]\nincrements = 5\nmanufactured = { motion = \"constrained_tension\", stretch = 1.5, "
        "law = \"NEO_HOOKEAN\", law_constants = [1000, 0.26] }\n";
    const Result result = verify_deck(directory, block + wrong + no_plot, "--quiet");
    EXPECT_EQ(result.status, static_cast<int>(Status::not_verified));
    EXPECT_EQ(result.status, 7);
    EXPECT_NE(result.err.find("closed form"), std::string::npos) << result.err;
    EXPECT_NE(directory.read("deck.txt").find("WRONG"), std::string::npos);
    EXPECT_NE(verify_deck(directory, block + wrong + no_plot).out.find("0.00 (exact)"), std::string::npos)
        << "a wrong limit does not converge";
}

TEST(Verify, NothingToVerifyIsABadDeck) {
    const Directory directory;
    const Result nothing = verify_deck(directory, block + ("[[step]]\nstrain = { 11 = 0.1 }\n" + no_plot));
    EXPECT_EQ(nothing.status, 2);
    EXPECT_NE(nothing.err.find("manufactured"), std::string::npos) << nothing.err;
    const std::string step = "[[step]]\nmanufactured = { motion = \"linear_shear\", shear = 1 }\n";
    const Result automatic = verify_deck(directory, block + step + "automatic = { initial = 0.1 }\n" + no_plot);
    EXPECT_EQ(automatic.status, 2);
    EXPECT_NE(automatic.err.find("automatic"), std::string::npos) << automatic.err;
    const Result single = verify_deck(
        directory, block + ("[analysis]\ninterface = \"vumat\"\nprecision = \"single\"\n" + step + no_plot));
    EXPECT_EQ(single.status, 2);
    EXPECT_NE(single.err.find("precision"), std::string::npos) << single.err;
}

}  // namespace
}  // namespace lode::host::test
