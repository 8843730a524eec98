// SPDX-License-Identifier: MIT
#pragma once
#include <array>

#include "geometry/vec3.h"

namespace meshbound {

/// The corners of a triangle, or of a sub-triangle of one.
using TriangleCorners = std::array<Vec3, 3>;

/// Rounded by less than 7 u M, for which the slack of a lower bound has room (numeric/rounding.h).
[[nodiscard]] inline Vec3 centroid(const TriangleCorners& t) { return (1.0 / 3) * (t[0] + t[1] + t[2]); }

}  // namespace meshbound
