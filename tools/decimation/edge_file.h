// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <vector>

#include "meshbound/line_mesh.h"
#include "meshbound/stop_token.h"

namespace meshbound::tools {

/// Reads edges of a mesh: two indices of vertices a line, counted from 0; empty lines and what follows # do not count.
/// Throws `IoError`; `InvalidInput` with file and line for anything else and for an index that is not below `vertices`.
[[nodiscard]] std::vector<Edge> read_edges(const std::filesystem::path& path, std::size_t vertices,
                                           const StopToken& stop);

}  // namespace meshbound::tools
