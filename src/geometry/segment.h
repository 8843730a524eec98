// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>

#include "geometry/vec3.h"

namespace meshbound {

/// As computed: whoever proves something by it leaves room for its rounding. The ends may be one point.
[[nodiscard]] inline double squared_distance_to_segment(Vec3 p, Vec3 a, Vec3 b) {
  const Vec3 way = b - a;
  const double squared = squared_length(way);
  const double share = squared > 0 ? std::clamp(dot(p - a, way) / squared, 0.0, 1.0) : 0;
  return squared_length(p - (a + share * way));
}

}  // namespace meshbound
