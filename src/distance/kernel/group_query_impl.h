// SPDX-License-Identifier: MIT
/// `MeasureGroup`. Compiled once per instruction set (numeric/isa.h).
///
///     one query in three walks over the surface, from where the one before it ended; the blocks there: first limits
///     level by level: keep the children whose boxes are within the largest limit of the box around the group
///     in single precision, each triangle of their blocks against all queries at once: lower limits
///     in doubles, by vectors: the pairs of a triangle and a query that are not proven to be beyond the limit
///
/// Why an answer has the bits that `PointSearch` gives. Limits only fall; let U be that of a query at the end, and d
/// the least computed distance among its pairs. A triangle without a pair is further away than U: its box is, or single
/// precision proves it (geometry/float_triangles.h). Where U is at least d + `group_margin` primal, the distances to
/// such triangles are computed as above d, so the least (squared distance, slot) of the pairs is that of the mesh. And
/// for each such triangle `best_separation` proves what is asked for: as the offset in extended precision is among its
/// directions, it loses less than `group_margin` primal of a distance above U. So the lower bound is what is asked for,
/// or what `PointSearch` finds where the plane of a pair does not prove that. Where U is less, the query is asked by
/// itself.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>

#include "distance/kernel/level_walk.h"
#include "distance/kernel/point_query.h"
#include "distance/kernel/point_query_impl.h"
#include "geometry/float_triangles.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {

/// By how many times `PointRoundings::primal` the limit of a query exceeds its distance.
inline constexpr double group_margin = 4;

/// Numbers rounded to nearest.
inline Floats to_floats(const Doubles& low, const Doubles& high) {
#if defined(__AVX512F__)
  return _mm512_insertf32x8(_mm512_castps256_ps512(_mm512_cvtpd_ps(low)), _mm512_cvtpd_ps(high), 1);
#elif defined(__AVX2__)
  return _mm256_set_m128(_mm256_cvtpd_ps(high), _mm256_cvtpd_ps(low));
#else
  Floats all;
  for (std::size_t i = 0; i < doubles_width; ++i) {
    all[i] = static_cast<float>(low[i]);
    all[i + doubles_width] = static_cast<float>(high[i]);
  }
  return all;
#endif
}

class GroupSearch {
 public:
  GroupSearch(const Bvh::Data& data, std::span<const GroupQuery> queries)
      : data_(data), queries_(queries), all_queries_((1U << queries.size()) - 1), box_(box_of(queries)) {
    centre_ = 0.5 * (box_.lo + box_.hi);
    Vec<Floats> global;
    for (std::size_t i = 0; i < floats_width; ++i) {
      const Vec3& p = queries_[std::min(i, queries_.size() - 1)].point;
      const Vec3 around = p - centre_;
      local_.x[i] = static_cast<float>(around.x);
      local_.y[i] = static_cast<float>(around.y);
      local_.z[i] = static_cast<float>(around.z);
      global.x[i] = static_cast<float>(p.x);
      global.y[i] = static_cast<float>(p.y);
      global.z[i] = static_cast<float>(p.z);
    }
    const auto step = [](const Floats& x) { return maximum(x, -x) * 0x1p-23F + std::numeric_limits<float>::min(); };
    const Vec<Floats> steps{step(global.x), step(global.y), step(global.z)};
    lo_ = global - steps;
    hi_ = global + steps;
    error_ = magnitude(local_) * float_error + min_float_error;
  }

  /// As `MeasureGroup`.
  bool run(std::uint32_t hint, std::span<PointDistance> answers) {
    measure_start(hint);
    Level levels[2];
    const FloatQuery query(box_.lo, box_.hi);
    const Level* const blocks = members_within(data_, query, query.limit(square(largest_lane(limit_))), 0, levels);
    if (blocks == nullptr) return false;
    measure_near(*blocks);
    if (!collect_pairs()) return false;
    test_pairs();
    for (std::size_t i = 0; i < answers.size(); ++i) answers[i] = answer(i);
    return true;
  }

 private:
  /// Beyond these a group takes longer than its queries one by one. Beside a scan it has 9 pairs and 40 triangles.
  static constexpr std::uint32_t max_pairs = 16 * floats_width, max_triangles = 24 * floats_width;

  static constexpr std::uint32_t blocks_at_once = floats_width / block_width;
  using FloatSlots = std::array<std::uint32_t, floats_width>;

  /// One of so many queries walks over the surface: each step waits for the one before it.
  static constexpr std::size_t queries_per_start = 3;

  /// A triangle, seen from all queries.
  struct Measured {
    FloatOffset offset;
    std::uint32_t slot;
  };
  struct Pair {
    std::uint32_t slot, query;
  };
  /// What the pairs of a query say.
  struct Best {
    Nearest nearest{std::numeric_limits<double>::infinity(), no_slot};
    Vec3 offset;
    double separated_squared = std::numeric_limits<double>::infinity();
  };

  static double square(double x) { return x * x; }
  static Floats magnitude(const Vec<Floats>& v) {
    return maximum(maximum(v.x, -v.x), maximum(maximum(v.y, -v.y), maximum(v.z, -v.z)));
  }
  static Box box_of(std::span<const GroupQuery> queries) {
    Double4 lo = coordinates(queries[0].point), hi = lo;
    for (const GroupQuery& query : queries) {
      lo = minimum(lo, coordinates(query.point));
      hi = maximum(hi, coordinates(query.point));
    }
    return {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}};
  }

  /// First limits: by the blocks that a walk over the surface leads each query to.
  void measure_start(std::uint32_t slot) {
    Level blocks;
    if (slot == no_slot) slot = block_by_boxes(data_, FloatQuery(queries_[0].point)) * block_width;
    for (std::size_t i = 0; i < queries_.size(); i += queries_per_start) {
      slot = step_over(data_, queries_[i].point, slot);
      const std::uint32_t block = slot / block_width;
      const std::uint32_t is_new = is_measured(block) ? 0 : 1;
      start_[blocks.count] = static_cast<std::int32_t>(block);
      blocks.index[blocks.count] = block;
      blocks.count += is_new;
    }
    measure(blocks);
  }

  /// Whether a walk has led to the block.
  [[nodiscard]] bool is_measured(std::uint32_t block) const {
    return lane_bits(start_ == static_cast<std::int32_t>(block)) != 0;
  }

  /// Whether the box of a block is within the limit of any query (`prune_limit` says why limits are this much larger).
  [[nodiscard]] bool is_near(std::uint32_t block, const Floats& limit_squared) const {
    const BvhNode& node = data_.nodes[data_.level_begin[1] + block / node_width];
    const std::uint32_t child = block % node_width;
    const auto outside = [&](std::size_t axis, const Floats& lo, const Floats& hi) {
      return maximum(maximum(broadcast_floats(node.lo[axis][child]) - hi, lo - broadcast_floats(node.hi[axis][child])),
                     Floats{});
    };
    const Vec<Floats> apart{outside(0, lo_.x, hi_.x), outside(1, lo_.y, hi_.y), outside(2, lo_.z, hi_.z)};
    return less_bits(squared_length(apart), limit_squared) != 0;
  }

  /// Measures those of the blocks that are within the limit of any query.
  void measure_near(const Level& blocks) {
    const Floats limit_squared = limit_ * limit_ * (1 + 0x1p-19F) + std::numeric_limits<float>::min();
    Level near;
    for (std::uint32_t i = 0; i < blocks.count; ++i) {
      near.index[near.count] = blocks.index[i];
      // & instead of &&: a branch would be guessed wrong half the time.
      near.count += is_near(blocks.index[i], limit_squared) & !is_measured(blocks.index[i]) ? 1 : 0;
    }
    measure(near);
  }

  /// Measures blocks, as many at a time as fill the lanes.
  void measure(const Level& blocks) {
    FloatSlots slots;
    for (std::uint32_t i = 0; i < blocks.count; i += blocks_at_once) {
      for (std::uint32_t k = 0; k < blocks_at_once; ++k) {
        const auto block = slots_of_block(data_, blocks.index[std::min(i + k, blocks.count - 1)]);
        std::copy(block.begin(), block.end(), &slots[k * block_width]);
      }
      const std::uint32_t used = std::min(blocks.count - i, blocks_at_once) * block_width;
      measure_triangles(slots, (1U << used) - 1);
    }
  }

  /// Corner k of the triangles, from the centre.
  [[nodiscard]] Vec<Floats> corners(const FloatSlots& slots, std::size_t k) const {
    const Vec<Doubles> centre = broadcast_doubles(centre_);
    const auto at = [&](std::size_t i) -> const Vec3& { return data_.vertices[data_.corners[slots[i]][k]]; };
    const Vec<Doubles> low = gather(at) - centre,
                       high = gather([&](std::size_t i) -> const Vec3& { return at(i + doubles_width); }) - centre;
    return {to_floats(low.x, high.x), to_floats(low.y, high.y), to_floats(low.z, high.z)};
  }

  /// Measures the triangles whose boxes are within the limit of any query, and lowers the limits.
  void measure_triangles(const FloatSlots& slots, unsigned used) {
    const FloatTriangles triangles(corners(slots, 0), corners(slots, 1), corners(slots, 2));
    error_ = maximum(error_, broadcast_floats(largest_lane(triangles.magnitude())) * float_error);
    const Floats within = limit_ + error_, within_squared = within * within;
    unsigned near = 0;
    for (std::size_t i = 0; i < FloatTriangles::width; ++i)
      near |= (less_bits(triangles.box_squared(i, local_), within_squared) != 0 ? 1U : 0U) << i;
    for (near &= used; near != 0; near &= near - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(near));
      Measured& measured = measured_[measured_count_];
      measured.offset = triangles.offset(i, local_);
      measured.slot = slots[i];
      squared_ = minimum(squared_, measured.offset.squared);
      measured_count_ = std::min(measured_count_ + 1, max_triangles);
    }
    limit_ = minimum(limit_, square_root(squared_) + error_);
  }

  /// The pairs that single precision does not tell to be beyond the limit. False where there are too many.
  bool collect_pairs() {
    if (measured_count_ == max_triangles) return false;
    const Floats limit_and_error = limit_ + error_;
    // A third of the triangles have a pair: listed first without branches, which would be guessed wrong.
    std::array<std::uint32_t, max_triangles> triangles, near;
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < measured_count_; ++i) {
      triangles[count] = i;
      near[count] = ~measured_[i].offset.lanes_beyond(limit_and_error) & all_queries_;
      count += near[count] != 0 ? 1 : 0;
    }
    for (std::uint32_t i = 0; i < count; ++i) {
      for (unsigned queries = near[i]; queries != 0; queries &= queries - 1) {
        if (pair_count_ == max_pairs) return false;
        pairs_[pair_count_++] = {measured_[triangles[i]].slot, static_cast<std::uint32_t>(std::countr_zero(queries))};
      }
    }
    return true;
  }

  void test_pairs() {
    const std::uint32_t last = pair_count_ - 1;
    for (std::uint32_t i = 0; i < pair_count_; i += doubles_width) {
      std::array<Pair, doubles_width> together;
      Slots slots;
      for (std::uint32_t lane = 0; lane < doubles_width; ++lane) {
        together[lane] = pairs_[std::min(i + lane, last)];
        slots[lane] = together[lane].slot;
      }
      const CornerTriangle<Doubles> t = triangles_at(data_, slots);
      const Vec<Doubles> p =
          gather([&](std::size_t lane) -> const Vec3& { return queries_[together[lane].query].point; });
      const TriangleOffset<Doubles> to = closest_on_triangle(t, p);
      const Doubles separated = separation_squared(t, p, to);
      for (std::size_t lane = 0; lane < doubles_width; ++lane) {
        const auto& [slot, query] = together[lane];
        Best& best = best_[query];
        const double squared = to.squared_distance[lane];
        best.separated_squared = std::min(best.separated_squared, separated[lane]);
        if (squared < best.nearest.squared || (squared == best.nearest.squared && slot < best.nearest.slot)) {
          best.nearest = {squared, slot};
          best.offset = {to.offset.x[lane], to.offset.y[lane], to.offset.z[lane]};
        }
      }
    }
  }

  [[nodiscard]] PointDistance answer(std::size_t i) const {
    const Best& best = best_[i];
    const Vec3& point = queries_[i].point;
    const PointRoundings& roundings = queries_[i].roundings;
    const double distance = std::sqrt(best.nearest.squared), wanted = std::max(0.0, distance - roundings.allowed);
    if (!(distance + group_margin * roundings.primal <= double{limit_[i]}))
      return measure_point(data_, point, roundings, best.nearest.slot);
    if (wanted == 0 || best.separated_squared >= wanted * wanted) return {best.nearest, best.offset, wanted};
    const double separated = with_query(data_, point, [&](const auto& query) {
      return PointSearch(data_, point, query, roundings).separated_beyond(best.nearest.squared, wanted);
    });
    return {best.nearest, best.offset, separated};
  }

  const Bvh::Data& data_;
  std::span<const GroupQuery> queries_;
  unsigned all_queries_;
  Box box_;  ///< of the queries
  Vec3 centre_;
  Vec<Floats> local_;    ///< the queries, from the centre
  Vec<Floats> lo_, hi_;  ///< the queries in the working frame, as intervals
  Floats error_;         ///< `float_error` for the coordinates seen so far
  Floats squared_ = broadcast_floats(std::numeric_limits<float>::infinity());  ///< the least of those measured
  Floats limit_ =
      broadcast_floats(std::numeric_limits<float>::infinity());  ///< no triangle further away is of interest
  FloatsMask start_ = FloatsMask{} - 1;                          ///< the blocks that the walks led to
  std::uint32_t measured_count_ = 0, pair_count_ = 0;
  std::array<Measured, max_triangles + 1> measured_;
  std::array<Pair, max_pairs> pairs_;
  std::array<Best, floats_width> best_;
};

inline bool measure_group(const Bvh::Data& data, std::span<const GroupQuery> queries, std::uint32_t hint,
                          std::span<PointDistance> answers) {
  return GroupSearch(data, queries).run(hint, answers);
}

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
