// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>

namespace meshbound::tools {

/// The file that writing to `path` would replace: `path` itself, or where it points to as a symbolic link. Throws
/// `IoError` when that is a folder, or its folder does not exist or is not writable: known now, not after an hour of
/// work.
[[nodiscard]] std::filesystem::path output_target(const std::filesystem::path& path);

}  // namespace meshbound::tools
