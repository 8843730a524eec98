// SPDX-License-Identifier: MIT
// The choice among the kernels of point queries, by processor.
#include "distance/kernel/point_query.h"

#include "numeric/vector_code.h"

namespace meshbound {

PointKernel portable_point_kernel();
PointKernel avx2_point_kernel();
PointKernel avx512_point_kernel();

PointKernel point_kernel() {
#if defined(MESHBOUND_HAS_AVX512)
  if (uses_avx512()) return avx512_point_kernel();
#endif
#if defined(MESHBOUND_HAS_AVX2)
  if (uses_avx2()) return avx2_point_kernel();
#endif
  return portable_point_kernel();
}

std::vector<PointKernel> point_kernels() {
  std::vector<PointKernel> kernels{portable_point_kernel()};
#if defined(MESHBOUND_HAS_AVX2)
  if (uses_avx2()) kernels.push_back(avx2_point_kernel());
#endif
#if defined(MESHBOUND_HAS_AVX512)
  if (uses_avx512()) kernels.push_back(avx512_point_kernel());
#endif
  return kernels;
}

}  // namespace meshbound
