// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <vector>

#include "meshbound/cgal/surface_mesh.h"
#include "numeric/no_index.h"
#include "simplify/region_collapses.h"

namespace meshbound::cgal {

/// The faces of one region of an array mesh as a `Surface_mesh`, which CGAL collapses and the array mesh follows.
struct RegionMesh {
  /// Takes faces whose corners all belong to the region: all of them, or where few edges are open those around these. A
  /// vertex at the rim may have several fans of them, of which CGAL finds only one; no collapse ever involves an edge
  /// at such a vertex. O(n), and a word for 4096 faces of the whole mesh.
  explicit RegionMesh(const RegionCollapses& collapses);

  /// Edges from an open edge to vertices whose faces are all taken: a collapse opens the edges around its vertex. What
  /// becomes open beyond waits for the next region.
  static constexpr int rings_around_open = 2;
  /// A region with fewer edges for each open one is taken whole.
  static constexpr std::size_t edges_of_open = 8;

  SurfaceMesh mesh;
  std::vector<std::uint32_t> vertex;   ///< by vertex of `mesh`: vertex of the array mesh
  std::vector<std::uint8_t> is_inner;  ///< by vertex of `mesh`: all of its faces that belong to the region are taken
  std::size_t max_edges_of_vertex = 0;
  bool has_edge_of_no_length = false;  ///< among the open edges
};

/// The corner whose edge joins these vertices of the array mesh, in either direction; `no_index` if they are not
/// neighbours. O(edges of `a`).
[[nodiscard]] Corner corner_between(const ArrayMesh& mesh, std::uint32_t a, std::uint32_t b);

}  // namespace meshbound::cgal
