// SPDX-License-Identifier: MIT
// Compiled with -mavx2 (src/CMakeLists.txt); only called where the processor has it.
#include "simplify/sampled_slope_impl.h"

namespace meshbound {

SlopeKernel avx2_slope_kernel() { return {offsets, drop_far, add_slope}; }

}  // namespace meshbound
