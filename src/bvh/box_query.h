// SPDX-License-Identifier: MIT
/// How far the boxes of a node are from a query. Compiled once per instruction set (numeric/isa.h).
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include "bvh/bvh_data.h"
#include "numeric/simd.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {

/// The eight boxes of a node, seen from a query.
struct BoxDistances {
  Float8 squared{};  ///< lower bounds but for 8 roundings of 2^-24 each (`prune_limit` allows for them); infinite for
                     ///< empty boxes
  Float8 centre{};   ///< nearer boxes mostly have less; any numbers for empty boxes
};

/// The limit for computed box distances: boxes at this squared distance or more hold no point within `squared`.
inline float prune_limit(double squared) {
  const double limit = squared * (1 + 0x1p-20);
  return limit < 0x1p126 ? static_cast<float>(limit) + std::numeric_limits<float>::min()
                         : std::numeric_limits<float>::infinity();
}

/// A query point or box as intervals of floats, so that box distances never come out too large.
struct FloatQuery {
  explicit FloatQuery(const Vec3& p) : FloatQuery(p, p) {}
  FloatQuery(const Vec3& box_lo, const Vec3& box_hi) {
    const double min[3] = {box_lo.x, box_lo.y, box_lo.z}, max[3] = {box_hi.x, box_hi.y, box_hi.z};
    for (int axis = 0; axis < 3; ++axis) {
      const auto from = static_cast<float>(min[axis]), to = static_cast<float>(max[axis]);
      lo[axis] = broadcast8(from - step(from));
      hi[axis] = broadcast8(to + step(to));
    }
  }

  /// `centre` is the squared distance of the centres, times 4.
  [[nodiscard]] BoxDistances to_boxes(const BvhNode& node) const {
    BoxDistances distances;
    for (int axis = 0; axis < 3; ++axis) {
      const auto [outside, from_centre] = along(node, axis);
      distances.squared = multiply_add(outside, outside, distances.squared);
      distances.centre = multiply_add(from_centre, from_centre, distances.centre);
    }
    return distances;
  }
  /// The limit for `squared` of boxes that hold no point within a squared distance.
  [[nodiscard]] static float limit(double squared) { return prune_limit(squared); }

  struct Along {
    Float8 outside, from_centre;
  };
  [[nodiscard]] Along along(const BvhNode& node, int axis) const {
    const Float8 below = *reinterpret_cast<const Float8*>(node.lo[axis]) - hi[axis],
                 above = lo[axis] - *reinterpret_cast<const Float8*>(node.hi[axis]);
    return {maximum(maximum(below, above), Float8{}), below - above};
  }

  Float8 lo[3], hi[3];

 private:
  /// One step of a float is at most 2^-23 of it; the least normal number covers the range below.
  static float step(float f) { return (f < 0 ? -f : f) * 0x1p-23F + std::numeric_limits<float>::min(); }
};

/// Queries with a coordinate beyond this, in working units, are `FarQuery`s: floats tell their distances to boxes of
/// the tree apart by 2^-11 of its size only, and a walk would visit all triangles of a flat side. It is less than what
/// `FloatTriangles` allows for.
inline constexpr double max_near_magnitude = 0x1p10;

inline bool is_far(const Vec3& p) {
  return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}) > max_near_magnitude;
}

/// A query point far outside the box of the tree. Let c be the point of that box nearest to it, apart[k] = |p[k] -
/// c[k]| and outside[k] how far c is outside a box of a node, along axis k. The squared distance to any point of the
/// tree in that box is at least the sum of (apart[k] + outside[k])^2. What it exceeds the sum of apart[k]^2 by is the
/// sum of outside[k] (outside[k] + 2 apart[k]), which floats tell exactly enough: their roundings are relative to it.
class FarQuery {
 public:
  FarQuery(const Box& tree, const Vec3& p) : FarQuery(p, nearest_in(tree, p)) {}

  /// `squared`: less the squared distance to the box of the tree.
  [[nodiscard]] BoxDistances to_boxes(const BvhNode& node) const {
    BoxDistances distances;
    for (int axis = 0; axis < 3; ++axis) {
      const Float8 outside = from_box_.along(node, axis).outside;
      distances.squared = multiply_add(outside, outside + twice_apart_[axis], distances.squared);
    }
    distances.centre = distances.squared;
    return distances;
  }
  [[nodiscard]] float limit(double squared) const {
    return prune_limit(std::max(0.0, squared * (1 + margin) - squared_apart_));
  }

 private:
  /// More than 8 roundings of doubles.
  static constexpr double margin = 0x1p-49;

  FarQuery(const Vec3& p, const Vec3& in_tree) : from_box_(in_tree) {
    const Vec3 apart = p - in_tree;
    squared_apart_ = squared_length(apart) * (1 - margin);
    const double along[3] = {std::fabs(apart.x), std::fabs(apart.y), std::fabs(apart.z)};
    for (int axis = 0; axis < 3; ++axis)
      twice_apart_[axis] = broadcast8(static_cast<float>(2 * along[axis]) * (1 - 0x1p-23F));
  }

  static Vec3 nearest_in(const Box& box, const Vec3& p) {
    return {std::clamp(p.x, box.lo.x, box.hi.x), std::clamp(p.y, box.lo.y, box.hi.y),
            std::clamp(p.z, box.lo.z, box.hi.z)};
  }

  FloatQuery from_box_;
  Float8 twice_apart_[3];
  double squared_apart_ = 0;  ///< not above the squared distance to the box of the tree
};

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
