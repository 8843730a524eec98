// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesh/stored_mesh.h"

namespace meshbound {

/// By vertex: the first one at its position (-0 equals 0); empty where all positions are different. Vertices of one
/// bucket after the other are compared, so that no table of all positions is in memory: 50 MB for a bucket of the usual
/// size. Expected O(n).
[[nodiscard]] std::vector<std::uint32_t> first_at_positions(const StoredMesh& mesh,
                                                            std::size_t vertices_of_bucket = std::size_t{1} << 20);

}  // namespace meshbound
