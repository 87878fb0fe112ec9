// Maps of the atlas against the numbers and formulas of the model pages, each limit from both sides.
#include <gtest/gtest.h>

#include <cmath>

#include "atlas/command.hpp"
#include "atlas/constants.hpp"
#include "atlas/element_size.hpp"
#include "atlas/ellipticity.hpp"
#include "atlas/error_map.hpp"
#include "atlas/failure_rate.hpp"
#include "atlas/limit_point.hpp"
#include "atlas/rotation.hpp"
#include "atlas/time_step.hpp"
#include "cards.hpp"
#include "study.hpp"
#include "study/variants.hpp"
#include "support.hpp"

namespace lode::host::test {
namespace {

constexpr int method = 22, substeps = 23;  // PROPS of ISO_PLASTIC

std::vector<double> with_method(std::vector<double> constants, double value, double count = 0) {
    constants.resize(substeps, 0.0);
    constants[method - 1] = value;
    constants[substeps - 1] = count;
    return constants;
}

const std::vector<double> perfect{200000, 0.3, 400, 0};

// Page 20, section 6: percent of the yield radius, printed to 0.001. Rows y, columns x.
TEST(ErrorMap, ReproducesThePageOfPerfectPlasticity) {
    LODE_NEEDS("ISO_PLASTIC");
    const Scenario scene = material("ISO_PLASTIC-X", perfect);
    const Scenario exact = material("ISO_PLASTIC-X", with_method(perfect, 1));
    auto axes = usual_axes(scene, library(), 0.006);
    ASSERT_TRUE(axes);
    struct Row {
        double y;
        std::vector<double> percent;
    };
    const std::vector<double> x{0, 0.5, 1, 2, 3, 4, 5, 6};
    const std::vector<Row> page{{0.5, {1.673, 6.071, 6.461, 4.850, 3.289, 2.248, 1.587, 1.163}},
                                {1, {8.035, 12.034, 12.095, 9.141, 6.302, 4.359, 3.104, 2.287}},
                                {2, {19.430, 20.012, 18.955, 14.830, 10.785, 7.773, 5.698, 4.287}},
                                {3, {22.180, 21.718, 20.489, 16.811, 12.990, 9.855, 7.513, 5.817}},
                                {4, {20.797, 20.272, 19.308, 16.554, 13.506, 10.771, 8.555, 6.840}},
                                {5, {18.366, 17.965, 17.289, 15.355, 13.090, 10.901, 8.993, 7.418}},
                                {6, {16.002, 15.721, 15.259, 13.920, 12.277, 10.590, 9.025, 7.658}}};
    axes->x = x;
    for (const Row& row : page) {
        axes->y = {row.y};
        for (const bool by_exact_solution : {true, false}) {
            const ErrorMap map =
                error_map(scene, library(), *axes, by_exact_solution ? std::optional(exact) : std::nullopt, nullptr);
            ASSERT_EQ(map.cells.size(), x.size());
            for (std::size_t i = 0; i < x.size(); ++i)
                EXPECT_NEAR(100 * map.cells[i].error, row.percent[i], 0.0006)
                    << "x = " << x[i] << ", y = " << row.y << (by_exact_solution ? "" : ", extrapolated reference");
        }
    }
    // Unloading first.
    axes->x = {-0.5};
    axes->y = {0.5, 1, 2, 3, 4};
    const ErrorMap unloading = error_map(scene, library(), *axes, exact, nullptr);
    const std::vector<double> half{0, 0.930, 16.974, 21.754, 20.817};
    for (std::size_t i = 0; i < half.size(); ++i) EXPECT_NEAR(100 * unloading.cells[i].error, half[i], 0.0006);
    axes->x = {-1};
    const ErrorMap more = error_map(scene, library(), *axes, exact, nullptr);
    const std::vector<double> whole{0, 0, 14.316, 20.666, 20.356};
    for (std::size_t i = 0; i < whole.size(); ++i) EXPECT_NEAR(100 * more.cells[i].error, whole[i], 0.0006);
}

// Page 70: from over-consolidated states and in large increments the source's iteration diverges.
TEST(FailureRate, TheTextbookNewtonOfCamClayFailsWhereTheDefaultDoesNot) {
    LODE_NEEDS("CAM_CLAY");
    const auto [model, sample] = samples_named(library(), "CAM_CLAY-CLAY").front();
    const Scenario scene = sample_scenario(*model, *sample, Kind::solid);
    std::vector<Algorithm> algorithms;
    for (int i = 0; i < model->algorithm_count; ++i)
        algorithms.push_back({model->algorithms[i].name, with_algorithm(scene, *model, model->algorithms[i])});
    ASSERT_EQ(algorithms.size(), 5U);
    const auto rates =
        failure_rates(scene, algorithms, library(), sample->strain_scale, {1e-3, 0.2, 2.0}, 100, nullptr);
    ASSERT_EQ(rates.size(), 5U);
    for (const AlgorithmRates& algorithm : rates) {
        ASSERT_EQ(algorithm.rates.size(), 3U);
        EXPECT_EQ(algorithm.rates[0].tried, 100);
        EXPECT_EQ(algorithm.rates[0].cut, 0) << algorithm.name;
    }
    for (const std::size_t default_and_substeps : {0U, 1U, 2U}) EXPECT_EQ(rates[default_and_substeps].rates[1].cut, 0);
    // Page 70: some five iterations in an increment as large; the guard refuses before anything is solved.
    for (const AlgorithmRates& algorithm : rates) EXPECT_TRUE(algorithm.observed);
    EXPECT_GT(rates[0].rates[1].iterations, 1);
    EXPECT_LT(rates[0].rates[1].iterations, 8);
    EXPECT_FALSE(rates[3].is_ever_safeguarded());
    EXPECT_GT(rates[4].rates[1].cut, 5) << "page 70: a fifth of increments of this size fail from the old state";
    // Hardly any direction of this norm stays below the guard of 0.5 in each component.
    EXPECT_GT(rates[0].rates[2].cut, 90);
}

// What the library says of its solutions stands in every cell: a closed form takes nothing, substeps are as many as
// were asked for, saturating hardening iterates beyond the elastic limit and only there.
TEST(ErrorMap, SaysWhatTheSolutionsTook) {
    LODE_NEEDS("ISO_PLASTIC");
    const std::vector<double> saturating{200000, 0.3, 400, 8, 300, 12, 500};
    struct Line {
        std::vector<double> constants;
        int substeps;
        bool iterates;
    };
    for (const Line& line : {Line{perfect, 0, false}, {with_method(perfect, 2, 8), 8, false}, {saturating, 0, true}}) {
        const Scenario scene = material("ISO_PLASTIC-X", line.constants);
        auto axes = usual_axes(scene, library(), 0.006);
        ASSERT_TRUE(axes);
        axes->x = {-0.5, 1, 3};
        axes->y = {0, 2};
        const ErrorMap map = error_map(scene, library(), *axes, std::nullopt, nullptr);
        for (const ErrorMapCell& cell : map.cells) {
            ASSERT_TRUE(cell.observation);
            const bool plastic = cell.x > 0 || cell.y > 0;
            EXPECT_EQ(cell.observation->iterations > 0, plastic && line.iterates);
            EXPECT_EQ(cell.observation->safeguards, 0);
            EXPECT_EQ(cell.observation->substeps, line.substeps);
        }
        const Sheet sheet = error_sheet(map, "stem", "title");
        EXPECT_TRUE(
            sheet.table.text().starts_with("x,y,error,reference_error,pnewdt,ns,iterations,safeguards,substeps\n"));
        EXPECT_EQ(map.most.iterations > 0, line.iterates);
    }
}

// Page 20: largest and mean error over the grid, n equal substeps.
TEST(ErrorMap, FallsWithSubstepsAsThePageSays) {
    LODE_NEEDS("ISO_PLASTIC");
    const Scenario exact = material("ISO_PLASTIC-X", with_method(perfect, 1));
    struct Line {
        double count, largest, mean;
    };
    for (const Line& line : {Line{1, 22.18, 10.60},
                             {2, 13.45, 5.36},
                             {4, 7.80, 2.55},
                             {8, 4.24, 1.20},
                             {16, 2.21, 0.574},
                             {32, 1.13, 0.280}}) {
        const Scenario scene = material("ISO_PLASTIC-X", with_method(perfect, 2, line.count));
        const auto axes = usual_axes(material("ISO_PLASTIC-X", perfect), library(), 0.006);
        ASSERT_TRUE(axes);
        const ErrorMap map = error_map(scene, library(), *axes, exact, nullptr);
        EXPECT_NEAR(100 * map.largest, line.largest, 0.006) << line.count << " substeps";
        // The page's mean leaves out the increment of zero.
        const double cells = static_cast<double>(map.cells.size()), mean = 100 * map.mean * cells / (cells - 1);
        EXPECT_NEAR(mean, line.mean, line.mean < 1 ? 0.0006 : 0.006) << line.count << " substeps";
    }
}

// The same page: plane stress from uniaxial tension, increments of the trial stress in units of the yield stress.
TEST(ErrorMap, ReproducesThePageOfPlaneStress) {
    LODE_NEEDS("ISO_PLASTIC");
    const double E = perfect[0], nu = perfect[1], Y = perfect[2];
    const Scenario scene = material("ISO_PLASTIC-X", perfect, Kind::plane_stress);
    const auto strain = [&](double s11, double s22) {
        return components({(s11 - nu * s22) / E, (s22 - nu * s11) / E, 0});
    };
    struct Start {
        double s11, s22;
        std::vector<std::vector<double>> percent;  // rows y, columns x = 0, 2, 4, 6
    };
    const double r = 1 / std::sqrt(3.0);
    const std::vector<Start> page{{1,
                                   0,
                                   {{0, 4.637, 4.645, 3.716},
                                    {7.619, 10.900, 8.225, 5.929},
                                    {13.757, 10.110, 7.352, 5.716},
                                    {11.671, 8.658, 6.383, 5.047}}},
                                  {1,
                                   1,
                                   {{0, 12.794, 12.957, 10.389},
                                    {12.794, 0, 3.524, 4.412},
                                    {12.957, 3.524, 0, 1.391},
                                    {10.389, 4.412, 1.391, 0}}},
                                  {r,
                                   -r,
                                   {{0, 15.828, 15.984, 12.711},
                                    {0.587, 13.242, 14.155, 11.546},
                                    {5.738, 9.153, 9.494, 8.625},
                                    {5.365, 6.713, 6.729, 6.335}}}};
    for (const Start& start : page) {
        ErrorMapAxes axes;
        axes.start = (1 - 1e-14) * strain(start.s11 * Y, start.s22 * Y);
        axes.along = strain(Y, 0);
        axes.across = strain(0, Y);
        axes.x = axes.y = {0, 2, 4, 6};
        axes.relative_to_end = true;
        const ErrorMap map = error_map(scene, library(), axes, std::nullopt, nullptr);
        ASSERT_EQ(map.cells.size(), 16U);
        for (std::size_t j = 0; j < 4; ++j)
            for (std::size_t i = 0; i < 4; ++i)
                EXPECT_NEAR(100 * map.cells[4 * j + i].error, start.percent[j][i], 0.002)
                    << "from (" << start.s11 << ", " << start.s22 << "), x = " << axes.x[i] << ", y = " << axes.y[j];
    }
}

// Stable just below, unstable just above.
void expect_time_step(const Scenario& scene, int component, double limit, double amplitude) {
    Scenario vumat = scene;
    vumat.analysis.entry = Entry::vumat;
    MaterialPoint point(vumat, library());
    const double density = vumat.material.density, length = vumat.analysis.element_length;
    EXPECT_TRUE(oscillator_is_stable(point, component, density, length, amplitude, 0.9999 * limit, 3000));
    EXPECT_FALSE(oscillator_is_stable(point, component, density, length, amplitude, 1.0001 * limit, 3000));
}

// Pages 10 and 20: the wave speeds of the kinds.
TEST(TimeStep, IsElementLengthOverWaveSpeed) {
    const double E = 200000, nu = 0.3, density = 7.8e-9, length = 2.5;
    const double G = E / (2 * (1 + nu)), K = E / (3 * (1 - 2 * nu));
    const std::vector<std::pair<std::string, std::vector<double>>> materials{
        {"ISO_ELASTIC", {E, nu}}, {"ISO_PLASTIC", {E, nu, 400, 1, 2000}}, {"NEO_HOOKEAN", {E, nu}}};
    for (const auto& [keyword, constants] : materials) {
        LODE_NEEDS(keyword);
        SCOPED_TRACE(keyword);
        const auto limit = [&](double modulus) { return length / std::sqrt(modulus / density); };
        const auto scene = [&, name = keyword + "-X", values = constants](Kind kind) {
            Scenario s = material(name, values, kind);
            s.material.density = density;
            s.analysis.element_length = length;
            return s;
        };
        const double strain = 1e-9;
        expect_time_step(scene(Kind::solid), 0, limit(K + 4 * G / 3), strain);
        expect_time_step(scene(Kind::solid), 3, limit(G), strain);
        expect_time_step(scene(Kind::plane_strain), 1, limit(K + 4 * G / 3), strain);
        expect_time_step(scene(Kind::plane_stress), 0, limit(E / (1 - nu * nu)), strain);
        if ((library().model_of(keyword)->kinds & LODE_UNIAXIAL) != 0)
            expect_time_step(scene(Kind::uniaxial), 0, limit(E), strain);
    }
}

// Page 40: a stiff interface costs time steps as 1/sqrt(k).
TEST(TimeStep, OfAnInterfaceFallsWithTheRootOfItsStiffness) {
    LODE_NEEDS("COH_TRIANGULAR");
    for (const double stiffness : {1e4, 1e6}) {
        const Scenario scene =
            material("COH_TRIANGULAR-X", {stiffness, 30, 0.9, stiffness, 40, 0.9}, Kind::cohesive_2d);
        expect_time_step(scene, 0, std::sqrt(scene.material.density / stiffness), 1e-9);
    }
}

// The wave speed of the virgin state gives the explicit step of every material of the registry. Where tension and
// compression differ in stiffness the step is smaller than that of the stiffer side.
class TimeStepOf : public testing::TestWithParam<const lode_model*> {};
TEST_P(TimeStepOf, FollowsFromTheStiffnessOfItsMaterials) {
    const lode_model& model = *GetParam();
    for (int s = 0; s < model.sample_count; ++s) {
        const lode_sample& sample = model.samples[s];
        for (const Kind kind : kinds_of(model.kinds & sample.kinds)) {
            const Scenario scene = sample_scenario(model, sample, kind);
            for (const TimeStepLimit& limit : time_step_limits(scene, library(), sample.strain_scale)) {
                // Where contact makes compression stiffer, the kink costs more than either side.
                const bool kinked = limit.softer > 1.01 * limit.estimate || limit.rate_dependent;
                EXPECT_LE(limit.found, 1.01 * limit.softer) << scene.title << ", component " << limit.component;
                EXPECT_GE(limit.found, (kinked ? 0.1 : 0.99) * limit.estimate)
                    << scene.title << ", component " << limit.component;
            }
        }
    }
}

// Damping makes the step of viscous models shorter than the stiffness says.
std::vector<const lode_model*> undamped_models() {
    std::vector<const lode_model*> models;
    for (const lode_model* model : library().models())
        if ((model->traits & LODE_VISCOUS) == 0) models.push_back(model);
    return models;
}
INSTANTIATE_TEST_SUITE_P(Registry, TimeStepOf, testing::ValuesIn(undamped_models()),
                         [](const auto& test_case) { return std::string(test_case.param->keyword); });

// Page 20, "where methods fail": the largest element of a softening law with slope Ep at LREF.
TEST(ElementSize, IsLimitedWhereSofteningIsAsSteepAsUnloading) {
    LODE_NEEDS("ISO_PLASTIC");
    const double E = 30000, nu = 0.2, Ep = -1500, reference = 50, G = E / (2 * (1 + nu));
    std::vector<double> constants{E, nu, 30, 1, Ep, 3};
    constants.resize(24, 0.0);
    constants[23] = reference;
    const std::vector<std::pair<Kind, double>> limits{{Kind::solid, 3 * G},
                                                      {Kind::plane_strain, 3 * G},
                                                      {Kind::plane_stress, E / (2 * (1 - nu))},
                                                      {Kind::uniaxial, E}};
    for (const auto& [kind, slope] : limits) {
        const double largest = slope * reference / -Ep;
        const Scenario scene = material("ISO_PLASTIC-X", constants, kind);
        const Muted muted;
        std::string message;
        EXPECT_TRUE(accepts_element(scene, library(), largest * (1 - 1e-9))) << name_of(kind);
        EXPECT_FALSE(accepts_element(scene, library(), largest * (1 + 1e-9), &message)) << name_of(kind);
        EXPECT_NE(message.find("h_max"), std::string::npos) << message;
        const auto found = largest_element(scene, library());
        ASSERT_TRUE(found);
        EXPECT_NEAR(found->length / largest, 1, 1e-9) << name_of(kind);
    }
}

// Every material with such a limit: it works just inside and is refused just outside, by a message with the length; and
// smaller elements dissipate the same energy.
TEST(ElementSize, IsHeldByEveryMaterialThatHasALimit) {
    const Muted muted;
    for (const auto& [model, sample] : all_samples(library())) {
        if ((model->traits & LODE_USES_CELENT) == 0) continue;
        for (const Kind kind : kinds_of(model->kinds & sample->kinds)) {
            if (is_cohesive(kind)) continue;
            Scenario scene = sample_scenario(*model, *sample, kind);
            scene.analysis.large_rotation.reset();
            SCOPED_TRACE(scene.title);
            const auto largest = largest_element(scene, library());
            if (!largest) continue;
            EXPECT_TRUE(accepts_element(scene, library(), 0.999 * largest->length));
            EXPECT_FALSE(accepts_element(scene, library(), 1.001 * largest->length));
            EXPECT_NE(largest->message.find(model->keyword), std::string::npos) << largest->message;
            if (kind != Kind::solid) continue;
            const auto runs = dissipation_over_size(scene, library(), sample->strain_scale, largest->length,
                                                    {1.0 / 16, 1.0 / 32, 1.0 / 64});
            for (const Dissipation& run : runs)
                if (run.complete) {
                    EXPECT_NEAR(run.energy / runs.back().energy, 1, 0.05) << "element length " << run.length;
                }
        }
    }
}

// Page 20: ellipticity is lost where H <= -(3/4) E N^2: in uniaxial tension (N^2 = 1/3) at H = -E/4, in pure shear (N =
// 0) as soon as the law softens.
double least_ratio(double slope, bool shear) {
    const double E = 200000;
    std::vector<double> constants{E, 0.3, 400, 1, slope};
    constants.resize(24, 0.0);
    constants[23] = 1;
    Scenario scene = material("ISO_PLASTIC-X", constants);
    Step step;
    // Small increments beyond the yield point: the consistent tangent is then that of the rate equations.
    step.components[shear ? 3 : 0] =
        Prescribed{Control::strain, (shear ? 2.6 / std::sqrt(3.0) : 1.0) * 400 / E * 1.001};
    step.increments = FixedIncrements{5000};
    if (shear)
        for (const std::size_t i : {0U, 1U, 2U, 4U, 5U}) step.components[i] = Prescribed{Control::strain, 0};
    scene.steps = {step};
    const Ellipticity result = ellipticity_along(scene, library());
    EXPECT_EQ(result.failure, "");
    return result.points.back().least.ratio;
}
TEST(Ellipticity, IsLostWhereThePageSays) {
    LODE_NEEDS("ISO_PLASTIC");
    const double critical = -200000.0 / 4;
    EXPECT_GT(least_ratio(0.99 * critical, false), 0);
    EXPECT_LT(least_ratio(1.01 * critical, false), 0);
    EXPECT_GT(least_ratio(500, true), 0);
    EXPECT_LT(least_ratio(-500, true), 0);
}

// Linear elasticity: det Q = (lambda + 2 G) G^2 in all directions.
TEST(Ellipticity, AcousticTensorOfLinearElasticity) {
    LODE_NEEDS("ISO_ELASTIC");
    const double E = 1000, nu = 0.25, G = E / (2 * (1 + nu)), M = 2 * G * (1 - nu) / (1 - 2 * nu);
    MaterialPoint point(material("ISO_ELASTIC-X", {E, nu}), library());
    const AcousticTensor tensor(point.layout(), point.tangent(), Components::Zero(6), false);
    for (const Eigen::Vector3d& n : std::vector<Eigen::Vector3d>{Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0.6, 0.8, 0),
                                                                 Eigen::Vector3d(2, -1, 2) / 3.0})
        EXPECT_NEAR(tensor.determinant(n) / (M * G * G), 1, 1e-12);
}

// Page 10, section 6, column H: the UMAT convention turns a stress by a whole turn without drift, and is of first order
// in simple shear to 2 (errors over G).
TEST(Rotation, UmatConventionAsOnThePage) {
    LODE_NEEDS("ISO_ELASTIC");
    const double E = 1000, nu = 0.25, G = 400;
    Scenario scene = material("ISO_ELASTIC-X", {E, nu});
    EXPECT_LT(turn_error(scene, library(), 0.01, 100), 1e-12);
    EXPECT_LT(turn_error(scene, library(), 0.01, 1000), 1e-12);
    Components jaumann = components({566.458734619, -566.458734619, 0, 363.718970730, 0, 0});
    const std::vector<std::pair<int, double>> page{{4, 6.07e-1}, {16, 1.50e-1}, {64, 3.72e-2}, {256, 9.30e-3}};
    for (const auto& [n, error] : page)
        EXPECT_NEAR(stress_norm(Layout(Kind::solid), sheared_stress(scene, library(), 2, n) - jaumann) / G / error, 1,
                    0.006)
            << n;
    // Closed cycle of stretch and shear by 0.1, increments that tend to zero.
    const Components left =
        (2 * cycled_stress(scene, library(), 0.1, 2000) - cycled_stress(scene, library(), 0.1, 1000)) / G;
    EXPECT_NEAR(left[0], 4.733e-4, 2e-6);
    EXPECT_NEAR(left[3], -4.406e-4, 2e-6);
}

// The same page, column G: the frame of VUMAT (Green-Naghdi) with strain increments at mid-increment.
TEST(Rotation, VumatConventionAsOnThePage) {
    LODE_NEEDS("ISO_ELASTIC");
    Scenario scene = material("ISO_ELASTIC-X", {1000, 0.25});
    scene.analysis.entry = Entry::vumat;
    EXPECT_LT(turn_error(scene, library(), 0.01, 100), 1e-12);
    const Components exact = components({456.637061436, -456.637061436, 0, 554.517744448, 0, 0});
    // Of second order, and no worse than there: the host's frame in the middle of an increment is its own affair.
    const std::vector<std::pair<int, double>> page{{4, 2.35e-2}, {16, 1.50e-3}, {64, 9.35e-5}, {256, 5.85e-6}};
    for (const auto& [n, error] : page) {
        const double found = stress_norm(Layout(Kind::solid), sheared_stress(scene, library(), 2, n) - exact) / 400;
        EXPECT_LT(found, error) << n;
        EXPECT_GT(found, 0.5 * error) << n;
    }
    const Components left = cycled_stress(scene, library(), 0.1, 1000) / 400;
    EXPECT_NEAR(left[0], -2.378e-4, 2e-6);
    EXPECT_NEAR(left[3], 2.193e-4, 2e-6);
}

// Finite-strain laws have no drift and leave nothing: the stress is a function of F.
TEST(Rotation, LeavesNothingInHyperelasticity) {
    for (const lode_model* model : library().models()) {
        if ((model->traits & LODE_FINITE_STRAIN) == 0 || (model->traits & LODE_ELASTIC) == 0) continue;
        const lode_sample& sample = model->samples[0];
        const Scenario scene = sample_scenario(*model, sample, Kind::solid);
        const double stress =
            stress_norm(Layout(Kind::solid), sheared_stress(scene, library(), sample.strain_scale, 4));
        const double virgin = stress_norm(Layout(Kind::solid), sheared_stress(scene, library(), 0, 1));
        if (!(virgin < 1e-12 * stress)) continue;  // no shear stiffness, or a gas under pressure at F = 1
        EXPECT_LT(stress_norm(Layout(Kind::solid), cycled_stress(scene, library(), sample.strain_scale, 4)),
                  1e-11 * stress)
            << model->keyword;
    }
}

// Stress control works just below the strength and ends with status 3 just above it.
void expect_limit_point(const Scenario& scene, double strength, double strain_scale) {
    SCOPED_TRACE(scene.material.name);
    const auto limit = limit_point(scene, library(), strain_scale);
    ASSERT_TRUE(limit);
    EXPECT_NEAR(limit->stress / strength, 1, 1e-3);
    EXPECT_TRUE(reaches(scene, library(), 0.999 * strength));
    std::string message;
    EXPECT_FALSE(reaches(scene, library(), 1.001 * strength, &message));
    EXPECT_NE(message.find("below the smallest allowed"), std::string::npos) << message;
}
TEST(LimitPoint, IsTheStrengthOfASofteningSolid) {
    LODE_NEEDS("ISO_PLASTIC");
    std::vector<double> constants{30000, 0.2, 30, 1, -1500, 3};
    constants.resize(24, 0.0);
    constants[23] = 50;
    for (const Kind kind : {Kind::solid, Kind::plane_stress, Kind::uniaxial})
        expect_limit_point(material("ISO_PLASTIC-X", constants, kind), 30, 3e-3);
}
TEST(LimitPoint, IsTheStrengthOfAnInterface) {
    LODE_NEEDS("COH_TRIANGULAR");
    expect_limit_point(material("COH_TRIANGULAR-X", {100000, 30, 0.3, 50000, 40, 0.9}, Kind::cohesive_2d), 30, 5e-3);
}

// --- constants ----------------------------------------------------------------------------------------------------

// Limits that the pages state by formula: 40 (a law must not create energy), 45 (KU above K), 30 (no snap-back).
TEST(Constants, EndWhereThePagesSay) {
    LODE_NEEDS("COH_TRIANGULAR");
    LODE_NEEDS("PORO_ISO");
    LODE_NEEDS("ISO_SOFTENING");
    struct Limit {
        const char* symbol;
        double lower, upper;  // 0: none
        const char* word;     // in the message
    };
    const auto expect_limits = [](const Scenario& scene, const std::vector<Limit>& limits) {
        SCOPED_TRACE(scene.material.name);
        const lode_model* model = library().model_of(scene.material.name);
        const Muted muted;
        const auto ranges = constant_ranges(scene, *model, library(), 1e-3, nullptr);
        for (const Limit& expected : limits) {
            SCOPED_TRACE(expected.symbol);
            const auto found = std::find_if(ranges.begin(), ranges.end(),
                                            [&](const ConstantRange& r) { return r.symbol == expected.symbol; });
            ASSERT_NE(found, ranges.end());
            for (const auto& [limit, value] :
                 {std::pair(found->lower, expected.lower), {found->upper, expected.upper}}) {
                EXPECT_EQ(limit.limited, value != 0);
                if (value == 0) continue;
                EXPECT_NEAR(limit.value / value, 1, 1e-8);
                EXPECT_NE(limit.message.find(expected.word), std::string::npos) << limit.message;
                EXPECT_TRUE(limit.works);
            }
        }
    };
    const double K = 1e5, strength = 30, toughness = 0.3;
    expect_limits(material("COH_TRIANGULAR-X", {K, strength, toughness, 5e4, 40, 0.9}, Kind::cohesive_2d),
                  {{"K_N", strength * strength / (2 * toughness), 0, "GIC"},
                   {"SIG_N", 0, std::sqrt(2 * K * toughness), "GIC"},
                   {"GIC", strength * strength / (2 * K), 0, "GIC"}});
    const double E = 14400, nu = 0.2, KU = 13000;
    expect_limits(material("PORO_ISO-X", {E, nu, 0.8, KU}), {{"E", 0, 3 * (1 - 2 * nu) * KU, "KU"},
                                                             {"NU", 0, 0.5 - E / (6 * KU), "KU"},
                                                             {"KU", E / (3 * (1 - 2 * nu)), 0, "KU"},
                                                             {"ALPHA", 0, 1, "ALPHA"}});
    // h < 2 GIC C/SIGC^2, C the modulus of constrained compression; h = 1 here.
    const double modulus_ratio = (1 - nu) / ((1 + nu) * (1 - 2 * nu)), GIC = 0.1, SIGC = 3, young = 30000;
    expect_limits(material("ISO_SOFTENING-X", {young, nu, SIGC, 0, 1, GIC, 1, GIC}),
                  {{"E", SIGC * SIGC / (2 * GIC * modulus_ratio), 0, "snap back"},
                   {"SIGC", 0, std::sqrt(2 * GIC * young * modulus_ratio), "snap back"},
                   {"GIC", SIGC * SIGC / (2 * young * modulus_ratio), 0, "snap back"}});
}

// The library takes a material or says why not: whatever it takes can be used up to the limit itself.
TEST(Constants, WorkUpToTheirLimits) {
    int limits = 0;
    for (const lode_model* model : library().models()) {
        const lode_sample& sample = model->samples[0];
        const Kind kind = kinds_of(model->kinds & sample.kinds).front();
        const Muted muted;
        for (const ConstantRange& range :
             constant_ranges(sample_scenario(*model, sample, kind), *model, library(), sample.strain_scale, nullptr))
            for (const ConstantLimit& limit : {range.lower, range.upper}) {
                if (!limit.limited) continue;
                ++limits;
                EXPECT_TRUE(limit.works) << model->keyword << " " << range.symbol << " = " << limit.value;
                EXPECT_NE(limit.message.find(model->keyword), std::string::npos) << limit.message;
            }
    }
    EXPECT_GT(limits, static_cast<int>(library().models().size()));
}

// A deck brings its own constants, element length and kind.
TEST(Atlas, MapsTheMaterialOfADeck) {
    LODE_NEEDS("ISO_SOFTENING");
    const Directory directory;
    directory.write("beam.toml",
                    "[material]\nname = \"ISO_SOFTENING-X\"\nconstants = [30000, 0.2, 3, 0, 1, 0.1, 1, 0.1]\n"
                    "[analysis]\nkind = \"plane_strain\"\nelement_length = 50\n"
                    "[[step]]\nincrements = 20\nstrain = { 11 = 5e-4 }\n");
    const Muted muted;
    AtlasOptions options;
    options.library = LODE_TEST_LIBRARY;
    options.targets = {directory.file("beam.toml")};
    options.maps = {"element_size"};
    options.output_directory = directory.file("");
    options.quiet = true;
    EXPECT_EQ(atlas(options), Status::success);
    std::istringstream csv(directory.read("beam_plane_strain_element_size.csv"));
    std::string header, line;
    std::getline(csv, header);
    int rows = 0;
    while (std::getline(csv, line)) ++rows;
    EXPECT_EQ(rows, 7) << header;
    options.maps = {"constants"};
    EXPECT_EQ(atlas(options), Status::success);
    const double largest = std::sqrt(2 * 0.1 * 30000 * 0.8 / (1.2 * 0.6) / 50);
    const std::string constants = directory.read("beam_plane_strain_constants.csv");
    const std::size_t row = constants.find("3,SIGC,3,upper,");
    ASSERT_NE(row, std::string::npos) << constants;
    EXPECT_NEAR(std::stod(constants.substr(row + 15)) / largest, 1, 1e-8);
}

}  // namespace
}  // namespace lode::host::test
