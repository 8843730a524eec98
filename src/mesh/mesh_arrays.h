// SPDX-License-Identifier: MIT
/// Copies of what a view shows, in the order of its mesh, for those that read it over and over.
#pragma once
#include <cstddef>
#include <vector>

#include "geometry/vec3.h"
#include "meshbound/mesh_view.h"

namespace meshbound {

inline std::vector<Vec3> positions_of(const MeshView& mesh) {
  std::vector<Vec3> positions(mesh.vertex_count());
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const Eigen::Vector3d p = mesh.vertex(v);
    positions[v] = {p.x(), p.y(), p.z()};
  }
  return positions;
}

inline std::vector<Triangle> triangles_of(const MeshView& mesh) {
  std::vector<Triangle> triangles(mesh.triangle_count());
  for (std::size_t i = 0; i < triangles.size(); ++i) triangles[i] = mesh.triangle(i);
  return triangles;
}

}  // namespace meshbound
