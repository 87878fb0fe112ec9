// DDSDDE and DDSDDT against the derivative of the very same kernel, and against differences through the entry point.
#include <Eigen/LU>
#include <cmath>
#include <string_view>

#include "property_ad.hpp"
#include "property_suite.hpp"

namespace lode::test {
namespace {

std::vector<DifferentiatedModel>& differentiated_models() {
    static std::vector<DifferentiatedModel> models;
    return models;
}

}  // namespace

bool register_differentiated(const DifferentiatedModel& model) {
    differentiated_models().push_back(model);
    return true;
}
DifferentiateFunction differentiated_kernel(std::string_view keyword, AnalysisKind kind) {
    if (keyword.starts_with("POROUS_")) return differentiated_porous_kernel(kind);
    for (const DifferentiatedModel& model : differentiated_models())
        if (keyword == model.keyword) return model.kernels[static_cast<int>(kind)];
    return nullptr;
}

namespace {

double largest_entry(const Eigen::MatrixXd& a) { return a.cwiseAbs().maxCoeff(); }

// d ln(J)/d strain: what turns d(sigma) into d(J sigma)/J. Laws of small strain have none; a total law none in plane
// stress (page 10, 1.8).
Eigen::RowVectorXd volume_rate(const Case& c, const UmatPoint& point, const Numbers& state,
                               const Eigen::MatrixXd& state_by_strain) {
    Eigen::RowVectorXd rate = Eigen::RowVectorXd::Zero(point.size());
    if (!c.reads_deformation) return rate;
    if (c.kind != AnalysisKind::plane_stress) {
        rate.head(point.normals()).setOnes();
    } else if (c.has_trait(LODE_FINITE_STRAIN)) {
        rate.head(2).setOnes();
        for (int i = 0; i < c.model->state_count; ++i)
            if (std::string_view(c.model->state[i].name) == "F33M1")
                rate += state_by_strain.row(i) / (1.0 + state[static_cast<std::size_t>(i)]);
    }
    return rate;
}

Eigen::Map<const Eigen::VectorXd> vector_of(const Numbers& v) {
    return {v.data(), static_cast<Eigen::Index>(v.size())};
}

class Tangent : public testing::TestWithParam<Case> {
  protected:
    // Calls `check(point, load, answer)` in virgin, loading, unloading and turned states.
    template <class Check>
    static void in_many_states(const Case& c, std::uint64_t seeds, const Check& check) {
        bool dissipated = false;
        for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
            SCOPED_TRACE("seed " + std::to_string(seed));
            Random random(c, seed);
            UmatPoint point = c.point();
            point.temperature(c.temperature() + 20.0);
            if (c.reads_field) point.fields({0.3});
            for (Step& step : random_path(c, random)) {
                if (random.chance(0.3)) step.rotation = random.rotation(c.kind, 0.2);
                Load load = load_of(point, step);
                load.dtemp = random.uniform(-1.0, 1.0);
                const Answer answer = point.evaluate(load);
                if (!answer.done()) {
                    EXPECT_EQ(answer.messages.stops, 0) << answer.first_error();
                    continue;
                }
                check(point, load, answer);
                if (testing::Test::HasFatalFailure()) return;
                point.step(load);
            }
            dissipated = dissipated || point.spd() + point.scd() > 0.0;
        }
        // A check that never left the elastic range would say little.
        EXPECT_TRUE(dissipated || c.has_trait(LODE_ELASTIC | LODE_OPEN_ENERGY)) << "no path was inelastic";
    }

    static void expect_derivative_of_kernel(const Case& c, std::uint64_t seeds);
};

// In as many states of `c` as `seeds` ask for.
void Tangent::expect_derivative_of_kernel(const Case& c, std::uint64_t seeds) {
    const DifferentiateFunction kernel = differentiated_kernel(c.model->keyword, c.kind);
    ASSERT_NE(kernel, nullptr);
    in_many_states(c, seeds, [&](const UmatPoint& point, const Load& load, const Answer& answer) {
        const Differentiated exact = kernel(point, load);
        ASSERT_TRUE(exact.done);
        // The same arithmetic, but compiled differently.
        const double scale = std::max(c.stress_scale(), largest(point.stress()));
        ASSERT_LE(distance(answer.stress, exact.stress), 1e-12 * scale);
        const Eigen::VectorXd stress = vector_of(exact.stress);
        const Eigen::MatrixXd derivative =
            exact.stress_by_strain + stress * volume_rate(c, point, exact.state, exact.state_by_strain);
        ASSERT_LE(largest_entry(answer.tangent - derivative), 1e-9 * largest_entry(derivative))
            << "DDSDDE\n"
            << answer.tangent << "\nderivative\n"
            << derivative;
        ASSERT_LE(largest_entry(vector_of(answer.ddsddt) - exact.stress_by_temperature),
                  1e-9 * std::max(largest_entry(exact.stress_by_temperature), largest(answer.ddsddt)))
            << "DDSDDT " << vector_of(answer.ddsddt).transpose() << "\nderivative "
            << exact.stress_by_temperature.transpose();
    });
}

TEST_P(Tangent, IsTheDerivativeOfTheKernel) { expect_derivative_of_kernel(GetParam(), 8); }

// Whatever the number of substeps of backward Euler, METHOD 2 of plasticity.
TEST_P(Tangent, OfSubstepsIsTheDerivativeOfTheKernel) {
    Case c = GetParam();
    const lode_model& model = *c.model;
    const auto place_of = [&](std::string_view symbol) {
        for (int i = 0; i < model.parameter_count; ++i)
            if (model.parameters[i].symbol == symbol) return static_cast<std::size_t>(i);
        return std::size_t{0};
    };
    const std::size_t method = place_of("METHOD"), substeps = place_of("NSUB");
    if (model.family != std::string_view("plasticity") || method == 0 || substeps == 0) return;
    Numbers constants = c.props();
    for (std::size_t i = constants.size(); i <= std::max(method, substeps); ++i)
        constants.push_back(model.parameters[i].default_value);
    constants[method] = 2.0;
    lode_sample sample = *c.sample;
    sample.constants = constants.data();
    sample.constant_count = static_cast<int>(constants.size());
    c.sample = &sample;
    for (const double number : {1.0, 2.0, 4.0, 37.0}) {
        SCOPED_TRACE("NSUB " + std::to_string(number));
        constants[substeps] = number;
        expect_derivative_of_kernel(c, 4);
        if (HasFatalFailure()) return;
    }
}

// As a host sees it, without any help of the library: central differences. The step is studied because kinks ask for a
// small one and rounding for a large one; the best of them counts.
TEST_P(Tangent, IsTheDifferenceOfTheEntryPoint) {
    const Case& c = GetParam();
    in_many_states(c, 3, [&](const UmatPoint& point, const Load& load, const Answer& answer) {
        const auto n = static_cast<std::size_t>(point.size());
        double best = HUGE_VAL;
        Eigen::MatrixXd closest = answer.tangent;
        for (const double h : {1e-3 * c.scale(), 1e-4 * c.scale(), 1e-5 * c.scale(), 1e-6 * c.scale()}) {
            Eigen::MatrixXd difference(n, n);
            bool done = true;
            for (std::size_t k = 0; k < n && done; ++k) {
                Numbers kirchhoff[2];
                for (const int sign : {0, 1}) {
                    Numbers strain(n, 0.0);
                    strain[k] = sign == 0 ? h : -h;
                    Load perturbed = load;
                    for (std::size_t i = 0; i < n; ++i) perturbed.dstran[i] += strain[i];
                    const Matrix3d d = c.is_cohesive() ? Matrix3d::Zero() : strain_tensor(strain, c.kind);
                    perturbed.dfgrd1 = (Matrix3d::Identity() + d) * *load.dfgrd1;
                    const Answer a = point.evaluate(perturbed);
                    done = done && a.done();
                    double j = jacobian(c, a.state, *perturbed.dfgrd1);
                    if (c.is_total_law() && c.kind != AnalysisKind::plane_stress) j = perturbed.dfgrd1->determinant();
                    kirchhoff[sign] = scaled(a.stress, j);
                }
                for (std::size_t i = 0; i < n; ++i)
                    difference(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) =
                        (kirchhoff[0][i] - kirchhoff[1][i]) / (2.0 * h);
            }
            if (!done) continue;
            double j = jacobian(c, answer.state, *load.dfgrd1);
            if (c.is_total_law() && c.kind != AnalysisKind::plane_stress) j = load.dfgrd1->determinant();
            difference /= j;
            const double error = largest_entry(difference - answer.tangent);
            if (error < best) {
                best = error;
                closest = difference;
            }
        }
        ASSERT_LE(best, 1e-6 * std::max(largest_entry(answer.tangent), 1e-3 * c.stiffness))
            << "DDSDDE\n"
            << answer.tangent << "\ndifferences\n"
            << closest;
    });
}

// RPL has its own derivatives: DRPLDE and DRPLDT against differences, the best of several steps.
TEST_P(Tangent, HeatFollowsItsDerivatives) {
    const Case& c = GetParam();
    in_many_states(c, 3, [&](const UmatPoint& point, const Load& load, const Answer& answer) {
        const auto n = static_cast<std::size_t>(point.size());
        // The slope of RPL towards a load, by central differences.
        const auto slope = [&](const auto& perturbed, double given) {
            double best = HUGE_VAL;
            for (const double h : {1e-2, 1e-3, 1e-4, 1e-5}) {
                const Answer ahead = point.evaluate(perturbed(h)), back = point.evaluate(perturbed(-h));
                if (!ahead.done() || !back.done()) continue;
                const double found = (ahead.rpl - back.rpl) / (2.0 * h);
                if (std::abs(found - given) < std::abs(best - given)) best = found;
            }
            return best;
        };
        const double stress = std::max(largest(point.stress()), 1e-3 * c.stress_scale());
        for (std::size_t k = 0; k < n; ++k) {
            const double given = answer.drplde[k] * c.scale();
            const auto along = [&](double h) {
                Load perturbed = load;
                perturbed.dstran[k] += h * c.scale();
                Numbers strain(n, 0.0);
                strain[k] = h * c.scale();
                const Matrix3d d = c.is_cohesive() ? Matrix3d::Zero() : strain_tensor(strain, c.kind);
                perturbed.dfgrd1 = (Matrix3d::Identity() + d) * *load.dfgrd1;
                return perturbed;
            };
            ASSERT_NEAR(slope(along, given), given, 1e-6 * (std::abs(given) + stress * c.scale()))
                << "DRPLDE " << k + 1;
        }
        const auto hotter = [&](double h) {
            Load perturbed = load;
            perturbed.dtemp += h;
            return perturbed;
        };
        ASSERT_NEAR(slope(hotter, answer.drpldt), answer.drpldt, 1e-6 * (std::abs(answer.drpldt) + stress * c.scale()))
            << "DRPLDT";
    });
}

TEST_P(Tangent, IsSymmetricUnlessSaidOtherwise) {
    const Case& c = GetParam();
    if (c.has_trait(LODE_UNSYMMETRIC) || c.is_total_law()) return;
    in_many_states(c, 4, [&](const UmatPoint&, const Load&, const Answer& answer) {
        ASSERT_LE(largest_entry(answer.tangent - answer.tangent.transpose()), 1e-12 * largest_entry(answer.tangent));
    });
}

LODE_FOR_ALL_CASES(Tangent);

}  // namespace
}  // namespace lode::test
