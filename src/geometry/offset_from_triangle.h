// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>

#include "geometry/longest_edge.h"
#include "geometry/point_triangle.h"
#include "geometry/triangle_corners.h"
#include "geometry/vec3.h"

namespace meshbound {

/// The vector to p from the point of the triangle nearest to it, rounded. Coordinates around p are divided by the
/// largest one, so that squares neither overflow nor underflow.
inline Eigen::Vector3d offset_from_triangle(const std::array<Eigen::Vector3d, 3>& corners, const Eigen::Vector3d& p) {
  double size = 0;
  for (const Eigen::Vector3d& corner : corners) size = std::max(size, (corner - p).cwiseAbs().maxCoeff());
  if (!(size > 0)) return Eigen::Vector3d::Zero();
  TriangleCorners c;  // around p
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d way = (corners[k] - p) / size;
    c[k] = {way.x(), way.y(), way.z()};
  }
  const Vec3 offset = closest_on_triangle(longest_edge_first(c), Vec3{}).offset;
  return size * Eigen::Vector3d(offset.x, offset.y, offset.z);
}

}  // namespace meshbound
