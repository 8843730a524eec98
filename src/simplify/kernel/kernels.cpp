// SPDX-License-Identifier: MIT
#include "simplify/kernel/kernels.h"

#include "numeric/vector_code.h"

namespace meshbound {

SimplifyKernels avx2_simplify_kernels();

SimplifyKernels simplify_kernels() {
#if defined(MESHBOUND_HAS_AVX2)
  if (uses_avx2()) return avx2_simplify_kernels();
#endif
  return portable_simplify_kernels();
}

}  // namespace meshbound
