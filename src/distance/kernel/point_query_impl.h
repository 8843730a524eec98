// SPDX-License-Identifier: MIT
/// `MeasurePoint`. Compiled once per instruction set (numeric/isa.h).
///
///     test the block of the hint: a first limit, which mostly is near its final value already
///     level by level: keep the children whose boxes are within the limit, in no order and without branches
///     test the nearest block, then the others within the new limit
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

/// Lane i of the result is lane lanes[i] of x.
inline Float8 permuted(const Float8& x, const Mask8& lanes) {
#if defined(__AVX2__)
  return _mm256_permutevar8x32_ps(x, reinterpret_cast<__m256i>(lanes));
#else
  Float8 result;
  for (std::size_t i = 0; i < node_width; ++i) result[i] = x[lanes[i]];
  return result;
#endif
}

class PointSearch {
 public:
  PointSearch(const Bvh::Data& data, const Vec3& p, const PointRoundings& roundings)
      : data_(data),
        p_(p),
        lanes_(broadcast4(p)),
        box_(p),
        roundings_(roundings),
        last_slot_(static_cast<std::int64_t>(data.triangle_count()) - 1) {}

  PointDistance run(std::uint32_t hint) {
    first_block_ = hint == no_slot ? block_by_boxes() : hint / block_width;
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

  void test_block(std::uint32_t block) {
    const CornerTriangle<Double4> t = triangles_of_block(data_, block);
    const TriangleOffset<Double4> to = closest_on_triangle(t, lanes_);
    separated_squared_ = minimum(separated_squared_, separation_squared(t, to));
    Mask4 slots = Mask4{0, 1, 2, 3} + std::int64_t{block} * block_width;
    slots = slots < last_slot_ ? slots : Mask4{} + last_slot_;
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

  /// Nodes or blocks of one level, with the squared distances of their boxes; room for a whole node behind them.
  struct Level {
    std::uint32_t count = 0;
    std::uint32_t index[capacity + node_width];
    float squared[capacity + node_width];
  };

  /// The children of the members of a level of nodes that are within the limit. False when there are too many.
  bool open(std::uint32_t level, const Level& from, Level& children) const {
    const BvhNode* const nodes = data_.nodes.data() + data_.level_begin[level];
    const Float8 limit = broadcast8(limit_);
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < from.count; ++i) {
      const Float8 squared = squared_box_distances(nodes[from.index[i]], box_);
      const unsigned hits = lane_bits(squared < limit);
      const Mask8 lanes = lanes_of(hits), index = lanes + static_cast<std::int32_t>(from.index[i] * node_width);
      const Float8 packed = permuted(squared, lanes);
      std::memcpy(&children.index[count], &index, sizeof index);
      std::memcpy(&children.squared[count], &packed, sizeof packed);
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
    return true;
  }

  void test_blocks(Level& blocks) {
    constexpr float tested = std::numeric_limits<float>::infinity();
    std::uint32_t nearest = 0;
    for (std::uint32_t i = 0; i < blocks.count; ++i) {
      if (blocks.index[i] == first_block_) blocks.squared[i] = tested;
      if (blocks.squared[i] < blocks.squared[nearest]) nearest = i;
    }
    if (blocks.count == 0 || !(blocks.squared[nearest] < limit_)) return;
    test_block(blocks.index[nearest]);
    update_limit();
    blocks.squared[nearest] = tested;
    for (std::uint32_t i = 0; i < blocks.count; ++i)
      if (blocks.squared[i] < limit_) test_block(blocks.index[i]);
    update_limit();
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
      for (unsigned fails = ~lane_bits(passes) & all_lanes; fails != 0; fails &= fails - 1) {
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
  Vec<Double4> lanes_;  ///< the query, in each lane
  FloatQuery box_;      ///< the query, as a box of floats
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
