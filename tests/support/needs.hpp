// Tests that need models besides their own. In a build that is content with some of the models (-DLODE_MODELS=...),
// too, a model that is missing is a failure, which says what to build with it.
#pragma once

#include <gtest/gtest.h>

#define LODE_NEEDS_PRESENT(present, keyword)                              \
    if (!(present))                                                       \
        FAIL() << keyword                                                 \
               << " is missing; a build of some models (-DLODE_MODELS=) " \
                  "needs it for this test";                               \
    static_assert(true)
