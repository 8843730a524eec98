// SPDX-License-Identifier: MIT
#include "numeric/vector_code.h"

namespace meshbound {

bool internal::portable_kernels = false;

bool uses_avx2() {
#if defined(MESHBOUND_HAS_AVX2)
  return !internal::portable_kernels && __builtin_cpu_supports("avx2");
#else
  return false;
#endif
}

}  // namespace meshbound
