// The Abaqus utility routines against closed forms, called by their Fortran symbol names.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <numbers>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "utility_host.h"

extern "C" {
void sinv_(const double*, double*, double*, const int*, const int*);
void sprinc_(const double*, double*, const int*, const int*, const int*);
void sprind_(const double*, double*, double*, const int*, const int*, const int*);
void rotsig_(const double*, const double*, double*, const int*, const int*, const int*);
void vsprinc_(const int*, const void*, void*, const int*, const int*);
void vsprind_(const int*, const void*, void*, void*, const int*, const int*);
void xit_();
void xplb_exit_();
void stdb_abqerr_(const int*, const char*, const int*, const double*, const char*, std::size_t, std::size_t);
void xplb_abqerr_(const int*, const char*, const int*, const void*, const char*, std::size_t, std::size_t);
void getjobname_(char*, int*, std::size_t);
void vgetjobname_(char*, int*, std::size_t);
void getoutdir_(char*, int*, std::size_t);
void vgetoutdir_(char*, int*, std::size_t);
void getrank_(int*);
void vgetrank_(int*);
void getnumcpus_(int*);
void vgetnumcpus_(int*);
int getnumthreads_();
int get_thread_id_();
void mutexinit_(const int*);
void mutexlock_(const int*);
void mutexunlock_(const int*);
}

namespace {

using Matrix3 = std::array<std::array<double, 3>, 3>;
constexpr int stress = 1, strain = 2;
constexpr double eps = 2.2204460492503131e-16;

struct Layout {
    int ndi, nshr;
    std::size_t size() const { return static_cast<std::size_t>(ndi + nshr); }
};
constexpr Layout all_layouts[] = {{3, 3}, {3, 2}, {3, 1}, {3, 0}, {2, 1}, {2, 0}, {1, 2}, {1, 1}, {1, 0}, {2, 3}};

// Components in UMAT order -> tensor, written out independently of the routine under test.
Matrix3 tensor(const std::vector<double>& s, Layout n, int lstr) {
    const double factor = lstr == strain ? 0.5 : 1.0;
    Matrix3 a{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(n.ndi); ++i) a[i][i] = s[i];
    const auto shear = [&](int k) { return n.nshr > k ? factor * s[static_cast<std::size_t>(n.ndi + k)] : 0.0; };
    a[0][1] = a[1][0] = shear(0);
    a[0][2] = a[2][0] = shear(1);
    a[1][2] = a[2][1] = shear(2);
    return a;
}

double magnitude(const Matrix3& a) {
    double m = 0;
    for (const auto& row : a)
        for (double x : row) m = std::max(m, std::abs(x));
    return m;
}

void expect_principal(const Matrix3& a, const double* value, const double* direction, const std::string& what) {
    const double scale = magnitude(a);
    EXPECT_GE(value[0], value[1]) << what;
    EXPECT_GE(value[1], value[2]) << what;
    const auto d = [&](std::size_t i, std::size_t j) { return direction[i + 3 * j]; };
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            double ad = 0, dot = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                ad += a[j][k] * d(i, k);
                dot += d(i, k) * d(j, k);
            }
            EXPECT_NEAR(ad, value[i] * d(i, j), 20 * eps * scale) << what << ": A d = lambda d, i = " << i;
            EXPECT_NEAR(dot, i == j ? 1.0 : 0.0, 10 * eps) << what << ": orthonormal " << i << j;
        }
    }
    const double triple = d(0, 0) * (d(1, 1) * d(2, 2) - d(1, 2) * d(2, 1)) +
                          d(0, 1) * (d(1, 2) * d(2, 0) - d(1, 0) * d(2, 2)) +
                          d(0, 2) * (d(1, 0) * d(2, 1) - d(1, 1) * d(2, 0));
    EXPECT_NEAR(triple, 1.0, 20 * eps) << what << ": right-handed";
}

std::array<double, 9> rotation(double ax, double ay, double az, double angle) {  // column major
    const double n = std::sqrt(ax * ax + ay * ay + az * az);
    const double u[3] = {ax / n, ay / n, az / n};
    const double c = std::cos(angle), s = std::sin(angle);
    std::array<double, 9> r{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) r[i + 3 * j] = (1 - c) * u[i] * u[j] + (i == j ? c : 0.0);
    r[0 + 3 * 1] -= s * u[2];
    r[1 + 3 * 0] += s * u[2];
    r[0 + 3 * 2] += s * u[1];
    r[2 + 3 * 0] -= s * u[1];
    r[1 + 3 * 2] -= s * u[0];
    r[2 + 3 * 1] += s * u[0];
    return r;
}

TEST(Sinv, ClosedForms) {
    const auto check = [](std::vector<double> s, Layout n, double mean, double mises) {
        double sinv1 = 0, sinv2 = 0;
        sinv_(s.data(), &sinv1, &sinv2, &n.ndi, &n.nshr);
        EXPECT_NEAR(sinv1, mean, 1e-14 * (1 + std::abs(mean)));
        EXPECT_NEAR(sinv2, mises, 1e-14 * (1 + std::abs(mises)));
    };
    check({300, 0, 0, 0, 0, 0}, {3, 3}, 100, 300);                  // uniaxial
    check({-5, -5, -5, 0, 0, 0}, {3, 3}, -5, 0);                    // hydrostatic
    check({0, 0, 0, 7, 0, 0}, {3, 3}, 0, 7 * std::numbers::sqrt3);  // shear in each plane
    check({0, 0, 0, 0, 7, 0}, {3, 3}, 0, 7 * std::numbers::sqrt3);  //
    check({0, 0, 0, 0, 0, 7}, {3, 3}, 0, 7 * std::numbers::sqrt3);  //
    check({10, 4, -2, 3}, {3, 1}, 4, std::sqrt(108.0 + 27.0));      // plane strain
    check({10, 4, 3}, {2, 1}, 14.0 / 3.0, std::sqrt(76.0 + 27.0));  // plane stress
    check({-6}, {1, 0}, -2, 6);                                     // 1D
    check({1e9 + 3, 1e9, 1e9, 0, 0, 0}, {3, 3}, 1e9 + 1, 3);        // no cancellation
}

TEST(Sprinc, PlaneStressMohrCircle) {
    const Layout n{2, 1};
    const double s[3] = {50, -10, 40};
    double ps[3];
    sprinc_(s, ps, &stress, &n.ndi, &n.nshr);
    EXPECT_NEAR(ps[0], 20 + 50, 1e-13);
    EXPECT_NEAR(ps[1], 0, 1e-13);
    EXPECT_NEAR(ps[2], 20 - 50, 1e-13);
}

TEST(Sprinc, StrainShearsAreEngineering) {
    const Layout n{3, 3};
    const double gamma = 0.02, e[6] = {0, 0, 0, 0, gamma, 0};
    double ps[3];
    sprinc_(e, ps, &strain, &n.ndi, &n.nshr);
    EXPECT_NEAR(ps[0], gamma / 2, 1e-17);
    EXPECT_NEAR(ps[1], 0, 1e-17);
    EXPECT_NEAR(ps[2], -gamma / 2, 1e-17);
    sprinc_(e, ps, &stress, &n.ndi, &n.nshr);
    EXPECT_NEAR(ps[0], gamma, 1e-17);
}

TEST(Sprind, EveryLayoutAndBothKindsOfShear) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-100, 100);
    for (const Layout n : all_layouts)
        for (const int lstr : {stress, strain})
            for (int repeat = 0; repeat < 20; ++repeat) {
                std::vector<double> s(n.size());
                for (double& x : s) x = uniform(random);
                double ps[3], an[9], values[3];
                sprind_(s.data(), ps, an, &lstr, &n.ndi, &n.nshr);
                const std::string what = std::to_string(n.ndi) + "," + std::to_string(n.nshr);
                expect_principal(tensor(s, n, lstr), ps, an, what);
                sprinc_(s.data(), values, &lstr, &n.ndi, &n.nshr);
                for (int i = 0; i < 3; ++i) EXPECT_EQ(values[i], ps[i]) << what;
            }
}

TEST(Sprind, CloseAndEqualPrincipalValues) {
    const auto r = rotation(1, 2, 3, 0.7);
    const Layout n{3, 3};
    for (const double gap : {0.0, 1e-16, 1e-12, 1e-8, 1e-4})
        for (const auto& principal : {std::array<double, 3>{1.0 + gap, 1.0, 1.0},
                                      {1.0 + gap, 1.0, -2.0},
                                      {3.0, 1.0 + gap, 1.0},
                                      {1.0 + 2 * gap, 1.0 + gap, 1.0}}) {
            const double diagonal[6] = {principal[0], principal[1], principal[2], 0, 0, 0};
            std::vector<double> s(6);
            rotsig_(diagonal, r.data(), s.data(), &stress, &n.ndi, &n.nshr);
            double ps[3], an[9];
            sprind_(s.data(), ps, an, &stress, &n.ndi, &n.nshr);
            expect_principal(tensor(s, n, stress), ps, an, "gap " + std::to_string(gap));
            for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(ps[i], principal[i], 8 * eps * 3);
        }
}

TEST(Sprind, ExtremeMagnitudes) {
    const Layout n{3, 3};
    for (const double scale : {1e-150, 1.0, 1e150}) {
        const std::vector<double> s = {2 * scale, -scale, 3 * scale, 0.5 * scale, -0.2 * scale, scale};
        double ps[3], an[9];
        sprind_(s.data(), ps, an, &stress, &n.ndi, &n.nshr);
        expect_principal(tensor(s, n, stress), ps, an, "scale");
    }
    const std::vector<double> zero(6, 0.0);
    double ps[3], an[9];
    sprind_(zero.data(), ps, an, &stress, &n.ndi, &n.nshr);
    expect_principal(tensor(zero, n, stress), ps, an, "zero");
}

TEST(Rotsig, QuarterTurnAboutEachAxis) {
    const Layout n{3, 3};
    const double s[6] = {1, 2, 3, 4, 5, 6};
    const auto expect = [&](const std::array<double, 9>& r, const std::array<double, 6>& expected) {
        double result[6];
        rotsig_(s, r.data(), result, &stress, &n.ndi, &n.nshr);
        for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(result[i], expected[i], 1e-14) << "component " << i;
    };
    const double quarter = std::numbers::pi / 2;
    expect(rotation(0, 0, 1, quarter), {2, 1, 3, -4, -6, 5});  // x -> y, y -> -x
    expect(rotation(1, 0, 0, quarter), {1, 3, 2, -5, 4, -6});  // y -> z, z -> -y
    expect(rotation(0, 1, 0, quarter), {3, 2, 1, 6, -5, -4});  // z -> x, x -> -z
}

TEST(Rotsig, InvariantsInverseAndStrainConvention) {
    const auto r = rotation(-1, 2, 0.5, 1.1);
    std::array<double, 9> inverse{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) inverse[i + 3 * j] = r[j + 3 * i];
    const Layout n{3, 3};
    const double s[6] = {10, -4, 7, 3, -2, 5};
    double turned[6], back[6], before[3], after[3];
    rotsig_(s, r.data(), turned, &stress, &n.ndi, &n.nshr);
    EXPECT_GT(std::abs(turned[0] - s[0]), 1.0);
    rotsig_(turned, inverse.data(), back, &stress, &n.ndi, &n.nshr);
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(back[i], s[i], 1e-14);
    sprinc_(s, before, &stress, &n.ndi, &n.nshr);
    sprinc_(turned, after, &stress, &n.ndi, &n.nshr);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(before[i], after[i], 1e-13);

    // A strain with doubled shears turns into the doubled shears of the same tensor.
    const double e[6] = {10, -4, 7, 6, -4, 10};
    double turned_strain[6];
    rotsig_(e, r.data(), turned_strain, &strain, &n.ndi, &n.nshr);
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(turned_strain[i], (i < 3 ? 1 : 2) * turned[i], 1e-14);
}

TEST(Rotsig, PlaneLayoutsAndInPlace) {
    const auto r = rotation(0, 0, 1, std::numbers::pi / 4);
    const Layout plane_strain{3, 1}, plane_stress{2, 1};
    double s4[4] = {6, 2, 9, 1}, s3[3] = {6, 2, 1};
    rotsig_(s4, r.data(), s4, &stress, &plane_strain.ndi, &plane_strain.nshr);
    rotsig_(s3, r.data(), s3, &stress, &plane_stress.ndi, &plane_stress.nshr);
    const double expected[4] = {3, 5, 9, 2};  // mean -+ shear; half the difference
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(s4[i], expected[i], 1e-14);
    EXPECT_NEAR(s3[0], 3, 1e-14);
    EXPECT_NEAR(s3[1], 5, 1e-14);
    EXPECT_NEAR(s3[2], 2, 1e-14);
}

template <class Real>
void check_block(double tolerance) {
    constexpr int block = 5, ndir = 3, nshr = 3;
    std::mt19937 random(2);
    std::uniform_real_distribution<double> uniform(-10, 10);
    std::vector<Real> t(block * 6), value(block * 3), value_only(block * 3), vector(block * 9);
    for (Real& x : t) x = static_cast<Real>(uniform(random));
    lode_utility_set_explicit_real(sizeof(Real));
    vsprind_(&block, t.data(), value.data(), vector.data(), &ndir, &nshr);
    vsprinc_(&block, t.data(), value_only.data(), &ndir, &nshr);
    lode_utility_set_explicit_real(sizeof(double));
    EXPECT_EQ(value, value_only);
    for (std::size_t k = 0; k < block; ++k) {
        const auto at = [&](std::size_t c) { return static_cast<double>(t[k + block * c]); };
        const double a[3][3] = {{at(0), at(3), at(5)}, {at(3), at(1), at(4)}, {at(5), at(4), at(2)}};
        for (std::size_t i = 0; i < 3; ++i) {
            double norm = 0;
            for (std::size_t j = 0; j < 3; ++j) {
                double ad = 0;
                for (std::size_t m = 0; m < 3; ++m)
                    ad += a[j][m] * static_cast<double>(vector[k + block * (i + 3 * m)]);
                const double d = static_cast<double>(vector[k + block * (i + 3 * j)]);
                EXPECT_NEAR(ad, static_cast<double>(value[k + block * i]) * d, tolerance);
                norm += d * d;
            }
            EXPECT_NEAR(norm, 1, tolerance);
        }
        EXPECT_GE(value[k], value[k + block]);
        EXPECT_GE(value[k + block], value[k + 2 * block]);
    }
}

TEST(Vsprind, DoubleBlock) { check_block<double>(1e-13); }
TEST(Vsprind, SingleBlock) { check_block<float>(1e-5); }

TEST(Vsprinc, PlaneBlockUsesTensorShear) {
    constexpr int block = 2, ndir = 3, nshr = 1;
    const double t[block * 4] = {0, 50, 0, -10, 0, 5, 0.25, 40};
    double value[block * 3];
    vsprinc_(&block, t, value, &ndir, &nshr);
    const double expected[block * 3] = {0.25, 70, 0, 5, -0.25, -30};
    for (int i = 0; i < block * 3; ++i) EXPECT_NEAR(value[i], expected[i], 1e-13);
}

struct Ended {};
std::vector<std::pair<int, std::string>> messages;

class Messages : public ::testing::Test {
  protected:
    void SetUp() override {
        messages.clear();
        lode_utility_on_message([](int severity, const char* text) { messages.emplace_back(severity, text); });
        lode_utility_on_exit([] { throw Ended{}; });
    }
    void TearDown() override {
        lode_utility_on_message(nullptr);
        lode_utility_on_exit(nullptr);
    }
    static void say(int lop, const std::string& text) {
        const int intv[] = {12, -7};
        const double realv[] = {0.5, -1.25e10};
        const char charv[] = "STEEL   COPPER12";
        stdb_abqerr_(&lop, text.c_str(), intv, realv, charv, text.size(), 8);
    }
};

TEST_F(Messages, ExpandsTheArraysInOrder) {
    say(-1, "%S at %I: %R of %R in %S, %I   ");
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_EQ(messages[0].first, -1);
    EXPECT_EQ(messages[0].second, "STEEL at 12: 0.5 of -1.25e+10 in COPPER12, -7");
}

TEST_F(Messages, OtherPercentSignsStay) {
    say(1, "100 % of %I %");
    EXPECT_EQ(messages.at(0).second, "100 % of 12 %");
}

TEST_F(Messages, OnlyTheFatalOneEndsTheAnalysis) {
    EXPECT_NO_THROW(say(1, "note"));
    EXPECT_NO_THROW(say(-1, "warning"));
    EXPECT_NO_THROW(say(-2, "error"));
    EXPECT_THROW(say(-3, "fatal"), Ended);
    ASSERT_EQ(messages.size(), 4u);
    EXPECT_EQ(messages[3], (std::pair<int, std::string>{-3, "fatal"}));
}

TEST_F(Messages, ExitRoutinesReachTheHost) {
    EXPECT_THROW(xit_(), Ended);
    EXPECT_THROW(xplb_exit_(), Ended);
}

TEST_F(Messages, ExplicitRealsFollowThePrecision) {
    const int lop = -1, intv[] = {0};
    const std::string text = "%R %R";
    const double reals[] = {1.5, -2.5};
    xplb_abqerr_(&lop, text.c_str(), intv, reals, "", text.size(), 8);
    const float singles[] = {1.5f, -2.5f};
    lode_utility_set_explicit_real(4);
    xplb_abqerr_(&lop, text.c_str(), intv, singles, "", text.size(), 8);
    lode_utility_set_explicit_real(8);
    ASSERT_EQ(messages.size(), 2u);
    EXPECT_EQ(messages[0].second, "1.5 -2.5");
    EXPECT_EQ(messages[1].second, "1.5 -2.5");
}

TEST_F(Messages, MutexNumberOutOfRange) {
    for (const int id : {0, 101}) EXPECT_THROW(mutexlock_(&id), Ended);
    ASSERT_EQ(messages.size(), 2u);
    EXPECT_NE(messages[0].second.find("MutexLock: mutex 0"), std::string::npos);
}

TEST(DefaultExit, FlushesAndReturnsFour) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(xit_(), ::testing::ExitedWithCode(4), "");
    const int lop = -3, intv[] = {3};
    const double realv[] = {0};
    EXPECT_EXIT(stdb_abqerr_(&lop, "NDI = %I", intv, realv, "", 8, 8), ::testing::ExitedWithCode(4), "error: NDI = 3");
}

TEST(DefaultExit, AlsoIfTheHandlerReturns) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(
        {
            lode_utility_on_exit([] {});
            xplb_exit_();
        },
        ::testing::ExitedWithCode(4), "");
}

TEST(Names, AreBlankPaddedWithTheirLength) {
    lode_utility_set_job_name("beam-7");
    lode_utility_set_output_directory("/results/here");
    const auto ask = [](void (*routine)(char*, int*, std::size_t)) {
        std::string text(256, '#');
        int length = -1;
        routine(text.data(), &length, text.size());
        EXPECT_EQ(text.find_first_not_of(' ', static_cast<std::size_t>(length)), std::string::npos);
        return text.substr(0, static_cast<std::size_t>(length));
    };
    EXPECT_EQ(ask(getjobname_), "beam-7");
    EXPECT_EQ(ask(vgetjobname_), "beam-7");
    EXPECT_EQ(ask(getoutdir_), "/results/here");
    EXPECT_EQ(ask(vgetoutdir_), "/results/here");
    lode_utility_set_output_directory("");
    EXPECT_EQ(ask(getoutdir_), std::filesystem::current_path().string());

    char small[4];
    int length = 0;
    getjobname_(small, &length, 4);
    EXPECT_EQ(std::string(small, 4), "beam");
    EXPECT_EQ(length, 4);
}

TEST(Processes, RankCountAndThreads) {
    int rank = -1, count = -1;
    getrank_(&rank);
    getnumcpus_(&count);
    EXPECT_EQ(rank, 0);
    EXPECT_EQ(count, 1);
    lode_utility_set_processes(3, 8);
    vgetrank_(&rank);
    vgetnumcpus_(&count);
    EXPECT_EQ(rank, 3);
    EXPECT_EQ(count, 8);
    lode_utility_set_processes(0, 1);
    EXPECT_EQ(getnumthreads_(), 1);
    lode_utility_set_threads(6);
    EXPECT_EQ(getnumthreads_(), 6);
    lode_utility_set_threads(1);
}

TEST(Threads, HaveDifferentStableNumbers) {
    const int mine = get_thread_id_();
    int other = mine;
    std::thread([&] { other = get_thread_id_(); }).join();
    EXPECT_NE(mine, other);
    EXPECT_EQ(mine, get_thread_id_());
}

TEST(Mutex, ProtectsACounter) {
    const int id = 100;
    mutexinit_(&id);
    constexpr int repeats = 20000;
    int counter = 0;
    const auto work = [&] {
        for (int i = 0; i < repeats; ++i) {
            mutexlock_(&id);
            ++counter;
            mutexunlock_(&id);
        }
    };
    std::thread first(work), second(work);
    first.join();
    second.join();
    EXPECT_EQ(counter, 2 * repeats);
}

}  // namespace
