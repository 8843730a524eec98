// SPDX-License-Identifier: MIT
#pragma once
#include <array>

#include "geometry/triangle_corners.h"
#include "geometry/vec3.h"

namespace meshbound {

/// A triangle that has an area, with its unit normal.
struct FacedTriangle {
  TriangleCorners corners;
  Vec3 normal;

  [[nodiscard]] Vec3 middle() const { return (1.0 / 3) * (corners[0] + corners[1] + corners[2]); }
};

}  // namespace meshbound
