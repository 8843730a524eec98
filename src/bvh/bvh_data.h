// SPDX-License-Identifier: MIT
/// The tree: triangles in the order of a Hilbert curve, packed into full blocks of four, and 8-wide nodes stacked on
/// runs of eight, so that children are found by arithmetic and the build is a sort. After Kamel and Faloutsos, "On
/// Packing R-trees", CIKM 1993.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <vector>

#include "bvh/array.h"
#include "geometry/frame.h"
#include "geometry/vec3.h"
#include "meshbound/bvh.h"

namespace meshbound {

inline constexpr std::uint32_t block_width = 4;  ///< triangles of a leaf (the paper's bound, section 4.2.1)
inline constexpr std::uint32_t node_width = 8;   ///< children of a node
inline constexpr std::uint32_t no_slot = 0x7fffffff;

/// Boxes of up to eight children, rounded outward; unused ones are empty (lo = +inf, hi = -inf).
struct alignas(32) BvhNode {
  float lo[3][node_width];
  float hi[3][node_width];
};

/// A box of double precision in the working frame.
struct Box {
  Vec3 lo{1e300, 1e300, 1e300};
  Vec3 hi{-1e300, -1e300, -1e300};
};

/// What lies across an edge of a triangle. A hint for walking, never trusted for a bound.
struct Neighbour {
  std::uint32_t slot : 31 = no_slot;
  std::uint32_t flipped : 1 = 0;  ///< runs along the edge the same way: its normal points to the other side
};

/// [k]: across the edge from corner k to corner k + 1.
using EdgeNeighbours = std::array<Neighbour, 3>;

/// The boxes of the children of a node, in a frame of its own.
struct OrientedNode {
  Vec3 centre;
  std::array<Vec3, 3> axes;  ///< the rows of a rotation, up to roundings
  BvhNode children;
};

/// By node of a tree, or none; made when they are first wanted (bvh/oriented_nodes.h).
struct OrientedNodes {
  std::mutex making;
  std::atomic<bool> made{false};
  std::vector<OrientedNode> nodes;
};

struct Bvh::Data {
  Data() = default;
  explicit Data(std::size_t arena_bytes) : arena(arena_bytes) {}

  Arena arena;               ///< memory for the arrays of a new tree, as far as it has room
  std::uint64_t serial = 0;  ///< identifies these coordinates; never given twice in a process
  double built_cost = 0;     ///< `tree_cost` before the first refit; 0: never refitted
  Frame frame;
  Eigen::AlignedBox3d bounding_box;  ///< model units
  double diagonal = 0;               ///< length of the diagonal of `bounding_box`, model units
  Box working_box;

  // By vertex, in the order of first use along the curve. Only vertices that triangles use.
  Array<Vec3> vertices = array_in<Vec3>(arena);
  Array<std::uint32_t> source_vertex =
      array_in<std::uint32_t>(arena);  ///< index in the mesh that the tree was built from
  // By slot: the index of a triangle along the curve.
  Array<Triangle> corners = array_in<Triangle>(arena);
  Array<EdgeNeighbours> neighbours = array_in<EdgeNeighbours>(arena);
  Array<std::array<float, 3>> normals = array_in<std::array<float, 3>>(arena);  ///< unit, or 0 for zero area; a hint
  Array<std::uint32_t> triangle_of_slot = array_in<std::uint32_t>(arena);
  // By level: nodes[level_begin[l] + i] has the children 8 i ... 8 i + 7 of level l - 1; level 0 are the blocks.
  Array<BvhNode> nodes = array_in<BvhNode>(arena);
  std::vector<std::uint32_t> level_begin;
  mutable OrientedNodes oriented;

  [[nodiscard]] std::uint32_t triangle_count() const { return static_cast<std::uint32_t>(corners.size()); }
  /// Number of leaves: block i has the slots 4 i ... 4 i + 3, as far as there are triangles.
  [[nodiscard]] std::uint32_t block_count() const { return (triangle_count() + block_width - 1) / block_width; }
  [[nodiscard]] std::uint32_t levels() const { return static_cast<std::uint32_t>(level_begin.size()) - 1; }
};

}  // namespace meshbound
