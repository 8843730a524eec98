// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "bvh/nearest.h"
#include "geometry/vec3.h"
#include "meshbound/stop_token.h"
#include "numeric/rounding.h"

namespace meshbound {

/// Cuts after which a piece is not cut any more but bounded as it is. It enters the error analysis: no corner is the
/// product of more cuts.
inline constexpr std::uint32_t deepest_cut = 120;

/// What a one-sided search is to reach, in units of B's working frame.
struct Goal {
  double error_bound = 0;
  double tolerance = std::numeric_limits<double>::infinity();  ///< infinite: none
  bool decide_only = false;  ///< only tell whether the distance is within the tolerance
  double slack = 0;          ///< what a computed distance of a point of the models may be off, either way
  double cut_slack = 0;      ///< what each cut adds for the points it makes
  double magnitude = std::numeric_limits<double>::infinity();  ///< of all coordinates at most
  StopToken stop;

  /// The proven length of a computed squared distance to a point of B, of a point of A behind so many cuts: never below
  /// the true distance. Root, product and sums carry a relative error of 5 u at most. This and `proven_lower` are where
  /// rounding enters the bounds.
  [[nodiscard]] double proven_upper(double squared, std::uint32_t cuts) const {
    return std::sqrt(squared) * (1 + 8 * unit_roundoff) + slack + cuts * cut_slack;
  }
  /// The proven length of a certified distance (`certified_distance`) of such a point: never above the true distance.
  [[nodiscard]] double proven_lower(double certified, std::uint32_t cuts) const {
    return certified - slack - cuts * cut_slack;
  }

  /// How far any computed distance may be off at most.
  [[nodiscard]] double largest_slack() const { return slack + deepest_cut * cut_slack; }

  /// The target: pieces whose computed distance is at most this need no more work, given a proven lower bound. It is
  /// never so near to that bound that the slack of both could hide which is larger.
  [[nodiscard]] double accepted(double lower) const {
    double target = lower + error_bound;
    if (decide_only || (lower <= tolerance && tolerance < target)) target = tolerance;
    return std::max(target - largest_slack(), lower + 3 * largest_slack());
  }

  [[nodiscard]] bool out_of_time() const { return stop.stopped(); }
};

/// A point of A whose distance to B is proven to be at least `lower`.
struct LowerBound {
  double lower = 0;  ///< the slack is subtracted already
  Vec3 point;        ///< B's working frame
  std::uint32_t nearest_slot = 0;
  std::uint32_t from_slot = 0;  ///< triangle of A, by A's slot
};

/// What the walk over the cells of B did.
struct WalkCounters {
  QueryCounters queries;
  std::uint64_t pieces = 0;
  std::uint64_t cuts = 0;
  std::uint64_t resolved = 0;  ///< pieces inside a cell but nearer to another triangle at a corner
  std::uint64_t enclosed = 0;  ///< sub-triangles ended by the rule for closed models
  std::uint64_t given_up = 0;  ///< pieces too deep or beyond the budget, bounded as they stood
  std::uint32_t deepest = 0;   ///< cuts behind any piece: their rounding enters the upper bound
};

}  // namespace meshbound
