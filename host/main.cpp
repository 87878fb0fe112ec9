// The command line of `lode`.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>

#include "advise/command.hpp"
#include "atlas/command.hpp"
#include "catalogue.hpp"
#include "chart/command.hpp"
#include "check/command.hpp"
#include "guard.hpp"
#include "replay/command.hpp"
#include "rerun/command.hpp"
#include "status.hpp"

namespace {

using lode::host::Status;

int run(int argc, char** argv) {
    CLI::App app{"Mock host for UMAT and VUMAT material libraries", "lode"};
    app.set_version_flag("--version", std::string("lode ") + LODE_HOST_VERSION);
    app.require_subcommand(1);
    app.footer(
        "Exit status: 0 success, 1 bad command line, 2 bad deck, 3 no convergence, 4 refused by the library "
        "(or XIT), 5 library not loaded, 6 different from the recording, 7 different from the closed form, "
        "8 a check failed");

    lode::host::ReplayOptions replay_options;
    std::string entry;
    CLI::App* const replay = app.add_subcommand("replay", "Drive one material point through the steps of a deck");
    replay->add_option("deck", replay_options.deck, "The deck, a TOML file")->required();
    replay->add_option("-l,--library", replay_options.library,
                       "Shared object with umat_ or vumat_ (default: liblode.so)");
    replay->add_option("-o,--output", replay_options.output_directory,
                       "Directory for the files (default: the current one)");
    replay->add_option("-i,--interface", entry, "umat or vumat, instead of the deck's choice")
        ->check(CLI::IsMember({"umat", "vumat"}));
    replay->add_flag("--verify", replay_options.verify,
                     "Compare manufactured steps with their closed forms, through umat_ and vumat_");
    replay->add_flag("-q,--quiet", replay_options.quiet, "Print errors only");

    lode::host::CatalogueOptions catalogue_options;
    CLI::App* const models = app.add_subcommand("models", "List the models of a library, or describe one");
    models->add_option("name", catalogue_options.keyword, "Keyword of the model to describe");
    models->add_option("-l,--library", catalogue_options.library,
                       "Shared object with the catalogue (default: liblode.so)");
    models->add_option("-m,--markdown", catalogue_options.markdown_directory,
                       "Write a reference page for each model (or the named one) to this directory");

    lode::host::ChartOptions chart_options;
    CLI::App* const chart = app.add_subcommand("chart", "Chart accuracy against cost of a deck or of a material");
    chart->add_option("target", chart_options.targets, "Decks, or materials: KEYWORD or KEYWORD-LABEL");
    chart->add_flag("--all", chart_options.all, "Every material of the library");
    chart->add_flag("--first", chart_options.first, "Only the first sample of each model");
    chart->add_option("-l,--library", chart_options.library,
                      "Shared object with umat_ or vumat_ (default: liblode.so)");
    chart->add_option("--single-library", chart_options.single_library,
                      "Its twin for single-precision hosts (default: liblode-sp.so beside liblode.so)");
    chart->add_option("-o,--output", chart_options.output_directory,
                      "Directory for the files (default: the current one)");
    chart->add_option("-p,--path", chart_options.path, "One of the built-in paths, e.g. corner (default: all)");
    chart->add_option("-k,--kind", chart_options.kinds,
                      "Kinds, e.g. 3d plane_stress (default: of a deck all that fit, of a material the fullest)");
    chart
        ->add_option("-n,--increments", chart_options.increments,
                     "Increments a step, e.g. 1,4,16 (default: 1,2,4,...,128)")
        ->delimiter(',')
        ->check(CLI::Range(1, 100000));
    chart->add_flag("--no-cost", chart_options.no_cost, "Errors and orders only");
    chart->add_flag("-q,--quiet", chart_options.quiet, "Print errors only");

    lode::host::RerunOptions rerun_options;
    CLI::App* const rerun = app.add_subcommand("rerun", "Run the calls again that LODE_RECORD has stored");
    rerun->add_option("recording", rerun_options.file, "The file that LODE_RECORD named")->required();
    rerun->add_option("-l,--library", rerun_options.library,
                      "Shared object with umat_ or vumat_ (default: liblode.so)");
    rerun->add_option("--at", rerun_options.at, "Show the call of this number in full");
    rerun->add_option("--deck", rerun_options.deck, "Write the history of a point as a deck for `lode replay`");
    rerun->add_option("--plot", rerun_options.plot, "Draw the history of a point: PLOT.png, .svg, .csv");
    rerun->add_option("--element", rerun_options.element, "Element of the point (default: that of the first call)");
    rerun->add_option("--point", rerun_options.point, "Integration point (default: that of the first call)");
    rerun->add_flag("--time", rerun_options.time, "Measure what the calls cost");
    bool rerun_check = false, rerun_host = false;
    rerun->add_flag("--check", rerun_check, "Run the checks of `lode check` at the call of --at (default: the last)");
    rerun->add_flag("--host", rerun_host, "Look for mistakes of the host in the recorded calls");
    rerun->add_flag("--salvage", rerun_options.salvage, "Read a damaged file up to the damage");
    rerun->add_flag("-q,--quiet", rerun_options.quiet, "Print differences and errors only");

    lode::host::CheckOptions check_options;
    std::string check_entry;
    CLI::App* const check = app.add_subcommand("check", "Check a UMAT or VUMAT, of this library or of anybody else");
    check->add_option("library", check_options.library, "Shared object with umat_ or vumat_ (default: liblode.so)");
    check->add_option("-p,--props", check_options.constants, "Material constants: 210000,0.3")->delimiter(',');
    check->add_option("-n,--name", check_options.name, "Material name (CMNAME); with --card: which material");
    check->add_option("-k,--kind", check_options.kinds, "Kinds, e.g. 3d plane_stress (default: 3d; of a model: all)");
    check->add_option("--nstatv", check_options.state_variables, "Number of state variables");
    check->add_option("--state", check_options.initial_state, "State variables at the beginning: 0,0.01")
        ->delimiter(',');
    check->add_option("-c,--card", check_options.card, "Abaqus input file with the material's cards");
    check->add_option("-m,--model", check_options.model, "KEYWORD or KEYWORD-LABEL of a library that has samples");
    check->add_flag("--all", check_options.all, "All samples of the library");
    check->add_option("--strain", check_options.scale,
                      "A strain (cohesive: separation) at which the material is inelastic (default: found)");
    check->add_option("--celent", check_options.element_length, "Element length (default: 1)");
    check->add_option("--temperature", check_options.temperature, "Temperature (default: 0)");
    check->add_flag("--elastic", check_options.elastic, "The material claims to be elastic: check closed paths");
    check->add_flag("--unsymmetric", check_options.unsymmetric, "DDSDDE may be unsymmetric");
    check->add_option("--only", check_options.only, "Names of checks, see --list")->delimiter(',');
    check->add_option("-i,--interface", check_entry, "umat or vumat alone")->check(CLI::IsMember({"umat", "vumat"}));
    check->add_option("--time-limit", check_options.seconds, "Seconds for each check (default: 10)")
        ->check(CLI::Range(0.1, 1e6));
    check->add_option("--host", check_options.host, "A recording (LODE_RECORD): look for mistakes of the host instead");
    check->add_flag("--salvage", check_options.salvage, "Read a damaged recording up to the damage");
    check->add_option("--json", check_options.json, "Write the results to this file");
    check->add_option("--html", check_options.html, "Write a report with plots to this file");
    check->add_flag("--list", check_options.list, "List the checks");
    check->add_flag("-q,--quiet", check_options.quiet, "Print failures only");

    lode::host::AtlasOptions atlas_options;
    CLI::App* const atlas = app.add_subcommand("atlas", "Map where the methods of a material fail");
    atlas->add_option("target", atlas_options.targets, "Decks, or materials: KEYWORD or KEYWORD-LABEL");
    atlas->add_flag("--all", atlas_options.all, "Every material of the library");
    atlas->add_flag("--first", atlas_options.first, "Only the first sample of each model");
    atlas->add_option("-m,--map", atlas_options.maps, "Maps to draw (default: all that make sense)")
        ->check(CLI::IsMember(lode::host::atlas_maps()));
    atlas->add_option("-l,--library", atlas_options.library,
                      "Shared object with umat_ or vumat_ (default: liblode.so)");
    atlas->add_option("-o,--output", atlas_options.output_directory,
                      "Directory for the files (default: the current one)");
    atlas->add_option("-k,--kind", atlas_options.kinds,
                      "Kinds, e.g. 3d plane_stress (default: that of a deck, the fullest of a material)");
    atlas->add_flag("-q,--quiet", atlas_options.quiet, "Print errors only");

    lode::host::AdviseOptions advise_options;
    CLI::App* const advise = app.add_subcommand("advise", "Find the cheapest setting of a deck that meets a tolerance");
    advise->add_option("deck", advise_options.deck, "The deck, a TOML file")->required();
    advise
        ->add_option("-t,--tolerance", advise_options.tolerance,
                     "Error allowed, relative to the largest stress (default: 1e-3)")
        ->check(CLI::Range(1e-15, 1.0));
    advise->add_option("-l,--library", advise_options.library,
                       "Shared object with umat_ or vumat_ (default: liblode.so)");
    advise->add_option("--single-library", advise_options.single_library,
                       "Its twin for single-precision hosts (default: liblode-sp.so beside liblode.so)");
    advise->add_option("-o,--output", advise_options.output_directory, "Directory for a table of what was run");
    advise->add_flag("-q,--quiet", advise_options.quiet, "Print the cards only");

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : static_cast<int>(Status::usage);
    }

    lode::host::install_utility_handlers();
    if (*replay) {
        if (!entry.empty()) replay_options.entry = entry == "umat" ? lode::host::Entry::umat : lode::host::Entry::vumat;
        return static_cast<int>(lode::host::replay(replay_options));
    }
    if (*advise) return static_cast<int>(lode::host::advise(advise_options));
    if (*atlas) return static_cast<int>(lode::host::atlas(atlas_options));
    if (*chart) return static_cast<int>(lode::host::chart(chart_options));
    if (*check) {
        if (!check_entry.empty())
            check_options.entry = check_entry == "umat" ? lode::host::Entry::umat : lode::host::Entry::vumat;
        return static_cast<int>(lode::host::check(check_options));
    }
    if (*rerun && rerun_host) {
        check_options.host = rerun_options.file;
        check_options.salvage = rerun_options.salvage;
        check_options.quiet = rerun_options.quiet;
        return static_cast<int>(lode::host::check(check_options));
    }
    if (*rerun && rerun_check) {
        lode::host::RecordedCheckOptions recorded;
        recorded.recording = rerun_options.file;
        recorded.library = rerun_options.library;
        recorded.at = rerun_options.at;
        recorded.salvage = rerun_options.salvage;
        recorded.quiet = rerun_options.quiet;
        return static_cast<int>(lode::host::check_recorded(recorded));
    }
    if (*rerun) return static_cast<int>(lode::host::rerun(rerun_options));
    return static_cast<int>(lode::host::list_models(catalogue_options));
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const lode::host::Failure& failure) {
        std::fprintf(stderr, "%s%s\n", failure.status() == Status::bad_deck ? "" : "lode: ", failure.what());
        return static_cast<int>(failure.status());
    } catch (const std::exception& error) {
        std::fprintf(stderr, "lode: %s\n", error.what());
        return static_cast<int>(Status::usage);
    }
}
