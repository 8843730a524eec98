// SPDX-License-Identifier: MIT
// The choice among the kernels of point queries, by processor.
#include "distance/kernel/point_query.h"

#include "numeric/vector_code.h"

namespace meshbound {

PointKernel avx2_point_kernel();

PointKernel point_kernel() {
#if defined(MESHBOUND_HAS_AVX2)
  if (uses_avx2()) return avx2_point_kernel();
#endif
  return portable_point_kernel();
}

}  // namespace meshbound
