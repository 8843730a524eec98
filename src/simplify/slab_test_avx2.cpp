// SPDX-License-Identifier: MIT
// Compiled with -mavx2 (src/CMakeLists.txt); only called where the processor has it.
#include "simplify/slab_test_impl.h"

namespace meshbound {

SlabBits test_slab_with_avx2(const PlaneBlock& block, Vec3 p, double tolerance, double squared_reach) {
  return test_slab(block, p, tolerance, squared_reach);
}

}  // namespace meshbound
