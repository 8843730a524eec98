// SPDX-License-Identifier: MIT
#pragma once
#include <string>

#include "meshbound/report.h"

namespace meshbound::tools {

/// Stores the command line for `provenance`. Called once, by `tool_main`.
void remember_command_line(const std::string& tool, int argc, const char* const* argv);

/// This process, its command line and the time at the call.
[[nodiscard]] Provenance provenance();

}  // namespace meshbound::tools
