// SPDX-License-Identifier: MIT
// Compiled with -mavx2 (src/CMakeLists.txt); only called where the processor has it.
#include "bvh/leaf_kernel_impl.h"

namespace meshbound {

BuildLeaves avx2_leaf_kernel() { return build_leaves; }

}  // namespace meshbound
