// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "mesh/number_lists.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound {

/// Where planes cut a mesh into tiles.
struct TileCut {
  int direction = 0;         ///< of the axes, below `cut_directions`
  double first_share = 0.5;  ///< of the items before the first plane; all further planes halve
};

/// Where an item of a mesh is, by its number.
using PositionOf = std::function<Eigen::Vector3d(std::uint32_t)>;

/// Vertices or triangles of a mesh in tiles: cut by planes across the longest side of the box of what is left, until no
/// tile weighs more than `max_weight` or has more than one item. `weights`: by item number, or empty where each weighs
/// 1. Numbers in a tile ascend. O(n log n) for n items, which are different.
[[nodiscard]] NumberLists cut_into_tiles(std::vector<std::uint32_t> items, const PositionOf& position,
                                         std::span<const std::uint32_t> weights, std::uint64_t max_weight,
                                         const TileCut& cut = {});

/// Three times the centroid of a triangle.
[[nodiscard]] inline Eigen::Vector3d sum_of_corners(const TriangleMesh& mesh, std::uint32_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c];
}

/// Some triangles of a mesh as a mesh of their own.
struct MeshPart {
  TriangleMesh mesh;                    ///< the triangles in the order that they were asked for
  std::vector<std::uint32_t> vertices;  ///< by vertex of the part: its number in the whole, ascending
};

/// O(n log n) for n triangles.
[[nodiscard]] MeshPart part_of(const TriangleMesh& whole, std::span<const std::uint32_t> triangles);

}  // namespace meshbound
