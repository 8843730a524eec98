// SPDX-License-Identifier: MIT
#include "simplify/kernel/kernels.h"

#include "numeric/vector_code.h"

namespace meshbound {

SimplifyKernels portable_simplify_kernels();
SimplifyKernels avx2_simplify_kernels();
void use_avx512(SimplifyKernels& kernels);

std::vector<SimplifyKernels> all_simplify_kernels() {
  std::vector<SimplifyKernels> kernels;
#if defined(MESHBOUND_HAS_AVX512)
  if (uses_avx512()) use_avx512(kernels.emplace_back(avx2_simplify_kernels()));
#endif
#if defined(MESHBOUND_HAS_AVX2)
  if (uses_avx2()) kernels.push_back(avx2_simplify_kernels());
#endif
  kernels.push_back(portable_simplify_kernels());
  return kernels;
}

SimplifyKernels simplify_kernels() { return all_simplify_kernels().front(); }

}  // namespace meshbound
