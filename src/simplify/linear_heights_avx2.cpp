// SPDX-License-Identifier: MIT
// Compiled with -mavx2 (src/CMakeLists.txt); only called where the processor has it.
#include "simplify/linear_heights_impl.h"

namespace meshbound {

HeightKernel avx2_height_kernel() { return {linearise, weighted_sums, largest_along}; }

}  // namespace meshbound
