// SPDX-License-Identifier: MIT
#pragma once
#include "simplify/linear_heights.h"

namespace meshbound {

/// Where a vertex should go so that the largest of some heights, linear in its motion, is least: a Chebyshev problem in
/// three unknowns, by Newton's method on p-norms of growing p. Heights are in tolerances; one below `low_height` is
/// good enough.
struct MinimaxStep {
  float here = 0;   ///< the largest height without a move
  float there = 0;  ///< after `move`; where no move makes it small, a number that none goes below
  HeightKernel::Move move = {};
};
[[nodiscard]] MinimaxStep minimax_step(const LinearHeights& heights, const HeightKernel& kernel, float low_height);

/// No proof is expected where some height stays above this, in tolerances: closest points move, by which a tenth may be
/// gained.
inline constexpr float hopeless_height = 1.1F;

}  // namespace meshbound
