// SPDX-License-Identifier: MIT
/// `MeasureGroup`. Compiled once per instruction set (numeric/isa.h).
///
///     each query walks over the surface, from where the one before it ended; the blocks there give first limits
///     level by level: keep the children whose boxes are within the largest limit of the box around the group
///     in single precision, each triangle of their blocks against all queries at once: lower limits
///     in doubles, four at a time: the pairs of a triangle and a query that are not proven to be beyond the limit
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

/// Eight numbers rounded to nearest.
inline Float8 to_float(const Double4& low, const Double4& high) {
#if defined(__AVX2__)
  return _mm256_set_m128(_mm256_cvtpd_ps(high), _mm256_cvtpd_ps(low));
#else
  Float8 all;
  for (int i = 0; i < 4; ++i) {
    all[i] = static_cast<float>(low[i]);
    all[i + 4] = static_cast<float>(high[i]);
  }
  return all;
#endif
}

class GroupSearch {
 public:
  GroupSearch(const Bvh::Data& data, std::span<const GroupQuery> queries)
      : data_(data), queries_(queries), all_queries_((1U << queries.size()) - 1), box_(box_of(queries)) {
    centre_ = 0.5 * (box_.lo + box_.hi);
    Vec<Float8> global;
    for (std::size_t i = 0; i < group_width; ++i) {
      const Vec3& p = queries_[std::min(i, queries_.size() - 1)].point;
      const Vec3 around = p - centre_;
      local_.x[i] = static_cast<float>(around.x);
      local_.y[i] = static_cast<float>(around.y);
      local_.z[i] = static_cast<float>(around.z);
      global.x[i] = static_cast<float>(p.x);
      global.y[i] = static_cast<float>(p.y);
      global.z[i] = static_cast<float>(p.z);
    }
    const auto step = [](const Float8& x) { return maximum(x, -x) * 0x1p-23F + std::numeric_limits<float>::min(); };
    const Vec<Float8> steps{step(global.x), step(global.y), step(global.z)};
    lo_ = global - steps;
    hi_ = global + steps;
    error_ = magnitude(local_) * float_error + min_float_error;
  }

  /// As `MeasureGroup`.
  bool run(std::uint32_t hint, std::span<PointDistance> answers) {
    measure_start(hint);
    Level levels[2];
    const float limit = prune_limit(square(largest(limit_)));
    const Level* const blocks = blocks_within(data_, FloatQuery(box_.lo, box_.hi), limit, levels);
    if (blocks == nullptr) return false;
    measure_near(*blocks);
    if (!collect_pairs()) return false;
    test_pairs();
    for (std::size_t i = 0; i < answers.size(); ++i) answers[i] = answer(i);
    return true;
  }

 private:
  /// Beyond these a group takes longer than its queries one by one. Beside a scan it has 9 pairs and 40 triangles.
  static constexpr std::uint32_t max_pairs = 16 * group_width, max_triangles = 192;

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
  static float largest(const Float8& x) {
    float most = x[0];
    for (int i = 1; i < 8; ++i) most = std::max(most, x[i]);
    return most;
  }
  static Float8 magnitude(const Vec<Float8>& v) {
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
    for (const GroupQuery& query : queries_) {
      slot = step_over(data_, query.point, slot);
      const std::uint32_t block = slot / block_width;
      const std::uint32_t is_new = is_measured(block) ? 0 : 1;
      start_[blocks.count] = static_cast<std::int32_t>(block);
      blocks.index[blocks.count] = block;
      blocks.count += is_new;
    }
    measure(blocks);
  }

  [[nodiscard]] bool is_measured(std::uint32_t block) const {
    return lane_bits(start_ == static_cast<std::int32_t>(block)) != 0;
  }

  /// Whether the box of a block is within the limit of any query (`prune_limit` says why limits are this much larger).
  [[nodiscard]] bool is_near(std::uint32_t block, const Float8& limit_squared) const {
    const BvhNode& node = data_.nodes[data_.level_begin[1] + block / node_width];
    const std::uint32_t child = block % node_width;
    const auto outside = [&](std::size_t axis, const Float8& lo, const Float8& hi) {
      return maximum(maximum(broadcast8(node.lo[axis][child]) - hi, lo - broadcast8(node.hi[axis][child])), Float8{});
    };
    const Vec<Float8> apart{outside(0, lo_.x, hi_.x), outside(1, lo_.y, hi_.y), outside(2, lo_.z, hi_.z)};
    return lane_bits(squared_length(apart) < limit_squared) != 0;
  }

  /// Measures those of the blocks that are within the limit of any query.
  void measure_near(const Level& blocks) {
    const Float8 limit_squared = limit_ * limit_ * (1 + 0x1p-19F) + std::numeric_limits<float>::min();
    Level near;
    for (std::uint32_t i = 0; i < blocks.count; ++i) {
      near.index[near.count] = blocks.index[i];
      near.count += is_near(blocks.index[i], limit_squared) && !is_measured(blocks.index[i]) ? 1 : 0;
    }
    measure(near);
  }

  /// Measures blocks, two at a time.
  void measure(const Level& blocks) {
    std::uint32_t i = 0;
    for (; i + 1 < blocks.count; i += 2) measure_blocks(blocks.index[i], blocks.index[i + 1], 0xff);
    if (i < blocks.count) measure_blocks(blocks.index[i], blocks.index[i], 0x0f);
  }

  /// Corner k of the triangles of two blocks, from the centre.
  [[nodiscard]] Vec<Float8> corners(const std::array<std::uint32_t, block_width>& s,
                                    const std::array<std::uint32_t, block_width>& t, std::size_t k) const {
    const Vec<Double4> centre = broadcast4(centre_);
    const auto at = [&](std::uint32_t slot) -> const Vec3& { return data_.vertices[data_.corners[slot][k]]; };
    const Vec<Double4> low = gather4(at(s[0]), at(s[1]), at(s[2]), at(s[3])) - centre,
                       high = gather4(at(t[0]), at(t[1]), at(t[2]), at(t[3])) - centre;
    return {to_float(low.x, high.x), to_float(low.y, high.y), to_float(low.z, high.z)};
  }

  /// Measures the triangles of two blocks whose boxes are within the limit of any query, and lowers the limits.
  void measure_blocks(std::uint32_t first, std::uint32_t second, unsigned used) {
    const auto s = slots_of_block(data_, first), t = slots_of_block(data_, second);
    const FloatTriangles triangles(corners(s, t, 0), corners(s, t, 1), corners(s, t, 2));
    error_ = maximum(error_, broadcast8(largest(triangles.magnitude())) * float_error);
    const Float8 within = limit_ + error_, within_squared = within * within;
    unsigned near = 0;
    for (std::size_t i = 0; i < FloatTriangles::width; ++i)
      near |= (lane_bits(triangles.box_squared(i, local_) < within_squared) != 0 ? 1U : 0U) << i;
    for (near &= used; near != 0; near &= near - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(near));
      Measured& measured = measured_[measured_count_];
      measured.offset = triangles.offset(i, local_);
      measured.slot = i < block_width ? s[i] : t[i - block_width];
      squared_ = minimum(squared_, measured.offset.squared);
      measured_count_ = std::min(measured_count_ + 1, max_triangles);
    }
    limit_ = minimum(limit_, square_root(squared_) + error_);
  }

  /// The pairs that single precision does not tell to be beyond the limit. False where there are too many.
  bool collect_pairs() {
    if (measured_count_ == max_triangles) return false;
    const Float8 limit_and_error = limit_ + error_;
    for (std::uint32_t i = 0; i < measured_count_; ++i) {
      const Measured& measured = measured_[i];
      for (unsigned near = ~lane_bits(measured.offset.is_beyond(limit_and_error)) & all_queries_; near != 0;
           near &= near - 1) {
        if (pair_count_ == max_pairs) return false;
        pairs_[pair_count_++] = {measured.slot, static_cast<std::uint32_t>(std::countr_zero(near))};
      }
    }
    return true;
  }

  void test_pairs() {
    const std::uint32_t last = pair_count_ - 1;
    for (std::uint32_t i = 0; i < pair_count_; i += block_width) {
      const Pair &a = pairs_[i], &b = pairs_[std::min(i + 1, last)], &c = pairs_[std::min(i + 2, last)],
                 &d = pairs_[std::min(i + 3, last)];
      const CornerTriangle<Double4> t = triangles_at(data_, {a.slot, b.slot, c.slot, d.slot});
      const Vec<Double4> p =
          gather4(queries_[a.query].point, queries_[b.query].point, queries_[c.query].point, queries_[d.query].point);
      const TriangleOffset<Double4> to = closest_on_triangle(t, p);
      const Double4 separated = separation_squared(t, p, to);
      int lane = 0;
      for (const Pair* const pair : {&a, &b, &c, &d}) {
        Best& best = best_[pair->query];
        const double squared = to.squared_distance[lane];
        best.separated_squared = std::min(best.separated_squared, separated[lane]);
        if (squared < best.nearest.squared || (squared == best.nearest.squared && pair->slot < best.nearest.slot)) {
          best.nearest = {squared, pair->slot};
          best.offset = {to.offset.x[lane], to.offset.y[lane], to.offset.z[lane]};
        }
        ++lane;
      }
    }
  }

  [[nodiscard]] PointDistance answer(std::size_t i) const {
    const Best& best = best_[i];
    const auto& [point, roundings] = queries_[i];
    const double distance = std::sqrt(best.nearest.squared), wanted = std::max(0.0, distance - roundings.allowed);
    if (!(distance + group_margin * roundings.primal <= double{limit_[i]}))
      return measure_point(data_, point, roundings, best.nearest.slot);
    const bool separated = wanted == 0 || best.separated_squared >= wanted * wanted;
    return {best.nearest, best.offset,
            separated ? wanted : PointSearch(data_, point, roundings).separated_beyond(best.nearest.squared, wanted)};
  }

  const Bvh::Data& data_;
  std::span<const GroupQuery> queries_;
  unsigned all_queries_;
  Box box_;  ///< of the queries
  Vec3 centre_;
  Vec<Float8> local_;    ///< the queries, from the centre
  Vec<Float8> lo_, hi_;  ///< the queries in the working frame, as intervals
  Float8 error_;         ///< `float_error` for the coordinates seen so far
  Float8 squared_ = broadcast8(std::numeric_limits<float>::infinity());  ///< the least of those measured
  Float8 limit_ = broadcast8(std::numeric_limits<float>::infinity());    ///< no triangle further away is of interest
  Mask8 start_ = Mask8{} - 1;                                            ///< the blocks that the walks led to
  std::uint32_t measured_count_ = 0, pair_count_ = 0;
  std::array<Measured, max_triangles + 1> measured_;
  std::array<Pair, max_pairs> pairs_;
  std::array<Best, group_width> best_;
};

inline bool measure_group(const Bvh::Data& data, std::span<const GroupQuery> queries, std::uint32_t hint,
                          std::span<PointDistance> answers) {
  return GroupSearch(data, queries).run(hint, answers);
}

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
