// SPDX-License-Identifier: MIT
#pragma once
#include <span>
#include <vector>

#include "simplify/mesh/refuted.h"
#include "simplify/prove.h"

namespace meshbound {

/// Undoes the changes that caused what could not be proven, and those made on top of them. From then on, samples around
/// may reach a smaller share of the tolerance.
struct Repair {
  std::vector<std::uint32_t> faces;  ///< changed by undoing, ascending
  std::size_t changes = 0;           ///< changes undone
};
[[nodiscard]] Repair repair(DecimationState& state, const Unproven& unproven);
/// As `repair`, but undoes proven changes: `DecimationState::proven_changes` must be set, and nothing else be unproven.
/// The faces that this changes are unproven then.
[[nodiscard]] Repair repair_proven(DecimationState& state, const Unproven& unproven);
/// Undoes proven changes that led to what is refuted, and those made on top of them: the last one around each, and
/// those before it as long as its texture coordinate shows that they are at fault too. A face is blamed only where none
/// of those around the original has changed. The vertices of the changes are `DecimationState::refuted`. The faces that
/// this changes are unproven then. Returns how many were undone.
[[nodiscard]] std::size_t undo_refuted(DecimationState& state, std::span<const Refuted> refuted);

/// Notes a change of a region that is about to be made to these faces. `edge` is that of the `Edit`.
void note_edit(DecimationState& state, Region& region, Edit::Kind kind, Corner edge,
               std::span<const std::uint32_t> faces);

/// Undoes the last change of a region, before its samples were assigned to other faces.
void undo_last(DecimationState& state, Region& region);

/// Undoes all changes since the last proof.
void undo_all(DecimationState& state);

}  // namespace meshbound
