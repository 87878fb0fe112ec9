// Short ways to write the entries of a model's description (lode.h) down where the model is.
#pragma once

#include <cmath>
#include <iterator>

#include "lode/lode.h"

namespace lode {

struct Range {
    double lower = -HUGE_VAL, upper = HUGE_VAL;
    unsigned flags = 0;
};
constexpr Range any_value() { return {}; }
constexpr Range above(double lower) { return {lower, HUGE_VAL, LODE_LOWER_OPEN}; }
constexpr Range at_least(double lower) { return {lower, HUGE_VAL, 0}; }
constexpr Range between(double lower, double upper) { return {lower, upper, 0}; }
constexpr Range inside(double lower, double upper) { return {lower, upper, LODE_LOWER_OPEN | LODE_UPPER_OPEN}; }
constexpr Range code(int lower, int upper) { return {double(lower), double(upper), LODE_INTEGER}; }

constexpr lode_parameter required(const char* symbol, const char* name, const char* unit, Range range,
                                  const char* note = "") {
    return {symbol, name, unit, range.lower, range.upper, 0.0, range.flags, note};
}
constexpr lode_parameter optional(const char* symbol, const char* name, const char* unit, Range range,
                                  double default_value, const char* note = "") {
    return {symbol, name, unit, range.lower, range.upper, default_value, range.flags | LODE_OPTIONAL, note};
}
// An optional entry that may also be written as 0 to get its default (page 20, section 1).
constexpr lode_parameter optional_or_zero(const char* symbol, const char* name, const char* unit, Range range,
                                          double default_value, const char* note = "") {
    lode_parameter p = optional(symbol, name, unit, range, default_value, note);
    p.flags |= LODE_ZERO_IS_DEFAULT;
    return p;
}

// An entry that stands in PROPS as often as the count with number `count` in the table says.
constexpr lode_parameter repeated(int count, lode_parameter p) {
    p.flags |= static_cast<unsigned>(count) << LODE_REPEATED_SHIFT;
    return p;
}

template <class Array>
constexpr int count_of(const Array& array) {
    return static_cast<int>(std::size(array));
}

}  // namespace lode
