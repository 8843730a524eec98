// SPDX-License-Identifier: MIT
#pragma once
#include "common/tool_main.h"
#include "hausdorff/question.h"

namespace meshbound::tools {

/// `hausdorff_distance A B --poses FILE`: one measurement or decision for each pose of B, each from what the pose
/// before has left (`MovingPair`). The exit code is that of the worst step.
[[nodiscard]] ExitCode run_motion(const Arguments& arguments);

}  // namespace meshbound::tools
