// Rare work that is not worth a batch: take the lanes apart, do it in double, put them together again.
#pragma once

#include <array>

#include "lode/numerics/scalar.hpp"

namespace lode {

template <class Real>
using Lanes = std::array<double, std::size_t{ScalarTraits<Real>::lanes}>;

template <class Real>
inline Lanes<Real> to_lanes(const Real& x) {
    Lanes<Real> lanes;
    if constexpr (is_batch<Real>) x.store_unaligned(lanes.data());
    else lanes[0] = value_of(x);
    return lanes;
}
template <class Real>
inline Real from_lanes(const Lanes<Real>& lanes) {
    if constexpr (is_batch<Real>) return Real::load_unaligned(lanes.data());
    else return Real(lanes[0]);
}
template <class Real>
inline bool is_set(const Mask<Real>& mask, std::size_t lane) {
    if constexpr (is_batch<Real>) return mask.get(lane);
    else return mask;
}

}  // namespace lode
