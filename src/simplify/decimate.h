// SPDX-License-Identifier: MIT
/// The main loop: propose, prove, repair, then what is near the tolerance one by one.
#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "meshbound/simplify.h"
#include "meshbound/stop_token.h"
#include "simplify/decimation_threads.h"

namespace meshbound {

/// When a decimation ends, beside where nothing fits. Lengths as in its mesh.
struct DecimationGoal {
  double tolerance = 0;  ///< less all room for rounding
  std::size_t target_faces = 0;
  OnExceed on_exceed = OnExceed::Skip;
  Effort effort = Effort::Normal;
  StopToken stop;
  std::function<void(std::size_t faces)> progress;  ///< called from the calling thread; may be none
  const CollapseDriver* driver = nullptr;           ///< null: our own
};

/// Decimates until nothing more fits or the goal is reached. The state is proven for the tolerance of the goal, which
/// must not be smaller than that of the call before, whatever ends it.
[[nodiscard]] EndedBy decimate(DecimationState& state, const DecimationGoal& goal, DecimationThreads& threads);

}  // namespace meshbound
