// SPDX-License-Identifier: MIT
#include "simplify/slab_test_impl.h"

namespace meshbound {

SlabBits test_slab_with_avx2(const PlaneBlock& block, Vec3 p, double tolerance, double squared_reach);

SlabTest slab_test() {
#if defined(MESHBOUND_HAS_AVX2)
  if (__builtin_cpu_supports("avx2")) return test_slab_with_avx2;
#endif
  return test_slab;
}

}  // namespace meshbound
