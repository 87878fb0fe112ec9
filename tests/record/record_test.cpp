// LODE_RECORD and `lode rerun`, as a user has them.
#include <signal.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <set>
#include <span>

#include "directory.hpp"
#include "rerun/deck_writer.hpp"
#include "rerun/recording.hpp"
#include "status.hpp"

namespace lode::host::test {
namespace {

struct Result {
    int status;
    std::string out;
};

Result shell(const Directory& directory, const std::string& command) {
    const std::string line = "cd '" + directory.file("") + "' && " + command + " >out.log 2>&1";
    const int raw = std::system(line.c_str());
    return {WIFEXITED(raw) ? WEXITSTATUS(raw) : -1, directory.read("out.log")};
}
Result replay(const Directory& directory, const std::string& selection, const std::string& arguments) {
    return shell(directory, "LODE_RECORD=run.rec" + selection + " '" LODE_EXECUTABLE "' replay -q " + arguments);
}
Result rerun(const Directory& directory, const std::string& arguments) {
    return shell(directory, "'" LODE_EXECUTABLE "' rerun " + arguments);
}

constexpr const char* clay = R"([material]
name = "CAM_CLAY-CLAY"
constants = [100, 0.02, 0.1, 1.2, 3000, 0, 120]
initial_stress = { 11 = -100, 22 = -100, 33 = -100 }
[[step]]
increments = 10
strain = { 11 = -0.03, 22 = 0.01, 33 = 0.005, 12 = 0.01 }
temperature = 5
[output]
plot = false
)";
std::string elastic_deck(const std::string& analysis, const std::string& step) {
    return "[material]\nname = \"ISO_ELASTIC-A\"\nconstants = [210000, 0.3]\n[analysis]\n" + analysis +
           "\n[[step]]\nincrements = 7\n" + step + "\n[output]\nplot = false\n";
}

TEST(Record, AReplayRerunsBitForBit) {
    const Directory directory;
    directory.write("deck.toml", clay);
    ASSERT_EQ(replay(directory, "", "deck.toml").status, 0);
    const Recording recording = read_recording(directory.file("run.rec"), false);
    ASSERT_EQ(recording.sessions.size(), 1U);
    EXPECT_EQ(recording.sessions[0].library, "Lode");
    EXPECT_FALSE(recording.sessions[0].instruction_set.empty());
    ASSERT_EQ(recording.materials.size(), 1U);
    EXPECT_EQ(recording.materials[0].constants, (std::vector<double>{100, 0.02, 0.1, 1.2, 3000, 0, 120}));
    ASSERT_GE(recording.calls.size(), 10U);
    const RecordedCall& last = recording.calls.back();
    EXPECT_EQ(last.umat().kinc, 10);
    EXPECT_EQ(last.input(record::UmatInput::drot), (std::vector<double>{1, 0, 0, 0, 1, 0, 0, 0, 1}));
    const Result again = rerun(directory, "run.rec");
    EXPECT_EQ(again.status, 0) << again.out;
    EXPECT_NE(again.out.find(std::to_string(recording.calls.size()) + " of "), std::string::npos) << again.out;
}

TEST(Record, VumatInBothPrecisionsRerunsBitForBit) {
    for (const bool single : {false, true}) {
        const Directory directory;
        directory.write(
            "deck.toml",
            elastic_deck(std::string("interface = \"vumat\"\nunnamed = \"strain\"\nblock = 5\nprecision = \"") +
                             (single ? "single\"" : "double\""),
                         "strain = { 11 = 0.01, 12 = 0.02 }\ntemperature = 20"));
        const std::string library = single ? " --library '" LODE_SINGLE_PRECISION_LIBRARY "'" : "";
        const Result made = replay(directory, "", "deck.toml" + library);
        ASSERT_EQ(made.status, 0) << made.out;
        const Recording recording = read_recording(directory.file("run.rec"), false);
        ASSERT_GE(recording.calls.size(), 8U) << "seven increments and the host's probe";
        EXPECT_EQ(recording.calls.back().vumat().nblock, 5);
        EXPECT_EQ(recording.calls.back().vumat().real_size, single ? 4 : 8);
        const Result again = rerun(directory, "run.rec" + library);
        EXPECT_EQ(again.status, 0) << again.out;
    }
}

TEST(Record, OtherConstantsAreRankedAsDifferences) {
    const Directory directory;
    directory.write("deck.toml", elastic_deck("", "strain = { 11 = 0.01 }"));
    ASSERT_EQ(replay(directory, "", "deck.toml").status, 0);
    // What another build might give: one stress of one call is changed in the file, whose checksum is then mended.
    Recording recording = read_recording(directory.file("run.rec"), false);
    std::string bytes = directory.read("run.rec");
    const double stress = recording.calls.back().output(record::UmatOutput::stress)[0];
    const std::size_t place = bytes.rfind(std::string(reinterpret_cast<const char*>(&stress), sizeof stress));
    ASSERT_NE(place, std::string::npos);
    const double other = stress * (1 + 1e-9);
    bytes.replace(place, sizeof other, reinterpret_cast<const char*>(&other), sizeof other);
    const std::uint32_t mark = record::frame_mark;
    const std::size_t frame = bytes.rfind(std::string(reinterpret_cast<const char*>(&mark), sizeof mark));
    record::FrameHeader header;
    std::memcpy(&header, &bytes[frame], sizeof header);
    header.checksum = 0;
    std::memcpy(&bytes[frame], &header, sizeof header);
    header.checksum = record::checksum(std::as_bytes(std::span(bytes).subspan(frame)));
    std::memcpy(&bytes[frame], &header, sizeof header);
    directory.write("other.rec", bytes);
    const Result again = rerun(directory, "other.rec");
    EXPECT_EQ(again.status, static_cast<int>(Status::different));
    EXPECT_NE(again.out.find("STRESS(1) was"), std::string::npos) << again.out;
    EXPECT_NE(again.out.find("1e-09 of the largest"), std::string::npos) << again.out;
}

TEST(Record, SelectsPointsAndIncrements) {
    const Directory directory;
    const std::string host = "'" THREADED_HOST "' 3 20";
    ASSERT_EQ(shell(directory, "LODE_RECORD=run.rec:element=2-3,increment=5-8,material=ISO_ELASTIC " + host).status, 0);
    const Recording recording = read_recording(directory.file("run.rec"), false);
    EXPECT_EQ(recording.calls.size(), 2U * 4U);
    for (const RecordedCall& call : recording.calls) {
        EXPECT_GE(call.umat().noel, 2);
        EXPECT_GE(call.umat().kinc, 5);
        EXPECT_LE(call.umat().kinc, 8);
    }
    ASSERT_EQ(shell(directory, "LODE_RECORD=none.rec:material=CAM_CLAY " + host).status, 0);
    EXPECT_TRUE(read_recording(directory.file("none.rec"), false).calls.empty());
}

TEST(Record, ARingKeepsTheLastCalls) {
    const Directory directory;
    ASSERT_EQ(shell(directory, "LODE_RECORD=run.rec:last=6 '" THREADED_HOST "' 1 100").status, 0);
    const Recording recording = read_recording(directory.file("run.rec"), false);
    ASSERT_EQ(recording.calls.size(), 6U);
    EXPECT_EQ(recording.calls.front().umat().kinc, 95);
    EXPECT_EQ(recording.calls.back().umat().kinc, 100);
}

TEST(Record, OnlyCutsStoresOnlyWhatAskedForASmallerIncrement) {
    const Directory directory;
    // On the straight way to half a turn det F is zero: NEO_HOOKEAN asks for smaller increments until the host gives
    // up.
    directory.write("deck.toml",
                    "[material]\nname = \"NEO_HOOKEAN-A\"\nconstants = [3, 0.3]\n[[step]]\nincrements = 3\n"
                    "deformation_gradient = [[1.1, 0, 0], [0, 1, 0], [0, 0, 1]]\n[[step]]\nincrements = 2\n"
                    "deformation_gradient = [[-1.1, 0, 0], [0, -1, 0], [0, 0, 1]]\n[output]\nplot = false\n");
    EXPECT_EQ(replay(directory, ":cut", "deck.toml").status, static_cast<int>(Status::not_converged));
    const Recording recording = read_recording(directory.file("run.rec"), false);
    ASSERT_FALSE(recording.calls.empty());
    for (const RecordedCall& call : recording.calls) {
        EXPECT_EQ(call.umat().kstep, 2);
        EXPECT_LT(call.output(record::UmatOutput::pnewdt)[0], 1.0);
    }
    EXPECT_EQ(rerun(directory, "run.rec").status, 0);
}

TEST(Record, ACallThatEndsTheAnalysisIsStored) {
    for (const char* selection : {"", ":last=3", ":cut"}) {
        const Directory directory;
        directory.write(
            "deck.toml",
            "[material]\nname = \"ISO_ELASTIC-A\"\nconstants = [210000, 0.7]\nstate_variables = 4\n[[step]]\n"
            "strain = { 11 = 0.01 }\n[output]\nplot = false\n");
        // NU = 0.7 is refused; with a number of STATEV given, the host finds out by calling.
        const Result made = replay(directory, selection, "deck.toml");
        EXPECT_EQ(made.status, static_cast<int>(Status::refused)) << made.out;
        if (!std::filesystem::exists(directory.file("run.rec"))) continue;  // the host asked the catalogue first
        const Recording recording = read_recording(directory.file("run.rec"), false);
        ASSERT_EQ(recording.calls.size(), 1U);
        EXPECT_FALSE(recording.calls[0].returned());
        const Result again = rerun(directory, "run.rec");
        EXPECT_EQ(again.status, 0) << again.out;
        EXPECT_NE(rerun(directory, "run.rec --at 1").out.find("now it does so again"), std::string::npos);
    }
}

TEST(Record, ThreadsShareTheFile) {
    const Directory directory;
    constexpr int threads = 4, calls = 250;
    ASSERT_EQ(shell(directory, "LODE_RECORD=run.rec '" THREADED_HOST "' 4 250").status, 0);
    const Recording recording = read_recording(directory.file("run.rec"), false);
    ASSERT_EQ(recording.calls.size(), static_cast<std::size_t>(threads * calls));
    EXPECT_EQ(recording.materials.size(), 1U);
    std::set<std::pair<int, int>> seen;
    for (const RecordedCall& call : recording.calls) seen.insert({call.umat().noel, call.umat().kinc});
    EXPECT_EQ(seen.size(), recording.calls.size());
    EXPECT_EQ(rerun(directory, "-q run.rec").status, 0);
}

TEST(Record, ProcessesShareTheFile) {
    const Directory directory;
    const std::string host = "LODE_RECORD=run.rec '" THREADED_HOST "' 2 100";
    ASSERT_EQ(shell(directory, "(" + host + " & " + host + " & " + host + " & wait)").status, 0);
    const Recording recording = read_recording(directory.file("run.rec"), false);
    EXPECT_EQ(recording.sessions.size(), 3U);
    EXPECT_EQ(recording.calls.size(), 600U);
    EXPECT_EQ(rerun(directory, "-q run.rec").status, 0);
}

TEST(Record, AKilledHostLeavesAReadableRecording) {
    const Directory directory;
    // Killed while its threads are writing.
    shell(directory,
          "(LODE_RECORD=run.rec '" THREADED_HOST
          "' 2 -1 > host.log & pid=$!; while ! grep -q running host.log; do sleep 0.02; done; kill -9 $pid)");
    const Recording recording = read_recording(directory.file("run.rec"), false);
    EXPECT_GE(recording.calls.size(), 50U);
    EXPECT_TRUE(recording.damage.empty());
}

TEST(Record, WhatAKilledHostLeftUnfinishedIsPassedOver) {
    const Directory directory;
    ASSERT_EQ(shell(directory, "LODE_RECORD=run.rec '" THREADED_HOST "' 1 20").status, 0);
    const std::string whole = directory.read("run.rec");
    const std::uint32_t mark = record::frame_mark;
    const std::string frame_begins(reinterpret_cast<const char*>(&mark), sizeof mark);
    const std::size_t last = whole.rfind(frame_begins), before_last = whole.rfind(frame_begins, last - 1);
    for (const std::size_t kept : {1U, 31U, 32U, 500U}) {
        const std::string part = whole.substr(last, kept);
        directory.write("tail.rec", whole + part);
        EXPECT_EQ(read_recording(directory.file("tail.rec"), false).calls.size(), 20U) << kept;
        // Another process went on behind it.
        directory.write("middle.rec", whole.substr(0, before_last) + part + whole.substr(before_last));
        EXPECT_EQ(read_recording(directory.file("middle.rec"), false).calls.size(), 20U) << kept;
    }
}

TEST(Record, DamagedAndForeignFilesAreRefused) {
    const Directory directory;
    ASSERT_EQ(shell(directory, "LODE_RECORD=run.rec '" THREADED_HOST "' 1 20").status, 0);
    const std::string whole = directory.read("run.rec");
    const auto expect_refusal = [&](const std::string& bytes, const char* reason) {
        directory.write("bad.rec", bytes);
        const Result result = rerun(directory, "bad.rec");
        EXPECT_EQ(result.status, static_cast<int>(Status::bad_deck)) << reason;
        EXPECT_NE(result.out.find(reason), std::string::npos) << result.out;
    };
    expect_refusal("", "too short");
    expect_refusal("This is some other file, not a recording.", "not a recording");
    expect_refusal(whole.substr(0, whole.size() - 7), "ends inside a frame after 19 whole calls");
    const std::uint32_t mark = record::frame_mark;
    expect_refusal(whole.substr(0, whole.rfind(std::string(reinterpret_cast<const char*>(&mark), sizeof mark))),
                   "bytes are missing at the end of the file after 19 whole calls");
    std::string flipped = whole;
    flipped[whole.size() / 2] = static_cast<char>(flipped[whole.size() / 2] ^ 4);
    expect_refusal(flipped, "checksum");
    std::string newer = whole;
    newer[8] = 99;
    expect_refusal(newer, "format version 99");

    directory.write("short.rec", whole.substr(0, whole.size() - 7));
    const Result salvaged = rerun(directory, "short.rec --salvage");
    EXPECT_EQ(salvaged.status, 0) << salvaged.out;
    EXPECT_NE(salvaged.out.find("19 of 19"), std::string::npos) << salvaged.out;

    // Nothing is written to a file that is not a recording.
    directory.write("notes.txt", "mine");
    const Result made = shell(directory, "LODE_RECORD=notes.txt '" THREADED_HOST "' 1 5");
    EXPECT_EQ(made.status, 0);
    EXPECT_NE(made.out.find("not a recording; nothing is recorded"), std::string::npos) << made.out;
    EXPECT_EQ(directory.read("notes.txt"), "mine");
}

TEST(Record, AHistoryBecomesADeckWithTheSameStresses) {
    for (const bool finite : {false, true}) {
        const Directory directory;
        const std::string step = finite ? "deformation_gradient = [[1.02, 0.05, 0], [0, 0.98, 0.01], [0, 0, 1.01]]"
                                        : "strain = { 11 = 0.01, 12 = -0.004 }\ntemperature = 15";
        directory.write("deck.toml", elastic_deck("", step));
        ASSERT_EQ(replay(directory, "", "deck.toml").status, 0);
        const Result made = rerun(directory, "run.rec --deck again.toml");
        ASSERT_EQ(made.status, 0) << made.out;
        const Result again = shell(directory, "LODE_RECORD=again.rec '" LODE_EXECUTABLE "' replay -q again.toml");
        ASSERT_EQ(again.status, 0) << again.out;
        const Recording first = read_recording(directory.file("run.rec"), false);
        const Recording second = read_recording(directory.file("again.rec"), false);
        const auto a = history_of(first, {1, 1}), b = history_of(second, {1, 1});
        ASSERT_EQ(a.size(), 7U);
        ASSERT_EQ(b.size(), 7U);
        for (std::size_t i = 0; i < a.size(); ++i)
            for (std::size_t c = 0; c < 6; ++c)
                EXPECT_NEAR(a[i]->output(record::UmatOutput::stress)[c], b[i]->output(record::UmatOutput::stress)[c],
                            1e-9 * 210000 * 0.02)
                    << "increment " << i + 1 << ", component " << c;
    }
}

TEST(Record, ShowsACallAndMeasuresTimes) {
    const Directory directory;
    directory.write("deck.toml", clay);
    ASSERT_EQ(replay(directory, "", "deck.toml").status, 0);
    const Result shown = rerun(directory, "run.rec --at 2");
    EXPECT_EQ(shown.status, 0);
    for (const char* word : {"PROPS", "DSTRAN", "DFGRD1", "DDSDDE", "CAM_CLAY-CLAY, element 1"})
        EXPECT_NE(shown.out.find(word), std::string::npos) << word;
    EXPECT_EQ(rerun(directory, "run.rec --at 9999").status, static_cast<int>(Status::usage));
    const Result timed = rerun(directory, "run.rec --time");
    EXPECT_NE(timed.out.find("ns a call"), std::string::npos) << timed.out;
    EXPECT_NE(timed.out.find("slowest"), std::string::npos);
    ASSERT_EQ(rerun(directory, "run.rec --plot history").status, 0);
    EXPECT_NE(directory.read("history.csv").find("time,strain1"), std::string::npos);
}

#ifdef FORTRAN_HOST
TEST(Record, TheFortranHostRerunsBitForBit) {
    const Directory directory;
    const Result host = shell(directory, "LODE_RECORD=run.rec '" FORTRAN_HOST "'");
    ASSERT_EQ(host.status, 0) << host.out;
    EXPECT_GT(read_recording(directory.file("run.rec"), false).calls.size(), 5U);
    const Result again = rerun(directory, "run.rec");
    EXPECT_EQ(again.status, 0) << again.out;
}
#endif

#ifdef THIRD_PARTY_LIBRARY
TEST(Record, TheStandAloneRecorderServesAnyLibrary) {
    const Directory directory;
    const Result made =
        shell(directory, "LODE_RECORD=run.rec LODE_RECORD_LIBRARY='" THIRD_PARTY_LIBRARY "' '" LODE_EXECUTABLE
                         "' replay -q '" THIRD_PARTY_DECK "' --library '" LODE_RECORDER "'");
    ASSERT_EQ(made.status, 0) << made.out;
    const Recording recording = read_recording(directory.file("run.rec"), false);
    EXPECT_GT(recording.calls.size(), 50U);
    EXPECT_EQ(recording.sessions[0].library, THIRD_PARTY_LIBRARY);
    const Result again = rerun(directory, "run.rec --library '" THIRD_PARTY_LIBRARY "'");
    EXPECT_EQ(again.status, 0) << again.out;

    const Result nameless = shell(directory, "env -u LODE_RECORD_LIBRARY '" LODE_EXECUTABLE
                                             "' replay -q '" THIRD_PARTY_DECK "' --library '" LODE_RECORDER "'");
    EXPECT_EQ(nameless.status, 65);
    EXPECT_NE(nameless.out.find("LODE_RECORD_LIBRARY must name"), std::string::npos) << nameless.out;
}
#endif

}  // namespace
}  // namespace lode::host::test
