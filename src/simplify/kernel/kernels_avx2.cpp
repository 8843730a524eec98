// SPDX-License-Identifier: MIT
// Compiled with -mavx2 (src/CMakeLists.txt); only called where the processor has it.
#include "simplify/kernel/kernels_impl.h"

namespace meshbound {

SimplifyKernels avx2_simplify_kernels() { return kernels_of_this_instruction_set(); }

}  // namespace meshbound
