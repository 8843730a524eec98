// SPDX-License-Identifier: MIT
// Compiled with -mavx2 (src/CMakeLists.txt); only called where the processor has it.
#include "distance/kernel/group_query_impl.h"

namespace meshbound {

PointKernel avx2_point_kernel() { return {measure_point, measure_group, floats_width}; }

}  // namespace meshbound
