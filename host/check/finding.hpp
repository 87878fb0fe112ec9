// What a check has found, and how it travels from the child process that ran it.
#ifndef LODE_HOST_CHECK_FINDING_HPP
#define LODE_HOST_CHECK_FINDING_HPP

#include <string>
#include <string_view>
#include <vector>

namespace lode::host {

enum class Verdict { pass, not_applicable, warning, fail };
std::string_view name_of(Verdict verdict);

// One named thing that is wrong, or looks wrong. `name` is an entry of finding_texts.
struct Finding {
    Verdict verdict = Verdict::fail;
    std::string name;
    std::string details;  // where, how much
};

// For the plots of the report; both axes are logarithmic.
struct Curve {
    std::string title, x_label, y_label, label;
    std::vector<double> x, y;
};

struct CheckResult {
    std::string check;      // name of the check
    std::string interface;  // "umat", "vumat" or "host"
    std::string kind;
    bool applicable = true;
    std::string figures;  // what was measured, in one line; why it is not applicable
    std::vector<Finding> findings;
    std::vector<Curve> curves;

    void fail(std::string name, std::string details) {
        findings.push_back({Verdict::fail, std::move(name), std::move(details)});
    }
    void warn(std::string name, std::string details) {
        findings.push_back({Verdict::warning, std::move(name), std::move(details)});
    }
    void skip(std::string why) {
        applicable = false;
        figures = std::move(why);
    }
    // Of the findings the worst one.
    Verdict verdict() const;
    bool has(std::string_view finding) const;
};

// What a finding means and how to mend it, one sentence each.
struct FindingText {
    std::string_view name, meaning, mend;
};
const std::vector<FindingText>& finding_texts();
const FindingText& text_of(const std::string& finding);

// Bytes for the pipe between processes of this program.
std::string packed(const CheckResult& result);
CheckResult unpacked(const std::string& bytes);

}  // namespace lode::host

#endif
