// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "meshbound/attributes.h"
#include "proof/edge_neighbours.h"

namespace meshbound {

/// Triangles with the same corners, such as a decal and what it lies on. Empty where a mesh has none.
struct Layers {
  /// By triangle: `SimplifyOptions::looks`, 0 for triangles that have their corners for themselves.
  std::vector<std::uint32_t> look;
  /// By triangle: its layer, 0 for the first triangle with its corners; `no_index`: it repeats another one.
  std::vector<std::uint32_t> sheet;

  [[nodiscard]] bool empty() const { return sheet.empty(); }
};

/// Triangles with the same corners look alike where they show the same side and have the same part, material and values
/// at their corners. `first`: by vertex, the first one at its position; `neighbours` as `edge_neighbours` finds them.
/// O(n log n).
[[nodiscard]] Layers layers(const TriangleMesh& mesh, const MeshAttributes& attributes,
                            const std::vector<std::uint32_t>& first, std::span<const TriangleNeighbours> neighbours);

/// The neighbours of triangles in their layers; repetitions have none. O(n log n).
[[nodiscard]] std::vector<TriangleNeighbours> neighbours_in_layers(const TriangleMesh& mesh, const Layers& layers);

}  // namespace meshbound
