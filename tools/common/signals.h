// SPDX-License-Identifier: MIT
#pragma once
#include <atomic>

namespace meshbound::tools {

/// From here on the first SIGINT or SIGTERM sets the flag that is returned, so that a tool can end with what it has
/// proven; a second one ends the process as usual.
const std::atomic<bool>& watch_interrupts();

}  // namespace meshbound::tools
