// SPDX-License-Identifier: MIT
#include "simplify/linear_deviations.h"

#include "numeric/vector_code.h"
#include "simplify/linear_deviations_impl.h"

namespace meshbound {

DeviationKernel avx2_deviation_kernel();

DeviationKernel portable_deviation_kernel() { return {linearise, weighted_sums, largest_along}; }

DeviationKernel fastest_deviation_kernel() {
#if defined(MESHBOUND_HAS_AVX2)
  if (uses_avx2()) return avx2_deviation_kernel();
#endif
  return portable_deviation_kernel();
}

}  // namespace meshbound
