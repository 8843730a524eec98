// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "meshbound/simplify.h"

namespace meshbound {

/// Whether two corners at one vertex, of triangles with a common edge there, may belong to one sector.
using MayJoin = std::function<bool(std::uint32_t, std::uint32_t)>;

/// The corners of a level, numbered 3 t + k, in sectors: a sector holds the corners around one vertex that are joined
/// across edges that are no lines. By sector, in the order of their first corners: its corners, ascending. O(n log n).
[[nodiscard]] std::vector<std::vector<std::uint32_t>> sectors(const SimplifiedLevel& level,
                                                              const MayJoin& may_join = {});

}  // namespace meshbound
