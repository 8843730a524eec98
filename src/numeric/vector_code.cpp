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

bool uses_avx512() {
#if defined(MESHBOUND_HAS_AVX512)
  return !internal::portable_kernels && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("fma");
#else
  return false;
#endif
}

}  // namespace meshbound
