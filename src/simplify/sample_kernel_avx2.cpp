// SPDX-License-Identifier: MIT
// Compiled with -mavx2 (src/CMakeLists.txt); only called where the processor has it.
#include "simplify/sample_kernel_impl.h"

namespace meshbound {

SampleKernel avx2_sample_kernel() { return {offsets, drop_far, add_deviations}; }

}  // namespace meshbound
