// The third-party example is loaded as a host loads it: the executable supplies SPRINC, ROTSIG, STDB_ABQERR and XIT.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "abi.hpp"
#include "utility_host.h"

namespace {

struct Ended {};
std::vector<std::pair<int, std::string>> messages;

class ThirdParty : public ::testing::Test {
  protected:
    void SetUp() override {
        messages.clear();
        lode_utility_on_message([](int severity, const char* text) { messages.emplace_back(severity, text); });
        lode_utility_on_exit([] { throw Ended{}; });
        library = dlopen(THIRD_PARTY_LIBRARY, RTLD_NOW | RTLD_LOCAL);
        ASSERT_NE(library, nullptr) << dlerror();
        umat = reinterpret_cast<lode_umat_function*>(dlsym(library, "umat_"));
        ASSERT_NE(umat, nullptr);
    }
    void TearDown() override {
        lode_utility_on_message(nullptr);
        lode_utility_on_exit(nullptr);
    }

    void call(const std::array<double, 6>& de, const std::array<double, 9>& drot = identity) {
        double scd = 0, rpl = 0, drpldt = 0, pnewdt = 1;
        std::array<double, 6> unused{}, stran{};
        const double time[2] = {0, 0}, dtime = 1, temp = 0, none[1] = {0}, celent = 1;
        const int ntens = ndi + nshr, nstatv = ntens + 4, nprops = static_cast<int>(props.size()), one = 1;
        const int jstep[4] = {1, 1, 0, 0};
        std::array<char, LODE_CMNAME_LENGTH> name;
        name.fill(' ');
        std::copy_n("PRAGER", 6, name.begin());
        umat(stress.data(), state.data(), tangent.data(), &sse, &spd, &scd, &rpl, unused.data(), unused.data(), &drpldt,
             stran.data(), de.data(), time, &dtime, &temp, &temp, none, none, name.data(), &ndi, &nshr, &ntens, &nstatv,
             props.data(), &nprops, none, drot.data(), &pnewdt, &celent, identity.data(), identity.data(), &one, &one,
             &one, &one, jstep, &one, name.size());
    }

    static constexpr std::array<double, 9> identity = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    void* library = nullptr;
    lode_umat_function* umat = nullptr;
    std::vector<double> props = {200000, 0.3, 400, 2000};
    int ndi = 3, nshr = 3;
    std::array<double, 6> stress{};
    std::array<double, 10> state{};
    std::array<double, 36> tangent{};
    double sse = 0, spd = 0;
};

// Shear to 0.02 and back: |tau - X| = 400/sqrt(3) with X = C ep, ep the plastic strain component 12.
TEST_F(ThirdParty, ReversedShearFollowsPrager) {
    const double shear = 200000 / 2.6, k = 400 / std::sqrt(3.0), c = 2000.0 * 2.0 / 3.0;
    const auto plastic = [&](double gamma, double sign) {  // tau = G (gamma - 2 ep) = sign k + c ep
        return (shear * gamma - sign * k) / (2 * shear + c);
    };
    call({0, 0, 0, 0.02, 0, 0});
    EXPECT_NEAR(stress[3], k + c * plastic(0.02, 1), 1e-9);
    EXPECT_NEAR(state[3], c * plastic(0.02, 1), 1e-9);
    EXPECT_NEAR(state[6], 2 / std::sqrt(3.0) * plastic(0.02, 1), 1e-12);
    EXPECT_NEAR(state[7], stress[3], 1e-12);
    EXPECT_NEAR(state[9], -stress[3], 1e-12);
    call({0, 0, 0, -0.03, 0, 0});
    EXPECT_NEAR(stress[3], -k + c * plastic(-0.01, -1), 1e-9);
    EXPECT_TRUE(messages.empty());
}

TEST_F(ThirdParty, TangentIsTheDerivative) {
    const std::array<double, 6> start = {100, -50, 20, 60, -30, 40}, de = {4e-3, -1e-3, 2e-3, 5e-3, -3e-3, 1e-3};
    const std::array<double, 10> back = {20, -5, -15, 10, 5, -10, 0, 0, 0, 0};
    const auto at = [&](const std::array<double, 6>& increment) {
        stress = start;
        state = back;
        call(increment);
        return stress;
    };
    at(de);
    const auto analytic = tangent;
    ASSERT_GT(state[6], 0);
    const double h = 1e-7;
    for (std::size_t j = 0; j < 6; ++j) {
        auto plus = de, minus = de;
        plus[j] += h;
        minus[j] -= h;
        const auto a = at(plus), b = at(minus);
        for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(analytic[i + 6 * j], (a[i] - b[i]) / (2 * h), 0.2) << i << j;
    }
}

TEST_F(ThirdParty, BackStressTurnsWithDrot) {
    state = {30, -10, -20, 5, 0, 0, 0, 0, 0, 0};
    call({}, {0, 1, 0, -1, 0, 0, 0, 0, 1});  // quarter turn about 3
    const double expected[4] = {-10, 30, -20, -5};
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(state[i], expected[i], 1e-12);
}

TEST_F(ThirdParty, BadInputEndsTheAnalysisThroughTheHost) {
    props = {200000, 0.3};
    EXPECT_THROW(call({}), Ended);
    props = {200000, 0.3, -1, 0};
    EXPECT_THROW(call({}), Ended);
    ndi = 2, nshr = 1;
    EXPECT_THROW(call({}), Ended);
    ASSERT_EQ(messages.size(), 3u);
    EXPECT_EQ(messages[0].first, -2);
    EXPECT_EQ(messages[0].second, "PRAGER: 4 constants and NTENS+4 state variables are needed, there are 2 and 10");
    EXPECT_EQ(messages[1].second, "PRAGER: E and the yield stress must be positive, found -1");
    EXPECT_EQ(messages[2], (std::pair<int, std::string>{-3, "PRAGER: NDI = 3 is needed, not 2"}));
}

}  // namespace
