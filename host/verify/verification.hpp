// Manufactured steps against their closed forms, through both entry points of a library.
#ifndef LODE_HOST_VERIFY_VERIFICATION_HPP
#define LODE_HOST_VERIFY_VERIFICATION_HPP

#include <optional>
#include <string>
#include <vector>

#include "../library.hpp"
#include "../replay/scenario.hpp"

namespace lode::host {

// Exact closed forms have to be met to this, relative to the largest stress component of the moment (but not below a
// thousandth of the largest of the path, which is the measure where an order is stated).
inline constexpr double exact_limit = 1e-10;
// By so much the measured order may fall short of the stated one.
inline constexpr double order_margin = 0.2;

struct VerifiedStep {
    int step = 0;  // from 1
    std::string name, motion;
    Entry entry = Entry::umat;
    // With an error above the limit, the order is that of twice as many increments.
    struct Quantity {
        double error = 0;
        int stated_order = 0;  // 0: exact
        std::optional<double> order = {};
        bool passed() const {
            return error <= exact_limit || (stated_order > 0 && order.value_or(0) >= stated_order - order_margin);
        }
    };
    std::vector<Quantity> stress;    // largest error of each component
    std::optional<Quantity> energy;  // SSE + SPD + SCD against the stress power, relative to the largest
    std::string failure;             // the run did not reach its end

    bool passed() const;
};

struct Verification {
    std::vector<std::string> components;
    std::vector<VerifiedStep> steps;

    bool passed() const;
    std::string text() const;
};

// Throws BadDeck if there is nothing to verify, or not in the way the deck has it.
void check_verifiable(const Scenario& scenario, const std::string& deck);

// Each manufactured step by itself, through umat_ and vumat_ or the one asked for. The scenario has been resolved.
Verification verify(const Scenario& scenario, const Library& library, std::optional<Entry> only);

}  // namespace lode::host

#endif
