// Settings of the utility routines that more than one of them reads.
#ifndef LODE_FORTRAN_SHIMS_UTILITY_STATE_HPP
#define LODE_FORTRAN_SHIMS_UTILITY_STATE_HPP

#include <cstddef>

namespace lode::utility {

std::size_t explicit_real_bytes();

}  // namespace lode::utility

#endif
