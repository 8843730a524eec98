// SPDX-License-Identifier: MIT
#pragma once
#include "simplify/arguments.h"

namespace meshbound::tools {

/// One run of simplify_with_bound on one mesh: reads, simplifies, writes, measures what was written, reports. Returns
/// the exit code; throws for what `tool_main` turns into a line.
int run_simplify(const SimplifyArguments& options);

}  // namespace meshbound::tools
