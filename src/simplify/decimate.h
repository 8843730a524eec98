// SPDX-License-Identifier: MIT
/// The main loop: propose, prove, repair; then collapses near the tolerance, proven one by one.
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "meshbound/simplify.h"
#include "meshbound/stop_token.h"
#include "simplify/decimation_threads.h"
#include "simplify/mesh/refuted.h"

namespace meshbound {

/// Limits at which a decimation ends before nothing fits any more. Lengths as in its mesh.
struct DecimationGoal {
  double tolerance = 0;  ///< without the room reserved for rounding
  std::size_t target_faces = 0;
  OnExceed on_exceed = OnExceed::Skip;
  Effort effort = Effort::Normal;
  StopToken stop;
  std::function<void(std::size_t faces)> progress;  ///< called from the calling thread; may be none
  const CollapseDriver* driver = nullptr;           ///< null: our own
};

/// Decimates until nothing more fits or the goal is reached. Afterwards the state is proven for the tolerance of the
/// goal, whatever ended it; that tolerance must not be smaller than that of the call before.
[[nodiscard]] EndedBy decimate(DecimationState& state, const DecimationGoal& goal, DecimationThreads& threads);

/// Undoes what has led to what is refuted by a measurement of the mesh, and proves the state again. False if there is
/// nothing to undo. `DecimationState::proven_changes` must be set.
[[nodiscard]] bool take_back(DecimationState& state, std::span<const Refuted> refuted, DecimationThreads& threads);

}  // namespace meshbound
