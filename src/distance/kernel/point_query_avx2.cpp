// SPDX-License-Identifier: MIT
// Compiled with -mavx2 (src/CMakeLists.txt); only called where the processor has it.
#include "distance/kernel/point_query_impl.h"

namespace meshbound {

MeasurePoint avx2_point_kernel() { return measure_point; }

}  // namespace meshbound
