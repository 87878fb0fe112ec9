// One vocabulary for the three kinds of number a kernel is written in: double (UMAT), xsimd::batch<double> (VUMAT
// blocks) and a forward-mode automatic-differentiation number (tests). Branches are written as masks: bool for a single
// point, one bit a lane for a batch.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <xsimd/xsimd.hpp>

// For what must end up inside its caller, so that a material point lives in registers. Instrumented code, which takes
// minutes a file if it is forced together, and code that is not optimised, are left to the compiler.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__OPTIMIZE__)
#define LODE_INLINE inline
#define LODE_INLINE_LAMBDA
#else
#define LODE_INLINE [[gnu::always_inline]] inline
#define LODE_INLINE_LAMBDA __attribute__((always_inline))
#endif

namespace lode {

using std::abs, std::cbrt, std::cos, std::exp, std::expm1, std::fma, std::hypot, std::log, std::log1p, std::max,
    std::min, std::pow, std::sin, std::sqrt;

using Batch = xsimd::batch<double>;
inline constexpr int batch_lanes = static_cast<int>(Batch::size);

// What a kernel needs to know about its number type. The primary template serves automatic-differentiation numbers,
// which branch on their value like a double.
template <class Real>
struct ScalarTraits {
    using Mask = bool;
    using Storage = Real;  // what STRESS, STATEV, ... are arrays of
    static constexpr int lanes = 1;
    static constexpr bool is_batch = false;
    static constexpr bool is_differentiated = !std::is_floating_point_v<Real>;
};
template <>
struct ScalarTraits<Batch> {
    using Mask = xsimd::batch_bool<double>;
    using Storage = double;
    static constexpr int lanes = batch_lanes;
    static constexpr bool is_batch = true;
    static constexpr bool is_differentiated = false;
};

template <class Real>
using Mask = typename ScalarTraits<Real>::Mask;
template <class Real>
using Storage = typename ScalarTraits<Real>::Storage;
template <class Real>
inline constexpr bool is_batch = ScalarTraits<Real>::is_batch;
template <class Real>
inline constexpr bool is_differentiated = ScalarTraits<Real>::is_differentiated;

// The batch versions of these are xsimd's, found by argument-dependent look-up.
template <class Real>
constexpr Real select(bool condition, const Real& yes, const Real& no) {
    return condition ? yes : no;
}
constexpr bool any(bool condition) { return condition; }
constexpr bool all(bool condition) { return condition; }
// Both sides are evaluated, so that no branch hangs on the first one.
template <class Condition>
constexpr Condition or_without_branch(const Condition& a, const Condition& b) {
    if constexpr (std::is_same_v<Condition, bool>) return (static_cast<int>(a) | static_cast<int>(b)) != 0;
    else return a || b;
}
template <class Condition>
constexpr Condition and_without_branch(const Condition& a, const Condition& b) {
    if constexpr (std::is_same_v<Condition, bool>) return (static_cast<int>(a) & static_cast<int>(b)) != 0;
    else return a && b;
}

// Reads `lanes` consecutive numbers (one for a single point); writes them.
template <class Real>
inline Real load(const Storage<Real>* p) {
    if constexpr (is_batch<Real>) return Real::load_unaligned(p);
    else return *p;
}
template <class Real>
inline void store(Storage<Real>* p, const Real& x) {
    if constexpr (is_batch<Real>) x.store_unaligned(p);
    else *p = x;
}

// The value of an automatic-differentiation number, without its derivatives; everything else is its own value.
// Dual numbers provide `value_of` themselves.
inline double value_of(double x) { return x; }
inline Batch value_of(const Batch& x) { return x; }

template <class Real>
inline Real square(const Real& x) {
    return x * x;
}

// max(x, 0).
template <class Real>
inline Real positive_part(const Real& x) {
    return max(x, Real(0.0));
}

// True where x is neither infinite nor NaN; costs one multiplication and one comparison.
template <class Real>
inline Mask<Real> is_finite(const Real& x) {
    return x * 0.0 == Real(0.0);
}

}  // namespace lode
