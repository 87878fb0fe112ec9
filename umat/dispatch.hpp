// Picks the kernels built for the best instruction set that this machine has.
#pragma once

#include "lode/material/model_entry.hpp"

namespace lode {

// LODE_ISA in the environment (e.g. "x86-64-v2") picks a more modest set than the machine's best.
const KernelTable& kernels();

}  // namespace lode
