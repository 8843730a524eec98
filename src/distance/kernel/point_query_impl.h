// SPDX-License-Identifier: MIT
/// `MeasurePoint`. Compiled once per instruction set (numeric/isa.h).
///
///     walk over the surface from the hint; the distance to a corner of the triangle there is a first reach
///     level by level: keep the children whose boxes are within reach, in no order and without branches
///     meanwhile, test the triangles there: before the blocks are reached, the reach is mostly near its final value
///     test the triangles of those blocks whose own boxes are within reach too, about a third of them
///
/// Where a level would hold too many nodes, the hint was a bad one: it begins again at the block that the nearest boxes
/// lead to. Where that does not do either (far queries), the walk of bvh/nearest.h takes its place, whose reach falls
/// with each block.
///
/// The answer does not depend on the hint or the order. Reach is above the least computed distance d by `primal`, so
/// a triangle whose computed distance is at most d, and whose box therefore is within d + `primal_error`, is met in any
/// case: the answer is the least (squared distance, slot) of all triangles of the mesh. That of a corner, which is not
/// a computed distance of a triangle, is used only where it is no less than the reach that follows it.
///
/// The lower bound. Let L = d - allowed. A triangle that was not met lies in a box beyond d. One that was met is at
/// least as far as the plane across its own offset o separates it from p: m / |o| with m the least o . (p - c) over its
/// corners c. L holds where m > 0 and m^2 / o.o >= L^2 for each of them, for which the least quotient is kept. The
/// roundings are those of `separation` (7uM of p - c, 11uM of the product), and instead of those of norm and quotient
/// six of squares, sum, product and quotient, 3u of at most 2 sqrt(3) M in the root (11uM): less than `dual_error`. L^2
/// cannot underflow, as L > 0 is a difference of doubles above 2^-53.
///
/// Where that fails (needles, points next to the surface), a second walk over the boxes within the final reach asks
/// `best_separation` of each triangle there that fails. It meets the same triangles in the same way whatever the hint
/// was, and the first walk met all of them: that it was needed, or what it says, does not depend on the hint either.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "distance/kernel/level_walk.h"
#include "distance/kernel/point_query.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {

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

/// The quotient m^2 / o.o of the file's comment, 0 where m is not positive.
template <class Lanes>
[[gnu::always_inline]] inline Lanes separation_squared(const CornerTriangle<Lanes>& t, const Vec<Lanes>& p,
                                                       const TriangleOffset<Lanes>& to) {
  const Vec<Lanes> ap = p - t.a;
  const Lanes along = minimum(dot(to.offset, ap), minimum(dot(to.offset, ap - t.ab), dot(to.offset, ap - t.ac)));
  return select(along > 0.0, along * along / to.squared_distance, Lanes{});
}

/// Triangles that are tested together.
using Slots = std::array<std::uint32_t, doubles_width>;

inline DoublesMask lanes_of(const Slots& slots) {
  std::uint32_t words __attribute__((vector_size(sizeof slots)));
  std::memcpy(&words, slots.data(), sizeof words);
  return __builtin_convertvector(words, DoublesMask);
}

inline Vec<Doubles> broadcast_doubles(const Vec3& v) {
  return {broadcast_doubles(v.x), broadcast_doubles(v.y), broadcast_doubles(v.z)};
}

/// `Query`: as `with_query` gives.
template <class Query>
class PointSearch {
 public:
  PointSearch(const Bvh::Data& data, const Vec3& p, const Query& query, const PointRoundings& roundings)
      : data_(data),
        p_(p),
        coordinates_(coordinates(p)),
        lanes_(broadcast_doubles(p)),
        query_(query),
        roundings_(roundings),
        last_slot_(data.triangle_count() - 1) {}

  PointDistance run(std::uint32_t hint) {
    if (!walk_from(hint == no_slot ? block_by_boxes(data_, query_) * block_width : step_over(data_, p_, hint)) &&
        !walk_from(block_by_boxes(data_, query_) * block_width))
      walk_near();
    PointDistance found;
    const int lane = best_lane();
    found.nearest = {best_.squared_distance[lane], static_cast<std::uint32_t>(slots_[lane])};
    found.offset = {best_.offset.x[lane], best_.offset.y[lane], best_.offset.z[lane]};
    const double wanted = std::max(0.0, std::sqrt(found.nearest.squared) - roundings_.allowed);
    const bool separated = smallest_lane(separated_squared_) >= wanted * wanted;
    found.separated = wanted > 0 && !separated ? separated_beyond(found.nearest.squared, wanted) : wanted;
    return found;
  }

  /// The lower bound that `run` proves where it is not `wanted` at once: given the least squared distance.
  double separated_beyond(double nearest_squared, double wanted) {
    reach_squared_ = reach_squared(nearest_squared);
    return separated_within_reach(wanted);
  }

 private:
  /// More than the roundings of the squared distance to a corner, which a measured triangle shall not exceed.
  static constexpr double corner_margin = 1 + 0x1p-20;
  /// More than the roundings of `squared_triangle_box_distances` and of a square.
  static constexpr double box_margin = 1 + 0x1p-48;

  void update_reach() { reach_squared_ = reach_squared(smallest_lane(best_.squared_distance)); }

  [[nodiscard]] double reach_squared(double squared) const {
    const double reach = std::sqrt(squared) + roundings_.primal;
    return reach * reach;
  }

  /// Tests a triangle and its neighbours in memory.
  void test_first(std::uint32_t slot) {
    first_ = slot / std::uint32_t{doubles_width};
    Slots slots;
    for (std::size_t i = 0; i < doubles_width; ++i)
      slots[i] = std::min(static_cast<std::uint32_t>(first_ * doubles_width + i), last_slot_);
    test(slots);
  }

  [[gnu::always_inline]] void test(const Slots& triangles) {
    const CornerTriangle<Doubles> t = triangles_at(data_, triangles);
    const TriangleOffset<Doubles> to = closest_on_triangle(t, lanes_);
    separated_squared_ = minimum(separated_squared_, separation_squared(t, lanes_, to));
    const DoublesMask slots = lanes_of(triangles);
    const DoublesMask nearer = (to.squared_distance < best_.squared_distance) |
                               ((to.squared_distance == best_.squared_distance) & (slots < slots_));
    best_.squared_distance = select(nearer, to.squared_distance, best_.squared_distance);
    best_.offset.x = select(nearer, to.offset.x, best_.offset.x);
    best_.offset.y = select(nearer, to.offset.y, best_.offset.y);
    best_.offset.z = select(nearer, to.offset.z, best_.offset.z);
    slots_ = nearer ? slots : slots_;
  }

  [[nodiscard]] int best_lane() const {
    unsigned ties = lane_bits(best_.squared_distance == broadcast_doubles(smallest_lane(best_.squared_distance)));
    int best = std::countr_zero(ties);
    for (ties &= ties - 1; ties != 0; ties &= ties - 1)
      if (const int lane = std::countr_zero(ties); slots_[lane] < slots_[best]) best = lane;
    return best;
  }

  /// Starts at a triangle. False where a level has too many members, or where the triangle comes out farther away than
  /// its corner.
  bool walk_from(std::uint32_t slot) {
    const Vec3& corner = data_.vertices[data_.corners[slot][0]];
    const double first_reach = reach_squared(corner_margin * squared_length(p_ - corner));
    Level levels[2];
    Level* members = members_within(data_, query_, query_.limit(first_reach), 1, levels);
    test_first(slot);
    update_reach();
    if (members == nullptr || reach_squared_ > first_reach) return false;
    if (data_.levels() > 1) {
      Level& blocks = levels[members == &levels[0] ? 1 : 0];
      if (!open_level(data_, query_, query_.limit(reach_squared_), 1, *members, blocks)) return false;
      members = &blocks;
    }
    test_blocks(*members);
    return true;
  }

  /// The lanes of a block whose triangles have boxes within reach.
  [[nodiscard]] unsigned lanes_within_reach(std::uint32_t block) const {
    const Double4 squared = squared_triangle_box_distances(data_, block, coordinates_);
    return lane_bits(squared <= broadcast4(reach_squared_ * box_margin));
  }

  /// Tests the triangles whose boxes are within reach, as many at a time as fill the lanes, whatever their blocks.
  void test_blocks(const Level& blocks) {
    std::array<std::uint32_t, Level::capacity * block_width + node_width> slots;
    const Mask8 last = Mask8{} + static_cast<std::int32_t>(last_slot_);
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < blocks.count; ++i) {
      const unsigned hits = lanes_within_reach(blocks.index[i]);
      Mask8 slot = lanes_of(hits) + static_cast<std::int32_t>(blocks.index[i] * block_width);
      slot = slot < last ? slot : last;
      std::memcpy(&slots[count], &slot, sizeof slot);
      if (blocks.index[i] * block_width / doubles_width != first_)
        count += static_cast<std::uint32_t>(std::popcount(hits));
    }
    if (count == 0) return;
    std::fill_n(&slots[count], doubles_width, slots[count - 1]);
    for (std::uint32_t i = 0; i < count; i += doubles_width) {
      Slots together;
      std::memcpy(together.data(), &slots[i], sizeof together);
      test(together);
    }
  }

  void walk_near() {
    QueryCounters counters;
    visit_near(data_, query_, reach_squared_, counters, [&](std::uint32_t block) {
      if (block * block_width / std::uint32_t{doubles_width} != first_) {  // else tested with a block before
        test_first(block * block_width);
        update_reach();
      }
      return reach_squared_;
    });
  }

  /// The lower bound that the triangles in the boxes within reach prove, at most `wanted`.
  double separated_within_reach(double wanted) const {
    QueryCounters counters;
    double least = wanted;
    const Vec<Double4> p = broadcast4(p_);
    visit_near(data_, query_, reach_squared_, counters, [&](std::uint32_t block) {
      const CornerTriangle<Double4> t = triangles_of_block(data_, block);
      const Double4 squared = separation_squared(t, p, closest_on_triangle(t, p));
      const Mask4 passes = squared >= broadcast4(wanted * wanted);
      for (unsigned fails = ~lane_bits(passes) & lanes_within_reach(block); fails != 0; fails &= fails - 1) {
        const std::uint32_t slot = block * block_width + static_cast<std::uint32_t>(std::countr_zero(fails));
        const auto triangle = triangle_at(data_, std::min(slot, last_slot_));
        least = std::min(least, best_separation(triangle, p_, wanted));
      }
      return reach_squared_;
    });
    return least;
  }

  const Bvh::Data& data_;
  Vec3 p_;
  Double4 coordinates_;  ///< of the query
  Vec<Doubles> lanes_;   ///< the query, in each lane
  Query query_;          ///< for boxes of nodes
  PointRoundings roundings_;
  std::uint32_t last_slot_;
  std::uint32_t first_ = 0;   ///< which of the runs of `doubles_width` slots `test_first` tested
  double reach_squared_ = 0;  ///< triangles beyond it are of no interest
  // In each lane, the best of that lane's triangles in all blocks tested.
  TriangleOffset<Doubles> best_{{}, broadcast_doubles(std::numeric_limits<double>::infinity())};
  DoublesMask slots_{};
  Doubles separated_squared_ = broadcast_doubles(std::numeric_limits<double>::infinity());
};

inline PointDistance measure_point(const Bvh::Data& data, const Vec3& p, const PointRoundings& roundings,
                                   std::uint32_t hint) {
  return with_query(data, p, [&](const auto& query) { return PointSearch(data, p, query, roundings).run(hint); });
}

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
