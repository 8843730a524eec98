// SPDX-License-Identifier: MIT
#include "bvh/leaf_kernel.h"

#include "numeric/vector_code.h"

namespace meshbound {

BuildLeaves avx2_leaf_kernel();

BuildLeaves leaf_kernel() {
#if defined(MESHBOUND_HAS_AVX2)
  if (uses_avx2()) return avx2_leaf_kernel();
#endif
  return portable_leaf_kernel();
}

}  // namespace meshbound
