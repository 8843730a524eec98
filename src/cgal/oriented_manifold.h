// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>
#include <vector>

namespace meshbound::cgal {

/// True when the triangles, as they are, fit a half-edge structure: no directed edge twice, so that every edge has two
/// faces of opposite direction at most, and the faces around each vertex hang together as one fan or ring. The answer
/// of CGAL's `is_polygon_soup_a_polygon_mesh`, without its sets of edges. Corners are indices below `vertices`.
/// O(n log of the largest degree) time, O(n) memory.
[[nodiscard]] bool is_oriented_manifold(const std::vector<std::array<std::size_t, 3>>& triangles, std::size_t vertices);

}  // namespace meshbound::cgal
