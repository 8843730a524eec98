// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

#include "meshbound/simplify.h"

namespace meshbound {

/// The edge with its smaller vertex first.
[[nodiscard]] inline Edge sorted(Edge edge) {
  std::sort(edge.begin(), edge.end());
  return edge;
}

/// Whether two corners at one vertex, of triangles with a common edge there, may be in one sector.
using MayJoin = std::function<bool(std::uint32_t, std::uint32_t)>;

/// The corners of a level, numbered 3 t + k, by sector: the corners around one vertex that are connected without
/// crossing a line. Sectors are ordered by their first corners, and corners ascend in a sector. O(n log n).
[[nodiscard]] std::vector<std::vector<std::uint32_t>> sectors(const SimplifiedLevel& level,
                                                              const MayJoin& may_join = {});

}  // namespace meshbound
