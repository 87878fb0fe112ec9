// The program as a user runs it: exit statuses, messages, files.
#include <sys/wait.h>

#include <cstdlib>

#include "support.hpp"

namespace lode::host::test {
namespace {

struct Result {
    int status;
    std::string out, err;
};

Result lode(const Directory& directory, const std::string& arguments, const std::string& environment = "") {
    const std::string command = "cd '" + directory.file("") + "' && env -u LODE_LIBRARY " + environment +
                                " '" LODE_EXECUTABLE "' " + arguments + " >out.log 2>err.log";
    const int raw = std::system(command.c_str());
    return {WIFEXITED(raw) ? WEXITSTATUS(raw) : -1, directory.read("out.log"), directory.read("err.log")};
}

const std::string library = " --library '" HOST_TEST_LIBRARY "'";
const std::string material = "[material]\nname = \"J2-A\"\nconstants = [1000, 0.3, 5, 100]\nstate_variables = 1\n";
const std::string five_increments = "[[step]]\nstrain = { 11 = 0.01 }\nincrements = 5\n";

TEST(Program, SuccessWritesCsvPlotAndSummary) {
    const Directory directory;
    directory.write("bar.toml", "title = \"A 'quoted' title\"\n" + material + five_increments +
                                    "[output]\ncolumns = [\"time\", \"stress11\", \"mises\", \"state1\"]\nplot = { x = "
                                    "\"strain11\", y = [\"stress11\", \"mises\"] }\n");
    const Result result = lode(directory, "replay bar.toml --output results" + library);
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.err, "");
    for (const char* word : {"5 in 1 steps", "stress11", "state at the end", "balance", "results/bar.csv"})
        EXPECT_NE(result.out.find(word), std::string::npos) << word;
    std::istringstream csv(directory.read("results/bar.csv"));
    std::string line;
    std::getline(csv, line);
    EXPECT_EQ(line, "time,stress11,mises,state1,strain11") << "columns of the plot are added";
    int rows = 0;
    while (std::getline(csv, line)) ++rows;
    EXPECT_EQ(rows, 6);
    EXPECT_NE(directory.read("results/bar.txt").find("balance"), std::string::npos);
    EXPECT_NE(directory.read("results/bar.gp").find("plot data using 5:2"), std::string::npos);
    if (std::system("gnuplot --version >/dev/null 2>&1") == 0) {
        EXPECT_GT(std::filesystem::file_size(directory.file("results/bar.png")), 5000U);
        EXPECT_NE(directory.read("results/bar.svg").find("<svg"), std::string::npos);
    }
}

TEST(Program, QuietPrintsNothing) {
    const Directory directory;
    directory.write("bar.toml", material + five_increments + "[output]\nevery = 2\nplot = false\n");
    const Result result = lode(directory, "replay --quiet bar.toml" + library);
    EXPECT_EQ(result.status, 0);
    EXPECT_EQ(result.out + result.err, "");
    EXPECT_FALSE(std::filesystem::exists(directory.file("bar.png")));
    const std::string csv = directory.read("bar.csv");
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 4) << "header, initial state, increments 2 and 4";
}

TEST(Program, WithoutGnuplotThereIsStillTheScript) {
    const Directory directory;
    directory.write("bar.toml", material + five_increments);
    const Result result = lode(directory, "replay bar.toml" + library, "PATH=/nonexistent");
    EXPECT_EQ(result.status, 0);
    EXPECT_NE(result.err.find("gnuplot is not installed"), std::string::npos) << result.err;
    EXPECT_TRUE(std::filesystem::exists(directory.file("bar.gp")));
}

TEST(Program, UsageErrors) {
    const Directory directory;
    EXPECT_EQ(lode(directory, "").status, 1);
    EXPECT_EQ(lode(directory, "replay").status, 1);
    EXPECT_EQ(lode(directory, "replay x.toml --interface uel").status, 1);
    EXPECT_EQ(lode(directory, "--help").status, 0);
    EXPECT_EQ(lode(directory, "replay --help").status, 0);
    EXPECT_EQ(lode(directory, "--version").status, 0);
    directory.write("bar.toml", material + five_increments);
    directory.write("file", "");
    EXPECT_EQ(lode(directory, "replay bar.toml --output file" + library).status, 1);
}

TEST(Program, BadDecks) {
    const Directory directory;
    directory.write("bar.toml", material + "[[step]]\nstrian = { 11 = 0.01 }\n");
    const Result result = lode(directory, "replay bar.toml" + library);
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(result.err.find("bar.toml:6: step[1].strian: there is no such key"), 0U) << result.err;
    EXPECT_NE(result.err.find("did you mean \"strain\""), std::string::npos) << result.err;
    directory.write("bar.toml", material + five_increments + "[output]\ncolumns = [\"time\",\n  \"stress14\"]\n");
    const Result column = lode(directory, "replay bar.toml" + library);
    EXPECT_EQ(column.status, 2);
    EXPECT_EQ(column.err.find("bar.toml:10: output.columns: there is no column \"stress14\""), 0U) << column.err;
    EXPECT_EQ(lode(directory, "replay missing.toml" + library).status, 2);
}

TEST(Program, NoConvergenceKeepsWhatWasDone) {
    const Directory directory;
    directory.write("bar.toml",
                    "[material]\nname = \"PICKY\"\nconstants = [1000, 0.3, 0]\nstate_variables = 1\n[[step]]\n"
                    "increments = 2\n[[step]]\nstrain = { 11 = 0.01 }\n");
    const Result result = lode(directory, "replay bar.toml" + library);
    EXPECT_EQ(result.status, 3);
    EXPECT_NE(result.err.find("PNEWDT"), std::string::npos) << result.err;
    EXPECT_NE(result.out.find("STOPPED"), std::string::npos);
    const std::string csv = directory.read("bar.csv");
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 4);
}

#ifdef HOST_TEST_HAS_UTILITY
TEST(Program, ExitOfTheLibrary) {
    const Directory directory;
    directory.write("bar.toml", "[material]\nname = \"QUIT\"\nconstants = [1000, 0.3]\n" + five_increments);
    const Result result = lode(directory, "replay bar.toml" + library);
    EXPECT_EQ(result.status, 4);
    EXPECT_NE(result.err.find("QUIT: that is enough"), std::string::npos) << result.err;
    EXPECT_TRUE(std::filesystem::exists(directory.file("bar.csv")));
}
#endif

TEST(Program, RefusedConstants) {
    const Directory directory;
    directory.write("bar.toml", "[material]\nname = \"SPRING\"\nconstants = [-1000, 0.3]\n" + five_increments);
    const Result result = lode(directory, "replay bar.toml --library '" HOST_TEST_CATALOGUE "'");
    EXPECT_EQ(result.status, 4);
    EXPECT_NE(result.err.find("K has to be positive"), std::string::npos) << result.err;
}

TEST(Program, LibrariesThatCannotBeLoaded) {
    const Directory directory;
    directory.write("bar.toml", material + five_increments);
    const Result missing = lode(directory, "replay bar.toml --library ./missing.so");
    EXPECT_EQ(missing.status, 5);
    EXPECT_NE(missing.err.find("missing.so"), std::string::npos) << missing.err;
    EXPECT_EQ(lode(directory, "replay bar.toml --library bar.toml").status, 5) << "not a shared object";
    EXPECT_EQ(lode(directory, "replay bar.toml --library libm.so.6").status, 5) << "no umat_ in it";
}

TEST(Program, LibraryFromEnvironmentAndDeck) {
    const Directory directory;
    directory.write("bar.toml", material + five_increments);
    EXPECT_EQ(lode(directory, "replay -q bar.toml", "LODE_LIBRARY='" HOST_TEST_LIBRARY "'").status, 0);
    directory.write("deck.toml", material + "library = \"" HOST_TEST_LIBRARY "\"\n" + five_increments);
    EXPECT_EQ(lode(directory, "replay -q deck.toml", "LODE_LIBRARY=missing.so").status, 0);
    EXPECT_EQ(lode(directory, "replay -q deck.toml --interface vumat").status, 0);
}

TEST(Program, Models) {
    const Directory directory;
    const std::string catalogue = " --library '" HOST_TEST_CATALOGUE "'";
    const Result table = lode(directory, "models" + catalogue);
    EXPECT_EQ(table.status, 0);
    EXPECT_NE(table.out.find("| SPRING"), std::string::npos) << table.out;
    EXPECT_NE(lode(directory, "models spring" + catalogue).out.find("# SPRING"), std::string::npos);
    EXPECT_EQ(lode(directory, "models --markdown pages" + catalogue).status, 0);
    EXPECT_NE(directory.read("pages/FINITE.md").find("# FINITE"), std::string::npos);
    const Result unknown = lode(directory, "models SPRNG" + catalogue);
    EXPECT_EQ(unknown.status, 1);
    EXPECT_NE(unknown.err.find("did you mean \"SPRING\""), std::string::npos) << unknown.err;
    EXPECT_EQ(lode(directory, "models" + library).status, 4) << "no catalogue in it";
}

}  // namespace
}  // namespace lode::host::test
