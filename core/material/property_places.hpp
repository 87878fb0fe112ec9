// Where the entries of a model's table of parameters stand in PROPS: repeated ones push the others on.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "lode/lode.h"

namespace lode {

struct PropertyPlace {
    const lode_parameter* parameter;
    int repetition;  // 1-based; 0 for an entry that stands once
};

// Number in the table (1-based) of the count that repeats an entry, 0 if nothing does.
constexpr int repeated_by(const lode_parameter& p) { return static_cast<int>(p.flags >> LODE_REPEATED_SHIFT); }

// The places from PROPS(1) on, for constants whose counts are as `values` says. A count that is missing has its
// default; one that is illegal ends the list, because nothing is known of what it repeats.
inline std::vector<PropertyPlace> property_places(const lode_model& model, const double* values, int value_count) {
    std::vector<PropertyPlace> places;
    std::vector<int> first(static_cast<std::size_t>(model.parameter_count), 0);  // index of the entry in PROPS
    const auto times = [&](int count) {
        const lode_parameter& p = model.parameters[count - 1];
        const int index = first[static_cast<std::size_t>(count - 1)];
        const double n = index < value_count ? values[index] : p.default_value;
        return n >= p.lower && n <= p.upper && n == std::nearbyint(n) ? static_cast<int>(n) : -1;
    };
    for (int i = 0; i < model.parameter_count;) {
        const int count = repeated_by(model.parameters[i]);
        int end = i + 1;
        while (count != 0 && end < model.parameter_count && repeated_by(model.parameters[end]) == count) ++end;
        for (int k = i; k < end; ++k) first[static_cast<std::size_t>(k)] = static_cast<int>(places.size()) + (k - i);
        const int repetitions = count == 0 ? 1 : times(count);
        if (repetitions < 0) break;
        for (int r = 1; r <= repetitions; ++r)
            for (int k = i; k < end; ++k) places.push_back({&model.parameters[k], count == 0 ? 0 : r});
        i = end;
    }
    return places;
}

// PROPS index (1-based) of entry `number` of the table, its first one if it is repeated; 0 if it does not stand there.
inline int property_index(const lode_model& model, int number, const double* values, int value_count) {
    if (number < 1 || number > model.parameter_count) return 0;
    const std::vector<PropertyPlace> places = property_places(model, values, value_count);
    const auto at = std::find_if(places.begin(), places.end(), [&](const PropertyPlace& place) {
        return place.parameter == &model.parameters[number - 1];
    });
    return at == places.end() ? 0 : static_cast<int>(at - places.begin()) + 1;
}

}  // namespace lode
