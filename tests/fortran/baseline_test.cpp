// The Fortran baselines of bench/ are what the library is measured against, so they must be right: closed forms,
// tangents against differences, and all forms of one model against each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "abi.hpp"

namespace {

using Vector = std::array<double, 6>;

struct Result {
    Vector stress;
    double state = 0, sse = 0, spd = 0;
    std::array<double, 36> tangent{};
};

std::array<char, LODE_CMNAME_LENGTH> cmname(const std::string& name) {
    std::array<char, LODE_CMNAME_LENGTH> text;
    text.fill(' ');
    std::copy(name.begin(), name.end(), text.begin());
    return text;
}

constexpr std::array<double, 9> identity = {1, 0, 0, 0, 1, 0, 0, 0, 1};

Result call(lode_umat_function* umat, const std::vector<double>& props, const Vector& stress, double state,
            const Vector& dstran, const std::array<double, 9>& f = identity) {
    Result r;
    r.stress = stress;
    r.state = state;
    double scd = 0, rpl = 0, drpldt = 0, pnewdt = 1;
    Vector ddsddt{}, drplde{};
    const Vector stran{};
    const double time[2] = {1, 1}, dtime = 1, temp = 0, dtemp = 0, none[1] = {0}, coords[3] = {}, celent = 1;
    const int ndi = 3, nshr = 3, ntens = 6, nstatv = 1, nprops = static_cast<int>(props.size()), one = 1;
    const int jstep[4] = {1, 1, 0, 0};
    const auto name = cmname("BASELINE");
    umat(r.stress.data(), &r.state, r.tangent.data(), &r.sse, &r.spd, &scd, &rpl, ddsddt.data(), drplde.data(), &drpldt,
         stran.data(), dstran.data(), time, &dtime, &temp, &dtemp, none, none, name.data(), &ndi, &nshr, &ntens,
         &nstatv, props.data(), &nprops, coords, identity.data(), &pnewdt, &celent, identity.data(), f.data(), &one,
         &one, &one, &one, jstep, &one, name.size());
    EXPECT_EQ(pnewdt, 1);
    return r;
}

double mises(const Vector& s) {
    const double a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];
    return std::sqrt(0.5 * (a * a + b * b + c * c) + 3 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

struct Case {
    const char* name;
    lode_umat_function* umat;
    std::vector<double> props;
    friend void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }
};
const std::vector<double> linear = {200000, 0.3, 400, 2000}, voce = {200000, 0.3, 400, 150, 20, 500};
double flow_stress(const std::vector<double>& p, double alpha) {
    return p.size() == 4 ? p[2] + p[3] * alpha : p[2] + p[3] * (1 - std::exp(-p[4] * alpha)) + p[5] * alpha;
}

class Plastic : public ::testing::TestWithParam<Case> {};

TEST_P(Plastic, ShearFollowsTheFlowCurve) {
    const auto& [name, umat, props] = GetParam();
    const double shear = props[0] / (2 * (1 + props[1]));
    const Result r = call(umat, props, {}, 0, {0, 0, 0, 0.02, 0, 0});
    const double q = std::sqrt(3.0) * r.stress[3];
    EXPECT_NEAR(q, flow_stress(props, r.state), 1e-9);
    EXPECT_NEAR(q, std::sqrt(3.0) * shear * 0.02 - 3 * shear * r.state, 1e-9);
    EXPECT_GT(r.state, 0.005);
}

TEST_P(Plastic, TangentIsTheDerivative) {
    const auto& [name, umat, props] = GetParam();
    const Vector start = {150, -60, 20, 90, -40, 70}, de = {4e-3, -2e-3, 1e-3, 3e-3, -5e-3, 2e-3};
    const Result r = call(umat, props, start, 0.01, de);
    EXPECT_GT(r.state, 0.01);
    EXPECT_NEAR(mises(r.stress), flow_stress(props, r.state), 1e-9);
    const double h = 1e-7;
    for (std::size_t j = 0; j < 6; ++j) {
        Vector plus = de, minus = de;
        plus[j] += h;
        minus[j] -= h;
        const Result a = call(umat, props, start, 0.01, plus), b = call(umat, props, start, 0.01, minus);
        for (std::size_t i = 0; i < 6; ++i)
            EXPECT_NEAR(r.tangent[i + 6 * j], (a.stress[i] - b.stress[i]) / (2 * h), 1e-6 * 2e5) << i << j;
    }
}

TEST_P(Plastic, EnergyIsTheWork) {
    const auto& [name, umat, props] = GetParam();
    const Vector start = {150, -60, 20, 90, -40, 70}, de = {4e-3, -2e-3, 1e-3, 3e-3, -5e-3, 2e-3};
    const Result r = call(umat, props, start, 0.01, de);
    double work = 0;
    for (std::size_t i = 0; i < 6; ++i) work += 0.5 * (start[i] + r.stress[i]) * de[i];
    EXPECT_NEAR(r.sse + r.spd, work, 1e-12 * std::abs(work));
    const double mean_flow = 0.5 * (flow_stress(props, 0.01) + flow_stress(props, r.state));
    EXPECT_NEAR(r.spd, mean_flow * (r.state - 0.01), 1e-12 * r.spd);
}

TEST_P(Plastic, ElasticBelowTheYieldStress) {
    const auto& [name, umat, props] = GetParam();
    const Vector de = {1e-4, -2e-4, 3e-5, 1e-4, 0, -1e-4};
    const Result r = call(umat, props, {}, 0, de), e = call(baseline_umat_elastic_, props, {}, 0, de);
    EXPECT_EQ(r.state, 0);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(r.stress[i], e.stress[i], 1e-12);
    for (std::size_t i = 0; i < 36; ++i) EXPECT_NEAR(r.tangent[i], e.tangent[i], 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Baseline, Plastic,
                         ::testing::Values(Case{"J2", baseline_umat_j2_, linear},
                                           Case{"J2Usual", baseline_umat_j2_usual_, linear},
                                           Case{"J2Voce", baseline_umat_j2_voce_, voce}));

TEST(BaselineElastic, UniaxialStrain) {
    const Result r = call(baseline_umat_elastic_, {200000, 0.3}, {}, 0, {1e-3, 0, 0, 0, 0, 2e-3});
    const double lambda = 200000 * 0.3 / (1.3 * 0.4), shear = 200000 / 2.6;
    EXPECT_NEAR(r.stress[0], (lambda + 2 * shear) * 1e-3, 1e-10);
    EXPECT_NEAR(r.stress[1], lambda * 1e-3, 1e-10);
    EXPECT_NEAR(r.stress[5], shear * 2e-3, 1e-10);
    EXPECT_NEAR(r.tangent[0], lambda + 2 * shear, 1e-9);
    EXPECT_NEAR(r.tangent[1], lambda, 1e-9);
    EXPECT_NEAR(r.tangent[35], shear, 1e-9);
    EXPECT_NEAR(r.sse, 0.5 * (r.stress[0] * 1e-3 + r.stress[5] * 2e-3), 1e-12);
}

// Stress of simple shear and the Jaumann tangent over J (page 50, check of a tangent).
TEST(BaselineNeoHooke, ShearAndTangent) {
    const std::vector<double> props = {2, 7};
    std::array<double, 9> shear = identity;
    shear[3] = 0.4;
    const Result simple = call(baseline_umat_neo_hooke_, props, {}, 0, {}, shear);
    EXPECT_NEAR(simple.stress[0], 2 * 0.16, 1e-14);
    EXPECT_NEAR(simple.stress[3], 2 * 0.4, 1e-14);
    EXPECT_NEAR(simple.sse, 0.5 * 2 * 0.16, 1e-14);

    const std::array<double, 9> f = {1.3, 0.15, -0.3, 0.2, 0.85, 0.1, -0.1, 0.25, 1.1};  // column major
    const auto det = [](const std::array<double, 9>& a) {
        return a[0] * (a[4] * a[8] - a[7] * a[5]) - a[3] * (a[1] * a[8] - a[7] * a[2]) +
               a[6] * (a[1] * a[5] - a[4] * a[2]);
    };
    const Result r = call(baseline_umat_neo_hooke_, props, {}, 0, {}, f);
    constexpr std::size_t pair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
    const double h = 1e-6;
    for (std::size_t c = 0; c < 6; ++c) {
        const auto perturbed = [&](double step) {
            std::array<double, 9> l = identity, g{};
            l[pair[c][0] + 3 * pair[c][1]] += 0.5 * step;
            l[pair[c][1] + 3 * pair[c][0]] += 0.5 * step;
            for (std::size_t i = 0; i < 3; ++i)
                for (std::size_t j = 0; j < 3; ++j)
                    for (std::size_t k = 0; k < 3; ++k) g[i + 3 * j] += l[i + 3 * k] * f[k + 3 * j];
            return g;
        };
        const auto plus = perturbed(h), minus = perturbed(-h);
        const Result a = call(baseline_umat_neo_hooke_, props, {}, 0, {}, plus);
        const Result b = call(baseline_umat_neo_hooke_, props, {}, 0, {}, minus);
        for (std::size_t i = 0; i < 6; ++i)
            EXPECT_NEAR(r.tangent[i + 6 * c], (det(plus) * a.stress[i] - det(minus) * b.stress[i]) / (2 * h * det(f)),
                        1e-8 * 20)
                << i << c;
    }
}

constexpr int block = 19;  // not a multiple of any vector length
struct Block {
    std::vector<double> stress, state, intern, inelas;
};

Block call(lode_vumat_function* vumat, const std::vector<double>& props, std::vector<double> strain, const Block& old) {
    Block r = old;
    const std::vector<double> zero(9 * block, 0.0), density(block, 2.5);
    const double time = 1, dt = 1e-3;
    const int n = block, ndir = 3, nshr = 3, nstatev = 1, none = 0, nprops = static_cast<int>(props.size());
    const auto name = cmname("BASELINE");
    vumat(&n, &ndir, &nshr, &nstatev, &none, &nprops, &none, &time, &time, &dt, name.data(), zero.data(), zero.data(),
          props.data(), density.data(), strain.data(), zero.data(), zero.data(), zero.data(), zero.data(), zero.data(),
          old.stress.data(), old.state.data(), old.intern.data(), old.inelas.data(), zero.data(), zero.data(),
          zero.data(), zero.data(), r.stress.data(), r.state.data(), r.intern.data(), r.inelas.data(), name.size());
    return r;
}

// Point by point the explicit forms give what the UMAT gives; shears change place and size.
void expect_vumat_equals_umat(lode_vumat_function* vumat, lode_umat_function* umat, const std::vector<double>& props,
                              bool inelastic) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    Block old{std::vector<double>(6 * block), std::vector<double>(block), std::vector<double>(block),
              std::vector<double>(block)};
    std::vector<double> strain(6 * block);
    for (double& x : strain) x = 5e-3 * uniform(random);
    for (double& x : old.stress) x = 150 * uniform(random);
    for (double& x : old.state) x = 0.01 * (1 + uniform(random));
    for (double& x : old.intern) x = uniform(random);
    for (std::size_t c = 0; c < 6; ++c) strain[block * c] = old.stress[block * c] = 0;  // point 0 rests
    const Block result = call(vumat, props, strain, old);
    constexpr std::size_t umat_place[6] = {0, 1, 2, 3, 5, 4};
    int plastic = 0;
    for (std::size_t k = 0; k < block; ++k) {
        Vector stress{}, de{};
        for (std::size_t c = 0; c < 6; ++c) {
            stress[umat_place[c]] = old.stress[k + block * c];
            de[umat_place[c]] = (c < 3 ? 1 : 2) * strain[k + block * c];
        }
        const Result r = call(umat, props, stress, old.state[k], de);
        for (std::size_t c = 0; c < 6; ++c)
            EXPECT_NEAR(result.stress[k + block * c], r.stress[umat_place[c]], 1e-10) << "point " << k;
        EXPECT_NEAR(result.state[k], r.state, 1e-15);
        EXPECT_NEAR(result.intern[k], old.intern[k] + (r.sse + r.spd) / 2.5, 1e-12);
        EXPECT_NEAR(result.inelas[k], r.spd / 2.5, 1e-12);
        plastic += r.state > old.state[k];
    }
    EXPECT_EQ(plastic > block / 2, inelastic);
}

TEST(BaselineVumat, ElasticEqualsUmat) {
    expect_vumat_equals_umat(baseline_vumat_elastic_, baseline_umat_elastic_, {200000, 0.3}, false);
}
TEST(BaselineVumat, UsualFormEqualsUmat) {
    expect_vumat_equals_umat(baseline_vumat_j2_, baseline_umat_j2_, linear, true);
}
TEST(BaselineVumat, VectorisedFormEqualsUmat) {
    expect_vumat_equals_umat(baseline_vumat_j2_simd_, baseline_umat_j2_, linear, true);
}

}  // namespace
