// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <functional>

#include "simplify/decimation_threads.h"

namespace meshbound {

struct RefinementGoal {
  std::size_t target_faces = 0;
  std::function<bool()> stop = [] { return false; };  ///< asked now and then, by several threads; true ends at once
};

/// Makes room for further collapses where nothing fits any more: shakes the mesh a little, flips edges and moves
/// vertices to where the deviation is lower, and collapses edges together with changes around them, in rounds, until a
/// round gains too little. Each change is proven, so the state, which must have nothing unproven, stays so.
///
/// Deterministic: random numbers depend on the round and the region alone, and the result on the number of threads not
/// at all. O(n) for each of a few rounds, n the size of the original.
void refine(DecimationState& state, const RefinementGoal& goal, DecimationThreads& threads);

}  // namespace meshbound
