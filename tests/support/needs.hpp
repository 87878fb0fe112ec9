// Tests that need models besides their own. A build may be content with some of the models (-DLODE_MODELS=...): there,
// and only there, such a test is left out. In a complete build a model that is missing is a failure.
#pragma once

#include <gtest/gtest.h>

// The skip cannot hide anything: LODE_HAS_ALL_MODELS is 1 in every build without -DLODE_MODELS=, so in CI and in
// scripts/test, and there the line before it fails. With -DLODE_MODELS= there is nothing that the test could be run on.
#define LODE_NEEDS_PRESENT(present, keyword)                              \
    if (!(present)) {                                                     \
        if (LODE_HAS_ALL_MODELS) FAIL() << keyword << " is missing";      \
        GTEST_SKIP() << keyword << " was not chosen with -DLODE_MODELS="; \
    }                                                                     \
    static_assert(true)
