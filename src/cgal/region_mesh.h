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
  /// Takes the faces whose corners all belong to the region. A vertex at its rim may have several fans of them, of
  /// which CGAL finds only one; no collapse ever involves an edge at such a vertex. O(n), and a word
  /// for 4096 faces of the whole mesh.
  explicit RegionMesh(const RegionCollapses& collapses);

  SurfaceMesh mesh;
  std::vector<std::uint32_t> vertex;  ///< by vertex of `mesh`: vertex of the array mesh
  std::vector<std::uint8_t> is_open;  ///< by edge of `mesh`, at the start: see `RegionCollapses::is_open`
  std::size_t max_edges_of_vertex = 0;
  bool has_edge_of_no_length = false;  ///< among the open edges
};

/// The corner whose edge joins these vertices of the array mesh, in either direction; `no_index` if they are not
/// neighbours. O(edges of `a`).
[[nodiscard]] Corner corner_between(const ArrayMesh& mesh, std::uint32_t a, std::uint32_t b);

}  // namespace meshbound::cgal
