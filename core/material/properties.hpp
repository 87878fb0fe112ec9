// PROPS of one material: checked against the model's description, then read by the page's 1-based index.
#pragma once

#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <string_view>

#include "lode/material/property_places.hpp"

namespace lode {

// A material that cannot be used: the message names material, property, value and what is allowed. It is thrown while a
// material is made, never by an update, and never crosses the ABI.
struct BadProperty : std::runtime_error {
    using std::runtime_error::runtime_error;
};

inline std::string format_number(double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.12g", x);
    return text;
}

// "(-1, 0.5)", "> 0", "0..2", "any": the legal values of a parameter in words.
inline std::string format_range(const lode_parameter& p) {
    const bool from = std::isfinite(p.lower), to = std::isfinite(p.upper);
    if (p.flags & LODE_INTEGER) {
        if (from && to) return "an integer " + format_number(p.lower) + ".." + format_number(p.upper);
        return from ? "an integer >= " + format_number(p.lower) : "an integer";
    }
    if (from && to)
        return std::string(p.flags & LODE_LOWER_OPEN ? "(" : "[") + format_number(p.lower) + ", " +
               format_number(p.upper) + (p.flags & LODE_UPPER_OPEN ? ")" : "]");
    if (from) return (p.flags & LODE_LOWER_OPEN ? "> " : ">= ") + format_number(p.lower);
    if (to) return (p.flags & LODE_UPPER_OPEN ? "< " : "<= ") + format_number(p.upper);
    return "any finite number";
}

class Properties {
  public:
    // Validates every entry that is present; throws BadProperty. `material` is the name the host gave. A model inside
    // another one, whose constants stand before its own: messages count `before` more.
    Properties(const lode_model& model, std::string_view material, const double* values, int count, int before = 0)
        : places_(property_places(model, values, count)),
          material_(material),
          values_(values),
          count_(count),
          before_(before) {
        int required = static_cast<int>(places_.size());
        while (required > 0 && (parameter(required).flags & LODE_OPTIONAL) != 0) --required;
        if (count < required) {
            std::string message = std::string(material_) + ": " + model.keyword + " needs at least " +
                                  std::to_string(required) + " constants, NPROPS = " + std::to_string(count) +
                                  "; the first one missing is " + label(count + 1);
            throw BadProperty(message);
        }
        for (int i = 1; i <= count && i <= static_cast<int>(places_.size()); ++i) {
            const lode_parameter& p = parameter(i);
            const double x = values[i - 1];
            if (x == 0.0 && (p.flags & LODE_ZERO_IS_DEFAULT)) continue;
            const bool above_lower = p.flags & LODE_LOWER_OPEN ? x > p.lower : x >= p.lower;
            const bool below_upper = p.flags & LODE_UPPER_OPEN ? x < p.upper : x <= p.upper;
            const bool whole = !(p.flags & LODE_INTEGER) || x == std::nearbyint(x);
            if (!std::isfinite(x) || !above_lower || !below_upper || !whole) refuse(i, format_range(p));
        }
    }

    // Entry `index` (1-based), or its default where it is missing or, if its description says so, zero.
    double operator[](int index) const {
        const lode_parameter& p = parameter(index);
        if (index > count_) return p.default_value;
        const double x = values_[index - 1];
        return x == 0.0 && (p.flags & LODE_ZERO_IS_DEFAULT) ? p.default_value : x;
    }
    int code(int index) const { return static_cast<int>((*this)[index]); }
    int count() const { return count_; }
    std::string_view material() const { return material_; }
    // Those of a model whose constants stand behind the first `before`.
    Properties inner(const lode_model& model, int before) const {
        return {model, material_, values_ + before, count_ - before, before_ + before};
    }

    // Throws "<material>: PROPS(i) = value (symbol, name) must be <allowed>".
    [[noreturn]] void refuse(int index, const std::string& allowed) const {
        const std::string value = index <= count_ ? format_number(values_[index - 1]) : "missing";
        throw BadProperty(std::string(material_) + ": PROPS(" + std::to_string(before_ + index) + ") = " + value +
                          " (" + label(index) + ") must be " + allowed);
    }
    // For refusals that concern no single entry.
    [[noreturn]] void refuse(const std::string& reason) const {
        const std::string where =
            before_ > 0 ? "counting PROPS from PROPS(" + std::to_string(before_ + 1) + ") on, " : "";
        throw BadProperty(std::string(material_) + ": " + where + reason);
    }

  private:
    const PropertyPlace& place(int index) const { return places_[static_cast<std::size_t>(index - 1)]; }
    const lode_parameter& parameter(int index) const { return *place(index).parameter; }
    std::string label(int index) const {
        const int repetition = place(index).repetition;
        return std::string(parameter(index).symbol) + ", " + parameter(index).name +
               (repetition > 0 ? ", number " + std::to_string(repetition) : "");
    }

    std::vector<PropertyPlace> places_;  // of PROPS, in order
    std::string_view material_;
    const double* values_;
    int count_, before_;
};

}  // namespace lode
