// What shows only in a process of its own: a host without utility routines, environment variables, other processors.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

#include "lode/lode.h"

namespace {

struct Outcome {
    int status = -1;
    std::string output;
};

// By the shell: `environment` in front, `redirection` behind.
Outcome run(const std::string& environment, const std::string& arguments, const std::string& redirection) {
    const std::string command = environment + " '" LODE_BARE_HOST "' " + arguments + " " + redirection;
    Outcome result;
    FILE* pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) return result;
    char text[4096];
    for (std::size_t got = 0; (got = std::fread(text, 1, sizeof text, pipe)) > 0;) result.output.append(text, got);
    const int status = pclose(pipe);
    result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return result;
}

// Exit status 65 is EX_DATAERR.
TEST(BareHost, RefusalEndsTheProcessWithAMessage) {
    for (const char* entry : {"umat", "vumat"}) {
        const Outcome refused = run("", std::string("refuse ") + entry, "2>&1 >/dev/null");
        EXPECT_EQ(refused.status, 65) << entry;
        EXPECT_NE(refused.output.find("ERROR: "), std::string::npos) << refused.output;
        EXPECT_NE(refused.output.find("NO_SUCH_MODEL"), std::string::npos) << refused.output;
        EXPECT_NE(refused.output.find("ISO_ELASTIC"), std::string::npos) << "lists what there is: " << refused.output;
    }
}

TEST(BareHost, SweepIsSilentOnStandardError) {
    const Outcome swept = run("", "sweep", "2>/dev/null");
    EXPECT_EQ(swept.status, 0);
    EXPECT_GT(swept.output.size(), 1000u);
}

struct Number {
    std::string what;
    double scale, value;
};
std::vector<Number> parse(const std::string& text) {
    std::vector<Number> numbers;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with('#')) continue;
        std::istringstream words(line);
        Number n;
        std::string scale, value;
        words >> n.what >> scale >> value;
        n.scale = std::stod(scale);
        n.value = std::stod(value);
        numbers.push_back(n);
    }
    return numbers;
}

// Instruction sets differ in fused multiply-adds and vector lengths: answers agree to rounding, tangents to the
// amplification of a local Newton iteration.
TEST(InstructionSets, AgreeToRounding) {
    // A sanitizer build has one set of kernels, which must serve whatever LODE_ISA asks for.
    const bool has_variants = *LODE_ISA_VARIANTS != '\0';
    std::vector<Number> reference;
    std::istringstream list(has_variants ? LODE_ISA_VARIANTS : "x86-64-v2,x86-64-v4");
    for (std::string variant; std::getline(list, variant, ',');) {
        const Outcome swept = run("LODE_ISA=" + variant, "sweep", "2>/dev/null");
        ASSERT_EQ(swept.status, 0) << variant;
        const std::vector<Number> numbers = parse(swept.output);
        ASSERT_FALSE(numbers.empty());
        if (reference.empty()) {
            const std::string set = has_variants ? variant : "the compiler's default";
            EXPECT_NE(swept.output.find("# instruction set " + set), std::string::npos) << "the first runs anywhere";
            reference = numbers;
        }
        ASSERT_EQ(numbers.size(), reference.size());
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            ASSERT_EQ(numbers[i].what, reference[i].what);
            EXPECT_NEAR(numbers[i].value, reference[i].value, 1e-12 * numbers[i].scale)
                << variant << " " << numbers[i].what;
        }
    }
}

// 10 % stretch along 1 and a quarter turn, E = 1000, nu = 0.25: 120 along the stretch, 40 across.
TEST(HostProfile, EnvironmentOverridesDetection) {
    EXPECT_EQ(run("", "turned 1", "").output, "40.000000 120.000000 1.000000\n");
    EXPECT_EQ(run("", "turned -1", "").output, "120.000000 40.000000 -1.000000\n");
    EXPECT_EQ(run("LODE_HOST=calculix", "turned 1", "").output, "120.000000 40.000000 1.000000\n");
    EXPECT_EQ(run("LODE_HOST=abaqus", "turned -1", "").output, "40.000000 120.000000 -1.000000\n");
}

}  // namespace
