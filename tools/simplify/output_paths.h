// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <filesystem>

#include "simplify/arguments.h"

namespace meshbound::tools {

/// The file of a level. `index` 0 is that of the smallest tolerance.
[[nodiscard]] std::filesystem::path level_path(const SimplifyArguments& options, std::size_t index);

/// The file of the certificate of that level.
[[nodiscard]] std::filesystem::path level_certificate_path(const SimplifyArguments& options, std::size_t index);

/// Checks, before any work, that no output replaces an input or another output, and that the outputs can be written.
/// Throws `InvalidInput` or `IoError`.
void check_paths(const SimplifyArguments& options);

}  // namespace meshbound::tools
