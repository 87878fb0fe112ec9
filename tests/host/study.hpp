// What the tests of `lode chart`, `lode atlas` and `lode advise` share: the project's own libraries, and its models.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "guard.hpp"
#include "needs.hpp"
#include "study/libraries.hpp"
#include "study/paths.hpp"

namespace lode::host::test {

inline const Libraries& libraries() {
    install_utility_handlers();
    static const Libraries loaded(LODE_TEST_LIBRARY, LODE_TEST_SINGLE_LIBRARY);
    return loaded;
}
inline const Library& library() { return libraries().main(); }

inline bool has_model(const std::string& keyword) { return library().model_of(keyword) != nullptr; }
#define LODE_NEEDS(keyword) LODE_NEEDS_PRESENT(has_model(keyword), keyword)

// A material without a path.
inline Scenario material(const std::string& name, std::vector<double> constants, Kind kind = Kind::solid) {
    Scenario scenario;
    scenario.material.name = name;
    scenario.material.constants = std::move(constants);
    scenario.analysis.kind = kind;
    return scenario;
}

inline Components components(std::initializer_list<double> values) {
    Components result(static_cast<Eigen::Index>(values.size()));
    Eigen::Index i = 0;
    for (const double value : values) result[i++] = value;
    return result;
}

}  // namespace lode::host::test
