// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>

#include "geometry/triangle_corners.h"
#include "geometry/vec3.h"

namespace meshbound {

/// The point of a triangle with these barycentric coordinates.
[[nodiscard]] inline Vec3 point_of(const TriangleCorners& corners, const std::array<double, 3>& weights) {
  return weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2];
}

/// Position of the point of segment ab closest to p, as a share of the way from a to b.
[[nodiscard]] inline double closest_share(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                          const Eigen::Vector2d& p) {
  const Eigen::Vector2d way = b - a;
  const double squared = way.squaredNorm();
  return squared > 0 ? std::clamp((p - a).dot(way) / squared, 0.0, 1.0) : 0;
}

[[nodiscard]] inline double closest_share(Vec3 a, Vec3 b, Vec3 p) {
  const Vec3 way = b - a;
  const double squared = squared_length(way);
  return squared > 0 ? std::clamp(dot(p - a, way) / squared, 0.0, 1.0) : 0;
}

}  // namespace meshbound
