// Linear equations of a size known at run time, for the coupled cracks of a point.
#pragma once

#include <cmath>
#include <utility>

namespace lode {

// Gaussian elimination with partial pivoting, right-hand sides beside each other; false if singular.
template <class Number>
bool solve_in_place(double* matrix, int n, Number* rhs, int columns) {
    for (int k = 0; k < n; ++k) {
        int pivot = k;
        for (int i = k + 1; i < n; ++i)
            if (std::abs(matrix[i * n + k]) > std::abs(matrix[pivot * n + k])) pivot = i;
        if (!(std::abs(matrix[pivot * n + k]) > 0.0)) return false;
        if (pivot != k) {
            for (int i = k; i < n; ++i) std::swap(matrix[pivot * n + i], matrix[k * n + i]);
            for (int i = 0; i < columns; ++i) std::swap(rhs[pivot * columns + i], rhs[k * columns + i]);
        }
        const double inverse = 1.0 / matrix[k * n + k];
        for (int i = k + 1; i < n; ++i) {
            const double factor = matrix[i * n + k] * inverse;
            if (factor == 0.0) continue;
            for (int l = k + 1; l < n; ++l) matrix[i * n + l] -= factor * matrix[k * n + l];
            for (int l = 0; l < columns; ++l)
                rhs[i * columns + l] = rhs[i * columns + l] - factor * rhs[k * columns + l];
        }
    }
    for (int k = n - 1; k >= 0; --k)
        for (int l = 0; l < columns; ++l) {
            Number sum = rhs[k * columns + l];
            for (int i = k + 1; i < n; ++i) sum = sum - matrix[k * n + i] * rhs[i * columns + l];
            rhs[k * columns + l] = sum * (1.0 / matrix[k * n + k]);
        }
    return true;
}

}  // namespace lode
