// SPDX-License-Identifier: MIT
/// Boxes of triangles, and distances from them.
#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "geometry/eigen_vec3.h"
#include "geometry/point_triangle.h"
#include "geometry/triangle_corners.h"
#include "geometry/vec3.h"

namespace meshbound {

inline Eigen::AlignedBox3d box_of(const TriangleCorners& corners) {
  Eigen::AlignedBox3d box;
  for (const Vec3 p : corners) box.extend(to_eigen(p));
  return box;
}
inline Eigen::AlignedBox3d box_of(const std::array<Eigen::Vector3d, 3>& corners) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : corners) box.extend(p);
  return box;
}
/// The box of a triangle in the plane at this height.
inline Eigen::AlignedBox3d box_of(const std::array<Eigen::Vector2d, 3>& corners, double height) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector2d& p : corners) box.extend(Eigen::Vector3d(p.x(), p.y(), height));
  return box;
}
inline Eigen::AlignedBox3d grown(const Eigen::AlignedBox3d& box, double by) {
  return {box.min().array() - by, box.max().array() + by};
}

/// Whether the box of a triangle and another one have a point in common.
inline bool box_meets(const TriangleCorners& corners, const Eigen::AlignedBox3d& box) {
  const auto meets = [](double p, double q, double r, double min, double max) {
    return std::min(std::min(p, q), r) <= max && std::max(std::max(p, q), r) >= min;
  };
  const auto& [a, b, c] = corners;
  return meets(a.x, b.x, c.x, box.min().x(), box.max().x()) && meets(a.y, b.y, c.y, box.min().y(), box.max().y()) &&
         meets(a.z, b.z, c.z, box.min().z(), box.max().z());
}

/// As computed, for guides; a proof asks `PreparedTriangle`.
inline double squared_distance(const TriangleCorners& corners, Vec3 p) {
  const auto& [a, b, c] = corners;
  return closest_on_triangle(CornerTriangle<double>{a, b - a, c - a}, p).squared_distance;
}

/// As Eigen's `squaredExteriorDistance`, without its branches: which way they go cannot be foretold in a search.
inline double squared_distance(const Eigen::AlignedBox3d& box, Vec3 p) {
  const auto beyond = [](double min, double max, double at) { return std::max(std::max(min - at, at - max), 0.0); };
  return squared_length(Vec3{beyond(box.min().x(), box.max().x(), p.x), beyond(box.min().y(), box.max().y(), p.y),
                             beyond(box.min().z(), box.max().z(), p.z)});
}

}  // namespace meshbound
