// What the checks found, as text, JSON and HTML.
#ifndef LODE_HOST_CHECK_REPORT_HPP
#define LODE_HOST_CHECK_REPORT_HPP

#include <string>
#include <vector>

#include "run.hpp"

namespace lode::host {

// One line of the table, with the findings below it.
std::string text_line(const CheckResult& result);
// "12 pass, 1 warning, 2 FAIL".
std::string summary(const std::vector<SubjectReport>& reports);

// Throw Failure (usage) if the file cannot be written. The page holds its figures itself; without gnuplot it has none.
void write_json(const std::vector<SubjectReport>& reports, const std::string& path);
void write_html(const std::vector<SubjectReport>& reports, const std::string& path);

}  // namespace lode::host

#endif
