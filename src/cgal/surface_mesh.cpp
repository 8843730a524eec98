// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshbound/cgal/surface_mesh.h"

#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>

#include <array>
#include <string>
#include <utility>

#include "simplify/mesh/manifold_soup.h"

namespace meshbound::cgal {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using Point = Kernel::Point_3;

Point to_point(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

}  // namespace

SurfaceMesh to_surface_mesh(const TriangleMesh& mesh) {
  SurfaceMesh result;
  for (const Eigen::Vector3d& p : mesh.vertices) result.add_vertex(to_point(p));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& corners = mesh.triangles[t];
    const auto face = result.add_face(SurfaceMesh::Vertex_index(corners[0]), SurfaceMesh::Vertex_index(corners[1]),
                                      SurfaceMesh::Vertex_index(corners[2]));
    if (face == SurfaceMesh::null_face())
      throw InvalidInput("triangle " + std::to_string(t) +
                         " does not fit a 2-manifold with those before it; use manifold_copy to split the mesh");
  }
  return result;
}

ManifoldCopy manifold_copy(const TriangleMesh& soup) {
  ManifoldSoup manifold = manifold_soup(soup);
  if (manifold.faces.empty()) throw InvalidInput("there is no surface: every triangle has two equal corners");
  std::vector<Point> points;
  points.reserve(manifold.vertex_of.size());
  for (const std::uint32_t v : manifold.vertex_of) points.push_back(to_point(soup.vertices[v]));
  std::vector<std::array<std::size_t, 3>> polygons;
  polygons.reserve(manifold.faces.size());
  for (const auto& f : manifold.faces) polygons.push_back({f[0], f[1], f[2]});
  ManifoldCopy copy;
  PMP::polygon_soup_to_polygon_mesh(points, polygons, copy.mesh);
  copy.source_triangle = std::move(manifold.triangle_of);
  copy.source_vertex = std::move(manifold.vertex_of);
  copy.dropped_triangles = manifold.dropped_triangles;
  copy.split = manifold.split;
  return copy;
}

}  // namespace meshbound::cgal
