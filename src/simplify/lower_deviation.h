// SPDX-License-Identifier: MIT
#pragma once
#include "simplify/local_edit.h"

namespace meshbound {

struct DeviationSearch {
  int max_steps = 8;             ///< of Newton's method
  int max_attempts = 4;          ///< at one step, each shorter than the one before
  double min_gain = 0.01;        ///< a step that lowers the sum by a smaller share is the last one
  double enough_squared = 0.01;  ///< the largest squared distance, in tolerances, that needs no lowering
};

struct LoweredDeviation {
  Vec3 point;         ///< the best position found; the vertex has been placed there
  double before = 0;  ///< sum at the start
  DeviationSums lowest;
};

/// Looks for the position of a vertex where the sampled deviation around it is smallest, by Newton's method from
/// `start`, where `edit` has placed it.
[[nodiscard]] LoweredDeviation lower_deviation(LocalEdit& edit, Vec3 start, double tolerance,
                                               const DeviationSearch& search);

}  // namespace meshbound
