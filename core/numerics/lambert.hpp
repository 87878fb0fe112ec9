// Lambert's function W0, w e^w = X, in a form that neither overflows nor loses small arguments.
#pragma once

#include "lode/numerics/scalar.hpp"

namespace lode {

// W0(exp(log_X)). Winitzki's approximation and two steps of Fritsch's fourth-order iteration on w + ln w = ln X; within
// a few units in the last place, times |log_X| where X is small.
template <class Real>
LODE_INLINE Real lambert_w0_of_exponential(const Real& log_X) {
    const Real L = select(log_X > Real(30.0), log_X, log1p(exp(min(log_X, Real(30.0)))));
    Real w = L * (1.0 - log1p(L) / (2.0 + L));
    for (int i = 0; i < 2; ++i) {
        const Real z = log_X - log(max(w, Real(1e-300))) - w, next = 1.0 + w;
        const Real q = 2.0 * next * (next + (2.0 / 3.0) * z);
        w = w * (1.0 + z / next * (q - z) / (q - 2.0 * z));
    }
    return w;
}

}  // namespace lode
