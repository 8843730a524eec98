// SPDX-License-Identifier: MIT
#pragma once
#include <array>

#include "geometry/vec3.h"

namespace meshbound {

/// A triangle of A, or a sub-triangle of one, in B's working frame.
using TriangleCorners = std::array<Vec3, 3>;

/// Rounded by less than 7 u M, for which the slack of a lower bound has room (numeric/rounding.h).
[[nodiscard]] inline Vec3 centroid(const TriangleCorners& t) { return (1.0 / 3) * (t[0] + t[1] + t[2]); }

}  // namespace meshbound
