// SPDX-License-Identifier: MIT
#include "bvh/leaf_kernel_impl.h"

namespace meshbound {

BuildLeaves portable_leaf_kernel() { return build_leaves; }

}  // namespace meshbound
