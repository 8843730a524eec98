// SPDX-License-Identifier: MIT
#include "bvh/build_kernels.h"

#include "numeric/vector_code.h"

namespace meshbound {

BuildKernels avx512_build_kernels();
BuildKernels avx2_build_kernels();
BuildKernels portable_build_kernels();

std::vector<BuildKernels> all_build_kernels() {
  std::vector<BuildKernels> kernels;
#if defined(MESHBOUND_HAS_AVX512)
  if (uses_avx512()) kernels.push_back(avx512_build_kernels());
#endif
#if defined(MESHBOUND_HAS_AVX2)
  if (uses_avx2()) kernels.push_back(avx2_build_kernels());
#endif
  kernels.push_back(portable_build_kernels());
  return kernels;
}

BuildKernels build_kernels() { return all_build_kernels().front(); }

}  // namespace meshbound
