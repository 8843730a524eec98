// SPDX-License-Identifier: MIT
#pragma once
#include "meshbound/distance.h"
#include "numeric/checked_seconds.h"

namespace meshbound {

/// The results where the time was over before the trees were built: nothing is known.
[[nodiscard]] inline HausdorffDistance unfinished_distance() {
  HausdorffDistance result;
  result.a_to_b.outcome = result.b_to_a.outcome = Outcome::BudgetExhausted;
  return result;
}
[[nodiscard]] inline ToleranceCheck unfinished_check(double tolerance) {
  const HausdorffDistance unknown = unfinished_distance();
  return {Verdict::Undecided, tolerance, unknown.bounds, unknown.a_to_b, unknown.b_to_a};
}

/// When building trees for a measurement that begins at `start` ends.
[[nodiscard]] inline StopToken stop_of_trees(const DistanceOptions& options, StopToken::Clock::time_point start) {
  return StopToken{.cancel = options.cancel}.until(start, checked_seconds(options.budget.seconds));
}

/// The options for what follows the trees: with the time that is left.
[[nodiscard]] inline DistanceOptions after_trees(DistanceOptions options, const StopToken& stop) {
  options.budget.seconds = stop.seconds_left();
  return options;
}

}  // namespace meshbound
