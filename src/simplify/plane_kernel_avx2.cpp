// SPDX-License-Identifier: MIT
// Compiled with -mavx2 (src/CMakeLists.txt); only called where the processor has it.
#include "simplify/plane_kernel_impl.h"

namespace meshbound {

PlaneKernel avx2_plane_kernel() { return {set_planes, test_slab, reach_in_slabs}; }

}  // namespace meshbound
