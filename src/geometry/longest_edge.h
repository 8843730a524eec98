// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>

#include "geometry/point_triangle.h"
#include "geometry/triangle_corners.h"
#include "geometry/vec3.h"

namespace meshbound {

/// Where the longest edge of a triangle begins: corner 0, 1 or 2, the first of them when edges are equally long.
inline std::uint32_t longest_edge(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double ab = squared_length(b - a), bc = squared_length(c - b), ca = squared_length(a - c);
  const auto not_ab = static_cast<std::uint32_t>((ab < bc) | (ab < ca));
  return not_ab * (2 - static_cast<std::uint32_t>(bc >= ca));
}

/// A triangle as `closest_on_triangle` needs it.
inline CornerTriangle<double> longest_edge_first(const TriangleCorners& corners) {
  const std::uint32_t first = longest_edge(corners[0], corners[1], corners[2]);
  const Vec3& a = corners[first];
  return {a, corners[(first + 1) % 3] - a, corners[(first + 2) % 3] - a};
}

}  // namespace meshbound
