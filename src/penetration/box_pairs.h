// SPDX-License-Identifier: MIT
/// A simultaneous descent of two trees: the pairs of leaves whose boxes overlap.
#pragma once
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "bvh/bvh_data.h"
#include "geometry/mapping.h"
#include "penetration/sparse_array.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {

struct FloatBox {
  float lo[3], hi[3];
};

inline Box child_box(const BvhNode& node, std::uint32_t child) {
  return {{node.lo[0][child], node.lo[1][child], node.lo[2][child]},
          {node.hi[0][child], node.hi[1][child], node.hi[2][child]}};
}

/// The box around the image of a box, grown by `margin` and rounded outward.
inline FloatBox mapped_box(const Mapping& map, const Box& box, double margin) {
  const Vec3 middle = map(0.5 * (box.lo + box.hi)), half = 0.5 * (box.hi - box.lo);
  const double centre[3] = {middle.x, middle.y, middle.z};
  FloatBox image;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3& row = map.rows[axis];
    const double reach = std::fabs(row.x) * half.x + std::fabs(row.y) * half.y + std::fabs(row.z) * half.z + margin;
    // Two roundings of a float on each side are less than 2^-22 of the larger magnitude.
    const double slack = (std::fabs(centre[axis]) + reach) * 0x1p-22;
    image.lo[axis] = static_cast<float>(centre[axis] - reach - slack);
    image.hi[axis] = static_cast<float>(centre[axis] + reach + slack);
  }
  return image;
}

/// The children of the node whose boxes meet the box, a bit for each. Without branches, which would be guessed wrong
/// for most nodes.
inline unsigned overlapping_children(const BvhNode& node, const FloatBox& box) {
  unsigned lanes = 0;
#if defined(__SSE2__)
  for (unsigned first = 0; first < node_width; first += 4) {
    __m128 meet = _mm_castsi128_ps(_mm_set1_epi32(-1));
    for (int axis = 0; axis < 3; ++axis) {
      const __m128 below = _mm_cmple_ps(_mm_load_ps(node.lo[axis] + first), _mm_set1_ps(box.hi[axis])),
                   above = _mm_cmple_ps(_mm_set1_ps(box.lo[axis]), _mm_load_ps(node.hi[axis] + first));
      meet = _mm_and_ps(meet, _mm_and_ps(below, above));
    }
    lanes |= static_cast<unsigned>(_mm_movemask_ps(meet)) << first;
  }
#else
  for (unsigned lane = 0; lane < node_width; ++lane) {
    bool meet = true;
    for (int axis = 0; axis < 3; ++axis)
      meet = meet && node.lo[axis][lane] <= box.hi[axis] && box.lo[axis] <= node.hi[axis][lane];
    lanes |= static_cast<unsigned>(meet) << lane;
  }
#endif
  return lanes;
}

inline bool overlaps(const FloatBox& p, const FloatBox& q) {
  for (int axis = 0; axis < 3; ++axis)
    if (!(p.lo[axis] <= q.hi[axis] && q.lo[axis] <= p.hi[axis])) return false;
  return true;
}

/// A node of each of two trees; level 0 are the leaves.
struct NodePair {
  std::uint32_t level_a, a, level_b, b;
};

/// The box of a node in the working frame of its tree; that of the root is taken as all of space.
inline FloatBox box_of(const Bvh::Data& data, std::uint32_t level, std::uint32_t index) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  if (level + 1 == data.levels()) return {{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}};
  const BvhNode& node = data.nodes[data.level_begin[level + 1] + index / node_width];
  const std::uint32_t lane = index % node_width;
  return {{node.lo[0][lane], node.lo[1][lane], node.lo[2][lane]},
          {node.hi[0][lane], node.hi[1][lane], node.hi[2][lane]}};
}

/// Memory of `visit_box_pairs` from call to call.
struct BoxPairMemory {
  std::vector<NodePair> stack;
  SparseArray<FloatBox> mapped;  ///< by node of b and child: its box as seen from a, computed once in a call
};

/// Calls `on_leaves(block_a, block_b)` for all pairs of leaves whose boxes overlap, and possibly for some others, until
/// it returns false. Returns whether it never did. Leaves out pairs of nodes of which `are_apart(pair)` is true. `map`
/// leads from the working frame of b to that of a. In a tree compared with itself (`is_same`) each pair comes once,
/// with block_a <= block_b.
template <class AreApart, class OnLeaves>
bool visit_box_pairs(const Bvh::Data& a, const Bvh::Data& b, const Mapping& map, bool is_same,
                     const AreApart& are_apart, BoxPairMemory& memory, std::uint64_t& compared, OnLeaves&& on_leaves) {
  const double scale = std::fabs(map.rows[0].x) + std::fabs(map.rows[0].y) + std::fabs(map.rows[0].z);
  const double margin = map.error + a.frame.error + 2 * scale * b.frame.error + 0x1p-40 * map.magnitude;
  std::vector<NodePair>& stack = memory.stack;
  stack.assign(1, {a.levels() - 1, 0, b.levels() - 1, 0});
  memory.mapped.clear(b.nodes.size() * node_width);
  while (!stack.empty()) {
    const NodePair pair = stack.back();
    stack.pop_back();
    if (pair.level_a == 0 && pair.level_b == 0) {
      if (!on_leaves(pair.a, pair.b)) return false;
      continue;
    }
    // Opens nodes; a leaf is reached through its parent, of which only that child is visited.
    const bool opens_a = pair.level_a > 0, opens_b = pair.level_b > 0;
    const std::uint32_t first_a = opens_a ? pair.a * node_width : pair.a / node_width * node_width;
    const std::uint32_t child_level_a = opens_a ? pair.level_a - 1 : 0, child_level_b = opens_b ? pair.level_b - 1 : 0;
    const BvhNode& node_a = a.nodes[a.level_begin[child_level_a + 1] + first_a / node_width];
    const unsigned lanes_a = opens_a ? 0xff : 1U << (pair.a % node_width);
    const FloatBox around_a = box_of(a, pair.level_a, pair.a);
    const std::uint32_t first_b = opens_b ? pair.b * node_width : pair.b;
    const std::uint32_t node_b = b.level_begin[child_level_b + 1] + first_b / node_width;
    for (std::uint32_t child_b = first_b; child_b < (opens_b ? first_b + node_width : first_b + 1); ++child_b) {
      const std::uint32_t lane_b = child_b % node_width;
      if (!(b.nodes[node_b].lo[0][lane_b] <= b.nodes[node_b].hi[0][lane_b])) break;  // the rest of the node is empty
      ++compared;
      const std::size_t index = std::size_t{node_b} * node_width + lane_b;
      const FloatBox& box = memory.mapped.has(index)
                                ? memory.mapped[index]
                                : memory.mapped.set(index, mapped_box(map, child_box(b.nodes[node_b], lane_b), margin));
      if (!overlaps(box, around_a)) continue;
      unsigned hits = overlapping_children(node_a, box) & lanes_a;
      for (; hits != 0; hits &= hits - 1) {
        const std::uint32_t child_a = first_a + static_cast<std::uint32_t>(std::countr_zero(hits));
        const NodePair children{child_level_a, child_a, child_level_b, child_b};
        if ((!is_same || child_a <= child_b) && !are_apart(children)) stack.push_back(children);
      }
    }
  }
  return true;
}

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
