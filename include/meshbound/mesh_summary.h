// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Geometry>
#include <cstddef>

#include "meshbound/mesh_view.h"

namespace meshbound {

/// Facts about a mesh that reports show.
struct MeshSummary {
  std::size_t vertices = 0;    ///< as stored, unused ones included
  std::size_t faces = 0;       ///< triangles, degenerate ones included
  std::size_t components = 0;  ///< sets of triangles connected through shared vertices
  bool closed = false;         ///< every edge has exactly two triangles, and no triangle repeats a vertex
  double bbox_diagonal = 0;    ///< of the vertices that triangles use, model units
};

/// The facts about a mesh. O(n) time and memory. Here and below every index must be in range, as `validate` checks.
/// Safe to call from several threads.
[[nodiscard]] MeshSummary summarise(const MeshView& mesh);

/// Bounding box of the vertices that triangles use, model units; empty when there are none. O(n).
[[nodiscard]] Eigen::AlignedBox3d used_bounding_box(const MeshView& mesh);

/// Length of the diagonal of a box, rounded, without overflow or underflow in between; 0 when it is empty.
[[nodiscard]] double diagonal_of(const Eigen::AlignedBox3d& box);

/// `diagonal_of` the `used_bounding_box`: what lengths in percent are relative to. O(n).
[[nodiscard]] double bounding_box_diagonal(const MeshView& mesh);

}  // namespace meshbound
