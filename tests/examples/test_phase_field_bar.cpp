// The toughness that the phase-field joint recovers: GC (1 + h/(2 ELL)) as the phase of its layer goes to 1.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

namespace {

struct Row {
    std::string law;
    double ell, ratio, peak, phase, dissipated, work, surface, expected, iterations;
};

std::vector<Row> run() {
    std::vector<Row> rows;
    std::FILE* pipe = popen(PHASE_FIELD_BAR, "r");
    EXPECT_NE(pipe, nullptr);
    if (pipe == nullptr) return rows;
    char line[512];
    while (std::fgets(line, sizeof line, pipe) != nullptr) {
        std::istringstream text(line);
        Row r;
        if (text >> r.law >> r.ell >> r.ratio >> r.peak >> r.phase >> r.dissipated >> r.work >> r.surface >>
            r.expected >> r.iterations)
            rows.push_back(r);
    }
    EXPECT_EQ(pclose(pipe), 0);
    return rows;
}

TEST(PhaseFieldBar, RecoversTheToughness) {
    const std::vector<Row> rows = run();
    ASSERT_EQ(rows.size(), 7u);
    // Increments of 2 % in strain: the trapezoid rule, and 1/R of the stiff bars.
    constexpr double trapezoid = 0.02 * 0.02;
    for (const Row& r : rows) {
        SCOPED_TRACE(r.law + ", h/ELL " + std::to_string(r.ratio));
        EXPECT_NEAR(r.expected, 1.0 + 0.5 * r.ratio, 1e-6);
        EXPECT_GT(r.phase, 0.999);
        const double missing = 2.0 * (1.0 - r.phase);  // phi^2
        EXPECT_NEAR(r.dissipated, r.expected, (missing + trapezoid) * r.expected);
        EXPECT_NEAR(r.work, r.expected, (missing + trapezoid) * r.expected);
        EXPECT_NEAR(r.surface, r.expected, (missing + trapezoid) * r.expected);
    }
    // First order in h/ELL: what is too much halves with it.
    for (std::size_t i = 1; i < 5; ++i) {
        const double before = rows[i - 1].dissipated / rows[i - 1].phase / rows[i - 1].phase - 1.0,
                     after = rows[i].dissipated / rows[i].phase / rows[i].phase - 1.0;
        EXPECT_NEAR(before / after, 2.0, 4.0 * trapezoid / after) << "h/ELL " << rows[i].ratio;
    }
}

}  // namespace
