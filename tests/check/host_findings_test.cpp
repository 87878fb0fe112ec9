// Mistakes of hosts, found in what LODE_RECORD has stored of them; and the checks at a recorded call.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>

#include "check/command.hpp"
#include "check/host_findings.hpp"
#include "directory.hpp"
#include "rerun/recording.hpp"

namespace lode::host::test {
namespace {

struct Mistake {
    const char* interface;
    const char* name;
    const char* finding;  // empty: none
};
void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }

SubjectReport report_on(const Directory& directory, const char* interface, const char* mistake) {
    const std::string command = "cd '" + directory.file("") + "' && LODE_RECORD=run.rec '" BROKEN_HOST "' " +
                                interface + " " + mistake + " >host.log 2>&1";
    [[maybe_unused]] const int status = std::system(command.c_str());
    return check_host(read_recording(directory.file("run.rec"), false), "run.rec");
}

std::vector<std::string> findings_of(const SubjectReport& report) {
    std::vector<std::string> names;
    for (const CheckResult& r : report.results)
        for (const Finding& f : r.findings) names.push_back(f.name);
    return names;
}

class Host : public testing::TestWithParam<Mistake> {};

TEST_P(Host, IsToldItsMistake) {
    const Mistake& mistake = GetParam();
    const Directory directory;
    const SubjectReport report = report_on(directory, mistake.interface, mistake.name);
    const std::vector<std::string> names = findings_of(report);
    if (std::string_view(mistake.finding).empty()) {
        EXPECT_TRUE(names.empty()) << names.front();
        return;
    }
    EXPECT_NE(std::find(names.begin(), names.end(), mistake.finding), names.end())
        << "found " << testing::PrintToString(names);
    for (const std::string& name : names) EXPECT_FALSE(text_of(name).mend.empty()) << name;
    for (const CheckResult& r : report.results)
        for (const Finding& f : r.findings)
            EXPECT_NE(f.details.find(", call "), std::string::npos) << "the numbers of the calls: " << f.details;
}

constexpr Mistake mistakes[] = {
    {"umat", "none", ""},
    {"umat", "ntens", "host-ntens"},
    {"umat", "not_finite", "host-not-finite"},
    {"umat", "dtime", "host-negative-dtime"},
    {"umat", "drot", "host-drot"},
    {"umat", "transposed", "host-dfgrd-transposed"},
    {"umat", "dstran", "host-dstran"},
    {"umat", "tensor_shear", "host-shear-strain"},
    {"umat", "dfgrd0", "host-dfgrd0"},
    {"umat", "stran_at_end", "host-stran-at-end"},
    {"umat", "stran_zero", "host-stran"},
    {"umat", "stress_not_rotated", "host-stress-not-rotated"},
    {"umat", "stress_twice", "host-stress"},
    {"umat", "state", "host-state"},
    {"umat", "celent", "host-element-length"},
    {"umat", "pnewdt", "host-pnewdt"},
    {"vumat", "none", ""},
    {"vumat", "vumat_stretch", "host-stretch"},
    {"vumat", "vumat_engineering", "host-strain-inc"},
    {"vumat", "vumat_density", "host-density"},
    {"vumat", "celent", "host-element-length"},
    {"vumat", "dtime", "host-negative-dtime"},
};
INSTANTIATE_TEST_SUITE_P(Mistakes, Host, testing::ValuesIn(mistakes), [](const testing::TestParamInfo<Mistake>& one) {
    return std::string(one.param.interface) + "_" + one.param.name;
});

int lode(const Directory& directory, const std::string& arguments) {
    const std::string command =
        "cd '" + directory.file("") + "' && env -u LODE_LIBRARY '" LODE_EXECUTABLE "' " + arguments + " >out.log 2>&1";
    const int raw = std::system(command.c_str());
    return WIFEXITED(raw) ? WEXITSTATUS(raw) : -1;
}

TEST(HostCommand, IsContentWithAGoodHost) {
    const Directory directory;
    report_on(directory, "umat", "none");
    EXPECT_EQ(lode(directory, "check --host run.rec"), 0) << directory.read("out.log");
}

TEST(HostCommand, NamesTheMistake) {
    const Directory directory;
    report_on(directory, "umat", "drot");
    EXPECT_EQ(lode(directory, "check --host run.rec"), static_cast<int>(Status::failed_check));
    EXPECT_NE(directory.read("out.log").find("host-drot"), std::string::npos) << directory.read("out.log");
    EXPECT_EQ(lode(directory, "rerun run.rec --host -q"), static_cast<int>(Status::failed_check));
}

TEST(RecordedCheck, RunsAtTheRecordedState) {
    for (const char* interface : {"umat", "vumat"}) {
        const Directory directory;  // of this pass: gone at its end
        report_on(directory, interface, "none");
        EXPECT_EQ(lode(directory, "rerun run.rec --check --at 3"), 0) << directory.read("out.log");
        EXPECT_NE(directory.read("out.log").find("call 3"), std::string::npos) << directory.read("out.log");
        EXPECT_EQ(lode(directory, "rerun run.rec --check"), 0) << directory.read("out.log");
        EXPECT_EQ(lode(directory, "rerun run.rec --check --at 99"), 1) << directory.read("out.log");
    }
}

}  // namespace
}  // namespace lode::host::test
