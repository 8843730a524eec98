// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cmath>

#include "geometry/vec3.h"

namespace meshbound {

/// The largest magnitude of a coordinate; not a number where a coordinate is none.
[[nodiscard]] inline double largest_magnitude_of(const Vec3& v) {
  const double sum = std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z);
  return sum <= sum ? std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}) : sum;
}

}  // namespace meshbound
