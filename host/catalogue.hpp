// `lode models`: the models of a library, as a table or as reference pages.
#ifndef LODE_HOST_CATALOGUE_HPP
#define LODE_HOST_CATALOGUE_HPP

#include <string>

#include "library.hpp"
#include "status.hpp"

namespace lode::host {

struct CatalogueOptions {
    std::string keyword, library, markdown_directory;
};

// Prints to standard output, or writes one page a model. Errors are thrown as Failure.
Status list_models(const CatalogueOptions& options);

std::string model_table(const Library& library);
// Markdown, with tables that are as readable in a terminal.
std::string reference_page(const lode_model& model, const Library& library);

}  // namespace lode::host

#endif
