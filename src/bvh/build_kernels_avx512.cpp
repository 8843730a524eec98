// SPDX-License-Identifier: MIT
// Compiled for AVX-512 (src/CMakeLists.txt); only called where the processor has it.
#include "bvh/build_kernels_impl.h"

namespace meshbound {

BuildKernels avx512_build_kernels() { return {hilbert_indices, match_half_edges, build_leaves}; }

}  // namespace meshbound
