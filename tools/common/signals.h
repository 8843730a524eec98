// SPDX-License-Identifier: MIT
#pragma once
#include <atomic>

namespace meshbound::tools {

/// From here on the first SIGINT or SIGTERM sets the flag that is returned, so that a tool can end with what it has
/// proven; a second one ends the process as usual.
const std::atomic<bool>& watch_interrupts();

/// Writing past a limit on the size of files becomes an error like a full disk, instead of the end of the process.
void ignore_file_size_signal();

}  // namespace meshbound::tools
