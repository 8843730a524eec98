// SPDX-License-Identifier: MIT
#pragma once
#include "simplify/kernel/deviation_kernel.h"

namespace meshbound {

/// The motion of a vertex that minimises the largest of some deviations, which are linear in it: a Chebyshev problem in
/// three unknowns, solved by Newton's method on p-norms of growing p. Deviations are in tolerances; one below
/// `low_deviation` is good enough.
struct MinimaxStep {
  float here = 0;   ///< the largest deviation without a move
  float there = 0;  ///< after `move`; where no move makes it small, a lower bound for every move
  DeviationKernel::Move move = {};
};
[[nodiscard]] MinimaxStep minimax_step(const LinearDeviations& deviations, const DeviationKernel& kernel,
                                       float low_deviation);

/// No proof is expected where some deviation stays above this, in tolerances: closest points move, by which a tenth may
/// be gained.
inline constexpr float hopeless_deviation = 1.1F;

}  // namespace meshbound
