// SPDX-License-Identifier: MIT
#include "bvh/build_kernels_impl.h"

namespace meshbound {

BuildKernels portable_build_kernels() { return {hilbert_indices, match_half_edges, build_leaves}; }

}  // namespace meshbound
