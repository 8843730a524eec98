// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "meshbound/attributes.h"
#include "numeric/no_index.h"
#include "proof/edge_neighbours.h"

namespace meshbound {

/// Triangles with the same corners, such as a decal and what it lies on. Empty where a mesh has none.
struct Layers {
  /// A triangle that counts for nothing, for it looks like one before it with the same corners.
  struct Repetition {
    std::uint32_t triangle, of;
  };
  /// By triangle: `SimplifyOptions::looks`, 0 for triangles that have their corners for themselves. Empty where looks
  /// do not count.
  std::vector<std::uint32_t> look;
  /// By triangle: its layer, 0 for the first triangle with its corners; `no_index`: it repeats another one.
  std::vector<std::uint32_t> sheet;
  std::vector<Repetition> repetitions;

  [[nodiscard]] bool empty() const { return sheet.empty(); }
  [[nodiscard]] bool repeats(std::uint32_t triangle) const { return !empty() && sheet[triangle] == no_index; }
};

/// Triangles with the same corners look alike where they show the same side and have the same part, material, object,
/// group and values at their corners. `first`: by vertex, the first one at its position; `neighbours` as
/// `edge_neighbours` finds them. O(n log n).
[[nodiscard]] Layers layers(const TriangleMesh& mesh, const MeshAttributes& attributes,
                            const std::vector<std::uint32_t>& first, std::span<const TriangleNeighbours> neighbours);

/// One layer: triangles with the same corners are repetitions of the first one, whatever they look like. O(n log n).
[[nodiscard]] Layers single_layer(const TriangleMesh& mesh, const std::vector<std::uint32_t>& first,
                                  std::span<const TriangleNeighbours> neighbours);

/// The neighbours of triangles in their layers; repetitions have none. O(n log n).
[[nodiscard]] std::vector<TriangleNeighbours> neighbours_in_layers(const TriangleMesh& mesh, const Layers& layers);

}  // namespace meshbound
