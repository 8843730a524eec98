// SPDX-License-Identifier: MIT
#pragma once
#include "common/tool_main.h"
#include "hausdorff/question.h"

namespace meshbound::tools {

/// `hausdorff_distance QUERY --nearest FOLDER`: the meshes below a folder that are most like the query.
[[nodiscard]] ExitCode run_nearest(const Arguments& arguments);

}  // namespace meshbound::tools
