// SPDX-License-Identifier: MIT
/// `MeasurePoint`. Compiled once per instruction set (numeric/isa.h).
///
///     walk over the surface from the hint, and test the block there: a first limit, mostly near its final value
///     level by level: keep the children whose boxes are within the limit, in no order and without branches
///     test the triangles of those blocks whose own boxes are within the limit too, about a third of them
///
/// Where a level would hold too many nodes, the hint was a bad one: it begins again at the block that the nearest boxes
/// lead to. Where that does not do either (far queries), the walk of bvh/nearest.h takes its place, whose limit falls
/// with each block.
///
/// The answer does not depend on the hint or the order. Limits are above the least computed distance d by `primal`, so
/// a triangle whose computed distance is at most d, and whose box therefore is within d + `primal_error`, is met in any
/// case: the answer is the least (squared distance, slot) of all triangles of the mesh.
///
/// The lower bound. Let L = d - allowed. A triangle that was not met lies in a box beyond d. One that was met is at
/// least as far as the plane across its own offset o separates it from p: m / |o| with m the least o . (p - c) over its
/// corners c. L holds where m > 0 and m^2 / o.o >= L^2 for each of them, for which the least quotient is kept. The
/// roundings are those of `separation` (7uM of p - c, 11uM of the product), and instead of those of norm and quotient
/// six of squares, sum, product and quotient, 3u of at most 2 sqrt(3) M in the root (11uM): less than `dual_error`. L^2
/// cannot underflow, as L > 0 is a difference of doubles above 2^-53.
///
/// Where that fails (needles, points next to the surface), a second walk over the boxes within the final limit asks
/// `best_separation` of each triangle there that fails. It meets the same triangles in the same way whatever the hint
/// was, and the first walk met all of them: that it was needed, or what it says, does not depend on the hint either.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "distance/kernel/point_query.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {

/// By a word of bits: the lanes whose bits are set, in order; 0 behind them.
inline constexpr auto packed_lanes = [] {
  std::array<std::array<std::uint8_t, node_width>, 1U << node_width> table{};
  for (unsigned bits = 0; bits < table.size(); ++bits) {
    std::size_t count = 0;
    for (std::uint8_t lane = 0; lane < node_width; ++lane)
      if ((bits >> lane & 1U) != 0) table[bits][count++] = lane;
  }
  return table;
}();

inline Mask8 lanes_of(unsigned bits) {
  const auto& packed = packed_lanes[bits];
#if defined(__AVX2__)
  return reinterpret_cast<Mask8>(
      _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(packed.data()))));
#else
  Mask8 lanes;
  for (std::size_t i = 0; i < node_width; ++i) lanes[i] = packed[i];
  return lanes;
#endif
}

/// Lane i of the result is the sum of the lanes of d[i], whose last one is 0.
inline Double4 sums_of_lanes(const std::array<Double4, 4>& d) {
#if defined(__AVX2__)
  const __m256d low = _mm256_hadd_pd(d[0], d[1]), high = _mm256_hadd_pd(d[2], d[3]);
  return _mm256_add_pd(_mm256_permute2f128_pd(low, high, 0x21), _mm256_blend_pd(low, high, 0b1100));
#else
  Double4 sums;
  for (std::size_t i = 0; i < 4; ++i) sums[i] = (d[i][0] + d[i][1]) + d[i][2];
  return sums;
#endif
}

/// The squared distances from p (`coordinates`) to the boxes of the four triangles of a block, but for a relative error
/// of 8 roundings of doubles. Costs a fraction of the distances to the triangles: it has no divisions, and the corners
/// need not be put lane by lane.
inline Double4 squared_triangle_box_distances(const Bvh::Data& data, std::uint32_t block, const Double4& p) {
  const std::array<std::uint32_t, block_width> slots = slots_of_block(data, block);
  std::array<Double4, block_width> squared;
  for (std::size_t i = 0; i < block_width; ++i) {
    const Triangle& t = data.corners[slots[i]];
    const Double4 a = coordinates(data.vertices[t[0]]), b = coordinates(data.vertices[t[1]]),
                  c = coordinates(data.vertices[t[2]]);
    const Double4 lo = minimum(a, minimum(b, c)), hi = maximum(a, maximum(b, c));
    const Double4 apart = maximum(maximum(lo - p, p - hi), Double4{});
    squared[i] = apart * apart;
  }
  return sums_of_lanes(squared);
}

class PointSearch {
 public:
  PointSearch(const Bvh::Data& data, const Vec3& p, const PointRoundings& roundings)
      : data_(data),
        p_(p),
        coordinates_(coordinates(p)),
        lanes_(broadcast4(p)),
        box_(p),
        roundings_(roundings),
        last_slot_(static_cast<std::int64_t>(data.triangle_count()) - 1) {}

  PointDistance run(std::uint32_t hint) {
    first_block_ = hint == no_slot ? block_by_boxes() : step_over(data_, p_, hint) / block_width;
    test_block(first_block_);
    update_limit();
    if (!walk_by_levels()) {
      test_block(block_by_boxes());
      update_limit();
      if (!walk_by_levels()) walk_near();
    }
    PointDistance found;
    const int lane = best_lane();
    found.nearest = {best_.squared_distance[lane], static_cast<std::uint32_t>(slots_[lane])};
    found.offset = {best_.offset.x[lane], best_.offset.y[lane], best_.offset.z[lane]};
    const double wanted = std::max(0.0, std::sqrt(found.nearest.squared) - roundings_.allowed);
    const Mask4 is_separated = separated_squared_ >= broadcast4(wanted * wanted);
    const bool separated = lane_bits(is_separated) == all_lanes;
    found.separated = wanted > 0 && !separated ? separated_within_limit(wanted) : wanted;
    return found;
  }

 private:
  static constexpr unsigned all_lanes = 15;
  static constexpr std::uint32_t capacity = 64;  ///< nodes or blocks of a level; a warm start leaves five of them

  /// The block that one reaches by taking the nearest box of each node, from the root down.
  [[nodiscard]] std::uint32_t block_by_boxes() const {
    std::uint32_t index = 0;
    for (std::uint32_t level = data_.levels() - 1; level > 0; --level) {
      const Float8 squared = squared_box_distances(data_.nodes[data_.level_begin[level] + index], box_);
      std::uint32_t nearest = 0;
      for (std::uint32_t lane = 1; lane < node_width; ++lane)
        if (squared[lane] < squared[nearest]) nearest = lane;
      index = index * node_width + nearest;
    }
    return std::min(index, data_.block_count() - 1);
  }

  void update_limit() {
    const Double4& s = best_.squared_distance;
    const double reach = std::sqrt(std::min(std::min(s[0], s[1]), std::min(s[2], s[3]))) + roundings_.primal;
    limit_ = prune_limit(reach * reach);
  }

  /// The quotient m^2 / o.o of the file's comment, 0 where m is not positive.
  [[nodiscard]] Double4 separation_squared(const CornerTriangle<Double4>& t, const TriangleOffset<Double4>& to) const {
    const Vec<Double4> ap = lanes_ - t.a;
    const Double4 along = minimum(dot(to.offset, ap), minimum(dot(to.offset, ap - t.ab), dot(to.offset, ap - t.ac)));
    return select(along > 0.0, along * along / to.squared_distance, Double4{});
  }

  void test_block(std::uint32_t block) { test(slots_of_block(data_, block)); }

  void test(const std::array<std::uint32_t, block_width>& triangles) {
    const CornerTriangle<Double4> t = triangles_at(data_, triangles);
    const TriangleOffset<Double4> to = closest_on_triangle(t, lanes_);
    separated_squared_ = minimum(separated_squared_, separation_squared(t, to));
    const Mask4 slots{triangles[0], triangles[1], triangles[2], triangles[3]};
    const Mask4 nearer = (to.squared_distance < best_.squared_distance) |
                         ((to.squared_distance == best_.squared_distance) & (slots < slots_));
    best_.squared_distance = select(nearer, to.squared_distance, best_.squared_distance);
    best_.offset.x = select(nearer, to.offset.x, best_.offset.x);
    best_.offset.y = select(nearer, to.offset.y, best_.offset.y);
    best_.offset.z = select(nearer, to.offset.z, best_.offset.z);
    slots_ = nearer ? slots : slots_;
  }

  [[nodiscard]] int best_lane() const {
    int best = 0;
    for (int lane = 1; lane < static_cast<int>(block_width); ++lane) {
      const double least = best_.squared_distance[best], squared = best_.squared_distance[lane];
      if (squared < least || (squared == least && slots_[lane] < slots_[best])) best = lane;
    }
    return best;
  }

  /// Nodes or blocks of one level; room for a whole node behind them.
  struct Level {
    std::uint32_t count = 0;
    std::uint32_t index[capacity + node_width];
  };

  /// The children of the members of a level of nodes that are within the limit. False when there are too many.
  bool open(std::uint32_t level, const Level& from, Level& children) const {
    const BvhNode* const nodes = data_.nodes.data() + data_.level_begin[level];
    const Float8 limit = broadcast8(limit_);
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < from.count; ++i) {
      const unsigned hits = lane_bits(squared_box_distances(nodes[from.index[i]], box_) < limit);
      const Mask8 index = lanes_of(hits) + static_cast<std::int32_t>(from.index[i] * node_width);
      std::memcpy(&children.index[count], &index, sizeof index);
      count += static_cast<std::uint32_t>(std::popcount(hits));
      if (count > capacity) return false;
    }
    children.count = count;
    return true;
  }

  bool walk_by_levels() {
    Level levels[2];
    levels[0].count = 1;
    levels[0].index[0] = 0;
    std::uint32_t now = 0;
    for (std::uint32_t level = data_.levels() - 1; level > 0; --level, now = 1 - now)
      if (!open(level, levels[now], levels[1 - now])) return false;
    test_blocks(levels[now]);
    update_limit();
    return true;
  }

  /// The lanes of a block whose triangles have boxes within the limit.
  [[nodiscard]] unsigned lanes_within_limit(std::uint32_t block) const {
    return lane_bits(squared_triangle_box_distances(data_, block, coordinates_) < broadcast4(double{limit_}));
  }

  /// Tests the triangles whose boxes are within the limit, four at a time whatever their blocks.
  void test_blocks(const Level& blocks) {
    std::uint32_t slots[capacity * block_width + node_width];
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < blocks.count; ++i) {
      const unsigned hits = lanes_within_limit(blocks.index[i]);
      const Mask8 slot = lanes_of(hits) + static_cast<std::int32_t>(blocks.index[i] * block_width);
      std::memcpy(&slots[count], &slot, sizeof slot);
      if (blocks.index[i] != first_block_) count += static_cast<std::uint32_t>(std::popcount(hits));
    }
    const std::uint32_t last = count - 1, last_slot = data_.triangle_count() - 1;
    const auto slot = [&](std::uint32_t i) { return std::min(slots[std::min(i, last)], last_slot); };
    for (std::uint32_t i = 0; i < count; i += block_width) test({slot(i), slot(i + 1), slot(i + 2), slot(i + 3)});
  }

  void walk_near() {
    QueryCounters counters;
    visit_near(data_, box_, limit_, counters, [&](std::uint32_t block) {
      test_block(block);
      update_limit();
      return limit_;
    });
  }

  /// The lower bound that the triangles in the boxes within the limit prove, at most `wanted`.
  double separated_within_limit(double wanted) const {
    QueryCounters counters;
    double least = wanted;
    visit_near(data_, box_, limit_, counters, [&](std::uint32_t block) {
      const CornerTriangle<Double4> t = triangles_of_block(data_, block);
      const Double4 squared = separation_squared(t, closest_on_triangle(t, lanes_));
      const Mask4 passes = squared >= broadcast4(wanted * wanted);
      for (unsigned fails = ~lane_bits(passes) & lanes_within_limit(block); fails != 0; fails &= fails - 1) {
        const std::int64_t slot = std::int64_t{block} * block_width + std::countr_zero(fails);
        const auto triangle = triangle_at(data_, static_cast<std::uint32_t>(std::min(slot, last_slot_)));
        least = std::min(least, best_separation(triangle, p_, wanted));
      }
      return limit_;
    });
    return least;
  }

  const Bvh::Data& data_;
  Vec3 p_;
  Double4 coordinates_;  ///< of the query
  Vec<Double4> lanes_;   ///< the query, in each lane
  FloatQuery box_;       ///< the query, as a box of floats
  PointRoundings roundings_;
  std::int64_t last_slot_;
  std::uint32_t first_block_ = 0;
  float limit_ = 0;  ///< squared
  // In each lane, the best of that lane's triangles in all blocks tested.
  TriangleOffset<Double4> best_{{}, broadcast4(std::numeric_limits<double>::infinity())};
  Mask4 slots_{};
  Double4 separated_squared_ = broadcast4(std::numeric_limits<double>::infinity());
};

inline PointDistance measure_point(const Bvh::Data& data, const Vec3& p, const PointRoundings& roundings,
                                   std::uint32_t hint) {
  return PointSearch(data, p, roundings).run(hint);
}

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
