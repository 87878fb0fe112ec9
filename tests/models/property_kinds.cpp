// A plane or one-dimensional kind is the solid with constraints: the same increments in 3D, with the strains that the
// kind leaves free iterated until their stresses vanish, give the same answer.
#include <Eigen/LU>
#include <cmath>

#include "property_suite.hpp"

namespace lode::test {
namespace {

// Where component i of a kind stands among those of the solid.
int solid_component(AnalysisKind kind, int i) {
    return i < normal_components(kind) ? i : i - normal_components(kind) + 3;
}

// The normal components of the solid whose stress is zero in the kind.
std::vector<int> free_components(AnalysisKind kind) {
    if (kind == AnalysisKind::plane_stress) return {2};
    if (kind == AnalysisKind::uniaxial) return {1, 2};
    return {};
}

class Kinds : public testing::TestWithParam<Case> {};

TEST_P(Kinds, AreTheConstrainedSolid) {
    const Case& c = GetParam();
    const Case* solid = find_case(c, AnalysisKind::solid);
    if (c.kind == AnalysisKind::solid || c.is_cohesive() || solid == nullptr) return;
    if (c.reads_deformation != solid->reads_deformation) return;  // an option that this kind ignores
    const std::vector<int> free = free_components(c.kind);
    int compared = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(c, seed);
        UmatPoint plane = c.point(), full = solid->point();
        double previous[3] = {0.0, 0.0, 0.0};
        for (const Step& step : random_path(c, random)) {
            Step in_3d{Numbers(6, 0.0), step.rotation};
            for (int i = 0; i < plane.size(); ++i)
                in_3d.strain[static_cast<std::size_t>(solid_component(c.kind, i))] =
                    step.strain[static_cast<std::size_t>(i)];
            for (const int i : free) in_3d.strain[static_cast<std::size_t>(i)] = previous[i];
            Answer answer;
            double residual = 0.0;
            for (int iteration = 0; iteration < 60; ++iteration) {
                answer = full.evaluate(load_of(full, in_3d));
                if (!answer.done() || free.empty()) break;
                const auto size = static_cast<Eigen::Index>(free.size());
                Eigen::VectorXd r(size);
                Eigen::MatrixXd k(size, size);
                for (Eigen::Index a = 0; a < size; ++a) {
                    const int i = free[static_cast<std::size_t>(a)];
                    r(a) = answer.stress[static_cast<std::size_t>(i)];
                    for (Eigen::Index b = 0; b < size; ++b)
                        k(a, b) = answer.tangent(i, free[static_cast<std::size_t>(b)]);
                }
                residual = r.cwiseAbs().maxCoeff();
                if (residual <= 1e-14 * c.stress_scale()) break;
                const Eigen::VectorXd change = k.partialPivLu().solve(r);
                for (Eigen::Index a = 0; a < size; ++a)
                    in_3d.strain[static_cast<std::size_t>(free[static_cast<std::size_t>(a)])] -= change(a);
            }
            const Answer flat = plane.step(load_of(plane, step));
            if (!flat.done() || !answer.done()) break;
            if (residual > 1e-10 * c.stress_scale()) break;  // this search is not the one under test
            full.step(load_of(full, in_3d));
            for (const int i : free) previous[i] = 0.0;
            ++compared;
            Numbers seen(flat.stress.size());
            for (int i = 0; i < plane.size(); ++i)
                seen[static_cast<std::size_t>(i)] = full.stress()[static_cast<std::size_t>(solid_component(c.kind, i))];
            // The local equations are solved to 1e-13 of the trial stress, the search above to the residual.
            const double scale = std::max({c.stress_scale(), largest(seen), c.stiffness * largest(step.strain)});
            ASSERT_LE(distance(flat.stress, seen), 1e-11 * scale + 10.0 * residual) << "increment " << compared;
            ASSERT_NEAR(plane.sse(), full.sse(), 1e-10 * scale * c.scale());
            ASSERT_NEAR(plane.spd(), full.spd(), 1e-10 * scale * c.scale());
            ASSERT_NEAR(plane.scd(), full.scd(), 1e-10 * scale * c.scale());
        }
    }
    EXPECT_GE(compared, 80);
}

LODE_FOR_ALL_CASES(Kinds);

}  // namespace
}  // namespace lode::test
