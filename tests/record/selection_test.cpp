// LODE_RECORD=file[:selection]
#include "record/selection.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <stdexcept>

namespace lode::record {
namespace {

TEST(RecordSelection, NothingSelectsEverything) {
    const Request request = parse_request("/tmp/a:b/run.rec");
    EXPECT_EQ(request.file, "/tmp/a:b/run.rec");
    EXPECT_TRUE(selects(request.selection.elements, 123456));
    EXPECT_TRUE(selects_material(request.selection, "ANY-THING"));
    EXPECT_EQ(request.selection.ring, 0);
    EXPECT_FALSE(request.selection.only_cut);
}

TEST(RecordSelection, ReadsEveryKey) {
    const Request request = parse_request(
        "run.rec:material=iso_plastic|CAM_CLAY-A,element=12|15-20,point=1,step=2,increment=50-60,last=1000,"
        "fields=3,cut");
    const Selection& s = request.selection;
    EXPECT_EQ(request.file, "run.rec");
    EXPECT_TRUE(selects_material(s, "ISO_PLASTIC-STEEL")) << "by the keyword";
    EXPECT_TRUE(selects_material(s, "cam_clay-a"));
    EXPECT_FALSE(selects_material(s, "CAM_CLAY-B"));
    for (const int element : {12, 15, 20}) EXPECT_TRUE(selects(s.elements, element)) << element;
    for (const int element : {11, 13, 14, 21}) EXPECT_FALSE(selects(s.elements, element)) << element;
    EXPECT_FALSE(selects(s.points, 2));
    EXPECT_TRUE(selects(s.steps, 2));
    EXPECT_TRUE(selects(s.increments, 55));
    EXPECT_EQ(s.ring, 1000);
    EXPECT_EQ(s.fields, 3);
    EXPECT_TRUE(s.only_cut);
}

TEST(RecordSelection, NamesWhatItDoesNotUnderstand) {
    for (const char* wrong : {"a.rec:elements=3", "a.rec:element=x", "a.rec:element=5-3", "a.rec:last=0", "a.rec:cut=1",
                              "a.rec:material=", "a.rec:", ":element=3", ""}) {
        try {
            parse_request(wrong);
            ADD_FAILURE() << wrong << " was accepted";
        } catch (const std::invalid_argument& refusal) {
            EXPECT_EQ(std::string(refusal.what()).find("LODE_RECORD: "), 0U) << refusal.what();
        }
    }
}

TEST(RecordSelection, PutsTheProcessIntoTheFileName) {
    EXPECT_EQ(parse_request("run-%p.rec").file, "run-" + std::to_string(getpid()) + ".rec");
}

}  // namespace
}  // namespace lode::record
