// Material cards of the user's own input file.
#include "replay/abaqus_input.hpp"

#include "support.hpp"

namespace lode::host::test {
namespace {

constexpr const char* job = R"(** a job with two user materials
*Heading
 does not matter
*Material, name=Steel
*Elastic
210000., 0.3
*MATERIAL, NAME="J2-sheet"
*Density
 7.85e-9,
*Depvar
 3,
1, EQPS, "equivalent plastic strain"
*User Material, constants=10, unsymm
** continuation lines of eight
 2.1D5, .3, 250., 2000., 1, 2, 3, 4,
 5.5, -6e-1
*Expansion, type=ORTHO
1e-5, 2e-5, 3e-5
*MATERIAL,
 NAME=other
*user  material, CONSTANTS=1
 7
*Step
)";

TEST(AbaqusInput, ReadsTheCards) {
    const Directory directory;
    const auto materials = read_material_cards(directory.write("job.inp", job));
    ASSERT_EQ(materials.size(), 2U) << "Steel is no user material";
    const MaterialCards& sheet = materials[0];
    EXPECT_EQ(sheet.name, "J2-SHEET");
    EXPECT_EQ(sheet.constants, (std::vector<double>{2.1e5, 0.3, 250, 2000, 1, 2, 3, 4, 5.5, -0.6}));
    EXPECT_TRUE(sheet.unsymmetric);
    EXPECT_EQ(sheet.state_variables, 3);
    EXPECT_EQ(sheet.density, 7.85e-9);
    EXPECT_EQ(sheet.expansion, (std::vector<double>{1e-5, 2e-5, 3e-5}));
    EXPECT_EQ(materials[1].name, "OTHER");
    EXPECT_FALSE(materials[1].state_variables.has_value());
}

TEST(AbaqusInput, FollowsIncludes) {
    const Directory directory;
    directory.write("materials.inc", "*MATERIAL, NAME=IN\n*USER MATERIAL, CONSTANTS=2\n1, 2\n");
    const auto materials = read_material_cards(directory.write("job.inp", "*INCLUDE, INPUT=materials.inc\n"));
    EXPECT_EQ(materials.front().name, "IN");
}

TEST(AbaqusInput, ADeckTakesMaterialAndStateFromIt) {
    const Directory directory;
    directory.write("job.inp", job);
    const std::string deck = directory.write(
        "deck.toml", "[material]\ninput_file = \"job.inp\"\nname = \"j2-sheet\"\n[[step]]\nstrain = { 11 = 0.001 }\n");
    const Scenario scenario = read_deck(deck);
    EXPECT_EQ(scenario.material.name, "J2-SHEET");
    EXPECT_EQ(scenario.material.constants.size(), 10U);
    EXPECT_EQ(scenario.material.state_variables, 3);
    EXPECT_EQ(scenario.material.density, 7.85e-9);
    const History run = run_scenario(scenario);
    EXPECT_EQ(run.end().state.size(), 3U);
    EXPECT_NEAR(run.stress(0), 210, 1e-6);
}

TEST(AbaqusInput, ADeckHasToChooseAmongSeveral) {
    const Directory directory;
    directory.write("job.inp", job);
    const auto message = [&](const std::string& name) -> std::string {
        try {
            read_deck(directory.write("deck.toml", "[material]\ninput_file = \"job.inp\"\n" + name + "[[step]]\n"));
        } catch (const BadDeck& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_NE(message("").find("J2-SHEET, OTHER"), std::string::npos) << message("");
    EXPECT_NE(message("name = \"J2-SHET\"\n").find("did you mean \"J2-SHEET\""), std::string::npos);
}

struct BadCards {
    const char* text;
    int line;
    const char* says;
};
class AbaqusInputErrors : public testing::TestWithParam<BadCards> {};

TEST_P(AbaqusInputErrors, NameFileLineAndCard) {
    const Directory directory;
    const std::string path = directory.write("job.inp", GetParam().text);
    try {
        read_material_cards(path);
        FAIL() << "was accepted";
    } catch (const BadDeck& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.find(path + (GetParam().line > 0 ? ":" + std::to_string(GetParam().line) + ": *" : ": ")), 0U)
            << message;
        EXPECT_NE(message.find(GetParam().says), std::string::npos) << message;
    }
}

INSTANTIATE_TEST_SUITE_P(
    Cards, AbaqusInputErrors,
    testing::Values(BadCards{"*MATERIAL\n*USER MATERIAL, CONSTANTS=1\n1\n", 1, "NAME"},
                    BadCards{"*MATERIAL, NAME=A\n*USER MATERIAL\n1\n", 2, "CONSTANTS=n is missing"},
                    BadCards{"*MATERIAL, NAME=A\n*USER MATERIAL, CONSTANTS=x\n1\n", 2, "whole number"},
                    BadCards{"*MATERIAL, NAME=A\n*USER MATERIAL, CONSTANTS=3\n1, 2\n", 3, "2 values where 3"},
                    BadCards{"*MATERIAL, NAME=A\n*USER MATERIAL, CONSTANTS=10\n1, 2, 3\n4, 5\n", 3, "eight a line"},
                    BadCards{"*MATERIAL, NAME=A\n*USER MATERIAL, CONSTANTS=9\n1, 2, 3, 4, 5, 6, 7, 8\n", 2, "hold 8"},
                    BadCards{"*MATERIAL, NAME=A\n*USER MATERIAL, CONSTANTS=2\n1, 2x\n", 3, "\"2x\" is not a number"},
                    BadCards{"*MATERIAL, NAME=A\n*EXPANSION\n1e-5, 20\n2e-5, 100\n*USER MATERIAL, CONSTANTS=1\n1\n", 2,
                             "one data line"},
                    BadCards{"*MATERIAL, NAME=A\n*ELASTIC\n1, 0\n", 0, "no *MATERIAL with a *USER MATERIAL"},
                    BadCards{"*INCLUDE, INPUT=job.inp\n", 1, "too deeply"}));

}  // namespace
}  // namespace lode::host::test
