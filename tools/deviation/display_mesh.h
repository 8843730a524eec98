// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <limits>
#include <vector>

#include "meshbound/bounds.h"
#include "meshbound/bvh.h"
#include "meshbound/deviation_map.h"
#include "meshbound/line_mesh.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound::tools {

/// A mesh of bounded size to look at in place of another one, with deviations at its vertices.
struct DisplayMesh {
  TriangleMesh mesh;  ///< model units
  /// By vertex of `mesh`: how far it is at most from the surface that it shows, as points inside of triangles are
  /// rounded; model units.
  std::vector<double> errors;
  std::vector<Bounds> deviations;  ///< of the surface where its vertices show it, model units
  std::vector<Edge> edges;         ///< edges of the mesh that it shows; its own edges if it is reduced
  std::size_t faces = 0;           ///< of the mesh that it shows
  bool is_reduced = false;         ///< it has fewer triangles than the mesh that it shows
};

/// How large a display mesh may be.
struct DisplayLimits {
  std::size_t max_triangles = 0;
  /// Bytes of text in a report. Where a mesh of `max_triangles` takes more, a smaller one is made.
  std::size_t max_size = std::numeric_limits<std::size_t>::max();
  std::size_t deviation_sets = 1;  ///< how many deviations a report has for each vertex
};

/// The bytes of text that a report holds of a mesh with this many deviations for each vertex.
[[nodiscard]] std::size_t packed_size(const DisplayMesh& display, std::size_t deviation_sets);

/// A mesh within the limits that shows `mesh` and how far it is from `other`; `vertices` are the deviations of
/// the vertices of `mesh`. A larger mesh is reduced: its vertices are clustered in the cells of a grid, and the one
/// that is furthest from `other` stands for its cell, so that no peak is lost. The triangles of a smaller one are cut
/// into equal parts with deviations of their own, so that what stands between the vertices is seen. Throws `Stopped` as
/// the options say. O(n log n).
[[nodiscard]] DisplayMesh display_mesh(const TriangleMesh& mesh, const std::vector<Bounds>& vertices, const Bvh& other,
                                       const DisplayLimits& limits, const DeviationOptions& options);

/// The distance from `other` of the surface that a display mesh shows, at each of its vertices. Throws `Stopped` as the
/// options say.
[[nodiscard]] std::vector<Bounds> display_deviations(const DisplayMesh& display, const Bvh& other,
                                                     const DeviationOptions& options);

}  // namespace meshbound::tools
