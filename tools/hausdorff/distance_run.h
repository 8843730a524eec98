// SPDX-License-Identifier: MIT
#pragma once
#include "hausdorff/question.h"

namespace meshbound::tools {

/// One run of hausdorff_distance: reads both meshes, measures or decides, reports. Returns the exit code; throws for
/// what `tool_main` turns into a line.
int run_distance(const Arguments& arguments);

}  // namespace meshbound::tools
