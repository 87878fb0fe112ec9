// Tests that need models besides their own. A build may be content with some of the models (-DLODE_MODELS=...): there,
// and only there, such a test is left out. In a complete build a model that is missing is a failure.
#pragma once

#include <gtest/gtest.h>

#include <string_view>

inline void skip_for_want_of(std::string_view keyword) {
    // Not a test that does not test: -DLODE_MODELS= has left out the model that it is about. Every other build, CI's
    // among them, fails below before it comes here.
    GTEST_SKIP() << keyword << " was not chosen with -DLODE_MODELS=";
}

#define LODE_NEEDS_PRESENT(present, keyword)                         \
    if (!(present)) {                                                \
        if (LODE_HAS_ALL_MODELS) FAIL() << keyword << " is missing"; \
        return skip_for_want_of(keyword);                            \
    }                                                                \
    static_assert(true)
