// What the solution of one material point took, for whoever asks (lode_umat_observed). A counter is a handle to numbers
// that live with the caller: a kernel passes it to its solves by value, so that nothing of the point gets an address,
// and what has no solve pays for nothing. Batches count nothing: theirs is empty.
#pragma once

#include <type_traits>

#include "lode/lode.h"
#include "lode/numerics/scalar.hpp"

namespace lode {

template <class Real>
class SolveCounter {
  public:
    SolveCounter() = default;  // counts nothing
    LODE_INLINE explicit SolveCounter(lode_observation& numbers) : numbers_(&numbers) {}
    // A differentiated number counts for the plain one.
    template <class Other>
    LODE_INLINE SolveCounter(const SolveCounter<Other>& other) requires(!is_batch<Real> && !is_batch<Other>)
        : numbers_(other.numbers()) {}

    // Evaluations of a residual, and how many of the steps between them were those of a safeguard.
    LODE_INLINE void count(int iterations, int safeguards = 0) const {
        if constexpr (!is_batch<Real>)
            if (numbers_ != nullptr) {
                numbers_->iterations += iterations;
                numbers_->safeguards += safeguards;
            }
    }
    // What root.hpp and dense_newton.hpp return.
    template <class Solution>
    LODE_INLINE void count(const Solution& solution) const requires requires {
        solution.safeguards;
    }
    {
        if constexpr (!is_batch<Real>) count(solution.iterations, solution.safeguards);
    }
    LODE_INLINE void count_substeps(int substeps) const {
        if constexpr (!is_batch<Real>)
            if (numbers_ != nullptr) numbers_->substeps += substeps;
    }
    LODE_INLINE lode_observation* numbers() const { return numbers_; }

  private:
    struct Nothing {
        LODE_INLINE Nothing(std::nullptr_t) {}
        LODE_INLINE operator lode_observation*() const { return nullptr; }
    };
    [[no_unique_address]] std::conditional_t<is_batch<Real>, Nothing, lode_observation*> numbers_ = nullptr;
};

}  // namespace lode
