// SPDX-License-Identifier: MIT
/// Copies of what a view shows: of all vertices and triangles, in its order, for algorithms that read them many times,
/// and of the corners of one triangle.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
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

[[nodiscard]] inline std::array<Eigen::Vector3d, 3> corners_of(const MeshView& mesh, std::size_t triangle) {
  const Triangle t = mesh.triangle(triangle);
  return {mesh.vertex(t[0]), mesh.vertex(t[1]), mesh.vertex(t[2])};
}

/// By vertex: 1 where a triangle uses it, else 0. Indices must be in range. O(n).
inline std::vector<std::uint8_t> used_vertices(const MeshView& mesh) {
  std::vector<std::uint8_t> used(mesh.vertex_count(), 0);
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i)
    for (const std::uint32_t v : mesh.triangle(i)) used[v] = 1;
  return used;
}

}  // namespace meshbound
