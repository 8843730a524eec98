// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "geometry/vec3.h"
#include "mesh/item_store.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound {

/// Where planes cut a mesh into tiles.
struct TileCut {
  int direction = 0;         ///< of the axes, below `cut_directions`
  double first_share = 0.5;  ///< of the items before the first plane; all further planes halve
};

/// A vertex or triangle of a mesh.
struct CutItem {
  Vec3 position;
  std::uint32_t number = 0, weight = 1;
};

/// Takes the tiles one after the other, as the numbers of their items, which ascend.
using UseTile = std::function<void(std::span<const std::uint32_t>)>;

/// Items with different numbers in tiles: cut by planes across the longest side of the box of what is left, until no
/// tile weighs more than `max_weight` or has more than one item. O(n log n) for n items.
void cut_into_tiles(std::vector<CutItem> items, std::uint64_t max_weight, const TileCut& cut, const UseTile& use);

/// Items of a store that are cut in memory: 80 MB.
inline constexpr std::size_t max_cut_in_memory = std::size_t{1} << 20;

/// As above for items of a store, in the order of their numbers, of which at most twice `max_in_memory` are in memory
/// at once: gives the same tiles for any such number from 256 on. Expected O(n log n); reads each item about once for
/// each halving, and copies it once for 64 parts that it is cut into. Throws `IoError`.
void cut_into_tiles(ItemStore<CutItem> items, std::uint64_t max_weight, const TileCut& cut, const StoreSpace& space,
                    const UseTile& use, std::size_t max_in_memory = max_cut_in_memory);

/// Three times the centroid of a triangle.
[[nodiscard]] inline Eigen::Vector3d sum_of_corners(const TriangleMesh& mesh, std::uint32_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c];
}

}  // namespace meshbound
