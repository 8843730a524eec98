// SPDX-License-Identifier: MIT
// Compiled with -mavx2 (src/CMakeLists.txt); only called where the processor has it.
#include "simplify/linear_deviations_impl.h"

namespace meshbound {

DeviationKernel avx2_deviation_kernel() { return {linearise, weighted_sums, largest_along}; }

}  // namespace meshbound
