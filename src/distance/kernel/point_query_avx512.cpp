// SPDX-License-Identifier: MIT
// Compiled for AVX-512 (src/CMakeLists.txt); only called where the processor has it.
#include "distance/kernel/group_query_impl.h"

namespace meshbound {

PointKernel avx512_point_kernel() { return {measure_point, measure_group, floats_width}; }

}  // namespace meshbound
