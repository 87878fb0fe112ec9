// The advice in words, as a table and as something to paste.
#ifndef LODE_HOST_ADVISE_REPORT_HPP
#define LODE_HOST_ADVISE_REPORT_HPP

#include <string>

#include "../study/table.hpp"
#include "advise.hpp"

namespace lode::host {

std::string text(const Advice& advice);
Table evidence(const Advice& advice);
// Cards of the recommended setting: Abaqus, and what to change in the deck.
std::string cards(const Option& option, const Library& library);

}  // namespace lode::host

#endif
