// What the driver itself costs: a UMAT that does nothing, in a file of its own so that the call stays.
#include "abi.hpp"

extern "C" void empty_umat_(double*, double*, double*, double*, double*, double*, double*, double*, double*, double*,
                            const double*, const double*, const double*, const double*, const double*, const double*,
                            const double*, const double*, const char*, const int*, const int*, const int*, const int*,
                            const double*, const int*, const double*, const double*, double*, const double*,
                            const double*, const double*, const int*, const int*, const int*, const int*, const int*,
                            const int*, size_t) {}
