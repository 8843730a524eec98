// SPDX-License-Identifier: MIT
// Compiled with -mavx2 (src/CMakeLists.txt); only called where the processor has it.
#include "bvh/build_kernels_impl.h"

namespace meshbound {

BuildKernels avx2_build_kernels() { return {hilbert_indices, match_half_edges, build_leaves}; }

}  // namespace meshbound
