// SPDX-License-Identifier: MIT
#include "simplify/kernel/kernels_impl.h"

namespace meshbound {

SimplifyKernels portable_simplify_kernels() { return kernels_of_this_instruction_set(); }

}  // namespace meshbound
