// The entry points of the library under test.
#pragma once

#include <type_traits>

#include "lode/entry_points.h"

extern "C" {
lode_umat_function UMAT;
lode_vumat_function VUMAT;
}

namespace lode::test {

// `Real` is the type of the host's arrays.
template <class Real>
using VumatFunctionOf = std::conditional_t<std::is_same_v<Real, float>, lode_vumat_sp_function, lode_vumat_function>*;

}  // namespace lode::test
