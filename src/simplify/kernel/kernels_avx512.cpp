// SPDX-License-Identifier: MIT
// Compiled for AVX-512 (src/CMakeLists.txt); only called where the processor has it.
#include "simplify/kernel/deviation_kernel_impl.h"
#include "simplify/kernel/kernels.h"

namespace meshbound {

/// In place of those for AVX2, whose vectors are half as wide.
void use_avx512(SimplifyKernels& kernels) {
  kernels.samples = {offsets, distances, add_deviations};
  kernels.deviations = {linearise, weighted_sums, largest_along};
}

}  // namespace meshbound
