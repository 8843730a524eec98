// SPDX-License-Identifier: MIT
#include "distance/kernel/group_query_impl.h"

namespace meshbound {

PointKernel portable_point_kernel() { return {measure_point, measure_group, floats_width}; }

}  // namespace meshbound
