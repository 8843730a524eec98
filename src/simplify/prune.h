// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>

#include "simplify/prove.h"

namespace meshbound {

struct Pruned {
  std::size_t components = 0, faces = 0;
};

/// Removes components, the smallest first, as long as `min_faces` are left: those whose part of the original is proven
/// to lie within the tolerance of what remains. Ones with locked vertices, and where `keeps_borders` ones with a
/// border, stay. The state has nothing unproven. O(n log n + size of the original).
Pruned prune(DecimationState& state, double tolerance, std::size_t min_faces, bool keeps_borders,
             ProofWorkers& workers);

}  // namespace meshbound
