// SPDX-License-Identifier: MIT
#pragma once

namespace meshbound::tools {

enum ExitCode : int { ExitDone = 0, ExitExceeds = 1, ExitBadInput = 2, ExitUndecided = 3 };

}  // namespace meshbound::tools
