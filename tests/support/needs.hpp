// Tests that need models besides their own. A build may be content with some of the models (-DLODE_MODELS=...): there,
// and only there, such a test is left out. In a complete build a model that is missing is a failure.
#pragma once

#include <gtest/gtest.h>

#define LODE_NEEDS_PRESENT(present, keyword)                                                                        \
    if (!(present)) {                                                                                               \
        if (LODE_HAS_ALL_MODELS) FAIL() << keyword << " is missing"; /* every build without -DLODE_MODELS=: CI's */ \
        /* Only with -DLODE_MODELS=, which left the model out: there is nothing that the test could be run on. */   \
        GTEST_SKIP() << keyword << " was not chosen with -DLODE_MODELS=";                                           \
    }                                                                                                               \
    static_assert(true)
