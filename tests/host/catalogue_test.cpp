// `lode models` and what a deck takes from the catalogue of a library.
#include "catalogue.hpp"

#include "cards.hpp"
#include "support.hpp"

namespace lode::host::test {
namespace {

class Catalogue : public testing::Test {
  protected:
    Library library{HOST_TEST_CATALOGUE};
    const lode_model& spring = *library.model_of("spring-eight");
    const lode_model& finite = *library.model_of("FINITE");

    static void expect_all(const std::string& text, std::initializer_list<const char*> parts) {
        for (const char* part : parts)
            EXPECT_NE(text.find(part), std::string::npos) << part << "\nis missing in\n" << text;
    }
};

TEST_F(Catalogue, ModelsAreFoundByMaterialName) {
    EXPECT_STREQ(library.model_of("@ABAQUS_LODE_UMAT@Spring-x")->keyword, "SPRING");
    EXPECT_EQ(library.model_of("SPRINGS"), nullptr);
    expect_all(model_table(library), {"SPRING", "A finite model", "2/3", "3d plane_stress"});
}

// A library of others: what it has is used, what it lacks is not asked for.
TEST(LibraryOfOthers, SaysNothingOfItsSolutions) {
    const Library others(HOST_TEST_LIBRARY);
    EXPECT_NE(others.umat(), nullptr);
    EXPECT_EQ(others.observed_umat(), nullptr);
}

TEST_F(Catalogue, ReferencePage) {
    expect_all(reference_page(spring, library),
               {"# SPRING: A spring", "Shows what a page looks like.", "3d (3,3), plane_stress (2,1)", "UNSYMM",
                "| 1   | K ", "> 0 ", "-1 < x < 0.5", "0..2", "- MODE: 0 slow; 1 fast", "1 (or 0)", "required",
                "| COUNT |", "2.5", "PROPS(3) = 1", "exact", "- Fails at nothing."});
}

TEST_F(Catalogue, AbaqusCards) {
    EXPECT_EQ(abaqus_cards(spring, spring.samples[0], library),
              "*MATERIAL, NAME=SPRING-EIGHT\n*USER MATERIAL, CONSTANTS=8, UNSYMM\n1000, 0.25, 1, 4, 5, 6, 7, "
              "8\n*DEPVAR\n2\n");
    EXPECT_EQ(abaqus_cards(spring, spring.samples[1], library),
              "*MATERIAL, NAME=SPRING-TWO\n*USER MATERIAL, CONSTANTS=2, UNSYMM\n1000, 0.25\n*DEPVAR\n1\n");
    EXPECT_EQ(abaqus_cards(finite, finite.samples[0], library),
              "*MATERIAL, NAME=FINITE-RUBBER\n*USER MATERIAL, CONSTANTS=2\n10, 40\n");
}

TEST_F(Catalogue, CalculixCards) {
    // After a multiple of eight constants the temperature needs a line of its own.
    expect_all(calculix_cards(spring, spring.samples[0], library),
               {"NAME=ABAQUSSPRING-EIGHT\n", "CONSTANTS=8\n1000, 0.25, 1, 4, 5, 6, 7, 8\n0\n*DEPVAR\n2\n"});
    EXPECT_EQ(calculix_cards(spring, spring.samples[1], library), "") << "CalculiX has no plane stress";
    expect_all(calculix_cards(finite, finite.samples[0], library), {"NAME=ABAQUSNLFINITE-RUBBER\n"});
}

TEST_F(Catalogue, PrintedDecksAndCardsRun) {
    const Directory directory;
    for (const lode_model* model : library.models())
        for (int i = 0; i < model->sample_count; ++i) {
            const std::string deck = directory.write("deck.toml", replay_deck(*model, model->samples[i]));
            EXPECT_EQ(run_scenario(read_deck(deck), HOST_TEST_CATALOGUE).outcome.status, Status::success);
            directory.write("job.inp", abaqus_cards(*model, model->samples[i], library));
            const Scenario scenario = read_deck(directory.write(
                "cards.toml", "[material]\ninput_file = \"job.inp\"\n[[step]]\nstrain = { 11 = 0.01 }\n"));
            EXPECT_EQ(scenario.material.name, material_name(*model, model->samples[i]));
        }
}

TEST_F(Catalogue, StateCountAndInitialValuesByName) {
    const History run = run_scenario(
        scenario_of("[material]\nname = \"SPRING-A\"\nconstants = [1000, 0.2]\ninitial_state = { AGE = 7 }\n"
                    "[[step]]\nstrain = { 11 = 0.01 }\nincrements = 3\n"),
        HOST_TEST_CATALOGUE);
    ASSERT_EQ(run.end().state.size(), 2U);
    EXPECT_EQ(run.state(1), 7);
    EXPECT_EQ(run.state(0), 3);
}

TEST_F(Catalogue, RefusedConstantsEndBeforeTheRun) {
    const Scenario scenario = scenario_of("[material]\nname = \"SPRING-A\"\nconstants = [-1, 0.2]\n[[step]]\n");
    try {
        run_scenario(scenario, HOST_TEST_CATALOGUE);
        FAIL() << "was accepted";
    } catch (const Refused& refusal) {
        EXPECT_STREQ(refusal.what(), "SPRING-A: K has to be positive");
    }
}

TEST_F(Catalogue, FiniteStrainModelsSwitchLargeRotationOn) {
    const std::string material = "[material]\nname = \"FINITE\"\nconstants = [10, 40]\n";
    const History run = run_scenario(scenario_of(material + "[[step]]\nstrain = { 11 = 0.5 }\n"), HOST_TEST_CATALOGUE);
    EXPECT_NEAR(run.end().F(0, 0), std::exp(0.5), 1e-14);
    const Scenario linear =
        scenario_of(material + "[analysis]\nlarge_rotation = false\n[[step]]\nstrain = { 11 = 0.5 }\n");
    try {
        run_scenario(linear, HOST_TEST_CATALOGUE);
        FAIL() << "was accepted";
    } catch (const BadDeck& error) {
        EXPECT_NE(std::string(error.what()).find("deck.toml:5: analysis.large_rotation: "), std::string::npos)
            << error.what();
    }
}

TEST_F(Catalogue, ExplicitPlaneStressGetsItsLabel) {
    const History run = run_scenario(
        scenario_of("[material]\nname = \"SPRING-TWO\"\nconstants = [1000, 0.2]\n[analysis]\nkind = \"plane_stress\"\n"
                    "interface = \"vumat\"\n[[step]]\nstrain = { 11 = 0.01 }\n"),
        HOST_TEST_CATALOGUE);
    EXPECT_EQ(run.state(0), 1);
}

}  // namespace
}  // namespace lode::host::test
