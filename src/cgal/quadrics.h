// SPDX-License-Identifier: GPL-3.0-or-later
/// The quadric error metric of Garland and Heckbert, "Surface simplification using quadric error metrics", SIGGRAPH
/// 1997, with planes weighted as CGAL's `GarlandHeckbert_plane_policies` weights them.
#pragma once
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "meshbound/cgal/surface_mesh.h"

namespace meshbound::cgal {

/// Sum of squared distances to planes, x.A x + 2 b.x + c with a symmetric A.
struct Quadric {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;  ///< A
  double x = 0, y = 0, z = 0;                             ///< b
  double constant = 0;

  /// `weight` times the squared distance to the plane through `p` with the unit vector `normal`.
  static Quadric of_plane(const Kernel::Vector_3& normal, const Kernel::Point_3& p, double weight);
  Quadric& operator+=(const Quadric& other);
  [[nodiscard]] double at(const Kernel::Point_3& p) const;
  /// Where it is least; none where A is singular.
  [[nodiscard]] std::optional<Kernel::Point_3> minimum() const;
};

/// Quadrics of the vertices of a mesh that is being decimated, and the cost and placement of its edges. CGAL asks for
/// both of every edge in the two rings around a collapse, though they change for those at the new vertex only: they are
/// kept by edge. Memory: O(vertices + edges).
class Quadrics {
 public:
  /// True for border edges, given by their ends, that are none of the whole mesh.
  using IsSeamEdge = std::function<bool(SurfaceMesh::Vertex_index, SurfaceMesh::Vertex_index)>;
  /// Of the mesh as it is now: the planes of the faces around a vertex, and through border edges, perpendicular to
  /// their face. Vertices and edges must keep their indices from now on.
  explicit Quadrics(const SurfaceMesh& mesh, const IsSeamEdge& is_seam_edge = nullptr);
  /// Of a mesh that was decimated elsewhere: by vertex.
  Quadrics(std::vector<Quadric> of_vertex, const SurfaceMesh& mesh);
  [[nodiscard]] const Quadric& of_vertex(SurfaceMesh::Vertex_index v) const { return of_vertex_[v]; }

  /// Half a cache line: they are looked up all over the mesh.
  struct alignas(32) Collapse {
    Kernel::Point_3 placement{0, 0, 0};
    double cost = unknown;
  };
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  /// Of the edge, with ends v0 and v1 at p0 and p1. The placement is where the sum of their quadrics is least; where
  /// that is too far away to be believed, the best of the middle and the ends.
  const Collapse& of_edge(SurfaceMesh::Edge_index edge, SurfaceMesh::Vertex_index v0, SurfaceMesh::Vertex_index v1,
                          const Kernel::Point_3& p0, const Kernel::Point_3& p1);
  /// Cost of another placement for both ends.
  [[nodiscard]] double cost(SurfaceMesh::Vertex_index v0, SurfaceMesh::Vertex_index v1, const Kernel::Point_3& p) const;

  /// `kept` stands for v0 and v1 in `mesh` now.
  void collapsed(SurfaceMesh::Vertex_index v0, SurfaceMesh::Vertex_index v1, SurfaceMesh::Vertex_index kept,
                 const SurfaceMesh& mesh);
  /// Vertices may have moved and edges been flipped. O(edges).
  void forget_edges() { known_.assign(known_.size(), Collapse{}); }

 private:
  std::vector<Quadric> of_vertex_;
  std::vector<Collapse> known_;  ///< by edge
};

}  // namespace meshbound::cgal
