// SPDX-License-Identifier: MIT
/// Closed models with known shape.
#pragma once
#include <Eigen/Geometry>
#include <utility>

#include "meshbound/triangle_mesh.h"

namespace meshbound::solids {

using Eigen::Vector3d;

/// The surface of an axis-parallel box, 12 triangles, normals outwards.
inline TriangleMesh box(const Vector3d& low, const Vector3d& high) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(), i & 4 ? high.z() : low.z());
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

inline TriangleMesh reversed(TriangleMesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

inline TriangleMesh mapped(TriangleMesh mesh, const Eigen::Isometry3d& map) {
  for (Vector3d& v : mesh.vertices) v = map * v;
  return mesh;
}

inline Eigen::Isometry3d motion(const Vector3d& shift, double angle = 0, const Vector3d& axis = Vector3d::UnitZ()) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(shift);
  pose.rotate(Eigen::AngleAxisd(angle, axis.normalized()));
  return pose;
}

}  // namespace meshbound::solids
