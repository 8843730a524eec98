// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <vector>

#include "meshbound/bounds.h"
#include "meshbound/bvh.h"
#include "meshbound/deviation_map.h"
#include "meshbound/line_mesh.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound::tools {

/// A mesh of bounded size to look at in place of another one, with deviations at its vertices.
struct DisplayMesh {
  TriangleMesh mesh;               ///< model units
  std::vector<Bounds> deviations;  ///< of its vertices, model units
  std::vector<Edge> edges;         ///< edges of the mesh that it shows; its own edges if it is reduced
  std::size_t faces = 0;           ///< of the mesh that it shows
  bool is_reduced = false;         ///< it has fewer triangles than the mesh that it shows
};

/// A mesh of at most `max_triangles` that shows `mesh` and how far it is from `other`; `vertices` are the deviations of
/// the vertices of `mesh`. A larger mesh is reduced: its vertices are clustered in the cells of a grid, and the one
/// that is furthest from `other` stands for its cell, so that no peak is lost. The triangles of a smaller one are cut
/// into equal parts with deviations of their own, so that what stands between the vertices is seen. Throws `Stopped` as
/// the options say. O(n log n).
[[nodiscard]] DisplayMesh display_mesh(const TriangleMesh& mesh, const std::vector<Bounds>& vertices, const Bvh& other,
                                       std::size_t max_triangles, const DeviationOptions& options);

}  // namespace meshbound::tools
