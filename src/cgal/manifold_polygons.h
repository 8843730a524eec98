// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "meshbound/cgal/surface_mesh.h"

namespace meshbound::cgal {

/// Corners as indices, as CGAL's functions on polygon soups take them.
using Polygon = std::array<std::size_t, 3>;

/// What a `ManifoldCopy` is built from; its members mean the same.
struct ManifoldPolygons {
  std::vector<Kernel::Point_3> points;
  std::vector<Polygon> polygons;
  std::vector<std::uint32_t> triangle_of_face;
  std::vector<std::uint32_t> vertex_of_vertex;
  std::size_t dropped_triangles = 0;
  bool split = false;
};

/// The first step of `manifold_copy`, see there.
[[nodiscard]] ManifoldPolygons manifold_polygons(const TriangleMesh& soup);
/// The second. O(n).
[[nodiscard]] ManifoldCopy to_manifold_copy(ManifoldPolygons polygons);

/// Vertices and faces in the given order. Throws `InvalidInput` when a polygon does not fit or a point is not used.
[[nodiscard]] SurfaceMesh to_surface_mesh(const std::vector<Kernel::Point_3>& points,
                                          const std::vector<Polygon>& polygons);

}  // namespace meshbound::cgal
