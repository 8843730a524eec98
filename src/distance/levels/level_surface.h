// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "bvh/bvh_data.h"
#include "distance/search/search_memory.h"
#include "meshbound/mesh_view.h"

namespace meshbound {

/// A level in model coordinates, numbered as its tree numbers it: what a later level, whose tree may have another
/// frame, is compared with.
struct LevelSurface {
  std::vector<Vec3> vertices;     ///< model units, by the tree's vertex
  std::vector<Triangle> corners;  ///< by slot

  LevelSurface() = default;
  /// `tree` is the one built from `level`.
  LevelSurface(const Bvh::Data& tree, const MeshView& level);
};

/// Where the triangles and vertices of one level are in the next one; `no_slot` for those that are not there any more,
/// bit for bit.
struct Successors {
  std::vector<std::uint32_t> slot;    ///< by old slot
  std::vector<std::uint32_t> vertex;  ///< by old vertex
  /// By old slot: its successor, or a triangle at one of its corners, or `no_slot`.
  std::vector<std::uint32_t> near_slot;

  /// O(n).
  Successors(const LevelSurface& from, const LevelSurface& to);
};

/// The memory of a search from a fixed model to `from`, as far as it holds for the next level: proofs whose triangles
/// are all still there.
[[nodiscard]] SearchMemory inherited_by_original(const SearchMemory& memory, const Successors& next);

/// The memory of a search from the old level to a fixed model, as far as it holds for the triangles of the new level
/// `to`.
[[nodiscard]] SearchMemory inherited_by_level(const SearchMemory& memory, const Successors& next, const Bvh::Data& to);

}  // namespace meshbound
