// Principal values and directions of a symmetric 3x3 tensor.
#ifndef LODE_FORTRAN_SHIMS_PRINCIPAL_HPP
#define LODE_FORTRAN_SHIMS_PRINCIPAL_HPP

#include <array>

namespace lode::utility {

using Matrix3 = std::array<std::array<double, 3>, 3>;

struct Principal {
    std::array<double, 3> value;  // largest first
    Matrix3 direction;            // direction[i] belongs to value[i]; orthonormal, right-handed
};

Principal principal(const Matrix3& tensor);

}  // namespace lode::utility

#endif
