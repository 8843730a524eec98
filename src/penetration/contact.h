// SPDX-License-Identifier: MIT
/// Whether triangles meet, decided exactly and without any perturbation: touching counts.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "penetration/box_pairs.h"
#include "penetration/placed_pair.h"

namespace meshbound {

using PairTriangle = std::array<PairVertex, 3>;

/// Whether two triangles that share no vertex have a point in common.
[[nodiscard]] bool triangles_meet(PlacedPair& pair, const PairTriangle& s, const PairTriangle& t);

/// Whether two triangles of a model (`pair` holds it on both sides, unmoved) have a point in common besides a vertex or
/// an edge that both have.
[[nodiscard]] bool triangles_cross(PlacedPair& pair, const Triangle& s, const Triangle& t);

inline bool boxes_meet(const Box& a, const Box& b) {
  // Without branches, which would be guessed wrong often.
  const auto overlap = [](double lo, double hi, double other_lo, double other_hi) {
    return static_cast<unsigned>(lo <= other_hi) & static_cast<unsigned>(other_lo <= hi);
  };
  return (overlap(a.lo.x, a.hi.x, b.lo.x, b.hi.x) & overlap(a.lo.y, a.hi.y, b.lo.y, b.hi.y) &
          overlap(a.lo.z, a.hi.z, b.lo.z, b.hi.z)) != 0;
}

/// Counts of what `visit_triangle_pairs` has tested.
struct PairCounters {
  std::uint64_t node_pairs = 0;
  std::uint64_t triangle_pairs = 0;
};

/// Calls `on_triangles(s, t)` for all pairs of a triangle of each side whose boxes overlap, until it returns false.
/// Returns whether it never did. Leaves out those below nodes of which `are_apart(pair)` is true. `is_same`: both sides
/// are one model at one place, and each pair of its triangles comes once.
template <class AreApart, class OnTriangles>
bool visit_triangle_pairs(PlacedPair& pair, bool is_same, const AreApart& are_apart, BoxPairMemory& memory,
                          PairCounters& counters, OnTriangles&& on_triangles) {
  const std::uint32_t side = pair.tree_side();
  const Bvh::Data &a = pair.model(side).tree.data(), &b = pair.model(1 - side).tree.data();
  const auto on_leaves = [&](std::uint32_t block_a, std::uint32_t block_b) {
    pair.count_step();
    const Box& around_b = pair.block_box(1 - side, block_b);
    if (!boxes_meet(pair.block_box(side, block_a), around_b)) return true;
    const std::uint32_t end_a = std::min((block_a + 1) * block_width, a.triangle_count()),
                        end_b = std::min((block_b + 1) * block_width, b.triangle_count());
    for (std::uint32_t i = block_a * block_width; i < end_a; ++i) {
      const std::uint32_t s = a.triangle_of_slot[i];
      const Box& box = pair.box(side, s);
      if (!boxes_meet(box, around_b)) continue;
      for (std::uint32_t j = block_b * block_width; j < end_b; ++j) {
        const std::uint32_t t = b.triangle_of_slot[j];
        if ((is_same && block_a == block_b && i >= j) || !boxes_meet(box, pair.box(1 - side, t))) continue;
        ++counters.triangle_pairs;
        if (!(side == 0 ? on_triangles(s, t) : on_triangles(t, s))) return false;
      }
    }
    return true;
  };
  return visit_box_pairs(a, b, pair.tree_mapping(), is_same, are_apart, memory, counters.node_pairs, on_leaves);
}

/// Calls `on_triangles(s, t)` for all pairs of a triangle of each of two models whose boxes overlap, until it returns
/// false. Returns whether it never did.
template <class OnTriangles>
bool visit_triangle_pairs(PlacedPair& pair, BoxPairMemory& memory, PairCounters& counters, OnTriangles&& on_triangles) {
  const auto none = [](const NodePair&) { return false; };
  return visit_triangle_pairs(pair, false, none, memory, counters, on_triangles);
}

}  // namespace meshbound
