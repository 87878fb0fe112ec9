// What the tests of the scalar damage models of page 35 share.
#pragma once

#include "softening_support.hpp"

namespace lode::test::damage_cases {

using softening::entries, softening::entry, softening::expect_printed, softening::expect_same_in_vumat,
    softening::expect_tangent, softening::follow, softening::printed;

struct LawCode {
    int code;
    double a1, a2;
};
constexpr LawCode laws[] = {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 1.5, 0}, {5, 3, 0.6}, {6, 1.5, 0}};

inline void expect_message(const std::string& message, const std::vector<std::string>& words) {
    for (const std::string& word : words)
        EXPECT_NE(message.find(word), std::string::npos) << "no '" << word << "' in: " << message;
}
// The analysis ends with a message that has these words.
inline void expect_refused(const UmatPoint& point, const std::vector<std::string>& words) {
    const Answer a = point.evaluate({});
    EXPECT_EQ(a.messages.stops, 1);
    expect_message(a.first_error(), words);
}
// What is said of constants that cannot be used.
inline std::string refusal(const char* name, const Numbers& props, AnalysisKind kind) {
    char error[512] = "";
    EXPECT_EQ(lode_required_state(name, props.data(), int(props.size()), normal_components(kind),
                                  shear_components(kind), error, sizeof error),
              -1);
    return error;
}

// Those of six components that a kind has.
inline Numbers in_kind(const Numbers& full, AnalysisKind kind) {
    Numbers some(full.begin(), full.begin() + normal_components(kind));
    some.insert(some.end(), full.begin() + 3, full.begin() + 3 + shear_components(kind));
    return some;
}

// DDSDDE by central differences through the entry point.
inline Eigen::MatrixXd central_difference(const UmatPoint& point, const Load& load, double h) {
    const auto n = static_cast<Eigen::Index>(point.size());
    Eigen::MatrixXd difference(n, n);
    for (Eigen::Index j = 0; j < n; ++j) {
        Load ahead = load, back = load;
        ahead.dstran[std::size_t(j)] += h;
        back.dstran[std::size_t(j)] -= h;
        const Answer a = point.evaluate(ahead), b = point.evaluate(back);
        for (Eigen::Index i = 0; i < n; ++i)
            difference(i, j) = (a.stress[std::size_t(i)] - b.stress[std::size_t(i)]) / (2.0 * h);
    }
    return difference;
}

}  // namespace lode::test::damage_cases
