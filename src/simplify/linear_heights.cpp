// SPDX-License-Identifier: MIT
#include "simplify/linear_heights.h"

#include "numeric/vector_code.h"
#include "simplify/linear_heights_impl.h"

namespace meshbound {

HeightKernel avx2_height_kernel();

HeightKernel portable_height_kernel() { return {linearise, weighted_sums, largest_along}; }

HeightKernel fastest_height_kernel() {
#if defined(MESHBOUND_HAS_AVX2)
  if (uses_avx2()) return avx2_height_kernel();
#endif
  return portable_height_kernel();
}

}  // namespace meshbound
