// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "meshbound/triangle_mesh.h"

namespace meshbound {

/// By triangle: three triangles that share an edge with it, descending; `no_index` first where there are fewer. Of more
/// than two triangles of an edge, those next to each other in number count. O(n log n).
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> neighbours_of_triangles(const TriangleMesh& mesh);

}  // namespace meshbound
