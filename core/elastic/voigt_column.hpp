// Vectors of GCC and Clang for the columns of DDSDDE, padded to a power of two. Written entry by entry, the 36 stores
// of a three-dimensional tangent cost as much as a radial return.
#pragma once

#include <cstring>
#include <type_traits>

#include "lode/numerics/scalar.hpp"

// Functions that pass such vectors are always inlined: the calling convention, which depends on the instruction set, is
// never used.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace lode {

typedef double ColumnOf2 [[gnu::vector_size(2 * sizeof(double))]];
typedef double ColumnOf4 [[gnu::vector_size(4 * sizeof(double))]];
typedef double ColumnOf8 [[gnu::vector_size(8 * sizeof(double))]];
// n components: 6, 4 or 3.
template <int n>
using Column = std::conditional_t<(n > 4), ColumnOf8, ColumnOf4>;

namespace voigt_column_detail {

// The first 6 or 3 entries.
LODE_INLINE void store_exactly(double* p, const ColumnOf8& v) {
    const ColumnOf4 front = __builtin_shufflevector(v, v, 0, 1, 2, 3);
    const ColumnOf2 back = __builtin_shufflevector(v, v, 4, 5);
    std::memcpy(p, &front, sizeof front);
    std::memcpy(p + 4, &back, sizeof back);
}
LODE_INLINE void store_exactly(double* p, const ColumnOf4& v) {
    const ColumnOf2 front = __builtin_shufflevector(v, v, 0, 1);
    std::memcpy(p, &front, sizeof front);
    p[2] = v[2];
}

}  // namespace voigt_column_detail

// Column j of an n x n matrix that is written from its first column to its last: the padding runs over into the next
// column.
template <int n>
LODE_INLINE void store_column(double* matrix, int j, const Column<n>& column) {
    if (j + 1 < n || n == 4) std::memcpy(matrix + n * j, &column, sizeof column);
    else voigt_column_detail::store_exactly(matrix + n * j, column);
}

}  // namespace lode
