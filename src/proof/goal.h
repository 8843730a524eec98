// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <limits>

#include "bvh/nearest.h"
#include "geometry/vec3.h"

namespace meshbound {

/// Cuts after which a piece is bounded as it stands. It enters the error analysis: a corner is the product of at most
/// so many cuts.
inline constexpr std::uint32_t deepest_cut = 120;

/// What a one-sided search is to reach, in units of B's working frame.
struct Goal {
  double error_bound = 0;
  double tolerance = std::numeric_limits<double>::infinity();  ///< infinite: none
  bool decide_only = false;  ///< only tell whether the distance is within the tolerance
  double slack = 0;          ///< what a computed distance of a point of the models may be off, either way
  double cut_slack = 0;      ///< what each cut adds for the points it makes
  std::chrono::steady_clock::time_point deadline = std::chrono::steady_clock::time_point::max();
  const std::atomic<bool>* cancel = nullptr;

  /// The most that any computed distance may be off.
  [[nodiscard]] double largest_slack() const { return slack + deepest_cut * cut_slack; }

  /// Pieces whose computed distance is at most this need no more work, given a proven lower bound: DESIGN "target". Not
  /// below what is left of the proven distance when both are off by the slack: nothing could be told there.
  [[nodiscard]] double accepted(double lower) const {
    double target = lower + error_bound;
    if (decide_only || (lower <= tolerance && tolerance < target)) target = tolerance;
    return std::max(target - largest_slack(), lower + 3 * largest_slack());
  }

  [[nodiscard]] bool out_of_time() const {
    return (cancel != nullptr && cancel->load(std::memory_order_relaxed)) ||
           (deadline != std::chrono::steady_clock::time_point::max() && std::chrono::steady_clock::now() >= deadline);
  }
};

/// A point of A whose distance to B is proven to be at least `lower`.
struct LowerBound {
  double lower = 0;  ///< slack taken off
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
  std::uint64_t enclosed = 0;  ///< parts ended by the rule for closed models
  std::uint64_t given_up = 0;  ///< pieces too deep or beyond the budget, bounded as they stood
  std::uint32_t deepest = 0;   ///< cuts behind any piece: their rounding enters the upper bound
};

}  // namespace meshbound
