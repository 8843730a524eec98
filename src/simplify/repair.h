// SPDX-License-Identifier: MIT
#pragma once
#include <span>
#include <vector>

#include "simplify/prove.h"

namespace meshbound {

/// Takes back the changes that made what could not be proven, and those made on top of them. Samples around may reach a
/// smaller share of the tolerance from then on.
struct Repair {
  std::vector<std::uint32_t> faces;  ///< that have changed by that, ascending
  std::size_t changes = 0;           ///< taken back
};
[[nodiscard]] Repair repair(DecimationState& state, const Unproven& unproven);

/// Notes a change of a region that is about to be made to these faces. `edge` is that of the `Edit`.
void note_edit(DecimationState& state, Region& region, Edit::Kind kind, Corner edge,
               std::span<const std::uint32_t> faces);

/// Takes back the last change of a region, whose samples have not been given to other faces yet.
void undo_last(DecimationState& state, Region& region);

/// Takes back all changes since the last proof.
void undo_all(DecimationState& state);

}  // namespace meshbound
