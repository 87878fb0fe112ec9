// Decks that are wrong are refused with file, line, key and what would be legal.
#include "support.hpp"

namespace lode::host::test {
namespace {

struct Wrong {
    const char* name;
    std::string text;
    int line;
    const char* key;
    const char* says;
};

std::ostream& operator<<(std::ostream& stream, const Wrong& wrong) { return stream << wrong.name; }

const std::string material = "[material]\nname = \"ELASTIC\"\nconstants = [1000, 0.3]\n";  // three lines
const std::string one_step = "[[step]]\nstrain = { 11 = 0.01 }\n";

class DeckErrors : public testing::TestWithParam<Wrong> {};

TEST_P(DeckErrors, NameFileLineAndKey) {
    const Directory directory;
    const std::string path = directory.write("deck.toml", GetParam().text);
    try {
        read_deck(path);
        FAIL() << "was accepted";
    } catch (const BadDeck& error) {
        const std::string message = error.what(), place = path + ":" + std::to_string(GetParam().line) + ": ";
        EXPECT_EQ(message.find(place), 0U) << message;
        EXPECT_NE(message.find(GetParam().key), std::string::npos) << message;
        EXPECT_NE(message.find(GetParam().says), std::string::npos) << message;
    }
}

INSTANTIATE_TEST_SUITE_P(
    Keys, DeckErrors,
    testing::Values(
        Wrong{"not_toml", "title = \"x\"\n[material\n", 2, "", "not TOML"},
        Wrong{"no_material", one_step, 1, "", "[material] is missing"},
        Wrong{"no_step", material, 1, "", "no [[step]]"},
        Wrong{"no_name", "[material]\nconstants = [1]\n" + one_step, 1, "material.name", "missing"},
        Wrong{"no_constants", "[material]\nname = \"A\"\n" + one_step, 1, "material", "constants are missing"},
        Wrong{"both_sources", material + "input_file = \"x.inp\"\n" + one_step, 4, "material.input_file", "either"},
        Wrong{"constants_not_numbers", "[material]\nname = \"A\"\nconstants = [1, \"2\"]\n" + one_step, 3,
              "material.constants", "entry 2"},
        Wrong{"unknown_table", material + one_step + "[output]\n[ouput]\n", 7, "ouput", "did you mean \"output\""},
        Wrong{"unknown_material_key", material + "densty = 2\n" + one_step, 4, "material.densty",
              "did you mean \"density\""},
        Wrong{"unknown_kind", material + "[analysis]\nkind = \"plane_stres\"\n" + one_step, 5, "analysis.kind",
              "did you mean \"plane_stress\""},
        Wrong{"unknown_analysis_key", material + "[analysis]\nlarge_rotatoin = true\n" + one_step, 5,
              "analysis.large_rotatoin", "did you mean \"large_rotation\""},
        Wrong{"interface", material + "[analysis]\ninterface = \"uel\"\n" + one_step, 5, "analysis.interface",
              "umat, vumat"},
        Wrong{"flag", material + "[analysis]\nlarge_rotation = 1\n" + one_step, 5, "analysis.large_rotation",
              "true or false"},
        Wrong{"negative_length", material + "[analysis]\nelement_length = -1\n" + one_step, 5,
              "analysis.element_length", "positive"},
        Wrong{"infinite_time", material + one_step + "time = inf\n", 6, "step[1].time", "positive"},
        Wrong{"zero_increments", material + one_step + "increments = 0\n", 6, "step[1].increments", "from 1"},
        Wrong{"fractional_increments", material + one_step + "increments = 2.5\n", 6, "step[1].increments",
              "whole number"},
        Wrong{"both_increments", material + one_step + "increments = 2\nautomatic = {}\n", 7, "step[1].automatic",
              "either"},
        Wrong{"automatic_key", material + one_step + "automatic = { inital = 0.1 }\n", 6, "step[1].automatic.inital",
              "did you mean \"initial\""},
        Wrong{"automatic_order", material + one_step + "automatic = { initial = 0.1, minimum = 0.2 }\n", 6,
              "automatic.minimum", "larger than initial"},
        Wrong{"component", material + "[[step]]\nstrain = { 14 = 1 }\n", 5, "step[1].strain.14",
              "11, 22, 33, 12, 13, 23"},
        Wrong{"component_of_kind",
              "[analysis]\nkind = \"plane_stress\"\n" + material + "[[step]]\nstress = { 33 = 0 }\n", 7,
              "step[1].stress.33", "plane_stress has no such component"},
        Wrong{"plane_strain_33", "[analysis]\nkind = \"plane_strain\"\n" + material + "[[step]]\nstrain = { 33 = 0 }\n",
              7, "strain.33", "holds strain 33"},
        Wrong{"twice", material + "[[step]]\nstrain = { 11 = 1 }\nstress = { 11 = 1 }\n", 6, "stress.11", "twice"},
        Wrong{"twice_swapped", material + "[[step]]\nstrain = { 12 = 1, 21 = 1 }\n", 5, "strain.21", "twice"},
        Wrong{"strain_of_cohesive",
              "[analysis]\nkind = \"cohesive_2d\"\n" + material + "[[step]]\nstrain = { 11 = 1 }\n", 7,
              "step[1].strain", "separation"},
        Wrong{"text_value", material + "[[step]]\nstrain = { 11 = \"much\" }\n", 5, "strain.11", "number"},
        Wrong{"amplitude_start", material + one_step + "amplitude = [[0, 1], [1, 0]]\n", 6, "amplitude", "[0, 0]"},
        Wrong{"amplitude_order", material + one_step + "amplitude = [[0, 0], [0.5, 1], [0.5, 2], [1, 0]]\n", 6,
              "amplitude", "ascend"},
        Wrong{"amplitude_end", material + one_step + "amplitude = [[0, 0], [0.5, 1]]\n", 6, "amplitude", "fraction 1"},
        Wrong{"ragged", material + one_step + "amplitude = [[0, 0], [0.5]]\n", 6, "amplitude", "equally long"},
        Wrong{"gradient_shape", material + "[[step]]\ndeformation_gradient = [[1, 0], [0, 1]]\n", 5,
              "deformation_gradient", "three rows"},
        Wrong{"gradient_sign", material + "[[step]]\ndeformation_gradient = [[-1, 0, 0], [0, 1, 0], [0, 0, 1]]\n", 5,
              "deformation_gradient", "determinant"},
        Wrong{"gradient_and_strain", material + one_step + "rotation = { angle_degrees = 9 }\n", 6, "step[1].rotation",
              "either"},
        Wrong{"gradient_without_rotation",
              material + "[analysis]\nlarge_rotation = false\n[[step]]\nrotation = { angle_degrees = 9 }\n", 7,
              "rotation", "large_rotation"},
        Wrong{"angle", material + "[[step]]\nrotation = { axis = [0, 0, 1] }\n", 5, "step[1].rotation",
              "angle_degrees"},
        Wrong{"axis",
              "[analysis]\nkind = \"plane_strain\"\n" + material +
                  "[[step]]\nrotation = { axis = [1, 0, 0], angle_degrees = 5 }\n",
              7, "rotation.axis", "axis 3"},
        Wrong{"field_count", material + one_step + "field = [1]\n[[step]]\nfield = [1, 2]\n", 8, "step[2].field",
              "1 field"},
        Wrong{"initial_state", material + "state_variables = 1\ninitial_state = [1, 2]\n" + one_step, 5,
              "material.initial_state", "2 values"},
        Wrong{"initial_stress", material + "initial_stress = { 44 = 1 }\n" + one_step, 4, "material.initial_stress.44",
              "11, 22"},
        Wrong{"expansion", material + "expansion = [1, 2]\n" + one_step, 4, "material.expansion", "three"},
        Wrong{"group_key", material + "[[step]]\ntime = 2\n[[step.step]]\nstrain = { 11 = 1 }\n", 5, "step[1].time",
              "repeat"},
        Wrong{"plot", material + one_step + "[output]\nplot = { x = \"time\" }\n", 7, "output.plot.y", "columns"},
        Wrong{"units", material + one_step + "[output]\nunits = { stres = \"MPa\" }\n", 7, "output.units.stres",
              "stress"}),
    [](const auto& wrong) { return wrong.param.name; });

TEST(Deck, MissingFile) {
    EXPECT_THROW(read_deck("there-is-no-such.toml"), BadDeck);
    const Directory directory;
    EXPECT_THROW(read_deck(directory.file("")), BadDeck) << "a directory is no deck";
}

TEST(Deck, TenLinesAreEnough) {
    const History run =
        finished_run("[material]\nname = \"ELASTIC\"\nconstants = [1000, 0.3]\n[[step]]\nstrain = { 11 = 0.01 }\n");
    EXPECT_EQ(run.outcome.statistics.increments, 100);
    EXPECT_NEAR(run.stress(0), 10, 1e-7);
}

TEST(Deck, InitialStateByIndex) {
    const Scenario scenario = scenario_of(material + "initial_state = { 3 = 5, 1 = 2 }\n" + one_step);
    EXPECT_EQ(scenario.material.initial_state, (std::vector<double>{2, 0, 5}));
    const History run = run_scenario(scenario);
    EXPECT_EQ(run.end().state.size(), 3U);
}

TEST(Deck, UnknownStateNameIsRefusedWithItsPlace) {
    const Scenario scenario = scenario_of(material + "initial_state = { EQPS = 5 }\n" + one_step);
    try {
        run_scenario(scenario);
        FAIL() << "was accepted";
    } catch (const BadDeck& error) {
        EXPECT_NE(std::string(error.what()).find("deck.toml:4: material.initial_state.EQPS"), std::string::npos)
            << error.what();
    }
}

}  // namespace
}  // namespace lode::host::test
