// The command line of `lode`.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>

#include "catalogue.hpp"
#include "guard.hpp"
#include "replay/command.hpp"
#include "status.hpp"

namespace {

using lode::host::Status;

int run(int argc, char** argv) {
    CLI::App app{"Mock host for UMAT and VUMAT material libraries", "lode"};
    app.set_version_flag("--version", std::string("lode ") + LODE_HOST_VERSION);
    app.require_subcommand(1);
    app.footer(
        "Exit status: 0 success, 1 bad command line, 2 bad deck, 3 no convergence, 4 refused by the library "
        "(or XIT), 5 library not loaded");

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
    replay->add_flag("-q,--quiet", replay_options.quiet, "Print errors only");

    lode::host::CatalogueOptions catalogue_options;
    CLI::App* const models = app.add_subcommand("models", "List the models of a library, or describe one");
    models->add_option("name", catalogue_options.keyword, "Keyword of the model to describe");
    models->add_option("-l,--library", catalogue_options.library,
                       "Shared object with the catalogue (default: liblode.so)");
    models->add_option("-m,--markdown", catalogue_options.markdown_directory,
                       "Write a reference page for each model (or the named one) to this directory");

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
