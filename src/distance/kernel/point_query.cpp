// SPDX-License-Identifier: MIT
#include "distance/kernel/point_query.h"

#include "distance/kernel/point_query_impl.h"
#include "numeric/vector_code.h"

namespace meshbound {

MeasurePoint avx2_point_kernel();

MeasurePoint portable_point_kernel() { return measure_point; }

MeasurePoint point_kernel() {
#if defined(MESHBOUND_HAS_AVX2)
  if (uses_avx2()) return avx2_point_kernel();
#endif
  return portable_point_kernel();
}

}  // namespace meshbound
