// Deliberately broken materials: each is caught by the finding that names its mistake; the correct twins pass clean.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>

#include "check/child.hpp"
#include "check/run.hpp"
#include "directory.hpp"
#include "guard.hpp"
#include "status.hpp"

namespace lode::host::test {
namespace {

struct Animal {
    const char* library;
    const char* finding;
    Verdict verdict;
    const char* check;  // where it has to be found
    double friction = 0;
    bool elastic = false;
};

// The finding is what is printed when one of these tests fails.
void PrintTo(const Animal& animal, std::ostream* out) { *out << animal.library; }

Subject subject_of(const Library& library, const std::string& name, Kind kind, double friction) {
    Subject subject;
    subject.library = &library;
    subject.name = "ZOO";
    subject.kind = kind;
    const bool fortran = name.starts_with("zoo_fortran");
    if (fortran) subject.constants = {200000, 0.3, 400, 20000};
    else subject.constants = {200000, 0.3, 400, 2000, friction};
    subject.state_variables = fortran ? Layout(kind).size() + 1 : 1;
    subject.unsymmetric = friction != 0;
    return subject;
}

std::string listed(const SubjectReport& report) {
    std::string text;
    for (const CheckResult& r : report.results)
        for (const Finding& f : r.findings) text += r.check + ": " + f.name + ": " + f.details + "\n";
    return text;
}

// Seconds for a check that comes to an end; instrumented code takes ten times as long.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr double time_limit = 50;
#else
constexpr double time_limit = 5;
#endif

RunSettings patient(double seconds = 2.0 * time_limit) {
    RunSettings settings;
    settings.seconds = seconds;
    return settings;
}

class Zoo : public testing::TestWithParam<Animal> {};

TEST_P(Zoo, IsCaught) {
    const Animal& animal = GetParam();
    install_utility_handlers();
    const Library library(std::string(ZOO_DIRECTORY "/") + animal.library + ".so");
    Subject subject = subject_of(library, animal.library, Kind::solid, animal.friction);
    subject.elastic = animal.elastic;
    RunSettings settings = patient(time_limit);
    settings.only = {animal.check};
    const SubjectReport report = run_checks(subject, settings);
    const auto found = std::any_of(report.results.begin(), report.results.end(), [&](const CheckResult& r) {
        return r.check == animal.check && std::any_of(r.findings.begin(), r.findings.end(), [&](const Finding& f) {
                   return f.name == animal.finding && f.verdict == animal.verdict;
               });
    });
    EXPECT_TRUE(found) << "expected " << animal.check << ": " << animal.finding << ", found\n" << listed(report);
    EXPECT_FALSE(text_of(animal.finding).meaning.empty());
    EXPECT_FALSE(text_of(animal.finding).mend.empty());
}

constexpr Verdict fail = Verdict::fail, warning = Verdict::warning;
constexpr Animal animals[] = {
    {"zoo_fortran_tangent_elastic", "tangent-elastic", fail, "tangent"},
    {"zoo_fortran_tangent_shear", "tangent-shear-factor", fail, "tangent"},
    {"zoo_cpp_tangent_transposed", "tangent-transposed", fail, "tangent", 0.05},
    {"zoo_fortran_stress_rotated", "stress-rotated-twice", fail, "objectivity"},
    {"zoo_fortran_state_not_rotated", "state-not-rotated", fail, "objectivity"},
    {"zoo_fortran_statev_beyond", "writes-out-of-bounds", fail, "writes"},
    {"zoo_fortran_writes_dstran", "writes-input", fail, "writes"},
    {"zoo_fortran_ddsdde_unset", "ddsdde-unset", fail, "uninitialised"},
    {"zoo_cpp_adds_to_ddsdde", "reads-output", fail, "uninitialised"},
    {"zoo_fortran_reads_props_beyond", "reads-out-of-bounds", fail, "uninitialised"},
    {"zoo_fortran_save_variable", "hidden-state", fail, "determinism"},
    {"zoo_cpp_stale_constants", "stale-constants", fail, "constants"},
    {"zoo_fortran_stop_on_nan", "ends-process", fail, "nan"},
    {"zoo_fortran_nan_on_zero", "zero-increment-not-finite", fail, "zero-increment"},
    {"zoo_cpp_null_pointer", "crash", fail, "ordinary-path"},
    {"zoo_cpp_endless_loop", "endless-loop", fail, "absurd-increments"},
    {"zoo_cpp_path_dependent", "path-dependent", fail, "closed-path", 0, true},
    {"zoo_cpp_pnewdt_zero", "pnewdt-invalid", fail, "cut-back"},
    {"zoo_cpp_cut_changes_state", "state-changed-on-cut", warning, "cut-back"},
    {"zoo_fortran_above_one", "pnewdt-above-one", warning, "cut-back"},
    {"zoo_cpp_energy_overwritten", "energy-balance", fail, "energy"},
    {"zoo_cpp_scd_decreases", "energy-balance", fail, "energy"},
    {"zoo_fortran_energy_not_set", "energy-not-set", warning, "energy"},
    {"zoo_cpp_vumat_writes_stress_old", "writes-input", fail, "vumat-writes"},
    {"zoo_cpp_vumat_component_order", "vumat-component-order", fail, "vumat-components"},
    {"zoo_cpp_vumat_shear_factor", "vumat-shear-factor", fail, "vumat-components"},
    {"zoo_cpp_vumat_block", "depends-on-block", fail, "vumat-block"},
    {"zoo_cpp_vumat_state_unset", "output-unset", fail, "vumat-outputs"},
};
INSTANTIATE_TEST_SUITE_P(Animals, Zoo, testing::ValuesIn(animals),
                         [](const testing::TestParamInfo<Animal>& one) { return std::string(one.param.library); });

// Whether two threads meet in the shared array is a matter of luck. That it is shared is not.
TEST(Race, IsCaughtOneWayOrTheOther) {
    install_utility_handlers();
    const Library library(ZOO_DIRECTORY "/zoo_cpp_global_array.so");
    RunSettings settings = patient();
    settings.only = {"threads"};
    const SubjectReport report = run_checks(subject_of(library, "zoo_cpp", Kind::solid, 0), settings);
    const CheckResult& result = report.results.back();
    EXPECT_TRUE(result.has("thread-race") || result.has("writes-static-memory")) << listed(report);
}

TEST(Twins, PassClean) {
    install_utility_handlers();
    for (const char* name : {"zoo_cpp_none", "zoo_fortran_none"}) {
        const Library library(std::string(ZOO_DIRECTORY "/") + name + ".so");
        for (const Kind kind : {Kind::solid, Kind::plane_strain})
            for (const double friction : {0.0, 0.05}) {
                const SubjectReport report = run_checks(subject_of(library, name, kind, friction), patient());
                EXPECT_EQ(listed(report), "") << name << ", " << name_of(kind) << ", friction " << friction;
                EXPECT_GE(count({report}, Verdict::pass), 15);
            }
    }
}

// What goes wrong in one check leaves the others alone.
TEST(Run, GoesOnAfterACrash) {
    install_utility_handlers();
    const Library library(ZOO_DIRECTORY "/zoo_fortran_stop_on_nan.so");
    RunSettings settings;
    settings.only = {"tangent", "nan", "absurd-increments"};
    const SubjectReport report = run_checks(subject_of(library, "zoo_fortran", Kind::solid, 0), settings);
    ASSERT_EQ(report.results.size(), 4U) << "the ordinary path comes first";
    EXPECT_EQ(report.results[1].verdict(), Verdict::pass);
    EXPECT_EQ(report.results[2].verdict(), Verdict::fail);
    EXPECT_EQ(report.results[3].verdict(), Verdict::pass);
    EXPECT_NE(report.results[2].findings[0].details.find("NaN in DSTRAN"), std::string::npos)
        << "what the library printed last: " << report.results[2].findings[0].details;
}

TEST(Child, SaysHowItEnded) {
    using How = ChildEnd::How;
    EXPECT_EQ(in_child([] { return std::string("an answer"); }, 5).answer, "an answer");
    EXPECT_EQ(in_child([]() -> std::string { std::abort(); }, 5).how, How::crashed);
    EXPECT_EQ(in_child([]() -> std::string { std::exit(3); }, 5).how, How::exited);
    const ChildEnd late = in_child(
        []() -> std::string {
            doing("waiting");
            while (true) {
            }
        },
        0.2);
    EXPECT_EQ(late.how, How::timed_out);
    EXPECT_EQ(late.activity, "waiting");
    const std::string large(3000000, 'x');
    EXPECT_EQ(in_child([&] { return large; }, 5).answer, large);
}

TEST(Finding, SurvivesThePipe) {
    CheckResult result;
    result.check = "tangent";
    result.fail("tangent-wrong", "here");
    result.curves.push_back({"title", "x", "y", "label", {1, 2}, {3, 4}});
    const CheckResult back = unpacked(packed(result));
    EXPECT_EQ(back.check, "tangent");
    EXPECT_EQ(back.verdict(), Verdict::fail);
    EXPECT_EQ(back.curves[0].y, (std::vector<double>{3, 4}));
}

struct Result {
    int status;
    std::string out;
};
Result lode(const Directory& directory, const std::string& arguments) {
    const std::string command = "cd '" + directory.file("") + "' && env -u LODE_LIBRARY '" LODE_EXECUTABLE "' check " +
                                arguments + " >out.log 2>&1";
    const int raw = std::system(command.c_str());
    return {WIFEXITED(raw) ? WEXITSTATUS(raw) : -1, directory.read("out.log")};
}

TEST(Command, ReportsAsTextJsonAndHtml) {
    const Directory directory;
    const Result result = lode(directory, ZOO_DIRECTORY
                               "/zoo_fortran_tangent_elastic.so --props 200000,0.3,400,20000 --nstatv 7 --only "
                               "tangent,splitting --json r.json --html r.html");
    EXPECT_EQ(result.status, static_cast<int>(Status::failed_check)) << result.out;
    EXPECT_NE(result.out.find("tangent-elastic"), std::string::npos);
    EXPECT_NE(result.out.find("2 pass, 0 not applicable, 0 warning, 1 fail"), std::string::npos) << result.out;
    const std::string json = directory.read("r.json"), html = directory.read("r.html");
    EXPECT_NE(json.find("\"name\": \"tangent-elastic\""), std::string::npos);
    EXPECT_NE(json.find("\"fail\": 1"), std::string::npos);
    EXPECT_NE(html.find("tangent-elastic"), std::string::npos);
    if (std::system("gnuplot --version >/dev/null 2>&1") == 0) {
        EXPECT_NE(html.find("<svg"), std::string::npos);
    }
}

TEST(Command, TakesTheCardsOfAnInputFile) {
    const Directory directory;
    directory.write("job.inp",
                    "*MATERIAL, NAME=STEEL\n*USER MATERIAL, CONSTANTS=4\n200000., 0.3, 400., 20000.\n*DEPVAR\n7\n");
    const Result result =
        lode(directory, ZOO_DIRECTORY "/zoo_fortran_none.so --card job.inp --only tangent,writes,energy");
    EXPECT_EQ(result.status, 0) << result.out;
    EXPECT_NE(result.out.find("STEEL, 3d"), std::string::npos) << result.out;
}

TEST(Command, SaysWhatItCannotDo) {
    const Directory directory;
    EXPECT_EQ(lode(directory, ZOO_DIRECTORY "/zoo_cpp_none.so").status, 1);
    EXPECT_EQ(lode(directory, "nothing.so --props 1").status, 5);
    const Result unknown = lode(directory, ZOO_DIRECTORY "/zoo_cpp_none.so --props 1 --only tangant");
    EXPECT_EQ(unknown.status, 1);
    EXPECT_NE(unknown.out.find("did you mean \"tangent\""), std::string::npos) << unknown.out;
    const Result refused = lode(directory, ZOO_DIRECTORY "/zoo_cpp_none.so --props 1");
    EXPECT_EQ(refused.status, static_cast<int>(Status::failed_check)) << refused.out;
    EXPECT_NE(refused.out.find("ends-analysis"), std::string::npos) << refused.out;
}

}  // namespace
}  // namespace lode::host::test
