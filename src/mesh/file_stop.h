// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>

#include "meshbound/stop_token.h"

namespace meshbound {

/// Ends the reading or writing of a file once `stop` says so: throws `Interrupted` for its flag, `Stopped` for its
/// deadline. `action`, for the message: "read" or "written".
void end_if_stopped(const StopToken& stop, const std::filesystem::path& path, const char* action);

}  // namespace meshbound
