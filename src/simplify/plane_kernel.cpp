// SPDX-License-Identifier: MIT
#include "numeric/vector_code.h"
#include "simplify/plane_kernel_impl.h"

namespace meshbound {

PlaneKernel avx2_plane_kernel();

PlaneKernel portable_plane_kernel() { return {set_planes, test_slab, reach_in_slabs}; }

PlaneKernel fastest_plane_kernel() {
#if defined(MESHBOUND_HAS_AVX2)
  if (uses_avx2()) return avx2_plane_kernel();
#endif
  return portable_plane_kernel();
}

}  // namespace meshbound
