// SPDX-License-Identifier: GPL-3.0-or-later
/// Between CGAL's face graphs and the core's triangle soups. Points of any kernel go through `CGAL::to_double`, which
/// is exact where coordinates are doubles (`Simple_cartesian<double>`, inexact constructions) and rounds those of exact
/// constructions.
#pragma once
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/helpers.h>
#include <CGAL/boost/graph/iterator.h>
#include <CGAL/boost/graph/properties.h>

#include <cstdint>
#include <vector>

#include "meshbound/error.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound::cgal {

/// The mesh type that the compiled part of this library works on. `Simple_cartesian<double>`: nothing here needs exact
/// predicates, and it is faster than the filtered kernels.
using Kernel = CGAL::Simple_cartesian<double>;
/// Vertices and faces with points of `Kernel`.
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;

/// Copies a face graph with the given vertex point map; vertices and faces in the order of the graph's ranges.
/// Throws `InvalidInput` when a face is not a triangle. O(n).
template <class FaceGraph, class VertexPointMap>
[[nodiscard]] TriangleMesh to_triangle_mesh(const FaceGraph& graph, const VertexPointMap& points) {
  TriangleMesh mesh;
  using Vertex = typename boost::graph_traits<FaceGraph>::vertex_descriptor;
  const auto index = get(CGAL::dynamic_vertex_property_t<std::uint32_t>(), const_cast<FaceGraph&>(graph));
  for (const Vertex v : vertices(graph)) {
    put(index, v, static_cast<std::uint32_t>(mesh.vertices.size()));
    const auto& p = get(points, v);
    mesh.vertices.emplace_back(CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z()));
  }
  for (const auto f : faces(graph)) {
    const auto h = halfedge(f, graph);
    if (!CGAL::is_triangle(h, graph)) throw InvalidInput("the mesh has a face that is not a triangle; triangulate it");
    mesh.triangles.push_back(
        {get(index, target(h, graph)), get(index, target(next(h, graph), graph)), get(index, source(h, graph))});
  }
  return mesh;
}

/// Copies a face graph with its own points, `CGAL::vertex_point`; as above.
template <class FaceGraph>
[[nodiscard]] TriangleMesh to_triangle_mesh(const FaceGraph& graph) {
  return to_triangle_mesh(graph, get(CGAL::vertex_point, graph));
}

/// Builds a Surface_mesh with the vertices and triangles of `mesh`, in their order. Throws `InvalidInput` when the
/// triangles do not form a 2-manifold: `manifold_copy` can split those.
[[nodiscard]] SurfaceMesh to_surface_mesh(const TriangleMesh& mesh);

/// A 2-manifold made from a triangle soup for decimation.
struct ManifoldCopy {
  SurfaceMesh mesh;                            ///< a 2-manifold
  std::vector<std::uint32_t> source_triangle;  ///< by face index: the triangle of the soup
  std::vector<std::uint32_t> source_vertex;    ///< by vertex index: a vertex of the soup with the same coordinates
  std::size_t dropped_triangles = 0;  ///< duplicates, and those with two equal corners; geometry of the soup only
  bool split = false;                 ///< vertices were duplicated or triangles turned over to make it manifold
};

/// Welds vertices of equal coordinates, drops duplicate triangles and those with two equal corners, and where the rest
/// is not a 2-manifold turns triangles over and duplicates vertices, as decimation in the core does. The surface is
/// that of the soup but for what was dropped. Throws `InvalidInput` when nothing is left. O(n log n).
[[nodiscard]] ManifoldCopy manifold_copy(const TriangleMesh& soup);

}  // namespace meshbound::cgal
